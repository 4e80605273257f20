//! Matrices of any size and complex numbers: nalgebra's, with what it leaves to the standard library.

use engine::math::{atan2, sqrt, square};

/// A complex number.
pub type Complex = nalgebra::Complex<f64>;
/// A real matrix of any size.
pub type Matrix = nalgebra::DMatrix<f64>;

/// A complex number by magnitude and phase.
pub trait Polar {
    /// Distance from zero.
    fn magnitude(self) -> f64;
    /// Angle, −π..π.
    fn phase_rad(self) -> f64;
}

impl Polar for Complex {
    fn magnitude(self) -> f64 {
        sqrt(square(self.re) + square(self.im))
    }

    fn phase_rad(self) -> f64 {
        atan2(self.im, self.re)
    }
}
