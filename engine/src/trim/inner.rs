//! The state as a list of numbers, and which of them are the plant's inner states.

use alloc::string::String;
use alloc::vec::Vec;

use crate::frames::{Body, Vec3};
use crate::inputs::World;
use crate::state::State;
use crate::{Aircraft, step};

/// The places of the plant's inner states among the numbers of a state, with their names: whatever
/// the plant remembers beside the rigid body, the drive, the fuel and the tyres.
pub(crate) fn inner_states(names: &[String]) -> Vec<usize> {
    const OTHERS: [&str; 9] = [
        "plant.origin",
        "plant.position_m",
        "plant.velocity_mps",
        "plant.attitude",
        "plant.angular_rate_radps",
        "plant.rotor_speed_radps",
        "plant.rotor_azimuth_rad",
        "plant.fuel_kg",
        "plant.tyre_deflections",
    ];
    (0..names.len())
        .filter(|&i| {
            names[i].starts_with("plant.")
                && !names[i].starts_with("plant.engines")
                && !OTHERS.iter().any(|other| names[i].starts_with(other))
        })
        .collect()
}

/// The state's numbers.
pub(crate) fn numbers(state: &State) -> Vec<f64> {
    let mut numbers = Vec::new();
    let mut copy = *state;
    copy.each_number(|number| numbers.push(*number));
    numbers
}

/// The state after some ticks in which only the plant's inner states move, as on a test stand:
/// the body, the drive and all controls are held.
pub fn settle(aircraft: &Aircraft, state: &State, world: &World, ticks: usize) -> State {
    let inner = inner_states(&state.number_names());
    let mut state = *state;
    for _ in 0..ticks {
        let next = numbers(&step::derivatives(aircraft, &state, world).0);
        set_numbers(&mut state, &inner, |i| next[inner[i]]);
    }
    state
}

/// Sets the numbers at these places, which ascend; what is not finite stays as it was.
pub(crate) fn set_numbers(state: &mut State, places: &[usize], value: impl Fn(usize) -> f64) {
    let (mut number, mut i) = (0, 0);
    state.each_number(|place| {
        if places.get(i) == Some(&number) {
            let value = value(i);
            if value.is_finite() {
                *place = value;
            }
            i += 1;
        }
        number += 1;
    });
}

/// u̇ and ω̇ in body axes of a state whose rates are in `next`.
pub(crate) fn accelerations(state: &State, next: &State) -> [f64; 6] {
    let body_from_ned = state.plant.attitude.ned_from_body().inverse();
    let rate = &next.rate.motion;
    let omega = state.plant.angular_rate_radps;
    let along: Vec3<Body> = body_from_ned * rate.acceleration_mps2
        - omega.cross(body_from_ned * state.plant.velocity_mps);
    let turn = rate.angular_acceleration_radps2;
    [along.x, along.y, along.z, turn.x, turn.y, turn.z]
}
