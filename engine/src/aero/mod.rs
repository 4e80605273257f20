//! Aerodynamics of the airframe: one block per component, and one for the rotors' wake on them.

pub mod fin_wake;
pub mod fuselage;
pub mod half_wing;
pub mod horizontal_stabilizer;
pub mod polar;
pub mod rotor_wake;
pub mod vertical_stabilizers;
mod wake_course;
pub mod wake_footprint;
pub mod wing_pylon;

use crate::frames::{Body, Load, Vec3};
use crate::math::{FRAC_PI_2, PI, atan2, clamp, sin_cos, sqrt, square};

/// Least dynamic length, so that a standing aircraft divides by something, m/s.
const SPEED_MPS_MIN: f64 = 1e-3;

/// The local flow at a component: angles, dynamic pressure and speed of the air that meets it.
#[derive(Clone, Copy, Debug)]
pub struct LocalFlow {
    /// α, in the plane of symmetry, from below positive.
    pub alpha_rad: f64,
    /// β, from the right positive.
    pub beta_rad: f64,
    /// ½ρV².
    pub pressure_pa: f64,
    /// V.
    pub speed_mps: f64,
}

impl LocalFlow {
    /// Image in the plane of symmetry.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { beta_rad: -self.beta_rad, ..*self }
    }
}

/// The flow that meets a component moving with `velocity_mps` through the air.
pub fn local_flow(velocity_mps: Vec3<Body>, density_kg_per_m3: f64) -> LocalFlow {
    let speed_mps = velocity_mps.norm();
    let in_plane_mps = sqrt(square(velocity_mps.x) + square(velocity_mps.z));
    LocalFlow {
        alpha_rad: atan2(velocity_mps.z, velocity_mps.x),
        beta_rad: atan2(velocity_mps.y, in_plane_mps + SPEED_MPS_MIN),
        pressure_pa: 0.5 * density_kg_per_m3 * square(speed_mps),
        speed_mps,
    }
}

/// Lift and drag in body axes; side force along y.
fn in_body_axes(lift_n: f64, drag_n: f64, side_n: f64, alpha_rad: f64) -> Vec3<Body> {
    let (s, c) = sin_cos(alpha_rad);
    Vec3::new(lift_n * s - drag_n * c, side_n, -lift_n * c - drag_n * s)
}

/// A pure pitching moment.
fn pitching(moment_n_m: f64) -> Vec3<Body> {
    Vec3::new(0.0, moment_n_m, 0.0)
}

/// How much the flow comes from ahead: 1 up to 60° of angle of attack, −1 from 120°, 0 from above.
fn ahead(alpha_rad: f64) -> f64 {
    const OVER_RAD: f64 = PI / 6.0;
    clamp((FRAC_PI_2 - alpha_rad.abs()) / OVER_RAD, -1.0, 1.0)
}

/// A load at rest.
fn load_at(force_n: Vec3<Body>, from_cg_m: Vec3<Body>, pitching_n_m: f64) -> Load {
    Load::at(force_n, from_cg_m).with_moment(pitching(pitching_n_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lift_is_across_and_drag_along_the_flow() {
        let force = in_body_axes(10.0, 1.0, 0.0, 0.1);
        let along = Vec3::<Body>::new(crate::math::cos(0.1), 0.0, crate::math::sin(0.1));
        assert!((force.dot(along) + 1.0).abs() < 1e-12);
    }
}
