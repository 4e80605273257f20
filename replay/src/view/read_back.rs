//! What is drawn of a flight, read back: rows of every entity, and where the aircraft is in space.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use engine::frames::{Attitude, Euler, Vec3};
use engine::inputs::World;
use engine::math::{FRAC_PI_2, cos, sin};
use engine::pair::Pair;
use engine::{Outputs, STEP_S};
use logs::records::TimingRecord;
use rerun::Transform3D;
use rerun::log::{Chunk, LogMsg};
use rerun::sink::{LogSink, SinkFlushError};

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
    now
}

/// Draws the flight; every chunk of rows that was sent, in the order in which they were.
fn drawn() -> Vec<Chunk> {
    let xv15 =
        aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"));
    let (kept, look) = (Kept::default(), Look::alone());
    let title = "read back".into();
    let about = About { title, recording_id: "read-back".into(), ..About::default() };
    let plan = (Layout::Engineer, Plan::new(&[&look.root]));
    let mut canvas =
        Canvas::begin(Box::new(kept.clone()), &about, plan, &[(&look, &*xv15)]).expect("begun");
    let mut track = Track::new(look, &xv15, Vec::new());
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
    let (recording, error) = canvas.end("");
    assert!(error.is_none(), "{error:?}");
    recording.flush_blocking().expect("flushed");
    let messages = kept.0.lock().expect("nobody panicked");
    let chunks = messages.iter().filter_map(|message| match message {
        LogMsg::ArrowMsg(_, message) => Some(Chunk::from_arrow_msg(message).expect("a chunk")),
        _ => None,
    });
    chunks.filter(|chunk| !chunk.is_static()).collect()
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
