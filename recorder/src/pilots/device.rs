//! The device that exists in the cockpit map only.

use engine::cockpit::{self, AxisControl, ButtonControl};
use engine::inputs::EventKind;
use engine::math::clamp;

use crate::hands::Reach;

/// Name of the device in the cockpit map that pilot models and scripts use.
pub const DEVICE: &str = "pilot";

/// A device that exists in the map only: moves controls by sending what a real one would send.
pub struct VirtualDevice {
    number: u64,
    device: cockpit::Device,
    sent: Vec<(u64, i64)>,
}

impl VirtualDevice {
    /// The device called [`DEVICE`], if the map has it.
    pub fn of(map: &cockpit::Params) -> Option<Self> {
        let number = map.device.iter().position(|device| device.name == DEVICE)?;
        Some(Self { number: number as u64, device: map.device[number].clone(), sent: Vec::new() })
    }

    /// Moves an axis to a position (−1..1, or 0..1 for lever and brakes), if it is not there yet.
    pub fn set(&mut self, reach: &mut Reach<'_>, control: AxisControl, position_norm: f64) {
        let Some(axis) = self.device.axis.iter().find(|axis| axis.control == control) else {
            return;
        };
        let (low, high) = (axis.raw_min.unwrap_or(-32767), axis.raw_max.unwrap_or(32767));
        let from_end = matches!(
            control,
            AxisControl::Collective | AxisControl::BrakeLeft | AxisControl::BrakeRight
        );
        let travel = if from_end { position_norm } else { 0.5 * (position_norm + 1.0) };
        let travel = clamp(if axis.inverted { 1.0 - travel } else { travel }, 0.0, 1.0);
        let raw = low + (travel * (high - low) as f64).round() as i64;
        match self.sent.iter_mut().find(|(code, _)| *code == axis.code) {
            Some((_, sent)) if *sent == raw => return,
            Some((_, sent)) => *sent = raw,
            None => self.sent.push((axis.code, raw)),
        }
        reach.send(self.number, EventKind::Axis, axis.code, raw);
    }

    /// Presses or releases a button.
    pub fn press(&self, reach: &mut Reach<'_>, control: ButtonControl, pressed: bool) {
        if let Some(button) = self.device.button.iter().find(|button| button.control == control) {
            reach.send(self.number, EventKind::Button, button.code, i64::from(pressed));
        }
    }

    /// Presses a button and lets it go.
    pub fn tap(&self, reach: &mut Reach<'_>, control: ButtonControl) {
        self.press(reach, control, true);
        self.press(reach, control, false);
    }
}
