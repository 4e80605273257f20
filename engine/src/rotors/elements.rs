//! Blade elements: forces and flapping moments of one rotor, averaged over fixed azimuths.
//!
//! # Equations
//! ```text
//! e_r = (−cos ψ, sin ψ)   e_ψ = (sin ψ, cos ψ)          in the hub plane, x forward and y right
//! β = β0 − a1·cos ψ − b1·sin ψ                          flap, up positive
//! θ = θ¾ + twist(r) − A1·cos ψ − B1·sin ψ − tan δ3·(β_gimbal)
//! U_T = Ω·r + V·e_ψ − s(r)                              against the air, in the hub plane
//! U_P = Vz·cos β − V·e_r·sin β + r·β̇ + v(r, ψ)          against the air, along the blade's normal
//! sin α = (sin θ·U_T − cos θ·U_P)/U     cos α = (cos θ·U_T + sin θ·U_P)/U
//! dFn = ½ρcU·(cl·U_T − cd·U_P)·dr       dFt = ½ρcU·(cl·U_P + cd·U_T)·dr
//! dFr = −½ρcU·cd·(V·e_r)·dr                             friction along the span
//! ```
//! No angle of the flow is taken to be small: the sine and cosine of α come from the velocities, so
//! that reverse flow, descent and axial flight at any speed are the same equations.
//! # Signs
//! ψ from aft, counter-clockwise from above: the right blade advances. β̇ is the blade's rate in
//! inertial space: the hub's own roll and pitch are in it.
//! # Assumptions
//! Eight fixed azimuths stand for a turn of the blades: the loads are steady when the flight is.

use super::blade::{Blade, STATIONS};
use super::flapping;
use super::section::LIFT_SLOPE;
use crate::lanes::{LANES, Lanes, min, sin_cos, sqrt, square};

/// Azimuths in a turn.
pub const AZIMUTHS: usize = 8;
const DIAGONAL: f64 = core::f64::consts::FRAC_1_SQRT_2;
/// cos ψ and sin ψ of the azimuths that are evaluated together.
const TURN: [[[f64; LANES]; 2]; AZIMUTHS / LANES] = [
    [[1.0, DIAGONAL, 0.0, -DIAGONAL], [0.0, DIAGONAL, 1.0, DIAGONAL]],
    [[-1.0, -DIAGONAL, 0.0, DIAGONAL], [0.0, -DIAGONAL, -1.0, -DIAGONAL]],
];

/// What all elements have in common.
#[derive(Clone, Copy, Debug)]
pub struct Flow {
    /// Ω, the hub's own turn about the mast included.
    pub omega_radps: f64,
    /// Hub through the air, mast axes: forward.
    pub forward_mps: f64,
    /// To the right.
    pub right_mps: f64,
    /// Along the thrust.
    pub along_mps: f64,
    /// ρ.
    pub density_kg_per_m3: f64,
    /// Speed of sound.
    pub sound_speed_mps: f64,
}

/// How the blades are pitched.
#[derive(Clone, Copy, Debug)]
pub struct Pitch {
    /// θ¾.
    pub collective_rad: f64,
    /// B1, δ3 of the gimbal included.
    pub forward_rad: f64,
    /// A1, δ3 of the gimbal included.
    pub right_rad: f64,
}

/// Air that the rotor itself moves, down positive.
#[derive(Clone, Copy, Debug)]
pub struct Induced {
    /// Around the turn, by station.
    pub mean_mps: [f64; STATIONS],
    /// With the rotation, by station.
    pub swirl_mps: [f64; STATIONS],
    /// Part of each station's area that lifts.
    pub lifting: [f64; STATIONS],
    /// More of it aft, per radius.
    pub aft_per_s: f64,
    /// More of it on the right, per radius.
    pub right_per_s: f64,
}

/// Averages over the turn, of one blade.
#[derive(Clone, Copy, Debug, Default)]
pub struct BladeLoads {
    /// Along the mast, up.
    pub up_n: f64,
    /// Forward in the hub plane.
    pub forward_n: f64,
    /// To the right in the hub plane.
    pub right_n: f64,
    /// Against the rotation.
    pub torque_n_m: f64,
    /// Flapping moment.
    pub flap_n_m: f64,
    /// Its part with cos ψ: amplitude.
    pub flap_cos_n_m: f64,
    /// Its part with sin ψ: amplitude.
    pub flap_sin_n_m: f64,
    /// Flapping moment lost per flapping rate, roughly.
    pub damping_n_m_s: f64,
    /// Part of the outer blade that is stalled.
    pub stalled_norm: f64,
}

/// All elements, once around.
pub fn elements(
    blade: &Blade,
    flow: &Flow,
    pitch: &Pitch,
    flap: &flapping::State,
    induced: &Induced,
) -> BladeLoads {
    let mut loads = BladeLoads::default();
    for [c, s] in TURN {
        azimuths(blade, flow, pitch, flap, induced, (c.into(), s.into()), &mut loads);
    }
    let each = 1.0 / AZIMUTHS as f64;
    let half_density = 0.5 * flow.density_kg_per_m3;
    let load = half_density * each;
    BladeLoads {
        up_n: load * loads.up_n,
        forward_n: load * loads.forward_n,
        right_n: load * loads.right_n,
        torque_n_m: load * loads.torque_n_m,
        flap_n_m: load * loads.flap_n_m,
        flap_cos_n_m: 2.0 * load * loads.flap_cos_n_m,
        flap_sin_n_m: 2.0 * load * loads.flap_sin_n_m,
        damping_n_m_s: load * LIFT_SLOPE * loads.damping_n_m_s,
        stalled_norm: each * loads.stalled_norm,
    }
}

/// Adds the elements at a few azimuths, without ½ρ: each azimuth in its lane.
///
/// The lanes are added up in the order of the azimuths, so that it is the sum that the azimuths one
/// after the other would give.
fn azimuths(
    blade: &Blade,
    flow: &Flow,
    pitch: &Pitch,
    flap: &flapping::State,
    induced: &Induced,
    (c, s): (Lanes, Lanes),
    loads: &mut BladeLoads,
) {
    let (sin_theta, cos_theta) =
        sin_cos(pitch.collective_rad - pitch.right_rad * c - pitch.forward_rad * s);
    let beta = flap.coning_rad - flap.aft_rad * c - flap.right_rad * s;
    // Flapping stays within the stops and what blades bend: two terms are exact to 1e-4.
    let (sin_beta, cos_beta) = (beta * (1.0 - square(beta) / 6.0), 1.0 - 0.5 * square(beta));
    // What the turn makes of the tilt adds to its own rate.
    let beta_radps = flap.coning_radps - (flap.aft_radps + flow.omega_radps * flap.right_rad) * c
        + (flow.omega_radps * flap.aft_rad - flap.right_radps) * s;
    let along_blade_mps = flow.right_mps * s - flow.forward_mps * c;
    let turning_mps = flow.forward_mps * s + flow.right_mps * c;
    let through_mps = flow.along_mps * cos_beta - along_blade_mps * sin_beta;
    let through_per_s = beta_radps + induced.aft_per_s * c + induced.right_per_s * s;
    let per_sound = 1.0 / flow.sound_speed_mps;

    let zero = Lanes::from(0.0);
    let (mut normal, mut tangential, mut radial) = (zero, zero, zero);
    let (mut torque, mut moment, mut damping) = (zero, zero, zero);
    let mut stalled = zero;
    for (i, station) in blade.stations.iter().enumerate() {
        let r = station.radius_m;
        let u_t = flow.omega_radps * r + turning_mps - induced.swirl_mps[i];
        let u_p = through_mps + through_per_s * r + induced.mean_mps[i];
        // The tiny length keeps still air from dividing by nothing.
        let u = sqrt(u_t * u_t + u_p * u_p + 1e-12);
        let per_u = 1.0 / u;
        let sin_pitch = sin_theta * station.cos_twist + cos_theta * station.sin_twist;
        let cos_pitch = cos_theta * station.cos_twist - sin_theta * station.sin_twist;
        let sin_alpha = (sin_pitch * u_t - cos_pitch * u_p) * per_u;
        let cos_alpha = (cos_pitch * u_t + sin_pitch * u_p) * per_u;
        let turn = r * flow.omega_radps * per_u;
        let section = blade.regions[station.region].coefficients(
            (sin_alpha, cos_alpha),
            u * per_sound,
            station.delay * min(turn * turn, 1.0),
            station.rise_mach,
        );
        let lift = induced.lifting[i] * section.lift;
        let scale = station.area_m2 * u;
        let f_n = scale * (lift * u_t - section.drag * u_p);
        let f_t = scale * (lift * u_p + section.drag * u_t);
        normal += f_n;
        tangential += f_t;
        radial -= scale * section.drag;
        torque += r * f_t;
        moment += r * f_n;
        damping += r * r * scale;
        if station.region > 0 {
            stalled += section.stalled.above(0.3).select(1.0, 0.0);
        }
    }
    let outward = radial * along_blade_mps - normal * sin_beta;
    let add = |sum: &mut f64, azimuths: Lanes| azimuths.to_array().iter().for_each(|x| *sum += x);
    add(&mut loads.up_n, normal * cos_beta);
    add(&mut loads.forward_n, -outward * c - tangential * s);
    add(&mut loads.right_n, outward * s - tangential * c);
    add(&mut loads.torque_n_m, torque);
    add(&mut loads.flap_n_m, moment);
    add(&mut loads.flap_cos_n_m, moment * c);
    add(&mut loads.flap_sin_n_m, moment * s);
    add(&mut loads.damping_n_m_s, damping);
    // One by one: a sum of fifths is not a number of them times a fifth.
    for count in stalled.to_array() {
        (0..count as u32).for_each(|_| loads.stalled_norm += 1.0 / 5.0);
    }
}
