//! Linearisation: the state-space matrices of small motions about a trim.
//!
//! # Equations
//! ```text
//! ẋ = A·x + B·u        y = C·x + D·u                     x, u, y: differences from the trim
//! u̇ = Rᵀ·V̇ − ω×u,   φ̇, θ̇ from ω                       rigid body, in body axes          [STEVENS]
//! ṡ = (s' − s)/h                                        all else, s' from step::derivatives
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

use alloc::vec::Vec;

use engine::frames::{Attitude, Body, Euler, Vec3};
use engine::inputs::World;
use engine::math::{ln, max};
use engine::outputs::EulerRate;
use engine::{Aircraft, Outputs, STEP_S, State, step};

use crate::eigen::{self, Unsolved};
use crate::matrix::{Complex, Matrix};
use crate::solve::solve;
use crate::trim::Trim;
use crate::variable::{Inner, Rigid, Variable, accelerations};

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

/// A linear system of n states, m = 4 [`INPUTS`] and k = 13 [`OUTPUTS`], all in SI units and radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// The states x: the rigid body's first.
    pub states: Vec<Variable>,
    /// A, n × n.
    pub a: Matrix,
    /// B, n × m.
    pub b: Matrix,
    /// C, k × n.
    pub c: Matrix,
    /// D, k × m.
    pub d: Matrix,
}

/// The system about a trim, with the SCAS as the trim has it.
pub fn linearize(aircraft: &Aircraft, trim: &Trim, world: &World) -> Linear {
    let about = About::new(aircraft, &trim.state, world);
    let (n, m) = (Rigid::ALL.len() + about.inner.len(), INPUTS.len());
    let mut linear = Linear {
        states: about.variables(),
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
    /// The states that are not the rigid body's.
    inner: Vec<Inner>,
}

impl<'a> About<'a> {
    fn new(aircraft: &'a Aircraft, base: &State, world: &'a World) -> Self {
        let inner = Inner::that_move(base.cockpit.scas_on != 0).collect();
        Self { aircraft, world, base: *base, inner }
    }

    fn variables(&self) -> Vec<Variable> {
        let rigid = Rigid::ALL.into_iter().map(Variable::Rigid);
        rigid.chain(self.inner.iter().map(|&inner| Variable::Inner(inner))).collect()
    }

    fn pack(&self, state: &State) -> Vec<f64> {
        rigid(state).into_iter().chain(self.inner.iter().map(|inner| inner.get(state))).collect()
    }

    fn unpack(&self, x: &[f64], u: &[f64; INPUTS.len()]) -> State {
        let mut state = self.base;
        let plant = &mut state.plant;
        let heading_rad = plant.attitude.euler().heading_rad;
        plant.attitude =
            Attitude::from_euler(Euler { roll_rad: x[6], pitch_rad: x[7], heading_rad });
        plant.velocity_mps = plant.attitude.ned_from_body() * Vec3::<Body>::new(x[0], x[1], x[2]);
        plant.angular_rate_radps = Vec3::new(x[3], x[4], x[5]);
        for (inner, &value) in self.inner.iter().zip(&x[Rigid::ALL.len()..]) {
            inner.set(&mut state, value);
        }
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
        let rates = body
            .into_iter()
            .chain([turn.roll_radps, turn.pitch_radps])
            .chain(self.inner.iter().map(|inner| (inner.get(&next) - inner.get(&state)) / STEP_S))
            .collect();
        (rates, observed(&x[..Rigid::ALL.len()], &outputs))
    }
}

/// The rigid body's states.
fn rigid(state: &State) -> [f64; Rigid::ALL.len()] {
    let plant = &state.plant;
    let along = plant.attitude.ned_from_body().inverse() * plant.velocity_mps;
    let (rate, euler) = (plant.angular_rate_radps, plant.attitude.euler());
    [along.x, along.y, along.z, rate.x, rate.y, rate.z, euler.roll_rad, euler.pitch_rad]
}

/// The [`INPUTS`] of a flown state, with their trim.
pub fn inputs_of(aircraft: &Aircraft, state: &State) -> [f64; INPUTS.len()] {
    let (travel, pilot) = (&aircraft.fcc.travel, &state.cockpit);
    [
        pilot.stick_aft_norm * travel.longitudinal_stick_m,
        pilot.stick_right_norm * travel.lateral_stick_m,
        pilot.pedal_right_norm * travel.pedal_m,
        pilot.collective_norm * travel.collective_m,
    ]
}

/// The [`OUTPUTS`] of a flown state, with their trim.
pub fn outputs_of(state: &State, outputs: &Outputs) -> [f64; OUTPUTS.len()] {
    observed(&rigid(state), outputs)
}

fn observed(rigid: &[f64], outputs: &Outputs) -> [f64; OUTPUTS.len()] {
    let force = outputs.specific_force_mps2;
    let power_w = outputs.rotors.map(|rotor| rotor.power_w).sum();
    let mut y = [0.0; OUTPUTS.len()];
    y[..Rigid::ALL.len()].copy_from_slice(rigid);
    y[Rigid::ALL.len()..].copy_from_slice(&[
        force.x,
        force.y,
        force.z,
        outputs.rotor_speed_radps,
        power_w,
    ]);
    y
}

impl Linear {
    /// The eigenvalues of A: n of them, 1/s and rad/s, the slowest first, of a pair the one with positive
    /// imaginary part first.
    ///
    /// # Errors
    /// When the iteration does not converge, or a number of A is not finite.
    pub fn eigenvalues(&self) -> Result<Vec<Complex>, Unsolved> {
        eigen::eigenvalues(&self.a)
    }

    /// G(jω) from an input to an output, by their places in [`INPUTS`] and [`OUTPUTS`], in the unit of the
    /// output over that of the input.
    ///
    /// # Errors
    /// [`Unsolved::Singular`] when jω is an eigenvalue.
    pub fn response(
        &self,
        input: usize,
        output: usize,
        omega_radps: f64,
    ) -> Result<Complex, Unsolved> {
        let b: Vec<Complex> =
            self.b.column(input).iter().map(|&number| Complex::new(number, 0.0)).collect();
        let x = eigen::solve_shifted(&self.a, Complex::new(0.0, omega_radps), &b)?;
        let c = self.c.row(output);
        let from_states: Complex = c.iter().zip(&x).map(|(&c, x)| x * c).sum();
        Ok(from_states + self.d[(output, input)])
    }

    /// The system whose fast states follow at once: the derivatives of the textbooks.
    ///
    /// ```text
    /// 0 = A21·x1 + A22·x2 + B2·u    A = A11 − A12·A22⁻¹·A21    B = B1 − A12·A22⁻¹·B2, and so on
    /// ```
    #[must_use]
    pub fn quasi_steady(&self, fast: impl Fn(Variable) -> bool) -> Self {
        let split = |wanted: bool| -> Vec<usize> {
            (0..self.states.len()).filter(|&i| fast(self.states[i]) == wanted).collect()
        };
        let (slow, quick) = (split(false), split(true));
        let a22 = self.a.select_rows(&quick).select_columns(&quick);
        // What the fast states do per unit of each slow state and input.
        let answer = |cause: &dyn Fn(usize) -> f64| {
            let minus: Vec<f64> = quick.iter().map(|&row| -cause(row)).collect();
            solve(&a22, &minus)
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
            for y in 0..self.c.nrows() {
                reduced.c[(y, new)] = total(self.c[(y, old)], &|k| self.c[(y, k)], &x2);
            }
        }
        for input in 0..self.b.ncols() {
            let x2 = answer(&|row| self.b[(row, input)]);
            for (row, &i) in slow.iter().enumerate() {
                reduced.b[(row, input)] = total(self.b[(i, input)], &|k| self.a[(i, k)], &x2);
            }
            for y in 0..self.c.nrows() {
                reduced.d[(y, input)] = total(self.d[(y, input)], &|k| self.c[(y, k)], &x2);
            }
        }
        reduced
    }

    /// The system without some of its states, which stand still in it.
    #[must_use]
    pub fn without(&self, stands: impl Fn(Variable) -> bool) -> Self {
        let kept: Vec<usize> =
            (0..self.states.len()).filter(|&i| !stands(self.states[i])).collect();
        Self {
            states: kept.iter().map(|&i| self.states[i]).collect(),
            a: self.a.select_rows(&kept).select_columns(&kept),
            b: self.b.select_rows(&kept),
            c: self.c.select_columns(&kept),
            d: self.d.clone(),
        }
    }
}

/// Gain in decibels.
pub fn decibels(gain: f64) -> f64 {
    20.0 * ln(max(gain, 1e-300)) / core::f64::consts::LN_10
}

#[cfg(test)]
mod tests {
    use engine::math::{PI, sqrt};

    use super::*;
    use crate::matrix::Polar;

    const POSITION: Variable = Variable::Rigid(Rigid::Pitch);
    const SPEED: Variable = Variable::Rigid(Rigid::PitchRate);

    /// A mass on a spring with damping: ẍ = −4·x − ẋ + u, y = x.
    fn spring() -> Linear {
        Linear {
            states: alloc::vec![POSITION, SPEED],
            a: Matrix::from_row_slice(2, 2, &[0.0, 1.0, -4.0, -1.0]),
            b: Matrix::from_row_slice(2, 1, &[0.0, 1.0]),
            c: Matrix::from_row_slice(1, 2, &[1.0, 0.0]),
            d: Matrix::zeros(1, 1),
        }
    }

    #[test]
    fn the_response_of_a_spring_is_the_textbooks() {
        let linear = spring();
        // 1/(4 − ω² + jω): a quarter at rest, 1/(2j) in resonance.
        let still = linear.response(0, 0, 0.0).unwrap();
        assert!((still.re - 0.25).abs() < 1e-15 && still.im.abs() < 1e-15);
        let resonant = linear.response(0, 0, 2.0).unwrap();
        assert!((resonant.magnitude() - 0.5).abs() < 1e-14);
        assert!((resonant.phase_rad() + 0.5 * PI).abs() < 1e-14);
        assert!((decibels(resonant.magnitude()) + 6.0206).abs() < 1e-4);
    }

    #[test]
    fn a_pole_on_the_imaginary_axis_has_no_response() {
        let mut undamped = spring();
        undamped.a[(1, 1)] = 0.0;
        assert_eq!(undamped.response(0, 0, 2.0), Err(Unsolved::Singular));
    }

    #[test]
    fn a_state_that_follows_at_once_leaves_its_gain() {
        // ẋ = −x + 3·s, ṡ = 100·(u − s): x ends at 3·u.
        let mut linear = spring();
        linear.a = Matrix::from_row_slice(2, 2, &[-1.0, 3.0, 0.0, -100.0]);
        linear.b = Matrix::from_row_slice(2, 1, &[0.0, 100.0]);
        let slow = linear.quasi_steady(|state| state == SPEED);
        assert_eq!(slow.states, [POSITION]);
        assert!((slow.a[(0, 0)] + 1.0).abs() < 1e-15 && (slow.b[(0, 0)] - 3.0).abs() < 1e-15);
    }

    #[test]
    fn its_mode_has_the_textbooks_frequency() {
        let mode = spring().eigenvalues().unwrap()[0];
        assert!((mode.magnitude() - 2.0).abs() < 1e-14);
        assert!((mode.im - sqrt(3.75)).abs() < 1e-14);
    }
}
