//! Commands to the actuators by name.

use engine::controls::Commands;
use logs::cdr;
use logs::fields::{Value, fields};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{refused, told};
use crate::numbers::body;

/// The commands by their names, `elevator_rad`, `collective_rad.left`…
pub fn named<'py>(py: Python<'py>, commands: &Commands) -> PyResult<Bound<'py, PyDict>> {
    let known = PyDict::new(py);
    for field in fields(commands).map_err(told)? {
        match field.value {
            Value::F64(value) => known.set_item(field.path, value)?,
            Value::U64(value) => known.set_item(field.path, value)?,
            Value::I64(value) => known.set_item(field.path, value)?,
        }
    }
    Ok(known)
}

/// Commands of which some are changed.
pub fn changed(base: &Commands, given: &Bound<'_, PyDict>) -> PyResult<Commands> {
    let known = fields(base).map_err(told)?;
    let mut message = cdr::encode(base).map_err(told)?;
    let header = message.len() - body(&message).len();
    for (key, value) in given {
        let key = key.extract::<String>()?;
        let number = || refused(format!("{key}: expected a number"));
        let value = value.extract::<f64>().map_err(|_| number())?;
        let Some(place) = known.iter().position(|field| field.path == key) else {
            let keys: Vec<_> = known.iter().map(|field| field.path.as_str()).collect();
            let there = keys.join(", ");
            return Err(refused(format!("{key}: no such command; there are {there}")));
        };
        let bits = match known[place].value {
            _ if !value.is_finite() => {
                return Err(refused(format!("{key}: expected a finite number, got {value}")));
            }
            // What is recorded has no negative zero.
            Value::F64(_) => (value + 0.0).to_bits(),
            Value::U64(_) | Value::I64(_) => u64::from(value > 0.5),
        };
        // Eight bytes a number.
        message[header + 8 * place..][..8].copy_from_slice(&bits.to_le_bytes());
    }
    cdr::decode(&message).map_err(told)
}
