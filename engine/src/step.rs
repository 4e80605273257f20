//! One tick, and all the wiring between the blocks.
//!
//! # Equations
//! ```text
//! x' = x + h·(3/2·ẋ − 1/2·ẋ_before)                 rates of the plant (Adams–Bashforth, 2nd order)
//! p' = p + h·(V + V')/2       q' = q ⊗ exp(h·(ω + ω')/4)      position and attitude
//! ```
//! # Assumptions
//! Cockpit, computer, actuators and tyres are sampled: they move once a tick and hold through it.

mod blocks;
mod observed;

use self::blocks::{Blocks, airspeed};
use self::observed::outputs;
use crate::aero::horizontal_stabilizer;
use crate::controls::Commands;
use crate::frames::Euler;
use crate::inputs::World;
use crate::landing_gear::RigidMotion;
use crate::math::{PI, TAU, clamp, max, square};
use crate::state::{Plant, PlantRate, State};
use crate::{
    Aircraft, Inputs, Outputs, STEP_S, actuators, cockpit, engines, environment, fcc, landing_gear,
};

/// Advances the aircraft by one tick. Same arguments, same bits.
pub fn step(aircraft: &Aircraft, state: &State, inputs: &Inputs) -> (State, Outputs) {
    let mut next = *state;
    let (blocks, computer) = tick(aircraft, state, inputs, &mut next);
    let outputs = outputs(aircraft, &blocks, &next, &computer);
    (next, outputs)
}

/// The same in place, for whoever does not look at the outputs.
pub fn step_state(aircraft: &Aircraft, state: &mut State, inputs: &Inputs) {
    let before = *state;
    tick(aircraft, &before, inputs, state);
}

/// One tick of the state: `next` begins as a copy of it. What the blocks say of it, and what the
/// computer gives, or the commands from outside in its place.
fn tick(
    aircraft: &Aircraft,
    state: &State,
    inputs: &Inputs,
    next: &mut State,
) -> (Blocks, fcc::Outputs) {
    next.tick = state.tick.wrapping_add(1);
    let passed_s = if inputs.world.paused == 0 { STEP_S } else { 0.0 };
    next.cockpit = cockpit::update(&aircraft.cockpit, &state.cockpit, inputs.events, passed_s);

    // Sampled once, held through the tick.
    let (environment, air) = weather(state, &inputs.world);
    let sensed = sense(state, &air);
    let (fcc, mut computer) =
        fcc::update(&aircraft.fcc, &state.fcc, &next.cockpit, &sensed, &inputs.world);
    computer.commands = inputs.world.outside_commands().unwrap_or(computer.commands);
    if inputs.world.paused != 0 || state.frozen != 0 {
        // What the computer asks for stays to be seen; what it remembers does not move. The rates
        // of the tick before the pause stay too, so that the motion goes on as if there were none.
        return (Blocks::evaluate(aircraft, next, &inputs.world, &air), computer);
    }
    next.actuators = moved(aircraft, state, &computer.commands);
    next.fcc = fcc;
    next.environment = environment;

    // Integrated across the tick.
    let blocks = Blocks::evaluate(aircraft, next, &inputs.world, &air);
    let plant = advance(&state.plant, &blocks, &state.rate);
    next.plant = above_ground(aircraft, plant, &inputs.world);
    next.rate = blocks.rate;
    if !next.make_zeros_positive() {
        *next = State { frozen: 1, tick: next.tick, cockpit: next.cockpit, ..*state };
    }
    (blocks, computer)
}

/// The actuators one tick later.
fn moved(aircraft: &Aircraft, state: &State, commands: &Commands) -> actuators::State {
    actuators::update(&aircraft.actuators, &aircraft.actuator_parts, &state.actuators, commands)
}

/// What can be observed of a state by itself, in a world that stands still: the controls are where they
/// are, and no tick passes. It is what is seen before the first tick.
pub fn observe(aircraft: &Aircraft, state: &State, world: &World) -> Outputs {
    let inputs = Inputs { events: &[], world: World { paused: 1, ..*world } };
    Outputs { tick: state.tick, ..step(aircraft, state, &inputs).1 }
}

/// Where everything is heading from a state: what moves once a tick after one tick, what moves all the
/// time after a tick at the rates of the state itself, which are kept in `rate`.
///
/// This is no flight. It is what trim and linearisation look at, where all parts are wanted at the
/// same moment.
pub fn derivatives(aircraft: &Aircraft, state: &State, world: &World) -> (State, Outputs) {
    let (environment, air) = weather(state, world);
    let sensed = sense(state, &air);
    let (fcc, mut computer) =
        fcc::update(&aircraft.fcc, &state.fcc, &state.cockpit, &sensed, world);
    computer.commands = world.outside_commands().unwrap_or(computer.commands);
    let actuators = moved(aircraft, state, &computer.commands);
    let blocks = Blocks::evaluate(aircraft, state, world, &air);
    let plant = advance(&state.plant, &blocks, &blocks.rate);
    let outputs = outputs(aircraft, &blocks, state, &computer);
    (State { fcc, actuators, environment, plant, rate: blocks.rate, ..*state }, outputs)
}

/// The air of this tick.
fn weather(state: &State, world: &World) -> (environment::State, environment::Outputs) {
    let plant = &state.plant;
    environment::update(
        &state.environment,
        &environment::Inputs {
            height_m: plant.origin.height_m - plant.position_m.z,
            height_above_ground_m: -plant.position_m.z - world.ground_under_aircraft_m(),
            airspeed_mps: (plant.velocity_mps - world.wind_mps).norm(),
            tick: state.tick,
            world,
        },
    )
}

/// What the flight control computer's sensors read in a state at rest in its weather.
pub fn sensed(state: &State, world: &World) -> fcc::Sensed {
    sense(state, &weather(state, world).1)
}

/// What the flight control computer's sensors read. Ideal: no lag, no noise.
fn sense(state: &State, air: &environment::Outputs) -> fcc::Sensed {
    let plant = &state.plant;
    let airspeed_mps = airspeed(plant, air).norm();
    let euler = plant.attitude.euler();
    // Exactly upside down neither way round is the shorter: taking one would break the symmetry.
    let half_turn = euler.roll_rad.abs() >= PI;
    let euler = Euler { roll_rad: if half_turn { 0.0 } else { euler.roll_rad }, ..euler };
    fcc::Sensed {
        angular_rate_radps: plant.angular_rate_radps,
        euler,
        airspeed_mps,
        dynamic_pressure_pa: 0.5 * air.density_kg_per_m3 * square(airspeed_mps),
        rotor_speed_radps: plant.rotor_speed_radps,
        mast_tilt_rad: state.actuators.mast_tilt_rad.mean(),
        mast_tilt_rate_radps: state.actuators.mast_tilt_rate_radps.mean(),
        weight_on_wheels: plant.weight_on_wheels != 0,
    }
}

/// The plant one tick later.
fn advance(plant: &Plant, blocks: &Blocks, rate_before: &PlantRate) -> Plant {
    let (rate, gear) = (&blocks.rate, &blocks.gear);
    let ab2 = |now: f64, before: f64| STEP_S * (1.5 * now - 0.5 * before);
    let (motion, motion_before) = (&rate.motion, &rate_before.motion);
    let velocity_mps = plant.velocity_mps
        + (motion.acceleration_mps2 * 1.5 - motion_before.acceleration_mps2 * 0.5) * STEP_S;
    let angular_rate_radps = plant.angular_rate_radps
        + (motion.angular_acceleration_radps2 * 1.5
            - motion_before.angular_acceleration_radps2 * 0.5)
            * STEP_S;
    let (tail, tail_before) = (&rate.horizontal_stabilizer, &rate_before.horizontal_stabilizer);
    let (drive, drive_before) = (&rate.engines, &rate_before.engines);
    let change_w = drive
        .power_w_per_s
        .zip(drive_before.power_w_per_s)
        .map(|(now_w_per_s, before_w_per_s)| ab2(now_w_per_s, before_w_per_s));
    let engines = plant
        .engines
        .zip(change_w)
        .map(|(engine, change_w)| engines::State { power_w: engine.power_w + change_w });
    let rotor_speed_radps = max(
        0.0,
        plant.rotor_speed_radps + ab2(drive.rotor_speed_radps2, drive_before.rotor_speed_radps2),
    );
    let turned_rad =
        plant.rotor_azimuth_rad + 0.5 * (plant.rotor_speed_radps + rotor_speed_radps) * STEP_S;
    Plant {
        origin: plant.origin,
        position_m: plant.position_m + (plant.velocity_mps + velocity_mps) * (0.5 * STEP_S),
        velocity_mps,
        attitude: plant
            .attitude
            .turned_by((plant.angular_rate_radps + angular_rate_radps) * (0.5 * STEP_S)),
        angular_rate_radps,
        rotors: blocks.rotors_next,
        horizontal_stabilizer: horizontal_stabilizer::State {
            downwash_rad: plant.horizontal_stabilizer.downwash_rad
                + ab2(tail.downwash_radps, tail_before.downwash_radps),
        },
        rotor_speed_radps,
        rotor_azimuth_rad: if turned_rad >= TAU { turned_rad - TAU } else { turned_rad },
        engines,
        // When the flow ends, half of the tick before would come back.
        fuel_kg: clamp(
            plant.fuel_kg + ab2(drive.fuel_kg_per_s, drive_before.fuel_kg_per_s),
            0.0,
            plant.fuel_kg,
        ),
        tyre_deflections: gear.tyre_deflections,
        weight_on_wheels: u64::from(gear.legs.main.map(|leg| leg.push_n).sum() > 0.0),
    }
}

/// The plant where structural contact with the ground lets it be.
fn above_ground(aircraft: &Aircraft, plant: Plant, world: &World) -> Plant {
    let Plant { position_m, velocity_mps, angular_rate_radps, .. } = plant;
    let motion = landing_gear::structural_contact(
        &aircraft.landing_gear,
        RigidMotion { position_m, velocity_mps, angular_rate_radps },
        world.ground_under_aircraft_m(),
    );
    let RigidMotion { position_m, velocity_mps, angular_rate_radps } = motion;
    Plant { position_m, velocity_mps, angular_rate_radps, ..plant }
}
