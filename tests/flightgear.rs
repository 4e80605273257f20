//! FlightGear gets the picture while flying, and the same picture while replaying.
//!
//! Packets are read here byte by byte, as FlightGear's header lays them out.

mod common;

use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::thread;
use std::time::{Duration, Instant};

use common::{OK, Said, command, folder, said, text, tiltrotor, verify};
use logs::OpenOptions;

/// FGNetFDM 24.
const LENGTH: usize = 408;
/// Of the flight, at 250 a second.
const TICKS: usize = 500;
/// FlightGear asks for no more than this.
const PACKETS_A_SECOND_MIN: f64 = 60.0;
/// Single and double precision, and a height above the ellipsoid.
const HEIGHT_TOLERANCE_M: f64 = 0.01;

/// A packet, and when it came.
type Packet = (Instant, Vec<u8>);

/// Runs the command with a FlightGear that listens: what it said, and what FlightGear got.
fn watched(arguments: &[&str]) -> (Said, Vec<Packet>) {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    socket.set_read_timeout(Some(Duration::from_millis(200))).expect("a timeout");
    let destination = socket.local_addr().expect("a bound socket").to_string();
    let mut program: Command = command(arguments);
    program.args(["--flightgear", &destination]);
    thread::scope(|scope| {
        let running = scope.spawn(|| said(&mut program));
        let mut packets = Vec::new();
        let mut bytes = [0; 2 * LENGTH];
        // To its end, and until nothing more comes.
        loop {
            let over = running.is_finished();
            match socket.recv(&mut bytes) {
                Ok(length) => packets.push((Instant::now(), bytes[..length].to_vec())),
                Err(_) if over => break,
                Err(_) => {}
            }
        }
        (running.join().expect("what it said"), packets)
    })
}

/// Two seconds in real time, and the packets of it.
fn flight() -> &'static (PathBuf, Vec<Packet>) {
    static FLIGHT: OnceLock<(PathBuf, Vec<Packet>)> = OnceLock::new();
    FLIGHT.get_or_init(|| {
        let log = folder("flightgear").join("flight.mcap");
        let (said, packets) =
            watched(&["fly", "--pilot", "hover", "--duration", "2", "--out", text(&log)]);
        said.ends(OK).says("FlightGear 500 packets sent, 0 not");
        (log, packets)
    })
}

fn contents(packets: &[Packet]) -> Vec<&[u8]> {
    packets.iter().map(|(_, bytes)| bytes.as_slice()).collect()
}

/// Big-endian, at a place of the header.
fn number(packet: &[u8], at: usize) -> f64 {
    f64::from_be_bytes(packet[at..at + 8].try_into().expect("eight bytes"))
}

#[test]
fn flightgear_gets_a_whole_picture_every_tick() {
    let (_, packets) = flight();
    assert_eq!(packets.len(), TICKS);
    for (_, packet) in packets {
        assert_eq!(packet.len(), LENGTH);
        assert_eq!(packet[..4], [0, 0, 0, 24], "the version, big-endian");
    }
    let took = packets[TICKS - 1].0.duration_since(packets[0].0);
    let rate = (TICKS - 1) as f64 / took.as_secs_f64();
    assert!(rate >= PACKETS_A_SECOND_MIN, "{rate:.0} packets a second");
    assert!(took >= Duration::from_millis(1900), "two seconds of flight took {took:?}");
}

#[test]
fn flightgear_sees_the_aircraft_where_the_log_says_it_is() {
    let (log, packets) = flight();
    let mut reader = logs::open(log, OpenOptions::default()).expect("a log");
    let origin = reader.initial.plant.origin;
    let mut heights = Vec::new();
    for (_, packet) in packets {
        let state = reader.next_tick().expect("a tick").expect("a tick").record.state;
        let height_m = origin.height_m - state.plant.position_m.z;
        let (longitude, latitude) = (number(packet, 8), number(packet, 16));
        assert!((number(packet, 24) - height_m).abs() < HEIGHT_TOLERANCE_M, "{height_m}");
        assert!((latitude - origin.latitude_rad).abs() < 1e-5, "{latitude}");
        assert!((longitude - origin.longitude_rad).abs() < 1e-5, "{longitude}");
        heights.push(height_m);
    }
    assert!(heights[TICKS - 1] > heights[0], "light on its wheels: {heights:?}");
    assert!(heights.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.05), "no jumps");
}

#[test]
fn a_replay_shows_flightgear_the_same_bytes_at_the_same_ticks() {
    let (log, flown) = flight();
    let (said, replayed) = watched(&["replay", text(log)]);
    said.ends(OK).says("2.0 s reflown from 0.000 s on at 1 times real time, 500 packets sent");
    assert!(contents(&replayed) == contents(flown), "{} packets", replayed.len());
    let took = replayed[TICKS - 1].0.duration_since(replayed[0].0);
    assert!(took >= Duration::from_millis(1900), "in real time: {took:?}");
}

#[test]
fn a_faster_replay_shows_the_same_pictures() {
    let (log, flown) = flight();
    let (said, replayed) = watched(&["replay", text(log), "--speed", "4"]);
    said.ends(OK).says("at 4 times real time");
    assert!(contents(&replayed) == contents(flown), "{} packets", replayed.len());
}

#[test]
fn nobody_listening_is_no_reason_not_to_fly() {
    let log = folder("flightgear-nobody").join("flight.mcap");
    let free = UdpSocket::bind("127.0.0.1:0").expect("a socket").local_addr().expect("bound");
    let out = text(&log);
    let to = free.to_string();
    let flight = ["fly", "--pilot", "hover", "--fast", "--duration", "1", "--out", out];
    tiltrotor(&[&flight[..], &["--flightgear", &to]].concat())
        .ends(OK)
        .says("FlightGear 250 packets sent, 0 not");
    verify(Path::new(out)).ends(OK);
}

#[test]
fn a_destination_that_is_none_is_refused() {
    let log = folder("flightgear-none").join("flight.mcap");
    for destination in ["nonsense", "127.0.0.1", "127.0.0.1:0", "127.0.0.1:99999"] {
        let out = text(&log);
        let flight = ["fly", "--pilot", "hover", "--fast", "--duration", "1", "--out", out];
        tiltrotor(&[&flight[..], &["--flightgear", destination]].concat())
            .refused()
            .says(destination);
        assert!(!log.exists(), "nothing was begun");
    }
}
