use alloc::vec;

use super::*;
use crate::math::{FRAC_PI_2, sqrt};
use crate::table::{Table1, Table2};

use crate::units::DEGREE_RAD as DEG;
const DENSITY: f64 = crate::isa::DENSITY_SL_KG_PER_M3;
const OMEGA: f64 = 61.68;

/// A rotor for which theory has answers: straight lift, no drag, free gimbal without precone.
fn ideal() -> Params {
    let ends = vec![0.55, 0.80, 0.95, 1.0];
    let angles: vec::Vec<f64> = (-3..=6).map(|i| f64::from(2 * i) * DEG).collect();
    let lift = angles.iter().map(|angle| 5.7 * angle).collect::<vec::Vec<_>>();
    Params {
        radius_m: 3.81,
        solidity: 0.089,
        polar_inertia_kg_m2: 420.0,
        pivot_m: Vec3::new(7.62, 4.902, 2.54),
        mast_length_m: 1.4225,
        mast_cant_rad: 0.0,
        blade: blade::Params {
            count: 3.0,
            root_norm: 0.0875,
            blade_chord_m: Table1::new(vec![0.0, 1.0], vec![0.3556; 2]),
            twist_rad: Table1::new(vec![0.0, 1.0], vec![15.0 * DEG, -5.0 * DEG]),
            section: section::Params {
                lift_coefficient: Table2::new(
                    ends.clone(),
                    angles.clone(),
                    vec![lift; section::REGIONS],
                ),
                drag_coefficient: Table2::new(
                    ends.clone(),
                    angles,
                    vec![vec![0.0; 10]; section::REGIONS],
                ),
                thickness_norm: Table1::new(ends, vec![0.1; section::REGIONS]),
                table_tip_mach: 0.0,
                delay_exponent: 0.0,
                korn_factor: 9.0,
            },
        },
        inflow: inflow::Params {
            induced_power_factor: 1.0,
            recirculation: 0.0,
            download_near_ground: Table1::new(vec![0.5, 3.0], vec![0.5, 1.0]),
        },
        flapping: flapping::Params {
            blade_inertia_kg_m2: 139.0,
            precone_rad: 0.0,
            hub_spring_n_m_per_rad: 0.0,
            flapping_rad_max: 0.2,
            stop_spring_n_m_per_rad: 4e6,
            delta3_rad: 0.0,
        },
        bending: bending::Params {
            frequency_radps: 88.7,
            reference_radps: 47.96,
            shape_norm: [6.0, -4.0, 1.0],
        },
        other_rotor: other_rotor::Params {
            downwind: Table1::new(vec![0.0, 0.1, 0.2], vec![0.0, 0.8, 0.4]),
            abreast: Table1::new(vec![0.0, 0.1, 0.2], vec![0.0, -0.05, -0.1]),
        },
    }
}

fn hovering(collective_rad: f64) -> Inputs {
    Inputs {
        motion: Motion {
            cg_m: Vec3::new(7.62, 0.0, 2.54),
            airspeed_mps: Vec3::zero(),
            angular_rate_radps: Vec3::zero(),
            density_kg_per_m3: DENSITY,
        },
        sound_speed_mps: 1e6,
        mast_tilt_rad: 0.0,
        mast_tilt_rate_radps: 0.0,
        rotor_speed_radps: OMEGA,
        collective_rad,
        cyclic_forward_rad: 0.0,
        cyclic_outboard_rad: 0.0,
        hub_height_m: 1e9,
        other_induced_mps: 0.0,
    }
}

fn after(params: &Params, state: State, inputs: &Inputs, ticks: u32) -> (State, Outputs) {
    let blade = params.blade();
    let state = (0..ticks).fold(state, |state, _| evaluate(params, &blade, &state, inputs).0);
    (state, evaluate(params, &blade, &state, inputs).1)
}

fn settled(params: &Params, inputs: &Inputs) -> (State, Outputs) {
    after(params, State::default(), inputs, 4_000)
}

#[test]
fn a_steady_rotor_is_steady() {
    let params = ideal();
    let mut inputs = hovering(8.0 * DEG);
    inputs.motion.airspeed_mps = Vec3::new(30.0, 3.0, 2.0);
    let (state, _) = settled(&params, &inputs);
    let (next, _) = evaluate(&params, &params.blade(), &state, &inputs);
    assert!((next.inflow.mean_mps - state.inflow.mean_mps).abs() < 1e-12);
    assert!((next.flapping.aft_rad - state.flapping.aft_rad).abs() < 1e-14);
    assert!((next.flapping.coning_rad - state.flapping.coning_rad).abs() < 1e-14);
}

#[test]
fn a_hovering_rotor_moves_the_air_of_momentum_theory() {
    let params = ideal();
    let (state, out) = settled(&params, &hovering(8.0 * DEG));
    let ideal_mps = sqrt(out.thrust_n / (2.0 * DENSITY * params.disc_area_m2()));
    assert!((state.inflow.mean_mps / ideal_mps - 1.0).abs() < 1e-9);
}

/// What a rotor at constant pitch and speed gives up of its thrust when it begins to rise, N s/m.
fn heave_damping(params: &Params, collective_rad: f64, rise_mps: f64) -> f64 {
    let still = settled(params, &hovering(collective_rad)).1.thrust_n;
    let mut inputs = hovering(collective_rad);
    inputs.motion.airspeed_mps.z = -rise_mps;
    (still - settled(params, &inputs).1.thrust_n) / rise_mps
}

/// T_w = ½K/(1 + K/(4ρA·v0)), K = ¼ρabcΩR²·(B² − x0²): blade elements against the momentum of the disc.
#[test]
fn heave_in_hover_is_damped_as_momentum_theory_says_both_ways() {
    let params = ideal();
    let (state, _) = settled(&params, &hovering(8.0 * DEG));
    let root = square(params.blade.root_norm);
    let inflow = state.inflow.mean_mps / (OMEGA * params.radius_m);
    let tip = square(1.0 - 2.0 * core::f64::consts::LN_2 / 3.0 * inflow);
    let bladed =
        3.0 * 0.3556 * 5.7 * DENSITY * OMEGA * square(params.radius_m) * (tip - root) / 4.0;
    let disc = 4.0 * DENSITY * params.disc_area_m2() * state.inflow.mean_mps;
    let expected = 0.5 * bladed / (1.0 + bladed / disc);
    for rise_mps in [0.5, -0.5] {
        let found = heave_damping(&params, 8.0 * DEG, rise_mps);
        assert!((found / expected - 1.0).abs() < 0.1, "{rise_mps} m/s: {found} {expected}");
    }
}

#[test]
fn the_vortex_ring_takes_most_of_the_damping_and_gives_it_back() {
    let params = ideal();
    let (state, _) = settled(&params, &hovering(8.0 * DEG));
    let slope = |part: f64| {
        let sink_mps = part * state.inflow.mean_mps;
        let thrust = |sink_mps: f64| {
            let mut inputs = hovering(8.0 * DEG);
            inputs.motion.airspeed_mps.z = sink_mps;
            settled(&params, &inputs).1.thrust_n
        };
        (thrust(sink_mps + 0.5) - thrust(sink_mps - 0.5)) / heave_damping(&params, 8.0 * DEG, 0.5)
    };
    let (slow, ring, fast) = (slope(0.1), slope(0.8), slope(2.5));
    assert!(slow > 0.7 && ring < 0.35 && fast > 0.7, "{slow} {ring} {fast}");
}

/// Without drag all power is induced: never less than the ideal, and little more where the twist
/// suits the thrust.
#[test]
fn no_rotor_beats_momentum_theory() {
    let params = ideal();
    let over = [4.0, 8.0, 12.0].map(|collective_deg| {
        let (state, out) = settled(&params, &hovering(collective_deg * DEG));
        out.power_w / (out.thrust_n * state.inflow.mean_mps)
    });
    assert!(over.iter().all(|over| *over > 1.0), "{over:?}");
    assert!(over.is_sorted_by(|less, more| less > more) && over[2] < 1.1, "{over:?}");
}

/// In forward flight Glauert's: v = T/(2ρA·√(μ² + λ²)).
#[test]
fn edgewise_the_inflow_is_glauerts() {
    let params = ideal();
    let mut inputs = hovering(6.0 * DEG);
    inputs.motion.airspeed_mps.x = 40.0;
    let (state, out) = settled(&params, &inputs);
    let v = state.inflow.mean_mps;
    let glauert =
        out.thrust_n / (2.0 * DENSITY * params.disc_area_m2() * sqrt(square(40.0) + square(v)));
    // The skewed wake couples the mean with the harmonics, which a free disc holds near zero load.
    assert!((v / glauert - 1.0).abs() < 0.02, "{v} {glauert}");
    assert!(state.inflow.aft_mps > 0.8 * v, "downwash grows downwind");
}

/// Where the flow comes steeply, near the root, a degree of tilt is less than one of incidence.
const LARGE_ANGLES: f64 = 0.05;

/// Pitch is least where the blade passes the right; the blade is lowest a quarter turn later.
#[test]
fn cyclic_tilts_the_disc_a_quarter_turn_late() {
    let mut inputs = hovering(8.0 * DEG);
    inputs.cyclic_forward_rad = 0.05;
    let (_, out) = settled(&ideal(), &inputs);
    assert!((out.tilt_aft_rad / -0.05 - 1.0).abs() < LARGE_ANGLES, "{}", out.tilt_aft_rad);
    assert!(out.tilt_outboard_rad.abs() < 1e-3, "{}", out.tilt_outboard_rad);
    assert!((out.load.force_n.x / out.thrust_n - 0.05).abs() < 0.01);
    inputs.cyclic_forward_rad = 0.0;
    inputs.cyclic_outboard_rad = 0.05;
    let (_, out) = settled(&ideal(), &inputs);
    assert!((out.tilt_outboard_rad / 0.05 - 1.0).abs() < LARGE_ANGLES);
    assert!(out.tilt_aft_rad.abs() < 1e-3);
    assert!(out.load.force_n.y > 0.0);
}

/// Nothing turns a free gyroscope: the mast rolls under the disc.
#[test]
fn in_a_vacuum_the_disc_stays_where_it_was() {
    let mut inputs = hovering(0.0);
    inputs.motion.density_kg_per_m3 = 1e-9;
    inputs.motion.angular_rate_radps = Vec3::new(0.1, 0.05, 0.0);
    let (_, out) = after(&ideal(), State::default(), &inputs, 250);
    assert!((out.tilt_outboard_rad + 0.1).abs() < 1e-6, "{}", out.tilt_outboard_rad);
    assert!((out.tilt_aft_rad + 0.05).abs() < 1e-6, "{}", out.tilt_aft_rad);
}

/// 16/(γ*Ω) behind a pitching mast: the air that the load on the disc moves makes the Lock number
/// smaller by 1 + aσ/(16·λ0) in hover (Curtiss).
#[test]
fn the_disc_lags_a_turning_mast() {
    let params = ideal();
    let mut inputs = hovering(8.0 * DEG);
    inputs.motion.angular_rate_radps.y = 0.2;
    let (state, out) = settled(&params, &inputs);
    let lock = DENSITY * 5.7 * 0.3556 * square(square(3.81)) / 139.0;
    let lambda = state.inflow.mean_mps / (OMEGA * params.radius_m);
    let lessened = lock / (1.0 + 5.7 * 0.0891 / (16.0 * lambda));
    let expected = -16.0 / (lessened * OMEGA) * 0.2;
    assert!((out.tilt_aft_rad / expected - 1.0).abs() < 0.1, "{} {expected}", out.tilt_aft_rad);
    assert!(out.tilt_outboard_rad < 0.0);
}

/// Amer's effect: the force leans by 1 − 3/2·k/(1 + k) of the disc's lag, k = aσ/(16·λ0). The blade
/// that is pitched up to turn the disc has more of its lift in the plane of the disc, the more the
/// steeper the inflow comes: a loaded proprotor damps little over half of what T·h·16/(γ*Ω) says.
#[test]
fn the_force_of_a_turning_rotor_leans_less_than_its_disc() {
    let params = ideal();
    let mut inputs = hovering(8.0 * DEG);
    inputs.motion.angular_rate_radps.y = 0.2;
    let (state, out) = settled(&params, &inputs);
    let k = 5.7 * 0.0891 / (16.0 * state.inflow.mean_mps / (OMEGA * params.radius_m));
    let leans = out.load.force_n.x / (out.thrust_n * -out.tilt_aft_rad);
    let expected = 1.0 - 1.5 * k / (1.0 + k);
    assert!((leans / expected - 1.0).abs() < 0.1, "{leans} {expected}");
}

#[test]
fn a_gimbal_on_its_stop_gives_way_only_by_bending() {
    let mut inputs = hovering(8.0 * DEG);
    inputs.cyclic_forward_rad = 0.3;
    let (_, out) = settled(&ideal(), &inputs);
    assert_eq!(out.on_stop, 1);
    let tilt_rad = sqrt(square(out.tilt_aft_rad) + square(out.tilt_outboard_rad));
    assert!((0.2..0.25).contains(&tilt_rad) && out.tilt_aft_rad < -0.15, "{tilt_rad}");
}

#[test]
fn the_right_rotor_drags_the_nose_to_the_right() {
    let (_, out) = settled(&ideal(), &hovering(8.0 * DEG));
    assert!((out.load.moment_n_m.z / out.torque_n_m - 1.0).abs() < 1e-9);
}

#[test]
fn as_an_aeroplane_the_thrust_points_forward() {
    let mut inputs = hovering(40.0 * DEG);
    inputs.mast_tilt_rad = FRAC_PI_2;
    inputs.motion.airspeed_mps.x = 100.0;
    let (_, out) = settled(&ideal(), &inputs);
    assert!(out.thrust_n > 0.0 && (out.load.force_n.x / out.thrust_n - 1.0).abs() < 1e-6);
}

#[test]
fn air_from_below_drives_the_rotor() {
    let mut inputs = hovering(2.0 * DEG);
    inputs.motion.airspeed_mps = Vec3::new(40.0, 0.0, 15.0);
    let (_, out) = settled(&ideal(), &inputs);
    assert!(out.thrust_n > 0.0 && out.torque_n_m < 0.0, "{} N m", out.torque_n_m);
}

/// From hover into the windmill state the thrust has no jump, whichever way one goes.
#[test]
fn a_vertical_descent_has_no_jump() {
    let params = ideal();
    let blade = params.blade();
    let mut inputs = hovering(8.0 * DEG);
    let (mut state, _) = settled(&params, &inputs);
    let sweep = |state: &mut State, inputs: &mut Inputs, sinks: &[f64]| {
        let mut worst = 0.0;
        let mut before = evaluate(&params, &blade, state, inputs).1.thrust_n;
        for sink_mps in sinks {
            inputs.motion.airspeed_mps.z = *sink_mps;
            *state = after(&params, *state, inputs, 500).0;
            let now = evaluate(&params, &blade, state, inputs).1.thrust_n;
            worst = max(worst, (now - before).abs() / now.abs());
            before = now;
        }
        (worst, before)
    };
    let down: vec::Vec<f64> = (0..=120).map(|i| 0.5 * f64::from(i)).collect();
    let half: vec::Vec<f64> = down.iter().copied().take(61).collect();
    let up: vec::Vec<f64> = down[60..].iter().rev().copied().collect();
    let (_, thrust_down) = sweep(&mut state, &mut inputs, &half);
    let (worst, _) = sweep(&mut state, &mut inputs, &down[60..]);
    let (_, thrust_up) = sweep(&mut state, &mut inputs, &up);
    assert!(worst < 0.1, "{worst}");
    assert!((thrust_up / thrust_down - 1.0).abs() < 1e-3, "{thrust_up} {thrust_down}");
}

#[test]
fn the_ground_saves_power() {
    let params = ideal();
    let far = settled(&params, &hovering(8.0 * DEG)).1;
    let mut inputs = hovering(8.0 * DEG);
    inputs.hub_height_m = 0.6 * params.radius_m;
    let near = settled(&params, &inputs).1;
    assert!(near.thrust_n > far.thrust_n);
    assert!(near.power_w / near.thrust_n < far.power_w / far.thrust_n);
}

/// Every quotient by a speed is one by none here.
#[test]
fn a_rotor_at_rest_in_still_air_is_without_load_and_stays_at_rest() {
    let params = ideal();
    for collective_rad in [0.0, 20.0 * DEG] {
        let still = Inputs { rotor_speed_radps: 0.0, ..hovering(collective_rad) };
        let (state, out) = after(&params, State::default(), &still, 10);
        for number in [
            out.thrust_n,
            out.torque_n_m,
            out.power_w,
            state.inflow.mean_mps,
            state.inflow.aft_mps,
            state.inflow.right_mps,
            state.flapping.aft_rad,
            state.flapping.right_rad,
        ] {
            // Not a number is not below it either.
            assert!(number.abs() < 1e-9, "{number}: {out:?} {state:?}");
        }
    }
}

/// A number from −1 to 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Anything that can happen to a rotor, for half a second each.
#[test]
fn no_flight_makes_it_infinite() {
    let params = ideal();
    let blade = params.blade();
    let mut seed = 1;
    let mut state = State::default();
    for case in 0..3_000 {
        let mut r = |size: f64| size * random(&mut seed);
        let still = case % 7 == 0;
        let inputs = Inputs {
            motion: Motion {
                cg_m: Vec3::new(7.62, 0.0, 2.54),
                airspeed_mps: if still {
                    Vec3::zero()
                } else {
                    Vec3::new(60.0 + r(100.0), r(100.0), r(100.0))
                },
                angular_rate_radps: Vec3::new(r(3.0), r(3.0), r(3.0)),
                density_kg_per_m3: 0.9 + r(0.6),
            },
            sound_speed_mps: 330.0,
            mast_tilt_rad: 0.8 + r(0.9),
            mast_tilt_rate_radps: r(0.2),
            rotor_speed_radps: if case % 5 == 0 { 0.0 } else { 36.65 + r(36.65) },
            collective_rad: (30.0 + r(40.0)) * DEG,
            cyclic_forward_rad: r(0.18),
            cyclic_outboard_rad: r(0.1),
            hub_height_m: 20.0 + r(20.0),
            other_induced_mps: r(20.0),
        };
        for _ in 0..125 {
            let (next, out) = evaluate(&params, &blade, &state, &inputs);
            let load = out.load.force_n.norm() + out.load.moment_n_m.norm() + out.power_w;
            assert!(load.is_finite() && load.abs() < 1e9, "case {case}: {inputs:?}");
            let flap = next.flapping;
            assert!(flap.aft_rad.abs() + flap.right_rad.abs() + flap.coning_rad.abs() < 3.0);
            assert!(next.inflow.mean_mps.abs() + next.inflow.aft_mps.abs() < 500.0, "{next:?}");
            state = next;
        }
    }
}

/// Air that nothing drives any more comes to rest by its apparent mass, 128/75π of the disc's density times radius
/// for the mean and 64/45π for what is uneven: in hover at v0 by 2·v0 and v0 a second of it.
#[test]
fn air_in_motion_comes_to_rest_as_fast_as_its_apparent_mass_lets_it() {
    use core::f64::consts::PI;
    let (radius_m, mean_mps) = (3.81, 12.0);
    let flow = elements::Flow {
        forward_mps: 0.0,
        right_mps: 0.0,
        along_mps: 0.0,
        omega_radps: OMEGA,
        density_kg_per_m3: DENSITY,
        sound_speed_mps: 340.0,
    };
    let nothing = inflow::DiscLoads { thrust_n: 0.0, aft_n_m: 0.0, right_n_m: 0.0 };
    let state = inflow::State { mean_mps, aft_mps: 0.5, right_mps: -0.25 };
    let through = inflow::disc_flow(&state, &flow);
    let next = inflow::advance(&state, &through, &flow, &nothing, radius_m);
    let left = |rate_per_s: f64| 1.0 / (1.0 + rate_per_s * crate::STEP_S);
    let mean = left(2.0 * mean_mps * 75.0 * PI / (128.0 * radius_m));
    let uneven = left(mean_mps * 45.0 * PI / (64.0 * radius_m));
    for (found, before, part) in [
        (next.mean_mps, mean_mps, mean),
        (next.aft_mps, 0.5, uneven),
        (next.right_mps, -0.25, uneven),
    ] {
        assert!((found / before - part).abs() < 1e-6, "{found} after {before}: {part} of it");
    }
}
