//! Wing and pylons: one half of the wing, in free stream and in its rotor's wake.
//!
//! # Equations
//! ```text
//! α = α_flow + i_W      CL = CLα·(α − α0) + CLδ·δ_flap + CLδa·δ_flaperon             [KH]
//! CD = CD0 + CDδ·δ_flap + CL²/(π·e·AR)
//! S_ss = S_ssmax·[sin(1.386(π/2 − βm)) + cos(3.114(π/2 − βm))]·(u_max − u)/u_max, 0..S/2    [KH]
//! download: the immersed part meets V + 1.6·v along the thrust, CDi on it               [CR536]
//! D_pylon = q·(f_0 + (f_h − f_0)·cos²βm)
//! ```
//! # Signs
//! Written for the right half; the left is its mirror image. Flaps and flaperon: down positive.
//! # Assumptions
//! Linear until the stall, a flat plate beyond; the wake is all on or all off its area; interference
//! of the wake with the flow ahead is left out.

use serde::Deserialize;

use super::{Motion, flow, from_behind, in_body_axes, load_at, surface};
use crate::frames::{Body, Load, Structural, Vec3};
use crate::math::{FRAC_PI_2, PI, clamp, cos, max, sin, square};

/// What a half wing is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// S of both halves.
    pub area_m2: f64,
    /// Mean chord.
    pub chord_m: f64,
    /// Aerodynamic centre of the right half.
    pub centre_m: Vec3<Structural>,
    /// AR.
    pub aspect_ratio: f64,
    /// e.
    pub span_efficiency: f64,
    /// CLα.
    pub lift_slope_per_rad: f64,
    /// α0 to the body axis, incidence included.
    pub zero_lift_rad: f64,
    /// Angle from zero lift at which the wing stalls.
    pub stall_rad: f64,
    /// CLδ of the flap.
    pub lift_per_flap_per_rad: f64,
    /// ΔCL of the half wing per flaperon angle.
    pub lift_per_flaperon_per_rad: f64,
    /// CD0.
    pub drag_coefficient_min: f64,
    /// CDδ of the flap.
    pub drag_per_flap_per_rad: f64,
    /// Cm about the aerodynamic centre.
    pub pitching_moment_coefficient: f64,
    /// S_ssmax: immersed area of a half wing in hover.
    pub immersed_area_m2_max: f64,
    /// u_max: forward speed at which the wake has left the wing.
    pub immersed_speed_mps_max: f64,
    /// Drag coefficient of the immersed part, flaps up.
    pub immersed_drag_coefficient: f64,
    /// Its change with flap angle.
    pub immersed_drag_per_flap_per_rad: f64,
    /// K0: wake velocity at the wing over the mean induced velocity.
    pub wake_factor: f64,
    /// Drag area of one pylon as an aeroplane.
    pub pylon_drag_area_m2: f64,
    /// Drag area of one upright pylon.
    pub pylon_drag_area_upright_m2: f64,
}

/// What the right half reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// βm of this side's nacelle.
    pub mast_tilt_rad: f64,
    /// Unit vector of this side's thrust.
    pub thrust_axis: Vec3<Body>,
    /// v of this side's rotor.
    pub induced_mps: f64,
    /// Flap.
    pub flap_rad: f64,
    /// This side's flaperon beyond the flap's setting.
    pub flaperon_rad: f64,
}

/// The part of the half wing in the wake, m².
pub fn immersed_area(params: &Params, mast_tilt_rad: f64, forward_mps: f64) -> f64 {
    let upright = FRAC_PI_2 - mast_tilt_rad;
    let footprint = sin(1.386 * upright) + cos(3.114 * upright);
    // The printed law gives the whole area again as an aeroplane; the wake has left the wing by then.
    let leaving = crate::math::ramp(cos(mast_tilt_rad), 0.0, 0.5);
    let blown =
        max(0.0, params.immersed_speed_mps_max - forward_mps.abs()) / params.immersed_speed_mps_max;
    clamp(params.immersed_area_m2_max * footprint * leaving * blown, 0.0, 0.5 * params.area_m2)
}

/// Load of the right half.
pub fn half_wing(params: &Params, inputs: &Inputs) -> Load {
    let arm = params.centre_m.from_cg(inputs.motion.cg_m);
    let velocity = inputs.motion.velocity_at(arm);
    let immersed_m2 = immersed_area(params, inputs.mast_tilt_rad, inputs.motion.airspeed_mps.x);

    let free = flow(velocity, inputs.motion.density_kg_per_m3);
    let alpha = from_behind(free.alpha_rad) - params.zero_lift_rad;
    let (line, base_drag) =
        surface(params.lift_slope_per_rad, alpha, params.stall_rad, params.drag_coefficient_min);
    // Controls work on attached flow only.
    let attached = 1.0 - crate::math::ramp(alpha.abs(), params.stall_rad, 2.0 * params.stall_rad);
    let lift_coefficient = line
        + attached
            * (params.lift_per_flap_per_rad * inputs.flap_rad
                + params.lift_per_flaperon_per_rad * inputs.flaperon_rad);
    let drag_coefficient = base_drag
        + params.drag_per_flap_per_rad * inputs.flap_rad
        + square(lift_coefficient) / (PI * params.span_efficiency * params.aspect_ratio);
    let pressure_area = free.pressure_pa * (0.5 * params.area_m2 - immersed_m2);
    let pylon_m2 = params.pylon_drag_area_m2
        + (params.pylon_drag_area_upright_m2 - params.pylon_drag_area_m2)
            * square(cos(inputs.mast_tilt_rad));
    let force = in_body_axes(
        pressure_area * lift_coefficient,
        pressure_area * drag_coefficient + free.pressure_pa * pylon_m2,
        0.0,
        free.alpha_rad,
    );
    let pitching_n_m = pressure_area * params.chord_m * params.pitching_moment_coefficient;

    // The wake blows against the thrust: the wing moves through it along the thrust.
    let blown = velocity + inputs.thrust_axis * (params.wake_factor * inputs.induced_mps);
    let washed = flow(blown, inputs.motion.density_kg_per_m3);
    let download = max(
        0.0,
        params.immersed_drag_coefficient + params.immersed_drag_per_flap_per_rad * inputs.flap_rad,
    );
    let along = blown * (1.0 / max(washed.speed_mps, 1e-3));
    let wake_force = along * (-washed.pressure_pa * immersed_m2 * download);

    load_at(force + wake_force, arm, pitching_n_m)
}
