//! Recordings for the viewer: what is in them, when they are drawn anew, and what is opened where.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};

use crate::common::{DIVERGED, Forgery, OK, UNUSABLE, folder, hover, program_of, text, tiltrotor};

/// Whether the name of an entity is somewhere in the recording: its chunks are compressed, its
/// manifest at the end is not.
fn knows(recording: &Path, entity: &str) -> bool {
    let bytes = fs::read(recording).expect("a recording");
    bytes.windows(entity.len()).any(|window| window == entity.as_bytes())
}

/// A program that does as a viewer would: says its version, writes down what it is given, and runs for a
/// while.
fn viewer(place: &Path, version: &str, then: &str) -> PathBuf {
    let program = place.join(format!("viewer-{version}"));
    let given = place.join("given");
    let script = format!(
        "#!/bin/sh\nif [ \"$1\" = --version ]; then echo \"rerun-cli {version} [rustc 1.95.0] x86_64\"; exit; fi\n\
         echo \"$@\" >{}\n{then}\n",
        given.display()
    );
    program_of(&program, &script);
    program
}

/// What the viewer of these recordings is.
const VERSION: &str = "0.36.3";

#[test]
fn two_flights_and_their_difference_are_in_one_recording() {
    let place = folder("view-against");
    let (long, short) = (place.join("long.mcap"), place.join("short.mcap"));
    hover(&long, "4");
    hover(&short, "2");
    let saved = place.join("both.rrd");
    let view = ["view", text(&long), "--against", text(&short), "--save", text(&saved)];
    tiltrotor(&view).ends(OK).says("no difference").says(" MB for rerun");
    assert!(fs::metadata(&saved).expect("a recording").len() > 100_000);
    for entity in
        ["/long/world/aircraft", "/short/plots/height", "/delta/plots/height", "/delta/largest"]
    {
        assert!(knows(&saved, entity), "{entity}");
    }
    tiltrotor(&view).refused().says("--force");
    let missing = place.join("missing.mcap");
    tiltrotor(&["view", text(&long), "--against", text(&missing), "--force"])
        .refused()
        .says("missing.mcap");
    let aligned = ["view", text(&long), "--against", text(&short), "--align", "lift-off"];
    tiltrotor(&aligned).refused();
}

#[test]
fn what_diverged_is_drawn_beside_what_was_recorded() {
    let place = folder("view-diverged");
    let log = place.join("wing.mcap");
    hover(&log, "6");
    let exact = place.join("exact");
    tiltrotor(&["verify", text(&log), "--rrd", text(&exact)]).ends(OK);
    assert_eq!(fs::read_dir(&exact).expect("a folder").count(), 0, "nothing to draw");
    let mut forgery = Forgery::of(&log);
    forgery.rewrite(
        "aircraft.toml",
        "\narea_ft2 = { value = 181.0",
        "\narea_ft2 = { value = 190.0",
    );
    forgery.write(&log);
    let folder = place.join("parted");
    tiltrotor(&["verify", text(&log), "--rrd", text(&folder)])
        .ends(DIVERGED)
        .says("recorded, reflown and the difference");
    let mut drawn = fs::read_dir(&folder).expect("a folder");
    let recording = drawn.next().expect("a recording").expect("a file").path();
    for entity in
        ["/recorded/world/aircraft", "/reflown/world/aircraft", "/delta/growth/position_m"]
    {
        assert!(knows(&recording, entity), "{entity} in {}", recording.display());
    }
    for facts in engine::outputs::Validity::FACTS {
        let lane = format!("/recorded/validity/{}", facts.key);
        assert!(knows(&recording, &lane), "{lane} in {}", recording.display());
    }
}

/// `demo` and then `view`, and `view` again: drawn once, told alike; drawn anew for another log or another
/// layout, and never over a file of somebody else.
#[test]
#[cfg(unix)]
fn a_recording_of_ours_is_used_again_or_drawn_anew_and_another_s_file_is_refused() {
    let place = folder("view-again");
    let log = place.join("flight.mcap");
    hover(&log, "2");
    let program = viewer(&place, VERSION, "sleep 5");
    let view = ["view", text(&log), "--viewer", text(&program)];
    tiltrotor(&view).ends(OK).says("exact: all").says(" MB for rerun");
    let recording = place.join("flight.rrd");
    let given = fs::read_to_string(place.join("given")).expect("the viewer was started");
    assert!(given.contains("--bind 127.0.0.1") && given.contains("flight.rrd"), "{given}");
    let drawn = fs::read(&recording).expect("a recording");
    tiltrotor(&view).ends(OK).says("drawn before").never_says("for rerun");
    assert!(drawn == fs::read(&recording).expect("a recording"), "drawn anew");
    tiltrotor(&["view", text(&log), "--viewer", text(&program), "--layout", "rotor"])
        .ends(OK)
        .says(" MB for rerun");
    // Another flight of the same name.
    fs::remove_file(&log).expect("the log");
    hover(&log, "3");
    tiltrotor(&view).ends(OK).says(" MB for rerun");
    // One that diverges ends alike when it is drawn and when it was drawn before.
    let mut forgery = Forgery::of(&log);
    forgery.rewrite(
        "aircraft.toml",
        "\narea_ft2 = { value = 181.0",
        "\narea_ft2 = { value = 190.0",
    );
    forgery.write(&log);
    tiltrotor(&view).ends(DIVERGED);
    tiltrotor(&view).ends(DIVERGED).says("drawn before");
    fs::write(&recording, "somebody's notes").expect("a file");
    tiltrotor(&view).refused().says("--force");
    assert_eq!(fs::read(&recording).expect("the file"), b"somebody's notes");
}

#[test]
#[cfg(unix)]
fn a_viewer_that_is_missing_old_or_dies_is_told_before_and_after_drawing() {
    let place = folder("view-viewer");
    let log = place.join("flight.mcap");
    hover(&log, "1");
    let with = |program: &Path| tiltrotor(&["view", text(&log), "--viewer", text(program)]);
    let install = "pip install rerun-sdk==0.36.3";
    with(&place.join("nowhere")).refused().says(install);
    with(&viewer(&place, "0.30.1", "")).refused().says("version 0.30.1").says(install);
    with(Path::new("/bin/echo")).refused().says("not the rerun viewer").says(install);
    assert!(!place.join("flight.rrd").exists(), "drawn for no viewer");
    let dying = viewer(&place, VERSION, "echo 'no graphics adapter' >&2; exit 3");
    with(&dying).ends(UNUSABLE).says("no graphics adapter").says("--save");
    // Told where to go, and dead after it was watched: no success either.
    let later = viewer(&place, VERSION, "sleep 4; echo 'lost the screen' >&2; exit 3");
    tiltrotor(&["view", text(&log), "--viewer", text(&later), "--at", "0.5"])
        .ends(UNUSABLE)
        .says("lost the screen");
    let closed = viewer(&place, VERSION, "sleep 4; exit 0");
    tiltrotor(&["view", text(&log), "--viewer", text(&closed), "--at", "0.5"]).ends(OK);
}

/// Scripts that are run at once while other threads start programs: none is "busy".
#[test]
#[cfg(unix)]
fn scripts_are_run_while_other_programs_are_started() {
    let place = folder("view-busy");
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let place = &place;
            scope.spawn(move || {
                for round in 0..25 {
                    let program = place.join(format!("program-{thread}-{round}"));
                    program_of(&program, "#!/bin/sh\nexit 0\n");
                    let ended = Command::new(&program).status();
                    assert!(ended.as_ref().is_ok_and(ExitStatus::success), "{ended:?}");
                }
            });
        }
    });
}

/// A place that is in no recording is told at once: not after the drawing, and not by waiting for the viewer.
#[test]
#[cfg(unix)]
fn a_place_that_is_not_drawn_is_told_before_the_drawing() {
    let place = folder("view-places");
    let log = place.join("flight.mcap");
    hover(&log, "2");
    let program = viewer(&place, VERSION, "sleep 5");
    let with = |more: &[&str]| {
        let mut words = vec!["view", text(&log), "--viewer", text(&program)];
        words.extend(more);
        tiltrotor(&words)
    };
    with(&["--at", "marker:99"]).refused().says("no marker:99");
    with(&["--at", "event:999"]).refused().says("no event 999");
    with(&["--at", "60"]).refused().says("60.000 s").says("to tick 500 (2.000 s)");
    with(&["--at", "1.6", "--from", "0.4", "--until", "1.2"]).refused().says("1.600 s");
    with(&["--at", "0.2", "--from", "0.4"]).refused().says("0.200 s");
    // Of a log that was never closed, as far as it goes.
    let cut = place.join("cut.mcap");
    let bytes = fs::read(&log).expect("the log");
    fs::write(&cut, &bytes[..bytes.len() / 2]).expect("half of it");
    tiltrotor(&["view", text(&cut), "--viewer", text(&program), "--at", "60"])
        .refused()
        .says("60.000 s");
    assert!(!place.join("flight.rrd").exists() && !place.join("cut.rrd").exists(), "drawn");
    assert!(!place.join("given").exists(), "a viewer was started");
}

#[test]
fn layouts_and_places_to_open_at_are_read_before_anything_is_drawn() {
    let place = folder("view-words");
    let log = place.join("flight.mcap");
    hover(&log, "1");
    let saved = place.join("flight.rrd");
    let with = |more: &[&str]| {
        let mut words = vec!["view", text(&log)];
        words.extend(more);
        tiltrotor(&words)
    };
    with(&["--layout", "cockpit", "--save", text(&saved)]).refused().says("pilot, engineer");
    with(&["--layout", "compare", "--save", text(&saved)]).refused().says("--against");
    with(&["--at", "event:x"]).refused().says("first-difference");
    // A wrong file is told before a viewer that is not there.
    let no_log = place.join("text.mcap");
    fs::write(&no_log, "words").expect("a file");
    let viewer = ["--viewer", "/nowhere/rerun"];
    for arguments in
        [&["view", text(&no_log)][..], &["view", text(&log), "--against", text(&no_log)]]
    {
        tiltrotor(&[arguments, &viewer].concat())
            .refused()
            .says("text.mcap")
            .says("not a flight log");
    }
    let own = place.join("own.toml");
    fs::write(&own, "[[tab]]\nname = \"A\"\n[[tab.view]]\nfields = [\"thrust\"]\n")
        .expect("a file");
    with(&["--layout", text(&own), "--save", text(&saved)]).refused().says("log fields");
    assert!(!saved.exists());
    let layout = "[[tab]]\nname = \"A\"\n[[tab.view]]\nfields = [\"rotors.left.thrust_n\", \
                  \"timing/step_ns\"]\n[[tab.view]]\nshow = \"lanes\"\n";
    fs::write(&own, layout).expect("a file");
    with(&["--layout", text(&own), "--save", text(&saved)]).ends(OK);
    assert!(knows(&saved, "/fields/outputs/rotors/left/thrust_n"));
    assert!(knows(&saved, "/fields/timing/step_ns"));
}
