//! Where the pictures go, and for how long: what `fly`, `demo` and `replay` have in common.

use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Result;
use flightgear::{DEFAULT_DESTINATION, Hold, Link, Listener, Sent};
use recorder::Progress;

use crate::claim::Claim;
use crate::numbers;

/// Where FlightGear is.
#[derive(clap::Args, Clone)]
pub struct LinkArgs {
    /// Where a FlightGear listens: its own packets at PORT, the second channel at the port after it; may
    /// be given several times [default: 127.0.0.1:5501; nothing is sent with --fast]
    #[arg(long, value_name = "HOST:PORT")]
    flightgear: Vec<String>,
    /// Send nothing to FlightGear
    #[arg(long, conflicts_with = "flightgear")]
    no_flightgear: bool,
    /// For how long the last picture is sent again and again when all is over, s, or `forever`: a
    /// FlightGear that stood still just then shows it, too. Ctrl-C ends it; none when nobody listens
    /// [default: 7]
    #[arg(long, value_name = "SECONDS")]
    #[arg(value_parser = numbers::hold_s, allow_negative_numbers = true)]
    hold: Option<f64>,
}

/// Longer than any stall that is to be survived, s.
const HOLD_S: f64 = 7.0;

impl LinkArgs {
    /// Where the pictures go. What is as fast as it goes would fly over somebody's flight in real time.
    pub fn destinations(&self, fast: bool) -> Vec<&str> {
        match &self.flightgear[..] {
            [] if self.no_flightgear || fast => Vec::new(),
            [] => vec![DEFAULT_DESTINATION],
            given => given.iter().map(String::as_str).collect(),
        }
    }

    /// Opens the ways, warns of what will not work, and claims them for as long as the claims live.
    pub fn open(&self, fast: bool) -> Result<Option<(Link, Vec<Claim>)>> {
        let destinations = self.destinations(fast);
        if destinations.is_empty() {
            return Ok(None);
        }
        let link = Link::new(&destinations)?;
        for place in link.destinations().filter(std::net::SocketAddr::is_ipv6) {
            complain!(
                "WARNING: {place} is IPv6, and FlightGear listens on IPv4 only: give an IPv4 address"
            );
        }
        let claims = destinations.iter().map(|destination| Claim::of(destination)).collect();
        Ok(Some((link, claims)))
    }

    /// Keeps the last picture up for as long as it is to be, or until a signal; says how many pictures
    /// were sent in all.
    ///
    /// # Errors
    /// When the system refuses to tell of signals.
    pub fn keep(&self, hold: Hold) -> Result<Vec<Sent>> {
        // A signal of its own: one that ended the flight was for the flight.
        let waiting = Progress::default();
        waiting.stop_on_signals()?;
        let hold_s = self.hold.unwrap_or(HOLD_S);
        let held = Instant::now();
        while !waiting.stop.load(Ordering::Relaxed) && held.elapsed().as_secs_f64() < hold_s {
            thread::sleep(Duration::from_millis(20));
        }
        Ok(hold.finish())
    }

    /// The same, kept up for ever where nothing else is asked for.
    #[must_use]
    pub fn or_forever(&self) -> Self {
        Self { hold: self.hold.or(Some(f64::INFINITY)), ..self.clone() }
    }
}

/// How many pictures went where, a line each.
pub fn in_words(sent: &[Sent]) -> Vec<String> {
    let of = |sent: &Sent| {
        let Sent { destination, sent, dropped, listener } = sent;
        let known = match listener {
            Listener::Unknown => String::new(),
            Listener::Nobody => format!(
                "; nobody listens there: start FlightGear with --native-fdm=socket,in,60,{},{},udp",
                destination.ip(),
                destination.port()
            ),
            Listener::NoChannel => format!(
                "; nobody listens at the port after it: without --generic=socket,in,60,{},{},udp,tiltrotor \
                 nacelles, rotors and instruments do not move",
                destination.ip(),
                destination.port().saturating_add(1)
            ),
        };
        format!("{sent} pictures sent to {destination}, {dropped} not{known}")
    };
    sent.iter().map(of).collect()
}
