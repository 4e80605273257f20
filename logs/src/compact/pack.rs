//! Compacting a log.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use mcap::records::{AttachmentHeader, Channel, MessageHeader, Metadata};
use mcap::{Compression, McapError, WriteOptions, Writer};
use xxhash_rust::xxh3::Xxh3Default;

use super::block::{Block, Op, ROWS};
use super::columns::put;
use super::expander::{Open, add_to, setup_of};
use super::flier::{Flier, VIEWED};
use super::{Copied, HEAD, ID, TAIL, TOPIC, VERSION, create, define, facts};
use crate::raw::{Raw, RawReader};
use crate::records::{HARDWARE, INPUTS, STATE, StateRecord, TIMING, time_ns};
use crate::setup::{Identity, METADATA};
use crate::{LogError, cdr};

/// Compacts a log.
///
/// # Errors
/// When `log` is not a whole flight log of this version, does not refly to the same bits, or `out`
/// cannot be written. `keyframe_ticks` says how many ticks lie between two states that are kept.
pub fn compact(
    log: &Path,
    out: &Path,
    force: bool,
    keyframe_ticks: u64,
    open: Open,
    mut progress: impl FnMut(u64),
) -> Result<Copied, LogError> {
    let mut from = RawReader::open(log)?;
    let mut head = Head::default();
    let mut pack: Option<Pack> = None;
    let mut tail = Vec::new();
    loop {
        let raw = from.next().map_err(|error| match error {
            McapError::BadMagic => LogError::NotAFlight("not an MCAP file".into()),
            McapError::UnexpectedEof => LogError::Order(
                "it ends without having been closed; `tiltrotor log recover` makes a whole log of \
                 what there is"
                    .into(),
            ),
            error => error.into(),
        })?;
        match (raw, &mut pack) {
            (None, Some(_)) => break,
            (None, None) => return Err(LogError::NotAFlight("no message in it".into())),
            (Some(Raw::Message(header, data)), _) => {
                if !tail.is_empty() {
                    return Err(LogError::Order("messages after the writer's last word".into()));
                }
                if pack.is_none() {
                    pack = Some(Pack::begin(&head, out, force, keyframe_ticks, open)?);
                }
                if let Some(pack) = &mut pack {
                    pack.message(header, data)?;
                    progress(pack.states);
                }
            }
            (Some(Raw::ChunkEnd), Some(pack)) => pack.block.ops.push(Op::ChunkEnd),
            (Some(Raw::ChunkEnd), None) => {}
            (Some(Raw::Metadata(record)), Some(_)) => tail.push(record),
            // Our writer defines all channels first, other programs when they need them.
            (Some(raw @ (Raw::Schema { .. } | Raw::Channel(_))), Some(pack)) => {
                pack.define(&raw)?;
            }
            (Some(_), Some(_)) => {
                return Err(LogError::Order("files after the first message".into()));
            }
            (Some(raw), None) => head.take(raw)?,
        }
    }
    let Some(mut pack) = pack else { return Err(LogError::NotAFlight("no message in it".into())) };
    pack.close_last()?;
    for record in &tail {
        pack.to.write_metadata(record)?;
    }
    let original = from.fingerprint();
    let last = [
        ("messages", format!("{:016x}", pack.hash.digest())),
        ("original_bytes", original.bytes.to_string()),
        ("original_xxh3", format!("{:032x}", original.xxh3)),
    ];
    pack.to.write_metadata(&facts(TAIL, last))?;
    pack.to.finish()?;
    let file = pack.to.into_inner().into_inner().map_err(std::io::IntoInnerError::into_error)?;
    let bytes = file.metadata()?.len();
    Ok(Copied { bytes_before: original.bytes, bytes, states: pack.states, same_file: None })
}

/// What comes before the first message.
#[derive(Default)]
struct Head {
    profile: String,
    library: String,
    metadata: Vec<Metadata>,
    attachments: Vec<(AttachmentHeader, Vec<u8>)>,
    /// Message types and channels, in order.
    definitions: Vec<Raw>,
}

impl Head {
    fn take(&mut self, raw: Raw) -> Result<(), LogError> {
        match raw {
            Raw::Header { profile, library } => {
                (self.profile, self.library) = (profile, library);
            }
            Raw::Metadata(record) if record.name == HEAD => {
                return Err(LogError::NotAFlight("a log that is compacted already".into()));
            }
            Raw::Metadata(record) => self.metadata.push(record),
            Raw::Attachment(header, data) => self.attachments.push((header, data)),
            raw => self.definitions.push(raw),
        }
        Ok(())
    }

    /// The attachments as bytes; they are texts, and as attachments they would not be compressed. Then
    /// the channels: a tool that copies the compacted log leaves those out that have no message in it.
    fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        put(&mut bytes, self.attachments.len() as u64);
        for (header, data) in &self.attachments {
            put(&mut bytes, header.log_time);
            put(&mut bytes, header.create_time);
            for part in [header.name.as_bytes(), header.media_type.as_bytes(), data] {
                put_sized(&mut bytes, part);
            }
        }
        put(&mut bytes, self.definitions.len() as u64);
        for raw in &self.definitions {
            match raw {
                Raw::Schema { id, name, encoding, data } => {
                    put(&mut bytes, 0);
                    put(&mut bytes, u64::from(*id));
                    for part in [name.as_bytes(), encoding.as_bytes(), data] {
                        put_sized(&mut bytes, part);
                    }
                }
                Raw::Channel(channel) => {
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
                // Nothing else is taken for a definition.
                _ => put(&mut bytes, 2),
            }
        }
        bytes
    }
}

/// A compacted log being written.
struct Pack {
    to: Writer<BufWriter<File>>,
    hash: Xxh3Default,
    /// Topic of each channel, and whether it is the only one of that topic.
    topics: BTreeMap<u16, String>,
    flier: Flier,
    block: Block,
    plain: Vec<(MessageHeader, Vec<u8>)>,
    /// The last state's message, and where in the block it is.
    last_state: Option<(MessageHeader, Vec<u8>, usize)>,
    states: u64,
    keyframe_ticks: u64,
}

impl Pack {
    fn begin(
        head: &Head,
        out: &Path,
        force: bool,
        keyframe_ticks: u64,
        open: Open,
    ) -> Result<Self, LogError> {
        let identity = head
            .metadata
            .iter()
            .find(|record| record.name == METADATA)
            .ok_or_else(|| LogError::NotAFlight("no `tiltrotor` metadata".into()))?;
        crate::reader::refuse_other_versions(&Identity(identity.metadata.clone()))?;
        let flown = open(&setup_of(&head.attachments)?)?;
        let mut to = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            .compression_level(12)
            .compression_threads(0)
            .chunk_size(None)
            .profile(head.profile.clone())
            .library(head.library.clone())
            .disable_seeking(true)
            .create(BufWriter::new(create(out, force)?))?;
        to.write_metadata(&facts(HEAD, [("version", VERSION.to_string())]))?;
        for record in &head.metadata {
            to.write_metadata(record)?;
        }
        let schema = b"uint8[] data\n";
        to.add_schema_with_id(ID, "tiltrotor/msg/CompactBlock", "ros2msg", schema)?;
        to.add_channel_with_id(ID, ID, TOPIC, "cdr", &BTreeMap::new())?;
        let mut pack = Self {
            to,
            hash: Xxh3Default::new(),
            topics: BTreeMap::new(),
            flier: Flier::new(flown),
            block: Block::default(),
            plain: Vec::new(),
            last_state: None,
            states: 0,
            keyframe_ticks: keyframe_ticks.max(1),
        };
        pack.write_bytes(0, &head.encode())?;
        for raw in &head.definitions {
            pack.define(raw)?;
        }
        Ok(pack)
    }

    /// Takes over a message type or a channel.
    fn define(&mut self, raw: &Raw) -> Result<(), LogError> {
        match raw {
            Raw::Schema { id, name, encoding, data } => {
                self.to.add_schema_with_id(*id, name, encoding, data)?;
            }
            Raw::Channel(channel) => {
                define(&mut self.to, channel)?;
                only(&mut self.topics, channel)?;
            }
            _ => {}
        }
        Ok(())
    }

    fn message(&mut self, header: MessageHeader, data: Vec<u8>) -> Result<(), LogError> {
        let topic = self.topics.get(&header.channel_id).map_or("", String::as_str);
        let op = match topic {
            STATE => return self.state(header, data),
            HARDWARE | INPUTS | TIMING => {
                match topic {
                    HARDWARE => self.flier.event(&data)?,
                    INPUTS => self.flier.inputs(&data)?,
                    _ => {}
                }
                let number = ROWS.iter().position(|row| *row == topic).unwrap_or_default();
                let body = data.strip_prefix(&cdr::HEADER);
                let kept = body.is_some_and(|body| {
                    // The first number is the tick, from which the message's times follow.
                    body.first_chunk::<8>()
                        .is_some_and(|tick| is_stamped(&header, u64::from_le_bytes(*tick)))
                        && self.block.rows[number].push(body)
                });
                kept.then_some(Op::Row(number as u8))
            }
            _ => match VIEWED.iter().position(|viewed| *viewed == topic) {
                Some(number) => {
                    let number = number as u8;
                    let tick = header.log_time / engine::STEP_NS;
                    let again = self.flier.view(number, tick)?;
                    let same = is_stamped(&header, tick) && again.is_some_and(|a| a == data);
                    if same {
                        self.block.view_ticks[usize::from(number)].push(tick);
                    }
                    same.then_some(Op::View(number))
                }
                None => None,
            },
        };
        self.block.ops.push(op.unwrap_or(Op::Plain));
        if op.is_none() {
            self.plain.push((header, data));
        }
        Ok(())
    }

    fn state(&mut self, header: MessageHeader, data: Vec<u8>) -> Result<(), LogError> {
        let record: StateRecord = cdr::decode(&data)?;
        let tick = record.state.tick;
        self.states += 1;
        if self.states == 1 {
            self.flier.begin(record.state);
            self.block.first_tick = tick;
            self.block.ops.push(Op::Plain);
            self.plain.push((header, data));
            return Ok(());
        }
        self.flier.fly();
        if !is_stamped(&header, tick) || self.flier.state_message(record.digest)? != data {
            return Err(LogError::NotReflown { tick });
        }
        self.block.ops.push(Op::State);
        self.block.digests.push(record.digest);
        self.last_state = Some((header, data, self.block.ops.len() - 1));
        if self.block.digests.len() as u64 >= self.keyframe_ticks {
            self.close()?;
        }
        Ok(())
    }

    /// Writes the block; its last state becomes a keyframe.
    fn close(&mut self) -> Result<(), LogError> {
        let mut next_tick = self.block.first_tick;
        for (header, data) in std::mem::take(&mut self.plain) {
            self.write(header, &data)?;
        }
        if let Some((header, data, place)) = self.last_state.take() {
            next_tick = header.log_time / engine::STEP_NS;
            self.block.ops[place] = Op::Keyframe;
            self.block.digests.pop();
            self.write(header, &data)?;
        }
        let block = std::mem::replace(&mut self.block, Block::after(next_tick));
        self.write_bytes(time_ns(block.first_tick), &block.encode())?;
        self.to.flush()?;
        Ok(())
    }

    fn close_last(&mut self) -> Result<(), LogError> {
        if self.block.ops.is_empty() { Ok(()) } else { self.close() }
    }

    fn write_bytes(&mut self, time_ns: u64, bytes: &[u8]) -> Result<(), LogError> {
        let mut data = cdr::HEADER.to_vec();
        let length = u32::try_from(bytes.len())
            .map_err(|_| LogError::Encode("a block of more than 4 GB".into()))?;
        data.extend_from_slice(&length.to_le_bytes());
        data.extend_from_slice(bytes);
        let header =
            MessageHeader { channel_id: ID, sequence: 0, log_time: time_ns, publish_time: time_ns };
        self.write(header, &data)
    }

    fn write(&mut self, header: MessageHeader, data: &[u8]) -> Result<(), LogError> {
        let topic = self.topics.get(&header.channel_id).map_or(TOPIC, String::as_str);
        add_to(&mut self.hash, topic, &header, data);
        Ok(self.to.write_to_known_channel(&header, data)?)
    }
}

fn put_sized(bytes: &mut Vec<u8>, part: &[u8]) {
    put(bytes, part.len() as u64);
    bytes.extend_from_slice(part);
}

/// Whether the message carries the times and the number that our writer gives it.
fn is_stamped(header: &MessageHeader, tick: u64) -> bool {
    header.log_time == time_ns(tick)
        && header.publish_time == header.log_time
        && header.sequence == tick as u32
}

/// Adds a channel. Two of the same topic could not be told apart when they are made again.
fn only(topics: &mut BTreeMap<u16, String>, channel: &Channel) -> Result<(), LogError> {
    if channel.id == ID || topics.values().any(|topic| *topic == channel.topic) {
        return Err(LogError::Order(format!("two channels for {}", channel.topic)));
    }
    topics.insert(channel.id, channel.topic.clone());
    Ok(())
}
