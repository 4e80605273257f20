//! Landing gear: the ground's push and grip on three struts.
//!
//! # Equations
//! ```text
//! F = k·δ + c·δ̇, never pulling: F ≥ 0; past the stroke k grows tenfold; from 0.15 m past it the
//!     strut yields: no greater F, and F·(1 + δ̇/1 m/s) where it rises, so that it throws nothing back
//! grip: tyre deflection s, ṡ = v_slip, |s| ≤ μF/k_t;   G = −(k_t·s + c_t·v_slip), |G| ≤ μF
//! structural contact: z ≤ −(ground + h_c); where that binds, ż ≤ 0, sliding loses μ_c·(ż + g·h),
//!     ω̇ = −ω/τ_c
//! ```
//! # Signs
//! δ and δ̇ positive in compression. NED z is down, so the push is along −z. Slip positive forward
//! and to the right of the aircraft's heading.
//! # Assumptions
//! Level ground; struts along NED z; a retracted wheel lies `retraction_m` higher and still bears, so
//! a belly landing stands on the wheel wells. Rotors, tail and wing tips do not touch. The tyre
//! is what lets the aircraft stand still: it holds without sliding, as a deflected tyre does.
//! Structural contact is a rule, not a model: a wreck, any way up, comes to rest on the ground instead of
//! sinking into it, from where a wheel that turns up again would throw it out.

use serde::{Deserialize, Serialize};

use crate::frames::{Body, Load, Ned, Rotation, Structural, Vec3};
use crate::math::{clamp, max, min, sqrt, square};
use crate::pair::Pair;
use crate::struts::Struts;
use crate::{GRAVITY_MPS2, STEP_S};

/// Past the stroke the strut is this much stiffer.
const BOTTOMED: f64 = 10.0;
/// Further past the stroke than this, it yields, m.
const YIELD_M: f64 = 0.15;
/// Rising faster than this a strut that yielded pushes no more, m/s.
const YIELD_MPS: f64 = 1.0;

/// μ_c.
const CONTACT_FRICTION: f64 = 0.5;
/// τ_c, s.
const CONTACT_STOP_S: f64 = 0.2;

/// What a strut is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strut {
    /// Tyre contact point, strut extended; of the right one where there are two.
    pub tyre_m: Vec3<Structural>,
    /// k.
    pub stiffness_n_per_m: f64,
    /// c.
    pub damping_n_s_per_m: f64,
    /// Travel until it bottoms.
    pub stroke_m: f64,
    /// μ along a rolling wheel.
    pub rolling_friction: f64,
    /// μ along a braked wheel, added at full brake.
    pub braking_friction: f64,
    /// μ across the wheel; a castering wheel has its rolling one.
    pub sideways_friction: f64,
}

/// What the gear is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Nose strut.
    pub nose: Strut,
    /// Main struts.
    pub main: Strut,
    /// k_t of one strut's tyres.
    #[serde(alias = "tread_stiffness_n_per_m")]
    pub tyre_stiffness_n_per_m: f64,
    /// c_t.
    #[serde(alias = "tread_damping_n_s_per_m")]
    pub tyre_damping_n_s_per_m: f64,
    /// How much higher a retracted wheel lies.
    pub retraction_m: f64,
    /// h_c: nearer to the ground than this the centre of gravity does not come, any way up.
    #[serde(alias = "hull_height_m")]
    pub contact_height_m: f64,
}

/// What a strut's tyres remember: how far their contact patch is deflected in the ground's plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TyreDeflection {
    /// Along the heading.
    pub forward_m: f64,
    /// To the right of it.
    pub right_m: f64,
}

/// What the gear reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// Centre of gravity in the structure.
    pub cg_m: Vec3<Structural>,
    /// Centre of gravity in the world.
    pub position_m: Vec3<Ned>,
    /// Its velocity.
    pub velocity_mps: Vec3<Ned>,
    /// Angular rate of the body.
    pub angular_rate_radps: Vec3<Body>,
    /// Attitude.
    pub ned_from_body: Rotation<Ned, Body>,
    /// Ground under each wheel, above the origin.
    pub ground_height_m: Struts<f64>,
    /// 0 up … 1 down.
    pub extension_norm: f64,
    /// Brake of each main wheel, 0..1.
    pub brake_norm: Pair<f64>,
}

/// What a strut gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Leg {
    /// On the airframe, about the centre of gravity.
    pub load: Load,
    /// δ; 0 in the air.
    pub compression_m: f64,
    /// The ground's push.
    pub push_n: f64,
    /// 1 past the stroke.
    pub bottomed: u64,
}

/// Loads of the struts, and the deflections of their tyres after the tick.
pub fn evaluate(
    params: &Params,
    deflections: &Struts<TyreDeflection>,
    inputs: &Inputs,
) -> (Struts<TyreDeflection>, Struts<Leg>) {
    let ground = inputs.ground_height_m;
    let wheel = |tyre_m, ground_height_m, brake_norm| Wheel { tyre_m, ground_height_m, brake_norm };
    let wheels = Struts {
        nose: wheel(params.nose.tyre_m, ground.nose, 0.0),
        main: Pair {
            left: wheel(params.main.tyre_m.mirrored(), ground.main.left, inputs.brake_norm.left),
            right: wheel(params.main.tyre_m, ground.main.right, inputs.brake_norm.right),
        },
    };
    let (nose_deflection, nose) =
        strut_and_tyre(params, &params.nose, &wheels.nose, deflections.nose, inputs);
    let main = wheels.main.zip(deflections.main).map(|(wheel, deflection)| {
        strut_and_tyre(params, &params.main, &wheel, deflection, inputs)
    });
    (
        Struts { nose: nose_deflection, main: main.map(|(deflection, _)| deflection) },
        Struts { nose, main: main.map(|(_, leg)| leg) },
    )
}

/// A wheel on its place.
struct Wheel {
    /// Tyre contact point, strut extended.
    tyre_m: Vec3<Structural>,
    ground_height_m: f64,
    brake_norm: f64,
}

fn strut_and_tyre(
    params: &Params,
    strut: &Strut,
    wheel: &Wheel,
    deflection: TyreDeflection,
    inputs: &Inputs,
) -> (TyreDeflection, Leg) {
    let raised = Vec3::new(0.0, 0.0, params.retraction_m * (1.0 - inputs.extension_norm));
    let arm = (wheel.tyre_m + raised).from_cg(inputs.cg_m);
    let tyre = inputs.position_m + inputs.ned_from_body * arm;
    let compression_m = tyre.z + wheel.ground_height_m;
    if compression_m <= 0.0 {
        return (TyreDeflection::default(), Leg::default());
    }
    let velocity =
        inputs.velocity_mps + inputs.ned_from_body * inputs.angular_rate_radps.cross(arm);
    let past_stroke_m = max(0.0, compression_m - strut.stroke_m);
    let push_n = push(strut, compression_m, past_stroke_m, velocity.z);

    let nose = inputs.ned_from_body * Vec3::<Body>::new(1.0, 0.0, 0.0);
    let level = sqrt(square(nose.x) + square(nose.y));
    let (north, east) = if level > 1e-6 { (nose.x / level, nose.y / level) } else { (1.0, 0.0) };
    let slip_forward_mps = velocity.x * north + velocity.y * east;
    let slip_right_mps = velocity.y * north - velocity.x * east;
    let along = strut.rolling_friction + strut.braking_friction * wheel.brake_norm;
    let (forward_m, forward_n) =
        grip(params, deflection.forward_m, slip_forward_mps, along * push_n);
    let (right_m, right_n) =
        grip(params, deflection.right_m, slip_right_mps, strut.sideways_friction * push_n);
    let force = Vec3::<Ned>::new(
        forward_n * north - right_n * east,
        forward_n * east + right_n * north,
        -push_n,
    );
    let load = Load::at(inputs.ned_from_body.inverse() * force, arm);
    (
        TyreDeflection { forward_m, right_m },
        Leg { load, compression_m, push_n, bottomed: u64::from(past_stroke_m > 0.0) },
    )
}

/// The ground's push on a strut.
fn push(strut: &Strut, compression_m: f64, past_stroke_m: f64, sinking_mps: f64) -> f64 {
    let elastic_n = strut.stiffness_n_per_m * (compression_m + (BOTTOMED - 1.0) * past_stroke_m);
    let push_n = max(0.0, elastic_n + strut.damping_n_s_per_m * sinking_mps);
    let push_n_max = strut.stiffness_n_per_m * (strut.stroke_m + BOTTOMED * YIELD_M);
    let spent =
        if past_stroke_m > YIELD_M { clamp(1.0 + sinking_mps / YIELD_MPS, 0.0, 1.0) } else { 1.0 };
    min(push_n, push_n_max) * spent
}

/// How the aircraft moves, as structural contact changes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// Centre of gravity.
    pub position_m: Vec3<Ned>,
    /// Its velocity.
    pub velocity_mps: Vec3<Ned>,
    /// ω.
    pub angular_rate_radps: Vec3<Body>,
}

/// The motion after a tick, kept above the ground by contact of the structure with it; untouched
/// where that does not bind.
pub fn structural_contact(
    params: &Params,
    motion: RigidMotion,
    ground_height_m: f64,
) -> RigidMotion {
    let lowest_m = -(ground_height_m + params.contact_height_m);
    if motion.position_m.z <= lowest_m {
        return motion;
    }
    let velocity = motion.velocity_mps;
    let pressed_mps = max(0.0, velocity.z) + GRAVITY_MPS2 * STEP_S;
    let sliding_mps = max(sqrt(square(velocity.x) + square(velocity.y)), 1e-9);
    let kept = max(0.0, 1.0 - CONTACT_FRICTION * pressed_mps / sliding_mps);
    RigidMotion {
        position_m: Vec3::new(motion.position_m.x, motion.position_m.y, lowest_m),
        velocity_mps: Vec3::new(velocity.x * kept, velocity.y * kept, min(0.0, velocity.z)),
        angular_rate_radps: motion.angular_rate_radps * (1.0 - STEP_S / CONTACT_STOP_S),
    }
}

/// A tyre's deflection after the tick, and its force, neither beyond what friction holds.
fn grip(params: &Params, deflection_m: f64, slip_mps: f64, force_n_max: f64) -> (f64, f64) {
    let deflection_m_max = force_n_max / params.tyre_stiffness_n_per_m;
    let deflection_m = clamp(deflection_m + slip_mps * STEP_S, -deflection_m_max, deflection_m_max);
    let force_n =
        -(params.tyre_stiffness_n_per_m * deflection_m + params.tyre_damping_n_s_per_m * slip_mps);
    (deflection_m, clamp(force_n, -force_n_max, force_n_max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Attitude;

    fn params() -> Params {
        let strut = Strut {
            tyre_m: Vec3::new(8.28, 1.19, 0.0),
            stiffness_n_per_m: 175e3,
            damping_n_s_per_m: 21e3,
            stroke_m: 0.343,
            rolling_friction: 0.025,
            braking_friction: 0.5,
            sideways_friction: 0.7,
        };
        Params {
            nose: Strut { tyre_m: Vec3::new(3.48, 0.0, 0.0), ..strut.clone() },
            main: strut,
            tyre_stiffness_n_per_m: 3e5,
            tyre_damping_n_s_per_m: 2e4,
            retraction_m: 0.8,
            contact_height_m: 1.0,
        }
    }

    fn standing(height_m: f64) -> Inputs {
        Inputs {
            cg_m: Vec3::new(7.65, 0.0, 2.0),
            position_m: Vec3::new(0.0, 0.0, -height_m),
            velocity_mps: Vec3::zero(),
            angular_rate_radps: Vec3::zero(),
            ned_from_body: Attitude::default().ned_from_body(),
            ground_height_m: Struts::all(0.0),
            extension_norm: 1.0,
            brake_norm: Pair::both(0.0),
        }
    }

    #[test]
    fn a_strut_pushes_by_its_spring_and_never_pulls() {
        let (_, legs) = evaluate(&params(), &Struts::default(), &standing(1.9));
        assert!((legs.nose.push_n - 175e3 * 0.1).abs() < 1e-6);
        let mut rebounding = standing(1.9);
        rebounding.velocity_mps = Vec3::new(0.0, 0.0, -50.0);
        let (_, legs) = evaluate(&params(), &Struts::default(), &rebounding);
        assert_eq!(legs.nose.push_n.to_bits(), 0);
    }

    #[test]
    fn in_the_air_nothing_touches() {
        let (deflections, legs) = evaluate(&params(), &Struts::default(), &standing(2.5));
        assert_eq!((deflections, legs), (Struts::default(), Struts::default()));
    }

    #[test]
    fn ground_that_rises_by_a_step_lifts_the_aircraft_and_does_not_throw_it() {
        let strut = params().main;
        let most_n = 175e3 * (0.343 + 1.5);
        let at = |past_stroke_m, sinking_mps| {
            push(&strut, strut.stroke_m + past_stroke_m, past_stroke_m, sinking_mps)
        };
        assert!((at(0.1, 0.0) - 175e3 * 1.343).abs() < 1e-6);
        assert!((at(9.0, 0.0) - most_n).abs() < 1e-6 && (at(9.0, 50.0) - most_n).abs() < 1e-6);
        assert!((at(9.0, -0.5) - 0.5 * most_n).abs() < 1e-6 && at(9.0, -1.0) == 0.0);
    }

    #[test]
    fn structural_contact_stops_a_wreck_and_leaves_a_flight_alone() {
        let motion = RigidMotion {
            position_m: Vec3::new(0.0, 0.0, -1.1),
            velocity_mps: Vec3::new(60.0, 0.0, 80.0),
            angular_rate_radps: Vec3::new(0.0, 9.0, 0.0),
        };
        assert_eq!(structural_contact(&params(), motion, 0.0), motion);
        let wreck = structural_contact(&params(), motion, 5.0);
        assert_eq!((wreck.position_m.z, wreck.velocity_mps.z), (-6.0, 0.0));
        assert!((19.0..20.0).contains(&wreck.velocity_mps.x), "60 less half of 80 m/s");
        assert!(wreck.angular_rate_radps.y < 9.0);
    }

    #[test]
    fn sliding_grip_is_friction_times_push() {
        let mut inputs = standing(1.9);
        inputs.velocity_mps = Vec3::new(30.0, 0.0, 0.0);
        inputs.brake_norm = Pair::both(1.0);
        let (_, legs) = evaluate(&params(), &Struts::default(), &inputs);
        let grip_n = -legs.main.left.load.force_n.x;
        assert!((grip_n / legs.main.left.push_n - 0.525).abs() < 1e-12);
    }
}
