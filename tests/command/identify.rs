//! What is identified from a flown sweep is what the linearised model says, by the command from end to end.

use std::fs;

use analysis::Polar;
use analysis::linearize::{INPUTS, OUTPUTS, decibels, linearize};
use analysis::trim::{Target, trim};
use engine::units::{DEG_PER_RAD as DEG, FOOT_M, INCH_M, KNOT_MPS};

use crate::common::{OK, folder, text, tiltrotor};

/// A pilot model's sweep from a steady flight, and what is asked of it.
struct Sweep {
    name: &'static str,
    pilot: &'static str,
    start: &'static [&'static str],
    target: Target,
    input: usize,
    output: usize,
}

/// Where the coherence is over this, gain and phase are those of `linearize`.
const COHERENCE: f64 = 0.8;
/// Gain, dB, and phase, deg: what the specification asks.
const GAIN_DB: f64 = 1.0;
const PHASE_DEG: f64 = 5.0;

/// Flies, identifies, and compares; returns how many frequencies were compared.
fn compare(sweep: &Sweep) -> usize {
    let place = folder(&format!("identify-{}", sweep.name));
    let (log, table) = (place.join("sweep.mcap"), place.join("response.csv"));
    let mut fly = vec!["fly", "--pilot", sweep.pilot, "--fast", "--from-trim", "--scas-off"];
    fly.extend_from_slice(sweep.start);
    fly.extend(["--no-flightgear", "--out", text(&log)]);
    tiltrotor(&fly).ends(OK);
    let (input, output) = (INPUTS[sweep.input], OUTPUTS[sweep.output]);
    let identify = ["identify", text(&log), "--input", input, "--output", output];
    tiltrotor(&[&identify[..], &["--csv", text(&table)]].concat()).ends(OK);

    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
    let steady = trim(&aircraft, &sweep.target).expect("a steady flight");
    let linear = linearize(&aircraft, &steady, &sweep.target.world);
    let (mut compared, mut wrong) = (0, String::new());
    for line in fs::read_to_string(&table).expect("a table").lines().skip(1) {
        let numbers: Vec<f64> =
            line.split(',').take(4).map(|number| number.parse().expect(line)).collect();
        let [omega, gain_db, phase_deg, coherence] = numbers[..] else { panic!("{line}") };
        if coherence < COHERENCE {
            continue;
        }
        compared += 1;
        let expected = linear.response(sweep.input, sweep.output, omega).expect("a response");
        let off_db = gain_db - decibels(expected.magnitude() * DEG * INCH_M);
        let off_deg = (phase_deg - expected.phase_rad() * DEG + 540.0).rem_euclid(360.0) - 180.0;
        if off_db.abs() > GAIN_DB || off_deg.abs() > PHASE_DEG {
            wrong += &format!(
                "{omega:.3} rad/s: {off_db:+.2} dB, {off_deg:+.1} deg off at a coherence of {coherence:.3}\n"
            );
        }
    }
    assert!(wrong.is_empty(), "{}:\n{wrong}", sweep.name);
    fs::remove_dir_all(place).expect("our own folder");
    compared
}

fn at(mast_tilt_rad: f64, speed_kt: f64, flap_detent: u64, rpm_select: u64) -> Target {
    Target {
        mast_tilt_rad,
        airspeed_mps: speed_kt * KNOT_MPS,
        altitude_m: 1000.0 * FOOT_M,
        flap_detent,
        rpm_select,
        ..Target::default()
    }
}

#[test]
fn a_pitch_sweep_in_hover_gives_the_response_of_the_linearised_model() {
    let compared = compare(&Sweep {
        name: "hover",
        pilot: "sweep-pitch",
        start: &[],
        target: at(0.0, 0.0, 2, 0),
        input: 0,
        output: 4,
    });
    assert!(compared >= 15, "{compared} frequencies with enough coherence");
}

#[test]
fn a_pitch_sweep_as_an_aeroplane_gives_the_response_of_the_linearised_model() {
    let compared = compare(&Sweep {
        name: "aeroplane",
        pilot: "sweep-pitch",
        start: &["--nacelle", "0", "--speed-kt", "180"],
        target: at(engine::math::FRAC_PI_2, 180.0, 0, 2),
        input: 0,
        output: 4,
    });
    assert!(compared >= 15, "{compared} frequencies with enough coherence");
}

#[test]
fn a_flight_without_a_sweep_is_refused_in_words() {
    let place = folder("identify-none");
    let log = place.join("hover.mcap");
    let hover = ["fly", "--pilot", "hover", "--fast", "--duration", "12", "--from-trim"];
    tiltrotor(&[&hover[..], &["--no-flightgear", "--out", text(&log)]].concat()).ends(OK);
    let asked = |more: &[&str]| {
        let of = ["identify", text(&log), "--output", "pitch_rate"];
        tiltrotor(&[&of[..], more].concat()).refused()
    };
    asked(&["--input", "stick_aft", "--low", "0.3"])
        .says("the record is too short: 12 s, and 0.30 rad/s takes 251 s");
    asked(&["--input", "stick_right", "--low", "7"]).says("the input does not move");
    asked(&["--input", "throttle"]).says("`throttle` is no signal: there are stick_aft");

    // A stick that goes slowly to one side and back moves, but not seven times a second.
    let (script, slow) = (place.join("slow.toml"), place.join("slow.mcap"));
    let to = |at_s: f64, norm: f64| {
        format!("[[event]]\nat_s = {at_s:.1}\nover_s = 5.0\naxis = {{ stick_right = {norm} }}\n")
    };
    fs::write(&script, to(1.0, 0.1) + &to(6.0, -0.1)).expect("a script");
    let fly = ["fly", "--script", text(&script), "--fast", "--duration", "12"];
    tiltrotor(&[&fly[..], &["--no-flightgear", "--out", text(&slow)]].concat()).ends(OK);
    let of = ["identify", text(&slow), "--output", "roll_rate", "--input", "stick_right"];
    tiltrotor(&[&of[..], &["--low", "7"]].concat())
        .refused()
        .says("the input is not swept between 7.00 and 12.00 rad/s");
    fs::remove_dir_all(place).expect("our own folder");
}
