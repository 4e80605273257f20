//! Inflow: the air that the rotor moves, in three states and a radial shape.
//!
//! # Equations
//! ```text
//! R·M·v̇ + diag(V_T, V, V)·L0⁻¹·v = F/(ρA)      v = (v0, vs, vc)                      [PETERS]
//! F = (T, Ms/R, Mc/R)              loads of the air on the disc; with sin ψ, with cos ψ
//! M = diag(128/(75π), 64/(45π), 64/(45π))
//! L0 = [1/2, 0, −bX; 0, 2(1 + X²), 0; bX, 0, 2(1 − X²)]        b = 15π/64, X = tan(χ/2)
//! V_T = √(μ² + V_m²)     V = (μ² + (Vc + v0)(Vc + 2v0))/V_T, V_T ≤ V ≤ 2V_T
//! V_m = |Vc + v0|, but v0·g(Vc/v0) where the rotor descends into its wake        [LEISHMAN, TP213477]
//! v(r, ψ) = G·(κ·(1 + f·s)·(v0 + k·(v_r − v̄_r)) + r/R·(vc·cos ψ + vs·sin ψ))
//! v_r·(|V| + v_r) = bcΩ·U·cl(r, v_r)/(8π)       annulus by annulus                     [GESSOW]
//! v̄_r·(|V| + |v̄_r|) = mean over the disc of v_r·(|V| + |v_r|)
//! s(r) = v·Ωr·(Vc + v)/((Ωr)² + (Vc + v)²)           swirl: v is square to the blade's path
//! B = 1 − 2·ln 2/b·v0/√((ΩR)² + (Vc + v0)²)          lift ends there                     [BETZ]
//! k = V_m²/(V_m² + μ²)                              in edgewise flight the shape fades out
//! s = v0²/(v0² + Vc² + μ²)                           still air: the fountain stands
//! G = 1 − k·(1 − 1/(0.9926 + 0.0379·(2R/z)²))        ground                             [HAYDEN]
//! W = 1 − k·(1 − √(D(z/2R)/D(∞)))                    wake at the wing near ground     [CR176970]
//! ```
//! # Signs
//! Down the mast positive; Vc, the hub's speed along the thrust, positive in a climb. Aft of the
//! wind means downwind: there the air that goes down is more.
//! # Assumptions
//! Pitt and Peters' states carry the mean and the first harmonics. How the mean spreads over the
//! radius follows at once: a blade twisted for the aeroplane loads its root in hover, and annular
//! momentum theory says by how much. The shape adds nothing to the mean momentum.
//! Where the wakes of both rotors meet over the fuselage they rise, and the rotors breathe them in
//! again: f, which hover over the wing costs beyond the rotor alone. Any wind blows it away; how
//! fast, by its share of the velocity, is an assumption.
//! Hayden's ground is the mean of helicopters in flight; the image of a lone source (Cheeseman and
//! Bennett) gives half of it. Both fade with the wake's skew, as Cheeseman and Bennett have it. The
//! ground also spreads the wake before it meets the wing: download falls faster than the inflow.
//! Betz's tip loss is that of the hover, where all that goes through the disc is induced. Counted with
//! the whole inflow it would take a fifth of the blade as an aeroplane, where annular theory with
//! Prandtl's factor in the momentum leaves a twentieth; counted with the induced part it takes nothing.
//! Between a slow descent and the windmill brake state, momentum theory has no answer or three; g is
//! the measured mean. Its shape over Vc/v0 has one root for every thrust: there is no jump.

use serde::{Deserialize, Serialize};

use super::blade::{Blade, Group, STATIONS};
use super::elements::{Flow, Induced};
use super::section::LIFT_SLOPE;
use crate::STEP_S;
use crate::lanes::{self, LANES, Lanes};
use crate::math::{PI, clamp, max, min, sqrt, square};
use crate::table::Table1;
use crate::table::axis::HubHeight;

/// Apparent mass of the mean.
const APPARENT_MASS: f64 = 128.0 / (75.0 * PI);
/// Apparent inertia of the harmonics.
const APPARENT_INERTIA: f64 = 64.0 / (45.0 * PI);
/// b.
const SKEW: f64 = 15.0 * PI / 64.0;
/// 2·ln 2.
const BETZ: f64 = 2.0 * core::f64::consts::LN_2;
/// Keeps still air from dividing by nothing, m/s.
const STILL_MPS: f64 = 1e-6;

/// How the rotor's inflow differs from the ideal.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// κ: losses that shape, harmonics, swirl and tip do not hold: contraction, single blades' wakes.
    pub induced_power_factor: f64,
    /// f: more of it in hover over the wing and beside the other rotor.
    pub recirculation: f64,
    /// Download over that far from the ground, over the hub's height in rotor diameters.
    pub download_near_ground: Table1<HubHeight>,
}

/// Velocities in the disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// v0.
    pub mean_mps: f64,
    /// vc: more of it at the aft rim, as much less at the fore rim.
    pub aft_mps: f64,
    /// vs: more of it at the right rim.
    pub right_mps: f64,
}

/// What the air feels of the rotor.
#[derive(Clone, Copy, Debug)]
pub struct DiscLoads {
    /// T.
    pub thrust_n: f64,
    /// Mc: of the thrust aft of the hub.
    pub aft_n_m: f64,
    /// Ms: of the thrust right of the hub.
    pub right_n_m: f64,
}

/// How the air passes through the disc.
#[derive(Clone, Copy, Debug)]
pub struct DiscFlow {
    /// μ as a speed.
    pub edgewise_mps: f64,
    /// V_m.
    pub through_mps: f64,
    /// V_T.
    pub total_mps: f64,
    /// Whether the rotor descends into its own wake.
    pub in_vortex_ring: bool,
}

impl DiscFlow {
    /// k: 1 where the air goes along the mast, 0 where it goes across.
    fn axial(&self) -> f64 {
        let along = square(self.through_mps);
        along / (along + square(self.edgewise_mps) + STILL_MPS)
    }
}

/// (−Vc/v0, g): the mean inflow of a descent as g = (vh/v0)² over Vc/v0; x = Vc/vh.
///
/// - To x = −0.2 momentum theory, v0/vh = −x/2 + √(x²/4 + 1), here the straight line g = 1 + Vc/v0:
///   the wake still leaves, and hover is no corner, the rotor damping small motions up and down alike.
/// - Beyond x = −0.7 Leishman's fit to measurements, v0/vh = 1 − 1.125x − 1.372x² − 1.718x³ − 0.655x⁴
///   for −2 < x < 0. At hover its slope would be −1.125 against momentum theory's −½: v0 would grow by
///   more than Vc falls, and a descent that begins would find no damping.
/// - Between them a smooth step, which takes v0 + Vc to its first minimum near x = −0.45: there the
///   damping of heave ends, as it does in the flights of helicopters and a tilt-rotor \[TP213477\].
const DESCENT: [(f64, f64); 13] = [
    (0.0, 1.0),
    (0.181, 0.819),
    (0.256, 0.729),
    (0.3182, 0.634),
    (0.369, 0.546),
    (0.413, 0.473),
    (0.452, 0.418),
    (0.551, 0.303),
    (0.720, 0.231),
    (0.956, 0.298),
    (1.326, 0.487),
    (1.949, 0.949),
    (2.0, 1.0),
];

fn descent(ratio: f64) -> f64 {
    let i = DESCENT.iter().position(|&(end, _)| ratio <= end).unwrap_or(DESCENT.len() - 1).max(1);
    let ((x0, y0), (x1, y1)) = (DESCENT[i - 1], DESCENT[i]);
    y0 + (ratio - x0) * (y1 - y0) / (x1 - x0)
}

/// How the air passes through the disc.
pub fn disc_flow(state: &State, flow: &Flow) -> DiscFlow {
    let (v, climb_mps) = (state.mean_mps, flow.along_mps);
    let edgewise_mps = sqrt(square(flow.forward_mps) + square(flow.right_mps));
    // The wake is met when the rotor moves against what it induces, slower than twice that.
    let meets = climb_mps * v < 0.0 && climb_mps.abs() < 2.0 * v.abs();
    let ratio = if meets { -climb_mps / v } else { 0.0 };
    let through_mps = if meets { v.abs() * descent(ratio) } else { (climb_mps + v).abs() };
    DiscFlow {
        edgewise_mps,
        through_mps,
        total_mps: sqrt(square(edgewise_mps) + square(through_mps)),
        in_vortex_ring: meets && (0.35..1.3).contains(&ratio) && edgewise_mps < v.abs(),
    }
}

/// Velocities one tick later, implicitly: no speed of the flow is too fast for the step.
pub fn advance(
    state: &State,
    through: &DiscFlow,
    flow: &Flow,
    loads: &DiscLoads,
    radius_m: f64,
) -> State {
    let DiscFlow { edgewise_mps, through_mps, total_mps, .. } = *through;
    let x = edgewise_mps / (total_mps + through_mps + STILL_MPS);
    // Downwind: aft in forward flight; anywhere, without wind.
    let (c, s) = if edgewise_mps > STILL_MPS {
        (flow.forward_mps / edgewise_mps, -flow.right_mps / edgewise_mps)
    } else {
        (1.0, 0.0)
    };
    let into_wind = |aft: f64, right: f64| (c * aft + s * right, c * right - s * aft);
    let disc = flow.density_kg_per_m3 * PI * square(radius_m);
    let f0 = loads.thrust_n / disc;
    let (fc, fs) =
        into_wind(loads.aft_n_m / (disc * radius_m), loads.right_n_m / (disc * radius_m));
    let (vc, vs) = into_wind(state.aft_mps, state.right_mps);
    let v0 = state.mean_mps;

    let squared = square(edgewise_mps) + (flow.along_mps + v0) * (flow.along_mps + 2.0 * v0);
    let harmonic_mps = clamp(squared / (total_mps + STILL_MPS), total_mps, 2.0 * total_mps);
    // (m/h + K)·v' = m/h·v + F, K = diag(V)·L0⁻¹.
    let m0 = radius_m * APPARENT_MASS / STEP_S;
    let m1 = radius_m * APPARENT_INERTIA / STEP_S;
    let determinant = 1.0 - square(x) + square(SKEW * x);
    let k00 = m0 + total_mps * 2.0 * (1.0 - square(x)) / determinant;
    let k0c = total_mps * SKEW * x / determinant;
    let kc0 = -harmonic_mps * SKEW * x / determinant;
    let kcc = m1 + harmonic_mps * 0.5 / determinant;
    let kss = m1 + harmonic_mps * 0.5 / (1.0 + square(x));
    let (b0, bc, bs) = (m0 * v0 + f0, m1 * vc + fc, m1 * vs + fs);
    let d = k00 * kcc - k0c * kc0;
    let (mean_mps, vc, vs) = ((b0 * kcc - k0c * bc) / d, (k00 * bc - kc0 * b0) / d, bs / kss);
    State { mean_mps, aft_mps: c * vc - s * vs, right_mps: s * vc + c * vs }
}

/// What the ground does.
#[derive(Clone, Copy, Debug)]
pub struct Ground {
    /// G, of the air through the disc.
    pub disc: f64,
    /// W, of the wake at the airframe.
    pub wake: f64,
}

/// Hayden's fit begins where it saves nothing, and the rotor never comes nearer than its mast.
const DIAMETERS_OVER_HEIGHT_MAX: f64 = 2.0;

/// What the ground does to a rotor whose hub is that high over it.
pub fn ground(params: &Params, through: &DiscFlow, height_m: f64, radius_m: f64) -> Ground {
    let diameters = 0.5 * height_m / radius_m;
    let near = min(1.0 / max(diameters, 1e-3), DIAMETERS_OVER_HEIGHT_MAX);
    let saved = max(1.0 - 1.0 / (0.9926 + 0.0379 * square(near)), 0.0);
    let axial = through.axial();
    let wake = sqrt(max(params.download_near_ground.at(HubHeight(diameters)), 0.0));
    Ground { disc: 1.0 - axial * saved, wake: 1.0 - axial * (1.0 - wake) }
}

/// What the elements meet.
pub fn induced(
    params: &Params,
    state: &State,
    through: &DiscFlow,
    flow: &Flow,
    blade: &Blade,
    (collective, blades): ((f64, f64), f64),
    (ground, radius_m): (f64, f64),
) -> Induced {
    let omega = flow.omega_radps;
    let free_mps = sqrt(square(flow.along_mps) + square(through.edgewise_mps));
    let (annular, momentum) = annular(blade, flow, free_mps, collective, blades);
    let root = sqrt(square(free_mps) + 4.0 * momentum.abs());
    let mean = 2.0 * momentum / (free_mps + root + STILL_MPS);
    let axial = through.axial();
    let own = square(state.mean_mps);
    let still = own / (own + square(free_mps) + STILL_MPS);
    let factor = ground * params.induced_power_factor * (1.0 + params.recirculation * still);
    let mean_mps = annular.map(|v| factor * (state.mean_mps + axial * (v - mean)));
    let swirl_mps = by_station(blade, |group, stations| {
        let v = Lanes::from_fn(|lane| mean_mps[stations + lane]);
        let (turning, through) = (omega * group.radius_m, flow.along_mps + v);
        v * turning * through / (lanes::square(turning) + lanes::square(through) + STILL_MPS)
    });
    let through = flow.along_mps + state.mean_mps;
    let tip_mps = sqrt(square(through) + square(omega * radius_m) + STILL_MPS);
    let lost = BETZ / blades * state.mean_mps.abs() / tip_mps;
    Induced {
        mean_mps,
        swirl_mps,
        lifting: by_station(blade, |group, _| group.lifting(1.0 - lost)),
        aft_per_s: ground * state.aft_mps / radius_m,
        right_per_s: ground * state.right_mps / radius_m,
    }
}

/// What `f` makes of the blade's elements in lanes, by station; it is told which the first of them is.
fn by_station(blade: &Blade, f: impl Fn(&Group, usize) -> Lanes) -> [f64; STATIONS] {
    let mut stations = [0.0; STATIONS];
    for (i, (some, group)) in stations.chunks_exact_mut(LANES).zip(&blade.groups).enumerate() {
        some.copy_from_slice(&f(group, i * LANES).to_array());
    }
    stations
}

/// v_r by station, and the mean of its v_r·(|V| + |v_r|) over the disc.
fn annular(
    blade: &Blade,
    flow: &Flow,
    free_mps: f64,
    (sin_collective, cos_collective): (f64, f64),
    blades: f64,
) -> ([f64; STATIONS], f64) {
    let (omega, along_mps) = (flow.omega_radps, flow.along_mps);
    let annular = by_station(blade, |group, _| {
        let r = group.radius_m;
        let u = lanes::sqrt(lanes::square(omega * r) + square(along_mps)) + STILL_MPS;
        let sin_pitch = sin_collective * group.cos_twist + cos_collective * group.sin_twist;
        let cos_pitch = cos_collective * group.cos_twist - sin_collective * group.sin_twist;
        let sin_alpha = (sin_pitch * omega * r - cos_pitch * along_mps) / u;
        let pull = blades * group.chord_m * omega * LIFT_SLOPE / (8.0 * PI);
        let forcing = pull * u * (sin_alpha - group.zero_lift_rad);
        let relief = free_mps + (pull * omega * r / u).abs() + STILL_MPS;
        2.0 * forcing / (relief + lanes::sqrt(lanes::square(relief) + 4.0 * forcing.abs()))
    });
    let momentum = blade
        .stations
        .iter()
        .zip(annular)
        .fold(0.0, |sum, (station, v)| sum + station.disc_norm * v * (free_mps + v.abs()));
    (annular, momentum)
}
