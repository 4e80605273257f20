//! Unix: signals and named pipes.

use std::fs::{File, OpenOptions, metadata};
use std::io;
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;

use rustix::fs::OFlags;
use rustix::io::Errno;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};

/// Signals that end a flight in an orderly way, and what they are called. After SIGXFSZ the log cannot
/// grow any further; what is in it stays.
pub(crate) const ENDING: &[(i32, &str)] =
    &[(SIGINT, "SIGINT"), (SIGTERM, "SIGTERM"), (SIGHUP, "SIGHUP"), (SIGXFSZ, "SIGXFSZ")];

/// Whether whoever started this process has it ignore SIGHUP or SIGXFSZ, as `nohup` does: the flight is to
/// go on. Not known, and so not the case, where the system does not tell. The others always end it.
pub(crate) fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    // A bit each from signal 1 on.
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    matches!(signal, SIGHUP | SIGXFSZ) && mask & 1 << (signal - 1) != 0
}

/// Opens a named pipe that the log goes into, to be kept open until the log is closed; `None` when the path
/// is none.
///
/// The log's writer opens it a second time. That would wait for a reader; with this one kept, the reader
/// sees no end between the two.
///
/// # Errors
/// When nobody reads it: whoever opened it then would wait without a word.
pub fn open_pipe(path: &Path) -> io::Result<Option<File>> {
    if !metadata(path).is_ok_and(|file| file.file_type().is_fifo()) {
        return Ok(None);
    }
    let flags = OFlags::NONBLOCK.bits().cast_signed();
    match OpenOptions::new().write(true).custom_flags(flags).open(path) {
        Err(error) if error.raw_os_error() == Some(Errno::NXIO.raw_os_error()) => {
            let words = "it is a pipe that nobody reads: start its reader first";
            Err(io::Error::other(words))
        }
        pipe => pipe.map(Some),
    }
}
