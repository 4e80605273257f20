//! The steady flight that is asked for.

use engine::frames::Vec3;
use engine::inputs::{Failures, World};
use engine::state::Geodetic;

/// A steady flight to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// βm.
    pub mast_tilt_rad: f64,
    /// True airspeed.
    pub airspeed_mps: f64,
    /// What the engines are to do.
    pub power: Power,
    /// ψ̇, to the right positive.
    pub turn_radps: f64,
    /// β; beyond ±90° the air comes from behind: 180° is rearward flight.
    pub sideslip_rad: f64,
    /// Where the nose points.
    pub heading_rad: f64,
    /// Above mean sea level.
    pub altitude_m: f64,
    /// The origin of NED, and the ground there.
    pub origin: Geodetic,
    /// Fuel aboard.
    pub fuel_kg: f64,
    /// Flap lever's detent, 0..3.
    pub flap_detent: u64,
    /// Rotor speed selected: 0 helicopter, 1 and 2 aeroplane.
    pub rpm_select: u64,
    /// 1 with the gear down.
    pub gear_down: u64,
    /// 1 with the SCAS on; it is centred.
    pub scas_on: u64,
    /// The world. Its ground is what the rotors feel under them.
    pub world: World,
}

/// What the engines are to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Power {
    /// Whatever this climb takes, m/s upwards.
    Climb(f64),
    /// What the lever gives at this position, 0..1; the climb follows.
    Lever(f64),
}

/// Ground that no rotor feels, m.
pub const GROUND_FAR_BELOW_M: f64 = -1e5;

impl Default for Target {
    /// Hover as a helicopter at sea level, far from the ground, flaps 40/25, gear up.
    fn default() -> Self {
        Self {
            mast_tilt_rad: 0.0,
            airspeed_mps: 0.0,
            power: Power::Climb(0.0),
            turn_radps: 0.0,
            sideslip_rad: 0.0,
            heading_rad: 0.0,
            altitude_m: 0.0,
            origin: Geodetic::default(),
            fuel_kg: 669.0,
            flap_detent: 2,
            rpm_select: 0,
            gear_down: 0,
            scas_on: 0,
            world: World::default().with_ground(GROUND_FAR_BELOW_M),
        }
    }
}

impl Target {
    /// Whether left and right are alike in it.
    pub(super) fn is_symmetric(&self) -> bool {
        let failed = self.world.failures & Failures::ENGINES;
        self.turn_radps == 0.0
            && self.sideslip_rad == 0.0
            && (failed.is_empty() || failed == Failures::ENGINES)
            && self.world.wind_mps == Vec3::zero()
    }
}
