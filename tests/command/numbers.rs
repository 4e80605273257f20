//! Every number of every verb: what is none, or none of such an aircraft, is refused in a line that names
//! the option, the value, the unit and the range. Nothing panics, nothing is flown.

use std::collections::BTreeSet;
use std::path::Path;

use crate::common::{UNUSABLE, folder, hover, text, tiltrotor};

/// What no option takes.
const NEVER: [&str; 7] = ["nan", "inf", "-inf", "1e300", "-1e300", "-1e9", "fast"];

/// How options that take numbers call them in the help.
const NUMBERS: [&str; 13] = [
    "KT", "DEG", "FPM", "FT", "LB", "K", "RPM", "PERCENT", "DEGPS", "SECONDS", "N", "SPEED",
    "RADPS",
];

/// Verbs with an option that takes a number, by the help.
fn options(verb: &[&str]) -> Vec<(String, String)> {
    let help = tiltrotor(&[verb, &["--help"]].concat()).out;
    let option = |line: &str| {
        let (name, value) = line.trim_start().strip_prefix("--")?.split_once(" <")?;
        Some((format!("--{name}"), value.split('>').next()?.to_string()))
    };
    help.lines().filter_map(option).collect()
}

/// What each verb needs beside the option that is tried.
fn verbs(log: &str) -> Vec<(Vec<&'static str>, Vec<String>)> {
    let log = || vec![log.to_string()];
    let signals = ["--input", "stick_aft", "--output", "pitch_rate"];
    let from_trim = ["--from-trim", "--pilot", "hover", "--fast", "--out", "absent/flight.mcap"];
    vec![
        (vec!["fly"], from_trim.map(String::from).to_vec()),
        (vec!["demo"], vec![]),
        (vec!["replay"], log()),
        (vec!["verify"], log()),
        (vec!["diff"], [log(), log()].concat()),
        (vec!["view"], log()),
        (vec!["plot"], log()),
        (vec!["report"], log()),
        (vec!["whatif"], [log(), vec!["--fail".into(), "governor".into()]].concat()),
        (vec!["log", "info"], log()),
        (vec!["log", "cat"], log()),
        (vec!["log", "files"], log()),
        (vec!["log", "export"], log()),
        (vec!["log", "summary"], log()),
        (vec!["log", "clip"], log()),
        (vec!["log", "compact"], log()),
        (vec!["log", "expand"], log()),
        (vec!["log", "recover"], log()),
        (vec!["devices"], vec![]),
        (vec!["doctor"], vec![]),
        (vec!["flightgear"], vec!["--print".into()]),
        (vec!["trim"], vec![]),
        (vec!["linearize"], vec![]),
        (vec!["identify"], [log(), signals.map(String::from).to_vec()].concat()),
    ]
}

#[test]
fn every_number_has_a_range_and_a_unit() {
    let log = folder("numbers").join("flight.mcap");
    hover(&log, "0.1");
    let mut tried = BTreeSet::new();
    for (verb, needed) in verbs(text(&log)) {
        for (option, value) in options(&verb) {
            if !NUMBERS.contains(&value.as_str()) {
                continue;
            }
            tried.insert(format!("{} {option}", verb.join(" ")));
            for never in NEVER {
                let around = if option == "--window" { &["--around", "5t"][..] } else { &[] };
                let mut arguments = verb.clone();
                arguments.extend(needed.iter().map(String::as_str));
                arguments.extend(around);
                let both = format!("{option}={never}");
                arguments.push(&both);
                let said = tiltrotor(&arguments).ends(UNUSABLE);
                assert!(said.err.starts_with(&format!("tiltrotor: {option} {never}: ")), "{said}");
                let counted = ["--jobs", "--every"].contains(&option.as_str());
                assert!(counted || said.err.contains("expected "), "{said}");
                assert_eq!((said.err.lines().count(), said.out.as_str()), (1, ""), "{said}");
            }
        }
    }
    // The help was read right: these are known to be among them.
    for known in ["fly --duration", "fly --speed-kt", "trim --bank-deg", "linearize --isa-k"] {
        assert!(tried.contains(known), "{known} in {tried:?}");
    }
    for known in ["replay --speed", "verify --window", "log compact --keyframes", "log cat --every"]
    {
        assert!(tried.contains(known), "{known} in {tried:?}");
    }
    assert!(!Path::new("absent").exists());
}

#[test]
fn a_negative_number_is_a_number_and_no_option() {
    for option in ["--speed-kt", "--weight-lb", "--flap", "--rpm", "--lever", "--height-ft"] {
        let said = tiltrotor(&["trim", option, "-1e9"]).refused();
        assert!(said.err.starts_with(&format!("tiltrotor: {option} -1e9: expected ")), "{said}");
    }
    for sweep in ["-1e9:0:1", "0:1e9:1e6", "0:nan:1", "0:10:-1", "0:10:0", "inf:inf:1"] {
        tiltrotor(&["trim", "--sweep", sweep]).refused().says("--sweep ").says("expected ");
    }
    for moment in ["-1", "nan", "inf", "1e300", "-1t"] {
        tiltrotor(&["log", "cat", "absent.mcap", "--from", moment]).refused().says("--from ");
    }
}

#[test]
fn a_part_of_a_log_is_named() {
    let log = folder("numbers-part").join("flight.mcap");
    hover(&log, "0.1");
    tiltrotor(&["log", "clip", text(&log)]).refused().says("give --from, --until or --around");
}
