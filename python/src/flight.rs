//! A flight that is stepped from Python.

use std::path::PathBuf;

use ::aircraft as files;
use engine::cockpit::{AxisControl, ButtonControl};
use engine::frames::Vec3;
use engine::inputs::{Failures, InputLevel, World};
use engine::math::{cos, sin};
use engine::units::{mps_of_knots, radians};
use logs::{Identity, Setup, cdr, fields};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use recorder::Stepped;

use crate::aircraft::Aircraft;
use crate::errors::{TiltrotorError, told, told_of};

/// Ticks between two looks for Ctrl-C: some ten milliseconds.
const LOOK_TICKS: u64 = 500;

/// A flight, stepped by whoever calls.
#[pyclass(module = "tiltrotor")]
pub struct Flight {
    flown: Stepped,
    aircraft: Aircraft,
}

fn refused(words: String) -> PyErr {
    TiltrotorError::new_err(words)
}

fn setup(aircraft: &Aircraft, scenario_toml: String) -> PyResult<Setup> {
    let map = files::cockpit("pilot.toml", files::PILOT_MAP).map_err(told)?;
    let cockpit_toml = toml::to_string(&map).map_err(told)?;
    Ok(Setup { aircraft_toml: aircraft.text().into(), cockpit_toml, scenario_toml })
}

#[pymethods]
impl Flight {
    /// Begins at a start position, or as a scenario's text says.
    #[new]
    #[pyo3(signature = (aircraft, start="runway", scenario=None))]
    fn new(aircraft: Aircraft, start: &str, scenario: Option<String>) -> PyResult<Self> {
        let text = match scenario {
            Some(text) => text,
            None => match files::STARTS.iter().find(|(name, ..)| *name == start) {
                Some((_, _, text)) => (*text).into(),
                None => {
                    let names: Vec<_> = files::STARTS.iter().map(|(name, ..)| *name).collect();
                    return Err(refused(format!("start: no position is called {start}; there are {}", names.join(", "))));
                }
            },
        };
        let begins = files::start("scenario.toml", &text).map_err(told)?;
        let setup = setup(&aircraft, text)?;
        let flown = Stepped::begin(aircraft.params.clone(), setup, &begins).map_err(told)?;
        Ok(Self { flown, aircraft })
    }

    /// Moves controls with the next step.
    fn set_control(&mut self, control: &str, position: f64) -> PyResult<()> {
        let Some(known) = self.flown.axes().find(|known| known.facts().key == control) else {
            let keys: Vec<_> = self.flown.axes().map(|known| known.facts().key).collect();
            return Err(refused(format!("{control}: no such control; there are {}", keys.join(", "))));
        };
        let low = known.facts().travel.low_norm();
        if !(low..=1.0).contains(&position) {
            return Err(refused(format!("{control}: expected {low} to 1, got {position}")));
        }
        self.flown.set(known, position);
        Ok(())
    }

    /// The controls that can be moved, each with its lower end and what it is.
    fn controls(&self) -> Vec<(&'static str, f64, &'static str)> {
        let facts = self.flown.axes().map(AxisControl::facts);
        facts.map(|facts| (facts.key, facts.travel.low_norm(), facts.description)).collect()
    }

    /// Presses and releases a button with the next step, or holds it, or lets it go.
    fn button(&mut self, control: &str, pressed: Option<bool>) -> PyResult<()> {
        let Some(known) = ButtonControl::from_key(control) else {
            return Err(refused(format!("{control}: no such button; there are {}", ButtonControl::KEYS.join(", "))));
        };
        for pressed in pressed.map_or(vec![true, false], |pressed| vec![pressed]) {
            self.flown.press(known, pressed);
        }
        Ok(())
    }

    /// Sets or mends a failure.
    fn fail(&mut self, key: &str, failed: bool) -> PyResult<()> {
        let failure = Failures::from_key(key)
            .ok_or_else(|| refused(format!("{key}: no such failure; there are {}", Failures::KEYS.join(", "))))?;
        self.flown.world.failures.set(failure, failed);
        Ok(())
    }

    /// Sets the steady wind.
    fn wind(&mut self, from_deg: f64, kt: f64) -> PyResult<()> {
        if !(from_deg.is_finite() && (0.0..=200.0).contains(&kt)) {
            return Err(refused(format!("wind: expected 0 to 200 kt, got {kt} kt from {from_deg} deg")));
        }
        let (from_rad, mps) = (radians(from_deg), mps_of_knots(kt));
        self.flown.world.wind_mps = Vec3::new(-mps * cos(from_rad), -mps * sin(from_rad), 0.0);
        Ok(())
    }

    /// Sets the vertical intensity of the turbulence, m/s.
    fn turbulence(&mut self, mps: f64) -> PyResult<()> {
        if !(0.0..=15.0).contains(&mps) {
            return Err(refused(format!("turbulence: expected 0 to 15 m/s, got {mps}")));
        }
        self.flown.world.turbulence_mps = mps;
        Ok(())
    }

    /// Commands the actuators in place of the flight control computer; `None` gives them back to it.
    fn command(&mut self, commands: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let Some(given) = commands else {
            let World { commands, .. } = World::default();
            self.flown.world.input_level = InputLevel::Controls as u64;
            self.flown.world.commands = commands;
            return Ok(());
        };
        // From what the computer asks for, or from what was asked for before.
        let outside = self.flown.world.input_level == InputLevel::Actuators as u64;
        let base = if outside { self.flown.world.commands } else { self.flown.outputs.commands };
        let known = fields::fields(&base).map_err(told)?;
        let mut message = cdr::encode(&base).map_err(told)?;
        for (key, value) in given {
            let (key, value) = (key.extract::<String>()?, value.extract::<f64>()?);
            let Some(place) = known.iter().position(|field| field.path == key) else {
                let keys: Vec<_> = known.iter().map(|field| field.path.as_str()).collect();
                return Err(refused(format!("{key}: no such command; there are {}", keys.join(", "))));
            };
            if !value.is_finite() {
                return Err(refused(format!("{key}: expected a finite number, got {value}")));
            }
            let bits = match known[place].value {
                fields::Value::F64(_) => (value + 0.0).to_bits(),
                fields::Value::U64(_) | fields::Value::I64(_) => u64::from(value > 0.5),
            };
            // Eight bytes a number, after the header.
            message[4 + 8 * place..][..8].copy_from_slice(&bits.to_le_bytes());
        }
        self.flown.world.commands = cdr::decode(&message).map_err(told)?;
        self.flown.world.input_level = InputLevel::Actuators as u64;
        Ok(())
    }

    /// Flies so many ticks of 4 ms.
    #[pyo3(signature = (ticks=1))]
    fn step(&mut self, py: Python<'_>, ticks: u64) -> PyResult<()> {
        let mut left = ticks;
        while left > 0 {
            let now = left.min(LOOK_TICKS);
            let flown = &mut self.flown;
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
    fn tick(&self) -> u64 {
        self.flown.state.tick
    }

    /// A second flight from here on, without a log.
    fn copy(&self) -> Self {
        Self { flown: self.flown.fork(), aircraft: self.aircraft.clone() }
    }

    /// The numbers of the state, or of what could be observed: names, numpy's codes, and the bytes.
    fn numbers<'py>(&self, py: Python<'py>, which: &str) -> PyResult<(Vec<(String, &'static str)>, Bound<'py, PyBytes>)> {
        let (message, named) = match which {
            "state" => (cdr::encode(&self.flown.state), fields::fields(&self.flown.state)),
            "outputs" => (cdr::encode(&self.flown.outputs), fields::fields(&self.flown.outputs)),
            _ => return Err(refused(format!("{which}: expected state or outputs"))),
        };
        let (message, named) = (message.map_err(told)?, named.map_err(told)?);
        let code = |value: &fields::Value| match value {
            fields::Value::F64(_) => "<f8",
            fields::Value::U64(_) => "<u8",
            fields::Value::I64(_) => "<i8",
        };
        let named = named.into_iter().map(|field| (field.path, code(&field.value))).collect();
        Ok((named, PyBytes::new(py, &message[4..])))
    }

    /// Records from here on.
    #[pyo3(signature = (path, force=false))]
    fn record(&mut self, path: PathBuf, force: bool) -> PyResult<()> {
        if self.flown.is_recording() {
            return Err(refused("it is being recorded already: close() ends that log".into()));
        }
        let identity = Identity::new()
            .with("program", concat!("tiltrotor python ", env!("CARGO_PKG_VERSION")))
            .with("commit", env!("TILTROTOR_COMMIT"))
            .with("dirty", env!("TILTROTOR_DIRTY"))
            .with("compiler", env!("TILTROTOR_RUSTC"))
            .with("target", env!("TILTROTOR_TARGET"))
            .with("target_features", env!("TILTROTOR_TARGET_FEATURES"))
            .with("profile", env!("TILTROTOR_PROFILE"));
        let shape = files::urdf(&self.aircraft.params);
        let name = path.display().to_string();
        self.flown.record(&path, force, identity, &shape).map_err(|error| told_of(&name, error))
    }

    /// Ends the log; the digest of the whole flight, or `None` when there was no log.
    fn close(&mut self) -> PyResult<Option<String>> {
        let closed = self.flown.close().map_err(told)?;
        Ok(closed.map(|closed| format!("{:016x}", closed.digest)))
    }

    fn __repr__(&self) -> String {
        format!("<tiltrotor.Flight of {} at {:.3} s>", self.aircraft.params.name, self.flown.state.time_s())
    }
}
