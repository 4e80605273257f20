//! A record of a file.

use mcap::McapError;
use mcap::records::{AttachmentHeader, Channel, MessageHeader, Metadata, op};

/// No record of a flight is larger than this; a length beyond it is damage, not data.
pub(crate) const RECORD_BYTES_MAX: usize = 4 << 20;

/// A record that a flight log has, as it stands there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) enum Record {
    /// Of the file.
    Header { profile: String, library: String },
    /// A message type.
    Schema(Schema),
    /// A channel.
    Channel(Channel),
    /// A message.
    Message(MessageHeader, Vec<u8>),
    /// Here the writer closed a chunk.
    #[default]
    ChunkEnd,
    /// Facts.
    Metadata(Metadata),
    /// A file.
    Attachment(AttachmentHeader, Vec<u8>),
}

/// A message type, as a file says it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Schema {
    pub id: u16,
    pub name: String,
    pub encoding: String,
    pub text: Vec<u8>,
}

impl Record {
    /// Makes a message of the record, and returns the room for its bytes, empty.
    pub fn message(&mut self, header: MessageHeader) -> &mut Vec<u8> {
        let mut data = match std::mem::take(self) {
            Self::Message(_, data) => data,
            _ => Vec::new(),
        };
        data.clear();
        *self = Self::Message(header, data);
        let Self::Message(_, data) = self else { unreachable!("it was made a message") };
        data
    }

    /// The name of what may stand anywhere in a file: metadata and attachments.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Metadata(metadata) => Some(&metadata.name),
            Self::Attachment(header, _) => Some(&header.name),
            _ => None,
        }
    }
}

/// Log time of a tick's state, ns since the start of the flight.
pub fn time_ns(tick: u64) -> u64 {
    tick.saturating_mul(engine::STEP_NS)
}

/// The header of a tick's message. The sequence wraps after half a year of flight.
pub(crate) fn stamped(channel_id: u16, tick: u64) -> MessageHeader {
    let log_time = time_ns(tick);
    MessageHeader { channel_id, sequence: tick as u32, log_time, publish_time: log_time }
}

/// A record of its bytes. To be used instead of mcap's own, which (0.26) panics on an attachment whose
/// record is too short for its name and media type.
pub(super) fn parse(opcode: u8, data: &[u8]) -> Result<mcap::records::Record<'_>, McapError> {
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
