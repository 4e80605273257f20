//! Actuators: what stands between a command and the surface it moves.
//!
//! # Equations
//! ```text
//! x' = x + clamp((c − x)·(1 − e^(−h/τ)), ±ẋ_max·h),  x_min ≤ x' ≤ x_max     one tick h
//! nacelles: β̇m = ∓rate(βm) while the switch is held, stopped at the ends      [CR536 8a-V]
//! ```
//! # Signs
//! As the commands; nacelle switch aft (towards the helicopter) positive, which lowers βm.
//! # Assumptions
//! First-order; no published constants exist, so lags and rates are estimates. Both nacelles move
//! together: their interconnect does not fail.

use serde::{Deserialize, Serialize};

use crate::STEP_S;
use crate::controls::Commands;
use crate::math::{clamp, exp};
use crate::pair::Pair;
use crate::table::Table1;
use crate::table::axis::MastTilt;

/// One kind of actuator.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Actuator {
    /// τ.
    pub lag_s: f64,
    /// ẋ_max.
    pub rate_radps_max: f64,
    /// Travel one way.
    pub rad_min: f64,
    /// Travel the other way.
    pub rad_max: f64,
}

/// What the actuators are.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Collective pitch at ¾ radius.
    pub collective: Actuator,
    /// Longitudinal and lateral cyclic.
    pub cyclic: Actuator,
    /// Elevator.
    pub elevator: Actuator,
    /// Flaperon beyond the flap's setting.
    pub flaperon: Actuator,
    /// Rudder.
    pub rudder: Actuator,
    /// Flap.
    pub flap: Actuator,
    /// Nacelle rate over mast tilt.
    pub nacelle_radps: Table1<MastTilt>,
    /// Mast tilt at the aft stop.
    pub mast_tilt_rad_min: f64,
    /// Mast tilt at the down stop.
    pub mast_tilt_rad_max: f64,
    /// Time of a gear cycle.
    pub gear_s: f64,
}

/// 1 − e^(−h/τ) of each kind: what part of the way to its command it goes in a tick.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    collective: f64,
    cyclic: f64,
    elevator: f64,
    flaperon: f64,
    rudder: f64,
    flap: f64,
}

impl Params {
    /// What follows from the lags.
    pub fn parts(&self) -> Parts {
        Parts {
            collective: self.collective.part(),
            cyclic: self.cyclic.part(),
            elevator: self.elevator.part(),
            flaperon: self.flaperon.part(),
            rudder: self.rudder.part(),
            flap: self.flap.part(),
        }
    }
}

/// Where everything is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// θ at ¾ radius.
    pub collective_rad: Pair<f64>,
    /// B1.
    pub cyclic_forward_rad: Pair<f64>,
    /// A1, tilting the discs outboard.
    pub cyclic_outboard_rad: Pair<f64>,
    /// δe.
    pub elevator_rad: f64,
    /// Beyond the flap's setting, down.
    pub flaperon_rad: Pair<f64>,
    /// δr, trailing edge right.
    pub rudder_right_rad: f64,
    /// Flap.
    pub flap_rad: f64,
    /// βm.
    pub mast_tilt_rad: Pair<f64>,
    /// β̇m during the last tick.
    pub mast_tilt_rate_radps: Pair<f64>,
    /// 0 up … 1 down.
    pub gear_extension_norm: f64,
    /// Power lever.
    pub lever_norm: f64,
    /// Wheel brakes.
    pub brake_norm: Pair<f64>,
}

impl Actuator {
    fn part(&self) -> f64 {
        1.0 - exp(-STEP_S / self.lag_s)
    }

    fn toward(&self, part: f64, position_rad: f64, command_rad: f64) -> f64 {
        let step_rad = (command_rad - position_rad) * part;
        let step_rad_max = self.rate_radps_max * STEP_S;
        clamp(
            position_rad + clamp(step_rad, -step_rad_max, step_rad_max),
            self.rad_min,
            self.rad_max,
        )
    }
}

/// Positions one tick later; `parts` are those of [`Params::parts`].
pub fn update(params: &Params, parts: &Parts, state: &State, commands: &Commands) -> State {
    let both = |actuator: &Actuator, part: f64, position: Pair<f64>, command: Pair<f64>| {
        position.zip(command).map(|(at, to)| actuator.toward(part, at, to))
    };
    let mast_tilt_rad = state.mast_tilt_rad.map(|tilt_rad| {
        let rate_radps = -commands.nacelle_aft_norm * params.nacelle_radps.at(MastTilt(tilt_rad));
        clamp(tilt_rad + rate_radps * STEP_S, params.mast_tilt_rad_min, params.mast_tilt_rad_max)
    });
    let gear_step = STEP_S / params.gear_s;
    let gear_wanted = if commands.gear_down != 0 { 1.0 } else { 0.0 };
    State {
        collective_rad: both(
            &params.collective,
            parts.collective,
            state.collective_rad,
            commands.collective_rad,
        ),
        cyclic_forward_rad: both(
            &params.cyclic,
            parts.cyclic,
            state.cyclic_forward_rad,
            commands.cyclic_forward_rad,
        ),
        cyclic_outboard_rad: both(
            &params.cyclic,
            parts.cyclic,
            state.cyclic_outboard_rad,
            commands.cyclic_outboard_rad,
        ),
        elevator_rad: params.elevator.toward(
            parts.elevator,
            state.elevator_rad,
            commands.elevator_rad,
        ),
        flaperon_rad: both(
            &params.flaperon,
            parts.flaperon,
            state.flaperon_rad,
            commands.flaperon_rad,
        ),
        rudder_right_rad: params.rudder.toward(
            parts.rudder,
            state.rudder_right_rad,
            commands.rudder_right_rad,
        ),
        flap_rad: params.flap.toward(parts.flap, state.flap_rad, commands.flap_rad),
        mast_tilt_rad,
        mast_tilt_rate_radps: mast_tilt_rad
            .zip(state.mast_tilt_rad)
            .map(|(now, before)| (now - before) / STEP_S),
        gear_extension_norm: state.gear_extension_norm
            + clamp(gear_wanted - state.gear_extension_norm, -gear_step, gear_step),
        lever_norm: commands.lever_norm,
        brake_norm: commands.brake_norm,
    }
}

/// Where everything comes to rest under commands that stand, the nacelles standing where they are.
pub fn settled(params: &Params, state: &State, commands: &Commands) -> State {
    let at = |actuator: &Actuator, command_rad: f64| {
        clamp(command_rad, actuator.rad_min, actuator.rad_max)
    };
    State {
        collective_rad: commands.collective_rad.map(|rad| at(&params.collective, rad)),
        cyclic_forward_rad: commands.cyclic_forward_rad.map(|rad| at(&params.cyclic, rad)),
        cyclic_outboard_rad: commands.cyclic_outboard_rad.map(|rad| at(&params.cyclic, rad)),
        elevator_rad: at(&params.elevator, commands.elevator_rad),
        flaperon_rad: commands.flaperon_rad.map(|rad| at(&params.flaperon, rad)),
        rudder_right_rad: at(&params.rudder, commands.rudder_right_rad),
        flap_rad: at(&params.flap, commands.flap_rad),
        mast_tilt_rad: state.mast_tilt_rad,
        mast_tilt_rate_radps: Pair::both(0.0),
        gear_extension_norm: if commands.gear_down != 0 { 1.0 } else { 0.0 },
        lever_norm: commands.lever_norm,
        brake_norm: commands.brake_norm,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_actuator_lags_and_keeps_to_its_rate_and_travel() {
        let actuator = Actuator { lag_s: 0.1, rate_radps_max: 0.5, rad_min: -0.1, rad_max: 0.1 };
        let part = actuator.part();
        let slow = actuator.toward(part, 0.0, 10.0);
        assert!((slow - 0.5 * STEP_S).abs() < 1e-15);
        let free = actuator.toward(part, 0.0, 0.01);
        assert!((free - 0.01 * (1.0 - exp(-0.04))).abs() < 1e-15);
        assert!((actuator.toward(part, 0.0999, 5.0) - 0.1).abs() < 1e-15);
    }
}
