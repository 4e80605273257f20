//! Two logs beside each other, as they were recorded.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use engine::inputs::DeviceEvent;
use logs::records::{HARDWARE, INPUTS, InputsRecord, STATE, StateRecord};
use serde_json::Value;

use crate::common::{
    DIVERGED, Forgery, OK, Said, UNUSABLE, flip_state_bit, folder, hover, place_of, text, tiltrotor,
};

/// Five seconds by the pilot model.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("diff-flight").join("flight.mcap");
        hover(&log, "5");
        log
    })
}

fn forged(name: &str, change: impl FnOnce(&mut Forgery)) -> PathBuf {
    let mut forgery = Forgery::of(flight());
    change(&mut forgery);
    let log = folder(&format!("diff-{name}")).join("forged.mcap");
    forgery.write(&log);
    log
}

fn diff(a: &Path, b: &Path) -> Said {
    tiltrotor(&["diff", text(a), text(b)])
}

fn json(a: &Path, b: &Path) -> Value {
    let said = tiltrotor(&["diff", "--format", "json", text(a), text(b)]);
    serde_json::from_str(&said.out).unwrap_or_else(|why| panic!("{why}: {said}"))
}

#[test]
fn a_flight_flown_twice_is_the_same_flight() {
    let again = folder("diff-again").join("again.mcap");
    hover(&again, "5");
    // When it was flown is told, and is no difference.
    diff(flight(), &again).ends(OK).says("the same flight").says("started_unix_ns");
    let report = json(flight(), &again);
    assert_eq!((&report["same"], &report["status"]), (&true.into(), &0.into()));
    assert_eq!(report["compared"]["ticks"], 1251);
}

#[test]
fn one_bit_is_named_on_both_sides() {
    let log = forged("bit", |log| flip_state_bit(log, 700, "plant.angular_rate_radps.y"));
    diff(flight(), &log)
        .ends(DIVERGED)
        .says("states: 1 field differs, first at tick 700 (2.800 s)")
        .says("  field     plant.angular_rate_radps.y")
        .says("  apart     1 ULP")
        .says("rad/s")
        .says("inputs: the same")
        .says("the same again from tick 701")
        .says("a pilot would notice nothing");
    let (there, back) = (json(flight(), &log), json(&log, flight()));
    assert_eq!(there["first"]["a"], back["first"]["b"]);
    assert_ne!(there["first"]["a"], there["first"]["b"]);
    let field = &there["state"][0];
    assert_eq!((&field["ticks"], &field["ulps"]), (&1.into(), &1.into()), "{there:#}");
    assert_eq!(field["largest_tick"], 700);
}

#[test]
fn what_a_pilot_would_notice_is_said_in_a_sentence() {
    let log = forged("noticed", |log| {
        let height = place_of::<StateRecord>("state.plant.position_m.z");
        let place = &mut log.bytes(STATE, 700)[height..height + 8];
        let down_m = f64::from_le_bytes(place.try_into().expect("a number"));
        place.copy_from_slice(&(down_m - 4.0).to_le_bytes());
    });
    diff(flight(), &log)
        .ends(DIVERGED)
        .says("a pilot would notice: height up to 4.0 m apart, at tick 700 (2.800 s)");
}

#[test]
fn the_keys_of_other_files_are_named() {
    let log = forged("files", |log| {
        log.rewrite(
            "aircraft.toml",
            "mast_length_ft = { value = 4.667",
            "mast_length_ft = { value = 4.668",
        );
        let map = log.attachments.iter_mut().find(|file| file.name == "cockpit.toml");
        map.expect("a map").data.to_mut().extend_from_slice(b"# a word\n");
    });
    diff(flight(), &log)
        .ends(DIVERGED)
        .says("aircraft.toml: 1 value differs")
        .says("mast_length_ft.value: 4.667 in A, 4.668 in B")
        .says("cockpit.toml: not the same text, but the same values")
        .says("states: the same to the bit");
}

#[test]
fn other_inputs_are_told_apart_from_other_states() {
    let log = forged("inputs", |log| {
        let wind = place_of::<InputsRecord>("world.wind_mps.y");
        log.bytes(INPUTS, 600)[wind..wind + 8].copy_from_slice(&5.0_f64.to_le_bytes());
        let value = place_of::<DeviceEvent>("value");
        log.bytes(HARDWARE, 20)[value] ^= 0x40;
    });
    diff(flight(), &log)
        .ends(DIVERGED)
        .says("world: 1 field differs")
        .says("world.wind_mps.y: 5.000e0 m/s at tick 601")
        .says("device events: not the same in 1 ticks")
        .says("states: the same to the bit");
}

#[test]
fn a_shorter_flight_is_compared_as_far_as_both_go() {
    let short = folder("diff-short").join("short.mcap");
    hover(&short, "2");
    diff(flight(), &short)
        .ends(DIVERGED)
        .says("compared: 501 ticks, from tick 0 (0.000 s) to tick 500 (2.000 s)")
        .says("states: the same to the bit")
        .says("they differ");
}

#[test]
fn a_flight_that_begins_later_is_compared_from_there() {
    let log = forged("later", |log| {
        // The flight without its first hundred ticks: their messages, and the state at the start.
        let from = log.places(STATE)[100];
        let channels = [STATE, INPUTS, HARDWARE];
        let mut at = 0;
        log.messages.retain(|message| {
            at += 1;
            at > from || !channels.contains(&message.channel.topic.as_str())
        });
    });
    diff(flight(), &log)
        .ends(DIVERGED)
        .says("B  ")
        .says("from tick 100 (0.400 s)")
        .says("compared: 1151 ticks, from tick 100")
        .says("inputs: the same")
        .says("states: the same to the bit");
}

/// From the west, a second into the flight.
const WIND: &str = "[[event]]\nat_s = 1.0\nwind = { from_deg = 270.0, kt = 15.0 }\n\n";

#[test]
fn flights_of_other_weather_part_and_grow_apart() {
    let place = folder("diff-wind");
    let fly = |name: &str, wind: &str| {
        let script = place.join(format!("{name}.toml"));
        let end = "[[event]]\nat_s = 12.0\nend = true\n";
        fs::write(&script, format!("{wind}{end}")).expect("a file");
        let log = place.join(format!("{name}.mcap"));
        let [script, out] = [text(&script), text(&log)];
        tiltrotor(&["fly", "--script", script, "--fast", "--no-flightgear", "--out", out]).ends(OK);
        log
    };
    let (calm, windy) = (fly("calm", ""), fly("windy", WIND));
    let report = json(&calm, &windy);
    assert_eq!(report["status"], 1);
    let world = report["world"].as_array().expect("fields");
    let wind = world[0]["first_tick"].as_u64().expect("a tick");
    assert!(report["first"]["tick"].as_u64().expect("a tick") >= wind, "{report:#}");
    let growth = report["growth"]["checkpoints"].as_array().expect("checkpoints");
    assert_eq!(growth.len(), 5, "{report:#}");
}

#[test]
fn what_cannot_be_used_is_refused_or_told() {
    let missing = folder("diff-missing").join("missing.mcap");
    diff(flight(), &missing).refused().says(text(&missing));
    diff(&missing, flight()).refused();
    let mut bytes = fs::read(flight()).expect("a log");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    let damaged = folder("diff-damaged").join("damaged.mcap");
    fs::write(&damaged, bytes).expect("a file");
    diff(flight(), &damaged).ends(UNUSABLE).says("damaged").says("the same to the bit");
}
