//! Horizontal stabiliser with elevator, in the wakes of wing and rotors.
//!
//! # Equations
//! ```text
//! α_H = α_flow − ε + i_H, α_flow of V + ω×r + V_H from the rotors             [CR536 A-85 to A-88]
//! ε = ε(βm, α_WFS, δF)/√(1 − M²), which reaches the tail with the lag τ = l_H/V: τ·ε̇ = ε∞ − ε
//! CL = K_β(|β|)·CL(α_H, δe) + CL_Hβ·|β|        CD = CD(α_H + K_e·τe·δe)
//! K_e = X_Ke(M) − D_Ke·(|δe| − 15°)/15° beyond 15°
//! q_H = ½ρ·K_HNU(βm)·η(βm, α, V)·(U² + W²), U and W without the rotors
//! ```
//! # Signs
//! Elevator: trailing edge down positive. Forces stand on the flow at the tail, incidence excluded.
//! # Assumptions
//! The source's pressure factor K_HNU = .8 holds as an aeroplane, where its table of η is 1 throughout
//! and flight has the short period that .8 makes (2.0 rad/s; without it 2.8). As a helicopter η was
//! measured and is the whole of it: with another .8 the tail loads of the source's own trim printouts
//! come out a fifth too small, without it they agree. In between it sets in linearly, an assumption.
//! Above Mach .2 the high-speed tables take the elevator as a change of angle. CL_Hβ counts up to 20° of
//! sideslip. No pitching moment.

use serde::{Deserialize, Serialize};

use super::polar::ByMach;
use super::{LocalFlow, in_body_axes, load_at};
use crate::frames::{Body, Load, Structural, Vec3};
use crate::math::{atan2, max, min, sqrt, square, wrap_angle};
use crate::motion::Motion;
use crate::table::axis::{Airspeed, Alpha, Beta, ElevatorAngle, FlapAngle, Mach, MastTilt};
use crate::table::{Invalid, Table1, Table2, Table3, all_valid};
use crate::units::DEGREE_RAD as DEG;

/// Elevator angle from which it loses effect.
const ELEVATOR_FULL_RAD: f64 = 15.0 * DEG;
/// Sideslip beyond this changes the lift no more.
const SIDESLIP_RAD_MAX: f64 = 20.0 * DEG;
/// Slower than this the wing's wake reaches the tail no later.
const WAKE_MPS_MIN: f64 = 3.0;
/// Compressibility counts up to here.
const MACH_MAX: f64 = 0.8;

/// What the stabiliser is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// S.
    pub area_m2: f64,
    /// Reference point.
    pub centre_m: Vec3<Structural>,
    /// i_H.
    pub incidence_rad: f64,
    /// l_H, from the wing.
    pub wake_length_m: f64,
    /// τe.
    pub elevator_effect: f64,
    /// D_Ke.
    pub elevator_loss: f64,
    /// X_Ke over Mach number.
    pub elevator_by_mach: Table1<Mach>,
    /// CL over α_H and δe, at Mach number .2 and below.
    pub lift: Table2<Alpha, ElevatorAngle>,
    /// CL above, over the angle with the elevator; odd.
    pub lift_by_mach: ByMach<Alpha>,
    /// CD over the angle with the elevator, at Mach number .2 and below.
    pub drag: Table1<Alpha>,
    /// CD above.
    pub drag_by_mach: ByMach<Alpha>,
    /// CL_Hβ.
    pub lift_by_sideslip_per_rad: f64,
    /// K_β over |β|.
    pub sideslip_factor: Table1<Beta>,
    /// ε over mast tilt, α_WFS and flap.
    pub downwash_rad: Table3<MastTilt, Alpha, FlapAngle>,
    /// η over mast tilt, angle of attack and airspeed.
    pub pressure_ratio: Table3<MastTilt, Alpha, Airspeed>,
    /// K_HNU over mast tilt.
    pub pressure_factor: Table1<MastTilt>,
}

/// What the stabiliser remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// ε at the tail.
    pub downwash_rad: f64,
}

/// How fast the state changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// Of ε.
    pub downwash_radps: f64,
}

/// What the stabiliser reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// The flow that the whole aircraft meets.
    pub flow: LocalFlow,
    /// Mach number.
    pub mach: f64,
    /// α_WFS.
    pub wing_alpha_rad: f64,
    /// Velocity through the rotors' wake.
    pub wake_mps: Vec3<Body>,
    /// Mean βm.
    pub mast_tilt_rad: f64,
    /// Flap.
    pub flap_rad: f64,
    /// δe.
    pub elevator_rad: f64,
    /// η.
    pub pressure_ratio: f64,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        all_valid([
            ("horizontal_stabilizer.elevator_by_mach", self.elevator_by_mach.validate()),
            ("horizontal_stabilizer.lift", self.lift.validate()),
            ("horizontal_stabilizer.lift_by_mach", self.lift_by_mach.validate()),
            ("horizontal_stabilizer.drag", self.drag.validate()),
            ("horizontal_stabilizer.drag_by_mach", self.drag_by_mach.validate()),
            ("horizontal_stabilizer.sideslip_factor", self.sideslip_factor.validate()),
            ("horizontal_stabilizer.downwash", self.downwash_rad.validate()),
            ("horizontal_stabilizer.pressure_ratio", self.pressure_ratio.validate()),
            ("horizontal_stabilizer.pressure_factor", self.pressure_factor.validate()),
        ])
    }

    /// ε∞: the wing's downwash as it will be at the tail.
    pub fn downwash(&self, inputs: &Inputs) -> f64 {
        let alpha = Alpha(wrap_angle(inputs.wing_alpha_rad));
        let (tilt, flap) = (MastTilt(inputs.mast_tilt_rad), FlapAngle(inputs.flap_rad));
        let slow = self.downwash_rad.at(tilt, alpha, flap);
        slow / sqrt(1.0 - square(min(inputs.mach, MACH_MAX)))
    }

    /// η, which the fins share.
    pub fn pressure_ratio_at(&self, mast_tilt_rad: f64, flow: &LocalFlow) -> f64 {
        let (tilt, alpha) = (MastTilt(mast_tilt_rad), Alpha(flow.alpha_rad));
        self.pressure_ratio.at(tilt, alpha, Airspeed(flow.speed_mps))
    }
}

/// Load of the stabiliser, and the rate of its state.
pub fn evaluate(params: &Params, state: &State, inputs: &Inputs) -> (Rate, Load) {
    let whole = inputs.flow;
    let rate = Rate {
        downwash_radps: (params.downwash(inputs) - state.downwash_rad)
            * max(whole.speed_mps, WAKE_MPS_MIN)
            / params.wake_length_m,
    };

    let arm = params.centre_m.from_cg(inputs.motion.cg_m);
    let own_mps = inputs.motion.velocity_at(arm);
    let velocity = own_mps + inputs.wake_mps;
    let flow_rad = atan2(velocity.z, velocity.x) - state.downwash_rad;
    let alpha = wrap_angle(flow_rad + params.incidence_rad);
    let beyond = max(0.0, inputs.elevator_rad.abs() / ELEVATOR_FULL_RAD - 1.0);
    let effect = params.elevator_by_mach.at(Mach(inputs.mach)) - params.elevator_loss * beyond;
    let with_elevator =
        Alpha(wrap_angle(alpha + effect * params.elevator_effect * inputs.elevator_rad));

    let slow = params.lift.at(Alpha(alpha), ElevatorAngle(inputs.elevator_rad));
    let along = params.lift_by_mach.odd_at(inputs.mach, with_elevator, slow);
    let beta = whole.beta_rad.abs();
    let lift = params.sideslip_factor.at(Beta(beta)) * along
        + params.lift_by_sideslip_per_rad * min(beta, SIDESLIP_RAD_MAX);
    let drag = params.drag_by_mach.at(inputs.mach, with_elevator, params.drag.at(with_elevator));

    let ratio = params.pressure_factor.at(MastTilt(inputs.mast_tilt_rad)) * inputs.pressure_ratio;
    let pressure_area = 0.5
        * inputs.motion.density_kg_per_m3
        * ratio
        * (square(own_mps.x) + square(own_mps.z))
        * params.area_m2;
    let force = in_body_axes(pressure_area * lift, pressure_area * drag, 0.0, flow_rad);
    (rate, load_at(force, arm, 0.0))
}
