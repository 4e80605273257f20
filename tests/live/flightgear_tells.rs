//! What FlightGear tells: ground under the wheels, its controls, and whatever else comes in at that port.

use std::path::Path;

use engine::inputs::EventKind;
use logs::OpenOptions;

use crate::common::flightgear::{DrawingFlightGear, report};
use crate::common::{self, OK, command, folder, said, text, verify};

/// FlightGear's ground: other than the scenario's 13.386 m.
const GROUND_M: f64 = 15.75;

/// The ground of every tick above the origin's, under the left wheel, and the origin's height.
fn grounds(log: &Path) -> (f64, Vec<f64>) {
    let mut reader = logs::open(log, OpenOptions::default()).expect("a log");
    let origin_m = reader.initial.plant.origin.height_m;
    let mut heights = Vec::new();
    while let Some(tick) = reader.next_tick().expect("a tick") {
        heights.push(tick.inputs.world.ground_height_m.main.left);
    }
    (origin_m, heights)
}

fn fly(flightgear: &DrawingFlightGear, log: &Path, arguments: &[&str]) -> common::Said {
    let mut program = command(&["fly", "--out", text(log), "--hold", "0"]);
    program.args(["--flightgear", &flightgear.place]).args(arguments);
    said(&mut program)
}

#[test]
fn a_flight_begins_on_flightgear_s_ground_and_follows_it_and_replays_exactly() {
    let log = folder("flightgear-ground").join("flight.mcap");
    let mut number = 0;
    // The ground rises by half a metre once the flight is under way.
    let flightgear = DrawingFlightGear::start(move |channel, fdm| {
        number += 1;
        let risen = channel.get("tiltrotor/tick") > Some(125.0);
        let ground_m = GROUND_M + if risen { 0.5 } else { 0.0 };
        vec![report(channel, fdm, number, ground_m).bytes()]
    });
    fly(&flightgear, &log, &["--pilot", "hover", "--duration", "2"])
        .ends(OK)
        .says("ground: FlightGear's, 15.75 m above sea level where the flight begins");
    drop(flightgear);
    let (origin_m, heights) = grounds(&log);
    assert!((origin_m - GROUND_M).abs() < 1e-9, "{origin_m}");
    assert!(heights[..125].iter().all(|height_m| height_m.abs() < 1e-9), "level with the origin");
    // At 0.2 m/s under wheels: a metre and a half of time.
    let last_m = heights.last().expect("ticks");
    assert!((0.15..0.35).contains(last_m), "{last_m}");
    let steps = heights.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(steps.into_iter().all(|step_m| (0.0..=0.0011).contains(&step_m)), "slowly");
    verify(&log).ends(OK);
}

#[test]
fn flat_ground_is_flat_whatever_flightgear_tells() {
    let log = folder("flightgear-flat").join("flight.mcap");
    let mut number = 0;
    let flightgear = DrawingFlightGear::start(move |channel, fdm| {
        number += 1;
        vec![report(channel, fdm, number, GROUND_M).bytes()]
    });
    fly(&flightgear, &log, &["--pilot", "hover", "--duration", "0.5", "--ground", "flat"]).ends(OK);
    let (origin_m, heights) = grounds(&log);
    assert!((origin_m - 13.386).abs() < 1e-9, "{origin_m}");
    assert!(heights.iter().all(|height_m| height_m.abs() < 1e-12));
}

#[test]
fn a_flood_of_garbage_changes_nothing_of_a_flight() {
    let folder = folder("flightgear-garbage");
    let (flooded, quiet) = (folder.join("flooded.mcap"), folder.join("quiet.mcap"));
    let mut seed = 1_u64;
    let flightgear = DrawingFlightGear::start(move |channel, fdm| {
        let mut packets = Vec::new();
        for length in 0..400 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            packets.push((0..length).map(|at| (seed >> (at % 57)) as u8).collect());
        }
        // Reports that are almost right: not finite, far away, cut, of no scenery.
        let good = report(channel, fdm, 1, GROUND_M);
        packets.push(good.bytes()[1..].to_vec());
        let mut broken = good.bytes();
        broken[4..12].copy_from_slice(&f64::NAN.to_be_bytes());
        packets.push(broken);
        let mut elsewhere = good;
        elsewhere.ground = elsewhere.ground.map(|mut sample| {
            sample.latitude_deg += 1.0;
            sample
        });
        packets.push(elsewhere.bytes());
        packets
    });
    let arguments = ["--pilot", "hover", "--duration", "2", "--no-panel"];
    // It hears packets, and none that is of here: it waits for scenery as long as it is told to.
    fly(&flightgear, &flooded, &[&arguments[..], &["--ground", "flat"]].concat()).ends(OK);
    drop(flightgear);
    let mut program = command(&["fly", "--no-flightgear", "--out", text(&quiet)]);
    said(program.args(arguments)).ends(OK);
    verify(&flooded).ends(OK);
    // The same states, to the bit: the digest is of all of them.
    let digest =
        |log: &Path| verify(log).out.split("digest ").nth(1).map(|rest| rest[..16].to_owned());
    assert_eq!(digest(&flooded), digest(&quiet));
}

#[test]
fn flightgear_s_own_controls_are_recorded_as_a_device_of_the_map() {
    let log = folder("flightgear-controls").join("flight.mcap");
    let mut number = 0;
    let flightgear = DrawingFlightGear::start(move |channel, fdm| {
        number += 1;
        let mut told = report(channel, fdm, number, 13.386);
        let late = channel.get("tiltrotor/tick") > Some(250.0);
        told.controls.throttle = if late { 0.5 } else { 0.0 };
        told.controls.elevator = if late { -0.5 } else { 0.0 };
        told.controls.presses[6] = i64::from(late);
        vec![told.bytes()]
    });
    fly(&flightgear, &log, &["--flightgear-controls", "--duration", "2", "--ground", "flat"])
        .ends(OK);
    drop(flightgear);
    let mut reader = logs::open(&log, OpenOptions::default()).expect("a log");
    assert!(reader.setup.cockpit_toml.contains("FlightGear"), "the map as flown");
    let (mut events, mut last) = (Vec::new(), None);
    while let Some(tick) = reader.next_tick().expect("a tick") {
        events.extend(tick.events.iter().map(|event| (event.kind, event.code, event.value)));
        last = Some(tick.record.state.cockpit);
    }
    let cockpit = last.expect("ticks");
    assert!((cockpit.collective_norm - 0.5).abs() < 1e-3, "{}", cockpit.collective_norm);
    assert!((cockpit.stick_aft_norm - 0.5).abs() < 1e-3, "{}", cockpit.stick_aft_norm);
    assert_eq!(cockpit.markers, 1);
    assert!(events.contains(&(EventKind::Axis as u64, 1, -16_384)), "raw: {events:?}");
    verify(&log).ends(OK);
}
