//! `tiltrotor replay`.

mod keys;

use std::path::PathBuf;

use anyhow::{Result, anyhow};
use engine::{Aircraft, STEP_S};
use flightgear::{Channel, Hold, Lamps, Link, Picture};
use indicatif::{ProgressBar, ProgressStyle};
use recorder::Pace;
use replay::judgement::{disorder, judge};
use replay::playback::{Frame, Moment};
use replay::{Facts, Playback, Reflown, ReflyOptions, ReplayError, Window};

use crate::flightgear::Scene;
use crate::link_args::{self, LinkArgs};
use crate::numbers::between;
use crate::report;
use crate::status::Status;
use crate::window::{When, WindowArgs};
use keys::Keys;

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
    /// Show a second XV-15 beside the first: another log, at the same time since its beginning
    #[arg(long, value_name = "LOG")]
    ghost: Option<PathBuf>,
    /// Show the second XV-15 so many seconds further in its flight than the first, or less for a negative
    /// number
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, requires = "ghost")]
    #[arg(value_parser = between(-86_400.0, 86_400.0, "s"), allow_negative_numbers = true)]
    ghost_ahead: f64,
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
    let open = |log: &PathBuf, window| {
        Playback::open(log, &ReflyOptions { window, ..options }, args.speed)
            .map_err(|error| anyhow!("{}: {}", log.display(), report::refusal(&error)))
    };
    let playback = open(&args.log, window)?;
    // Which part of it is shown, the first one says.
    let ghost = args.ghost.as_ref().map(|log| open(log, Window::default())).transpose()?;
    let ahead_ticks = args.ghost_ahead / STEP_S;
    let ghost = ghost.map(|playback| Ghost { playback, ahead_ticks });
    let start = playback.flight.state.tick;
    let log = args.log.clone();
    // Kept to the end: with it ends a FlightGear that was started for this.
    let mut linked = args.link.open(false, false, || Scene::of_log(&log))?;
    let link = linked.as_mut().map(|linked| std::mem::take(&mut linked.link));
    let mut showing = Showing::of(playback, ghost, link)?;
    let disorder = match showing.run() {
        Ok(()) => None,
        Err(error) => Some(disorder(error)?),
    };
    let Showing {
        mut playback,
        mut facts,
        link,
        last,
        ticks,
        slipped_ns,
        keys,
        told,
        stopped,
        bar,
        ..
    } = showing;
    bar.finish_and_clear();
    drop(keys);
    let whole = playback.is_whole() || disorder.is_some();
    // While the rest is said and judged, the last picture stays.
    let sent = link.as_ref().map(Link::sent).unwrap_or_default();
    let hold = link
        .filter(|link| !link.nobody_listens())
        .zip(last)
        .map(|(link, last)| Hold::start(link, last));
    if whole {
        facts.end_of_reflight(&mut playback.flight, disorder, &window);
    }
    say!(
        "{}: {:.1} s reflown from {:.3} s on at {} times real time",
        args.log.display(),
        ticks as f64 * STEP_S,
        start as f64 * STEP_S,
        playback.speed(),
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
    // Of what was not shown from beginning to end, only reading says what it is.
    let judgement = if whole { facts.judge() } else { judge(&args.log, &window) };
    say!("{judgement}");
    if let Some(hold) = hold.filter(|_| !stopped) {
        let link = if args.at.is_some() { &args.link.or_forever() } else { &args.link };
        link.keep(hold)?;
    }
    let status = Status::from(&judgement);
    Ok(if told && !whole { Status::gravest([status, Status::Differs]) } else { status })
}

/// A log being shown.
struct Showing {
    playback: Playback,
    /// Another log, beside it.
    ghost: Option<Ghost>,
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
    /// Where somebody sits at a terminal.
    keys: Option<Keys>,
    /// Whether it was ended by a key.
    stopped: bool,
    /// Where it is, in a line.
    bar: ProgressBar,
}

impl Showing {
    /// At its beginning, with the keys of the terminal if there is one.
    fn of(playback: Playback, ghost: Option<Ghost>, link: Option<Link>) -> Result<Self> {
        let keys = Keys::take();
        if keys.is_some() {
            complain!("{}\r", keys::HELP);
        }
        Ok(Self {
            facts: Facts::of_reflight(&playback.flight),
            start: playback.flight.state.tick,
            playback,
            ghost,
            link,
            last: None,
            ticks: 0,
            told: false,
            slipped_ns: 0,
            keys,
            stopped: false,
            bar: ProgressBar::new_spinner().with_style(ProgressStyle::with_template("{msg}")?),
        })
    }

    /// Shows frame after frame until the log is over.
    fn run(&mut self) -> Result<(), ReplayError> {
        let mut pace = Pace::starting_now();
        // Where keys come one by one, a line does not begin at the left by itself.
        let end = if self.keys.is_some() { "\r" } else { "" };
        let mut number = 0;
        loop {
            let woken = pace.wait(number);
            number += 1;
            if woken.slip_ns > 0 {
                self.slipped_ns += woken.slip_ns;
                let slipped = recorder::writer::slipped(woken.slip_ns);
                self.bar.suspend(|| complain!("tiltrotor: {slipped}{end}"));
            }
            let key = self.keys.as_ref().and_then(Keys::next);
            let Self { playback, facts, ticks, told, start, bar, .. } = self;
            let mut watch = |reflown: &Reflown<'_>| {
                facts.add(reflown.recorded, Some(reflown.exact));
                *ticks += 1;
                if !reflown.exact && !std::mem::replace(told, true) {
                    let from_s = reflown.outputs.tick as f64 * STEP_S;
                    bar.suspend(|| {
                        complain!(
                            "tiltrotor: from {from_s:.3} s on this is not the recorded flight; \
                             `tiltrotor verify` says more{end}"
                        );
                    });
                }
            };
            if let Some(key) = key {
                let Some(command) = key.command(playback, *start) else {
                    self.stopped = true;
                    break;
                };
                playback.obey(command, &mut watch)?;
                // To fly there took time that nobody has to catch up.
                (pace, number) = (Pace::starting_now(), 0);
            }
            // At the end, whoever has keys may go back.
            if playback.frame(&mut watch)?.is_none() && self.keys.is_none() {
                break;
            }
            self.show_place(number);
            let Self { playback, .. } = self;
            let paused = playback.is_paused();
            let mut picture = picture(&playback.flight.aircraft, &playback.shown(), paused);
            if let Some(ghost) = &mut self.ghost {
                picture.ghost = Some(ghost.beside(playback.tick())?);
            }
            if let Some(link) = &mut self.link {
                link.send(&picture);
            }
            self.last = Some(picture);
        }
        Ok(())
    }

    /// Says where it is, ten times a second.
    fn show_place(&self, frame: u64) {
        if self.keys.is_none() || !frame.is_multiple_of(25) {
            return;
        }
        let (playback, paused) = (&self.playback, self.playback.is_paused());
        let how = match (playback.has_ended(), paused) {
            (true, _) => "the end: Home goes back, Q ends".into(),
            (_, true) => "paused".into(),
            _ => format!("{} times real time", playback.speed()),
        };
        self.bar.set_message(format!("{:9.3} s  {how}", playback.tick() * STEP_S));
        self.bar.tick();
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

/// Another log, shown beside the first.
struct Ghost {
    playback: Playback,
    /// How much further it is in its flight.
    ahead_ticks: f64,
}

impl Ghost {
    /// What is to be seen of it when the first one has come to a tick.
    fn beside(&mut self, tick: f64) -> Result<Channel, ReplayError> {
        let Self { playback, ahead_ticks } = self;
        playback.follow(tick + *ahead_ticks, &mut |_| {})?;
        Ok(picture(&playback.flight.aircraft, &playback.shown(), playback.is_paused()).channel)
    }
}
