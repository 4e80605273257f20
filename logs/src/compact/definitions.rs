//! Channels and message types of a log that was compacted, and their numbers in the compacted file.

use std::collections::BTreeMap;

use mcap::records::Channel;

use super::ID;
use super::files::broken;
use crate::LogError;
use crate::container::Schema;

/// What a compacted log says of its channels and message types, as far as it has been read.
#[derive(Default)]
pub(super) struct Definitions {
    /// Channels of the log that was compacted, and of this file.
    ids: BTreeMap<String, u16>,
    topics: BTreeMap<u16, String>,
    /// Message types of the log, and their numbers there by those in this file.
    schemas: Vec<Schema>,
    schema_ids: BTreeMap<u16, u16>,
}

impl Definitions {
    /// A message type of the log, by its number there.
    pub fn has_type(&mut self, schema: &Schema) {
        self.schema_ids.insert(schema.id, schema.id);
        self.schemas.push(schema.clone());
    }

    /// A channel of the log, by its number there.
    pub fn has(&mut self, channel: &Channel) {
        self.ids.insert(channel.topic.clone(), channel.id);
    }

    /// A channel of this file, by its number here.
    pub fn in_file(&mut self, channel: &Channel) {
        self.topics.insert(channel.id, channel.topic.clone());
    }

    /// The number that a channel has in the log.
    ///
    /// # Errors
    /// When the log has no such channel.
    pub fn id(&self, topic: &str) -> Result<u16, LogError> {
        self.ids.get(topic).copied().ok_or_else(|| broken("a channel is not there"))
    }

    /// Whether a channel of the log with that topic has that number there.
    pub fn is(&self, topic: &str, id: u16) -> bool {
        self.ids.get(topic) == Some(&id)
    }

    /// The topic of a channel of this file.
    ///
    /// # Errors
    /// When the file has no such channel.
    pub fn topic(&self, id: u16) -> Result<&str, LogError> {
        self.topics.get(&id).map(String::as_str).ok_or_else(|| broken("a channel is not there"))
    }

    /// Whether a message type is not one of the log's yet; from now on it is. A tool that copied this
    /// file may have given the log's types other numbers.
    pub fn is_new_type(&mut self, schema: &mut Schema) -> bool {
        let in_file = schema.id;
        let same = |known: &&Schema| {
            (&known.name, &known.encoding, &known.text)
                == (&schema.name, &schema.encoding, &schema.text)
        };
        // Of two alike, the one with this number.
        let known = self.schemas.iter().filter(same);
        let known = known.max_by_key(|known| known.id == in_file).map(|known| known.id);
        if let Some(known) = known {
            self.schema_ids.insert(in_file, known);
            return false;
        }
        let taken = |id: &u16| self.schemas.iter().any(|known| known.id == *id);
        schema.id = (in_file..ID).chain(1..in_file).find(|id| !taken(id)).unwrap_or(in_file);
        self.schema_ids.insert(in_file, schema.id);
        self.schemas.push(schema.clone());
        true
    }

    /// The same of a channel.
    pub fn is_new(&mut self, channel: &mut Channel) -> bool {
        if self.ids.contains_key(&channel.topic) {
            return false;
        }
        let taken = |id: &u16| self.ids.values().any(|known| known == id);
        let in_file = channel.id;
        channel.id = (in_file..ID).chain(1..in_file).find(|id| !taken(id)).unwrap_or(in_file);
        channel.schema_id = *self.schema_ids.get(&channel.schema_id).unwrap_or(&channel.schema_id);
        self.ids.insert(channel.topic.clone(), channel.id);
        true
    }
}
