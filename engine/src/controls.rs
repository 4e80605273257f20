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
///
/// Reserved in the recorded layout: no control waits yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PickUp {
    /// Controls that wait: the bit of each [`AxisControl`](crate::cockpit::AxisControl)'s place.
    pub waiting: u64,
    /// Where the hardware stands.
    pub hardware: AxisPositions,
}

/// Positions of the axes, in the ranges of [`PilotControls`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxisPositions {
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
}

/// Force trim: the positions in which stick and pedals are at rest.
///
/// Reserved in the recorded layout: nothing releases or moves them yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceTrim {
    /// 1 while the release button is pressed.
    pub released: u64,
    /// Stick, aft positive.
    pub stick_aft_norm: f64,
    /// Stick, right positive.
    pub stick_right_norm: f64,
    /// Pedals, right positive.
    pub pedal_right_norm: f64,
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
