//! What is known of a flight when it is over.

use engine::Outputs;
use logs::{Closed, LogError};

use crate::hands::GaveUp;
use crate::self_check::Checked;
use crate::statistics::Statistics;
use crate::writer::Delay;

/// Why a flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The hands are done.
    Done,
    /// It was to last no longer.
    TimeUp,
    /// Someone ended it, by this signal if by one.
    Stopped(Option<&'static str>),
    /// A pilot model gave up.
    GaveUp(GaveUp),
}

impl End {
    /// Its number in the log.
    pub(crate) fn number(&self) -> u64 {
        match self {
            Self::Done | Self::TimeUp => 0,
            Self::Stopped(None) => 1,
            Self::Stopped(Some(_)) => 2,
            Self::GaveUp(_) => 3,
        }
    }
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Done => f.write_str("end of the flight: the hands are done"),
            Self::TimeUp => f.write_str("end of the flight: the time given is over"),
            Self::Stopped(None) => f.write_str("ended by the crew"),
            Self::Stopped(Some(signal)) => write!(f, "ended by {signal}"),
            Self::GaveUp(gave_up) => write!(f, "end of the flight: {gave_up}"),
        }
    }
}

/// How a flight ended.
#[derive(Debug)]
pub struct Landing {
    /// How it kept time.
    pub statistics: Statistics,
    /// The log, or why it ends early.
    pub log: Result<Closed, LogError>,
    /// What the aircraft was like at the end.
    pub outputs: Outputs,
    /// Device events taken.
    pub events: u64,
    /// Pictures sent to FlightGear.
    pub sent: u64,
    /// Pictures that could not be sent.
    pub unsent: u64,
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
