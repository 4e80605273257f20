//! A flight by script: timed events in TOML take the path that a stick takes.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use engine::cockpit::{Device, Travel};
use engine::controls::PilotControls;
use engine::inputs::{EventKind, Failures, World};
use logs::records::FlightEvent;
use logs::{FlightReader, OpenOptions, Tick};

use crate::common::{OK, folder, text, tiltrotor, verify};

const SCRIPT: &str = r#"
[[event]]
at_s = 0.5
over_s = 1.0
axis = { stick_aft = -0.4, collective = 0.5 }

[[event]]
at_s = 2.0
press = ["marker", "gear_toggle"]
wind = { from_deg = 270.0, kt = 20.0 }

[[event]]
at_s = 2.5
hold = ["nacelle_aft"]

[[event]]
at_s = 2.6
release = ["nacelle_aft"]

[[event]]
at_s = 3.0
fail = ["engine_left", "scas_yaw"]

[[event]]
at_s = 3.5
mend = ["scas_yaw"]
pause = true

[[event]]
at_s = 3.8
pause = false
axis = { pedal_right = 0.25 }

[[event]]
at_s = 4.0
press = ["marker"]
end = true
"#;

/// Ticks of a moment of the script.
const fn tick(ms: u64) -> u64 {
    ms / 4
}

fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let place = folder("script");
        let (script, log) = (place.join("flight.toml"), place.join("flight.mcap"));
        fs::write(&script, SCRIPT).expect("a script");
        let (script, out) = (text(&script), text(&log));
        tiltrotor(&["fly", "--script", script, "--fast", "--no-flightgear", "--out", out]).ends(OK);
        log
    })
}

fn ticks() -> (Vec<Tick>, FlightReader) {
    let mut reader = logs::open(flight(), OpenOptions::default()).expect("a log");
    let mut ticks = Vec::new();
    while let Some(tick) = reader.next_tick().expect("a tick") {
        ticks.push(tick.clone());
    }
    (ticks, reader)
}

#[test]
fn a_script_flies_until_it_says_end_and_the_log_is_exact() {
    // The event that ends the flight is still flown.
    verify(flight()).ends(OK).says("exact: all 1001 ticks (4.0 s)");
}

#[test]
fn what_a_script_does_is_told_by_log_info() {
    tiltrotor(&["log", "info", text(flight())])
        .ends(OK)
        .says("flown_by         script flight.toml")
        .says("2.004 s  marker 1")
        .says("3.000 s  failed: left engine, SCAS yaw")
        .says("2.000 s  wind: from ")
        .says("3.500 s  mended: SCAS yaw; still failed: left engine\n")
        .says("3.500 s  paused")
        .says("3.800 s  goes on")
        .says("4.004 s  marker 2")
        .says("4.004 s  end of the flight");
}

#[test]
fn the_events_of_a_script_are_recorded_at_their_ticks() {
    let (_, reader) = ticks();
    let told: Vec<_> = reader
        .events
        .iter()
        .filter_map(|event| Some((event.tick, FlightEvent::from_u64(event.kind)?, event.value)))
        .filter(|(_, what, _)| !matches!(what, FlightEvent::Validity | FlightEvent::WeightOnWheels))
        .collect();
    let both = Failures::ENGINE_LEFT | Failures::SCAS_YAW;
    assert_eq!(
        told,
        [
            (tick(2000), FlightEvent::Wind, 1),
            // A marker is counted by the step that got it.
            (tick(2000) + 1, FlightEvent::Marker, 1),
            (tick(3000), FlightEvent::Failures, both.bits()),
            (tick(3500), FlightEvent::Failures, Failures::ENGINE_LEFT.bits()),
            (tick(3500), FlightEvent::Paused, 1),
            (tick(3800), FlightEvent::Paused, 0),
            (tick(4000) + 1, FlightEvent::Marker, 2),
            (tick(4000) + 1, FlightEvent::Landed, 0),
        ]
    );
}

#[test]
fn an_axis_ramps_from_where_it_was_in_the_time_it_was_given() {
    let (ticks, _) = ticks();
    let at = |ms: u64| ticks[tick(ms) as usize].record.state.cockpit;
    assert!(at(496).collective_norm.abs() < 1e-9);
    assert!((at(1000).collective_norm - 0.25).abs() < 1e-3);
    assert!((at(1000).stick_aft_norm + 0.2).abs() < 1e-3);
    assert!((at(1600).collective_norm - 0.5).abs() < 1e-3);
    assert!((at(1600).stick_aft_norm + 0.4).abs() < 1e-3);
    assert!((at(4000).pedal_right_norm - 0.25).abs() < 1e-3, "at once");
    let lever: Vec<_> =
        ticks.iter().map(|tick| tick.record.state.cockpit.collective_norm).collect();
    assert!(lever.windows(2).all(|pair| pair[0] <= pair[1]), "never back");
}

#[test]
fn buttons_of_a_script_are_pressed_and_released_in_order() {
    let (ticks, _) = ticks();
    let buttons: Vec<_> = ticks
        .iter()
        .flat_map(|tick| &tick.events)
        .filter(|event| event.kind == EventKind::Button as u64)
        .map(|event| (event.tick, event.code, event.value))
        .collect();
    let (marker, gear, aft) = (0x128, 0x124, 0x121);
    assert_eq!(
        buttons,
        [
            (tick(2000), marker, 1),
            (tick(2000), gear, 1),
            (tick(2000), marker, 0),
            (tick(2000), gear, 0),
            (tick(2500), aft, 1),
            (tick(2600), aft, 0),
            (tick(4000), marker, 1),
            (tick(4000), marker, 0),
        ]
    );
}

#[test]
fn wind_from_the_west_blows_east_from_the_tick_it_was_ordered() {
    let (ticks, _) = ticks();
    let world = |ms: u64| -> World { ticks[tick(ms) as usize].inputs.world };
    assert_eq!(world(1996).wind_mps.norm().to_bits(), 0.0_f64.to_bits());
    let wind = world(2000).wind_mps;
    assert!(
        (wind.y - 20.0 * engine::units::KNOT_MPS).abs() < 1e-9 && wind.x.abs() < 1e-9,
        "{wind:?}"
    );
}

#[test]
fn a_paused_aircraft_stands_still_while_ticks_go_on() {
    let (ticks, _) = ticks();
    let plant = |ms: u64| ticks[tick(ms) as usize].record.state.plant;
    assert_eq!(plant(3500), plant(3796));
    assert_ne!(plant(3492), plant(3496), "before");
    assert_ne!(plant(3796), plant(3804), "after");
}

#[test]
fn an_engine_failed_by_script_loses_its_power() {
    let (ticks, _) = ticks();
    let engines = ticks[tick(4000) as usize].record.state.plant.engines;
    assert!(engines.left.power_w < 0.5 * engines.right.power_w, "{engines:?}");
}

#[test]
fn the_same_script_gives_the_same_digest() {
    let place = folder("script-again");
    let (script, log) = (place.join("flight.toml"), place.join("again.mcap"));
    fs::write(&script, SCRIPT).expect("a script");
    let (script, out) = (text(&script), text(&log));
    let again =
        tiltrotor(&["fly", "--script", script, "--fast", "--no-flightgear", "--out", out]).ends(OK);
    let first = tiltrotor(&["log", "info", text(flight())]).ends(OK);
    assert!(again.out.contains(first.after("digest")), "{again}");
}

/// A script of steps a tenth of a second apart, flown: the cockpit a tick or two after each.
fn cockpits_after(name: &str, steps: &[String]) -> Vec<PilotControls> {
    let mut toml = String::new();
    for (number, step) in steps.iter().enumerate() {
        let at_s = 0.1 * (number + 1) as f64;
        toml += &format!("[[event]]\nat_s = {at_s:.1}\n{step}\n");
    }
    toml += &format!("[[event]]\nat_s = {:.1}\nend = true\n", 0.1 * (steps.len() + 1) as f64);
    let place = folder(name);
    let (script, log) = (place.join("flight.toml"), place.join("flight.mcap"));
    fs::write(&script, toml).expect("a script");
    let flight =
        ["fly", "--script", text(&script), "--fast", "--no-flightgear", "--out", text(&log)];
    tiltrotor(&flight).ends(OK);
    verify(&log).ends(OK);
    let mut reader = logs::open(&log, OpenOptions::default()).expect("a log");
    let mut cockpits = Vec::new();
    while let Some(flown) = reader.next_tick().expect("a tick") {
        cockpits.push(flown.record.state.cockpit);
    }
    (1..=steps.len()).map(|number| cockpits[number * 25 + 2]).collect()
}

/// The controls that scripts have.
fn scripted() -> Device {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).expect("our own map");
    map.device.into_iter().next().expect("a device")
}

#[test]
fn every_axis_of_a_script_goes_to_both_ends_and_back_and_no_farther() {
    let axes: Vec<_> = scripted().axis.iter().map(|axis| axis.control).collect();
    assert!(axes.len() >= 6, "{axes:?}");
    let mut steps = Vec::new();
    for axis in &axes {
        let (key, low) = match axis.facts().travel {
            Travel::Centred => (axis.facts().key, -1.0),
            Travel::FromEnd => (axis.facts().key, 0.0),
        };
        for to in [1.0, low, 0.0] {
            steps.push((*axis, to, format!("axis = {{ {key} = {to:?} }}")));
        }
        for beyond in [1.01, low - 0.01] {
            let place = folder("script-beyond");
            let script = place.join("beyond.toml");
            let event = format!("[[event]]\nat_s = 0.1\naxis = {{ {key} = {beyond:?} }}\n");
            fs::write(&script, event).expect("a script");
            let said = tiltrotor(&["fly", "--script", text(&script), "--fast", "--no-flightgear"]);
            said.refused().says(&format!("axis.{key}: expected {low} to 1")).says("got");
        }
    }
    let texts: Vec<_> = steps.iter().map(|(.., text)| text.clone()).collect();
    let flown = cockpits_after("script-axes", &texts);
    for ((axis, to, text), cockpit) in steps.iter().zip(&flown) {
        let found = (axis.facts().get)(cockpit);
        // A raw value has 15 bits and a sign.
        assert!((found - to).abs() < 2e-5, "{text}: {found}");
    }
}

#[test]
fn every_button_of_a_script_is_pressed_past_its_ends_and_back() {
    let buttons: Vec<_> = scripted().button.iter().map(|button| button.control).collect();
    let read = |what: &str, cockpit: &PilotControls| match what {
        "flap" => cockpit.flap_detent as i64,
        "gear" => cockpit.gear_down as i64,
        "brake" => cockpit.parking_brake as i64,
        "scas" => cockpit.scas_on as i64,
        "rpm" => cockpit.rpm_select as i64,
        "markers" => cockpit.markers as i64,
        _ => cockpit.nacelle_aft_norm as i64,
    };
    // Each with what it moves and where that is after every press: flaps from 40 deg past full flap, up past flaps
    // up, and back; handles there and back; rotor speeds around; both nacelle switches, the later one counts.
    let presses: [(&str, &str, &str, &[i64]); 9] = [
        ("press", "flap_down", "flap", &[3, 3, 3]),
        ("press", "flap_up", "flap", &[2, 1, 0, 0, 0]),
        ("press", "flap_down", "flap", &[1, 2]),
        ("press", "gear_toggle", "gear", &[0, 1]),
        ("press", "parking_brake_toggle", "brake", &[0, 1]),
        ("press", "scas_toggle", "scas", &[0, 1]),
        ("press", "rpm_select", "rpm", &[1, 2, 0, 1, 2, 0]),
        ("press", "marker", "markers", &[1, 2]),
        ("hold", "nacelle_aft", "nacelles", &[1, 1]),
    ];
    let releases: [(&str, &str, &str, &[i64]); 4] = [
        ("release", "nacelle_aft", "nacelles", &[0, 0]),
        ("hold", "nacelle_forward", "nacelles", &[-1, -1]),
        ("release", "nacelle_forward", "nacelles", &[0]),
        ("press", "nacelle_forward", "nacelles", &[0]),
    ];
    let all: Vec<_> = presses.iter().chain(&releases).collect();
    for button in buttons {
        let key = button.facts().key;
        assert!(all.iter().any(|(_, pressed, ..)| *pressed == key), "{key} is not pressed");
    }
    let steps = all.iter().flat_map(|(verb, key, what, after)| {
        after.iter().map(move |after| (format!("{verb} = [\"{key}\"]"), *what, *after))
    });
    let steps: Vec<_> = steps.collect();
    let texts: Vec<_> = steps.iter().map(|(text, ..)| text.clone()).collect();
    let flown = cockpits_after("script-buttons", &texts);
    for (number, ((text, what, after), cockpit)) in steps.iter().zip(&flown).enumerate() {
        assert_eq!(read(what, cockpit), *after, "step {number}: {text}");
    }
}
