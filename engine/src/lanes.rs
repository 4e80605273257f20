//! Lanes: four numbers at once, each of them treated as it would be alone.
//!
//! Only what gives the same bits on every CPU is here: sum, difference, product, quotient and square
//! root, which IEEE 754 rounds in one way, comparisons, and the choice between two numbers. What the
//! crate `wide` has beyond that stays out: its `min` and `max` answer otherwise for NaN and signed
//! zeros on other CPUs, its fused products round once or twice, its sums over the lanes have no
//! order. This file alone knows it; numbers in lanes are added up in an order of their own by
//! whoever has [their array](Lanes::to_array).
//!
//! A branch is a choice by [`Mask::select`]: both sides are evaluated, each lane takes its own. It
//! pays to ask [`Mask::any`] first where a side is hardly ever taken. A comparison with NaN is false,
//! as it is between numbers.
#![expect(clippy::disallowed_types, reason = "the one file that may use them")]

use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

use wide::f64x4;

use crate::math;

/// How many numbers.
pub const LANES: usize = 4;

/// Four numbers.
#[derive(Clone, Copy, Debug)]
pub struct Lanes(f64x4);

/// In which lanes something holds.
#[derive(Clone, Copy, Debug)]
pub struct Mask(f64x4);

impl From<f64> for Lanes {
    /// The same number in every lane.
    #[inline(always)]
    fn from(x: f64) -> Self {
        Self(f64x4::splat(x))
    }
}

impl From<[f64; LANES]> for Lanes {
    #[inline(always)]
    fn from(x: [f64; LANES]) -> Self {
        Self(f64x4::new(x))
    }
}

/// An operator between lanes, and between lanes and a number that is the same in all of them.
macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<T: Into<Lanes>> $trait<T> for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: T) -> Self {
                Self($trait::$method(self.0, other.into().0))
            }
        }

        impl $trait<Lanes> for f64 {
            type Output = Lanes;
            #[inline(always)]
            fn $method(self, other: Lanes) -> Lanes {
                $trait::$method(Lanes::from(self), other)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Lanes {
    /// Every lane's number from its place.
    #[inline(always)]
    pub fn from_fn(f: impl FnMut(usize) -> f64) -> Self {
        Self::from(core::array::from_fn(f))
    }

    /// The numbers, in the order of the lanes.
    #[inline(always)]
    pub fn to_array(self) -> [f64; LANES] {
        self.0.to_array()
    }

    /// Without the sign.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(self.0.abs())
    }

    /// Where it is less.
    #[inline(always)]
    pub fn below(self, other: impl Into<Self>) -> Mask {
        Mask(self.0.simd_lt(other.into().0))
    }

    /// Where it is greater.
    #[inline(always)]
    pub fn above(self, other: impl Into<Self>) -> Mask {
        other.into().below(self)
    }
}

impl Mask {
    /// `yes` where it holds, else `no`.
    #[inline(always)]
    pub fn select(self, yes: impl Into<Lanes>, no: impl Into<Lanes>) -> Lanes {
        Lanes(self.0.select(yes.into().0, no.into().0))
    }

    /// Whether it holds in any lane.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.0.any()
    }
}

impl BitAnd for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

/// [`math::min`] of each lane. Written so, it is one instruction for two lanes.
#[inline(always)]
pub fn min(a: impl Into<Lanes>, b: impl Into<Lanes>) -> Lanes {
    let (a, b) = (a.into().to_array(), b.into().to_array());
    Lanes::from_fn(|lane| math::min(a[lane], b[lane]))
}

/// [`math::max`] of each lane.
#[inline(always)]
pub fn max(a: impl Into<Lanes>, b: impl Into<Lanes>) -> Lanes {
    let (a, b) = (a.into().to_array(), b.into().to_array());
    Lanes::from_fn(|lane| math::max(a[lane], b[lane]))
}

/// [`math::clamp`] of each lane.
#[inline(always)]
pub fn clamp(x: Lanes, low: impl Into<Lanes>, high: impl Into<Lanes>) -> Lanes {
    max(low, min(x, high))
}

/// [`math::ramp`] of each lane.
#[inline(always)]
pub fn ramp(x: Lanes, from: f64, to: f64) -> Lanes {
    clamp((x - from) / (to - from), 0.0, 1.0)
}

/// Square root of each lane.
#[inline(always)]
pub fn sqrt(x: Lanes) -> Lanes {
    Lanes(x.0.sqrt())
}

/// Each lane squared.
#[inline(always)]
pub fn square(x: Lanes) -> Lanes {
    x * x
}

/// Sine and cosine of each lane's angle, one after the other: they are those of [`math`].
#[inline(always)]
pub fn sin_cos(angle_rad: Lanes) -> (Lanes, Lanes) {
    let both = angle_rad.to_array().map(math::sin_cos);
    (both.map(|(s, _)| s).into(), both.map(|(_, c)| c).into())
}

/// The greatest whole number not above each lane, 0 ≤ x < 2⁵¹, and the same as integers.
///
/// In a number of 2⁵² and more the last bit counts whole ones: adding that much rounds to the nearest
/// whole number, without a conversion, which CPUs have only one by one.
#[inline(always)]
pub fn whole(x: Lanes) -> (Lanes, [u64; LANES]) {
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    let nearest = x + WHOLE - WHOLE;
    let below = x.below(nearest).select(nearest - 1.0, nearest);
    (below, (below + WHOLE).to_array().map(|sum| sum.to_bits() - WHOLE.to_bits()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pair of these meets in some lane.
    const ODD: [f64; 12] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.1,
        -1e-300,
        5e-324,
        1e300,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        3.5,
    ];

    fn bits(x: f64) -> u64 {
        // Which NaN comes out is the machine's choice.
        if x.is_nan() { u64::MAX } else { x.to_bits() }
    }

    fn same(lanes: Lanes, alone: impl Fn(usize) -> f64, what: &str) {
        let lanes = core::hint::black_box(lanes).to_array();
        for (lane, x) in lanes.into_iter().enumerate() {
            assert_eq!(bits(x), bits(alone(lane)), "{what}, lane {lane}: {x}");
        }
    }

    #[test]
    fn each_lane_has_the_bits_of_a_number_alone() {
        for first in 0..ODD.len() {
            for second in 0..ODD.len() {
                let a: [f64; LANES] = core::array::from_fn(|k| ODD[(first + k) % ODD.len()]);
                let b: [f64; LANES] = core::array::from_fn(|k| ODD[(second + 3 * k) % ODD.len()]);
                let (x, y) = core::hint::black_box((Lanes::from(a), Lanes::from(b)));
                same(x + y, |k| a[k] + b[k], "sum");
                same(x - y, |k| a[k] - b[k], "difference");
                same(x * y, |k| a[k] * b[k], "product");
                same(x / y, |k| a[k] / b[k], "quotient");
                same(-x, |k| -a[k], "opposite");
                same(sqrt(x), |k| math::sqrt(a[k]), "square root");
                same(x.abs(), |k| a[k].abs(), "without sign");
                same(min(x, y), |k| math::min(a[k], b[k]), "min");
                same(max(x, y), |k| math::max(a[k], b[k]), "max");
                same(clamp(x, y, 1.0), |k| math::clamp(a[k], b[k], 1.0), "clamp");
                same(ramp(x, -0.5, 2.0), |k| math::ramp(a[k], -0.5, 2.0), "ramp");
                same(x.below(y).select(x, y), |k| if a[k] < b[k] { a[k] } else { b[k] }, "below");
                same(x.above(y).select(1.0, 2.0), |k| if a[k] > b[k] { 1.0 } else { 2.0 }, "above");
                let unknown = !(x.below(y) | y.below(x) & x.below(0.0));
                let alone = |k: usize| a[k] < b[k] || (b[k] < a[k] && a[k] < 0.0);
                same(unknown.select(x, 0.5), |k| if alone(k) { 0.5 } else { a[k] }, "not");
                assert_eq!(x.below(y).any(), (0..LANES).any(|k| a[k] < b[k]), "any");
                same(sin_cos(x).0, |k| math::sin(a[k]), "sine");
                same(sin_cos(x).1, |k| math::cos(a[k]), "cosine");
            }
        }
    }

    #[test]
    fn the_whole_part_is_that_of_a_conversion() {
        for x in [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.5, 2.999_999_999_999_999_6, 14.0, 14.5, 1e9] {
            let (below, index) = whole(core::hint::black_box(Lanes::from(x)));
            same(below, |_| f64::from(x as u32), "whole part");
            assert_eq!(index, [x as u64; LANES], "{x}");
        }
    }
}
