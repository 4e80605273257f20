//! Random flights across the envelope and far beyond it: tumbling, vortex rings, crashes, stopped
//! engines, wild hands, weather that nobody flies in. No number ever breaks, nothing runs away, and
//! where the model is no longer to be trusted the outputs say so.
//!
//! `TILTROTOR_FLIGHTS=10000` flies that many (`tests/ten_thousand.sh`), `TILTROTOR_SEED=7` the flight of
//! one seed.

mod flying;

use std::collections::BTreeMap;
use std::env;
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use engine::frames::{Attitude, Euler, Vec3};
use engine::inputs::{Failures, World};
use engine::math::{PI, cos, sin};
use engine::outputs::Validity;
use engine::{Aircraft, Inputs, Outputs, State, step};
use flying::{Chance, DEG, TICKS_PER_S, aloft, energy_j, parked, words, xv15};

/// Fewer where nothing is optimised, so that the crate's tests stay within a minute.
const FLIGHTS: u64 = if cfg!(debug_assertions) { 40 } else { 300 };
/// Length of a flight.
const TICKS: u64 = 20 * TICKS_PER_S;

/// Beyond this nothing here can fly or fall: a vertical dive ends at some 330 m/s.
const SPEED_MPS_MAX: f64 = 400.0;
/// A tumble: these hands make one of 6 rad/s, and it may begin with 10.
const TURN_RADPS_MAX: f64 = 20.0;
/// Windmilling in a dive at 250 m/s: twice the speed of a helicopter, and not three times.
const ROTOR_RADPS_MAX: f64 = 185.0;
/// Still air gives nothing back but what wake, flapping and tyres had stored: the energy of a climb
/// of 10 m.
const ENERGY_KJ_MAX: f64 = 600.0;

/// How a flight begins.
#[derive(Clone, Copy, Debug)]
enum Beginning {
    /// Between standing and flying fast.
    Anywhere,
    /// Any way up, and turning.
    Tumbling,
    /// Sinking upright through its own wake.
    VortexRing,
    /// Just before the ground, and not as one should be.
    HardLanding,
    /// Fast in any direction.
    Fast,
    /// Where the air is thin.
    High,
    /// Rotors too slow or too fast, engines out, tanks empty.
    Powerless,
}

const BEGINNINGS: [Beginning; 7] = [
    Beginning::Anywhere,
    Beginning::Tumbling,
    Beginning::VortexRing,
    Beginning::HardLanding,
    Beginning::Fast,
    Beginning::High,
    Beginning::Powerless,
];

fn begin(chance: &mut Chance, how: Beginning, parked: &State, world: &mut World) -> State {
    if matches!(how, Beginning::Anywhere) {
        return chance.start(parked);
    }
    let mut state = aloft(parked, chance.between(-5.0, 90.0) * DEG, 0.0);
    let any_m = chance.between(20.0, 1000.0);
    let mut attitude = Euler {
        roll_rad: chance.between(-0.3, 0.3),
        pitch_rad: chance.between(-0.3, 0.3),
        heading_rad: chance.between(-PI, PI),
    };
    let plant = &mut state.plant;
    plant.position_m.z = -any_m;
    let along = |mps: f64, chance: &mut Chance| {
        let (course_rad, dive_rad) = (chance.between(-PI, PI), chance.between(-PI, PI));
        Vec3::new(
            mps * cos(course_rad) * cos(dive_rad),
            mps * sin(course_rad) * cos(dive_rad),
            mps * sin(dive_rad),
        )
    };
    match how {
        Beginning::Anywhere => {}
        Beginning::Tumbling => {
            attitude.roll_rad = chance.between(-PI, PI);
            attitude.pitch_rad = chance.between(-1.57, 1.57);
            plant.velocity_mps = along(chance.between(0.0, 100.0), chance);
            plant.angular_rate_radps = Vec3::new(
                chance.between(-6.0, 6.0),
                chance.between(-6.0, 6.0),
                chance.between(-6.0, 6.0),
            );
        }
        Beginning::VortexRing => {
            state.actuators.mast_tilt_rad =
                engine::pair::Pair::both(chance.between(0.0, 15.0) * DEG);
            plant.velocity_mps = Vec3::new(
                chance.between(-8.0, 8.0),
                chance.between(-8.0, 8.0),
                chance.between(2.0, 30.0),
            );
        }
        Beginning::HardLanding => {
            attitude.roll_rad *= 2.0;
            attitude.pitch_rad *= 2.0;
            plant.position_m.z = -chance.between(2.0, 12.0);
            plant.velocity_mps = Vec3::new(
                chance.between(-60.0, 60.0),
                chance.between(-20.0, 20.0),
                chance.between(0.0, 25.0),
            );
            state.cockpit.gear_down = chance.of(2);
        }
        Beginning::Fast => plant.velocity_mps = along(chance.between(80.0, 250.0), chance),
        Beginning::High => {
            plant.position_m.z = -chance.between(4e3, 15e3);
            plant.velocity_mps = along(chance.between(0.0, 150.0), chance);
        }
        Beginning::Powerless => {
            plant.velocity_mps = along(chance.between(0.0, 120.0), chance);
            plant.rotor_speed_radps *= chance.between(0.0, 1.4);
            plant.fuel_kg *= chance.between(0.0, 1.0) * chance.of(2) as f64;
            world.failures = Failures::from_bits_retain(chance.of(4)) & Failures::ENGINES;
        }
    }
    state.plant.attitude = Attitude::from_euler(attitude);
    state.environment.noise = chance.of(1 << 40);
    state
}

/// Now and then weather that nobody flies in.
fn storm(chance: &mut Chance, tick: u64, before: &World) -> World {
    let mut world = chance.world(before);
    if chance.one_in(500) {
        world.gust_mps = Vec3::new(
            chance.between(-30.0, 30.0),
            chance.between(-30.0, 30.0),
            chance.between(-30.0, 30.0),
        );
        world.gust_s = chance.between(0.0, 5.0);
        world.gust_start_tick = tick;
    }
    if chance.one_in(500) {
        world.turbulence_mps = chance.between(0.0, 12.0);
        world.wind_roughness_m = chance.between(0.0, 2.0) * chance.of(2) as f64;
    }
    if chance.one_in(1000) {
        world.temperature_offset_k = chance.between(-80.0, 80.0);
        world.pressure_offset_pa = chance.between(-20e3, 20e3);
    }
    world
}

/// What the outputs must say of a state, whatever the model thinks of it.
fn untold(state: &State, outputs: &Outputs) -> Option<&'static str> {
    let told = |flag: Validity| outputs.validity.contains(flag);
    let legs = &outputs.landing_gear;
    let bottomed = [legs.nose, legs.main.left, legs.main.right].iter().any(|leg| leg.bottomed != 0);
    let rotor_radps = state.plant.rotor_speed_radps;
    [
        (outputs.airspeed_mps > 180.0, Validity::SPEED, "faster than the data"),
        (outputs.place.height_m > 12e3, Validity::HEIGHT, "higher than the data"),
        (bottomed, Validity::GEAR_BOTTOMED, "a strut past its stroke"),
        (
            !(43.0..=69.3).contains(&rotor_radps),
            Validity::ROTOR_SPEED,
            "rotors too slow or too fast",
        ),
        (state.plant.angular_rate_radps.norm() > 3.0, Validity::TUMBLING, "a tumble"),
    ]
    .into_iter()
    .find(|(beyond, flag, _)| *beyond && !told(*flag))
    .map(|(_, _, what)| what)
}

/// The greatest numbers that were met, by name.
type Extremes = BTreeMap<&'static str, f64>;

/// Flies a seed; says at which tick it broke, and how.
fn fly(xv15: &Aircraft, parked: &State, seed: u64, extremes: &mut Extremes) -> Result<(), String> {
    const NEGATIVE_ZERO: u64 = 1 << 63;
    let mut chance = Chance::seeded(seed);
    let mut world = World::default();
    let how = BEGINNINGS[(seed % BEGINNINGS.len() as u64) as usize];
    let mut state = begin(&mut chance, how, parked, &mut world).without_negative_zeros();
    // In still air what flies has no energy but its own and that of its engines.
    let still = chance.one_in(4);
    let mut given_j = f64::INFINITY;
    for tick in 0..TICKS {
        let events = chance.events(tick);
        world = if still { world } else { storm(&mut chance, tick, &world) };
        let (next, outputs) = step(xv15, &state, &Inputs { events: &events, world });
        let broken = |what: &str| Err(format!("seed {seed} ({how:?}), tick {}: {what}", next.tick));
        if !next.is_finite() || next.frozen != 0 || !outputs.total.force_n.norm().is_finite() {
            return broken("a number is not finite");
        }
        if words(&next).contains(&NEGATIVE_ZERO) {
            return broken("a zero is negative");
        }
        if let Some(what) = untold(&next, &outputs) {
            return broken(&format!("{what}, and the outputs do not say so"));
        }
        let spin_j = 0.5
            * (2.0 * xv15.rotors.polar_inertia_kg_m2 + xv15.engines.drive_inertia_kg_m2)
            * next.plant.rotor_speed_radps
            * next.plant.rotor_speed_radps;
        let energy_j = energy_j(xv15, &next, &outputs) + spin_j;
        if tick == 0 {
            given_j = energy_j;
        }
        given_j += outputs.engines.power_w.sum() * engine::STEP_S;
        let mut met = |name: &'static str, value: f64, most: f64| {
            let greatest = extremes.entry(name).or_insert(value);
            *greatest = engine::math::max(*greatest, value);
            if value < most { Ok(()) } else { broken(&format!("{name} is {value:.3}")) }
        };
        met("speed, m/s", next.plant.velocity_mps.norm(), SPEED_MPS_MAX)?;
        met("angular rate, rad/s", next.plant.angular_rate_radps.norm(), TURN_RADPS_MAX)?;
        met("rotor speed, rad/s", next.plant.rotor_speed_radps, ROTOR_RADPS_MAX)?;
        if still {
            met("energy out of nothing, kJ", (energy_j - given_j) * 1e-3, ENERGY_KJ_MAX)?;
        }
        state = next;
    }
    Ok(())
}

fn number(name: &str) -> Option<u64> {
    env::var(name).ok().map(|text| text.parse().unwrap_or_else(|_| panic!("{name}: a number")))
}

/// For whoever reads a failure.
fn commit() -> String {
    let git = Command::new("git").args(["describe", "--always", "--dirty", "--abbrev=12"]).output();
    git.map_or_else(
        |_| "unknown".into(),
        |said| String::from_utf8_lossy(&said.stdout).trim().into(),
    )
}

#[test]
fn no_flight_however_violent_breaks_the_numbers() {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let first = number("TILTROTOR_SEED");
    let flights = first.map_or_else(|| number("TILTROTOR_FLIGHTS").unwrap_or(FLIGHTS), |_| 1);
    let next = AtomicU64::new(0);
    let found = Mutex::new((Vec::new(), Extremes::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                let mut extremes = Extremes::new();
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= flights {
                        break;
                    }
                    let seed = first.unwrap_or(0) + number;
                    if let Err(broken) = fly(&xv15, &parked, seed, &mut extremes) {
                        found.lock().unwrap().0.push(broken);
                    }
                }
                for (name, value) in extremes {
                    let mut found = found.lock().unwrap();
                    let greatest = found.1.entry(name).or_insert(value);
                    *greatest = engine::math::max(*greatest, value);
                }
            });
        }
    });
    let (broken, extremes) = found.into_inner().unwrap();
    println!("{flights} flights of {} s", TICKS / TICKS_PER_S);
    for (name, value) in extremes {
        println!("  greatest {name}: {value:.1}");
    }
    assert!(
        broken.is_empty(),
        "{} of {flights} flights broke; commit {}\n{}",
        broken.len(),
        commit(),
        broken[..broken.len().min(20)].join("\n")
    );
}
