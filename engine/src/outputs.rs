//! What can be observed after a step: instruments, motion, and every load by its component.

use serde::{Deserialize, Serialize};

use crate::controls::{Commands, PilotControls};
use crate::frames::{Body, Euler, Load, Ned, Vec3};
use crate::landing_gear::Leg;
use crate::math::{sin_cos, sqrt, square};
use crate::pair::Pair;
use crate::state::Geodetic;
use crate::struts::Struts;
use crate::{actuators, engines, environment, rotors, weight_balance};

/// Where the model's answer is no longer to be trusted, as bits of [`Outputs::validity`].
pub mod validity {
    /// A tenth of a rotor's outer blades is beyond its greatest lift.
    pub const ROTOR_STALL: u64 = 1;
    /// A rotor descends into its own wake.
    pub const VORTEX_RING: u64 = 1 << 1;
    /// Beyond the speeds of the data, 180 m/s.
    pub const SPEED: u64 = 1 << 2;
    /// Beyond the heights of the data, 12 km.
    pub const HEIGHT: u64 = 1 << 3;
    /// A strut is past its stroke.
    pub const GEAR_BOTTOMED: u64 = 1 << 4;
    /// A number stopped being finite; the aircraft stands still.
    pub const FROZEN: u64 = 1 << 5;
    /// The hull touches the ground: a wreck.
    pub const HULL: u64 = 1 << 6;
    /// A rotor's gimbal is on its stop.
    pub const FLAPPING_STOP: u64 = 1 << 7;
    /// The rotors turn slower than 0.7 of the helicopter's speed, or faster than their limit of 661 rpm.
    pub const ROTOR_SPEED: u64 = 1 << 8;
    /// It turns faster than 3 rad/s: tables of steady flow know nothing of that.
    pub const TUMBLING: u64 = 1 << 9;
}

/// Loads on the airframe by component, each about the centre of gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Loads {
    /// Rotors.
    pub rotors: Pair<Load>,
    /// Half wings with their pylons.
    pub wing_pylon: Pair<Load>,
    /// Fuselage and gear drag.
    pub fuselage: Load,
    /// Horizontal stabiliser.
    pub horizontal_stabilizer: Load,
    /// Fins.
    pub vertical_stabilizers: Pair<Load>,
    /// Engine jets.
    pub jets: Pair<Load>,
    /// Landing gear.
    pub landing_gear: Struts<Load>,
}

impl Loads {
    /// All together. Sides are added first, so that a mirrored aircraft rounds the same way.
    pub fn total(&self) -> Load {
        self.rotors.sum()
            + self.wing_pylon.sum()
            + self.fuselage
            + self.horizontal_stabilizer
            + self.vertical_stabilizers.sum()
            + self.jets.sum()
            + self.landing_gear.main.sum()
            + self.landing_gear.nose
    }
}

/// What can be observed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// Ticks flown.
    pub tick: u64,
    /// Where, on the ellipsoid: the point that is the centre of gravity as a helicopter. It is fixed in
    /// the structure, which the centre of gravity is not when the nacelles tilt.
    pub place: Geodetic,
    /// Where, from the origin: the centre of gravity.
    pub position_m: Vec3<Ned>,
    /// Centre of gravity over the ground.
    pub height_above_ground_m: f64,
    /// Over the ground.
    pub velocity_mps: Vec3<Ned>,
    /// Over the ground, in body axes.
    pub body_velocity_mps: Vec3<Body>,
    /// Roll, pitch, heading.
    pub euler: Euler,
    /// φ̇, θ̇, ψ̇.
    pub euler_rate: EulerRate,
    /// p, q, r.
    pub angular_rate_radps: Vec3<Body>,
    /// What an accelerometer at the centre of gravity reads.
    pub specific_force_mps2: Vec3<Body>,
    /// Load factor, 1 in level flight.
    pub load_factor: f64,
    /// True airspeed.
    pub airspeed_mps: f64,
    /// Calibrated airspeed.
    pub calibrated_airspeed_mps: f64,
    /// V/a.
    pub mach: f64,
    /// α.
    pub alpha_rad: f64,
    /// β.
    pub beta_rad: f64,
    /// The air.
    pub air: environment::Outputs,
    /// Mass and balance.
    pub balance: weight_balance::Outputs,
    /// Fuel aboard.
    pub fuel_kg: f64,
    /// Where the pilot holds everything.
    pub cockpit: PilotControls,
    /// What the computer asks for.
    pub commands: Commands,
    /// Where the surfaces, nacelles and gear are.
    pub actuators: actuators::State,
    /// Ω.
    pub rotor_speed_radps: f64,
    /// Azimuth of a right blade.
    pub rotor_azimuth_rad: f64,
    /// Rotors.
    pub rotors: Pair<rotors::Outputs>,
    /// Engines.
    pub engines: engines::Outputs,
    /// Landing gear.
    pub landing_gear: Struts<Leg>,
    /// By component.
    pub loads: Loads,
    /// All together, without gravity.
    pub total: Load,
    /// Where the answer is not to be trusted: bits of [`validity`].
    pub validity: u64,
}

/// Rates of the Euler angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EulerRate {
    /// φ̇.
    pub roll_radps: f64,
    /// θ̇.
    pub pitch_radps: f64,
    /// ψ̇.
    pub heading_radps: f64,
}

impl EulerRate {
    /// From body rates; near the vertical, where they grow without bound, as if 1° short of it.
    pub fn new(euler: Euler, rate: Vec3<Body>) -> Self {
        let (s, c) = sin_cos(euler.roll_rad);
        let (sin_pitch, cos_pitch) = sin_cos(euler.pitch_rad);
        let cos_pitch = crate::math::max(cos_pitch, 0.017);
        let heading_radps = (rate.y * s + rate.z * c) / cos_pitch;
        Self {
            roll_radps: rate.x + heading_radps * sin_pitch,
            pitch_radps: rate.y * c - rate.z * s,
            heading_radps,
        }
    }
}

/// WGS-84 semi-major axis, m.
const EARTH_M: f64 = 6_378_137.0;
/// WGS-84 first eccentricity squared.
const ECCENTRICITY2: f64 = 6.694_379_990_141_33e-3;

/// The place that lies `position_m` from `origin`, the flat world unrolled onto the ellipsoid.
///
/// Heights are kept; lengths along the meridian and the parallel of the origin are kept.
pub fn place(origin: &Geodetic, position_m: Vec3<Ned>) -> Geodetic {
    let (s, c) = sin_cos(origin.latitude_rad);
    let w2 = 1.0 - ECCENTRICITY2 * s * s;
    let w = sqrt(w2);
    let meridian_m = EARTH_M * (1.0 - ECCENTRICITY2) / (w2 * w) + origin.height_m;
    let parallel_m = (EARTH_M / w + origin.height_m) * c;
    Geodetic {
        latitude_rad: origin.latitude_rad + position_m.x / meridian_m,
        longitude_rad: origin.longitude_rad + position_m.y / parallel_m,
        height_m: origin.height_m - position_m.z,
    }
}

/// Calibrated airspeed of a Mach number at a pressure, m/s (subsonic).
pub fn calibrated_airspeed(mach: f64, pressure_pa: f64) -> f64 {
    const PRESSURE_SL_PA: f64 = 101_325.0;
    const SOUND_SL_MPS: f64 = 340.294;
    let impact_pa = pressure_pa * (crate::math::pow_positive(1.0 + 0.2 * square(mach), 3.5) - 1.0);
    let ratio = crate::math::pow_positive(impact_pa / PRESSURE_SL_PA + 1.0, 2.0 / 7.0);
    SOUND_SL_MPS * sqrt(5.0 * crate::math::max(0.0, ratio - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_of_latitude_is_a_nautical_mile() {
        let origin = Geodetic { latitude_rad: 0.785, ..Geodetic::default() };
        let there = place(&origin, Vec3::new(1852.0, 0.0, -100.0));
        let minutes = (there.latitude_rad - origin.latitude_rad) * 180.0 / crate::math::PI * 60.0;
        assert!((minutes - 1.0).abs() < 0.003, "{minutes}");
        assert!((there.height_m - 100.0).abs() < 1e-12);
    }

    #[test]
    fn at_sea_level_calibrated_is_true() {
        assert!((calibrated_airspeed(0.3, 101_325.0) - 0.3 * 340.294).abs() < 1e-6);
    }
}
