//! What an eye sees: our pictures as a display of sixty frames a second shows them, live and in slow and
//! fast replay.
//!
//! A machine that is busy with other things delays packets, and there is no test that could tell its delay
//! from ours: of three attempts one has to be smooth. And it is a program of its own, because cargo runs those
//! one after the other: no other test is beside it.

mod common;

use std::path::Path;
use std::time::{Duration, Instant};

use common::flightgear::{FakeFlightGear, Heard};
use common::{OK, command, folder, said, text};
use flightgear::Channel;

/// A display's frame.
const FRAME_S: f64 = 1.0 / 60.0;
/// Of flight.
const TICK_S: f64 = 0.004;
/// 150 kt.
const SPEED_MPS: f64 = 77.2;
/// Frames that show what the one before showed.
const REPEATS_MAX: f64 = 0.01;
/// How far a frame shows the aircraft from where it would be at that moment.
const PLACE_M_P99: f64 = 0.5;
const ATTEMPTS: usize = 3;

/// What a display shows of a stream, at that many times real time.
#[derive(Debug)]
struct Shown {
    backwards: usize,
    repeats: f64,
    place_m_p99: f64,
    frames: usize,
}

impl Shown {
    fn of(heard: &Heard, speed: f64) -> Self {
        let pictures: Vec<(Instant, f64)> = heard
            .channel
            .iter()
            .filter_map(|(came, bytes)| {
                Some((*came, Channel::parse(bytes).ok()?.get("tiltrotor/tick")?))
            })
            .collect();
        let last = pictures.last().expect("pictures").1;
        // The last one is held; before it a packet may be late, and never early.
        let moving: Vec<_> = pictures.iter().filter(|(_, tick)| *tick < last).collect();
        let first = moving[0].0;
        let at_s = |came: &Instant| came.duration_since(first).as_secs_f64();
        let offset_s = moving
            .iter()
            .map(|(came, tick)| at_s(came) - tick * TICK_S / speed)
            .fold(f64::INFINITY, |least, offset| if offset < least { offset } else { least });
        let (mut shown, mut errors) = (Vec::new(), Vec::new());
        let end_s = at_s(&moving[moving.len() - 1].0);
        let mut now_s = 0.5;
        while now_s < end_s {
            let newest = moving.partition_point(|(came, _)| at_s(came) <= now_s) - 1;
            let tick = moving[newest].1;
            shown.push(tick);
            let there = (now_s - offset_s) * speed / TICK_S;
            errors.push((there - tick).abs() * TICK_S * SPEED_MPS);
            now_s += FRAME_S;
        }
        errors.sort_by(f64::total_cmp);
        let pairs = || shown.windows(2);
        Self {
            backwards: pairs().filter(|pair| pair[1] < pair[0]).count(),
            repeats: pairs().filter(|pair| pair[1] <= pair[0]).count() as f64 / shown.len() as f64,
            place_m_p99: errors[errors.len() * 99 / 100],
            frames: shown.len(),
        }
    }

    fn is_smooth(&self, speed: f64) -> bool {
        // Beyond real time as much more of the flight goes by in a frame.
        let place_m = PLACE_M_P99 * if speed > 1.0 { speed } else { 1.0 };
        // A chunk of the log is read in a millisecond, and in many where nothing is optimised: there only
        // a live flight and stretches within a chunk are on time.
        let timely = self.place_m_p99 <= place_m && self.repeats <= REPEATS_MAX;
        self.backwards == 0 && (timely || (speed > 1.0 && cfg!(debug_assertions)))
    }
}

fn watched(arguments: &[&str], speed: f64) -> Shown {
    let flightgear = FakeFlightGear::new();
    let mut program = command(arguments);
    program.args(["--flightgear", &flightgear.place(), "--hold", "0"]);
    std::thread::scope(|scope| {
        let running = scope.spawn(|| said(&mut program).ends(OK));
        let heard = flightgear.listen(|| running.is_finished());
        running.join().expect("it ends");
        Shown::of(&heard, speed)
    })
}

#[track_caller]
fn smooth(arguments: &[&str], speed: f64) {
    let mut all = Vec::new();
    for _ in 0..ATTEMPTS {
        let shown = watched(arguments, speed);
        if shown.is_smooth(speed) {
            assert!(shown.frames > 100, "{shown:?}");
            return;
        }
        assert_eq!(shown.backwards, 0, "on no machine: {shown:?}");
        all.push(shown);
        std::thread::sleep(Duration::from_millis(500));
    }
    panic!("{arguments:?}: {all:?}");
}

/// Nobody touches the controls of an aeroplane in steady flight at 150 kt.
fn script(folder: &Path) -> std::path::PathBuf {
    let script = folder.join("still.toml");
    std::fs::write(&script, "[[event]]\nat_s = 100.0\nend = true\n").expect("written");
    script
}

#[test]
fn pictures_are_smooth_live_and_in_slow_and_fast_replay() {
    let folder = folder("flightgear-smooth");
    let (script, log) = (script(&folder), folder.join("flight.mcap"));
    let (script, log) = (text(&script), text(&log));
    let flight = ["fly", "--script", script, "--from-trim", "--nacelle", "0", "--speed-kt", "150"];
    let flight =
        [&flight[..], &["--duration", "5", "--ground", "flat", "--out", log, "--force"]].concat();
    smooth(&flight, 1.0);
    smooth(&["replay", log, "--until", "0.75", "--speed", "0.25"], 0.25);
    smooth(&["replay", log, "--until", "0.3", "--speed", "0.1"], 0.1);
    smooth(&["replay", log, "--speed", "1.5"], 1.5);
}
