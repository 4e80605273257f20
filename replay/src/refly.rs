//! Reflying a log: the recorded inputs through the engine, tick by tick.

use std::path::Path;

use crate::outputs::{OutputsCheck, OutputsDifference, are_todays};
use crate::versions::Versions;
use engine::start::Start;
use engine::{Aircraft, Inputs, Outputs, State, observe, step, step_state};
use logs::compact::FlightModel;
use logs::{Ending, FlightReader, LogError, OpenOptions, Setup, Tick, cdr};

/// Why a log cannot be reflown.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The log itself.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The files the flight was flown with.
    #[error("the log's {0}")]
    Setup(#[from] aircraft::ConfigError),
    /// The flight that it was can no longer be begun.
    #[error("the flight cannot begin as its scenario says: {0}")]
    Start(#[from] analysis::trim::Failure),
    /// Something that must not be blessed, or made a test of.
    #[error("{0}")]
    Refused(String),
}

/// A stretch of a flight: from one recorded state to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// The state to begin with; the first one without.
    pub from_tick: Option<u64>,
    /// The state to end with; the last one without.
    pub until_tick: Option<u64>,
    /// Whether a beginning before the log's is the log's: there is less around a marker that was
    /// pressed early.
    pub clamped: bool,
}

impl Window {
    /// Brings a log to where the window begins, and lets it end where the window ends.
    ///
    /// # Errors
    /// When the tick is not in the log.
    pub fn apply(&self, reader: &mut FlightReader) -> Result<(), LogError> {
        reader.until_tick = self.until_tick;
        let first = reader.initial.tick;
        if let Some(until) = self.until_tick.filter(|&until| until < first) {
            let last = reader.last_tick();
            return Err(LogError::Outside { tick: until, first, last });
        }
        match self.from_tick {
            Some(tick) if self.clamped && tick <= first => Ok(()),
            Some(tick) => reader.seek(tick),
            None => Ok(()),
        }
    }
}

/// How logs are opened: compacted ones, too, and of this version of the flight model only.
pub const OPEN: OpenOptions = OpenOptions { aircraft_of: Some(flown), across_versions: false };

/// What flies the states that a compacted log leaves out.
///
/// # Errors
/// [`LogError::Setup`] when the log's files cannot be read.
pub fn flown(setup: &Setup) -> Result<FlightModel, LogError> {
    read(setup).map_err(|error| LogError::Setup(error.to_string()))
}

/// The aircraft of a log with its cockpit map, and the world at the start.
pub(crate) fn read(setup: &Setup) -> Result<FlightModel, aircraft::ConfigError> {
    let aircraft = aircraft::aircraft("aircraft.toml", &setup.aircraft_toml)?
        .with_cockpit(aircraft::cockpit("cockpit.toml", &setup.cockpit_toml)?);
    // A flight does not need it once it has begun, but a log whose scenario cannot be read is not
    // whole.
    let start = aircraft::start("scenario.toml", &setup.scenario_toml)?;
    Ok(FlightModel { aircraft, world: start.world.world() })
}

/// A log being reflown.
pub struct Reflight {
    /// The log.
    pub reader: FlightReader,
    /// The aircraft of the log.
    pub aircraft: Aircraft,
    /// The state after the last tick.
    pub state: State,
    /// What could be observed after it.
    pub outputs: Outputs,
    /// The state as a message.
    message: Vec<u8>,
    /// Every tick so far was the recorded one.
    together: bool,
    pub(crate) outputs_check: OutputsCheck,
    /// Outputs are computed every so many ticks; between them, the older ones stay.
    pub(crate) outputs_ticks: u64,
    /// So many ticks are known to fly to the recorded states: they are only read.
    pub(crate) proven: u64,
    /// Whether the caller takes the recorded outputs out of the reader.
    pub(crate) outputs_taken: bool,
    /// What is not as the log says.
    pub notes: Vec<String>,
}

/// How a log is opened to be reflown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReflyOptions {
    /// The part to be reflown.
    pub window: Window,
    /// Whether a log of another version of the flight model is flown: what comes out is a comparison of
    /// two versions. Where the log's files mean nothing to this one, its own take their place.
    pub across_versions: bool,
}

/// One tick, recorded and reflown.
#[derive(Clone, Copy)]
pub struct Reflown<'a> {
    /// As recorded.
    pub recorded: &'a Tick,
    /// The reflown state after it.
    pub state: &'a State,
    /// What can be observed after it.
    pub outputs: &'a Outputs,
    /// Whether the reflown state is the recorded one, to the bit.
    pub exact: bool,
}

impl Reflight {
    /// Opens a log where the window begins, to be reflown until it ends.
    ///
    /// # Errors
    /// When it is not a flight log, or of another version, or its files cannot be read, or the window
    /// is not in it.
    pub fn open(path: &Path, options: &ReflyOptions) -> Result<Self, ReplayError> {
        let across = options.across_versions;
        // A compacted log is flown while it is read, by this version's model or not at all.
        let aircraft_of = OPEN.aircraft_of.filter(|_| !across);
        let mut reader = logs::open(path, OpenOptions { aircraft_of, across_versions: across })?;
        // What a compacted log has of them is made again.
        reader.keep_outputs = !across && !reader.is_compacted();
        let mut notes = Vec::new();
        let mut world = None;
        let aircraft = match read(&reader.setup) {
            Ok(flown) => {
                world = Some(flown.world);
                flown.aircraft
            }
            Err(error) if !across => return Err(error.into()),
            Err(_) => aircraft_across(&reader.setup, &mut notes)?,
        };
        options.window.apply(&mut reader)?;
        let state = match aircraft::start("scenario.toml", &reader.setup.scenario_toml) {
            Ok(start) => first_state(&reader, &aircraft, &start)?,
            Err(error) if !across => return Err(error.into()),
            Err(error) => {
                notes.push(format!("what the first state lacks is 0: the log's {error}"));
                reader.initial
            }
        };
        let mut outputs_check = OutputsCheck::new()?;
        if let Some(world) = world.filter(|_| state.tick == 0) {
            // What there was to be seen before the first tick.
            outputs_check.computed(&observe(&aircraft, &state, &world));
        }
        let (outputs, message) = (Outputs::default(), Vec::new());
        Ok(Self {
            reader,
            aircraft,
            state,
            outputs,
            message,
            together: true,
            outputs_check,
            outputs_ticks: 1,
            proven: 0,
            outputs_taken: false,
            notes,
        })
    }

    /// Flies the next tick; `None` at the end of the log, or of the window.
    ///
    /// In a compacted log, a state that was not kept is exact when the digest that was kept says so.
    ///
    /// # Errors
    /// When the log's messages do not make a flight.
    pub fn next_tick(&mut self) -> Result<Option<Reflown<'_>>, ReplayError> {
        if self.reader.next_tick()?.is_none() {
            self.check_outputs()?;
            return Ok(None);
        }
        if self.proven > 0 {
            self.proven -= 1;
            self.state = self.reader.tick.record.state;
            self.check_outputs()?;
            let Self { state, outputs, reader, .. } = &*self;
            return Ok(Some(Reflown { recorded: &reader.tick, state, outputs, exact: true }));
        }
        let read = self.fly();
        self.message.clear();
        if read {
            // Its message was made of this very state.
            self.message.extend_from_slice(&self.reader.tick.state_message);
        } else {
            cdr::append(&mut self.message, &self.state)?;
        }
        self.reader.fill(&self.state)?;
        let recorded = &self.reader.tick;
        let mut exact = self.message == recorded.state_message;
        if self.reader.is_compacted() {
            exact &= self.together && (recorded.chained || self.reader.is_recorded());
        }
        self.together &= exact;
        let tick = recorded.record.state.tick;
        if self.together && self.outputs.tick == self.state.tick {
            self.outputs_check.computed(&self.outputs);
        }
        self.check_outputs()?;
        if !self.outputs_taken {
            self.reader.outputs.retain(|outputs| outputs.tick > tick);
        }
        let recorded = &self.reader.tick;
        let Self { state, outputs, .. } = &*self;
        Ok(Some(Reflown { recorded, state, outputs, exact }))
    }

    /// Flies the tick that was read; `true` when reading had flown it and nothing was recorded of it.
    fn fly(&mut self) -> bool {
        let tick = &self.reader.tick;
        let inputs = Inputs { events: &tick.events, world: tick.inputs.world };
        let seen = self.state.tick.wrapping_add(1).is_multiple_of(self.outputs_ticks);
        // A compacted log was flown while it was read: once is enough while all is as recorded.
        let flown = self.reader.flown().filter(|_| self.together);
        if let Some((state, outputs)) = flown {
            self.state = *state;
            if seen {
                self.outputs = *outputs;
            }
            return !self.reader.is_recorded();
        } else {
            self.state = tick.begins_with(&self.state);
            if seen {
                (self.state, self.outputs) = step(&self.aircraft, &self.state, &inputs);
            } else {
                step_state(&self.aircraft, &mut self.state, &inputs);
            }
        }
        false
    }

    fn check_outputs(&mut self) -> Result<(), LogError> {
        if self.reader.outputs.is_empty() || !are_todays(&self.reader) {
            return Ok(());
        }
        self.outputs_check.recorded(&self.reader.outputs)
    }

    /// Whether every recorded state is one to begin with: the log has them, as they are today.
    pub(crate) fn can_begin_anywhere(&self) -> bool {
        let reader = &self.reader;
        reader.same_model
            && reader.has_todays_state()
            && !reader.is_compacted()
            && self.notes.is_empty()
    }

    /// The first recorded outputs that are not those computed now, of states that are the recorded ones.
    pub fn outputs_difference(&self) -> Option<&OutputsDifference> {
        self.outputs_check.first.as_ref()
    }

    /// The state after the last tick, as a message.
    pub fn message(&self) -> &[u8] {
        &self.message
    }

    /// What stands between the log's version and this one; `None` when nothing does. Channels count
    /// once a message of theirs was read.
    pub fn versions(&self) -> Option<Versions> {
        Versions::of(&self.reader, &self.notes)
    }

    /// How the log ends, once it has been flown.
    pub fn ending(&self) -> Ending {
        self.reader.ending().cloned().unwrap_or(Ending::Truncated)
    }
}

/// The aircraft of another version's log; where it means nothing here, this version's own.
fn aircraft_across(
    setup: &Setup,
    notes: &mut Vec<String>,
) -> Result<Aircraft, aircraft::ConfigError> {
    let aircraft = aircraft::aircraft("aircraft.toml", &setup.aircraft_toml).or_else(|error| {
        notes.push(format!("flown with this version's XV-15: the log's {error}"));
        aircraft::aircraft("xv15.toml", aircraft::XV15)
    })?;
    Ok(aircraft.with_cockpit(aircraft::cockpit("cockpit.toml", &setup.cockpit_toml)?))
}

/// The state at the start: the log's, and what the log lacks as the scenario has it.
fn first_state(
    reader: &FlightReader,
    aircraft: &Aircraft,
    start: &Start,
) -> Result<State, ReplayError> {
    if reader.has_todays_state() {
        return Ok(reader.initial);
    }
    Ok(reader.initial_over(&analysis::start::state_at(start, aircraft).unwrap_or_default())?)
}
