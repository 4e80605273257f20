//! Flight control computer: SCAS, collective governor and mixer.

pub mod governor;
pub mod mixer;
pub mod scas;
pub mod sensed;

use serde::{Deserialize, Serialize};

pub use self::sensed::Sensed;
use crate::controls::{Commands, PilotControls};
use crate::inputs::{World, failures};

/// What the computer is set to.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Travel of the inceptors.
    pub travel: Travel,
    /// Stability and control augmentation.
    pub scas: scas::Params,
    /// Collective governor.
    pub governor: governor::Params,
    /// Gearing.
    pub mixer: mixer::Params,
}

/// Travel of the inceptors from neutral (of the lever: from its bottom).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Travel {
    /// Longitudinal stick, either way.
    pub longitudinal_stick_m: f64,
    /// Lateral stick, either way.
    pub lateral_stick_m: f64,
    /// Pedals, either way.
    pub pedal_m: f64,
    /// Power lever, whole travel.
    pub collective_m: f64,
}

/// What the computer remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Of the SCAS.
    pub scas: scas::State,
    /// Of the governor.
    pub governor: governor::State,
}

/// One tick of the computer: the state after it, and what it asks of the actuators.
pub fn update(
    params: &Params,
    state: &State,
    pilot: &PilotControls,
    sensed: &Sensed,
    world: &World,
) -> (State, Commands) {
    let sticks = scas::Sticks {
        aft_m: pilot.stick_aft_norm * params.travel.longitudinal_stick_m,
        right_m: pilot.stick_right_norm * params.travel.lateral_stick_m,
        pedal_right_m: pilot.pedal_right_norm * params.travel.pedal_m,
    };
    let on = scas::Axes {
        pitch: pilot.scas_on != 0 && !world.failed(failures::SCAS_PITCH),
        roll: pilot.scas_on != 0 && !world.failed(failures::SCAS_ROLL),
        yaw: pilot.scas_on != 0 && !world.failed(failures::SCAS_YAW),
    };
    let (scas, augmented) = scas::update(&params.scas, &state.scas, &sticks, on, sensed);
    let lever_m = pilot.collective_norm * params.travel.collective_m;
    let (governor, collective_rad) = governor::update(
        &params.governor,
        &state.governor,
        &governor::Inputs {
            from_lever_rad: mixer::lever_collective(&params.mixer, sensed.mast_tilt_rad, lever_m),
            rpm_select: pilot.rpm_select,
            rotor_speed_radps: sensed.rotor_speed_radps,
            mast_tilt_rad: sensed.mast_tilt_rad,
            failed: world.failed(failures::GOVERNOR),
        },
    );
    let commands = mixer::mix(&params.mixer, &augmented, collective_rad, pilot, sensed);
    (State { scas, governor }, commands)
}
