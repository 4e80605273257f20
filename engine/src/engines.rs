//! Engines and drive: two turboshafts on one cross-shafted pair of rotors.
//!
//! # Equations
//! ```text
//! P_available = P_rated·δ·√θ·(1 − k1·(θ − 1) − k2·(θ − 1)²)      [through TMX §6]
//! P_wanted = P_available·(f_idle + (1 − f_idle)·f(lever))         [CR536 8a-VI for f]
//! Ṗ = (P_wanted − P)/τ
//! J·Ω̇ = (P_L + P_R)/Ω − Q_L − Q_R         each engine's torque within its limit
//! fuel flow = sfc·P + δ·√θ·idle flow               referred flow over referred power
//! ```
//! # Signs
//! Torque of the engines drives, torque of the rotors is needed; both positive.
//! # Assumptions
//! Stiff shafts, one speed for both rotors; power by rating only, no gas-generator dynamics; both
//! levers together.

use serde::{Deserialize, Serialize};

use crate::frames::{Body, Load, Structural, Vec3};
use crate::inputs::{Failures, World};
use crate::isa::{PRESSURE_SL_PA, TEMPERATURE_SL_K};
use crate::math::{clamp, max, min, sqrt};
use crate::pair::Pair;
use crate::table::Table1;
use crate::table::axis::EngineLever;

/// An engine's torque goes up to this, over the continuous limit.
pub const TORQUE_NORM_MAX: f64 = 1.3;

/// What engines and drive are.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Power of one engine at its rotor shaft, take-off rating, sea level standard.
    pub rated_power_w: f64,
    /// k1: loss with temperature beyond √θ.
    pub temperature_loss: f64,
    /// k2: how it grows with heat, and what cold gains shrinks.
    pub temperature_loss_growth: f64,
    /// f_idle: part of the available power at the bottom of the lever.
    pub idle_power_norm: f64,
    /// f over lever position, 0..1.
    pub power_by_lever_norm: Table1<EngineLever>,
    /// τ.
    pub lag_s: f64,
    /// Continuous torque limit of one mast.
    pub torque_n_m_max: f64,
    /// Drive train inertia at mast speed, both sides together.
    pub drive_inertia_kg_m2: f64,
    /// Fuel per shaft energy.
    pub fuel_kg_per_j: f64,
    /// Fuel flow of one running engine that drives nothing, at sea level standard.
    pub fuel_idle_kg_per_s: f64,
    /// Residual jet thrust of one engine at rated power.
    pub jet_thrust_n: f64,
}

/// What an engine remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Power at the rotor shaft.
    pub power_w: f64,
}

/// What the engines read.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// Power lever, 0..1.
    pub lever_norm: f64,
    /// Ω.
    pub rotor_speed_radps: f64,
    /// Needed by the rotors.
    pub rotor_torque_n_m: Pair<f64>,
    /// Both rotors' polar inertia.
    pub rotor_inertia_kg_m2: f64,
    /// p.
    pub pressure_pa: f64,
    /// T.
    pub temperature_k: f64,
    /// Fuel aboard.
    pub fuel_kg: f64,
    /// For what has failed.
    pub world: World,
}

/// What the engines give.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// Power delivered.
    pub power_w: Pair<f64>,
    /// Torque delivered at the mast.
    pub torque_n_m: Pair<f64>,
    /// Power that one engine could deliver.
    pub available_w: f64,
    /// Fuel used by both.
    pub fuel_flow_kg_per_s: f64,
    /// Residual jet thrust of each.
    pub jet_thrust_n: Pair<f64>,
}

/// How fast the state changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// Of each engine's power.
    pub power_w_per_s: Pair<f64>,
    /// Of the rotor speed.
    pub rotor_speed_radps2: f64,
    /// Of the fuel aboard.
    pub fuel_kg_per_s: f64,
}

/// Power, torque, fuel and the rotors' acceleration.
pub fn evaluate(params: &Params, state: &Pair<State>, inputs: &Inputs) -> (Rate, Outputs) {
    let theta = inputs.temperature_k / TEMPERATURE_SL_K;
    let referred = inputs.pressure_pa / PRESSURE_SL_PA * sqrt(theta);
    let hotter = theta - 1.0;
    let by_temperature =
        1.0 - hotter * (params.temperature_loss + params.temperature_loss_growth * hotter);
    let available_w = max(0.0, params.rated_power_w * referred * by_temperature);
    let power_norm = params.power_by_lever_norm.at(EngineLever(inputs.lever_norm));
    let wanted_w =
        available_w * (params.idle_power_norm + (1.0 - params.idle_power_norm) * power_norm);
    let running = Pair {
        left: !inputs.world.failed(Failures::ENGINE_LEFT) && inputs.fuel_kg > 0.0,
        right: !inputs.world.failed(Failures::ENGINE_RIGHT) && inputs.fuel_kg > 0.0,
    };
    let power_w_per_s = running.zip(*state).map(|(running, engine)| {
        let target_w = if running { wanted_w } else { 0.0 };
        (target_w - engine.power_w) / params.lag_s
    });

    // A stopped rotor cannot take power; the limit keeps the torque finite.
    let omega = max(inputs.rotor_speed_radps, 1.0);
    let torque_n_m = state
        .map(|engine| clamp(engine.power_w / omega, 0.0, TORQUE_NORM_MAX * params.torque_n_m_max));
    let inertia = inputs.rotor_inertia_kg_m2 + params.drive_inertia_kg_m2;
    let rotor_speed_radps2 = (torque_n_m.sum() - inputs.rotor_torque_n_m.sum()) / inertia;
    let fuel_flow_kg_per_s = running
        .zip(*state)
        .map(|(running, engine)| {
            if running {
                referred * params.fuel_idle_kg_per_s + params.fuel_kg_per_j * engine.power_w
            } else {
                0.0
            }
        })
        .sum();
    let jet_thrust_n =
        state.map(|engine| params.jet_thrust_n * min(1.0, engine.power_w / params.rated_power_w));
    let rate = Rate { power_w_per_s, rotor_speed_radps2, fuel_kg_per_s: -fuel_flow_kg_per_s };
    let outputs = Outputs {
        power_w: state.map(|engine| engine.power_w),
        torque_n_m,
        available_w,
        fuel_flow_kg_per_s,
        jet_thrust_n,
    };
    (rate, outputs)
}

/// Load of the right engine's jet, along its mast.
pub fn jet(
    thrust_n: f64,
    thrust_axis: Vec3<Body>,
    pivot_m: Vec3<Structural>,
    cg_m: Vec3<Structural>,
) -> Load {
    Load::at(thrust_axis * thrust_n, pivot_m.from_cg(cg_m))
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    fn params() -> Params {
        Params {
            rated_power_w: 1e6,
            temperature_loss: 2.9,
            temperature_loss_growth: 0.0,
            idle_power_norm: 0.1,
            power_by_lever_norm: Table1::new(vec![0.0, 1.0], vec![0.0, 1.0]),
            lag_s: 0.5,
            torque_n_m_max: 18e3,
            drive_inertia_kg_m2: 150.0,
            fuel_kg_per_j: 1e-7,
            fuel_idle_kg_per_s: 0.02,
            jet_thrust_n: 370.0,
        }
    }

    fn inputs() -> Inputs {
        Inputs {
            lever_norm: 1.0,
            rotor_speed_radps: 60.0,
            rotor_torque_n_m: Pair::both(5_000.0),
            rotor_inertia_kg_m2: 850.0,
            pressure_pa: PRESSURE_SL_PA,
            temperature_k: TEMPERATURE_SL_K,
            fuel_kg: 100.0,
            world: World::default(),
        }
    }

    #[test]
    fn full_lever_gives_rated_power_at_sea_level() {
        let state = Pair::both(State { power_w: 1e6 });
        let (rate, out) = evaluate(&params(), &state, &inputs());
        assert!((out.available_w - 1e6).abs() < 1e-6);
        assert!(rate.power_w_per_s.left.abs() < 1e-6);
    }

    #[test]
    fn a_failed_engine_runs_down_and_the_other_does_not() {
        let mut inputs = inputs();
        inputs.world.failures = Failures::ENGINE_LEFT;
        let state = Pair::both(State { power_w: 5e5 });
        let (rate, _) = evaluate(&params(), &state, &inputs);
        assert!(rate.power_w_per_s.left < 0.0 && rate.power_w_per_s.right > 0.0);
    }

    #[test]
    fn surplus_torque_speeds_the_rotors_up() {
        let state = Pair::both(State { power_w: 6e5 });
        let (rate, _) = evaluate(&params(), &state, &inputs());
        assert!((rate.rotor_speed_radps2 - (20_000.0 - 10_000.0) / 1_000.0).abs() < 1e-9);
    }
}
