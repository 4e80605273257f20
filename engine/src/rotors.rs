//! Rotors: thrust, torque and tip-path tilt of one gimballed proprotor.
//!
//! # Equations
//! One blade section at ¾ radius stands for the blade; momentum theory gives the inflow.
//! ```text
//! φ = atan2(Vz + κ·v, ¾ΩR)     α = θ¾ − φ      cl = a·α, |cl| ≤ cl_max     cd = δ0 + δ2·cl²
//! W² = (ΩR)²·(1/3 + μ²/2) + (Vz + v)²
//! T = ½ρσA·W²·(cl·cos φ − cd·sin φ)
//! Q = ½ρσA·W²·(cl·sin φ + cd·cos φ)·¾R
//! m̄ρAR·v̇ = T·G² − 2ρA·v·√(μ²(ΩR)² + (Vz + v)²)         m̄ = 128/(75π)            [PETERS]
//! G = 1 − (R/4z)²/(1 + (μ/λ)²)      v near the ground over v far from it           [CHEESEMAN]
//! a1∞ = 2μx·(4/3·θ¾ − λ) − B1 − 16q/(γΩ) + p/Ω   tip path, aft positive  [CR536 form]
//! b1∞ = −2μy·(4/3·θ¾ − λ) − 16p/(γΩ) − q/Ω   tip path, right positive
//! ȧ1 = (a1∞ − a1)·γΩ/16, ḃ1 alike
//! ```
//! # Signs
//! Mast axes (x forward, y right, z down the mast). Vz is the hub's speed along the thrust. B1 is
//! positive for stick forward and tilts the disc forward. Written for the right rotor, which turns
//! counter-clockwise seen from above; the left one is its mirror image.
//! # Assumptions
//! No lateral cyclic; uniform inflow; no coning, no δ3, no blade elasticity; one section instead of an integral along
//! the blade; hub moments by the gimbal spring alone. Blade elements, three-state inflow and
//! second-order gimbal motion are to replace these.

use serde::{Deserialize, Serialize};

use crate::aero::Motion;
use crate::frames::{Body, Load, Mast, Rotation, Structural, Vec3};
use crate::math::{PI, atan2, clamp, cos, max, sin, sqrt, square};

/// Apparent mass of the uniform inflow.
const APPARENT_MASS: f64 = 128.0 / (75.0 * PI);
/// The section that stands for the blade.
const SECTION: f64 = 0.75;

/// What a rotor is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// R.
    pub radius_m: f64,
    /// σ, thrust-weighted.
    pub solidity: f64,
    /// a.
    pub lift_slope_per_rad: f64,
    /// cl_max of the mean section.
    pub lift_coefficient_max: f64,
    /// δ0.
    pub drag_coefficient_min: f64,
    /// δ2: growth of drag with the square of lift.
    pub drag_coefficient_per_lift2: f64,
    /// κ: what a real disc induces over an ideal one.
    pub induced_power_factor: f64,
    /// γ at sea-level density.
    pub lock_number: f64,
    /// K_H.
    pub hub_spring_n_m_per_rad: f64,
    /// Flapping stop, either way.
    pub flapping_rad_max: f64,
    /// Polar inertia of rotor and hub.
    pub polar_inertia_kg_m2: f64,
    /// Conversion pivot of the right nacelle.
    pub pivot_m: Vec3<Structural>,
    /// Pivot to hub.
    pub mast_length_m: f64,
    /// Outboard cant of the mast as a helicopter.
    pub mast_cant_rad: f64,
}

impl Params {
    /// A.
    pub fn disc_area_m2(&self) -> f64 {
        PI * square(self.radius_m)
    }

    /// Unit vector of the right rotor's thrust.
    pub fn thrust_axis(&self, mast_tilt_rad: f64) -> Vec3<Body> {
        let cant_rad = self.mast_cant_rad * cos(mast_tilt_rad);
        Vec3::new(
            sin(mast_tilt_rad) * cos(cant_rad),
            sin(cant_rad),
            -cos(mast_tilt_rad) * cos(cant_rad),
        )
    }

    /// Right hub, from the centre of gravity.
    pub fn hub_from_cg(&self, cg_m: Vec3<Structural>, mast_tilt_rad: f64) -> Vec3<Body> {
        self.pivot_m.from_cg(cg_m) + self.thrust_axis(mast_tilt_rad) * self.mast_length_m
    }
}

/// What a rotor remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// v, mean induced velocity, down the mast positive.
    pub induced_mps: f64,
    /// a1, tip path tilted aft.
    pub tilt_aft_rad: f64,
    /// b1, tip path tilted right (in the mirror for the left rotor).
    pub tilt_right_rad: f64,
}

/// What a rotor reads, as the right rotor sees it.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// βm.
    pub mast_tilt_rad: f64,
    /// How fast the nacelle tilts.
    pub mast_tilt_rate_radps: f64,
    /// Ω.
    pub rotor_speed_radps: f64,
    /// θ¾.
    pub collective_rad: f64,
    /// B1.
    pub cyclic_forward_rad: f64,
    /// Hub over the ground.
    pub hub_height_m: f64,
}

/// What a rotor gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// On the airframe, about the centre of gravity.
    pub load: Load,
    /// T.
    pub thrust_n: f64,
    /// Q, needed at the mast.
    pub torque_n_m: f64,
    /// Q·Ω.
    pub power_w: f64,
    /// v as the airframe meets it, along the thrust axis and downwards positive.
    pub induced_mps: f64,
    /// μ.
    pub advance_ratio: f64,
    /// 1 when the mean section is at its greatest lift.
    pub stalled: u64,
}

/// How fast the state changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// Of the induced velocity.
    pub induced_mps2: f64,
    /// Of the tilt aft.
    pub tilt_aft_radps: f64,
    /// Of the tilt right.
    pub tilt_right_radps: f64,
}

/// Loads and rates of one rotor.
pub fn rotor(params: &Params, state: &State, inputs: &Inputs) -> (Rate, Outputs) {
    let omega = max(inputs.rotor_speed_radps, 1.0);
    let tip_mps = omega * params.radius_m;
    let area = params.disc_area_m2();
    let rho = inputs.motion.density_kg_per_m3;

    let axis = params.thrust_axis(inputs.mast_tilt_rad);
    let forward = Vec3::<Body>::new(cos(inputs.mast_tilt_rad), 0.0, sin(inputs.mast_tilt_rad));
    let body_from_mast: Rotation<Body, Mast> =
        Rotation::from_axes(forward, (-axis).cross(forward), -axis);
    let mast_from_body = body_from_mast.inverse();

    let arm = params.hub_from_cg(inputs.motion.cg_m, inputs.mast_tilt_rad);
    // Tilting forward is a nose-down turn of the nacelle about its pivot.
    let nacelle_rate = Vec3::<Body>::new(0.0, -inputs.mast_tilt_rate_radps, 0.0);
    let hub_velocity = mast_from_body
        * (inputs.motion.velocity_at(arm) + nacelle_rate.cross(axis * params.mast_length_m));
    let hub_rate = mast_from_body * (inputs.motion.angular_rate_radps + nacelle_rate);

    let along_mps = -hub_velocity.z;
    let (mu_x, mu_y) = (hub_velocity.x / tip_mps, hub_velocity.y / tip_mps);
    let mu2 = square(mu_x) + square(mu_y);
    let through_mps = along_mps + state.induced_mps;
    let lambda = through_mps / tip_mps;

    let phi = atan2(along_mps + params.induced_power_factor * state.induced_mps, SECTION * tip_mps);
    let lift_wanted = params.lift_slope_per_rad * (inputs.collective_rad - phi);
    let cl = clamp(lift_wanted, -params.lift_coefficient_max, params.lift_coefficient_max);
    let beyond = lift_wanted - cl;
    let cd = params.drag_coefficient_min
        + params.drag_coefficient_per_lift2 * square(cl)
        // Past the stall the section drags like a plate: what lift is missing shows up as drag.
        + 0.25 * beyond.abs();
    let dynamic = 0.5
        * rho
        * params.solidity
        * area
        * (square(tip_mps) * (1.0 / 3.0 + 0.5 * mu2) + square(through_mps));
    let (sin_phi, cos_phi) = (sin(phi), cos(phi));
    let thrust_n = dynamic * (cl * cos_phi - cd * sin_phi);
    let torque_n_m = dynamic * (cl * sin_phi + cd * cos_phi) * SECTION * params.radius_m;

    let height = max(inputs.hub_height_m / params.radius_m, 0.3);
    let skew2 = mu2 / max(square(lambda), 1e-6);
    let ground = 1.0 - min_half(square(0.25 / height)) / (1.0 + skew2);
    let flow_mps = sqrt(mu2 * square(tip_mps) + square(through_mps));
    let induced_mps2 = (thrust_n * square(ground)
        - 2.0 * rho * area * state.induced_mps * flow_mps)
        / (APPARENT_MASS * rho * area * params.radius_m);

    // Lock number grows with density.
    let lock = params.lock_number * rho / crate::environment::DENSITY_SL_KG_PER_M3;
    let flap_per_s = lock * omega / 16.0;
    let blowback = 2.0 * (4.0 / 3.0 * inputs.collective_rad - lambda);
    let tilt_aft =
        mu_x * blowback - inputs.cyclic_forward_rad - hub_rate.y / flap_per_s + hub_rate.x / omega;
    let tilt_right = -mu_y * blowback - hub_rate.x / flap_per_s - hub_rate.y / omega;
    let stop = |tilt_rad| clamp(tilt_rad, -params.flapping_rad_max, params.flapping_rad_max);
    let (tilt_aft, tilt_right) = (stop(tilt_aft), stop(tilt_right));

    let (a1, b1) = (state.tilt_aft_rad, state.tilt_right_rad);
    // In-plane profile drag opposes the hub's motion in the disc.
    let drag_n = 0.25 * params.solidity * cd * rho * area * square(tip_mps);
    let force = Vec3::<Mast>::new(
        -thrust_n * sin(a1) - drag_n * mu_x,
        thrust_n * sin(b1) - drag_n * mu_y,
        -thrust_n * cos(a1) * cos(b1),
    );
    // The right rotor turns counter-clockwise: the air drags it, and the mast the airframe, the
    // other way round, which is positive about z, down the mast.
    let moment = Vec3::<Mast>::new(
        params.hub_spring_n_m_per_rad * b1,
        params.hub_spring_n_m_per_rad * a1,
        torque_n_m,
    );
    let load = Load::at(body_from_mast * force, arm).with_moment(body_from_mast * moment);

    let rate = Rate {
        induced_mps2,
        tilt_aft_radps: (tilt_aft - a1) * flap_per_s,
        tilt_right_radps: (tilt_right - b1) * flap_per_s,
    };
    let outputs = Outputs {
        load,
        thrust_n,
        torque_n_m,
        power_w: torque_n_m * omega,
        induced_mps: state.induced_mps,
        advance_ratio: sqrt(mu2),
        stalled: u64::from(beyond != 0.0),
    };
    (rate, outputs)
}

fn min_half(x: f64) -> f64 {
    clamp(x, 0.0, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn params() -> Params {
        Params {
            radius_m: 3.81,
            solidity: 0.089,
            lift_slope_per_rad: 5.9,
            lift_coefficient_max: 1.2,
            drag_coefficient_min: 0.0,
            drag_coefficient_per_lift2: 0.0,
            induced_power_factor: 1.0,
            lock_number: 3.83,
            hub_spring_n_m_per_rad: 0.0,
            flapping_rad_max: 0.2,
            polar_inertia_kg_m2: 420.0,
            pivot_m: Vec3::new(7.62, 4.902, 2.54),
            mast_length_m: 1.4225,
            mast_cant_rad: 0.0,
        }
    }

    fn hovering(collective_rad: f64) -> Inputs {
        Inputs {
            motion: Motion {
                cg_m: Vec3::new(7.65, 0.0, 2.074),
                airspeed_mps: Vec3::zero(),
                angular_rate_radps: Vec3::zero(),
                density_kg_per_m3: 1.225,
            },
            mast_tilt_rad: 0.0,
            mast_tilt_rate_radps: 0.0,
            rotor_speed_radps: 61.68,
            collective_rad,
            cyclic_forward_rad: 0.0,
            hub_height_m: 1e9,
        }
    }

    fn settled(params: &Params, inputs: &Inputs) -> (State, Outputs) {
        let mut state = State { induced_mps: 10.0, ..State::default() };
        for _ in 0..20_000 {
            let (rate, _) = rotor(params, &state, inputs);
            state.induced_mps += 1e-3 * rate.induced_mps2;
            state.tilt_aft_rad += 1e-3 * rate.tilt_aft_radps;
            state.tilt_right_rad += 1e-3 * rate.tilt_right_radps;
        }
        let (_, outputs) = rotor(params, &state, inputs);
        (state, outputs)
    }

    #[test]
    fn an_ideal_hovering_rotor_is_the_one_of_momentum_theory() {
        let p = params();
        let (state, out) = settled(&p, &hovering(0.2));
        let ideal_mps = sqrt(out.thrust_n / (2.0 * 1.225 * p.disc_area_m2()));
        assert!((state.induced_mps / ideal_mps - 1.0).abs() < 1e-9);
        assert!((out.power_w / (out.thrust_n * ideal_mps) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn stick_forward_tilts_the_thrust_forward() {
        let mut inputs = hovering(0.2);
        inputs.cyclic_forward_rad = 0.05;
        let (_, out) = settled(&params(), &inputs);
        assert!((out.load.force_n.x / out.thrust_n - 0.05).abs() < 1e-4);
    }

    /// The disc lags behind its mast; rolled, a disc that turns counter-clockwise goes aft as well.
    #[test]
    fn the_disc_stays_behind_when_its_mast_turns() {
        let turning = |roll, pitch, mast_tilt_rate_radps| {
            let mut inputs = Inputs { mast_tilt_rate_radps, ..hovering(0.2) };
            inputs.motion.angular_rate_radps = Vec3::new(roll, pitch, 0.0);
            rotor(&params(), &State::default(), &inputs).0
        };
        assert!(turning(0.0, 0.1, 0.0).tilt_aft_radps < 0.0, "nose up leaves it forward");
        assert!(turning(0.0, 0.0, 0.1).tilt_aft_radps > 0.0, "the nacelle forward leaves it aft");
        let rolled = turning(0.1, 0.0, 0.0);
        assert!(rolled.tilt_right_radps < 0.0 && rolled.tilt_aft_radps > 0.0);
    }

    #[test]
    fn the_right_rotor_drags_the_nose_to_the_right() {
        let (_, out) = settled(&params(), &hovering(0.2));
        let yaw = out.load.moment_n_m.z;
        assert!((yaw / out.torque_n_m - 1.0).abs() < 1e-9);
    }

    #[test]
    fn as_an_aeroplane_the_thrust_points_forward() {
        let mut inputs = hovering(0.2);
        inputs.mast_tilt_rad = crate::math::FRAC_PI_2;
        let (_, out) = settled(&params(), &inputs);
        assert!((out.load.force_n.x / out.thrust_n - 1.0).abs() < 1e-9);
    }

    #[test]
    fn near_the_ground_the_inflow_falls_as_cheeseman_and_bennett_say() {
        let p = params();
        let mut inputs = hovering(0.2);
        inputs.hub_height_m = 0.75 * p.radius_m;
        let (state, out) = settled(&p, &inputs);
        let far_mps = sqrt(out.thrust_n / (2.0 * 1.225 * p.disc_area_m2()));
        // 1 − (1/(4·0.75))² = 8/9.
        assert!((state.induced_mps / far_mps - 8.0 / 9.0).abs() < 1e-9);
    }

    #[test]
    fn the_ground_saves_power() {
        let p = params();
        let far = settled(&p, &hovering(0.2)).1;
        let mut inputs = hovering(0.2);
        inputs.hub_height_m = 0.6 * p.radius_m;
        let near = settled(&p, &inputs).1;
        assert!(near.thrust_n > far.thrust_n);
        assert!(near.power_w / near.thrust_n < far.power_w / far.thrust_n);
    }
}
