//! Same arguments, same bits; a mirrored flight is the mirrored state.

use engine::controls::Commands;
use engine::frames::{Attitude, Euler, Vec3};
use engine::inputs::{DeviceEvent, Failures, InputLevel, World};
use engine::pair::Pair;
use engine::symmetry::Mirror;
use engine::{Inputs, Outputs, State, observe, step};

use crate::flying::{
    self, TICKS_PER_S, aloft, assert_same_bits, calm, parked, step_in_the_mirror, violent_flight,
    xv15,
};

/// Fewer where nothing is optimised, so that the crate's tests stay within a minute.
const FLIGHTS: u64 = if cfg!(debug_assertions) { 20 } else { 100 };

#[test]
fn a_mirrored_flight_is_the_mirrored_state_to_the_bit() {
    let xv15 = xv15();
    let parked = parked(&xv15);
    for seed in 0..FLIGHTS {
        violent_flight(&xv15, &parked, seed, 8 * TICKS_PER_S, |state, inputs, next, _| {
            let image = step_in_the_mirror(&xv15, state, inputs);
            let what = format!("seed {seed}, tick {}: the mirrored step", next.tick);
            assert_same_bits(&image, &next.mirrored(), &what);
        });
    }
}

/// Gusts from the left are those from the right of the image, and so is what the air remembers of them; commands
/// from outside for the left actuators are those for the right ones.
#[test]
fn a_world_in_a_mirror_does_what_the_world_does_to_the_bit() {
    let xv15 = xv15();
    let gusty = World {
        wind_mps: Vec3::new(-8.0, 3.0, 0.5),
        gust_mps: Vec3::new(1.0, -4.0, 2.0),
        gust_s: 1.0,
        gust_start_tick: 100,
        turbulence_mps: 4.0,
        ..World::default()
    };
    let commanded = World {
        input_level: InputLevel::Actuators as u64,
        commands: Commands {
            collective_rad: Pair { left: 0.30, right: 0.32 },
            cyclic_forward_rad: Pair { left: 0.01, right: -0.02 },
            cyclic_outboard_rad: Pair { left: -0.01, right: 0.015 },
            elevator_rad: 0.02,
            flaperon_rad: Pair { left: 0.1, right: -0.05 },
            rudder_right_rad: 0.1,
            brake_norm: Pair { left: 0.2, right: 0.7 },
            lever_norm: 0.6,
            ..Commands::default()
        },
        failures: Failures::ENGINE_LEFT,
        ..World::default()
    };
    for world in [gusty, commanded] {
        let inputs = Inputs { events: &[], world };
        let mut state = aloft(&parked(&xv15), 0.5, 60.0).without_negative_zeros();
        for _ in 0..2 * TICKS_PER_S {
            let next = step(&xv15, &state, &inputs).0;
            let image = step_in_the_mirror(&xv15, &state, &inputs);
            assert_same_bits(&image, &next.mirrored(), "the mirrored step");
            state = next;
        }
        let air = state.environment;
        let stirred = air.turbulence_mps.y.abs() > 1e-3 && air.lateral_stage_mps.abs() > 1e-3;
        assert_eq!(stirred, world == gusty, "{air:?}");
        let to = state.actuators.collective_rad;
        assert_eq!(to.right - to.left > 0.01, world == commanded, "{to:?}");
    }
}

/// Upside down, rolling left and rolling right are equally far from upright.
#[test]
fn a_straight_loop_stays_straight() {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), 0.0, 60.0);
    state.plant.attitude = Attitude::from_euler(Euler { pitch_rad: 1.3, ..Euler::default() });
    state.plant.angular_rate_radps = Vec3::new(0.0, 2.0, 0.0);
    state.cockpit.stick_aft_norm = 1.0;
    let mut inverted = false;
    for _ in 0..4 * TICKS_PER_S {
        state = step(&xv15, &state, &calm()).0;
        inverted |= flying::euler(&state).roll_rad.abs() > 3.0;
        // The air remembers that it is a mirror image; nothing else does.
        let mut image = state.mirrored();
        image.environment.mirrored = state.environment.mirrored;
        assert_same_bits(&state, &image, "the plane of symmetry");
    }
    assert!(inverted);
}

#[test]
fn a_flight_resumed_at_any_tick_has_the_bits_of_the_uninterrupted_one() {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let mut log: Vec<(State, Vec<DeviceEvent>, World)> = Vec::new();
    violent_flight(&xv15, &parked, 7, 6 * TICKS_PER_S, |state, inputs, _, _| {
        // Through the log's bytes, as a reader would have it.
        let config = bincode::config::legacy();
        let bytes = bincode::serde::encode_to_vec(state, config).unwrap();
        let (read, _) = bincode::serde::decode_from_slice(&bytes, config).unwrap();
        log.push((read, inputs.events.to_vec(), inputs.world));
    });
    let last = log.len() - 1;
    for from in [0, 1, 499, 1000, last - 1] {
        let resumed = log[from..last].iter().fold(log[from].0, |state, (_, events, world)| {
            step(&xv15, &state, &Inputs { events, world: *world }).0
        });
        assert_same_bits(&resumed, &log[last].0, &format!("resumed at {from}"));
    }
}

#[test]
fn a_pause_holds_everything_but_the_tick() {
    let xv15 = xv15();
    let state = aloft(&parked(&xv15), 0.5, 40.0).without_negative_zeros();
    let paused = World { paused: 1, wind_mps: Vec3::new(9.0, 9.0, 0.0), ..World::default() };
    let (held, outputs) = step(&xv15, &state, &Inputs { events: &[], world: paused });
    assert_same_bits(&held, &State { tick: state.tick + 1, ..state }, "the paused state");
    assert!(outputs.commands.lever_norm > 0.0, "what the computer asks for stays to be seen");
    let seen = observe(&xv15, &state, &World { paused: 0, ..paused });
    assert_eq!(seen, Outputs { tick: state.tick, ..outputs }, "what is seen without a tick");
}

#[test]
fn a_pause_leaves_no_trace_in_the_motion() {
    let xv15 = xv15();
    let mut flown = aloft(&parked(&xv15), 0.5, 40.0);
    let mut interrupted = flown;
    for tick in 0..TICKS_PER_S {
        flown = step(&xv15, &flown, &calm()).0;
        let paused = World { paused: 1, ..World::default() };
        for _ in 0..tick % 3 {
            interrupted = step(&xv15, &interrupted, &Inputs { events: &[], world: paused }).0;
        }
        interrupted = step(&xv15, &interrupted, &calm()).0;
    }
    let interrupted = State { tick: flown.tick, ..interrupted };
    assert_same_bits(&interrupted, &flown, "the interrupted flight");
}

#[test]
fn events_that_mean_nothing_change_nothing() {
    let xv15 = xv15();
    let state = aloft(&parked(&xv15), 0.5, 40.0);
    let some = DeviceEvent { kind: 1, value: i64::MIN, ..DeviceEvent::default() };
    let events = [
        DeviceEvent { device: 1, ..some },
        DeviceEvent { device: u64::MAX, ..some },
        DeviceEvent { kind: 0, ..some },
        DeviceEvent { kind: u64::MAX, ..some },
        DeviceEvent { code: 99, ..some },
        DeviceEvent { kind: 2, code: u64::MAX, ..some },
    ];
    let (next, _) = step(&xv15, &state, &Inputs { events: &events, world: World::default() });
    assert_same_bits(&next, &step(&xv15, &state, &calm()).0, "the step with nonsense");
}

#[test]
fn a_raw_value_beyond_any_range_is_the_end_of_travel() {
    let xv15 = xv15();
    for (value, end) in [(i64::MIN, -1.0), (i64::MAX, 1.0)] {
        let event = DeviceEvent { kind: 1, code: 1, value, ..DeviceEvent::default() };
        let inputs = Inputs { events: &[event], world: World::default() };
        let (next, _) = step(&xv15, &parked(&xv15), &inputs);
        assert_eq!(next.cockpit.stick_aft_norm.to_bits(), f64::to_bits(end));
    }
}
