//! What a pilot has to know of the aircraft beside its limits: speeds to fly, and how it answers.
//!
//! No block of the physics reads it. Pilot models do; they have the limits from `envelope`, `engines`
//! and `fcc.governor`, and gains of their own, which are the same for every aircraft.
//!
//! # Signs
//! Nose up, lever up, climb positive.
//! # Assumptions
//! An aircraft that answers twice or half as strongly is flown nevertheless: the pilot makes up for it
//! by what is felt.

use serde::Deserialize;

use crate::table::Invalid;

/// Speeds to fly, and the aircraft's answer to attitude and lever.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Calibrated airspeed at which a conversion begins, as a helicopter.
    pub helicopter_mps: f64,
    /// Calibrated airspeed of a circuit as an aeroplane.
    pub circuit_mps: f64,
    /// Calibrated airspeed of a cruise as an aeroplane.
    pub cruise_mps: f64,
    /// Least speed of a steep descent as a helicopter: fast enough to leave its own wake.
    pub descent_mps: f64,
    /// Speed over the ground of a landing with an engine that gives nothing.
    pub run_on_mps: f64,
    /// Airspeed of the descent without engines.
    pub glide_mps: f64,
    /// Calibrated airspeed below which an aeroplane has its flaps at the second detent.
    pub flap_down_mps: f64,
    /// Calibrated airspeed above which an aeroplane has its flaps at the first detent.
    pub flap_up_mps: f64,
    /// Airspeed below which it is flown as over a spot.
    pub over_a_spot_mps_max: f64,
    /// Airspeed above which it is flown by bank and heading.
    pub flying_mps_min: f64,
    /// Airspeed above which the wing carries enough of the weight that attitude alone makes height.
    pub wing_borne_mps_min: f64,
    /// Angle of attack that is not exceeded while the wing carries.
    pub alpha_rad_max: f64,
    /// Height of the centre of gravity over the ground with the wheels on it.
    pub standing_m: f64,
    /// Height over the ground at which the flare of a landing without engines begins.
    pub flare_m: f64,
    /// Height over the ground at which the lever cushions that landing.
    pub cushion_m: f64,
    /// Lift over mass for an angle of attack, by dynamic pressure: Z_α/q.
    pub lift_m2_per_kg_rad: f64,
    /// Z_l: acceleration along the masts for the whole lever in hover.
    pub lever_mps2: f64,
    /// The power over mass that the whole lever adds: what is left of Z_l at speed is that over V.
    pub lever_w_per_kg: f64,
    /// Dynamic pressure at which half of a stick movement does the same.
    pub half_stick_pa: f64,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        [
            (
                "pilot.over_a_spot_max",
                self.over_a_spot_mps_max < self.flying_mps_min,
                "slower than flying_min",
            ),
            ("pilot.flap_down", self.flap_down_mps < self.flap_up_mps, "slower than flap_up"),
            ("pilot.cushion", self.cushion_m < self.flare_m, "lower than flare"),
        ]
        .into_iter()
        .try_for_each(|(key, holds, expected)| holds.then_some(()).ok_or(Invalid { key, expected }))
    }
}
