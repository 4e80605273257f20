//! Small motions about a steady flight.

use analysis::Matrix;
use analysis::linearize::{INPUTS, Linear as Found, OUTPUTS};
use analysis::modes::modes;
use pyo3::prelude::*;

use crate::errors::{refused, unsteady};

/// The matrices of ẋ = A·x + B·u, y = C·x + D·u, SI units and radians.
#[pyclass(module = "tiltrotor._native", frozen)]
pub struct Linear {
    pub(crate) found: Found,
    pub(crate) airspeed_mps: f64,
}

/// Rows, columns, and the numbers row by row.
type Numbers = (usize, usize, Vec<f64>);

fn numbers(matrix: &Matrix) -> Numbers {
    let by_rows = matrix.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<_>>());
    (matrix.nrows(), matrix.ncols(), by_rows.collect())
}

#[pymethods]
impl Linear {
    #[getter]
    fn states(&self) -> Vec<String> {
        self.found.states.iter().map(ToString::to_string).collect()
    }

    #[getter]
    fn inputs(&self) -> Vec<&'static str> {
        INPUTS.to_vec()
    }

    #[getter]
    fn outputs(&self) -> Vec<&'static str> {
        OUTPUTS.to_vec()
    }

    /// A matrix by its letter.
    fn matrix(&self, name: &str) -> PyResult<Numbers> {
        match name {
            "A" => Ok(numbers(&self.found.a)),
            "B" => Ok(numbers(&self.found.b)),
            "C" => Ok(numbers(&self.found.c)),
            "D" => Ok(numbers(&self.found.d)),
            _ => Err(refused(format!("{name}: no such matrix; there are A, B, C, D"))),
        }
    }

    /// Eigenvalues of A from the slowest, 1/s.
    fn eigenvalues(&self) -> PyResult<Vec<(f64, f64)>> {
        let found = self.found.eigenvalues().map_err(|why| unsteady(&why))?;
        Ok(found.iter().map(|value| (value.re, value.im)).collect())
    }

    /// What the modes are called, from the slowest: name, eigenvalue, and whether it is a fast one.
    fn modes(&self) -> PyResult<Vec<(&'static str, f64, f64, bool)>> {
        let found = modes(&self.found, self.airspeed_mps).map_err(|why| unsteady(&why))?;
        let told = found.iter().map(|m| (m.name, m.eigenvalue.re, m.eigenvalue.im, m.fast));
        Ok(told.collect())
    }
}
