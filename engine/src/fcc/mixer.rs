//! Mixer: augmented sticks and collective to rotor and surface commands.
//!
//! # Equations
//! ```text
//! θ_R,L = θ ∓ dθ/dXLT(βm)·XLT        B1_R,L = dB1/dXLN(βm)·XLN ∓ dB1/dXP(βm, V)·XP       [CR536 8a]
//! A1_R,L = g(βm)·A1(V)                                       programmed, outboard          [CR536 8a]
//! δe = K_e·XLN     δr = K_r·XP     δa = ±K_a·XLT
//! ```
//! # Signs
//! XLN forward, XLT right, XP right positive: stick forward tilts both discs forward and lowers the
//! elevator's trailing edge; stick right takes collective off the right rotor and raises the right
//! flaperon; right pedal tilts the right disc aft and the left one forward.
//! A1 positive tilts both discs outboard; the programme is negative, against the lateral flapping of
//! forward flight.

use serde::Deserialize;

use super::scas::Sticks;
use super::sensed::Sensed;
use crate::controls::{Commands, FLAP_DETENT_LAST, PilotControls};
use crate::math::clamp;
use crate::pair::Pair;
use crate::table::axis::{Airspeed, MastTilt};
use crate::table::{Table1, Table2};

/// Gearing.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// dθ/dXCOL over mast tilt.
    pub collective_per_lever_rad_per_m: Table1<MastTilt>,
    /// dθ/dXLT over mast tilt.
    pub collective_per_lateral_stick_rad_per_m: Table1<MastTilt>,
    /// dB1/dXLN over mast tilt.
    pub cyclic_per_longitudinal_stick_rad_per_m: Table1<MastTilt>,
    /// dB1/dXP over mast tilt and airspeed.
    pub cyclic_per_pedal_rad_per_m: Table2<MastTilt, Airspeed>,
    /// A1 over airspeed.
    pub lateral_cyclic_rad: Table1<Airspeed>,
    /// g over mast tilt.
    pub lateral_cyclic_norm: Table1<MastTilt>,
    /// K_e.
    pub elevator_per_longitudinal_stick_rad_per_m: f64,
    /// K_r.
    pub rudder_per_pedal_rad_per_m: f64,
    /// K_a, mean of up and down going side.
    pub flaperon_per_lateral_stick_rad_per_m: f64,
    /// Flap angle of each detent.
    pub flap_rad: [f64; FLAP_DETENT_LAST as usize + 1],
    /// Weight on wheels keeps the masts at least this upright.
    pub mast_tilt_on_ground_rad_max: f64,
}

/// What the lever alone asks of the collective, from the bottom of the lever, rad.
pub fn lever_collective(params: &Params, mast_tilt_rad: f64, lever_m: f64) -> f64 {
    params.collective_per_lever_rad_per_m.at(MastTilt(mast_tilt_rad)) * lever_m
}

/// All commands.
pub fn mix(
    params: &Params,
    sticks: &Sticks,
    collective_rad: f64,
    pilot: &PilotControls,
    sensed: &Sensed,
) -> Commands {
    let tilt_rad = sensed.mast_tilt_rad;
    let (tilt, airspeed) = (MastTilt(tilt_rad), Airspeed(sensed.airspeed_mps));
    let forward_m = -sticks.aft_m;
    let differential_rad = params.collective_per_lateral_stick_rad_per_m.at(tilt) * sticks.right_m;
    let cyclic_rad = params.cyclic_per_longitudinal_stick_rad_per_m.at(tilt) * forward_m;
    let yaw_rad = params.cyclic_per_pedal_rad_per_m.at(tilt, airspeed) * sticks.pedal_right_m;
    let lateral_rad = params.lateral_cyclic_norm.at(tilt) * params.lateral_cyclic_rad.at(airspeed);
    let aileron_rad = params.flaperon_per_lateral_stick_rad_per_m * sticks.right_m;
    let detent = pilot.flap_detent.min(FLAP_DETENT_LAST) as usize;
    let locked = sensed.weight_on_wheels
        && pilot.nacelle_aft_norm < 0.0
        && tilt_rad >= params.mast_tilt_on_ground_rad_max;
    let parked = if pilot.parking_brake != 0 { 1.0 } else { 0.0 };
    Commands {
        collective_rad: Pair {
            left: collective_rad + differential_rad,
            right: collective_rad - differential_rad,
        },
        cyclic_forward_rad: Pair { left: cyclic_rad + yaw_rad, right: cyclic_rad - yaw_rad },
        cyclic_outboard_rad: Pair::both(lateral_rad),
        elevator_rad: params.elevator_per_longitudinal_stick_rad_per_m * forward_m,
        flaperon_rad: Pair { left: aileron_rad, right: -aileron_rad },
        rudder_right_rad: params.rudder_per_pedal_rad_per_m * sticks.pedal_right_m,
        flap_rad: params.flap_rad[detent],
        nacelle_aft_norm: if locked { 0.0 } else { clamp(pilot.nacelle_aft_norm, -1.0, 1.0) },
        gear_down: pilot.gear_down,
        lever_norm: pilot.collective_norm,
        brake_norm: pilot.brake_norm.map(|brake| clamp(brake + parked, 0.0, 1.0)),
    }
}
