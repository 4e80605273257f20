//! Tilts of a disc as complex numbers: z = a + i·b, aft and right.

use core::ops::{Add, Mul, Sub};

use crate::math::square;

/// Aft and right, of an angle, a rate or a moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tilt {
    pub aft: f64,
    pub right: f64,
}

impl Tilt {
    pub const fn new(aft: f64, right: f64) -> Self {
        Self { aft, right }
    }

    /// i·z: a quarter turn on, against the rotation.
    pub fn turned(self) -> Self {
        Self::new(-self.right, self.aft)
    }

    /// 1/z.
    pub fn inverse(self) -> Self {
        let scale = 1.0 / (square(self.aft) + square(self.right));
        Self::new(scale * self.aft, -scale * self.right)
    }
}

impl Add for Tilt {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.aft + other.aft, self.right + other.right)
    }
}

impl Sub for Tilt {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.aft - other.aft, self.right - other.right)
    }
}

impl Mul<f64> for Tilt {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.aft * factor, self.right * factor)
    }
}

impl Mul for Tilt {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.aft * other.aft - self.right * other.right,
            self.aft * other.right + self.right * other.aft,
        )
    }
}
