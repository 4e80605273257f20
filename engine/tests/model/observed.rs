//! What is observed after a tick, computed once more by other formulas: rotation matrices out of the
//! quaternion, the Earth in earth-centred axes, the atmosphere and the pitot tube by their printed
//! equations, rates by differences. And every validity bit, set by what it is there for.
#![allow(
    clippy::disallowed_methods,
    reason = "other formulas, by other functions than the engine's"
)]

use engine::frames::{Attitude, Euler, Vec3};
use engine::inputs::World;
use engine::outputs::Validity;
use engine::pair::Pair;
use engine::step::derivatives;
use engine::{Aircraft, Inputs, Outputs, State, step};

use crate::flying::{self, Chance, DEG, aloft, parked, xv15};

const G: f64 = 9.806_65;

/// Rows of a matrix times a column.
type Matrix = [[f64; 3]; 3];

fn times(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

fn transposed(m: &Matrix) -> Matrix {
    [0, 1, 2].map(|column| m.map(|row| row[column]))
}

fn array<F>(v: Vec3<F>) -> [f64; 3] {
    [v.x, v.y, v.z]
}

/// From body axes to north, east, down.
fn direction_cosines(q: &Attitude) -> Matrix {
    let (w, x, y, z) = (q.w, q.x, q.y, q.z);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// Roll, pitch, heading of a matrix.
fn angles(m: &Matrix) -> [f64; 3] {
    [m[2][1].atan2(m[2][2]), (-m[2][0]).asin(), m[1][0].atan2(m[0][0])]
}

#[track_caller]
fn near(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance * b.abs().max(1.0), "{what}: {a}, by other formulas {b}");
}

#[track_caller]
fn all_near<const N: usize>(a: [f64; N], b: [f64; N], tolerance: f64, what: &str) {
    for (a, b) in a.into_iter().zip(b) {
        near(a, b, tolerance, what);
    }
}

/// Any way up, in any motion, in wind, gust and turbulence.
fn random(chance: &mut Chance, parked: &State) -> (State, World) {
    let mut state = aloft(parked, chance.between(0.0, 90.0) * DEG, 0.0);
    let plant = &mut state.plant;
    let mut any = |most: f64| chance.between(-most, most);
    plant.position_m = Vec3::new(any(300.0), any(300.0), -1500.0 + any(1400.0));
    plant.velocity_mps = Vec3::new(any(90.0), any(90.0), any(30.0));
    plant.angular_rate_radps = Vec3::new(any(1.0), any(1.0), any(1.0));
    plant.attitude = Attitude::from_euler(Euler {
        roll_rad: any(3.1),
        pitch_rad: any(1.4),
        heading_rad: any(3.1),
    });
    plant.fuel_kg = 300.0 + any(250.0);
    plant.rotor_azimuth_rad = 3.0 + any(2.9);
    plant.rotor_speed_radps = 56.0 + any(8.0);
    plant.engines = Pair { left: any(3e5), right: any(3e5) }
        .map(|power_w| engine::engines::State { power_w: 6e5 + power_w });
    state.environment.noise = chance.of(1 << 40);
    state.environment.turbulence_mps = Vec3::new(1.5, -2.0, 0.5);
    state.tick = chance.of(100_000);
    let mut any = |most: f64| chance.between(-most, most);
    let world = World {
        wind_mps: Vec3::new(any(15.0), any(15.0), any(3.0)),
        gust_mps: Vec3::new(any(5.0), any(5.0), any(5.0)),
        gust_s: 4.0,
        gust_start_tick: state.tick.saturating_sub(200),
        turbulence_mps: 1.0,
        temperature_offset_k: any(20.0),
        pressure_offset_pa: any(2000.0),
        ..World::default()
    }
    .with_ground(any(10.0));
    (state, world)
}

fn for_random_states(mut look: impl FnMut(&Aircraft, &State, &World, &State, &Outputs)) {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let mut chance = Chance::seeded(21);
    for _ in 0..300 {
        let (state, world) = random(&mut chance, &parked);
        let (rates, outputs) = derivatives(&xv15, &state, &world);
        look(&xv15, &state, &world, &rates, &outputs);
    }
}

#[test]
fn attitude_and_velocity_are_those_of_the_direction_cosines() {
    for_random_states(|_, state, world, _, outputs| {
        let plant = &state.plant;
        let to_ned = direction_cosines(&plant.attitude);
        let velocity = times(&transposed(&to_ned), array(plant.velocity_mps));
        all_near(array(outputs.body_velocity_mps), velocity, 1e-10, "velocity in body axes, m/s");
        let Euler { roll_rad, pitch_rad, heading_rad } = outputs.euler;
        all_near([roll_rad, pitch_rad, heading_rad], angles(&to_ned), 1e-9, "Euler angles, rad");

        let short_s = 1e-5;
        let turned = |s: f64| {
            let half = array(plant.angular_rate_radps).map(|radps| 0.5 * radps * s);
            let q = &plant.attitude;
            let [x, y, z] = half;
            let w = q.w - q.x * x - q.y * y - q.z * z;
            let i = q.x + q.w * x + q.y * z - q.z * y;
            let j = q.y + q.w * y + q.z * x - q.x * z;
            let k = q.z + q.w * z + q.x * y - q.y * x;
            let norm = (w * w + i * i + j * j + k * k).sqrt();
            angles(&direction_cosines(&Attitude {
                w: w / norm,
                x: i / norm,
                y: j / norm,
                z: k / norm,
            }))
        };
        let (after, before) = (turned(short_s), turned(-short_s));
        let rate = outputs.euler_rate;
        for (rate, (after, before)) in [rate.roll_radps, rate.pitch_radps, rate.heading_radps]
            .into_iter()
            .zip(after.into_iter().zip(before))
        {
            let change = (after - before).sin().asin();
            near(rate, change / (2.0 * short_s), 1e-5, "rates of the Euler angles, rad/s");
        }

        near(
            outputs.height_above_ground_m,
            -plant.position_m.z - world.ground_height_m.main.left,
            1e-12,
            "height above the ground, m",
        );
    });
}

/// Printed equations of the standard atmosphere; and the speed at which a pitot tube at sea level meets the
/// same impact pressure, by bisection of the compressible equation.
#[test]
fn airspeeds_follow_from_the_air_that_is_flown_through() {
    for_random_states(|_, state, world, _, outputs| {
        let plant = &state.plant;
        let to_body = transposed(&direction_cosines(&plant.attitude));
        let since_s = (state.tick - world.gust_start_tick) as f64 * 0.004;
        let swell = 0.5 * (1.0 - (std::f64::consts::TAU * since_s / world.gust_s).cos());
        let wind: Vec<f64> = array(world.wind_mps)
            .into_iter()
            .zip(array(world.gust_mps))
            .map(|(steady, gust)| steady + gust * swell)
            .collect();
        let through: Vec<f64> =
            array(plant.velocity_mps).into_iter().zip(&wind).map(|(v, w)| v - w).collect();
        let still = times(&to_body, through.try_into().unwrap());
        let turbulence = array(outputs.air.turbulence_mps);
        assert!(turbulence.iter().all(|mps| *mps != 0.0), "no turbulence");
        let [u, v, w] = [0, 1, 2].map(|axis| still[axis] - turbulence[axis]);

        let speed_mps = (u * u + v * v + w * w).sqrt();
        near(outputs.airspeed_mps, speed_mps, 1e-10, "airspeed, m/s");
        near(outputs.alpha_rad, w.atan2(u), 1e-9, "angle of attack, rad");
        near(outputs.beta_rad, (v / speed_mps).asin(), 1e-7, "sideslip, rad");

        let height_m = plant.origin.height_m - plant.position_m.z;
        let standard_k = 288.15 - 0.0065 * height_m;
        let temperature_k = standard_k + world.temperature_offset_k;
        let pressure_pa =
            (101_325.0 + world.pressure_offset_pa) * (standard_k / 288.15).powf(5.255_88);
        near(outputs.air.temperature_k, temperature_k, 1e-12, "temperature, K");
        near(outputs.air.pressure_pa, pressure_pa, 1e-6, "pressure, Pa");
        near(
            outputs.air.density_kg_per_m3,
            pressure_pa / (287.052_87 * temperature_k),
            1e-6,
            "density, kg/m3",
        );
        let mach = speed_mps / (1.4_f64 * 287.052_87 * temperature_k).sqrt();
        near(outputs.mach, mach, 1e-6, "Mach number");

        let impact_pa =
            |mach: f64, static_pa: f64| static_pa * ((1.0 + 0.2 * mach * mach).powf(3.5) - 1.0);
        let (mut low_mps, mut high_mps) = (0.0, 330.0);
        while high_mps - low_mps > 1e-9 {
            let middle_mps = 0.5 * (low_mps + high_mps);
            if impact_pa(middle_mps / 340.294, 101_325.0) < impact_pa(mach, pressure_pa) {
                low_mps = middle_mps;
            } else {
                high_mps = middle_mps;
            }
        }
        near(outputs.calibrated_airspeed_mps, low_mps, 1e-5, "calibrated airspeed, m/s");
    });
}

/// Earth-centred, earth-fixed axes of WGS-84.
fn earth_centred(latitude_rad: f64, longitude_rad: f64, height_m: f64) -> [f64; 3] {
    let e2 = 6.694_379_990_141_33e-3;
    let across_m = 6_378_137.0 / (1.0 - e2 * latitude_rad.sin().powi(2)).sqrt();
    let out_m = (across_m + height_m) * latitude_rad.cos();
    [
        out_m * longitude_rad.cos(),
        out_m * longitude_rad.sin(),
        (across_m * (1.0 - e2) + height_m) * latitude_rad.sin(),
    ]
}

/// A metre north, east or up at the origin is a metre in the Earth's own axes; 1e-6 of the way.
#[test]
fn the_place_is_that_on_the_ellipsoid() {
    for_random_states(|xv15, state, _, _, outputs| {
        let origin = &state.plant.origin;
        let at = |latitude_rad: f64, longitude_rad: f64| {
            earth_centred(latitude_rad, longitude_rad, origin.height_m)
        };
        let length = |a: [f64; 3], b: [f64; 3]| {
            a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
        };
        let small_rad = 1e-5;
        let (latitude_rad, longitude_rad) = (origin.latitude_rad, origin.longitude_rad);
        let north_m_per_rad = length(
            at(latitude_rad + small_rad, longitude_rad),
            at(latitude_rad - small_rad, longitude_rad),
        ) / (2.0 * small_rad);
        let east_m_per_rad = length(
            at(latitude_rad, longitude_rad + small_rad),
            at(latitude_rad, longitude_rad - small_rad),
        ) / (2.0 * small_rad);

        // The fixed point: structural axes are aft, right and up, body axes forward, right and down.
        let (fixed, centre) = (xv15.weight_balance.cg_m, outputs.balance.cg_m);
        let from_centre = [centre.x - fixed.x, fixed.y - centre.y, centre.z - fixed.z];
        let out = times(&direction_cosines(&state.plant.attitude), from_centre);
        let [north_m, east_m, down_m] =
            [0, 1, 2].map(|axis| array(state.plant.position_m)[axis] + out[axis]);
        let place = outputs.place;
        let north = (place.latitude_rad - latitude_rad) * north_m_per_rad;
        let east = (place.longitude_rad - longitude_rad) * east_m_per_rad;
        near(north, north_m, 1e-6, "metres north");
        near(east, east_m, 1e-6, "metres east");
        near(place.height_m, origin.height_m - down_m, 1e-12, "height, m");
    });
}

/// What an accelerometer reads is the acceleration less gravity, and nothing of the sum is left out.
#[test]
fn specific_force_and_loads_are_those_of_the_acceleration() {
    for_random_states(|_, state, _, rates, outputs| {
        let [north, east, down] = array(rates.rate.motion.acceleration_mps2);
        let to_body = transposed(&direction_cosines(&state.plant.attitude));
        let felt = times(&to_body, [north, east, down - G]);
        all_near(array(outputs.specific_force_mps2), felt, 1e-9, "specific force, m/s2");
        near(outputs.load_factor, -felt[2] / G, 1e-9, "load factor");

        let loads = &outputs.loads;
        let (sides, gear) = (
            [loads.rotors, loads.wing_pylon, loads.vertical_stabilizers, loads.jets],
            loads.landing_gear,
        );
        let all: Vec<_> = sides
            .into_iter()
            .flat_map(|pair| [pair.left, pair.right])
            .chain([loads.fuselage, loads.horizontal_stabilizer])
            .chain([gear.nose, gear.main.left, gear.main.right])
            .collect();
        let sum = |of: &dyn Fn(&engine::frames::Load) -> [f64; 3]| {
            all.iter()
                .map(of)
                .fold([0.0; 3], |sum, part| [0, 1, 2].map(|axis| sum[axis] + part[axis]))
        };
        let force = sum(&|load| array(load.force_n));
        let moment = sum(&|load| array(load.moment_n_m));
        all_near(array(outputs.total.force_n), force, 1e-9, "sum of forces, N");
        all_near(array(outputs.total.moment_n_m), moment, 1e-9, "sum of moments, N m");
        let weight_kg = 11_525.0 * 0.453_592_37 + state.plant.fuel_kg;
        near(outputs.balance.mass_kg, weight_kg, 1e-9, "mass, kg");
        all_near(force.map(|newtons| newtons / weight_kg), felt, 1e-9, "forces over mass, m/s2");
    });
}

#[test]
fn what_is_carried_over_is_the_states() {
    for_random_states(|_, state, _, _, outputs| {
        let plant = &state.plant;
        let pairs = [
            (outputs.rotor_speed_radps, plant.rotor_speed_radps),
            (outputs.rotor_azimuth_rad, plant.rotor_azimuth_rad),
            (outputs.fuel_kg, plant.fuel_kg),
            (outputs.position_m.x, plant.position_m.x),
            (outputs.position_m.y, plant.position_m.y),
            (outputs.position_m.z, plant.position_m.z),
            (outputs.velocity_mps.x, plant.velocity_mps.x),
            (outputs.velocity_mps.y, plant.velocity_mps.y),
            (outputs.velocity_mps.z, plant.velocity_mps.z),
            (outputs.angular_rate_radps.x, plant.angular_rate_radps.x),
            (outputs.angular_rate_radps.y, plant.angular_rate_radps.y),
            (outputs.angular_rate_radps.z, plant.angular_rate_radps.z),
        ];
        for (seen, held) in pairs {
            assert_eq!(seen.to_bits(), held.to_bits());
        }
        assert_eq!((outputs.tick, outputs.cockpit), (state.tick, state.cockpit));
        assert_eq!(outputs.actuators, state.actuators);
    });
}

/// Ten seconds hands-off: what the engines' flow takes is missing in the tanks, what the speed turns is in
/// the azimuth, what the velocity covers is in the position.
#[test]
fn sums_over_ten_seconds_are_the_integrals() {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), 0.0, 10.0);
    let begin = state;
    let (mut burnt_kg, mut turned_rad, mut north_m) = (0.0, 0.0, 0.0);
    let (mut turns, ticks) = (0, 2500);
    for _ in 0..ticks {
        let (next, outputs) = step(&xv15, &state, &flying::calm());
        burnt_kg += outputs.engines.fuel_flow_kg_per_s * 0.004;
        turned_rad += 0.5 * (state.plant.rotor_speed_radps + next.plant.rotor_speed_radps) * 0.004;
        north_m += 0.5 * (state.plant.velocity_mps.x + next.plant.velocity_mps.x) * 0.004;
        turns += usize::from(next.plant.rotor_azimuth_rad < state.plant.rotor_azimuth_rad);
        assert!((0.0..std::f64::consts::TAU).contains(&next.plant.rotor_azimuth_rad));
        state = next;
    }
    let burnt = begin.plant.fuel_kg - state.plant.fuel_kg;
    assert!(burnt > 0.1, "{burnt} kg in ten seconds");
    near(burnt, burnt_kg, 1e-3, "fuel burnt, kg");
    let azimuth_rad = state.plant.rotor_azimuth_rad - begin.plant.rotor_azimuth_rad
        + turns as f64 * std::f64::consts::TAU;
    assert!(turns > 80, "{turns} turns in ten seconds");
    near(azimuth_rad, turned_rad, 1e-9, "azimuth, rad");
    near(state.plant.position_m.x - begin.plant.position_m.x, north_m, 1e-9, "metres north");
}

/// Which bits are set after one tick.
fn bits(xv15: &Aircraft, state: &State) -> Validity {
    step(xv15, state, &Inputs { events: &[], world: World::default() }).1.validity
}

/// A flight that is well, and what breaks it: the one bit, from one side of its limit to the other.
#[test]
fn every_validity_bit_is_set_by_what_it_is_there_for() {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let well = aloft(&parked, 0.0, 20.0);
    assert_eq!(bits(&xv15, &well), Validity::empty());
    assert_eq!(bits(&xv15, &parked), Validity::empty());
    let mut seen = Validity::empty();
    let mut sets = |flag: Validity, change: &dyn Fn(&mut State)| {
        let mut state = well;
        change(&mut state);
        let found = bits(&xv15, &state);
        assert!(found.contains(flag), "{flag} is not set, but {found}");
        seen |= flag;
    };
    // Blades at 40 degrees in a hover are stalled from root to tip.
    sets(Validity::ROTOR_STALL, &|state| {
        state.actuators.collective_rad = Pair { left: 0.1, right: 40.0 * DEG };
    });
    sets(Validity::VORTEX_RING, &|state| {
        state.plant.velocity_mps = Vec3::new(0.0, 0.0, 9.0);
        state.plant.rotors = state.plant.rotors.map(|mut rotor| {
            rotor.inflow.mean_mps = 11.0;
            rotor
        });
    });
    sets(Validity::SPEED, &|state| state.plant.velocity_mps.x = 181.0);
    sets(Validity::HEIGHT, &|state| {
        state.plant.position_m.z = -12_001.0 + state.plant.origin.height_m;
    });
    sets(Validity::GEAR_BOTTOMED, &|state| {
        state.plant.position_m.z = parked.plant.position_m.z + 0.35;
        state.actuators.gear_extension_norm = 1.0;
        state.plant.velocity_mps = Vec3::zero();
    });
    sets(Validity::FROZEN, &|state| state.plant.velocity_mps.x = f64::NAN);
    sets(Validity::HULL, &|state| state.plant.position_m.z = 0.0);
    sets(Validity::FLAPPING_STOP, &|state| {
        state.plant.rotors.left.flapping.aft_rad = 12.5 * DEG;
    });
    sets(Validity::ROTOR_SPEED, &|state| state.plant.rotor_speed_radps = 42.0);
    sets(Validity::ROTOR_SPEED, &|state| state.plant.rotor_speed_radps = 70.0);
    sets(Validity::TUMBLING, &|state| state.plant.angular_rate_radps.y = 3.1);
    assert_eq!(seen, Validity::all(), "a bit that nothing sets");

    // On the near side of each limit none is.
    let mut near = well;
    near.plant.velocity_mps.x = 20.0;
    near.plant.rotor_speed_radps = 44.0;
    near.plant.angular_rate_radps.y = 2.9;
    near.plant.position_m.z = -11_900.0 + near.plant.origin.height_m;
    let slow = Validity::ROTOR_SPEED | Validity::TUMBLING | Validity::HEIGHT | Validity::SPEED;
    assert!(!bits(&xv15, &near).intersects(slow));
}

/// What is exactly at a limit is within it, and the least bit more is beyond.
#[test]
fn a_limit_of_the_model_is_the_last_number_that_is_within_it() {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), 0.3, 20.0);
    state.plant.angular_rate_radps = Vec3::new(0.1, 0.2, 0.3);
    let (next, seen) = step(&xv15, &state, &Inputs { events: &[], world: World::default() });
    let plant = next.plant;
    for (flag, value, least, limit) in [
        (Validity::SPEED, seen.airspeed_mps, false, (|model| &mut model.airspeed_mps_max) as Limit),
        (Validity::HEIGHT, seen.place.height_m, false, |model| &mut model.height_m_max),
        (Validity::TUMBLING, plant.angular_rate_radps.norm(), false, |model| {
            &mut model.angular_rate_radps_max
        }),
        (Validity::ROTOR_SPEED, plant.rotor_speed_radps, false, |model| {
            &mut model.rotor_speed_radps_max
        }),
        (Validity::ROTOR_SPEED, plant.rotor_speed_radps, true, |model| {
            &mut model.rotor_speed_radps_min
        }),
    ] {
        let with = |limit_is: f64| {
            let narrower = xv15.clone().with(|all| *limit(&mut all.envelope.model) = limit_is);
            bits(&narrower, &state)
        };
        assert_eq!(with(value), Validity::empty(), "{flag}, at its limit");
        let passed = if least { value.next_up() } else { value.next_down() };
        assert_eq!(with(passed), flag, "{flag}, just beyond its limit");
    }
}

/// Which limit of the model.
type Limit = fn(&mut engine::envelope::Model) -> &mut f64;
