//! Tells in events what the numbers say: markers, failures, devices, validity, wheels.

use engine::State;
use engine::inputs::{DeviceEvent, EventKind, failures};
use engine::outputs::{Outputs, validity};

use crate::records::{Happening, InputsRecord};
use crate::view::Level;
use crate::{FlightWriter, LogError};

/// What was told last.
pub struct Narrator {
    markers: u64,
    failures: u64,
    validity: u64,
    paused: u64,
    weight_on_wheels: u64,
}

impl Narrator {
    /// Nothing has happened yet.
    pub fn new(initial: &State) -> Self {
        Self {
            markers: initial.cockpit.markers,
            failures: 0,
            validity: 0,
            paused: 0,
            weight_on_wheels: initial.plant.weight_on_wheels,
        }
    }

    /// A device event, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn event(&self, writer: &mut FlightWriter, event: &DeviceEvent) -> Result<(), LogError> {
        let (what, words, level) = match EventKind::from_u64(event.kind) {
            Some(EventKind::Connected) => (Happening::DeviceConnected, "connected", Level::Info),
            Some(EventKind::Disconnected) => {
                (Happening::DeviceDisconnected, "disconnected", Level::Warn)
            }
            _ => return Ok(()),
        };
        let words = format!("device {} {words}", event.device);
        writer.happened(event.tick, what, event.device, level, &words)
    }

    /// The world of a tick, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn inputs(
        &mut self,
        writer: &mut FlightWriter,
        inputs: &InputsRecord,
    ) -> Result<(), LogError> {
        let world = &inputs.world;
        if world.failures != self.failures {
            self.failures = world.failures;
            let words = format!("failed: {}", names(world.failures, &FAILURES));
            let (what, level) = (Happening::Failures, Level::Warn);
            writer.happened(inputs.tick, what, world.failures, level, &words)?;
        }
        if world.paused != self.paused {
            self.paused = world.paused;
            let words = if world.paused != 0 { "paused" } else { "goes on" };
            let (what, level) = (Happening::Paused, Level::Info);
            writer.happened(inputs.tick, what, world.paused, level, words)?;
        }
        Ok(())
    }

    /// The state after a tick, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn state(&mut self, writer: &mut FlightWriter, state: &State) -> Result<(), LogError> {
        if state.cockpit.markers != self.markers {
            self.markers = state.cockpit.markers;
            let words = format!("marker {}", self.markers);
            let (what, level) = (Happening::Marker, Level::Info);
            writer.happened(state.tick, what, self.markers, level, &words)?;
        }
        if state.plant.weight_on_wheels != self.weight_on_wheels {
            self.weight_on_wheels = state.plant.weight_on_wheels;
            let words = if self.weight_on_wheels != 0 { "touchdown" } else { "lift-off" };
            let (what, level) = (Happening::WeightOnWheels, Level::Info);
            writer.happened(state.tick, what, self.weight_on_wheels, level, words)?;
        }
        Ok(())
    }

    /// What can be observed after a tick, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn outputs(
        &mut self,
        writer: &mut FlightWriter,
        outputs: &Outputs,
    ) -> Result<(), LogError> {
        if outputs.validity != self.validity {
            self.validity = outputs.validity;
            let level = if self.validity == 0 { Level::Info } else { Level::Warn };
            let words =
                format!("outside the model's validity: {}", names(self.validity, &VALIDITY));
            writer.happened(outputs.tick, Happening::Validity, self.validity, level, &words)?;
        }
        Ok(())
    }
}

const FAILURES: [(u64, &str); 6] = [
    (failures::ENGINE_LEFT, "left engine"),
    (failures::ENGINE_RIGHT, "right engine"),
    (failures::SCAS_PITCH, "SCAS pitch"),
    (failures::SCAS_ROLL, "SCAS roll"),
    (failures::SCAS_YAW, "SCAS yaw"),
    (failures::GOVERNOR, "governor"),
];

const VALIDITY: [(u64, &str); 10] = [
    (validity::ROTOR_STALL, "rotor stall"),
    (validity::VORTEX_RING, "vortex ring"),
    (validity::SPEED, "speed"),
    (validity::HEIGHT, "height"),
    (validity::GEAR_BOTTOMED, "gear bottomed"),
    (validity::FROZEN, "numbers not finite"),
    (validity::HULL, "hull on the ground"),
    (validity::FLAPPING_STOP, "flapping stop"),
    (validity::ROTOR_SPEED, "rotor speed"),
    (validity::TUMBLING, "tumbling"),
];

/// The names of the set bits, or "nothing".
fn names(bits: u64, known: &[(u64, &str)]) -> String {
    let set: Vec<_> =
        known.iter().filter(|(bit, _)| bits & bit != 0).map(|(_, name)| *name).collect();
    if set.is_empty() { "nothing".into() } else { set.join(", ") }
}
