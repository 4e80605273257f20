//! Another aircraft is another file: the generic tilt-rotor trims, flies, is recorded, reflies and is drawn as
//! itself, by the same program and the same pilot models.

use std::path::Path;

use serde_json::Value;

use crate::common::{Forgery, OK, folder, text, tiltrotor, verify};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/aircraft/generic.toml");
/// Length over the XV-15's.
const LAMBDA: f64 = 0.8;

fn read(name: &str, toml: &str) -> engine::Aircraft {
    aircraft::aircraft(name, toml).unwrap_or_else(|error| panic!("{error}"))
}

fn generic_toml() -> String {
    std::fs::read_to_string(FILE).expect("the file")
}

#[test]
fn every_number_is_an_estimate_and_what_differs_is_no_scale() {
    let toml = generic_toml();
    for number in aircraft::provenance("generic.toml", &toml).expect("TOML") {
        assert_eq!(number.trust.label(), "E", "{}", number.key);
    }
    let (generic, xv15) = (read("generic.toml", &toml), read("xv15.toml", aircraft::XV15));
    let ratio = generic.rotors.radius_m / xv15.rotors.radius_m;
    assert!((ratio - LAMBDA).abs() < 1e-4, "{ratio}");
    let part = |of: &engine::Aircraft, select: usize| {
        of.fcc.governor.rotor_speed_radps[select] / of.envelope.rotors.rated_radps
    };
    assert!((part(&generic, 2) - part(&xv15, 2)).abs() > 0.02, "another schedule");
    assert!((generic.fcc.mixer.flap_rad[1] - xv15.fcc.mixer.flap_rad[1]).abs() > 0.05);
    assert!(toml.contains("\nradius_norm = [0.80, 0.95, 1.0]\n"), "three sections");
}

/// Speeds by the root of the length.
#[test]
fn it_trims_as_a_helicopter_in_conversion_and_as_an_aeroplane() {
    for (nacelle_deg, speed_kt) in [("90", "0"), ("90", "72"), ("60", "90"), ("0", "150")] {
        let flight = ["trim", "--aircraft", FILE, "--nacelle", nacelle_deg, "--speed-kt", speed_kt];
        let said = tiltrotor(&flight).ends(OK);
        assert!(!said.err.contains("warning"), "{said}");
    }
}

/// A number of `/outputs`, once a second.
fn each_second(log: &Path, field: &str) -> Vec<f64> {
    let said = tiltrotor(&[
        "log",
        "cat",
        text(log),
        "--channel",
        "outputs",
        "--every",
        "250",
        "--field",
        field,
    ]);
    let of_line = |line: &str| {
        let line: Value = serde_json::from_str(line).expect("JSON");
        line[field].as_f64().expect("a number")
    };
    said.ends(OK).out.lines().map(of_line).collect()
}

#[test]
fn it_takes_off_converts_lands_reflies_and_is_drawn_as_itself() {
    let log = folder("second-aircraft").join("demo.mcap");
    let flight = ["fly", "--pilot", "demo", "--fast", "--aircraft", FILE, "--out", text(&log)];
    tiltrotor(&flight).ends(OK).says("debrief    touchdown");
    verify(&log).ends(OK).says(": exact: all ");

    let generic = read("generic.toml", &generic_toml());
    let radps = each_second(&log, "rotor_speed_radps");
    let [helicopter, ..] = generic.fcc.governor.rotor_speed_radps;
    assert!((radps[10] / helicopter - 1.0).abs() < 0.02, "{} rad/s in hover", radps[10]);
    let flap_rad = each_second(&log, "actuators.flap_rad");
    // The circuit is flown too slowly for flaps up.
    for detent in 1..3 {
        let wanted_rad = generic.fcc.mixer.flap_rad[detent];
        let was = flap_rad.iter().any(|rad| (rad - wanted_rad).abs() < 1e-6);
        assert!(was, "detent {detent}: {wanted_rad} rad");
    }
    let tilt_rad = each_second(&log, "actuators.mast_tilt_rad.left");
    assert!(tilt_rad.iter().any(|rad| *rad > 1.57), "an aeroplane");
    assert!(tilt_rad.last().is_some_and(|rad| *rad < 0.01), "a helicopter again");

    let mut forgery = Forgery::of(&log);
    let drawn = String::from_utf8_lossy(forgery.bytes("/robot_description", 0)).into_owned();
    assert!(drawn.contains(aircraft::urdf(&generic).trim()), "its own shape");
    assert!(drawn.contains("<robot name=\"generic_tilt_rotor\">"), "its own name");
    assert!(drawn.contains("radius=\"3.048\""), "its own rotors: {drawn}");
}
