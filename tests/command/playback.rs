//! A log being shown, with pauses, steps and jumps: at any tick it shows what it shows when nobody touches it.

use std::path::Path;

use engine::Outputs;
use replay::playback::Command;
use replay::{Playback, Reflown, ReflyOptions};

/// A golden flight of fourteen seconds.
const LOG: &str = "tests/golden/lift-off.mcap";
const TICKS: u64 = 3500;

fn open(speed: f64) -> Playback {
    let log = Path::new(env!("CARGO_MANIFEST_DIR")).join(LOG);
    Playback::open(&log, &ReflyOptions::default(), speed).expect("a flight log")
}

/// Does not look.
fn nobody(_: &Reflown<'_>) {}

fn obey(playback: &mut Playback, command: Command) {
    playback.obey(command, &mut nobody).expect("it can be reflown");
}

/// What is shown now.
fn shown(playback: &Playback) -> (f64, Outputs) {
    let frame = playback.shown();
    (frame.part, frame.after.outputs)
}

/// What every tick shows when the log is shown from beginning to end.
fn untouched() -> Vec<Outputs> {
    let mut playback = open(1.0);
    let mut seen = Vec::new();
    while let Some(frame) = playback.frame(&mut nobody).expect("it can be reflown") {
        assert!((frame.part - 1.0).abs() < 1e-9, "at real time every frame is a tick");
        seen.push(frame.after.outputs);
    }
    assert!(playback.is_whole());
    seen
}

#[test]
fn pauses_steps_and_jumps_lead_to_the_same_pictures() {
    let seen = untouched();
    assert_eq!(seen.len() as u64, TICKS);
    let at = |tick: u64| seen[tick as usize - 1];
    let mut playback = open(1.0);
    for _ in 0..100 {
        playback.frame(&mut nobody).expect("a frame");
    }
    assert_eq!(shown(&playback), (1.0, at(100)));

    obey(&mut playback, Command::Pause(true));
    for _ in 0..10 {
        playback.frame(&mut nobody).expect("a frame");
    }
    assert_eq!(shown(&playback), (1.0, at(100)), "it stands still");
    obey(&mut playback, Command::Step(1));
    assert_eq!(shown(&playback), (1.0, at(101)));
    obey(&mut playback, Command::Step(-3));
    assert_eq!(shown(&playback), (1.0, at(98)));
    assert!(playback.is_paused(), "after a step it stands still");

    for tick in [3000, 1, 150, 3499] {
        obey(&mut playback, Command::Seek(tick));
        assert_eq!(shown(&playback), (1.0, at(tick)));
    }
    obey(&mut playback, Command::Pause(false));
    playback.frame(&mut nobody).expect("a frame");
    assert_eq!(shown(&playback), (1.0, at(TICKS)));
    assert!(playback.frame(&mut nobody).expect("the end").is_none());
    assert!(!playback.is_whole(), "parts were shown twice, others not at all");

    obey(&mut playback, Command::Seek(10_000));
    assert_eq!(shown(&playback), (1.0, at(TICKS)), "beyond the end is the end");
    obey(&mut playback, Command::Seek(2000));
    playback.frame(&mut nobody).expect("a frame").expect("it goes on from there");
    assert_eq!(shown(&playback), (1.0, at(2001)));
}

#[test]
fn the_speed_may_change_on_the_way() {
    let mut playback = open(1.0);
    let frames = |playback: &mut Playback, count: u32| {
        for _ in 0..count {
            playback.frame(&mut nobody).expect("a frame");
        }
        playback.tick()
    };
    assert!((frames(&mut playback, 50) - 50.0).abs() < 1e-9);
    obey(&mut playback, Command::Speed(0.25));
    assert!((frames(&mut playback, 10) - 52.5).abs() < 1e-9);
    let (part, after) = shown(&playback);
    assert_eq!(after.tick, 53);
    assert!((part - 0.5).abs() < 1e-9, "half-way to the next tick: {part}");
    obey(&mut playback, Command::Speed(4.0));
    assert!((frames(&mut playback, 10) - 92.5).abs() < 1e-9);
    // A step from between two ticks goes to the one on that side.
    obey(&mut playback, Command::Step(-1));
    assert_eq!(shown(&playback).1.tick, 92);
}
