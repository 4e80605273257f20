//! Trim: the steady flight that was asked for, and the state that flies it.
//!
//! # Equations
//! ```text
//! u̇ = 0, ω̇ = 0 in body axes,  Ω̇ = 0,  ṡ = 0                       s: inner states of the plant
//! u̇ = Rᵀ·V̇ − ω×u               ω = ψ̇·(−sin θ, sin φ·cos θ, cos φ·cos θ)       steady turn  [STEVENS]
//! v = V·sin β  by the heading ψ off the track                             from θ, φ and the climb
//! ```
//! Unknown are pitch, stick, collective and engine power (or, with the lever given, the climb); in flight
//! that is not symmetric roll, lateral stick and pedals too; and every inner state of the plant,
//! whatever the blocks remember. Newton's method with central differences and a line search finds
//! them together; [`step::derivatives`] says where a trial is heading.
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

use alloc::boxed::Box;
use alloc::string::String;

use crate::frames::Vec3;
use crate::inputs::{World, failures};
use crate::math::{PI, clamp, cos, max, sin, square};
use crate::state::{Geodetic, State};
use crate::{Aircraft, Outputs};

mod inner;
mod newton;
mod problem;
mod report;

pub use inner::settle;
pub(crate) use inner::{accelerations, inner_states, numbers, set_numbers};
use problem::Problem;
pub use report::Report;

/// A steady flight to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// βm.
    pub mast_tilt_rad: f64,
    /// True airspeed.
    pub airspeed_mps: f64,
    /// What the engines are to do.
    pub power: Power,
    /// ψ̇, to the right positive.
    pub turn_radps: f64,
    /// β.
    pub sideslip_rad: f64,
    /// Where the nose points.
    pub heading_rad: f64,
    /// Above mean sea level.
    pub altitude_m: f64,
    /// The origin of NED, and the ground there.
    pub origin: Geodetic,
    /// Fuel aboard.
    pub fuel_kg: f64,
    /// Flap lever's detent, 0..3.
    pub flap_detent: u64,
    /// Rotor speed selected: 0 helicopter, 1 and 2 aeroplane.
    pub rpm_select: u64,
    /// 1 with the gear down.
    pub gear_down: u64,
    /// 1 with the SCAS on; it is centred.
    pub scas_on: u64,
    /// The world. Its ground is what the rotors feel under them.
    pub world: World,
}

/// What the engines are to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Power {
    /// Whatever this climb takes, m/s upwards.
    Climb(f64),
    /// What the lever gives at this position, 0..1; the climb follows.
    Lever(f64),
}

/// Ground that no rotor feels, m.
pub const GROUND_FAR_BELOW_M: f64 = -1e5;

impl Default for Target {
    /// Hover as a helicopter at sea level, far from the ground, flaps 40/25, gear up.
    fn default() -> Self {
        Self {
            mast_tilt_rad: 0.0,
            airspeed_mps: 0.0,
            power: Power::Climb(0.0),
            turn_radps: 0.0,
            sideslip_rad: 0.0,
            heading_rad: 0.0,
            altitude_m: 0.0,
            origin: Geodetic::default(),
            fuel_kg: 669.0,
            flap_detent: 2,
            rpm_select: 0,
            gear_down: 0,
            scas_on: 0,
            world: World { ground_height_m: GROUND_FAR_BELOW_M, ..World::default() },
        }
    }
}

impl Target {
    fn is_symmetric(&self) -> bool {
        let engines = failures::ENGINE_LEFT | failures::ENGINE_RIGHT;
        let failed = self.world.failures & engines;
        self.turn_radps == 0.0
            && self.sideslip_rad == 0.0
            && (failed == 0 || failed == engines)
            && self.world.wind_mps == Vec3::zero()
    }
}

/// A steady flight that was found.
#[derive(Clone, Debug)]
pub struct Trim {
    /// Everything the aircraft remembers in it.
    pub state: State,
    /// What can be observed in it.
    pub outputs: Outputs,
    /// In words that a pilot knows.
    pub report: Report,
}

/// Why there is no trim.
#[derive(Clone, Debug)]
pub enum Failure {
    /// No steady flight was found.
    Unsteady {
        /// Largest acceleration in the best trial: m/s², rad/s².
        residual: f64,
        /// Of what.
        of: String,
    },
    /// There is a steady flight, but the aircraft cannot fly it.
    Beyond {
        /// What is asked for too much of.
        what: &'static str,
        /// How much, 1 being all there is.
        wanted_norm: f64,
        /// The flight, with that control at its stop.
        trim: Box<Trim>,
    },
    /// What was asked for makes no sense.
    Senseless(&'static str),
}

impl core::fmt::Display for Failure {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unsteady { residual, of } => {
                let unit = match of.as_str() {
                    "acceleration forward" | "acceleration down" | "acceleration to the right" => {
                        " m/s²"
                    }
                    "pitch acceleration" | "rotor acceleration" | "roll acceleration"
                    | "yaw acceleration" => " rad/s²",
                    // Inner states have their unit in the name, power is relative.
                    _ => "",
                };
                write!(f, "no steady flight found: {of} is left with {residual:.2e}{unit}")
            }
            Self::Beyond { what, wanted_norm, .. } => {
                write!(
                    f,
                    "beyond the aircraft: {what} at {:.0} % of its limit",
                    100.0 * wanted_norm
                )
            }
            Self::Senseless(what) => f.write_str(what),
        }
    }
}

impl core::error::Error for Failure {}

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

/// The engines give the torque that is needed: where that is too much is told afterwards.
fn unlimited(aircraft: &Aircraft) -> Unlimited {
    let torque_n_m_max = aircraft.engines.torque_n_m_max;
    let aircraft = aircraft.clone().with(|params| params.engines.torque_n_m_max = 1e9);
    Unlimited { aircraft, torque_n_m_max }
}

/// An aircraft whose engines know no limit of torque, and that limit.
struct Unlimited {
    aircraft: Aircraft,
    torque_n_m_max: f64,
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
