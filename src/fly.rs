//! `tiltrotor fly`.

mod flying;
mod hardware;
mod live;
mod plan;
mod progress;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use engine::STEP_S;
use engine::cockpit;
use logs::output;
use recorder::pilots;
use recorder::script::Script;
use recorder::situation;
use recorder::{End, Landing};

use crate::status::Status;
use crate::texts::{name_of, read};
use crate::{controls, numbers, report};
use live::Live;
use plan::{Air, on_a_terminal, pilot_names};
pub use plan::{Common, Plan};

/// What flies, from where, and where it is recorded.
#[derive(clap::Args)]
pub struct Args {
    /// Fly with the sticks that are plugged in
    #[arg(long)]
    stick: bool,
    /// Let a pilot model fly
    #[arg(long, value_name = "NAME", long_help = plan::pilots_in_words())]
    pilot: Option<String>,
    /// Play the timed events of a file
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Fly with the keys of this terminal; `--controls` lists them
    #[arg(long)]
    keyboard: bool,
    /// Say what moves the aircraft in such a flight, and fly nothing
    #[arg(long)]
    controls: bool,
    /// Fly with FlightGear's own stick, keyboard and mouse
    #[arg(long)]
    flightgear_controls: bool,
    /// Cockpit map for --stick: a file, or the name of a shipped one (without: of the shipped ones
    /// those for what is plugged in)
    #[arg(long, value_name = "FILE", requires = "stick")]
    map: Option<PathBuf>,
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    air: Air,
    /// Begin at a start position: runway, hover-50ft, approach-60, downwind
    #[arg(long, value_name = "NAME", conflicts_with_all = ["scenario", "from_trim"])]
    start: Option<String>,
    /// Begin with a situation that was saved before
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from_trim", "start"])]
    situation: Option<PathBuf>,
    /// When a tick is later than this, set the clock anew (a slip, told and recorded) instead of catching up, ms
    #[arg(long, value_name = "MS", default_value_t = 100.0)]
    #[arg(value_parser = numbers::between(5.0, 10_000.0, "ms"), allow_negative_numbers = true)]
    slip_limit: f64,
    /// Sleep until this long before a tick is due, and spin for the rest, µs
    #[arg(long, value_name = "US", default_value_t = 200.0)]
    #[arg(value_parser = numbers::between(0.0, 4000.0, "µs"), allow_negative_numbers = true)]
    spin_us: f64,
    /// Keep the loop on this processor, counted from 0
    #[arg(long, value_name = "N")]
    #[arg(value_parser = crate::numbers::processor, allow_negative_numbers = true)]
    cpu: Option<usize>,
    /// Show a line of progress instead of the panel
    #[arg(long, conflicts_with = "keyboard")]
    no_panel: bool,
    /// End the flight after this long, s
    #[arg(long, value_name = "SECONDS")]
    #[arg(value_parser = numbers::duration_s, allow_negative_numbers = true)]
    duration: Option<f64>,
    /// Refly each second on a spare thread while flying, and warn when a bit is not the same
    #[arg(long)]
    self_check: bool,
    #[command(flatten)]
    live: live::LiveArgs,
}

/// Flies, and sums up.
pub fn run(args: &Args) -> Result<Status> {
    if args.controls {
        return say_controls(args);
    }
    let live = Live::wanted(&args.live)?;
    let mut plan = Plan::new(&args.common, args.start.as_deref())?;
    plan.live = live;
    plan.keep_time(args.slip_limit, args.spin_us, args.cpu);
    if let Some(file) = &args.situation {
        plan.flight.situation = Some(situation::load(file, &plan.flight.aircraft.name)?);
    }
    plan.flight.self_check = args.self_check;
    let inputs: Vec<&Path> = [&args.map, &args.script, &args.situation]
        .into_iter()
        .filter_map(|file| file.as_deref())
        .collect();
    output::refuse(&args.common.out, args.common.force, &inputs)?;
    if let Some(seconds) = args.duration {
        plan.flight.ticks_max = Some((seconds / STEP_S).round() as u64);
    }
    if args.air.from_trim {
        plan.begin_in(&args.air)?;
    }
    let virtual_hands = args.pilot.is_some() || args.script.is_some();
    if !args.stick && !args.keyboard && !virtual_hands && !args.flightgear_controls {
        bail!(
            "nobody flies: give --stick, --keyboard, --flightgear-controls, --script FILE or --pilot NAME, one of {}",
            pilot_names()
        );
    }
    if args.keyboard {
        plan.look_for_keys(args.common.fast)?;
    }
    let mut map = cockpit::Params::default();
    if args.stick {
        plan.plug_in(&mut map, args.map.as_deref())?;
    }
    if virtual_hands {
        let pilot = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP)?;
        map.device.extend(pilot.device);
    }
    if let Some(name) = &args.pilot {
        plan.set_pilot(name, &map)?;
    }
    if let Some(path) = &args.script {
        let text = read(path)?;
        plan.flight.controllers.push(Box::new(Script::parse(&name_of(path), &text, &map)?));
        plan.flown_by(&format!("script {}", path.file_name().unwrap_or_default().display()));
    }
    if args.flightgear_controls {
        plan.add_flightgear(&mut map)?;
    }
    let real_time = plan.flight.real_time.is_some();
    plan.panel = args.keyboard || (real_time && !args.no_panel && on_a_terminal());
    if plan.panel {
        // Whoever else flies: freeze, reset, failures and weather are on keys.
        plan.add_keyboard(&mut map, args.keyboard)?;
    }
    plan.set_map(map)?;
    if let (Some(name), None, true) = (&args.pilot, args.duration, args.common.fast)
        && !pilots::lands(name)
    {
        bail!("the {name} pilot never lands: give --duration SECONDS with --fast");
    }
    let _linked = plan.connect()?;
    plan.live.as_mut().map_or(Ok(()), Live::begin)?;
    let mut landing = plan.fly()?;
    report::landing(&landing, real_time, &args.common.out.display().to_string());
    args.common.hold(&mut landing)?;
    Ok(if is_whole(&landing) { Status::Done } else { Status::CutShort })
}

/// Whether the flight was flown and recorded as it was to be; who ends it may do so.
pub fn is_whole(landing: &Landing) -> bool {
    landing.log.is_ok() && !matches!(landing.end, End::GaveUp(_))
}

/// Says what moves the aircraft.
fn say_controls(args: &Args) -> Result<Status> {
    if args.stick {
        hardware::say_controls(args.map.as_deref())?;
    }
    if args.keyboard || !args.stick {
        controls::keyboard().iter().for_each(|line| say!("{line}"));
    }
    Ok(Status::Done)
}
