//! Stability and control augmentation: rate damping, attitude hold and quickening, in series with
//! the pilot's sticks.
//!
//! # Equations
//! ```text
//! w = x − x̄,  x̄˙ = w/τ_w                                  washed-out stick
//! pitch: −K_q·q − K_θ·(θ − θ_h) + (f_q − 1)·w_aft           within ± its authority
//! roll:  −K_p·p − K_φ·(φ − φ_h) + (f_p − 1)·w_right
//! yaw:   −K_r·(r − g·sin φ·cos θ/V) + (f_r − 1)·w_pedal
//! hold:  θ_h, φ_h follow the attitude while the stick moves or the axis is off, stand while it rests
//! ```
//! Gains fall with dynamic pressure by 1/(1 + q̄/q̄0).
//! # Signs
//! Stick aft, stick right, right pedal positive; so are q, p and r.
//! # Assumptions
//! The reference model's gains are not published; these are back-solved from TMX Table 8.3.2, as the
//! aircraft file says. Sensors and series actuators are ideal.

use serde::{Deserialize, Serialize};

use super::sensed::Sensed;
use crate::math::{clamp, cos, max, min, sin, wrap_angle};
use crate::{GRAVITY_MPS2, STEP_S};

/// What the SCAS is set to.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Pitch axis.
    pub pitch: Axis,
    /// Roll axis.
    pub roll: Axis,
    /// Yaw axis; its attitude gain is not used.
    pub yaw: Axis,
    /// τ_w.
    pub washout_s: f64,
    /// Stick further than this from its mean position is being moved.
    pub hold_stick_m: f64,
    /// How fast the held attitude follows while it does.
    pub hold_follow_s: f64,
    /// q̄0.
    pub dynamic_pressure_pa: f64,
}

/// What an axis is set to.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// K of the rate.
    pub rate_gain_m_per_radps: f64,
    /// K of the attitude.
    pub attitude_gain_m_per_rad: f64,
    /// f.
    pub feed_forward: f64,
    /// What the axis may add, either way.
    pub authority_m: f64,
    /// What its attitude hold may add, either way.
    pub hold_authority_m: f64,
}

/// What the SCAS remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// x̄ of the longitudinal stick.
    pub mean_aft_m: f64,
    /// x̄ of the lateral stick.
    pub mean_right_m: f64,
    /// x̄ of the pedals.
    pub mean_pedal_right_m: f64,
    /// θ_h.
    pub held_pitch_rad: f64,
    /// φ_h.
    pub held_roll_rad: f64,
}

/// The pilot's sticks, from neutral.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sticks {
    /// Longitudinal, aft positive.
    pub aft_m: f64,
    /// Lateral, right positive.
    pub right_m: f64,
    /// Pedals, right positive.
    pub pedal_right_m: f64,
}

/// Which axes work.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// Pitch.
    pub pitch: bool,
    /// Roll.
    pub roll: bool,
    /// Yaw.
    pub yaw: bool,
}

/// What the SCAS remembers after the tick.
fn remembered(
    params: &Params,
    state: &State,
    washed_out: &Sticks,
    on: Axes,
    sensed: &Sensed,
) -> State {
    let washout_step = STEP_S / params.washout_s;
    let follow = |works: bool, held_rad: f64, attitude_rad: f64, moved_m: f64| {
        let rests = works && moved_m.abs() < params.hold_stick_m && !sensed.weight_on_wheels;
        let step = if rests { 0.0 } else { min(1.0, STEP_S / params.hold_follow_s) };
        wrap_angle(held_rad + step * wrap_angle(attitude_rad - held_rad))
    };
    let (pitch_rad, roll_rad) = (sensed.euler.pitch_rad, sensed.euler.roll_rad);
    State {
        mean_aft_m: state.mean_aft_m + washout_step * washed_out.aft_m,
        mean_right_m: state.mean_right_m + washout_step * washed_out.right_m,
        mean_pedal_right_m: state.mean_pedal_right_m + washout_step * washed_out.pedal_right_m,
        held_pitch_rad: follow(on.pitch, state.held_pitch_rad, pitch_rad, washed_out.aft_m),
        held_roll_rad: follow(on.roll, state.held_roll_rad, roll_rad, washed_out.right_m),
    }
}

/// The series commands.
fn series(params: &Params, next: &State, washed_out: &Sticks, on: Axes, sensed: &Sensed) -> Sticks {
    let scale = 1.0 / (1.0 + sensed.dynamic_pressure_pa / params.dynamic_pressure_pa);
    let rate = sensed.angular_rate_radps;
    let euler = sensed.euler;
    // In a steady banked turn the yaw rate is not a disturbance; near hover there is no such turn.
    let turning = crate::math::ramp(sensed.airspeed_mps, 15.0, 30.0);
    let turn_radps = turning * GRAVITY_MPS2 * sin(euler.roll_rad) * cos(euler.pitch_rad)
        / max(sensed.airspeed_mps, 15.0);
    let command_m = |axis: &Axis, works: bool, rate_radps: f64, off_rad: f64, moved_m: f64| {
        if !works {
            return 0.0;
        }
        let hold_m = clamp(
            axis.attitude_gain_m_per_rad * wrap_angle(off_rad),
            -axis.hold_authority_m,
            axis.hold_authority_m,
        );
        let m = -scale * (axis.rate_gain_m_per_radps * rate_radps + hold_m)
            + (axis.feed_forward - 1.0) * moved_m;
        clamp(m, -axis.authority_m, axis.authority_m)
    };
    let pitch_off = euler.pitch_rad - next.held_pitch_rad;
    let roll_off = euler.roll_rad - next.held_roll_rad;
    let yaw_radps = rate.z - turn_radps;
    Sticks {
        aft_m: command_m(&params.pitch, on.pitch, rate.y, pitch_off, washed_out.aft_m),
        right_m: command_m(&params.roll, on.roll, rate.x, roll_off, washed_out.right_m),
        pedal_right_m: command_m(&params.yaw, on.yaw, yaw_radps, 0.0, washed_out.pedal_right_m),
    }
}

/// The state after the tick, and the sticks with the series commands added.
pub fn update(
    params: &Params,
    state: &State,
    sticks: &Sticks,
    on: Axes,
    sensed: &Sensed,
) -> (State, Sticks) {
    let washed_out = Sticks {
        aft_m: sticks.aft_m - state.mean_aft_m,
        right_m: sticks.right_m - state.mean_right_m,
        pedal_right_m: sticks.pedal_right_m - state.mean_pedal_right_m,
    };
    let next = remembered(params, state, &washed_out, on, sensed);
    let added = series(params, &next, &washed_out, on, sensed);
    let augmented = Sticks {
        aft_m: sticks.aft_m + added.aft_m,
        right_m: sticks.right_m + added.right_m,
        pedal_right_m: sticks.pedal_right_m + added.pedal_right_m,
    };
    (next, augmented)
}

/// What the SCAS remembers once the sticks have rested: they are their own mean, and the attitude is
/// the held one.
pub fn settled(sticks: &Sticks, sensed: &Sensed) -> State {
    State {
        mean_aft_m: sticks.aft_m,
        mean_right_m: sticks.right_m,
        mean_pedal_right_m: sticks.pedal_right_m,
        held_pitch_rad: sensed.euler.pitch_rad,
        held_roll_rad: sensed.euler.roll_rad,
    }
}
