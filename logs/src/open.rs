//! Opening a log: which records it has, whatever its form.

use std::path::Path;

use crate::LogError;
use crate::compact::{Expander, FlightModelOf};
use crate::container::{LogFile, RecordSource};

/// How a log is opened.
#[derive(Clone, Copy, Debug, Default)]
pub struct OpenOptions {
    /// Makes the aircraft that flies what a compacted log leaves out. Without it such a log is refused:
    /// [`LogError::Compacted`].
    pub aircraft_of: Option<FlightModelOf>,
    /// Whether a log of another version of the flight model is opened. Its messages become today's
    /// structs by the names of their fields; [`differences`](crate::FlightReader::differences) says which ones did not. The
    /// states of a compacted one are then not those that were flown, but where
    /// [`is_recorded`](crate::FlightReader::is_recorded).
    pub across_versions: bool,
}

/// The records of a log, whatever its form.
pub(crate) fn source(path: &Path, options: OpenOptions) -> Result<Box<dyn RecordSource>, LogError> {
    let file = LogFile::open(path)?;
    match (Expander::is_compacted(path)?, options.aircraft_of) {
        (false, _) => Ok(Box::new(file)),
        (true, None) => Err(LogError::Compacted),
        (true, Some(of)) => Ok(Box::new(Expander::new(file, of, options.across_versions))),
    }
}
