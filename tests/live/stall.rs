//! A writer that cannot write for five seconds: the loop flies on, nothing is lost, and it is told.
//!
//! The log goes into a pipe, and whoever reads the pipe is stopped. When it holds no more, the writer
//! waits in the kernel, as it does on a disk that hangs.

use std::fs::File;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use logs::OpenOptions;
use logs::records::FlightEvent;

use crate::common::{OK, command, folder, text, tiltrotor, understood, verify};

/// How long the reader of the pipe is stopped, s.
const STALL_S: u64 = 5;
/// So much is written within the first second or two.
const UNDER_WAY_BYTES: u64 = 300_000;
/// The loop's share of a tick on which the writer has an influence. A loop that waited for the writer
/// would show seconds here; a busy machine may take its processor away for some tens of milliseconds.
const HAND_OVER_MAX: Duration = Duration::from_millis(500);

fn signal(name: &str, process: u32) {
    let id = process.to_string();
    let sent = Command::new("kill").args(["-s", name, &id]).status().expect("kill runs");
    assert!(sent.success(), "{name}");
}

#[test]
fn a_writer_stalled_for_five_seconds_delays_no_tick_and_loses_no_input() {
    let place = folder("stall");
    let (pipe, log) = (place.join("pipe"), place.join("flight.mcap"));
    let made = Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs");
    assert!(made.success());
    let mut reader = Command::new("cat")
        .arg(&pipe)
        .stdout(File::create(&log).expect("a file"))
        .spawn()
        .expect("cat runs");
    let mut flight = command(&[
        "fly",
        "--pilot",
        "hover",
        "--duration",
        "8",
        "--self-check",
        "--no-flightgear",
        "--force",
        "--out",
        text(&pipe),
    ])
    .stdout(Stdio::piped())
    .stderr(Stdio::piped())
    .spawn()
    .expect("the command runs");
    // Under way, with more in the log than the files it begins with.
    while log.metadata().map_or(0, |file| file.len()) < UNDER_WAY_BYTES {
        sleep(Duration::from_millis(10));
        let ended = flight.try_wait().expect("a status");
        assert!(ended.is_none(), "it ended before it began: {ended:?}");
    }
    signal("STOP", reader.id());
    sleep(Duration::from_secs(STALL_S));
    signal("CONT", reader.id());
    let output = flight.wait_with_output().expect("the flight ends");
    assert!(reader.wait().expect("the reader ends").success());

    let said = understood("fly", &output).ends(OK).says("flown      8.0 s, 2000 ticks");
    println!("{said}");
    let said = said.says("writer     held up ").says("none was lost");
    said.says("2000 of 2000 ticks reflown in flight, 0 mismatches, 0 ticks dropped");
    verify(&log).ends(OK).says("exact: all 2000 ticks");
    tiltrotor(&["log", "info", text(&log)]).ends(OK).says("the log's writer was held up for ");

    let mut reader = logs::open(&log, OpenOptions::default()).expect("a flight log");
    while reader.next_tick().expect("whole ticks").is_some() {}
    let held_up_ms = reader.events.iter().filter(|e| e.kind == FlightEvent::WriterHeldUp as u64);
    let longest_ms = held_up_ms.map(|event| event.value).max().expect("it is in the log");
    // The pipe takes some of the flight before it is full.
    assert!((STALL_S - 2) * 1000 < longest_ms, "{longest_ms} ms");
    assert_eq!(reader.timings.len(), 2000);
    let hand_over = reader.timings.iter().map(|timing| timing.record_ns).max().unwrap_or(0);
    assert!(Duration::from_nanos(hand_over) < HAND_OVER_MAX, "{hand_over} ns");
}
