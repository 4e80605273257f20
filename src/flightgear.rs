//! `tiltrotor flightgear`: FlightGear with our aircraft, found, started, and ready.

mod command_line;
mod find;
mod launch;
mod scene;

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use flightgear::Receiver;
use flightgear::link::REPORT_PORT;
use recorder::Progress;

pub use command_line::{Ports, Request};
pub use find::Found;
pub use launch::Running;
pub use scene::Scene;

use crate::status::Status;

/// Which FlightGear, and what it is to show first.
#[derive(clap::Args)]
pub struct Args {
    /// Only say the command line
    #[arg(long)]
    print: bool,
    /// The port of FlightGear's own packets; the second channel is at the next one, what FlightGear
    /// tells goes to the one after that, and the port after that one is for a second aircraft
    #[arg(long, default_value_t = 5501)]
    #[arg(value_parser = crate::numbers::port, allow_negative_numbers = true)]
    port: u16,
    /// The address at which it listens: 0.0.0.0 for flights on other machines
    #[arg(long, default_value_t = Ipv4Addr::LOCALHOST)]
    listen: Ipv4Addr,
    /// The machine of the flight, where what FlightGear tells goes
    #[arg(long, value_name = "ADDRESS", default_value_t = Ipv4Addr::LOCALHOST)]
    tell: Ipv4Addr,
    /// Begin where and when a log begins
    #[arg(long, value_name = "LOG", conflicts_with = "scenario")]
    log: Option<PathBuf>,
    /// Begin where a scenario begins, with its wind (Hilo, runway 26, calm air without)
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    #[command(flatten)]
    how: HowArgs,
    /// For how long it may take to become ready, s
    #[arg(long, value_name = "SECONDS", default_value_t = 300.0)]
    #[arg(value_parser = crate::numbers::duration_s, allow_negative_numbers = true)]
    patience: f64,
    /// End it as soon as it is ready
    #[arg(long, hide = true)]
    only_until_ready: bool,
}

/// How FlightGear is started, wherever it is started.
#[derive(clap::Args, Clone, Default)]
pub struct HowArgs {
    /// FlightGear's program (looked for in the usual places without)
    #[arg(long, value_name = "FILE")]
    fgfs: Option<PathBuf>,
    /// The folder with our `Aircraft` and `data` (the program's own without)
    #[arg(long, value_name = "FOLDER")]
    aircraft_dir: Option<PathBuf>,
    /// Download scenery while flying: on where there is a network, without this option
    #[arg(long, value_name = "ON|OFF")]
    terrasync: Option<Switch>,
    /// One more argument for FlightGear; may be given several times
    #[arg(long = "fgfs-arg", value_name = "ARGUMENT", allow_hyphen_values = true)]
    extra: Vec<String>,
}

/// On or off.
#[derive(clap::ValueEnum, Clone, Copy, PartialEq, Eq)]
enum Switch {
    On,
    Off,
}

/// Finds FlightGear and says or runs its command.
pub fn run(args: &Args) -> Result<Status> {
    let scene = match (&args.log, &args.scenario) {
        (Some(log), _) => Scene::of_log(log)?,
        (None, scenario) => {
            let path = scenario.as_deref();
            let (name, text) =
                crate::texts::text_or(path, "default.toml", aircraft::DEFAULT_SCENARIO)?;
            Scene { start: Some(aircraft::start(&name, &text)?), moment: None }
        }
    };
    let ports =
        Ports { port: args.port, listen: args.listen, tell: (args.tell, args.port + REPORT_PORT) };
    let request = args.how.request(&scene, ports)?;
    if args.print {
        say!("{}", request.in_a_shell());
        return Ok(Status::Done);
    }
    let receiver =
        Receiver::open(IpAddr::V4(args.tell), args.port + REPORT_PORT).with_context(|| {
            format!("port {} is taken: a flight is under way?", args.port + REPORT_PORT)
        })?;
    let stop = Progress::default();
    let (mut running, took) =
        started(&request, &receiver, Duration::from_secs_f64(args.patience), &stop)?;
    say!("FlightGear is ready after {:.0} s: start a flight now", took.as_secs_f64());
    // The flight listens there from now on.
    drop(receiver);
    while !stop.stop.load(Ordering::Relaxed) && !args.only_until_ready {
        if let Some(ended) = running.ended()? {
            if !ended.success() {
                bail!("FlightGear ended with {ended}\n{}", running.last_words());
            }
            return Ok(Status::Done);
        }
        thread::sleep(Duration::from_millis(100));
    }
    Ok(Status::Done)
}

/// A FlightGear that draws, and how long that took; the wait ends with a signal too.
pub fn started(
    request: &Request,
    receiver: &Receiver,
    patience: Duration,
    stop: &Progress,
) -> Result<(Running, Duration)> {
    let mut running = Running::start(request)?;
    complain!(
        "FlightGear starts; the first time it takes minutes. What it says: {}",
        running.log()
    );
    stop.stop_on_signals()?;
    let took = running.ready(receiver, patience, &stop.stop)?;
    Ok((running, took))
}

impl HowArgs {
    /// What is to be run: FlightGear as it is found here, with what it lacks said in words.
    pub fn request(&self, scene: &Scene, ports: Ports) -> Result<Request> {
        let found = Found::look(self.fgfs.as_deref())?;
        let package = match &self.aircraft_dir {
            Some(folder) => flightgear::package::Package::in_folder(folder),
            None => flightgear::package::Package::unpack(&find::cache())
                .with_context(|| format!("cannot write under {}", find::cache().display()))?,
        };
        if !package.aircraft.join("XV-15/xv15-set.xml").is_file() {
            bail!("no XV-15/xv15-set.xml in {}", package.aircraft.display());
        }
        let terrasync = match self.terrasync {
            Some(switch) => switch == Switch::On,
            None => find::has_network(),
        };
        if let Some(start) = &scene.start {
            let origin = &start.origin;
            let (latitude_deg, longitude_deg) = (
                engine::units::degrees(origin.latitude_rad),
                engine::units::degrees(origin.longitude_rad),
            );
            if !found.has_scenery(latitude_deg, longitude_deg) {
                let hope = if terrasync {
                    "TerraSync will look for it (untested: it needs FlightGear's servers)"
                } else {
                    "FlightGear will show the sea; --terrasync on downloads it (untested)"
                };
                complain!(
                    "WARNING: no scenery is installed at {latitude_deg:.2}, {longitude_deg:.2}: {hope}"
                );
            }
        }
        Ok(Request {
            fgfs: found.program,
            package,
            ports,
            scene: scene.clone(),
            terrasync,
            extra: self.extra.clone(),
        })
    }
}
