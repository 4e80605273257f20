//! A log's index: where in the file which moment is, so that reading can start there.
//!
//! The index only says where to look. What is found is checked as everywhere: by the chunk's checksum,
//! by its tick, and by the digest chain from there on.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use mcap::records::Channel;
use mcap::sans_io::{SummaryReadEvent, SummaryReader, SummaryReaderOptions};

use crate::raw::{Raw, RawReader};
use crate::reader::{Definition, RECORD_BYTES_MAX, last_word};
use crate::records::{EVENTS, EventRecord, Happening, time_ns};
use crate::setup::CLOSING;
use crate::{LogError, cdr};

/// Where a chunk is, and which moments it holds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub offset: u64,
    end_ns: u64,
    has_events: bool,
}

/// The index at the end of a log.
pub(crate) struct Index {
    pub chunks: Vec<Place>,
    /// Message types and channels: a tool may have defined some in chunks that are passed by.
    pub definitions: Vec<(u16, Definition)>,
    pub channels: Vec<Channel>,
    closing: Option<u64>,
}

impl Index {
    /// The index, if the log was closed and its end is whole.
    pub fn read(path: &Path) -> Option<Self> {
        let mut file = File::open(path).ok()?;
        let size = file.metadata().ok()?.len();
        let options = SummaryReaderOptions::default()
            .with_file_size(size)
            .with_record_length_limit(RECORD_BYTES_MAX);
        let mut reader = SummaryReader::new_with_options(options);
        while let Some(event) = reader.next_event() {
            match event.ok()? {
                SummaryReadEvent::ReadRequest(wanted) => {
                    let read = file.read(reader.insert(wanted)).ok()?;
                    reader.notify_read(read);
                }
                SummaryReadEvent::SeekRequest(to) => reader.notify_seeked(file.seek(to).ok()?),
            }
        }
        let summary = reader.finish()?;
        let events =
            summary.channels.values().find(|channel| channel.topic == EVENTS).map(|c| c.id);
        let mut chunks: Vec<_> = summary
            .chunk_indexes
            .iter()
            .map(|chunk| Place {
                offset: chunk.chunk_start_offset,
                end_ns: chunk.message_end_time,
                has_events: events
                    .is_some_and(|events| chunk.message_index_offsets.contains_key(&events)),
            })
            .collect();
        chunks.sort_by_key(|chunk| chunk.offset);
        let closing = summary.metadata_indexes.iter().find(|m| m.name == CLOSING).map(|m| m.offset);
        let definition = |schema: &mcap::Schema<'_>| Definition {
            name: schema.name.clone(),
            encoding: schema.encoding.clone(),
            text: schema.data.to_vec(),
        };
        let definitions = summary.schemas.values().map(|s| (s.id, definition(s))).collect();
        let channel = |channel: &mcap::Channel<'_>| Channel {
            id: channel.id,
            schema_id: channel.schema.as_ref().map_or(0, |schema| schema.id),
            topic: channel.topic.clone(),
            message_encoding: channel.message_encoding.clone(),
            metadata: channel.metadata.clone(),
        };
        let channels = summary.channels.values().map(|c| channel(c)).collect();
        Some(Self { chunks, definitions, channels, closing })
    }

    /// The first chunk that reaches the tick, by its place in the list.
    pub fn chunk_of(&self, tick: u64) -> Option<usize> {
        self.chunks.iter().position(|chunk| chunk.end_ns >= time_ns(tick))
    }
}

/// Last tick and last digest of a log, as its writer closed it; `None` where that cannot be seen
/// without reading the whole log.
pub fn closing(path: &Path) -> Option<(u64, u64)> {
    let offset = Index::read(path)?.closing?;
    let mut raw = RawReader::open(path).ok()?;
    raw.jump(offset).ok()?;
    match raw.next().ok()?? {
        Raw::Metadata(record) if record.name == CLOSING => {
            last_word(&record.metadata).map(|word| word.last)
        }
        _ => None,
    }
}

/// The tick at which the pilot pressed the marker for the `number`-th time.
///
/// # Errors
/// When the log cannot be read; [`LogError::NoMarker`] with those that there are.
pub fn marker(path: &Path, number: u64) -> Result<u64, LogError> {
    let mut found = Vec::new();
    let mut look =
        |header: u16, events: Option<u16>, data: &[u8]| -> Result<Option<u64>, LogError> {
            if Some(header) != events {
                return Ok(None);
            }
            let event: EventRecord = cdr::decode(data)?;
            if event.kind != Happening::Marker as u64 {
                return Ok(None);
            }
            found.push((event.value, event.tick));
            Ok((event.value == number).then_some(event.tick))
        };
    let mut raw = RawReader::open(path)?;
    let mut events = None;
    let index = Index::read(path);
    // Without an index, the whole log; with it, the first chunk for the channels, then those with
    // events.
    let mut waiting =
        index.map(|index| index.chunks.into_iter().skip(1).filter(|chunk| chunk.has_events));
    loop {
        match raw.next() {
            Ok(Some(Raw::Channel(channel))) if channel.topic == EVENTS => events = Some(channel.id),
            Ok(Some(Raw::Message(header, data))) => {
                if let Some(tick) = look(header.channel_id, events, &data)? {
                    return Ok(tick);
                }
            }
            Ok(Some(Raw::ChunkEnd)) => {
                if let Some(waiting) = &mut waiting {
                    match waiting.next() {
                        Some(chunk) => raw.jump(chunk.offset)?,
                        None => break,
                    }
                }
            }
            Ok(Some(_)) => {}
            // Up to a cut or to damage there may be markers, too: whoever reads on will hear of it.
            Ok(None) | Err(_) => break,
        }
    }
    Err(LogError::NoMarker { number, found })
}
