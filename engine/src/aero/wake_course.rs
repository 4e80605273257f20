//! Course of a rotor's wake: where the air goes that has passed the disc.
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
//! In forward flight the front of the disc moves little air down: what passes there is blown away behind.
//! Sideways flight shifts the wake as a whole. The edge is as thick as a twentieth of the radius either
//! way (an estimate), so that nothing comes or goes at once. f = 1.3 is the mean between disc, 1, and
//! wing, K0 = 1.6. The mast's cant counts for nothing here.

use crate::frames::{Body, Vec3};
use crate::lanes::{self, Lanes};
use crate::mast::TiltedMast;
use crate::math::{PI, clamp, exp, max, min, sqrt, square};
use crate::motion::Motion;

/// Half the thickness of the wake's edge, parts of the radius.
const EDGE_NORM: f64 = 0.05;
/// f.
const ON_THE_WAY: f64 = 1.3;
/// k at a skew of 90°.
const GRADIENT: f64 = 15.0 * PI / 32.0;
/// Air that hardly moves down is carried away: it is taken to move at least so, part of U and m/s.
const SLOWEST: (f64, f64) = (0.02, 0.03);

/// The wake's air on its way, longitudinally.
struct Stream {
    /// |U|.
    blown_mps: f64,
    /// W + f·v.
    down_mps: f64,
    /// f·v·k.
    gradient_mps: f64,
}

impl Stream {
    fn new(blown_mps: f64, along_mps: f64, induced_mps: f64) -> Self {
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
    fn place(&self, p: Lanes, down: f64, radius: f64) -> Lanes {
        let slowest_mps = SLOWEST.0 * self.blown_mps + SLOWEST.1;
        let down_mps = lanes::max(self.down_mps + self.gradient_mps * p, slowest_mps);
        radius * p + down * self.blown_mps / down_mps
    }

    /// The p of the least x.
    fn foremost(&self, down: f64, radius: f64) -> f64 {
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

/// r/R.
pub(super) fn contracted(down: f64) -> f64 {
    0.707 / sqrt(0.5 * (2.0 - exp(-1.197 * down)))
}

/// Along the mast and forward in the disc's plane, its cant aside.
pub(super) fn axes(mast: &TiltedMast) -> (Vec3<Body>, Vec3<Body>) {
    let (s, c) = (mast.sin_tilt, mast.cos_tilt);
    (Vec3::new(s, 0.0, -c), Vec3::new(c, 0.0, s))
}

/// A rotor's wake and where it goes.
pub(super) struct Course {
    stream: Stream,
    /// Along the mast.
    pub axis: Vec3<Body>,
    /// Forward in the disc's plane.
    pub forward: Vec3<Body>,
    downwind: f64,
    sideways_mps: f64,
    right_mps: f64,
}

impl Course {
    /// Of a rotor whose hub is there, with its mean induced velocity.
    pub fn new(
        motion: &Motion,
        mast: &TiltedMast,
        hub_from_cg_m: Vec3<Body>,
        induced_mps: f64,
    ) -> Self {
        let (axis, forward) = axes(mast);
        let velocity = motion.velocity_at(hub_from_cg_m);
        let (along_mps, ahead_mps) = (velocity.dot(axis), velocity.dot(forward));
        let stream = Stream::new(ahead_mps.abs(), along_mps, max(0.0, induced_mps));
        let sideways_mps = max(stream.down_mps, 0.1 * velocity.y.abs() + SLOWEST.1);
        let downwind = if ahead_mps < 0.0 { -1.0 } else { 1.0 };
        Self { stream, axis, forward, downwind, sideways_mps, right_mps: velocity.y }
    }

    /// Whether stations there are beyond any wake: however narrow it has grown, no part of it is further
    /// from the hub than this.
    pub fn is_far(&self, ahead: f64, down: f64) -> bool {
        let x = -self.downwind * ahead;
        let [drift, ..] = self.stream.place(Lanes::from(-1.0), down, 0.0).to_array();
        x < -1.0 - EDGE_NORM || x > 1.0 + drift + EDGE_NORM
    }

    /// As it passes stations `ahead` of the hub and `down` the wake, contracted to `radius`, parts of R.
    pub fn passing(&self, ahead: f64, down: f64, radius: f64) -> Passing<'_> {
        Passing {
            stream: &self.stream,
            x: -self.downwind * ahead,
            down,
            radius,
            foremost: self.stream.foremost(down, radius),
            aside: down * self.right_mps / self.sideways_mps,
        }
    }
}

/// The wake as it passes stations of one height. Lengths are parts of R.
pub(super) struct Passing<'a> {
    stream: &'a Stream,
    /// Of the stations, downwind of the hub.
    x: f64,
    /// Down the wake.
    down: f64,
    /// To which the wake has contracted.
    radius: f64,
    /// The p of the least x(p).
    foremost: f64,
    /// How far the wake has shifted to the left.
    aside: f64,
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
