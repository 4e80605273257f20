//! `tiltrotor fly`.

mod hardware;

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use engine::STEP_S;
use engine::cockpit;
use flightgear::Link;
use indicatif::{ProgressBar, ProgressStyle};
use logs::Setup;
use logs::output;
use recorder::pilots::{self, PILOTS, Pilot};
use recorder::script::Script;
use recorder::{End, Flight, Landing, Progress, Snapshot, fly};

use crate::claim::Claim;
use crate::status::Status;
use crate::{condition, identity, numbers, report};

/// What flies, from where, and where it is recorded.
#[derive(clap::Args)]
pub struct Args {
    /// Fly with the sticks that are plugged in
    #[arg(long)]
    stick: bool,
    /// Let a pilot model fly: hover, demo, takeoff, convert, turn, reconvert, land
    #[arg(long, value_name = "NAME")]
    pilot: Option<String>,
    /// Play the timed events of a file
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Cockpit map for --stick: a file, or the name of a shipped one (without: of the shipped ones
    /// those for what is plugged in)
    #[arg(long, value_name = "FILE", requires = "stick")]
    map: Option<PathBuf>,
    /// Print what moves which control, and fly nothing
    #[arg(long, requires = "stick")]
    controls: bool,
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    air: Air,
    /// End the flight after this long, s
    #[arg(long, value_name = "SECONDS")]
    #[arg(value_parser = numbers::duration_s, allow_negative_numbers = true)]
    duration: Option<f64>,
    /// Refly each second on a spare thread while flying, and warn when a bit is not the same
    #[arg(long)]
    self_check: bool,
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
    /// Flap lever: 0, 20, 40 or 75 deg (without: 40 with nacelles above 75 deg, 20 above 15, else 0)
    #[arg(long, value_name = "DEG", requires = "from_trim")]
    #[arg(value_parser = numbers::flap_deg, allow_negative_numbers = true)]
    flap: Option<f64>,
    /// Rotor speed, rpm (without: the slowest below 1 deg of nacelle)
    #[arg(long, value_name = "RPM", requires = "from_trim")]
    #[arg(value_parser = numbers::rotor_rpm, allow_negative_numbers = true)]
    rpm: Option<f64>,
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
    /// Where FlightGear listens (--native-fdm=socket,in,60,HOST,PORT,udp)
    /// [default: 127.0.0.1:5501; nothing is sent with --fast]
    #[arg(long, value_name = "HOST:PORT")]
    flightgear: Option<String>,
    /// Send nothing to FlightGear
    #[arg(long, conflicts_with = "flightgear")]
    no_flightgear: bool,
}

impl Common {
    /// Where the pictures go. A flight as fast as it goes would fly over somebody's flight in real time.
    fn destination(&self) -> Option<&str> {
        match &self.flightgear {
            Some(destination) => Some(destination),
            None if self.no_flightgear || self.fast => None,
            None => Some(flightgear::DEFAULT_DESTINATION),
        }
    }
}

/// Flies, and sums up.
pub fn run(args: &Args) -> Result<Status> {
    if args.controls {
        return hardware::say_controls(args.map.as_deref());
    }
    let mut plan = Plan::new(&args.common)?;
    plan.flight.self_check = args.self_check;
    let inputs: Vec<&Path> =
        [&args.map, &args.script].into_iter().filter_map(|file| file.as_deref()).collect();
    output::refuse(&args.common.out, args.common.force, &inputs)?;
    if let Some(seconds) = args.duration {
        plan.flight.ticks_max = Some((seconds / STEP_S).round() as u64);
    }
    if args.air.from_trim {
        plan.begin_in(&args.air)?;
    }
    let virtual_hands = args.pilot.is_some() || args.script.is_some();
    if !args.stick && !virtual_hands {
        bail!("nobody flies: give --stick, --pilot NAME ({}) or --script FILE", pilot_names());
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
        plan.flight.hands.push(Box::new(Script::parse(&name_of(path), &text, &map)?));
    }
    plan.set_map(map)?;
    if let (Some(name), None, true) = (&args.pilot, args.duration, args.common.fast)
        && !pilots::lands(name)
    {
        bail!("the {name} pilot never lands: give --duration SECONDS with --fast");
    }
    let real_time = plan.flight.real_time;
    let landing = plan.fly()?;
    report::landing(&landing, real_time, &args.common.out.display().to_string());
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
    crew: hardware::Named,
    /// Where its pictures go.
    _claim: Option<Claim>,
}

impl Plan {
    /// Aircraft, scenario, log and link; hands and cockpit map are still to come.
    pub fn new(common: &Common) -> Result<Self> {
        let (aircraft_name, aircraft_toml) =
            text_or(common.aircraft.as_deref(), "xv15.toml", aircraft::XV15)?;
        let aircraft = aircraft::aircraft(&aircraft_name, &aircraft_toml)?;
        let (scenario_name, scenario_toml) =
            text_or(common.scenario.as_deref(), "default.toml", aircraft::DEFAULT_SCENARIO)?;
        let start = aircraft::start(&scenario_name, &scenario_toml)?;
        let fuel_kg_max = aircraft.weight_balance.fuel_kg_max;
        if start.fuel_kg > fuel_kg_max {
            bail!(
                "{scenario_name}: fuel of {:.0} kg: the tanks of {} hold {fuel_kg_max:.0} kg",
                start.fuel_kg,
                aircraft.name
            );
        }
        let robot_description = aircraft::urdf(&aircraft);
        let link = common.destination().map(Link::new).transpose()?;
        let claim = common.destination().map(Claim::of);
        let inputs: Vec<&Path> =
            [&common.aircraft, &common.scenario].into_iter().filter_map(|f| f.as_deref()).collect();
        output::refuse(&common.out, common.force, &inputs)?;
        let pipe = recorder::pipe::take(&common.out)
            .with_context(|| format!("cannot write {}", common.out.display()))?;
        Ok(Self {
            pipe,
            phases: Vec::new(),
            crew: hardware::Named::default(),
            _claim: claim,
            flight: Flight {
                aircraft,
                start,
                setup: Setup { aircraft_toml, cockpit_toml: String::new(), scenario_toml },
                identity: identity::identity(),
                robot_description,
                hands: Vec::new(),
                #[cfg(feature = "sticks")]
                sticks: None,
                out: common.out.clone(),
                force: common.force,
                real_time: !common.fast,
                ticks_max: None,
                link,
                self_check: false,
            },
        })
    }

    /// Begins in steady flight: the scenario says so, and goes into the log with it.
    fn begin_in(&mut self, air: &Air) -> Result<()> {
        if self.flight.start.trim.is_some() {
            bail!("--from-trim: the scenario begins in the air already, by its table [trim]");
        }
        let (aircraft, nacelle_deg) = (&self.flight.aircraft, air.nacelle);
        let detent = condition::flap_detent(aircraft, air.flap, nacelle_deg)?;
        let rpm_select = condition::rpm_select(aircraft, air.rpm, nacelle_deg)?;
        let scenario = &mut self.flight.setup.scenario_toml;
        scenario.push_str(&format!(
            "\n[trim] # by --from-trim\nmast_tilt_deg = {:?}\nairspeed_kt = {:?}\n\
             altitude_ft = {:?}\nclimb_fpm = {:?}\nflap_detent = {detent}\n\
             rpm_select = {rpm_select}\nscas_on = 1\n",
            90.0 - nacelle_deg,
            air.speed_kt,
            air.altitude_ft,
            air.climb_fpm,
        ));
        self.flight.start = aircraft::start("scenario.toml", scenario)?;
        Ok(())
    }

    /// Lets the pilot model of that name fly.
    pub fn set_pilot(&mut self, name: &str, map: &cockpit::Params) -> Result<()> {
        let Some(pilot) = Pilot::named(name, map, &self.flight.aircraft.envelope.corridor) else {
            bail!("no pilot model is called `{name}`; there are {}", pilot_names());
        };
        self.phases = pilot.phases();
        self.flight.hands.push(Box::new(pilot));
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
        self.crew = hardware::plug_in(&mut self.flight, map, path)?;
        Ok(())
    }

    /// Flies, with a line of progress on a terminal.
    pub fn fly(self) -> Result<Landing> {
        let progress = Progress::default();
        progress.stop_on_signals()?;
        let bar = ProgressBar::new_spinner();
        bar.set_style(ProgressStyle::with_template("{spinner} {msg}")?);
        let Self { flight, pipe: _pipe, phases, crew, _claim } = self;
        let landing = thread::scope(|scope| {
            let flying = scope.spawn(|| fly(flight, &progress));
            let mut told = Snapshot::default();
            while !flying.is_finished() {
                thread::sleep(Duration::from_millis(100));
                let now = progress.now();
                bar.set_message(line(&now, &phases));
                bar.tick();
                for warning in warnings(&told, &now) {
                    bar.suspend(|| complain!("WARNING: {warning}"));
                }
                for line in crew.lines(&told, &now) {
                    bar.suspend(|| complain!("{line}"));
                }
                told = now;
            }
            flying.join()
        });
        bar.finish_and_clear();
        let landing = landing.map_err(|_| anyhow::anyhow!("the flight died of a fault of ours"))?;
        Ok(landing?)
    }
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

fn pilot_names() -> String {
    let names: Vec<_> = PILOTS.iter().map(|(name, what)| format!("{name}: {what}")).collect();
    names.join("; ")
}

/// The text of a file, or the built-in one of that name.
pub fn text_or(path: Option<&Path>, name: &str, built_in: &str) -> Result<(String, String)> {
    match path {
        Some(path) => Ok((name_of(path), read(path)?)),
        None => Ok((name.to_string(), built_in.to_string())),
    }
}

fn name_of(path: &Path) -> String {
    path.display().to_string()
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}
