//! A FlightGear that only listens: both its ports, and what came.

use std::net::UdpSocket;
use std::time::{Duration, Instant};

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
