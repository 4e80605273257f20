//! Reflying a log: the recorded inputs through the engine, tick by tick.

use std::path::Path;

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
        let reader = FlightReader::open(path)?;
        let aircraft = aircraft_of(&reader.setup)?;
        // The flight does not need it, but a log whose scenario cannot be read is not whole.
        aircraft::start("scenario.toml", &reader.setup.scenario_toml)?;
        let state = reader.initial;
        Ok(Self { reader, aircraft, state, message: Vec::new() })
    }

    /// Flies the next tick; `None` at the end of the log.
    ///
    /// # Errors
    /// When the log's messages do not make a flight.
    pub fn next_tick(&mut self) -> Result<Option<Reflown>, ReplayError> {
        let Some(recorded) = self.reader.next_tick()? else { return Ok(None) };
        let inputs = Inputs { events: &recorded.events, world: recorded.inputs.world };
        let (state, outputs) = step(&self.aircraft, &self.state, &inputs);
        self.state = state;
        self.message.clear();
        cdr::append(&mut self.message, &state)?;
        let exact = self.message == recorded.state_message;
        Ok(Some(Reflown { recorded, outputs, exact }))
    }

    /// The state after the last tick, as a message.
    pub fn message(&self) -> &[u8] {
        &self.message
    }

    /// How the log ends, once it has been flown.
    pub fn ending(&self) -> Ending {
        self.reader.ending().cloned().unwrap_or(Ending::Truncated)
    }
}

/// The aircraft of a log, with its cockpit map.
pub(crate) fn aircraft_of(setup: &Setup) -> Result<Aircraft, ReplayError> {
    let mut aircraft = aircraft::aircraft("aircraft.toml", &setup.aircraft_toml)?;
    aircraft.cockpit = aircraft::cockpit("cockpit.toml", &setup.cockpit_toml)?;
    Ok(aircraft)
}
