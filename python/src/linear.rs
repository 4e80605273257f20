//! Small motions about a steady flight.

use analysis::Matrix;
use analysis::linearize::{INPUTS, Linear as Found, OUTPUTS};
use pyo3::prelude::*;

use crate::errors::TiltrotorError;

/// The matrices of ẋ = A·x + B·u, y = C·x + D·u, SI units and radians.
#[pyclass(module = "tiltrotor", frozen)]
pub struct Linear {
    pub(crate) found: Found,
}

/// Rows, columns, and the numbers row by row.
type Numbers = (usize, usize, Vec<f64>);

fn numbers(matrix: &Matrix) -> Numbers {
    let rows = matrix.row_iter();
    (matrix.nrows(), matrix.ncols(), rows.flat_map(|row| row.iter().copied().collect::<Vec<_>>()).collect())
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
            _ => Err(TiltrotorError::new_err(format!("{name}: no such matrix; there are A, B, C, D"))),
        }
    }

    /// Eigenvalues of A from the slowest, 1/s.
    fn eigenvalues(&self) -> PyResult<Vec<(f64, f64)>> {
        let found = self.found.eigenvalues().map_err(|why| TiltrotorError::new_err(why.to_string()))?;
        Ok(found.iter().map(|value| (value.re, value.im)).collect())
    }
}
