//! Recordings for the viewer: what is in them, when they are drawn anew, and what is opened where.
#![cfg(feature = "rerun")]

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{DIVERGED, Forgery, OK, UNUSABLE, folder, hover, text, tiltrotor};

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
    fs::write(&program, script).expect("a script");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("may run");
    }
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
