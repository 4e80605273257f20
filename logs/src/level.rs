//! How grave an event is.

/// Severity of a `/log` message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Level {
    /// As it should be.
    Info = 20,
    /// The crew should know.
    Warn = 30,
    /// Something is wrong.
    Error = 40,
}
