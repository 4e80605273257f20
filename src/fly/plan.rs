//! A flight being prepared: aircraft, scenario, log, links, and whoever is to fly.

use std::fs;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use engine::cockpit;
use flightgear::{Link, Receiver};
use logs::Setup;
use logs::output;
use recorder::flightgear_controls::FlightGearControls;
use recorder::keyboard::{Keyboard, Orders};
use recorder::pilots::{PILOTS, Pilot};
use recorder::{Flight, Landing, RealTime};

use super::hardware;
use super::live::Live;
use crate::flightgear::Scene;
use crate::ground::{self, Whose};
use crate::link_args::{LinkArgs, Linked};
use crate::texts::text_or;
use crate::{identity, numbers};

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

/// The steady flight in which a flight begins.
#[derive(clap::Args)]
pub struct Air {
    /// Begin in the air, in steady flight
    #[arg(long)]
    pub from_trim: bool,
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

/// A flight being prepared.
pub struct Plan {
    /// What will be flown.
    pub flight: Flight,
    /// The pipe that the log goes into, if it does, kept open.
    pub(super) pipe: Option<fs::File>,
    /// Names of the pilot model's phases, for the line of progress.
    pub(super) phases: Vec<&'static str>,
    /// What the crew calls its devices.
    pub(super) names: hardware::Named,
    /// Where the keys go.
    pub(super) orders: Option<Orders>,
    /// Whether there is a panel, or a line of progress.
    pub(super) panel: bool,
    /// Where its pictures go.
    pub linked: Option<Linked>,
    /// In which viewer it is shown.
    pub(super) live: Option<Live>,
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

    /// Notes in the log who flies.
    pub fn flown_by(&mut self, who: &str) {
        let identity = std::mem::take(&mut self.flight.identity);
        self.flight.identity = identity.flown_by(who);
    }

    /// Lets FlightGear's own controls fly.
    pub fn add_flightgear(&mut self, map: &mut cockpit::Params) -> Result<()> {
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
        self.flown_by("FlightGear's controls");
        Ok(())
    }

    /// Begins in steady flight: the scenario says so, and goes into the log with it.
    pub fn begin_in(&mut self, air: &Air) -> Result<()> {
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
            bail!("no pilot model is called `{name}`; there are {}", pilot_names());
        };
        self.phases = pilot.phases();
        self.flight.controllers.push(Box::new(pilot));
        self.flown_by(&format!("pilot model {name}"));
        Ok(())
    }

    /// How punctual the loop is to be.
    pub fn keep_time(&mut self, slip_limit_ms: f64, spin_us: f64, cpu: Option<usize>) {
        if let Some(real_time) = &mut self.flight.real_time {
            real_time.slip_limit_ns = (slip_limit_ms * 1e6).round() as u64;
            real_time.spin_ns = (spin_us * 1e3).round() as u64;
            real_time.cpu = cpu;
        }
    }

    /// Whether keys can fly.
    pub fn look_for_keys(&self, fast: bool) -> Result<()> {
        if fast {
            bail!("--keyboard flies in real time: leave out --fast");
        }
        if !on_a_terminal() {
            bail!("--keyboard needs a terminal: neither its keys nor its screen can be had here");
        }
        Ok(())
    }

    /// Lets the keys in: to fly, which the log notes, or beside whoever flies.
    pub fn add_keyboard(&mut self, map: &mut cockpit::Params, flies: bool) -> Result<()> {
        let own = aircraft::cockpit("keyboard.toml", aircraft::KEYBOARD_MAP)?;
        map.device.extend(own.device);
        let (keyboard, orders) = Keyboard::of(map).context("the map has no keyboard")?;
        self.flight.controllers.push(Box::new(keyboard));
        self.orders = Some(orders);
        if flies {
            self.flown_by("keyboard");
        }
        Ok(())
    }

    /// The cockpit map as flown.
    pub fn set_map(&mut self, map: cockpit::Params) -> Result<()> {
        self.flight.setup.cockpit_toml = toml::to_string(&map)?;
        let aircraft = self.flight.aircraft.clone();
        self.flight.aircraft = aircraft.with_cockpit(map);
        Ok(())
    }

    /// Lets the sticks that are plugged in fly.
    pub fn plug_in(&mut self, map: &mut cockpit::Params, path: Option<&Path>) -> Result<()> {
        self.names = hardware::plug_in(&mut self.flight, map, path)?;
        let names = self.names.names().join(", ");
        self.flown_by(&names);
        Ok(())
    }
}

/// Whether keys can be had and a screen is there.
pub fn on_a_terminal() -> bool {
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

/// The pilot models with what each flies, for the help.
pub fn pilots_in_words() -> String {
    let lines: Vec<String> =
        PILOTS.iter().map(|(name, what)| format!("{name:<12} {what}")).collect();
    format!("Let a pilot model fly:\n{}", lines.join("\n"))
}

/// The pilot models by name.
pub fn pilot_names() -> String {
    let names: Vec<&str> = PILOTS.iter().map(|(name, _)| *name).collect();
    format!("{} (`tiltrotor fly --help` says what each flies)", names.join(", "))
}
