//! An `.rrd` file that tells when it cannot be written.
//!
//! Rerun's own file sink logs such an error and goes on: with a disk that fills up, its flush never
//! returns when the writer gave up with that flush in its queue, and a footer that did not fit is
//! not told at all (0.36.3, both seen). Here the first error is kept for [`RrdFile::close`].

use std::fs::File;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rerun::external::re_build_info::CrateVersion;
use rerun::external::re_log_encoding::rrd::{EncodeError, Encoder, EncodingOptions};
use rerun::external::re_log_types::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};

/// The file; clones are the same file.
#[derive(Clone)]
pub struct RrdFile {
    state: Arc<Mutex<State>>,
}

/// Either can be written, or has an error, or is closed.
#[derive(Default)]
struct State {
    encoder: Option<Encoder<File>>,
    error: Option<EncodeError>,
}

impl RrdFile {
    /// Begins a recording in an empty file.
    pub fn new(file: File) -> Result<Self, EncodeError> {
        let encoder =
            Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file)?;
        let state = State { encoder: Some(encoder), error: None };
        Ok(Self { state: Arc::new(Mutex::new(state)) })
    }

    /// Writes the footer; tells the first error there was.
    pub fn close(&self) -> Result<(), EncodeError> {
        let State { encoder, error } = std::mem::take(&mut *self.lock());
        if let Some(error) = error {
            return Err(error);
        }
        encoder.map_or(Ok(()), |mut encoder| encoder.finish())
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LogSink for RrdFile {
    fn send(&self, message: LogMsg) {
        let mut state = self.lock();
        if let Some(encoder) = &mut state.encoder
            && let Err(error) = encoder.append(&message)
        {
            *state = State { encoder: None, error: Some(error) };
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
}
