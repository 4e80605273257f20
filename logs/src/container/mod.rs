//! The container: an MCAP file as records, each checked before it is handed out. Nothing else drives
//! mcap's readers.

pub(crate) mod checksums;
mod file;
mod index;
mod record;

pub(crate) use file::LogFile;
pub(crate) use index::Index;
pub use record::time_ns;
pub(crate) use record::{RECORD_BYTES_MAX, Record, Schema, stamped};

use engine::{Outputs, State};

use crate::LogError;

/// The records of a flight log, one after another, whatever form its file has.
pub(crate) trait RecordSource: Send {
    /// Reads the next record into `record`, whose room is used again; `false` at the end of a whole
    /// file.
    ///
    /// # Errors
    /// [`LogError::Truncated`] and [`LogError::Damaged`] say how the file ends,
    /// [`LogError::NotAFlight`] that it is something else; any other error is of a file that is not for
    /// this program.
    fn next(&mut self, record: &mut Record) -> Result<bool, LogError>;

    /// Goes where the state of a tick is not far ahead, if the file's index says where.
    ///
    /// # Errors
    /// When the file cannot be read.
    fn seek(&mut self, tick: u64) -> Result<(), LogError>;

    /// Nobody looks at the outputs of a compacted log's ticks but where they are made again: its states are
    /// flown on so many threads beside the one that reads.
    fn fly_states_only(&mut self, _threads: usize) {}

    /// How the last state came about, if the file is compacted.
    fn compacted(&self) -> Option<Compacted<'_>> {
        None
    }
}

/// Nothing at all: of a reader before it has its source.
impl RecordSource for std::io::Empty {
    fn next(&mut self, _: &mut Record) -> Result<bool, LogError> {
        Ok(false)
    }

    fn seek(&mut self, _: u64) -> Result<(), LogError> {
        Ok(())
    }
}

impl Default for Box<dyn RecordSource> {
    fn default() -> Self {
        Box::new(std::io::empty())
    }
}

/// The last state of a compacted log.
pub(crate) struct Compacted<'a> {
    /// Whether it is as it was recorded, not flown again.
    pub recorded: bool,
    /// The last tick as it was flown again; its outputs are of an earlier tick where nobody looks at them.
    pub flown: Option<(&'a State, &'a Outputs)>,
    /// The first tick whose outputs, computed again, have not the digest that was kept.
    pub outputs_differ: Option<u64>,
}
