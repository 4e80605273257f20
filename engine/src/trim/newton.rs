//! Newton's method with a line search, and the steady state it ends in.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;

use super::problem::{COLLECTIVE, OUTER, Problem, Trial};
use super::report::{Report, beyond};
use super::{Failure, Power, Trim};
use crate::dense::Matrix;
use crate::frames::{Ned, Vec3};
use crate::math::{cos, max, sin, sqrt, square};
use crate::state::State;
use crate::{STEP_S, step};

/// No trial moves further at a time: rad, stick travel, rad, rated power, m/s.
const STEP_MAX: [f64; OUTER] = [0.1, 0.4, 0.1, 0.3, 5.0, 0.15, 0.4, 0.4];

/// What must vanish, beside the inner states' rates.
const EQUATIONS: [&str; OUTER] = [
    "acceleration forward",
    "acceleration down",
    "pitch acceleration",
    "rotor acceleration",
    "engine power",
    "acceleration to the right",
    "roll acceleration",
    "yaw acceleration",
];

/// Weighed against each other, for the line search: an m/s² counts like this many of the others.
const WEIGHTS: [f64; OUTER] = [1.0, 1.0, 3.0, 1.0, 1.0, 1.0, 3.0, 3.0];

/// Inner states are fast: their rates are large where their effect is small.
const INNER_WEIGHT: f64 = 0.02;

/// Below this an acceleration is rounding.
const STEADY: f64 = 1e-8;

/// A trial is this good at the latest after so many iterations, or never.
const ITERATIONS: usize = 60;

/// Ticks for which the inner states settle before the first iteration.
impl Problem<'_> {
    fn merit(&self, residual: &[f64]) -> f64 {
        let outer = self.equations.iter().zip(residual).map(|(&i, r)| WEIGHTS[i] * r);
        let inner = residual[self.equations.len()..].iter().map(|r| INNER_WEIGHT * r);
        let merit = sqrt(outer.chain(inner).map(square).sum());
        if merit.is_finite() { merit } else { f64::MAX }
    }

    /// The largest of them, and its equation. Inner rates count by their weight.
    fn worst(&self, residual: &[f64]) -> (f64, String) {
        let mut worst = (0.0, String::new());
        for (i, r) in residual.iter().enumerate() {
            let (size, name) = match self.equations.get(i) {
                Some(&equation) => (r.abs(), EQUATIONS[equation]),
                None => {
                    let inner = self.inner[i - self.equations.len()];
                    (INNER_WEIGHT * r.abs(), self.names[inner].as_str())
                }
            };
            // What is not a number is worse than any.
            if size > worst.0 || size.is_nan() {
                worst = (size, name.into());
            }
        }
        worst
    }

    /// Places of the unknown among the values of a trial.
    fn unknown(&self) -> Vec<usize> {
        self.outer.iter().copied().chain(OUTER..OUTER + self.inner.len()).collect()
    }

    fn jacobian(&self, trial: &Trial, unknown: &[usize]) -> Matrix {
        let mut jacobian = Matrix::zeros(unknown.len(), unknown.len());
        for (column, &i) in unknown.iter().enumerate() {
            let step = 1e-6 * max(1.0, if i >= OUTER { trial[i].abs() } else { 1.0 });
            let mut moved = trial.clone();
            moved[i] = trial[i] + step;
            let above = self.residual(&moved);
            moved[i] = trial[i] - step;
            let below = self.residual(&moved);
            for row in 0..unknown.len() {
                jacobian[(row, column)] = (above[row] - below[row]) / (2.0 * step);
            }
        }
        jacobian
    }

    pub(super) fn solve(&self, mut trial: Trial) -> Result<Trim, Failure> {
        let unknown = self.unknown();
        let mut residual = self.residual(&trial);
        let mut stuck = 0;
        for _ in 0..ITERATIONS {
            if self.worst(&residual).0 < 1e-3 * STEADY {
                break;
            }
            let wanted: Vec<f64> = residual.iter().map(|r| -r).collect();
            let mut change = self.jacobian(&trial, &unknown).solve(&wanted);
            let over = unknown.iter().zip(&change).fold(1.0, |over, (&i, change)| {
                let most = if i < OUTER { STEP_MAX[i] } else { max(0.3 * trial[i].abs(), 5.0) };
                max(over, change.abs() / most)
            });
            change.iter_mut().for_each(|change| *change /= over);
            let merit = self.merit(&residual);
            let mut part = 1.0;
            let better = loop {
                let mut moved = trial.clone();
                for (&i, change) in unknown.iter().zip(&change) {
                    moved[i] += part * change;
                }
                let left = self.residual(&moved);
                if self.merit(&left) < merit * (1.0 - 1e-3 * part) {
                    break Some((moved, left));
                }
                part *= 0.5;
                if part < 1e-3 {
                    break None;
                }
            };
            if let Some((moved, left)) = better {
                (trial, residual) = (moved, left);
            } else if self.worst(&residual).0 < STEADY || stuck == 3 {
                break;
            } else {
                // A fold or a kink: let the inner states find their way and try again from there.
                stuck += 1;
                let mut outer = [0.0; OUTER];
                outer.copy_from_slice(&trial[..OUTER]);
                for (&i, change) in self.outer.iter().zip(&change) {
                    outer[i] += 0.3 * change;
                }
                trial = self.settled(&outer, self.state(&outer, Some(&trial[OUTER..])));
                residual = self.residual(&trial);
            }
        }
        let (left, of) = self.worst(&residual);
        if left >= STEADY || left.is_nan() {
            return Err(Failure::Unsteady { residual: left, of });
        }
        self.finish(&trial, left)
    }

    /// The state of a trial that is steady, with lever and governor where they belong.
    fn finish(&self, trial: &Trial, residual: f64) -> Result<Trim, Failure> {
        let (aircraft, world) = (self.aircraft, &self.target.world);
        let mut state = self.state(trial, Some(&trial[OUTER..]));
        let lever_norm = match self.target.power {
            Power::Lever(lever_norm) => lever_norm,
            Power::Climb(_) => self.lever(&state),
        };
        state.cockpit.collective_norm = lever_norm;
        self.set_controls(&mut state, trial[COLLECTIVE]);
        let (next, outputs) = step::derivatives(aircraft, &state, world);
        state.rate = next.rate;
        state.rate.motion.acceleration_mps2 =
            a_tick_before(next.rate.motion.acceleration_mps2, self.target.turn_radps);
        let state = state.without_negative_zeros();
        let report = Report::new(aircraft, &state, &outputs, residual);
        let trim = Trim { state, outputs, report };
        let power_w_per_s = next.rate.engines.power_w_per_s;
        match beyond(aircraft, self.torque_n_m_max, &trim, power_w_per_s) {
            Some((what, wanted_norm)) => {
                Err(Failure::Beyond { what, wanted_norm, trim: Box::new(trim) })
            }
            None => Ok(trim),
        }
    }

    /// The lever that keeps the engines' power, or the stop that is nearest to it.
    fn lever(&self, state: &State) -> f64 {
        let gains = |lever_norm: f64| {
            let mut at = *state;
            at.actuators.lever_norm = lever_norm;
            let rate = step::derivatives(self.aircraft, &at, &self.target.world).0.rate.engines;
            if self.running.right { rate.power_w_per_s.right } else { rate.power_w_per_s.left }
        };
        if !self.running.left && !self.running.right {
            return 0.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        if gains(high) < 0.0 {
            return high;
        }
        if gains(low) > 0.0 {
            return low;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if gains(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// An acceleration that turns with the aircraft, a tick before: what the integration remembers.
fn a_tick_before(acceleration_mps2: Vec3<Ned>, turn_radps: f64) -> Vec3<Ned> {
    let (s, c) = (sin(turn_radps * STEP_S), cos(turn_radps * STEP_S));
    let Vec3 { x, y, z, .. } = acceleration_mps2;
    Vec3::new(c * x + s * y, c * y - s * x, z)
}
