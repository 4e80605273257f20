//! Flight control computer: SCAS, collective governor and mixer.

pub mod governor;
pub mod mixer;
pub mod scas;
pub mod sensed;

use serde::{Deserialize, Serialize};

pub use self::sensed::Sensed;
use crate::controls::{Commands, PilotControls};
use crate::inputs::{Failures, World};

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

/// What the computer gives.
#[derive(Clone, Copy, Debug)]
pub struct Outputs {
    /// What it asks of the actuators.
    pub commands: Commands,
    /// What the SCAS adds to the sticks.
    pub scas: scas::Outputs,
}

/// One tick of the computer: the state after it, and what it gives.
pub fn update(
    params: &Params,
    state: &State,
    pilot: &PilotControls,
    sensed: &Sensed,
    world: &World,
) -> (State, Outputs) {
    let (sticks, on) = (sticks(params, pilot), axes_on(pilot, world));
    let (scas, augmented, added) = scas::update(&params.scas, &state.scas, &sticks, on, sensed);
    let (governor, collective_rad) = governor::update(
        &params.governor,
        &state.governor,
        &to_governor(params, pilot, sensed, world),
    );
    let commands = mixer::mix(&params.mixer, &augmented, collective_rad, pilot, sensed);
    (State { scas, governor }, Outputs { commands, scas: added })
}

/// The computer at rest with the pilot's controls where they are: what it remembers once the SCAS is
/// centred and the governor holds the sensed rotor speed with this collective, and what it then asks
/// of the actuators.
///
/// One more [`update`] changes nothing of it, as long as the collective is within the governor's
/// limits and the reference speed is the selected one.
pub fn settled(
    params: &Params,
    pilot: &PilotControls,
    sensed: &Sensed,
    world: &World,
    collective_rad: f64,
) -> (State, Commands) {
    let sticks = sticks(params, pilot);
    let scas = scas::settled(&sticks, sensed);
    let (_, augmented, _) =
        scas::update(&params.scas, &scas, &sticks, axes_on(pilot, world), sensed);
    let to_governor = to_governor(params, pilot, sensed, world);
    let governor = governor::settled(&params.governor, &to_governor, collective_rad);
    let commands = mixer::mix(&params.mixer, &augmented, collective_rad, pilot, sensed);
    (State { scas, governor }, commands)
}

/// The pilot's sticks by their travel.
fn sticks(params: &Params, pilot: &PilotControls) -> scas::Sticks {
    scas::Sticks {
        aft_m: pilot.stick_aft_norm * params.travel.longitudinal_stick_m,
        right_m: pilot.stick_right_norm * params.travel.lateral_stick_m,
        pedal_right_m: pilot.pedal_right_norm * params.travel.pedal_m,
        rest_aft_m: pilot.force_trim.stick_aft_norm * params.travel.longitudinal_stick_m,
    }
}

/// The SCAS axes that are switched on and have not failed.
fn axes_on(pilot: &PilotControls, world: &World) -> scas::Axes {
    let on = |failure: Failures| pilot.scas_on != 0 && !world.failed(failure);
    scas::Axes {
        pitch: on(Failures::SCAS_PITCH),
        roll: on(Failures::SCAS_ROLL),
        yaw: on(Failures::SCAS_YAW),
    }
}

/// What the governor reads.
fn to_governor(
    params: &Params,
    pilot: &PilotControls,
    sensed: &Sensed,
    world: &World,
) -> governor::Inputs {
    let lever_m = pilot.collective_norm * params.travel.collective_m;
    governor::Inputs {
        from_lever_rad: mixer::lever_collective(&params.mixer, sensed.mast_tilt_rad, lever_m),
        rpm_select: pilot.rpm_select,
        rotor_speed_radps: sensed.rotor_speed_radps,
        mast_tilt_rad: sensed.mast_tilt_rad,
        failed: world.failed(Failures::GOVERNOR),
    }
}
