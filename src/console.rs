//! Standard output: an output like others.
//!
//! Whoever closes the pipe early, as `head` does, has seen enough: no more is written, and that is no
//! error. Any other error is kept, and ends the command with a status of its own.

use std::fmt;
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

/// Prints a line on standard output.
macro_rules! say {
    ($($what:tt)*) => { $crate::console::line(format_args!($($what)*)) };
}

/// Prints a line for the eye only, on standard error.
macro_rules! complain {
    ($($what:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), $($what)*);
    }};
}

/// The first error; nothing is written after it.
static FIRST_ERROR: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints a line.
pub fn line(words: fmt::Arguments<'_>) {
    // What went wrong is kept.
    let _ = writeln!(Stdout, "{words}");
}

/// Standard output, as a writer that remembers what went wrong.
pub struct Stdout;

impl Write for Stdout {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        unless_failed(|| io::stdout().write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        unless_failed(|| io::stdout().flush())
    }
}

fn unless_failed<T>(write: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
    let mut first = FIRST_ERROR.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(error) = &*first {
        return Err(error.kind().into());
    }
    write().map_err(|error| {
        let kind = error.kind();
        // To be tried again, as `write_all` does.
        if kind != io::ErrorKind::Interrupted {
            *first = Some(error);
        }
        kind.into()
    })
}

/// Whether nothing more can be written.
#[cfg(feature = "sticks")]
pub fn has_failed() -> bool {
    FIRST_ERROR.lock().unwrap_or_else(PoisonError::into_inner).is_some()
}

/// Writes what is held back.
///
/// # Errors
/// The first error there was, but for a pipe that was closed.
pub fn finish() -> io::Result<()> {
    let _ = Stdout.flush();
    match FIRST_ERROR.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

#[cfg(all(test, feature = "sticks"))]
mod tests {
    use super::*;

    fn failed_with(kind: io::ErrorKind) -> io::Result<()> {
        unless_failed(|| Err(kind.into()))
    }

    /// One test: what went wrong is known to the whole program.
    #[test]
    fn after_the_first_error_nothing_is_written_and_only_a_closed_pipe_is_none() {
        assert!(!has_failed());
        // A signal came: it is tried again.
        assert!(failed_with(io::ErrorKind::Interrupted).is_err());
        assert!(!has_failed());

        assert!(failed_with(io::ErrorKind::StorageFull).is_err());
        assert!(has_failed());
        let after = unless_failed(|| -> io::Result<()> { panic!("nothing more is written") });
        assert_eq!(after.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(finish().unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert!(!has_failed(), "it was told");

        assert!(failed_with(io::ErrorKind::BrokenPipe).is_err());
        assert!(has_failed());
        assert!(finish().is_ok());
    }
}
