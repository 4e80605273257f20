//! The aircraft, and its steady flights.

use std::path::PathBuf;
use std::sync::Arc;

use ::aircraft as files;
use analysis::condition::Condition;
use analysis::trim::{COLUMNS, Trim as Found, trim};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{TiltrotorError, told, unsteady};
use crate::linear::Linear;
use crate::waiting::wait;

/// An aircraft file that was read.
#[pyclass(module = "tiltrotor", frozen, from_py_object)]
#[derive(Clone)]
pub struct Aircraft {
    pub(crate) params: Arc<engine::Aircraft>,
    toml: Arc<str>,
}

impl Aircraft {
    fn read(name: &str, toml: &str) -> PyResult<Self> {
        // Scripts and programs move the controls through this map.
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

    /// Of the text of an aircraft file.
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

    /// Every number that can be changed, by its key.
    fn values(&self) -> PyResult<Vec<(String, String)>> {
        files::values("aircraft.toml", &self.toml).map_err(told)
    }

    /// The same aircraft with numbers changed.
    #[pyo3(signature = (changes, source="changed in Python"))]
    fn with_(&self, changes: &Bound<'_, PyDict>, source: &str) -> PyResult<Self> {
        let mut toml = self.toml.to_string();
        for (key, value) in changes {
            let (key, value) = (key.extract::<String>()?, value.str()?.to_string());
            toml = files::set("aircraft.toml", &toml, &key, &value, source)
                .map_err(|error| PyKeyError::new_err(error.to_string()))?;
        }
        Self::read("aircraft.toml", &toml)
    }

    #[pyo3(signature = (**condition))]
    fn trim(&self, py: Python<'_>, condition: Option<&Bound<'_, PyDict>>) -> PyResult<Trim> {
        let (params, target) = asked(condition)?.target(&self.params).map_err(|fault| unsteady(&fault))?;
        let found = wait(py, move |_| trim(&params, &target))?.map_err(|why| unsteady(&why))?;
        Ok(Trim { found })
    }

    #[pyo3(signature = (**condition))]
    fn linearize(&self, py: Python<'_>, condition: Option<&Bound<'_, PyDict>>) -> PyResult<Linear> {
        let (params, target) = asked(condition)?.target(&self.params).map_err(|fault| unsteady(&fault))?;
        let found = wait(py, move |_| {
            let found = trim(&params, &target)?;
            Ok::<_, analysis::trim::Failure>(analysis::linearize::linearize(&params, &found, &target.world))
        })?;
        Ok(Linear { found: found.map_err(|why| unsteady(&why))? })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let this = slf.get();
        Ok((slf.get_type().getattr("from_toml")?, (this.toml.to_string(),)))
    }

    fn __repr__(&self) -> String {
        format!("<tiltrotor.Aircraft {}>", self.params.name)
    }
}

/// The keyword arguments as a condition.
fn asked(given: Option<&Bound<'_, PyDict>>) -> PyResult<Condition> {
    let mut asked = Condition::default();
    for (key, value) in given.into_iter().flatten() {
        let key: String = key.extract()?;
        let number = || value.extract::<f64>().map_err(|_| TiltrotorError::new_err(format!("{key}: expected a number")));
        let flag = || value.extract::<bool>().map_err(|_| TiltrotorError::new_err(format!("{key}: expected True or False")));
        match key.as_str() {
            "nacelle_deg" => asked.nacelle_deg = number()?,
            "speed_kt" => asked.speed_kt = number()?,
            "climb_fpm" => asked.climb_fpm = number()?,
            "lever_percent" => asked.lever_percent = Some(number()?),
            "turn_degps" => asked.turn_degps = number()?,
            "bank_deg" => asked.bank_deg = Some(number()?),
            "sideslip_deg" => asked.sideslip_deg = number()?,
            "weight_lb" => asked.weight_lb = number()?,
            "altitude_ft" => asked.altitude_ft = number()?,
            "height_ft" => asked.height_ft = Some(number()?),
            "isa_k" => asked.isa_k = number()?,
            "flap_deg" => asked.flap_deg = Some(number()?),
            "rpm" => asked.rpm = Some(number()?),
            "gear_down" => asked.gear_down = flag()?,
            "scas_on" => asked.scas_on = flag()?,
            _ => return Err(TiltrotorError::new_err(format!(
                "{key}: no such condition; there are {}", CONDITIONS.join(", ")
            ))),
        }
    }
    for (key, value) in [("nacelle_deg", asked.nacelle_deg), ("speed_kt", asked.speed_kt), ("altitude_ft", asked.altitude_ft)] {
        if !value.is_finite() {
            return Err(TiltrotorError::new_err(format!("{key}: expected a finite number, got {value}")));
        }
    }
    Ok(asked)
}

const CONDITIONS: [&str; 15] = [
    "nacelle_deg", "speed_kt", "climb_fpm", "lever_percent", "turn_degps", "bank_deg", "sideslip_deg", "weight_lb",
    "altitude_ft", "height_ft", "isa_k", "flap_deg", "rpm", "gear_down", "scas_on",
];

/// A steady flight.
#[pyclass(module = "tiltrotor", frozen)]
pub struct Trim {
    found: Found,
}

#[pymethods]
impl Trim {
    /// Its numbers by name, the unit in the name, as `tiltrotor trim --csv` has them.
    fn as_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let numbers = PyDict::new(py);
        for column in &COLUMNS {
            numbers.set_item(column.key(), (column.of)(&self.found))?;
        }
        Ok(numbers)
    }

    fn __getitem__(&self, key: &str) -> PyResult<f64> {
        let column = COLUMNS.iter().find(|column| column.key() == key);
        let names = || COLUMNS.iter().map(analysis::trim::Column::key).collect::<Vec<_>>().join(", ");
        column.map(|column| (column.of)(&self.found)).ok_or_else(|| PyKeyError::new_err(format!("{key}; there are {}", names())))
    }

    fn __repr__(&self) -> String {
        let numbers: Vec<_> = COLUMNS.iter().map(|column| format!("{} {} {}", column.name, column.value(&self.found), column.unit)).collect();
        format!("<tiltrotor.Trim {}>", numbers.join(", "))
    }
}
