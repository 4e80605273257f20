//! A file's index: where in the file which moment is, so that reading can start there.
//!
//! The index only says where to look. What is found is checked as everywhere: by the chunk's checksum,
//! by its tick, and by the digest chain from there on.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use mcap::records::{Channel, ChunkIndex};
use mcap::sans_io::{SummaryReadEvent, SummaryReader, SummaryReaderOptions};

use super::record::{RECORD_BYTES_MAX, Record, Schema};
use crate::records::{EVENTS, time_ns};
use crate::setup::{self, CLOSING};

/// Where a chunk is, and which moments it holds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub offset: u64,
    end_ns: u64,
    pub has_events: bool,
}

/// The index at the end of a file.
pub(crate) struct Index {
    pub chunks: Vec<Place>,
    /// Message types, then channels: a tool may have defined some in chunks that are passed by.
    pub definitions: Vec<Record>,
    /// Where the metadata and attachments are that a flight is opened with.
    pub files: Vec<u64>,
    /// Whether it lists all metadata and attachments that there are.
    pub lists_files: bool,
    /// Where the writer's footer record is.
    pub closing: Option<u64>,
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
        Some(Self::of(&reader.finish()?))
    }

    fn of(summary: &mcap::Summary) -> Self {
        let events = summary.channels.values().find(|channel| channel.topic == EVENTS);
        let place = |chunk: &ChunkIndex| Place {
            offset: chunk.chunk_start_offset,
            end_ns: chunk.message_end_time,
            has_events: events.is_some_and(|e| chunk.message_index_offsets.contains_key(&e.id)),
        };
        let mut chunks: Vec<_> = summary.chunk_indexes.iter().map(place).collect();
        chunks.sort_by_key(|chunk| chunk.offset);
        // In the order of their numbers.
        let (schemas, channels): (BTreeMap<_, _>, BTreeMap<_, _>) =
            (summary.schemas.iter().collect(), summary.channels.iter().collect());
        let schemas = schemas.values().map(|schema| {
            let (name, encoding) = (schema.name.clone(), schema.encoding.clone());
            Record::Schema(Schema { id: schema.id, name, encoding, text: schema.data.to_vec() })
        });
        let channels = channels.values().map(|channel| {
            Record::Channel(Channel {
                id: channel.id,
                schema_id: channel.schema.as_ref().map_or(0, |schema| schema.id),
                topic: channel.topic.clone(),
                message_encoding: channel.message_encoding.clone(),
                metadata: channel.metadata.clone(),
            })
        });
        let metadata = summary.metadata_indexes.iter().map(|found| (&found.name, found.offset));
        let attached = summary.attachment_indexes.iter().map(|found| (&found.name, found.offset));
        let closing = metadata.clone().find(|(name, _)| *name == CLOSING);
        let files = metadata.chain(attached).filter(|(name, _)| setup::opens_a_flight(name));
        let mut files: Vec<_> = files.map(|(_, offset)| offset).collect();
        files.sort_unstable();
        let counts = summary.stats.as_ref().map(|s| (s.metadata_count, s.attachment_count));
        let listed = (summary.metadata_indexes.len(), summary.attachment_indexes.len());
        Self {
            definitions: schemas.chain(channels).collect(),
            lists_files: counts == Some((listed.0 as u32, listed.1 as u32)),
            closing: closing.map(|(_, offset)| offset),
            chunks,
            files,
        }
    }

    /// The first chunk that reaches the tick, by its place in the list.
    pub fn chunk_of(&self, tick: u64) -> Option<usize> {
        self.chunks.iter().position(|chunk| chunk.end_ns >= time_ns(tick))
    }
}
