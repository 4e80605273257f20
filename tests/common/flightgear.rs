//! A FlightGear that only listens: both its ports, and what came.

use std::net::UdpSocket;
use std::time::{Duration, Instant};

use flightgear::{Channel, GroundSample, Report};

/// FGNetFDM 24.
pub const LENGTH: usize = 408;

/// Packets, and when they came.
pub type Packets = Vec<(Instant, Vec<u8>)>;

/// What FlightGear got.
#[derive(Default)]
pub struct Heard {
    /// At its own port.
    pub fdm: Packets,
    /// At the second channel's.
    pub channel: Packets,
}

impl Heard {
    /// The packets of its own port.
    pub fn contents(&self) -> Vec<&[u8]> {
        self.fdm.iter().map(|(_, bytes)| bytes.as_slice()).collect()
    }
}

/// Both ports, in a row.
pub struct FakeFlightGear {
    /// Its own packets.
    pub fdm: UdpSocket,
    /// The second channel.
    pub channel: UdpSocket,
}

impl FakeFlightGear {
    /// At two free ports.
    pub fn new() -> Self {
        (0..100).find_map(|_| Self::at("127.0.0.1:0")).expect("two free ports in a row")
    }

    /// At that port and the one after it, if they are free.
    pub fn at(place: &str) -> Option<Self> {
        let fdm = UdpSocket::bind(place).ok()?;
        let next = fdm.local_addr().ok()?.port().checked_add(1)?;
        let channel = UdpSocket::bind(("127.0.0.1", next)).ok()?;
        for socket in [&fdm, &channel] {
            socket.set_nonblocking(true).ok()?;
        }
        Some(Self { fdm, channel })
    }

    /// `HOST:PORT` of its own port.
    pub fn place(&self) -> String {
        self.fdm.local_addr().expect("a bound socket").to_string()
    }

    /// Takes everything that comes until `over`, and what was under way then.
    pub fn listen(&self, mut over: impl FnMut() -> bool) -> Heard {
        let mut heard = Heard::default();
        loop {
            let last = over();
            let came = take(&self.fdm, &mut heard.fdm) | take(&self.channel, &mut heard.channel);
            if last {
                return heard;
            }
            if !came {
                std::thread::sleep(Duration::from_millis(1));
            }
        }
    }

    /// Throws away what waits.
    pub fn discard(&self) {
        let _ = self.listen(|| true);
    }
}

/// Takes what waits at a socket; whether there was anything.
fn take(socket: &UdpSocket, packets: &mut Packets) -> bool {
    let mut bytes = [0; 2048];
    let before = packets.len();
    while let Ok(length) = socket.recv(&mut bytes) {
        packets.push((Instant::now(), bytes[..length].to_vec()));
    }
    packets.len() > before
}

/// A big-endian double at a place of a packet.
pub fn double(packet: &[u8], at: usize) -> f64 {
    f64::from_be_bytes(packet[at..at + 8].try_into().expect("eight bytes"))
}

/// A big-endian float at a place of a packet.
pub fn single(packet: &[u8], at: usize) -> f32 {
    f32::from_be_bytes(packet[at..at + 4].try_into().expect("four bytes"))
}

/// A FlightGear that draws: it takes the newest picture, and tells of it.
pub struct DrawingFlightGear {
    /// `HOST:PORT` of its own port; what it tells goes two ports further.
    pub place: String,
    stop: std::sync::Arc<std::sync::atomic::AtomicBool>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl DrawingFlightGear {
    /// Draws sixty frames a second; `tell` makes of what is shown what is told, and may send what it likes.
    pub fn start(mut tell: impl FnMut(&Channel, &[u8]) -> Vec<Vec<u8>> + Send + 'static) -> Self {
        use std::sync::atomic::Ordering;
        let (flightgear, back) = (0..100)
            .find_map(|_| {
                let flightgear = FakeFlightGear::at("127.0.0.1:0")?;
                let port = flightgear.fdm.local_addr().ok()?.port().checked_add(2)?;
                // Free now, for the flight to listen at.
                UdpSocket::bind(("127.0.0.1", port)).ok()?;
                Some((flightgear, port))
            })
            .expect("three free ports in a row");
        let place = flightgear.place();
        let stop = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
        let stopping = std::sync::Arc::clone(&stop);
        let out = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        let thread = std::thread::spawn(move || {
            let (mut fdm, mut channel): (Vec<u8>, Option<Channel>) = (Vec::new(), None);
            while !stopping.load(Ordering::Relaxed) {
                let heard = flightgear.listen(|| true);
                fdm = heard.fdm.last().map_or(fdm, |(_, bytes)| bytes.clone());
                let newest = heard.channel.last().and_then(|(_, bytes)| Channel::parse(bytes).ok());
                channel = newest.or(channel);
                if let Some(channel) = &channel {
                    for packet in tell(channel, &fdm) {
                        let _ = out.send_to(&packet, ("127.0.0.1", back));
                    }
                }
                std::thread::sleep(Duration::from_millis(16));
            }
        });
        Self { place, stop, thread: Some(thread) }
    }
}

impl Drop for DrawingFlightGear {
    fn drop(&mut self) {
        self.stop.store(true, std::sync::atomic::Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// What FlightGear tells of a picture: its place, and level ground of that height.
pub fn report(channel: &Channel, fdm: &[u8], number: i64, ground_m: f64) -> Report {
    const PLACE_DEG_PER_RAD: f64 = 57.295_776_367_187_5;
    let latitude_deg = double(fdm, 16) * PLACE_DEG_PER_RAD;
    let longitude_deg = double(fdm, 8) * PLACE_DEG_PER_RAD;
    Report {
        tick: channel.get("tiltrotor/tick").expect("in the table"),
        elapsed_s: number as f64 / 60.0,
        scenery_loaded: true,
        latitude_deg,
        longitude_deg,
        altitude_ft: double(fdm, 24) / 0.3048,
        ground: Some(GroundSample { number, latitude_deg, longitude_deg, height_m: [ground_m; 3] }),
        ..Report::default()
    }
}
