//! Rotors: one gimballed proprotor, by blade elements, dynamic inflow and flapping blades.
//!
//! # Equations
//! ```text
//! elements:  forces and flapping moments from pitch, flap, inflow and the hub's motion
//! inflow:    v̇ from thrust and flapping moments              three states         [PETERS]
//! flapping:  β̈ from flapping moments, springs and gyration   gimbal and bending   [JOHNSON]
//! neighbour: the other rotor's wake adds to the flow along the mast                 [CR536]
//! ```
//! Each in its file: [`section`], [`blade`], [`elements`], [`inflow`], [`flapping`], [`bending`], [`other_rotor`]. The
//! elements are evaluated once a tick; inflow and flapping take the tick implicitly, because the flapping's fast
//! roots (2Ω, 123 rad/s, and the elastic ones) are too fast for the rates of the plant. So the block gives its next
//! state.
//! ```text
//! F = (Σ in the hub plane, −T + S)     M = K·tilt by gimbal and stop, Q about the mast
//! ```
//! # Signs
//! Mast axes (x forward, y right, z down the mast); azimuth from aft. A1 and B1 tilt the disc right
//! and forward. Written for the right rotor, which turns counter-clockwise seen from above; the left
//! one is its mirror image.
//! # Assumptions
//! Steady between ticks; rigid in lag and torsion; the in-plane inertia of flapping blades averages out. A
//! gimballed rotor does not pass its gyroscopic moment on: it precesses until the air turns it.

pub mod bending;
pub mod blade;
pub mod elements;
pub mod flapping;
pub mod inflow;
pub mod other_rotor;
pub mod section;
#[cfg(test)]
mod tests;
mod tilt;

use serde::{Deserialize, Serialize};

use crate::frames::{Body, Load, Mast, Rotation, Structural, Vec3};
use crate::mast::TiltedMast;
use crate::math::{PI, max, sin_cos, square};
use crate::motion::Motion;

/// What a rotor is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// R.
    pub radius_m: f64,
    /// σ, thrust-weighted: for blade loadings only.
    pub solidity: f64,
    /// Polar inertia of rotor and hub.
    pub polar_inertia_kg_m2: f64,
    /// Conversion pivot of the right nacelle.
    pub pivot_m: Vec3<Structural>,
    /// Pivot to hub.
    pub mast_length_m: f64,
    /// Outboard cant of the mast as a helicopter.
    pub mast_cant_rad: f64,
    /// Blades.
    pub blade: blade::Params,
    /// Inflow.
    pub inflow: inflow::Params,
    /// Hub and flapping.
    pub flapping: flapping::Params,
    /// How blades bend.
    pub bending: bending::Params,
    /// What the other rotor's wake does.
    pub other_rotor: other_rotor::Params,
}

impl Params {
    /// I_h: the hub about a diameter, a flat ring of what the polar inertia has beyond the blades'.
    pub fn hub_inertia_kg_m2(&self) -> f64 {
        let blades_kg_m2 = self.blade.count * self.flapping.blade_inertia_kg_m2;
        0.5 * max(0.0, self.polar_inertia_kg_m2 - blades_kg_m2)
    }

    /// The blade's elements and inertias.
    pub fn blade(&self) -> blade::Blade {
        // Of the hub's tilt each blade has its share, as of the moments: multiblade sums over b blades are b/2.
        let hub_share_kg_m2 = self.hub_inertia_kg_m2() / 1.5;
        let blade_kg_m2 = self.flapping.blade_inertia_kg_m2;
        let inertias = self.bending.inertias(blade_kg_m2, hub_share_kg_m2, self.radius_m);
        let delta3_rad = self.flapping.delta3_rad;
        blade::blade(&self.blade, self.radius_m, delta3_rad, &self.bending, inertias)
    }

    /// A.
    pub fn disc_area_m2(&self) -> f64 {
        PI * square(self.radius_m)
    }

    /// The right mast, tilted.
    pub fn mast(&self, tilt_rad: f64) -> TiltedMast {
        TiltedMast::new(tilt_rad, self.mast_cant_rad)
    }

    /// Right hub, from the centre of gravity.
    pub fn hub_from_cg(&self, cg_m: Vec3<Structural>, mast: &TiltedMast) -> Vec3<Body> {
        self.pivot_m.from_cg(cg_m) + mast.thrust_axis * self.mast_length_m
    }
}

/// What a rotor remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Air it moves.
    pub inflow: inflow::State,
    /// Tilt, coning, bending.
    pub flapping: flapping::State,
}

/// What a rotor reads, as the right rotor sees it.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// Speed of sound.
    pub sound_speed_mps: f64,
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
    /// A1, to the right: outboard.
    pub cyclic_outboard_rad: f64,
    /// Hub over the ground.
    pub hub_height_m: f64,
    /// v0 of the other rotor.
    pub other_induced_mps: f64,
}

/// What a rotor gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// On the airframe, about the centre of gravity.
    pub load: Load,
    /// T, along the mast.
    pub thrust_n: f64,
    /// Q, needed at the mast.
    pub torque_n_m: f64,
    /// Q·Ω.
    pub power_w: f64,
    /// Mean induced velocity as the airframe meets it, the other rotor's at this one with it, against the
    /// thrust axis positive.
    pub induced_mps: f64,
    /// C_T = T/(ρA(ΩR)²); 0 at rest.
    pub thrust_coefficient: f64,
    /// C_T/σ.
    pub blade_loading: f64,
    /// μ.
    pub advance_ratio: f64,
    /// β0: how far the tips are out of the hub plane, around the turn, over the radius.
    pub coning_rad: f64,
    /// a1, tip path tilted aft of the hub plane: the first harmonic of that.
    pub tilt_aft_rad: f64,
    /// b1, tip path tilted right (outboard).
    pub tilt_outboard_rad: f64,
    /// Part of the outer blades, once around, that is stalled.
    pub stalled_norm: f64,
    /// 1 when a tenth of that is.
    pub stalled: u64,
    /// 1 while the gimbal is on its stop.
    pub on_stop: u64,
    /// 1 while it descends into its own wake.
    pub in_vortex_ring: u64,
}

/// The hub's motion, mast axes.
struct Hub {
    body_from_mast: Rotation<Body, Mast>,
    arm_m: Vec3<Body>,
    velocity_mps: Vec3<Mast>,
    rate_radps: Vec3<Mast>,
}

impl Hub {
    fn new(params: &Params, inputs: &Inputs) -> Self {
        let mast = params.mast(inputs.mast_tilt_rad);
        let axis = mast.thrust_axis;
        let forward = Vec3::<Body>::new(mast.cos_tilt, 0.0, mast.sin_tilt);
        let body_from_mast: Rotation<Body, Mast> =
            Rotation::from_axes(forward, (-axis).cross(forward), -axis);
        let mast_from_body = body_from_mast.inverse();
        let arm_m = params.hub_from_cg(inputs.motion.cg_m, &mast);
        // Tilting forward is a nose-down turn of the nacelle about its pivot.
        let nacelle_rate = Vec3::<Body>::new(0.0, -inputs.mast_tilt_rate_radps, 0.0);
        let velocity =
            inputs.motion.velocity_at(arm_m) + nacelle_rate.cross(axis * params.mast_length_m);
        Self {
            body_from_mast,
            arm_m,
            velocity_mps: mast_from_body * velocity,
            rate_radps: mast_from_body * (inputs.motion.angular_rate_radps + nacelle_rate),
        }
    }
}

/// Loads of the rotor now, and the rotor one tick later.
///
/// `blade` is the one of [`Params::blade`]: the same for both rotors, so it is made once.
pub fn evaluate(
    params: &Params,
    blade: &blade::Blade,
    state: &State,
    inputs: &Inputs,
) -> (State, Outputs) {
    let hub = Hub::new(params, inputs);
    let free = elements::Flow {
        omega_radps: inputs.rotor_speed_radps - hub.rate_radps.z,
        forward_mps: hub.velocity_mps.x,
        right_mps: hub.velocity_mps.y,
        along_mps: -hub.velocity_mps.z,
        density_kg_per_m3: inputs.motion.density_kg_per_m3,
        sound_speed_mps: inputs.sound_speed_mps,
    };
    let spacing_m = 2.0 * hub.arm_m.y;
    let of_other = other_rotor::factor(&params.other_rotor, &free, spacing_m, params.radius_m);
    let flow =
        elements::Flow { along_mps: free.along_mps + of_other * inputs.other_induced_mps, ..free };
    let flap = &state.flapping;
    let gimbal = flapping::gimbal(&params.flapping, flap);
    let pitch = elements::Pitch {
        collective_rad: inputs.collective_rad,
        forward_rad: inputs.cyclic_forward_rad - blade.tan_delta3 * gimbal.right_rad,
        right_rad: inputs.cyclic_outboard_rad - blade.tan_delta3 * gimbal.aft_rad,
    };
    let through = inflow::disc_flow(&state.inflow, &flow);
    let ground = inflow::ground(&params.inflow, &through, inputs.hub_height_m, params.radius_m);
    let induced = inflow::induced(
        &params.inflow,
        &state.inflow,
        &through,
        &flow,
        blade,
        (sin_cos(inputs.collective_rad), params.blade.count),
        (ground.disc, params.radius_m),
    );
    let curve = flap.curve(params.flapping.precone_rad);
    let blade_loads = elements::elements(blade, &flow, &pitch, &curve, &induced);

    let inertias = &blade.inertias;
    let next = advance((params, inertias), state, &hub, &flow, &through, &gimbal, &blade_loads);
    let swinging_n = flapping::swinging_n(inertias, flap, &next.flapping);
    let wake = Wake {
        induced_mps: ground.wake * (state.inflow.mean_mps + of_other * inputs.other_induced_mps),
        in_vortex_ring: through.in_vortex_ring,
    };
    (next, outputs(params, state, inputs, &hub, &gimbal, (&blade_loads, swinging_n), &wake))
}

/// What the airframe and the crew notice of the rotor's inflow.
struct Wake {
    induced_mps: f64,
    in_vortex_ring: bool,
}

fn advance(
    (params, inertias): (&Params, &bending::Inertias),
    state: &State,
    hub: &Hub,
    flow: &elements::Flow,
    through: &inflow::DiscFlow,
    gimbal: &flapping::Gimbal,
    blade_loads: &elements::BladeLoads,
) -> State {
    let blades = params.blade.count;
    let disc_loads = inflow::DiscLoads {
        thrust_n: blades * blade_loads.up_n,
        aft_n_m: 0.5 * blades * blade_loads.straight.cos_n_m,
        right_n_m: 0.5 * blades * blade_loads.straight.sin_n_m,
    };
    let flapping = flapping::Inputs {
        omega_radps: flow.omega_radps,
        hub_pitch_radps: hub.rate_radps.y,
        hub_roll_radps: hub.rate_radps.x,
        straight: blade_loads.straight,
        elastic: blade_loads.elastic,
        damping: blade_loads.damping,
    };
    State {
        inflow: inflow::advance(&state.inflow, through, flow, &disc_loads, params.radius_m),
        flapping: flapping::advance(&params.flapping, inertias, &state.flapping, gimbal, &flapping),
    }
}

/// Loads and what can be observed.
fn outputs(
    params: &Params,
    state: &State,
    inputs: &Inputs,
    hub: &Hub,
    gimbal: &flapping::Gimbal,
    (blade_loads, swinging_n): (&elements::BladeLoads, f64),
    wake: &Wake,
) -> Outputs {
    let blades = params.blade.count;
    let (thrust_n, torque_n_m) = (blades * blade_loads.up_n, blades * blade_loads.torque_n_m);
    let up_n = thrust_n - blades * swinging_n;
    let force =
        Vec3::<Mast>::new(blades * blade_loads.forward_n, blades * blade_loads.right_n, -up_n);
    // The right rotor turns counter-clockwise: the air drags it, and the mast the airframe, the
    // other way round, which is positive about z, down the mast.
    let moment = Vec3::<Mast>::new(gimbal.rolling_n_m, gimbal.pitching_n_m, torque_n_m);
    let load =
        Load::at(hub.body_from_mast * force, hub.arm_m).with_moment(hub.body_from_mast * moment);
    let tip_mps = max(inputs.rotor_speed_radps * params.radius_m, 1.0);
    let pressure_pa = inputs.motion.density_kg_per_m3 * square(tip_mps);
    let thrust_coefficient = thrust_n / (pressure_pa * params.disc_area_m2());
    let in_plane = square(hub.velocity_mps.x) + square(hub.velocity_mps.y);
    Outputs {
        load,
        thrust_n,
        torque_n_m,
        power_w: torque_n_m * inputs.rotor_speed_radps,
        induced_mps: wake.induced_mps,
        thrust_coefficient,
        blade_loading: thrust_coefficient / params.solidity,
        advance_ratio: crate::math::sqrt(in_plane) / tip_mps,
        coning_rad: state.flapping.coning_rad,
        tilt_aft_rad: state.flapping.aft_rad,
        tilt_outboard_rad: state.flapping.right_rad,
        stalled_norm: blade_loads.stalled_norm,
        stalled: u64::from(blade_loads.stalled_norm > 0.1),
        on_stop: u64::from(gimbal.on_stop),
        in_vortex_ring: u64::from(wake.in_vortex_ring),
    }
}
