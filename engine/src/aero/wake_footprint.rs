//! Wake footprint: which part of a half wing stands in its rotor's wake.
//!
//! # Equations
//! ```text
//! r/R = .707/√(½·(2 − e^(−1.197·s/R)))          contraction, s down the wake            [CR176970]
//! air that passes the disc at p (−1 upwind … 1 downwind, parts of R) is, s further down, at
//!   x(p) = (r/R)·p + (s/R)·U/(W + f·v·(1 + k·p))        k = 15π/32·tan(χ/2)               [PETERS]
//! a point is in the wake where x lies between the least x(p) and the greatest of |p| = √(1 − η²)
//! ```
//! # Signs
//! U in the disc's plane, W along the thrust: the hub's through the air. x downwind, η to the right in
//! parts of the wake's radius. χ is the wake's skew, from the axis.
//! # Assumptions
//! In forward flight the front of the disc moves little air down: what passes there is blown behind the
//! wing, and the wing is out of the wake from 33 kt on, where a wake of one velocity throughout would
//! still wash half of it at 40 kt. The reference's printouts have nothing of it in the wake at 40 kt;
//! the law of speed taken before (KH: 56 ft² a side less a part, none from 58 kt) had 18 ft².
//! Sideways flight shifts the wake as a whole. The edge is as thick as a twentieth of the radius either
//! way (an estimate), so that no area comes or goes at once. f = 1.3 is the mean between disc, 1, and
//! wing, K0 = 1.6. Dihedral, sweep and the mast's cant count for nothing here.

use super::half_wing::{Inputs, Params};
use crate::frames::{Body, Structural, Vec3};
use crate::lanes::{self, LANES, Lanes};
use crate::mast::TiltedMast;
use crate::math::{PI, clamp, exp, max, min, sqrt, square};

/// Stations over the chord.
pub(super) const CHORDWISE: usize = 4;
/// Stations over the half span.
const SPANWISE: usize = 8;
/// Half the thickness of the wake's edge, parts of the radius.
pub(super) const EDGE_NORM: f64 = 0.05;
/// f.
const ON_THE_WAY: f64 = 1.3;
/// k at a skew of 90°.
const GRADIENT: f64 = 15.0 * PI / 32.0;
/// Air that hardly moves down is carried away: it is taken to move at least so, part of U and m/s.
pub(super) const SLOWEST: (f64, f64) = (0.02, 0.03);

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

/// The wake's air on its way to the wing, longitudinally.
pub(super) struct Stream {
    /// |U|.
    blown_mps: f64,
    /// W + f·v.
    pub down_mps: f64,
    /// f·v·k.
    gradient_mps: f64,
}

impl Stream {
    pub fn new(blown_mps: f64, along_mps: f64, induced_mps: f64) -> Self {
        let through_mps = along_mps + induced_mps;
        let total_mps = sqrt(square(blown_mps) + square(through_mps));
        // χ counts up to 90°.
        let tan_half_skew = blown_mps / max(max(total_mps + through_mps, blown_mps), 1e-3);
        Self {
            blown_mps,
            down_mps: along_mps + ON_THE_WAY * induced_mps,
            gradient_mps: ON_THE_WAY * induced_mps * GRADIENT * min(tan_half_skew, 1.0),
        }
    }

    /// x(p) at `down`, parts of R, where the wake has contracted to `radius`.
    pub fn place(&self, p: Lanes, down: f64, radius: f64) -> Lanes {
        let slowest_mps = SLOWEST.0 * self.blown_mps + SLOWEST.1;
        let down_mps = lanes::max(self.down_mps + self.gradient_mps * p, slowest_mps);
        radius * p + down * self.blown_mps / down_mps
    }

    /// The p of the least x.
    pub fn foremost(&self, down: f64, radius: f64) -> f64 {
        if self.gradient_mps > 1e-9 {
            let slope_mps = sqrt(down * self.blown_mps * self.gradient_mps / radius);
            clamp((slope_mps - self.down_mps) / self.gradient_mps, -1.0, 1.0)
        } else if self.down_mps > 0.0 {
            -1.0
        } else {
            1.0
        }
    }
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

/// r/R.
pub(super) fn contracted(down: f64) -> f64 {
    0.707 / sqrt(0.5 * (2.0 - exp(-1.197 * down)))
}

/// Along the mast and forward in the disc's plane, its cant aside.
pub(super) fn axes(mast: &TiltedMast) -> (Vec3<Body>, Vec3<Body>) {
    let (s, c) = (mast.sin_tilt, mast.cos_tilt);
    (Vec3::new(s, 0.0, -c), Vec3::new(c, 0.0, s))
}

/// The wake as it passes a row. Lengths are parts of R.
pub(super) struct Passing<'a> {
    pub stream: &'a Stream,
    /// Of the stations, downwind of the hub.
    pub x: f64,
    /// Down the wake.
    pub down: f64,
    /// To which the wake has contracted.
    pub radius: f64,
    /// The p of the least x(p).
    pub foremost: f64,
    /// How far the wake has shifted to the left.
    pub aside: f64,
}

impl Passing<'_> {
    /// Whether no part of the wake comes near, edge and rounding included.
    pub fn is_elsewhere(&self) -> bool {
        let ends = Lanes::from([self.foremost, -1.0, 0.0, 0.0]);
        let [foremost, upwind, ..] = self.stream.place(ends, self.down, self.radius).to_array();
        // The least x(p) is where its slope is 0, or upwind where air that hardly moves is carried
        // away. No x(p) is greater than the slowest air's with the greatest p.
        let front = min(foremost, upwind);
        let rear = upwind + 2.0 * self.radius;
        let apart = -EDGE_NORM - 1e-9;
        // Where the shift is no number every station counts: nothing must hide that.
        (self.x - front < apart || rear - self.x < apart) && self.aside.is_finite()
    }

    /// How far into the wake the stations are that lie `y` to the right of the hub: 0 out, 1 in.
    pub fn covered(&self, y: Lanes) -> Lanes {
        let place = |p: Lanes| self.stream.place(p, self.down, self.radius);
        let eta = (y + self.aside) / self.radius;
        let p = lanes::sqrt(lanes::max(0.0, 1.0 - lanes::square(eta)));
        let front = place(lanes::clamp(self.foremost.into(), -p, p));
        let rear = lanes::max(place(p), place(-p));
        let sideways = self.radius * (1.0 - eta.abs());
        let within = lanes::min(lanes::min(self.x - front, rear - self.x), sideways);
        lanes::ramp(within, -EDGE_NORM, EDGE_NORM)
    }
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
    let (axis, forward) = axes(&inputs.mast);
    let hub = inputs.hub_from_cg_m;
    let velocity = inputs.motion.velocity_at(hub);
    let (along_mps, ahead_mps) = (velocity.dot(axis), velocity.dot(forward));
    let stream = Stream::new(ahead_mps.abs(), along_mps, max(0.0, inputs.induced_mps));
    let downwind = if ahead_mps < 0.0 { -1.0 } else { 1.0 };
    let sideways_mps = max(stream.down_mps, 0.1 * velocity.y.abs() + SLOWEST.1);

    let (chordwise, spanwise) = (CHORDWISE as f64, SPANWISE as f64);
    let buttlines_m: [f64; SPANWISE] =
        core::array::from_fn(|j| 0.5 * params.span_m * (j as f64 + 0.5) / spanwise);
    let (mut part, mut part2, mut station, mut buttline) = (0.0, 0.0, 0.0, 0.0);
    let mut covered = [0.0; SPANWISE];
    for &Row { station_m, ahead, down, radius } in rows {
        if down <= 0.0 {
            continue;
        }
        let passing = Passing {
            stream: &stream,
            x: -downwind * ahead,
            down,
            radius,
            foremost: stream.foremost(down, radius),
            aside: down * velocity.y / sideways_mps,
        };
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
