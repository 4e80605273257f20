//! `tiltrotor replay`.

use std::path::PathBuf;

use anyhow::{Result, anyhow};
use engine::{Aircraft, STEP_S};
use flightgear::{Hold, Lamps, Link, Picture};
use recorder::Pace;
use replay::judgement::disorder;
use replay::playback::{Frame, Moment};
use replay::{Facts, Playback, Reflown, ReflyOptions, ReplayError, Window};

use crate::flightgear::Scene;
use crate::link_args::{self, LinkArgs};
use crate::numbers::between;
use crate::report;
use crate::status::Status;
use crate::window::{When, WindowArgs};

/// What to refly, and where to show it.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    #[command(flatten)]
    link: LinkArgs,
    /// Times real time
    #[arg(long, default_value_t = 1.0)]
    #[arg(value_parser = between(0.01, 1000.0, "times real time"), allow_negative_numbers = true)]
    speed: f64,
    #[command(flatten)]
    window: WindowArgs,
    /// Show this moment and stand still, until Ctrl-C or for --hold seconds
    #[arg(long, value_name = "WHEN", allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["from", "until", "around", "across_versions"])]
    at: Option<When>,
    /// Fly a log of another version of the flight model too, as a comparison: exit 6, never 0
    #[arg(long, conflicts_with_all = ["from", "until", "around"])]
    across_versions: bool,
}

impl Args {
    fn window(&self) -> Result<Window> {
        let Some(at) = self.at else { return self.window.of(&self.log) };
        let tick = at.tick(&self.log)?.max(1);
        Ok(Window { from_tick: Some(tick - 1), until_tick: Some(tick), clamped: true })
    }
}

/// Reflies the log and sends its pictures, 250 a second at most.
pub fn run(args: &Args) -> Result<Status> {
    let window = args.window()?;
    let options = ReflyOptions { window, across_versions: args.across_versions };
    let playback = Playback::open(&args.log, &options, args.speed)
        .map_err(|error| anyhow!("{}: {}", args.log.display(), report::refusal(&error)))?;
    let start = playback.flight.state.tick;
    let log = args.log.clone();
    // Kept to the end: with it ends a FlightGear that was started for this.
    let mut linked = args.link.open(false, false, || Scene::of_log(&log))?;
    let link = linked.as_mut().map(|linked| std::mem::take(&mut linked.link));
    let mut showing = Showing {
        facts: Facts::of_reflight(&playback.flight),
        playback,
        link,
        last: None,
        start,
        ticks: 0,
        told: false,
        slipped_ns: 0,
    };
    let disorder = match showing.run() {
        Ok(()) => None,
        Err(error) => Some(disorder(error)?),
    };
    let Showing { mut playback, mut facts, link, last, ticks, slipped_ns, .. } = showing;
    // While the rest is said and judged, the last picture stays.
    let sent = link.as_ref().map(Link::sent).unwrap_or_default();
    let hold = link
        .filter(|link| !link.nobody_listens())
        .zip(last)
        .map(|(link, last)| Hold::start(link, last));
    facts.end_of_reflight(&mut playback.flight, disorder, &window);
    say!(
        "{}: {:.1} s reflown from {:.3} s on at {} times real time",
        args.log.display(),
        ticks as f64 * STEP_S,
        start as f64 * STEP_S,
        args.speed,
    );
    for words in link_args::in_words(&sent) {
        say!("{words}");
    }
    if slipped_ns > 0 {
        say!("the clock slipped by {:.3} s in all", slipped_ns as f64 * 1e-9);
    }
    if let Some(versions) = &playback.flight.versions() {
        say!("{versions}");
    }
    let judgement = facts.judge();
    say!("{judgement}");
    if let Some(hold) = hold {
        let link = if args.at.is_some() { &args.link.or_forever() } else { &args.link };
        link.keep(hold)?;
    }
    Ok(Status::from(&judgement))
}

/// A log being shown.
struct Showing {
    playback: Playback,
    link: Option<Link>,
    /// The picture that was sent last.
    last: Option<Picture>,
    facts: Facts,
    /// The tick of the first state.
    start: u64,
    /// Ticks reflown.
    ticks: u64,
    /// Whether it has been said that it is not the recorded flight.
    told: bool,
    slipped_ns: u64,
}

impl Showing {
    /// Shows frame after frame until the log is over.
    fn run(&mut self) -> Result<(), ReplayError> {
        let mut pace = Pace::starting_now();
        for number in 0.. {
            let woken = pace.wait(number);
            if woken.slip_ns > 0 {
                self.slipped_ns += woken.slip_ns;
                complain!("tiltrotor: {}", recorder::writer::slipped(woken.slip_ns));
            }
            let Self { playback, facts, ticks, told, start, .. } = self;
            let mut watch = |reflown: &Reflown<'_>| {
                facts.add(reflown.recorded, Some(reflown.exact));
                *ticks += 1;
                if !reflown.exact && !std::mem::replace(told, true) {
                    complain!(
                        "tiltrotor: from {:.3} s on this is not the recorded flight; `tiltrotor \
                         verify` says more",
                        (*start + *ticks) as f64 * STEP_S
                    );
                }
            };
            if playback.frame(&mut watch)?.is_none() {
                break;
            }
            let picture =
                picture(&playback.flight.aircraft, &playback.shown(), playback.is_paused());
            if let Some(link) = &mut self.link {
                link.send(&picture);
            }
            self.last = Some(picture);
        }
        Ok(())
    }
}

/// What FlightGear is to show of a frame.
fn picture(aircraft: &Aircraft, frame: &Frame<'_>, paused: bool) -> Picture {
    let lamps = Lamps { replay: true, paused, ..Lamps::default() };
    let of = |moment: &Moment| {
        let Moment { outputs, world } = moment;
        Picture::of(&flightgear::Scene { aircraft, outputs, world, lamps })
    };
    if frame.part < 1.0 {
        Picture::between(&of(frame.before), &of(frame.after), frame.part)
    } else {
        of(frame.after)
    }
}
