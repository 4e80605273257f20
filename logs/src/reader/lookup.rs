//! Looking things up in a log without reading all of it.

use std::path::Path;

use super::ending::footer_record;
use crate::container::{Index, LogFile, Record, RecordSource};
use crate::records::{EVENTS, EventRecord, FlightEvent};
use crate::setup::CLOSING;
use crate::{LogError, cdr};

/// Last tick and last digest of a log, as its writer closed it; `None` where that cannot be seen
/// without reading the whole log.
pub fn closing(path: &Path) -> Option<(u64, u64)> {
    let offset = Index::read(path)?.closing?;
    let mut file = LogFile::open(path).ok()?;
    file.jump(offset).ok()?;
    let mut record = Record::default();
    match (file.next(&mut record).ok()?, record) {
        (true, Record::Metadata(record)) if record.name == CLOSING => {
            footer_record(&record.metadata).map(|word| word.last)
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
    let mut file = LogFile::open(path)?;
    let mut events = None;
    // Without an index, the whole log; with it, the first chunk for the channels, then those with
    // events.
    let mut waiting = Index::read(path)
        .map(|index| index.chunks.into_iter().skip(1).filter(|chunk| chunk.has_events));
    let mut record = Record::default();
    // Up to a cut or to damage there may be markers, too: whoever reads on will hear of it.
    while let Ok(true) = file.next(&mut record) {
        match &record {
            Record::Channel(channel) if channel.topic == EVENTS => events = Some(channel.id),
            Record::Message(header, data) if Some(header.channel_id) == events => {
                let event: EventRecord = cdr::decode(data)?;
                if event.kind == FlightEvent::Marker as u64 {
                    if event.value == number {
                        return Ok(event.tick);
                    }
                    found.push((event.value, event.tick));
                }
            }
            Record::ChunkEnd => {
                if let Some(waiting) = &mut waiting {
                    let Some(chunk) = waiting.next() else { break };
                    file.jump(chunk.offset)?;
                }
            }
            _ => {}
        }
    }
    Err(LogError::NoMarker { number, found })
}
