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

    #[test]
    fn every_option_names_a_part_and_none_is_the_whole() {
        let none = WindowArgs::default;
        let some = Some(When::Tick(0));
        assert!(none().is_whole());
        assert!(!WindowArgs { from: some, ..none() }.is_whole());
        assert!(!WindowArgs { until: some, ..none() }.is_whole());
        assert!(!WindowArgs { around: some, ..none() }.is_whole());
    }

    #[test]
    fn a_part_around_a_moment_has_as_much_before_it_as_after_it() {
        // Of ticks alone: no log is looked into. 10 s are 2500 ticks.
        let of = |from, until, around| {
            let tick = |tick: Option<u64>| tick.map(When::Tick);
            let (from, until, around) = (tick(from), tick(until), tick(around));
            WindowArgs { from, until, around, window: 10.0 }.of(Path::new("absent.mcap")).ok()
        };
        let part = |from_tick, until_tick, clamped| Some(Window { from_tick, until_tick, clamped });
        assert_eq!(of(None, None, Some(9000)), part(Some(6500), Some(11_500), true));
        assert_eq!(of(None, None, Some(1000)), part(Some(0), Some(3500), true));
        assert_eq!(of(Some(5), None, None), part(Some(5), None, false));
        assert_eq!(of(Some(5), Some(6), None), part(Some(5), Some(6), false));
        assert_eq!(of(Some(5), Some(5), None), None);
        assert_eq!(of(None, None, None), part(None, None, false));
    }
}
