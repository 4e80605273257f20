//! Recorded inputs flown again: from the middle, with something changed, as a part, compacted.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use logs::OpenOptions;
use logs::records::{STATE, StateRecord};

use crate::common::{
    DIVERGED, Dice, Forgery, INCOMPLETE, OK, Said, UNUSABLE, flip_state_bit, folder, hover, text,
    tiltrotor, verify,
};

/// A demonstration flight of thirty seconds: start, lift-off, hover.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("reflight").join("flight.mcap");
        hover(&log, "30");
        log
    })
}

/// A second's script with two markers.
fn marked() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let place = folder("reflight-marked");
        let (script, log) = (place.join("script.toml"), place.join("marked.mcap"));
        let events = "[[event]]\nat_s = 3.0\npress = [\"marker\"]\n\n[[event]]\nat_s = 5.0\n\
                      press = [\"marker\"]\nfail = [\"engine_left\"]\n\n[[event]]\nat_s = 8.0\nend = true\n";
        fs::write(&script, events).expect("a script");
        let (script, out) = (text(&script), text(&log));
        tiltrotor(&["fly", "--script", script, "--fast", "--no-flightgear", "--out", out]).ends(OK);
        log
    })
}

fn compacted(log: &Path, name: &str) -> PathBuf {
    let out = folder(&format!("reflight-compact-{name}")).join("compact.mcap");
    tiltrotor(&["log", "compact", text(log), "--out", text(&out)]).ends(OK);
    out
}

/// The states of a log from a tick on, as they are read.
fn states(log: &Path, from: u64, until: u64) -> Vec<StateRecord> {
    let mut reader = logs::open(log, replay::OPEN).expect("a log");
    reader.seek(from).expect("a tick of it");
    reader.until_tick = Some(until);
    let mut states = Vec::new();
    while let Some(tick) = reader.next_tick().expect("a tick") {
        assert!(tick.chained, "tick {}", tick.record.state.tick);
        states.push(tick.record);
    }
    states
}

#[test]
fn any_tick_is_a_start_and_the_flight_from_there_is_the_same() {
    let compact = compacted(flight(), "anywhere");
    let whole = states(flight(), 0, u64::MAX);
    assert_eq!(whole.len(), 7500);
    let mut dice = Dice(11);
    let mut ticks: Vec<_> = (0..8).map(|_| 1 + dice.below(7400)).collect();
    // Around keyframes, and at the ends.
    ticks.extend([1, 499, 500, 501, 1000, 7499]);
    for tick in ticks {
        let until = (tick + 60).min(7500);
        let part = &whole[tick as usize..until as usize];
        for log in [flight(), &compact] {
            assert!(states(log, tick, until) == part, "{} from {tick}", log.display());
        }
        let mut from = logs::open(flight(), replay::OPEN).expect("a log");
        from.seek(tick).expect("a tick of it");
        assert!(from.initial == whole[tick as usize - 1].state, "the state of tick {tick}");
    }
}

#[test]
fn a_window_verifies_by_time_by_tick_and_around_a_marker() {
    let log = text(marked());
    for log in [log, text(&compacted(marked(), "window"))] {
        let around = ["verify", log, "--around", "marker:2", "--window", "1"];
        tiltrotor(&around)
            .ends(OK)
            .says("exact: all 500 ticks (2.0 s) from tick 1001 (4.004 s) on");
        tiltrotor(&["verify", log, "--from", "2.5", "--until", "900t"])
            .ends(OK)
            .says("exact: all 275 ticks (1.1 s) from tick 625 (2.500 s) on");
        // There is less before a marker than was asked for.
        tiltrotor(&["verify", log, "--around", "marker:1", "--window", "4"]).ends(OK);
        tiltrotor(&["verify", log, "--around", "marker:3"])
            .ends(UNUSABLE)
            .says("no marker:3 in the log; there is marker:1 at tick 751 (3.004 s), marker:2 at");
        tiltrotor(&["verify", log, "--from", "9"]).ends(UNUSABLE).says(
            "tick 2250 (9.000 s) is not in the log, which goes from tick 0 (0.000 s) to tick 2001",
        );
        let cat = ["log", "cat", log, "--topic", "/state", "--from", "3", "--until", "3.1"];
        let said = tiltrotor(&cat).ends(OK);
        assert_eq!(said.out.lines().count(), 26, "{said}");
        assert!(said.out.starts_with("{\"topic\":\"/state\",\"time_ns\":3000000000,"), "{said}");
    }
}

#[test]
fn a_changed_bit_in_the_window_is_found_and_one_before_it_is_not() {
    let mut forgery = Forgery::of(flight());
    flip_state_bit(&mut forgery, 3000, "plant.velocity_mps.x");
    let log = folder("reflight-forged").join("forged.mcap");
    forgery.write(&log);
    tiltrotor(&["verify", text(&log), "--from", "2990t", "--until", "3010t"])
        .ends(DIVERGED)
        .says("tick 3000 (12.000 s)");
    tiltrotor(&["verify", text(&log), "--from", "3001t", "--until", "3100t"]).ends(OK);
}

#[test]
fn a_log_that_was_never_closed_is_read_from_the_middle_too() {
    let log = folder("reflight-cut").join("cut.mcap");
    let bytes = fs::read(flight()).expect("a log");
    fs::write(&log, &bytes[..bytes.len() / 2]).expect("a file");
    tiltrotor(&["verify", text(&log), "--from", "2", "--until", "4"])
        .ends(OK)
        .says("exact: all 500 ticks");
    tiltrotor(&["verify", text(&log), "--from", "2"]).ends(INCOMPLETE);
    tiltrotor(&["log", "compact", text(&log)]).ends(UNUSABLE).says("without having been closed");
}

#[test]
fn a_log_is_compacted_and_expanded_to_the_same_bytes() {
    for (name, log) in [("hover", flight()), ("marked", marked())] {
        let compact = compacted(log, &format!("bytes-{name}"));
        let before = fs::metadata(log).expect("a log").len();
        let after = fs::metadata(&compact).expect("a log").len();
        assert!(after * 5 < before, "{after} of {before} bytes");
        let out = compact.with_file_name("expanded.mcap");
        tiltrotor(&["log", "expand", text(&compact), "--out", text(&out)])
            .ends(OK)
            .says("byte for byte");
        assert!(fs::read(&out).expect("a log") == fs::read(log).expect("a log"), "{name}");
    }
}

#[test]
fn a_log_that_another_program_put_together_keeps_every_message() {
    let place = folder("reflight-foreign");
    let (log, compact, out) =
        (place.join("copy.mcap"), place.join("compact.mcap"), place.join("expanded.mcap"));
    Forgery::of(marked()).write(&log);
    tiltrotor(&["log", "compact", text(&log), "--out", text(&compact)]).ends(OK);
    tiltrotor(&["log", "expand", text(&compact), "--out", text(&out)])
        .ends(OK)
        .says("every message is there, in order");
    let messages = |log: &Path| {
        let of =
            |m: mcap::Message<'static>| (m.channel.topic.clone(), m.log_time, m.sequence, m.data);
        Forgery::of(log).messages.into_iter().map(of).collect::<Vec<_>>()
    };
    assert!(messages(&out) == messages(&log));
    verify(&out).ends(OK);
}

#[test]
fn a_compacted_log_is_taken_for_the_log_it_was() {
    let compact = compacted(flight(), "taken");
    let (a, b) = (text(flight()), text(&compact));
    verify(&compact).ends(OK).says("exact: all 7500 ticks (30.0 s)");
    let cat = |log| tiltrotor(&["log", "cat", log]).ends(OK).out;
    assert!(cat(a) == cat(b), "log cat");
    let info = |log| {
        let said = tiltrotor(&["log", "info", log]).ends(OK).out;
        let lines = said.lines().skip(1).filter(|line| !line.contains("  compacted "));
        lines.map(str::to_string).collect::<Vec<_>>()
    };
    assert_eq!(info(a), info(b));
    let summary = |log| {
        let said = tiltrotor(&["log", "summary", log]).ends(OK).out;
        said.split_once(": ").expect("a name").1.to_string()
    };
    assert_eq!(summary(a), summary(b));
    let error =
        logs::open(&compact, OpenOptions::default()).err().expect("the states are not in it");
    assert!(error.to_string().contains("log expand"), "{error}");
}

#[test]
fn a_compacted_log_that_was_changed_is_found_out() {
    let compact = compacted(marked(), "changed");
    let whole = fs::read(&compact).expect("a log");
    let place = folder("reflight-changed");
    let log = place.join("changed.mcap");
    // Bits of the file.
    let mut dice = Dice(3);
    for _ in 0..40 {
        let mut damaged = whole.clone();
        let at = dice.below(damaged.len() as u64) as usize;
        damaged[at] ^= 1 << dice.below(8);
        fs::write(&log, &damaged).expect("a file");
        let said = verify(&log);
        assert_ne!(said.status, Some(OK), "byte {at}: {said}");
        let out = place.join("expanded.mcap");
        let said = tiltrotor(&["log", "expand", text(&log), "--force", "--out", text(&out)]);
        assert_ne!(said.status, Some(OK), "byte {at}: {said}");
    }
    // The file cut short: exact as far as it goes, or unusable.
    for part in [3, 5, 7, 9] {
        fs::write(&log, &whole[..whole.len() * part / 10]).expect("a file");
        let said = verify(&log);
        assert!(matches!(said.status, Some(INCOMPLETE | UNUSABLE)), "{said}");
    }
    // A keyframe changed by a tool that makes all checksums right again.
    let mut forgery = Forgery::of(&compact);
    let keyframes = forgery.places(STATE).len();
    assert_eq!(keyframes, 6, "the start, every two seconds, the end");
    flip_state_bit(&mut forgery, 2, "plant.fuel_kg");
    forgery.write(&log);
    verify(&log).ends(DIVERGED).says("tick 1000 (4.000 s)").says("plant.fuel_kg");
    // And a digest of a state that was not kept.
    let mut forgery = Forgery::of(&compact);
    let block = forgery.places("/compact")[2];
    let data = forgery.messages[block].data.to_mut();
    let end = data.len() - 200;
    data[end] ^= 1;
    forgery.write(&log);
    assert_ne!(verify(&log).status, Some(OK));
}

#[test]
fn a_log_that_does_not_refly_is_not_compacted() {
    let mut forgery = Forgery::of(marked());
    flip_state_bit(&mut forgery, 777, "plant.position_m.x");
    let log = folder("reflight-not").join("forged.mcap");
    forgery.write(&log);
    tiltrotor(&["log", "compact", text(&log)])
        .ends(UNUSABLE)
        .says("not compacted: altered at tick 777 (3.108 s)");
    assert!(!log.with_file_name("forged-compact.mcap").exists());
    tiltrotor(&["log", "clip", text(&log), "--from", "3"])
        .ends(UNUSABLE)
        .says("not cut: altered at tick 777 (3.108 s)");
    assert!(!log.with_file_name("forged-clip.mcap").exists());
}

#[test]
fn a_compacted_log_of_another_model_is_refused_by_name() {
    let mut forgery = Forgery::of(&compacted(marked(), "version"));
    for record in &mut forgery.metadata {
        if let Some(version) = record.metadata.get_mut("model_version") {
            *version = "1850".into();
        }
    }
    let log = folder("reflight-version").join("old.mcap");
    forgery.write(&log);
    let refused = |said: Said| said.ends(UNUSABLE).says("flight model is version 1850");
    refused(verify(&log));
    refused(tiltrotor(&["log", "expand", text(&log), "--force"]));
    refused(tiltrotor(&["log", "info", text(&log)]));
}

#[test]
fn a_part_of_a_log_is_a_log_that_names_its_parent() {
    let out = folder("reflight-part").join("part.mcap");
    let part = ["log", "clip", text(marked()), "--around", "marker:2", "--window", "1"];
    tiltrotor(&[&part[..], &["--out", text(&out)]].concat()).ends(OK).says("500 ticks");
    verify(&out).ends(OK).says("from tick 1001 (4.004 s) on");
    let info =
        tiltrotor(&["log", "info", text(&out)]).ends(OK).says("marker 2").says("left engine");
    let parent = tiltrotor(&["log", "info", text(marked())]).ends(OK);
    assert_eq!(info.after("parent "), "marked.mcap");
    assert_eq!(info.after("parent_digest "), parent.after("digest "));
    assert_eq!(info.after("parent_from_tick "), "1001");
    assert_ne!(info.after("digest "), parent.after("digest "), "a chain of its own");
    let whole = states(marked(), 1001, 1501);
    let part = states(&out, 1001, u64::MAX);
    assert!(whole.iter().map(|s| s.state).eq(part.iter().map(|s| s.state)), "the same states");
    // A part of the part, by the parent's time, and by the name that the verb had.
    let smaller = out.with_file_name("smaller.mcap");
    let trim = ["log", "trim", text(&out), "--from", "4.5", "--until", "5", "--out"];
    tiltrotor(&[&trim[..], &[text(&smaller)]].concat()).ends(OK).says("125 ticks");
    verify(&smaller).ends(OK);
}

#[test]
fn what_if_flies_the_same_hands_on_another_aircraft() {
    let place = folder("reflight-whatif");
    let out = place.join("new.mcap");
    let set = ["--set", "fcc.travel.collective_in=9.5", "--set", "fcc.travel.pedal_in = 2"];
    let whatif = ["whatif", text(flight()), "--from", "12", "--out", text(&out)];
    tiltrotor(&[&whatif[..], &set[..]].concat())
        .ends(OK)
        .says("fcc.travel.collective_in = 9.5 (was ")
        .says("; fcc.travel.pedal_in = 2 (was ")
        .says("apart from 12.");
    verify(&out).ends(OK).says("from tick 3000 (12.000 s) on");
    let info = tiltrotor(&["log", "info", text(&out)]).ends(OK);
    assert_eq!(info.after("parent "), "flight.mcap");
    assert_eq!(info.after("made_by "), "whatif");
    assert_eq!(info.after("parent_from_tick "), "3000");
    assert!(info.out.contains("pilot model "), "its inputs are the pilot's: {info}");
    let (was, is) = (states(flight(), 3000, 7500), states(&out, 3000, 7500));
    assert_eq!(was.len(), is.len());
    assert_eq!(is[0].state.tick, 3001, "the parent's time");
    assert!(was.iter().zip(&is).any(|(was, is)| was.state != is.state));
    let reader = logs::open(&out, replay::OPEN).expect("a log");
    let same = logs::open(flight(), replay::OPEN).map(|mut parent| {
        parent.seek(3000).expect("a tick");
        parent.initial == reader.initial
    });
    assert!(same.expect("a log"), "it begins with the recorded state");
    // Without a change there is no difference, from a compacted parent either.
    for parent in [flight().to_path_buf(), compacted(flight(), "whatif")] {
        let pedal = "fcc.travel.pedal_in=2.5";
        let again = place.join("again.mcap");
        let args = ["whatif", text(&parent), "--set", pedal, "--force", "--out", text(&again)];
        tiltrotor(&args).ends(OK).says("every state is the recorded one, to the bit");
    }
}

#[test]
fn what_if_refuses_what_is_no_number_of_the_aircraft() {
    let place = folder("reflight-refused");
    let out = place.join("new.mcap");
    let whatif = |set: &str| {
        tiltrotor(&["whatif", text(flight()), "--set", set, "--out", text(&out)]).refused()
    };
    whatif("fcc.travel.pedals_in=2").says("did you mean fcc.travel.pedal_in");
    whatif("fcc.travel.pedal_in=fast").says("not a value");
    whatif("fcc.travel.pedal_in=\"2\"").says("expected a number");
    whatif("rotors.radius_ft=-2")
        .says("aircraft.toml:")
        .says("rotors.radius_ft: expected 3.281e-6 to");
    whatif("fcc.travel.pedal_in").says("KEY=VALUE");
    whatif("fcc.travel=2").says("table of keys");
    assert!(!out.exists());
    tiltrotor(&["whatif", text(flight()), "--set", "fcc.travel.pedal_in=2", "--from", "99"])
        .ends(UNUSABLE)
        .says("is not in the log");
}
