//! Compacting a log.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;

use mcap::records::{Channel as Definition, MessageHeader, Metadata};
use mcap::{Compression, WriteOptions, Writer};
use xxhash_rust::xxh3::Xxh3Default;

use super::block::{Block, Op};
use super::files::{attach, define, encode, facts, refuse_other_layout, setup_of};
use super::proof::prove;
use super::regenerator::{FlightModelOf, Regenerator, short_digest};
use super::{Copied, HEAD, ID, TAIL, TOPIC, VERSION};
use crate::channels::{Channel, ChannelId, Compacted};
use crate::container::checksums::{MessageDigests, add_message};
use crate::container::{Index, LogFile, Record, RecordSource, Schema, stamped};
use crate::output::Output;
use crate::records::{StateRecord, time_ns};
use crate::setup::{CLOSING, CLOSING_MESSAGES, Identity, METADATA};
use crate::{LogError, cdr};

/// Compacts a log, and expands it again in memory: the same messages, files and facts come back, or there
/// is no compacted log. Whoever asked for it finishes the output.
///
/// # Errors
/// When `log` is not a whole flight log of this version, does not refly to the same bits, or `output`
/// cannot be written. `keyframe_ticks` says how many ticks lie between two states that are kept.
pub fn compact(
    log: &Path,
    output: &Output,
    keyframe_ticks: u64,
    aircraft_of: FlightModelOf,
    mut progress: impl FnMut(u64),
) -> Result<Copied, LogError> {
    let mut from = LogFile::open(log)?.with_fingerprint();
    // What comes before the first message.
    let mut head = Vec::new();
    let mut packing: Option<Pack> = None;
    let mut tail: Vec<Metadata> = Vec::new();
    let mut record = Record::default();
    while from.next(&mut record)? {
        if let (Record::Message(..), None) = (&record, &packing) {
            // Our writer defines all channels first, other programs when they need them.
            let later = Index::read(log).map(|index| index.definitions).unwrap_or_default();
            head.extend(later.into_iter().filter(|new| !head.contains(new)).collect::<Vec<_>>());
            packing = Some(Pack::begin(&head, output.file()?, keyframe_ticks, aircraft_of)?);
        }
        let Some(pack) = &mut packing else {
            head.push(record.clone());
            continue;
        };
        match &mut record {
            Record::Message(header, data) => {
                pack.message(*header, data)?;
                progress(pack.states);
            }
            Record::ChunkEnd => pack.block.ops.push(Op::ChunkEnd),
            Record::Metadata(record) => tail.push(record.clone()),
            // A file that no flight is opened with.
            Record::Attachment(header, data) => attach(&mut pack.to, header, data)?,
            definition => pack.define(definition)?,
        }
    }
    let mut pack = packing.ok_or_else(|| LogError::NotAFlight("no message in it".into()))?;
    pack.close_last()?;
    pack.refuse_others_count(&head, &tail)?;
    tail.iter().try_for_each(|record| pack.to.write_metadata(record))?;
    let original = from.fingerprint().cloned().unwrap_or_default();
    let last = [
        ("messages", format!("{:016x}", pack.hash.digest())),
        ("original_bytes", original.bytes.to_string()),
        ("original_xxh3", format!("{:032x}", original.xxh3())),
    ];
    pack.to.write_metadata(&facts(TAIL, last))?;
    pack.to.finish()?;
    let file = pack.to.into_inner().into_inner().map_err(std::io::IntoInnerError::into_error)?;
    let bytes = file.metadata()?.len();
    prove(log, output.unfinished(), aircraft_of)?;
    Ok(Copied { bytes_before: original.bytes, bytes, states: pack.states, same_file: None })
}

/// A compacted log being written.
struct Pack {
    to: Writer<BufWriter<File>>,
    hash: Xxh3Default,
    /// Topic of each channel, and which of ours it is.
    topics: BTreeMap<u16, (String, Option<&'static Channel>)>,
    /// Text of each message type, and of each channel's.
    types: BTreeMap<u16, Arc<[u8]>>,
    definitions: BTreeMap<u16, Arc<[u8]>>,
    message_digests: MessageDigests,
    regenerator: Regenerator,
    /// A message as it was made again.
    again: Vec<u8>,
    block: Block,
    plain: Vec<(MessageHeader, Vec<u8>)>,
    /// The last state's message, and where in the block it is.
    last_state: Option<(MessageHeader, Vec<u8>, usize)>,
    states: u64,
    keyframe_ticks: u64,
}

impl Pack {
    fn begin(
        head: &[Record],
        out: File,
        keyframe_ticks: u64,
        aircraft_of: FlightModelOf,
    ) -> Result<Self, LogError> {
        if head.iter().any(|record| record.name() == Some(HEAD)) {
            return Err(LogError::NotAFlight("a log that is compacted already".into()));
        }
        let metadata = head.iter().filter_map(|record| match record {
            Record::Metadata(record) => Some(record),
            _ => None,
        });
        let identity = metadata
            .clone()
            .find(|record| record.name == METADATA)
            .ok_or_else(|| LogError::NotAFlight("no `tiltrotor` metadata".into()))?;
        let identity = Identity(identity.metadata.clone());
        identity.refuse_other_versions()?;
        refuse_other_layout(head, &identity, &[Compacted::Rows, Compacted::Reflown])?;
        let flown = aircraft_of(&setup_of(head)?)?;
        let (profile, library) = match head.first() {
            Some(Record::Header { profile, library }) => (profile.as_str(), library.as_str()),
            _ => ("", ""),
        };
        let mut to = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            .compression_level(12)
            .compression_threads(0)
            .chunk_size(None)
            .profile(profile)
            .library(library)
            .disable_seeking(true)
            .create(BufWriter::new(out))?;
        to.write_metadata(&facts(HEAD, [("version", VERSION.to_string())]))?;
        metadata.clone().try_for_each(|record| to.write_metadata(record))?;
        let schema = b"uint8[] data\n";
        to.add_schema_with_id(ID, "tiltrotor/msg/CompactBlock", "ros2msg", schema)?;
        to.add_channel_with_id(ID, ID, TOPIC, "cdr", &BTreeMap::new())?;
        let mut pack = Self {
            to,
            hash: Xxh3Default::new(),
            topics: BTreeMap::new(),
            types: BTreeMap::new(),
            definitions: BTreeMap::new(),
            message_digests: MessageDigests::default(),
            regenerator: Regenerator::new(flown),
            again: Vec::new(),
            block: Block::after(0),
            plain: Vec::new(),
            last_state: None,
            states: 0,
            keyframe_ticks: keyframe_ticks.max(1),
        };
        pack.write_bytes(0, &encode(head))?;
        head.iter().try_for_each(|record| pack.define(record))?;
        Ok(pack)
    }

    /// Takes over a message type or a channel, once. Two channels of the same topic could not be told
    /// apart when they are made again.
    fn define(&mut self, definition: &Record) -> Result<(), LogError> {
        if let Record::Channel(Definition { id, topic, .. }) = definition {
            if self.topics.get(id).is_some_and(|(known, _)| known == topic) {
                return Ok(());
            }
            if *id == ID || self.topics.values().any(|(known, _)| known == topic) {
                return Err(LogError::Order(format!("two channels for {topic}")));
            }
            self.topics.insert(*id, (topic.clone(), Channel::of(topic)));
        }
        match definition {
            Record::Schema(Schema { id, text, .. }) => {
                self.types.insert(*id, text.as_slice().into());
            }
            Record::Channel(channel) => {
                let text = self.types.get(&channel.schema_id).cloned().unwrap_or_default();
                self.definitions.insert(channel.id, text);
            }
            _ => {}
        }
        define(&mut self.to, definition)
    }

    /// Other people's tools write metadata while a chunk of messages waits: what comes after the writer's
    /// footer record may still be his. It is, when he counted it.
    fn refuse_others_count(&self, head: &[Record], tail: &[Metadata]) -> Result<(), LogError> {
        let metadata = head.iter().filter_map(|record| match record {
            Record::Metadata(record) => Some(record),
            _ => None,
        });
        let closing = metadata.chain(tail).find(|record| record.name == CLOSING);
        let counted = closing.and_then(|record| record.metadata.get(CLOSING_MESSAGES));
        match counted.map(|text| text.parse().ok()) {
            Some(counted) if !self.message_digests.are(counted) => Err(LogError::Damaged(
                "the messages are not those that its writer counted; `tiltrotor verify` says more"
                    .into(),
            )),
            _ => Ok(()),
        }
    }

    fn message(&mut self, header: MessageHeader, data: &[u8]) -> Result<(), LogError> {
        let (topic, channel) = self
            .topics
            .get(&header.channel_id)
            .map_or(("", None), |(topic, channel)| (topic.as_str(), *channel));
        let text = self.definitions.get(&header.channel_id).map_or(&[][..], |text| text);
        self.message_digests.add(topic, channel.is_some(), text, &header, data);
        let op = match channel.map(|channel| (channel, channel.compacted)) {
            Some((_, Compacted::Reflown)) => return self.state(header, data),
            Some((channel, Compacted::Rows)) => {
                self.regenerator.takes(channel.id, data)?;
                let number = channel.number();
                // The first number is the tick, from which the message's times follow.
                let tick = cdr::word(data, 0);
                let kept = tick.is_some_and(|tick| is_stamped(&header, tick))
                    && cdr::body_of(data).is_ok_and(|body| self.block.rows[number].push(body));
                kept.then_some(Op::Row(number as u8))
            }
            Some((channel, Compacted::Remade)) => {
                let tick = header.log_time / engine::STEP_NS;
                self.again.clear();
                let made = self.regenerator.view(&mut self.again, channel, tick)?;
                let same = is_stamped(&header, tick) && made && self.again == data;
                if same {
                    self.block.view_ticks[channel.number()].push(tick);
                }
                if let (true, ChannelId::Outputs, Some(digests)) =
                    (same, channel.id, &mut self.block.outputs)
                {
                    digests.push(short_digest(data));
                }
                same.then_some(Op::View(channel.number() as u8))
            }
            Some((channel, Compacted::Kept)) => {
                self.regenerator.takes(channel.id, data)?;
                None
            }
            None => None,
        };
        self.block.ops.push(op.unwrap_or(Op::Plain));
        if op.is_none() {
            self.plain.push((header, data.to_vec()));
        }
        Ok(())
    }

    fn state(&mut self, header: MessageHeader, data: &[u8]) -> Result<(), LogError> {
        let record: StateRecord = cdr::decode(data)?;
        let tick = record.state.tick;
        self.states += 1;
        if self.states == 1 {
            self.regenerator.begin(record.state);
            self.block.first_tick = tick;
            self.block.ops.push(Op::Plain);
            self.plain.push((header, data.to_vec()));
            return Ok(());
        }
        self.regenerator.fly();
        self.again.clear();
        self.regenerator.state_message(&mut self.again, record.digest)?;
        if !is_stamped(&header, tick) || self.again != data {
            return Err(LogError::NotReflown { tick });
        }
        self.block.ops.push(Op::State);
        self.block.digests.push(record.digest);
        let (_, mut last, _) = self.last_state.take().unwrap_or((header, Vec::new(), 0));
        last.clear();
        last.extend_from_slice(data);
        self.last_state = Some((header, last, self.block.ops.len() - 1));
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
        let topic = self.topics.get(&header.channel_id).map_or(TOPIC, |(topic, _)| topic);
        add_message(&mut self.hash, topic, &header, data);
        Ok(self.to.write_to_known_channel(&header, data)?)
    }
}

/// Whether the message carries the times and the number that our writer gives it.
fn is_stamped(header: &MessageHeader, tick: u64) -> bool {
    *header == stamped(header.channel_id, tick)
}
