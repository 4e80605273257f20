//! What displays show of the aircraft and the model does not compute: from its state, and for display
//! only.
//!
//! # Equations
//! ```text
//! exhaust gas = T + P/P_rated·(T_rated − T_idle) + T_idle − 15 °C      a running engine
//! oil pressure, fuel pressure = constants of a running engine
//! castor angle = atan2(v_right, v_forward) of the nose wheel, turned forward
//! ```
//! # Assumptions
//! No source gives temperatures and pressures of the XV-15's engines over power. What is shown moves
//! as such instruments do, so that an engine that stops is seen to stop; no number of it is to be
//! trusted.

use engine::engines;
use engine::landing_gear::Leg;
use engine::math::{atan2, clamp, max, sqrt, square};
use engine::outputs::Outputs;
use engine::pair::Pair;

use crate::scene::Scene;

/// An engine below this part of the power it could give has stopped: idle is well above.
const RUNNING_POWER_NORM: f64 = 0.01;

/// Exhaust gas of an idling and of a full engine on a standard day, °C. Estimates.
const EXHAUST_C: (f64, f64) = (400.0, 600.0);
/// Oil of an idling and of a full engine, °C. Estimates.
const OIL_C: (f64, f64) = (60.0, 85.0);
/// Oil pressure of an engine that runs, psi. An estimate.
const OIL_PSI: f64 = 80.0;
/// Fuel pressure of an engine that runs, psi. An estimate.
const FUEL_PSI: f64 = 25.0;
/// 0 °C, K.
const FREEZING_K: f64 = 273.15;
/// A standard day at sea level, °C.
const STANDARD_C: f64 = 15.0;

/// Slower than this the castor keeps straight, m/s.
const CASTOR_MPS_MIN: f64 = 0.3;
/// How far the castor turns either way, as it is shown, rad.
pub(crate) const CASTOR_RAD_MAX: f64 = 1.0;

/// Whether an engine runs: 0 left, 1 right. Nothing tells but its power.
pub(crate) fn runs(engines: &engines::Outputs, index: usize) -> bool {
    let power_w = if index == 0 { engines.power_w.left } else { engines.power_w.right };
    power_w > RUNNING_POWER_NORM * engines.available_w
}

/// Fuel flow of each engine. The model gives both together; it is split as the power is.
pub(crate) fn fuel_flow_kg_per_s(engines: &engines::Outputs) -> Pair<f64> {
    let power_w = engines.power_w.sum();
    engines.power_w.map(|each_w| {
        let part = if power_w > 0.0 { each_w / power_w } else { 0.5 };
        engines.fuel_flow_kg_per_s * part
    })
}

/// Exhaust gas temperature of each engine, °F.
pub(crate) fn exhaust_gas_degf(scene: &Scene<'_>) -> Pair<f64> {
    temperature_degf(scene, EXHAUST_C)
}

/// Oil temperature of each engine, °F.
pub(crate) fn oil_degf(scene: &Scene<'_>) -> Pair<f64> {
    temperature_degf(scene, OIL_C)
}

/// Oil pressure of each engine, psi.
pub(crate) fn oil_psi(scene: &Scene<'_>) -> Pair<f64> {
    while_running(scene, OIL_PSI)
}

/// Fuel pressure of each engine, psi.
pub(crate) fn fuel_psi(scene: &Scene<'_>) -> Pair<f64> {
    while_running(scene, FUEL_PSI)
}

fn while_running(scene: &Scene<'_>, value: f64) -> Pair<f64> {
    let of = |index| if runs(&scene.outputs.engines, index) { value } else { 0.0 };
    Pair { left: of(0), right: of(1) }
}

/// Between idle and full by power, and with the air; the air's own when the engine stands.
fn temperature_degf(scene: &Scene<'_>, (idle_c, full_c): (f64, f64)) -> Pair<f64> {
    let air_c = scene.outputs.air.temperature_k - FREEZING_K;
    let engines = &scene.outputs.engines;
    let rated_w = scene.aircraft.engines.rated_power_w;
    let of = |index, power_w: f64| {
        let hot_c = if runs(engines, index) {
            idle_c + (full_c - idle_c) * clamp(power_w / rated_w, 0.0, 1.2) - STANDARD_C
        } else {
            0.0
        };
        (air_c + hot_c) * 1.8 + 32.0
    };
    Pair { left: of(0, engines.power_w.left), right: of(1, engines.power_w.right) }
}

/// A strut: 0 nose, 1 left, 2 right.
pub(crate) fn leg(outputs: &Outputs, index: usize) -> &Leg {
    let gear = &outputs.landing_gear;
    [&gear.nose, &gear.main.left, &gear.main.right][index]
}

/// Where the nose wheel's castor points, to the right of straight ahead; straight in the air and at
/// rest.
pub(crate) fn castor_rad(scene: &Scene<'_>) -> f64 {
    let outputs = scene.outputs;
    if outputs.landing_gear.nose.push_n <= 0.0 {
        return 0.0;
    }
    let arm = scene.aircraft.landing_gear.nose.tyre_m.from_cg(outputs.balance.cg_m);
    let velocity = outputs.body_velocity_mps + outputs.angular_rate_radps.cross(arm);
    if sqrt(square(velocity.x) + square(velocity.y)) < CASTOR_MPS_MIN {
        return 0.0;
    }
    // Backwards it trails the other way round, which looks the same.
    let (forward, right) =
        if velocity.x < 0.0 { (-velocity.x, -velocity.y) } else { (velocity.x, velocity.y) };
    clamp(atan2(right, forward), -CASTOR_RAD_MAX, CASTOR_RAD_MAX)
}

/// Height of the main wheels, struts extended, over the ground; 0 while they stand on it.
pub(crate) fn wheels_above_ground_m(scene: &Scene<'_>) -> f64 {
    let outputs = scene.outputs;
    let wheels_m = scene.aircraft.landing_gear.main.tyre_m.z;
    max(0.0, outputs.height_above_ground_m - (outputs.balance.cg_m.z - wheels_m))
}
