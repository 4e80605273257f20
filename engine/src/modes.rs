//! Modes: the eigenvalues of a linear system, and what they are called.
//!
//! # Equations
//! ```text
//! A·v = λ·v,  Aᵀ·w = λ·w      pₖ = |wₖ·vₖ| / Σ|wₖ·vₖ|      how much state k takes part in a mode
//! ω = |λ|     ζ = −Re λ/ω     τ = −1/Re λ
//! ```
//! Participation has no units: it says the same whatever the states are measured in.
//!
//! # Assumptions
//! A mode belongs to the group of states that take most part in it; the rigid body's modes get their
//! textbook names by their order within the group. Names are a help to the reader and nothing
//! depends on them: where the aircraft has other modes than the textbook's, they are called by their
//! group.

use alloc::string::String;
use alloc::vec::Vec;

use crate::dense::Complex;
use crate::linearize::Linear;

/// Slower than this it is hover: the textbook's hovering modes are looked for, m/s.
const HOVER_MPS: f64 = 20.0;

/// Faster than this, a mode is of no interest to a pilot, rad/s.
const FAST_RADPS: f64 = 12.0;

/// A motion of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// λ; of a pair the one above.
    pub eigenvalue: Complex,
    /// What it is called.
    pub name: &'static str,
    /// Whether it is fast: rotors, inflow, actuators.
    pub fast: bool,
    /// The state that takes most part in it.
    pub state: String,
}

impl Mode {
    /// ω.
    pub fn frequency_radps(&self) -> f64 {
        self.eigenvalue.abs()
    }

    /// ζ; below zero the mode grows.
    pub fn damping(&self) -> f64 {
        if self.eigenvalue.abs() > 0.0 { -self.eigenvalue.re / self.eigenvalue.abs() } else { 0.0 }
    }

    /// Time in which it decays to 1/e, below zero grows to e times.
    pub fn time_s(&self) -> f64 {
        -1.0 / self.eigenvalue.re
    }

    /// Whether it swings.
    pub fn swings(&self) -> bool {
        self.eigenvalue.im > 0.0
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Group {
    Longitudinal,
    Lateral,
    Drive,
    Augmentation,
    Rotors,
    Actuators,
}

fn group(state: &str) -> Group {
    match state {
        "forward_mps" | "down_mps" | "pitch_rate_radps" | "pitch_rad" => Group::Longitudinal,
        "right_mps" | "roll_rate_radps" | "yaw_rate_radps" | "roll_rad" => Group::Lateral,
        _ if state.starts_with("actuators.") => Group::Actuators,
        _ if state.starts_with("fcc.scas.") => Group::Augmentation,
        _ if state.starts_with("fcc.") => Group::Drive,
        _ if state.starts_with("plant.engines") || state.starts_with("plant.rotor_speed") => {
            Group::Drive
        }
        _ => Group::Rotors,
    }
}

/// Takes part by group, and the state that does most.
struct Part {
    group: Group,
    rigid: [f64; 8],
    state: usize,
}

/// The modes of a system at an airspeed, the slowest first, a pair as one.
pub fn modes(linear: &Linear, airspeed_mps: f64) -> Vec<Mode> {
    let turned = linear.a.transposed();
    let mut found: Vec<(Complex, Part)> = Vec::new();
    for eigenvalue in linear.a.eigenvalues() {
        // What never moves, and the other one of a pair, is no mode of its own.
        if eigenvalue.abs() < 1e-9 || eigenvalue.im < 0.0 {
            continue;
        }
        let (v, w) = (linear.a.eigenvector(eigenvalue), turned.eigenvector(eigenvalue));
        let parts: Vec<f64> = v.iter().zip(&w).map(|(v, w)| v.abs() * w.abs()).collect();
        found.push((eigenvalue, part(linear, &parts)));
    }
    let hovers = airspeed_mps < HOVER_MPS;
    let names: Vec<&str> = (0..found.len()).map(|i| name(&found, i, hovers)).collect();
    found
        .iter()
        .zip(names)
        .map(|((eigenvalue, part), name)| Mode {
            eigenvalue: *eigenvalue,
            name,
            fast: is_fast(*eigenvalue, part),
            state: linear.states[part.state].clone(),
        })
        .collect()
}

fn part(linear: &Linear, parts: &[f64]) -> Part {
    let groups = [
        Group::Longitudinal,
        Group::Lateral,
        Group::Drive,
        Group::Augmentation,
        Group::Rotors,
        Group::Actuators,
    ];
    let of = |wanted: Group| -> f64 {
        let all = linear.states.iter().zip(parts);
        all.filter(|(state, _)| group(state) == wanted).map(|(_, part)| *part).sum()
    };
    let mut most = groups[0];
    for other in groups {
        if of(other) > of(most) {
            most = other;
        }
    }
    let mut state = 0;
    for (i, part) in parts.iter().enumerate() {
        if *part > parts[state] {
            state = i;
        }
    }
    let mut rigid = [0.0; 8];
    rigid.copy_from_slice(&parts[..8]);
    Part { group: most, rigid, state }
}

fn is_fast(eigenvalue: Complex, part: &Part) -> bool {
    eigenvalue.abs() > FAST_RADPS || matches!(part.group, Group::Rotors | Group::Actuators)
}

/// What the mode `i` is called among all.
fn name(found: &[(Complex, Part)], i: usize, hovers: bool) -> &'static str {
    let (eigenvalue, part) = &found[i];
    let swings = eigenvalue.im > 0.0;
    match part.group {
        Group::Actuators => return "actuator",
        Group::Rotors => return "rotor",
        Group::Drive => return if swings { "rotor speed and governor" } else { "drive" },
        Group::Augmentation => return "augmentation",
        Group::Longitudinal | Group::Lateral => {}
    }
    // How many slower ones of the same kind and group there are, and how many in all.
    let alike = |other: &(Complex, Part)| {
        other.1.group == part.group && (other.0.im > 0.0) == swings && !is_fast(other.0, &other.1)
    };
    let slower = found[..i].iter().filter(|other| alike(other)).count();
    let all = found.iter().filter(|other| alike(other)).count();
    let [u, v, w, p, _, r, ..] = part.rigid;
    if part.group == Group::Longitudinal {
        match (swings, hovers) {
            (true, true) if slower == 0 => "hover oscillation in pitch",
            (true, false) if slower + 1 == all && (all > 1 || w > u) => "short period",
            (true, false) if slower == 0 => "phugoid",
            (false, true) if w > u => "heave",
            (false, true) => "pitch subsidence",
            (false, false) if w > u => "heave subsidence",
            (false, false) if u > w => "speed subsidence",
            _ => "longitudinal",
        }
    } else {
        match (swings, hovers) {
            (true, true) if slower == 0 => "hover oscillation in roll",
            (true, false) if slower + 1 == all => "dutch roll",
            (true, false) => "lateral phugoid",
            (false, true) if r > p && r > v => "yaw subsidence",
            (false, true) => "roll subsidence",
            (false, false) if slower + 1 == all && (p > r || all > 1) => "roll subsidence",
            (false, false) if slower == 0 => "spiral",
            _ => "lateral",
        }
    }
}
