//! `trim`, `linearize` and `fly --from-trim`, end to end.

use std::fs;

use crate::common::{OK, UNUSABLE, folder, text, tiltrotor, verify};

/// No such steady flight.
const NO_TRIM: i32 = 5;

#[test]
fn a_hover_is_told_with_a_unit_on_every_number() {
    let said = tiltrotor(&["trim"]).ends(OK).says("power").says(" kW").says("stick ");
    assert!(said.out.lines().all(|line| line.split_whitespace().count() >= 3), "{}", said.out);
}

#[test]
fn a_sweep_is_a_table_and_a_file() {
    let csv = folder("steady").join("sweep.csv");
    tiltrotor(&["trim", "--sweep", "0:60:20", "--csv", text(&csv)]).ends(OK).says("kt");
    let written = fs::read_to_string(&csv).expect("the table");
    assert_eq!(written.lines().count(), 5);
    assert!(written.starts_with("speed_kt,nacelle_deg,climb_fpm,pitch_deg,"), "{written}");
}

#[test]
fn what_cannot_be_flown_is_said_and_told_by_the_status() {
    let slow = ["trim", "--nacelle", "0", "--speed-kt", "40"];
    tiltrotor(&slow).ends(NO_TRIM).says("NO TRIM");
    tiltrotor(&["trim", "--sweep", "9"]).ends(UNUSABLE);
    tiltrotor(&["fly", "--nacelle", "0", "--script", "x"]).ends(UNUSABLE);
}

#[test]
fn the_modes_and_the_matrices_of_a_cruise() {
    let csv = folder("linear").join("linear.csv");
    let cruise = ["linearize", "--nacelle", "0", "--speed-kt", "180", "--response", "--csv"];
    let all: Vec<&str> = cruise.into_iter().chain([text(&csv)]).collect();
    tiltrotor(&all).ends(OK).says("short period").says("phugoid").says("deg/s/in");
    let written = fs::read_to_string(&csv).expect("the matrices");
    assert!(written.contains("\nA,pitch_rad,pitch_rate_radps,"), "{}", &written[..200]);
    assert!(written.contains("\neigenvalue,0,re_per_s,-0."), "the slowest mode");
}

/// Ten actuators with one lag give repeated eigenvalues, on which iterations stand still.
#[test]
fn every_mode_with_the_scas_on_is_a_number() {
    let slow = ["linearize", "--nacelle", "90", "--speed-kt", "30", "--scas", "--fast"];
    let said = tiltrotor(&slow).ends(OK).says("SCAS washout");
    assert!(!said.out.contains("NaN"), "{}", said.out);
}

#[test]
fn what_has_no_steady_flight_is_not_linearised() {
    let csv = folder("not-linear").join("linear.csv");
    let slow = ["linearize", "--nacelle", "0", "--speed-kt", "40", "--csv", text(&csv)];
    tiltrotor(&slow).ends(NO_TRIM).says("no steady flight");
    assert!(!csv.exists());
}

#[test]
fn a_flight_that_begins_in_the_air_is_reflown_from_its_log_alone() {
    let place = folder("air");
    let (script, log) = (place.join("nothing.toml"), place.join("flight.mcap"));
    fs::write(&script, "").expect("a script");
    tiltrotor(&[
        "fly",
        "--from-trim",
        "--nacelle",
        "30",
        "--speed-kt",
        "120",
        "--script",
        text(&script),
        "--duration",
        "1",
        "--fast",
        "--no-flightgear",
        "--out",
        text(&log),
    ])
    .ends(OK);
    verify(&log).ends(OK).says("exact: all 250 ticks");
    tiltrotor(&["log", "info", text(&log)]).ends(OK);
}
