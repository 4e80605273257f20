//! Rotor wake: what the rotors do to the air at wing and tail.
//!
//! # Equations
//! ```text
//! α_WFS = α − K_XRW·X_RW·C_RF/max(.15, μ)²      C_RF = Σ|F_rotor|/(ρπΩ²R⁴)      [CR536 A-70, B-33]
//! X_RW = x0 + x1·βm + x2·βm²
//! V_W = K0·v·n                  at each half wing, n along its thrust                 [CR536 A-34]
//! V_H = G(βm, α, V)·F(|β|, βm)·(v_L + v_R)/2·(sin βm, 0, −cos βm)             [CR536 2-I, 2-II]
//! ```
//! # Signs
//! Velocities are those of the component through the air: a downwash moves it along the thrust.
//! Negative G is upwash at the tail.
//! # Assumptions
//! The wake reaches the tail at once. What the source adds at each fin is not at hand;
//! [`fin_wake`](super::fin_wake) has an estimate of it.

use serde::Deserialize;

use super::LocalFlow;
use crate::frames::{Body, Vec3};
use crate::math::{PI, max, sin_cos, square};
use crate::motion::Motion;
use crate::pair::Pair;
use crate::table::axis::{Airspeed, Alpha, Beta, MastTilt};
use crate::table::{Invalid, Table2, Table3, all_valid};

/// Below this advance ratio the rotors deflect the air as at it.
const ADVANCE_RATIO_MIN: f64 = 0.15;
/// Rotors that stand still deflect nothing, and divide by something.
const ROTOR_SPEED_RADPS_MIN: f64 = 10.0;

/// How the wake acts.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// K0: wake velocity at the wing over the mean induced velocity.
    pub wing_factor: f64,
    /// K_XRW.
    pub deflection_factor: f64,
    /// x0.
    pub deflection_upright: f64,
    /// x1.
    pub deflection_per_tilt_per_rad: f64,
    /// x2.
    pub deflection_per_tilt2_per_rad2: f64,
    /// G over mast tilt, angle of attack and airspeed.
    pub tail_ratio: Table3<MastTilt, Alpha, Airspeed>,
    /// F over |β| and mast tilt.
    pub sideslip_factor: Table2<Beta, MastTilt>,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        all_valid([
            ("rotor_wake.tail_ratio", self.tail_ratio.validate()),
            ("rotor_wake.sideslip_factor", self.sideslip_factor.validate()),
        ])
    }
}

/// What the wake depends on. Axes and induced velocities are each side's as a right one.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// The flow that the whole aircraft meets.
    pub flow: LocalFlow,
    /// Mean βm.
    pub mast_tilt_rad: f64,
    /// Unit vectors of thrust.
    pub thrust_axes: Pair<Vec3<Body>>,
    /// v.
    pub induced_mps: Pair<f64>,
    /// |F| of each rotor.
    pub rotor_force_n: Pair<f64>,
    /// μ.
    pub advance_ratio: Pair<f64>,
    /// Ω.
    pub rotor_speed_radps: f64,
    /// R.
    pub rotor_radius_m: f64,
}

/// What the airframe meets.
#[derive(Clone, Copy, Debug)]
pub struct Outputs {
    /// α_WFS, of the wing outside the wake.
    pub wing_alpha_rad: f64,
    /// Velocity of each half wing through its wake, as a right one.
    pub wing_mps: Pair<Vec3<Body>>,
    /// Velocity of the tail through the wake.
    pub tail_mps: Vec3<Body>,
}

/// The wake at wing and tail.
pub fn evaluate(params: &Params, inputs: &Inputs) -> Outputs {
    let flow = inputs.flow;
    let tilt_rad = inputs.mast_tilt_rad;

    let tip_mps = max(inputs.rotor_speed_radps, ROTOR_SPEED_RADPS_MIN) * inputs.rotor_radius_m;
    let tip_n = inputs.motion.density_kg_per_m3 * PI * square(tip_mps * inputs.rotor_radius_m);
    let force_coefficient = inputs.rotor_force_n.sum() / tip_n;
    let x_rw = params.deflection_upright
        + tilt_rad
            * (params.deflection_per_tilt_per_rad
                + params.deflection_per_tilt2_per_rad2 * tilt_rad);
    let advance_ratio = max(ADVANCE_RATIO_MIN, inputs.advance_ratio.mean());
    let deflection_rad =
        params.deflection_factor * x_rw * force_coefficient / square(advance_ratio);

    let tilt = MastTilt(tilt_rad);
    let ratio = params.tail_ratio.at(tilt, Alpha(flow.alpha_rad), Airspeed(flow.speed_mps))
        * params.sideslip_factor.at(Beta(flow.beta_rad.abs()), tilt);
    let (sin_tilt, cos_tilt) = sin_cos(tilt_rad);
    let axis = Vec3::new(sin_tilt, 0.0, -cos_tilt);
    Outputs {
        wing_alpha_rad: flow.alpha_rad - deflection_rad,
        wing_mps: inputs
            .thrust_axes
            .zip(inputs.induced_mps)
            .map(|(axis, induced_mps)| axis * (params.wing_factor * induced_mps)),
        tail_mps: axis * (ratio * inputs.induced_mps.mean()),
    }
}
