//! Systems that are no Unix: two signals, and no pipe that has a place among the files.

use std::fs::File;
use std::io;
use std::path::Path;

use signal_hook::consts::{SIGINT, SIGTERM};

/// Signals that end a flight in an orderly way, and what they are called.
pub(crate) const ENDING: &[(i32, &str)] = &[(SIGINT, "SIGINT"), (SIGTERM, "SIGTERM")];

/// Whether the process was told to ignore a signal: no system but Unix has that.
pub(crate) fn is_ignored(_: i32) -> bool {
    false
}

/// Opens a named pipe that the log goes into: there are none here.
///
/// # Errors
/// None.
pub fn open_pipe(_: &Path) -> io::Result<Option<File>> {
    Ok(None)
}
