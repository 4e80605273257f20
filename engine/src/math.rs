//! The only transcendental functions of the project: `libm`'s, pinned to one version.
//!
//! The standard library's call the machine's own C library, whose last bit depends on the CPU.

/// Archimedes' constant.
pub const PI: f64 = core::f64::consts::PI;
/// Half of it.
pub const FRAC_PI_2: f64 = core::f64::consts::FRAC_PI_2;
/// Twice it.
pub const TAU: f64 = core::f64::consts::TAU;

/// Sine of an angle in rad.
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine of an angle in rad.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Sine and cosine of an angle in rad: the bits of [`sin()`] and [`cos()`] for little more than one of them.
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Tangent of an angle in rad.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Angle of the point (x, y), rad, −π..π.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Arc sine, rad; arguments beyond ±1 count as ±1.
pub fn asin(x: f64) -> f64 {
    libm::asin(clamp(x, -1.0, 1.0))
}

/// eˣ.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Square root.
pub fn sqrt(x: f64) -> f64 {
    libm::sqrt(x)
}

/// xʸ for positive x, by exp and ln: a quarter of the time of `libm::pow`.
pub fn pow_positive(x: f64, y: f64) -> f64 {
    exp(y * ln(x))
}

/// The smaller one. Unlike `f64::min` it has one answer for signed zeros.
pub fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger one. Unlike `f64::max` it has one answer for signed zeros.
pub fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// `x` held within `low..=high`.
pub fn clamp(x: f64, low: f64, high: f64) -> f64 {
    max(low, min(x, high))
}

/// `x` squared.
pub fn square(x: f64) -> f64 {
    x * x
}

/// −1, 0 or 1.
pub fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}

/// 0 below `from`, 1 above `to`, a straight line between.
pub fn ramp(x: f64, from: f64, to: f64) -> f64 {
    clamp((x - from) / (to - from), 0.0, 1.0)
}

/// The angle within −π..π, rad. Odd: the wrapped mirror is the mirrored wrap.
pub fn wrap_angle(angle_rad: f64) -> f64 {
    angle_rad - TAU * libm::rint(angle_rad / TAU)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_together_are_those_alone() {
        let bits = |x: f64| if x.is_nan() { u64::MAX } else { x.to_bits() };
        let same = |x: f64| {
            let (s, c) = sin_cos(x);
            assert_eq!((bits(s), bits(c)), (bits(sin(x)), bits(cos(x))), "{x:e}");
        };
        for x in [0.0, f64::MIN_POSITIVE, 5e-324, f64::INFINITY, f64::NAN] {
            same(x);
            same(-x);
        }
        // Every order of magnitude, densest where the two functions begin to differ from their series.
        let mut x = 1e-9;
        while x < 1e12 {
            same(x);
            same(-x);
            x *= if x < 1e-7 { 1.000_1 } else { 1.000_7 };
        }
    }
}
