//! Where a rotor stands still, and how it answers small inputs.

use engine::math::max;
use engine::rotors::flapping::Damping;
use nalgebra::{DMatrix, DVector};

use super::{Form, INPUTS, Input, OUTPUTS, Output, Rotor};

impl Rotor {
    /// Slopes of ẋ and y by x and u.
    fn slopes(&self, form: Form, x: &[f64], by_input: bool) -> (DMatrix<f64>, DMatrix<f64>) {
        let (n, count) = (x.len(), if by_input { INPUTS } else { x.len() });
        let (mut rates, mut outputs) = (DMatrix::zeros(n, count), DMatrix::zeros(OUTPUTS, count));
        for column in 0..count {
            let moved = |by: f64| {
                let (mut x, mut u) = (x.to_vec(), [0.0; INPUTS]);
                if by_input {
                    u[column] += by;
                } else {
                    x[column] += by;
                }
                self.equations(form, &x, &u)
            };
            let step = 1e-6;
            let (above, below) = (moved(step), moved(-step));
            for row in 0..n {
                rates[(row, column)] = (above.0[row] - below.0[row]) / (2.0 * step);
            }
            for row in 0..OUTPUTS {
                outputs[(row, column)] = (above.1[row] - below.1[row]) / (2.0 * step);
            }
        }
        (rates, outputs)
    }

    /// Where the form stands still under the trim's controls, by Newton's method.
    pub fn steady(&self, form: Form) -> Steady {
        let mut x = self.guess(form);
        assert_eq!(x.len(), Self::size(form));
        for _ in 0..50 {
            let (rates, _) = self.slopes(form, &x, false);
            let still = DVector::from_vec(self.equations(form, &x, &[0.0; INPUTS]).0);
            let step = rates.lu().solve(&still).unwrap_or_else(|| panic!("no steady rotor"));
            for (x, step) in x.iter_mut().zip(step.iter()) {
                *x -= step;
            }
            if step.amax() < 1e-11 {
                break;
            }
        }
        let (rate, y) = self.equations(form, &x, &[0.0; INPUTS]);
        let off = rate.iter().fold(0.0_f64, |most, rate| max(most, rate.abs()));
        assert!(off < 1e-6, "the rotor does not stand still: {off}");
        let ((a, c), (b, d)) = (self.slopes(form, &x, false), self.slopes(form, &x, true));
        let damping = self.air(form, &x, &[0.0; INPUTS]).0.damping;
        Steady { y, damping, a, b, c, d }
    }
}

/// A steady rotor and its answers to small inputs.
pub struct Steady {
    pub(super) y: [f64; OUTPUTS],
    /// D, of the full form.
    pub(super) damping: Damping,
    pub(super) a: DMatrix<f64>,
    pub(super) b: DMatrix<f64>,
    pub(super) c: DMatrix<f64>,
    pub(super) d: DMatrix<f64>,
}

impl Steady {
    /// What it gives.
    pub fn output(&self, output: Output) -> f64 {
        self.y[output as usize]
    }

    /// C·(iω − A)⁻¹·B + D, real and imaginary part.
    pub fn response(&self, input: Input, output: Output, omega_radps: f64) -> (f64, f64) {
        let at = (0.0, omega_radps);
        respond(&self.a, &self.b, (&self.c, &self.d), (input, output), at)
    }
}

/// C·(z − A)⁻¹·B + D, real and imaginary part.
pub(super) fn respond(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    (c, d): (&DMatrix<f64>, &DMatrix<f64>),
    (input, output): (Input, Output),
    z: (f64, f64),
) -> (f64, f64) {
    let n = a.nrows();
    // (z − A)·(x + iy) = b in real numbers.
    let mut system = DMatrix::zeros(2 * n, 2 * n);
    system.view_mut((0, 0), (n, n)).copy_from(&-a);
    system.view_mut((n, n), (n, n)).copy_from(&-a);
    for i in 0..n {
        system[(i, i)] += z.0;
        system[(n + i, n + i)] += z.0;
        system[(i, n + i)] = -z.1;
        system[(n + i, i)] = z.1;
    }
    let (input, output) = (input as usize, output as usize);
    let mut right = DVector::zeros(2 * n);
    right.rows_mut(0, n).copy_from(&b.column(input));
    let x = system.lu().solve(&right).unwrap_or_else(|| panic!("a root on the axis"));
    let row = c.row(output);
    let part = |from: usize| (0..n).map(|i| row[i] * x[from + i]).sum::<f64>();
    (part(0) + d[(output, input)], part(n))
}
