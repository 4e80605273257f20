//! Vertical stabilisers: one fin with its rudder.
//!
//! # Equations
//! ```text
//! CY = −CYβ·β − CYδ·δr       CD = CD0 + CY²/(π·e·AR)                                [KH]
//! ```
//! # Signs
//! Rudder: trailing edge right positive, which pushes the tail left and the nose right.
//! Written for the right fin; the left is its mirror image.
//! # Assumptions
//! Linear until the stall, a flat plate beyond; sidewash and rotor interference are left out.

use serde::Deserialize;

use super::{Motion, flow, load_at, surface};
use crate::frames::{Load, Structural, Vec3};
use crate::math::{PI, clamp, cos, max, ramp, square};

/// What a fin is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// S of one fin.
    pub area_m2: f64,
    /// AR.
    pub aspect_ratio: f64,
    /// e.
    pub span_efficiency: f64,
    /// Reference point of the right fin.
    pub centre_m: Vec3<Structural>,
    /// CYβ.
    pub side_force_slope_per_rad: f64,
    /// CYδ.
    pub side_force_per_rudder_per_rad: f64,
    /// Angle at which it stalls.
    pub stall_rad: f64,
    /// CD0.
    pub drag_coefficient_min: f64,
}

/// What the right fin reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// δr, outboard positive (to the right for the right fin).
    pub rudder_rad: f64,
}

/// Load of the right fin.
pub fn fin(params: &Params, inputs: &Inputs) -> Load {
    let arm = params.centre_m.from_cg(inputs.motion.cg_m);
    let velocity = inputs.motion.velocity_at(arm);
    let flow = flow(velocity, inputs.motion.density_kg_per_m3);
    let ahead = clamp(cos(flow.alpha_rad), 0.0, 1.0);
    let (line, base_drag) = surface(
        params.side_force_slope_per_rad,
        flow.beta_rad,
        params.stall_rad,
        params.drag_coefficient_min,
    );
    let attached = 1.0 - ramp(flow.beta_rad.abs(), params.stall_rad, 2.0 * params.stall_rad);
    let side = line + attached * params.side_force_per_rudder_per_rad * inputs.rudder_rad * ahead;
    let drag = base_drag + square(side) / (PI * params.span_efficiency * params.aspect_ratio);
    let pressure_area = flow.pressure_pa * params.area_m2;
    let along = velocity * (1.0 / max(flow.speed_mps, 1e-3));
    let force = Vec3::new(0.0, -pressure_area * side, 0.0) + along * (-pressure_area * drag);
    load_at(force, arm, 0.0)
}
