//! `fly --rerun`: a viewer that is there, is killed, comes back, or is none; and what it costs the flight.
//!
//! Where the viewer is not installed (`tests/rerun_screenshot.sh` brings it), what needs it is skipped.

use std::fs;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::common::{OK, Said, command, folder, program_of, text, tiltrotor, understood};

/// The viewer's program, if it is there: itself, and not the script that starts it, which would be killed in
/// its place.
fn rerun() -> Option<PathBuf> {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).parent()?.join("rerun-0.36.3/lib");
    let within = "site-packages/rerun_sdk/rerun_cli/rerun";
    let folders = fs::read_dir(&place).into_iter().flatten().flatten();
    let program = folders.map(|of| of.path().join(within)).find(|program| program.is_file());
    if program.is_none() {
        eprintln!("skipped: no viewer below {}", place.display());
    }
    program
}

fn free_port() -> u16 {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    listener.local_addr().expect("bound").port()
}

/// A viewer without a window, killed when it is dropped.
struct Server(Child);

impl Server {
    fn at(program: &Path, port: u16) -> Self {
        let child = Command::new(program)
            .args(["--serve-grpc", "--bind", "127.0.0.1", "--port", &port.to_string()])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the viewer starts");
        let server = Self(child);
        wait("the viewer listens", || TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_ok());
        server
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn wait(what: &str, mut there: impl FnMut() -> bool) {
    let began = Instant::now();
    while !there() {
        assert!(began.elapsed() < Duration::from_secs(120), "{what}: not within two minutes");
        thread::sleep(Duration::from_millis(50));
    }
}

/// A flight in real time that is shown there, or nowhere.
fn flying(log: &Path, seconds: &str, shown: &[&str]) -> Child {
    let fly = ["fly", "--pilot", "hover", "--no-flightgear", "--no-panel", "--ground", "flat"];
    command(&fly)
        .args(["--out", text(log), "--duration", seconds])
        .args(shown)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the flight begins")
}

fn landed(flight: Child) -> Said {
    understood("fly --rerun", &flight.wait_with_output().expect("it ends"))
}

/// Parts of all ticks that took no longer.
const PARTS: [f64; 4] = [0.5, 0.99, 0.999, 1.0];

/// How ticks kept time: the hand-over to the log and the lateness, ns, that so many did not exceed, and how many
/// ticks there are.
fn spread(log: &Path) -> ([[u64; PARTS.len()]; 2], usize) {
    let mut reader = logs::open(log, logs::OpenOptions::default()).expect("a log");
    while reader.next_tick().expect("whole").is_some() {}
    let mut both = [Vec::new(), Vec::new()];
    for timing in &reader.timings {
        both[0].push(timing.record_ns);
        both[1].push(timing.late_ns);
    }
    let ticks = both[0].len();
    let spread = both.map(|mut times| {
        times.sort_unstable();
        PARTS.map(|part| times[((ticks - 1) as f64 * part) as usize])
    });
    (spread, ticks)
}

/// What a viewer at this port has been told, as rerun prints it.
fn told_to(program: &Path, port: u16, saved: &Path) -> String {
    let from = format!("rerun+http://127.0.0.1:{port}/proxy");
    let mut reading = Command::new(program)
        .args([&from, "--save", text(saved)])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("rerun reads");
    // It listens for ever; what was there comes first, on a busy machine with pauses of seconds.
    let mut size = 0;
    let mut same = 0;
    wait("the recording is read", || {
        thread::sleep(Duration::from_millis(500));
        let now = fs::metadata(saved).map_or(0, |file| file.len());
        same = if now > 0 && now == size { same + 1 } else { 0 };
        size = now;
        same >= 20
    });
    let _ = reading.kill();
    let _ = reading.wait();
    let printed = Command::new(program).args(["rrd", "print", text(saved)]).output();
    String::from_utf8_lossy(&printed.expect("rerun prints").stdout).into_owned()
}

#[test]
fn a_viewer_that_is_killed_and_comes_back_is_told_everything_again() {
    let Some(program) = rerun() else { return };
    let place = folder("live-killed");
    let (log, port) = (place.join("flight.mcap"), free_port());
    let server = Server::at(&program, port);
    let at = format!("127.0.0.1:{port}");
    let flight = flying(&log, "14", &["--rerun", &at]);
    thread::sleep(Duration::from_secs(5));
    drop(server);
    thread::sleep(Duration::from_secs(2));
    let server = Server::at(&program, port);
    landed(flight).ends(OK).says("live: in the viewer").says("which was lost once");
    tiltrotor(&["verify", text(&log)]).ends(OK).says("exact: all 3500 ticks");
    // The second one knows what does not move, the path, the plots, the lanes, and the layout.
    let told = told_to(&program, port, &place.join("second.rrd"));
    drop(server);
    for entity in [
        "/world/ground",
        "/world/aircraft/airframe",
        "/world/path",
        "/plots/height",
        "/modes/gear",
        "/viewport",
    ] {
        assert!(told.contains(entity), "{entity} in {told}");
    }
}

#[test]
fn what_listens_and_never_answers_is_no_viewer_and_the_log_is_whole() {
    let place = folder("live-silent");
    let log = place.join("flight.mcap");
    let silent = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let at = silent.local_addr().expect("bound").to_string();
    landed(flying(&log, "4", &["--rerun", &at])).ends(OK).says("no viewer answered");
    drop(silent);
    tiltrotor(&["verify", text(&log)]).ends(OK).says("exact: all 1000 ticks");
}

#[test]
fn where_nobody_listens_a_viewer_is_started_or_its_absence_told_before_the_flight() {
    let place = folder("live-started");
    let (log, port) = (place.join("flight.mcap"), free_port());
    let at = format!("127.0.0.1:{port}");
    let fly = ["fly", "--pilot", "hover", "--fast", "--duration", "1", "--out", text(&log)];
    let with = |more: &[&str]| tiltrotor(&[&fly[..], &["--rerun", &at], more].concat());
    with(&["--viewer", "/nowhere/rerun"]).refused().says("pip install rerun-sdk==0.36.3");
    with(&["--layout", "compare"]).refused().says("--against");
    with(&["--layout", "cockpit"]).refused().says("pilot, engineer");
    assert!(!log.exists(), "flown");
    let Some(program) = rerun() else { return };
    let number = place.join("number");
    let script = place.join("viewer");
    let words = format!(
        "#!/bin/sh\n[ \"$1\" = --version ] && exec {0} --version\necho $$ >{1}\nexec {0} --serve-grpc \"$@\"\n",
        program.display(),
        number.display()
    );
    program_of(&script, &words);
    let flight = flying(&log, "4", &["--rerun", &at, "--viewer", text(&script)]);
    landed(flight).ends(OK).says("live: in the viewer started").says("rows sent");
    // It outlives the flight.
    let number = fs::read_to_string(&number).expect("it was started");
    let ended = Command::new("kill").arg(number.trim()).status().expect("a shell's kill");
    assert!(ended.success(), "the viewer had ended");
}

/// Of the times that the loop itself recorded: handing a tick over costs what it costs without a viewer.
#[test]
fn a_viewer_costs_the_loop_nothing() {
    let Some(program) = rerun() else { return };
    let place = folder("live-cost");
    let (alone, shown) = (place.join("alone.mcap"), place.join("shown.mcap"));
    let port = free_port();
    landed(flying(&alone, "8", &[])).ends(OK);
    let server = Server::at(&program, port);
    let at = format!("127.0.0.1:{port}");
    landed(flying(&shown, "8", &["--rerun", &at])).ends(OK).says("rows sent");
    drop(server);
    let (without, ticks) = spread(&alone);
    let (with, ticks_shown) = spread(&shown);
    for (what, place) in [("hand-over", 0), ("lateness", 1)] {
        println!(
            "{what}, ns, of 50, 99, 99.9 and 100 % of the ticks: {:?} without a viewer, {:?} with one",
            without[place], with[place]
        );
    }
    assert_eq!((ticks, ticks_shown), (2000, 2000));
    // Of the medians. What a busy machine does to the slowest ticks says nothing of the viewer.
    let [median, median_shown] = [without[0][0], with[0][0]];
    assert!(median_shown <= 2 * median + 10_000, "{median_shown} ns against {median} ns");
    let [late, late_shown] = [without[1][0], with[1][0]];
    assert!(late_shown <= 2 * late + 80_000, "{late_shown} ns against {late} ns");
}

/// A viewer that stands still takes nothing and does not go away: what it does not take is left out, and the
/// flight is flown and ended as if there were none.
#[test]
fn a_viewer_that_stands_still_holds_nothing_up() {
    let Some(program) = rerun() else { return };
    let place = folder("live-still");
    let (log, port) = (place.join("flight.mcap"), free_port());
    let server = Server::at(&program, port);
    let at = format!("127.0.0.1:{port}");
    let began = Instant::now();
    let flight = flying(&log, "14", &["--rerun", &at]);
    thread::sleep(Duration::from_secs(3));
    let number = server.0.id().to_string();
    let stopped = Command::new("kill").args(["-STOP", &number]).status().expect("a shell's kill");
    assert!(stopped.success(), "the viewer stands still");
    landed(flight).ends(OK).says("rows sent").says("does not have the end");
    // The end waits two seconds for the viewer.
    assert!(began.elapsed() < Duration::from_secs(40), "{:?}", began.elapsed());
    drop(server);
    tiltrotor(&["verify", text(&log)]).ends(OK).says("exact: all 3500 ticks");
    let ([hand_over, late], _) = spread(&log);
    println!(
        "hand-over {hand_over:?}, lateness {late:?}, ns, of 50, 99, 99.9 and 100 % of the ticks"
    );
    assert!(hand_over[0] < 400_000, "a tenth of a tick: {} ns", hand_over[0]);
}
