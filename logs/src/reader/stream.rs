//! The records of a file, one after another, each with its checksum right.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::McapError;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::Ending;
use super::messages::Message;
use crate::compact::Open;
use crate::compact::expander::Expander;
use crate::index::Index;
use crate::layout::Layout;
use crate::raw::{Raw, parse_record};
use crate::seal::{RollCall, Stamp};
use crate::{LogError, cdr, schema};

/// Bytes asked for at a time.
const BUFFER_BYTES: usize = 256 * 1024;
/// No record of a flight is larger than this; a length beyond it is damage, not data.
pub(crate) const RECORD_BYTES_MAX: usize = 4 << 20;

/// A record that matters.
pub(super) enum Item {
    Metadata(String, BTreeMap<String, String>),
    Attachment(String, Vec<u8>),
    Message(Message),
}

/// A channel of the file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Channel {
    pub(super) topic: String,
    /// `None` when its messages are no recorded struct.
    pub(super) layout: Option<Arc<Layout>>,
    definition: Arc<Definition>,
}

/// What a channel's messages are, as the log says it.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Definition {
    pub name: String,
    pub encoding: String,
    pub text: Vec<u8>,
}

/// The parts of a file, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Start,
    Data,
    Index,
    Footer,
}

/// Records of the file, up to its end or the first damage.
pub(super) struct Records {
    /// Where it is, if it is a file.
    path: Option<PathBuf>,
    source: BufReader<Box<dyn Read + Send>>,
    reader: LinearReader,
    /// The last bytes that were read.
    tail: Vec<u8>,
    part: Part,
    definitions: BTreeMap<u16, Arc<Definition>>,
    pub(super) channels: BTreeMap<u16, Arc<Channel>>,
    pub(super) roll_call: RollCall,
    /// The first thing that no checksum found and that is not as written.
    pub(super) oddity: Option<String>,
    ending: Ending,
    /// Makes the records of a compacted log.
    pub(super) expander: Option<Box<Expander>>,
    /// Reading went on somewhere else in the file.
    pub(super) sought: bool,
    /// What is no damage: a log that is not for this program.
    pub(super) refused: Option<LogError>,
}

impl Records {
    /// Opens a log; one that is compacted only if its states can be flown again.
    pub(super) fn open(path: &Path, open: Option<Open>) -> Result<Self, LogError> {
        let file = File::open(path).map_err(LogError::Open)?;
        if file.metadata().map_err(LogError::Open)?.is_dir() {
            return Err(LogError::NotAFlight("a folder".into()));
        }
        let mut records = Self { path: Some(path.into()), ..Self::new(file) };
        let nobody: Open = |_| Err(LogError::Compacted);
        if let Some(expander) = Expander::open(path, open.unwrap_or(nobody), false)? {
            if open.is_none() {
                return Err(LogError::Compacted);
            }
            records.expander = Some(Box::new(expander));
        }
        Ok(records)
    }

    /// Goes where the state of a tick is not far ahead, if the log's index says where.
    pub(super) fn seek(&mut self, tick: u64) -> Result<(), LogError> {
        self.sought = true;
        if let Some(expander) = &mut self.expander {
            return expander.seek(tick);
        }
        let Some(path) = self.path.clone() else { return Ok(()) };
        let Some(index) = Index::read(&path) else { return Ok(()) };
        let Some(place) = index.chunk_of(tick).filter(|&place| place > 0) else { return Ok(()) };
        for (id, definition) in index.definitions {
            self.definitions.entry(id).or_insert_with(|| Arc::new(definition));
        }
        for channel in index.channels {
            if !self.channels.contains_key(&channel.id) {
                self.meet(channel);
            }
        }
        let mut file = File::open(&path).map_err(LogError::Open)?;
        file.seek(SeekFrom::Start(index.chunks[place].offset))?;
        self.source = BufReader::with_capacity(BUFFER_BYTES, Box::new(file));
        // Chunks keep their own checksums; that of the whole file cannot be looked at any more.
        let options = options().with_skip_start_magic(true).with_validate_data_section_crc(false);
        self.reader = LinearReader::new_with_options(options);
        self.part = Part::Data;
        Ok(())
    }

    pub(super) fn new(source: impl Read + Send + 'static) -> Self {
        Self {
            path: None,
            source: BufReader::with_capacity(BUFFER_BYTES, Box::new(source)),
            reader: LinearReader::new_with_options(options()),
            tail: Vec::with_capacity(2 * mcap::MAGIC.len()),
            part: Part::Start,
            definitions: BTreeMap::new(),
            channels: BTreeMap::new(),
            roll_call: RollCall::default(),
            oddity: None,
            ending: Ending::Closed,
            expander: None,
            sought: false,
            refused: None,
        }
    }

    pub(super) fn ending(&self) -> Ending {
        self.ending.clone()
    }

    pub(super) fn oddity(&mut self, what: &str) {
        self.oddity.get_or_insert_with(|| what.to_string());
    }

    pub(super) fn next(&mut self) -> Option<Item> {
        if self.ending != Ending::Closed {
            return None;
        }
        if self.expander.is_some() {
            return self.expanded();
        }
        match self.read() {
            Ok(item) => item,
            Err(McapError::BadMagic | McapError::UnexpectedEof) if self.part == Part::Start => {
                self.ending = Ending::Damaged("not an MCAP file".into());
                None
            }
            Err(McapError::UnexpectedEof) if self.tail != mcap::MAGIC => {
                self.ending = Ending::Truncated;
                None
            }
            Err(error) => {
                self.ending = Ending::Damaged(in_words(&error));
                None
            }
        }
    }

    /// The next record of a compacted log.
    fn expanded(&mut self) -> Option<Item> {
        loop {
            match self.expander.as_mut()?.next() {
                Ok(Some(Raw::Schema { id, name, encoding, data: text })) => {
                    self.definitions.insert(id, Arc::new(Definition { name, encoding, text }));
                }
                Ok(Some(Raw::Channel(channel))) => self.meet(channel),
                Ok(Some(Raw::Message(header, data))) => {
                    if let Some(channel) = self.channels.get(&header.channel_id).cloned() {
                        let stamp = Stamp {
                            sequence: header.sequence,
                            log_time_ns: header.log_time,
                            publish_time_ns: header.publish_time,
                        };
                        self.roll_call.add(&channel.topic, &channel.definition.text, stamp, &data);
                        let time_ns = header.log_time;
                        return Some(Item::Message(Message { channel, time_ns, data, stamp }));
                    }
                }
                Ok(Some(Raw::Metadata(record))) => {
                    return Some(Item::Metadata(record.name, record.metadata));
                }
                Ok(Some(Raw::Attachment(header, data))) => {
                    return Some(Item::Attachment(header.name, data));
                }
                Ok(Some(_)) => {}
                Ok(None) => return None,
                Err(LogError::Mcap(McapError::UnexpectedEof)) => {
                    self.ending = Ending::Truncated;
                    return None;
                }
                Err(error) => {
                    self.ending = Ending::Damaged(error.to_string());
                    if matches!(error, LogError::Version { .. } | LogError::Setup(_)) {
                        self.refused = Some(error);
                    }
                    return None;
                }
            }
        }
    }

    fn read(&mut self) -> Result<Option<Item>, McapError> {
        while let Some(event) = self.reader.next_event() {
            match event? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let room = self.reader.insert(wanted);
                    let read = self.source.read(room)?;
                    remember(&mut self.tail, &room[..read]);
                    self.reader.notify_read(read);
                }
                LinearReadEvent::Record { data, opcode } => {
                    let record = parse_record(opcode, data)?;
                    let part = part_of(&record, self.part);
                    if let Some(what) = misplaced(&record, part, self.part) {
                        self.ending = Ending::Damaged(what);
                        return Ok(None);
                    }
                    self.part = part;
                    match record {
                        Record::Schema { header, data } => {
                            let definition = Definition {
                                name: header.name,
                                encoding: header.encoding,
                                text: data.into_owned(),
                            };
                            self.definitions.insert(header.id, Arc::new(definition));
                        }
                        Record::Channel(channel) => self.meet(channel),
                        Record::Message { header, data } => {
                            let Some(channel) = self.channels.get(&header.channel_id).cloned()
                            else {
                                self.ending = Ending::Damaged(
                                    "a message on a channel that is not there".into(),
                                );
                                return Ok(None);
                            };
                            let stamp = Stamp {
                                sequence: header.sequence,
                                log_time_ns: header.log_time,
                                publish_time_ns: header.publish_time,
                            };
                            let definition = &channel.definition.text;
                            self.roll_call.add(&channel.topic, definition, stamp, &data);
                            return Ok(Some(Item::Message(Message {
                                channel,
                                time_ns: header.log_time,
                                data: data.into_owned(),
                                stamp,
                            })));
                        }
                        Record::Metadata(metadata) => {
                            return Ok(Some(Item::Metadata(metadata.name, metadata.metadata)));
                        }
                        Record::Attachment { header, data, .. } => {
                            return Ok(Some(Item::Attachment(header.name, data.into_owned())));
                        }
                        _ => {}
                    }
                }
            }
        }
        Ok(None)
    }

    /// Takes a channel's name, and looks whether it can hold what a channel of that name holds.
    fn meet(&mut self, channel: mcap::records::Channel) {
        let definition = self.definitions.get(&channel.schema_id).cloned().unwrap_or_default();
        let plain = |c: char| c.is_ascii_alphanumeric() || "/_-.".contains(c);
        let ours = definition.encoding == schema::ENCODING
            && definition.name.split('/').next() == Some(schema::PACKAGE)
            && channel.topic.chars().all(plain);
        let kinds = schema::kinds().unwrap_or_default();
        let kind = kinds.iter().find(|kind| kind.topic == channel.topic);
        let layout = match kind.filter(|kind| kind.text.as_bytes() == definition.text) {
            // Most logs are today's: nothing to be parsed.
            Some(kind) => kind.layout.clone().filter(|_| ours),
            None => std::str::from_utf8(&definition.text)
                .ok()
                .filter(|_| ours)
                .and_then(Layout::parse)
                .map(Arc::new),
        };
        if let Some(kind) = kind {
            // Its fields may be others than today's; what they are called has to be said.
            let named = layout.is_some() || kind.layout.is_none();
            if !named || definition.name != kind.name || channel.message_encoding != cdr::ENCODING {
                self.oddity(&format!("the definition of {} is not as written", kind.topic));
            }
        }
        let known = Channel { topic: channel.topic, layout, definition };
        self.channels.insert(channel.id, Arc::new(known));
    }
}

/// Keeps the last bytes, as many as the magic number has.
fn remember(tail: &mut Vec<u8>, read: &[u8]) {
    let kept = mcap::MAGIC.len();
    tail.extend_from_slice(&read[read.len().saturating_sub(kept)..]);
    tail.drain(..tail.len().saturating_sub(kept));
}

/// The part of the file that a record is in, or begins.
fn part_of(record: &Record<'_>, now: Part) -> Part {
    match record {
        Record::Header(_) => Part::Data,
        Record::DataEnd(_) => Part::Index,
        Record::Footer(_) => Part::Footer,
        _ => now,
    }
}

/// What is wrong with a record's place, if anything.
fn misplaced(record: &Record<'_>, part: Part, before: Part) -> Option<String> {
    let repeated = match record {
        Record::Header(_) => before != Part::Start,
        Record::DataEnd(_) => before != Part::Data,
        Record::Footer(_) => before != Part::Index,
        Record::Unknown { opcode, .. } => {
            return Some(format!("a record of a kind that no log has (0x{opcode:02x})"));
        }
        Record::Message { .. } | Record::Attachment { .. } | Record::Metadata(_) => {
            part != Part::Data
        }
        _ => part == Part::Start || part == Part::Footer,
    };
    repeated.then(|| "a record where it does not belong".to_string())
}

/// What MCAP's own checks found, and where that is.
fn in_words(error: &McapError) -> String {
    let what = match error {
        McapError::BadAttachmentCrc { .. } => "one of the files the flight was flown with",
        McapError::BadChunkCrc { .. } | McapError::DecompressionError(_) => "a chunk of messages",
        McapError::BadDataCrc { .. } => {
            "something beside messages and files: header, metadata, a chunk's frame or its index"
        }
        McapError::BadSummaryCrc { .. } => "the index at the end",
        McapError::UnexpectedEof => "a length: it points beyond the end",
        McapError::BadMagic => "the last bytes",
        McapError::BytesAfterEndMagic => return "bytes after the end".into(),
        error => return error.to_string(),
    };
    format!("{what} is not as written ({error})")
}

fn options() -> LinearReaderOptions {
    LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(RECORD_BYTES_MAX)
}
