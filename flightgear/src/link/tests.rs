use std::sync::OnceLock;
use std::thread;
use std::time::{Duration, Instant};

use engine::inputs::World;
use engine::state::Geodetic;
use engine::{Aircraft, Outputs};

use super::*;
use crate::channel::{self, Channel};
use crate::net_fdm::{self, NetFdm};
use crate::scene::{Lamps, Scene};

/// Long enough for a loopback packet on a busy machine.
const PATIENCE: Duration = Duration::from_secs(10);

/// A FlightGear with both its ports.
struct FlightGear {
    fdm: UdpSocket,
    channel: UdpSocket,
}

impl FlightGear {
    fn new() -> Self {
        (0..100).find_map(|_| Self::at("127.0.0.1:0")).expect("two ports in a row")
    }

    fn at(place: &str) -> Option<Self> {
        let fdm = UdpSocket::bind(place).ok()?;
        let port = fdm.local_addr().ok()?.port().checked_add(1)?;
        let channel = UdpSocket::bind(("127.0.0.1", port)).ok()?;
        for socket in [&fdm, &channel] {
            socket.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        }
        Some(Self { fdm, channel })
    }

    fn address(&self) -> String {
        self.fdm.local_addr().expect("a bound socket").to_string()
    }

    fn receive(&self) -> Picture {
        let mut bytes = [0; 2 * net_fdm::LENGTH];
        let length = self.fdm.recv(&mut bytes).expect("a packet");
        let fdm = NetFdm::parse(&bytes[..length]).expect("a valid packet");
        let mut bytes = [0; 2 * channel::LENGTH];
        let length = self.channel.recv(&mut bytes).expect("a packet");
        let channel = Channel::parse(&bytes[..length]).expect("a valid packet");
        Picture { fdm, channel, ghost: None }
    }
}

fn xv15() -> &'static Aircraft {
    static XV15: OnceLock<Aircraft> = OnceLock::new();
    XV15.get_or_init(|| aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15"))
}

fn at_height(height_m: f64) -> Picture {
    let place = Geodetic { height_m, ..Geodetic::default() };
    let outputs = Outputs { place, ..Outputs::default() };
    let (world, lamps) = (World::default(), Lamps::default());
    Picture::of(&Scene { aircraft: xv15(), outputs: &outputs, world: &world, lamps })
}

fn counts(link: &Link) -> (u64, u64) {
    let sent = link.sent()[0];
    (sent.sent, sent.dropped)
}

#[test]
fn what_is_sent_arrives() {
    let flightgear = FlightGear::new();
    let mut link = Link::new(&[flightgear.address()]).expect("a link");
    for height_m in [100.0, 200.0, 300.0] {
        let picture = at_height(height_m);
        link.send(&picture);
        assert_eq!(flightgear.receive(), picture);
    }
    assert_eq!(counts(&link), (3, 0));
    assert_eq!(link.sent()[0].listener, Listener::Unknown);
    assert_eq!(
        link.destinations().next().map(|place| place.to_string()),
        Some(flightgear.address())
    );
}

#[test]
fn several_get_the_same() {
    let views = [FlightGear::new(), FlightGear::new(), FlightGear::new()];
    let mut link = Link::new(&views.each_ref().map(FlightGear::address)).expect("a link");
    link.send(&at_height(7.0));
    assert!(views.iter().all(|view| view.receive() == at_height(7.0)));
}

#[test]
fn the_local_end_of_a_loopback_link_is_on_the_loopback() {
    let flightgear = FlightGear::new();
    let link = Link::new(&[flightgear.address()]).expect("a link");
    for socket in [&link.ways[0].fdm, &link.ways[0].channel] {
        let local = socket.socket.local_addr().expect("a bound socket");
        assert!(local.ip().is_loopback() && local.port() != 0);
    }
}

#[test]
fn nobody_listening_is_known_and_no_failure_and_who_comes_late_is_served_at_once() {
    let early = FlightGear::new();
    let place = early.address();
    let mut link = Link::new(&[&place]).expect("a link");
    drop(early);
    for _ in 0..100 {
        link.send(&at_height(0.0));
    }
    assert_eq!(counts(&link), (100, 0));
    assert!(link.nobody_listens());

    let late = FlightGear::at(&place).expect("the same ports");
    link.send(&at_height(1.0));
    assert_eq!(late.receive(), at_height(1.0), "the first picture that it could hear");
    link.send(&at_height(2.0));
    assert_eq!(late.receive(), at_height(2.0));
    assert!(!link.nobody_listens());
}

#[test]
fn a_flightgear_without_the_second_channel_is_known() {
    let flightgear = FlightGear::new();
    let mut link = Link::new(&[flightgear.address()]).expect("a link");
    let FlightGear { fdm: _fdm, channel } = flightgear;
    drop(channel);
    for _ in 0..3 {
        link.send(&at_height(0.0));
    }
    assert_eq!(link.sent()[0].listener, Listener::NoChannel);
}

#[test]
fn a_receiver_that_never_reads_holds_up_nothing() {
    let deaf = FlightGear::new();
    let mut link = Link::new(&[deaf.address()]).expect("a link");
    for _ in 0..5000 {
        link.send(&at_height(0.0));
    }
    let (sent, dropped) = counts(&link);
    assert_eq!(sent + dropped, 5000);
}

#[test]
fn a_picture_that_is_held_reaches_who_wakes_late() {
    let asleep = FlightGear::new();
    let mut link = Link::new(&[asleep.address()]).expect("a link");
    // Five seconds of flight: far more than the system keeps.
    for tick in 0..1250 {
        link.send(&at_height(f64::from(tick)));
    }
    let hold = crate::Hold::start(link, at_height(9999.0));
    thread::sleep(Duration::from_millis(50));
    let woke = Instant::now();
    let is_newest = |picture: Picture| picture == at_height(9999.0);
    while !is_newest(asleep.receive()) {}
    assert!(woke.elapsed() < Duration::from_secs(1), "{:?}", woke.elapsed());
    assert!(hold.finish()[0].sent > 1250);
}

#[test]
fn of_a_host_s_addresses_flightgear_s_kind_is_taken() {
    let v6 = SocketAddr::from((Ipv6Addr::LOCALHOST, 5501));
    let v4 = SocketAddr::from((Ipv4Addr::LOCALHOST, 5501));
    assert_eq!(choose(&[v6, v4]), Some(v4));
    assert_eq!(choose(&[v6]), Some(v6));
    assert_eq!(choose(&[]), None);
}

#[test]
fn the_default_destination_is_a_destination() {
    let link = Link::new(&[DEFAULT_DESTINATION]).expect("a link");
    let places: Vec<_> = link.destinations().map(|place| place.to_string()).collect();
    assert_eq!(places, [DEFAULT_DESTINATION]);
}

#[test]
fn a_destination_that_is_none_is_named() {
    for destination in ["", "127.0.0.1", "127.0.0.1:x", "127.0.0.1:70000"] {
        let error = Link::new(&[destination]).expect_err("no link");
        assert!(matches!(error, LinkError::Resolve { .. }), "{destination}: {error}");
        assert!(error.to_string().contains(destination));
    }
    let error = Link::new(&["127.0.0.1:0"]).expect_err("no link");
    assert!(matches!(error, LinkError::NoAddress { .. }), "{error}");
    let error = Link::new(&["127.0.0.1:65535"]).expect_err("no link");
    assert!(matches!(error, LinkError::NoNextPort { .. }), "{error}");
}
