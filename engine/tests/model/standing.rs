//! The aircraft on its wheels.

use engine::frames::Vec3;
use engine::state::Geodetic;
use engine::step;

use crate::flying::{self, TICKS_PER_S, calm, parked, xv15};

#[test]
fn parked_with_brakes_it_stands_still_for_a_minute() {
    let xv15 = xv15();
    let start = parked(&xv15);
    let mut state = start;
    let (mut moved_m, mut fastest_mps, mut turned_radps) = (0.0, 0.0, 0.0);
    for _ in 0..60 * TICKS_PER_S {
        state = step(&xv15, &state, &calm()).0;
        let max = engine::math::max;
        moved_m = max(moved_m, (state.plant.position_m - start.plant.position_m).norm());
        fastest_mps = max(fastest_mps, state.plant.velocity_mps.norm());
        turned_radps = max(turned_radps, state.plant.angular_rate_radps.norm());
    }
    println!("{moved_m:.6} m, {fastest_mps:.6} m/s, {turned_radps:.6} rad/s");
    assert!(moved_m < 1e-3, "{:.3} mm", 1e3 * moved_m);
    assert!(fastest_mps < 1e-3, "{:.3} mm/s", 1e3 * fastest_mps);
    assert!(turned_radps < 1e-4, "{turned_radps:.6} rad/s");
}

/// Where the start is, is where the aircraft stands: place, heading, fuel, ground.
#[test]
fn on_its_wheels_it_stands_where_the_start_says() {
    let xv15 = xv15();
    let origin = Geodetic { latitude_rad: 0.5, longitude_rad: -1.25, height_m: 300.0 };
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
    let start = engine::start::Start { origin, heading_rad: 1.0, ..start };
    let state = start.on_wheels(&xv15);
    let seen = step(&xv15, &state, &calm()).1;
    let off_rad = (seen.place.latitude_rad - origin.latitude_rad).abs()
        + (seen.place.longitude_rad - origin.longitude_rad).abs();
    assert!(off_rad < 1e-9, "{:?}", seen.place);
    let height_m = seen.place.height_m - origin.height_m;
    assert!((1.0..3.0).contains(&height_m), "the centre of gravity stands {height_m} m high");
    assert!((seen.euler.heading_rad - 1.0).abs() < 1e-4, "{:?}", seen.euler);
    assert!((seen.fuel_kg - start.fuel_aboard_kg(&xv15)).abs() < 0.1, "{} kg", seen.fuel_kg);
}

/// What sampling may add in a tick as the tyres swing back: they hold 400 J at 10 rad/s, of which
/// a step of 4 ms misplaces a hundredth, to an aircraft of a megajoule.
const GAIN_J: f64 = 1.0;

/// Friction may take energy only: rolling and sliding from 20 m/s, the speed never rises.
#[test]
fn wheels_never_speed_the_aircraft_up() {
    // Without rotors and air nothing but the ground acts along it.
    let xv15 = xv15().with(flying::in_vacuum);
    for (brake, sideways_mps) in [(0, 0.0), (1, 0.0), (0, 8.0), (1, 8.0)] {
        let mut state = flying::rotors_stopped(&parked(&xv15));
        state.cockpit.parking_brake = brake;
        state.plant.velocity_mps = Vec3::new(20.0, sideways_mps, 0.0);
        let mut energy_j = f64::INFINITY;
        for _ in 0..20 * TICKS_PER_S {
            let (next, outputs) = step(&xv15, &state, &calm());
            let before_j = energy_j;
            energy_j = flying::energy_j(&xv15, &state, &outputs);
            assert!(energy_j < before_j + GAIN_J, "{energy_j} after {before_j} J");
            state = next;
        }
        let left = state.plant.velocity_mps;
        assert!(brake == 0 || left.norm() < 1e-2, "{left:?}");
    }
}
