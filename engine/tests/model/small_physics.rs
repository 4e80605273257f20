//! Small parts of the model by hand, from the numbers that the sources print.
#![allow(
    clippy::disallowed_methods,
    reason = "other formulas, by other functions than the engine's"
)]

use engine::frames::Vec3;
use engine::pair::Pair;
use engine::step::derivatives;
use engine::table::axis::{Beta, RudderAngle};
use engine::{Outputs, State};

use crate::flying::{DEG, aloft, calm, parked, xv15};

const LBF: f64 = 4.448_221_615_260_5;
const FOOT_M: f64 = 0.3048;
const INCH_M: f64 = 0.0254;
/// Rated power of an engine, W.
const RATED_W: f64 = 1375.0 * 745.699_871_582_270_2;

fn seen(change: impl Fn(&mut State)) -> Outputs {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), 0.0, 0.0);
    change(&mut state);
    derivatives(&xv15, &state, &calm().world).1
}

#[track_caller]
fn near(a: f64, b: f64, what: &str) {
    assert!((a - b).abs() <= 1e-6 * b.abs().max(1.0), "{what}: {a}, by hand {b}");
}

/// 109 lbf a jet at rated power, along the mast, which leans 1 degree outboard as a helicopter: it lifts as a
/// helicopter, pushes as an aeroplane, and turns the aircraft about its centre of gravity by its arm.
#[test]
fn a_jet_pushes_along_its_mast_with_its_share_of_the_power() {
    for (mast_tilt_deg, left, right) in [(0.0, 1.0, 0.5), (90.0, 0.25, 1.0), (30.0, 2.0, 0.0)] {
        let outputs = seen(|state| {
            state.actuators.mast_tilt_rad = Pair::both(mast_tilt_deg * DEG);
            state.plant.engines =
                Pair { left, right }.map(|norm| engine::engines::State { power_w: norm * RATED_W });
        });
        let (tilt_rad, cg) = (mast_tilt_deg * DEG, outputs.balance.cg_m);
        for (load, norm, right_m) in [
            (outputs.loads.jets.left, left, -193.0 * INCH_M),
            (outputs.loads.jets.right, right, 193.0 * INCH_M),
        ] {
            let thrust_n = 109.0 * LBF * f64::min(norm, 1.0);
            let cant_rad: f64 = 1.0 * DEG * tilt_rad.cos();
            let upright_n = thrust_n * cant_rad.cos();
            let force = [
                upright_n * tilt_rad.sin(),
                thrust_n * cant_rad.sin() * f64::signum(right_m),
                -upright_n * tilt_rad.cos(),
            ];
            // The pivot is at station 300, waterline 100.
            let arm = [cg.x - 300.0 * INCH_M, right_m, cg.z - 100.0 * INCH_M];
            near(load.force_n.x, force[0], "forward, N");
            near(load.force_n.y, force[1], "to the right, N");
            near(load.force_n.z, force[2], "down, N");
            near(load.moment_n_m.x, arm[1] * force[2] - arm[2] * force[1], "rolling, N m");
            near(load.moment_n_m.y, arm[2] * force[0] - arm[0] * force[2], "pitching, N m");
            near(load.moment_n_m.z, arm[0] * force[1] - arm[1] * force[0], "yawing, N m");
        }
    }
}

/// Slower than Mach .2 a rudder of 20 degrees gives the .3984 that table 6-I prints without sideslip; the
/// force is to the left of a rudder to the right, and turns the nose to the right.
#[test]
fn a_fin_at_full_rudder_has_its_printed_side_force() {
    let speed_mps = 60.0;
    let fins = |rudder_deg: f64| {
        seen(|state| {
            state.actuators.mast_tilt_rad = Pair::both(90.0 * DEG);
            state.plant.velocity_mps = Vec3::new(speed_mps, 0.0, 0.0);
            state.actuators.rudder_right_rad = rudder_deg * DEG;
            state.plant.rotors = Pair::default();
        })
    };
    let (middle, right, left) = (fins(0.0), fins(20.0), fins(-20.0));
    assert!(right.mach < 0.2, "Mach {}", right.mach);
    let side_n = |outputs: &Outputs| outputs.loads.vertical_stabilizers.sum().force_n.y;
    let area_m2 = 25.25 * FOOT_M * FOOT_M;
    let pressure_pa = 0.5 * right.air.density_kg_per_m3 * speed_mps * speed_mps;
    let expected_n = -2.0 * pressure_pa * area_m2 * 0.3984;
    near(side_n(&middle), 0.0, "rudder in the middle, N");
    near(side_n(&right), expected_n, "full right rudder, N");
    near(side_n(&left), -expected_n, "full left rudder, N");

    // A rudder turns the fin's drag by .27 of its angle, .24 less of that for every 15 degrees beyond 15; table 6-III
    // has .0071 at 0, .014 at 4 and .024 at 8 degrees.
    let forward_n = |outputs: &Outputs| outputs.loads.vertical_stabilizers.sum().force_n.x;
    for (rudder_deg, turned_deg, drag) in [
        (10.0, 2.7, 0.0071 + 2.7 / 4.0 * 0.0069),
        (20.0, 0.27 * 20.0 * (1.0 - 0.24 / 3.0), 0.014 + 0.968 / 4.0 * 0.010),
    ] {
        let times = forward_n(&fins(rudder_deg)) / forward_n(&middle);
        near(times, drag / 0.0071, &format!("drag of a fin turned by {turned_deg} deg"));
    }

    // From the centre of gravity to station 570.
    let arm_m = 570.0 * INCH_M - right.balance.cg_m.x;
    let turning_n_m = right.loads.vertical_stabilizers.sum().moment_n_m.z;
    near(turning_n_m, -arm_m * expected_n, "yawing, N m");
}

/// A fin above the centre of gravity meets air from the side to which the aircraft rolls, and .1·p·b/2U more of it
/// from the sidewash of the wing.
#[test]
fn a_fin_is_pushed_against_the_roll_by_its_height_and_by_the_wing_s_sidewash() {
    let (xv15, forward_mps, roll_radps) = (xv15(), 60.0, 0.2);
    let fin = &xv15.vertical_stabilizers;
    let outputs = seen(|state| {
        state.actuators.mast_tilt_rad = Pair::both(90.0 * DEG);
        state.plant.velocity_mps = Vec3::new(forward_mps, 0.0, 0.0);
        state.plant.angular_rate_radps = Vec3::new(roll_radps, 0.0, 0.0);
        state.plant.rotors = Pair::default();
    });
    // Waterline upwards, and the wing's span of 32.17 ft.
    let above_m = fin.centre_m.z - outputs.balance.cg_m.z;
    let by_height_rad = (roll_radps * above_m / forward_mps).atan();
    let by_wing_rad = 0.1 * roll_radps * 32.17 * FOOT_M / (2.0 * forward_mps);
    // Printed for air from the left; the table is odd.
    let beta_rad = by_height_rad + by_wing_rad;
    let coefficient = fin.side_force.at(Beta(-beta_rad), RudderAngle(0.0));
    let pressure_pa = 0.5 * outputs.air.density_kg_per_m3 * forward_mps * forward_mps;
    let expected_n = 2.0 * pressure_pa * fin.area_m2 * coefficient;
    let side_n = outputs.loads.vertical_stabilizers.sum().force_n.y;
    assert!(above_m > 1.0 && by_wing_rad > 0.2 * by_height_rad);
    assert!((side_n / expected_n - 1.0).abs() < 0.02, "{side_n} N, by hand {expected_n} N");
}
