//! An `.rrd` file that tells when it cannot be written.
//!
//! Rerun's own file sink logs such an error and goes on: with a disk that fills up, its flush never
//! returns when the writer gave up with that flush in its queue, and a footer that did not fit is
//! not told at all (0.36.3, both seen). Here the first error is kept for [`RrdFile::close`].

use std::fs::File;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rerun::external::re_build_info::CrateVersion;
use rerun::external::re_log_encoding::Encodable;
use rerun::external::re_log_encoding::rrd::{
    EncodeError, Encoder, EncodingOptions, MessageHeader, MessageKind,
};
use rerun::external::re_log_types::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};

use logs::output::Output;

use super::basics::ViewError;
use super::canvas::Canvas;

/// A recording's file, which whoever asked for it puts in its place.
pub struct Saved {
    /// What is written to.
    pub file: RrdFile,
    /// As it is named, and where it is until it is finished.
    path: PathBuf,
    unfinished: PathBuf,
}

impl Saved {
    /// Begins it.
    pub fn new(out: &Output) -> Result<Self, ViewError> {
        let path: PathBuf = out.path().into();
        let file = out.file().map_err(|error| EncodeError::Write(io::Error::other(error)));
        let file = file
            .and_then(RrdFile::new)
            .map_err(|source| ViewError::Write { path: path.clone(), source })?;
        Ok(Self { file, path, unfinished: out.unfinished().into() })
    }

    /// What rerun refused.
    pub fn refused(&self, source: rerun::RecordingStreamError) -> ViewError {
        ViewError::Draw { path: self.path.clone(), source: Box::new(source) }
    }

    /// Ends what was drawn and closes the file; its size in bytes.
    pub fn finish(self, canvas: Canvas, mark: &str) -> Result<u64, ViewError> {
        let (recording, error) = canvas.end(mark);
        // Waits until everything is in the file.
        let flushed = recording.flush_blocking();
        let Self { file, path, unfinished } = self;
        let closed = file.close().and_then(|()| Ok(std::fs::metadata(&unfinished)?.len()));
        match (closed, error, flushed) {
            (Err(source), ..) => Err(ViewError::Write { path, source }),
            (_, Some(source), _) => Err(ViewError::Draw { path, source: Box::new(source) }),
            (.., Err(source)) => Err(ViewError::Flush { path, source }),
            (Ok(bytes), None, Ok(())) => Ok(bytes),
        }
    }
}

/// The file; clones are the same file.
#[derive(Clone)]
pub struct RrdFile {
    state: Arc<Mutex<State>>,
}

/// A file of more chunks has no index: with as many, its index and what is made of it at the end take as much
/// memory as everything else (`benches/view_cost.sh`).
const INDEXED_MAX: usize = 4096;

/// Either can be written, or has an error, or is closed.
#[derive(Default)]
struct State {
    encoder: Option<Encoder<File>>,
    error: Option<EncodeError>,
    /// Chunks so far.
    chunks: usize,
}

impl State {
    fn append(&mut self, message: &LogMsg) -> Result<(), EncodeError> {
        let Some(encoder) = &mut self.encoder else { return Ok(()) };
        self.chunks += usize::from(matches!(message, LogMsg::ArrowMsg(..)));
        if self.chunks > INDEXED_MAX {
            encoder.do_not_emit_footer();
        }
        encoder.append(message).map(drop)
    }

    /// Writes the index, or where there is none says that the file ends here: a reader would wait for more.
    fn finish(self) -> Result<(), EncodeError> {
        let Some(mut encoder) = self.encoder else { return Ok(()) };
        encoder.finish()?;
        if self.chunks > INDEXED_MAX {
            let mut end = Vec::new();
            MessageHeader { kind: MessageKind::End, len: 0 }.to_rrd_bytes(&mut end)?;
            encoder.into_inner()?.write_all(&end)?;
        }
        Ok(())
    }
}

impl RrdFile {
    /// Begins a recording in an empty file.
    pub fn new(file: File) -> Result<Self, EncodeError> {
        let encoder =
            Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file)?;
        let state = State { encoder: Some(encoder), ..State::default() };
        Ok(Self { state: Arc::new(Mutex::new(state)) })
    }

    /// Writes the end; tells the first error there was.
    pub fn close(&self) -> Result<(), EncodeError> {
        let mut state = std::mem::take(&mut *self.lock());
        state.error.take().map_or_else(|| state.finish(), Err)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LogSink for RrdFile {
    fn send(&self, message: LogMsg) {
        let mut state = self.lock();
        if let Err(error) = state.append(&message) {
            *state = State { error: Some(error), ..State::default() };
        }
    }

    /// Nothing is held back.
    fn flush_blocking(&self, _: Duration) -> Result<(), SinkFlushError> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `/dev/full` takes nothing, as a full disk.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_is_told() {
        let full = File::create("/dev/full").expect("the device");
        assert!(matches!(RrdFile::new(full), Err(EncodeError::Write(_))));
    }

    #[test]
    fn the_first_error_is_told_at_the_end() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("flight.rrd");
        let file = RrdFile::new(File::create(&path).expect("a file")).expect("a recording");
        // From here on the file is open for reading only, and refuses what is written.
        let refusing = Encoder::new_eager(
            CrateVersion::LOCAL,
            EncodingOptions::PROTOBUF_COMPRESSED,
            File::open(&path).expect("the file"),
        );
        assert!(refusing.is_err());
        file.lock().error = refusing.err();
        assert!(matches!(file.close(), Err(EncodeError::Write(_))));
        assert!(file.close().is_ok());
    }

    /// Without an index it ends with what says so: a viewer waits for more of a file that does not.
    #[test]
    fn a_long_recording_has_no_index_and_an_end() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (stream, storage) =
            rerun::RecordingStreamBuilder::new("long").memory().expect("a stream");
        stream.log_static("word", &rerun::TextLog::new("one")).expect("logged");
        let messages = storage.take();
        let chunk = messages.iter().find(|message| matches!(message, LogMsg::ArrowMsg(..)));
        let chunk = chunk.expect("a chunk");
        let written = |chunks: usize| {
            let path = folder.path().join(format!("{chunks}.rrd"));
            let file = RrdFile::new(File::create(&path).expect("a file")).expect("a recording");
            (0..chunks).for_each(|_| file.send(chunk.clone()));
            file.close().expect("room");
            std::fs::read(path).expect("a file")
        };
        // What says where an index is.
        let has_index = |bytes: &[u8]| bytes[bytes.len() - 64..].windows(4).any(|of| of == b"FOOT");
        let (few, many) = (written(INDEXED_MAX), written(INDEXED_MAX + 1));
        assert!(has_index(&few) && !has_index(&many));
        assert!(many.ends_with(&[0; MessageHeader::ENCODED_SIZE_BYTES]));
    }
}
