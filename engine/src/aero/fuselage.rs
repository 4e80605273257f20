//! Fuselage: drag, lift and moments of the body.
//!
//! # Equations
//! ```text
//! D = q·(f0 + f_c·sin²(angle to the x axis))    L = q·S·CLα·(α − α0)    M = q·S·c·(Cm0 + Cmα·α)   [KH]
//! Y = q·S_y·β          N = q·V_n·β
//! ```
//! # Signs
//! α and β as in the flow; N nose right positive.
//! # Assumptions
//! Lift and moments saturate at 20° of α and β; flow from behind gives drag only.

use serde::Deserialize;

use super::{Motion, flow, in_body_axes, load_at};
use crate::frames::{Load, Structural, Vec3};
use crate::math::{clamp, cos, square};

/// Beyond this the body no longer lifts like a wing.
const ANGLE_RAD_MAX: f64 = 0.35;

/// What the fuselage is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Reference point.
    pub centre_m: Vec3<Structural>,
    /// Reference area of the coefficients.
    pub reference_area_m2: f64,
    /// Reference chord.
    pub reference_chord_m: f64,
    /// f0, along the axis.
    pub drag_area_m2: f64,
    /// Added when the flow comes across.
    pub drag_area_across_m2: f64,
    /// CLα.
    pub lift_slope_per_rad: f64,
    /// α0.
    pub zero_lift_rad: f64,
    /// Cm0.
    pub pitching_moment_coefficient: f64,
    /// Cmα.
    pub pitching_moment_slope_per_rad: f64,
    /// Side force over q and β; negative.
    pub side_force_slope_m2_per_rad: f64,
    /// Yawing moment over q and β; negative turns the nose away from the wind.
    pub yawing_moment_slope_m3_per_rad: f64,
    /// Drag area of the extended gear.
    pub gear_drag_area_m2: f64,
}

/// What the fuselage reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// 0 up … 1 down.
    pub gear_extension_norm: f64,
}

/// Load of the fuselage.
pub fn fuselage(params: &Params, inputs: &Inputs) -> Load {
    let arm = params.centre_m.from_cg(inputs.motion.cg_m);
    let velocity = inputs.motion.velocity_at(arm);
    let flow = flow(velocity, inputs.motion.density_kg_per_m3);
    let limit = |angle_rad| clamp(angle_rad, -ANGLE_RAD_MAX, ANGLE_RAD_MAX);
    // Fades out as the flow turns to come from behind.
    let ahead = clamp(cos(flow.alpha_rad), 0.0, 1.0);
    let alpha = limit(flow.alpha_rad - params.zero_lift_rad);
    let beta = limit(flow.beta_rad);
    let q = flow.pressure_pa;
    let across = 1.0 - square(cos(flow.alpha_rad) * cos(flow.beta_rad));
    let drag_m2 = params.drag_area_m2
        + params.drag_area_across_m2 * across
        + params.gear_drag_area_m2 * inputs.gear_extension_norm;
    let lift_n = q * params.reference_area_m2 * params.lift_slope_per_rad * alpha * ahead;
    let pitching_n_m = q
        * params.reference_area_m2
        * params.reference_chord_m
        * (params.pitching_moment_coefficient
            + params.pitching_moment_slope_per_rad * limit(flow.alpha_rad))
        * ahead;
    let side_n = q * params.side_force_slope_m2_per_rad * beta;
    let yawing_n_m = q * params.yawing_moment_slope_m3_per_rad * beta * ahead;
    let lift_and_side = in_body_axes(lift_n, 0.0, side_n, flow.alpha_rad);
    let drag = velocity * (-q * drag_m2 / crate::math::max(flow.speed_mps, 1e-3));
    load_at(lift_and_side + drag, arm, pitching_n_m).with_moment(Vec3::new(0.0, 0.0, yawing_n_m))
}
