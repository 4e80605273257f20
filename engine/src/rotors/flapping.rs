//! Flapping: the gimbal's tilt and the blades' own bending.
//!
//! # Equations
//! Multiblade coordinates of β(ψ) = β0 − a1·cos ψ − b1·sin ψ; as complex numbers z = a1 + i·b1,
//! w its rate in inertial space, m the air's flapping moment over I_b, (q, p) the hub's rates:
//! ```text
//! ż = w − (q + i·p)
//! I_t·(ẇ − 2iΩ·w) = −κ(z) + I_b·m          I_t = I_b + I_h/(3/2)                  [JOHNSON]
//! β̈0 = −(Ω² + K_b/I_b)·β0 + K_b/I_b·β_p + m0
//! κ(z) = K/(3/2)·z,   1/K = 1/K_H + 1/(3/2·K_b)            the gimbal's spring and the blades' own
//! κ(z) = K_b·(|z| − z_max)·z/|z|                           beyond the gimbal's stop
//! S = b·(3/2)·I_b/R·β̈0                                     of the thrust, what accelerates the blades
//! ```
//! One tick is taken by the implicit midpoint rule, the air's damping m = m₀ − D·(Δw − iΩ·Δz) in it:
//! of second order, stable at any rotor speed, steady where the motion is.
//! # Signs
//! Flap up; a1 aft and b1 to the right, as the disc's tilt. Moment of the spring on the airframe: as
//! the tilt.
//! # Assumptions
//! A blade bends in the shape of a straight line from the hub, its mass spread evenly: gimbal
//! and blades are springs in series, and what a blade bends with cos ψ and sin ψ follows from the
//! tilt (K_H to 3/2·K_b, a few per cent) without states of its own. The hub tilts with the blades, as a flat ring:
//! I_h about a diameter is half of what the rotor's polar inertia has beyond the blades'. What blades that bend in a
//! curve of their own would change is in docs/model.md. Gravity and the hub's
//! acceleration do not flap the blades. The gimbal keeps the speed constant.

use serde::{Deserialize, Serialize};

use crate::STEP_S;
use crate::math::{sqrt, square};

/// What holds the blades.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// I_b.
    pub blade_inertia_kg_m2: f64,
    /// K_b: the blade's bending as a spring about the hub.
    pub blade_spring_n_m_per_rad: f64,
    /// β_p.
    pub precone_rad: f64,
    /// K_H, of the whole rotor.
    pub hub_spring_n_m_per_rad: f64,
    /// Gimbal stop, any way.
    pub flapping_rad_max: f64,
    /// δ3; negative: flap up raises the pitch.
    pub delta3_rad: f64,
}

/// How the blades flap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// β0, precone included.
    pub coning_rad: f64,
    /// Its rate.
    pub coning_radps: f64,
    /// a1, tip path tilted aft.
    pub aft_rad: f64,
    /// Its rate in inertial space: what the mast's own turn adds is not in it.
    pub aft_radps: f64,
    /// b1, tip path tilted right (in the mirror for the left rotor).
    pub right_rad: f64,
    /// Its rate in inertial space.
    pub right_radps: f64,
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
    /// Flapping moment of the air on a blade.
    pub flap_n_m: f64,
    /// Its part with cos ψ.
    pub flap_cos_n_m: f64,
    /// Its part with sin ψ.
    pub flap_sin_n_m: f64,
    /// D·I_b.
    pub damping_n_m_s: f64,
    /// I_h.
    pub hub_inertia_kg_m2: f64,
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
    /// Slope of κ.
    stiffness_n_m: f64,
}

/// The gimbal under a tilted disc.
pub fn gimbal(params: &Params, state: &State) -> Gimbal {
    let blades = 1.5 * params.blade_spring_n_m_per_rad;
    let share = blades / (blades + params.hub_spring_n_m_per_rad);
    let tilt_rad = sqrt(square(state.aft_rad) + square(state.right_rad));
    let on_stop = share * tilt_rad > params.flapping_rad_max;
    let (share, n_m_per_rad, slope) = if on_stop {
        let share = params.flapping_rad_max / tilt_rad;
        (share, blades * (1.0 - share), blades)
    } else {
        let series = share * params.hub_spring_n_m_per_rad;
        (share, series, series)
    };
    Gimbal {
        aft_rad: share * state.aft_rad,
        right_rad: share * state.right_rad,
        pitching_n_m: n_m_per_rad * state.aft_rad,
        rolling_n_m: n_m_per_rad * state.right_rad,
        on_stop,
        stiffness_n_m: slope / 1.5,
    }
}

/// Flapping one tick later.
pub fn advance(params: &Params, state: &State, gimbal: &Gimbal, inputs: &Inputs) -> State {
    let h = STEP_S;
    let omega = inputs.omega_radps;
    // A disc that tilts takes the hub with it.
    let per_inertia = 1.0 / (params.blade_inertia_kg_m2 + inputs.hub_inertia_kg_m2 / 1.5);
    let damping = inputs.damping_n_m_s * per_inertia;
    let stiffness = gimbal.stiffness_n_m * per_inertia;

    // δw·(1 − ihΩ + κ'h²/4 + Dh/2 − iΩDh²/4) = h·(2iΩw − κ + m − (κ' − iΩD)·h/2·ż)
    let tilting =
        (state.aft_radps - inputs.hub_pitch_radps, state.right_radps - inputs.hub_roll_radps);
    let spring = per_inertia / 1.5;
    let right_hand = (
        -2.0 * omega * state.right_radps
            - spring * gimbal.pitching_n_m
            - per_inertia * inputs.flap_cos_n_m
            - 0.5 * h * (stiffness * tilting.0 + omega * damping * tilting.1),
        2.0 * omega * state.aft_radps
            - spring * gimbal.rolling_n_m
            - per_inertia * inputs.flap_sin_n_m
            - 0.5 * h * (stiffness * tilting.1 - omega * damping * tilting.0),
    );
    let real = 1.0 + 0.25 * stiffness * h * h + 0.5 * damping * h;
    let imaginary = -h * omega - 0.25 * omega * damping * h * h;
    let scale = h / (square(real) + square(imaginary));
    let aft = scale * (right_hand.0 * real + right_hand.1 * imaginary);
    let right = scale * (right_hand.1 * real - right_hand.0 * imaginary);

    let per_inertia = 1.0 / params.blade_inertia_kg_m2;
    let damping = inputs.damping_n_m_s * per_inertia;
    let bending = params.blade_spring_n_m_per_rad * per_inertia;
    let stiffness = square(omega) + bending;
    let coning = h
        * (bending * params.precone_rad - stiffness * state.coning_rad
            + per_inertia * inputs.flap_n_m
            - 0.5 * h * stiffness * state.coning_radps)
        / (1.0 + 0.25 * stiffness * h * h + 0.5 * damping * h);
    State {
        coning_rad: state.coning_rad + h * (state.coning_radps + 0.5 * coning),
        coning_radps: state.coning_radps + coning,
        aft_rad: state.aft_rad + h * (tilting.0 + 0.5 * aft),
        aft_radps: state.aft_radps + aft,
        right_rad: state.right_rad + h * (tilting.1 + 0.5 * right),
        right_radps: state.right_radps + right,
    }
}

/// S: what of a blade's air load goes into swinging it up from one state to the next, and not into the mast.
pub fn swinging_n(params: &Params, state: &State, next: &State, radius_m: f64) -> f64 {
    let coning_radps2 = (next.coning_radps - state.coning_radps) / STEP_S;
    1.5 * params.blade_inertia_kg_m2 / radius_m * coning_radps2
}
