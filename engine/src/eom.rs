//! Equations of motion: the rigid body.
//!
//! # Equations
//! ```text
//! V̇ = R·F/m + g                           in NED, flat and inertial                [STEVENS]
//! ω̇ = I⁻¹·(M − ω×(I·ω + h) − ḣ)          h, ḣ: angular momentum of the rotors
//! q̇ = ½·q⊗ω
//! ```
//! # Signs
//! F and M in body axes about the centre of gravity; g along NED z.
//! # Assumptions
//! Inertia changes slowly as the nacelles tilt: İ·ω is left out.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::GRAVITY_MPS2;
use crate::frames::{Body, Load, Ned, Rotation, Vec3};
use crate::weight_balance;

/// What the body's motion follows from.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// Sum of all loads but gravity.
    pub load: Load,
    /// Mass and inertia.
    pub balance: weight_balance::Outputs,
    /// Attitude.
    pub ned_from_body: Rotation<Ned, Body>,
    /// ω.
    pub angular_rate_radps: Vec3<Body>,
    /// h.
    pub rotor_momentum_n_m_s: Vec3<Body>,
    /// ḣ in body axes.
    pub rotor_momentum_rate_n_m: Vec3<Body>,
}

/// How fast the motion changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// V̇.
    pub acceleration_mps2: Vec3<Ned>,
    /// ω̇.
    pub angular_acceleration_radps2: Vec3<Body>,
}

/// Accelerations.
pub fn motion(inputs: &Inputs) -> Rate {
    let gravity = Vec3::<Ned>::new(0.0, 0.0, GRAVITY_MPS2);
    let force = inputs.ned_from_body * inputs.load.force_n;
    let acceleration_mps2 = force * (1.0 / inputs.balance.mass_kg) + gravity;

    let inertia = inputs.balance.inertia;
    let omega = inputs.angular_rate_radps;
    let turned = inertia.tensor() * Vector3::new(omega.x, omega.y, omega.z);
    let momentum = Vec3::new(turned.x, turned.y, turned.z) + inputs.rotor_momentum_n_m_s;
    let moment = inputs.load.moment_n_m - omega.cross(momentum) - inputs.rotor_momentum_rate_n_m;
    // The tensor couples roll with yaw only: its inverse in closed form keeps the symmetry exact.
    let (xx, zz, xz) = (inertia.xx_kg_m2, inertia.zz_kg_m2, inertia.xz_kg_m2);
    let determinant = xx * zz - xz * xz;
    let angular_acceleration_radps2 = Vec3::new(
        (zz * moment.x + xz * moment.z) / determinant,
        moment.y / inertia.yy_kg_m2,
        (xz * moment.x + xx * moment.z) / determinant,
    );
    Rate { acceleration_mps2, angular_acceleration_radps2 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Attitude;

    /// A top whose momentum points up (a rotor that turns counter-clockwise seen from above), pitched
    /// nose up: the momentum is turned aft, which takes a moment to the left; the body feels its
    /// reaction, to the right.
    #[test]
    fn a_rotor_pitched_up_rolls_the_body_to_the_right() {
        let inertia = weight_balance::Inertia {
            xx_kg_m2: 1000.0,
            yy_kg_m2: 1000.0,
            zz_kg_m2: 1000.0,
            xz_kg_m2: 0.0,
        };
        let rate = motion(&Inputs {
            load: Load::default(),
            balance: weight_balance::Outputs { mass_kg: 1.0, inertia, ..Default::default() },
            ned_from_body: Attitude::default().ned_from_body(),
            angular_rate_radps: Vec3::new(0.0, 0.2, 0.0),
            rotor_momentum_n_m_s: Vec3::new(0.0, 0.0, -5000.0),
            rotor_momentum_rate_n_m: Vec3::zero(),
        });
        assert!((rate.angular_acceleration_radps2.x - 1.0).abs() < 1e-12);
        assert_eq!(rate.acceleration_mps2, Vec3::new(0.0, 0.0, GRAVITY_MPS2));
    }
}
