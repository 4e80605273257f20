//! What can be observed after a step: instruments, motion, and every load by its component.

use serde::{Deserialize, Serialize};

use crate::controls::{Commands, PilotControls};
use crate::frames::{Body, Euler, Load, Ned, Vec3};
use crate::isa::{PRESSURE_SL_PA, SOUND_SPEED_SL_MPS};
use crate::landing_gear::Leg;
use crate::listing::flags;
use crate::math::{sin_cos, sqrt, square};
use crate::pair::Pair;
use crate::state::Geodetic;
use crate::struts::Struts;
use crate::{actuators, engines, environment, fcc, rotors, weight_balance};

/// How much of the answer is left when the model is outside its validity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The answer is rough.
    Caution,
    /// The answer is no longer to be trusted.
    Warning,
    /// The flight is over: nothing after it means anything.
    Final,
}

/// What is told of a flag of [`Validity`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ValidityFacts {
    /// Which.
    pub flag: Validity,
    /// Its name in files and recordings; never changed.
    pub key: &'static str,
    /// Its name in words.
    pub words: &'static str,
    /// When it is set.
    pub description: &'static str,
    /// How much it matters.
    pub severity: Severity,
}

flags! {
    /// Where the model's answer is no longer to be trusted.
    pub struct Validity tells ValidityFacts {
        /// A tenth of a rotor's outer blades is beyond its greatest lift.
        ROTOR_STALL = 0 { key: "rotor_stall", words: "rotor stall", severity: Severity::Caution }
        /// A rotor descends into its own wake.
        VORTEX_RING = 1 { key: "vortex_ring", words: "vortex ring", severity: Severity::Warning }
        /// Beyond the speeds of the data, as the aircraft's envelope has them.
        SPEED = 2 { key: "speed", words: "speed", severity: Severity::Caution }
        /// Beyond the heights of the data.
        HEIGHT = 3 { key: "height", words: "height", severity: Severity::Caution }
        /// A strut is past its stroke.
        GEAR_BOTTOMED = 4 {
            key: "gear_bottomed", words: "gear bottomed", severity: Severity::Warning
        }
        /// A number stopped being finite; the aircraft stands still.
        FROZEN = 5 { key: "frozen", words: "numbers not finite", severity: Severity::Final }
        /// The hull touches the ground: a wreck.
        HULL = 6 { key: "hull", words: "hull on the ground", severity: Severity::Final }
        /// A rotor's gimbal is on its stop.
        FLAPPING_STOP = 7 {
            key: "flapping_stop", words: "flapping stop", severity: Severity::Caution
        }
        /// The rotors turn slower or faster than the data are for.
        ROTOR_SPEED = 8 { key: "rotor_speed", words: "rotor speed", severity: Severity::Caution }
        /// It turns faster than any flight: tables of steady flow know nothing of that.
        TUMBLING = 9 { key: "tumbling", words: "tumbling", severity: Severity::Warning }
    }
}

impl Validity {
    /// What is told of the gravest flag that is set; of several alike, of the lowest bit.
    pub fn gravest(self) -> Option<&'static ValidityFacts> {
        // `max_by_key` would give the last of several.
        self.told().reduce(|best, next| if next.severity > best.severity { next } else { best })
    }
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
    /// What the SCAS adds to the sticks.
    pub scas: fcc::scas::Outputs,
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
    /// Where the answer is not to be trusted.
    pub validity: Validity,
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
    let impact_pa = pressure_pa * (crate::math::pow_positive(1.0 + 0.2 * square(mach), 3.5) - 1.0);
    let ratio = crate::math::pow_positive(impact_pa / PRESSURE_SL_PA + 1.0, 2.0 / 7.0);
    SOUND_SPEED_SL_MPS * sqrt(5.0 * crate::math::max(0.0, ratio - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_of_latitude_is_a_nautical_mile() {
        let origin = Geodetic { latitude_rad: 0.785, ..Geodetic::default() };
        let mile_m = crate::units::NAUTICAL_MILE_M;
        let there = place(&origin, Vec3::new(mile_m, 0.0, -100.0));
        let minutes = crate::units::degrees(there.latitude_rad - origin.latitude_rad) * 60.0;
        assert!((minutes - 1.0).abs() < 0.003, "{minutes}");
        assert!((there.height_m - 100.0).abs() < 1e-12);
    }

    #[test]
    fn at_sea_level_calibrated_is_true() {
        let true_mps = 0.3 * SOUND_SPEED_SL_MPS;
        assert!((calibrated_airspeed(0.3, PRESSURE_SL_PA) - true_mps).abs() < 1e-6);
    }

    #[test]
    fn the_gravest_is_told_first_and_of_equals_the_lowest_bit() {
        let gravest = |flags: Validity| flags.gravest().map(|facts| facts.flag);
        assert_eq!(gravest(Validity::empty()), None);
        assert_eq!(gravest(Validity::all()), Some(Validity::FROZEN));
        let wreck = Validity::ROTOR_STALL | Validity::GEAR_BOTTOMED | Validity::HULL;
        assert_eq!(gravest(wreck), Some(Validity::HULL));
        assert_eq!(gravest(Validity::SPEED | Validity::HEIGHT), Some(Validity::SPEED));
    }

    #[test]
    fn flags_are_told_in_the_order_of_their_bits_and_unknown_ones_are_kept() {
        extern crate alloc;
        use alloc::string::ToString;
        assert_eq!(Validity::empty().to_string(), "nothing");
        assert_eq!((Validity::TUMBLING | Validity::SPEED).to_string(), "speed, tumbling");
        let newer = Validity::from_bits_retain(1 << 40 | 1);
        assert_eq!((newer.to_string().as_str(), newer.bits()), ("rotor stall", 1 << 40 | 1));
    }
}
