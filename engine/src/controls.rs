//! Controls: what the cockpit tells the flight control computer, and what that asks of the actuators.
//!
//! # Signs
//! Of the pilot: stick aft, stick right, right pedal, collective up, nacelles towards the helicopter
//! positive. Of the surfaces: trailing edge down and right positive; cyclic tilts the disc forward and
//! outboard.

use serde::{Deserialize, Serialize};

use crate::pair::Pair;

/// The number of the last flap detent.
pub const FLAP_DETENT_LAST: u64 = 3;
/// The number of the last rotor speed.
pub const RPM_SELECT_LAST: u64 = 2;

/// Where the pilot holds everything. Booleans are 0 or 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PilotControls {
    /// −1 full forward … 1 full aft.
    pub stick_aft_norm: f64,
    /// −1 full left … 1 full right.
    pub stick_right_norm: f64,
    /// 0 down … 1 up.
    pub collective_norm: f64,
    /// −1 full left … 1 full right pedal.
    pub pedal_right_norm: f64,
    /// Toe brakes, 0 … 1.
    pub brake_norm: Pair<f64>,
    /// Nacelle switch: −1 forward, 0 released, 1 aft.
    pub nacelle_aft_norm: f64,
    /// Flap lever's detent, 0 (up) to 3.
    pub flap_detent: u64,
    /// Gear handle down.
    pub gear_down: u64,
    /// Parking brake set.
    pub parking_brake: u64,
    /// SCAS switched on.
    pub scas_on: u64,
    /// Rotor speed selected: 0 helicopter, 1 and 2 aeroplane.
    pub rpm_select: u64,
    /// How often the marker was pressed.
    pub markers: u64,
    /// Controls that wait for the hardware to come to where they are.
    pub pick_up: PickUp,
    /// Where the stick and pedals are trimmed to.
    pub force_trim: ForceTrim,
}

/// Pick-up: a control stays where the aircraft has it until the hardware crosses that position, so that a
/// lever that stands elsewhere when a flight begins or a device is replaced does not make it jump.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PickUp {
    /// Bits from 0: controls that wait, each by its place in the list of
    /// [`AxisControl`](crate::cockpit::AxisControl). Twelve bits each from 16: the lower axis of a joined
    /// pair, 0 at rest, 4095 at its end, of stick aft, stick right, collective and pedals.
    pub waiting: u64,
    /// Where the hardware of a control stands that waits, is a joined pair, or moves at a rate: its own
    /// deflection, to which the trim comes.
    pub hardware: AxisPositions,
}

/// Positions of the axes, in the ranges of [`PilotControls`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxisPositions {
    /// −1 full forward … 1 full aft.
    pub stick_aft_norm: f64,
    /// −1 full left … 1 full right.
    pub stick_right_norm: f64,
    /// 0 down … 1 up; at a rate −1 … 1.
    pub collective_norm: f64,
    /// −1 full left … 1 full right pedal.
    pub pedal_right_norm: f64,
    /// Toe brakes, 0 … 1.
    pub brake_norm: Pair<f64>,
}

/// Force trim: the positions in which stick and pedals are at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceTrim {
    /// Bit 0: the release button is held. What else is remembered of switches: bits from 1, trim switches
    /// that are held; from 8, waiting controls whose hardware stands above them; from 16, controls that
    /// move at a rate; from 32, axes used as buttons that are pressed, in the order of the map.
    pub released: u64,
    /// Stick, aft positive.
    pub stick_aft_norm: f64,
    /// Stick, right positive.
    pub stick_right_norm: f64,
    /// Pedals, right positive.
    pub pedal_right_norm: f64,
}

/// One bit of a number that remembers several.
fn put(bits: &mut u64, bit: u64, on: bool) {
    *bits = *bits & !(1 << bit) | u64::from(on) << bit;
}

const LOWER_BITS: u64 = 12;
const LOWER_MAX: u64 = (1 << LOWER_BITS) - 1;

impl PickUp {
    /// Whether the control at this place of the list waits.
    pub fn waits(&self, place: u64) -> bool {
        self.waiting >> place & 1 != 0
    }

    pub(crate) fn wait(&mut self, place: u64, on: bool) {
        put(&mut self.waiting, place, on);
    }

    /// The lower axis of a joined pair, 0 … 1.
    pub(crate) fn lower_norm(&self, place: u64) -> f64 {
        (self.waiting >> (16 + place * LOWER_BITS) & LOWER_MAX) as f64 / LOWER_MAX as f64
    }

    /// Remembers it as exactly as there are bits.
    pub(crate) fn put_lower(&mut self, place: u64, at_norm: f64) {
        let shift = 16 + place * LOWER_BITS;
        let counts = (at_norm * LOWER_MAX as f64 + 0.5) as u64;
        self.waiting = self.waiting & !(LOWER_MAX << shift) | counts.min(LOWER_MAX) << shift;
    }
}

impl ForceTrim {
    const TRIM_SWITCHES: u64 = 0b111_1110;
    const MOVING: u64 = 0xff_0000;

    /// Whether the release button is held.
    pub fn is_released(&self) -> bool {
        self.released & 1 != 0
    }

    pub(crate) fn release(&mut self, on: bool) {
        put(&mut self.released, 0, on);
    }

    /// Whether a trim switch is held: 0 aft, 1 forward, 2 right, 3 left, 4 and 5 pedals right and left.
    pub(crate) fn holds(&self, switch: u64) -> bool {
        self.released >> (1 + switch) & 1 != 0
    }

    pub(crate) fn hold(&mut self, switch: u64, on: bool) {
        put(&mut self.released, 1 + switch, on);
    }

    /// Whether the hardware of the waiting control at this place stands above it.
    pub(crate) fn is_above(&self, place: u64) -> bool {
        self.released >> (8 + place) & 1 != 0
    }

    pub(crate) fn put_above(&mut self, place: u64, on: bool) {
        put(&mut self.released, 8 + place, on);
    }

    /// Whether the control at this place moves at a rate.
    pub(crate) fn moves(&self, place: u64) -> bool {
        self.released >> (16 + place) & 1 != 0
    }

    pub(crate) fn put_moving(&mut self, place: u64, on: bool) {
        put(&mut self.released, 16 + place, on);
    }

    /// Whether any control moves without an event.
    pub(crate) fn anything_moves(&self) -> bool {
        self.released & (Self::TRIM_SWITCHES | Self::MOVING) != 0
    }

    /// Whether an axis used as a button is pressed; beyond 32 of them they are not remembered.
    pub(crate) fn is_pressed(&self, button: u64) -> bool {
        button < 32 && self.released >> (32 + button) & 1 != 0
    }

    pub(crate) fn put_pressed(&mut self, button: u64, on: bool) {
        if button < 32 {
            put(&mut self.released, 32 + button, on);
        }
    }
}

/// What the actuators are asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Commands {
    /// θ at ¾ radius.
    pub collective_rad: Pair<f64>,
    /// B1.
    pub cyclic_forward_rad: Pair<f64>,
    /// A1.
    pub cyclic_outboard_rad: Pair<f64>,
    /// δe, trailing edge down.
    pub elevator_rad: f64,
    /// Beyond the flap's setting, down.
    pub flaperon_rad: Pair<f64>,
    /// δr, trailing edge right.
    pub rudder_right_rad: f64,
    /// Flap, down.
    pub flap_rad: f64,
    /// Nacelles: −1 towards the aeroplane, 1 towards the helicopter.
    pub nacelle_aft_norm: f64,
    /// Gear: 1 down.
    pub gear_down: u64,
    /// Power lever.
    pub lever_norm: f64,
    /// Wheel brakes.
    pub brake_norm: Pair<f64>,
}

impl Commands {
    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        let pairs = [self.collective_rad, self.cyclic_forward_rad, self.cyclic_outboard_rad]
            .into_iter()
            .chain([self.flaperon_rad, self.brake_norm]);
        pairs
            .flat_map(|pair| [pair.left, pair.right])
            .chain([self.elevator_rad, self.rudder_right_rad, self.flap_rad])
            .chain([self.nacelle_aft_norm, self.lever_norm])
            .all(f64::is_finite)
    }
}
