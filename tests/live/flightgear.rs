//! FlightGear gets the picture while flying, and the same picture while replaying, whatever it does
//! meanwhile.
//!
//! Packets are read here byte by byte, as FlightGear's header lays them out.

use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::thread;
use std::time::{Duration, Instant};

use flightgear::Channel;
use logs::OpenOptions;

use crate::common::flightgear::{FakeFlightGear, Heard, LENGTH, double, single};
use crate::common::{OK, Said, command, folder, said, text, tiltrotor, verify};

/// Of the flight, at 250 a second.
const TICKS: usize = 500;
/// FlightGear asks for no more than this.
const PACKETS_A_SECOND_MIN: f64 = 60.0;
/// Single and double precision, and a height above the ellipsoid.
const HEIGHT_TOLERANCE_M: f64 = 0.01;
/// More than the 250 pictures a wall second of a fast replay, on a machine that is late and catches up.
const PACKETS_A_SECOND_MAX: f64 = 300.0;

/// Runs the command with a FlightGear that listens: what it said, and what FlightGear got.
fn watched(arguments: &[&str]) -> (Said, Heard) {
    let flightgear = FakeFlightGear::new();
    let place = flightgear.place();
    let mut program = command(arguments);
    program.args(["--flightgear", &place, "--hold", "0"]);
    thread::scope(|scope| {
        let running = scope.spawn(|| said(&mut program));
        let heard = flightgear.listen(|| running.is_finished());
        (running.join().expect("what it said"), heard)
    })
}

/// Two seconds in real time, and the packets of it.
fn flight() -> &'static (PathBuf, Heard) {
    static FLIGHT: OnceLock<(PathBuf, Heard)> = OnceLock::new();
    FLIGHT.get_or_init(|| {
        let log = folder("flightgear").join("flight.mcap");
        let (said, heard) = watched(&[
            "fly",
            "--pilot",
            "hover",
            "--duration",
            "2",
            "--ground",
            "flat",
            "--out",
            text(&log),
        ]);
        said.ends(OK).says("FlightGear 500 pictures sent to 127.0.0.1:").says(", 0 not");
        (log, heard)
    })
}

#[test]
fn flightgear_gets_a_whole_picture_every_tick() {
    let (_, heard) = flight();
    let fdm = &heard.fdm[..TICKS];
    for (_, packet) in fdm {
        assert_eq!(packet.len(), LENGTH);
        assert_eq!(packet[..4], [0, 0, 0, 24], "the version, big-endian");
    }
    let took = fdm[TICKS - 1].0.duration_since(fdm[0].0);
    let rate = (TICKS - 1) as f64 / took.as_secs_f64();
    assert!(rate >= PACKETS_A_SECOND_MIN, "{rate:.0} packets a second");
    assert!(took >= Duration::from_millis(1900), "two seconds of flight took {took:?}");
    // The second channel goes along, and says which tick it is.
    let ticks: Vec<_> = heard.channel[..TICKS]
        .iter()
        .map(|(_, bytes)| Channel::parse(bytes).expect("a packet").get("tiltrotor/tick"))
        .collect();
    let expected: Vec<_> = (1..=TICKS).map(|tick| Some(tick as f64)).collect();
    assert_eq!(ticks, expected);
}

#[test]
fn flightgear_sees_the_aircraft_where_the_log_says_it_is() {
    let (log, heard) = flight();
    let mut reader = logs::open(log, OpenOptions::default()).expect("a log");
    let origin = reader.initial.plant.origin;
    let mut heights = Vec::new();
    for (_, packet) in &heard.fdm[..TICKS] {
        let state = reader.next_tick().expect("a tick").expect("a tick").record.state;
        let height_m = origin.height_m - state.plant.position_m.z;
        let (longitude, latitude) = (double(packet, 8), double(packet, 16));
        assert!((double(packet, 24) - height_m).abs() < HEIGHT_TOLERANCE_M, "{height_m}");
        assert!((latitude - origin.latitude_rad).abs() < 1e-5, "{latitude}");
        assert!((longitude - origin.longitude_rad).abs() < 1e-5, "{longitude}");
        heights.push(height_m);
    }
    assert!(heights[TICKS - 1] > heights[0], "light on its wheels: {heights:?}");
    assert!(heights.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.05), "no jumps");
}

#[test]
fn the_lamps_tell_a_flight_from_a_replay() {
    let (log, heard) = flight();
    let (_, replayed) = watched(&["replay", text(log), "--until", "0.1"]);
    let lamp = |heard: &Heard, name: &str| {
        let channel = Channel::parse(&heard.channel[0].1).expect("a packet");
        channel.get(&format!("tiltrotor/lamp/{name}")).expect("in the table")
    };
    assert_eq!((lamp(heard, "recording") as i32, lamp(heard, "replay") as i32), (1, 0));
    assert_eq!((lamp(&replayed, "recording") as i32, lamp(&replayed, "replay") as i32), (0, 1));
}

#[test]
fn a_replay_shows_flightgear_the_same_bytes_at_the_same_ticks() {
    let (log, flown) = flight();
    let (said, replayed) = watched(&["replay", text(log)]);
    said.ends(OK)
        .says("2.0 s reflown from 0.000 s on at 1 times real time")
        .says("500 pictures sent to 127.0.0.1:");
    assert!(replayed.contents()[..TICKS] == flown.contents()[..TICKS]);
    let took = replayed.fdm[TICKS - 1].0.duration_since(replayed.fdm[0].0);
    assert!(took >= Duration::from_millis(1900), "in real time: {took:?}");
}

#[test]
fn a_faster_replay_shows_some_of_the_same_pictures_and_the_last_and_no_more_a_second() {
    let (log, flown) = flight();
    let (said, replayed) = watched(&["replay", text(log), "--speed", "4"]);
    said.ends(OK).says("at 4 times real time");
    // Up to the end of the log; then the last one again, while the log is judged.
    let pictures = &replayed.contents()[..TICKS / 4];
    let mut of_flight = flown.contents().into_iter();
    assert!(pictures.iter().all(|picture| of_flight.any(|flown| flown == *picture)), "in order");
    assert_eq!(pictures.last(), flown.contents()[..TICKS].last());
    let took = replayed.fdm[pictures.len() - 1].0.duration_since(replayed.fdm[0].0);
    let rate = (pictures.len() - 1) as f64 / took.as_secs_f64();
    assert!(rate < PACKETS_A_SECOND_MAX, "{rate:.0} packets a second");
}

#[test]
fn a_slower_replay_shows_every_tick_and_what_lies_between() {
    let (log, flown) = flight();
    let (said, replayed) =
        watched(&["replay", text(log), "--from", "1", "--until", "1.2", "--speed", "0.25"]);
    said.ends(OK).says("0.2 s reflown");
    // Four for each of fifty ticks; then the last one again, while the log is judged.
    let pictures = &replayed.contents()[..200];
    for (tick, four) in pictures.chunks(4).enumerate() {
        assert!(four[3] == flown.contents()[250 + tick], "tick {}", 251 + tick);
    }
    // The rotors turn a little with every picture: none is shown twice.
    let azimuths: Vec<_> = replayed.channel[..200]
        .iter()
        .map(|(_, bytes)| Channel::parse(bytes).expect("a packet"))
        .filter_map(|channel| channel.get("tiltrotor/rotor[0]/azimuth-deg"))
        .collect();
    for pair in azimuths.windows(2) {
        let turned_deg = (pair[1] - pair[0]).rem_euclid(360.0);
        assert!((2.0..5.0).contains(&turned_deg), "{turned_deg} of 3.5 degrees");
    }
}

/// A log beside another: at any time what a replay of its own shows then, between ticks too.
#[test]
fn a_ghost_is_shown_as_by_a_replay_of_its_own() {
    let (log, flown) = flight();
    let ghost = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/gust.mcap");
    let part = ["--until", "0.3", "--speed", "0.5"];
    let alone = watched(&[&["replay", text(&ghost)], &part[..]].concat()).1;
    let flightgear = FakeFlightGear::new();
    let place = flightgear.place();
    let port = flightgear.fdm.local_addr().expect("bound").port() + 3;
    let beside = UdpSocket::bind(("127.0.0.1", port)).expect("the port of the second aircraft");
    beside.set_read_timeout(Some(Duration::from_secs(1))).expect("a timeout");
    let mut program = command(&["replay", text(log), "--ghost", text(&ghost)]);
    program.args(part).args(["--flightgear", &place, "--hold", "0"]);
    let told = said(&mut program).ends(OK).says("pictures sent to");
    assert!(!told.to_string().contains("nobody listens"), "{told}");
    let heard = flightgear.listen(|| true);
    // The first one's own pictures are none the worse for it: every other is a tick.
    assert!(
        heard.contents()[1] == flown.contents()[0] && heard.contents()[99] == flown.contents()[49]
    );
    let mut bytes = [0; 2048];
    for number in 0..150 {
        let length = beside.recv(&mut bytes).expect("a packet");
        assert!(bytes[..length] == alone.channel[number].1, "picture {number}");
    }
    // Half a second further: its picture after the first one's is that of tick 126.
    let mut program = command(&["replay", text(log), "--ghost", text(&ghost)]);
    program.args(["--ghost-ahead", "0.5", "--until", "0.1", "--flightgear", &place, "--hold", "0"]);
    said(&mut program).ends(OK);
    let ticks: Vec<_> =
        std::iter::from_fn(|| beside.recv(&mut bytes).ok().map(|length| bytes[..length].to_vec()))
            .filter_map(|packet| Channel::parse(&packet).expect("a packet").get("tiltrotor/tick"))
            .collect();
    assert!(ticks.contains(&126.0) && ticks.last() == Some(&150.0), "{ticks:?}");
    let lost = ["replay", text(log), "--ghost", "there-is-none.mcap", "--no-flightgear"];
    tiltrotor(&lost).refused().says("there-is-none.mcap");
}

#[test]
fn a_moment_is_shown_until_told_to_stop() {
    let (log, flown) = flight();
    let flightgear = FakeFlightGear::new();
    let place = flightgear.place();
    let arguments = ["replay", text(log), "--at", "1", "--flightgear", &place];
    let mut showing = command(&arguments).spawn().expect("the command runs");
    let until = Instant::now() + Duration::from_secs(3);
    let heard = flightgear.listen(|| Instant::now() > until);
    assert!(showing.try_wait().expect("a status").is_none(), "it goes on");
    let told = Command::new("kill").args(["-INT", &showing.id().to_string()]).status();
    assert!(told.expect("kill").success());
    assert!(showing.wait().expect("a status").success());
    let pictures = heard.contents();
    assert!(pictures.len() > 166, "{}", pictures.len());
    assert!(pictures.iter().all(|picture| *picture == flown.contents()[249]), "tick 250 only");
}

#[test]
fn every_place_gets_the_picture() {
    let log = folder("flightgear-several").join("flight.mcap");
    let views = [FakeFlightGear::new(), FakeFlightGear::new(), FakeFlightGear::new()];
    let mut program = command(&["fly", "--pilot", "hover", "--duration", "0.5", "--hold", "0"]);
    program.args(["--ground", "flat"]);
    program.args(["--out", text(&log)]);
    for view in &views {
        program.args(["--flightgear", &view.place()]);
    }
    let said = said(&mut program).ends(OK);
    let heard = views.map(|view| view.listen(|| true));
    for heard in &heard {
        assert!(heard.fdm.len() >= 125, "{}", heard.fdm.len());
    }
    assert!(heard.iter().all(|view| view.contents()[..125] == heard[0].contents()[..125]));
    assert_eq!(said.out.matches("FlightGear 125 pictures sent to").count(), 3, "{said}");
}

/// The whole of what a frozen FlightGear meets: its system keeps the oldest packets, and the flight ends
/// while it stands still.
#[test]
fn frozen_over_the_end_of_a_flight_it_shows_the_end_when_it_wakes() {
    let log = folder("flightgear-frozen").join("flight.mcap");
    let flightgear = FakeFlightGear::new();
    let place = flightgear.place();
    let arguments =
        ["fly", "--pilot", "hover", "--duration", "2", "--flightgear", &place, "--out", text(&log)];
    let arguments = [&arguments[..], &["--ground", "flat"]].concat();
    let began = Instant::now();
    let mut flying = command(&arguments).spawn().expect("the command runs");
    // Frozen from 1 s on for 5 s; the flight is over after two.
    thread::sleep(Duration::from_secs(1));
    flightgear.discard();
    thread::sleep(Duration::from_secs(5));
    let woke = Instant::now();
    let heard = flightgear.listen(|| woke.elapsed() > Duration::from_secs(1));
    let newest = Channel::parse(&heard.channel.last().expect("packets").1).expect("a packet");
    assert_eq!(newest.get("tiltrotor/tick"), Some(500.0), "the end of the flight");
    assert!(heard.fdm.last().expect("packets").1 == heard.fdm[heard.fdm.len() - 2].1, "it stays");
    assert!(flying.wait().expect("a status").success());
    assert!(began.elapsed() < Duration::from_secs(30), "and it ends by itself");
    verify(&log).ends(OK);
}

#[test]
fn killed_and_restarted_it_gets_the_newest_picture_and_the_log_is_exact() {
    let log = folder("flightgear-restarted").join("flight.mcap");
    let first = FakeFlightGear::new();
    let place = first.place();
    let arguments =
        ["fly", "--pilot", "hover", "--duration", "3", "--flightgear", &place, "--out", text(&log)];
    let arguments = [&arguments[..], &["--ground", "flat"]].concat();
    let mut flying = command(&arguments).arg("--hold").arg("0").spawn().expect("it runs");
    // Killed well after the flight began, however long that took.
    let mut seen = 0;
    let _ = first.listen(|| {
        seen += 1;
        seen > 1000
    });
    drop(first);
    thread::sleep(Duration::from_millis(500));
    let second = FakeFlightGear::at(&place).expect("the same ports");
    let heard = second.listen(|| flying.try_wait().expect("a status").is_some());
    let ticks: Vec<_> = heard
        .channel
        .iter()
        .filter_map(|(_, bytes)| Channel::parse(bytes).expect("a packet").get("tiltrotor/tick"))
        .collect();
    assert!(ticks[0] > 100.0, "the newest, not the first: {}", ticks[0]);
    assert!(ticks.windows(2).all(|pair| pair[1] >= pair[0]), "never back");
    assert_eq!(ticks.last(), Some(&750.0));
    verify(&log).ends(OK);
}

#[test]
fn nobody_listening_is_said_and_no_reason_not_to_fly() {
    let log = folder("flightgear-nobody").join("flight.mcap");
    let to = FakeFlightGear::new().place();
    let out = text(&log);
    let flight = ["fly", "--pilot", "hover", "--duration", "0.5", "--out", out];
    let began = Instant::now();
    tiltrotor(&[&flight[..], &["--flightgear", &to]].concat())
        .ends(OK)
        .says("FlightGear 125 pictures sent to")
        .says("nobody listens there: start FlightGear with --native-fdm=socket,in,60,127.0.0.1,");
    assert!(began.elapsed() < Duration::from_secs(7), "nothing is kept up for nobody");
    verify(Path::new(out)).ends(OK);
}

#[test]
fn a_flightgear_without_the_second_channel_is_told_apart() {
    let log = folder("flightgear-half").join("flight.mcap");
    let FakeFlightGear { fdm, channel } = FakeFlightGear::new();
    drop(channel);
    let to = fdm.local_addr().expect("bound").to_string();
    let out = text(&log);
    let flight = ["fly", "--pilot", "hover", "--duration", "0.2", "--out", out, "--hold", "0"];
    tiltrotor(&[&flight[..], &["--flightgear", &to]].concat())
        .ends(OK)
        .says("nobody listens at the port after it: without --generic=socket,in,60,127.0.0.1,");
}

#[test]
fn as_fast_as_it_goes_a_flight_sends_no_more_than_a_display_can_show() {
    let log = folder("flightgear-fast").join("flight.mcap");
    let began = Instant::now();
    let arguments = ["fly", "--pilot", "hover", "--fast", "--duration", "20", "--out", text(&log)];
    let (said, heard) = watched(&arguments);
    let took_s = began.elapsed().as_secs_f64();
    said.ends(OK);
    let most = (took_s * PACKETS_A_SECOND_MAX) as usize + 1;
    assert!(heard.fdm.len() <= most.min(5000), "{} packets in {took_s:.1} s", heard.fdm.len());
    assert!(single(&heard.fdm[0].1, 36).is_finite());
}

#[test]
fn a_destination_that_is_none_is_refused() {
    let log = folder("flightgear-none").join("flight.mcap");
    for destination in
        ["nonsense", "127.0.0.1", "127.0.0.1:0", "127.0.0.1:99999", "127.0.0.1:65535"]
    {
        let out = text(&log);
        let flight = ["fly", "--pilot", "hover", "--fast", "--duration", "1", "--out", out];
        tiltrotor(&[&flight[..], &["--flightgear", destination]].concat())
            .refused()
            .says(destination);
        assert!(!log.exists(), "nothing was begun");
    }
}

#[test]
fn an_ipv6_destination_is_warned_about() {
    if UdpSocket::bind("[::1]:0").is_err() {
        // A machine without IPv6 refuses the socket: nothing to warn of.
        return;
    }
    let log = folder("flightgear-v6").join("flight.mcap");
    let out = text(&log);
    let flight = ["fly", "--pilot", "hover", "--fast", "--duration", "0.1", "--out", out];
    tiltrotor(&[&flight[..], &["--flightgear", "[::1]:5601"]].concat())
        .ends(OK)
        .says("WARNING: [::1]:5601 is IPv6, and FlightGear listens on IPv4 only");
}
