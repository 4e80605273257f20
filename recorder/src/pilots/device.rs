//! The device that exists in the cockpit map only.

use engine::cockpit::{self, AxisControl, ButtonControl, Travel};
use engine::inputs::EventKind;
use engine::math::clamp;

use crate::controller::TickContext;

/// Name of the device in the cockpit map that pilot models and scripts use.
pub const DEVICE: &str = "pilot";

/// A device that exists in the map only: moves controls by sending what a real one would send.
#[derive(Clone, Debug)]
pub struct VirtualDevice {
    number: u64,
    device: cockpit::Device,
    sent: Vec<(u64, i64)>,
}

impl VirtualDevice {
    /// The device called [`DEVICE`], if the map has it.
    pub fn of(map: &cockpit::Params) -> Option<Self> {
        Self::named(map, DEVICE)
    }

    /// The device of that name, if the map has it.
    pub fn named(map: &cockpit::Params, name: &str) -> Option<Self> {
        let number = map.device.iter().position(|device| device.name == name)?;
        let device = map.device[number].clone();
        // No memory is asked for in flight.
        let sent = Vec::with_capacity(device.axis.len());
        Some(Self { number: number as u64, device, sent })
    }

    /// Forgets where the axes were sent to: something else has moved the controls.
    pub fn forget(&mut self) {
        self.sent.clear();
    }

    /// Where each axis was sent to last: its code, and the raw value.
    pub fn sent(&self) -> &[(u64, i64)] {
        &self.sent
    }

    /// The same device after it was sent there.
    #[must_use]
    pub fn after(self, sent: Vec<(u64, i64)>) -> Self {
        Self { sent, ..self }
    }

    /// The controls that it has an axis for, as the engine lists them.
    pub fn axes(&self) -> impl Iterator<Item = AxisControl> {
        let bound = |control: &AxisControl| self.device.axis.iter().any(|a| a.control == *control);
        AxisControl::ALL.iter().copied().filter(bound)
    }

    /// Moves an axis to a position (−1..1, or 0..1 for lever and brakes), if it is not there yet.
    pub fn set(&mut self, context: &mut TickContext<'_>, control: AxisControl, position_norm: f64) {
        let Some(axis) = self.device.axis.iter().find(|axis| axis.control == control) else {
            return;
        };
        let (low, high) = (axis.raw_min.unwrap_or(-32767), axis.raw_max.unwrap_or(32767));
        let travel = match control.facts().travel {
            Travel::Centred => 0.5 * (position_norm + 1.0),
            Travel::FromEnd => position_norm,
        };
        let travel = clamp(if axis.inverted { 1.0 - travel } else { travel }, 0.0, 1.0);
        let raw = low + (travel * (high - low) as f64).round() as i64;
        let code = axis.code.number();
        match self.sent.iter_mut().find(|(sent_code, _)| *sent_code == code) {
            Some((_, sent)) if *sent == raw => return,
            Some((_, sent)) => *sent = raw,
            None => self.sent.push((code, raw)),
        }
        context.send(self.number, EventKind::Axis, code, raw);
    }

    /// Presses or releases a button.
    pub fn press(&self, context: &mut TickContext<'_>, control: ButtonControl, pressed: bool) {
        if let Some(button) = self.device.button.iter().find(|button| button.control == control) {
            let pressed = i64::from(pressed);
            context.send(self.number, EventKind::Button, button.code.number(), pressed);
        }
    }

    /// Presses a button and lets it go.
    pub fn tap(&self, context: &mut TickContext<'_>, control: ButtonControl) {
        self.press(context, control, true);
        self.press(context, control, false);
    }
}
