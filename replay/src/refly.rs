//! Reflying a log: the recorded inputs through the engine, tick by tick.

use std::path::Path;

use crate::versions::Versions;
use engine::start::Start;
use engine::{Aircraft, Inputs, Outputs, State, step};
use logs::compact::Flown;
use logs::{Ending, FlightReader, LogError, Messages, Setup, Tick, cdr};

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
    Start(#[from] engine::trim::Failure),
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

/// Opens a log, compacted or not.
///
/// # Errors
/// When it is not a flight log, or of another version, or its files cannot be read.
pub fn open(path: &Path) -> Result<FlightReader, LogError> {
    FlightReader::open_any(path, flown)
}

/// Every message of a log, compacted or not.
///
/// # Errors
/// When the file cannot be read.
pub fn messages(path: &Path) -> Result<Messages, LogError> {
    Messages::open_any(path, flown)
}

/// What flies the states that a compacted log leaves out.
///
/// # Errors
/// [`LogError::Setup`] when the log's files cannot be read.
pub fn flown(setup: &Setup) -> Result<Flown, LogError> {
    read(setup).map_err(|error| LogError::Setup(error.to_string()))
}

/// The aircraft of a log with its cockpit map, and the world at the start.
pub(crate) fn read(setup: &Setup) -> Result<Flown, aircraft::ConfigError> {
    let aircraft = aircraft::aircraft("aircraft.toml", &setup.aircraft_toml)?
        .with_cockpit(aircraft::cockpit("cockpit.toml", &setup.cockpit_toml)?);
    // A flight does not need it once it has begun, but a log whose scenario cannot be read is not
    // whole.
    let start = aircraft::start("scenario.toml", &setup.scenario_toml)?;
    Ok(Flown { aircraft, world: start.world.world() })
}

/// A log being reflown.
pub struct Reflight {
    /// The log.
    pub reader: FlightReader,
    /// The aircraft of the log.
    pub aircraft: Aircraft,
    /// The state after the last tick.
    pub state: State,
    /// The same as a message.
    message: Vec<u8>,
    /// Every tick so far was the recorded one.
    together: bool,
    /// What is not as the log says.
    pub notes: Vec<String>,
}

/// One tick, recorded and reflown.
pub struct Reflown {
    /// As recorded.
    pub recorded: Tick,
    /// What can be observed after it.
    pub outputs: Outputs,
    /// Whether the reflown state is the recorded one, to the bit.
    pub exact: bool,
}

impl Reflight {
    /// Opens a log.
    ///
    /// # Errors
    /// When it is not a flight log, or of another version, or its files cannot be read.
    pub fn open(path: &Path) -> Result<Self, ReplayError> {
        Self::within(path, &Window::default())
    }

    /// Opens a log, whatever version of the flight model flew it: what comes out is a comparison of
    /// two versions. Where the log's files mean nothing to this one, its own take their place.
    ///
    /// # Errors
    /// When it is not a flight log, or its cockpit map cannot be read.
    pub fn open_across_versions(path: &Path) -> Result<Self, ReplayError> {
        let reader = FlightReader::open_across_versions(path)?;
        let mut notes = Vec::new();
        let setup = &reader.setup;
        let aircraft = match aircraft::aircraft("aircraft.toml", &setup.aircraft_toml) {
            Ok(aircraft) => aircraft,
            Err(error) => {
                notes.push(format!("flown with this version's XV-15: the log's {error}"));
                aircraft::aircraft("xv15.toml", aircraft::XV15)?
            }
        };
        let aircraft =
            aircraft.with_cockpit(aircraft::cockpit("cockpit.toml", &setup.cockpit_toml)?);
        let state = match aircraft::start("scenario.toml", &setup.scenario_toml) {
            Ok(start) => first_state(&reader, &aircraft, &start)?,
            Err(error) => {
                notes.push(format!("what the first state lacks is 0: the log's {error}"));
                reader.initial
            }
        };
        Ok(Self { reader, aircraft, state, message: Vec::new(), together: true, notes })
    }

    /// Opens a log where a window begins, to be reflown until it ends.
    ///
    /// # Errors
    /// As for [`Reflight::open`], and when the window is not in the log.
    pub fn within(path: &Path, window: &Window) -> Result<Self, ReplayError> {
        let mut reader = open(path)?;
        let aircraft = read(&reader.setup)?.aircraft;
        let start = aircraft::start("scenario.toml", &reader.setup.scenario_toml)?;
        window.apply(&mut reader)?;
        let state = first_state(&reader, &aircraft, &start)?;
        let notes = Vec::new();
        Ok(Self { reader, aircraft, state, message: Vec::new(), together: true, notes })
    }

    /// Flies the next tick; `None` at the end of the log, or of the window.
    ///
    /// In a compacted log, a state that was not kept is exact when the digest that was kept says so.
    ///
    /// # Errors
    /// When the log's messages do not make a flight.
    pub fn next_tick(&mut self) -> Result<Option<Reflown>, ReplayError> {
        let Some(mut recorded) = self.reader.next_tick()? else { return Ok(None) };
        // A compacted log was flown while it was read: once is enough while all is as recorded.
        let flown = self.reader.flown().filter(|_| self.together);
        let (state, outputs) = if let Some((state, outputs)) = flown {
            (*state, *outputs)
        } else {
            let inputs = Inputs { events: &recorded.events, world: recorded.inputs.world };
            step(&self.aircraft, &self.state, &inputs)
        };
        self.state = state;
        self.message.clear();
        cdr::append(&mut self.message, &state)?;
        self.reader.fill(&mut recorded, &state)?;
        let mut exact = self.message == recorded.state_message;
        if self.reader.is_compacted() {
            exact &= self.together && (recorded.chained || self.reader.is_recorded());
        }
        self.together &= exact;
        Ok(Some(Reflown { recorded, outputs, exact }))
    }

    /// The state after the last tick, as a message.
    pub fn message(&self) -> &[u8] {
        &self.message
    }

    /// What stands between the log's version and this one; `None` when nothing does. Channels count
    /// once a message of theirs was read.
    ///
    /// # Errors
    /// Never, for the structs that are recorded.
    pub fn versions(&self) -> Result<Option<Versions>, ReplayError> {
        Ok(Versions::of(self)?)
    }

    /// How the log ends, once it has been flown.
    pub fn ending(&self) -> Ending {
        self.reader.ending().cloned().unwrap_or(Ending::Truncated)
    }
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
    Ok(reader.initial_over(&start.state(aircraft).unwrap_or_default())?)
}
