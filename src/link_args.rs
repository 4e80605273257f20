//! Where the pictures go, and for how long: what `fly`, `demo` and `replay` have in common.

use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use flightgear::link::{CHANNEL_PORT, GHOST_PORT, REPORT_PORT};
use flightgear::{DEFAULT_DESTINATION, Hold, Link, Listener, Receiver, Sent};
use recorder::Progress;

use crate::claim::Claim;
use crate::flightgear::{HowArgs, Ports, Running, Scene};
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
    /// After the end, send the last picture again and again for so long, s, or `forever`: a FlightGear that
    /// stood still just then shows it, too. Ctrl-C ends it; nothing is sent when nobody listens [default: 7]
    #[arg(long, value_name = "SECONDS")]
    #[arg(value_parser = numbers::hold_s, allow_negative_numbers = true)]
    hold: Option<f64>,
    /// Start a FlightGear with our aircraft before the flight, and end it after
    #[arg(long)]
    launch_flightgear: bool,
    #[command(flatten)]
    how: HowArgs,
}

/// The ways to and from FlightGear.
pub struct Linked {
    /// The pictures' way.
    pub link: Link,
    /// What FlightGear tells; `None` where it was not wanted, or the port is taken.
    pub receiver: Option<Arc<Receiver>>,
    /// The FlightGear that was started for this.
    pub running: Option<Running>,
    _claims: Vec<Claim>,
}

/// The first start of a slow machine, with all that FlightGear prepares then.
const LAUNCH: Duration = Duration::from_secs(300);
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
    /// What FlightGear tells is wanted where it is `heard`. One that is to be started shows the scene
    /// first, and is ready when this comes back.
    pub fn open(
        &self,
        fast: bool,
        heard: bool,
        scene: impl FnOnce() -> Result<Scene>,
    ) -> Result<Option<Linked>> {
        let destinations = self.destinations(fast && !self.launch_flightgear);
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
        let mut linked = Linked { link, receiver: None, running: None, _claims: claims };
        if heard || self.launch_flightgear {
            linked.listen(self.launch_flightgear)?;
        }
        if self.launch_flightgear {
            linked.launch(&self.how, &scene()?)?;
        }
        Ok(Some(linked))
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

impl Linked {
    fn first(&self) -> Option<SocketAddr> {
        self.link.destinations().next()
    }

    /// Listens to what the first FlightGear tells, two ports after its own.
    fn listen(&mut self, needed: bool) -> Result<()> {
        let Some(first) = self.first() else { return Ok(()) };
        let Some(port) = first.port().checked_add(REPORT_PORT) else { return Ok(()) };
        match Receiver::open(first.ip(), port) {
            Ok(receiver) => self.receiver = Some(Arc::new(receiver)),
            Err(error) if needed => {
                bail!("cannot listen to FlightGear at port {port}: {error}")
            }
            Err(error) => complain!(
                "WARNING: cannot listen to FlightGear at port {port}: {error}; the ground stays flat"
            ),
        }
        Ok(())
    }

    /// Starts a FlightGear where the first pictures go, and waits until it is ready.
    fn launch(&mut self, how: &HowArgs, scene: &Scene) -> Result<()> {
        let (Some(first), Some(receiver)) = (self.first(), &self.receiver) else { return Ok(()) };
        let IpAddr::V4(listen) = first.ip() else {
            bail!("{first} is IPv6, and FlightGear listens on IPv4 only")
        };
        if !listen.is_loopback() {
            bail!("--launch-flightgear starts one on this machine, and {first} is another one");
        }
        let tell = (listen, receiver.port());
        let request = how.request(scene, Ports { port: first.port(), listen, tell })?;
        let (running, took) =
            crate::flightgear::started(&request, receiver, LAUNCH, &Progress::default())?;
        complain!("FlightGear is ready after {:.0} s", took.as_secs_f64());
        self.running = Some(running);
        Ok(())
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
                destination.port().saturating_add(CHANNEL_PORT)
            ),
            Listener::NoGhost => format!(
                "; nobody listens at port {ghost}: without --generic=socket,in,60,{},{ghost},udp,tiltrotor-ghost \
                 there is no second aircraft",
                destination.ip(),
                ghost = destination.port().saturating_add(GHOST_PORT)
            ),
        };
        format!("{sent} pictures sent to {destination}, {dropped} not{known}")
    };
    sent.iter().map(of).collect()
}
