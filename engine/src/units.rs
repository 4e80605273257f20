//! Units that are not SI's, by their definitions.
//!
//! A constant named `FOOT_M` is the unit in SI: `25.0 * FOOT_M` is a length in metres, `length_m /
//! FOOT_M` one in feet. A constant `DEG_PER_RAD` is the factor the other way. Both are there where
//! both are used: a number multiplied by the one and divided by the other differ in the last bit, and
//! a recorded value keeps the order of its operations. So do the functions, which multiply before
//! they divide.
//!
//! # Source
//! Inch, foot and pound: the international yard and pound agreement of 1959, exact. Nautical mile:
//! exact. Pound-force, slug, horsepower: from those and standard gravity, which is exact too.

use crate::GRAVITY_MPS2;
use crate::math::{PI, TAU, wrap_angle};

/// Inch, m.
pub const INCH_M: f64 = 0.0254;
/// Foot, m.
pub const FOOT_M: f64 = 0.3048;
/// Nautical mile, m.
pub const NAUTICAL_MILE_M: f64 = 1852.0;
/// Minute, s.
pub const MINUTE_S: f64 = 60.0;
/// Hour, s.
pub const HOUR_S: f64 = 3600.0;
/// Knot, a nautical mile an hour, m/s.
pub const KNOT_MPS: f64 = NAUTICAL_MILE_M / HOUR_S;
/// Foot a minute, m/s.
pub const FOOT_PER_MINUTE_MPS: f64 = FOOT_M / MINUTE_S;
/// Pound, the mass, kg.
pub const POUND_KG: f64 = 0.453_592_37;
/// Pound, the force: the weight of a pound at standard gravity, N.
pub const POUND_N: f64 = POUND_KG * GRAVITY_MPS2;
/// Slug: the mass that a pound of force accelerates by a foot per second squared, kg.
pub const SLUG_KG: f64 = POUND_N / FOOT_M;
/// Horsepower: 550 foot-pounds a second, W.
pub const HORSEPOWER_W: f64 = 550.0 * FOOT_M * POUND_N;
/// Hectopascal, Pa.
pub const HECTOPASCAL_PA: f64 = 100.0;
/// Degree, rad.
pub const DEGREE_RAD: f64 = PI / 180.0;
/// Revolution a minute, rad/s.
pub const RPM_RADPS: f64 = PI / 30.0;

/// Degrees in a radian.
pub const DEG_PER_RAD: f64 = 180.0 / PI;
/// Knots in a metre a second.
pub const KT_PER_MPS: f64 = HOUR_S / NAUTICAL_MILE_M;
/// Feet a minute in a metre a second.
pub const FPM_PER_MPS: f64 = MINUTE_S / FOOT_M;
/// Revolutions a minute in a radian a second.
pub const RPM_PER_RADPS: f64 = MINUTE_S / TAU;

/// An angle, deg.
pub fn degrees(angle_rad: f64) -> f64 {
    angle_rad * 180.0 / PI
}

/// A direction as a compass shows it, from 0 to below 360 deg and never −0.
pub fn compass_deg(heading_rad: f64) -> f64 {
    let from_north_deg = degrees(wrap_angle(heading_rad));
    let turned_deg = if from_north_deg < 0.0 { from_north_deg + 360.0 } else { from_north_deg };
    // A little west of north it rounds to a whole turn.
    if turned_deg < 360.0 { turned_deg + 0.0 } else { 0.0 }
}

/// An angle in degrees, rad.
pub fn radians(angle_deg: f64) -> f64 {
    angle_deg * PI / 180.0
}

/// A speed, kt.
pub fn knots(speed_mps: f64) -> f64 {
    speed_mps * HOUR_S / NAUTICAL_MILE_M
}

/// A speed in knots, m/s.
pub fn mps_of_knots(speed_kt: f64) -> f64 {
    speed_kt * NAUTICAL_MILE_M / HOUR_S
}

/// The units that names of recorded quantities and of parameters end in, and how they are written.
/// `norm` is travel of a control as a part of the whole.
pub const SI: &[(&str, &str)] = &[
    ("m", "m"),
    ("m2", "m²"),
    ("m3", "m³"),
    ("mps", "m/s"),
    ("mps2", "m/s²"),
    ("rad", "rad"),
    ("radps", "rad/s"),
    ("radps2", "rad/s²"),
    ("s", "s"),
    ("ns", "ns"),
    ("kg", "kg"),
    ("n", "N"),
    ("w", "W"),
    ("pa", "Pa"),
    ("k", "K"),
    ("norm", "norm"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::FRAC_PI_2;

    /// By hand from the definitions; the last ones as NIST SP 811 prints them.
    #[test]
    fn units_are_their_definitions() {
        for (ours, printed) in [
            (12.0 * INCH_M, FOOT_M),
            (36.0 * KNOT_MPS, 18.52),
            (1000.0 * FOOT_PER_MINUTE_MPS, 5.08),
            (POUND_N, 4.448_221_615_260_5),
            (SLUG_KG, 14.593_902_937_206_364),
            (HORSEPOWER_W, 745.699_871_582_270_2),
            (180.0 * DEGREE_RAD, PI),
            (60.0 * RPM_RADPS, TAU),
        ] {
            assert!((ours / printed - 1.0).abs() < 1e-15, "{ours} is not {printed}");
        }
    }

    #[test]
    fn a_compass_shows_less_than_a_turn_and_no_negative_north() {
        for (heading_rad, shown_deg) in [
            (0.0, 0.0),
            (-0.0, 0.0),
            (-1e-20, 0.0),
            (FRAC_PI_2, 90.0),
            (PI, 180.0),
            (-PI, 180.0),
            (-FRAC_PI_2, 270.0),
            (5.0 * TAU - FRAC_PI_2, 270.0),
        ] {
            let found_deg = compass_deg(heading_rad);
            assert!((found_deg - shown_deg).abs() < 1e-9, "{heading_rad} rad: {found_deg}");
            assert!(found_deg.is_sign_positive() && found_deg < 360.0, "{heading_rad} rad");
        }
    }

    #[test]
    fn there_and_back_is_the_same() {
        for (there, back) in [
            (DEGREE_RAD, DEG_PER_RAD),
            (KNOT_MPS, KT_PER_MPS),
            (FOOT_PER_MINUTE_MPS, FPM_PER_MPS),
            (RPM_RADPS, RPM_PER_RADPS),
            (radians(1.0), degrees(1.0)),
            (mps_of_knots(1.0), knots(1.0)),
        ] {
            assert!((there * back - 1.0).abs() < 1e-15, "{there} and {back}");
        }
    }
}
