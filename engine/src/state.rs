//! Everything the aircraft remembers: plain numbers of eight bytes.

use alloc::format;
use alloc::string::String;

use serde::{Deserialize, Serialize};

use crate::aero::horizontal_stabilizer;
use crate::controls::{AxisPositions, ForceTrim, PickUp, PilotControls};
use crate::frames::{Attitude, Body, Ned, Vec3};
use crate::landing_gear::TyreDeflection;
use crate::pair::Pair;
use crate::struts::Struts;
use crate::{actuators, engines, environment, eom, fcc, rotors};

/// The whole state. No pointers, no NaN, no −0.0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Ticks flown.
    pub tick: u64,
    /// 1 once a number of the motion stopped being finite: the aircraft stands still from there.
    pub frozen: u64,
    /// Where the pilot holds everything.
    pub cockpit: PilotControls,
    /// Flight control computer.
    pub fcc: fcc::State,
    /// Actuators.
    pub actuators: actuators::State,
    /// Turbulence.
    pub environment: environment::State,
    /// Motion, rotors, engines, gear.
    pub plant: Plant,
    /// How fast the plant changed in the tick before, for the integration.
    pub rate: PlantRate,
}

/// What moves by physics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Plant {
    /// Where the origin of NED is.
    pub origin: Geodetic,
    /// Centre of gravity.
    pub position_m: Vec3<Ned>,
    /// Its velocity over the ground.
    pub velocity_mps: Vec3<Ned>,
    /// Attitude.
    pub attitude: Attitude,
    /// ω.
    pub angular_rate_radps: Vec3<Body>,
    /// Inflow and flapping of each rotor; the left one as its mirror image.
    pub rotors: Pair<rotors::State>,
    /// Downwash on its way from the wing to the tail.
    pub horizontal_stabilizer: horizontal_stabilizer::State,
    /// Ω of both rotors.
    pub rotor_speed_radps: f64,
    /// Azimuth of a right blade, 0..2π from aft; the left rotor's is its mirror image.
    pub rotor_azimuth_rad: f64,
    /// Engines.
    pub engines: Pair<engines::State>,
    /// Fuel aboard.
    pub fuel_kg: f64,
    /// How far the tyres are deflected in the plane of the ground.
    pub tyre_deflections: Struts<TyreDeflection>,
    /// 1 while a main wheel bears weight.
    pub weight_on_wheels: u64,
}

/// A place on the WGS-84 ellipsoid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Geodetic {
    /// North positive.
    pub latitude_rad: f64,
    /// East positive.
    pub longitude_rad: f64,
    /// Above mean sea level.
    pub height_m: f64,
}

/// How fast the plant changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlantRate {
    /// Of the motion.
    pub motion: eom::Rate,
    /// Of the downwash at the tail.
    pub horizontal_stabilizer: horizontal_stabilizer::Rate,
    /// Of rotor speed, power and fuel.
    pub engines: engines::Rate,
}

/// Every floating-point number of a part of the state, to be looked at or changed in place.
///
/// The macro below names every field without a rest pattern: a new field that is forgotten here does
/// not compile.
trait Numbers {
    fn each(&mut self, f: &mut impl FnMut(&mut f64));

    /// Their names, in the order of `each`, behind the name of what they are a part of.
    fn names(&self, of: &str, f: &mut impl FnMut(String));
}

impl Numbers for f64 {
    fn each(&mut self, f: &mut impl FnMut(&mut f64)) {
        f(self);
    }

    fn names(&self, of: &str, f: &mut impl FnMut(String)) {
        f(of.into());
    }
}

impl Numbers for u64 {
    fn each(&mut self, _: &mut impl FnMut(&mut f64)) {}

    fn names(&self, _: &str, _: &mut impl FnMut(String)) {}
}

impl<F> Numbers for Vec3<F> {
    fn each(&mut self, f: &mut impl FnMut(&mut f64)) {
        f(&mut self.x);
        f(&mut self.y);
        f(&mut self.z);
    }

    fn names(&self, of: &str, f: &mut impl FnMut(String)) {
        ["x", "y", "z"].iter().for_each(|name| f(format!("{of}.{name}")));
    }
}

macro_rules! numbers {
    ($($name:ty { $($field:ident),+ $(,)? })+) => {
        $(impl Numbers for $name {
            fn each(&mut self, f: &mut impl FnMut(&mut f64)) {
                let Self { $($field),+ } = self;
                $($field.each(f);)+
            }

            fn names(&self, of: &str, f: &mut impl FnMut(String)) {
                let dot = if of.is_empty() { "" } else { "." };
                $(self.$field.names(&format!("{of}{dot}{}", stringify!($field)), f);)+
            }
        })+
    };
}

impl<T: Numbers> Numbers for Pair<T> {
    fn each(&mut self, f: &mut impl FnMut(&mut f64)) {
        self.left.each(f);
        self.right.each(f);
    }

    fn names(&self, of: &str, f: &mut impl FnMut(String)) {
        self.left.names(&format!("{of}.left"), f);
        self.right.names(&format!("{of}.right"), f);
    }
}

impl<T: Numbers> Numbers for Struts<T> {
    fn each(&mut self, f: &mut impl FnMut(&mut f64)) {
        self.nose.each(f);
        self.main.each(f);
    }

    fn names(&self, of: &str, f: &mut impl FnMut(String)) {
        self.nose.names(&format!("{of}.nose"), f);
        self.main.names(&format!("{of}.main"), f);
    }
}

numbers! {
    State { tick, frozen, cockpit, fcc, actuators, environment, plant, rate }
    PilotControls {
        stick_aft_norm, stick_right_norm, collective_norm, pedal_right_norm, brake_norm,
        nacelle_aft_norm, flap_detent, gear_down, parking_brake, scas_on, rpm_select, markers,
        pick_up, force_trim,
    }
    PickUp { waiting, hardware }
    AxisPositions {
        stick_aft_norm, stick_right_norm, collective_norm, pedal_right_norm, brake_norm,
    }
    ForceTrim { released, stick_aft_norm, stick_right_norm, pedal_right_norm }
    fcc::State { scas, governor }
    fcc::scas::State {
        mean_aft_m, mean_right_m, mean_pedal_right_m, held_pitch_rad, held_roll_rad,
        turned_rad, held_airspeed_mps, trim_aft_m,
    }
    fcc::governor::State { reference_radps, integral_rad, correction_rad }
    actuators::State {
        collective_rad, cyclic_forward_rad, cyclic_outboard_rad, elevator_rad, flaperon_rad, rudder_right_rad, flap_rad,
        mast_tilt_rad, mast_tilt_rate_radps, gear_extension_norm, lever_norm, brake_norm,
    }
    environment::State {
        noise, mirrored, turbulence_mps, lateral_stage_mps, vertical_stage_mps,
    }
    Plant {
        origin, position_m, velocity_mps, attitude, angular_rate_radps, rotors,
        horizontal_stabilizer, rotor_speed_radps, rotor_azimuth_rad, engines, fuel_kg, tyre_deflections, weight_on_wheels,
    }
    Geodetic { latitude_rad, longitude_rad, height_m }
    Attitude { w, x, y, z }
    rotors::State { inflow, flapping }
    rotors::inflow::State { mean_mps, aft_mps, right_mps }
    rotors::flapping::State {
        coning_rad, coning_radps, aft_rad, aft_radps, right_rad, right_radps,
        elastic_aft_rad, elastic_aft_radps, elastic_right_rad, elastic_right_radps,
    }
    horizontal_stabilizer::State { downwash_rad }
    engines::State { power_w }
    TyreDeflection { forward_m, right_m }
    PlantRate { motion, horizontal_stabilizer, engines }
    horizontal_stabilizer::Rate { downwash_radps }
    eom::Rate { acceleration_mps2, angular_acceleration_radps2 }
    engines::Rate { power_w_per_s, rotor_speed_radps2, fuel_kg_per_s }
}

impl State {
    /// Simulated time, s: ticks times the step, never summed.
    pub fn time_s(&self) -> f64 {
        self.tick as f64 * crate::STEP_S
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        let mut finite = true;
        let mut copy = *self;
        copy.each(&mut |number| finite &= number.is_finite());
        finite
    }

    /// Every floating-point number in turn, to be looked at or changed in place.
    pub fn each_number(&mut self, mut f: impl FnMut(&mut f64)) {
        self.each(&mut f);
    }

    /// The names of the numbers, in the same order, with the parts that they are in:
    /// `plant.engines.left.power_w`.
    pub fn number_names(&self) -> alloc::vec::Vec<String> {
        let mut names = alloc::vec::Vec::new();
        self.names("", &mut |name| names.push(name));
        names
    }

    /// With every −0.0 made +0.0, so that equal states have equal bits.
    #[must_use]
    pub fn without_negative_zeros(mut self) -> Self {
        self.make_zeros_positive();
        self
    }

    /// Makes every −0.0 +0.0; says whether every number is finite.
    pub(crate) fn make_zeros_positive(&mut self) -> bool {
        let mut finite = true;
        self.each(&mut |number| {
            *number += 0.0;
            finite &= number.is_finite();
        });
        finite
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_has_its_name() {
        let mut state = State::default();
        let names = state.number_names();
        let mut count = 0;
        state.each_number(|number| {
            if names[count] == "plant.engines.right.power_w" {
                *number = 7.0;
            }
            count += 1;
        });
        assert_eq!(count, names.len());
        assert_eq!(state.plant.engines.right.power_w.to_bits(), 7.0f64.to_bits());
    }

    #[test]
    fn no_negative_zero_and_no_nan_escapes() {
        let mut state = State::default();
        state.plant.tyre_deflections.main.right.right_m = -0.0;
        let kept = state.without_negative_zeros();
        assert_eq!(kept.plant.tyre_deflections.main.right.right_m.to_bits(), 0);
        assert!(state.is_finite());
        state.rate.engines.power_w_per_s.left = f64::NAN;
        assert!(!state.is_finite());
    }
}
