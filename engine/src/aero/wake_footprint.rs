//! Wake footprint: which part of a half wing stands in its rotor's wake.
//!
//! Where the wake goes is said by `wake_course`.
//! # Assumptions
//! The wing is out of the wake from 33 kt on, where a wake of one velocity throughout would
//! still wash half of it at 40 kt. The reference's printouts have nothing of it in the wake at 40 kt;
//! the law of speed taken before (KH: 56 ft² a side less a part, none from 58 kt) had 18 ft².
//! Dihedral and sweep count for nothing here.

use super::half_wing::{Inputs, Params};
use super::wake_course::{Course, axes, contracted};
use crate::frames::{Body, Structural, Vec3};
use crate::lanes::{LANES, Lanes};
use crate::math::square;

/// Stations over the chord.
pub(super) const CHORDWISE: usize = 4;
/// Stations over the half span.
const SPANWISE: usize = 8;
/// The part of a half wing that stands in the wake.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    /// S_ss.
    pub area_m2: f64,
    /// Its centroid, (X_iW, Y_iW) of the source.
    pub centroid_from_cg_m: Vec3<Body>,
    /// Its mean chord.
    pub chord_m: f64,
}

/// Stations of one chordwise place, as the rotor sees them. Lengths are parts of R.
#[derive(Clone, Copy)]
pub(super) struct Row {
    /// Where it is in the drawings.
    station_m: f64,
    /// Of the stations, ahead of the hub in the disc's plane.
    ahead: f64,
    /// Down the wake: where it is negative no wake passes.
    down: f64,
    /// To which the wake has contracted.
    radius: f64,
}

/// The rows of a half wing.
pub(super) fn rows(params: &Params, inputs: &Inputs) -> [Row; CHORDWISE] {
    let (axis, forward) = axes(&inputs.mast);
    let radius_m = inputs.rotor_radius_m;
    core::array::from_fn(|i| {
        let part = 1.0 - (i as f64 + 0.5) / CHORDWISE as f64;
        let station_m = params.trailing_edge_station_m - params.chord_m * part;
        let point = Vec3::<Structural>::new(station_m, 0.0, params.centre_m.z);
        let from_hub = point.from_cg(inputs.motion.cg_m) - inputs.hub_from_cg_m;
        let down = -from_hub.dot(axis) / radius_m;
        let radius = if down <= 0.0 { 1.0 } else { contracted(down) };
        Row { station_m, ahead: from_hub.dot(forward) / radius_m, down, radius }
    })
}

/// The part of the right half wing in its rotor's wake.
pub fn footprint(params: &Params, inputs: &Inputs) -> Footprint {
    footprint_of_rows(params, inputs, &rows(params, inputs))
}

/// The same; `rows` are those of [`rows()`].
pub(super) fn footprint_of_rows(
    params: &Params,
    inputs: &Inputs,
    rows: &[Row; CHORDWISE],
) -> Footprint {
    let hub = inputs.hub_from_cg_m;
    let course = Course::new(&inputs.motion, &inputs.mast, hub, inputs.induced_mps);

    let (chordwise, spanwise) = (CHORDWISE as f64, SPANWISE as f64);
    let buttlines_m: [f64; SPANWISE] =
        core::array::from_fn(|j| 0.5 * params.span_m * (j as f64 + 0.5) / spanwise);
    let (mut part, mut part2, mut station, mut buttline) = (0.0, 0.0, 0.0, 0.0);
    let mut covered = [0.0; SPANWISE];
    for &Row { station_m, ahead, down, radius } in rows {
        if down <= 0.0 {
            continue;
        }
        let passing = course.passing(ahead, down, radius);
        if passing.is_elsewhere() {
            continue;
        }
        for (j, y_m) in buttlines_m.chunks_exact(LANES).enumerate() {
            let y = (Lanes::from_fn(|lane| y_m[lane]) - hub.y) / inputs.rotor_radius_m;
            let weights = passing.covered(y) / (chordwise * spanwise);
            let covered = &mut covered[j * LANES..];
            for ((weight, y_m), covered) in weights.to_array().iter().zip(y_m).zip(covered) {
                *covered += weight * spanwise;
                part += weight;
                station += weight * station_m;
                buttline += weight * y_m;
            }
        }
    }
    for covered in covered {
        part2 += square(covered) / spanwise;
    }
    if part <= 0.0 {
        let centroid_from_cg_m = params.centre_m.from_cg(inputs.motion.cg_m);
        return Footprint { area_m2: 0.0, centroid_from_cg_m, chord_m: 0.0 };
    }
    let centroid = Vec3::<Structural>::new(station / part, buttline / part, params.centre_m.z);
    Footprint {
        area_m2: 0.5 * params.area_m2 * part,
        centroid_from_cg_m: centroid.from_cg(inputs.motion.cg_m),
        chord_m: params.chord_m * part2 / part,
    }
}
