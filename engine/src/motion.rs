//! Motion through the air: what every block reads on which the air acts.

use crate::frames::{Body, Structural, Vec3};

/// How the aircraft moves through the air: what every aerodynamic block reads.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Centre of gravity.
    pub cg_m: Vec3<Structural>,
    /// Velocity of the centre of gravity through the air.
    pub airspeed_mps: Vec3<Body>,
    /// Angular rate of the body.
    pub angular_rate_radps: Vec3<Body>,
    /// ρ.
    pub density_kg_per_m3: f64,
}

impl Motion {
    /// Velocity through the air of a point of the body.
    pub fn velocity_at(&self, from_cg_m: Vec3<Body>) -> Vec3<Body> {
        self.airspeed_mps + self.angular_rate_radps.cross(from_cg_m)
    }

    /// Image in the plane of symmetry.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            airspeed_mps: self.airspeed_mps.mirrored(),
            angular_rate_radps: self.angular_rate_radps.mirrored_axial(),
            ..*self
        }
    }
}
