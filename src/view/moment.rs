//! Where the viewer opens, and what of two flights is laid beside each other.

use std::path::Path;
use std::str::FromStr;

use anyhow::{Context, Result, bail};
use engine::STEP_NS;
use logs::records::FlightEvent;
use logs::text::at;
use replay::Window;

use crate::window::When;

/// Where the viewer opens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// A time, a tick or a marker.
    When(When),
    /// The so-manieth event of the log, from 1.
    Event(u64),
    /// Where something is not the same.
    FirstDifference,
    /// The tick that was the latest to begin.
    Latest,
}

impl FromStr for At {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "--at {text}: expected seconds (12.5), ticks (3125t), marker:1, event:1, latest or first-difference"
            )
        };
        if text == "first-difference" {
            return Ok(Self::FirstDifference);
        }
        if text == "latest" {
            return Ok(Self::Latest);
        }
        match text.strip_prefix("event:") {
            Some(number) => match number.parse() {
                Ok(number) if number > 0 => Ok(Self::Event(number)),
                _ => Err(wrong()),
            },
            None => text.parse().map(Self::When).map_err(|_| wrong()),
        }
    }
}

/// Where the viewer opens, as far as that is known before anything is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// At a tick that is drawn.
    Tick(u64),
    /// Where something is not the same.
    FirstDifference,
}

impl At {
    /// Its place in what is drawn of the log, and beside it of another one that has it so many ticks later;
    /// refused when nothing is drawn there.
    pub fn place(self, log: &Path, window: &Window, beside: Option<(&Path, i64)>) -> Result<Place> {
        let tick = match self {
            Self::FirstDifference => return Ok(Place::FirstDifference),
            Self::When(when) => when.tick(log).with_context(|| log.display().to_string())?,
            Self::Event(number) => event(log, number)?,
            Self::Latest => latest(log)?.with_context(|| {
                format!("{}: --at latest: no tick of it waited for the clock", log.display())
            })?,
        };
        let (first, last) = drawn(log, window)?;
        if !(first..=last).contains(&tick) {
            bail!(
                "--at: {} is not drawn; of {} that is from {} to {}",
                at(tick),
                log.display(),
                at(first),
                at(last)
            );
        }
        if let Some((other, shift_ticks)) = beside {
            let (first, last) = drawn(other, &Window::default())?;
            let there = tick.checked_add_signed(shift_ticks);
            if !there.is_some_and(|there| (first..=last).contains(&there)) {
                let back = |tick: u64| at(tick.saturating_add_signed(shift_ticks.saturating_neg()));
                bail!(
                    "--at: {} is not in both; {} is laid beside it from {} to {}",
                    at(tick),
                    other.display(),
                    back(first),
                    back(last)
                );
            }
        }
        Ok(Place::Tick(tick))
    }
}

/// The tick of the so-manieth event.
fn event(log: &Path, number: u64) -> Result<u64> {
    let told = told(log)?;
    let place = usize::try_from(number - 1).unwrap_or(usize::MAX);
    match told.get(place) {
        Some((tick, _)) => Ok(*tick),
        None => bail!(
            "{}: no event {number}; there are {}: `tiltrotor log summary {0}` lists them",
            log.display(),
            told.len()
        ),
    }
}

/// The tick that was the latest to begin; `None` where none waited for the clock.
pub fn latest(log: &Path) -> Result<Option<u64>> {
    let name = || log.display().to_string();
    let mut reader = logs::open(log, replay::OPEN).with_context(name)?;
    reader.states_as_bytes = !reader.is_compacted();
    let (mut late_ns, mut latest) = (0, None);
    let mut goes_on = true;
    while goes_on {
        goes_on = matches!(reader.next_tick(), Ok(Some(_)));
        for timing in reader.timings.drain(..) {
            if timing.late_ns > late_ns {
                (late_ns, latest) = (timing.late_ns, Some(timing.tick));
            }
        }
    }
    Ok(latest)
}

/// First and last tick of what is drawn of a log.
fn drawn(log: &Path, window: &Window) -> Result<(u64, u64)> {
    let name = || log.display().to_string();
    let mut reader = logs::open(log, replay::OPEN).with_context(name)?;
    let first = reader.initial.tick;
    let last = match logs::closing(log) {
        Some((last, _)) => last,
        // Never closed: as far as it can be read.
        None => {
            reader.states_as_bytes = !reader.is_compacted();
            while let Ok(Some(_)) = reader.next_tick() {
                reader.timings.clear();
            }
            reader.last_tick()
        }
    };
    let (from, until) = (window.from_tick.unwrap_or(first), window.until_tick.unwrap_or(last));
    Ok((from.max(first), until.min(last)))
}

/// What of the other log is laid beside the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// The same time.
    Time,
    /// The start.
    Start,
    /// The first lift-off.
    LiftOff,
    /// A marker.
    Marker(u64),
}

impl FromStr for Align {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let marker = || text.strip_prefix("marker:")?.parse().ok().map(Self::Marker);
        match text {
            "time" => Ok(Self::Time),
            "start" => Ok(Self::Start),
            "lift-off" => Ok(Self::LiftOff),
            _ => marker().ok_or_else(|| {
                format!("--align {text}: expected time, start, lift-off or marker:1")
            }),
        }
    }
}

impl Align {
    /// So many ticks later in the other log than in the first it is.
    pub fn shift_ticks(self, log: &Path, other: &Path) -> Result<i64> {
        if self == Self::Time {
            return Ok(0);
        }
        let [first, second] = [log, other].map(|log| self.tick(log));
        let (first, second) = (first?, second?);
        if first != second {
            say!(
                "{} of {} is laid beside {} of {}",
                at(second),
                other.display(),
                at(first),
                log.display()
            );
        }
        Ok(i64::try_from(second)? - i64::try_from(first)?)
    }

    fn tick(self, log: &Path) -> Result<u64> {
        let name = || log.display().to_string();
        match self {
            Self::Time => Ok(0),
            Self::Start => Ok(logs::open(log, replay::OPEN).with_context(name)?.initial.tick),
            Self::Marker(number) => logs::marker(log, number).with_context(name),
            Self::LiftOff => {
                let lift_off = |(_, what): &&(u64, Option<FlightEvent>)| {
                    *what == Some(FlightEvent::WeightOnWheels)
                };
                let told = told(log)?;
                told.iter().find(lift_off).map(|(tick, _)| *tick).with_context(|| {
                    format!(
                        "{}: it never lifts off; --align start lays the starts beside each other",
                        log.display()
                    )
                })
            }
        }
    }
}

/// The ticks of everything that was told in a log, and of each lift-off what it is.
fn told(log: &Path) -> Result<Vec<(u64, Option<FlightEvent>)>> {
    let name = || log.display().to_string();
    let mut reader = logs::open(log, replay::OPEN).with_context(name)?;
    reader.states_as_bytes = !reader.is_compacted();
    // Up to damage there is something to be seen, too; what the log is, is said elsewhere.
    while let Ok(Some(_)) = reader.next_tick() {
        reader.timings.clear();
    }
    let known = reader.events.len() == reader.log_lines.len();
    let what = |place: usize| {
        let event = reader.events.get(place).filter(|_| known)?;
        let kind = FlightEvent::from_u64(event.kind)?;
        // Of weight on wheels the lift-offs only.
        (kind != FlightEvent::WeightOnWheels || event.value == 0).then_some(kind)
    };
    let told = reader.log_lines.iter().enumerate();
    Ok(told.map(|(place, line)| (line.time_ns / STEP_NS, what(place))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_to_open_at_is_a_time_a_marker_an_event_or_the_first_difference() {
        let read = |text: &str| text.parse::<At>().ok();
        assert_eq!(read("12.5"), Some(At::When(When::Tick(3125))));
        assert_eq!(read("marker:2"), Some(At::When(When::Marker(2))));
        assert_eq!(read("event:3"), Some(At::Event(3)));
        assert_eq!(read("first-difference"), Some(At::FirstDifference));
        assert_eq!(read("latest"), Some(At::Latest));
        for wrong in ["", "event:0", "event:", "event:-1", "lift-off", "-3"] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn flights_are_aligned_by_name() {
        assert_eq!("lift-off".parse(), Ok(Align::LiftOff));
        assert_eq!("marker:1".parse(), Ok(Align::Marker(1)));
        assert!("landing".parse::<Align>().is_err_and(|told| told.contains("lift-off")));
    }
}
