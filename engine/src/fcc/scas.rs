//! Stability and control augmentation: rate damping, attitude and heading hold, quickening and automatic
//! pitch trim, in series with the pilot's sticks.
//!
//! # Equations
//! ```text
//! w = x − x̄,  x̄˙ = w/τ_w                                  washed-out stick
//! pitch: −K_q·q − K_θ·(θ − θ_h) + (f_q − 1)·w_aft           within ± its authority
//! roll:  −K_p·p − K_φ·(φ − φ_h) + (f_p − 1)·w_right
//! yaw:   −K_r·(r − g·sin φ·cos θ/V) − K_ψ·Δψ + (f_r − 1)·w_pedal
//! hold:  θ_h, φ_h follow the attitude while the stick moves or the axis is off, stand while it rests;
//!        Δψ˙ = r·cos φ + q·sin φ while the pedals rest and nothing turns, else Δψ goes to 0
//! ```
//! Gains fall with dynamic pressure by 1/(1 + q̄/q̄0).
//!
//! Automatic pitch trim, while the stick rests in the detent in which it was let go:
//! ```text
//! pitch:  −K_q·q − K_t·(θ − θ_h − k·s·(V − V_h)),  θ̇_h = k_i·s·(V − V_h) + s·A(βm)·β̇m
//! trim:   ẋ_t = what the axis adds/τ_t + s·B(βm)·β̇m     within its rate and authority; x_t adds to the stick
//! ```
//! A and B: what pitch and stick a conversion takes, given at once, and not when the speed has
//! changed. V_h goes with the nacelles along the middle of the corridor: V̇_h = s·C(βm)·β̇m.
//! s is 0 below 15 m/s and 1 from 30 m/s of V_h: slower it holds the attitude. V_h follows the airspeed,
//! and x_t stands, while the pilot has the stick; on the wheels x_t goes back to 0.
//! # Signs
//! Stick aft, stick right, right pedal positive; so are q, p and r. A nose that rises slows down.
//! # Assumptions
//! That it has pitch and roll attitude retention, heading hold, airspeed sensors and automatic pitch trim
//! is published; the reference model's gains are not. Rate gains and feed-forward are back-solved
//! from TMX Table 8.3.2, the others estimates, as the aircraft file says. Sensors and series actuators
//! are ideal.

use serde::{Deserialize, Serialize};

use super::sensed::Sensed;
use crate::listing::flags;
use crate::math::{clamp, cos, max, min, ramp, sin, wrap_angle};
use crate::table::Table1;
use crate::table::axis::MastTilt;
use crate::{GRAVITY_MPS2, STEP_S};

/// No speed that is not the held one takes the nose further than this by itself, up or down. An estimate.
const BY_SPEED_RAD_MAX: f64 = 0.35;

/// What the SCAS is set to.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Pitch axis.
    pub pitch: Axis,
    /// Roll axis.
    pub roll: Axis,
    /// Yaw axis; its attitude is the heading.
    pub yaw: Axis,
    /// τ_w.
    pub washout_s: f64,
    /// Stick further than this from its mean position is being moved; within it of where it rests when it
    /// is let go, it has been.
    pub hold_stick_m: f64,
    /// How fast the held attitude follows while it does.
    pub hold_follow_s: f64,
    /// q̄0.
    pub dynamic_pressure_pa: f64,
    /// Yaw rate, and that of the turn a bank makes, up to which the heading is held.
    pub heading_hold_radps_max: f64,
    /// Automatic pitch trim.
    pub pitch_trim: PitchTrim,
}

/// What the automatic pitch trim is set to.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PitchTrim {
    /// K_t: takes the place of the pitch axis's K of the attitude.
    pub attitude_gain_m_per_rad: f64,
    /// k.
    pub attitude_by_speed_s_rad_per_m: f64,
    /// k_i.
    pub attitude_rate_by_speed_rad_per_m: f64,
    /// A.
    pub attitude_by_tilt_norm: Table1<MastTilt>,
    /// B, aft positive.
    pub stick_by_tilt_m_per_rad: Table1<MastTilt>,
    /// C.
    pub speed_by_tilt_mps_per_rad: Table1<MastTilt>,
    /// τ_t.
    pub take_over_s: f64,
    /// How fast the trim moves.
    pub trim_mps_max: f64,
    /// What the trim may add, either way.
    pub authority_m: f64,
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
    /// Δψ: how far the nose has turned since its heading is held.
    pub turned_rad: f64,
    /// V_h.
    pub held_airspeed_mps: f64,
    /// x_t.
    pub trim_aft_m: f64,
}

/// What the SCAS adds to the sticks, and whether that is all it may.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// To the longitudinal stick, the trim apart.
    pub aft_m: f64,
    /// To the lateral stick.
    pub right_m: f64,
    /// To the pedals.
    pub pedal_right_m: f64,
    /// x_t.
    pub trim_aft_m: f64,
    /// 1 while the automatic pitch trim is at work.
    pub trims: u64,
    /// What is at the end of its authority.
    pub saturated: Saturation,
}

/// What is told of a flag of [`Saturation`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SaturationFacts {
    /// Which.
    pub flag: Saturation,
    /// Its name in files and recordings; never changed.
    pub key: &'static str,
    /// Its name in words.
    pub words: &'static str,
    /// When it is set.
    pub description: &'static str,
}

flags! {
    /// What of the SCAS is at the end of its authority.
    pub struct Saturation tells SaturationFacts {
        /// The pitch axis asks for more than it may add.
        PITCH = 0 { key: "pitch", words: "pitch" }
        /// The roll axis does.
        ROLL = 1 { key: "roll", words: "roll" }
        /// The yaw axis does.
        YAW = 2 { key: "yaw", words: "yaw" }
        /// The automatic pitch trim is at its end.
        PITCH_TRIM = 3 { key: "pitch_trim", words: "pitch trim" }
    }
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
    /// Where the longitudinal stick rests when it is let go.
    pub rest_aft_m: f64,
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

/// s.
fn holds_speed(state: &State) -> f64 {
    ramp(state.held_airspeed_mps, 15.0, 30.0)
}

/// What is the case in a tick.
struct Moment<'a> {
    params: &'a Params,
    sensed: &'a Sensed,
    on: Axes,
    /// w.
    washed_out: Sticks,
    /// Whether the automatic pitch trim is at work.
    trims: bool,
    /// Yaw rate of the steady turn that this bank makes.
    turn_radps: f64,
}

impl Moment<'_> {
    fn rests(&self, works: bool, moved_m: f64) -> bool {
        works && moved_m.abs() < self.params.hold_stick_m && !self.sensed.weight_on_wheels
    }

    fn holds_heading(&self) -> bool {
        let slow = |radps: f64| radps.abs() < self.params.heading_hold_radps_max;
        self.rests(self.on.yaw, self.washed_out.pedal_right_m)
            && self.washed_out.right_m.abs() < self.params.hold_stick_m
            && slow(self.sensed.angular_rate_radps.z)
            && slow(self.turn_radps)
    }

    /// s·(V − V_h).
    fn too_fast_mps(&self, state: &State) -> f64 {
        holds_speed(state) * (self.sensed.airspeed_mps - state.held_airspeed_mps)
    }

    /// What the SCAS remembers after the tick, the trim as it was.
    fn remembered(&self, state: &State) -> State {
        let Self { params, sensed, on, washed_out, .. } = self;
        let washout_step = STEP_S / params.washout_s;
        let step = min(1.0, STEP_S / params.hold_follow_s);
        let follow = |stands: bool, held_rad: f64, attitude_rad: f64| {
            let step = if stands { 0.0 } else { step };
            wrap_angle(held_rad + step * wrap_angle(attitude_rad - held_rad))
        };
        let euler = sensed.euler;
        let pitch_rests = self.rests(on.pitch, washed_out.aft_m);
        let roll_rests = self.rests(on.roll, washed_out.right_m);
        let held_pitch_rad = follow(pitch_rests, state.held_pitch_rad, euler.pitch_rad);
        let (pitch_step_rad, airspeed_step_mps) = if self.trims {
            let trim = &params.pitch_trim;
            let tilt = MastTilt(sensed.mast_tilt_rad);
            let tilted_rad = STEP_S * holds_speed(state) * sensed.mast_tilt_rate_radps;
            let by_speed_rad =
                STEP_S * trim.attitude_rate_by_speed_rad_per_m * self.too_fast_mps(state);
            (
                by_speed_rad + trim.attitude_by_tilt_norm.at(tilt) * tilted_rad,
                trim.speed_by_tilt_mps_per_rad.at(tilt) * tilted_rad,
            )
        } else {
            (0.0, step * (sensed.airspeed_mps - state.held_airspeed_mps))
        };
        // Who has let go in a steep attitude keeps it.
        let highest_rad = max(held_pitch_rad.abs(), BY_SPEED_RAD_MAX);
        State {
            mean_aft_m: state.mean_aft_m + washout_step * washed_out.aft_m,
            mean_right_m: state.mean_right_m + washout_step * washed_out.right_m,
            mean_pedal_right_m: state.mean_pedal_right_m + washout_step * washed_out.pedal_right_m,
            held_pitch_rad: clamp(held_pitch_rad + pitch_step_rad, -highest_rad, highest_rad),
            held_roll_rad: follow(roll_rests, state.held_roll_rad, euler.roll_rad),
            turned_rad: self.turned(state, step),
            held_airspeed_mps: state.held_airspeed_mps + airspeed_step_mps,
            trim_aft_m: state.trim_aft_m,
        }
    }

    /// Δψ after the tick. That the nose points exactly the other way cannot come up: it has no side.
    fn turned(&self, state: &State, step: f64) -> f64 {
        if !self.holds_heading() {
            return state.turned_rad - step * state.turned_rad;
        }
        let (rate, roll_rad) = (self.sensed.angular_rate_radps, self.sensed.euler.roll_rad);
        state.turned_rad + STEP_S * (rate.z * cos(roll_rad) + rate.y * sin(roll_rad))
    }

    /// The series commands, and which axes are at their ends.
    fn series(&self, next: &State) -> Outputs {
        let Self { params, sensed, on, washed_out, .. } = self;
        let scale = 1.0 / (1.0 + sensed.dynamic_pressure_pa / params.dynamic_pressure_pa);
        let (rate, euler) = (sensed.angular_rate_radps, sensed.euler);
        let command = |axis: &Axis, works: bool, rate_radps: f64, hold_m: f64, moved_m: f64| {
            if !works {
                return (0.0, false);
            }
            let m = -scale * (axis.rate_gain_m_per_radps * rate_radps + hold_m)
                + (axis.feed_forward - 1.0) * moved_m;
            let within_m = clamp(m, -axis.authority_m, axis.authority_m);
            (within_m, m.abs() > axis.authority_m)
        };
        let held = |axis: &Axis, off_rad: f64| {
            let hold_m = axis.attitude_gain_m_per_rad * wrap_angle(off_rad);
            clamp(hold_m, -axis.hold_authority_m, axis.hold_authority_m)
        };
        let pitch_off_rad = euler.pitch_rad - next.held_pitch_rad;
        let pitch_hold_m = if self.trims {
            let trim = &params.pitch_trim;
            let by_speed_rad = clamp(
                trim.attitude_by_speed_s_rad_per_m * self.too_fast_mps(next),
                -BY_SPEED_RAD_MAX,
                BY_SPEED_RAD_MAX,
            );
            trim.attitude_gain_m_per_rad * wrap_angle(pitch_off_rad - by_speed_rad)
        } else {
            held(&params.pitch, pitch_off_rad)
        };
        let roll_hold_m = held(&params.roll, euler.roll_rad - next.held_roll_rad);
        let heading_hold_m = held(&params.yaw, next.turned_rad);
        let yaw_radps = rate.z - self.turn_radps;
        let (aft_m, pitch) =
            command(&params.pitch, on.pitch, rate.y, pitch_hold_m, washed_out.aft_m);
        let (right_m, roll) =
            command(&params.roll, on.roll, rate.x, roll_hold_m, washed_out.right_m);
        let (pedal_right_m, yaw) =
            command(&params.yaw, on.yaw, yaw_radps, heading_hold_m, washed_out.pedal_right_m);
        let mut saturated = Saturation::empty();
        saturated.set(Saturation::PITCH, pitch);
        saturated.set(Saturation::ROLL, roll);
        saturated.set(Saturation::YAW, yaw);
        Outputs {
            aft_m,
            right_m,
            pedal_right_m,
            trim_aft_m: next.trim_aft_m,
            trims: u64::from(self.trims),
            saturated,
        }
    }

    /// x_t after the tick, and whether it is at its end.
    fn trim(&self, state: &State, added_aft_m: f64) -> (f64, bool) {
        let Self { sensed, params, .. } = self;
        let &PitchTrim { take_over_s, trim_mps_max, authority_m, .. } = &params.pitch_trim;
        let trim_aft_m = state.trim_aft_m;
        let wanted_mps = if sensed.weight_on_wheels {
            -trim_aft_m / take_over_s
        } else if self.trims {
            let tilting =
                params.pitch_trim.stick_by_tilt_m_per_rad.at(MastTilt(sensed.mast_tilt_rad));
            added_aft_m / take_over_s + holds_speed(state) * tilting * sensed.mast_tilt_rate_radps
        } else {
            0.0
        };
        let moved_m = trim_aft_m + STEP_S * clamp(wanted_mps, -trim_mps_max, trim_mps_max);
        (clamp(moved_m, -authority_m, authority_m), moved_m.abs() > authority_m)
    }
}

/// The state after the tick, the sticks with the series commands and the trim added, and what those
/// are.
pub fn update(
    params: &Params,
    state: &State,
    sticks: &Sticks,
    on: Axes,
    sensed: &Sensed,
) -> (State, Sticks, Outputs) {
    let washed_out = Sticks {
        aft_m: sticks.aft_m - state.mean_aft_m,
        right_m: sticks.right_m - state.mean_right_m,
        pedal_right_m: sticks.pedal_right_m - state.mean_pedal_right_m,
        rest_aft_m: 0.0,
    };
    // In a steady banked turn the yaw rate is not a disturbance; near hover there is no such turn.
    let euler = sensed.euler;
    let turning = ramp(sensed.airspeed_mps, 15.0, 30.0);
    let turn_radps = turning * GRAVITY_MPS2 * sin(euler.roll_rad) * cos(euler.pitch_rad)
        / max(sensed.airspeed_mps, 15.0);
    let let_go = (sticks.aft_m - sticks.rest_aft_m).abs() < params.hold_stick_m;
    let mut now = Moment { params, sensed, on, washed_out, trims: false, turn_radps };
    now.trims = let_go && now.rests(on.pitch, now.washed_out.aft_m);
    let mut next = now.remembered(state);
    let mut added = now.series(&next);
    let (trim_aft_m, at_end) = now.trim(state, added.aft_m);
    next.trim_aft_m = trim_aft_m;
    added.trim_aft_m = trim_aft_m;
    added.saturated.set(Saturation::PITCH_TRIM, at_end);
    let augmented = Sticks {
        aft_m: sticks.aft_m + added.aft_m + next.trim_aft_m,
        right_m: sticks.right_m + added.right_m,
        pedal_right_m: sticks.pedal_right_m + added.pedal_right_m,
        ..*sticks
    };
    (next, augmented, added)
}

/// What the SCAS remembers once the sticks have rested: they are their own mean, attitude and airspeed
/// are the held ones, and nothing has turned or is trimmed away.
pub fn settled(sticks: &Sticks, sensed: &Sensed) -> State {
    State {
        mean_aft_m: sticks.aft_m,
        mean_right_m: sticks.right_m,
        mean_pedal_right_m: sticks.pedal_right_m,
        held_pitch_rad: sensed.euler.pitch_rad,
        held_roll_rad: sensed.euler.roll_rad,
        turned_rad: 0.0,
        held_airspeed_mps: sensed.airspeed_mps,
        trim_aft_m: 0.0,
    }
}
