//! Many logs: folders, shards, threads, and reports for CI servers.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use quick_junit::{NonSuccessKind, Report, TestCaseStatus};

use crate::common::{
    DIVERGED, Forgery, INCOMPLETE, OK, UNUSABLE, flip_state_bit, folder, hover, text, tiltrotor,
};

/// Names that a shell, a path or an XML file could stumble over.
const NAMES: [&str; 5] =
    ["a.mcap", "below/b & <c>.mcap", "below/further/\"quoted\" 'd'.mcap", "é.mcap", "z.mcap"];

/// A second by the pilot model.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("corpus-flight").join("flight.mcap");
        hover(&log, "1");
        log
    })
}

/// A folder of logs, all exact, and something that is none.
fn corpus(name: &str) -> PathBuf {
    let place = folder(name);
    for name in NAMES {
        let log = place.join(name);
        fs::create_dir_all(log.parent().expect("a folder")).expect("a folder");
        fs::copy(flight(), log).expect("a copy");
    }
    fs::write(place.join("notes.txt"), "no log").expect("a file");
    place
}

/// The same, with one log of every other kind.
fn mixed(name: &str) -> PathBuf {
    let place = corpus(name);
    let mut forgery = Forgery::of(flight());
    flip_state_bit(&mut forgery, 100, "plant.fuel_kg");
    forgery.write(&place.join("altered.mcap"));
    let whole = fs::read(flight()).expect("a log");
    fs::write(place.join("cut.mcap"), &whole[..whole.len() * 4 / 5]).expect("a file");
    fs::write(place.join("foreign.mcap"), "no log, but a good hundred bytes of it")
        .expect("a file");
    place
}

/// The logs that a run verified, as they stand in its report.
fn verified(arguments: &[&str]) -> Vec<String> {
    let said = tiltrotor(&[&["verify", "--format", "json"], arguments].concat());
    let report: serde_json::Value =
        serde_json::from_str(&said.out).unwrap_or_else(|why| panic!("{why}: {said}"));
    let logs = report["logs"].as_array().expect("logs").iter();
    logs.map(|log| log["log"].as_str().expect("a path").to_string()).collect()
}

#[test]
fn a_folder_is_every_log_in_it_and_below() {
    let place = corpus("corpus-folder");
    let found: BTreeSet<_> = verified(&[text(&place)]).into_iter().collect();
    let expected: BTreeSet<_> =
        NAMES.iter().map(|name| text(&place.join(name)).to_string()).collect();
    assert_eq!(found, expected);
}

#[test]
fn the_shards_together_are_the_whole_and_no_log_is_in_two() {
    let place = corpus("corpus-shards");
    let whole = verified(&[text(&place)]);
    for of in 1..=7 {
        let mut sum = Vec::new();
        for number in 1..=of {
            sum.extend(verified(&[text(&place), "--shard", &format!("{number}/{of}")]));
        }
        sum.sort();
        let mut sorted = whole.clone();
        sorted.sort();
        assert_eq!(sum, sorted, "in {of} shards");
    }
}

#[test]
fn a_log_named_twice_is_verified_once() {
    let place = corpus("corpus-twice");
    let again = place.join("below/../a.mcap");
    assert_eq!(verified(&[text(&place), text(&place.join("a.mcap")), text(&again)]).len(), 5);
}

#[test]
fn the_report_is_the_same_whatever_the_number_of_threads() {
    let place = mixed("corpus-threads");
    let said = |jobs: &str| {
        let said = tiltrotor(&["verify", text(&place), "--jobs", jobs]).ends(UNUSABLE);
        // All but how long it took, and what that comes to.
        let timeless = |line: &&str| !line.contains("times real time");
        said.out.lines().filter(timeless).map(String::from).collect::<Vec<_>>()
    };
    assert_eq!(said("1"), said("3"));
}

#[test]
fn of_several_logs_the_gravest_decides() {
    let place = mixed("corpus-gravest");
    let log = |name: &str| place.join(name);
    let verify = |names: &[&str]| {
        let logs: Vec<PathBuf> = names.iter().map(|name| log(name)).collect();
        let logs: Vec<&str> = logs.iter().map(|log| text(log)).collect();
        tiltrotor(&[&["verify"], &logs[..]].concat())
    };
    verify(&["a.mcap", "z.mcap"]).ends(OK).says("2 logs: 2 exact");
    verify(&["a.mcap", "cut.mcap"]).ends(INCOMPLETE).says("1 exact, 1 never closed");
    verify(&["cut.mcap", "altered.mcap", "a.mcap"]).ends(DIVERGED);
    verify(&["altered.mcap", "foreign.mcap", "cut.mcap"]).ends(UNUSABLE);
    verify(&["a.mcap", "missing.mcap"]).ends(UNUSABLE).says("exact: all 250 ticks");
}

#[test]
fn nothing_to_verify_does_not_look_like_all_is_well() {
    let empty = folder("corpus-empty");
    tiltrotor(&["verify", text(&empty)]).refused().says("no *.mcap in this folder");
    let log = text(flight());
    for shard in ["0/2", "3/2", "1", "one/two"] {
        tiltrotor(&["verify", log, "--shard", shard]).ends(UNUSABLE).says("expected I/N");
    }
    tiltrotor(&["verify", log, "--jobs", "0"]).ends(UNUSABLE);
    // More shards than logs is no mistake of whoever has the last one.
    tiltrotor(&["verify", log, "--shard", "2/2"]).ends(OK).says("0 logs of shard 2/2");
}

#[test]
fn a_pipe_gets_no_progress() {
    let place = corpus("corpus-quiet");
    let said = tiltrotor(&["verify", text(&place)]).ends(OK);
    assert_eq!(said.err, "");
    assert!(!said.out.contains('\u{1b}') && !said.out.contains('\r'), "{said}");
}

#[test]
fn a_ci_server_reads_which_logs_failed_and_why() {
    let place = mixed("corpus-junit");
    let said = tiltrotor(&["verify", text(&place), "--format", "junit"]).ends(UNUSABLE);
    let report = Report::deserialize_from_str(&said.out).expect("a report");
    let cases = &report.test_suites[0].test_cases;
    assert_eq!(cases.len(), NAMES.len() + 3, "{said}");
    for name in NAMES {
        let path = text(&place.join(name)).to_string();
        let case = cases.iter().find(|case| case.name.as_str() == path);
        let case = case.unwrap_or_else(|| panic!("{path} in {said}"));
        assert!(matches!(case.status, TestCaseStatus::Success { .. }), "{said}");
    }
    let failed = [
        ("altered.mcap", NonSuccessKind::Failure, "altered", "plant.fuel_kg"),
        ("cut.mcap", NonSuccessKind::Failure, "never_closed", "without having been closed"),
        ("foreign.mcap", NonSuccessKind::Error, "unusable", "not a flight log"),
    ];
    for (name, expected, word, why) in failed {
        let case = cases.iter().find(|case| case.name.as_str().ends_with(name)).expect(name);
        let TestCaseStatus::NonSuccess { kind, ty, message, description, .. } = &case.status else {
            panic!("{name} passed: {said}");
        };
        assert_eq!(*kind, expected, "{name}");
        assert_eq!(ty.as_ref().map(quick_junit::XmlString::as_str), Some(word), "{name}");
        let description = description.as_ref().map_or("", |text| text.as_str());
        assert!(description.contains(why), "{name}: {description}");
        let message = message.as_ref().map_or("", |text| text.as_str());
        assert!(description.starts_with(message) && !message.is_empty(), "{name}: {message}");
        assert!(!message.contains("as its writer closed it"), "{name}: {message}");
    }
}
