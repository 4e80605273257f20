//! The aircraft, and its steady flights.

use std::path::PathBuf;
use std::sync::Arc;

use ::aircraft as files;
use analysis::condition::Condition;
use analysis::trim::{COLUMNS, Column, Failure, Trim as Found, trim};
use engine::units::KNOT_MPS;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

use crate::errors::{refused, told, unsteady};
use crate::linear::Linear;
use crate::waiting::wait;

/// An aircraft file that was read.
#[pyclass(module = "tiltrotor._native", frozen)]
#[derive(Clone)]
pub struct Aircraft {
    pub(crate) params: Arc<engine::Aircraft>,
    toml: Arc<str>,
}

impl Aircraft {
    pub(crate) fn read(name: &str, toml: &str) -> PyResult<Self> {
        // Programs move the controls through the map that scripts use.
        let map = files::cockpit("pilot.toml", files::PILOT_MAP).map_err(told)?;
        let params = files::aircraft(name, toml).map_err(told)?.with_cockpit(map);
        Ok(Self { params: Arc::new(params), toml: toml.into() })
    }

    pub(crate) fn text(&self) -> &str {
        &self.toml
    }
}

#[pymethods]
impl Aircraft {
    #[new]
    #[pyo3(signature = (path=None))]
    fn new(path: Option<PathBuf>) -> PyResult<Self> {
        let Some(path) = path else { return Self::read("xv15.toml", files::XV15) };
        Self::read(&path.display().to_string(), &std::fs::read_to_string(&path)?)
    }

    #[staticmethod]
    #[pyo3(signature = (toml, name="aircraft.toml"))]
    fn from_toml(toml: &str, name: &str) -> PyResult<Self> {
        Self::read(name, toml)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.params.name
    }

    #[getter]
    fn toml(&self) -> &str {
        &self.toml
    }

    fn values(&self) -> PyResult<Vec<(String, String)>> {
        files::values("aircraft.toml", &self.toml).map_err(told)
    }

    fn with_(&self, changes: Vec<(String, String)>, source: &str) -> PyResult<Self> {
        let mut toml = self.toml.to_string();
        for (key, value) in changes {
            toml = files::set("aircraft.toml", &toml, &key, &value, source)
                .map_err(|error| PyKeyError::new_err(error.to_string()))?;
        }
        Self::read("aircraft.toml", &toml)
    }

    #[pyo3(signature = (**condition))]
    fn trim(&self, py: Python<'_>, condition: Option<&Bound<'_, PyDict>>) -> PyResult<Trim> {
        let (params, target) = asked(condition)?.target(&self.params).map_err(|f| unsteady(&f))?;
        let found = wait(py, move |_| trim(&params, &target))?;
        Ok(Trim { found: found.map_err(|why| unsteady(&why))? })
    }

    #[pyo3(signature = (**condition))]
    fn linearize(&self, py: Python<'_>, condition: Option<&Bound<'_, PyDict>>) -> PyResult<Linear> {
        let condition = asked(condition)?;
        let (params, target) = condition.target(&self.params).map_err(|f| unsteady(&f))?;
        let found = wait(py, move |_| {
            let found = trim(&params, &target)?;
            Ok::<_, Failure>(analysis::linearize::linearize(&params, &found, &target.world))
        })?;
        let found = found.map_err(|why| unsteady(&why))?;
        Ok(Linear { found, airspeed_mps: condition.speed_kt * KNOT_MPS })
    }

    /// The text of a scenario, its start in steady flight.
    #[pyo3(signature = (scenario, **condition))]
    fn scenario_in_trim(
        &self,
        scenario: &str,
        condition: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<String> {
        const KNOWN: [&str; 7] =
            ["nacelle_deg", "speed_kt", "altitude_ft", "climb_fpm", "flap_deg", "rpm", "scas_on"];
        for (key, _) in condition.into_iter().flatten() {
            let key: String = key.extract()?;
            if !KNOWN.contains(&key.as_str()) {
                let there = KNOWN.join(", ");
                return Err(refused(format!("{key}: a flight that begins in trim has {there}")));
            }
        }
        if files::start("scenario.toml", scenario).map_err(told)?.trim.is_some() {
            return Err(refused(
                "trim: the scenario begins in the air already, by its table [trim]",
            ));
        }
        let condition = asked(condition)?;
        let table = condition.start_toml(&self.params, "--from-trim").map_err(|f| unsteady(&f))?;
        Ok(format!("{scenario}{table}"))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("from_toml")?, (slf.get().toml.to_string(),)))
    }
}

const CONDITIONS: [&str; 15] = [
    "nacelle_deg",
    "speed_kt",
    "climb_fpm",
    "lever_percent",
    "turn_degps",
    "bank_deg",
    "sideslip_deg",
    "weight_lb",
    "altitude_ft",
    "height_ft",
    "isa_k",
    "flap_deg",
    "rpm",
    "gear_down",
    "scas_on",
];

/// The keyword arguments as a condition.
fn asked(given: Option<&Bound<'_, PyDict>>) -> PyResult<Condition> {
    let mut asked = Condition::default();
    for (key, value) in given.into_iter().flatten() {
        let key: String = key.extract()?;
        let number = || match value.extract::<f64>() {
            Ok(number) if !value.is_instance_of::<PyBool>() => Ok(number),
            _ => Err(refused(format!("{key}: expected a number"))),
        };
        let flag = || {
            value.extract::<bool>().map_err(|_| refused(format!("{key}: expected True or False")))
        };
        // What is None is what was not given.
        if value.is_none() && CONDITIONS.contains(&key.as_str()) {
            continue;
        }
        match key.as_str() {
            "nacelle_deg" => asked.nacelle_deg = number()?,
            "speed_kt" => asked.speed_kt = number()?,
            "climb_fpm" => asked.climb_fpm = number()?,
            "lever_percent" => asked.lever_percent = Some(number()?),
            "turn_degps" => asked.turn_degps = number()?,
            "bank_deg" => asked.bank_deg = Some(number()?),
            "sideslip_deg" => asked.sideslip_deg = number()?,
            "weight_lb" => asked.weight_lb = Some(number()?),
            "altitude_ft" => asked.altitude_ft = number()?,
            "height_ft" => asked.height_ft = Some(number()?),
            "isa_k" => asked.isa_k = number()?,
            "flap_deg" => asked.flap_deg = Some(number()?),
            "rpm" => asked.rpm = Some(number()?),
            "gear_down" => asked.gear_down = flag()?,
            "scas_on" => asked.scas_on = flag()?,
            _ => {
                let there = CONDITIONS.join(", ");
                return Err(refused(format!("{key}: no such condition; there are {there}")));
            }
        }
    }
    Ok(asked)
}

/// A steady flight.
#[pyclass(module = "tiltrotor._native", frozen)]
pub struct Trim {
    found: Found,
}

#[pymethods]
impl Trim {
    /// Its numbers by name, the unit in the name.
    fn numbers(&self) -> Vec<(String, f64)> {
        COLUMNS.iter().map(|column| (column.key(), (column.of)(&self.found))).collect()
    }

    /// The same in words, rounded as the command prints them.
    fn words(&self) -> Vec<(&'static str, String, &'static str)> {
        let told = |c: &Column| (c.name, c.value(&self.found), c.unit);
        COLUMNS.iter().map(told).collect()
    }
}
