//! Flapping: the gimbal's tilt, and the first elastic flapping of each blade.
//!
//! # Equations
//! A blade's displacement out of the hub plane is r·(β_p + γ) + R·φ(r)·q ([`super::bending`]). Multiblade coordinates of
//! both, γ(ψ) = −γ_a·cos ψ − γ_b·sin ψ and q(ψ) = q0 − q_a·cos ψ − q_b·sin ψ, as complex numbers z = a + i·b; w their rates in
//! inertial space, F the air's moments on a blade in either shape, (q, p) the hub's rates:
//! ```text
//! ż_γ = w_γ − (q + i·p)     ż_q = w_q
//! M_γγ·(ẇ_γ − 2iΩ·w_γ) + M_γq·(ẇ_q − 2iΩ·w_q) = −κ(z_γ) − F_γ      M_γγ = I_b + I_h/(3/2)     [JOHNSON]
//! M_γq·(ẇ_γ − 2iΩ·w_γ) + M_qq·(ẇ_q − 2iΩ·w_q) = −(K_q + Ω²·(C_qq − M_qq))·z_q − F_q
//! M_qq·q̈0 = F_q0 − (K_q + Ω²·C_qq)·q0 − Ω²·M_γq·β_p
//! κ(z) = (K_H·z + K_S·(|z| − z_max)·z/|z|)/(3/2)     the gimbal's spring, and its stop beyond z_max
//! S = b·S_q·q̈0                                      of the thrust, what accelerates the blades
//! ```
//! The state has the tip path, which is what is seen of a rotor: z = z_γ + z_q and β0 = β_p + q0, the tip's
//! displacement over the radius; and z_q, what of the tilt the blades bend.
//!
//! One tick is taken by the implicit midpoint rule, the air's damping F = F₀ + D·(Δw − iΩ·Δz) in it, D by both shapes:
//! of second order, stable at any rotor speed, steady where the motion is. Elastic flapping turns fast seen from the
//! airframe, 50 and 70 Hz: the rule neither damps nor drives it, and turns it slower. The stop is taken by the implicit Euler
//! rule: it is met and left within a tick, and what the midpoint rule makes of that grows.
//! # Signs
//! Flap up; a1 aft and b1 to the right, as the disc's tilt. Moment of the spring on the airframe: as
//! the tilt.
//! # Assumptions
//! The hub tilts with the gimbal, as a flat ring: I_h about a diameter is half of what the rotor's polar inertia has
//! beyond the blades'. δ3 feels the gimbal alone. Gravity and the hub's acceleration do not flap the blades. The
//! gimbal keeps the speed constant. Three blades: what all bend in turn (reactionless) is not there.

use serde::{Deserialize, Serialize};

use super::bending::Inertias;
use super::tilt::Tilt;
use crate::STEP_S;
use crate::math::{sqrt, square};

/// What holds the blades.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// I_b.
    pub blade_inertia_kg_m2: f64,
    /// β_p.
    pub precone_rad: f64,
    /// K_H, of the whole rotor.
    pub hub_spring_n_m_per_rad: f64,
    /// Gimbal stop, any way.
    pub flapping_rad_max: f64,
    /// K_S: how hard it is, of the whole rotor.
    pub stop_spring_n_m_per_rad: f64,
    /// δ3; negative: flap up raises the pitch.
    pub delta3_rad: f64,
}

/// How the blades flap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// β0, precone included: the tip's displacement over the radius.
    pub coning_rad: f64,
    /// Its rate.
    pub coning_radps: f64,
    /// a1, tip path tilted aft: by the gimbal and by what the blades bend.
    pub aft_rad: f64,
    /// Its rate in inertial space: what the mast's own turn adds is not in it.
    pub aft_radps: f64,
    /// b1, tip path tilted right (in the mirror for the left rotor).
    pub right_rad: f64,
    /// Its rate in inertial space.
    pub right_radps: f64,
    /// Of a1, what the blades bend; the rest is the gimbal's.
    pub elastic_aft_rad: f64,
    /// Its rate.
    pub elastic_aft_radps: f64,
    /// Of b1, what the blades bend.
    pub elastic_right_rad: f64,
    /// Its rate.
    pub elastic_right_radps: f64,
}

/// Displacement in one shape around the turn: mean − aft·cos ψ − right·sin ψ, and how fast it changes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Harmonics {
    /// Around the turn.
    pub mean_rad: f64,
    /// Its rate.
    pub mean_radps: f64,
    /// Up in front.
    pub aft_rad: f64,
    /// Its rate in inertial space.
    pub aft_radps: f64,
    /// Up on the left.
    pub right_rad: f64,
    /// Its rate in inertial space.
    pub right_radps: f64,
}

/// The blades as the air meets them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Curve {
    /// As straight lines from the hub.
    pub straight: Harmonics,
    /// In their own shape, the tip's.
    pub elastic: Harmonics,
}

impl State {
    fn gimbal(&self) -> (Tilt, Tilt) {
        (
            Tilt::new(self.aft_rad - self.elastic_aft_rad, self.right_rad - self.elastic_right_rad),
            Tilt::new(
                self.aft_radps - self.elastic_aft_radps,
                self.right_radps - self.elastic_right_radps,
            ),
        )
    }

    /// The blades' curve.
    pub fn curve(&self, precone_rad: f64) -> Curve {
        let (tilt, rate) = self.gimbal();
        Curve {
            straight: Harmonics {
                mean_rad: precone_rad,
                mean_radps: 0.0,
                aft_rad: tilt.aft,
                aft_radps: rate.aft,
                right_rad: tilt.right,
                right_radps: rate.right,
            },
            elastic: Harmonics {
                mean_rad: self.coning_rad - precone_rad,
                mean_radps: self.coning_radps,
                aft_rad: self.elastic_aft_rad,
                aft_radps: self.elastic_aft_radps,
                right_rad: self.elastic_right_rad,
                right_radps: self.elastic_right_radps,
            },
        }
    }
}

/// The air's moment on a blade in one shape.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment {
    /// Around the turn.
    pub mean_n_m: f64,
    /// Its part with cos ψ: amplitude.
    pub cos_n_m: f64,
    /// Its part with sin ψ: amplitude.
    pub sin_n_m: f64,
}

/// D: the air's moment in one shape lost per rate of another, roughly.
#[derive(Clone, Copy, Debug, Default)]
pub struct Damping {
    /// D_γγ.
    pub straight_n_m_s: f64,
    /// D_γq.
    pub coupled_n_m_s: f64,
    /// D_qq.
    pub elastic_n_m_s: f64,
}

/// What moves the blades.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// Ω.
    pub omega_radps: f64,
    /// q of the hub, mast axes.
    pub hub_pitch_radps: f64,
    /// p of the hub, mast axes.
    pub hub_roll_radps: f64,
    /// F_γ.
    pub straight: Moment,
    /// F_q.
    pub elastic: Moment,
    /// D.
    pub damping: Damping,
}

/// Where the gimbal is, and what it passes on.
#[derive(Clone, Copy, Debug)]
pub struct Gimbal {
    /// Its tilt aft.
    pub aft_rad: f64,
    /// Its tilt right.
    pub right_rad: f64,
    /// Moment on the airframe, pitching up.
    pub pitching_n_m: f64,
    /// Moment on the airframe, rolling right.
    pub rolling_n_m: f64,
    /// Whether it is on its stop.
    pub on_stop: bool,
    /// Slope of κ off the stop.
    stiffness_n_m: f64,
    /// What the stop adds to it.
    stop_n_m: f64,
}

/// The gimbal under tilted blades.
pub fn gimbal(params: &Params, state: &State) -> Gimbal {
    let (tilt, _) = state.gimbal();
    let tilt_rad = sqrt(square(tilt.aft) + square(tilt.right));
    let on_stop = tilt_rad > params.flapping_rad_max;
    let (spring, stop) = (params.hub_spring_n_m_per_rad, params.stop_spring_n_m_per_rad);
    let (n_m_per_rad, stop) = if on_stop {
        (spring + stop * (1.0 - params.flapping_rad_max / tilt_rad), stop)
    } else {
        (spring, 0.0)
    };
    Gimbal {
        aft_rad: tilt.aft,
        right_rad: tilt.right,
        pitching_n_m: n_m_per_rad * tilt.aft,
        rolling_n_m: n_m_per_rad * tilt.right,
        on_stop,
        stiffness_n_m: spring / 1.5,
        stop_n_m: stop / 1.5,
    }
}

/// Flapping one tick later.
pub fn advance(
    params: &Params,
    inertias: &Inertias,
    state: &State,
    gimbal: &Gimbal,
    inputs: &Inputs,
) -> State {
    let h = STEP_S;
    let (tilting, straight, elastic) = tilts(inertias, state, gimbal, inputs);
    let tip = straight + elastic;
    let coning = coning(params, inertias, state, inputs);
    State {
        coning_rad: state.coning_rad + h * (state.coning_radps + 0.5 * coning),
        coning_radps: state.coning_radps + coning,
        aft_rad: state.aft_rad + h * (tilting.aft + state.elastic_aft_radps + 0.5 * tip.aft),
        aft_radps: state.aft_radps + tip.aft,
        right_rad: state.right_rad
            + h * (tilting.right + state.elastic_right_radps + 0.5 * tip.right),
        right_radps: state.right_radps + tip.right,
        elastic_aft_rad: state.elastic_aft_rad + h * (state.elastic_aft_radps + 0.5 * elastic.aft),
        elastic_aft_radps: state.elastic_aft_radps + elastic.aft,
        elastic_right_rad: state.elastic_right_rad
            + h * (state.elastic_right_radps + 0.5 * elastic.right),
        elastic_right_radps: state.elastic_right_radps + elastic.right,
    }
}

/// ż_γ now, and what w_γ and w_q gain in a tick.
fn tilts(m: &Inertias, state: &State, gimbal: &Gimbal, inputs: &Inputs) -> (Tilt, Tilt, Tilt) {
    let h = STEP_S;
    let omega = inputs.omega_radps;
    let d = &inputs.damping;
    let stiffness_n_m =
        m.spring_n_m_per_rad + square(omega) * (m.stiffened_kg_m2 - m.elastic_kg_m2);
    let straight_radps = state.gimbal().1;
    let elastic_rad = Tilt::new(state.elastic_aft_rad, state.elastic_right_rad);
    let elastic_radps = Tilt::new(state.elastic_aft_radps, state.elastic_right_radps);
    let tilting = straight_radps - Tilt::new(inputs.hub_pitch_radps, inputs.hub_roll_radps);

    // (M·(1 − ihΩ) + K'·h²/4 + D·(h/2 − iΩh²/4))·δw = h·(2iΩ·M·w − κ − F − (K' − iΩD)·h/2·ż)
    let turns = |straight: f64, elastic: f64, lost: (f64, f64)| {
        let momentum = straight_radps * straight + elastic_radps * elastic;
        let lost = tilting * lost.0 + elastic_radps * lost.1;
        (momentum * 2.0 + lost * (0.5 * h)).turned() * omega
    };
    let moments = |moment: &Moment| Tilt::new(moment.cos_n_m, moment.sin_n_m);
    let by_straight = turns(m.gimbal_kg_m2, m.coupled_kg_m2, (d.straight_n_m_s, d.coupled_n_m_s))
        - Tilt::new(gimbal.pitching_n_m, gimbal.rolling_n_m) * (1.0 / 1.5)
        - moments(&inputs.straight)
        - tilting * (0.5 * h * gimbal.stiffness_n_m + h * gimbal.stop_n_m);
    let by_elastic = turns(m.coupled_kg_m2, m.elastic_kg_m2, (d.coupled_n_m_s, d.elastic_n_m_s))
        - (elastic_rad + elastic_radps * (0.5 * h)) * stiffness_n_m
        - moments(&inputs.elastic);

    let part = |inertia: f64, stiffness: f64, lost: f64| {
        Tilt::new(
            inertia + 0.25 * h * h * stiffness + 0.5 * h * lost,
            -h * omega * (inertia + 0.25 * h * lost),
        )
    };
    let stiffness = gimbal.stiffness_n_m + 2.0 * gimbal.stop_n_m;
    let straight = part(m.gimbal_kg_m2, stiffness, d.straight_n_m_s);
    let coupled = part(m.coupled_kg_m2, 0.0, d.coupled_n_m_s);
    let elastic = part(m.elastic_kg_m2, stiffness_n_m, d.elastic_n_m_s);
    let scale = (straight * elastic - coupled * coupled).inverse() * h;
    (
        tilting,
        (elastic * by_straight - coupled * by_elastic) * scale,
        (straight * by_elastic - coupled * by_straight) * scale,
    )
}

/// What the rate of coning gains in a tick.
fn coning(params: &Params, m: &Inertias, state: &State, inputs: &Inputs) -> f64 {
    let h = STEP_S;
    let turning = square(inputs.omega_radps);
    let stiffness_n_m = m.spring_n_m_per_rad + turning * m.stiffened_kg_m2;
    let bent_rad = state.coning_rad - params.precone_rad;
    h * (inputs.elastic.mean_n_m
        - turning * m.coupled_kg_m2 * params.precone_rad
        - stiffness_n_m * (bent_rad + 0.5 * h * state.coning_radps))
        / (m.elastic_kg_m2 + 0.25 * stiffness_n_m * h * h + 0.5 * inputs.damping.elastic_n_m_s * h)
}

/// S: what of a blade's air load goes into swinging it up from one state to the next, and not into the mast.
pub fn swinging_n(inertias: &Inertias, state: &State, next: &State) -> f64 {
    inertias.moment_kg_m * (next.coning_radps - state.coning_radps) / STEP_S
}
