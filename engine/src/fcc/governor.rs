//! Collective governor: holds the rotor speed by collective; the lever sets the power.
//!
//! # Equations
//! ```text
//! e = Ω − Ω_ref        θ = θ_ff + K_P(βm)·e + K_I(βm)·∫e,  θ_min(βm) ≤ θ ≤ θ_max    [CR536 17 form]
//! θ_ff = θ_0(βm) + dθ/dXCOL(βm)·XCOL                                                       [CR536 8a-IV]
//! θ_min = max(θ_0(βm) − Δ, θ_Q)
//! ```
//! θ_ff is where the linkage puts the collective: θ_0 is the lever's bottom, which rises by 23.6° as the
//! masts tilt, about as the inflow does that the blades meet. What is left to the governor
//! between hover and 120 kt as an aeroplane is a few degrees either way.
//!
//! The source gives θ_0 as the lower limit, too, but counts it for a blade with another twist: for the same
//! thrust in the same flight its collective is higher by Δ. As a limit it would keep the governor from
//! steady flights that the aircraft flew. As a feed-forward it stays as printed: the governor adds what is
//! missing, and what the lever's bottom is for this blade no source says.
//!
//! As an aeroplane a degree of collective takes more torque, and the governor alone moves it. As a
//! helicopter it must be slow: the engines' power comes later than the lever's collective, and what a
//! quick governor holds of the rotor speed meanwhile it takes of the thrust, which in flight follows
//! the lever at once \[TM89428\]. Ω_ref moves to a newly selected speed at a fixed rate; speeds other than the
//! helicopter's are granted only with the nacelles down. The collective is never below θ_Q, the pitch of
//! least torque: beyond it less pitch takes more torque, and the governor would work the wrong way.
//! # Signs
//! Overspeed positive: it raises the collective.

use serde::{Deserialize, Serialize};

use crate::STEP_S;
use crate::controls::RPM_SELECT_LAST;
use crate::math::{FRAC_PI_2, clamp, max, min};
use crate::table::Table1;
use crate::table::axis::MastTilt;

/// Closer than this to the aeroplane the nacelles count as down.
const DOWN_RAD: f64 = 0.02;

/// What the governor is set to.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Selectable speeds: helicopter, aeroplane as first flown, aeroplane as designed.
    pub rotor_speed_radps: [f64; RPM_SELECT_LAST as usize + 1],
    /// How fast the reference moves between them.
    pub reference_radps2: f64,
    /// K_P over mast tilt.
    pub proportional_rad_per_radps: Table1<MastTilt>,
    /// K_I over mast tilt.
    pub integral_rad_per_rad: Table1<MastTilt>,
    /// θ_0 at ¾ radius, with the lever at its bottom, over mast tilt.
    pub lever_bottom_rad: Table1<MastTilt>,
    /// Δ: how much more collective the blade takes that θ_0 is counted for.
    pub collective_datum_rad: f64,
    /// θ_Q: pitch of least torque as a helicopter without thrust, at ¾ radius.
    pub least_torque_rad: f64,
    /// θ_max at ¾ radius.
    pub collective_rad_max: f64,
    /// How fast the governor may move the collective.
    pub collective_radps_max: f64,
}

/// What the governor remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Ω_ref.
    pub reference_radps: f64,
    /// K_I·∫e.
    pub integral_rad: f64,
    /// θ − θ_ff, rate-limited.
    pub correction_rad: f64,
}

/// What the governor reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// What the lever adds to its bottom.
    pub from_lever_rad: f64,
    /// Selected speed.
    pub rpm_select: u64,
    /// Ω.
    pub rotor_speed_radps: f64,
    /// βm.
    pub mast_tilt_rad: f64,
    /// Holds its last correction.
    pub failed: bool,
}

impl Params {
    /// θ_0 − Δ: what the linkage allows. The pilot's wheel goes there, beyond what the governor does itself.
    pub fn limit_rad(&self, mast_tilt_rad: f64) -> f64 {
        self.lever_bottom_rad.at(MastTilt(mast_tilt_rad)) - self.collective_datum_rad
    }

    /// θ_min.
    pub fn lowest_rad(&self, mast_tilt_rad: f64) -> f64 {
        max(self.limit_rad(mast_tilt_rad), self.least_torque_rad)
    }

    /// θ_ff.
    pub fn feed_forward_rad(&self, mast_tilt_rad: f64, from_lever_rad: f64) -> f64 {
        self.lever_bottom_rad.at(MastTilt(mast_tilt_rad)) + from_lever_rad
    }
}

/// The state after the tick, and the collective for both rotors, rad at ¾ radius.
pub fn update(params: &Params, state: &State, inputs: &Inputs) -> (State, f64) {
    let low_rad = params.lowest_rad(inputs.mast_tilt_rad);
    let feed_forward_rad = params.feed_forward_rad(inputs.mast_tilt_rad, inputs.from_lever_rad);
    let within = |rad: f64| {
        clamp(rad, low_rad - feed_forward_rad, params.collective_rad_max - feed_forward_rad)
    };
    let next = if inputs.failed {
        *state
    } else {
        let nacelles_down = inputs.mast_tilt_rad > FRAC_PI_2 - DOWN_RAD;
        let select = if nacelles_down { inputs.rpm_select.min(RPM_SELECT_LAST) } else { 0 };
        let selected_radps = params.rotor_speed_radps[select as usize];
        let step_radps = params.reference_radps2 * STEP_S;
        let reference_radps = state.reference_radps
            + clamp(selected_radps - state.reference_radps, -step_radps, step_radps);
        let tilt = MastTilt(inputs.mast_tilt_rad);
        let proportional = params.proportional_rad_per_radps.at(tilt);
        let integral = params.integral_rad_per_rad.at(tilt);
        let error_radps = inputs.rotor_speed_radps - reference_radps;
        // Bounding the integral by what the collective can do keeps it from winding up.
        let integral_rad = within(state.integral_rad + integral * error_radps * STEP_S);
        let wanted_rad = within(integral_rad + proportional * error_radps);
        let step_rad = params.collective_radps_max * STEP_S;
        let correction_rad =
            state.correction_rad + max(-step_rad, min(step_rad, wanted_rad - state.correction_rad));
        State { reference_radps, integral_rad, correction_rad }
    };
    (next, feed_forward_rad + within(next.correction_rad))
}

/// What the governor remembers while it holds the rotor speed that it reads with this collective.
pub fn settled(params: &Params, inputs: &Inputs, collective_rad: f64) -> State {
    let feed_forward_rad = params.feed_forward_rad(inputs.mast_tilt_rad, inputs.from_lever_rad);
    let correction_rad = collective_rad - feed_forward_rad;
    State {
        reference_radps: inputs.rotor_speed_radps,
        integral_rad: correction_rad,
        correction_rad,
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    fn params() -> Params {
        let flat = |y: f64| Table1::new(vec![0.0, FRAC_PI_2], vec![y; 2]);
        Params {
            rotor_speed_radps: [61.7, 54.1, 48.0],
            reference_radps2: 1.0,
            proportional_rad_per_radps: flat(0.0042),
            integral_rad_per_rad: flat(0.0033),
            lever_bottom_rad: Table1::new(vec![0.0, FRAC_PI_2], vec![-0.04, 0.37]),
            collective_datum_rad: 0.066,
            least_torque_rad: 0.017,
            collective_rad_max: 1.05,
            collective_radps_max: 0.087,
        }
    }

    fn inputs(mast_tilt_rad: f64, rotor_speed_radps: f64) -> Inputs {
        let (from_lever_rad, rpm_select, failed) = (0.0, 0, false);
        Inputs { from_lever_rad, rpm_select, rotor_speed_radps, mast_tilt_rad, failed }
    }

    /// The collective after half a minute at a rotor speed that no collective mends.
    fn held(mast_tilt_rad: f64, rotor_speed_radps: f64) -> f64 {
        let params = params();
        let mut state = State { reference_radps: 61.7, ..State::default() };
        let mut collective_rad = 0.0;
        for _ in 0..7_500 {
            (state, collective_rad) =
                update(&params, &state, &inputs(mast_tilt_rad, rotor_speed_radps));
        }
        collective_rad
    }

    #[test]
    fn slow_rotors_get_the_lowest_collective_and_no_less() {
        assert!((held(FRAC_PI_2, 50.0) - (0.37 - 0.066)).abs() < 1e-12);
        assert!((held(0.0, 50.0) - 0.017).abs() < 1e-12);
    }

    #[test]
    fn the_datum_moves_the_limit_and_not_the_feed_forward() {
        let params = params();
        let limit_rad = params.lowest_rad(FRAC_PI_2);
        assert!((params.feed_forward_rad(FRAC_PI_2, 0.0) - limit_rad - 0.066).abs() < 1e-12);
        let on_speed = inputs(FRAC_PI_2, 61.7);
        let settled = settled(&params, &on_speed, 0.37);
        assert!((update(&params, &settled, &on_speed).1 - 0.37).abs() < 1e-12);
    }
}
