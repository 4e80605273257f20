//! A file's records in their order, each with its checksum right.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use mcap::McapError;
use mcap::records::Record as Parsed;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::checksums::Fingerprint;
use super::record::{RECORD_BYTES_MAX, Record, Schema, parse};
use super::{Index, RecordSource};
use crate::LogError;
use crate::setup::{self, COMPACT_HEAD, METADATA, Setup};

/// Bytes asked for at a time.
const BUFFER_BYTES: usize = 256 * 1024;

/// The parts of a file, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Start,
    Data,
    Index,
    Footer,
}

/// A log's file being read.
///
/// What a flight is opened with comes before its first message, wherever in the file it stands: other
/// people's tools put metadata and attachments last.
pub(crate) struct LogFile {
    /// Where it is, if it is a file.
    path: Option<PathBuf>,
    source: BufReader<Box<dyn Read + Send>>,
    reader: LinearReader,
    /// Of all bytes that were read, if it is wanted.
    fingerprint: Option<Fingerprint>,
    /// The last bytes that were read.
    tail: Vec<u8>,
    part: Part,
    in_chunk: bool,
    /// A message was read.
    begun: bool,
    /// Names of metadata and attachments before the first message.
    met: Vec<String>,
    /// Records that come before anything else is read.
    ready: VecDeque<Record>,
    /// Those of them that are still to be met in their place.
    ahead: Vec<Record>,
}

impl Default for LogFile {
    fn default() -> Self {
        Self::over(std::io::empty())
    }
}

impl LogFile {
    /// From the beginning.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        let file = File::open(path).map_err(LogError::Open)?;
        if file.metadata().map_err(LogError::Open)?.is_dir() {
            return Err(LogError::NotAFlight("a folder".into()));
        }
        Ok(Self { path: Some(path.into()), ..Self::over(file) })
    }

    /// From anywhere.
    pub fn over(source: impl Read + Send + 'static) -> Self {
        Self {
            path: None,
            source: BufReader::with_capacity(BUFFER_BYTES, Box::new(source)),
            reader: LinearReader::new_with_options(options().with_validate_data_section_crc(true)),
            fingerprint: None,
            tail: Vec::with_capacity(2 * mcap::MAGIC.len()),
            part: Part::Start,
            in_chunk: false,
            begun: false,
            met: Vec::new(),
            ready: VecDeque::new(),
            ahead: Vec::new(),
        }
    }

    /// Keeps count of the bytes read.
    #[must_use]
    pub fn with_fingerprint(self) -> Self {
        Self { fingerprint: Some(Fingerprint::default()), ..self }
    }

    /// Size and hash of the file, once it has been read from its beginning to its end.
    pub fn fingerprint(&self) -> Option<&Fingerprint> {
        self.fingerprint.as_ref()
    }

    /// Goes on with the record that begins at `offset`, outside of any chunk. Chunks keep their own
    /// checksums; that of the whole file cannot be looked at any more.
    pub fn jump(&mut self, offset: u64) -> Result<(), LogError> {
        let Some(path) = &self.path else { return Ok(()) };
        let mut file = File::open(path).map_err(LogError::Open)?;
        file.seek(SeekFrom::Start(offset))?;
        self.source = BufReader::with_capacity(BUFFER_BYTES, Box::new(file));
        self.reader = LinearReader::new_with_options(options().with_skip_start_magic(true));
        (self.part, self.in_chunk, self.begun) = (Part::Data, false, true);
        self.ready.clear();
        self.ahead.clear();
        Ok(())
    }

    /// Goes so many chunks before the one that reaches a tick; `false` where the file's index says of
    /// none.
    pub fn jump_before(&mut self, tick: u64, chunks: usize) -> Result<bool, LogError> {
        let Some(index) = self.path.as_deref().and_then(Index::read) else { return Ok(false) };
        let place = index.chunk_of(tick).and_then(|place| place.checked_sub(chunks));
        let Some(place) = place.filter(|&place| place > 0) else { return Ok(false) };
        self.jump(index.chunks[place].offset)?;
        self.ready.extend(index.definitions);
        Ok(true)
    }

    fn read(&mut self, into: &mut Record) -> Result<bool, LogError> {
        while let Some(event) = self.reader.next_event() {
            // The file itself is read below: here only a decompressor fails to read.
            let event = event.map_err(|error| match error {
                McapError::Io(_) => LogError::Damaged(
                    "a chunk of messages is not as written (it cannot be decompressed)".into(),
                ),
                error => error.into(),
            });
            let (opcode, data) = match event? {
                LinearReadEvent::Record { opcode, data } => (opcode, data),
                LinearReadEvent::ReadRequest(wanted) => {
                    let room = self.reader.insert(wanted);
                    let read = self.source.read(room)?;
                    remember(&mut self.tail, &room[..read]);
                    if let Some(fingerprint) = &mut self.fingerprint {
                        fingerprint.add(&room[..read]);
                    }
                    self.reader.notify_read(read);
                    continue;
                }
            };
            let parsed = parse(opcode, data)?;
            self.part = part_of(&parsed, self.part)?;
            // The summary repeats what was said; only its checksum and its order count.
            if self.part > Part::Data {
                continue;
            }
            if let Parsed::MessageIndex(_) = parsed {
                if !std::mem::take(&mut self.in_chunk) {
                    continue;
                }
                *into = Record::ChunkEnd;
                return Ok(true);
            }
            self.in_chunk |= matches!(
                parsed,
                Parsed::Schema { .. } | Parsed::Channel(_) | Parsed::Message { .. }
            );
            match parsed {
                Parsed::Message { header, data } => into.message(header).extend_from_slice(&data),
                Parsed::Header(header) => {
                    *into = Record::Header { profile: header.profile, library: header.library };
                }
                Parsed::Schema { header, data } => {
                    let (id, name, encoding) = (header.id, header.name, header.encoding);
                    *into = Record::Schema(Schema { id, name, encoding, text: data.into_owned() });
                }
                Parsed::Channel(channel) => *into = Record::Channel(channel),
                Parsed::Metadata(metadata) => *into = Record::Metadata(metadata),
                Parsed::Attachment { header, data, .. } => {
                    *into = Record::Attachment(header, data.into_owned());
                }
                _ => continue,
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// What is wrong with the file, by what mcap found.
    fn damage(&self, error: LogError) -> LogError {
        match error {
            LogError::Mcap(McapError::BadMagic | McapError::UnexpectedEof)
                if self.part == Part::Start =>
            {
                LogError::NotAFlight("not an MCAP file".into())
            }
            LogError::Mcap(McapError::UnexpectedEof) if self.tail != mcap::MAGIC => {
                LogError::Truncated
            }
            LogError::Mcap(error) => LogError::Damaged(in_words(&error)),
            error => error,
        }
    }

    /// Whether something that a flight is opened with did not come before its first message.
    fn lacks_files(&self) -> bool {
        let met = |name: &str| self.met.iter().any(|met| met == name);
        // A compacted log has its files in its first message.
        !met(METADATA) || !met(COMPACT_HEAD) && !Setup::NAMES.iter().all(|name| met(name))
    }

    /// What a flight is opened with and did not come yet: where the file's index says, or by a look at
    /// all of the file.
    fn files_ahead(&self) -> Result<Vec<Record>, LogError> {
        let Some(path) = &self.path else { return Ok(Vec::new()) };
        let mut found: Vec<Record> = Vec::new();
        let mut file = Self::open(path)?;
        let mut record = Record::default();
        let mut take = |record: &mut Record| {
            let name = record.name().unwrap_or_default();
            let met = self.met.iter().map(String::as_str);
            let known = met.chain(found.iter().filter_map(Record::name)).any(|met| met == name);
            if setup::opens_a_flight(name) && !known {
                found.push(std::mem::take(record));
            }
        };
        if let Some(index) = Index::read(path).filter(|index| index.lists_files) {
            for offset in index.files {
                file.jump(offset)?;
                if let Ok(true) = file.read(&mut record) {
                    take(&mut record);
                }
            }
        } else {
            while let Ok(true) = file.read(&mut record) {
                take(&mut record);
            }
        }
        Ok(found)
    }
}

impl RecordSource for LogFile {
    fn next(&mut self, record: &mut Record) -> Result<bool, LogError> {
        loop {
            if let Some(ready) = self.ready.pop_front() {
                *record = ready;
                return Ok(true);
            }
            if !self.read(record).map_err(|error| self.damage(error))? {
                return match self.ahead.first().and_then(Record::name) {
                    Some(name) => Err(LogError::Damaged(format!("{name} is not in its place"))),
                    None => Ok(false),
                };
            }
            if matches!(record, Record::Message(..)) && !self.begun {
                self.begun = true;
                if self.lacks_files() {
                    self.ahead = self.files_ahead()?;
                    self.ready.extend(self.ahead.iter().cloned());
                    self.ready.push_back(std::mem::take(record));
                    continue;
                }
            } else if let Some(name) = record.name() {
                if !self.begun {
                    self.met.push(name.into());
                } else if let Some(place) = self.ahead.iter().position(|ahead| ahead == record) {
                    self.ahead.swap_remove(place);
                    continue;
                }
            }
            return Ok(true);
        }
    }

    fn seek(&mut self, tick: u64) -> Result<(), LogError> {
        self.jump_before(tick, 0).map(|_| ())
    }
}

/// Keeps the last bytes, as many as the magic number has.
fn remember(tail: &mut Vec<u8>, read: &[u8]) {
    let kept = mcap::MAGIC.len();
    tail.extend_from_slice(&read[read.len().saturating_sub(kept)..]);
    tail.drain(..tail.len().saturating_sub(kept));
}

/// The part of the file that a record is in, or begins; what is wrong with its place, if anything.
fn part_of(record: &Parsed<'_>, now: Part) -> Result<Part, LogError> {
    use Parsed::{Attachment, DataEnd, Footer, Header, Message, Metadata, Unknown};
    match (record, now) {
        (Unknown { opcode, .. }, _) => {
            Err(LogError::Damaged(format!("a record of a kind that no log has (0x{opcode:02x})")))
        }
        (Header(_), Part::Start) => Ok(Part::Data),
        (DataEnd(_), Part::Data) => Ok(Part::Index),
        (Footer(_), Part::Index) => Ok(Part::Footer),
        (Message { .. } | Attachment { .. } | Metadata(_), Part::Data) => Ok(now),
        (Header(_) | DataEnd(_) | Footer(_), _)
        | (Message { .. } | Attachment { .. } | Metadata(_), _)
        | (_, Part::Start | Part::Footer) => {
            Err(LogError::Damaged("a record where it does not belong".into()))
        }
        _ => Ok(now),
    }
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
        McapError::Parse(_) => "a record",
        error => return error.to_string(),
    };
    format!("{what} is not as written ({error})")
}

fn options() -> LinearReaderOptions {
    LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(RECORD_BYTES_MAX)
}
