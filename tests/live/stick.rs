//! A USB stick, for real: a recorded one that the kernel seems to have, through gilrs.
//!
//! `umockdev-run` makes the program see the device of `devices/stick.umockdev` and feeds it the
//! events of `devices/stick.evemu`, four seconds that begin a little before the program does. What
//! the program has not read yet waits. The events' kernel times are the file's, not the clock's.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use engine::inputs::EventKind;
use logs::records::FlightEvent;
use logs::{FlightReader, OpenOptions, Tick};

use crate::common::{OK, folder, said, text, tiltrotor, verify};

const EVEMU: &str = include_str!("../devices/stick.evemu");

/// Of the file's lines, those that reach a program: axes and buttons.
const EVENTS: usize = 72;

/// Kind, kernel's code and value of every event that is to arrive, in the file's order.
fn expected() -> Vec<(EventKind, u64, i64)> {
    let hex = |digits: &str| u64::from_str_radix(digits, 16).expect("hexadecimal");
    let event = |line: &str| {
        let words: Vec<_> = line.strip_prefix("E: ")?.split_whitespace().collect();
        let kind = match hex(words[1]) {
            1 => EventKind::Button,
            3 => EventKind::Axis,
            // Ends of packets, scan codes.
            _ => return None,
        };
        Some((kind, hex(words[2]), words[3].parse().expect("a value")))
    };
    EVEMU.lines().filter_map(event).collect()
}

/// Eight seconds with the stick; `None` where there is no umockdev.
fn flight() -> Option<&'static Path> {
    static LOG: OnceLock<Option<PathBuf>> = OnceLock::new();
    LOG.get_or_init(|| {
        if Command::new("umockdev-run").arg("--version").output().is_err() {
            let in_ci = std::env::var("CI").is_ok_and(|ci| ci == "true");
            assert!(!in_ci, "CI must have umockdev-run: apt-get install umockdev");
            println!("skipped: no umockdev-run (apt-get install umockdev)");
            return None;
        }
        let devices = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/devices");
        let log = folder("stick").join("flight.mcap");
        let file = |name: &str| devices.join(name).display().to_string();
        let mut flight = Command::new("umockdev-run");
        flight
            .args(["-d", &file("stick.umockdev")])
            .args(["-i", &format!("/dev/input/event20={}", file("stick.ioctl"))])
            .args(["-e", &format!("/dev/input/event20={}", file("stick.evemu"))])
            .args(["--", env!("CARGO_BIN_EXE_tiltrotor"), "fly", "--stick", "--duration", "8"])
            .args(["--no-flightgear", "--out", text(&log)]);
        said(&mut flight).ends(OK).says("device 0: Virtual Flight Stick");
        Some(log)
    })
    .as_deref()
}

fn ticks(log: &Path) -> (Vec<Tick>, FlightReader) {
    let mut reader = logs::open(log, OpenOptions::default()).expect("a log");
    let mut ticks = Vec::new();
    while let Some(tick) = reader.next_tick().expect("a tick") {
        ticks.push(tick.clone());
    }
    (ticks, reader)
}

#[test]
fn every_event_of_a_stick_is_recorded_in_order() {
    let Some(log) = flight() else { return };
    let (ticks, _) = ticks(log);
    let events = ticks.iter().flat_map(|tick| &tick.events);
    let kind =
        |event: &engine::inputs::DeviceEvent| EventKind::from_u64(event.kind).expect("known");
    let recorded: Vec<_> = events
        .filter(|event| matches!(kind(event), EventKind::Axis | EventKind::Button))
        .inspect(|event| assert_eq!(event.device, 0))
        .map(|event| (kind(event), event.code, event.value))
        .collect();
    assert_eq!(expected().len(), EVENTS);
    assert_eq!(recorded, expected());
}

#[test]
fn a_stick_moves_the_controls_over_the_range_that_it_tells() {
    let Some(log) = flight() else { return };
    let (ticks, reader) = ticks(log);
    let map = &reader.setup.cockpit_toml;
    assert!(!map.contains("raw_max") && map.contains("ABS_THROTTLE"), "from the device: {map}");
    let cockpits: Vec<_> = ticks.iter().map(|tick| tick.record.state.cockpit).collect();
    let reached = |what: fn(&engine::cockpit::State) -> f64, expected: f64| {
        let most = cockpits.iter().map(what).fold(0.0, |most: f64, now| {
            if now * expected.signum() > most * expected.signum() { now } else { most }
        });
        assert!((most - expected).abs() < 0.01, "expected {expected}, got {most}");
    };
    // Past the dead zone, then 0.8 of it straight and 0.2 cubed.
    let curve = |travel: f64, dead: f64| {
        let x = (travel - dead) / (1.0 - dead);
        0.8 * x + 0.2 * x * x * x
    };
    reached(|cockpit| cockpit.collective_norm, 150.0 / 255.0);
    reached(|cockpit| cockpit.stick_right_norm, curve(0.25, 0.02));
    reached(|cockpit| cockpit.stick_aft_norm, -curve(0.25, 0.02));
    reached(|cockpit| cockpit.pedal_right_norm, curve(60.5 / 127.5, 0.05));
    reached(|cockpit| cockpit.nacelle_aft_norm, 1.0);
    let last = cockpits.last().expect("a tick");
    assert!(last.stick_right_norm.abs() < 1e-9 && last.nacelle_aft_norm.abs() < 1e-9, "{last:?}");
}

#[test]
fn the_trigger_marks_the_moment() {
    let Some(log) = flight() else { return };
    let (ticks, reader) = ticks(log);
    let pressed = ticks
        .iter()
        .find(|tick| tick.events.iter().any(|event| (event.code, event.value) == (0x120, 1)));
    let marks: Vec<_> = reader
        .events
        .iter()
        .filter(|event| event.kind == FlightEvent::Marker as u64)
        .map(|event| (event.tick, event.value))
        .collect();
    assert_eq!(marks, [(pressed.expect("a trigger").record.state.tick, 1)]);
    tiltrotor(&["log", "info", text(log)]).ends(OK).says("marker 1").says("device 0 connected");
}

#[test]
fn a_flight_with_a_stick_reflies_without_it() {
    let Some(log) = flight() else { return };
    verify(log).ends(OK).says("exact: all 2000 ticks (8.0 s)");
}
