//! What a compacted log says beside its blocks: the files of the flight, its channels, its form.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;

use mcap::records::{AttachmentHeader, Channel, Metadata};
use mcap::{Attachment, Writer};

use super::columns::{ColumnReader, put};
use super::{VERSION, VERSIONS_READ};
use crate::LogError;
use crate::channels::{Channel as ChannelOfOurs, Compacted};
use crate::container::{Record, Schema};
use crate::evolution::by_todays_names;
use crate::layout::Layout;
use crate::setup::{Identity, Setup};

/// The attachments as bytes; they are texts, and as attachments they would not be compressed. Then the
/// channels: a tool that copies the compacted log leaves those out that have no message in it.
pub fn encode(head: &[Record]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let files = head.iter().filter_map(|record| match record {
        Record::Attachment(header, data) => Some((header, data)),
        _ => None,
    });
    put(&mut bytes, files.clone().count() as u64);
    for (header, data) in files {
        put(&mut bytes, header.log_time);
        put(&mut bytes, header.create_time);
        for part in [header.name.as_bytes(), header.media_type.as_bytes(), data] {
            put_sized(&mut bytes, part);
        }
    }
    let is_definition = |record: &&Record| matches!(record, Record::Schema(_) | Record::Channel(_));
    put(&mut bytes, head.iter().filter(is_definition).count() as u64);
    for record in head {
        match record {
            Record::Schema(Schema { id, name, encoding, text }) => {
                put(&mut bytes, 0);
                put(&mut bytes, u64::from(*id));
                for part in [name.as_bytes(), encoding.as_bytes(), text] {
                    put_sized(&mut bytes, part);
                }
            }
            Record::Channel(channel) => {
                put(&mut bytes, 1);
                put(&mut bytes, u64::from(channel.id));
                put(&mut bytes, u64::from(channel.schema_id));
                for part in [&channel.topic, &channel.message_encoding] {
                    put_sized(&mut bytes, part.as_bytes());
                }
                put(&mut bytes, channel.metadata.len() as u64);
                for part in channel.metadata.iter().flat_map(|(key, value)| [key, value]) {
                    put_sized(&mut bytes, part.as_bytes());
                }
            }
            _ => {}
        }
    }
    bytes
}

/// The files that were attachments, and the definitions before the first message.
pub fn decode(bytes: &[u8]) -> Result<Vec<Record>, LogError> {
    let mut from = ColumnReader(bytes);
    let mut head = Vec::new();
    for _ in 0..from.count(5)? {
        let (log_time, create_time) = (from.number()?, from.number()?);
        let (name, media_type) = (text(&mut from)?, text(&mut from)?);
        let header = AttachmentHeader { log_time, create_time, name, media_type };
        head.push(Record::Attachment(header, from.sized()?.to_vec()));
    }
    for _ in 0..from.count(1)? {
        head.push(match from.number()? {
            0 => {
                let (id, name, encoding) = (id(&mut from)?, text(&mut from)?, text(&mut from)?);
                Record::Schema(Schema { id, name, encoding, text: from.sized()?.to_vec() })
            }
            1 => {
                let (id, schema_id) = (id(&mut from)?, id(&mut from)?);
                let (topic, message_encoding) = (text(&mut from)?, text(&mut from)?);
                let mut metadata = BTreeMap::new();
                for _ in 0..from.count(2)? {
                    metadata.insert(text(&mut from)?, text(&mut from)?);
                }
                Record::Channel(Channel { id, schema_id, topic, message_encoding, metadata })
            }
            _ => return Err(broken("a definition of an unknown kind")),
        });
    }
    Ok(head)
}

fn put_sized(bytes: &mut Vec<u8>, part: &[u8]) {
    put(bytes, part.len() as u64);
    bytes.extend_from_slice(part);
}

fn text(from: &mut ColumnReader<'_>) -> Result<String, LogError> {
    String::from_utf8(from.sized()?.to_vec()).map_err(|_| broken("a name is no text"))
}

fn id(from: &mut ColumnReader<'_>) -> Result<u16, LogError> {
    u16::try_from(from.number()?).map_err(|_| broken("a channel's number is too large"))
}

/// Those of the attachments that a flight is reflown from.
pub fn setup_of(head: &[Record]) -> Result<Setup, LogError> {
    let mut setup = Setup::default();
    for name in Setup::NAMES {
        let file = head.iter().find(|file| file.name() == Some(name));
        let Some(Record::Attachment(_, data)) = file else {
            return Err(LogError::NotAFlight(format!("{name} is not in it")));
        };
        setup.put(name, data.clone())?;
    }
    Ok(setup)
}

/// Writes a message type or a channel.
pub fn define(to: &mut Writer<BufWriter<File>>, definition: &Record) -> Result<(), LogError> {
    match definition {
        Record::Schema(Schema { id, name, encoding, text }) => {
            to.add_schema_with_id(*id, name, encoding, text)?;
        }
        Record::Channel(c) => {
            to.add_channel_with_id(c.id, c.schema_id, &c.topic, &c.message_encoding, &c.metadata)?;
        }
        _ => {}
    }
    Ok(())
}

/// Writes a file.
pub fn attach(
    to: &mut Writer<BufWriter<File>>,
    header: &AttachmentHeader,
    data: &[u8],
) -> Result<(), LogError> {
    to.attach(&Attachment {
        log_time: header.log_time,
        create_time: header.create_time,
        name: header.name.clone(),
        media_type: header.media_type.clone(),
        data: data.into(),
    })?;
    Ok(())
}

/// A metadata record.
pub fn facts<const N: usize>(name: &str, facts: [(&str, String); N]) -> Metadata {
    let metadata = facts.map(|(key, value)| (key.to_string(), value)).into();
    Metadata { name: name.into(), metadata }
}

/// The form of a compacted log.
pub fn form_of(head: &Metadata) -> &str {
    head.metadata.get("version").map_or("unknown", String::as_str)
}

/// Refuses a compacted log of another form.
pub fn refuse_other_form(head: &Metadata) -> Result<(), LogError> {
    let theirs = form_of(head);
    if VERSIONS_READ.contains(&theirs) {
        return Ok(());
    }
    let (what, theirs) = ("compacted form", theirs.to_string());
    Err(LogError::Version { what, theirs, ours: VERSION })
}

/// Refuses a log that has a channel, compacted in one of these ways, whose messages have not today's fields:
/// they are made of today's structs.
pub fn refuse_other_layout(
    head: &[Record],
    identity: &Identity,
    hows: &[Compacted],
) -> Result<(), LogError> {
    let types = head.iter().filter_map(|record| match record {
        Record::Schema(schema) => Some((schema.id, schema)),
        _ => None,
    });
    let types: BTreeMap<u16, &Schema> = types.collect();
    for record in head {
        let Record::Channel(definition) = record else { continue };
        let ours =
            ChannelOfOurs::of(&definition.topic).filter(|ours| hows.contains(&ours.compacted));
        let (Some(ours), Some(theirs)) = (ours, types.get(&definition.schema_id)) else { continue };
        let kind = ours.message_type()?;
        let layout = || std::str::from_utf8(&theirs.text).ok().and_then(Layout::parse);
        let same = theirs.text == kind.text.as_bytes()
            || kind.layout.is_some()
                && layout().as_ref().map(by_todays_names) == kind.layout.as_deref().cloned();
        if !same {
            let get = |key| identity.get(key);
            return Err(LogError::Layout {
                topic: ours.topic,
                format: get(Identity::FORMAT).into(),
                program: format!("{} (commit {})", get("program"), get("commit")),
            });
        }
    }
    Ok(())
}

/// What is wrong with a compacted log that has its checksums right.
pub fn broken(what: &str) -> LogError {
    LogError::Decode(format!("a compacted log that does not hold together: {what}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_definitions_come_back_in_order() {
        let file = |name: &str, log_time, data: &[u8]| {
            let (name, media_type) = (name.to_string(), "application/toml".to_string());
            let header = AttachmentHeader { log_time, create_time: 3, name, media_type };
            Record::Attachment(header, data.to_vec())
        };
        let schema = |id, text: &[u8]| {
            let (name, encoding) = (format!("tiltrotor/msg/Type{id}"), "ros2msg".to_string());
            Record::Schema(Schema { id, name, encoding, text: text.to_vec() })
        };
        let channel = |id, schema_id, facts: &[(&str, &str)]| {
            let facts = facts.iter().map(|(key, value)| (key.to_string(), value.to_string()));
            Record::Channel(Channel {
                id,
                schema_id,
                topic: format!("/topic{id}"),
                message_encoding: "cdr".into(),
                metadata: facts.collect(),
            })
        };
        let files = [file("aircraft.toml", 7, b"name = \"X\""), file("cockpit.toml", 0, b"")];
        let definitions = [
            schema(2, b"uint64 tick\n"),
            channel(5, 2, &[("a", "b"), ("c", "")]),
            schema(300, b""),
            // The greatest number that there is.
            channel(u16::MAX, 300, &[]),
        ];
        // What is no file and no definition is not among them, and files come first.
        let others =
            [Record::ChunkEnd, Record::Header { profile: "p".into(), library: "l".into() }];
        let head = [&definitions[..], &others, &files].concat();
        let bytes = encode(&head);
        assert_eq!(decode(&bytes).unwrap(), [&files[..], &definitions].concat());
        for cut in 0..bytes.len() {
            assert!(decode(&bytes[..cut]).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn a_number_of_a_definition_that_is_none_is_refused() {
        // No file and one definition, a message type of that number without name, encoding and text.
        let definition = |kind: u64, number: u64| {
            let mut bytes = vec![0, 1];
            put(&mut bytes, kind);
            put(&mut bytes, number);
            bytes.extend([0; 3]);
            decode(&bytes)
        };
        assert!(definition(0, 65_535).is_ok());
        let refused = definition(0, 65_536).unwrap_err().to_string();
        assert!(refused.ends_with("a channel's number is too large"), "{refused}");
        let refused = definition(2, 1).unwrap_err().to_string();
        assert!(refused.ends_with("a definition of an unknown kind"), "{refused}");
    }
}
