//! Recorded structs as numpy sees them: names, types, and bytes that are laid end to end.

use logs::fields::{Value, fields};
use logs::layout::{Kind, Layout};
use pyo3::prelude::*;
use serde::Serialize;

use crate::errors::told;

/// Name, and numpy's code of its type, of each number of a message.
pub type Fields = Vec<(String, &'static str)>;

/// Of a message in a log.
pub fn of_layout(layout: &Layout) -> Fields {
    let code = |kind| match kind {
        Kind::F64 => "<f8",
        Kind::U64 => "<u8",
        Kind::I64 => "<i8",
    };
    layout.numbers().iter().map(|number| (number.path.clone(), code(number.kind))).collect()
}

/// Of one of today's structs.
pub fn of_struct(value: &impl Serialize) -> PyResult<Fields> {
    let code = |value| match value {
        Value::F64(_) => "<f8",
        Value::U64(_) => "<u8",
        Value::I64(_) => "<i8",
    };
    let named = fields(value).map_err(told)?;
    Ok(named.into_iter().map(|field| (field.path, code(field.value))).collect())
}

/// The numbers of a message: what follows the header.
pub fn body(message: &[u8]) -> &[u8] {
    message.get(logs::cdr::HEADER.len()..).unwrap_or_default()
}
