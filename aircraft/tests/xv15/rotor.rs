//! The XV-15's rotor against the tests of its metal blades, and against what the reference model says
//! of it.

use engine::frames::Vec3;
use engine::math::{PI, cos, sin, sqrt};
use engine::rotors::{self, Params, State};
use engine::units::DEGREE_RAD as DEG;

use crate::rotor_stand::{self, hover_at, hovering, settled, trimmed};

/// OARF: a tip speed of 768 ft/s.
const OARF_RPM: f64 = 768.0 / 12.5 * 30.0 / PI;

/// The rotor alone, as it is tested.
fn xv15() -> Params {
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|e| panic!("{e}"));
    let mut alone = xv15.rotors.clone();
    alone.inflow.recirculation = 0.0;
    alone
}

/// CR-2017-219486 Table A-2 (OARF run 15): CT, CP, figure of merit, for CT from .004 to .014.
const OARF: [(f64, f64, f64); 5] = [
    (0.004_063, 0.000_315, 0.5814),
    (0.007_391, 0.000_588, 0.7641),
    (0.010_104, 0.000_913, 0.7866),
    (0.011_063, 0.001_044, 0.7881),
    (0.013_089, 0.001_358, 0.7797),
];
/// The test facilities disagree by .04; the validation plan takes half of it.
const FIGURE_OF_MERIT_TOLERANCE: f64 = 0.02;
/// The validation plan's, of the same reason.
const POWER_TOLERANCE: f64 = 0.03;

#[test]
fn val_hover_is_that_of_the_oarf_test() {
    let rotor = xv15();
    for (c_t, c_p, merit) in OARF {
        let at = hover_at(&rotor, OARF_RPM, c_t);
        let ours = at.c_t * sqrt(at.c_t / 2.0) / at.c_p;
        println!(
            "CT {c_t}: CP {:.6}, measured {c_p:.6}; figure of merit {ours:.4}, measured {merit}; \
             collective {:.2} deg",
            at.c_p,
            at.inputs.collective_rad / DEG
        );
        assert!((at.c_p / c_p - 1.0).abs() < POWER_TOLERANCE, "CT {c_t}: CP {}", at.c_p);
        // The plan asks for the figure of merit from .06 < CT/sigma.
        if c_t / rotor.solidity > 0.06 {
            assert!((ours - merit).abs() < FIGURE_OF_MERIT_TOLERANCE, "CT {c_t}: {ours}");
        }
    }
}

/// The collective's zero is another one in every source; its slope, .00093 per degree, is not.
#[test]
fn val_thrust_grows_with_collective_as_in_the_oarf_test() {
    const SLOPE_TOLERANCE: f64 = 0.07;
    let rotor = xv15();
    let at = |c_t| hover_at(&rotor, OARF_RPM, c_t);
    let (low, high) = (at(0.004_063), at(0.011_063));
    let over_deg = (high.inputs.collective_rad - low.inputs.collective_rad) / DEG;
    let slope_per_deg = (high.c_t - low.c_t) / over_deg;
    println!("dCT/dtheta {slope_per_deg:.6} per degree, measured .000930");
    assert!((slope_per_deg / 0.000_93 - 1.0).abs() < SLOPE_TOLERANCE, "{slope_per_deg}");
}

/// Table A-2's last point, CT .0151, is CT/sigma .170; the reference model's Table 1-I has .180 as the
/// greatest in hover. A rotor between the two does what was measured and not more than is believed.
#[test]
fn val_the_greatest_thrust_in_hover_lies_between_test_and_reference_model() {
    let rotor = xv15();
    let greatest = (13..26)
        .map(|deg| settled(&rotor, hovering(OARF_RPM, f64::from(deg) * DEG)).out.blade_loading)
        .fold(0.0, |a: f64, b| if b > a { b } else { a });
    println!("greatest CT/sigma {greatest:.4}, measured at least .170, reference model .180");
    assert!((0.170..0.180).contains(&greatest), "{greatest}");
}

/// Betzina 2002, digitised: CQ/sigma at CT/sigma .075 for shaft angles of -15, 0 and 15 degrees.
const BETZINA: [(f64, [f64; 3]); 4] = [
    (0.125, [0.00570, 0.00355, 0.00130]),
    (0.15, [0.00595, 0.00330, 0.00075]),
    (0.17, [0.00620, 0.00310, 0.00035]),
    (0.20, [0.00665, 0.00295, 0.00000]),
];
/// Digitised from a re-plot, for trends: a tenth of the range that the shaft angle covers.
const FORWARD_TORQUE_TOLERANCE: f64 = 0.0005;

#[test]
fn val_torque_in_forward_flight_is_that_of_the_wind_tunnel() {
    let params = xv15();
    for (mu, measured) in BETZINA {
        for (shaft_deg, measured) in [-15.0, 0.0, 15.0].into_iter().zip(measured) {
            let mut inputs = hovering(OARF_RPM, 6.0 * DEG);
            let tip_mps = inputs.rotor_speed_radps * params.radius_m;
            let (s, c) = (sin(shaft_deg * DEG), cos(shaft_deg * DEG));
            inputs.motion.airspeed_mps = Vec3::new(mu * tip_mps * c, 0.0, mu * tip_mps * s);
            // No flapping, as in the tunnel.
            let run = trimmed(&params, inputs, |inputs, out| {
                inputs.cyclic_forward_rad += 0.005 * out.tilt_aft_rad;
                inputs.cyclic_outboard_rad -= 0.005 * out.tilt_outboard_rad;
                inputs.collective_rad += 0.02 * (0.075 - out.blade_loading);
            });
            let c_q = run.c_p / params.solidity;
            println!("mu {mu}, shaft {shaft_deg:3} deg: CQ/sigma {c_q:.5}, measured {measured:.5}");
            assert!((run.out.blade_loading - 0.075).abs() < 1e-4, "{}", run.out.blade_loading);
            assert!((c_q - measured).abs() < FORWARD_TORQUE_TOLERANCE, "mu {mu}: {c_q}");
        }
    }
}

/// Wang et al., figure 1: root collective of the reference model as an aeroplane at 458 rpm. Its
/// digitisation is good to a degree, and its collective to that of a blade twisted in a straight line.
const AEROPLANE: [(f64, f64); 3] = [(71.9, 59.1), (92.4, 65.5), (113.1, 70.9)];
const AEROPLANE_COLLECTIVE_TOLERANCE_DEG: f64 = 1.5;
/// From root to 3/4 radius of the straight line of -41 degrees.
const ROOT_COLLECTIVE_DEG: f64 = 30.75;

#[test]
fn val_blade_angle_as_an_aeroplane_is_that_of_the_reference_model() {
    let params = xv15();
    for (speed_mps, published_deg) in AEROPLANE {
        // Half of a drag area of 10 ft2, and the induced drag of 13,000 lb on 181 ft2, AR 5.7.
        let pressure_pa = 0.5 * rotor_stand::DENSITY * speed_mps * speed_mps;
        let weight_n = 13_000.0 * 4.448_222;
        let induced_n = weight_n * weight_n / (pressure_pa * PI * 0.9 * 5.7 * 16.82);
        let wanted_n = 0.5 * (pressure_pa * 0.929 + induced_n);
        let mut inputs = hovering(458.0, 35.0 * DEG);
        inputs.mast_tilt_rad = 0.5 * PI;
        inputs.motion.airspeed_mps.x = speed_mps;
        let run = trimmed(&params, inputs, |inputs, out| {
            inputs.collective_rad += 2e-7 * (wanted_n - out.thrust_n);
        });
        let root_deg = run.inputs.collective_rad / DEG + ROOT_COLLECTIVE_DEG;
        let efficiency = run.out.thrust_n * speed_mps / run.out.power_w;
        println!(
            "{speed_mps} m/s: {root_deg:.2} deg, published {published_deg}; thrust {wanted_n:.0} N, \
             {:.0} kW for both, efficiency {efficiency:.3}",
            2e-3 * run.out.power_w
        );
        assert!((run.out.thrust_n - wanted_n).abs() < 20.0);
        assert!((root_deg - published_deg).abs() < AEROPLANE_COLLECTIVE_TOLERANCE_DEG);
        assert!((0.7..0.92).contains(&efficiency));
    }
}

/// Lateral flapping at 60 kt, with and without the programmed cyclic, which is there to lessen it.
#[test]
fn val_the_programmed_lateral_cyclic_takes_the_lateral_flapping_away() {
    let params = xv15();
    let lateral_deg = |cyclic_deg: f64| {
        let mut inputs = hovering(589.0, 8.0 * DEG);
        inputs.motion.airspeed_mps.x = 60.0 * engine::units::KNOT_MPS;
        inputs.cyclic_outboard_rad = cyclic_deg * DEG;
        settled(&params, inputs).out.tilt_outboard_rad / DEG
    };
    let (without, with) = (lateral_deg(0.0), lateral_deg(-4.0));
    println!(
        "lateral flapping at 60 kt: {without:.2} deg without, {with:.2} deg with -4 deg of A1"
    );
    assert!(without > 1.0 && with.abs() < 0.3 * without);
}

/// The disc follows a step of cyclic within a time of 16/(gamma Omega), .068 s by the published Lock
/// number: quarter-chord theory with steady inflow. Dynamic inflow makes it slower at first order by
/// its own lag, so the band is wide: a factor of two either way tells right from wrong physics.
#[test]
fn val_the_disc_follows_the_stick_in_the_time_of_its_lock_number() {
    let params = xv15();
    let blade = params.blade();
    let start = hover_at(&params, 589.0, 0.0105);
    let mut inputs = start.inputs;
    inputs.cyclic_forward_rad = 1.0 * DEG;
    let end = trimmed(&params, inputs, |_, _| ()).out.tilt_aft_rad;
    let mut state: State = start.state;
    let mut ticks = 0;
    while state.flapping.aft_rad / end < 1.0 - 1.0 / core::f64::consts::E {
        state = rotors::evaluate(&params, &blade, &state, &inputs).0;
        ticks += 1;
    }
    let ours_s = f64::from(ticks) * engine::STEP_S;
    let theory_s = 16.0 / (3.83 * inputs.rotor_speed_radps);
    println!("63 % of a cyclic step after {ours_s:.3} s, 16/(gamma Omega) {theory_s:.3} s");
    assert!((0.5..2.0).contains(&(ours_s / theory_s)));
}

/// Descending without power at 80 kt and 92 % rpm there is a collective that carries the weight.
#[test]
fn it_autorotates() {
    let params = xv15();
    let mut inputs = hovering(553.0, 4.0 * DEG);
    inputs.motion.airspeed_mps = Vec3::new(41.0, 0.0, 10.0);
    let run = trimmed(&params, inputs, |inputs, out| {
        inputs.collective_rad += 2e-8 * (28_000.0 - out.thrust_n);
        inputs.motion.airspeed_mps.z += 2e-6 * out.torque_n_m;
    });
    println!(
        "autorotation: sink {:.1} m/s through the disc, collective {:.2} deg, torque {:.0} N m",
        run.inputs.motion.airspeed_mps.z,
        run.inputs.collective_rad / DEG,
        run.out.torque_n_m
    );
    assert!((run.out.thrust_n / 28_000.0 - 1.0).abs() < 0.02 && run.out.torque_n_m.abs() < 100.0);
    assert!((3.0..20.0).contains(&run.inputs.motion.airspeed_mps.z));
}

/// Whatever happens to it, at any speed up to 160 m/s any way, 0 to 700 rpm, -10 to 70 degrees.
#[test]
fn no_flight_makes_the_rotor_infinite() {
    let params = xv15();
    let blade = params.blade();
    let mut seed = 7_u64;
    let mut random = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut state = State::default();
    for case in 0..4_000 {
        let mut inputs = hovering(random(0.0, 700.0), random(-10.0, 70.0) * DEG);
        let speed_mps = if case % 7 == 0 { 0.0 } else { random(0.0, 160.0) };
        let (across, up) = (random(-PI, PI), random(-1.0, 1.0));
        let level = sqrt(1.0 - up * up);
        inputs.motion.airspeed_mps =
            Vec3::new(level * cos(across), level * sin(across), up) * speed_mps;
        inputs.motion.angular_rate_radps =
            Vec3::new(random(-3.0, 3.0), random(-3.0, 3.0), random(-3.0, 3.0));
        inputs.mast_tilt_rad = random(-0.09, 0.5 * PI);
        inputs.cyclic_forward_rad = random(-0.2, 0.2);
        inputs.cyclic_outboard_rad = random(-0.1, 0.1);
        inputs.hub_height_m = random(0.0, 30.0);
        if case % 5 == 0 {
            inputs.rotor_speed_radps = 0.0;
        }
        for _ in 0..125 {
            let (next, out) = rotors::evaluate(&params, &blade, &state, &inputs);
            let load = out.load.force_n.norm() + out.load.moment_n_m.norm() + out.power_w.abs();
            let flap = next.flapping;
            let flapping_rad = flap.aft_rad.abs() + flap.right_rad.abs() + flap.coning_rad.abs();
            assert!(load < 1e9 && flapping_rad < 3.0, "case {case}: {inputs:?} {next:?}");
            assert!(next.inflow.mean_mps.abs() < 300.0, "case {case}: {inputs:?} {next:?}");
            state = next;
        }
    }
}

/// From rest to 110 % in half a minute, the cyclic stirring the disc onto its stop at every speed; then at rest.
#[test]
#[allow(clippy::disallowed_methods, reason = "extremes, looked at and not flown")]
fn a_run_up_on_the_gimbal_stop_stays_whole_and_comes_to_rest() {
    let params = xv15();
    let blade = params.blade();
    let full_radps = hovering(589.0, 0.0).rotor_speed_radps;
    let mut state = State::default();
    let (mut on_stop, mut most_bent_rad, mut most_rad) = (0_u64, 0.0_f64, 0.0_f64);
    let ticks = 7_500;
    for tick in 0..ticks {
        let part = f64::from(tick) / f64::from(ticks);
        let mut inputs = hovering(589.0, (2.0 + 10.0 * part) * DEG);
        inputs.rotor_speed_radps = 1.1 * part * full_radps;
        inputs.motion.airspeed_mps.x = 15.0;
        // Once a second round: 15 degrees of cyclic, which no swash plate has.
        let turn = 2.0 * PI * f64::from(tick) * engine::STEP_S;
        inputs.cyclic_forward_rad = 15.0 * DEG * sin(turn);
        inputs.cyclic_outboard_rad = 15.0 * DEG * cos(turn);
        let (next, out) = rotors::evaluate(&params, &blade, &state, &inputs);
        state = next;
        on_stop += out.on_stop;
        let flap = &state.flapping;
        most_bent_rad = most_bent_rad.max(flap.elastic_aft_rad.hypot(flap.elastic_right_rad));
        most_rad = most_rad.max(flap.aft_rad.hypot(flap.right_rad));
        assert!(out.load.force_n.norm() < 2e5 && out.load.moment_n_m.norm() < 2e6, "tick {tick}");
    }
    println!(
        "{on_stop} of {ticks} ticks on the stop; blades bent {:.2} deg, tip path {:.2} deg at most",
        most_bent_rad / DEG,
        most_rad / DEG
    );
    assert!(on_stop > 100 && most_bent_rad < 3.0 * DEG && most_rad < 16.0 * DEG);
    let mut inputs = hovering(589.0, 8.0 * DEG);
    inputs.rotor_speed_radps = 1.1 * full_radps;
    for _ in 0..10_000 {
        state = rotors::evaluate(&params, &blade, &state, &inputs).0;
    }
    let next = rotors::evaluate(&params, &blade, &state, &inputs).0;
    let moved = (next.flapping.elastic_aft_rad - state.flapping.elastic_aft_rad).abs()
        + (next.flapping.aft_rad - state.flapping.aft_rad).abs()
        + (next.flapping.coning_rad - state.flapping.coning_rad).abs();
    assert!(moved < 1e-12, "{moved}");
}
