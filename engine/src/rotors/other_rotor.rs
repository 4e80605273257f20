//! The other rotor: what its wake does to the air that this one meets.
//!
//! # Equations
//! ```text
//! ΔVc = (X_SS(|u|/ΩR) + k·X_SF(μ_s)) · v0 of the other rotor      X_SF, X_SS: [CR536 1-II, 1-III]
//! μ_s = −v/ΩR where the other rotor is upwind, 0 where it is downwind
//! k = 1 − d/2,  d = S·|u|/√(u² + v²),  at least 0                 S: distance of the hubs, parts of R
//! ```
//! # Signs
//! u forward and v to the right: the hub's in the disc's plane, as the right rotor sees them; its
//! neighbour is on its left. ΔVc adds to the hub's speed along the thrust: a downwash is positive,
//! as a climb is.
//! # Assumptions
//! In forward flight either rotor stands in the upwash beside the other's wake (X_SS, up to −.085). The
//! induced velocities of CR537's four trims agree with momentum theory times 1 + X_SS to .2 %, a
//! constant tip loss aside, and without it to 8 % (a test). In sideward flight the rotor downwind
//! stands in the wake of the other (X_SF). How the source joins the two when the flow comes from ahead
//! and from the side at once is not at hand: k is an estimate, the part of the disc's breadth on which
//! the other's wake lies when it is blown straight downwind, as broad as a disc. It is all of it in flight
//! straight to the side, and none from 39° of that towards forward flight, where wakes pass side by
//! side. The wake arrives at once.

use serde::Deserialize;

use super::elements::Flow;
use crate::math::{max, sqrt, square};
use crate::table::axis::AdvanceRatio;
use crate::table::{Invalid, Table1, all_valid};

/// Rotors that stand still have no advance ratio, and divide by something, m/s at the tip.
const TIP_MPS_MIN: f64 = 10.0;
/// Keeps still air from dividing by nothing, m/s.
const STILL_MPS: f64 = 1e-6;

/// How one rotor's wake acts on the other.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// X_SF over the advance ratio to the side.
    pub downwind: Table1<AdvanceRatio>,
    /// X_SS over the advance ratio ahead.
    pub abreast: Table1<AdvanceRatio>,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        all_valid([
            ("rotors.other_rotor.downwind", self.downwind.validate()),
            ("rotors.other_rotor.abreast", self.abreast.validate()),
        ])
    }
}

/// ΔVc over the other rotor's induced velocity; `flow` is this rotor's, as of a right one, and
/// `spacing_m` the distance of the hubs.
pub fn factor(params: &Params, flow: &Flow, spacing_m: f64, radius_m: f64) -> f64 {
    let tip_mps = max(flow.omega_radps.abs() * radius_m, TIP_MPS_MIN);
    let abreast = params.abreast.at(AdvanceRatio(flow.forward_mps.abs() / tip_mps));
    if flow.right_mps >= 0.0 {
        return abreast;
    }
    let edgewise_mps = sqrt(square(flow.forward_mps) + square(flow.right_mps)) + STILL_MPS;
    let apart = spacing_m / radius_m * flow.forward_mps.abs() / edgewise_mps;
    let covered = max(0.0, 1.0 - 0.5 * apart);
    abreast + covered * params.downwind.at(AdvanceRatio(-flow.right_mps / tip_mps))
}
