//! The way to FlightGear: two UDP packets a picture, three with a second aircraft, to each place, never waiting, never failing the
//! flight.
//!
//! # The newest picture wins
//! FlightGear reads everything that waits for it once a frame, and shows the last. While it stands
//! still, its system keeps the *oldest* packets, two thirds of a second of them, and drops the rest.
//! So whoever has nothing new to show goes on sending the last picture ([`Hold`](crate::Hold)): the first one
//! after FlightGear has emptied its queue is the newest.
//!
//! # Assumptions
//! The system's send buffer is the only queue here. What does not go out at once is dropped and
//! counted: the next picture is newer and says all of it again.

use std::io::{self, ErrorKind};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs, UdpSocket};

use crate::picture::Picture;

/// Where `fgfs --native-fdm=socket,in,60,127.0.0.1,5501,udp` listens.
pub const DEFAULT_DESTINATION: &str = "127.0.0.1:5501";

/// Why there is no link.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// Not a `HOST:PORT`, or a host that nobody knows.
    #[error("cannot resolve `{destination}`, expected HOST:PORT such as {DEFAULT_DESTINATION}")]
    Resolve {
        /// As given.
        destination: String,
        /// What the system says.
        source: io::Error,
    },
    /// A host without an address, or port 0.
    #[error("`{destination}` names no address and port to send to")]
    NoAddress {
        /// As given.
        destination: String,
    },
    /// No room for what goes to the ports after it.
    #[error("`{destination}`: the ports up to three after it are used too, and there are none")]
    NoNextPort {
        /// As given.
        destination: String,
    },
    /// The system gives no socket.
    #[error("cannot open a UDP socket to {address}")]
    Socket {
        /// As resolved.
        address: SocketAddr,
        /// What the system says.
        source: io::Error,
    },
}

/// What is known of who receives the pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Listener {
    /// Nothing: UDP does not tell who listens, only, on some ways, that nobody does.
    Unknown,
    /// Nobody listens at the port of FlightGear's own packets.
    Nobody,
    /// Nobody listens at the port of the second channel: FlightGear was started without it.
    NoChannel,
    /// Nobody listens at the port of the second aircraft: FlightGear was started without it.
    NoGhost,
}

/// Ports after FlightGear's own packets: of the second channel.
pub const CHANNEL_PORT: u16 = 1;
/// The same: of what FlightGear tells, at the machine of the flight.
pub const REPORT_PORT: u16 = 2;
/// The same: of a second aircraft.
pub const GHOST_PORT: u16 = 3;

/// How many pictures went to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sent {
    /// Where to; the second channel and a second aircraft go to ports after it.
    pub destination: SocketAddr,
    /// Pictures handed to the system. Whether they arrived, UDP does not say.
    pub sent: u64,
    /// Pictures that the system refused, wholly or in part.
    pub dropped: u64,
    /// What was known of the receiver last.
    pub listener: Listener,
}

/// The ways to one FlightGear or several.
#[derive(Debug, Default)]
pub struct Link {
    ways: Vec<Way>,
}

impl Link {
    /// Opens the ways to `HOST:PORT` each. Resolving a name may take its time: not for the loop.
    ///
    /// Whether anyone listens there does not matter.
    ///
    /// # Errors
    /// When one of them is no destination.
    pub fn new<S: AsRef<str>>(destinations: &[S]) -> Result<Self, LinkError> {
        let ways = destinations.iter().map(|place| Way::new(place.as_ref()));
        Ok(Self { ways: ways.collect::<Result<_, _>>()? })
    }

    /// Sends a picture. Never waits, allocates or fails.
    pub fn send(&mut self, picture: &Picture) {
        for way in &mut self.ways {
            way.send(picture);
        }
    }

    /// Counts from here on: what went before was no flight.
    pub fn count_anew(&mut self) {
        for way in &mut self.ways {
            (way.sent, way.dropped) = (0, 0);
        }
    }

    /// Where pictures go.
    pub fn destinations(&self) -> impl Iterator<Item = SocketAddr> + '_ {
        self.ways.iter().map(|way| way.fdm.destination)
    }

    /// Whether it is known that nobody listens anywhere.
    pub fn nobody_listens(&self) -> bool {
        // Nor does anybody where nothing is sent.
        self.ways.iter().all(|way| way.listener() == Listener::Nobody)
    }

    /// How many pictures went to each place.
    pub fn sent(&self) -> Vec<Sent> {
        self.ways.iter().map(Way::told).collect()
    }
}

/// The way to one FlightGear.
#[derive(Debug)]
struct Way {
    fdm: Socket,
    channel: Socket,
    ghost: Socket,
    sent: u64,
    dropped: u64,
}

impl Way {
    fn new(destination: &str) -> Result<Self, LinkError> {
        let fdm = resolve(destination)?;
        if fdm.port().checked_add(GHOST_PORT).is_none() {
            return Err(LinkError::NoNextPort { destination: destination.to_owned() });
        }
        let open = |after: u16| {
            let address = SocketAddr::new(fdm.ip(), fdm.port() + after);
            Socket::new(address).map_err(|source| LinkError::Socket { address, source })
        };
        let (channel, ghost) = (open(CHANNEL_PORT)?, open(GHOST_PORT)?);
        Ok(Self { fdm: open(0)?, channel, ghost, sent: 0, dropped: 0 })
    }

    fn send(&mut self, picture: &Picture) {
        let fdm = self.fdm.send(picture.fdm.bytes());
        let channel = self.channel.send(picture.channel.bytes());
        let ghost = picture.ghost.is_none_or(|ghost| self.ghost.send(ghost.bytes()));
        if fdm && channel && ghost {
            self.sent += 1;
        } else {
            self.dropped += 1;
        }
    }

    fn listener(&self) -> Listener {
        match (self.fdm.refused, self.channel.refused, self.ghost.refused) {
            (true, ..) => Listener::Nobody,
            (_, true, _) => Listener::NoChannel,
            (_, _, true) => Listener::NoGhost,
            _ => Listener::Unknown,
        }
    }

    fn told(&self) -> Sent {
        Sent {
            destination: self.fdm.destination,
            sent: self.sent,
            dropped: self.dropped,
            listener: self.listener(),
        }
    }
}

/// A socket that sends to one port.
#[derive(Debug)]
struct Socket {
    socket: UdpSocket,
    destination: SocketAddr,
    /// The last news was that nobody listens.
    refused: bool,
}

impl Socket {
    fn new(destination: SocketAddr) -> io::Result<Self> {
        // Bound to the loopback, nothing from outside can reach the socket.
        let local: IpAddr = match (destination.ip(), destination.ip().is_loopback()) {
            (IpAddr::V4(_), true) => Ipv4Addr::LOCALHOST.into(),
            (IpAddr::V4(_), false) => Ipv4Addr::UNSPECIFIED.into(),
            (IpAddr::V6(_), true) => Ipv6Addr::LOCALHOST.into(),
            (IpAddr::V6(_), false) => Ipv6Addr::UNSPECIFIED.into(),
        };
        let socket = UdpSocket::bind((local, 0))?;
        // Connected, so that the news that nobody listens comes back: as an error of the packet after
        // it, which is then sent once more. A network that cannot be reached now may be later.
        let connected = socket.connect(destination);
        if let Err(error) = connected
            && !is_about_the_network(&error)
        {
            return Err(error);
        }
        socket.set_nonblocking(true)?;
        Ok(Self { socket, destination, refused: false })
    }

    /// Whether the system took a packet. No error is worth the flight: a full buffer, nobody listening,
    /// a network gone.
    fn send(&mut self, bytes: &[u8]) -> bool {
        let sent = self.socket.send(bytes);
        // The error is the one before's: this packet has not gone out yet.
        self.refused = matches!(&sent, Err(error) if is_refusal(error));
        if self.refused {
            return self.socket.send(bytes).is_ok();
        }
        match sent {
            Err(error) if error.kind() == ErrorKind::NotConnected => {
                self.socket.send_to(bytes, self.destination).is_ok()
            }
            sent => sent.is_ok(),
        }
    }
}

/// Nobody listens: Windows calls it a reset.
fn is_refusal(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::ConnectionRefused | ErrorKind::ConnectionReset)
}

fn is_about_the_network(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NetworkUnreachable | ErrorKind::HostUnreachable)
}

fn resolve(destination: &str) -> Result<SocketAddr, LinkError> {
    let addresses: Vec<SocketAddr> = destination
        .to_socket_addrs()
        .map_err(|source| LinkError::Resolve { destination: destination.to_owned(), source })?
        .collect();
    choose(&addresses).ok_or_else(|| LinkError::NoAddress { destination: destination.to_owned() })
}

/// FlightGear listens on IPv4, while `localhost` often means IPv6 first.
fn choose(addresses: &[SocketAddr]) -> Option<SocketAddr> {
    let usable = || addresses.iter().copied().filter(|address| address.port() != 0);
    usable().find(SocketAddr::is_ipv4).or_else(|| usable().next())
}

#[cfg(test)]
mod tests;
