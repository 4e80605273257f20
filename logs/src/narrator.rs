//! Tells in events what the numbers say: markers, failures, devices, validity, wheels.

use engine::State;
use engine::inputs::{DeviceEvent, EventKind, Failures};
use engine::outputs::{Outputs, Validity};

use crate::records::{Happening, InputsRecord};
use crate::{FlightWriter, LogError};

/// What was told last.
pub struct Narrator {
    markers: u64,
    failures: Failures,
    validity: Validity,
    paused: u64,
    weight_on_wheels: u64,
}

impl Narrator {
    /// Nothing has happened yet.
    pub fn new(initial: &State) -> Self {
        Self {
            markers: initial.cockpit.markers,
            failures: Failures::empty(),
            validity: Validity::empty(),
            paused: 0,
            weight_on_wheels: initial.plant.weight_on_wheels,
        }
    }

    /// A device event, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn event(&self, writer: &mut FlightWriter, event: &DeviceEvent) -> Result<(), LogError> {
        let Some(kind) = EventKind::from_u64(event.kind) else { return Ok(()) };
        let words = format!("device {} {}", event.device, kind.facts().key);
        let (what, words) = match kind {
            EventKind::Connected => (Happening::DeviceConnected, words),
            EventKind::Disconnected => (Happening::DeviceDisconnected, words),
            EventKind::Dropped => {
                let words = format!("device {}: the kernel lost events", event.device);
                (Happening::EventsLost, words)
            }
            EventKind::Axis
            | EventKind::Button
            | EventKind::AxisPosition
            | EventKind::ButtonPosition => return Ok(()),
        };
        writer.happened(event.tick, what, event.device, &words)
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
            let (what, words) = (Happening::Failures, format!("failed: {}", world.failures));
            writer.happened(inputs.tick, what, world.failures.bits(), &words)?;
        }
        if world.paused != self.paused {
            self.paused = world.paused;
            let words = if world.paused != 0 { "paused" } else { "goes on" };
            writer.happened(inputs.tick, Happening::Paused, world.paused, words)?;
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
            writer.happened(state.tick, Happening::Marker, self.markers, &words)?;
        }
        if state.plant.weight_on_wheels != self.weight_on_wheels {
            self.weight_on_wheels = state.plant.weight_on_wheels;
            let words = if self.weight_on_wheels != 0 { "touchdown" } else { "lift-off" };
            writer.happened(state.tick, Happening::WeightOnWheels, self.weight_on_wheels, words)?;
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
            let words = format!("outside the model's validity: {}", self.validity);
            writer.happened(outputs.tick, Happening::Validity, self.validity.bits(), &words)?;
        }
        Ok(())
    }
}
