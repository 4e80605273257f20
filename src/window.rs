//! Which part of a flight: `--from`, `--until`, `--around`.

use std::path::Path;
use std::str::FromStr;

use anyhow::{Result, bail};
use engine::STEP_S;
use replay::Window;

/// The part of the flight that is meant.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct WindowArgs {
    /// Begin there: a time in s (12.5), a tick (3125t), or a marker (marker:1)
    #[arg(long, value_name = "WHEN", allow_hyphen_values = true)]
    pub from: Option<When>,
    /// End there
    #[arg(long, value_name = "WHEN", allow_hyphen_values = true)]
    until: Option<When>,
    /// Only the part around this moment: --window seconds before it and after it
    #[arg(long, value_name = "WHEN", allow_hyphen_values = true, conflicts_with_all = ["from", "until"])]
    around: Option<When>,
    /// With --around: so many seconds before, and as many after
    #[arg(long, value_name = "SECONDS", requires = "around", default_value_t = 10.0)]
    #[arg(value_parser = crate::numbers::duration_s, allow_negative_numbers = true)]
    window: f64,
}

/// A time of a flight: simulated, a tick, or a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// After so many ticks.
    Tick(u64),
    /// When the pilot pressed the marker for the so-manieth time.
    Marker(u64),
}

impl FromStr for When {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}`: expected seconds (12.5), ticks (3125t) or marker:1");
        if let Some(number) = text.strip_prefix("marker:") {
            return number.parse().map(Self::Marker).map_err(|_| wrong());
        }
        if let Some(tick) = text.strip_suffix('t') {
            return tick.parse().map(Self::Tick).map_err(|_| wrong());
        }
        let seconds: f64 = text.trim_end_matches('s').parse().map_err(|_| wrong())?;
        ticks(seconds).map(Self::Tick).ok_or_else(wrong)
    }
}

/// The tick nearest to a time.
fn ticks(seconds: f64) -> Option<u64> {
    let ticks = (seconds / STEP_S).round();
    (ticks.is_finite() && (0.0..=1e15).contains(&ticks)).then_some(ticks as u64)
}

impl When {
    /// Its tick.
    pub fn tick(self, log: &Path) -> Result<u64> {
        match self {
            Self::Tick(tick) => Ok(tick),
            Self::Marker(number) => Ok(logs::marker(log, number)?),
        }
    }
}

impl WindowArgs {
    /// Whether no part is named.
    pub fn is_whole(&self) -> bool {
        self.from.is_none() && self.until.is_none() && self.around.is_none()
    }

    /// The window in that log.
    pub fn of(&self, log: &Path) -> Result<Window> {
        let tick = |moment: Option<When>| moment.map(|moment| moment.tick(log)).transpose();
        if let Some(around) = tick(self.around)? {
            let Some(room) = ticks(self.window) else { bail!("--window {}", self.window) };
            return Ok(Window {
                from_tick: Some(around.saturating_sub(room)),
                until_tick: Some(around.saturating_add(room)),
                clamped: true,
            });
        }
        let (from_tick, until_tick) = (tick(self.from)?, tick(self.until)?);
        if let (Some(from), Some(until)) = (from_tick, until_tick)
            && until <= from
        {
            bail!("--until tick {until} is not after --from tick {from}");
        }
        Ok(Window { from_tick, until_tick, clamped: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_is_a_time_a_tick_or_a_marker() {
        let moment = |text: &str| text.parse::<When>().ok();
        assert_eq!(moment("12.5"), Some(When::Tick(3125)));
        assert_eq!(moment("12.5s"), Some(When::Tick(3125)));
        assert_eq!(moment("3125t"), Some(When::Tick(3125)));
        assert_eq!(moment("marker:2"), Some(When::Marker(2)));
        for wrong in
            ["", "-1", "t", "1.5t", "marker", "marker:", "marker:-1", "nan", "inf", "1e300"]
        {
            assert_eq!(moment(wrong), None, "{wrong}");
        }
    }
}
