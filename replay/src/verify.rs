//! Does a log refly to the same bits?

use std::fmt;
use std::path::Path;

use engine::STEP_S;
use engine::inputs::{DeviceEvent, EventKind};
use logs::fields::{Value, fields};
use logs::{Ending, Identity, LogError, Recovery};

use crate::refly::{Reflight, ReplayError};

/// What came out.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Ticks in the log.
    pub ticks: u64,
    /// Ticks that are the same to the bit, from the first on.
    pub exact: u64,
    /// The first difference.
    pub divergence: Option<Divergence>,
    /// First tick whose digest does not follow from what came before: the log was changed there.
    pub altered: Option<u64>,
    /// How the file ends.
    pub ending: Ending,
    /// Messages that do not make a flight, from which on nothing was compared.
    pub disorder: Option<String>,
    /// Digest of the last recorded tick.
    pub digest: u64,
    /// For a log that was recovered from a broken one: which, up to which tick, and why no further.
    pub recovered: Option<String>,
}

/// Where the reflown state is not the recorded one.
#[derive(Clone, Debug)]
pub struct Divergence {
    /// Tick.
    pub tick: u64,
    /// Field of the state that differs first, in the order of the state.
    pub path: String,
    /// As recorded.
    pub recorded: Value,
    /// As reflown.
    pub reflown: Value,
    /// How many other fields differ.
    pub others: usize,
    /// The last input before it, if there was one.
    pub last_input: Option<DeviceEvent>,
}

/// In one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The same to the last bit, and the log is whole.
    Exact,
    /// It is not the same, or the log was changed.
    Diverged,
    /// Bytes are damaged, or messages missing.
    Damaged,
    /// The same to the last bit, as far as the log goes: it was never closed.
    Incomplete,
}

impl Verdict {
    /// In one word.
    pub fn outcome(&self) -> Outcome {
        if self.divergence.is_some() || self.altered.is_some() {
            Outcome::Diverged
        } else if self.disorder.is_some() || matches!(self.ending, Ending::Damaged(_)) {
            Outcome::Damaged
        } else if self.ending == Ending::Truncated {
            Outcome::Incomplete
        } else {
            Outcome::Exact
        }
    }
}

/// Reflies a log and compares every bit of every state.
///
/// # Errors
/// When it is not a flight log, or of another version, or its files cannot be read.
pub fn verify(path: &Path, mut progress: impl FnMut(u64)) -> Result<Verdict, ReplayError> {
    let mut flight = Reflight::open(path)?;
    let mut verdict = Verdict {
        ticks: 0,
        exact: 0,
        divergence: None,
        altered: (!flight.reader.intact).then_some(0),
        ending: Ending::Truncated,
        disorder: None,
        digest: 0,
        recovered: recovered(&flight.reader.identity),
    };
    let mut last_input = None;
    loop {
        // After the first difference the rest is only counted.
        let step = if verdict.divergence.is_none() {
            flight.next_tick().map(|reflown| reflown.map(|tick| (tick.recorded, tick.exact)))
        } else {
            let tick = flight.reader.next_tick().map_err(ReplayError::from);
            tick.map(|tick| tick.map(|tick| (tick, false)))
        };
        let (tick, exact) = match step {
            Ok(Some(tick)) => tick,
            Ok(None) => break,
            Err(ReplayError::Log(error @ (LogError::Order(_) | LogError::Decode(_)))) => {
                verdict.disorder = Some(error.to_string());
                break;
            }
            Err(error) => return Err(error),
        };
        verdict.ticks += 1;
        verdict.digest = tick.record.digest;
        if !tick.chained && verdict.altered.is_none() {
            verdict.altered = Some(tick.record.state.tick);
        }
        last_input = tick.events.last().copied().or(last_input);
        if exact {
            verdict.exact += 1;
        } else if verdict.divergence.is_none() {
            let recorded = fields(&tick.record.state).map_err(LogError::from)?;
            let reflown = fields(&flight.state).map_err(LogError::from)?;
            verdict.divergence =
                divergence(tick.record.state.tick, &recorded, &reflown, last_input);
        }
        flight.reader.forget();
        progress(verdict.ticks);
    }
    verdict.ending = flight.ending();
    Ok(verdict)
}

fn recovered(identity: &Identity) -> Option<String> {
    let parent = identity.0.get(Recovery::PARENT)?;
    let (tick, reason) = (identity.get(Recovery::TICK), identity.get(Recovery::REASON));
    Some(format!("it was recovered from {parent} up to tick {tick}, because {reason}"))
}

fn divergence(
    tick: u64,
    recorded: &[logs::fields::Field],
    reflown: &[logs::fields::Field],
    last_input: Option<DeviceEvent>,
) -> Option<Divergence> {
    let mut differing = recorded
        .iter()
        .zip(reflown)
        .filter(|(recorded, reflown)| recorded.value.bits() != reflown.value.bits());
    let (recorded, reflown) = differing.next()?;
    Some(Divergence {
        tick,
        path: recorded.path.clone(),
        recorded: recorded.value,
        reflown: reflown.value,
        others: differing.count(),
        last_input,
    })
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = |tick: u64| format!("tick {tick} ({:.3} s)", tick as f64 * STEP_S);
        match self.outcome() {
            Outcome::Exact => {
                write!(
                    f,
                    "exact: all {} ticks ({:.1} s), digest {:016x}",
                    self.ticks,
                    self.ticks as f64 * STEP_S,
                    self.digest
                )?;
            }
            Outcome::Incomplete if self.recovered.is_some() => {
                write!(f, "exact up to {}, as far as it goes", time(self.exact))?;
            }
            Outcome::Incomplete => {
                write!(
                    f,
                    "exact up to {}, where the log ends without having been closed: the flight was \
                     killed or the file was cut, and what came after is lost",
                    time(self.exact)
                )?;
            }
            Outcome::Damaged | Outcome::Diverged => {
                let more = if self.ending == Ending::Closed { "" } else { " or more" };
                write!(f, "exact up to tick {} of {}{more}", self.exact, self.ticks)?;
            }
        }
        if let Some(recovered) = &self.recovered {
            write!(f, "\n{recovered}")?;
        }
        if let Some(divergence) = &self.divergence {
            write!(f, "\n{divergence}")?;
        }
        match self.altered {
            Some(0) => write!(
                f,
                "\nthe log was changed after the flight: its aircraft, cockpit map, scenario or \
                 first state is not what it was flown with"
            )?,
            Some(tick) => write!(
                f,
                "\nthe log was changed after the flight: the digest breaks at {}",
                time(tick)
            )?,
            None => {}
        }
        if let Some(disorder) = &self.disorder {
            write!(f, "\n{disorder}")?;
        }
        if let Ending::Damaged(why) = &self.ending {
            write!(f, "\nthe file is damaged after {}: {why}", time(self.ticks))?;
        }
        Ok(())
    }
}

impl fmt::Display for Divergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "first difference: tick {} ({:.3} s)", self.tick, self.tick as f64 * STEP_S)?;
        writeln!(f, "  field     {}", self.path)?;
        for (name, value) in [("recorded", self.recorded), ("reflown", self.reflown)] {
            writeln!(f, "  {name:<9} {value}  (0x{:016x})", value.bits())?;
        }
        let ulps = self.recorded.ulps_to(self.reflown);
        writeln!(f, "  apart     {} ULP", ulps.map_or("?".into(), |ulps| ulps.to_string()))?;
        writeln!(f, "  others    {} more fields differ at this tick", self.others)?;
        match self.last_input {
            None => write!(f, "  last input: none before it"),
            Some(input) => {
                let kind = match EventKind::from_u64(input.kind) {
                    Some(EventKind::Axis) => "axis",
                    Some(EventKind::Button) => "button",
                    Some(EventKind::Connected) => "connected",
                    Some(EventKind::Disconnected) => "disconnected",
                    None => "event",
                };
                write!(
                    f,
                    "  last input: device {} {kind} 0x{:x} = {}, for tick {} ({:.3} s)",
                    input.device,
                    input.code,
                    input.value,
                    input.tick.saturating_add(1),
                    input.tick.saturating_add(1) as f64 * STEP_S
                )
            }
        }
    }
}
