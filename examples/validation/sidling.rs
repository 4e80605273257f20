//! Sideward and rearward flight by a pilot model.

use engine::Aircraft;
use engine::math::{max, wrap_angle};
use recorder::pilots::Pilot;
use recorder::rehearse;

use crate::book::{Band, Case, DEG, FOOT_M, KNOT_MPS};

/// By then it has landed, or never will, ticks.
const PATIENCE_TICKS: u64 = 400 * 250;

/// What the flight was like.
#[derive(Clone, Copy, Default)]
struct Sidling {
    /// To the right, to the left, rearward, m/s.
    fastest_mps: [f64; 3],
    turned_rad: f64,
    height_off_m: f64,
    sink_mps: f64,
}

fn fly(aircraft: &Aircraft) -> Result<Sidling, String> {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).map_err(|e| e.to_string())?;
    let aircraft = aircraft.clone().with_cockpit(map);
    let start = aircraft::start("scenario.toml", aircraft::DEFAULT_SCENARIO);
    let start = start.map_err(|e| e.to_string())?;
    let pilot = Pilot::named("sideways", &aircraft.cockpit, &aircraft).ok_or("no such pilot")?;
    let mut flown = Sidling::default();
    let mut sinks_mps = 0.0;
    let (state, _) = rehearse(&aircraft, &start, vec![Box::new(pilot)], PATIENCE_TICKS, |now| {
        let seen = now.outputs;
        let along = seen.body_velocity_mps;
        if now.phase == "landing" && now.state.plant.weight_on_wheels == 0 {
            sinks_mps = seen.velocity_mps.z;
        }
        let phases = [("to the right", along.y), ("to the left", -along.y), ("rearward", -along.x)];
        let Some(i) = phases.iter().position(|(name, _)| *name == now.phase) else { return };
        flown.fastest_mps[i] = max(flown.fastest_mps[i], phases[i].1);
        let turned_rad = wrap_angle(seen.euler.heading_rad - start.heading_rad).abs();
        flown.turned_rad = max(flown.turned_rad, turned_rad);
        flown.height_off_m = max(flown.height_off_m, (seen.height_above_ground_m - 10.0).abs());
    })
    .map_err(|failure| failure.to_string())?;
    flown.sink_mps = sinks_mps;
    if state.tick < PATIENCE_TICKS { Ok(flown) } else { Err("it never landed".into()) }
}

/// The flown part of case 23.
pub fn rows(aircraft: &Aircraft, case: &mut Case) {
    let flown = fly(aircraft);
    let number = |of: &dyn Fn(&Sidling) -> f64| flown.as_ref().map(of).map_err(Clone::clone);
    for (i, (way, knots)) in
        [("to the right", 35.0), ("to the left", 35.0), ("rearward", 20.0)].into_iter().enumerate()
    {
        let fastest = number(&|flown| flown.fastest_mps[i] / KNOT_MPS);
        case.row(format!("flown {way}: fastest, kt"), knots, fastest, Band::Within(2.0), 1);
    }
    let turned = number(&|flown| flown.turned_rad * DEG);
    case.row("flown: nose off, deg (less than)", 10.0, turned, Band::AtMost(10.0), 1);
    let height = number(&|flown| flown.height_off_m / FOOT_M);
    case.row("flown: height off, ft (less than)", 10.0, height, Band::AtMost(10.0), 1);
    let sink = number(&|flown| flown.sink_mps / FOOT_M);
    case.row("landed: sink, ft/s (less than the gear's design)", 10.0, sink, Band::AtMost(10.0), 1);
}
