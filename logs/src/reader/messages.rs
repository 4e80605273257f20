//! Every message of a log as it stands there.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use mcap::records::MessageHeader;

use super::ending::Ending;
use super::stream::{FileChannel, Stream};
use crate::LogError;
use crate::channels::Channel;
use crate::container::{Record, stamped};
use crate::fields::Field;
use crate::layout::Layout;
use crate::open::{OpenOptions, source};
use crate::setup::CLOSING;

/// So many ticks after a state, viewers' messages of its tick are written, too.
const PAST_TICKS: u64 = 2500;

/// Every message of a log as it stands there, whatever its channel.
pub struct Messages {
    stream: Stream,
    /// The message that was read last; its room is used again.
    pub message: Message,
    facts: Vec<(String, BTreeMap<String, String>)>,
    files: Vec<(String, Vec<u8>)>,
    from_tick: u64,
    until_tick: u64,
    /// As far as it was wanted, all was read; the rest was not looked at.
    is_read: bool,
    /// The stream has a message that was not handed out yet.
    is_held: bool,
}

/// One message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    channel: Arc<FileChannel>,
    /// Time since the start of the flight, ns.
    pub time_ns: u64,
    /// Its bytes.
    pub data: Vec<u8>,
    /// What it carries beside them.
    pub(crate) header: MessageHeader,
}

impl Messages {
    /// Opens a log, of whatever version it is if it is not compacted.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open(path: &Path, options: OpenOptions) -> Result<Self, LogError> {
        let header = MessageHeader { channel_id: 0, sequence: 0, log_time: 0, publish_time: 0 };
        let mut messages = Self {
            stream: Stream::over(source(path, options)?),
            message: Message { channel: Arc::default(), time_ns: 0, data: Vec::new(), header },
            facts: Vec::new(),
            files: Vec::new(),
            from_tick: 0,
            until_tick: u64::MAX,
            is_read: false,
            is_held: false,
        };
        // The channels are defined before the first message; what is not for this program says so.
        while !messages.stream.has_channels() && messages.stream.advance() {
            messages.is_held = messages.take_beside();
        }
        messages.stream.refused.take().map_or(Ok(messages), Err)
    }

    /// Takes what was read if it is no message; `true` when it is one.
    fn take_beside(&mut self) -> bool {
        match &mut self.stream.record {
            Record::Message(..) => return true,
            Record::Metadata(record) => self
                .facts
                .push((std::mem::take(&mut record.name), std::mem::take(&mut record.metadata))),
            Record::Attachment(header, data) => {
                self.files.push((std::mem::take(&mut header.name), std::mem::take(data)));
            }
            _ => {}
        }
        false
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
        if from_tick == 0 {
            return Ok(());
        }
        self.is_held = false;
        self.stream.seek(from_tick)
    }

    /// Reads the next message; `None` when there is none any more.
    pub fn next_message(&mut self) -> Option<&Message> {
        while std::mem::take(&mut self.is_held) || self.stream.advance() {
            if !self.take_beside() {
                continue;
            }
            let Record::Message(header, data) = &mut self.stream.record else { continue };
            let tick = header.log_time / engine::STEP_NS;
            // What viewers draw is written after the states, but not ten seconds after.
            if tick > self.until_tick.saturating_add(PAST_TICKS) {
                self.is_read = true;
                return None;
            }
            if (self.from_tick..=self.until_tick).contains(&tick) {
                let message = &mut self.message;
                (message.header, message.time_ns) = (*header, header.log_time);
                std::mem::swap(&mut message.data, data);
                message.channel.clone_from(&self.stream.channel);
                return Some(&self.message);
            }
        }
        None
    }

    /// How the file ends, once the last message has been read.
    pub fn ending(&self) -> Ending {
        if self.is_read {
            return Ending::Closed;
        }
        match &self.stream.ending {
            // An end without the writer's footer record was put there by someone else.
            Ending::Closed if self.facts.iter().all(|(name, _)| name != CLOSING) => {
                Ending::Truncated
            }
            ending => ending.clone(),
        }
    }
}

impl Message {
    /// Its channel's name.
    pub fn topic(&self) -> &str {
        &self.channel.topic
    }

    /// Which of a flight log's channels it is on, if it is on one of them.
    pub fn channel(&self) -> Option<&'static Channel> {
        self.channel.id.map(Into::into)
    }

    /// Whether it is what today's definition of its channel says.
    pub(crate) fn is_todays(&self) -> bool {
        self.channel.is_todays()
    }

    /// Whether it carries the times and the number that our writer gives the messages of a tick.
    pub(crate) fn is_stamped(&self, tick: u64) -> bool {
        self.header == stamped(self.header.channel_id, tick)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_our_writers_when_its_times_and_number_are_those_of_its_tick() {
        // Tick 10 is 10 times 4 ms.
        let ours = MessageHeader {
            channel_id: 3,
            sequence: 10,
            log_time: 40_000_000,
            publish_time: 40_000_000,
        };
        let is_stamped = |header, tick| {
            let (channel, data) = (Arc::default(), Vec::new());
            Message { channel, time_ns: ours.log_time, data, header }.is_stamped(tick)
        };
        assert!(is_stamped(ours, 10) && !is_stamped(ours, 11));
        // On whatever channel it is.
        assert!(is_stamped(MessageHeader { channel_id: 4, ..ours }, 10));
        for other in [
            MessageHeader { sequence: 11, ..ours },
            MessageHeader { log_time: 40_000_001, ..ours },
            MessageHeader { publish_time: 39_999_999, ..ours },
        ] {
            assert!(!is_stamped(other, 10), "{other:?}");
        }
    }
}
