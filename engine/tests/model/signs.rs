//! Which way the aircraft goes: the sign tests of the source, as differences between two flights.
//!
//! The flights are short and not trimmed; both begin alike and differ in one control only.

use engine::frames::{Body, Vec3};
use engine::outputs::Validity;
use engine::{Aircraft, State, cockpit};

use crate::flying::{self, DEG, TICKS_PER_S, aloft, coast, euler, parked, xv15};

/// Mast tilts, each with a speed at which the XV-15 flies there.
const REGIMES: [(f64, f64); 4] = [(0.0, 0.0), (30.0, 45.0), (60.0, 60.0), (90.0, 100.0)];

/// How two flights from one state differ at their ends: the one with a control less the one without.
struct Difference {
    rate: Vec3<Body>,
    moment: Vec3<Body>,
    climb_mps: f64,
    forward_mps: f64,
}

/// SCAS off: the airframe's own answer.
fn difference(
    xv15: &Aircraft,
    state: &State,
    ticks: u64,
    control: impl Fn(&mut cockpit::State),
) -> Difference {
    let mut without = *state;
    without.cockpit.scas_on = 0;
    let mut with = without;
    control(&mut with.cockpit);
    let (with, with_outputs) = coast(xv15, &with, ticks);
    let (without, outputs) = coast(xv15, &without, ticks);
    Difference {
        rate: with.plant.angular_rate_radps - without.plant.angular_rate_radps,
        moment: with_outputs.total.moment_n_m - outputs.total.moment_n_m,
        climb_mps: without.plant.velocity_mps.z - with.plant.velocity_mps.z,
        forward_mps: with.plant.velocity_mps.x - without.plant.velocity_mps.x,
    }
}

fn in_every_regime(check: impl Fn(&Aircraft, &State, f64)) {
    let xv15 = xv15();
    let parked = parked(&xv15);
    for (mast_tilt_deg, speed_mps) in REGIMES {
        check(&xv15, &aloft(&parked, mast_tilt_deg * DEG, speed_mps), mast_tilt_deg);
    }
}

#[test]
fn stick_forward_is_nose_down_at_every_tilt() {
    in_every_regime(|xv15, state, tilt_deg| {
        let d = difference(xv15, state, 125, |pilot| pilot.stick_aft_norm = -0.3);
        assert!(d.rate.y < -2.0 * DEG, "tilt {tilt_deg}: {:.2} deg/s", d.rate.y / DEG);
    });
}

#[test]
fn stick_right_rolls_right_at_every_tilt() {
    in_every_regime(|xv15, state, tilt_deg| {
        let d = difference(xv15, state, 125, |pilot| pilot.stick_right_norm = 0.3);
        assert!(d.rate.x > 2.0 * DEG, "tilt {tilt_deg}: {:.2} deg/s", d.rate.x / DEG);
    });
}

#[test]
fn right_pedal_turns_the_nose_right_at_every_tilt() {
    in_every_regime(|xv15, state, tilt_deg| {
        let d = difference(xv15, state, 125, |pilot| pilot.pedal_right_norm = 0.3);
        assert!(d.rate.z > 0.5 * DEG, "tilt {tilt_deg}: {:.2} deg/s", d.rate.z / DEG);
    });
}

#[test]
fn power_lever_up_climbs_as_a_helicopter_and_accelerates_as_an_aeroplane() {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let lever_up = |pilot: &mut cockpit::State| pilot.collective_norm = 0.7;
    let hover = difference(&xv15, &aloft(&parked, 0.0, 0.0), 250, lever_up);
    assert!(hover.climb_mps > 0.5, "{:.2} m/s", hover.climb_mps);
    let cruise = difference(&xv15, &aloft(&parked, 90.0 * DEG, 100.0), 500, lever_up);
    assert!(cruise.forward_mps > 0.5, "{:.2} m/s", cruise.forward_mps);
}

/// TM812: conversion gives a nose-down moment and some 0.4 g. For the first second the tail, which loses the
/// rotors' upwash, holds against it with some 1000 N m: CR536's tables 2-Ia to 2-Ic say so (.90 of the induced
/// velocity upright, .48 at 30 deg), and the nose-down moment of steady flight comes after it.
#[test]
fn nacelles_forward_accelerate_and_pitch_the_nose_down() {
    let xv15 = xv15();
    let state = aloft(&parked(&xv15), 15.0 * DEG, 40.0);
    let forward = |pilot: &mut cockpit::State| pilot.nacelle_aft_norm = -1.0;
    let d = difference(&xv15, &state, 400, forward);
    assert!(d.moment.y < 0.0 && d.rate.y < 0.0, "{:.0} N m", d.moment.y);
    assert!(d.forward_mps > 0.03, "{:.2} m/s", d.forward_mps);
    let aft = |pilot: &mut cockpit::State| pilot.nacelle_aft_norm = 1.0;
    let d = difference(&xv15, &state, 400, aft);
    assert!(d.moment.y > 0.0 && d.rate.y > 0.0 && d.forward_mps < -0.03);
}

#[test]
fn flaps_down_lift_and_drag_in_forward_flight() {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), 60.0 * DEG, 60.0);
    state.cockpit.flap_detent = 0;
    state.actuators.flap_rad = 0.0;
    let d = difference(&xv15, &state, 500, |pilot| pilot.flap_detent = 2);
    assert!(d.climb_mps > 0.5 && d.forward_mps < -0.1, "{:.2} {:.2}", d.climb_mps, d.forward_mps);
}

#[test]
fn scas_damps_every_axis_more_than_the_bare_airframe() {
    let xv15 = xv15();
    let mut on = aloft(&parked(&xv15), 0.0, 0.0);
    on.plant.angular_rate_radps = Vec3::new(0.1, 0.1, 0.1);
    let mut off = on;
    off.cockpit.scas_on = 0;
    let rate = |state: &State| coast(&xv15, state, 100).0.plant.angular_rate_radps;
    let (on, off) = (rate(&on), rate(&off));
    assert!(on.x < off.x && on.y < off.y && on.z < off.z, "{on:?} {off:?}");
}

/// Lift, weathercock and attitude signs have to agree for this.
#[test]
fn a_bank_to_the_right_turns_to_the_right() {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), 90.0 * DEG, 100.0);
    state.plant.attitude = engine::frames::Attitude::from_euler(engine::frames::Euler {
        roll_rad: 20.0 * DEG,
        ..Default::default()
    });
    let (turned, _) = coast(&xv15, &state, 3 * TICKS_PER_S);
    assert!(turned.plant.velocity_mps.y > 3.0, "{:?}", turned.plant.velocity_mps);
    assert!(euler(&turned).heading_rad > 2.0 * DEG);
}

/// Hands that hold a height over one place, level, and someone who looks on.
fn hover(xv15: &Aircraft, start: &State, ticks: u64, mut look: impl FnMut(u64, &State)) {
    let clamp = engine::math::clamp;
    let mut state = *start;
    let mut lever = state.cockpit.collective_norm;
    // What attitude and stick are without a drift, these hands have to find out.
    let mut lean_rad = 0.0;
    for tick in 0..ticks {
        let plant = &state.plant;
        let climb_mps = clamp(0.1 * (plant.position_m.z - start.plant.position_m.z), -2.0, 2.0);
        let missing_mps = climb_mps + plant.velocity_mps.z;
        lever = clamp(lever + 0.0001 * missing_mps, 0.0, 1.0);
        let (at, rate) = (euler(&state), plant.angular_rate_radps);
        lean_rad = clamp(lean_rad + 2.4e-5 * plant.velocity_mps.x, -0.1, 0.1);
        let pitch_rad = clamp(lean_rad + 0.03 * plant.velocity_mps.x, -0.2, 0.2);
        let roll_rad = clamp(-0.03 * plant.velocity_mps.y, -0.2, 0.2);
        state.cockpit.collective_norm = clamp(lever + 0.04 * missing_mps, 0.0, 1.0);
        state.cockpit.stick_aft_norm = clamp(2.0 * (pitch_rad - at.pitch_rad) - rate.y, -1.0, 1.0);
        state.cockpit.stick_right_norm = clamp(2.0 * (roll_rad - at.roll_rad) - rate.x, -1.0, 1.0);
        state = engine::step(xv15, &state, &flying::calm()).0;
        look(tick, &state);
    }
}

#[test]
fn the_governor_holds_the_rotors_at_589_rpm_in_hover() {
    let xv15 = xv15();
    let start = aloft(&parked(&xv15), 0.0, 0.0);
    hover(&xv15, &start, 40 * TICKS_PER_S, |tick, state| {
        let rpm = state.plant.rotor_speed_radps / engine::units::RPM_RADPS;
        let settled = tick > 25 * TICKS_PER_S;
        assert!(!settled || (rpm - 589.0).abs() < 2.0, "{rpm:.1} rpm");
        let drift = state.plant.velocity_mps;
        assert!(!settled || drift.norm() < 0.5, "no hover: {drift:?}");
    });
}

#[test]
fn a_vortex_ring_is_reported_in_a_steep_descent_and_not_on_the_ground() {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let (_, standing) = coast(&xv15, &parked, 1);
    assert_eq!(standing.validity, Validity::empty());
    let mut sinking = aloft(&parked, 0.0, 0.0);
    sinking.plant.velocity_mps.z = 10.0;
    // The inflow has to build up first.
    let (_, sinking) = coast(&xv15, &sinking, TICKS_PER_S / 2);
    assert!(sinking.validity.contains(Validity::VORTEX_RING), "{}", sinking.validity);
}

/// Switched on again after a change of attitude, the hold must not pull back to the old one.
#[test]
fn the_attitude_hold_forgets_while_it_is_off() {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), 0.0, 0.0);
    state.cockpit.scas_on = 0;
    state.plant.angular_rate_radps.x = 0.1;
    let (state, _) = coast(&xv15, &state, 3 * TICKS_PER_S);
    let off_rad = euler(&state).roll_rad - state.fcc.scas.held_roll_rad;
    let roll_rad = euler(&state).roll_rad;
    assert!(roll_rad.abs() > 5.0 * DEG, "it rolled: {:.1} deg", roll_rad / DEG);
    assert!(off_rad.abs() < 0.7 * roll_rad.abs(), "{:.1} deg behind", off_rad / DEG);
}
