//! The whole step against motions that are known exactly.

use engine::frames::Vec3;
use engine::{GRAVITY_MPS2, State, step};

use crate::flying::{
    TICKS_PER_S, aloft, calm, energy_j, in_vacuum, parked, rotors_stopped, turning, xv15,
};

/// A body without air around it, its integration already under way.
fn falling(turn: Vec3<engine::frames::Body>) -> (engine::Aircraft, State) {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let xv15 = xv15.with(in_vacuum);
    let mut state = rotors_stopped(&aloft(&parked, 0.0, 30.0));
    state.cockpit.collective_norm = 0.0;
    state.actuators.lever_norm = 0.0;
    state.plant.angular_rate_radps = turn;
    // Nothing damps blades that swing in a vacuum, and swinging blades shake the airframe.
    for flapping in [&mut state.plant.rotors.left.flapping, &mut state.plant.rotors.right.flapping]
    {
        (flapping.coning_rad, flapping.coning_radps) = (xv15.rotors.flapping.precone_rad, 0.0);
    }
    state.rate = step(&xv15, &state, &calm()).0.rate;
    (xv15, state)
}

/// Constant acceleration is exact in the rule that is used: only rounding is left.
#[test]
fn free_fall_is_half_g_t_squared_to_the_rounding() {
    let (xv15, start) = falling(Vec3::zero());
    let mut state = start;
    for _ in 0..8 * TICKS_PER_S {
        state = step(&xv15, &state, &calm()).0;
    }
    let fallen_m = state.plant.position_m.z - start.plant.position_m.z;
    assert!((fallen_m - 0.5 * GRAVITY_MPS2 * 64.0).abs() < 1e-10, "{fallen_m}");
    let forward_m = state.plant.position_m.x - start.plant.position_m.x;
    assert!((forward_m - 240.0).abs() < 1e-10, "{forward_m}");
    assert!((state.plant.velocity_mps.z - 8.0 * GRAVITY_MPS2).abs() < 1e-11);
    assert_eq!(state.plant.angular_rate_radps, Vec3::zero());
}

/// Per radian turned, the second-order rule is off by 5/12 of the square of the angle of a tick:
/// at some 1 rad/s for eight seconds, 8·5/12·(0.004)² at most, for rates that turn as fast.
const TURN_TOLERANCE: f64 = 6e-5;

#[test]
fn a_torque_free_tumble_keeps_its_angular_momentum_and_energy() {
    let (xv15, start) = falling(Vec3::new(0.6, 0.5, -0.7));
    let inertia = step(&xv15, &start, &calm()).1.balance.inertia;
    let momentum = |state: &State| {
        let plant = &state.plant;
        plant.attitude.ned_from_body() * turning(inertia, plant.angular_rate_radps)
    };
    let (first, first_j) =
        (momentum(&start), energy_j(&xv15, &start, &step(&xv15, &start, &calm()).1));
    let mut state = start;
    let mut worst = 0.0;
    for _ in 0..8 * TICKS_PER_S {
        let (next, outputs) = step(&xv15, &state, &calm());
        let drift = (momentum(&state) - first).norm() / first.norm();
        worst = engine::math::max(worst, drift);
        let gained = energy_j(&xv15, &state, &outputs) / first_j - 1.0;
        assert!(gained.abs() < 1e-7, "energy by {gained:e}");
        state = next;
    }
    println!("momentum drifts by {worst:e}");
    assert!(worst < TURN_TOLERANCE, "{worst:e}");
    assert!((state.plant.angular_rate_radps - start.plant.angular_rate_radps).norm() > 0.1);
}
