//! What FlightGear is to show first.

use std::path::Path;

use anyhow::{Context, Result};
use chrono::{DateTime, Utc};
use engine::start::Start;

/// A moment of universal time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment(DateTime<Utc>);

impl Moment {
    /// From nanoseconds since 1970, as logs have it.
    pub fn of_unix_ns(text: &str) -> Option<Self> {
        Some(Self(DateTime::from_timestamp_nanos(text.parse().ok()?)))
    }

    /// `2020:06:21:21:00:00`, as FlightGear wants it.
    pub fn date(self) -> String {
        self.0.format("%Y:%m:%d:%H:%M:%S").to_string()
    }
}

/// What FlightGear is to show first.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Where, and in which wind.
    pub start: Option<Start>,
    /// When; at noon without.
    pub moment: Option<Moment>,
}

impl Scene {
    /// As a log begins.
    pub fn of_log(path: &Path) -> Result<Self> {
        let reader = logs::open(path, replay::OPEN)
            .with_context(|| format!("cannot read {}", path.display()))?;
        let mut start = aircraft::start("scenario.toml", &reader.setup.scenario_toml)?;
        start.origin = reader.initial.plant.origin;
        let began = &reader.identity;
        let began = Moment::of_unix_ns(began.get(logs::Identity::STARTED));
        Ok(Self { start: Some(start), moment: began })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_day_is_that_of_the_log() {
        let date = |text: &str| Moment::of_unix_ns(text).map(Moment::date);
        assert_eq!(date("0"), Some("1970:01:01:00:00:00".into()));
        assert_eq!(date("1592773261000000000"), Some("2020:06:21:21:01:01".into()));
        assert_eq!(date("unknown"), None);
    }
}
