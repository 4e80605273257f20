//! What is drawn of a flight, read back: rows of every entity, and where the aircraft is in space.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use engine::Aircraft;
use engine::frames::{Attitude, Euler, Vec3};
use engine::inputs::World;
use engine::math::{FRAC_PI_2, cos, sin};
use engine::outputs::Validity;
use engine::pair::Pair;
use engine::{Outputs, STEP_S};
use logs::records::TimingRecord;
use rerun::log::{Chunk, LogMsg};
use rerun::sink::{LogSink, SinkFlushError};
use rerun::{ComponentDescriptor, LineStrips3D, Points3D, StateChange, TextDocument, Transform3D};

use super::basics::{Severity, TICKS_PER_ROW};
use super::canvas::{About, Canvas};
use super::events::Happened;
use super::layout::Layout;
use super::look::Look;
use super::parts::Plan;
use super::plots::{GRAPHS, TIMES};
use super::track::{Moment, Track};

/// Ticks of the flight: more than two chunks of rows, and no whole number of rows.
const TICKS: u64 = 5_503;

/// Keeps what is sent.
#[derive(Clone, Default)]
struct Kept(Arc<Mutex<Vec<LogMsg>>>);

impl LogSink for Kept {
    fn send(&self, message: LogMsg) {
        self.0.lock().expect("nobody panicked").push(message);
    }

    fn flush_blocking(&self, _: Duration) -> Result<(), SinkFlushError> {
        Ok(())
    }
}

/// Where it is at a tick: around in a climb, nacelles going down.
fn at(tick: u64) -> Outputs {
    let time_s = tick as f64 * STEP_S;
    let heading_rad = 0.2 * time_s;
    let mut now = Outputs { tick, ..Outputs::default() };
    now.position_m =
        Vec3::new(200.0 * sin(heading_rad), -200.0 * cos(heading_rad), -2.0 - 3.0 * time_s);
    now.height_above_ground_m = 2.0 + 3.0 * time_s;
    now.euler = Euler { roll_rad: 0.3 * sin(time_s), pitch_rad: 0.1 * cos(time_s), heading_rad };
    now.actuators.mast_tilt_rad = Pair::both(FRAC_PI_2 * time_s / 25.0);
    now.rotor_speed_radps = 61.68;
    now
}

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

/// What is drawn on, and what is kept of it.
fn canvas() -> (Canvas, Kept) {
    let (kept, look) = (Kept::default(), Look::alone());
    let title = "read back".into();
    let about = About { title, recording_id: "read-back".into(), ..About::default() };
    let plan = (Layout::Engineer, Plan::new(&[&look.root]));
    let canvas = Canvas::begin(Box::new(kept.clone()), &about, plan, &[(&look, &*xv15())]);
    (canvas.expect("begun"), kept)
}

/// Every chunk that was sent, in the order in which they were.
fn sent(canvas: Canvas, kept: &Kept) -> Vec<Chunk> {
    let (recording, error) = canvas.end("");
    assert!(error.is_none(), "{error:?}");
    recording.flush_blocking().expect("flushed");
    let messages = kept.0.lock().expect("nobody panicked");
    let chunks = messages.iter().filter_map(|message| match message {
        LogMsg::ArrowMsg(_, message) => Some(Chunk::from_arrow_msg(message).expect("a chunk")),
        _ => None,
    });
    chunks.collect()
}

/// Draws the flight; every chunk of rows that was sent.
fn drawn() -> Vec<Chunk> {
    let (mut canvas, kept) = canvas();
    let mut track = Track::new(Look::alone(), &xv15(), Vec::new());
    track.begin(&mut canvas);
    let world = World::default();
    for tick in 1..=TICKS {
        track.push(&mut canvas, Moment { outputs: &at(tick), world: &world, events: &[] });
        track.time(&mut canvas, &TimingRecord { tick, ..TimingRecord::default() });
    }
    let happened = |tick, level, words| Happened { tick, level, words, number: None };
    track.event(&mut canvas, happened(7, Severity::Info, "one"));
    track.event(&mut canvas, happened(900, Severity::Warning, "two"));
    track.finish(&mut canvas);
    sent(canvas, &kept).into_iter().filter(|chunk| !chunk.is_static()).collect()
}

/// Words of an entity's rows with their ticks, in order; of what does not move the last ones, at none.
fn words(chunks: &[Chunk], entity: &str, component: &ComponentDescriptor) -> Vec<(i64, String)> {
    let mut found = Vec::new();
    for chunk in chunks.iter().filter(|chunk| *chunk.entity_path() == entity.into()) {
        let all = chunk.iter_slices::<String>(component.component);
        let said: Vec<String> = all
            .map(|row| {
                row.iter()
                    .map(rerun::external::re_sdk_types::ArrowString::as_str)
                    .collect::<Vec<_>>()
                    .join("; ")
            })
            .collect();
        if said.is_empty() {
            continue;
        }
        if chunk.is_static() {
            found = said.into_iter().map(|words| (0, words)).collect();
        } else {
            found.extend(ticks(chunk).into_iter().zip(said));
        }
    }
    found.sort_by_key(|(tick, _)| *tick);
    found
}

/// What is told above a flight, of the places where it was over, in the lane of events, and of the nacelles.
fn told(chunks: &[Chunk]) -> [Vec<(i64, String)>; 4] {
    let state = StateChange::descriptor_state();
    [
        words(chunks, "/heading", &TextDocument::descriptor_text()),
        words(chunks, "/world/crash", &Points3D::descriptor_labels()),
        words(chunks, "/modes/events", &state),
        words(chunks, "/modes/nacelles", &state),
    ]
}

/// The same, with the hull on the ground from tick 1003 until another state takes the place of that at 2000, and
/// a restart that no crash was before at 4000.
fn crashing(tick: u64) -> Outputs {
    let hull = (1003..2000).contains(&tick);
    let mut now = at(tick);
    now.validity = if hull { Validity::HULL } else { Validity::empty() };
    if tick > 2000 {
        now.position_m.x += 5000.0;
    }
    now
}

#[test]
fn after_a_restart_the_flight_means_something_again() {
    let (mut canvas, kept) = canvas();
    let mut track = Track::new(Look::alone(), &xv15(), Vec::new());
    track.begin(&mut canvas);
    let world = World::default();
    for tick in 1..=TICKS {
        if tick == 2001 || tick == 4001 {
            track.restart(&mut canvas, tick - 1);
        }
        track.push(&mut canvas, Moment { outputs: &crashing(tick), world: &world, events: &[] });
    }
    track.finish(&mut canvas);
    let chunks = sent(canvas, &kept);
    let [heading, marks, lane, _] = told(&chunks);
    let page = &heading.last().expect("a page").1;
    assert!(page.contains("**CRASH at 4.01 s"), "{page}");
    assert!(page.contains("Nothing until the restart at 8.00 s"), "{page}");
    assert_eq!(
        marks.last().expect("a mark").1,
        "CRASH at 4.01 s: hull on the ground; restarted at 8.00 s"
    );
    assert_eq!(lane, [(1003, "CRASH".to_string()), (2000, String::new())]);
    let pages = words(&chunks, "/numbers", &TextDocument::descriptor_text());
    let worthless = pages.iter().filter(|(_, page)| page.contains("none of these"));
    let ticks: Vec<i64> = worthless.map(|(tick, _)| *tick).collect();
    assert_eq!((ticks.first(), ticks.last()), (Some(&1005), Some(&2000)));
    // From where it was over to where it goes on nothing was flown, on neither of its lines.
    let strips = |entity: &str| {
        let lines = LineStrips3D::descriptor_strips();
        let of = chunks.iter().filter(|chunk| *chunk.entity_path() == entity.into());
        let rows = of.flat_map(|chunk| {
            chunk
                .iter_component::<rerun::components::LineStrip3D>(lines.component)
                .map(|row| row.as_slice().to_vec())
                .collect::<Vec<_>>()
        });
        rows.flatten().map(|strip| strip.0).collect::<Vec<_>>()
    };
    for entity in ["/world/path", "/world/flown"] {
        let strips = strips(entity);
        assert!(strips.len() > 2, "{entity}");
        for pair in strips.iter().flat_map(|strip| strip.windows(2)) {
            assert!((pair[1].x() - pair[0].x()).abs() < 100.0, "{entity}: {pair:?}");
        }
    }
}

/// A viewer that comes after the crash is told when that was, and what lanes and numbers were before it came.
#[test]
fn whoever_comes_late_is_told_what_was() {
    let mut track = Track::live(Look::alone(), &xv15(), Vec::new());
    let world = World::default();
    let late = |track: &mut Track, from: u64| {
        let (mut canvas, kept) = canvas();
        track.begin(&mut canvas);
        for tick in (from..from + 200).step_by(10) {
            track.draw(&mut canvas, &crashing(tick), &world);
        }
        track.finish(&mut canvas);
        track.forget();
        sent(canvas, &kept)
    };
    (10..1500).step_by(10).for_each(|tick| track.miss(&crashing(tick), &world));
    let chunks = late(&mut track, 1500);
    let [heading, marks, lane, nacelles] = told(&chunks);
    assert!(heading.last().expect("a page").1.contains("**CRASH at 4.04 s"), "{heading:?}");
    assert_eq!(marks.last().expect("a mark").1, "CRASH at 4.04 s: hull on the ground");
    assert_eq!(lane, [(1010, "CRASH".to_string())]);
    assert_eq!(nacelles[0], (10, "helicopter".to_string()));
    assert!(nacelles.iter().any(|(tick, words)| *tick < 1500 && words == "converting"));
    let pages = words(&chunks, "/numbers", &TextDocument::descriptor_text());
    assert!(pages[0].0 == 1500 && pages[0].1.contains("none of these"), "{pages:?}");
    // It goes away, the flight goes on, and another one comes.
    (1700..2000).step_by(10).for_each(|tick| track.miss(&crashing(tick), &world));
    assert!(track.go_on_from(2000));
    (2010..3000).step_by(10).for_each(|tick| track.miss(&crashing(tick), &world));
    let [heading, marks, lane, nacelles] = told(&late(&mut track, 3000));
    assert!(
        heading.last().expect("a page").1.contains("until the restart at 8.00 s"),
        "{heading:?}"
    );
    assert!(marks.last().expect("a mark").1.ends_with("restarted at 8.00 s"), "{marks:?}");
    assert_eq!(lane, [(1010, "CRASH".to_string()), (2000, String::new())]);
    assert_eq!(nacelles[0].0, 10);
}

fn ticks(chunk: &Chunk) -> Vec<i64> {
    let timelines = chunk.timelines();
    timelines.get(&"tick".into()).map_or_else(Vec::new, |column| column.times_raw().to_vec())
}

#[test]
fn every_row_of_the_flight_is_in_every_entity_once() {
    let mut rows: BTreeMap<String, Vec<i64>> = BTreeMap::new();
    for chunk in drawn() {
        rows.entry(chunk.entity_path().to_string()).or_default().extend(ticks(&chunk));
    }
    let drawn: Vec<i64> =
        (1..=TICKS).filter(|t| t % TICKS_PER_ROW == 0).map(|t| t as i64).collect();
    let moving = ["world/aircraft", "world/chase", "map/aircraft", "corridor/now", "world/plumb"];
    for entity in moving.into_iter().chain(GRAPHS.iter().map(|graph| graph.entity)) {
        assert!(rows.get(&format!("/{entity}")) == Some(&drawn), "{entity}");
    }
    // Of the times of a row the latest, and of as late ones the last.
    for graph in TIMES {
        let rows = &rows[&format!("/{}", graph.entity)];
        assert_eq!(rows.len() as u64, TICKS / TICKS_PER_ROW + 1, "{}", graph.entity);
    }
    assert_eq!(rows["/events"], [7, 900]);
}

#[test]
fn the_aircraft_in_space_is_where_and_how_the_state_says() {
    let (position, attitude) =
        (Transform3D::descriptor_translation(), Transform3D::descriptor_quaternion());
    let mut seen = 0;
    for chunk in drawn() {
        if *chunk.entity_path() != "/world/aircraft".into() {
            continue;
        }
        let places = chunk.iter_slices::<[f32; 3]>(position.component);
        let turns = chunk.iter_slices::<[f32; 4]>(attitude.component);
        for ((tick, place), turn) in ticks(&chunk).into_iter().zip(places).zip(turns) {
            let state = at(tick as u64);
            let Vec3 { x, y, z, .. } = state.position_m;
            assert_eq!(place, [[x as f32, y as f32, z as f32]], "tick {tick}");
            let Attitude { w, x, y, z } = Attitude::from_euler(state.euler);
            assert_eq!(turn, [[x as f32, y as f32, z as f32, w as f32]], "tick {tick}");
            seen += 1;
        }
    }
    assert_eq!(seen, TICKS / TICKS_PER_ROW);
}
