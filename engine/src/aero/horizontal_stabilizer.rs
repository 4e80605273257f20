//! Horizontal stabiliser with elevator.
//!
//! # Equations
//! ```text
//! α_H = α_flow + i_H − ε     ε = dε/dα·(α_W − α0W)     CL = CLα·α_H + CLδe·δe        [KH]
//! CD = CD0 + CL²/(π·e·AR)
//! ```
//! # Signs
//! Elevator: trailing edge down positive.
//! # Assumptions
//! Downwash follows the wing's angle of attack without delay; rotor interference is left out.

use serde::Deserialize;

use super::{Motion, flow, from_behind, in_body_axes, load_at, surface};
use crate::frames::{Load, Structural, Vec3};
use crate::math::{PI, clamp, cos, ramp, square};

/// What the stabiliser is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// S.
    pub area_m2: f64,
    /// AR.
    pub aspect_ratio: f64,
    /// e.
    pub span_efficiency: f64,
    /// Reference point.
    pub centre_m: Vec3<Structural>,
    /// i_H.
    pub incidence_rad: f64,
    /// CLα.
    pub lift_slope_per_rad: f64,
    /// CLδe.
    pub lift_per_elevator_per_rad: f64,
    /// Angle at which it stalls.
    pub stall_rad: f64,
    /// CD0.
    pub drag_coefficient_min: f64,
    /// dε/dα.
    pub downwash_per_alpha: f64,
    /// α0W: angle of attack at which the wing gives no downwash.
    pub downwash_zero_rad: f64,
}

/// What the stabiliser reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// δe.
    pub elevator_rad: f64,
}

/// Load of the stabiliser.
pub fn horizontal_stabilizer(params: &Params, inputs: &Inputs) -> Load {
    let arm = params.centre_m.from_cg(inputs.motion.cg_m);
    let velocity = inputs.motion.velocity_at(arm);
    let here = flow(velocity, inputs.motion.density_kg_per_m3);
    let wing = flow(inputs.motion.airspeed_mps, inputs.motion.density_kg_per_m3);
    // Only flow from ahead carries the wing's downwash to the tail.
    let ahead = clamp(cos(wing.alpha_rad), 0.0, 1.0);
    let downwash = params.downwash_per_alpha
        * clamp(wing.alpha_rad - params.downwash_zero_rad, -0.35, 0.35)
        * ahead;
    let flow_rad = here.alpha_rad - downwash;
    let alpha = from_behind(flow_rad + params.incidence_rad);
    let (line, base_drag) =
        surface(params.lift_slope_per_rad, alpha, params.stall_rad, params.drag_coefficient_min);
    let attached = 1.0 - ramp(alpha.abs(), params.stall_rad, 2.0 * params.stall_rad);
    let lift = line + attached * params.lift_per_elevator_per_rad * inputs.elevator_rad * ahead;
    let drag = base_drag + square(lift) / (PI * params.span_efficiency * params.aspect_ratio);
    let pressure_area = here.pressure_pa * params.area_m2;
    let force = in_body_axes(pressure_area * lift, pressure_area * drag, 0.0, flow_rad);
    load_at(force, arm, 0.0)
}
