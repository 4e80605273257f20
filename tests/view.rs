//! Recordings for the viewer: two flights in one, and what diverged beside what was recorded.
#![cfg(feature = "rerun")]

mod common;

use std::fs;
use std::path::Path;

use common::{DIVERGED, Forgery, OK, folder, hover, text, tiltrotor};

/// Whether the name of an entity is somewhere in the recording: its chunks are compressed, its
/// manifest at the end is not.
fn knows(recording: &Path, entity: &str) -> bool {
    let bytes = fs::read(recording).expect("a recording");
    bytes.windows(entity.len()).any(|window| window == entity.as_bytes())
}

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
    tiltrotor(&view).refused().says("--force");
    let missing = place.join("missing.mcap");
    tiltrotor(&["view", text(&long), "--against", text(&missing), "--force"])
        .refused()
        .says("missing.mcap");
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
