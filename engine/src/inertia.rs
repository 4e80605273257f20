//! Inertia of the rigid body.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// Moments and product of inertia about the centre of gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inertia {
    /// About the roll axis.
    pub xx_kg_m2: f64,
    /// About the pitch axis.
    pub yy_kg_m2: f64,
    /// About the yaw axis.
    pub zz_kg_m2: f64,
    /// Product; enters the tensor with a minus sign.
    pub xz_kg_m2: f64,
}

impl Inertia {
    /// The tensor in body axes.
    pub fn tensor(&self) -> Matrix3<f64> {
        Matrix3::new(
            self.xx_kg_m2,
            0.0,
            -self.xz_kg_m2,
            0.0,
            self.yy_kg_m2,
            0.0,
            -self.xz_kg_m2,
            0.0,
            self.zz_kg_m2,
        )
    }
}
