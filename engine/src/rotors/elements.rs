//! Blade elements: forces and flapping moments of one rotor, averaged over fixed azimuths.
//!
//! # Equations
//! ```text
//! e_r = (−cos ψ, sin ψ)   e_ψ = (sin ψ, cos ψ)          in the hub plane, x forward and y right
//! w = r·(β_p + γ) + R·φ(r)·q     β = dw/dr              the blade's curve and its slope, up positive
//! θ = θ¾ + twist(r) − A1·cos ψ − B1·sin ψ − tan δ3·(β_gimbal)
//! U_T = Ω·r + V·e_ψ − s(r)                              against the air, in the hub plane
//! U_P = Vz·cos β − V·e_r·sin β + ẇ + v(r, ψ)            against the air, along the blade's normal
//! sin α = (sin θ·U_T − cos θ·U_P)/U     cos α = (cos θ·U_T + sin θ·U_P)/U
//! dFn = ½ρcU·(cl·U_T − cd·U_P)·dr       dFt = ½ρcU·(cl·U_P + cd·U_T)·dr
//! dFr = −½ρcU·cd·(V·e_r)·dr                             friction along the span
//! ```
//! No angle of the flow is taken to be small: the sine and cosine of α come from the velocities, so
//! that reverse flow, descent and axial flight at any speed are the same equations.
//! # Signs
//! ψ from aft, counter-clockwise from above: the right blade advances. ẇ is the blade's velocity in
//! inertial space: the hub's own roll and pitch are in it.
//! # Assumptions
//! Eight fixed azimuths stand for a turn of the blades: the loads are steady when the flight is.

use super::blade::{Blade, STATIONS};
use super::flapping::{Curve, Damping, Harmonics, Moment};
use super::section::LIFT_SLOPE;
use crate::lanes::{LANES, Lanes, clamp, min, sin_cos, sqrt, square};

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
    /// F_γ: flapping moment.
    pub straight: Moment,
    /// F_q: moment in the shape in which blades bend.
    pub elastic: Moment,
    /// D.
    pub damping: Damping,
    /// Part of the outer blade that is stalled.
    pub stalled_norm: f64,
}

/// All elements, once around.
pub fn elements(
    blade: &Blade,
    flow: &Flow,
    pitch: &Pitch,
    curve: &Curve,
    induced: &Induced,
) -> BladeLoads {
    let mut loads = BladeLoads::default();
    for [c, s] in TURN {
        azimuths(blade, flow, pitch, curve, induced, (c.into(), s.into()), &mut loads);
    }
    let each = 1.0 / AZIMUTHS as f64;
    let half_density = 0.5 * flow.density_kg_per_m3;
    let load = half_density * each;
    let moment = |sum: &Moment| Moment {
        mean_n_m: load * sum.mean_n_m,
        cos_n_m: 2.0 * load * sum.cos_n_m,
        sin_n_m: 2.0 * load * sum.sin_n_m,
    };
    let lost = load * LIFT_SLOPE;
    BladeLoads {
        up_n: load * loads.up_n,
        forward_n: load * loads.forward_n,
        right_n: load * loads.right_n,
        torque_n_m: load * loads.torque_n_m,
        straight: moment(&loads.straight),
        elastic: moment(&loads.elastic),
        damping: Damping {
            straight_n_m_s: lost * loads.damping.straight_n_m_s,
            coupled_n_m_s: lost * loads.damping.coupled_n_m_s,
            elastic_n_m_s: lost * loads.damping.elastic_n_m_s,
        },
        stalled_norm: each * loads.stalled_norm,
    }
}

/// No blade flaps or bends further and is whole, rad: what is beyond, the air does not see.
const FLAP_RAD_MAX: f64 = 0.5;

/// Displacement and its rate at some azimuths; what the turn makes of the tilt adds to its own rate.
fn around(shape: &Harmonics, omega_radps: f64, (c, s): (Lanes, Lanes)) -> (Lanes, Lanes) {
    let flap = shape.mean_rad - shape.aft_rad * c - shape.right_rad * s;
    (
        clamp(flap, -FLAP_RAD_MAX, FLAP_RAD_MAX),
        shape.mean_radps - (shape.aft_radps + omega_radps * shape.right_rad) * c
            + (omega_radps * shape.aft_rad - shape.right_radps) * s,
    )
}

/// Adds the elements at a few azimuths, without ½ρ: each azimuth in its lane.
///
/// The lanes are added up in the order of the azimuths, so that it is the sum that the azimuths one
/// after the other would give.
fn azimuths(
    blade: &Blade,
    flow: &Flow,
    pitch: &Pitch,
    curve: &Curve,
    induced: &Induced,
    (c, s): (Lanes, Lanes),
    loads: &mut BladeLoads,
) {
    let (sin_theta, cos_theta) =
        sin_cos(pitch.collective_rad - pitch.right_rad * c - pitch.forward_rad * s);
    let (straight_rad, straight_radps) = around(&curve.straight, flow.omega_radps, (c, s));
    let (elastic_rad, elastic_radps) = around(&curve.elastic, flow.omega_radps, (c, s));
    let along_blade_mps = flow.right_mps * s - flow.forward_mps * c;
    let turning_mps = flow.forward_mps * s + flow.right_mps * c;
    let through_per_s = straight_radps + induced.aft_per_s * c + induced.right_per_s * s;
    let per_sound = 1.0 / flow.sound_speed_mps;

    let mut sums = Sums::new();
    let mut stalled = Lanes::from(0.0);
    for (i, station) in blade.stations.iter().enumerate() {
        let r = station.radius_m;
        let beta = straight_rad + station.slope_norm * elastic_rad;
        // Flapping stays within the stops and what blades bend: two terms are exact to 1e-4.
        let (beta2, along_mps) = (square(beta), flow.along_mps);
        let (sin_beta, cos_beta) = (beta * (1.0 - beta2 * (1.0 / 6.0)), 1.0 - 0.5 * beta2);
        let through_mps = along_mps * cos_beta - along_blade_mps * sin_beta;
        let u_t = flow.omega_radps * r + turning_mps - induced.swirl_mps[i];
        let u_p = through_mps
            + through_per_s * r
            + elastic_radps * station.displacement_m
            + induced.mean_mps[i];
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
        sums.up += f_n * cos_beta;
        sums.inward += f_n * sin_beta;
        sums.tangential += f_t;
        sums.rubbing += scale * section.drag;
        sums.torque += r * f_t;
        sums.straight += r * f_n;
        sums.elastic += station.displacement_m * f_n;
        let (swept, bent) = (r * scale, station.displacement_m * scale);
        sums.damping[0] += r * swept;
        sums.damping[1] += r * bent;
        sums.damping[2] += station.displacement_m * bent;
        if station.region > 0 {
            stalled += section.stalled.above(0.3).select(1.0, 0.0);
        }
    }
    sums.add_to(loads, along_blade_mps, (c, s));
    // One by one: a sum of fifths is not a number of them times a fifth.
    for count in stalled.to_array() {
        (0..count as u32).for_each(|_| loads.stalled_norm += 1.0 / 5.0);
    }
}

/// Sums over a blade's elements, without ½ρ, each azimuth in its lane.
struct Sums {
    up: Lanes,
    inward: Lanes,
    tangential: Lanes,
    rubbing: Lanes,
    torque: Lanes,
    straight: Lanes,
    elastic: Lanes,
    damping: [Lanes; 3],
}

impl Sums {
    #[inline(always)]
    fn new() -> Self {
        let zero = Lanes::from(0.0);
        Self {
            up: zero,
            inward: zero,
            tangential: zero,
            rubbing: zero,
            torque: zero,
            straight: zero,
            elastic: zero,
            damping: [zero; 3],
        }
    }

    /// Adds all azimuths up, in hub axes.
    #[inline(always)]
    fn add_to(self, loads: &mut BladeLoads, along_blade_mps: Lanes, (c, s): (Lanes, Lanes)) {
        let outward = -self.rubbing * along_blade_mps - self.inward;
        let add =
            |sum: &mut f64, azimuths: Lanes| azimuths.to_array().iter().for_each(|x| *sum += x);
        add(&mut loads.up_n, self.up);
        add(&mut loads.forward_n, -outward * c - self.tangential * s);
        add(&mut loads.right_n, outward * s - self.tangential * c);
        add(&mut loads.torque_n_m, self.torque);
        for (moment, of_blade) in
            [(&mut loads.straight, self.straight), (&mut loads.elastic, self.elastic)]
        {
            add(&mut moment.mean_n_m, of_blade);
            add(&mut moment.cos_n_m, of_blade * c);
            add(&mut moment.sin_n_m, of_blade * s);
        }
        let [straight, coupled, elastic] = self.damping;
        add(&mut loads.damping.straight_n_m_s, straight);
        add(&mut loads.damping.coupled_n_m_s, coupled);
        add(&mut loads.damping.elastic_n_m_s, elastic);
    }
}
