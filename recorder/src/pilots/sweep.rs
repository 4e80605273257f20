//! Frequency sweeps, flown as flight test does it: one control goes to and fro, slowly at first and
//! ever faster, about a steady flight that the other hand hardly touches.
//!
//! # Equations
//! ```text
//! δ = δ₀ + A·fade(t)·sin φ(t) + hold         φ̇ = ω₀ for one period, then ω₀·e^{gt} up to ω₁
//! hold: aft     k_θ·(θ₀ + k_u·(u − u₀) − θ) − k_q·q       right  k_φ·(φ₀ − k_v·(v − v₀) − φ) − k_p·p
//!       pedal   k_ψ·(ψ₀ − ψ) − k_r·r                      lever  k_h·(h₀ − h) − k_ḣ·ḣ
//! ```
//! # Signs
//! Stick aft, stick right, right pedal and lever up positive; climb up.
//! # Assumptions
//! The hold keeps an aircraft that drifts, or whose hover is unstable, where the sweep began. On the swept
//! control it is a part of the input that is recorded, and takes nothing from the response; on the others
//! it is slow and small, and what is identified is with it. As an aeroplane only attitude is held.

use engine::math::{PI, clamp, cos, exp, ln, min, ramp, sin, wrap_angle};
use engine::{Outputs, pilot};

use super::skill::{Observation, Positions, flying};

/// Lowest and highest frequency, rad/s.
const BAND_RADPS: [f64; 2] = [0.2, 15.0];
/// From the lowest to the highest, s.
const RISE_S: f64 = 80.0;
/// Coming to rest after it, s.
const REST_S: f64 = 9.0;
/// Growing and dying away, s.
const FADE_S: f64 = 3.0;
/// Amplitude with some speed, before it becomes lighter with dynamic pressure: .3 in of stick, .2 in of
/// pedal, and .3 in of lever, as parts of the travel.
const STICK_NORM: f64 = 0.062;
const PEDAL_NORM: f64 = 0.08;
const LEVER_NORM: f64 = 0.03;
/// Part of it over a spot from 1 rad/s on, and less in proportion below: slow movements sway a hover far,
/// .3 in of stick at .3 rad/s by 9 kt and 16 deg, and its derivatives are others at 2 kt already.
const OVER_A_SPOT: f64 = 0.25;
/// The hold's gains, each in flight and what is added over a spot: k_θ and k_φ, 1/rad, k_q and k_p, s/rad.
const PITCH: [f64; 2] = [0.4, 0.8];
const PITCH_RATE: [f64; 2] = [0.3, 0.7];
const ROLL: [f64; 2] = [0.35, 0.65];
const ROLL_RATE: [f64; 2] = [0.2, 0.6];
/// k_ψ, 1/rad, and k_r, s/rad, over a spot only.
const HEADING: f64 = 0.9;
const YAW_RATE: f64 = 1.5;
/// k_h, 1/m, and k_ḣ, s/m, as far as the masts are upright.
const HEIGHT: f64 = 0.015;
const CLIMB: f64 = 0.02;
/// Attitude by speed over a spot, k_u and k_v, rad per m/s, and bank by heading in flight.
const LEAN_BY_SPEED: f64 = 0.02;
const BANK_BY_HEADING: f64 = 0.5;
/// Attitude that the hold asks for because of a speed, rad.
const LEAN_RAD_MAX: f64 = 0.1;

/// The control that is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Stick aft.
    Pitch,
    /// Stick right.
    Roll,
    /// Right pedal.
    Yaw,
    /// Power lever.
    Lever,
}

impl Axis {
    /// Of a pilot model's name.
    pub fn of(pilot: &str) -> Option<Self> {
        match pilot {
            "sweep-pitch" => Some(Self::Pitch),
            "sweep-roll" => Some(Self::Roll),
            "sweep-yaw" => Some(Self::Yaw),
            "sweep-lever" => Some(Self::Lever),
            _ => None,
        }
    }
}

/// One sweep, its rest included, s.
pub fn length_s() -> f64 {
    first_period_s() + RISE_S + REST_S
}

fn first_period_s() -> f64 {
    2.0 * PI / BAND_RADPS[0]
}

/// How fast it is by then, rad/s.
fn frequency_radps(time_s: f64) -> f64 {
    let [low, high] = BAND_RADPS;
    low * exp(ln(high / low) * ramp(time_s - first_period_s(), 0.0, RISE_S))
}

/// Between −1 and 1, by the time since the sweep began.
fn wave(time_s: f64) -> f64 {
    let [low, high] = BAND_RADPS;
    let end_s = first_period_s() + RISE_S;
    if time_s >= end_s {
        return 0.0;
    }
    let since_s = time_s - first_period_s();
    let growth = ln(high / low) / RISE_S;
    let phase_rad =
        if since_s < 0.0 { low * time_s } else { low / growth * (exp(growth * since_s) - 1.0) };
    min(ramp(time_s, 0.0, FADE_S), ramp(end_s - time_s, 0.0, FADE_S)) * sin(phase_rad)
}

/// The steady flight about which is swept.
#[derive(Clone, Copy, Debug)]
pub struct Steady {
    hands: Positions,
    pitch_rad: f64,
    roll_rad: f64,
    heading_rad: f64,
    forward_mps: f64,
    right_mps: f64,
    height_m: f64,
}

impl Steady {
    /// As it is.
    pub fn of(seen: &Outputs) -> Self {
        let eyes = Observation::look(seen);
        Self {
            hands: Positions {
                stick_aft_norm: seen.cockpit.stick_aft_norm,
                stick_right_norm: seen.cockpit.stick_right_norm,
                pedal_right_norm: seen.cockpit.pedal_right_norm,
                lever_norm: seen.cockpit.collective_norm,
            },
            pitch_rad: seen.euler.pitch_rad,
            roll_rad: seen.euler.roll_rad,
            heading_rad: seen.euler.heading_rad,
            forward_mps: eyes.forward_mps,
            right_mps: eyes.right_mps,
            height_m: -seen.position_m.z,
        }
    }

    /// Where the hands go to keep it, with so much of a sweep.
    pub fn positions(
        &self,
        seen: &Outputs,
        sweep: Option<(Axis, f64)>,
        book: &pilot::Params,
    ) -> Positions {
        let eyes = Observation::look(seen);
        let slow = 1.0 - flying(seen, book);
        let gain = |[fast, over_a_spot]: [f64; 2]| fast + over_a_spot * slow;
        let upright = cos(seen.actuators.mast_tilt_rad.mean());
        let q_pa = 0.5 * seen.air.density_kg_per_m3 * seen.airspeed_mps * seen.airspeed_mps;
        let light = 1.0 / (1.0 + q_pa / book.half_stick_pa);
        let (euler, rate) = (seen.euler, seen.angular_rate_radps);

        let lean = |by_rad: f64| clamp(by_rad, -LEAN_RAD_MAX, LEAN_RAD_MAX);
        let nose_rad = lean(LEAN_BY_SPEED * slow * (eyes.forward_mps - self.forward_mps));
        let heading_off_rad = wrap_angle(self.heading_rad - euler.heading_rad);
        let bank_rad = lean(
            BANK_BY_HEADING * (1.0 - slow) * heading_off_rad
                - LEAN_BY_SPEED * slow * (eyes.right_mps - self.right_mps),
        );
        let mut to = Positions {
            stick_aft_norm: self.hands.stick_aft_norm
                + light
                    * (gain(PITCH) * (self.pitch_rad + nose_rad - euler.pitch_rad)
                        - gain(PITCH_RATE) * rate.y),
            stick_right_norm: self.hands.stick_right_norm
                + light
                    * (gain(ROLL) * (self.roll_rad + bank_rad - euler.roll_rad)
                        - gain(ROLL_RATE) * rate.x),
            pedal_right_norm: self.hands.pedal_right_norm
                + slow * (HEADING * heading_off_rad - YAW_RATE * rate.z),
            lever_norm: self.hands.lever_norm
                + upright * (HEIGHT * (self.height_m + seen.position_m.z) - CLIMB * eyes.climb_mps),
        };
        if let Some((axis, time_s)) = sweep {
            let part = OVER_A_SPOT * min(1.0, frequency_radps(time_s));
            let wave = wave(time_s) * (1.0 - (1.0 - part) * slow);
            match axis {
                Axis::Pitch => to.stick_aft_norm += STICK_NORM * light * wave,
                Axis::Roll => to.stick_right_norm += STICK_NORM * light * wave,
                Axis::Yaw => to.pedal_right_norm += PEDAL_NORM * light * wave,
                Axis::Lever => to.lever_norm += LEVER_NORM * wave,
            }
        }
        to
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_begins_and_ends_at_rest_and_passes_through_every_frequency() {
        assert!(wave(0.0).abs() < 1e-12 && wave(length_s() - REST_S).abs() < 1e-12);
        // Sign changes from the middle of the rise on, against the frequency that the rise has there.
        let step_s = 0.001;
        let crossings = |from_s: f64, to_s: f64| {
            let steps = ((to_s - from_s) / step_s) as u32;
            let at = |i: u32| wave(from_s + f64::from(i) * step_s);
            (1..steps).filter(|&i| at(i - 1) * at(i) < 0.0).count() as f64
        };
        let end_s = first_period_s() + RISE_S;
        let last = crossings(end_s - 10.0, end_s - FADE_S) * PI / (10.0 - FADE_S);
        assert!(last > 9.0 && last < 15.0, "{last} rad/s");
        assert!(crossings(0.5, first_period_s() - 0.5) <= 1.0, "one period of the lowest");
    }

    #[test]
    fn the_frequency_stays_for_a_period_and_then_rises_by_the_same_factor_every_second() {
        // One period at .2 rad/s.
        let first_s = 10.0 * PI;
        for (time_s, radps) in [
            (0.0, 0.2),
            (first_s, 0.2),
            // In the middle of the rise the geometric mean of .2 and 15 rad/s.
            (first_s + 0.5 * RISE_S, 3.0_f64.sqrt()),
            (first_s + RISE_S, 15.0),
            (length_s(), 15.0),
        ] {
            let found = frequency_radps(time_s);
            assert!((found - radps).abs() < 1e-9, "{time_s} s: {found} rad/s");
        }
        assert!((length_s() - (first_s + 80.0 + 9.0)).abs() < 1e-9);
    }

    /// As a helicopter over a spot, heading north, or as an aeroplane at a dynamic pressure; nothing moves.
    fn seen(airspeed_mps: f64) -> Outputs {
        let mut seen = Outputs { airspeed_mps, ..Outputs::default() };
        seen.balance.mass_kg = 6000.0;
        seen.air.density_kg_per_m3 = 1.0;
        seen.cockpit.stick_aft_norm = 0.1;
        seen.cockpit.stick_right_norm = -0.2;
        seen.cockpit.pedal_right_norm = 0.3;
        seen.cockpit.collective_norm = 0.6;
        seen.euler.pitch_rad = 0.05;
        seen.position_m.z = -100.0;
        seen
    }

    fn book() -> pilot::Params {
        aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap().pilot
    }

    /// How far the hands are from where they were, in the order aft, right, pedal, lever.
    fn moved(to: &Positions) -> [f64; 4] {
        [
            to.stick_aft_norm - 0.1,
            to.stick_right_norm + 0.2,
            to.pedal_right_norm - 0.3,
            to.lever_norm - 0.6,
        ]
    }

    fn assert_near(found: [f64; 4], expected: [f64; 4], what: &str) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{what}: {found} and not {expected}");
        }
    }

    /// The hold's equations, each term by itself, with the gains that stand beside them.
    #[test]
    fn the_hold_over_a_spot_answers_every_way_off_with_its_own_control() {
        let book = book();
        let steady = Steady::of(&seen(0.0));
        let off = |change: &dyn Fn(&mut Outputs)| {
            let mut now = seen(0.0);
            change(&mut now);
            moved(&steady.positions(&now, None, &book))
        };
        assert_near(off(&|_| {}), [0.0; 4], "nothing is off");
        assert_near(off(&|now| now.euler.pitch_rad -= 0.01), [1.2 * 0.01, 0.0, 0.0, 0.0], "θ");
        assert_near(off(&|now| now.angular_rate_radps.y = 0.01), [-0.01, 0.0, 0.0, 0.0], "q");
        assert_near(off(&|now| now.euler.roll_rad += 0.01), [0.0, -0.01, 0.0, 0.0], "φ");
        assert_near(off(&|now| now.angular_rate_radps.x = 0.01), [0.0, -0.008, 0.0, 0.0], "p");
        assert_near(off(&|now| now.euler.heading_rad = -0.01), [0.0, 0.0, 0.009, 0.0], "ψ");
        assert_near(off(&|now| now.angular_rate_radps.z = 0.01), [0.0, 0.0, -0.015, 0.0], "r");
        assert_near(off(&|now| now.position_m.z += 2.0), [0.0, 0.0, 0.0, 0.03], "2 m too low");
        assert_near(off(&|now| now.velocity_mps.z = -0.5), [0.0, 0.0, 0.0, -0.01], "climb");
        // Too fast ahead by 1 m/s: .02 rad of nose up. Too fast to the right: as much to the left.
        assert_near(off(&|now| now.velocity_mps.x = 1.0), [1.2 * 0.02, 0.0, 0.0, 0.0], "u");
        assert_near(off(&|now| now.velocity_mps.y = 1.0), [0.0, -0.02, 0.0, 0.0], "v");
        assert_near(off(&|now| now.velocity_mps.y = -9.0), [0.0, 0.1, 0.0, 0.0], "at most");
        // The lever serves the height as far as the masts are upright: half at 60 deg.
        let tilted = off(&|now| {
            now.actuators.mast_tilt_rad = engine::pair::Pair::both(PI / 3.0);
            now.position_m.z += 2.0;
        });
        assert_near(tilted, [0.0, 0.0, 0.0, 0.015], "tilted masts");
    }

    #[test]
    fn a_sweep_moves_its_own_control_and_less_over_a_spot_while_it_is_slow() {
        let book = book();
        // A quarter of the first period, the fading in being over: the sine is 1, at .2 rad/s.
        let time_s = 2.5 * PI;
        let axes = [Axis::Pitch, Axis::Roll, Axis::Yaw, Axis::Lever];
        let whole = [STICK_NORM, STICK_NORM, PEDAL_NORM, LEVER_NORM];
        // In flight the hand is half as heavy where the stick does half as much.
        let fast_mps = (2.0 * book.half_stick_pa).sqrt();
        assert!(fast_mps > book.flying_mps_min, "it is flying: {fast_mps} m/s");
        for (speed_mps, parts) in [(0.0, [0.25 * 0.2; 4]), (fast_mps, [0.5, 0.5, 0.5, 1.0])] {
            let now = seen(speed_mps);
            for (place, axis) in axes.into_iter().enumerate() {
                let mut expected = [0.0; 4];
                expected[place] = whole[place] * parts[place];
                let to = Steady::of(&now).positions(&now, Some((axis, time_s)), &book);
                assert_near(moved(&to), expected, &format!("{axis:?} at {speed_mps} m/s"));
            }
        }
    }
}
