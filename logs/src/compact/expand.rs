//! Writing the log that was compacted.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use mcap::{WriteOptions, Writer};

use super::files::{attach, define};
use super::regenerator::FlightModelOf;
use super::{Copied, Expander};
use crate::LogError;
use crate::container::checksums::Fingerprint;
use crate::container::{LogFile, Record, RecordSource};
use crate::output::Output;
use crate::writer::CHUNK_BYTES;

/// Writes the log that was compacted; whoever asked for it finishes the output.
///
/// # Errors
/// When `log` is not a compacted log of this version, is damaged, does not refly to its digests, or
/// `out` cannot be written.
pub fn expand(
    log: &Path,
    out: &Output,
    aircraft_of: FlightModelOf,
    mut progress: impl FnMut(u64),
) -> Result<Copied, LogError> {
    if !Expander::is_compacted(log)? {
        return Err(LogError::NotAFlight("a log, but not a compacted one".into()));
    }
    let mut from = Expander::new(LogFile::open(log)?.with_fingerprint(), aircraft_of, false);
    let mut writer: Option<Copy> = None;
    let mut record = Record::default();
    while from.next(&mut record)? {
        if let Record::Header { profile, library } = &record {
            writer = Some(Copy::create(out.file()?, profile, library)?);
        } else if let Some(writer) = &mut writer {
            writer.put(&record)?;
        }
        progress(from.states());
    }
    let writer = writer.ok_or_else(|| LogError::NotAFlight("a compacted log of nothing".into()))?;
    writer.finish()?;
    let made = Fingerprint::of(out.unfinished())?;
    Ok(Copied {
        bytes_before: from.bytes(),
        bytes: made.bytes,
        states: from.states(),
        same_file: from.original().map(|original| original == (made.bytes, made.xxh3())),
    })
}

/// A file that is to become the same as another one.
struct Copy(Writer<BufWriter<File>>);

impl Copy {
    fn create(file: File, profile: &str, library: &str) -> Result<Self, LogError> {
        let options = WriteOptions::new()
            .compression(Some(mcap::Compression::Lz4))
            .chunk_size(Some(CHUNK_BYTES))
            .profile(profile)
            .library(library);
        Ok(Self(options.disable_seeking(true).create(BufWriter::new(file))?))
    }

    fn put(&mut self, record: &Record) -> Result<(), LogError> {
        let to = &mut self.0;
        match record {
            Record::Message(header, data) => to.write_to_known_channel(header, data)?,
            Record::ChunkEnd => to.flush()?,
            Record::Metadata(metadata) => to.write_metadata(metadata)?,
            Record::Attachment(header, data) => attach(to, header, data)?,
            definition => define(to, definition)?,
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(), LogError> {
        self.0.finish()?;
        self.0.into_inner().into_inner().map_err(std::io::IntoInnerError::into_error)?;
        Ok(())
    }
}
