//! What is known of a flight when it is over.

use std::path::PathBuf;

use engine::Outputs;
use flightgear::{Hold, Sent};
use logs::{Closed, LogError};

use crate::debrief::Debrief;
use crate::end::End;
use crate::self_check::Checked;
use crate::statistics::Statistics;
use crate::writer::Delay;

/// How a flight ended.
#[derive(Debug)]
pub struct Landing {
    /// How it kept time.
    pub statistics: Statistics,
    /// What the pilot hears of it.
    pub debrief: Debrief,
    /// The log, or why it ends early.
    pub log: Result<Closed, LogError>,
    /// An older log of the same name, when this one could not take its place.
    pub set_aside: Option<PathBuf>,
    /// What the aircraft was like at the end.
    pub outputs: Outputs,
    /// Device events taken.
    pub events: u64,
    /// Pictures sent to each FlightGear.
    pub pictures: Vec<Sent>,
    /// Goes on sending the last one, until it is stopped or dropped; `None` when there is no FlightGear,
    /// or nobody listens.
    pub hold: Option<Hold>,
    /// Most entries that ever waited for the writer.
    pub backlog_max: usize,
    /// How the writer was held up.
    pub delay: Delay,
    /// What the self-check found, if there was one.
    pub checked: Option<Checked>,
    /// What the system did not grant.
    pub refused: Vec<String>,
    /// Why it ended.
    pub end: End,
}
