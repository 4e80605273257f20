//! The way to FlightGear: one UDP packet at a time, never waiting, never failing the flight.
//!
//! # Assumptions
//! The system's send buffer is the only queue. What does not go out at once is dropped and counted:
//! the next packet is newer and says all of it again.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs, UdpSocket};

use engine::Outputs;

use crate::net_fdm::NetFdm;

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
    /// The system gives no socket.
    #[error("cannot open a UDP socket to {address}")]
    Socket {
        /// As resolved.
        address: SocketAddr,
        /// What the system says.
        source: io::Error,
    },
}

/// A socket that sends to one FlightGear.
#[derive(Debug)]
pub struct Link {
    socket: UdpSocket,
    destination: SocketAddr,
    sent: u64,
    dropped: u64,
}

impl Link {
    /// Opens the way to `HOST:PORT`. Resolving a name may take its time: not for the loop.
    ///
    /// Whether anyone listens there does not matter.
    pub fn new(destination: &str) -> Result<Self, LinkError> {
        let destination = resolve(destination)?;
        let socket = open(destination)
            .map_err(|source| LinkError::Socket { address: destination, source })?;
        Ok(Self { socket, destination, sent: 0, dropped: 0 })
    }

    /// Sends what FlightGear is to show of a step. Never waits, allocates or fails.
    pub fn send(&mut self, outputs: &Outputs) {
        let packet = NetFdm::from_outputs(outputs);
        // No error is worth the flight: a full buffer, nobody listening, a network gone.
        match self.socket.send_to(packet.bytes(), self.destination) {
            Ok(_) => self.sent += 1,
            Err(_) => self.dropped += 1,
        }
    }

    /// Where packets go.
    pub fn destination(&self) -> SocketAddr {
        self.destination
    }

    /// Packets handed to the system. Whether they arrived, UDP does not say.
    pub fn sent(&self) -> u64 {
        self.sent
    }

    /// Packets that the system refused.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
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

fn open(destination: SocketAddr) -> io::Result<UdpSocket> {
    // Bound to the loopback, nothing from outside can reach the socket.
    let local: IpAddr = match (destination.ip(), destination.ip().is_loopback()) {
        (IpAddr::V4(_), true) => Ipv4Addr::LOCALHOST.into(),
        (IpAddr::V4(_), false) => Ipv4Addr::UNSPECIFIED.into(),
        (IpAddr::V6(_), true) => Ipv6Addr::LOCALHOST.into(),
        (IpAddr::V6(_), false) => Ipv6Addr::UNSPECIFIED.into(),
    };
    let socket = UdpSocket::bind((local, 0))?;
    // Not connected: the news that nobody listens would come back as an error of the next packet,
    // and cost the first one that someone would hear.
    socket.set_nonblocking(true)?;
    Ok(socket)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use engine::state::Geodetic;

    use super::*;
    use crate::net_fdm::LENGTH;

    /// Long enough for a loopback packet on a busy machine.
    const PATIENCE: Duration = Duration::from_secs(10);

    fn receiver(address: &str) -> UdpSocket {
        let socket = UdpSocket::bind(address).expect("a loopback socket");
        socket.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        socket
    }

    fn address(socket: &UdpSocket) -> String {
        socket.local_addr().expect("a bound socket").to_string()
    }

    fn receive(socket: &UdpSocket) -> NetFdm {
        let mut bytes = [0; LENGTH + 1];
        let length = socket.recv(&mut bytes).expect("a packet");
        NetFdm::parse(&bytes[..length]).expect("a valid packet")
    }

    fn at_height(height_m: f64) -> Outputs {
        Outputs { place: Geodetic { height_m, ..Geodetic::default() }, ..Outputs::default() }
    }

    #[test]
    fn what_is_sent_arrives() {
        let flightgear = receiver("127.0.0.1:0");
        let mut link = Link::new(&address(&flightgear)).expect("a link");
        for height_m in [100.0, 200.0, 300.0] {
            let outputs = at_height(height_m);
            link.send(&outputs);
            assert_eq!(receive(&flightgear), NetFdm::from_outputs(&outputs));
        }
        assert_eq!((link.sent(), link.dropped()), (3, 0));
        assert_eq!(link.destination().to_string(), address(&flightgear));
    }

    #[test]
    fn the_local_end_of_a_loopback_link_is_on_the_loopback() {
        let flightgear = receiver("127.0.0.1:0");
        let link = Link::new(&address(&flightgear)).expect("a link");
        let local = link.socket.local_addr().expect("a bound socket");
        assert!(local.ip().is_loopback() && local.port() != 0);
    }

    #[test]
    fn nobody_listening_is_no_failure_and_who_comes_late_is_served() {
        let early = receiver("127.0.0.1:0");
        let place = address(&early);
        let mut link = Link::new(&place).expect("a link");
        drop(early);
        for _ in 0..100 {
            link.send(&Outputs::default());
        }
        assert_eq!((link.sent(), link.dropped()), (100, 0));

        let late = receiver(&place);
        link.send(&at_height(1.0));
        assert_eq!(receive(&late), NetFdm::from_outputs(&at_height(1.0)));
    }

    #[test]
    fn a_receiver_that_never_reads_holds_up_nothing() {
        let deaf = receiver("127.0.0.1:0");
        let mut link = Link::new(&address(&deaf)).expect("a link");
        for _ in 0..5000 {
            link.send(&Outputs::default());
        }
        assert_eq!(link.sent() + link.dropped(), 5000);
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
        let link = Link::new(DEFAULT_DESTINATION).expect("a link");
        assert_eq!(link.destination().to_string(), DEFAULT_DESTINATION);
    }

    #[test]
    fn a_destination_that_is_none_is_named() {
        for destination in ["", "127.0.0.1", "127.0.0.1:x", "127.0.0.1:70000"] {
            let error = Link::new(destination).expect_err("no link");
            assert!(matches!(error, LinkError::Resolve { .. }), "{destination}: {error}");
            assert!(error.to_string().contains(destination));
        }
        let error = Link::new("127.0.0.1:0").expect_err("no link");
        assert!(matches!(error, LinkError::NoAddress { .. }), "{error}");
    }
}
