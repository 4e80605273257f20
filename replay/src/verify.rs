//! Does a log refly to the same bits?

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use engine::{Aircraft, Inputs, Outputs, STEP_S, State, step};
use logs::{Ending, Identity, LogError, Recovery, Tick, cdr};

use crate::compare::Names;
use crate::divergence::{Divergence, LastInput, Parted, SingleSteps, when};
use crate::growth::WINDOW_TICKS;
use crate::refly::{Reflight, ReflyOptions, ReplayError, Window};
use crate::versions::Versions;

/// How to verify.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Ticks that are still reflown after the first difference, to see how it grows.
    pub growth_ticks: u64,
    /// The part of the log that is reflown.
    pub window: Window,
    /// Fly logs of other versions of the flight model as well, as a comparison.
    pub across_versions: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { growth_ticks: WINDOW_TICKS, window: Window::default(), across_versions: false }
    }
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The tick that the log begins with: ticks are counted from there.
    pub start_tick: u64,
    /// Ticks in the log.
    pub ticks: u64,
    /// Ticks that are the same to the bit, from the first on.
    pub exact: u64,
    /// The first difference.
    pub divergence: Option<Box<Divergence>>,
    /// First tick whose digest does not follow from what came before: the log was changed there.
    pub altered: Option<u64>,
    /// How the file ends.
    pub ending: Ending,
    /// Messages that do not make a flight, from which on nothing was compared.
    pub disorder: Option<String>,
    /// Digest of the last recorded tick.
    pub digest: u64,
    /// It ends where the window does, not where the log does.
    pub windowed: bool,
    /// The log is compacted: of most ticks, only the digest was kept.
    pub compacted: bool,
    /// What stands between the log's version and this one; `None` when nothing does.
    pub versions: Option<Box<Versions>>,
    /// For a log that was recovered from a broken one: which, up to which tick, and why no further.
    pub recovered: Option<String>,
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
    /// Flown by another version than recorded, or not comparable in every field: never exact.
    Compared,
}

impl Outcome {
    /// As it stands in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Diverged => "diverged",
            Self::Damaged => "damaged",
            Self::Incomplete => "incomplete",
            Self::Compared => "compared",
        }
    }
}

impl Verdict {
    /// In one word.
    pub fn outcome(&self) -> Outcome {
        let comparison = self.versions.as_ref().is_some_and(|versions| versions.comparison());
        if comparison && self.altered.is_none() && self.readable() {
            Outcome::Compared
        } else if self.divergence.is_some() || self.altered.is_some() {
            Outcome::Diverged
        } else if self.disorder.is_some() || matches!(self.ending, Ending::Damaged(_)) {
            Outcome::Damaged
        } else if self.ending == Ending::Truncated {
            Outcome::Incomplete
        } else {
            Outcome::Exact
        }
    }

    fn readable(&self) -> bool {
        self.disorder.is_none() && !matches!(self.ending, Ending::Damaged(_))
    }

    /// The last tick that is the same.
    pub fn exact_tick(&self) -> u64 {
        self.start_tick.saturating_add(self.exact)
    }

    /// The last tick of the log.
    pub fn last_tick(&self) -> u64 {
        self.start_tick.saturating_add(self.ticks)
    }

    /// Why it is exact up to there and no further, as a word for programs and in words for people.
    pub fn stopped(&self) -> (&'static str, String) {
        if let Some(divergence) = &self.divergence {
            let field = &divergence.path;
            return ("diverged", format!("the reflown {field} is not the recorded one"));
        }
        if let Some(disorder) = &self.disorder {
            return ("disorder", disorder.clone());
        }
        match (&self.ending, &self.recovered) {
            (Ending::Damaged(why), _) => ("damaged", format!("the file is damaged: {why}")),
            (Ending::Truncated, Some(recovered)) => ("recovered", recovered.clone()),
            (Ending::Truncated, None) => (
                "never_closed",
                "the log ends without having been closed: the flight was killed or the file was \
                 cut, and what came after is lost"
                    .into(),
            ),
            (Ending::Closed, _) if self.windowed => {
                ("window", "there the part ends that was asked for".into())
            }
            (Ending::Closed, _) => ("closed", "the log ends as its writer closed it".into()),
        }
    }
}

/// Reflies a log and compares every bit of every state.
///
/// After the first difference the reflight goes on for a while, by the recorded inputs, to see what
/// becomes of it; the rest of the log is only counted.
///
/// # Errors
/// When it is not a flight log, or of another version, or its files cannot be read.
pub fn verify(
    path: &Path,
    options: &Options,
    mut progress: impl FnMut(u64),
) -> Result<Verdict, ReplayError> {
    let Options { window, across_versions, .. } = *options;
    let mut flight = Reflight::open(path, &ReflyOptions { window, across_versions })?;
    let mut verdict = Verdict {
        start_tick: flight.state.tick,
        ticks: 0,
        exact: 0,
        divergence: None,
        altered: (!flight.reader.intact).then_some(flight.state.tick),
        ending: Ending::Truncated,
        disorder: None,
        digest: 0,
        windowed: false,
        compacted: flight.reader.is_compacted(),
        versions: None,
        recovered: recovered(&flight.reader.identity),
    };
    let mut last_input = LastInput::new()?;
    let mut watch = Watch::new()?;
    flight.reader.keep_outputs = true;
    let mut before = flight.state;
    loop {
        let watched = verdict
            .divergence
            .as_ref()
            .is_none_or(|divergence| verdict.last_tick() - divergence.tick < options.growth_ticks);
        let next = if watched {
            flight.next_tick().map(|next| next.map(|next| Some(next.exact)))
        } else {
            let next = flight.reader.next_tick().map_err(ReplayError::from);
            next.map(|next| next.map(|_| None))
        };
        let exact = match next {
            Ok(Some(next)) => next,
            Ok(None) => break,
            Err(ReplayError::Log(error @ (LogError::Order(_) | LogError::Decode(_)))) => {
                verdict.disorder = Some(error.to_string());
                break;
            }
            Err(error) => return Err(error),
        };
        let recorded = &flight.reader.tick;
        verdict.ticks += 1;
        verdict.digest = recorded.record.digest;
        let tick = verdict.last_tick();
        if !recorded.chained && verdict.altered.is_none() {
            verdict.altered = Some(tick);
        }
        let parted = Parted { tick, recorded: &recorded.state_message, reflown: flight.message() };
        match (&mut verdict.divergence, exact) {
            (None, Some(exact)) => {
                last_input.add(&recorded.events, &recorded.inputs)?;
                if exact {
                    verdict.exact += 1;
                } else {
                    let input = last_input.told(&flight.aircraft.cockpit);
                    verdict.divergence =
                        Divergence::new(&watch.states, &parted, input)?.map(Box::new);
                }
            }
            (Some(divergence), Some(_)) => {
                divergence.growth.add(tick, parted.recorded, parted.reflown);
            }
            (_, None) => {}
        }
        if let Some(divergence) = &mut verdict.divergence {
            if exact.is_some() {
                watch.step(&flight.aircraft, &before, recorded, &mut divergence.single)?;
            }
            watch.outputs(&flight.reader.outputs, &mut divergence.single)?;
        }
        // What blocks gave stands some way behind the states in the file, or before them.
        flight.reader.outputs.retain(|outputs| outputs.tick > tick);
        before = recorded.record.state;
        flight.reader.forget();
        progress(verdict.ticks);
    }
    if let Some(divergence) = &mut verdict.divergence {
        watch.outputs(&flight.reader.outputs, &mut divergence.single)?;
    }
    verdict.ending = flight.ending();
    verdict.windowed = options.window.until_tick.is_some_and(|until| verdict.last_tick() >= until);
    verdict.versions = Versions::of(&flight).map(Box::new);
    Ok(verdict)
}

fn recovered(identity: &Identity) -> Option<String> {
    let parent = identity.0.get(Recovery::PARENT)?;
    let (tick, reason) = (identity.get(Recovery::TICK), identity.get(Recovery::REASON));
    Some(format!("it was recovered from {parent} up to tick {tick}, because {reason}"))
}

/// Single steps from the recorded states.
struct Watch {
    states: Names,
    blocks: Names,
    /// What they gave, until it is found in the log.
    outputs: BTreeMap<u64, Outputs>,
}

impl Watch {
    fn new() -> Result<Self, LogError> {
        Ok(Self {
            states: Names::of::<State>()?,
            blocks: Names::of::<Outputs>()?,
            outputs: BTreeMap::new(),
        })
    }

    fn step(
        &mut self,
        aircraft: &Aircraft,
        before: &State,
        recorded: &Tick,
        single: &mut SingleSteps,
    ) -> Result<(), LogError> {
        let inputs = Inputs { events: &recorded.events, world: recorded.inputs.world };
        let (stepped, outputs) = step(aircraft, before, &inputs);
        if single.block.is_none() {
            self.outputs.insert(outputs.tick, outputs);
        }
        single.add(&self.states, &recorded.state_message, &cdr::encode(&stepped)?);
        Ok(())
    }

    fn outputs(&mut self, recorded: &[Outputs], single: &mut SingleSteps) -> Result<(), LogError> {
        for recorded in recorded {
            if let Some(stepped) = self.outputs.remove(&recorded.tick)
                && single.block.is_none()
            {
                let (recorded, of_step) = (cdr::encode(recorded)?, cdr::encode(&stepped)?);
                single.add_outputs(&self.blocks, stepped.tick, &recorded, &of_step);
            }
        }
        Ok(())
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.outcome() == Outcome::Exact {
            writeln!(
                f,
                "exact: all {} ticks ({:.1} s){}, digest {:016x}",
                self.ticks,
                self.ticks as f64 * STEP_S,
                match self.start_tick {
                    0 => String::new(),
                    tick => format!(" from {} on", when(tick)),
                },
                self.digest
            )?;
        }
        if let Some(versions) = &self.versions {
            writeln!(f, "{versions}")?;
        }
        let more = if self.ending == Ending::Closed { "" } else { " or more" };
        let (exact, last) = (self.exact_tick(), self.last_tick());
        let (stopped, why) = self.stopped();
        let same = match self.outcome() {
            Outcome::Compared => "the same in every field that both know",
            _ => "exact",
        };
        write!(f, "{same} up to tick {exact} of {last}{more} ({:.3} s): {why}", time_s(exact))?;
        if let Some(recovered) = self.recovered.as_ref().filter(|_| stopped != "recovered") {
            write!(f, "\n{recovered}")?;
        }
        if let Some(divergence) = &self.divergence {
            write!(f, "\n{divergence}")?;
        }
        match self.altered {
            Some(tick) if tick == self.start_tick => write!(
                f,
                "\nthe log was changed after the flight: its aircraft, cockpit map, scenario or \
                 first state is not what it was flown with"
            )?,
            Some(tick) if self.compacted => write!(
                f,
                "\nat {} the state, which a compacted log does not keep, has not the digest that was \
                 kept: this program flies otherwise, or the log was changed after the flight",
                when(tick)
            )?,
            Some(tick) => write!(
                f,
                "\nthe log was changed after the flight: the digest breaks at {}",
                when(tick)
            )?,
            None => {}
        }
        // Whatever stopped it first is told above.
        if let (Some(_), Some(disorder)) = (&self.divergence, &self.disorder) {
            write!(f, "\n{disorder}")?;
        }
        if let Ending::Damaged(why) = &self.ending
            && (self.divergence.is_some() || self.disorder.is_some())
        {
            write!(f, "\nthe file is damaged after {}: {why}", when(last))?;
        }
        Ok(())
    }
}

fn time_s(tick: u64) -> f64 {
    tick as f64 * STEP_S
}
