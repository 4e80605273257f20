//! Reflying a log: the recorded inputs through the engine, tick by tick.

use std::path::Path;

use crate::versions::Versions;
use engine::start::Start;
use engine::{Aircraft, Inputs, Outputs, State, step};
use logs::{Ending, FlightReader, LogError, Setup, Tick, cdr};

/// Why a log cannot be reflown.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The log itself.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The files the flight was flown with.
    #[error("the log's {0}")]
    Setup(#[from] aircraft::ConfigError),
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
        Self::of(FlightReader::open(path)?)
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
        let mut aircraft = match aircraft::aircraft("aircraft.toml", &setup.aircraft_toml) {
            Ok(aircraft) => aircraft,
            Err(error) => {
                notes.push(format!("flown with this version's XV-15: the log's {error}"));
                aircraft::aircraft("xv15.toml", aircraft::XV15)?
            }
        };
        aircraft.cockpit = aircraft::cockpit("cockpit.toml", &setup.cockpit_toml)?;
        let state = match aircraft::start("scenario.toml", &setup.scenario_toml) {
            Ok(start) => first_state(&reader, &aircraft, &start)?,
            Err(error) => {
                notes.push(format!("what the first state lacks is 0: the log's {error}"));
                reader.initial
            }
        };
        Ok(Self { reader, aircraft, state, message: Vec::new(), notes })
    }

    fn of(reader: FlightReader) -> Result<Self, ReplayError> {
        let setup = &reader.setup;
        let aircraft = aircraft_of(setup)?;
        // The flight does not need it, but a log whose scenario cannot be read is not whole.
        let start = aircraft::start("scenario.toml", &setup.scenario_toml)?;
        let state = first_state(&reader, &aircraft, &start)?;
        Ok(Self { reader, aircraft, state, message: Vec::new(), notes: Vec::new() })
    }

    /// Flies the next tick; `None` at the end of the log.
    ///
    /// # Errors
    /// When the log's messages do not make a flight.
    pub fn next_tick(&mut self) -> Result<Option<Reflown>, ReplayError> {
        let Some(mut recorded) = self.reader.next_tick()? else { return Ok(None) };
        let inputs = Inputs { events: &recorded.events, world: recorded.inputs.world };
        let (state, outputs) = step(&self.aircraft, &self.state, &inputs);
        self.state = state;
        self.message.clear();
        cdr::append(&mut self.message, &state)?;
        self.reader.fill(&mut recorded, &state)?;
        let exact = self.message == recorded.state_message;
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

/// The aircraft of a log, with its cockpit map.
pub(crate) fn aircraft_of(setup: &Setup) -> Result<Aircraft, ReplayError> {
    let mut aircraft = aircraft::aircraft("aircraft.toml", &setup.aircraft_toml)?;
    aircraft.cockpit = aircraft::cockpit("cockpit.toml", &setup.cockpit_toml)?;
    Ok(aircraft)
}
