//! Weight and balance: mass, centre of gravity and inertia as fuel burns and the nacelles tilt.
//!
//! # Equations
//! ```text
//! ΔSL = Z0·sin βm + X0·(1 − cos βm)      ΔWL = Z0·(1 − cos βm) − X0·sin βm       [CR536 A-165…171]
//! X0 = (Wp/W)·(SLsp − SLp)               Z0 = (Wp/W)·(WLsp − WLp)
//! I(βm) = I(0) + βm·dI/dβm
//! ```
//! # Signs
//! Stations: aft and up positive. βm (`mast_tilt`): 0 helicopter, π/2 aeroplane.
//! # Assumptions
//! Inertia is that of the design gross weight whatever the fuel; fuel sits at the centre of gravity;
//! the reaction to the nacelles' own acceleration is left out.

use serde::{Deserialize, Serialize};

use crate::frames::{Structural, Vec3};
use crate::inertia::Inertia;
use crate::math::sin_cos;

/// What the aircraft weighs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Everything but fuel.
    pub zero_fuel_mass_kg: f64,
    /// Full tanks.
    pub fuel_kg_max: f64,
    /// Centre of gravity as a helicopter.
    pub cg_m: Vec3<Structural>,
    /// Wp/W: the tilting part of the weight.
    pub tilting_mass_ratio: f64,
    /// (SLsp, 0, WLsp): the pivot.
    pub pivot_m: Vec3<Structural>,
    /// (SLp, 0, WLp): centre of gravity of the tilting mass as a helicopter.
    pub tilting_cg_m: Vec3<Structural>,
    /// As a helicopter.
    pub inertia: Inertia,
    /// Change of inertia with mast tilt, aeroplane minus helicopter.
    pub inertia_change: Inertia,
}

/// Mass and balance of the moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// m.
    pub mass_kg: f64,
    /// Centre of gravity.
    pub cg_m: Vec3<Structural>,
    /// I.
    pub inertia: Inertia,
}

/// Mass and balance with `fuel_kg` aboard and the masts tilted by `mast_tilt_rad` (mean of both).
pub fn evaluate(params: &Params, fuel_kg: f64, mast_tilt_rad: f64) -> Outputs {
    let arm = params.pivot_m - params.tilting_cg_m;
    let x0 = params.tilting_mass_ratio * arm.x;
    let z0 = params.tilting_mass_ratio * arm.z;
    let (s, c) = sin_cos(mast_tilt_rad);
    let aft_m = z0 * s + x0 * (1.0 - c);
    let up_m = z0 * (1.0 - c) - x0 * s;
    let tilted = mast_tilt_rad / crate::math::FRAC_PI_2;
    let (i, di) = (&params.inertia, &params.inertia_change);
    Outputs {
        mass_kg: params.zero_fuel_mass_kg + fuel_kg,
        cg_m: params.cg_m + Vec3::new(aft_m, 0.0, up_m),
        inertia: Inertia {
            xx_kg_m2: i.xx_kg_m2 + tilted * di.xx_kg_m2,
            yy_kg_m2: i.yy_kg_m2 + tilted * di.yy_kg_m2,
            zz_kg_m2: i.zz_kg_m2 + tilted * di.zz_kg_m2,
            xz_kg_m2: i.xz_kg_m2 + tilted * di.xz_kg_m2,
        },
    }
}
