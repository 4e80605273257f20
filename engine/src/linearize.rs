//! Linearisation: the state-space matrices of small motions about a trim.
//!
//! # Equations
//! ```text
//! ẋ = A·x + B·u        y = C·x + D·u                     x, u, y: differences from the trim
//! u̇ = Rᵀ·V̇ − ω×u,   φ̇, θ̇ from ω                       rigid body, in body axes          [STEVENS]
//! ṡ = (s' − s)/h                                        all else, s' from step::heading
//! A = (f(x+ε) − f(x−ε))/2ε, and so on
//! ```
//! # Signs
//! Sticks and lever in metres of travel at the grip: aft, right, right pedal, lever up positive.
//! # Assumptions
//! The states are those that move in a second or so: heading, position, fuel, tyres, nacelles, flap
//! and gear stand. Integrated states have their true rates. Sampled ones (actuators, SCAS) have the
//! difference over one tick, as if it were a rate: a first-order lag of 50 ms then has its eigenvalue
//! at −19.2 /s instead of −20. The tick's own delay, 2 ms on average, is left out. The matrix
//! logarithm of the whole tick's map would keep both, and bring in a root for every rate that the
//! integration remembers, which no aircraft has.
//!
//! Limits and dead zones are those at the trim: differences are far smaller than any of them.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::dense::{Complex, Matrix};
use crate::frames::{Attitude, Body, Euler, Vec3};
use crate::inputs::World;
use crate::math::max;
use crate::outputs::EulerRate;
use crate::state::State;
use crate::trim::{Trim, accelerations, inner_states, numbers, set_numbers};
use crate::{Aircraft, Outputs, STEP_S, step};

/// Names of the rigid body's states, the first ones of every system.
pub const RIGID: [&str; 8] = [
    "forward_mps",
    "right_mps",
    "down_mps",
    "roll_rate_radps",
    "pitch_rate_radps",
    "yaw_rate_radps",
    "roll_rad",
    "pitch_rad",
];

/// Names of the inputs.
pub const INPUTS: [&str; 4] = ["stick_aft_m", "stick_right_m", "pedal_right_m", "lever_m"];

/// Names of the outputs.
pub const OUTPUTS: [&str; 13] = [
    "forward_mps",
    "right_mps",
    "down_mps",
    "roll_rate_radps",
    "pitch_rate_radps",
    "yaw_rate_radps",
    "roll_rad",
    "pitch_rad",
    "specific_force_forward_mps2",
    "specific_force_right_mps2",
    "specific_force_down_mps2",
    "rotor_speed_radps",
    "power_w",
];

/// A linear system.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Names of the states x.
    pub states: Vec<String>,
    /// Names of the inputs u.
    pub inputs: Vec<String>,
    /// Names of the outputs y.
    pub outputs: Vec<String>,
    /// A.
    pub a: Matrix,
    /// B.
    pub b: Matrix,
    /// C.
    pub c: Matrix,
    /// D.
    pub d: Matrix,
}

/// The system about a trim, with the SCAS as the trim has it.
pub fn linearize(aircraft: &Aircraft, trim: &Trim, world: &World) -> Linear {
    let about = About::new(aircraft, &trim.state, world);
    let (n, m) = (RIGID.len() + about.inner.len(), INPUTS.len());
    let mut linear = Linear {
        states: about.names(),
        inputs: INPUTS.iter().map(ToString::to_string).collect(),
        outputs: OUTPUTS.iter().map(ToString::to_string).collect(),
        a: Matrix::zeros(n, n),
        b: Matrix::zeros(n, m),
        c: Matrix::zeros(OUTPUTS.len(), n),
        d: Matrix::zeros(OUTPUTS.len(), m),
    };
    let (x, u) = (about.pack(&trim.state), [0.0; INPUTS.len()]);
    for column in 0..n + m {
        let step = match column.checked_sub(n) {
            None => 1e-5 * max(1.0, x[column].abs()),
            Some(_) => 1e-5,
        };
        let moved = |by: f64| {
            let (mut x, mut u) = (x.clone(), u);
            match column.checked_sub(n) {
                None => x[column] += by,
                Some(input) => u[input] += by,
            }
            about.evaluate(&x, &u)
        };
        let (above, below) = (moved(step), moved(-step));
        let slope = |above: f64, below: f64| (above - below) / (2.0 * step);
        for row in 0..n {
            let slope = slope(above.0[row], below.0[row]);
            match column.checked_sub(n) {
                None => linear.a[(row, column)] = slope,
                Some(input) => linear.b[(row, input)] = slope,
            }
        }
        for row in 0..OUTPUTS.len() {
            let slope = slope(above.1[row], below.1[row]);
            match column.checked_sub(n) {
                None => linear.c[(row, column)] = slope,
                Some(input) => linear.d[(row, input)] = slope,
            }
        }
    }
    linear
}

/// The neighbourhood of a state.
struct About<'a> {
    aircraft: &'a Aircraft,
    world: &'a World,
    base: State,
    numbers: Vec<String>,
    /// Places of the states that are not the rigid body's.
    inner: Vec<usize>,
}

impl<'a> About<'a> {
    fn new(aircraft: &'a Aircraft, base: &State, world: &'a World) -> Self {
        let numbers = base.number_names();
        let mut inner = inner_states(&numbers);
        let moves = |name: &str| {
            let surface =
                ["collective", "cyclic", "elevator", "flaperon", "rudder"].iter().any(|surface| {
                    name.strip_prefix("actuators.").is_some_and(|n| n.starts_with(surface))
                });
            surface
                || name == "plant.rotor_speed_radps"
                || name.starts_with("plant.engines")
                || name == "fcc.governor.integral_rad"
                || (base.cockpit.scas_on != 0 && name.starts_with("fcc.scas.mean"))
        };
        inner.extend((0..numbers.len()).filter(|&i| moves(&numbers[i])));
        inner.sort_unstable();
        Self { aircraft, world, base: *base, numbers, inner }
    }

    fn names(&self) -> Vec<String> {
        let rigid = RIGID.iter().map(ToString::to_string);
        rigid.chain(self.inner.iter().map(|&i| self.numbers[i].clone())).collect()
    }

    fn pack(&self, state: &State) -> Vec<f64> {
        let plant = &state.plant;
        let along = plant.attitude.ned_from_body().inverse() * plant.velocity_mps;
        let (rate, euler) = (plant.angular_rate_radps, plant.attitude.euler());
        let rigid =
            [along.x, along.y, along.z, rate.x, rate.y, rate.z, euler.roll_rad, euler.pitch_rad];
        let all = numbers(state);
        rigid.into_iter().chain(self.inner.iter().map(|&i| all[i])).collect()
    }

    fn unpack(&self, x: &[f64], u: &[f64; INPUTS.len()]) -> State {
        let mut state = self.base;
        let plant = &mut state.plant;
        let heading_rad = plant.attitude.euler().heading_rad;
        plant.attitude =
            Attitude::from_euler(Euler { roll_rad: x[6], pitch_rad: x[7], heading_rad });
        plant.velocity_mps = plant.attitude.ned_from_body() * Vec3::<Body>::new(x[0], x[1], x[2]);
        plant.angular_rate_radps = Vec3::new(x[3], x[4], x[5]);
        set_numbers(&mut state, &self.inner, |i| x[RIGID.len() + i]);
        let travel = &self.aircraft.fcc.travel;
        let pilot = &mut state.cockpit;
        pilot.stick_aft_norm += u[0] / travel.longitudinal_stick_m;
        pilot.stick_right_norm += u[1] / travel.lateral_stick_m;
        pilot.pedal_right_norm += u[2] / travel.pedal_m;
        pilot.collective_norm += u[3] / travel.collective_m;
        // The lever has no dynamics: the engines have it in the same tick.
        state.actuators.lever_norm = pilot.collective_norm;
        state
    }

    /// ẋ and y.
    fn evaluate(&self, x: &[f64], u: &[f64; INPUTS.len()]) -> (Vec<f64>, [f64; OUTPUTS.len()]) {
        let state = self.unpack(x, u);
        let (next, outputs) = step::derivatives(self.aircraft, &state, self.world);
        let body = accelerations(&state, &next);
        let euler = state.plant.attitude.euler();
        let turn = EulerRate::new(euler, state.plant.angular_rate_radps);
        let (before, after) = (numbers(&state), numbers(&next));
        let rates = body
            .into_iter()
            .chain([turn.roll_radps, turn.pitch_radps])
            .chain(self.inner.iter().map(|&i| (after[i] - before[i]) / STEP_S))
            .collect();
        (rates, observed(x, &outputs))
    }
}

fn observed(x: &[f64], outputs: &Outputs) -> [f64; OUTPUTS.len()] {
    let force = outputs.specific_force_mps2;
    let power_w = outputs.rotors.map(|rotor| rotor.power_w).sum();
    let mut y = [0.0; OUTPUTS.len()];
    y[..RIGID.len()].copy_from_slice(&x[..RIGID.len()]);
    y[RIGID.len()..].copy_from_slice(&[
        force.x,
        force.y,
        force.z,
        outputs.rotor_speed_radps,
        power_w,
    ]);
    y
}

impl Linear {
    /// G(jω) from an input to an output.
    pub fn response(&self, input: usize, output: usize, omega_radps: f64) -> Complex {
        let b: Vec<Complex> =
            (0..self.a.rows()).map(|row| Complex { re: self.b[(row, input)], im: 0.0 }).collect();
        let x = self.a.solve_shifted(Complex { re: 0.0, im: omega_radps }, &b);
        let c = self.c.row(output);
        Complex {
            re: c.iter().zip(&x).map(|(c, x)| c * x.re).sum::<f64>() + self.d[(output, input)],
            im: c.iter().zip(&x).map(|(c, x)| c * x.im).sum(),
        }
    }

    /// The system whose fast states follow at once: the derivatives of the textbooks.
    ///
    /// ```text
    /// 0 = A21·x1 + A22·x2 + B2·u    A = A11 − A12·A22⁻¹·A21    B = B1 − A12·A22⁻¹·B2, and so on
    /// ```
    #[must_use]
    pub fn quasi_steady(&self, fast: impl Fn(&str) -> bool) -> Self {
        let split = |wanted: bool| -> Vec<usize> {
            (0..self.states.len()).filter(|&i| fast(&self.states[i]) == wanted).collect()
        };
        let (slow, quick) = (split(false), split(true));
        let a22 = self.a.part(&quick);
        // What the fast states do per unit of each slow state and input.
        let answer = |cause: &dyn Fn(usize) -> f64| {
            let minus: Vec<f64> = quick.iter().map(|&row| -cause(row)).collect();
            a22.solve(&minus)
        };
        let mut reduced = self.without(&fast);
        let total = |own: f64, row: &dyn Fn(usize) -> f64, answer: &[f64]| {
            own + quick.iter().zip(answer).map(|(&k, x)| row(k) * x).sum::<f64>()
        };
        for (new, &old) in slow.iter().enumerate() {
            let x2 = answer(&|row| self.a[(row, old)]);
            for (row, &i) in slow.iter().enumerate() {
                reduced.a[(row, new)] = total(self.a[(i, old)], &|k| self.a[(i, k)], &x2);
            }
            for y in 0..self.c.rows() {
                reduced.c[(y, new)] = total(self.c[(y, old)], &|k| self.c[(y, k)], &x2);
            }
        }
        for input in 0..self.b.columns() {
            let x2 = answer(&|row| self.b[(row, input)]);
            for (row, &i) in slow.iter().enumerate() {
                reduced.b[(row, input)] = total(self.b[(i, input)], &|k| self.a[(i, k)], &x2);
            }
            for y in 0..self.c.rows() {
                reduced.d[(y, input)] = total(self.d[(y, input)], &|k| self.c[(y, k)], &x2);
            }
        }
        reduced
    }

    /// The system without some of its states, which stand still in it.
    #[must_use]
    pub fn without(&self, stands: impl Fn(&str) -> bool) -> Self {
        let kept: Vec<usize> =
            (0..self.states.len()).filter(|&i| !stands(&self.states[i])).collect();
        let mut part = Self {
            states: kept.iter().map(|&i| self.states[i].clone()).collect(),
            inputs: self.inputs.clone(),
            outputs: self.outputs.clone(),
            a: self.a.part(&kept),
            b: Matrix::zeros(kept.len(), self.b.columns()),
            c: Matrix::zeros(self.c.rows(), kept.len()),
            d: self.d.clone(),
        };
        for (new, &old) in kept.iter().enumerate() {
            for input in 0..self.b.columns() {
                part.b[(new, input)] = self.b[(old, input)];
            }
            for output in 0..self.c.rows() {
                part.c[(output, new)] = self.c[(output, old)];
            }
        }
        part
    }
}

/// Gain in decibels.
pub fn decibels(gain: f64) -> f64 {
    20.0 * crate::math::ln(max(gain, 1e-300)) / core::f64::consts::LN_10
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{PI, sqrt};

    /// A mass on a spring with damping: ẍ = −4·x − ẋ + u, y = x.
    fn spring() -> Linear {
        let name = |names: &[&str]| names.iter().map(ToString::to_string).collect();
        Linear {
            states: name(&["x_m", "x_mps"]),
            inputs: name(&["force_n"]),
            outputs: name(&["x_m"]),
            a: Matrix::from_rows(&[&[0.0, 1.0], &[-4.0, -1.0]]),
            b: Matrix::from_rows(&[&[0.0], &[1.0]]),
            c: Matrix::from_rows(&[&[1.0, 0.0]]),
            d: Matrix::from_rows(&[&[0.0]]),
        }
    }

    #[test]
    fn the_response_of_a_spring_is_the_textbooks() {
        let linear = spring();
        // 1/(4 − ω² + jω): a quarter at rest, 1/(2j) in resonance.
        let still = linear.response(0, 0, 0.0);
        assert!((still.re - 0.25).abs() < 1e-15 && still.im.abs() < 1e-15);
        let resonant = linear.response(0, 0, 2.0);
        assert!((resonant.abs() - 0.5).abs() < 1e-14);
        assert!((resonant.arg_rad() + 0.5 * PI).abs() < 1e-14);
        assert!((decibels(resonant.abs()) + 6.0206).abs() < 1e-4);
    }

    #[test]
    fn a_state_that_follows_at_once_leaves_its_gain() {
        // ẋ = −x + 3·s, ṡ = 100·(u − s): x ends at 3·u.
        let mut linear = spring();
        linear.a = Matrix::from_rows(&[&[-1.0, 3.0], &[0.0, -100.0]]);
        linear.b = Matrix::from_rows(&[&[0.0], &[100.0]]);
        let slow = linear.quasi_steady(|state| state == "x_mps");
        assert_eq!(slow.states, ["x_m"]);
        assert!((slow.a[(0, 0)] + 1.0).abs() < 1e-15 && (slow.b[(0, 0)] - 3.0).abs() < 1e-15);
    }

    #[test]
    fn its_mode_has_the_textbooks_frequency() {
        let mode = spring().a.eigenvalues()[0];
        assert!((mode.abs() - 2.0).abs() < 1e-14);
        assert!((mode.im - sqrt(3.75)).abs() < 1e-14);
    }
}
