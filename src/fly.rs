//! `tiltrotor fly`.

mod hardware;
mod live;

use std::fs;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use engine::cockpit;
use engine::{Aircraft, STEP_S};
use flightgear::{Link, Receiver};
use indicatif::{ProgressBar, ProgressStyle};
use logs::Setup;
use logs::output;
use logs::records::FlightEvent;
use logs::view::Level;
use recorder::flightgear_controls::FlightGearControls;
use recorder::keyboard::{Keyboard, Orders};
use recorder::pilots::{self, PILOTS, Pilot};
use recorder::script::Script;
use recorder::situation;
use recorder::{
    End, Flight, Landing, Progress, RealTime, Restart, Shown, Snapshot, Told, check_clock, fly,
};

use crate::flightgear::Scene;
use crate::ground::{self, Whose};
use crate::link_args::{LinkArgs, Linked};
use crate::panel::{Cockpit, Panel};
use crate::status::Status;
use crate::texts::{name_of, read, text_or};
use crate::{controls, identity, numbers, report};
use live::{Live, beside};

/// What flies, from where, and where it is recorded.
#[derive(clap::Args)]
pub struct Args {
    /// Fly with the sticks that are plugged in
    #[arg(long)]
    stick: bool,
    /// Let a pilot model fly: hover, demo, takeoff, convert, turn, reconvert, land, sideways,
    /// sweep-pitch, sweep-roll, sweep-yaw, sweep-lever
    #[arg(long, value_name = "NAME")]
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

/// The steady flight in which a flight begins.
#[derive(clap::Args)]
struct Air {
    /// Begin in the air, in steady flight
    #[arg(long)]
    from_trim: bool,
    /// Nacelle incidence of that flight: 90 helicopter, 0 aeroplane, deg
    #[arg(long, value_name = "DEG", requires = "from_trim", default_value_t = 90.0)]
    #[arg(value_parser = numbers::nacelle_deg, allow_negative_numbers = true)]
    nacelle: f64,
    /// True airspeed, kt
    #[arg(long, value_name = "KT", requires = "from_trim", default_value_t = 0.0)]
    #[arg(value_parser = numbers::speed_kt, allow_negative_numbers = true)]
    speed_kt: f64,
    /// Above mean sea level, ft
    #[arg(long, value_name = "FT", requires = "from_trim", default_value_t = 1000.0)]
    #[arg(value_parser = numbers::altitude_ft, allow_negative_numbers = true)]
    altitude_ft: f64,
    /// Rate of climb, ft/min
    #[arg(long, value_name = "FPM", requires = "from_trim", default_value_t = 0.0)]
    #[arg(value_parser = numbers::climb_fpm, allow_negative_numbers = true)]
    climb_fpm: f64,
    /// Flap lever, one of its detents: the XV-15's are 0, 20, 40 and 75 deg (without: the one next to 40 with
    /// nacelles above 75 deg, to 20 above 15, else to 0)
    #[arg(long, value_name = "DEG", requires = "from_trim")]
    #[arg(value_parser = numbers::flap_deg, allow_negative_numbers = true)]
    flap: Option<f64>,
    /// Rotor speed, rpm (without: the slowest below 1 deg of nacelle)
    #[arg(long, value_name = "RPM", requires = "from_trim")]
    #[arg(value_parser = numbers::rotor_rpm, allow_negative_numbers = true)]
    rpm: Option<f64>,
    /// SCAS off from the beginning: the bare airframe
    #[arg(long, requires = "from_trim")]
    scas_off: bool,
}

/// What `fly` and `demo` have in common.
#[derive(clap::Args)]
pub struct Common {
    /// As fast as it goes instead of in real time
    #[arg(long)]
    pub fast: bool,
    /// Aircraft file (the XV-15 without)
    #[arg(long, value_name = "FILE")]
    pub aircraft: Option<PathBuf>,
    /// Scenario: where and how the flight begins (Hilo, runway 26, calm air without)
    #[arg(long, value_name = "FILE")]
    pub scenario: Option<PathBuf>,
    /// The log to be written
    #[arg(long, value_name = "FILE", default_value = "flight.mcap")]
    pub out: PathBuf,
    /// Overwrite an existing log
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub link: LinkArgs,
    /// Whose ground the wheels stand on
    #[arg(long, value_enum, default_value_t)]
    ground: ground::Whose,
}

impl Common {
    /// Keeps the last picture up in FlightGear, for as long as it is to be.
    pub fn hold(&self, landing: &mut Landing) -> Result<()> {
        match landing.hold.take() {
            Some(hold) => self.link.keep(hold).map(|_| ()),
            None => Ok(()),
        }
    }
}

/// Flies, and sums up.
pub fn run(args: &Args) -> Result<Status> {
    if args.controls {
        return say_controls(args);
    }
    let live = Live::wanted(&args.live)?;
    let mut plan = Plan::new(&args.common, args.start.as_deref())?;
    plan.live = live;
    plan.keep_time(args);
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
            "nobody flies: give --stick, --keyboard, --flightgear-controls, --script FILE or --pilot NAME, one of{}",
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
    }
    if args.flightgear_controls {
        plan.add_flightgear(&mut map)?;
    }
    let real_time = plan.flight.real_time.is_some();
    plan.panel = args.keyboard || (real_time && !args.no_panel && on_a_terminal());
    if plan.panel {
        // Whoever else flies: freeze, reset, failures and weather are on keys.
        plan.add_keyboard(&mut map)?;
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

/// A flight being prepared.
pub struct Plan {
    /// What will be flown.
    pub flight: Flight,
    /// The pipe that the log goes into, if it does, kept open.
    pipe: Option<fs::File>,
    /// Names of the pilot model's phases, for the line of progress.
    phases: Vec<&'static str>,
    /// What the crew calls its devices.
    names: hardware::Named,
    /// Where the keys go.
    orders: Option<Orders>,
    /// Whether there is a panel, or a line of progress.
    panel: bool,
    /// Where its pictures go.
    pub linked: Option<Linked>,
    /// In which viewer it is shown.
    live: Option<Live>,
    /// Whose ground.
    ground: Whose,
}

impl Plan {
    /// Aircraft, scenario, log and link; hands and cockpit map are still to come.
    pub fn new(common: &Common, start: Option<&str>) -> Result<Self> {
        let (aircraft_name, aircraft_toml) =
            text_or(common.aircraft.as_deref(), "xv15.toml", aircraft::XV15)?;
        let aircraft = aircraft::aircraft(&aircraft_name, &aircraft_toml)?;
        let (scenario_name, scenario_toml) = match start {
            Some(name) => (name.to_string(), start_position(name)?.to_string()),
            None => {
                text_or(common.scenario.as_deref(), "default.toml", aircraft::DEFAULT_SCENARIO)?
            }
        };
        let start = aircraft::start(&scenario_name, &scenario_toml)?;
        let fuel_kg_max = aircraft.weight_balance.fuel_kg_max;
        if let Some(fuel_kg) = start.fuel_kg
            && fuel_kg > fuel_kg_max
        {
            bail!(
                "{scenario_name}: fuel of {:.0} kg: the tanks of {} hold {fuel_kg_max:.0} kg",
                fuel_kg,
                aircraft.name
            );
        }
        let robot_description = aircraft::urdf(&aircraft);
        let wants_ground = match common.ground {
            Whose::Auto => !common.fast,
            whose => whose == Whose::Flightgear,
        };
        // Its controls are wanted, or may be: the port is free while no flight is under way.
        let heard = !common.fast || wants_ground;
        let scene = || Ok(Scene { start: Some(start.clone()), moment: None });
        let linked = common.link.open(common.fast, heard, scene)?;
        if linked.is_none() && common.ground == Whose::Flightgear {
            bail!(
                "--ground flightgear: nothing is sent to FlightGear; give --flightgear HOST:PORT"
            );
        }
        let inputs: Vec<&Path> =
            [&common.aircraft, &common.scenario].into_iter().filter_map(|f| f.as_deref()).collect();
        output::refuse(&common.out, common.force, &inputs)?;
        let pipe = recorder::open_pipe(&common.out)
            .with_context(|| format!("cannot write {}", common.out.display()))?;
        Ok(Self {
            pipe,
            phases: Vec::new(),
            names: hardware::Named::default(),
            orders: None,
            panel: false,
            linked,
            live: None,
            ground: if wants_ground { common.ground } else { Whose::Flat },
            flight: Flight {
                aircraft,
                start,
                setup: Setup { aircraft_toml, cockpit_toml: String::new(), scenario_toml },
                identity: identity::identity(),
                robot_description,
                controllers: Vec::new(),
                #[cfg(feature = "sticks")]
                sticks: None,
                out: common.out.clone(),
                force: common.force,
                real_time: (!common.fast).then(RealTime::default),
                situation: None,
                ticks_max: None,
                link: None,
                self_check: false,
            },
        })
    }

    /// Gives the flight its way to FlightGear, and what comes back from there; what is returned is to be
    /// kept until all is over.
    pub fn connect(&mut self) -> Result<Option<Linked>> {
        let Some(mut linked) = self.linked.take() else { return Ok(None) };
        let wanted = self.ground != Whose::Flat && self.flight.situation.is_none();
        let receiver = linked.receiver.clone().filter(|_| wanted);
        let link = std::mem::take(&mut linked.link);
        self.flight.link = Some(match receiver {
            Some(receiver) => self.settle(link, &receiver)?,
            None => link,
        });
        Ok(Some(linked))
    }

    /// FlightGear's ground under the wheels, where it is to be and is: the flight begins on it.
    fn settle(&mut self, link: Link, receiver: &Arc<Receiver>) -> Result<Link> {
        let Flight { aircraft, start, .. } = &self.flight;
        let (link, ground_m) = ground::found(self.ground, aircraft, start, link, receiver)?;
        let Some(ground_m) = ground_m else { return Ok(link) };
        if start.trim.is_none() {
            let scenario = ground::scenario_at(&self.flight.setup.scenario_toml, ground_m)?;
            self.flight.start = aircraft::start("scenario.toml", &scenario)?;
            self.flight.setup.scenario_toml = scenario;
        }
        complain!("ground: FlightGear's, {ground_m:.2} m above sea level where the flight begins");
        let hand = ground::hand(receiver, &self.flight.start, &self.flight.aircraft);
        self.flight.controllers.insert(0, Box::new(hand));
        Ok(link)
    }

    /// Lets FlightGear's own controls fly.
    fn add_flightgear(&mut self, map: &mut cockpit::Params) -> Result<()> {
        let receiver = self.linked.as_ref().and_then(|linked| linked.receiver.clone());
        let Some(receiver) = receiver else {
            bail!(
                "--flightgear-controls: FlightGear is not listened to; give --flightgear HOST:PORT"
            )
        };
        let ours = aircraft::cockpit("flightgear.toml", aircraft::FLIGHTGEAR_MAP)?;
        map.device.extend(ours.device);
        let hand = FlightGearControls::new(receiver, map);
        self.flight
            .controllers
            .extend(hand.map(|hand| Box::new(hand) as Box<dyn recorder::Controller>));
        Ok(())
    }

    /// Begins in steady flight: the scenario says so, and goes into the log with it.
    fn begin_in(&mut self, air: &Air) -> Result<()> {
        if self.flight.start.trim.is_some() {
            bail!("--from-trim: the scenario begins in the air already, by its table [trim]");
        }
        let wanted = analysis::condition::Condition {
            nacelle_deg: air.nacelle,
            speed_kt: air.speed_kt,
            altitude_ft: air.altitude_ft,
            climb_fpm: air.climb_fpm,
            flap_deg: air.flap,
            rpm: air.rpm,
            scas_on: !air.scas_off,
            ..analysis::condition::Condition::default()
        };
        let table = wanted.start_toml(&self.flight.aircraft, "--from-trim")?;
        let scenario = &mut self.flight.setup.scenario_toml;
        scenario.push_str(&table);
        self.flight.start = aircraft::start("scenario.toml", scenario)?;
        Ok(())
    }

    /// Lets the pilot model of that name fly.
    pub fn set_pilot(&mut self, name: &str, map: &cockpit::Params) -> Result<()> {
        let Some(pilot) = Pilot::named(name, map, &self.flight.aircraft) else {
            bail!("no pilot model is called `{name}`; there are{}", pilot_names());
        };
        self.phases = pilot.phases();
        self.flight.controllers.push(Box::new(pilot));
        Ok(())
    }

    /// How punctual the loop is to be.
    fn keep_time(&mut self, args: &Args) {
        if let Some(real_time) = &mut self.flight.real_time {
            real_time.slip_limit_ns = (args.slip_limit * 1e6).round() as u64;
            real_time.spin_ns = (args.spin_us * 1e3).round() as u64;
            real_time.cpu = args.cpu;
        }
    }

    /// Whether keys can fly.
    fn look_for_keys(&self, fast: bool) -> Result<()> {
        if fast {
            bail!("--keyboard flies in real time: leave out --fast");
        }
        if !on_a_terminal() {
            bail!("--keyboard needs a terminal: neither its keys nor its screen can be had here");
        }
        Ok(())
    }

    /// Lets the keys fly.
    fn add_keyboard(&mut self, map: &mut cockpit::Params) -> Result<()> {
        let own = aircraft::cockpit("keyboard.toml", aircraft::KEYBOARD_MAP)?;
        map.device.extend(own.device);
        let (keyboard, orders) = Keyboard::of(map).context("the map has no keyboard")?;
        self.flight.controllers.push(Box::new(keyboard));
        self.orders = Some(orders);
        Ok(())
    }

    /// The cockpit map as flown.
    pub fn set_map(&mut self, map: cockpit::Params) -> Result<()> {
        self.flight.setup.cockpit_toml = toml::to_string(&map)?;
        let aircraft = self.flight.aircraft.clone();
        self.flight.aircraft = aircraft.with_cockpit(map);
        Ok(())
    }

    fn plug_in(&mut self, map: &mut cockpit::Params, path: Option<&Path>) -> Result<()> {
        self.names = hardware::plug_in(&mut self.flight, map, path)?;
        Ok(())
    }

    /// Flies with the panel, or with a line of progress on a terminal.
    pub fn fly(self) -> Result<Landing> {
        if self.panel {
            return self.fly_with_panel();
        }
        let progress = Progress::default();
        progress.stop_on_signals()?;
        let bar = ProgressBar::new_spinner();
        bar.set_style(ProgressStyle::with_template("{spinner} {msg}")?);
        let Self { flight, pipe: _pipe, phases, names, live, .. } = self;
        let real_time = flight.real_time.is_some();
        let live = live.map(|live| live.ready(&flight, &progress));
        let flown = || {
            thread::scope(|scope| {
                let flying = scope.spawn(|| fly(flight, &progress));
                let mut told = Snapshot::default();
                let mut punctual = Punctual::default();
                while !flying.is_finished() {
                    thread::sleep(Duration::from_millis(100));
                    let now = progress.now();
                    if let Some(warning) = progress.shown().and_then(|shown| punctual.look(&shown))
                    {
                        bar.suspend(|| complain!("WARNING: {warning}"));
                    }
                    bar.set_message(line(&now, &phases));
                    bar.tick();
                    // As fast as it goes, nobody could act on it.
                    for event in progress.told().iter().filter(|event| real_time && is_new(event)) {
                        let at_s = event.tick as f64 * STEP_S;
                        bar.suspend(|| complain!("{at_s:.1} s: {}", event.words));
                    }
                    for warning in warnings(&told, &now) {
                        bar.suspend(|| complain!("WARNING: {warning}"));
                    }
                    for line in names.lines(&told, &now) {
                        bar.suspend(|| complain!("{line}"));
                    }
                    told = now;
                }
                flying.join()
            })
        };
        let landing = beside(live, &progress, flown);
        bar.finish_and_clear();
        let landing = landing.map_err(|_| anyhow::anyhow!("the flight died of a fault of ours"))?;
        Ok(landing?)
    }
}

impl Plan {
    /// Flies with the panel.
    fn fly_with_panel(self) -> Result<Landing> {
        let progress = Progress::default();
        progress.stop_on_signals()?;
        let Self { flight, pipe: _pipe, phases, orders, names, live, .. } = self;
        let live = live.map(|live| live.ready(&flight, &progress));
        let verdict = flight
            .real_time
            .map_or_else(String::new, |wanted| check_clock(wanted, CLOCK_CHECK).verdict());
        complain!("{verdict}");
        let aircraft = flight.aircraft.clone();
        let cockpit = Cockpit {
            log: flight.out.display().to_string(),
            aircraft: aircraft.name.clone(),
            envelope: aircraft.envelope.clone(),
            phases,
            verdict,
            controls: controls::lines(&aircraft.cockpit, names.names()),
            keys_fly: orders.is_some(),
        };
        let panel = Panel {
            cockpit,
            orders,
            situation: flight.situation,
            start: Box::new(move |place| {
                let (name, _, text) = aircraft::STARTS.get(place)?;
                Some(reposition(name, text, &aircraft))
            }),
        };
        let flown = || {
            thread::scope(|scope| {
                let flying = scope.spawn(|| fly(flight, &progress));
                let told = panel.show(&progress, || !flying.is_finished());
                if told.is_err() {
                    // Without its panel a flight by hand cannot go on.
                    progress.stop.store(true, Ordering::Relaxed);
                }
                (flying.join(), told)
            })
        };
        let (landing, told) = beside(live, &progress, flown);
        for told in told? {
            complain!("{:.1} s: {}", told.tick as f64 * STEP_S, told.words);
        }
        let landing = landing.map_err(|_| anyhow::anyhow!("the flight died of a fault of ours"))?;
        Ok(landing?)
    }
}

/// How long the clock is tried before a flight with the panel.
const CLOCK_CHECK: Duration = Duration::from_millis(500);

/// Whether keys can be had and a screen is there.
fn on_a_terminal() -> bool {
    std::io::stdin().is_terminal() && std::io::stderr().is_terminal()
}

/// The scenario of a start position.
fn start_position(name: &str) -> Result<&'static str> {
    let known = aircraft::STARTS.iter().find(|(known, ..)| *known == name);
    let Some((_, _, text)) = known else {
        let names: Vec<String> =
            aircraft::STARTS.iter().map(|(name, what, _)| format!("{name}: {what}")).collect();
        bail!("no start position is called `{name}`; there are {}", names.join("; "));
    };
    Ok(text)
}

/// The state of a start position, to go on from.
fn reposition(name: &str, text: &str, aircraft: &Aircraft) -> Result<Restart> {
    let start = aircraft::start(name, text)?;
    Ok(Restart::Reposition(analysis::start::state_at(&start, aircraft)?))
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

/// Where the flight is, in a line.
fn line(now: &Snapshot, phases: &[&str]) -> String {
    // Phases count from 1; 0 is before the first.
    let phase = usize::try_from(now.phase)
        .ok()
        .and_then(|number| phases.get(number.checked_sub(1)?).copied());
    format!(
        "{:6.1} s  height {:6.1} m  speed {:5.1} kt  heading {:03.0}°  {} late  {}",
        now.tick as f64 * STEP_S,
        now.height_m,
        engine::units::knots(now.airspeed_mps),
        report::compass_deg(now.heading_rad),
        now.overruns,
        phase.unwrap_or("")
    )
}

/// Whether an event is for the crew, and is told nowhere else.
fn is_new(event: &Told) -> bool {
    let elsewhere = [FlightEvent::Slip, FlightEvent::SelfCheck, FlightEvent::GaveUp];
    event.level != Level::Info && !elsewhere.contains(&event.what)
}

/// Ticks between two warnings of lateness: ten seconds.
const LATE_AGAIN_TICKS: u64 = 2500;

/// Lateness, told when it begins and not again for a while.
#[derive(Default)]
struct Punctual {
    told_tick: Option<u64>,
}

impl Punctual {
    /// What is to be told of the last second.
    fn look(&mut self, shown: &Shown) -> Option<String> {
        let tick = shown.outputs.tick;
        let ms = |ns: u64| ns as f64 * 1e-6;
        let (late_ms, latency_ms) = (ms(shown.late_ns), ms(shown.latency_ns));
        let limit_ms = report::LATENCY_LIMIT_MS;
        if self.told_tick.is_some_and(|told| tick < told + LATE_AGAIN_TICKS) {
            return None;
        }
        let warning = if latency_ms > limit_ms {
            format!(
                "an input needed {latency_ms:.0} ms to the picture; {limit_ms:.0} ms are the limit of a \
                 simulator"
            )
        } else if late_ms > STEP_S * 1e3 {
            format!(
                "ticks up to {late_ms:.1} ms late within a second; `tiltrotor doctor` says what to change"
            )
        } else {
            return None;
        };
        self.told_tick = Some(tick);
        Some(warning)
    }
}

/// What the crew is to know, and has not been told.
fn warnings(told: &Snapshot, now: &Snapshot) -> Vec<String> {
    let mut warnings = Vec::new();
    if now.slips > told.slips {
        let slip_s = now.slipped_s - told.slipped_s;
        warnings.push(format!(
            "the clock slipped by {slip_s:.1} s: the process stood still, and so did the flight"
        ));
    }
    if now.mismatches > 0 && told.mismatches == 0 {
        warnings.push(
            "the flight is not the same when reflown: do not trust this machine, or report this; the \
             log says where"
                .into(),
        );
    }
    if now.log_failed && !told.log_failed {
        warnings.push("the log cannot be written any further; flying on".into());
    }
    warnings
}

/// The pilot models, a line each.
fn pilot_names() -> String {
    PILOTS.iter().map(|(name, what)| format!("\n  {name:<12} {what}")).collect()
}
