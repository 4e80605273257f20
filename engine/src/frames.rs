//! Frames of reference, and vectors that know theirs.
//!
//! ```text
//! Structural (drawings)      Body (at the CG)           Mast (one per rotor, at the hub)
//!   z up (waterline)           x forward                  x forward, tilting down with the nacelle
//!   │                         ╱                          ╱
//!   │   ╱ y right            ●───── y right             ●───── y right
//!   │  ╱  (buttline)         │                          │
//!   └────── x aft            z down                     z down the mast, against the thrust
//!     (fuselage station)
//!
//! Ned: x north, y east, z down; flat and inertial, its origin on the ground at the start.
//! ```
//!
//! The Mast frame is Body turned about y by the mast's tilt, `mast_tilt_rad`: 0 as a helicopter,
//! π/2 as an aeroplane. The left rotor is computed as the mirror image of a right one.

use core::marker::PhantomData;
use core::ops::{Add, AddAssign, Mul, Neg, Sub};

use nalgebra::{Matrix3, Quaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::math::{asin, atan2, sin_cos, sqrt};

/// Stations of the drawings: aft, right, up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Structural;
/// At the centre of gravity: forward, right, down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Body;
/// At a rotor's hub, tilting with its nacelle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mast;
/// North, east, down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ned;

/// A vector in the frame `F`.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "", deny_unknown_fields)]
pub struct Vec3<F> {
    /// Along the frame's first axis.
    pub x: f64,
    /// Along the second.
    pub y: f64,
    /// Along the third.
    pub z: f64,
    #[serde(skip)]
    frame: PhantomData<F>,
}

// By hand, so that a frame need not be any of these.
impl<F> Clone for Vec3<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Vec3<F> {}

impl<F> Default for Vec3<F> {
    fn default() -> Self {
        Self::zero()
    }
}

impl<F> Vec3<F> {
    /// From components.
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z, frame: PhantomData }
    }

    /// Nothing in every direction.
    pub const fn zero() -> Self {
        Self::new(0.0, 0.0, 0.0)
    }

    /// Inner product.
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Length.
    pub fn norm(self) -> f64 {
        sqrt(self.dot(self))
    }

    /// Image of a position, velocity or force in the plane of symmetry.
    pub fn mirrored(self) -> Self {
        Self::new(self.x, -self.y, self.z)
    }

    /// Image of an angular rate or moment in the plane of symmetry.
    pub fn mirrored_axial(self) -> Self {
        Self::new(-self.x, self.y, -self.z)
    }

    fn column(self) -> Vector3<f64> {
        Vector3::new(self.x, self.y, self.z)
    }

    fn from_column(v: &Vector3<f64>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl Vec3<Structural> {
    /// As seen from `origin` (the centre of gravity), in body axes.
    pub fn from_cg(self, origin: Self) -> Vec3<Body> {
        let station = self - origin;
        Vec3::new(-station.x, station.y, -station.z)
    }
}

impl<F> Add for Vec3<F> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<F> AddAssign for Vec3<F> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<F> Sub for Vec3<F> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<F> Neg for Vec3<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<F> Mul<f64> for Vec3<F> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

/// Turns vectors of one frame into another.
#[derive(Clone, Copy, Debug)]
pub struct Rotation<To, From> {
    matrix: Matrix3<f64>,
    frames: PhantomData<(To, From)>,
}

impl<To, From> Rotation<To, From> {
    fn from_matrix(matrix: Matrix3<f64>) -> Self {
        Self { matrix, frames: PhantomData }
    }

    /// From the axes of `From`, each given in `To`.
    pub fn from_axes(x: Vec3<To>, y: Vec3<To>, z: Vec3<To>) -> Self {
        Self::from_matrix(Matrix3::from_columns(&[x.column(), y.column(), z.column()]))
    }

    /// The way back.
    #[must_use]
    pub fn inverse(&self) -> Rotation<From, To> {
        Rotation::from_matrix(self.matrix.transpose())
    }
}

impl<To, From> Mul<Vec3<From>> for Rotation<To, From> {
    type Output = Vec3<To>;
    fn mul(self, v: Vec3<From>) -> Vec3<To> {
        Vec3::from_column(&(self.matrix * v.column()))
    }
}

/// A unit quaternion that turns body vectors into NED ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attitude {
    /// Scalar part.
    pub w: f64,
    /// First vector part.
    pub x: f64,
    /// Second vector part.
    pub y: f64,
    /// Third vector part.
    pub z: f64,
}

impl Default for Attitude {
    fn default() -> Self {
        Self { w: 1.0, x: 0.0, y: 0.0, z: 0.0 }
    }
}

/// Roll, pitch and heading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Euler {
    /// φ, right wing down positive, −π..π.
    pub roll_rad: f64,
    /// θ, nose up positive, −π/2..π/2.
    pub pitch_rad: f64,
    /// ψ, clockwise from north, −π..π.
    pub heading_rad: f64,
}

impl Attitude {
    fn quaternion(self) -> Quaternion<f64> {
        Quaternion::new(self.w, self.x, self.y, self.z)
    }

    fn normalised(q: &Quaternion<f64>) -> Self {
        let scale = 1.0 / sqrt(q.w * q.w + q.i * q.i + q.j * q.j + q.k * q.k);
        Self { w: q.w * scale, x: q.i * scale, y: q.j * scale, z: q.k * scale }
    }

    /// From roll, pitch and heading.
    pub fn from_euler(euler: Euler) -> Self {
        let about = |angle_rad: f64, i: f64, j: f64, k: f64| {
            let (s, c) = sin_cos(0.5 * angle_rad);
            Quaternion::new(c, i * s, j * s, k * s)
        };
        let q = about(euler.heading_rad, 0.0, 0.0, 1.0)
            * about(euler.pitch_rad, 0.0, 1.0, 0.0)
            * about(euler.roll_rad, 1.0, 0.0, 0.0);
        Self::normalised(&q)
    }

    /// Roll, pitch and heading; at ±90° of pitch the heading takes it all.
    pub fn euler(self) -> Euler {
        let Self { w, x, y, z } = self;
        Euler {
            roll_rad: atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
            pitch_rad: asin(2.0 * (w * y - z * x)),
            heading_rad: atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
        }
    }

    /// The rotation matrix.
    pub fn ned_from_body(self) -> Rotation<Ned, Body> {
        let Self { w, x, y, z } = self;
        Rotation::from_matrix(Matrix3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ))
    }

    /// Turned by a small rotation vector (rate × time) in body axes, exactly for a steady rate.
    #[must_use]
    pub fn turned_by(self, turn_rad: Vec3<Body>) -> Self {
        let angle_rad = turn_rad.norm();
        // sin(x/2)/x by its series where the quotient would lose digits.
        let (s, c) = sin_cos(0.5 * angle_rad);
        let half_sinc =
            if angle_rad > 1e-4 { s / angle_rad } else { 0.5 - angle_rad * angle_rad / 48.0 };
        let v = turn_rad * half_sinc;
        let turn = Quaternion::new(c, v.x, v.y, v.z);
        Self::normalised(&(self.quaternion() * turn))
    }

    /// Image in the plane of symmetry (of body and north–down alike).
    pub fn mirrored(self) -> Self {
        Self { w: self.w, x: -self.x, y: self.y, z: -self.z }
    }
}

/// A force, and its moment about the centre of gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Force.
    pub force_n: Vec3<Body>,
    /// Moment about the centre of gravity.
    pub moment_n_m: Vec3<Body>,
}

impl Load {
    /// A force that acts at a point.
    pub fn at(force_n: Vec3<Body>, from_cg_m: Vec3<Body>) -> Self {
        Self { force_n, moment_n_m: from_cg_m.cross(force_n) }
    }

    /// With a moment added.
    #[must_use]
    pub fn with_moment(self, moment_n_m: Vec3<Body>) -> Self {
        Self { force_n: self.force_n, moment_n_m: self.moment_n_m + moment_n_m }
    }

    /// Image in the plane of symmetry.
    pub fn mirrored(self) -> Self {
        Self { force_n: self.force_n.mirrored(), moment_n_m: self.moment_n_m.mirrored_axial() }
    }
}

impl Add for Load {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            force_n: self.force_n + other.force_n,
            moment_n_m: self.moment_n_m + other.moment_n_m,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{FRAC_PI_2, PI, cos, sin};

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    /// Half the sine of the angle about the axis, where it is a quotient and where it is a series, and where the one
    /// goes over into the other.
    #[test]
    fn a_turn_however_small_has_the_angle_that_was_asked_for() {
        for angle_rad in [1e-9, 1e-5, 0.999e-4, 1.001e-4, 1e-3, 1.0, 3.0] {
            let turned = Attitude::default().turned_by(Vec3::new(0.0, angle_rad, 0.0));
            let (s, c) = sin_cos(0.5 * angle_rad);
            let off = (turned.y - s).abs() + (turned.w - c).abs();
            assert!(
                off < 4e-16 * (1.0 + c) && (turned.y / s - 1.0).abs() < 1e-15,
                "{angle_rad}: {off}"
            );
        }
    }

    #[test]
    fn nose_up_lifts_the_body_x_axis() {
        let attitude = Attitude::from_euler(Euler { pitch_rad: 0.3, ..Euler::default() });
        let nose = attitude.ned_from_body() * Vec3::<Body>::new(1.0, 0.0, 0.0);
        assert!(close(nose.z, -sin(0.3)) && close(nose.x, cos(0.3)));
    }

    #[test]
    fn euler_angles_survive_the_quaternion() {
        let euler = Euler { roll_rad: -1.1, pitch_rad: 0.7, heading_rad: 2.9 };
        let back = Attitude::from_euler(euler).euler();
        assert!(close(back.roll_rad, euler.roll_rad));
        assert!(close(back.pitch_rad, euler.pitch_rad));
        assert!(close(back.heading_rad, euler.heading_rad));
    }

    #[test]
    fn a_steady_turn_is_exact() {
        let mut attitude = Attitude::default();
        for _ in 0..1000 {
            attitude = attitude.turned_by(Vec3::new(0.0, 0.0, FRAC_PI_2 / 1000.0));
        }
        assert!((attitude.euler().heading_rad - FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn mirrored_attitude_mirrors_what_it_turns() {
        let attitude =
            Attitude::from_euler(Euler { roll_rad: 0.4, pitch_rad: -0.2, heading_rad: PI - 0.3 });
        let v = Vec3::<Body>::new(1.0, 2.0, 3.0);
        let turned = (attitude.ned_from_body() * v).mirrored();
        let mirror = attitude.mirrored().ned_from_body() * v.mirrored();
        assert_eq!(turned, mirror);
    }
}
