//! A flight that is stepped from Python.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use ::aircraft as files;
use engine::cockpit::{AxisControl, ButtonControl};
use engine::frames::Vec3;
use engine::inputs::{Failures, InputLevel, World};
use engine::math::{cos, sin};
use engine::units::{mps_of_knots, radians};
use engine::{State, observe};
use logs::{FlightReader, Identity, Setup, cdr};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use recorder::{End, Moment, Movement, Stepped};
use replay::{OPEN, ReplayError, Source, Window, names_parent};

use crate::aircraft::Aircraft;
use crate::commands;
use crate::errors::{refused, told, told_of};
use crate::numbers::{Fields, body, of_struct};
use crate::provenance::identity;
use crate::waiting::wait;

/// Ticks between two looks for Ctrl-C: some milliseconds.
const LOOK_TICKS: u64 = 500;

/// Who flies, in the log.
const PYTHON: &str = "Python";

/// A flight, stepped by whoever calls.
#[pyclass(module = "tiltrotor._native")]
pub struct Flight {
    /// Never contended: Python hands out one exclusive borrow at a time.
    flown: Mutex<Stepped>,
    aircraft: Aircraft,
    /// Of a flight that goes on from a log: the tick, and what its own log says of that one.
    origin: Option<(u64, Identity)>,
}

/// A flight's moment as Python keeps it: state, outputs, world, where the axes stand, what is still to be
/// moved.
type Kept = (Vec<u8>, Vec<u8>, Vec<u8>, Vec<(u64, i64)>, Vec<(String, f64)>);

/// The cockpit map through which programs move the controls, as it stands in a log.
fn map_toml() -> PyResult<String> {
    let map = files::cockpit("pilot.toml", files::PILOT_MAP).map_err(told)?;
    toml::to_string(&map).map_err(told)
}

/// The scenario of a start position.
fn start_position(name: &str) -> PyResult<&'static str> {
    let found = files::STARTS.iter().find(|(known, ..)| *known == name);
    found.map(|(.., text)| *text).ok_or_else(|| {
        let there = files::STARTS.map(|(name, ..)| name).join(", ");
        refused(format!("start: no position is called {name}; there are {there}"))
    })
}

/// Brings a log to a tick; to its beginning without one.
fn stand_at(reader: &mut FlightReader, tick: Option<u64>) -> Result<(), ReplayError> {
    let window = Window { from_tick: tick, until_tick: None, clamped: false };
    Ok(window.apply(reader)?)
}

impl Flight {
    fn flown(&mut self) -> &mut Stepped {
        self.flown.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    fn new(flown: Stepped, aircraft: Aircraft, origin: Option<(u64, Identity)>) -> Self {
        Self { flown: Mutex::new(flown), aircraft, origin }
    }
}

#[pymethods]
impl Flight {
    /// Begins at a start position, or as a scenario's text says.
    #[new]
    fn begin(
        py: Python<'_>,
        aircraft: &Bound<'_, Aircraft>,
        start: &str,
        scenario: Option<String>,
    ) -> PyResult<Self> {
        let aircraft = aircraft.get().clone();
        let scenario_toml = match scenario {
            Some(text) => text,
            None => start_position(start)?.into(),
        };
        let begins = files::start("scenario.toml", &scenario_toml).map_err(told)?;
        let fuel_kg_max = aircraft.params.weight_balance.fuel_kg_max;
        if let Some(fuel_kg) = begins.fuel_kg
            && fuel_kg > fuel_kg_max
        {
            return Err(refused(format!(
                "scenario: fuel of {fuel_kg:.0} kg: the tanks hold {fuel_kg_max:.0} kg"
            )));
        }
        let (aircraft_toml, cockpit_toml) = (aircraft.text().into(), map_toml()?);
        let setup = Setup { aircraft_toml, cockpit_toml, scenario_toml };
        let params = Arc::clone(&aircraft.params);
        let flown = wait(py, move |_| Stepped::begin(params, setup, &begins))?.map_err(told)?;
        Ok(Self::new(flown, aircraft, None))
    }

    /// Goes on from a state of a log, by the hands of whoever calls.
    #[staticmethod]
    fn from_log(py: Python<'_>, path: PathBuf, tick: Option<u64>) -> PyResult<Self> {
        let name = path.display().to_string();
        let read = wait(py, move |_| {
            let source = Source::proven(&path, "not flown on")?;
            let mut reader = logs::open(&path, OPEN)?;
            let first_tick = reader.initial.tick;
            stand_at(&mut reader, tick)?;
            let state = reader.initial;
            let origin = source
                .marks(names_parent(identity(), &path, &reader, "python"))
                .with(Identity::FLOWN_BY, PYTHON);
            let setup = reader.setup.clone();
            // The world of the tick that begins there; after the last one, that of the last one.
            let mut world = reader.next_tick()?.map(|tick| tick.inputs.world);
            if world.is_none() && state.tick > first_tick {
                let mut before = logs::open(&path, OPEN)?;
                stand_at(&mut before, Some(state.tick - 1))?;
                world = before.next_tick()?.map(|tick| tick.inputs.world);
            }
            let world = world.map_or_else(|| replay::flown(&setup).map(|flown| flown.world), Ok)?;
            // Who moved the aircraft, and whether it was paused, is not the weather's.
            let World { paused, input_level, commands, .. } = World::default();
            let world = World { paused, input_level, commands, ..world };
            Ok::<_, ReplayError>((state, world, setup, origin))
        })?;
        let (state, world, mut setup, origin) = read.map_err(|error| told_of(&name, error))?;
        // Whatever flew it: from here on, a program does.
        setup.cockpit_toml = map_toml()?;
        let aircraft = Aircraft::read("aircraft.toml", &setup.aircraft_toml)?;
        let flown = Stepped::going_on(Arc::clone(&aircraft.params), setup, state, world);
        Ok(Self::new(flown.map_err(told)?, aircraft, Some((state.tick, origin))))
    }

    /// The scenario of a start position.
    #[staticmethod]
    fn scenario(start: &str) -> PyResult<&'static str> {
        start_position(start)
    }

    /// The aircraft that flies.
    #[getter]
    fn aircraft(&self) -> Aircraft {
        self.aircraft.clone()
    }

    /// Moves a control with the next step.
    fn set_control(&mut self, control: &str, position: f64) -> PyResult<()> {
        let flown = self.flown();
        let Some(known) = flown.axes().find(|known| known.facts().key == control) else {
            let keys: Vec<_> = flown.axes().map(|known| known.facts().key).collect();
            let there = keys.join(", ");
            return Err(refused(format!("{control}: no such control; there are {there}")));
        };
        let low = known.facts().travel.low_norm();
        if !(low..=1.0).contains(&position) {
            return Err(refused(format!("{control}: expected {low} to 1, got {position}")));
        }
        flown.set(known, position);
        Ok(())
    }

    /// The controls that can be moved, each with its lower end and what it is.
    fn controls(&mut self) -> Vec<(&'static str, f64, &'static str)> {
        let facts = self.flown().axes().map(AxisControl::facts);
        facts.map(|facts| (facts.key, facts.travel.low_norm(), facts.description)).collect()
    }

    /// Presses a button with the next step, or lets it go.
    fn button(&mut self, control: &str, pressed: bool) -> PyResult<()> {
        let Some(known) = ButtonControl::from_key(control) else {
            let there = ButtonControl::KEYS.join(", ");
            return Err(refused(format!("{control}: no such button; there are {there}")));
        };
        self.flown().press(known, pressed);
        Ok(())
    }

    /// Sets or mends a failure.
    fn fail(&mut self, key: &str, failed: bool) -> PyResult<()> {
        let failure = Failures::from_key(key).ok_or_else(|| {
            let there = Failures::KEYS.join(", ");
            refused(format!("{key}: no such failure; there are {there}"))
        })?;
        self.flown().world.failures.set(failure, failed);
        Ok(())
    }

    /// Sets the steady wind.
    fn wind(&mut self, from_deg: f64, kt: f64) -> PyResult<()> {
        if !(from_deg.is_finite() && (0.0..=200.0).contains(&kt)) {
            let words = format!("wind: expected 0 to 200 kt, got {kt} kt from {from_deg} deg");
            return Err(refused(words));
        }
        let (from_rad, mps) = (radians(from_deg), mps_of_knots(kt));
        // What is recorded has no negative zero.
        let (north_mps, east_mps) = (0.0 - mps * cos(from_rad), 0.0 - mps * sin(from_rad));
        self.flown().world.wind_mps = Vec3::new(north_mps, east_mps, 0.0);
        Ok(())
    }

    /// Sets the vertical intensity of the turbulence, m/s.
    fn turbulence(&mut self, mps: f64) -> PyResult<()> {
        if !(0.0..=15.0).contains(&mps) {
            return Err(refused(format!("turbulence: expected 0 to 15 m/s, got {mps}")));
        }
        self.flown().world.turbulence_mps = mps;
        Ok(())
    }

    /// Commands the actuators in place of the flight control computer; `None` gives them back to it.
    fn drive_actuators(&mut self, commands: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let flown = self.flown();
        let Some(given) = commands else {
            let World { commands, input_level, .. } = World::default();
            (flown.world.commands, flown.world.input_level) = (commands, input_level);
            return Ok(());
        };
        // From what was asked for last: from outside, or by the computer.
        let base = flown.world.outside_commands().unwrap_or(flown.outputs.commands);
        flown.world.commands = commands::changed(&base, given)?;
        flown.world.input_level = InputLevel::Actuators as u64;
        Ok(())
    }

    /// What the aircraft's own computer asks for now, whoever commands the actuators.
    fn computer_commands<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let flown = self.flown();
        let world = World { input_level: InputLevel::Controls as u64, ..flown.world };
        commands::named(py, &observe(&flown.aircraft, &flown.state, &world).commands)
    }

    /// Flies so many ticks.
    #[pyo3(signature = (ticks=1))]
    fn step(&mut self, py: Python<'_>, ticks: u64) -> PyResult<()> {
        let flown = self.flown();
        let mut left = ticks;
        while left > 0 {
            let now = left.min(LOOK_TICKS);
            py.detach(|| (0..now).try_for_each(|_| flown.step())).map_err(told)?;
            left -= now;
            if left > 0 {
                py.check_signals()?;
            }
        }
        Ok(())
    }

    /// Ticks flown.
    #[getter]
    fn tick(&mut self) -> u64 {
        self.flown().state.tick
    }

    /// A second flight from here on, without a log.
    fn copy(&mut self) -> Self {
        let flown = self.flown().fork();
        Self::new(flown, self.aircraft.clone(), self.origin.clone())
    }

    /// Names and types of the numbers of `state` or `outputs`.
    #[staticmethod]
    fn fields(which: &str) -> PyResult<Fields> {
        match which {
            "state" => of_struct(&State::default()),
            _ => of_struct(&engine::Outputs::default()),
        }
    }

    /// The numbers of the state.
    fn state<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let message = cdr::encode(&self.flown().state).map_err(told)?;
        Ok(PyBytes::new(py, body(&message)))
    }

    /// The numbers of what can be observed.
    fn outputs<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let message = cdr::encode(&self.flown().outputs).map_err(told)?;
        Ok(PyBytes::new(py, body(&message)))
    }

    /// Records from here on.
    #[expect(clippy::needless_pass_by_value, reason = "what Python gives is a path of its own")]
    fn record(&mut self, path: PathBuf, force: bool) -> PyResult<()> {
        let origin = self.origin.clone();
        let shape = files::urdf(&self.aircraft.params);
        let flown = self.flown();
        if flown.is_recording() {
            return Err(refused("it is being recorded already: close() ends that log"));
        }
        let tick = flown.state.tick;
        let identity = match origin {
            Some((from, origin)) if from == tick => origin,
            _ => identity().flown_by(PYTHON),
        };
        let name = path.display().to_string();
        flown.record(&path, force, identity, &shape).map_err(|error| told_of(&name, error))
    }

    /// Ends the log; the digest of the whole flight, or `None` when there was no log.
    fn close(&mut self) -> PyResult<Option<String>> {
        let closed = self.flown().close(End::Done).map_err(told)?;
        Ok(closed.map(|closed| format!("{:016x}", closed.digest)))
    }

    /// Ends the log of a flight that something else broke off: Ctrl-C, or what went wrong around it.
    fn broken_off(&mut self, by_signal: bool) -> PyResult<()> {
        let end = End::Stopped(by_signal.then_some("SIGINT"));
        self.flown().close(end).map_err(told)?;
        Ok(())
    }

    /// What another process goes on from: the three texts, and the moment.
    fn kept(&mut self) -> PyResult<(String, String, String, Kept)> {
        let flown = self.flown();
        let Setup { aircraft_toml, cockpit_toml, scenario_toml } = flown.setup.clone();
        let Moment { state, outputs, world, sent, movements } = flown.moment();
        let name = |movement: Movement| match movement {
            Movement::Axis(control, at_norm) => (control.facts().key.to_string(), at_norm),
            Movement::Button(control, pressed) => {
                (format!("button {}", control.facts().key), f64::from(u8::from(pressed)))
            }
        };
        let kept = (
            cdr::encode(&state).map_err(told)?,
            cdr::encode(&outputs).map_err(told)?,
            cdr::encode(&world).map_err(told)?,
            sent,
            movements.into_iter().map(name).collect(),
        );
        Ok((aircraft_toml, cockpit_toml, scenario_toml, kept))
    }

    /// Goes on where another process was.
    #[staticmethod]
    fn resume(
        aircraft_toml: String,
        cockpit_toml: String,
        scenario_toml: String,
        kept: Kept,
    ) -> PyResult<Self> {
        let aircraft = Aircraft::read("aircraft.toml", &aircraft_toml)?;
        let setup = Setup { aircraft_toml, cockpit_toml, scenario_toml };
        let (state, outputs, world, sent, named) = kept;
        let moment = Moment {
            state: cdr::decode(&state).map_err(told)?,
            outputs: cdr::decode(&outputs).map_err(told)?,
            world: cdr::decode(&world).map_err(told)?,
            sent,
            movements: Vec::new(),
        };
        let flown = Stepped::resume(Arc::clone(&aircraft.params), setup, moment).map_err(told)?;
        let mut flight = Self::new(flown, aircraft, None);
        for (control, value) in named {
            match control.strip_prefix("button ") {
                Some(button) => flight.button(button, value > 0.5)?,
                None => flight.set_control(&control, value)?,
            }
        }
        Ok(flight)
    }
}
