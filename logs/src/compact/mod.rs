//! Compacted logs: inputs, keyframes and digests kept, states dropped, because the engine can fly
//! them again.
//!
//! A compacted log is an MCAP file, too. Keyframes are on `/state`, events and their words where they
//! always are, so that viewers still show a flight; the rest is in blocks on `/compact`. It says
//! the order of all messages and where the writer closed its chunks: expanded, it is the file that was
//! compacted, byte for byte, and it says so only if the file's hash is the one that was kept.
//!
//! Readers take a compacted log for the log it was: `Expander` flies the states again while it is
//! read. Between keyframes a digest that was recorded meets a state that was flown again, and the
//! digest chain tells whether they belong together.

mod ahead;
mod block;
mod columns;
mod definitions;
mod expand;
mod files;
mod pack;
mod proof;
mod regenerator;
mod source;

pub use expand::expand;
pub use pack::compact;
pub(crate) use regenerator::Regenerator;
pub use regenerator::{FlightModel, FlightModelOf};
pub(crate) use source::Expander;

use crate::setup::COMPACT_HEAD as HEAD;

/// Name of the metadata record that ends it.
const TAIL: &str = "tiltrotor_compacted";
/// Version of the form.
const VERSION: &str = "2";
/// The forms that are read. 1 kept no digests of the outputs.
const VERSIONS_READ: [&str; 2] = ["1", VERSION];
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

#[cfg(test)]
mod tests;
