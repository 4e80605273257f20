//! A flight that is killed loses at most a quarter of a second; the rest is exact without repair. One
//! that is terminated lands, and one whose disk is full goes on.
//!
//! How far a flight had come is known from outside: it sends a packet to FlightGear every tick.
//! A machine busy with something else may hold up the program's writer, and that is no fault of
//! ours: a canary on a thread of its own sleeps and notes how much too late it woke up, and that
//! much, in the worst case of the last moments, is granted on top. On a quiet machine it is nothing.

mod common;

use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use common::{
    Dice, INCOMPLETE, LOG_CUT_SHORT, OK, command, folder, said, text, tiltrotor, understood, verify,
};
use engine::STEP_NS;
use logs::{Ending, OpenOptions};

/// At most this much of a flight may be lost.
const LOST_MAX: Duration = Duration::from_millis(250);
/// The machine was quiet if the canary woke up no later than this.
const QUIET: Duration = Duration::from_millis(10);
/// For how long before the kill the canary's delays count.
const LOOK_BACK: Duration = Duration::from_millis(600);
/// How long the canary sleeps.
const NAP: Duration = Duration::from_millis(5);
/// Kills; `TILTROTOR_KILLS` asks for more.
const KILLS: u64 = 20;
/// Flights at a time.
const AT_A_TIME: u64 = 2;

/// Notes when it woke up late, and by how much.
struct Canary {
    late: Arc<Mutex<Vec<(Instant, Duration)>>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Canary {
    fn start() -> Self {
        let late = Arc::new(Mutex::new(Vec::new()));
        let stop = Arc::new(AtomicBool::new(false));
        let (notes, stopping) = (Arc::clone(&late), Arc::clone(&stop));
        let thread = thread::spawn(move || {
            while !stopping.load(Ordering::Relaxed) {
                let asleep = Instant::now();
                thread::sleep(NAP);
                let late = asleep.elapsed().saturating_sub(NAP);
                if late > QUIET {
                    notes.lock().expect("the notes").push((Instant::now(), late));
                }
            }
        });
        Self { late, stop, thread: Some(thread) }
    }

    /// All delays that touch the time from `LOOK_BACK` before the moment.
    fn late_before(&self, moment: Instant) -> Duration {
        // One that is under way is noted when it is over.
        thread::sleep(2 * NAP);
        let notes = self.late.lock().expect("the notes");
        let recent = |at: &Instant| moment.saturating_duration_since(*at) < LOOK_BACK;
        notes.iter().filter(|(at, _)| recent(at)).map(|(_, late)| *late).sum()
    }
}

impl Drop for Canary {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// A flight under way, and who watches it from outside.
struct Flight {
    program: Child,
    picture: UdpSocket,
    log: PathBuf,
}

impl Flight {
    /// Returns once the first tick has been flown.
    fn start(log: PathBuf) -> Self {
        let picture = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        picture.set_read_timeout(Some(Duration::from_secs(30))).expect("a timeout");
        let destination = picture.local_addr().expect("a bound socket").to_string();
        let arguments = [
            "fly",
            "--pilot",
            "hover",
            "--ground",
            "flat",
            "--flightgear",
            &destination,
            "--out",
            text(&log),
        ];
        let program = command(&arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command runs");
        picture.recv(&mut [0; 512]).expect("the flight begins");
        Self { program, picture, log }
    }

    /// Ticks flown since the last look, waiting this long for more.
    fn ticks(&self, patience: Duration) -> u64 {
        let until = Instant::now() + patience;
        let mut ticks = 0;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return ticks;
            }
            self.picture.set_read_timeout(Some(left)).expect("a timeout");
            ticks += u64::from(self.picture.recv(&mut [0; 512]).is_ok());
        }
    }
}

/// What is in a log: its last tick and when that was flown, since the Unix epoch.
fn recorded(log: &Path) -> (u64, Duration, Ending) {
    let mut reader = logs::open(log, OpenOptions::default()).expect("a flight log");
    let started = reader.identity.get("started_unix_ns").parse().expect("a time");
    let (mut last, mut wall_ns) = (0, started);
    while let Some(tick) = reader.next_tick().expect("whole ticks") {
        last = tick.record.state.tick;
        // The tick's own, unless the file was cut between the two.
        wall_ns = reader.timings.drain(..).next_back().map_or(wall_ns, |timing| timing.wall_ns);
    }
    wall_ns = reader.timings.last().map_or(wall_ns, |timing| timing.wall_ns);
    (last, Duration::from_nanos(wall_ns), reader.ending().expect("an end").clone())
}

/// Flies, kills after `alive`, and says what was wrong with what was left.
fn kill_after(alive: Duration, log: PathBuf, canary: &Canary) -> Result<bool, String> {
    let mut flight = Flight::start(log);
    // The first has been received.
    let flown = 1 + flight.ticks(alive);
    let before = SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970");
    flight.program.kill().expect("a kill");
    let killed = Instant::now();
    flight.program.wait().expect("a dead program");
    let flown = flown + flight.ticks(Duration::from_millis(5));

    let late = canary.late_before(killed);
    let (ticks, wall, ending) = recorded(&flight.log);
    // Both ways of counting: by the clock, and in ticks that were flown and are not in the log.
    let lost = before.saturating_sub(wall);
    let lost_flown = Duration::from_nanos(flown.saturating_sub(ticks) * STEP_NS);
    let facts = format!(
        "killed after {alive:?}: {lost:?} lost by the clock, {lost_flown:?} of flight, tick {ticks} \
         of {flown} recorded, the machine was late by {late:?}"
    );
    println!("{facts}");
    if lost > LOST_MAX + late || lost_flown > LOST_MAX + late {
        return Err(facts);
    }
    if ending != Ending::Truncated {
        return Err(format!("{facts}: {ending:?}"));
    }
    let said = verify(&flight.log).ends(INCOMPLETE);
    if !said.out.contains(&format!("exact up to tick {ticks} of {ticks} or more (")) {
        return Err(format!("{facts}: {said}"));
    }
    Ok(late.is_zero())
}

#[test]
fn a_killed_flight_loses_a_quarter_of_a_second_at_most_and_the_rest_is_exact() {
    let place = folder("kill");
    let canary = Canary::start();
    let seed = SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970").as_secs();
    let kills = std::env::var("TILTROTOR_KILLS").ok().and_then(|kills| kills.parse().ok());
    let kills: u64 = kills.unwrap_or(KILLS);
    println!("seed {seed}, {kills} kills");
    let wrong = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for lane in 0..AT_A_TIME {
            let (place, canary, wrong) = (&place, &canary, &wrong);
            scope.spawn(move || {
                let mut dice = Dice(seed + lane);
                for number in 0..kills.div_ceil(AT_A_TIME) {
                    let alive = Duration::from_millis(300 + dice.below(1200));
                    let log = place.join(format!("{lane}-{number}.mcap"));
                    if let Err(what) = kill_after(alive, log, canary) {
                        wrong.lock().expect("the list").push(what);
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().expect("the list");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_flight_killed_as_it_begins_leaves_a_log_or_nothing_but_never_a_lie() {
    let place = folder("kill-early");
    for ms in [0, 5, 10, 20, 40, 80] {
        let log = place.join(format!("{ms}.mcap"));
        let mut program =
            command(&["fly", "--pilot", "hover", "--no-flightgear", "--out", text(&log)])
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .expect("the command runs");
        thread::sleep(Duration::from_millis(ms));
        program.kill().expect("a kill");
        program.wait().expect("a dead program");
        let said = verify(&log);
        match said.status {
            Some(INCOMPLETE) => {
                said.says("exact up to tick ");
            }
            _ => {
                said.refused();
            }
        }
    }
}

#[test]
fn a_terminated_flight_lands() {
    for signal in ["TERM", "INT"] {
        let log = folder(&format!("kill-{signal}")).join("flight.mcap");
        let flight = Flight::start(log.clone());
        flight.ticks(Duration::from_millis(300));
        let id = flight.program.id().to_string();
        let sent = Command::new("kill").args(["-s", signal, &id]).status().expect("kill runs");
        assert!(sent.success());
        let output = flight.program.wait_with_output().expect("the flight ends");
        understood("fly", &output).ends(OK).says("flown ").says("digest ");
        verify(&log).ends(OK).says("exact: all ");
        tiltrotor(&["log", "info", text(&log)])
            .ends(OK)
            .says(&format!("ended by a signal: SIG{signal}"))
            .says("closed");
    }
}

#[test]
fn a_full_disk_ends_the_log_but_not_the_flight() {
    let log = folder("kill-full").join("flight.mcap");
    let program = env!("CARGO_BIN_EXE_tiltrotor");
    let flight = "fly --pilot hover --fast --duration 20 --no-flightgear --out";
    // No file may grow beyond half a megabyte. Ignored, the signal of that becomes an error.
    let script =
        format!("ulimit -f 1000; trap '' XFSZ; exec '{program}' {flight} '{}'", text(&log));
    said(Command::new("sh").args(["-c", &script]))
        .ends(LOG_CUT_SHORT)
        .says("WARNING: the log cannot be written any further; flying on")
        .says("flown      20.0 s, 5000 ticks")
        .says("ends before the flight did: log file: File too large");
    let (ticks, _, ending) = recorded(&log);
    assert!(ticks > 100 && ending == Ending::Truncated, "tick {ticks}, {ending:?}");
    verify(&log).ends(INCOMPLETE).says(&format!("exact up to tick {ticks} of {ticks} or more ("));
}

#[test]
#[cfg(target_os = "linux")]
fn a_disk_that_is_full_from_the_start_is_told_before_the_flight() {
    tiltrotor(&[
        "fly",
        "--pilot",
        "hover",
        "--fast",
        "--duration",
        "1",
        "--no-flightgear",
        "--force",
        "--out",
        "/dev/full",
    ])
    .refused()
    .says("No space left on device");
}
