//! What is to be shown: the aircraft after a step, the world it flew in, and the lamps of the log.

use engine::inputs::World;
use engine::{Aircraft, Outputs};

/// What a lamp tells of the log.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Recording {
    /// Nothing is recorded.
    #[default]
    Off = 0,
    /// The flight is recorded.
    On = 1,
    /// The log cannot be written any further.
    Failed = 2,
}

/// Lamps that tell of the program, not of the aircraft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lamps {
    /// The log.
    pub recording: Recording,
    /// A log is being reflown.
    pub replay: bool,
    /// The picture stands still: the flight or the replay is paused.
    pub paused: bool,
}

/// What is to be shown of a moment.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Whose parameters scale what is shown.
    pub aircraft: &'a Aircraft,
    /// What a step gave.
    pub outputs: &'a Outputs,
    /// The world of that step.
    pub world: &'a World,
    /// The lamps.
    pub lamps: Lamps,
}
