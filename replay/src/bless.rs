//! Golden flights after a deliberate change of the model: flown anew, and what moved.

use std::fmt;
use std::path::Path;

use engine::math::{max, sqrt};
use engine::{STEP_S, State};
use logs::devices::DeviceIdentity;
use logs::fields::Value;
use logs::output::Output;
use logs::text::at;
use logs::{Ending, FlightReader, Identity, LogError, OpenOptions, Setup, cdr};

use crate::compare::Names;
use crate::judgement::{Judgement, Outcome};
use crate::made::proven;
use crate::outputs::{OutputsCheck, OutputsDifference, are_todays};
use crate::refly::{OPEN, ReplayError, flown, read};
use crate::rewrite::{NewLog, parent, rewrite};
use crate::source::Source;
use crate::summary::{Gathered, Touchdown};

/// Ticks between the keyframes of a compacted golden flight. What moved is seen at keyframes only, so
/// they are close.
pub const KEYFRAME_TICKS: u64 = 50;

/// How a golden flight moved.
#[derive(Clone, Debug)]
pub struct Moved {
    /// The largest change of each group of fields that changed, in the order of the state.
    pub groups: Vec<Largest>,
    /// First tick with a change, as far as states were kept.
    pub first_tick: Option<u64>,
    /// The first outputs that changed.
    pub outputs: Option<OutputsDifference>,
    /// Ticks between states that were kept; 1 in a log that is not compacted.
    pub seen_every_ticks: u64,
    /// Last states, before and now.
    pub ends: (State, State),
    /// Touchdowns: ticks before, and now.
    pub touchdowns: (Vec<u64>, Vec<Touchdown>),
    /// Last digests, before and now.
    pub digests: (u64, u64),
    /// Versions of the model, before and now.
    pub models: (String, &'static str),
    /// Size of the new log, bytes.
    pub bytes: u64,
}

/// The largest change of a group of fields.
#[derive(Clone, Debug)]
pub struct Largest {
    /// Which one of them.
    pub path: String,
    /// Its unit; empty for a count or a flag.
    pub unit: String,
    /// When.
    pub tick: u64,
    /// Before.
    pub before: String,
    /// Now.
    pub now: String,
    absolute: f64,
    /// The largest of the numbers of its group that changed, before or now.
    scale: f64,
    /// A real number, no count and no flag.
    is_real: bool,
}

/// Changes below this part of the numbers that changed are rounding: what a model changes is larger.
const ROUNDING_RELATIVE: f64 = 1e-9;
/// And so are changes below this, in SI units, of what is 0 but for rounding itself.
const ROUNDING_SI: f64 = 1e-12;

impl Largest {
    /// Whether it is no more than another order of operations makes. A count that changed is more.
    fn is_rounding(&self) -> bool {
        self.is_real && self.absolute <= max(ROUNDING_RELATIVE * self.scale, ROUNDING_SI)
    }
}

/// Flies a golden flight anew by its recorded inputs, and says what moved. A flight from tick 0 begins
/// as its scenario says, a later one with its first recorded state. With `write`, the new flight takes
/// the place of the old one, whose parent and reason it keeps. `aircraft_toml` is for flights whose own
/// aircraft file is out of date.
///
/// # Errors
/// When the log is damaged, was changed or never closed: only deliberate motion is blessed.
pub fn bless(
    log: &Path,
    identity: Identity,
    aircraft_toml: Option<&str>,
    write: bool,
) -> Result<Moved, ReplayError> {
    let options = OpenOptions { across_versions: true, ..OPEN };
    let Source { judgement: source, devices, .. } = Source::opened(log, options)?;
    if !matches!(source.outcome, Outcome::NotReflown | Outcome::Diverged | Outcome::OutputsDiffer) {
        return Err(refused(&source.words));
    }
    // Without a tick, only one number over the whole log says so: it may as well be damage.
    if source.outcome == Outcome::OutputsDiffer && source.first_bad_tick.is_none() {
        return Err(refused(&source.words));
    }
    let moved = fly(log, identity.clone(), aircraft_toml, &devices, false)?;
    if !write || moved.is_same() && moved.models.0 == moved.models.1 {
        return Ok(moved);
    }
    let first = moved.first_bad_tick(&source);
    let words = match first {
        Some(tick) => format!("moved from {} on", at(tick)),
        None => "moved by what it is flown with".into(),
    };
    let first = first.map_or("unknown".into(), |tick| tick.to_string());
    let identity = identity.with(parent::JUDGEMENT, words).with(parent::FIRST_BAD_TICK, first);
    fly(log, identity, aircraft_toml, &devices, true)
}

/// Where the flight begins: as its scenario says, or with its first recorded state.
fn first_state(reader: &FlightReader, setup: &Setup) -> Result<State, ReplayError> {
    if reader.initial.tick != 0 {
        return Ok(reader.initial);
    }
    let aircraft = read(setup)?.aircraft;
    let start = aircraft::start("scenario.toml", &setup.scenario_toml)?;
    Ok(analysis::start::state_at(&start, &aircraft)?)
}

fn is_closed(reader: &FlightReader) -> Result<(), ReplayError> {
    match reader.ending() {
        Some(Ending::Closed) => Ok(()),
        Some(Ending::Damaged(why)) => Err(refused(&format!("damaged: {why}"))),
        _ => Err(refused("it was never closed")),
    }
}

/// Flies it anew; with `write`, the new flight takes the place of the old one.
fn fly(
    log: &Path,
    identity: Identity,
    aircraft_toml: Option<&str>,
    devices: &[DeviceIdentity],
    write: bool,
) -> Result<Moved, ReplayError> {
    let mut reader = logs::open(log, OpenOptions { across_versions: true, ..OPEN })?;
    if !reader.intact {
        return Err(refused("its files or its first state were changed after the flight"));
    }
    let compacted = reader.is_compacted();
    reader.keep_outputs = !compacted;
    let mut outputs_check = OutputsCheck::new()?;
    let mut setup = reader.setup.clone();
    if let Some(text) = aircraft_toml {
        setup.aircraft_toml = text.into();
    }
    if let Err(error) = read(&setup) {
        let what = format!("the log's {error}; --aircraft FILE flies it with a file of today");
        return Err(refused(&what));
    }
    let initial = first_state(&reader, &setup)?;
    let before = logs::closing(log).map_or(0, |(_, digest)| digest);
    let identity = inherited(identity, &reader.identity, before);
    let out = Output::beside(log, true, &[])?;
    let (identity, setup) = (&identity, &setup);
    let new = NewLog { out: &out, setup, identity, timing: true, devices, picture_of: None };
    let names = Names::of::<State>()?;
    let mut seen = Seen::new(&names, &reader.initial);
    seen.compare(&reader.initial, &initial)?;
    let models = (reader.identity.get(Identity::MODEL).to_string(), engine::MODEL_VERSION);
    let (mut altered, mut failure) = (None, None);
    let mut gathered = Gathered::from(&initial);
    let rewritten = rewrite(&mut reader, &initial, &new, |tick, state, outputs, reader| {
        if let Some(restart) = &tick.restart {
            gathered.restart(&restart.state);
        }
        gathered.add(state, outputs);
        outputs_check.computed(outputs);
        if are_todays(reader)
            && let Err(error) = outputs_check.recorded(&reader.outputs)
        {
            failure.get_or_insert(error);
        }
        // Of a compacted log, the chain can only be formed by the model that flew it.
        if !tick.chained && !compacted {
            altered.get_or_insert(tick.record.state.tick);
        }
        if reader.is_recorded()
            && let Err(error) = seen.compare(&tick.record.state, state)
        {
            failure.get_or_insert(error);
        }
    })?;
    if let Some(error) = failure {
        return Err(error.into());
    }
    if let Some(tick) = altered {
        let what = format!("it was changed after the flight: the digest breaks at tick {tick}");
        return Err(refused(&what));
    }
    is_closed(&reader)?;
    let mut moved = Moved {
        groups: seen.largest.into_iter().flatten().collect(),
        first_tick: seen.first_tick,
        outputs: outputs_check.first.or_else(|| OutputsDifference::of_compacted(&reader)),
        seen_every_ticks: if compacted { KEYFRAME_TICKS } else { 1 },
        ends: seen.ends,
        touchdowns: (rewritten.touchdown_ticks, gathered.touchdowns),
        digests: (before, rewritten.closed.digest),
        models,
        bytes: rewritten.closed.bytes,
    };
    // What is the same already stays as it is.
    if write && !(moved.is_same() && moved.models.0 == moved.models.1) {
        moved.bytes = take_place(log, out, compacted, moved.bytes)?;
    }
    Ok(moved)
}

/// Puts the new flight where the old one is, in the old one's form, once it was reflown; returns its size.
fn take_place(log: &Path, new: Output, compacted: bool, bytes: u64) -> Result<u64, ReplayError> {
    let (new, bytes) = if compacted {
        let packed = Output::beside(log, true, &[])?;
        let keyframes = KEYFRAME_TICKS;
        let made = logs::compact::compact(new.unfinished(), &packed, keyframes, flown, |_| ())?;
        (packed, made.bytes)
    } else {
        (new, bytes)
    };
    proven(new.unfinished(), &[Outcome::Exact])?;
    new.finish()?;
    Ok(bytes)
}

fn refused(what: &str) -> ReplayError {
    ReplayError::Refused(format!("not blessed: {what}"))
}

/// Who flies now, with what the flight was made from and is kept for.
fn inherited(identity: Identity, old: &Identity, before: u64) -> Identity {
    use parent::{CHANGES, DIGEST, DIGEST_AT_START, FIRST_BAD_TICK, FROM_TICK, JUDGEMENT};
    use parent::{MADE_BY, NAME, REASON};
    let kept =
        [MADE_BY, NAME, DIGEST, DIGEST_AT_START, FROM_TICK, CHANGES, REASON, Identity::FLOWN_BY];
    // What it came from is not clean for being blessed.
    let identity = match (old.0.get(JUDGEMENT), identity.0.get(JUDGEMENT).cloned()) {
        (Some(before), Some(now)) => {
            identity.with(JUDGEMENT, format!("{now}; before that, {before}"))
        }
        (Some(before), None) => {
            let tick = old.get(FIRST_BAD_TICK);
            identity.with(JUDGEMENT, before).with(FIRST_BAD_TICK, tick)
        }
        (None, _) => identity,
    };
    kept.into_iter()
        .filter_map(|key| Some((key, old.0.get(key)?)))
        .fold(identity, |identity, (key, value)| identity.with(key, value))
        .with(parent::BLESSED_FROM, format!("{before:016x}"))
}

/// What has been seen to move.
struct Seen<'a> {
    names: &'a Names,
    largest: Vec<Option<Largest>>,
    first_tick: Option<u64>,
    ends: (State, State),
}

impl<'a> Seen<'a> {
    fn new(names: &'a Names, initial: &State) -> Self {
        let largest = names.groups.iter().map(|_| None).collect();
        let ends = (*initial, *initial);
        Self { names, largest, first_tick: None, ends }
    }

    fn compare(&mut self, before: &State, now: &State) -> Result<(), LogError> {
        let messages = (cdr::encode(before)?, cdr::encode(now)?);
        for difference in self.names.differences(&messages.0, &messages.1) {
            let absolute = difference.absolute();
            self.first_tick.get_or_insert(before.tick);
            let largest = &mut self.largest[difference.name.group];
            let before_scale = largest.as_ref().map_or(0.0, |largest| largest.scale);
            let scale = max(before_scale, difference.scale());
            if let Some(largest) = largest {
                largest.scale = scale;
            }
            if largest.as_ref().is_none_or(|largest| absolute > largest.absolute) {
                *largest = Some(Largest {
                    path: difference.name.path.clone(),
                    unit: difference.name.unit.clone(),
                    tick: before.tick,
                    before: difference.a.to_string(),
                    now: difference.b.to_string(),
                    absolute,
                    scale,
                    is_real: matches!(difference.a, Value::F64(_)),
                });
            }
        }
        self.ends = (*before, *now);
        Ok(())
    }
}

impl Moved {
    /// Whether every state that was kept is the same, and the digest.
    pub fn is_same(&self) -> bool {
        self.first_tick.is_none() && self.outputs.is_none() && self.digests.0 == self.digests.1
    }

    /// The first tick that moved, as exactly as it is known.
    fn first_bad_tick(&self, source: &Judgement) -> Option<u64> {
        let outputs = self.outputs.as_ref().and_then(|outputs| outputs.tick);
        [self.first_tick, source.first_bad_tick, outputs].into_iter().flatten().min()
    }

    fn write_groups(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.groups.is_empty() {
            writeln!(f, "  {:<48} {:>12}  at", "largest change by field", "")?;
        }
        for group in &self.groups {
            writeln!(
                f,
                "  {:<48} {:>12.5e} {:<6} {:>9.3} s  ({} -> {})",
                group.path,
                group.absolute,
                group.unit,
                s(group.tick),
                group.before,
                group.now
            )?;
        }
        Ok(())
    }

    /// Whether states moved, and none of them by more than another order of operations makes.
    pub fn is_rounding(&self) -> bool {
        !self.groups.is_empty()
            && self.outputs.is_none()
            && self.groups.iter().all(Largest::is_rounding)
            && self.touchdowns.0.iter().eq(self
                .touchdowns
                .1
                .iter()
                .map(|touchdown| &touchdown.tick))
    }
}

fn s(tick: u64) -> f64 {
    tick as f64 * STEP_S
}

impl fmt::Display for Moved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_same() {
            return write!(f, "nothing moved: the same bits, digest {:016x}", self.digests.0);
        }
        let (before, now) = (&self.ends.0.plant, &self.ends.1.plant);
        let every = if self.seen_every_ticks == 1 {
            String::new()
        } else {
            format!(
                ", seen every {} ticks ({:.3} s)",
                self.seen_every_ticks,
                s(self.seen_every_ticks)
            )
        };
        match self.first_tick {
            Some(first) => writeln!(f, "moved from {} on{every}", at(first))?,
            None if self.digests.0 == self.digests.1 => writeln!(f, "no state moved{every}")?,
            None => writeln!(f, "no state moved{every}; what it is flown with did")?,
        }
        if let Some(outputs) = &self.outputs {
            writeln!(f, "  outputs differ {outputs}")?;
        }
        if self.models.0 != self.models.1 {
            writeln!(f, "  flight model   {} -> {}", self.models.0, self.models.1)?;
        }
        if self.is_rounding() {
            writeln!(
                f,
                "  rounding only  {} groups of fields, none by more than {ROUNDING_RELATIVE:e} of what it is \
                 or {ROUNDING_SI:e} in its SI unit",
                self.groups.len()
            )?;
        } else {
            self.write_groups(f)?;
        }
        let apart = now.position_m - before.position_m;
        let distance = sqrt(apart.x * apart.x + apart.y * apart.y + apart.z * apart.z);
        writeln!(
            f,
            "  last position  {distance:.4} m apart: {:+.4} m north, {:+.4} m east, {:+.4} m up",
            apart.x, apart.y, -apart.z
        )?;
        let old: Vec<_> =
            self.touchdowns.0.iter().map(|tick| format!("{:.3} s", s(*tick))).collect();
        let new: Vec<_> = self.touchdowns.1.iter().map(ToString::to_string).collect();
        let list = |list: &[String]| if list.is_empty() { "none".into() } else { list.join("; ") };
        writeln!(f, "  touchdown      {} -> {}", list(&old), list(&new))?;
        write!(f, "  digest         {:016x} -> {:016x}", self.digests.0, self.digests.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(change: impl Fn(&mut State)) -> Moved {
        let names = Names::of::<State>().expect("recordable");
        let mut before = State::default();
        before.plant.position_m.x = 1000.0;
        before.plant.position_m.z = -300.0;
        let mut now = before;
        change(&mut now);
        let mut seen = Seen::new(&names, &before);
        seen.compare(&before, &now).expect("states");
        Moved {
            groups: seen.largest.into_iter().flatten().collect(),
            first_tick: seen.first_tick,
            seen_every_ticks: 1,
            ends: (before, now),
            touchdowns: (Vec::new(), Vec::new()),
            digests: (1, 2),
            outputs: None,
            models: ("2".into(), "2"),
            bytes: 0,
        }
    }

    #[test]
    fn rounding_is_called_so_in_a_line() {
        let said = moved(|state| {
            state.plant.position_m.x += 1e-12;
            state.plant.velocity_mps.y = 1e-17;
        });
        assert!(said.is_rounding());
        let said = said.to_string();
        assert!(said.contains("rounding only  2 groups of fields"), "{said}");
        assert!(!said.contains("velocity_mps.y"), "{said}");
    }

    #[test]
    fn what_is_more_than_rounding_is_listed() {
        for change in [
            (|state: &mut State| state.plant.position_m.x += 1e-5) as fn(&mut State),
            |state| state.plant.velocity_mps.y = 1e-9,
            |state| state.plant.weight_on_wheels ^= 1,
            |state| state.plant.fuel_kg = f64::NAN,
        ] {
            let said = moved(change);
            assert!(!said.is_rounding());
            assert!(said.to_string().contains("largest change by field"), "{said}");
        }
        assert!(!moved(|_| ()).is_rounding(), "nothing moved");
    }
}
