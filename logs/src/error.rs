//! What can go wrong with a log.

use std::io;
use std::path::Path;

use crate::codec::fields;

/// What can go wrong with a log.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The file cannot be opened.
    #[error("cannot be read: {0}")]
    Open(io::Error),
    /// The file cannot be made.
    #[error("cannot write {path}: {error}")]
    Create {
        /// Which.
        path: String,
        /// Why.
        error: io::Error,
    },
    /// There is a file already.
    #[error("{path} exists; name another file, or overwrite it with --force")]
    Exists {
        /// Which.
        path: String,
    },
    /// The file is being written by a flight.
    #[error("{path} is being flown: its log is still being written; name another file")]
    InUse {
        /// Which.
        path: String,
    },
    /// The file would be written over what it is made from.
    #[error("{path} is {input}, from which it would be made; name another file")]
    Input {
        /// The file to be written.
        path: String,
        /// What is read for it.
        input: String,
    },
    /// The file is something else.
    #[error("not a flight log: {0}")]
    NotAFlight(String),
    /// Another version wrote it.
    #[error("the log's {what} is version {theirs}, this program's is {ours}")]
    Version {
        /// Of what.
        what: &'static str,
        /// Version in the log.
        theirs: String,
        /// Version here.
        ours: &'static str,
    },
    /// The file is short of its end.
    #[error(
        "it ends without having been closed; `tiltrotor log recover` makes a whole log of what there is"
    )]
    Truncated,
    /// Bytes that do not belong there.
    #[error("damaged: {0}")]
    Damaged(String),
    /// Messages that do not make a flight.
    #[error("the log's messages do not make a flight: {0}")]
    Order(String),
    /// Nothing to be recovered.
    #[error("there is nothing to recover: {0}")]
    NotRecoverable(String),
    /// A struct that has no form as a message.
    #[error("cannot encode: {0}")]
    Encode(String),
    /// Bytes that are not the message they should be.
    #[error("cannot decode a message: {0}")]
    Decode(String),
    /// A compacted log, where only the messages in the file are looked at.
    #[error("a compacted log; `tiltrotor log expand` makes the log of it that it was")]
    Compacted,
    /// A compacted log, or one to be compacted, whose messages have other fields than today's.
    #[error(
        "compacted, its states could not be flown again: its {topic} has not the fields of today; the log is of format \
         {format}, written by {program}, and this program's is {}; the program that wrote it compacts and expands it",
        crate::records::FORMAT_VERSION
    )]
    Layout {
        /// The first such channel.
        topic: &'static str,
        /// Format of the log.
        format: String,
        /// Who wrote it.
        program: String,
    },
    /// The files the flight was flown with.
    #[error("the log's {0}")]
    Setup(String),
    /// A log that cannot be compacted: its states could not be flown again.
    #[error(
        "not compacted: tick {tick} does not refly to the recorded bits; `tiltrotor verify` says more"
    )]
    NotReflown {
        /// The first such tick.
        tick: u64,
    },
    /// What was compacted does not come back.
    #[error("not compacted: expanded again, it is not the log that it was: {0}")]
    NotTheSame(&'static str),
    /// The tick is not in the log.
    #[error("{}", outside(*tick, *first, *last))]
    Outside {
        /// Wanted.
        tick: u64,
        /// First one there is.
        first: u64,
        /// Last one there is.
        last: u64,
    },
    /// The pilot did not press the marker so often.
    #[error("{}", no_marker(*number, found))]
    NoMarker {
        /// Wanted.
        number: u64,
        /// Number and tick of those that there are.
        found: Vec<(u64, u64)>,
    },
    /// MCAP's own errors.
    #[error("log file: {0}")]
    Mcap(mcap::McapError),
    /// Reading or writing.
    #[error("log file: {}", in_words(.0))]
    Io(io::Error),
    /// A type that is not recordable.
    #[error(transparent)]
    Fields(#[from] fields::NotRecordable),
}

/// What is said of a full disk names no file: it is never the one that is read.
fn in_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::StorageFull => format!("{error}: make room where the new file is written"),
        _ => error.to_string(),
    }
}

fn at(tick: u64) -> String {
    format!("tick {tick} ({:.3} s)", tick as f64 * engine::STEP_S)
}

fn outside(tick: u64, first: u64, last: u64) -> String {
    format!("{} is not in the log, which goes from {} to {}", at(tick), at(first), at(last))
}

fn no_marker(number: u64, found: &[(u64, u64)]) -> String {
    let known: Vec<_> =
        found.iter().map(|(number, tick)| format!("marker:{number} at {}", at(*tick))).collect();
    let known = if known.is_empty() { "no marker at all".into() } else { known.join(", ") };
    format!("no marker:{number} in the log; there is {known}")
}

// By hand: what is said in full is not to be said again as the source.
impl From<io::Error> for LogError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<mcap::McapError> for LogError {
    fn from(error: mcap::McapError) -> Self {
        match error {
            // MCAP's own words hide the system's: a full disk is to be called one.
            mcap::McapError::Io(error) => Self::Io(error),
            error => Self::Mcap(error),
        }
    }
}

impl LogError {
    pub(crate) fn create(path: &Path, error: io::Error) -> Self {
        let path = path.display().to_string();
        if error.kind() == io::ErrorKind::AlreadyExists {
            Self::Exists { path }
        } else {
            Self::Create { path, error }
        }
    }
}
