//! The flight below an instance: begun as the parameters say, moved as the inputs say.

use std::path::Path;
use std::sync::Arc;

use analysis::condition::Condition;
use engine::cockpit::AxisControl;
use engine::inputs::{Failures, InputLevel, World};
use engine::units::POUND_KG;
use engine::{Aircraft, observe};
use logs::fields::{Value as Number, fields};
use logs::{Setup, cdr};
use recorder::{End, Moment, Stepped};

use crate::provenance::identity;
use crate::values::Values;
use crate::variables::{Target, axes, table};

/// A flight, and what of the inputs was last applied to it.
pub struct Flying {
    /// What is flown.
    pub stepped: Stepped,
    sent: Sent,
}

/// What the inputs were when they were last applied.
#[derive(Clone)]
struct Sent {
    /// The controls, where each stood at the start and where it was sent to.
    axes: Vec<(AxisControl, f64, f64)>,
    /// Which buttons were held, in the table's order.
    buttons: Vec<bool>,
}

/// A copy from which a flight goes on to the same bits.
#[derive(Clone)]
pub struct Kept {
    aircraft: Arc<Aircraft>,
    setup: Setup,
    moment: Moment,
    sent: Sent,
}

impl Flying {
    /// Begins as the parameters say.
    ///
    /// # Errors
    /// In words, when there is no such aircraft, start or steady flight.
    pub fn begin(values: &Values) -> Result<Self, String> {
        let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).map_err(told)?;
        let (file, aircraft_toml) = match values.text("aircraft_file") {
            "" => ("xv15.toml", aircraft::XV15.to_string()),
            path => {
                let text = std::fs::read_to_string(path);
                (path, text.map_err(|why| format!("aircraft_file: {path}: {why}"))?)
            }
        };
        let read = aircraft::aircraft(file, &aircraft_toml).map_err(told)?;
        let cockpit_toml = toml::to_string(&map).map_err(told)?;
        let aircraft = read.with_cockpit(map);
        let scenario_toml = scenario(values, &aircraft)?;
        let start = aircraft::start("scenario.toml", &scenario_toml).map_err(told)?;
        let fuel_kg_max = aircraft.weight_balance.fuel_kg_max;
        if let Some(fuel_kg) = start.fuel_kg
            && fuel_kg > fuel_kg_max
        {
            return Err(format!(
                "fuel_lb: expected 0 to {:.0} lb, what the tanks hold, or -1 (as any below 0) for full ones; got {:.0} lb",
                fuel_kg_max / POUND_KG,
                fuel_kg / POUND_KG
            ));
        }
        let setup = Setup { aircraft_toml, cockpit_toml, scenario_toml };
        let stepped = Stepped::begin(Arc::new(aircraft), setup, &start).map_err(told)?;
        let stands = |axis: AxisControl| (axis.facts().get)(&stepped.state.cockpit);
        let axes = axes().into_iter().map(|axis| (axis, stands(axis), stands(axis))).collect();
        let buttons = vec![false; table().len()];
        Ok(Self { sent: Sent { axes, buttons }, stepped })
    }

    /// Records from here on, if the parameters name a log.
    ///
    /// # Errors
    /// In words, when it cannot be begun.
    pub fn record(&mut self, values: &Values) -> Result<(), String> {
        let path = values.text("log_file");
        if path.is_empty() || self.stepped.is_recording() {
            return Ok(());
        }
        let shape = aircraft::urdf(&self.stepped.aircraft);
        self.stepped
            .record(
                Path::new(path),
                values.flag("log_force"),
                identity().flown_by("FMU importer"),
                &shape,
            )
            .map_err(|why| format!("log_file: {path}: {}", told(why)))
    }

    /// Flies so many ticks, the inputs held.
    ///
    /// # Errors
    /// In words, when the log cannot be written any further.
    pub fn step(&mut self, values: &Values, ticks: u64) -> Result<(), String> {
        self.move_controls(values);
        self.stepped.world.failures = failures(values);
        for _ in 0..ticks {
            self.drive(values)?;
            self.stepped.step().map_err(|why| format!("log_file: {}", told(why)))?;
        }
        Ok(())
    }

    /// Sends what moved since the last step: buttons before axes, as a script does.
    fn move_controls(&mut self, values: &Values) {
        for (place, variable) in table().iter().enumerate() {
            let Target::Button(button) = variable.target else { continue };
            let pressed = values.flag_at(place);
            if std::mem::replace(&mut self.sent.buttons[place], pressed) != pressed {
                self.stepped.press(button, pressed);
            }
        }
        let absolute = values.flag("absolute_inputs");
        for (axis, at_start_norm, sent_norm) in &mut self.sent.axes {
            let input_norm = values.real(axis.facts().key);
            let to_norm = if absolute { input_norm } else { *at_start_norm + input_norm };
            // Compared as bits: what was not moved sends nothing.
            if to_norm.to_bits() != sent_norm.to_bits() {
                *sent_norm = to_norm;
                self.stepped.set(*axis, to_norm);
            }
        }
    }

    /// Commands the actuators from outside, if that is asked for.
    fn drive(&mut self, values: &Values) -> Result<(), String> {
        let flown = &mut self.stepped;
        if !values.flag("drive_actuators") {
            let World { commands, input_level, .. } = World::default();
            (flown.world.commands, flown.world.input_level) = (commands, input_level);
            return Ok(());
        }
        let world = World { input_level: InputLevel::Controls as u64, ..flown.world };
        let asked = observe(&flown.aircraft, &flown.state, &world).commands;
        let absolute = values.flag("absolute_inputs");
        let mut bytes = cdr::HEADER.to_vec();
        for (place, field) in fields(&asked).map_err(told)?.into_iter().enumerate() {
            let input = values.command(place);
            bytes.extend(match field.value {
                // What is recorded has no negative zero.
                Number::F64(_) if absolute => (input + 0.0).to_le_bytes(),
                Number::F64(base) => (base + input).to_le_bytes(),
                Number::U64(base) => {
                    let base = if absolute { 0.0 } else { base as f64 };
                    // Of a switch: 0 or 1.
                    u64::from(base + input > 0.5).to_le_bytes()
                }
                Number::I64(base) => base.to_le_bytes(),
            });
        }
        flown.world.commands = cdr::decode(&bytes).map_err(told)?;
        flown.world.input_level = InputLevel::Actuators as u64;
        Ok(())
    }

    /// Ends the log, if there is one.
    ///
    /// # Errors
    /// In words, when it cannot be closed.
    pub fn close(&mut self, end: End) -> Result<(), String> {
        self.stepped.close(end).map(drop).map_err(|why| format!("log_file: {}", told(why)))
    }

    /// A copy from which another flight goes on.
    pub fn keep(&self) -> Kept {
        Kept {
            aircraft: Arc::clone(&self.stepped.aircraft),
            setup: self.stepped.setup.clone(),
            moment: self.stepped.moment(),
            sent: self.sent.clone(),
        }
    }

    /// Goes on from a copy, without a log.
    ///
    /// # Errors
    /// Never, with a copy of this program's.
    pub fn resume(kept: &Kept) -> Result<Self, String> {
        let Kept { aircraft, setup, moment, sent } = kept.clone();
        let stepped = Stepped::resume(aircraft, setup, moment).map_err(told)?;
        Ok(Self { stepped, sent })
    }

    /// Whether a flight stands where the copy was made.
    pub fn stands_at(&self, kept: &Kept) -> bool {
        self.stepped.state == kept.moment.state && self.stepped.setup == kept.setup
    }
}

fn failures(values: &Values) -> Failures {
    let mut failures = Failures::empty();
    for (place, variable) in table().iter().enumerate() {
        if let Target::Failure(flag) = variable.target {
            failures.set(flag, values.flag_at(place));
        }
    }
    failures
}

/// The text of the scenario that the parameters make.
fn scenario(values: &Values, aircraft: &Aircraft) -> Result<String, String> {
    let start = values.text("start");
    let in_trim = start == "trim";
    let text = if in_trim {
        aircraft::DEFAULT_SCENARIO
    } else {
        let found = aircraft::STARTS.iter().find(|(name, ..)| *name == start);
        found.map(|(.., text)| *text).ok_or_else(|| {
            let there = aircraft::STARTS.map(|(name, ..)| name).join(", ");
            format!("start: no position is called `{start}`; there are trim, {there}")
        })?
    };
    let mut scenario: toml::Table = text.parse().map_err(told)?;
    let world = scenario.get_mut("world").and_then(toml::Value::as_table_mut);
    let world = world.ok_or("start: the scenario has no table [world]")?;
    for key in [
        "wind_kt",
        "wind_from_deg",
        "wind_roughness_m",
        "turbulence_mps",
        "temperature_offset_k",
        "pressure_offset_pa",
    ] {
        world.insert(key.into(), values.real(key).into());
    }
    world.insert("turbulence_seed".into(), whole(values, "turbulence_seed", 0, i64::MAX)?.into());
    if !(0.0..=200.0).contains(&values.real("wind_kt")) {
        return Err(format!("wind_kt: expected 0 to 200 kt, got {} kt", values.real("wind_kt")));
    }
    if !(0.0..=15.0).contains(&values.real("turbulence_mps")) {
        let got = values.real("turbulence_mps");
        return Err(format!("turbulence_mps: expected 0 to 15 m/s, got {got} m/s"));
    }
    if in_trim {
        scenario.insert("heading_deg".into(), values.real("heading_deg").into());
        // Without it the tanks are full.
        let fuel_lb = values.real("fuel_lb");
        if fuel_lb >= 0.0 {
            scenario.insert("fuel_lb".into(), fuel_lb.into());
        }
        scenario.insert("trim".into(), trim(values, aircraft)?.into());
    }
    toml::to_string(&scenario).map_err(told)
}

/// The steady flight of the parameters, as a scenario has it.
fn trim(values: &Values, aircraft: &Aircraft) -> Result<toml::Table, String> {
    let detent = whole(values, "flap_detent", -1, 3)?;
    let condition = Condition {
        nacelle_deg: values.real("nacelle_deg"),
        speed_kt: values.real("speed_kt"),
        altitude_ft: values.real("altitude_ft"),
        climb_fpm: values.real("climb_fpm"),
        scas_on: values.flag("scas_on"),
        ..Condition::default()
    };
    let text = condition.start_toml(aircraft, "the FMU").map_err(told)?;
    let table: toml::Table = text.parse().map_err(told)?;
    let mut trim = match table.get("trim") {
        Some(toml::Value::Table(trim)) => trim.clone(),
        _ => return Err("start: no table [trim]".into()),
    };
    trim.insert("gear_down".into(), i64::from(values.flag("gear_down")).into());
    if detent >= 0 {
        trim.insert("flap_detent".into(), detent.into());
    }
    Ok(trim)
}

/// A parameter that is a whole number.
fn whole(values: &Values, name: &str, least: i64, greatest: i64) -> Result<i64, String> {
    /// 2^53: beyond it, not every whole number is a double.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let value = values.real(name);
    let whole = value as i64;
    if value.fract() != 0.0 || value.abs() > EXACT || !(least..=greatest).contains(&whole) {
        let to = if greatest == i64::MAX { "2^53".to_string() } else { greatest.to_string() };
        return Err(format!("{name}: expected a whole number from {least} to {to}, got {value}"));
    }
    Ok(whole)
}

/// An error in words, with all that led to it.
pub fn told(error: impl std::error::Error) -> String {
    logs::text::with_causes(&error)
}
