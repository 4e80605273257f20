//! Trim and linearisation of the XV-15: steady is steady, symmetric is symmetric.

use analysis::linearize::{INPUTS, linearize};
use analysis::modes::modes;
use analysis::start::state_at;
use analysis::trim::{Failure, Limit, Power, Target, Trim, trim, trim_near};
use analysis::variable::{Rigid, Variable};
use engine::frames::Vec3;
use engine::inputs::{Failures, World};
use engine::math::{FRAC_PI_2, max, square};
use engine::units::{DEGREE_RAD as DEG, FOOT_PER_MINUTE_MPS as FPM, KNOT_MPS as KT};
use engine::{Aircraft, Inputs, State, actuators, fcc, step};

/// What a steady state may be left with: m/s², rad/s². The least that a log would show is far above.
const STEADY: f64 = 1e-6;

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

fn flight(tilt_deg: f64, speed_kt: f64, flap_detent: u64) -> Target {
    Target {
        mast_tilt_rad: tilt_deg * DEG,
        airspeed_mps: speed_kt * KT,
        flap_detent,
        rpm_select: if tilt_deg > 89.0 { 2 } else { 0 },
        ..Target::default()
    }
}

/// A dozen steady flights of the envelope, and some that turn, climb, slip and hover near the ground.
fn envelope() -> Vec<Target> {
    let near_ground = World::default().with_ground(-6.0);
    let warm = World { temperature_offset_k: 20.0, ..Target::default().world };
    let failed = World { failures: Failures::ENGINE_LEFT, ..Target::default().world };
    vec![
        flight(0.0, 0.0, 2),
        flight(0.0, 20.0, 2),
        flight(0.0, 40.0, 2),
        flight(0.0, 60.0, 2),
        flight(0.0, 80.0, 2),
        flight(0.0, 100.0, 2),
        flight(30.0, 80.0, 1),
        flight(30.0, 120.0, 1),
        flight(60.0, 110.0, 1),
        flight(60.0, 140.0, 1),
        flight(90.0, 140.0, 0),
        flight(90.0, 220.0, 0),
        Target { world: near_ground, ..flight(0.0, 0.0, 2) },
        Target { world: warm, altitude_m: 1000.0, ..flight(0.0, 50.0, 2) },
        Target { power: Power::Climb(1000.0 * FPM), ..flight(0.0, 70.0, 2) },
        Target { power: Power::Climb(-500.0 * FPM), ..flight(30.0, 100.0, 1) },
        Target { power: Power::Lever(0.8), ..flight(90.0, 160.0, 0) },
        Target { turn_radps: 0.1, ..flight(0.0, 60.0, 2) },
        Target { turn_radps: -0.06, scas_on: 1, ..flight(90.0, 180.0, 0) },
        Target { sideslip_rad: 5.0 * DEG, ..flight(60.0, 140.0, 1) },
        Target { world: failed, ..flight(90.0, 140.0, 0) },
    ]
}

fn trimmed(aircraft: &Aircraft, target: &Target) -> Trim {
    trim(aircraft, target).unwrap_or_else(|failure| panic!("{target:?}: {failure}"))
}

fn fly(aircraft: &Aircraft, state: &State, world: World, ticks: usize) -> State {
    let mut state = *state;
    for _ in 0..ticks {
        state = step(aircraft, &state, &Inputs { events: &[], world }).0;
    }
    state
}

/// Largest change a second: of the velocity along the body, of its rotation, of the rotors' speed.
fn change_per_s(from: &State, to: &State, after_s: f64) -> f64 {
    let body =
        |state: &State| state.plant.attitude.ned_from_body().inverse() * state.plant.velocity_mps;
    let along = body(to) - body(from);
    let turn = to.plant.angular_rate_radps - from.plant.angular_rate_radps;
    let rotor = to.plant.rotor_speed_radps - from.plant.rotor_speed_radps;
    max(along.norm(), max(turn.norm(), rotor.abs())) / after_s
}

#[test]
fn the_first_tick_of_a_trimmed_flight_changes_nothing() {
    let xv15 = xv15();
    for target in envelope() {
        let trim = trimmed(&xv15, &target);
        let next = fly(&xv15, &trim.state, target.world, 1);
        let change = change_per_s(&trim.state, &next, engine::STEP_S);
        assert!(change < STEADY, "{target:?}: {change:e}");
        assert!(trim.report.residual < 1e-8, "{:e}", trim.report.residual);
    }
}

/// Fuel burnt and, in a climb, thinner air are the only changes: some 1e-4 g a second.
#[test]
fn a_trimmed_flight_stays_for_two_seconds() {
    let xv15 = xv15();
    for target in envelope() {
        let trim = trimmed(&xv15, &target);
        let after = fly(&xv15, &trim.state, target.world, 500);
        let change = change_per_s(&trim.state, &after, 2.0);
        assert!(change < 5e-3, "{target:?}: {change:e}");
    }
}

#[test]
fn a_symmetric_trim_has_no_lateral_quantities_at_all() {
    let xv15 = xv15();
    for target in [flight(0.0, 0.0, 2), flight(30.0, 90.0, 1), flight(90.0, 180.0, 0)] {
        let trim = trimmed(&xv15, &target);
        for state in [trim.state, fly(&xv15, &trim.state, target.world, 250)] {
            let plant = &state.plant;
            let euler = plant.attitude.euler();
            let rate: Vec3<_> = plant.angular_rate_radps;
            let lateral = [euler.roll_rad, euler.heading_rad, plant.velocity_mps.y, rate.x, rate.z];
            assert!(lateral.iter().all(|number| number.abs() <= 0.0), "{lateral:?}");
            assert_eq!(plant.rotors.left, plant.rotors.right);
            assert!(state.cockpit.stick_right_norm.abs() <= 0.0);
        }
    }
}

#[test]
fn a_turn_to_the_left_is_the_mirror_of_one_to_the_right() {
    let xv15 = xv15();
    let turn =
        |turn_radps: f64| trimmed(&xv15, &Target { turn_radps, ..flight(60.0, 140.0, 1) }).report;
    let (left, right) = (turn(-0.1), turn(0.1));
    assert!(right.roll_rad > 0.0 && (left.roll_rad + right.roll_rad).abs() < 1e-9);
    assert!((left.stick_right_m + right.stick_right_m).abs() < 1e-9);
    assert!((left.pitch_rad - right.pitch_rad).abs() < 1e-9);
    assert!(right.beta_rad.abs() < 1e-9);
}

#[test]
fn a_trim_near_another_is_the_same_trim() {
    let xv15 = xv15();
    let near = trimmed(&xv15, &flight(0.0, 50.0, 2));
    let target = flight(0.0, 60.0, 2);
    let found = trim_near(&xv15, &target, &near).unwrap();
    let alone = trimmed(&xv15, &target);
    assert!((found.report.pitch_rad - alone.report.pitch_rad).abs() < 1e-9);
    assert!((found.report.power_w - alone.report.power_w).abs() < 1e-3);
}

#[test]
fn what_the_engines_cannot_do_is_told_with_how_much_it_would_take() {
    let xv15 = xv15();
    let target = Target { altitude_m: 3300.0, ..flight(0.0, 0.0, 2) };
    let failure = trim(&xv15, &target).unwrap_err();
    let Failure::Beyond { limit: Limit::EnginePower, wanted_norm, trim: beyond } = failure else {
        panic!("{failure}");
    };
    assert!(wanted_norm > 1.0 && beyond.report.power_w > beyond.report.available_w);
    let part = beyond.report.power_w / beyond.report.available_w;
    assert!((wanted_norm / part - 1.0).abs() < 0.01, "{wanted_norm}, by the report {part}");
    assert!(matches!(
        trim(&xv15, &Target { airspeed_mps: -1.0, ..target }),
        Err(Failure::Senseless(_))
    ));
}

/// A steeper descent than idling engines let it fly, the lever against its upper stop where the masts bear no
/// more, wheels in the ground, a sideslip that no pedal holds.
#[test]
fn what_cannot_be_flown_names_the_limit_and_another_way() {
    let xv15 = xv15();
    let descending =
        |fpm: f64| Target { power: Power::Climb(-fpm * FPM), ..flight(90.0, 160.0, 0) };
    let sitting = World::default().with_ground(-1.5);
    for (target, limit, norm, words) in [
        (
            descending(1000.0),
            Limit::IdlePower,
            0.5..1.0,
            "idle; ask for less descent, or more flap",
        ),
        (descending(3000.0), Limit::IdlePower, -1e9..0.0, "the rotors would drive the engines;"),
        (
            Target { power: Power::Lever(1.0), ..flight(90.0, 160.0, 0) },
            Limit::MastTorque,
            1.1..2.0,
            "mast torque at 1",
        ),
        (
            Target { world: sitting, ..flight(0.0, 0.0, 2) },
            Limit::Ground,
            1.0..1.1,
            "the wheels touch the ground; ask for more height",
        ),
        (
            Target { sideslip_rad: 45.0 * DEG, ..flight(0.0, 40.0, 2) },
            Limit::Pedals,
            1.0..1.2,
            "pedals at 10",
        ),
    ] {
        let failure = trim(&xv15, &target).unwrap_err();
        let Failure::Beyond { limit: told, wanted_norm, trim } = &failure else {
            panic!("{failure}")
        };
        let engine_w = trim.state.plant.engines.left.power_w;
        if limit == Limit::IdlePower {
            let idle_w = xv15.engines.idle_power_norm * trim.outputs.engines.available_w;
            assert!((wanted_norm / (engine_w / idle_w) - 1.0).abs() < 1e-3, "{wanted_norm}");
        }
        assert!(*told == limit && norm.contains(wanted_norm), "{told:?} {wanted_norm}");
        assert!(failure.to_string().contains(words), "{failure}");
    }
}

/// A tick of the computer changes nothing of it, and the surfaces are where it wants them.
#[test]
fn the_computer_of_a_trimmed_flight_is_at_rest() {
    let xv15 = xv15();
    for target in envelope() {
        let state = trimmed(&xv15, &target).state;
        let sensed = step::sensed(&state, &target.world);
        let (next, computer) =
            fcc::update(&xv15.fcc, &state.fcc, &state.cockpit, &sensed, &target.world);
        let surfaces = actuators::settled(&xv15.actuators, &state.actuators, &computer.commands);
        let after = State { fcc: next, actuators: surfaces, ..state };
        for ((name, before), after) in
            state.number_names().iter().zip(numbers(&state)).zip(numbers(&after))
        {
            assert!((before - after).abs() < 1e-12, "{target:?}: {name} {before} {after}");
        }
    }
}

fn numbers(state: &State) -> Vec<f64> {
    let (mut state, mut numbers) = (*state, Vec::new());
    state.each_number(|number| numbers.push(*number));
    numbers
}

/// A small pull, flown tick by tick and computed from the matrices.
#[test]
fn the_matrices_say_what_the_aircraft_does() {
    let xv15 = xv15();
    let target = flight(90.0, 180.0, 0);
    let trim = trimmed(&xv15, &target);
    let linear = linearize(&xv15, &trim, &target.world);
    let pull_m = 1e-3;
    let mut pulled = trim.state;
    pulled.cockpit.stick_aft_norm += pull_m / xv15.fcc.travel.longitudinal_stick_m;
    let flown = fly(&xv15, &pulled, target.world, 125).plant.angular_rate_radps.y;
    let n = linear.states.len();
    let mut x = vec![0.0; n];
    // Ticks of a quarter millisecond: the sum is then as good as the exponential.
    for _ in 0..2000 {
        let rate: Vec<f64> = (0..n)
            .map(|i| {
                linear.a.row(i).iter().zip(&x).map(|(a, x)| a * x).sum::<f64>()
                    + linear.b[(i, 0)] * pull_m
            })
            .collect();
        for (x, rate) in x.iter_mut().zip(rate) {
            *x += 0.25e-3 * rate;
        }
    }
    assert_eq!((linear.states[4], INPUTS[0]), (Variable::Rigid(Rigid::PitchRate), "stick_aft_m"));
    assert!((x[4] / flown - 1.0).abs() < 0.03, "{} {flown}", x[4]);
}

/// Free fall about nothing: the kinematics' own derivatives, known by hand.
#[test]
fn the_kinematic_part_of_the_matrices_is_exact() {
    let xv15 = xv15();
    let target = flight(90.0, 200.0, 0);
    let trim = trimmed(&xv15, &target);
    let a = linearize(&xv15, &trim, &target.world).a;
    let at = |row: &str, column: &str| {
        let place = |name: &str| Rigid::ALL.iter().position(|rigid| rigid.name() == name).unwrap();
        a[(place(row), place(column))]
    };
    let (pitch, g) = (trim.report.pitch_rad, engine::GRAVITY_MPS2);
    let cos = engine::math::cos(pitch);
    assert!((at("forward_mps", "pitch_rad") + g * cos).abs() < 1e-5);
    assert!((at("right_mps", "roll_rad") - g * cos).abs() < 1e-5);
    assert!((at("pitch_rad", "pitch_rate_radps") - 1.0).abs() < 1e-9);
    assert!((at("roll_rad", "yaw_rate_radps") - engine::math::tan(pitch)).abs() < 1e-9);
    // Symmetric flight: the halves do not know of each other.
    assert!(at("pitch_rate_radps", "right_mps").abs() < 1e-9);
    assert!(at("roll_rate_radps", "forward_mps").abs() < 1e-9);
}

#[test]
fn the_modes_have_the_textbooks_names() {
    let xv15 = xv15();
    let names = |target: &Target| -> Vec<&'static str> {
        let trim = trimmed(&xv15, target);
        let linear = linearize(&xv15, &trim, &target.world);
        let modes = modes(&linear, target.airspeed_mps).unwrap();
        let swinging: f64 = modes.iter().filter(|mode| mode.swings()).map(|_| 1.0).sum();
        assert!((modes.len() as f64 + swinging - linear.states.len() as f64).abs() < 0.5);
        modes.into_iter().map(|mode| mode.name).collect()
    };
    let hover = names(&flight(0.0, 0.0, 2));
    for name in ["hover oscillation in pitch", "hover oscillation in roll", "heave"] {
        assert!(hover.contains(&name), "{hover:?}");
    }
    let cruise = names(&flight(90.0, 180.0, 0));
    for name in ["phugoid", "short period", "Dutch roll", "roll subsidence", "spiral"] {
        assert!(cruise.contains(&name), "{cruise:?}");
    }
}

/// A flight may begin in the air: the scenario says how.
#[test]
fn a_scenario_begins_in_steady_flight() {
    let xv15 = xv15();
    let text = format!(
        "{}\n[trim]\nmast_tilt_deg = 90.0\nairspeed_kt = 180.0\naltitude_ft = 3000.0\n\
         flap_detent = 0\nrpm_select = 2\nscas_on = 1\n",
        aircraft::DEFAULT_SCENARIO
    );
    let start = aircraft::start("air.toml", &text).unwrap();
    let state = state_at(&start, &xv15).unwrap();
    assert_eq!((state.tick, state.actuators.mast_tilt_rad.left), (0, FRAC_PI_2));
    assert!((state.plant.velocity_mps.norm() - 180.0 * KT).abs() < 1e-9);
    let after = fly(&xv15, &state, start.world.world(), 1250);
    let sunk_m = after.plant.position_m.z - state.plant.position_m.z;
    assert!(square(sunk_m) < 0.01, "{sunk_m}");
    // West, as the default scenario points.
    assert!(after.plant.position_m.y < -400.0);
}

/// Two seeds, in the air and on the ground: two turbulences, each its own again.
#[test]
fn turbulence_has_the_scenarios_seed_wherever_the_flight_begins() {
    let xv15 = xv15();
    let flown = |scenario: &str, seed: u64| {
        let world = format!("[world]\nturbulence_mps = 2.0\nturbulence_seed = {seed}");
        let scenario = scenario.replacen("[world]", &world, 1);
        let start = aircraft::start("scenario.toml", &scenario).unwrap_or_else(|e| panic!("{e}"));
        let state = state_at(&start, &xv15).unwrap_or_else(|e| panic!("{e}"));
        fly(&xv15, &state, start.world.world(), 50).environment
    };
    const IN_THE_AIR: &str = include_str!("../../../../aircraft/scenario/approach-60.toml");
    for scenario in [IN_THE_AIR, aircraft::DEFAULT_SCENARIO] {
        assert_eq!(flown(scenario, 1), flown(scenario, 1));
        assert_ne!(flown(scenario, 1), flown(scenario, 2), "{scenario}");
    }
}
