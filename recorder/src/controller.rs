//! Whatever moves the controls: hardware, a pilot model, a script. All of them speak in raw device
//! events, so that all of them take the path that hardware takes.

use engine::Outputs;
use engine::inputs::{DeviceEvent, EventKind, World};

use crate::restart::Restart;

/// What a controller may touch in one tick.
pub struct TickContext<'a> {
    /// Tick whose step uses it.
    pub tick: u64,
    /// Device events, appended in order.
    pub events: &'a mut Vec<DeviceEvent>,
    /// The world.
    pub world: &'a mut World,
    /// Number and name of the phase of the flight, for the log.
    pub phase: &'a mut (u64, &'static str),
    /// Set to end the flight.
    pub done: &'a mut bool,
    /// Set to go on from another state, before the step of this tick.
    pub restart: &'a mut Option<Restart>,
    /// Set to save the situation as it is before the step of this tick.
    pub save: &'a mut bool,
    /// Set with `done` by a pilot model whose task cannot be flown to its end.
    pub gave_up: &'a mut Option<GaveUp>,
}

/// What a pilot model gave up, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaveUp {
    /// Number of the phase, from 1.
    pub number: u64,
    /// Its name.
    pub phase: &'static str,
    /// Why.
    pub why: &'static str,
}

impl std::fmt::Display for GaveUp {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the pilot gave up, {}: {}", self.phase, self.why)
    }
}

impl TickContext<'_> {
    /// Adds a device event of this tick.
    pub fn send(&mut self, device: u64, kind: EventKind, code: u64, value: i64) {
        self.events.push(DeviceEvent {
            tick: self.tick,
            kernel_time_ns: 0,
            device,
            kind: kind as u64,
            code,
            value,
            ..DeviceEvent::default()
        });
    }
}

/// Moves controls.
pub trait Controller: Send {
    /// What it does in this tick, having seen the aircraft after the one before.
    fn act(&mut self, seen: &Outputs, context: &mut TickContext<'_>);

    /// How many events it sends in one tick at most: room is made for them before the flight.
    fn events_a_tick(&self) -> usize {
        64
    }
}
