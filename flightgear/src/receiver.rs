//! What FlightGear tells, received on a thread of its own: the loop takes the newest report, or none,
//! and never waits.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::report::{GroundSample, Report};

/// How long the thread waits for a packet before it looks whether it should end.
const WAIT: Duration = Duration::from_millis(50);
/// After so many packets without a pause somebody floods the port.
const FLOOD: u32 = 64;
/// Then the thread rests, so that it does not take a processor from the flight; the system drops what is
/// too much.
const REST: Duration = Duration::from_millis(1);

/// A port at which FlightGear's reports come in.
#[derive(Debug)]
pub struct Receiver {
    port: u16,
    latest: Arc<Mutex<Latest>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// What came in.
#[derive(Clone, Copy, Debug, Default)]
struct Latest {
    /// Newest, and whether nobody has taken it.
    report: Option<(Report, Instant)>,
    fresh: bool,
    reports: u64,
    refused: u64,
}

impl Receiver {
    /// Listens for the reports of a FlightGear at `from`, on this machine only if it is on this machine.
    /// Port 0 takes a free one.
    ///
    /// # Errors
    /// When the port is taken.
    pub fn open(from: IpAddr, port: u16) -> io::Result<Self> {
        let local = if from.is_loopback() { Ipv4Addr::LOCALHOST } else { Ipv4Addr::UNSPECIFIED };
        let socket = UdpSocket::bind((local, port))?;
        socket.set_read_timeout(Some(WAIT))?;
        let port = socket.local_addr()?.port();
        let latest = Arc::new(Mutex::new(Latest::default()));
        let stop = Arc::new(AtomicBool::new(false));
        let (to, stopping) = (Arc::clone(&latest), Arc::clone(&stop));
        let thread = thread::spawn(move || receive(&socket, from, &to, &stopping));
        Ok(Self { port, latest, stop, thread: Some(thread) })
    }

    /// Where it listens.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// The newest report, if there is one that was not taken before. Never waits.
    pub fn take(&self) -> Option<Report> {
        let mut latest = self.latest.try_lock().ok()?;
        if !std::mem::take(&mut latest.fresh) {
            return None;
        }
        latest.report.map(|(report, _)| report)
    }

    /// The newest ground, taken before or not. Never waits: nothing while a packet is just coming in.
    pub fn newest_ground(&self) -> Option<GroundSample> {
        self.latest.try_lock().ok()?.report?.0.ground
    }

    /// The newest report, and how old it is.
    pub fn newest(&self) -> Option<(Report, Duration)> {
        let latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        latest.report.map(|(report, came)| (report, came.elapsed()))
    }

    /// How many packets were reports, and how many were not.
    pub fn counts(&self) -> (u64, u64) {
        let latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        (latest.reports, latest.refused)
    }
}

impl Drop for Receiver {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn receive(socket: &UdpSocket, from: IpAddr, to: &Mutex<Latest>, stop: &AtomicBool) {
    let mut bytes = [0; 2048];
    let mut without_pause = 0;
    while !stop.load(Ordering::Relaxed) {
        let waited = Instant::now();
        let came = socket.recv_from(&mut bytes);
        without_pause = if waited.elapsed() > REST / 4 { 0 } else { without_pause + 1 };
        if without_pause > FLOOD {
            thread::sleep(REST);
            without_pause = 0;
        }
        let Ok((length, sender)) = came else { continue };
        let report = Some(&bytes[..length])
            .filter(|_| is_from(sender, from))
            .and_then(|bytes| Report::parse(bytes).ok());
        let mut latest = to.lock().unwrap_or_else(PoisonError::into_inner);
        match report {
            Some(report) => {
                latest.report = Some((report, Instant::now()));
                latest.fresh = true;
                latest.reports += 1;
            }
            None => latest.refused += 1,
        }
    }
}

/// A machine may send from another address of its own than it listens at, but not from another machine
/// when it is this one.
fn is_from(sender: SocketAddr, from: IpAddr) -> bool {
    sender.ip() == from || (from.is_loopback() && sender.ip().is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait_for(receiver: &Receiver, packets: u64) {
        let began = Instant::now();
        while receiver.counts().0 + receiver.counts().1 < packets {
            assert!(began.elapsed() < Duration::from_secs(10), "{:?}", receiver.counts());
            thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn the_newest_report_is_taken_once_and_garbage_never() {
        let here = IpAddr::from(Ipv4Addr::LOCALHOST);
        let receiver = Receiver::open(here, 0).expect("a port");
        assert!(receiver.take().is_none() && receiver.newest().is_none());
        let sender = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        sender.connect(("127.0.0.1", receiver.port())).expect("connected");
        for garbage in [&b""[..], b"nonsense", &[0xff; 1000]] {
            sender.send(garbage).expect("sent");
        }
        for tick in [1.0, 2.0] {
            sender.send(&Report { tick, ..Report::default() }.bytes()).expect("sent");
        }
        wait_for(&receiver, 5);
        assert_eq!(receiver.counts(), (2, 3));
        assert_eq!(receiver.take().map(|report| report.tick), Some(2.0));
        assert_eq!(receiver.take(), None);
        assert!(receiver.newest().is_some());
    }

    #[test]
    fn a_port_that_is_taken_is_told() {
        let here = IpAddr::from(Ipv4Addr::LOCALHOST);
        let first = Receiver::open(here, 0).expect("a port");
        assert!(Receiver::open(here, first.port()).is_err());
    }
}
