//! `tiltrotor replay`.

use std::path::PathBuf;

use anyhow::{Result, anyhow, bail};
use engine::STEP_S;
use flightgear::Link;
use logs::Ending;
use recorder::Pace;
use replay::{Reflight, ReflyOptions};

use crate::claim::Claim;
use crate::numbers::between;
use crate::report;
use crate::status::Status;
use crate::window::WindowArgs;

/// What to refly, and where to show it.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Where FlightGear listens (--native-fdm=socket,in,60,HOST,PORT,udp)
    #[arg(long, value_name = "HOST:PORT", default_value = flightgear::DEFAULT_DESTINATION)]
    flightgear: String,
    /// Times real time
    #[arg(long, default_value_t = 1.0)]
    #[arg(value_parser = between(0.01, 1000.0, "times real time"), allow_negative_numbers = true)]
    speed: f64,
    #[command(flatten)]
    window: WindowArgs,
    /// Fly a log of another version of the flight model too, as a comparison: exit 6, never 0
    #[arg(long, conflicts_with_all = ["from", "until", "around"])]
    across_versions: bool,
}

/// Reflies the log and sends every tick's picture.
pub fn run(args: &Args) -> Result<Status> {
    let window = args.window.of(&args.log)?;
    let options = ReflyOptions { window, across_versions: args.across_versions };
    let mut flight = Reflight::open(&args.log, &options)
        .map_err(|error| anyhow!("{}: {}", args.log.display(), report::refusal(&error)))?;
    let start = flight.state.tick;
    let mut link = Link::new(&args.flightgear)?;
    let _claim = Claim::of(&args.flightgear);
    let pace = Pace::at_speed(args.speed);
    let mut ticks = 0;
    let mut first_difference = None;
    while let Some(reflown) = flight.next_tick()? {
        pace.wait(ticks);
        link.send(reflown.outputs);
        let exact = reflown.exact;
        flight.reader.forget();
        ticks += 1;
        if !exact && first_difference.is_none() {
            first_difference = Some(ticks);
            complain!(
                "tiltrotor: from {:.3} s on this is not the recorded flight; `tiltrotor verify` says more",
                (start + ticks) as f64 * STEP_S
            );
        }
    }
    say!(
        "{}: {:.1} s reflown from {:.3} s on at {} times real time, {} packets sent to {}, {} not",
        args.log.display(),
        ticks as f64 * STEP_S,
        start as f64 * STEP_S,
        args.speed,
        link.sent(),
        link.destination(),
        link.dropped()
    );
    let versions = flight.versions();
    if let Some(versions) = &versions {
        say!("{versions}");
    }
    let comparison = versions.is_some_and(|versions| versions.comparison());
    match flight.ending() {
        Ending::Closed | Ending::Truncated if comparison => Ok(Status::Compared),
        Ending::Closed if first_difference.is_some() => Ok(Status::Differs),
        Ending::Closed => Ok(Status::Done),
        Ending::Truncated => {
            let log = args.log.display();
            complain!("tiltrotor: {log}: it ends there without having been closed");
            Ok(Status::NeverClosed)
        }
        Ending::Damaged(why) => {
            bail!("{}: the file is damaged after that: {why}", args.log.display())
        }
    }
}
