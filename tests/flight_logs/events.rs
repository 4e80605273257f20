//! The events of a log are the whole story, in order of time, and `log find` tells it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use logs::OpenOptions;
use logs::records::{EventRecord, FlightEvent};

use crate::common::{LOG_CUT_SHORT, OK, Said, UNUSABLE, folder, text, tiltrotor};

const WEATHER: &str = "
[[event]]
at_s = 1.0
wind = { from_deg = 270.0, kt = 15.0 }
[[event]]
at_s = 2.0
gust = { up_mps = 6.0, s = 2.0 }
[[event]]
at_s = 3.0
turbulence_mps = 1.5
[[event]]
at_s = 4.0
fail = ['scas_yaw', 'governor']
[[event]]
at_s = 5.0
mend = ['scas_yaw']
press = ['marker']
[[event]]
at_s = 6.0
turbulence_mps = 0.0
wind = { from_deg = 0.0, kt = 0.0 }
";

/// Flies from steady flight, as fast as it goes, and says so.
fn fly(place: &Path, script: &str, more: &[&str]) -> (PathBuf, Said) {
    let (events, log) = (place.join("script.toml"), place.join("flight.mcap"));
    fs::write(&events, script).expect("a file");
    let always = [
        "fly",
        "--fast",
        "--no-flightgear",
        "--from-trim",
        "--script",
        text(&events),
        "--out",
        text(&log),
    ];
    let said = tiltrotor(&[&always, more].concat());
    (log, said)
}

/// Every event of a kind, with its words.
fn told(log: &Path, what: FlightEvent) -> Vec<(EventRecord, String)> {
    let mut reader = logs::open(log, OpenOptions::default()).expect("a flight log");
    while reader.next_tick().expect("whole ticks").is_some() {}
    let words = reader.log_lines.iter().map(|line| line.words.clone());
    let events = reader.events.iter().copied().zip(words);
    events.filter(|(event, _)| event.kind == what as u64).collect()
}

fn words(log: &Path, what: FlightEvent) -> Vec<String> {
    told(log, what).into_iter().map(|(_, words)| words).collect()
}

#[test]
fn weather_and_failures_are_told_when_they_come_and_go() {
    let place = folder("events-weather");
    let (log, said) = fly(&place, WEATHER, &["--pilot", "hover", "--duration", "8"]);
    said.ends(OK);
    assert_eq!(words(&log, FlightEvent::Wind), ["wind: from 270 deg, 15.0 kt", "wind: calm"]);
    assert_eq!(
        words(&log, FlightEvent::Gust),
        ["gust begins: 0.0 m/s north, 0.0 m/s east, 6.0 m/s up, over 2.0 s"]
    );
    let gust = told(&log, FlightEvent::Gust)[0].0;
    assert_eq!((gust.tick, gust.measured), (500, [6.0, 2.0]));
    assert_eq!(words(&log, FlightEvent::Turbulence).len(), 2);
    assert_eq!(
        words(&log, FlightEvent::Failures),
        ["failed: SCAS yaw, governor", "mended: SCAS yaw; still failed: governor"]
    );
    assert_eq!(words(&log, FlightEvent::Landed), ["end of the flight: the time given is over"]);
}

#[test]
fn what_happened_around_a_moment_is_found_without_a_script() {
    let place = folder("events-find");
    let (log, said) = fly(&place, WEATHER, &["--pilot", "hover", "--duration", "8"]);
    said.ends(OK);
    let around =
        tiltrotor(&["log", "find", text(&log), "--around", "2", "--window", "0.5"]).ends(OK);
    let around = around.says("2.000 s  gust").says("6.0 m/s up, over 2.0 s");
    let around = around.says("2.000 s  world            gust_mps.z: 0.0 -> -6.0");
    around.never_says("wind: from").never_says("turbulence");

    let gusts = tiltrotor(&["log", "find", text(&log), "--kind", "gust"]).ends(OK);
    assert_eq!(gusts.out.lines().count(), 1, "{gusts}");
    let buttons = tiltrotor(&["log", "find", text(&log), "--kind", "button"]).ends(OK);
    buttons.says("5.000 s  button           marker pressed");
    tiltrotor(&["log", "find", text(&log), "--kind", "impact"])
        .ends(OK)
        .says("nothing of the kind");
    tiltrotor(&["log", "find", text(&log), "--kind", "gusts"])
        .ends(UNUSABLE)
        .says("expected one of");
}

/// The tanks run dry a hundred metres up, and somebody rolls it over.
#[test]
fn empty_tanks_and_the_impact_are_told_with_sink_and_speed() {
    let place = folder("events-impact");
    let scenario = place.join("scenario.toml");
    let little = format!("fuel_lb = 1.0\n{}", aircraft::DEFAULT_SCENARIO);
    fs::write(&scenario, little).expect("a file");
    let more = [
        "--scenario",
        text(&scenario),
        "--speed-kt",
        "60",
        "--altitude-ft",
        "350",
        "--duration",
        "15",
    ];
    let (log, said) = fly(&place, "[[event]]\nat_s = 5.0\naxis = { stick_right = 1.0 }\n", &more);
    said.ends(OK);
    let fuel = words(&log, FlightEvent::Fuel);
    assert_eq!(fuel, ["fuel exhausted; out by it: left engine, right engine"]);
    let impacts = told(&log, FlightEvent::Impact);
    let hulls: Vec<_> = impacts.iter().filter(|(event, _)| event.value == 2).collect();
    let [(hull, said)] = hulls[..] else { panic!("not one: {impacts:?}") };
    assert!(hull.measured[0] > 3.0, "{said}");
    assert!(said.starts_with("impact, sinking ") && said.ends_with("structural contact: the hull"));
    let validity = words(&log, FlightEvent::Validity);
    assert!(validity.iter().any(|words| words.contains("hull on the ground")), "{validity:?}");
    // A wreck that rolls over its wheels neither lands nor lifts off.
    let wheels = told(&log, FlightEvent::WeightOnWheels);
    assert!(wheels.iter().all(|(event, _)| event.tick <= hull.tick), "{wheels:?}");
}

#[test]
fn a_pilot_that_cannot_do_its_task_gives_up_in_words_and_ends_with_4() {
    let place = folder("events-gave-up");
    let scenario = "[[event]]\nat_s = 1.0\nfail = ['engine_left', 'engine_right']\n";
    let more = ["--pilot", "takeoff", "--speed-kt", "80", "--duration", "300"];
    let (log, said) = fly(&place, scenario, &more);
    said.ends(LOG_CUT_SHORT).says("end        end of the flight: the pilot gave up, ");
    let gave_up = told(&log, FlightEvent::GaveUp);
    assert_eq!(gave_up.len(), 1, "{gave_up:?}");
    assert_eq!(told(&log, FlightEvent::Landed)[0].0.value, 3);
}

/// The pilot selects the rotor speed in which nacelles move: it would wait for ever for what nobody asks
/// for.
#[test]
fn a_pilot_reconverts_from_the_slow_rotors_of_an_aeroplane_and_lands() {
    let place = folder("events-slow-rotors");
    let more = ["--pilot", "land", "--nacelle", "0", "--speed-kt", "180"];
    let (log, said) = fly(&place, "", &more);
    said.ends(OK);
    assert_eq!(
        words(&log, FlightEvent::Landed),
        ["end of the flight: the pilot model or script has ended"]
    );
    let touchdowns = told(&log, FlightEvent::WeightOnWheels);
    assert!(touchdowns.iter().any(|(event, _)| event.value == 1), "{touchdowns:?}");
    assert!(words(&log, FlightEvent::Impact).is_empty());
}

#[test]
fn log_times_never_go_back_and_validity_does_not_chatter() {
    let place = folder("events-order");
    let (log, said) =
        fly(&place, WEATHER, &["--pilot", "land", "--duration", "200", "--self-check"]);
    said.ends(OK);
    let bytes = fs::read(&log).expect("the log");
    let (mut last, mut count) = (0, 0);
    for message in mcap::MessageStream::new(&bytes).expect("MCAP") {
        let message = message.expect("a message");
        let topic = &message.channel.topic;
        assert!(message.log_time >= last, "{topic}: {} after {last}", message.log_time);
        (last, count) = (message.log_time, count + 1);
    }
    assert!(count > 10_000, "{count}");
    // Each flag comes and goes at most once a second.
    let mut flags: BTreeMap<u64, u64> = BTreeMap::new();
    for (event, words) in told(&log, FlightEvent::Validity) {
        if let Some(before) = flags.insert(event.value, event.tick) {
            assert!(event.tick >= before + 250, "{words}");
        }
    }
}
