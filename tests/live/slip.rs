//! What happens to a flight from outside: it is stopped and woken, hung up, its file may not grow, and
//! nobody reads the pipe that it is to write into.
//!
//! How far a flight has come is known from outside: it sends a packet to FlightGear every tick.

use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use engine::STEP_NS;
use logs::records::FlightEvent;
use logs::{FlightReader, OpenOptions};

use crate::common::{
    INCOMPLETE, LOG_CUT_SHORT, OK, Said, folder, hover, text, tiltrotor, understood, verify,
};

/// How long a process is stopped.
const STOPPED: Duration = Duration::from_secs(2);
/// Ticks that a burst may have beyond those that are due: what is late by less than the limit of a slip
/// is caught up, 25 ticks; on a busy machine twice.
const BURST_TICKS: u64 = 50;

fn signal(name: &str, process: u32) {
    let id = process.to_string();
    let sent = Command::new("kill").args(["-s", name, &id]).status().expect("kill runs");
    assert!(sent.success(), "{name}");
}

/// Whoever watches a flight: the packets that came.
struct Picture(UdpSocket);

impl Picture {
    fn new() -> (Self, String) {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        let address = socket.local_addr().expect("a bound socket").to_string();
        (Self(socket), address)
    }

    /// Packets that come within this time.
    fn count(&self, patience: Duration) -> u64 {
        let until = Instant::now() + patience;
        let mut packets = 0;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return packets;
            }
            self.0.set_read_timeout(Some(left)).expect("a timeout");
            packets += u64::from(self.0.recv(&mut [0; 512]).is_ok());
        }
    }

    fn wait_for_the_first(&self) {
        self.0.set_read_timeout(Some(Duration::from_secs(30))).expect("a timeout");
        self.0.recv(&mut [0; 512]).expect("it begins");
    }
}

fn begun(arguments: &[&str], picture: &Picture) -> Child {
    // Whoever runs the tests under `nohup` has SIGHUP ignored: not the flight.
    let program = Command::new("env")
        .args(["--default-signal=HUP", env!("CARGO_BIN_EXE_tiltrotor")])
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command runs");
    picture.wait_for_the_first();
    program
}

/// A flight in real time of so many seconds, under way.
fn flight(log: &Path, seconds: &str) -> (Child, Picture) {
    let (picture, address) = Picture::new();
    let arguments = [
        "fly",
        "--pilot",
        "hover",
        "--duration",
        seconds,
        "--ground",
        "flat",
        "--flightgear",
        &address,
        "--out",
        text(log),
    ];
    (begun(&arguments, &picture), picture)
}

fn landed(program: Child) -> Said {
    let output = program.wait_with_output().expect("the flight ends");
    understood("fly", &output)
}

/// Stops a process, wakes it, and returns how many packets came within a second from then on, and how
/// many could be due in the time that it really took.
fn stop_and_wake(program: &Child, picture: &Picture, step_ns: u64) -> (u64, u64) {
    signal("STOP", program.id());
    // What was on its way.
    sleep(Duration::from_millis(50));
    picture.count(Duration::from_millis(1));
    sleep(STOPPED);
    let woken = Instant::now();
    signal("CONT", program.id());
    let packets = picture.count(Duration::from_secs(1));
    (packets, woken.elapsed().as_nanos() as u64 / step_ns)
}

fn read(log: &Path) -> FlightReader {
    let mut reader = logs::open(log, OpenOptions::default()).expect("a flight log");
    while reader.next_tick().expect("whole ticks").is_some() {}
    reader
}

fn count(reader: &FlightReader, what: FlightEvent) -> usize {
    reader.events.iter().filter(|event| event.kind == what as u64).count()
}

#[test]
fn a_flight_that_was_stopped_goes_on_from_where_it_was_and_says_so() {
    let log = folder("slip").join("flight.mcap");
    let (program, picture) = flight(&log, "4");
    sleep(Duration::from_millis(500));
    let (packets, due) = stop_and_wake(&program, &picture, STEP_NS);
    assert!(packets <= due + BURST_TICKS, "{packets} ticks where {due} were due");
    let said = landed(program).ends(OK).says("flown      4.0 s, 1000 ticks");
    let said = said.says("WARNING: the clock slipped by 2.").says("slips      the clock slipped ");
    said.never_says("held up");
    verify(&log).ends(OK).says("exact: all 1000 ticks");

    let reader = read(&log);
    assert_eq!(count(&reader, FlightEvent::WriterHeldUp), 0);
    let slips_ns: Vec<u64> = reader.timings.iter().map(|timing| timing.slip_ns).collect();
    let longest_ns = slips_ns.iter().copied().max().unwrap_or(0);
    assert!(longest_ns >= STOPPED.as_nanos() as u64, "{longest_ns} ns");
    assert_eq!(count(&reader, FlightEvent::Slip), slips_ns.iter().filter(|&&ns| ns > 0).count());
    let told = reader.events.iter().filter(|event| event.kind == FlightEvent::Slip as u64);
    assert_eq!(told.map(|event| event.value).max(), Some(longest_ns / 1_000_000));

    // A part is of the flight as it was flown; what would have been was flown by no clock.
    let (part, otherwise) = (log.with_file_name("part.mcap"), log.with_file_name("whatif.mcap"));
    let whole = ["--from", "0", "--until", "4", "--out", text(&part)];
    tiltrotor(&[&["log", "clip", text(&log)], &whole[..]].concat()).ends(OK);
    assert_eq!(count(&read(&part), FlightEvent::Slip), count(&reader, FlightEvent::Slip));
    let changed = ["--fail", "scas_yaw", "--out", text(&otherwise)];
    tiltrotor(&[&["whatif", text(&log)], &changed[..]].concat()).ends(OK);
    assert_eq!(count(&read(&otherwise), FlightEvent::Slip), 0);
}

#[test]
fn a_replay_that_was_stopped_does_not_burst_either() {
    let log = folder("slip-replay").join("flight.mcap");
    hover(&log, "4");
    let (picture, address) = Picture::new();
    let program = begun(&["replay", text(&log), "--flightgear", &address], &picture);
    sleep(Duration::from_millis(200));
    let (packets, due) = stop_and_wake(&program, &picture, STEP_NS);
    assert!(packets <= due + BURST_TICKS, "{packets} ticks where {due} were due");
    landed(program).ends(OK).says("the clock slipped by 2.");
}

#[test]
fn a_flight_whose_terminal_hangs_up_lands() {
    let log = folder("hangup").join("flight.mcap");
    let (program, _picture) = flight(&log, "60");
    sleep(Duration::from_millis(300));
    signal("HUP", program.id());
    landed(program).ends(OK).says("end        ended by a signal: SIGHUP").says("nothing dropped");
    verify(&log).ends(OK).says("the log ends as its writer closed it");
    tiltrotor(&["log", "info", text(&log)]).ends(OK).says("ended by a signal: SIGHUP");
}

#[test]
fn a_flight_whose_log_may_not_grow_any_further_lands() {
    let log = folder("file-size").join("flight.mcap");
    // Blocks of 512 bytes, or of 1024 in some shells: far less than sixty seconds of flight.
    let program = env!("CARGO_BIN_EXE_tiltrotor");
    // Whoever runs the tests from Python may have SIGXFSZ ignored: not the flight.
    let line = format!(
        "ulimit -f 1000; exec env --default-signal=XFSZ '{program}' fly --pilot hover --duration 60 \
         --no-flightgear --out '{}'",
        text(&log)
    );
    let output = Command::new("sh").args(["-c", &line]).output().expect("sh runs");
    let said = understood(&line, &output).ends(LOG_CUT_SHORT);
    let said =
        said.says("ends before the flight did").says("end        ended by a signal: SIGXFSZ");
    assert!(!said.out.contains("flown      60.0 s"), "{said}");
    verify(&log).ends(INCOMPLETE).says("exact up to tick ");
}

#[test]
fn a_pipe_that_nobody_reads_is_refused_at_once() {
    let pipe: PathBuf = folder("pipe").join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let begun = Instant::now();
    tiltrotor(&[
        "fly",
        "--pilot",
        "hover",
        "--duration",
        "1",
        "--no-flightgear",
        "--force",
        "--out",
        text(&pipe),
    ])
    .refused()
    .says("nobody reads");
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
}
