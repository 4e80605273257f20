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
