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
//! group. A real root that grows is a divergence, one that decays a subsidence.

use alloc::vec::Vec;

use engine::math::max;

use crate::eigen::{self, Unsolved};
use crate::linearize::Linear;
use crate::matrix::{Complex, Polar};
use crate::variable::{Part, Rigid, Variable};

/// Slower than this it is hover: the textbook's hovering modes are looked for, m/s.
const HOVER_MPS: f64 = 20.0;

/// Faster than this, a mode is of no interest to a pilot, rad/s.
const FAST_RADPS: f64 = 12.0;

/// Imaginary parts below this part of an eigenvalue are rounding.
const ROUNDING_NORM: f64 = 1e-6;

/// A motion of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// λ; of a pair the one above.
    pub eigenvalue: Complex,
    /// What it is called.
    pub name: &'static str,
    /// Whether it is fast: rotors, inflow, actuators. A mode that grows is of interest however fast.
    pub fast: bool,
    /// The state that takes most part in it.
    pub state: Variable,
}

impl Mode {
    /// ω.
    pub fn frequency_radps(&self) -> f64 {
        self.eigenvalue.magnitude()
    }

    /// ζ; below zero the mode grows.
    pub fn damping(&self) -> f64 {
        let omega = self.eigenvalue.magnitude();
        if omega > 0.0 { -self.eigenvalue.re / omega } else { 0.0 }
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

/// Who takes part in a mode.
struct Shares {
    /// What takes most part together.
    part: Part,
    /// Of each state of the rigid body.
    rigid: [f64; Rigid::ALL.len()],
    /// The state that takes most part, by its place.
    state: usize,
}

/// The modes of a system at an airspeed, the slowest first, a pair as one.
///
/// # Errors
/// When the eigenvalues do not converge.
pub fn modes(linear: &Linear, airspeed_mps: f64) -> Result<Vec<Mode>, Unsolved> {
    let transposed = linear.a.transpose();
    let mut found: Vec<(Complex, Shares)> = Vec::new();
    for eigenvalue in linear.eigenvalues()?.into_iter().map(without_rounding) {
        // What never moves, and the other one of a pair, is no mode of its own.
        if eigenvalue.magnitude() < 1e-9 || eigenvalue.im < 0.0 {
            continue;
        }
        let v = eigen::eigenvector(&linear.a, eigenvalue)?;
        let w = eigen::eigenvector(&transposed, eigenvalue)?;
        let shares: Vec<f64> =
            v.iter().zip(&w).map(|(v, w)| v.magnitude() * w.magnitude()).collect();
        found.push((eigenvalue, Shares::new(linear, &shares)));
    }
    let hovers = airspeed_mps < HOVER_MPS;
    let names: Vec<&str> = (0..found.len()).map(|i| name(&found, i, hovers)).collect();
    Ok(found
        .iter()
        .zip(names)
        .map(|((eigenvalue, shares), name)| Mode {
            eigenvalue: *eigenvalue,
            name,
            fast: is_fast(*eigenvalue, shares) && eigenvalue.re <= 0.0,
            state: linear.states[shares.state],
        })
        .collect())
}

/// A repeated real root comes out as a pair with an imaginary part of about the square root of the
/// rounding: it swings no more than a root that stands alone.
fn without_rounding(eigenvalue: Complex) -> Complex {
    let rounding = eigenvalue.im.abs() < ROUNDING_NORM * eigenvalue.magnitude();
    if rounding { Complex::new(eigenvalue.re, 0.0) } else { eigenvalue }
}

impl Shares {
    /// From the share of every state of the system.
    fn new(linear: &Linear, shares: &[f64]) -> Self {
        let of = |wanted: Part| -> f64 {
            let all = linear.states.iter().zip(shares);
            all.filter(|(state, _)| state.part() == wanted).map(|(_, share)| *share).sum()
        };
        let mut part = Part::ALL[0];
        for other in Part::ALL {
            if of(other) > of(part) {
                part = other;
            }
        }
        let mut state = 0;
        for (i, share) in shares.iter().enumerate() {
            if *share > shares[state] {
                state = i;
            }
        }
        let mut rigid = [0.0; Rigid::ALL.len()];
        for (state, share) in linear.states.iter().zip(shares) {
            if let Variable::Rigid(which) = state {
                rigid[*which as usize] = *share;
            }
        }
        Self { part, rigid, state }
    }

    fn of(&self, rigid: Rigid) -> f64 {
        self.rigid[rigid as usize]
    }
}

fn is_fast(eigenvalue: Complex, shares: &Shares) -> bool {
    eigenvalue.magnitude() > FAST_RADPS
        || matches!(shares.part, Part::Rotors | Part::Downwash | Part::Actuators)
}

/// What the mode `i` is called among all.
fn name(found: &[(Complex, Shares)], i: usize, hovers: bool) -> &'static str {
    let (eigenvalue, shares) = &found[i];
    let swings = eigenvalue.im > 0.0;
    // How many slower ones of the same kind and part there are, and how many in all.
    let alike = |other: &(Complex, Shares)| {
        other.1.part == shares.part && (other.0.im > 0.0) == swings && !is_fast(other.0, &other.1)
    };
    let slower = found[..i].iter().filter(|other| alike(other)).count();
    let all = found.iter().filter(|other| alike(other)).count();
    let place = Place { slowest: slower == 0, fastest: slower + 1 == all, alone: all == 1, hovers };
    let grows = eigenvalue.re > 0.0;
    match (shares.part, swings) {
        (Part::Actuators, _) => "actuator",
        (Part::Rotors, _) => "rotor",
        (Part::Downwash, _) => "tail downwash",
        (Part::Scas, _) => "SCAS washout",
        (Part::Drive, true) => "rotor speed and governor",
        (Part::Drive, false) if grows => "drive divergence",
        (Part::Drive, false) => "drive",
        (Part::Longitudinal, true) => longitudinal_oscillation(shares, &place),
        (Part::Lateral, true) => lateral_oscillation(&place),
        (Part::Longitudinal, false) => longitudinal_root(shares, &place, grows),
        (Part::Lateral, false) => lateral_root(shares, &place, grows),
    }
}

/// A mode among those of its kind: oscillations, or real roots, of its part.
struct Place {
    slowest: bool,
    fastest: bool,
    alone: bool,
    /// Whether it is one of hover.
    hovers: bool,
}

fn longitudinal_oscillation(shares: &Shares, place: &Place) -> &'static str {
    let of = |rigid| shares.of(rigid);
    let (u, w) = (of(Rigid::Forward), of(Rigid::Down));
    let incidence = max(w, of(Rigid::PitchRate)) > max(u, of(Rigid::Pitch));
    match place {
        Place { hovers: true, slowest: true, .. } => "hover oscillation in pitch",
        Place { hovers: true, fastest: true, .. } if incidence => "short period",
        Place { hovers: true, .. } => "longitudinal oscillation",
        Place { fastest: true, alone, .. } if !alone || w > u => "short period",
        Place { slowest: true, .. } => "phugoid",
        Place { .. } => "longitudinal oscillation",
    }
}

fn lateral_oscillation(place: &Place) -> &'static str {
    match place {
        Place { hovers: true, slowest: true, .. } => "hover oscillation in roll",
        Place { fastest: true, .. } => "Dutch roll",
        Place { hovers: true, .. } => "lateral oscillation",
        Place { .. } => "lateral phugoid",
    }
}

fn longitudinal_root(shares: &Shares, place: &Place, grows: bool) -> &'static str {
    let (u, w) = (shares.of(Rigid::Forward), shares.of(Rigid::Down));
    let pitch = max(shares.of(Rigid::PitchRate), shares.of(Rigid::Pitch));
    let (decaying, growing) = if w > u && w > pitch {
        let decaying = if place.hovers { "heave" } else { "heave subsidence" };
        (decaying, "heave divergence")
    } else if u > pitch {
        ("speed subsidence", "speed divergence")
    } else {
        ("pitch subsidence", "pitch divergence")
    };
    if grows { growing } else { decaying }
}

fn lateral_root(shares: &Shares, place: &Place, grows: bool) -> &'static str {
    let (v, r) = (shares.of(Rigid::Right), shares.of(Rigid::YawRate));
    let roll = max(shares.of(Rigid::RollRate), shares.of(Rigid::Roll));
    let textbook = !place.hovers;
    let (decaying, growing) =
        if textbook && place.fastest && (!place.alone || shares.of(Rigid::RollRate) > r) {
            ("roll subsidence", "roll divergence")
        } else if textbook && place.slowest {
            ("spiral", "spiral divergence")
        } else if r > roll && r > v {
            ("yaw subsidence", "yaw divergence")
        } else if v > roll {
            ("sideslip subsidence", "sideslip divergence")
        } else {
            ("roll subsidence", "roll divergence")
        };
    if grows { growing } else { decaying }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::Matrix;

    /// Eight real roots, each of one state of the rigid body.
    fn roots(of: [f64; 8]) -> Linear {
        Linear {
            states: Rigid::ALL.into_iter().map(Variable::Rigid).collect(),
            a: Matrix::from_diagonal(&nalgebra::DVector::from_column_slice(&of)),
            b: Matrix::zeros(8, 4),
            c: Matrix::zeros(13, 8),
            d: Matrix::zeros(13, 4),
        }
    }

    #[test]
    fn a_real_root_is_a_divergence_when_and_only_when_it_grows() {
        let of = [0.1, -0.2, 0.3, -0.4, 0.5, 0.6, 0.7, -0.8];
        for (scale, airspeed_mps) in [(1.0, 0.0), (-1.0, 0.0), (1.0, 80.0), (-1.0, 80.0)] {
            let found = modes(&roots(of.map(|root| scale * root)), airspeed_mps).unwrap();
            assert_eq!(found.len(), 8);
            for mode in found {
                let grows = mode.eigenvalue.re > 0.0;
                assert_eq!(mode.name.ends_with("divergence"), grows, "{mode:?}");
                assert!(!(grows && mode.name.contains("subsidence")), "{mode:?}");
            }
        }
    }

    #[test]
    fn real_roots_in_hover_are_called_after_the_state_that_leads_them() {
        let of = [0.1, -0.2, -0.3, -0.4, 0.5, -0.6, -0.7, -0.8];
        let names: Vec<_> =
            modes(&roots(of), 0.0).unwrap().into_iter().map(|mode| mode.name).collect();
        let expected = [
            "speed divergence",
            "sideslip subsidence",
            "heave",
            "roll subsidence",
            "pitch divergence",
            "yaw subsidence",
            "roll subsidence",
            "pitch subsidence",
        ];
        assert_eq!(names, expected);
    }

    /// Rounding may split a double root into a pair: there are two modes, and neither swings.
    #[test]
    fn a_repeated_real_root_does_not_swing() {
        let mut linear = roots([-1.0, -2.0, -3.0, -4.0, -5.0, -6.0, -7.0, -7.0]);
        linear.a[(6, 7)] = 1e-4;
        linear.a[(7, 6)] = -1e-13;
        let found = modes(&linear, 80.0).unwrap();
        assert_eq!(found.len(), 8);
        assert!(found.iter().all(|mode| !mode.swings()), "{found:?}");
    }

    #[test]
    fn a_fast_mode_is_set_aside_only_when_it_decays() {
        let mut of = [-0.1, -0.2, -0.3, -0.4, -0.5, -0.6, -0.7, -20.0];
        assert!(modes(&roots(of), 0.0).unwrap()[7].fast);
        of[7] = 20.0;
        assert!(!modes(&roots(of), 0.0).unwrap()[7].fast);
    }
}
