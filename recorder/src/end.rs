//! Why a flight ended.

use crate::controller::GaveUp;

/// Why a flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The pilot model or the script has ended.
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
            Self::Done => f.write_str("end of the flight: the pilot model or script has ended"),
            Self::TimeUp => f.write_str("end of the flight: the time given is over"),
            Self::Stopped(None) => f.write_str("ended by the crew"),
            Self::Stopped(Some(signal)) => write!(f, "ended by a signal: {signal}"),
            Self::GaveUp(gave_up) => write!(f, "end of the flight: {gave_up}"),
        }
    }
}
