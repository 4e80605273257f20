//! The records of a file as they stand there, with the ends of its chunks: what a copy to the byte
//! needs to know, and what reading from the middle starts from.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use mcap::McapError;
use mcap::records::{AttachmentHeader, Channel, MessageHeader, Metadata, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use xxhash_rust::xxh3::Xxh3Default;

use crate::LogError;
use crate::reader::RECORD_BYTES_MAX;

/// A record that a flight log has.
#[derive(Debug)]
pub(crate) enum Raw {
    /// Of the file.
    Header { profile: String, library: String },
    /// A message type.
    Schema { id: u16, name: String, encoding: String, data: Vec<u8> },
    /// A channel.
    Channel(Channel),
    /// A message.
    Message(MessageHeader, Vec<u8>),
    /// Here the writer closed a chunk.
    ChunkEnd,
    /// Facts.
    Metadata(Metadata),
    /// A file.
    Attachment(AttachmentHeader, Vec<u8>),
}

/// Reads them, every checksum validated before its bytes are used.
pub(crate) struct RawReader {
    file: BufReader<File>,
    reader: LinearReader,
    hash: Xxh3Default,
    bytes: u64,
    in_chunk: bool,
}

impl RawReader {
    /// From the beginning.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        let file = File::open(path).map_err(LogError::Open)?;
        if file.metadata().map_err(LogError::Open)?.is_dir() {
            return Err(LogError::NotAFlight("a folder".into()));
        }
        Ok(Self {
            file: BufReader::with_capacity(256 * 1024, file),
            reader: LinearReader::new_with_options(options().with_validate_data_section_crc(true)),
            hash: Xxh3Default::new(),
            bytes: 0,
            in_chunk: false,
        })
    }

    /// Goes on with the chunk that begins at `offset`. Chunks keep their own checksums; that of the
    /// whole file cannot be looked at any more.
    pub fn jump(&mut self, offset: u64) -> Result<(), LogError> {
        self.file.seek(SeekFrom::Start(offset))?;
        self.reader = LinearReader::new_with_options(options().with_skip_start_magic(true));
        self.in_chunk = false;
        Ok(())
    }

    /// Size and hash of the file, once it has been read from its beginning to its end.
    pub fn fingerprint(&self) -> Fingerprint {
        Fingerprint { bytes: self.bytes, xxh3: self.hash.digest128() }
    }

    /// The next record; `None` at the end of a whole file.
    pub fn next(&mut self) -> Result<Option<Raw>, McapError> {
        while let Some(event) = self.reader.next_event() {
            let (opcode, data) = match event? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let room = self.reader.insert(wanted);
                    let read = self.file.read(room)?;
                    self.hash.update(&room[..read]);
                    self.bytes += read as u64;
                    self.reader.notify_read(read);
                    continue;
                }
                LinearReadEvent::Record { opcode, data } => (opcode, data),
            };
            if opcode == op::DATA_END {
                self.read_summary()?;
                return Ok(None);
            }
            let raw = match parse_record(opcode, data)? {
                Record::Header(header) => {
                    Raw::Header { profile: header.profile, library: header.library }
                }
                Record::Schema { header, data } => {
                    self.in_chunk = true;
                    let (id, name, encoding) = (header.id, header.name, header.encoding);
                    Raw::Schema { id, name, encoding, data: data.into_owned() }
                }
                Record::Channel(channel) => {
                    self.in_chunk = true;
                    Raw::Channel(channel)
                }
                Record::Message { header, data } => {
                    self.in_chunk = true;
                    Raw::Message(header, data.into_owned())
                }
                Record::MessageIndex(_) if self.in_chunk => {
                    self.in_chunk = false;
                    Raw::ChunkEnd
                }
                Record::Metadata(metadata) => Raw::Metadata(metadata),
                Record::Attachment { header, data, .. } => {
                    Raw::Attachment(header, data.into_owned())
                }
                _ => continue,
            };
            return Ok(Some(raw));
        }
        Ok(None)
    }

    /// The summary repeats what was said; its checksum counts, and so does every byte.
    fn read_summary(&mut self) -> Result<(), McapError> {
        while let Some(event) = self.reader.next_event() {
            if let LinearReadEvent::ReadRequest(wanted) = event? {
                let room = self.reader.insert(wanted);
                let read = self.file.read(room)?;
                self.hash.update(&room[..read]);
                self.bytes += read as u64;
                self.reader.notify_read(read);
            }
        }
        Ok(())
    }
}

/// A record of its bytes. To be used instead of mcap's own, which (0.26) panics on an attachment whose
/// record is too short for its name and media type.
pub(crate) fn parse_record(opcode: u8, data: &[u8]) -> Result<Record<'_>, McapError> {
    let available = data.len() as u64;
    match attachment_frame(data).filter(|_| opcode == op::ATTACHMENT) {
        Some(header) if header > available => {
            Err(McapError::BadAttachmentLength { header, available })
        }
        _ => mcap::parse_record(opcode, data),
    }
}

/// Bytes of an attachment's record beside the attachment itself, as far as its lengths can be read:
/// beyond that mcap notices.
fn attachment_frame(record: &[u8]) -> Option<u64> {
    const TIMES: usize = 2 * size_of::<u64>();
    const DATA_LENGTH: usize = size_of::<u64>();
    const CRC: usize = size_of::<u32>();
    let mut at = TIMES;
    for _name_and_media_type in 0..2 {
        let length = record.get(at..)?.first_chunk()?;
        at = at.checked_add(size_of::<u32>() + u32::from_le_bytes(*length) as usize)?;
    }
    Some((at.checked_add(DATA_LENGTH + CRC)?) as u64)
}

fn options() -> LinearReaderOptions {
    LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(RECORD_BYTES_MAX)
}

/// A file's size and hash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fingerprint {
    pub bytes: u64,
    pub xxh3: u128,
}

impl Fingerprint {
    /// Of a file.
    pub fn of(path: &Path) -> Result<Self, LogError> {
        let mut file = File::open(path).map_err(LogError::Open)?;
        let mut hash = Xxh3Default::new();
        let mut bytes = 0;
        let mut room = vec![0; 256 * 1024];
        loop {
            let read = file.read(&mut room)?;
            if read == 0 {
                return Ok(Self { bytes, xxh3: hash.digest128() });
            }
            hash.update(&room[..read]);
            bytes += read as u64;
        }
    }
}
