//! Equations of motion: the rigid body.
//!
//! # Equations
//! ```text
//! V̇ = R·F/m + g                           in NED, flat and inertial                [STEVENS]
//! ω̇ = I⁻¹·(M − ω×I·ω − ḣ)                ḣ: what the rotors' spin takes to change
//! q̇ = ½·q⊗ω
//! ```
//! # Signs
//! F and M in body axes about the centre of gravity; g along NED z.
//! # Assumptions
//! Inertia changes slowly as the nacelles tilt: İ·ω is left out. The rotors' own angular momentum h has
//! no ω×h here: a gimballed rotor does not follow the body but precesses, and what turns it, and pushes
//! back on the mast, is in the rotor's load. Only along the mast is it bound to the body: ḣ.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::GRAVITY_MPS2;
use crate::frames::{Body, Load, Ned, Rotation, Vec3};
use crate::inertia::Inertia;

/// What the body's motion follows from.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// Sum of all loads but gravity.
    pub load: Load,
    /// m.
    pub mass_kg: f64,
    /// I.
    pub inertia: Inertia,
    /// Attitude.
    pub ned_from_body: Rotation<Ned, Body>,
    /// ω.
    pub angular_rate_radps: Vec3<Body>,
    /// ḣ: rate of the rotors' angular momentum along their masts.
    pub spin_up_n_m: Vec3<Body>,
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
pub fn evaluate(inputs: &Inputs) -> Rate {
    let gravity = Vec3::<Ned>::new(0.0, 0.0, GRAVITY_MPS2);
    let force = inputs.ned_from_body * inputs.load.force_n;
    let acceleration_mps2 = force * (1.0 / inputs.mass_kg) + gravity;

    let inertia = inputs.inertia;
    let omega = inputs.angular_rate_radps;
    let turned = inertia.tensor() * Vector3::new(omega.x, omega.y, omega.z);
    let momentum = Vec3::new(turned.x, turned.y, turned.z);
    let moment = inputs.load.moment_n_m - omega.cross(momentum) - inputs.spin_up_n_m;
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

    fn inputs(xx_kg_m2: f64, angular_rate_radps: Vec3<Body>) -> Inputs {
        let inertia = Inertia { xx_kg_m2, yy_kg_m2: 1000.0, zz_kg_m2: 3000.0, xz_kg_m2: 0.0 };
        Inputs {
            load: Load::default(),
            mass_kg: 1.0,
            inertia,
            ned_from_body: Attitude::default().ned_from_body(),
            angular_rate_radps,
            spin_up_n_m: Vec3::zero(),
        }
    }

    /// Euler's equation by hand: ṗ = (I_yy − I_zz)·q·r/I_xx.
    #[test]
    fn a_body_that_pitches_and_yaws_begins_to_roll() {
        let rate = evaluate(&inputs(2000.0, Vec3::new(0.0, 0.2, 0.3)));
        assert!((rate.angular_acceleration_radps2.x + 2000.0 * 0.06 / 2000.0).abs() < 1e-12);
        assert_eq!(rate.acceleration_mps2, Vec3::new(0.0, 0.0, GRAVITY_MPS2));
    }

    /// Two rotors that are spun up alike turn against each other; one alone turns the body.
    #[test]
    fn a_rotor_spun_up_turns_the_body_the_other_way() {
        let spun =
            Inputs { spin_up_n_m: Vec3::new(0.0, 0.0, -600.0), ..inputs(2000.0, Vec3::zero()) };
        assert!((evaluate(&spun).angular_acceleration_radps2.z - 0.2).abs() < 1e-12);
    }
}
