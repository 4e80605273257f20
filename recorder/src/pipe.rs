//! A log that goes into a named pipe.

use std::fs::{File, OpenOptions, metadata};
use std::io;
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;

use rustix::fs::OFlags;

/// Takes a named pipe, which is to be kept until its log is closed; `None` when the path is none.
///
/// # Errors
/// When nobody reads it: whoever opened it then would wait without a word.
pub fn take(path: &Path) -> io::Result<Option<File>> {
    if !metadata(path).is_ok_and(|file| file.file_type().is_fifo()) {
        return Ok(None);
    }
    // A second opening would wait for a reader; with this one kept, the reader sees no end between the two.
    let flags = OFlags::NONBLOCK.bits().cast_signed();
    match OpenOptions::new().write(true).custom_flags(flags).open(path) {
        Err(error) if error.raw_os_error() == Some(rustix::io::Errno::NXIO.raw_os_error()) => {
            let words = "it is a pipe that nobody reads: start its reader first";
            Err(io::Error::other(words))
        }
        pipe => pipe.map(Some),
    }
}
