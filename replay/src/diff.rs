//! Two logs, field by field: what was flown, what came in, what came out.

use std::collections::BTreeMap;
use std::path::Path;

use engine::State;
use engine::inputs::DeviceEvent;
use logs::fields::Value;
use logs::records::{InputsRecord, RestartRecord};
use logs::{FlightReader, LogError, Setup, cdr};

use crate::compare::{Difference, Names};
use crate::divergence::{Divergence, LastInput, StatePair};
use crate::judgement::{End, Facts, Judgement};
use crate::refly::Window;
use crate::ticks::Irregular;

/// Two logs beside each other.
#[derive(Debug)]
pub struct Diff {
    /// The first log.
    pub a: Side,
    /// The second log.
    pub b: Side,
    /// Who flew, with what program, and when: what is not the same. It moves no aircraft.
    pub identity: Vec<KeyDifference>,
    /// The files flown with: those that are not the same.
    pub files: Vec<FileDifference>,
    /// First and last tick that both have; `None` when there is no such tick.
    pub compared: Option<(u64, u64)>,
    /// How many ticks were compared, the state at the start among them.
    pub ticks: u64,
    /// The device events.
    pub events: EventsDifference,
    /// The world: every field that differs.
    pub world: Vec<Extent>,
    /// Where the states part.
    pub first: Option<Box<Divergence>>,
    /// Every field of the state that differs.
    pub state: Vec<Extent>,
}

/// One of the two logs.
#[derive(Clone, Debug)]
pub struct Side {
    /// Tick of the state it begins with.
    pub start_tick: u64,
    /// Its last tick.
    pub last_tick: u64,
    /// Digest of its last tick.
    pub digest: u64,
    /// How its reading ended: where that was not as it should be, nothing was compared from there on.
    pub end: End,
    /// What it is, as far as reading shows.
    pub judgement: Judgement,
    /// The first ticks that are missing, or are there twice.
    pub irregular: Option<Irregular>,
    /// How many ticks are missing.
    pub missing: u64,
    /// How many ticks are there once more.
    pub doubled: u64,
}

/// A value by name that is not the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyDifference {
    /// Its name; in a file the path to it (`rotors.radius_ft.value`).
    pub key: String,
    /// In the first log, if it is there.
    pub a: Option<String>,
    /// In the second.
    pub b: Option<String>,
}

/// A file that is not the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileDifference {
    /// Which.
    pub name: &'static str,
    /// Its keys whose values differ; none where only comments or spelling do.
    pub keys: Vec<KeyDifference>,
}

/// The device events that are not the same.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EventsDifference {
    /// In how many ticks.
    pub ticks: u64,
    /// The first one.
    pub first: Option<FirstEvent>,
}

/// The first device event that is not the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FirstEvent {
    /// The tick it led to.
    pub tick: u64,
    /// In the first log, if there was one.
    pub a: Option<DeviceEvent>,
    /// In the second.
    pub b: Option<DeviceEvent>,
}

/// How far one field differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// Which.
    pub path: String,
    /// Its unit; empty for a count, a flag, a ratio.
    pub unit: String,
    /// The first tick where it does.
    pub first_tick: u64,
    /// In how many ticks it does.
    pub ticks: u64,
    /// The largest difference, in its unit; infinite where one value is no number.
    pub largest: f64,
    /// When that was.
    pub largest_tick: u64,
    /// Its value there in the first log.
    pub a: Value,
    /// And in the second.
    pub b: Value,
    /// The most representable numbers between.
    pub ulps: u64,
    /// When that was.
    pub ulps_tick: u64,
}

impl Diff {
    /// Whether it is the same flight: files, inputs, states, from the same start to the same end.
    pub fn same(&self) -> bool {
        let ends = |side: &Side| (side.start_tick, side.last_tick);
        self.files.is_empty()
            && self.events.ticks == 0
            && self.world.is_empty()
            && self.state.is_empty()
            && ends(&self.a) == ends(&self.b)
            && (self.a.missing, self.a.doubled) == (self.b.missing, self.b.doubled)
            && self.a.irregular == self.b.irregular
    }

    /// Whether both could be read to their end.
    pub fn usable(&self) -> bool {
        [&self.a, &self.b].iter().all(|side| side.end.is_readable())
    }

    /// Whether the states differ from the first one that both have.
    pub fn parts_at_start(&self) -> bool {
        match (&self.first, self.compared) {
            (Some(first), Some((from, _))) => first.tick == from,
            _ => false,
        }
    }
}

/// Compares two logs, each as it was recorded: nothing is reflown.
///
/// # Errors
/// When one of them is not a flight log, or of another version.
pub fn diff(a: &Path, b: &Path, mut progress: impl FnMut(u64)) -> Result<Diff, (Which, LogError)> {
    let mut a = Cursor::open(a).map_err(|error| (Which::A, error))?;
    let mut b = Cursor::open(b).map_err(|error| (Which::B, error))?;
    let mut comparison = Comparison::new().map_err(|error| (Which::A, error))?;
    let identity = keys(&a.reader.identity.0, &b.reader.identity.0);
    let files = files(&a.reader.setup, &b.reader.setup);
    while let (Some(of_a), Some(of_b)) = (&a.now, &b.now) {
        // A log that begins later, or lacks a tick, is waited for.
        match of_a.tick.cmp(&of_b.tick) {
            std::cmp::Ordering::Less => a.advance(),
            std::cmp::Ordering::Greater => b.advance(),
            std::cmp::Ordering::Equal => {
                comparison.add(of_a, of_b).map_err(|error| (Which::A, error))?;
                progress(comparison.ticks);
                a.advance();
                b.advance();
            }
        }
    }
    Ok(Diff {
        identity,
        files,
        compared: comparison.compared,
        ticks: comparison.ticks,
        events: comparison.events,
        world: comparison.world.into_values().collect(),
        first: comparison.first,
        state: comparison.state.into_values().collect(),
        a: a.finish(),
        b: b.finish(),
    })
}

/// One of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// The first.
    A,
    /// The second.
    B,
}

/// One tick of a log; the first one is the state at the start, which nothing led to.
pub(crate) struct At {
    pub(crate) tick: u64,
    pub(crate) state: Vec<u8>,
    pub(crate) led: Option<(Vec<DeviceEvent>, InputsRecord)>,
    /// What took the place of the state before it.
    #[cfg_attr(not(feature = "rerun"), expect(dead_code, reason = "only the viewer flies by it"))]
    pub(crate) restart: Option<Box<RestartRecord>>,
}

/// A log being read.
pub(crate) struct Cursor {
    pub(crate) reader: FlightReader,
    pub(crate) start_tick: u64,
    last: (u64, u64),
    facts: Facts,
    disorder: Option<String>,
    pub(crate) now: Option<At>,
}

impl Cursor {
    pub(crate) fn open(path: &Path) -> Result<Self, LogError> {
        let reader = logs::open(path, crate::refly::OPEN)?;
        let (tick, state) = (reader.initial.tick, cdr::encode(&reader.initial)?);
        let now = Some(At { tick, state, led: None, restart: None });
        let facts = Facts::of_reading(&reader);
        Ok(Self { reader, start_tick: tick, last: (tick, 0), facts, disorder: None, now })
    }

    pub(crate) fn advance(&mut self) {
        self.now = match self.reader.next_tick() {
            Ok(Some(tick)) => {
                self.last = (tick.record.state.tick, tick.record.digest);
                let led = Some((tick.events.clone(), tick.inputs));
                let (state, restart) = (tick.state_message.clone(), tick.restart.clone());
                let now = At { tick: self.last.0, state, led, restart };
                self.facts.add(tick, None);
                self.reader.timings.clear();
                Some(now)
            }
            Ok(None) => None,
            Err(error) => {
                self.disorder = Some(error.to_string());
                None
            }
        };
    }

    /// Reads what is left.
    pub(crate) fn finish(mut self) -> Side {
        while self.now.is_some() {
            self.advance();
        }
        self.facts.end(&self.reader, self.disorder, &Window::default());
        Side {
            start_tick: self.start_tick,
            last_tick: self.last.0,
            digest: self.last.1,
            judgement: self.facts.judge(),
            irregular: self.facts.irregular,
            missing: self.facts.missing,
            doubled: self.facts.doubled,
            end: self.facts.end,
        }
    }
}

/// What was found so far.
struct Comparison {
    inputs: Names,
    states: Names,
    compared: Option<(u64, u64)>,
    ticks: u64,
    last_input: LastInput,
    events: EventsDifference,
    world: BTreeMap<usize, Extent>,
    first: Option<Box<Divergence>>,
    state: BTreeMap<usize, Extent>,
}

impl Comparison {
    fn new() -> Result<Self, LogError> {
        Ok(Self {
            inputs: Names::of::<InputsRecord>()?,
            states: Names::of::<State>()?,
            compared: None,
            ticks: 0,
            last_input: LastInput::new()?,
            events: EventsDifference::default(),
            world: BTreeMap::new(),
            first: None,
            state: BTreeMap::new(),
        })
    }

    fn add(&mut self, a: &At, b: &At) -> Result<(), LogError> {
        let tick = a.tick;
        self.compared = Some((self.compared.map_or(tick, |(from, _)| from), tick));
        self.ticks += 1;
        if let (Some((events_a, inputs_a)), Some((events_b, inputs_b))) = (&a.led, &b.led) {
            self.events.add(tick, events_a, events_b);
            if inputs_a != inputs_b {
                let (a, b) = (cdr::encode(inputs_a)?, cdr::encode(inputs_b)?);
                let world = self.inputs.differences(&a, &b);
                let world = world.filter(|difference| difference.name.path.starts_with("world."));
                world.for_each(|difference| extend(&mut self.world, tick, &difference));
            }
            if self.first.is_none() {
                self.last_input.add(events_a, inputs_a)?;
            }
        }
        match &mut self.first {
            Some(first) => first.growth.add(tick, &a.state, &b.state),
            None if a.state != b.state => {
                let parted = StatePair { tick, recorded: &a.state, reflown: &b.state };
                // Which control an axis moved is in both logs' cockpit maps, and may differ.
                let input = self.last_input.told(&engine::cockpit::Params::default());
                self.first = Divergence::new(&self.states, &parted, input)?.map(Box::new);
            }
            None => {}
        }
        if a.state != b.state {
            for difference in self.states.differences(&a.state, &b.state) {
                extend(&mut self.state, tick, &difference);
            }
        }
        Ok(())
    }
}

impl EventsDifference {
    fn add(&mut self, tick: u64, a: &[DeviceEvent], b: &[DeviceEvent]) {
        if a == b {
            return;
        }
        self.ticks += 1;
        if self.first.is_none() {
            let at = |events: &[DeviceEvent], i: usize| events.get(i).copied();
            let found = (0..a.len().max(b.len())).find(|&i| at(a, i) != at(b, i));
            self.first = found.map(|i| FirstEvent { tick, a: at(a, i), b: at(b, i) });
        }
    }
}

fn extend(extents: &mut BTreeMap<usize, Extent>, tick: u64, difference: &Difference) {
    let (absolute, ulps) = (difference.absolute(), difference.ulps());
    let extent = extents.entry(difference.index).or_insert_with(|| Extent {
        path: difference.name.path.clone(),
        unit: difference.name.unit.clone(),
        first_tick: tick,
        ticks: 0,
        largest: -1.0,
        largest_tick: tick,
        a: difference.a,
        b: difference.b,
        ulps: 0,
        ulps_tick: tick,
    });
    extent.ticks += 1;
    if absolute > extent.largest {
        extent.largest = absolute;
        extent.largest_tick = tick;
        (extent.a, extent.b) = (difference.a, difference.b);
    }
    if ulps > extent.ulps {
        (extent.ulps, extent.ulps_tick) = (ulps, tick);
    }
}

/// What is not the same in two lists of names and values.
fn keys(a: &BTreeMap<String, String>, b: &BTreeMap<String, String>) -> Vec<KeyDifference> {
    let mut all: Vec<&String> = a.keys().chain(b.keys()).collect();
    all.sort();
    all.dedup();
    let difference = |key: &String| KeyDifference {
        key: key.clone(),
        a: a.get(key).cloned(),
        b: b.get(key).cloned(),
    };
    all.into_iter().map(difference).filter(|found| found.a != found.b).collect()
}

fn files(a: &Setup, b: &Setup) -> Vec<FileDifference> {
    let both = a.files().into_iter().zip(b.files());
    both.filter(|((_, a), (_, b))| a != b)
        .map(|((name, a), (_, b))| FileDifference { name, keys: keys(&values(a), &values(b)) })
        .collect()
}

/// Every value of a TOML file under the path of its keys; nothing where it is none.
fn values(text: &str) -> BTreeMap<String, String> {
    let mut values = BTreeMap::new();
    if let Ok(table) = text.parse::<toml::Table>() {
        collect(&mut values, "", &toml::Value::Table(table));
    }
    values
}

fn collect(values: &mut BTreeMap<String, String>, path: &str, value: &toml::Value) {
    match value {
        toml::Value::Table(table) => {
            let dot = if path.is_empty() { "" } else { "." };
            table.iter().for_each(|(key, value)| {
                collect(values, &format!("{path}{dot}{key}"), value);
            });
        }
        toml::Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, value)| {
                collect(values, &format!("{path}[{i}]"), value);
            });
        }
        value => {
            values.insert(path.into(), value.to_string());
        }
    }
}

#[cfg(test)]
mod tests;
