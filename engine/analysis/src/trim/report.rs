//! A trim by its numbers, and what of it the aircraft cannot do.

use engine::math::max;
use engine::pair::Pair;
use engine::{Aircraft, Outputs, State, engines};

use super::limit::Limit;

/// A trim by its numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// θ.
    pub pitch_rad: f64,
    /// φ.
    pub roll_rad: f64,
    /// α.
    pub alpha_rad: f64,
    /// β.
    pub beta_rad: f64,
    /// Upwards.
    pub climb_mps: f64,
    /// Longitudinal stick from the aft stop.
    pub stick_from_aft_m: f64,
    /// The same over the whole travel, 0 aft … 1 forward.
    pub stick_forward_norm: f64,
    /// Lateral stick from neutral, right positive.
    pub stick_right_m: f64,
    /// Pedals from neutral, right positive.
    pub pedal_right_m: f64,
    /// Power lever, 0..1.
    pub lever_norm: f64,
    /// θ at ¾ radius, mean of both rotors.
    pub collective_rad: f64,
    /// B1, mean of both rotors, stick forward positive.
    pub cyclic_forward_rad: f64,
    /// δe, trailing edge down.
    pub elevator_rad: f64,
    /// Of each rotor.
    pub thrust_n: Pair<f64>,
    /// Taken by both rotors.
    pub power_w: f64,
    /// That both engines could give at the rotor shafts.
    pub available_w: f64,
    /// Torque of the busier mast.
    pub torque_n_m: f64,
    /// Of both engines.
    pub fuel_flow_kg_per_s: f64,
    /// Wings and pylons push down by, in body axes.
    pub download_n: f64,
    /// Largest acceleration left: m/s², rad/s².
    pub residual: f64,
}

impl Report {
    pub(super) fn new(
        aircraft: &Aircraft,
        state: &State,
        outputs: &Outputs,
        residual: f64,
    ) -> Self {
        let travel = &aircraft.fcc.travel;
        let (pilot, surfaces) = (&state.cockpit, &state.actuators);
        let airspeed_mps = outputs.airspeed_mps;
        // A standing aircraft meets the air from nowhere.
        let moving = |angle_rad: f64| if airspeed_mps < 0.01 { 0.0 } else { angle_rad };
        Self {
            pitch_rad: outputs.euler.pitch_rad,
            roll_rad: outputs.euler.roll_rad,
            alpha_rad: moving(outputs.alpha_rad),
            beta_rad: moving(outputs.beta_rad),
            climb_mps: -state.plant.velocity_mps.z,
            stick_from_aft_m: travel.longitudinal_stick_m * (1.0 - pilot.stick_aft_norm),
            stick_forward_norm: 0.5 * (1.0 - pilot.stick_aft_norm),
            stick_right_m: travel.lateral_stick_m * pilot.stick_right_norm,
            pedal_right_m: travel.pedal_m * pilot.pedal_right_norm,
            lever_norm: pilot.collective_norm,
            collective_rad: surfaces.collective_rad.mean(),
            cyclic_forward_rad: surfaces.cyclic_forward_rad.mean(),
            elevator_rad: surfaces.elevator_rad,
            thrust_n: outputs.rotors.map(|rotor| rotor.thrust_n),
            power_w: outputs.rotors.map(|rotor| rotor.power_w).sum(),
            available_w: 2.0 * outputs.engines.available_w,
            torque_n_m: max(outputs.rotors.left.torque_n_m, outputs.rotors.right.torque_n_m),
            fuel_flow_kg_per_s: outputs.engines.fuel_flow_kg_per_s,
            download_n: outputs.loads.wing_pylon.sum().force_n.z,
            residual,
        }
    }
}

/// What the aircraft cannot do of a steady flight, and how much is asked of it.
pub(super) fn beyond(
    aircraft: &Aircraft,
    torque_n_m_max: f64,
    state: &State,
    outputs: &Outputs,
    report: &Report,
) -> Option<(Limit, f64)> {
    let pilot = &state.cockpit;
    let power_w_per_s = state.rate.engines.power_w_per_s;
    let engine_w = max(state.plant.engines.left.power_w, state.plant.engines.right.power_w);
    let lag_w = max(-power_w_per_s.left, -power_w_per_s.right) * aircraft.engines.lag_s;
    if lag_w > 1e-3 * aircraft.engines.rated_power_w {
        return Some((Limit::EnginePower, engine_w / max(engine_w - lag_w, 1.0)));
    }
    if -lag_w > 1e-3 * aircraft.engines.rated_power_w {
        return Some((Limit::IdlePower, engine_w / (engine_w - lag_w)));
    }
    // The engines give up to this in a hurry; what a mast may bear for long is for the pilot to mind.
    let torque_norm = engine_w / max(state.plant.rotor_speed_radps, 1.0) / torque_n_m_max;
    if torque_norm > engines::TORQUE_NORM_MAX {
        return Some((Limit::MastTorque, torque_norm));
    }
    for (what, norm) in [
        (Limit::LongitudinalStick, pilot.stick_aft_norm),
        (Limit::LateralStick, pilot.stick_right_norm),
        (Limit::Pedals, pilot.pedal_right_norm),
    ] {
        if norm.abs() > 1.0 {
            return Some((what, norm.abs()));
        }
    }
    let governor = &aircraft.fcc.governor;
    let low = governor.limit_rad(state.actuators.mast_tilt_rad.mean());
    let high = governor.collective_rad_max;
    if report.collective_rad < low - 1e-9 {
        return Some((Limit::CollectiveLow, report.collective_rad / low));
    }
    if report.collective_rad > high + 1e-9 {
        return Some((Limit::CollectiveHigh, report.collective_rad / high));
    }
    (outputs.landing_gear.main.right.push_n > 0.0).then_some((Limit::Ground, 1.0))
}
