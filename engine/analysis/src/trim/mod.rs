//! Trim: the steady flight that was asked for, and the state that flies it.
//!
//! # Equations
//! ```text
//! u̇ = 0, ω̇ = 0 in body axes,  Ω̇ = 0,  ṡ = 0                       s: inner states of the plant
//! u̇ = Rᵀ·V̇ − ω×u               ω = ψ̇·(−sin θ, sin φ·cos θ, cos φ·cos θ)       steady turn  [STEVENS]
//! v = V·sin β  by the heading ψ off the track                             from θ, φ and the climb
//! ```
//! Unknown are pitch, stick, collective and engine power (or, with the lever given, the climb); in flight
//! that is not symmetric roll, lateral stick and pedals too; and every inner state of the plant
//! ([`Inner::of_plant`](crate::variable::Inner::of_plant)). Newton's method with central differences and a line search finds
//! them together; [`engine::step::derivatives`] says how a trial changes.
//!
//! Lever, governor and SCAS follow from what was found: the lever that keeps the engines' power, the
//! governor's correction that makes up the collective.
//!
//! # Signs
//! Those of the blocks. Climb positive upwards, turn positive to the right, sideslip from the right
//! positive.
//! # Assumptions
//! The wind is part of the world and counts as moving air; fuel burns, and density changes in a
//! climb: both are so slow that the flight counts as steady. With the wings level, no turn and both engines
//! alike only the symmetric motion is solved, which makes the lateral quantities exactly zero.

use engine::Aircraft;
use engine::math::{PI, clamp, cos, max, sin, square};

mod columns;
mod found;
mod limit;
mod newton;
mod problem;
mod report;
mod residual;
mod settle;
mod target;

pub use columns::{COLUMNS, Column};
pub use found::{Failure, Trim};
pub use limit::Limit;
use problem::{Problem, unlimited};
pub use report::Report;
pub use residual::{Equation, Residual};
pub use settle::settle;
pub use target::{GROUND_FAR_BELOW_M, Power, Target};

/// Finds the steady flight.
///
/// # Errors
/// When there is none, or the aircraft cannot fly it.
pub fn trim(aircraft: &Aircraft, target: &Target) -> Result<Trim, Failure> {
    let aircraft = &unlimited(aircraft);
    let mut best = None;
    for pitch_rad in [guess_pitch(target), 0.0, 0.14, -0.14] {
        let problem = Problem::new(aircraft, target)?;
        let guess = problem.guess(pitch_rad);
        match problem.solve(guess) {
            Err(Failure::Unsteady { residual, of }) => {
                if best.as_ref().is_none_or(|(least, _)| residual < *least) {
                    best = Some((residual, of));
                }
            }
            done => return done,
        }
    }
    let (residual, of) = best.unwrap_or_default();
    Err(Failure::Unsteady { residual, of })
}

/// Finds the steady flight from one that is near it, and without one otherwise.
///
/// # Errors
/// When there is none, or the aircraft cannot fly it.
pub fn trim_near(aircraft: &Aircraft, target: &Target, near: &Trim) -> Result<Trim, Failure> {
    let unlimited = unlimited(aircraft);
    let problem = Problem::new(&unlimited, target)?;
    let guess = problem.like(near);
    match problem.solve(guess) {
        Err(Failure::Unsteady { .. }) => trim(aircraft, target),
        done => done,
    }
}

/// Slow flight takes about level attitudes, an aeroplane some incidence at low speed.
fn guess_pitch(target: &Target) -> f64 {
    let speed = max(target.airspeed_mps, 1.0);
    let aeroplane = sin(target.mast_tilt_rad) * clamp(400.0 / square(speed), 0.0, 0.15);
    let helicopter = -cos(target.mast_tilt_rad) * clamp(0.002 * speed, 0.0, 0.15);
    aeroplane + helicopter
}

/// The reference model counts collective at the root of its linearly twisted blade:
/// θ_root = θ¾ + 30.75°, rad.
pub const ROOT_FROM_THREE_QUARTERS_RAD: f64 = 30.75 * PI / 180.0;
