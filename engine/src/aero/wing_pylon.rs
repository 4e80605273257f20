//! Wing and pylons: one half of the wing, in free stream and in its rotor's wake, its pylon and spinner.
//!
//! # Equations
//! ```text
//! free stream, q = ½ρ(U² + W²), all on α_WFS:                                     [CR536 A-70 to A-74]
//!   L = q·((S/2 − S_ss)·CL − S/2·CLδa·|δa|)   D = q·(S/2 − S_ss)·CD   M = q·S/2·c·Cm
//!   l = q·S/2·b·(Clβ·β + Clp·p̂ + Clr·CL·r̂ − K·Clδa·δa)               p̂ = p·b/2V, r̂ alike
//!   N = q·S/2·b·((Cnβ + Cnβ2·CL²)·β + Cnp·CL·p̂ + (Cnr2·CL² + Cnr0·CD0)·r̂)
//!       − q_iw·S/2·b·(K_n0 + K_n·CL·K·Clδa)·δa
//! immersed: S_ss with the same CL and CD at V + K0·v·n + k·(p, r)×r; q_iw = ½ρ(U² + W²) there   [CR536 A-69]
//!   k = 1 − V/V_iw, at least 0; V fading as the coefficients do: what the coefficients have not counted
//!   at (X_iW, Y_iW): the middle of what is immersed, c_i/4·cos α ahead of it
//! pylon:   D = q_iw·D_PYINT(βm)/2 + q_SP·S_PLAT·K_PLAT(β_SP)           at the pivot      [CR536 A-75]
//! spinner: D = q_SP·(1 + 5.5·sin³α_m)      at the hub, at V + v·n, α_m to the mast       [CR536 A-76]
//! ```
//! # Signs
//! Written for the right half; the left is its mirror image. Flaps and flaperon: down positive, so the
//! right half's flaperon rolls to the left.
//! # Assumptions
//! Roll, yaw and sideslip act on the free stream through the published coefficients, so its α and q
//! are those of the centre of gravity and not the half wing's own: taking both would count the
//! damping twice. In the source they are those of the whole wing (it has lift and drag of the part in the
//! wake and of the part outside, but one rolling and one yawing moment of wing and pylons): the part in
//! the wake, as `wake_footprint` has it, adds to them what its air is faster by. With Clp = −.774, which
//! is −a/6 of strips with the wing's own slope, that is all of the damping in hover, where the coefficients have
//! no air, and 2 % of it as an aeroplane; its whole motion there would count two thirds of the wing twice.
//! Pitching has no coefficient, so that the part in the wake sees all of it. The source gives
//! its force arms of its own, from the trailing edge (X_iW, Y_iW, SL_WTE), not the quarter chord's: a
//! wing broadside to the wake is a plate, loaded in the middle of its chord; with the flow along the
//! chord again it is a quarter chord ahead of it, and cos α leads from one to the other. The deflection
//! α − α_WFS turns the air in the wake too, which the source does not say: as an aeroplane the wing
//! in the slipstream would else stand at a larger angle than the wing beside it. α is the body's: the tables contain the incidence. Coefficients of rate and sideslip fade as the flaperons'
//! do, from 8 to 25° of α; β counts up to 20°. Platform drag comes with the hub's sideways motion only:
//! the source's trim printouts have none in symmetric flight.

pub use super::half_wing::{Inputs, Params};
use super::polar::Flap;
use super::wake_footprint::{CHORDWISE, Footprint, Row, footprint_of_rows, rows};
use super::{in_body_axes, load_at};
use crate::frames::{Body, Load, Vec3};
use crate::math::{atan2, clamp, cos, max, ramp, sqrt, square, wrap_angle};
use crate::pair::Pair;
use crate::table::axis::{CrossflowAngle, FlapAngle, MastTilt};
use crate::units::DEGREE_RAD as DEG;

/// Flaperons work fully up to here …
const ATTACHED_RAD: f64 = 8.0 * DEG;
/// … and no longer from here on.
const SEPARATED_RAD: f64 = 25.0 * DEG;
/// Sideslip beyond this changes nothing more.
const SIDESLIP_RAD_MAX: f64 = 20.0 * DEG;

/// Loads of the right half by what they come from.
#[derive(Clone, Copy, Debug)]
pub struct Outputs {
    /// The part outside the wake, with all moments.
    pub free_stream: Load,
    /// The part in the wake.
    pub immersed: Load,
    /// The pylon.
    pub pylon: Load,
    /// The spinner.
    pub spinner: Load,
}

impl Outputs {
    /// All together.
    pub fn total(&self) -> Load {
        self.free_stream + self.immersed + self.pylon + self.spinner
    }
}

/// What both halves have in common while both masts are tilted alike.
#[derive(Clone, Copy)]
struct Common {
    coefficients: Coefficients,
    rows: [Row; CHORDWISE],
}

impl Common {
    fn new(params: &Params, inputs: &Inputs) -> Self {
        Self { coefficients: Coefficients::new(params, inputs), rows: rows(params, inputs) }
    }

    /// The arguments that lead to it, as bits.
    fn arguments(inputs: &Inputs) -> [u64; 11] {
        let (tilt_rad, hub, cg) = (inputs.mast.tilt_rad, inputs.hub_from_cg_m, inputs.motion.cg_m);
        let [alpha, flap] = [inputs.alpha_rad, inputs.flap_rad];
        let radius_m = inputs.rotor_radius_m;
        [tilt_rad, inputs.mach, alpha, flap, radius_m, hub.x, hub.y, hub.z, cg.x, cg.y, cg.z]
            .map(f64::to_bits)
    }
}

/// Loads of both halves, each as of a right one. What is equal for both is looked up once.
pub fn evaluate_both(params: &Params, inputs: Pair<Inputs>) -> Pair<Outputs> {
    let left = Common::new(params, &inputs.left);
    let alike = Common::arguments(&inputs.left) == Common::arguments(&inputs.right);
    let right = if alike { left } else { Common::new(params, &inputs.right) };
    Pair { left: loads(params, &inputs.left, &left), right: loads(params, &inputs.right, &right) }
}

/// Loads of the right half.
pub fn evaluate(params: &Params, inputs: &Inputs) -> Outputs {
    loads(params, inputs, &Common::new(params, inputs))
}

fn loads(params: &Params, inputs: &Inputs, common: &Common) -> Outputs {
    let Common { coefficients, rows } = common;
    let arm = params.centre_m.from_cg(inputs.motion.cg_m);
    let footprint = footprint_of_rows(params, inputs, rows);
    let in_wake = InWake::at(inputs, arm);
    let (immersed_m2, in_wake_pa) = (footprint.area_m2, in_wake.pressure_pa);
    Outputs {
        free_stream: free_stream(params, inputs, coefficients, arm, immersed_m2, in_wake_pa),
        immersed: immersed(params, inputs, coefficients.attached, &footprint),
        pylon: pylon(params, inputs, coefficients, in_wake),
        spinner: spinner(params, inputs),
    }
}

/// What the tables say of the free stream, this side's flaperon and the aircraft's rates aside.
#[derive(Clone, Copy)]
struct Coefficients {
    /// CL.
    lift: f64,
    /// CD.
    drag: f64,
    /// Cm.
    pitching: f64,
    /// How far the flow is attached: 1 fully, 0 not at all.
    attached: f64,
    /// CLδa, fading.
    lift_loss_per_rad: f64,
    /// Clβ.
    rolling_by_sideslip_per_rad: f64,
    /// K·Clδa.
    rolling_by_flaperon_per_rad: f64,
    /// Cnr2·CL² + Cnr0·CD0.
    yawing_by_yaw_rate: f64,
    /// K_n0 + K_n·CL·K·Clδa.
    yawing_by_flaperon_per_rad: f64,
    /// D_PYINT.
    interference_m2: f64,
}

impl Coefficients {
    fn new(params: &Params, inputs: &Inputs) -> Self {
        let (tilt_rad, columns) = (inputs.mast.tilt_rad, Flap::new(inputs.flap_rad));
        let (tilt, flap) = (MastTilt(tilt_rad), FlapAngle(inputs.flap_rad));
        let alpha = wrap_angle(inputs.alpha_rad);
        let cl = params.lift.lift_at(tilt_rad, columns, inputs.mach, alpha);
        let attached = 1.0 - ramp(alpha.abs(), ATTACHED_RAD, SEPARATED_RAD);
        let by_flaperon =
            params.rolling_by_flaperon_per_rad * params.flaperon_factor.at(tilt, flap) * attached;
        Self {
            lift: cl,
            drag: params.drag.drag_at(tilt_rad, columns, inputs.mach, alpha),
            pitching: params.pitching_moment.at(tilt, flap),
            attached,
            lift_loss_per_rad: params.lift_loss_by_flaperon_per_rad.at(flap),
            rolling_by_sideslip_per_rad: params.rolling_by_sideslip_per_rad.at(tilt, flap)
                + params.rolling_by_sideslip_and_lift_per_rad.at(tilt, flap) * cl,
            rolling_by_flaperon_per_rad: by_flaperon,
            yawing_by_yaw_rate: params.yawing_by_yaw_rate_and_lift2 * square(cl)
                + params.yawing_by_yaw_rate_and_drag * params.drag_at_no_lift.at(tilt, flap),
            yawing_by_flaperon_per_rad: params.yawing_by_flaperon_per_rad.at(tilt, flap) * attached
                + params.yawing_by_flaperon_and_lift.at(tilt, flap) * cl * by_flaperon,
            interference_m2: params.interference_m2.at(tilt),
        }
    }
}

/// Flow in the plane of symmetry at the half wing in its wake.
#[derive(Clone, Copy)]
struct InWake {
    alpha_rad: f64,
    /// q_iw.
    pressure_pa: f64,
}

impl InWake {
    fn at(inputs: &Inputs, arm: Vec3<Body>) -> Self {
        let velocity = inputs.motion.velocity_at(arm) + inputs.wake_mps;
        Self {
            alpha_rad: atan2(velocity.z, velocity.x),
            pressure_pa: 0.5
                * inputs.motion.density_kg_per_m3
                * (square(velocity.x) + square(velocity.z)),
        }
    }
}

fn free_stream(
    params: &Params,
    inputs: &Inputs,
    of: &Coefficients,
    arm: Vec3<Body>,
    immersed_m2: f64,
    pressure_in_wake_pa: f64,
) -> Load {
    let velocity = inputs.motion.airspeed_mps;
    let speed_mps = sqrt(square(velocity.x) + square(velocity.z));
    let rho = inputs.motion.density_kg_per_m3;
    let q = 0.5 * rho * square(speed_mps);
    let cl = of.lift;

    let half_m2 = 0.5 * params.area_m2;
    let free_m2 = half_m2 - immersed_m2;
    let lift_loss = of.lift_loss_per_rad * inputs.flaperon_rad.abs() * of.attached;
    let lift_n = q * (free_m2 * cl - half_m2 * lift_loss);
    let force = in_body_axes(lift_n, q * free_m2 * of.drag, 0.0, inputs.alpha_rad);
    let pitching_n_m = q * half_m2 * params.chord_m * of.pitching;

    let beta = clamp(inputs.flow.beta_rad, -SIDESLIP_RAD_MAX, SIDESLIP_RAD_MAX) * of.attached;
    // q·p̂ and q·r̂, which stay finite at rest.
    let rate = 0.25 * rho * speed_mps * params.span_m * of.attached;
    let (roll, yaw) =
        (rate * inputs.motion.angular_rate_radps.x, rate * inputs.motion.angular_rate_radps.z);
    let rolling = q
        * (of.rolling_by_sideslip_per_rad * beta
            - of.rolling_by_flaperon_per_rad * inputs.flaperon_rad)
        + params.rolling_by_roll_rate * roll
        + params.rolling_by_yaw_rate_and_lift * cl * yaw;
    let by_sideslip = params.yawing_by_sideslip_per_rad
        + params.yawing_by_sideslip_and_lift2_per_rad * square(cl);
    let yawing = q * by_sideslip * beta
        + params.yawing_by_roll_rate_and_lift * cl * roll
        + of.yawing_by_yaw_rate * yaw
        - pressure_in_wake_pa * of.yawing_by_flaperon_per_rad * inputs.flaperon_rad;
    let area_span_m3 = half_m2 * params.span_m;
    load_at(force, arm, pitching_n_m).with_moment(Vec3::new(
        rolling * area_span_m3,
        0.0,
        yawing * area_span_m3,
    ))
}

fn immersed(params: &Params, inputs: &Inputs, attached: f64, part: &Footprint) -> Load {
    if part.area_m2 <= 0.0 {
        return Load::default();
    }
    let mut own = *inputs;
    let not_counted = not_counted(inputs, attached);
    own.motion.angular_rate_radps.x *= not_counted;
    own.motion.angular_rate_radps.z *= not_counted;
    let in_wake = InWake::at(&own, part.centroid_from_cg_m);
    let deflection_rad = inputs.flow.alpha_rad - inputs.alpha_rad;
    let alpha = wrap_angle(in_wake.alpha_rad - deflection_rad);
    let flap = Flap::new(inputs.flap_rad);
    let cl = params.lift.lift_at(inputs.mast.tilt_rad, flap, inputs.mach, alpha);
    let cd = params.drag.drag_at(inputs.mast.tilt_rad, flap, inputs.mach, alpha);
    let pressure_area = in_wake.pressure_pa * part.area_m2;
    let force = in_body_axes(pressure_area * cl, pressure_area * cd, 0.0, alpha);
    let ahead_m = 0.25 * part.chord_m * cos(alpha);
    load_at(force, part.centroid_from_cg_m + Vec3::new(ahead_m, 0.0, 0.0), 0.0)
}

/// k: the part of what roll and yaw do in the wake that the whole wing's coefficients do not hold.
fn not_counted(inputs: &Inputs, attached: f64) -> f64 {
    let speed = |v: Vec3<Body>| sqrt(square(v.x) + square(v.z));
    let free_mps = attached * speed(inputs.motion.airspeed_mps);
    let in_wake_mps = speed(inputs.motion.airspeed_mps + inputs.wake_mps);
    max(0.0, 1.0 - free_mps / max(in_wake_mps, 1e-3))
}

/// Velocity of the hub through the air, its own rotor's included.
fn hub_velocity(inputs: &Inputs) -> Vec3<Body> {
    inputs.motion.velocity_at(inputs.hub_from_cg_m) + inputs.mast.thrust_axis * inputs.induced_mps
}

fn pylon(params: &Params, inputs: &Inputs, of: &Coefficients, in_wake: InWake) -> Load {
    let drag_n = 0.5 * of.interference_m2 * in_wake.pressure_pa;
    let interference = in_body_axes(0.0, drag_n, 0.0, in_wake.alpha_rad);
    let velocity = hub_velocity(inputs);
    let sideways_mps = inputs.motion.velocity_at(inputs.hub_from_cg_m).y;
    let in_plane_mps = sqrt(square(velocity.x) + square(velocity.z));
    let angle_rad = atan2(sideways_mps.abs(), in_plane_mps);
    let platform_m2 = params.platform_m2 * params.platform_factor.at(CrossflowAngle(angle_rad));
    let platform = along(velocity, inputs.motion.density_kg_per_m3, platform_m2);
    Load::at(interference + platform, inputs.pivot_m.from_cg(inputs.motion.cg_m))
}

fn spinner(params: &Params, inputs: &Inputs) -> Load {
    let velocity = hub_velocity(inputs);
    let speed_mps = max(velocity.norm(), 1e-3);
    let cos_mast = velocity.dot(inputs.mast.thrust_axis) / speed_mps;
    let sin_mast = sqrt(max(0.0, 1.0 - square(cos_mast)));
    let area_m2 = params.spinner_m2 + params.spinner_across_m2 * sin_mast * square(sin_mast);
    let force = along(velocity, inputs.motion.density_kg_per_m3, area_m2);
    Load::at(force, inputs.hub_from_cg_m)
}

/// Drag against a velocity.
fn along(velocity: Vec3<Body>, density_kg_per_m3: f64, area_m2: f64) -> Vec3<Body> {
    velocity * (-0.5 * density_kg_per_m3 * velocity.norm() * area_m2)
}
