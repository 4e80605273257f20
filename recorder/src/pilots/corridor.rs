//! The conversion corridor: between which airspeeds a nacelle angle is flown.
//!
//! The flight-test planning corridor of TM-81244 fig. 14, read to ±2 kt and ±1.5°, calibrated
//! airspeed. Below its lower side the wing stalls (α beyond 6°), beyond its upper side the rotors and
//! their masts bend too much.

use engine::math::FRAC_PI_2;
use engine::units::KNOT_MPS;

/// Nacelle incidence, deg, and the fastest airspeed there, kt.
const FASTEST: [(f64, f64); 8] = [
    (0.0, 234.0),
    (2.3, 234.0),
    (2.4, 169.0),
    (31.0, 169.0),
    (60.0, 144.0),
    (69.5, 128.0),
    (80.0, 117.0),
    (85.0, 96.0),
];

/// Nacelle incidence, deg, and the slowest airspeed there, kt.
const SLOWEST: [(f64, f64); 10] = [
    (0.0, 129.0),
    (16.0, 123.0),
    (29.0, 115.0),
    (47.0, 102.0),
    (60.5, 90.0),
    (68.0, 80.0),
    (76.0, 64.0),
    (85.0, 64.0),
    (85.1, 0.0),
    (90.0, 0.0),
];

fn at(line: &[(f64, f64)], x: f64) -> f64 {
    let (first, last) = (line[0], line[line.len() - 1]);
    if x <= first.0 {
        return first.1;
    }
    line.windows(2).find(|pair| x <= pair[1].0).map_or(last.1, |pair| {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    })
}

fn incidence_deg(mast_tilt_rad: f64) -> f64 {
    (FRAC_PI_2 - mast_tilt_rad).to_degrees()
}

/// The fastest calibrated airspeed at a mast tilt, m/s.
pub fn fastest_mps(mast_tilt_rad: f64) -> f64 {
    at(&FASTEST, incidence_deg(mast_tilt_rad)) * KNOT_MPS
}

/// The slowest calibrated airspeed at a mast tilt, m/s.
pub fn slowest_mps(mast_tilt_rad: f64) -> f64 {
    at(&SLOWEST, incidence_deg(mast_tilt_rad)) * KNOT_MPS
}

/// How far inside the corridor a calibrated airspeed is, m/s; negative outside.
pub fn margin_mps(mast_tilt_rad: f64, calibrated_mps: f64) -> f64 {
    let below = fastest_mps(mast_tilt_rad) - calibrated_mps;
    let slowest = slowest_mps(mast_tilt_rad);
    // As a helicopter there is no slowest speed: flying backwards is no way out.
    let above = if slowest > 0.0 { calibrated_mps - slowest } else { below };
    engine::math::min(below, above)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilt(incidence_deg: f64) -> f64 {
        FRAC_PI_2 - incidence_deg.to_radians()
    }

    #[test]
    fn the_corridor_is_that_of_the_figure() {
        for (incidence_deg, slowest_kt, fastest_kt) in [
            (0.0, 129.0, 234.0),
            (31.0, 113.6, 169.0),
            (60.0, 90.4, 144.0),
            (80.0, 64.0, 117.0),
            (90.0, 0.0, 96.0),
        ] {
            let slowest = slowest_mps(tilt(incidence_deg)) / KNOT_MPS;
            let fastest = fastest_mps(tilt(incidence_deg)) / KNOT_MPS;
            assert!((slowest - slowest_kt).abs() < 0.1, "{incidence_deg} deg: {slowest} kt");
            assert!((fastest - fastest_kt).abs() < 0.1, "{incidence_deg} deg: {fastest} kt");
        }
    }

    #[test]
    fn a_helicopter_in_hover_is_inside_and_an_aeroplane_in_hover_is_not() {
        assert!(margin_mps(tilt(90.0), 0.0) > 0.0);
        assert!(margin_mps(tilt(0.0), 0.0) < 0.0);
        assert!(margin_mps(tilt(90.0), 60.0) < 0.0);
    }
}
