//! Newton's method with a line search, and the steady state it ends in.

use alloc::boxed::Box;
use alloc::vec::Vec;

use engine::frames::{Ned, Vec3};
use engine::math::{cos, max, sin, sqrt, square};
use engine::{STEP_S, State, step};

use super::found::{Failure, Trim};
use super::problem::{Outer, Problem, Trial, Unknown};
use super::report::{Report, beyond};
use super::residual::{INNER_WEIGHT, Residual};
use super::target::Power;
use crate::Matrix;
use crate::solve::solve;

/// Below this an acceleration is rounding.
const STEADY: f64 = 1e-8;

/// A trial is this good at the latest after so many iterations, or never.
const ITERATIONS: usize = 60;

impl Problem<'_> {
    fn merit(&self, residual: &[f64]) -> f64 {
        let outer = self.equations.iter().zip(residual).map(|(equation, r)| equation.weight() * r);
        let inner = residual[self.equations.len()..].iter().map(|r| INNER_WEIGHT * r);
        let merit = sqrt(outer.chain(inner).map(square).sum());
        if merit.is_finite() { merit } else { f64::MAX }
    }

    /// The largest of them, and what it is of. Inner rates count by their weight.
    fn worst(&self, residual: &[f64]) -> (f64, Option<Residual>) {
        let mut worst = (0.0, None);
        for (i, r) in residual.iter().enumerate() {
            let (size, of) = match self.equations.get(i) {
                Some(&equation) => (r.abs(), Residual::Equation(equation)),
                None => {
                    let inner = self.inner[i - self.equations.len()];
                    (INNER_WEIGHT * r.abs(), Residual::Inner(inner))
                }
            };
            // What is not a number is worse than any.
            if size > worst.0 || size.is_nan() {
                worst = (size, Some(of));
            }
        }
        worst
    }

    /// Every unknown, in the order of the Jacobian's columns.
    fn unknown(&self) -> Vec<Unknown> {
        let outer = self.outer.iter().map(|&outer| Unknown::Outer(outer));
        outer.chain((0..self.inner.len()).map(Unknown::Inner)).collect()
    }

    /// Change of every residual (rows) with every unknown (columns), by central differences.
    fn jacobian(&self, trial: &Trial, unknown: &[Unknown]) -> Matrix {
        let mut jacobian = Matrix::zeros(unknown.len(), unknown.len());
        for (column, &i) in unknown.iter().enumerate() {
            let size = match i {
                Unknown::Outer(_) => 1.0,
                Unknown::Inner(_) => max(1.0, trial[i].abs()),
            };
            let step = 1e-6 * size;
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
            let mut change = solve(&self.jacobian(&trial, &unknown), &wanted);
            let over = unknown.iter().zip(&change).fold(1.0, |over, (&i, change)| {
                let most = match i {
                    Unknown::Outer(outer) => outer.step_max(),
                    Unknown::Inner(_) => max(0.3 * trial[i].abs(), 5.0),
                };
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
                // The inner states go on from where they are: they find their way, and are not moved.
                for (&outer, change) in self.outer.iter().zip(&change) {
                    trial[outer] += 0.3 * change;
                }
                trial = self.settled(trial);
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
        let mut state = self.state(trial);
        let lever_norm = match self.target.power {
            Power::Lever(lever_norm) => lever_norm,
            Power::Climb(_) => self.lever(&state),
        };
        state.cockpit.collective_norm = lever_norm;
        self.set_controls(&mut state, trial[Outer::Collective]);
        let (next, outputs) = step::derivatives(aircraft, &state, world);
        state.rate = next.rate;
        state.rate.motion.acceleration_mps2 =
            a_tick_before(next.rate.motion.acceleration_mps2, self.target.turn_radps);
        let state = state.without_negative_zeros();
        let report = Report::new(aircraft, &state, &outputs, residual);
        let beyond = beyond(aircraft, self.torque_n_m_max, &state, &outputs, &report);
        let trim = Trim { state, outputs, report };
        match beyond {
            Some((limit, wanted_norm)) => {
                Err(Failure::Beyond { limit, wanted_norm, trim: Box::new(trim) })
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
