//! Fuselage: lift, drag, side force and moments of the body and of what hangs from it.
//!
//! # Equations
//! ```text
//! L/q = L_α(α)·cos²β + L_β(|β|) + LBFO + LLANG                            [CR536 A-41 to A-44, 3-I to 3-IX]
//! D/q = D_α(α)·cos²β + D_β(|β|) + DBFO + DLANG + D_POD + D_oMG·gear
//! M/q = M_α(α)·cos²β + M_β(|β|) + MBFO          Y/q, l/q, N/q: odd in β
//! beyond ±90°: L(180° ∓ α) = −L(±α), D and M equal
//! ```
//! # Signs
//! L, D and Y in wind axes (Y right), moments in body axes about the reference point.
//! # Assumptions
//! The lift that comes with sideslip acts along body z, where the source turns it with α: the two
//! agree at α = 0, and only this one has an answer when the air comes straight from the side. l and N
//! change sign as the flow comes to be from behind, over ±30° about the vertical. Body rates do not
//! reach the fuselage's flow.

use serde::Deserialize;

use super::{LocalFlow, ahead};
use crate::frames::{Load, Structural, Vec3};
use crate::math::{FRAC_PI_2, PI, sign, sin_cos, square};
use crate::motion::Motion;
use crate::table::axis::{Alpha, Beta};
use crate::table::{Invalid, Table1, all_valid};

/// What the fuselage is. Tables over α are printed for ±90°, those over β for positive ones.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Reference point.
    pub centre_m: Vec3<Structural>,
    /// L_α.
    pub lift_m2: Table1<Alpha>,
    /// D_α.
    pub drag_m2: Table1<Alpha>,
    /// M_α.
    pub pitching_m3: Table1<Alpha>,
    /// L_β.
    pub lift_by_sideslip_m2: Table1<Beta>,
    /// D_β.
    pub drag_by_sideslip_m2: Table1<Beta>,
    /// M_β.
    pub pitching_by_sideslip_m3: Table1<Beta>,
    /// Y.
    pub side_m2: Table1<Beta>,
    /// l.
    pub rolling_m3: Table1<Beta>,
    /// N.
    pub yawing_m3: Table1<Beta>,
    /// LBFO.
    pub lift_offset_m2: f64,
    /// DBFO.
    pub drag_offset_m2: f64,
    /// MBFO.
    pub pitching_offset_m3: f64,
    /// LLANG.
    pub lift_correction_m2: f64,
    /// DLANG.
    pub drag_correction_m2: f64,
    /// D_POD, of the gear pods.
    pub pod_drag_m2: f64,
    /// D_oMG, of the extended gear.
    pub gear_drag_m2: f64,
}

/// What the fuselage reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// The flow that the whole aircraft meets.
    pub flow: LocalFlow,
    /// 0 up … 1 down.
    pub gear_extension_norm: f64,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        all_valid([
            ("fuselage.lift", self.lift_m2.validate()),
            ("fuselage.drag", self.drag_m2.validate()),
            ("fuselage.pitching", self.pitching_m3.validate()),
            ("fuselage.lift_by_sideslip", self.lift_by_sideslip_m2.validate()),
            ("fuselage.drag_by_sideslip", self.drag_by_sideslip_m2.validate()),
            ("fuselage.pitching_by_sideslip", self.pitching_by_sideslip_m3.validate()),
            ("fuselage.side", self.side_m2.validate()),
            ("fuselage.rolling", self.rolling_m3.validate()),
            ("fuselage.yawing", self.yawing_m3.validate()),
        ])
    }
}

/// α within ±90° with the same drag, and the sign of its lift.
fn folded(alpha_rad: f64) -> (f64, f64) {
    if alpha_rad > FRAC_PI_2 {
        (PI - alpha_rad, -1.0)
    } else if alpha_rad < -FRAC_PI_2 {
        (-PI - alpha_rad, -1.0)
    } else {
        (alpha_rad, 1.0)
    }
}

/// Load of the fuselage.
pub fn evaluate(params: &Params, inputs: &Inputs) -> Load {
    let flow = inputs.flow;
    let q = flow.pressure_pa;
    let (alpha_rad, lift_sign) = folded(flow.alpha_rad);
    let (beta, side) = (Beta(flow.beta_rad.abs()), sign(flow.beta_rad));
    let alpha = Alpha(alpha_rad);
    let (sin_beta, cos_beta) = sin_cos(flow.beta_rad);
    let cos2_beta = square(cos_beta);

    let lift_n = q * (lift_sign * params.lift_m2.at(alpha) * cos2_beta + params.lift_correction_m2);
    let sideslip_lift_n = q * (params.lift_by_sideslip_m2.at(beta) + params.lift_offset_m2);
    let drag_n = q
        * (params.drag_m2.at(alpha) * cos2_beta
            + params.drag_by_sideslip_m2.at(beta)
            + params.drag_offset_m2
            + params.drag_correction_m2
            + params.pod_drag_m2
            + params.gear_drag_m2 * inputs.gear_extension_norm);
    let side_n = q * side * params.side_m2.at(beta);
    let pitching_n_m = q
        * (params.pitching_m3.at(alpha) * cos2_beta
            + params.pitching_by_sideslip_m3.at(beta)
            + params.pitching_offset_m3);
    let turning = q * side * ahead(flow.alpha_rad);

    let (sin_alpha, cos_alpha) = sin_cos(flow.alpha_rad);
    let back_n = drag_n * cos_beta + side_n * sin_beta;
    let force = Vec3::new(
        lift_n * sin_alpha - back_n * cos_alpha,
        side_n * cos_beta - drag_n * sin_beta,
        -lift_n * cos_alpha - back_n * sin_alpha - sideslip_lift_n,
    );
    let moment = Vec3::new(
        turning * params.rolling_m3.at(beta),
        pitching_n_m,
        turning * params.yawing_m3.at(beta),
    );
    Load::at(force, params.centre_m.from_cg(inputs.motion.cg_m)).with_moment(moment)
}
