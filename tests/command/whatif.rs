//! What would have been in another world: weather and failures set and taken away, beside a baseline.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::common::{
    self, Forgery, OK, UNUSABLE, flip_state_bit, folder, hover, text, tiltrotor, verify,
};

/// Six seconds in which the yaw SCAS fails, and a gust comes.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let place = folder("whatif");
        let (log, script) = (place.join("flight.mcap"), place.join("script.toml"));
        let events = "[[event]]\nat_s = 2\nfail = [\"scas_yaw\"]\n\
                      [[event]]\nat_s = 3\ngust = { east_mps = 6, s = 1 }\n";
        fs::write(&script, events).expect("a script");
        let air = ["--from-trim", "--nacelle", "60", "--speed-kt", "110", "--altitude-ft", "2000"];
        let flight =
            ["fly", "--fast", "--duration", "6", "--script", text(&script), "--out", text(&log)];
        tiltrotor(&[&flight[..], &air].concat()).ends(OK);
        log
    })
}

/// The what-if of these changes, and its log.
fn whatif(name: &str, changes: &[&str]) -> (common::Said, PathBuf) {
    let out = flight().with_file_name(format!("{name}.mcap"));
    let flown = ["whatif", text(flight()), "--force", "--out", text(&out)];
    (tiltrotor(&[&flown[..], changes].concat()), out)
}

const EXACT: &str =
    "baseline: flown unchanged, the recorded inputs give the recorded states, to the bit";

#[test]
fn a_failure_is_taken_away_and_another_set() {
    let (said, log) = whatif("mended", &["--mend", "scas_yaw", "--from", "1"]);
    said.ends(OK).says("mend scas_yaw").says(EXACT).says("apart from 2.");
    verify(&log).ends(OK);
    let info = tiltrotor(&["log", "info", text(&log)]).ends(OK).never_says("failed: SCAS yaw");
    assert_eq!(info.after("changes "), "mend scas_yaw");
    let (said, log) = whatif("failed", &["--fail", "engine_left", "--from", "4.5"]);
    said.ends(OK).says(EXACT).says("apart from 4.504 s on");
    verify(&log).ends(OK);
    tiltrotor(&["log", "info", text(&log)]).ends(OK).says("left engine");
}

#[test]
fn weather_is_taken_away_and_set_from_a_moment_on() {
    let (said, log) = whatif("calm", &["--world", "gust_s=0"]);
    said.ends(OK).says("world gust_s = 0").says(EXACT).says("apart from 3.");
    verify(&log).ends(OK);
    let windy = ["--world", "wind_mps.x=-5", "--world", "temperature_offset_k=20", "--from", "1"];
    let (said, log) = whatif("windy", &windy);
    said.ends(OK).says("apart from 1.004 s on");
    verify(&log).ends(OK);
    let gusty =
        ["--world", "gust_mps.z=-6", "--world", "gust_s=1", "--from", "1.5", "--until", "2.5"];
    let (said, log) = whatif("gusty", &gusty);
    said.ends(OK).says("apart from 1.5");
    verify(&log).ends(OK);
    // What is as it was makes no difference.
    let (said, _) = whatif("same", &["--world", "turbulence_mps=0", "--mend", "governor"]);
    said.ends(OK).says("it makes no difference: every state is the recorded one, to the bit");
}

#[test]
fn keys_are_listed_with_values_and_suggested() {
    let list = tiltrotor(&["whatif", text(flight()), "--list", "--from", "3.5"]).ends(OK);
    list.says("gust_mps.y = 6 ")
        .says("turbulence_mps = 0 ")
        .says("m/s")
        .says("rotors.mast_length_ft = 4.667");
    let list = tiltrotor(&["whatif", text(flight()), "--list", "--from", "3.5"]).ends(OK);
    assert!(list.after("scas_yaw ").starts_with("failed "), "{list}");
    assert!(list.after("governor ").starts_with("works "), "{list}");
    whatif("no", &["--fail", "scas_jaw"]).0.refused().says("did you mean scas_yaw");
    whatif("no", &["--mend", "scas-yaw"]).0.refused().says("did you mean scas_yaw");
    whatif("no", &["--world", "turbulense_mps=1"]).0.refused().says("did you mean turbulence_mps");
    whatif("no", &["--world", "turbulence_mps=nan"]).0.refused().says("expected 0 to 15 m/s");
    let (said, log) = whatif("no", &[]);
    said.ends(UNUSABLE).says("--mend");
    assert!(!log.exists());
}

#[test]
fn what_is_not_by_the_change_alone_is_told() {
    let place = folder("whatif-baseline");
    let (log, changed) = (place.join("flight.mcap"), place.join("changed.mcap"));
    hover(&log, "2");
    let mut forgery = Forgery::of(&log);
    flip_state_bit(&mut forgery, 300, "plant.velocity_mps.x");
    forgery.write(&changed);
    let out = place.join("new.mcap");
    tiltrotor(&["whatif", text(&changed), "--fail", "governor", "--out", text(&out)])
        .says("tick 300")
        .never_says(EXACT);
}

#[test]
fn the_files_of_a_log_are_listed_and_printed() {
    let list = tiltrotor(&["log", "files", text(flight())]).ends(OK);
    list.says(": 3 files").says("aircraft.toml").says("cockpit.toml").says("scenario.toml");
    let print = |name: &str| tiltrotor(&["log", "files", text(flight()), "--extract", name]);
    assert_eq!(print("aircraft.toml").ends(OK).out, include_str!("../../aircraft/xv15.toml"));
    print("aircaft.toml").refused().says("did you mean aircraft.toml");
    print("quux").refused().says("there is aircraft.toml, ");
    let compact = flight().with_file_name("compact.mcap");
    tiltrotor(&["log", "compact", text(flight()), "--force", "--out", text(&compact)]).ends(OK);
    let of_compact = tiltrotor(&["log", "files", text(&compact), "--extract", "aircraft.toml"]);
    assert_eq!(of_compact.ends(OK).out, include_str!("../../aircraft/xv15.toml"));
}

#[test]
fn the_fields_of_a_log_are_listed_by_channel_and_by_name() {
    let list = |wanted: &[&str]| {
        tiltrotor(&[&["log", "fields", text(flight())], wanted].concat()).ends(OK)
    };
    // Six seconds are 1500 ticks; how one kept time is eleven numbers.
    let timing = list(&["--channel", "timing"]);
    assert!(timing.out.starts_with("/timing: 1500 messages of 11 numbers\n"), "{timing}");
    assert_eq!(timing.out.lines().count(), 12, "{timing}");
    for glob in ["/timing", "tim*", "/timin?"] {
        assert_eq!(list(&["--channel", glob]).out, timing.out, "{glob}");
    }
    let late = list(&["--field", "late_*"]);
    assert_eq!(late.out.lines().count(), 2, "{late}");
    assert_eq!(late.out.lines().next(), timing.out.lines().next());
    late.says("  late_ns ").says("Woke up later than wanted by.");
    let both = list(&["--channel", "timing", "--channel", "log"]);
    assert!(both.out.contains(timing.out.as_str()), "{both}");
    both.says("/log: ").says(" messages of text or for viewers").never_says("/state");
    let all = list(&[]);
    assert!(all.out.contains(timing.out.as_str()), "{all}");
    // The state of the beginning, and one after every tick.
    all.says("/state: 1501 messages of ").says("/log: ").says("/inputs: 1500 messages of ");
    let json = list(&["--channel", "timing", "--format", "json"]);
    assert_eq!(json.out.matches("\"channel\": \"/timing\"").count(), 11, "{json}");
    for nothing in [["--channel", "timings"], ["--field", "latte_ns"]] {
        let none = tiltrotor(&[&["log", "fields", text(flight())], &nothing[..]].concat());
        none.refused().says("no such channel or field in it; its channels are ").says("/timing");
    }
}

#[test]
fn the_version_names_the_commit() {
    tiltrotor(&["--version"]).ends(OK).says(concat!(env!("CARGO_PKG_VERSION"), " (commit "));
}
