//! What cannot be carried out is refused in one line that says what to do, and nothing is touched.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{OK, Said, UNUSABLE, folder, text, tiltrotor};

/// The built-in scenario.
const SCENARIO: &str = include_str!("../../aircraft/scenario/default.toml");
const XV15: &str = include_str!("../../aircraft/xv15.toml");

/// A short flight by the pilot model with something to be refused.
#[track_caller]
fn fly(place: &Path, more: &[&str]) -> Said {
    let out = place.join("flight.mcap");
    let flight = [
        "fly",
        "--pilot",
        "hover",
        "--fast",
        "--duration",
        "0.1",
        "--no-flightgear",
        "--out",
        text(&out),
    ];
    let said = tiltrotor(&[&flight[..], more].concat());
    assert!(said.status == Some(OK) || !out.exists(), "nothing is begun: {said}");
    said
}

/// A file of that text, to be given to the command.
fn file(place: &Path, name: &str, content: &str) -> PathBuf {
    let path = place.join(name);
    fs::write(&path, content).expect("a file");
    path
}

/// The XV-15 with one piece of text replaced, and the line it is on.
#[track_caller]
fn xv15_with(place: &Path, from: &str, to: &str) -> (PathBuf, usize) {
    let at = XV15.find(from).unwrap_or_else(|| panic!("no `{from}` in xv15.toml"));
    let line = 1 + XV15[..at].matches('\n').count();
    (file(place, "my xv15.toml", &XV15.replacen(from, to, 1)), line)
}

/// Flies an XV-15 with one piece of text replaced; the refusal names file and line.
#[track_caller]
fn refused_xv15(name: &str, from: &str, to: &str) -> Said {
    let place = folder(&format!("bad-{name}"));
    let (path, line) = xv15_with(&place, from, to);
    fly(&place, &["--aircraft", text(&path)]).refused().says(&format!("my xv15.toml:{line}: "))
}

/// Flies a script; the refusal names the file.
#[track_caller]
fn refused_script(name: &str, content: &str) -> Said {
    let place = folder(&format!("bad-script-{name}"));
    let path = file(&place, "script.toml", content);
    let out = place.join("flight.mcap");
    let said = tiltrotor(&[
        "fly",
        "--script",
        text(&path),
        "--fast",
        "--duration",
        "1",
        "--no-flightgear",
        "--out",
        text(&out),
    ])
    .refused()
    .says(text(&path));
    assert!(!out.exists());
    said
}

#[test]
fn the_aircraft_s_own_file_given_by_hand_flies() {
    let place = folder("bad-none");
    let path = file(&place, "my xv15.toml", XV15);
    fly(&place, &["--aircraft", text(&path)]).ends(OK);
}

#[test]
fn an_unknown_key_of_the_aircraft_is_named_with_its_line_and_the_known_ones() {
    refused_xv15("key", "mast_length_ft", "mast_lenght_ft")
        .says("rotors.mast_lenght_ft: unknown key; expected one of ")
        .says("mast_length_m");
}

#[test]
fn a_missing_key_of_the_aircraft_is_named() {
    let place = folder("bad-missing");
    let line = XV15.lines().find(|line| line.starts_with("mast_length_ft")).expect("the line");
    let (path, _) = xv15_with(&place, line, "");
    fly(&place, &["--aircraft", text(&path)])
        .refused()
        .says("my xv15.toml:")
        .says("rotors: missing key mast_length_m");
}

#[test]
fn a_value_of_the_wrong_type_is_named_with_what_was_expected() {
    refused_xv15(
        "type",
        "mast_length_ft = { value = 4.667",
        "mast_length_ft = { value = \"4.667\"",
    )
    .says("rotors.mast_length_ft: expected a number, found a string");
}

#[test]
fn a_number_out_of_range_is_named_with_the_range() {
    refused_xv15("range", "mast_length_ft = { value = 4.667", "mast_length_ft = { value = -4.667")
        .says("rotors.mast_length_ft: expected ")
        .says("found -");
    refused_xv15("nan", "mast_length_ft = { value = 4.667", "mast_length_ft = { value = nan")
        .says("rotors.mast_length_ft.value: expected a finite number");
}

#[test]
fn a_number_without_its_source_is_refused() {
    let line = XV15.lines().find(|line| line.starts_with("mast_length_ft")).expect("the line");
    refused_xv15("source", line, "mast_length_ft = 4.667").says("a number without its source");
}

#[test]
fn what_is_not_toml_is_named_with_its_line() {
    refused_xv15("toml", "mast_length_ft = {", "lock_number = = {").says("not valid TOML");
    let place = folder("bad-binary");
    let path = place.join("binary.toml");
    fs::write(&path, [0xff, 0xfe, 0x00, 0x80]).expect("a file");
    fly(&place, &["--aircraft", text(&path)]).refused().says("binary.toml");
    let path = file(&place, "empty.toml", "");
    fly(&place, &["--aircraft", text(&path)]).refused().says("empty.toml:1: ").says("missing key");
}

#[test]
fn a_wrong_scenario_is_named_with_its_line() {
    let place = folder("bad-scenario");
    let scenario = "heading_deg = 270.0\nfuel_lb = 1475.0\nwheels = 3\n";
    let path = file(&place, "scenario.toml", scenario);
    fly(&place, &["--scenario", text(&path)])
        .refused()
        .says("scenario.toml:3: wheels: unknown key; expected one of ")
        .says("flap_detent");
}

#[test]
fn more_fuel_than_the_tanks_hold_is_refused() {
    let place = folder("bad-fuel");
    let scenario = format!("fuel_lb = 3000.0\n{SCENARIO}");
    assert_ne!(scenario, SCENARIO);
    let path = file(&place, "scenario.toml", &scenario);
    fly(&place, &["--scenario", text(&path)])
        .refused()
        .says("fuel of 1361 kg: the tanks of ")
        .says(" hold 669 kg");
}

#[test]
fn files_that_are_not_there_are_named() {
    let place = folder("bad-absent");
    let absent = place.join("absent.toml");
    for option in ["--aircraft", "--scenario", "--script"] {
        fly(&place, &[option, text(&absent)])
            .refused()
            .says("cannot read ")
            .says("absent.toml")
            .says("No such file");
    }
    fly(&place, &["--aircraft", text(&place)]).refused().says("cannot read ");
}

#[test]
fn a_wrong_key_of_a_script_is_named_with_its_line_and_the_known_ones() {
    refused_script("key", "[[event]]\nat_s = 1.0\naxes = { stick_aft = 0.2 }\n")
        .says("script.toml:3: ")
        .says("axes")
        .says("expected one of `at_s`, `over_s`, `axis`");
    refused_script("button", "[[event]]\nat_s = 1.0\npress = [\"eject\"]\n")
        .says("script.toml:3: ")
        .says("eject")
        .says("`marker`");
    refused_script("time", "\n[[event]]\npress = [\"marker\"]\n").says("at_s");
    refused_script("syntax", "[[event]\n").says("script.toml:1: ");
}

#[test]
fn a_number_that_no_control_has_is_named_with_its_event() {
    let event = |rest: &str| format!("[[event]]\nat_s = 0.0\n\n[[event]]\nat_s = 1.5\n{rest}\n");
    refused_script("axis", &event("axis = { collective = -0.1 }"))
        .says("event 2 (at 1.5 s): axis.collective: expected 0 to 1, got -0.1");
    refused_script("nan", &event("axis = { stick_aft = nan }"))
        .says("axis.stick_aft: expected -1 to 1, got NaN");
    refused_script("name", &event("axis = { stick_up = 0.1 }"))
        .says("axis.stick_up: expected one of stick_aft, stick_right, collective, pedal_right, ");
    refused_script("wind", &event("wind = { from_deg = 270.0, kt = 900.0 }"))
        .says("wind: expected 0 to 200 kt, got 900 kt");
    refused_script("past", "[[event]]\nat_s = -1.0\n").says("at_s: expected 0 s or later, got -1");
}

#[test]
fn an_unknown_pilot_is_told_who_there_is() {
    let place = folder("bad-pilot");
    let out = place.join("flight.mcap");
    let said = tiltrotor(&["fly", "--pilot", "maverick", "--no-flightgear", "--out", text(&out)])
        .refused()
        .says("no pilot model is called `maverick`");
    for (name, _) in recorder::pilots::PILOTS {
        assert!(said.err.contains(name), "{said}");
    }
    assert!(!out.exists());
}

#[test]
fn nobody_at_the_controls_is_told_who_could_be() {
    let out = folder("bad-nobody").join("flight.mcap");
    tiltrotor(&["fly", "--no-flightgear", "--out", text(&out)])
        .refused()
        .says("nobody flies: give --stick, --keyboard")
        .says("--script FILE");
    assert!(!out.exists());
}

#[test]
fn a_pilot_who_never_lands_is_not_let_loose_without_real_time() {
    let out = folder("bad-endless").join("flight.mcap");
    tiltrotor(&["fly", "--pilot", "hover", "--fast", "--no-flightgear", "--out", text(&out)])
        .refused()
        .says("give --duration SECONDS with --fast");
    assert!(!out.exists());
}

#[test]
#[cfg(feature = "sticks")]
fn no_stick_plugged_in_is_told() {
    let place = folder("bad-stick");
    // A name that no stick has, should there be one after all.
    let map = "[[device]]\nname = \"no such stick\"\n";
    let (map, out) = (file(&place, "map.toml", map), place.join("flight.mcap"));
    let flight = ["fly", "--stick", "--duration", "1", "--no-flightgear", "--out", text(&out)];
    tiltrotor(&[&flight[..], &["--map", text(&map)]].concat())
        .ends(2)
        .says("no stick found")
        .says("plug one in, write a map for what is there (`tiltrotor devices --map-new FILE`), or fly")
        .says("with `--keyboard` or `--pilot hover`");
    assert!(!out.exists());
}

#[test]
fn a_wrong_cockpit_map_is_named_with_its_line() {
    let place = folder("bad-map");
    let map =
        "[[device]]\nname = \"stick\"\naxis = [\n  { code = 0, control = \"stick_left\" },\n]\n";
    let map = file(&place, "map.toml", map);
    let out = place.join("flight.mcap");
    let flight = ["fly", "--stick", "--duration", "1", "--no-flightgear", "--out", text(&out)];
    let said = tiltrotor(&[&flight[..], &["--map", text(&map)]].concat()).refused();
    if cfg!(feature = "sticks") {
        said.says("map.toml:4: ").says("unknown name `stick_left`; expected one of stick_aft");
    }
}

#[test]
fn a_log_that_cannot_be_written_is_told_before_the_flight() {
    let place = folder("bad-out");
    let flight = ["fly", "--pilot", "hover", "--fast", "--duration", "1", "--no-flightgear"];
    let out = place.join("no such folder").join("flight.mcap");
    tiltrotor(&[&flight[..], &["--out", text(&out)]].concat())
        .refused()
        .says("cannot write ")
        .says(text(&out))
        .says("No such file or directory");
    tiltrotor(&[&flight[..], &["--force", "--out", text(&place)]].concat())
        .refused()
        .says("cannot write ");
}

#[test]
fn an_existing_log_is_not_touched_without_force_and_replaced_with_it() {
    let place = folder("bad-existing");
    let out = place.join("precious.mcap");
    fs::write(&out, "precious").expect("a file");
    let [hover, demo] = [
        &["fly", "--pilot", "hover", "--fast", "--duration", "1", "--no-flightgear"][..],
        &["demo", "--fast", "--no-flightgear"][..],
    ];
    for flight in [hover, demo] {
        tiltrotor(&[flight, &["--out", text(&out)]].concat())
            .refused()
            .says("precious.mcap exists")
            .says("--force");
        assert_eq!(fs::read(&out).expect("still there"), b"precious");
    }
    tiltrotor(&[hover, &["--force", "--out", text(&out)]].concat()).ends(OK);
    tiltrotor(&["verify", text(&out)]).ends(OK).says("exact: all 250 ticks");
    // A shorter flight leaves nothing of the longer one behind it.
    let shorter = ["fly", "--pilot", "hover", "--fast", "--duration", "0.5", "--no-flightgear"];
    tiltrotor(&[&shorter[..], &["--force", "--out", text(&out)]].concat()).ends(OK);
    tiltrotor(&["verify", text(&out)]).ends(OK).says("exact: all 125 ticks");
}

#[test]
fn a_flight_refused_after_force_has_not_emptied_the_log() {
    let place = folder("bad-force");
    let out = place.join("precious.mcap");
    fs::write(&out, "precious").expect("a file");
    let script = file(&place, "script.toml", "[[event]]\nat = 1\n");
    tiltrotor(&[
        "fly",
        "--script",
        text(&script),
        "--force",
        "--no-flightgear",
        "--out",
        text(&out),
    ])
    .refused();
    assert_eq!(fs::read(&out).expect("still there"), b"precious");
}

#[test]
fn a_duration_that_is_none_is_refused() {
    let place = folder("bad-duration");
    let out = place.join("flight.mcap");
    for seconds in ["0", "NaN", "inf", "0.001"] {
        let duration = format!("--duration={seconds}");
        let flight = ["fly", "--pilot", "hover", "--fast", "--no-flightgear", "--out", text(&out)];
        tiltrotor(&[&flight[..], &[&duration]].concat()).refused().says("--duration ");
        assert!(!out.exists());
    }
    let flight = ["fly", "--pilot", "hover", "--fast", "--no-flightgear", "--out", text(&out)];
    tiltrotor(&[&flight[..], &["--duration=-1"]].concat()).refused().says("--duration -1");
    tiltrotor(&[&flight[..], &["--duration=soon"]].concat()).ends(UNUSABLE).says("soon");
}

#[test]
fn a_speed_that_is_none_is_refused() {
    for speed in ["0", "NaN", "inf", "-1", "1e9"] {
        let speed = format!("--speed={speed}");
        tiltrotor(&["replay", &speed, "absent.mcap"]).refused().says("--speed ");
    }
}
