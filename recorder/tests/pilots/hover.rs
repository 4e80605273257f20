//! A hover in steady air is quiet: controllers that have nothing to do rest.

use engine::Outputs;
use engine::math::max;
use engine::units::DEGREE_RAD as DEG;
use recorder::pilots::Pilot;
use recorder::{Controller, rehearse};

const TICKS_PER_S: u64 = 250;
/// From the ground to a hover that has settled, and how long it is watched, s.
const SETTLING_S: u64 = 120;
const WATCHED_S: u64 = 20;
/// A thousandth of the stick's half travel, .005 in: no hand is so still.
const STICK_NORM: f64 = 1e-3;
/// A hundredth of a degree a second, and a centimetre a second.
const RATE_RADPS: f64 = 0.01 * DEG;
const DRIFT_MPS: f64 = 0.01;

fn sticks(seen: &Outputs) -> [f64; 3] {
    let cockpit = &seen.cockpit;
    [cockpit.stick_right_norm, cockpit.stick_aft_norm, cockpit.pedal_right_norm]
}

/// It swung by ±1 % of the stick, every hand's movement the other way, when the hand asked for three times the
/// bank that was missing.
#[test]
fn a_hover_in_steady_air_is_quiet() {
    let map =
        aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap_or_else(|e| panic!("{e}"));
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15)
        .unwrap_or_else(|e| panic!("{e}"))
        .with_cockpit(map);
    for (wind_kt, from_deg) in [(0.0, 0.0), (10.0, 90.0), (10.0, 45.0), (10.0, 230.0)] {
        let scenario = aircraft::DEFAULT_SCENARIO
            .replace("wind_kt = 0.0", &format!("wind_kt = {wind_kt:?}"))
            .replace("wind_from_deg = 0.0", &format!("wind_from_deg = {from_deg:?}"));
        let start = aircraft::start("scenario.toml", &scenario).unwrap_or_else(|e| panic!("{e}"));
        let pilot = Pilot::named("hover", &xv15.cockpit, &xv15).expect("hover");
        let controllers: Vec<Box<dyn Controller>> = vec![Box::new(pilot)];
        let mut rest: Option<[f64; 3]> = None;
        let (mut moved, mut turning, mut drifting) = (0.0, 0.0, 0.0);
        let ticks = (SETTLING_S + WATCHED_S) * TICKS_PER_S;
        let flown = rehearse(&xv15, &start, controllers, ticks, |now| {
            let seen = now.outputs;
            if now.state.tick < SETTLING_S * TICKS_PER_S {
                return;
            }
            let at = sticks(seen);
            let rest = rest.get_or_insert(at);
            for (at, rest) in at.iter().zip(rest.iter()) {
                moved = max(moved, (at - rest).abs());
            }
            turning = max(turning, seen.angular_rate_radps.norm());
            drifting = max(drifting, seen.velocity_mps.norm());
        });
        flown.unwrap_or_else(|failure| panic!("{failure}"));
        println!(
            "{wind_kt} kt from {from_deg}: stick {moved:.5}, {turning:.6} rad/s, {drifting:.5} m/s"
        );
        assert!(rest.is_some(), "it has flown that long");
        assert!(moved < STICK_NORM, "{wind_kt} kt from {from_deg}: {moved}");
        assert!(turning < RATE_RADPS, "{wind_kt} kt from {from_deg}: {turning} rad/s");
        assert!(drifting < DRIFT_MPS, "{wind_kt} kt from {from_deg}: {drifting} m/s");
    }
}
