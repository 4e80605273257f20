//! Coefficients as the reports print them: one column for each flap setting and Mach number.
//!
//! # Equations
//! ```text
//! c(λ, δF, M, α): linear in each, held beyond the ends                           [CR536 4-I to 4-IV]
//! λ = βm/90° for lift; for drag 1 − (f(βm) − f(90°))/(f(0) − f(90°)), f = |sin(90° − βm + α)|³
//! a column that ends before ±180° goes over, within 10°, to the next wider one:
//! high Mach number → low Mach number → upright mast
//! ```
//! # Assumptions
//! Only masts upright and level are printed; what lies between is ours. Lift goes over in a straight
//! line. What the upright columns have more of drag is the pylons', .2 of CD, and a slender body across
//! the flow has a drag as the cube of the sine of the angle between them, as the source's own spinner
//! has (1 + 5.5·sin³α_m): at 60° of tilt and no angle of attack an eighth of it is left, not a third.
//! What lies beyond a column's print is an estimate, and continuous.

use serde::Deserialize;

use crate::math::{FRAC_PI_2, clamp, cos, sin_cos};
use crate::table::axis::Alpha;
use crate::table::{Axis, Table1};
use crate::units::DEGREE_RAD as DEG;

/// Within this angle beyond its print a column goes over to a wider one.
const FADE_RAD: f64 = 10.0 * DEG;
/// Beyond this angle of attack the pylons' drag goes over from upright to level as at it.
const ALPHA_RAD_MAX: f64 = 20.0 * DEG;
/// Flap settings of the columns; the flaperons droop with them to 0, 12.5, 25 and 47°.
const FLAP_RAD: [f64; 4] = [0.0, 20.0 * DEG, 40.0 * DEG, 75.0 * DEG];
/// Mach numbers of the columns; the first holds below, too.
const MACH: [f64; 4] = [0.2, 0.4, 0.5, 0.6];

/// The interval of four columns that holds `at`, and how far into it `at` lies.
fn between(columns: &[f64; 4], at: f64) -> (usize, f64) {
    let i = if at < columns[1] {
        0
    } else if at < columns[2] {
        1
    } else {
        2
    };
    (i, clamp((at - columns[i]) / (columns[i + 1] - columns[i]), 0.0, 1.0))
}

/// A setting of the flaps between two columns.
#[derive(Clone, Copy, Debug)]
pub struct Flap {
    column: usize,
    beyond: f64,
}

impl Flap {
    /// Where a flap angle lies among the columns.
    pub fn new(flap_rad: f64) -> Self {
        let (column, beyond) = between(&FLAP_RAD, flap_rad);
        Self { column, beyond }
    }

    /// Between the two columns, by number, that it lies between.
    pub fn blend(self, column: impl Fn(usize) -> f64) -> f64 {
        let low = column(self.column);
        if self.beyond > 0.0 { low + self.beyond * (column(self.column + 1) - low) } else { low }
    }
}

/// One table over angle of attack for each flap setting.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ByFlap {
    /// Flaps up.
    pub flap_0: Table1<Alpha>,
    /// 20/12.5.
    pub flap_20: Table1<Alpha>,
    /// 40/25.
    pub flap_40: Table1<Alpha>,
    /// 75/47.
    pub flap_75: Table1<Alpha>,
}

impl ByFlap {
    /// By setting, in order.
    pub fn columns(&self) -> [&Table1<Alpha>; 4] {
        [&self.flap_0, &self.flap_20, &self.flap_40, &self.flap_75]
    }

    /// # Errors
    /// What is expected, if it is not so.
    pub fn validate(&self) -> Result<(), &'static str> {
        self.columns().into_iter().try_for_each(Table1::validate)
    }
}

/// One table over an angle for each Mach number above .2.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, bound = "")]
pub struct ByMach<A: Axis> {
    /// .4.
    pub mach_0_4: Table1<A>,
    /// .5.
    pub mach_0_5: Table1<A>,
    /// .6.
    pub mach_0_6: Table1<A>,
}

impl<A: Axis> ByMach<A> {
    /// The value at an angle, where `slow` is the one at Mach number .2 and below.
    pub fn at(&self, mach: f64, angle: A, slow: f64) -> f64 {
        if mach <= MACH[0] {
            return slow;
        }
        let column = |i: usize| match i {
            0 => slow,
            1 => self.mach_0_4.at_or(angle, slow, FADE_RAD),
            2 => self.mach_0_5.at_or(angle, slow, FADE_RAD),
            _ => self.mach_0_6.at_or(angle, slow, FADE_RAD),
        };
        let (i, t) = between(&MACH, mach);
        let low = column(i);
        low + t * (column(i + 1) - low)
    }

    /// The same for a table that is odd in its angle and printed for positive ones.
    pub fn odd_at(&self, mach: f64, angle: A, slow: f64) -> f64 {
        if angle.si() < 0.0 {
            -self.at(mach, A::new(-angle.si()), -slow)
        } else {
            self.at(mach, angle, slow)
        }
    }

    /// By Mach number, in order.
    pub fn columns(&self) -> [&Table1<A>; 3] {
        [&self.mach_0_4, &self.mach_0_5, &self.mach_0_6]
    }

    /// # Errors
    /// What is expected, if it is not so.
    pub fn validate(&self) -> Result<(), &'static str> {
        self.columns().into_iter().try_for_each(Table1::validate)
    }
}

/// A coefficient of wing and pylon over ±180° of angle of attack.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polar {
    /// Masts upright.
    pub upright: ByFlap,
    /// As an aeroplane, at Mach number .2 and below.
    pub aeroplane: ByFlap,
    /// As an aeroplane, flaps up.
    pub aeroplane_by_mach: ByMach<Alpha>,
}

impl Polar {
    /// Lift: in a straight line with the masts' tilt.
    pub fn lift_at(&self, mast_tilt_rad: f64, flap: Flap, mach: f64, alpha_rad: f64) -> f64 {
        let level = clamp(mast_tilt_rad / FRAC_PI_2, 0.0, 1.0);
        self.at(level, flap, mach, Alpha(alpha_rad))
    }

    /// Drag: with how far the pylons stand across the flow.
    pub fn drag_at(&self, mast_tilt_rad: f64, flap: Flap, mach: f64, alpha_rad: f64) -> f64 {
        let alpha = clamp(alpha_rad, -ALPHA_RAD_MAX, ALPHA_RAD_MAX);
        let cube = |x: f64| (x * x * x).abs();
        let (sin_alpha, cos_alpha) = sin_cos(alpha);
        let level = cube(sin_alpha);
        let across = (cube(cos(mast_tilt_rad - alpha)) - level) / (cube(cos_alpha) - level);
        self.at(1.0 - clamp(across, 0.0, 1.0), flap, mach, Alpha(alpha_rad))
    }

    /// The coefficient, from masts upright, 0, to level, 1.
    fn at(&self, level: f64, flap: Flap, mach: f64, alpha: Alpha) -> f64 {
        let column = |i: usize| {
            let upright = self.upright.columns()[i].at(alpha);
            if level <= 0.0 {
                return upright;
            }
            let slow = self.aeroplane.columns()[i].at_or(alpha, upright, FADE_RAD);
            let fast = if i == 0 { self.aeroplane_by_mach.at(mach, alpha, slow) } else { slow };
            upright + level * (fast - upright)
        };
        flap.blend(column)
    }

    /// # Errors
    /// What is expected, if it is not so.
    pub fn validate(&self) -> Result<(), &'static str> {
        self.upright
            .validate()
            .and_then(|()| self.aeroplane.validate())
            .and_then(|()| self.aeroplane_by_mach.validate())
    }
}
