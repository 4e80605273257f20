//! Hand–eye coordination: from what the pilot wants to stick, pedals and lever.
//!
//! # Equations
//! ```text
//! wanted:  a = k_V·(V − V_now),  a_up = k_c·(climb − climb_now)                each within its limit
//! learned: ⎡a   ⎤   ⎡−g     Z_l·sin β⎤ ⎡Δθ⎤
//!          ⎣a_up⎦ = ⎣ Z_α   Z_l·cos β⎦·⎣Δl⎦
//! hands:   θ, l = part of what is wanted + ∫ rate · learned⁻¹·(wanted − felt)
//! ```
//! As a helicopter (β = 0) that is speed by attitude and climb by lever; as an aeroplane (β = 90°)
//! climb by attitude and speed by lever; between them what a conversion needs. The aircraft may answer
//! twice or half as strongly: the integral of what is felt makes up for it.
//! # Signs
//! θ nose up, l lever up, β mast tilt with 0 as a helicopter. Stick aft, stick right, right pedal
//! positive.

use engine::frames::Attitude;
use engine::math::{atan2, clamp, cos, min, ramp, sin, wrap_angle};
use engine::{GRAVITY_MPS2, Outputs, STEP_S, pilot};

use super::handbook::Handbook;

/// Ticks between two movements of the hands.
pub const HAND_TICKS: u64 = 5;
/// Time between them, s.
pub const HAND_S: f64 = HAND_TICKS as f64 * STEP_S;

/// What the pilot wants to hold.
#[derive(Clone, Copy, Debug, Default)]
pub struct Aim {
    /// Along the nose: over the ground when slow, through the air when fast.
    pub forward_mps: f64,
    /// Over the ground whatever the speed.
    pub over_ground: bool,
    /// To the right over the ground, when slow.
    pub right_mps: f64,
    /// Flown as over a spot however fast it goes to the side or back.
    pub any_way: bool,
    /// What that speed is to change by anyway.
    pub forward_mps2: f64,
    /// Greatest acceleration along the nose.
    pub forward_mps2_max: f64,
    /// Upwards.
    pub climb_mps: f64,
    /// Where the nose points.
    pub heading_rad: f64,
    /// Bank that the pilot allows when fast.
    pub bank_rad_max: f64,
}

/// Stick, lever and pedals.
#[derive(Clone, Copy, Debug, Default)]
pub struct Positions {
    /// Longitudinal.
    pub stick_aft_norm: f64,
    /// Lateral.
    pub stick_right_norm: f64,
    /// Pedals.
    pub pedal_right_norm: f64,
    /// Power lever.
    pub lever_norm: f64,
}

/// What is seen out of the window, on the dials, and felt in the seat.
#[derive(Clone, Copy, Debug, Default)]
pub struct Observation {
    /// Over the ground along the nose.
    pub forward_mps: f64,
    /// Over the ground to the right.
    pub right_mps: f64,
    /// Upwards.
    pub climb_mps: f64,
    /// Acceleration along the nose, level.
    pub forward_mps2: f64,
    /// Upwards.
    pub up_mps2: f64,
    /// Part of the weight that is on the wheels.
    pub on_wheels_norm: f64,
}

impl Observation {
    /// Looks.
    pub fn look(seen: &Outputs) -> Self {
        let (s, c) = (sin(seen.euler.heading_rad), cos(seen.euler.heading_rad));
        let v = seen.velocity_mps;
        let felt = Attitude::from_euler(seen.euler).ned_from_body() * seen.specific_force_mps2;
        let legs = &seen.landing_gear;
        let push_n = legs.nose.push_n + legs.main.map(|leg| leg.push_n).sum();
        Self {
            forward_mps: v.x * c + v.y * s,
            right_mps: v.y * c - v.x * s,
            climb_mps: -v.z,
            forward_mps2: felt.x * c + felt.y * s,
            up_mps2: -felt.z - GRAVITY_MPS2,
            on_wheels_norm: push_n / (seen.balance.mass_kg * GRAVITY_MPS2),
        }
    }
}

/// Slower than this no power is divided by the speed, m/s.
const STILL_MPS: f64 = 1.0;
/// Greatest vertical acceleration asked for, m/s².
const UP_MPS2_MAX: f64 = 2.0;
/// k_V, 1/s.
const SPEED_PER_S: f64 = 0.3;
/// k_c over a spot and in flight, 1/s.
const CLIMB_PER_S: [f64; 2] = [0.8, 0.5];
/// How fast the lever makes up for what is felt, over a spot and in flight, 1/s.
const LEARN_LEVER_PER_S: [f64; 2] = [0.9, 0.5];
/// How fast the attitude does, 1/s.
const LEARN_PITCH_PER_S: [f64; 2] = [0.4, 0.8];
/// Part of what is wanted that the hands do at once.
const AT_ONCE: f64 = 0.7;
/// What is felt is felt with this lag, s.
const FEEL_S: f64 = 0.25;
/// Attitude that the pilot does not exceed, rad.
const PITCH_RAD_MAX: f64 = 0.3;
/// Lever that is taken back for a torque beyond the limit, by that part of it, 1/s; how fast it is given
/// again, 1/s; and what is always left.
const TORQUE_PER_S: f64 = 0.5;
const LEVER_AGAIN_PER_S: f64 = 0.05;
const LEVER_NORM_LEFT: f64 = 0.3;
/// Off the climb by more than this the lever serves no speed, m/s.
const CLIMB_FIRST_MPS: f64 = 2.0;
/// Beyond the middle between hovering and flying: what holds for one holds for the other no longer.
const HALF: f64 = 0.5;
/// Part of the weight on the wheels from which on nothing is learned.
const ON_WHEELS_NORM: f64 = 0.1;
/// Time in which the stick is let go on the ground, s.
const LET_GO_S: f64 = 0.7;

/// Pitch: rate by attitude, 1/s, and at most, rad/s; stick by rate, s/rad of its half travel, learned at
/// that much a second too; and as far as it is held by learning.
const PITCH_PER_S: f64 = 1.8;
const PITCH_RADPS_MAX: f64 = 0.2;
const STICK_BY_PITCH: f64 = 1.8;
const STICK_AFT_NORM_MAX: f64 = 0.9;
/// Roll, alike; what is learned a second is less: a roll is over sooner.
const ROLL_PER_S: f64 = 1.5;
const ROLL_RADPS_MAX: f64 = 0.35;
const STICK_BY_ROLL: f64 = 0.9;
const STICK_BY_ROLL_LEARNED: f64 = 0.4;
const STICK_RIGHT_NORM_MAX: f64 = 0.6;
/// Yaw over a spot: rate by heading, 1/s, and at most, rad/s; pedal by the rate that is wanted, and by what
/// it is off, s/rad; by heading a second, near the heading, 1/(rad·s) and rad.
const YAW_PER_S: f64 = 0.6;
const YAW_RADPS_MAX: f64 = 0.2;
const PEDAL_BY_YAW: f64 = 2.2;
const PEDAL_BY_YAW_OFF: f64 = 2.5;
const PEDAL_BY_HEADING_PER_S: f64 = 0.25;
const NEAR_HEADING_RAD: f64 = 0.15;
/// Yaw in flight: pedal by the ball, 1/g, and by the turn's rate that is off, s/rad; all of it at once, and
/// learned a second, 1/s.
const PEDAL_BY_BALL: f64 = 0.8;
const PEDAL_BY_TURN_OFF: f64 = 0.5;
const BALL_AT_ONCE: f64 = 0.9;
const BALL_LEARNED_PER_S: f64 = 0.3;
const PEDAL_NORM_MAX: f64 = 0.7;
/// Bank over a spot: by speed to the side that is off, at once, rad per m/s, and at most, rad; learned a
/// second, rad/m, at most, rad, and forgotten in flight, s.
const BANK_BY_SIDE: f64 = 0.04;
const BANK_RAD_MAX: f64 = 0.2;
const BANK_BY_SIDE_LEARNED: f64 = 0.006;
const LEVEL_RAD_MAX: f64 = 0.15;
const FORGET_S: f64 = 2.0;
/// Bank in flight: turn by heading, 1/s, and at most, rad/s.
const TURN_PER_S: f64 = 0.2;
const TURN_RADPS_MAX: f64 = 0.35;
/// Nobody throws an aircraft into a turn: fifteen degrees a second, over a spot three times that, rad/s.
const BANKING_RADPS: [f64; 2] = [0.25, 0.75];

/// How far it flies: 0 as a helicopter over a spot, 1 by bank and heading.
pub fn flying(seen: &Outputs, book: &pilot::Params) -> f64 {
    ramp(seen.airspeed_mps, book.over_a_spot_mps_max, book.flying_mps_min)
}

/// What the hands remember.
#[derive(Clone, Copy, Debug, Default)]
pub struct Skill {
    felt_forward_mps2: f64,
    felt_up_mps2: f64,
    pitch_rad: f64,
    lever_norm: f64,
    lever_norm_max: f64,
    roll_rad: f64,
    roll_level_rad: f64,
    stick_aft_norm: f64,
    stick_right_norm: f64,
    pedal_right_norm: f64,
}

impl Skill {
    /// Takes the controls over where they are.
    pub fn taking_over(seen: &Outputs) -> Self {
        Self {
            pitch_rad: seen.euler.pitch_rad,
            roll_rad: seen.euler.roll_rad,
            lever_norm: seen.cockpit.collective_norm,
            lever_norm_max: 1.0,
            stick_aft_norm: seen.cockpit.stick_aft_norm,
            stick_right_norm: seen.cockpit.stick_right_norm,
            pedal_right_norm: seen.cockpit.pedal_right_norm,
            ..Self::default()
        }
    }

    /// Lowers the lever and lets the stick go, on the wheels.
    pub fn settle(&mut self, lower_per_s: f64) -> Positions {
        let fade = 1.0 - HAND_S / LET_GO_S;
        self.stick_aft_norm *= fade;
        self.stick_right_norm *= fade;
        self.pedal_right_norm *= fade;
        self.lever_norm = clamp(self.lever_norm - lower_per_s * HAND_S, 0.0, 1.0);
        Positions {
            stick_aft_norm: self.stick_aft_norm,
            stick_right_norm: self.stick_right_norm,
            pedal_right_norm: self.pedal_right_norm,
            lever_norm: self.lever_norm,
        }
    }

    /// Moves the hands once.
    pub fn fly(&mut self, seen: &Outputs, aim: &Aim, book: &Handbook) -> Positions {
        let eyes = Observation::look(seen);
        let flying = if aim.any_way { 0.0 } else { flying(seen, &book.pilot) };
        let (pitch_rad, lever_norm) = self.pitch_and_lever(seen, &eyes, (aim, book), flying);
        self.sticks(seen, (aim, &book.pilot), flying, (pitch_rad, lever_norm))
    }

    /// The same with pitch and lever that are known.
    pub fn hold(
        &mut self,
        seen: &Outputs,
        aim: &Aim,
        (pitch_rad, lever_norm): (f64, f64),
        book: &Handbook,
    ) -> Positions {
        (self.pitch_rad, self.lever_norm) = (pitch_rad, lever_norm);
        let flying = flying(seen, &book.pilot);
        self.sticks(seen, (aim, &book.pilot), flying, (pitch_rad, lever_norm))
    }

    /// Stick and pedals that serve an attitude.
    fn sticks(
        &mut self,
        seen: &Outputs,
        (aim, book): (&Aim, &pilot::Params),
        flying: f64,
        (pitch_rad, lever_norm): (f64, f64),
    ) -> Positions {
        let eyes = Observation::look(seen);
        let roll_rad = self.roll(seen, &eyes, aim, flying);
        let on_wheels = eyes.on_wheels_norm > ON_WHEELS_NORM;

        // The faster, the lighter the hand.
        let q_pa = 0.5 * seen.air.density_kg_per_m3 * seen.airspeed_mps * seen.airspeed_mps;
        let light = 1.0 / (1.0 + q_pa / book.half_stick_pa);
        let rate = seen.angular_rate_radps;
        let pitch_radps = clamp(
            PITCH_PER_S * (pitch_rad - seen.euler.pitch_rad),
            -PITCH_RADPS_MAX,
            PITCH_RADPS_MAX,
        );
        let turn_radps = flying * GRAVITY_MPS2 * sin(seen.euler.roll_rad)
            / engine::math::max(seen.airspeed_mps, book.over_a_spot_mps_max);
        let pull_off = pitch_radps + turn_radps * sin(seen.euler.roll_rad) - rate.y;
        let roll_radps =
            clamp(ROLL_PER_S * (roll_rad - seen.euler.roll_rad), -ROLL_RADPS_MAX, ROLL_RADPS_MAX);
        let roll_off = roll_radps - rate.x;
        let learn = if on_wheels { 0.0 } else { HAND_S };
        self.stick_aft_norm = clamp(
            self.stick_aft_norm + STICK_BY_PITCH * light * pull_off * learn,
            -STICK_AFT_NORM_MAX,
            STICK_AFT_NORM_MAX,
        );
        self.stick_right_norm = clamp(
            self.stick_right_norm + STICK_BY_ROLL_LEARNED * roll_off * learn,
            -STICK_RIGHT_NORM_MAX,
            STICK_RIGHT_NORM_MAX,
        );
        let (spot_foot, ball_foot) = self.feet(seen, aim, flying, (turn_radps, learn));
        Positions {
            stick_aft_norm: self.stick_aft_norm + STICK_BY_PITCH * light * pull_off,
            stick_right_norm: self.stick_right_norm + STICK_BY_ROLL * roll_off,
            pedal_right_norm: self.pedal_right_norm
                + (1.0 - flying) * spot_foot
                + flying * BALL_AT_ONCE * ball_foot,
            lever_norm,
        }
    }

    /// What the feet do at once over a spot, and in flight; what they have learned is kept.
    fn feet(
        &mut self,
        seen: &Outputs,
        aim: &Aim,
        flying: f64,
        (turn_radps, learn): (f64, f64),
    ) -> (f64, f64) {
        let rate = seen.angular_rate_radps;

        // Slow: the nose by pedals. Fast: the ball in the middle.
        let heading_off = wrap_angle(aim.heading_rad - seen.euler.heading_rad);
        let yaw_radps = clamp(YAW_PER_S * heading_off, -YAW_RADPS_MAX, YAW_RADPS_MAX);
        let spot_foot = PEDAL_BY_YAW * yaw_radps + PEDAL_BY_YAW_OFF * (yaw_radps - rate.z);
        let ball = -seen.specific_force_mps2.y / GRAVITY_MPS2;
        let ball_foot = PEDAL_BY_BALL * ball + PEDAL_BY_TURN_OFF * (turn_radps - rate.z);
        let nearly = if heading_off.abs() < NEAR_HEADING_RAD { heading_off } else { 0.0 };
        let learned_foot = (1.0 - flying) * PEDAL_BY_HEADING_PER_S * nearly
            + flying * BALL_LEARNED_PER_S * ball_foot;
        self.pedal_right_norm =
            clamp(self.pedal_right_norm + learned_foot * learn, -PEDAL_NORM_MAX, PEDAL_NORM_MAX);
        (spot_foot, ball_foot)
    }

    fn pitch_and_lever(
        &mut self,
        seen: &Outputs,
        eyes: &Observation,
        (aim, book): (&Aim, &Handbook),
        flying: f64,
    ) -> (f64, f64) {
        let feel = HAND_S / FEEL_S;
        self.felt_forward_mps2 += feel * (eyes.forward_mps2 - self.felt_forward_mps2);
        self.felt_up_mps2 += feel * (eyes.up_mps2 - self.felt_up_mps2);

        let through_air = if aim.over_ground { 0.0 } else { flying };
        let now_mps = eyes.forward_mps + through_air * (seen.airspeed_mps - eyes.forward_mps);
        let forward_mps2 = clamp(
            aim.forward_mps2 + SPEED_PER_S * (aim.forward_mps - now_mps),
            -aim.forward_mps2_max,
            aim.forward_mps2_max,
        );
        let climb_off_mps = aim.climb_mps - eyes.climb_mps;
        let climb_per_s = CLIMB_PER_S[0] + flying * (CLIMB_PER_S[1] - CLIMB_PER_S[0]);
        let up_mps2 = clamp(climb_per_s * climb_off_mps, -UP_MPS2_MAX, UP_MPS2_MAX);

        let tilt_rad = seen.actuators.mast_tilt_rad.mean();
        let learned = ControlEffectiveness::at(seen, tilt_rad, &book.pilot);
        self.watch_torque(seen, book.torque_n_m_max);
        let (mut at_once_rad, at_once_norm) =
            learned.hands(AT_ONCE * forward_mps2, AT_ONCE * up_mps2);
        let up_off_mps2 = up_mps2 - self.felt_up_mps2;
        let mut off = learned.hands(forward_mps2 - self.felt_forward_mps2, up_off_mps2);
        let lever_norm = self.lever_norm + at_once_norm;
        let at_end = (lever_norm >= self.lever_norm_max && off.1 > 0.0)
            || (lever_norm <= 0.0 && off.1 < 0.0);
        // Height before speed: the lever helps no speed while the height goes the other way.
        if flying > HALF && climb_off_mps.abs() > CLIMB_FIRST_MPS && off.1 * climb_off_mps < 0.0 {
            off.1 = 0.0;
        }
        if at_end && seen.airspeed_mps > book.pilot.wing_borne_mps_min {
            // No lever left: the wing carries, and the speed is what it is.
            at_once_rad = AT_ONCE * up_mps2 / learned.lift_mps2;
            off.0 = up_off_mps2 / learned.lift_mps2;
        }
        let on_wheels = eyes.on_wheels_norm > ON_WHEELS_NORM;
        let learn_lever_per_s =
            LEARN_LEVER_PER_S[0] + flying * (LEARN_LEVER_PER_S[1] - LEARN_LEVER_PER_S[0]);
        let learn_per_s =
            LEARN_PITCH_PER_S[0] + flying * (LEARN_PITCH_PER_S[1] - LEARN_PITCH_PER_S[0]);
        if !on_wheels {
            let alpha_left_rad = book.pilot.alpha_rad_max - seen.alpha_rad;
            let highest_rad = if flying > HALF {
                min(PITCH_RAD_MAX, seen.euler.pitch_rad + alpha_left_rad)
            } else {
                PITCH_RAD_MAX
            };
            self.pitch_rad = clamp(
                self.pitch_rad + learn_per_s * off.0 * HAND_S,
                -PITCH_RAD_MAX - at_once_rad,
                highest_rad - at_once_rad,
            );
        }
        self.lever_norm = clamp(
            self.lever_norm + learn_lever_per_s * off.1 * HAND_S,
            0.0 - at_once_norm,
            self.lever_norm_max - at_once_norm,
        );
        (
            self.pitch_rad + if on_wheels { 0.0 } else { at_once_rad },
            clamp(self.lever_norm + at_once_norm, 0.0, self.lever_norm_max),
        )
    }

    /// Takes the lever back from where the masts' torque is beyond its limit.
    fn watch_torque(&mut self, seen: &Outputs, torque_n_m_max: f64) {
        let torque = seen.engines.torque_n_m.sum() * 0.5 / torque_n_m_max;
        let step_per_s =
            if torque > 1.0 { -TORQUE_PER_S * (torque - 1.0) } else { LEVER_AGAIN_PER_S };
        self.lever_norm_max =
            clamp(self.lever_norm_max + step_per_s * HAND_S, LEVER_NORM_LEFT, 1.0);
    }

    /// Bank: to the side when slow, to the heading when fast.
    fn roll(&mut self, seen: &Outputs, eyes: &Observation, aim: &Aim, flying: f64) -> f64 {
        let right_off = aim.right_mps - eyes.right_mps;
        let slow = 1.0 - flying;
        if eyes.on_wheels_norm < ON_WHEELS_NORM {
            self.roll_level_rad = clamp(
                self.roll_level_rad + slow * BANK_BY_SIDE_LEARNED * right_off * HAND_S,
                -LEVEL_RAD_MAX,
                LEVEL_RAD_MAX,
            );
            self.roll_level_rad *= 1.0 - flying * HAND_S / FORGET_S;
        }
        let hover_rad = clamp(BANK_BY_SIDE * right_off, -BANK_RAD_MAX, BANK_RAD_MAX);
        let heading_off = wrap_angle(aim.heading_rad - seen.euler.heading_rad);
        let turn_radps = clamp(TURN_PER_S * heading_off, -TURN_RADPS_MAX, TURN_RADPS_MAX);
        let bank_rad = clamp(
            atan2(seen.airspeed_mps * turn_radps, GRAVITY_MPS2),
            -aim.bank_rad_max,
            aim.bank_rad_max,
        );
        let wanted_rad = slow * hover_rad + flying * bank_rad;
        let most_rad = BANKING_RADPS[usize::from(slow > HALF)] * HAND_S;
        self.roll_rad += clamp(wanted_rad - self.roll_rad, -most_rad, most_rad);
        self.roll_level_rad + self.roll_rad
    }
}

/// What the pilot has learned about the aircraft's answer to attitude and lever.
struct ControlEffectiveness {
    /// Z_α, m/s² per rad.
    lift_mps2: f64,
    /// Z_l·sin β and Z_l·cos β, m/s² for the whole lever.
    along_mps2: f64,
    up_mps2: f64,
}

impl ControlEffectiveness {
    fn at(seen: &Outputs, tilt_rad: f64, book: &pilot::Params) -> Self {
        let v = seen.airspeed_mps;
        let q_pa = 0.5 * seen.air.density_kg_per_m3 * v * v;
        // The same power is less thrust the faster the air goes through the rotors.
        let lever_mps2 =
            min(book.lever_mps2, book.lever_w_per_kg / engine::math::max(v, STILL_MPS));
        Self {
            lift_mps2: book.lift_m2_per_kg_rad * q_pa,
            along_mps2: lever_mps2 * sin(tilt_rad),
            up_mps2: lever_mps2 * cos(tilt_rad),
        }
    }

    /// Attitude and lever for accelerations along the nose and upwards.
    fn hands(&self, forward_mps2: f64, up_mps2: f64) -> (f64, f64) {
        let Self { lift_mps2, along_mps2: s, up_mps2: c } = *self;
        let whole = GRAVITY_MPS2 * c + lift_mps2 * s;
        (
            (s * up_mps2 - c * forward_mps2) / whole,
            (GRAVITY_MPS2 * up_mps2 + lift_mps2 * forward_mps2) / whole,
        )
    }
}

#[cfg(test)]
mod tests {
    use engine::pair::Pair;

    use super::*;

    #[test]
    fn the_lever_is_taken_back_by_half_of_the_torque_beyond_the_limit_a_second() {
        let mut skill = Skill { lever_norm_max: 1.0, ..Skill::default() };
        // Torque as a part of the limit: the mean of the masts', which differ by a tenth of it.
        let mut a_while = |torque: f64, seconds: f64| {
            let mut seen = Outputs::default();
            seen.engines.torque_n_m =
                Pair { left: 1000.0 * (torque + 0.05), right: 1000.0 * (torque - 0.05) };
            for _ in 0..(seconds / HAND_S).round() as u32 {
                skill.watch_torque(&seen, 1000.0);
            }
            skill.lever_norm_max
        };
        for (torque, seconds, lever_norm) in [
            // A fifth too much for a second takes a tenth of the lever.
            (1.2, 1.0, 0.9),
            (1.2, 2.0, 0.7),
            // Within the limit it is given again, a twentieth a second.
            (0.9, 1.0, 0.75),
            (1.0, 2.0, 0.85),
            (0.5, 10.0, 1.0),
            // However much it is, some lever is left.
            (3.0, 10.0, 0.3),
        ] {
            let found_norm = a_while(torque, seconds);
            assert!((found_norm - lever_norm).abs() < 1e-9, "{torque}: {found_norm}");
        }
    }
}
