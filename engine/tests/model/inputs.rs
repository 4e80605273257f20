//! Inputs that a flight need not use change nothing until they are used.

use engine::controls::{Commands, ForceTrim, PickUp};
use engine::inputs::{DeviceEvent, EventKind, InputLevel, World};
use engine::pair::Pair;
use engine::struts::Struts;
use engine::symmetry::Mirror;
use engine::{Aircraft, Inputs, Outputs, State, step};

use crate::flying::{assert_same_bits, parked, xv15};

/// Ticks flown: two seconds.
const TICKS: u64 = 500;

fn in_world(xv15: &Aircraft, state: &State, world: World) -> (State, Outputs) {
    step(xv15, state, &Inputs { events: &[], world })
}

/// Commands that no pilot asks for.
fn odd_commands() -> Commands {
    Commands {
        collective_rad: Pair { left: 0.3, right: 0.2 },
        elevator_rad: 0.1,
        nacelle_aft_norm: -1.0,
        lever_norm: 0.9,
        ..Commands::default()
    }
}

/// A helicopter whose lever was raised at the start.
fn lifting(xv15: &Aircraft) -> State {
    let mut state = parked(xv15);
    // Flaps up the wing takes an eighth of the thrust.
    state.cockpit.collective_norm = 0.9;
    state
}

#[test]
fn commands_from_outside_are_not_looked_at_while_the_pilot_flies() {
    let xv15 = xv15();
    let (mut with, mut without) = (lifting(&xv15), lifting(&xv15));
    let world = World { commands: odd_commands(), input_level: 7, ..World::default() };
    for _ in 0..TICKS {
        with = in_world(&xv15, &with, world).0;
        without = in_world(&xv15, &without, World::default()).0;
    }
    assert_same_bits(&with, &without, "unused commands");
}

#[test]
fn the_computer_s_own_commands_given_from_outside_fly_the_same_flight() {
    let xv15 = xv15();
    let (mut inside, mut outside) = (lifting(&xv15), lifting(&xv15));
    for _ in 0..TICKS {
        let (next, outputs) = in_world(&xv15, &inside, World::default());
        inside = next;
        let (input_level, commands) = (InputLevel::Actuators as u64, outputs.commands);
        outside = in_world(&xv15, &outside, World { input_level, commands, ..World::default() }).0;
        assert_same_bits(&outside, &inside, "commands from outside");
    }
    assert!(inside.plant.velocity_mps.z < -1.0, "it climbs");
}

#[test]
fn commands_from_outside_move_the_actuators_and_stay_within_their_travel() {
    let xv15 = xv15();
    let commands = Commands { lever_norm: 5.0, nacelle_aft_norm: -9.0, ..odd_commands() };
    let input_level = InputLevel::Actuators as u64;
    let world = World { input_level, commands, ..World::default() };
    let mut state = parked(&xv15);
    for _ in 0..TICKS {
        state = in_world(&xv15, &state, world).0;
    }
    assert_eq!(state.actuators.lever_norm.to_bits(), 1.0f64.to_bits());
    assert!(state.actuators.mast_tilt_rad.right > 0.1, "{}", state.actuators.mast_tilt_rad.right);
    assert!(state.actuators.collective_rad.left > 0.25);
    // At the nacelles' own rate: as far as the pilot's switch moves them.
    let mut switched = parked(&xv15);
    switched.cockpit.nacelle_aft_norm = -1.0;
    for _ in 0..TICKS {
        switched = in_world(&xv15, &switched, World::default()).0;
    }
    let (by_outside, by_switch) =
        (state.actuators.mast_tilt_rad.right, switched.actuators.mast_tilt_rad.right);
    assert_eq!(by_outside.to_bits(), by_switch.to_bits());
}

#[test]
fn ground_under_each_wheel_is_the_level_ground_when_it_is_the_same_under_all() {
    let xv15 = xv15();
    let mut state = parked(&xv15);
    state.plant.position_m.z -= 3.0;
    let each = Struts { nose: 3.0, main: Pair { left: 3.0, right: 3.0 } };
    let (mut apart, mut level) = (state, state);
    for _ in 0..TICKS {
        apart = in_world(&xv15, &apart, World { ground_height_m: each, ..World::default() }).0;
        level = in_world(&xv15, &level, World::default().with_ground(3.0)).0;
    }
    assert_same_bits(&apart, &level, "three wheels");
    assert!(level.plant.weight_on_wheels != 0);
}

#[test]
fn higher_ground_under_a_wheel_rolls_the_aircraft_away_from_it_and_its_image_the_other_way() {
    let xv15 = xv15();
    let slope = Struts { nose: 0.0, main: Pair { left: 0.1, right: 0.0 } };
    let world = World { ground_height_m: slope, ..World::default() };
    let (mut state, mut image) = (parked(&xv15), parked(&xv15).mirrored());
    for _ in 0..TICKS {
        state = in_world(&xv15, &state, world).0;
        image = in_world(&xv15, &image, world.mirrored()).0;
        assert_same_bits(&image, &state.mirrored(), "the mirrored slope");
    }
    assert!(state.plant.attitude.euler().roll_rad > 0.005, "{:?}", state.plant.attitude.euler());
}

#[test]
fn what_is_reserved_for_pick_up_and_force_trim_stays_empty() {
    let xv15 = xv15();
    let mut state = lifting(&xv15);
    let found =
        |kind: EventKind, value| DeviceEvent { kind: kind as u64, value, ..DeviceEvent::default() };
    let events = [
        found(EventKind::Dropped, 9),
        found(EventKind::AxisPosition, 30_000),
        found(EventKind::ButtonPosition, 1),
    ];
    for _ in 0..TICKS {
        state = step(&xv15, &state, &Inputs { events: &events, world: World::default() }).0;
    }
    assert_eq!(state.cockpit.pick_up, PickUp::default());
    assert_eq!(state.cockpit.force_trim, ForceTrim::default());
    let mut without = lifting(&xv15);
    for _ in 0..TICKS {
        without = in_world(&xv15, &without, World::default()).0;
    }
    assert_same_bits(&state, &without, "positions that were found");
}
