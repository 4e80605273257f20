//! Compacted logs: inputs, keyframes and digests kept, states dropped, because the engine can fly
//! them again.
//!
//! A compacted log is an MCAP file, too. Keyframes are on `/state`, events and their words where they
//! always are, so that viewers still show a flight; the rest is in [`block`]s on `/compact`. It says
//! the order of all messages and where the writer closed its chunks: expanded, it is the file that was
//! compacted, byte for byte, and it says so only if the file's hash is the one that was kept.
//!
//! Readers take a compacted log for the log it was: [`Expander`] flies the states again while it is
//! read. Between keyframes a digest that was recorded meets a state that was flown again, and the
//! digest chain tells whether they belong together.

pub(crate) mod block;
mod columns;
pub(crate) mod expander;
pub(crate) mod flier;
mod pack;

use std::fs::{File, OpenOptions};
use std::io::BufWriter;
use std::path::Path;

use mcap::records::{AttachmentHeader, Metadata};
use mcap::{Attachment, WriteOptions, Writer};

use crate::LogError;
use crate::raw::{Fingerprint, Raw};
use crate::writer::CHUNK_BYTES;

pub use expander::Open;
pub use flier::Flown;
pub use pack::compact;

/// Name of the metadata record that makes a file a compacted log; it is the first one.
const HEAD: &str = "tiltrotor_compact";
/// Name of the metadata record that ends it.
const TAIL: &str = "tiltrotor_compacted";
/// Version of the form.
const VERSION: &str = "1";
/// The channel of the blocks.
const TOPIC: &str = "/compact";
/// Its number, and that of its message type: writers count from 1.
const ID: u16 = u16::MAX;

/// How a log was expanded, or compacted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Copied {
    /// Size of the log.
    pub bytes_before: u64,
    /// Size of the copy.
    pub bytes: u64,
    /// States in it, the first one included.
    pub states: u64,
    /// Whether the copy is the file that was compacted, byte for byte; `None` when it is not known.
    pub same_file: Option<bool>,
}

/// Writes the log that was compacted.
///
/// # Errors
/// When `log` is not a compacted log of this version, is damaged, does not refly to its digests, or
/// `out` cannot be written.
pub fn expand(
    log: &Path,
    out: &Path,
    force: bool,
    open: Open,
    mut progress: impl FnMut(u64),
) -> Result<Copied, LogError> {
    let Some(mut from) = expander::Expander::open(log, open, false)? else {
        return Err(LogError::NotAFlight("a log, but not a compacted one".into()));
    };
    let mut writer: Option<Copy> = None;
    while let Some(raw) = from.next()? {
        if let Raw::Header { profile, library } = raw {
            writer = Some(Copy::create(out, force, &profile, &library)?);
        } else if let Some(writer) = &mut writer {
            writer.put(raw)?;
        }
        progress(from.states());
    }
    let writer = writer.ok_or_else(|| LogError::NotAFlight("a compacted log of nothing".into()))?;
    writer.finish()?;
    let made = Fingerprint::of(out)?;
    Ok(Copied {
        bytes_before: from.fingerprint().bytes,
        bytes: made.bytes,
        states: from.states(),
        same_file: from.original().map(|original| original == made),
    })
}

/// A file that is to become the same as another one.
struct Copy(Writer<BufWriter<File>>);

impl Copy {
    fn create(path: &Path, force: bool, profile: &str, library: &str) -> Result<Self, LogError> {
        let options = WriteOptions::new()
            .compression(Some(mcap::Compression::Lz4))
            .chunk_size(Some(CHUNK_BYTES))
            .profile(profile)
            .library(library);
        Ok(Self(options.disable_seeking(true).create(BufWriter::new(create(path, force)?))?))
    }

    fn put(&mut self, raw: Raw) -> Result<(), LogError> {
        let to = &mut self.0;
        match raw {
            Raw::Header { .. } => {}
            Raw::Schema { id, name, encoding, data } => {
                to.add_schema_with_id(id, &name, &encoding, &data)?;
            }
            Raw::Channel(channel) => define(to, &channel)?,
            Raw::Message(header, data) => to.write_to_known_channel(&header, &data)?,
            Raw::ChunkEnd => to.flush()?,
            Raw::Metadata(metadata) => to.write_metadata(&metadata)?,
            Raw::Attachment(header, data) => attach(to, &header, &data)?,
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(), LogError> {
        self.0.finish()?;
        self.0.into_inner().into_inner().map_err(std::io::IntoInnerError::into_error)?;
        Ok(())
    }
}

fn define(to: &mut Writer<BufWriter<File>>, c: &mcap::records::Channel) -> Result<(), LogError> {
    to.add_channel_with_id(c.id, c.schema_id, &c.topic, &c.message_encoding, &c.metadata)?;
    Ok(())
}

fn attach(
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

fn create(path: &Path, force: bool) -> Result<File, LogError> {
    OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(force)
        .create_new(!force)
        .open(path)
        .map_err(|error| LogError::create(path, error))
}

/// A metadata record.
fn facts<const N: usize>(name: &str, facts: [(&str, String); N]) -> Metadata {
    let metadata = facts.map(|(key, value)| (key.to_string(), value)).into();
    Metadata { name: name.into(), metadata }
}
