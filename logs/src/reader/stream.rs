//! The records of a log with their channels, up to its end or the first damage.

use std::collections::BTreeMap;
use std::sync::Arc;

use mcap::records::Channel as Definition;

use super::ending::Ending;
use crate::channels::{Channel, ChannelId};
use crate::container::checksums::MessageDigests;
use crate::container::{Record, RecordSource, Schema};
use crate::layout::Layout;
use crate::{LogError, cdr, schema};

/// A channel of the file.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct FileChannel {
    pub topic: String,
    /// What its numbers are called; `None` when its messages are no recorded struct.
    pub layout: Option<Arc<Layout>>,
    /// Which of ours it is.
    pub id: Option<ChannelId>,
    /// Whether its definition is today's, to the letter.
    todays: bool,
    definition: Arc<Schema>,
}

impl FileChannel {
    /// The layout, where it may not be today's.
    pub fn foreign_layout(&self) -> Option<&Layout> {
        self.layout.as_deref().filter(|_| !self.todays)
    }

    /// Whether its messages are what today's definition says, number by number where they are numbers.
    pub fn is_todays(&self) -> bool {
        let ours = self.id.and_then(|id| <&Channel>::from(id).message_type().ok());
        let same =
            |layout: &Layout| ours.is_some_and(|ours| ours.layout.as_deref() == Some(layout));
        self.todays || self.layout.as_deref().is_some_and(same)
    }
}

/// Records of a log.
#[derive(Default)]
pub(super) struct Stream {
    pub source: Box<dyn RecordSource>,
    /// The record that was read last.
    pub record: Record,
    /// Its channel, if it is a message.
    pub channel: Arc<FileChannel>,
    types: BTreeMap<u16, Arc<Schema>>,
    channels: BTreeMap<u16, Arc<FileChannel>>,
    pub message_digests: MessageDigests,
    /// The first thing that no checksum found and that is not as written.
    pub integrity_fault: Option<String>,
    pub ending: Ending,
    /// Reading went on somewhere else in the file.
    pub sought: bool,
    /// What is no damage: a log that is not for this program.
    pub refused: Option<LogError>,
}

impl Stream {
    pub fn over(source: Box<dyn RecordSource>) -> Self {
        Self { source, ..Self::default() }
    }

    pub fn integrity_fault(&mut self, what: &str) {
        self.integrity_fault.get_or_insert_with(|| what.to_string());
    }

    /// Whether a channel was defined so far.
    pub fn has_channels(&self) -> bool {
        !self.channels.is_empty()
    }

    /// Goes where the state of a tick is not far ahead, if the log's index says where.
    pub fn seek(&mut self, tick: u64) -> Result<(), LogError> {
        self.sought = true;
        self.source.seek(tick)
    }

    /// Reads the next message, metadata or attachment into `record`; `false` when there is none.
    pub fn advance(&mut self) -> bool {
        while self.ending == Ending::Closed {
            match self.source.next(&mut self.record) {
                Ok(true) => {}
                Ok(false) => return false,
                Err(error) => {
                    self.stop(error);
                    return false;
                }
            }
            match &mut self.record {
                Record::Message(header, data) => {
                    let Some(channel) = self.channels.get(&header.channel_id) else {
                        let what = "a message on a channel that is not there";
                        self.ending = Ending::Damaged(what.into());
                        return false;
                    };
                    if !Arc::ptr_eq(channel, &self.channel) {
                        self.channel = channel.clone();
                    }
                    let (ours, text) = (channel.id.is_some(), &channel.definition.text);
                    self.message_digests.add(&channel.topic, ours, text, header, data);
                    return true;
                }
                Record::Metadata(_) | Record::Attachment(..) => return true,
                Record::Schema(schema) => {
                    self.types.insert(schema.id, Arc::new(std::mem::take(schema)));
                }
                Record::Channel(channel) => {
                    let channel = channel.clone();
                    self.meet(channel);
                }
                Record::Header { .. } | Record::ChunkEnd => {}
            }
        }
        false
    }

    fn stop(&mut self, error: LogError) {
        self.ending = match error {
            LogError::Truncated => Ending::Truncated,
            LogError::Damaged(why) | LogError::NotAFlight(why) => Ending::Damaged(why),
            error => Ending::Damaged({
                let why = error.to_string();
                let refused = matches!(
                    error,
                    LogError::Version { .. } | LogError::Layout { .. } | LogError::Setup(_)
                );
                self.refused = Some(error).filter(|_| refused);
                why
            }),
        };
    }

    /// Takes a channel's name, and looks whether it can hold what a channel of that name holds.
    fn meet(&mut self, channel: Definition) {
        let definition = self.types.get(&channel.schema_id).cloned().unwrap_or_default();
        let plain = |c: char| c.is_ascii_alphanumeric() || "/_-.".contains(c);
        let named = definition.encoding == schema::ENCODING
            && definition.name.split('/').next() == Some(schema::PACKAGE)
            && channel.topic.chars().all(plain);
        let ours = Channel::of(&channel.topic);
        let kind = ours.and_then(|ours| ours.message_type().ok());
        let todays = kind.is_some_and(|kind| kind.text.as_bytes() == definition.text);
        let layout = match kind.filter(|_| todays) {
            // Most logs are today's: nothing to be parsed.
            Some(kind) => kind.layout.clone().filter(|_| named),
            None => std::str::from_utf8(&definition.text)
                .ok()
                .filter(|_| named)
                .and_then(Layout::parse)
                .map(Arc::new),
        };
        if let Some(kind) = kind {
            // Its fields may be others than today's; what they are called has to be said.
            let said = layout.is_some() || kind.layout.is_none();
            if !said || definition.name != kind.name || channel.message_encoding != cdr::ENCODING {
                self.integrity_fault(&format!(
                    "the definition of {} is not as written",
                    channel.topic
                ));
            }
        }
        let (topic, id) = (channel.topic, ours.map(|ours| ours.id));
        let known = FileChannel { topic, layout, id, todays, definition };
        self.channels.insert(channel.id, Arc::new(known));
    }
}
