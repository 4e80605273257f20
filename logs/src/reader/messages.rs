//! Every message of a log as it stands there.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::Ending;
use super::stream::{Channel, Item, Records};
use crate::LogError;
use crate::compact::Open;
use crate::fields::Field;
use crate::layout::Layout;
use crate::seal::Stamp;
use crate::setup::CLOSING;

/// So many ticks after a state, viewers' messages of its tick are written, too.
const PAST_TICKS: u64 = 2500;

/// Every message of a log as it stands there, whatever its channel.
pub struct Messages {
    records: Records,
    facts: Vec<(String, BTreeMap<String, String>)>,
    files: Vec<(String, Vec<u8>)>,
    from_tick: u64,
    until_tick: u64,
}

/// One message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    pub(super) channel: Arc<Channel>,
    /// Time since the start of the flight, ns.
    pub time_ns: u64,
    /// Its bytes.
    pub data: Vec<u8>,
    /// What it carries beside them.
    pub(crate) stamp: Stamp,
}

impl Messages {
    /// Opens a log.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        Ok(Self::of(Records::open(path, None)?))
    }

    /// Opens a log, compacted or not.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open_any(path: &Path, open: Open) -> Result<Self, LogError> {
        Ok(Self::of(Records::open(path, Some(open))?))
    }

    fn of(records: Records) -> Self {
        let (facts, files) = (Vec::new(), Vec::new());
        Self { records, facts, files, from_tick: 0, until_tick: u64::MAX }
    }

    /// The metadata records that came so far: name, keys and values.
    pub fn facts(&self) -> &[(String, BTreeMap<String, String>)] {
        &self.facts
    }

    /// The attachments that came so far: name and bytes.
    pub fn files(&self) -> &[(String, Vec<u8>)] {
        &self.files
    }

    /// Only the messages from one tick to another; those before are not read where the log's index
    /// says where they are.
    ///
    /// # Errors
    /// When the log cannot be read.
    pub fn limit(&mut self, from_tick: u64, until_tick: u64) -> Result<(), LogError> {
        (self.from_tick, self.until_tick) = (from_tick, until_tick);
        // The channels are defined before the first message.
        while self.records.channels.is_empty() && self.records.next().is_some() {}
        if from_tick > 0 { self.records.seek(from_tick) } else { Ok(()) }
    }

    /// How the file ends, once the last message has been read.
    pub fn ending(&self) -> Ending {
        match self.records.ending() {
            // An end without the writer's last word was put there by someone else.
            Ending::Closed if self.facts.iter().all(|(name, _)| name != CLOSING) => {
                Ending::Truncated
            }
            ending => ending,
        }
    }
}

impl Iterator for Messages {
    type Item = Message;

    fn next(&mut self) -> Option<Message> {
        loop {
            match self.records.next()? {
                Item::Message(message) => {
                    let tick = message.time_ns / engine::STEP_NS;
                    // What viewers draw is written after the states, but not ten seconds after.
                    if tick > self.until_tick.saturating_add(PAST_TICKS) {
                        return None;
                    }
                    if (self.from_tick..=self.until_tick).contains(&tick) {
                        return Some(message);
                    }
                }
                Item::Metadata(name, facts) => self.facts.push((name, facts)),
                Item::Attachment(name, data) => self.files.push((name, data)),
            }
        }
    }
}

impl Message {
    /// Its channel's name.
    pub fn topic(&self) -> &str {
        &self.channel.topic
    }

    /// What its numbers are called, by the log's own schema; `None` on channels for viewers.
    pub fn layout(&self) -> Option<&Layout> {
        self.channel.layout.as_deref()
    }

    /// The numbers of a recorded struct, by the log's own schema; `None` on channels for viewers.
    ///
    /// # Errors
    /// When the bytes are not what the channel holds.
    pub fn fields(&self) -> Option<Result<Vec<Field>, LogError>> {
        self.layout().map(|layout| layout.fields(&self.data))
    }
}
