//! What everything that is drawn has in common: times, colours of the sides, numbers, what may go wrong.

use std::path::PathBuf;

use engine::pair::Pair;
use rerun::RecordingStreamError;
use rerun::external::re_log_encoding::rrd::EncodeError;
use rerun::sink::SinkFlushError;

use crate::judgement::{Judgement, Outcome};

/// Of this many ticks one is drawn: 50 Hz.
pub const TICKS_PER_ROW: u64 = 5;
/// Nanoseconds of the timeline that the viewer opens on.
pub const SIM_TIME: &str = "sim_time";

/// Left is red and right is green, as the navigation lights are.
pub const SIDES: Pair<u32> = Pair { left: 0xE0_4A_3F_FF, right: 0x3F_B9_5A_FF };

/// Why a flight could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The file could not be made, or did not take everything: disk full, or taken away.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// What rerun, or through it the system, says.
        source: EncodeError,
    },
    /// Rerun refused something.
    #[error("cannot draw the flight for {}: {source}", path.display())]
    Draw {
        /// Which file.
        path: PathBuf,
        /// What rerun says.
        source: Box<RecordingStreamError>,
    },
    /// Rerun stopped before everything was written.
    #[error("the recording {} is incomplete: {source}", path.display())]
    Flush {
        /// Which file.
        path: PathBuf,
        /// What rerun says.
        source: SinkFlushError,
    },
}

/// A number with so many decimals; what rounds to nothing has no sign.
pub fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_nothing = text.trim_start_matches(['-', '0', '.']).is_empty();
    if is_nothing { text.trim_start_matches('-').into() } else { text }
}

/// How much an event matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Good to know: a marker, a device that appeared.
    Info,
    /// Needs attention: a device gone, a model beyond its data.
    Warning,
    /// Something failed.
    Error,
}

impl Severity {
    /// As the viewer calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Info => rerun::TextLogLevel::INFO,
            Self::Warning => rerun::TextLogLevel::WARN,
            Self::Error => rerun::TextLogLevel::ERROR,
        }
    }
}

/// How much it matters what a log tells.
pub fn level(level: logs::view::Level) -> Severity {
    match level {
        logs::view::Level::Info => Severity::Info,
        logs::view::Level::Warn => Severity::Warning,
        logs::view::Level::Error => Severity::Error,
    }
}

/// How much it matters what a log is.
pub fn severity(judgement: &Judgement) -> Severity {
    match judgement.outcome {
        Outcome::Exact | Outcome::NotReflown => Severity::Info,
        Outcome::NeverClosed | Outcome::Compared => Severity::Warning,
        _ => Severity::Error,
    }
}
