//! `tiltrotor replay`.

use std::path::PathBuf;

use anyhow::{Result, anyhow};
use engine::STEP_S;
use flightgear::Link;
use recorder::Pace;
use replay::judgement::disorder;
use replay::{Facts, Reflight, ReflyOptions};

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
    let mut pace = Pace::at_speed(args.speed);
    let (mut ticks, mut slipped_ns) = (0, 0);
    let mut told = false;
    let mut facts = Facts::of_reflight(&flight);
    let disorder = loop {
        let reflown = match flight.next_tick() {
            Ok(Some(reflown)) => reflown,
            Ok(None) => break None,
            Err(error) => break Some(disorder(error)?),
        };
        let woken = pace.wait(ticks);
        if woken.slip_ns > 0 {
            slipped_ns += woken.slip_ns;
            complain!("tiltrotor: {}", recorder::writer::slipped(woken.slip_ns));
        }
        link.send(reflown.outputs);
        let exact = reflown.exact;
        facts.add(reflown.recorded, Some(exact));
        flight.reader.forget();
        ticks += 1;
        if !exact && !std::mem::replace(&mut told, true) {
            complain!(
                "tiltrotor: from {:.3} s on this is not the recorded flight; `tiltrotor verify` says more",
                (start + ticks) as f64 * STEP_S
            );
        }
    };
    facts.end_of_reflight(&mut flight, disorder, &window);
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
    if slipped_ns > 0 {
        say!("the clock slipped by {:.3} s in all", slipped_ns as f64 * 1e-9);
    }
    if let Some(versions) = &flight.versions() {
        say!("{versions}");
    }
    let judgement = facts.judge();
    say!("{judgement}");
    Ok(Status::from(&judgement))
}
