//! The proof that a compacted log holds all of the log that it was.

use std::collections::BTreeMap;
use std::path::Path;

use mcap::records::{AttachmentHeader, Metadata};

use super::Expander;
use super::regenerator::FlightModelOf;
use crate::LogError;
use crate::container::checksums::MessageDigest;
use crate::container::{LogFile, Record, RecordSource, Schema};

/// Expands a compacted log in memory, and compares it with the log that it was.
///
/// # Errors
/// [`LogError::NotTheSame`], or when one of the two cannot be read.
pub fn prove(log: &Path, compact: &Path, aircraft_of: FlightModelOf) -> Result<(), LogError> {
    let was = Contents::of(&mut LogFile::open(log)?)?;
    let is = Contents::of(&mut Expander::new(LogFile::open(compact)?, aircraft_of, false))?;
    match () {
        () if was.messages.digest() != is.messages.digest() => {
            Err(LogError::NotTheSame("its messages"))
        }
        () if was.files != is.files => Err(LogError::NotTheSame("its attachments")),
        () if was.facts != is.facts => Err(LogError::NotTheSame("its metadata")),
        () => Ok(()),
    }
}

/// All that a log says, wherever it stands in the file.
#[derive(Default)]
struct Contents {
    messages: MessageDigest,
    files: Vec<(AttachmentHeader, Vec<u8>)>,
    facts: Vec<Metadata>,
}

impl Contents {
    fn of(source: &mut dyn RecordSource) -> Result<Self, LogError> {
        let mut found = Self::default();
        let mut types: BTreeMap<u16, Schema> = BTreeMap::new();
        let mut channels: BTreeMap<u16, (String, Vec<u8>)> = BTreeMap::new();
        let mut record = Record::default();
        while source.next(&mut record)? {
            match &record {
                Record::Schema(schema) => {
                    types.insert(schema.id, schema.clone());
                }
                Record::Channel(channel) => {
                    let schema = types.get(&channel.schema_id).cloned().unwrap_or_default();
                    let mut definition = Vec::new();
                    for part in [
                        channel.message_encoding.as_bytes(),
                        schema.name.as_bytes(),
                        schema.encoding.as_bytes(),
                        &schema.text,
                    ] {
                        definition.extend_from_slice(part);
                        definition.push(0);
                    }
                    channels.insert(channel.id, (channel.topic.clone(), definition));
                }
                Record::Message(header, data) => {
                    let channel = channels.get(&header.channel_id);
                    let (topic, definition) =
                        channel.ok_or(LogError::NotTheSame("a message without its channel"))?;
                    found.messages.add(topic, definition, header, data);
                }
                Record::Metadata(facts) => found.facts.push(facts.clone()),
                Record::Attachment(header, data) => {
                    found.files.push((header.clone(), data.clone()));
                }
                Record::Header { .. } | Record::ChunkEnd => {}
            }
        }
        found.files.sort_by(|a, b| (&a.0.name, &a.1).cmp(&(&b.0.name, &b.1)));
        found.facts.sort_by(|a, b| (&a.name, &a.metadata).cmp(&(&b.name, &b.metadata)));
        Ok(found)
    }
}
