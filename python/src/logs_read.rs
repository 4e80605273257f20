//! The numbers in a log.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use logs::units::unit_of;
use logs::{Ending, LogError, Messages};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use replay::OPEN;

use crate::errors::{refused, told_of};
use crate::numbers::{Fields, body, of_layout};
use crate::waiting::wait;

fn bare(topic: &str) -> &str {
    topic.trim_start_matches('/')
}

/// The channels of a log that hold numbers: how many messages each has, and its fields with their units.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "it is taken apart at once, in Python")]
pub fn channels(
    py: Python<'_>,
    path: PathBuf,
) -> PyResult<BTreeMap<String, (u64, Vec<(String, String)>)>> {
    let name = path.display().to_string();
    let counted = wait(py, move |stop| {
        let mut messages = Messages::open(&path, OPEN)?;
        let mut found: BTreeMap<String, (u64, Vec<(String, String)>)> = BTreeMap::new();
        while let Some(message) = messages.next_message() {
            let Some(layout) = message.layout() else { continue };
            if let Some((count, _)) = found.get_mut(bare(message.topic())) {
                *count += 1;
            } else {
                let field = |(path, _): (String, _)| (path.clone(), unit_of(&path));
                let fields = of_layout(layout).into_iter().map(field).collect();
                found.insert(bare(message.topic()).into(), (1, fields));
            }
            if stop.load(Ordering::Relaxed) {
                break;
            }
        }
        Ok::<_, LogError>(found)
    })?;
    counted.map_err(|error| told_of(&name, error))
}

/// What a log says of itself: who flew, when, and the texts that it is reflown from.
#[pyfunction]
pub fn facts(py: Python<'_>, path: PathBuf) -> PyResult<BTreeMap<String, String>> {
    let name = path.display().to_string();
    let read = wait(py, move |_| {
        let reader = logs::open(&path, OPEN)?;
        let mut facts = reader.identity.0.clone();
        for (name, text) in reader.setup.files() {
            facts.insert(name.into(), text.into());
        }
        Ok::<_, LogError>(facts)
    })?;
    read.map_err(|error| told_of(&name, error))
}

/// Messages of a channel: what was read of it.
struct Read {
    times: Vec<u8>,
    bodies: Vec<u8>,
    fields: Fields,
    there: Vec<String>,
    damage: Option<String>,
}

/// All messages of a channel from one tick to another, laid end to end without their headers: times, ns;
/// bytes; fields; and what is wrong with the log, if it is damaged.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "it is taken apart at once, in Python")]
pub fn messages<'py>(
    py: Python<'py>,
    path: PathBuf,
    channel: &str,
    from_tick: u64,
    until_tick: u64,
) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>, Fields, Option<String>)> {
    let name = path.display().to_string();
    let wanted = bare(channel).to_string();
    let read = wait(py, move |stop| {
        let mut messages = Messages::open(&path, OPEN)?;
        if (from_tick, until_tick) != (0, u64::MAX) {
            messages.limit(from_tick, until_tick)?;
        }
        let (times, bodies, fields) = (Vec::new(), Vec::new(), Fields::new());
        let mut read = Read { times, bodies, fields, there: Vec::new(), damage: None };
        while !stop.load(Ordering::Relaxed)
            && let Some(message) = messages.next_message()
        {
            let Some(layout) = message.layout() else { continue };
            let topic = bare(message.topic());
            if topic != wanted {
                if !read.there.iter().any(|known| known == topic) {
                    read.there.push(topic.into());
                }
                continue;
            }
            // Little-endian, as long as its fields say, and all of the same fields.
            let numbers = layout.bits(&message.data)?.len();
            if read.fields.is_empty() {
                read.fields = of_layout(layout);
            } else if numbers != read.fields.len() {
                return Err(LogError::Order(format!("{topic} changes its layout on the way")));
            }
            read.bodies.extend_from_slice(body(&message.data));
            read.times.extend_from_slice(&message.time_ns.to_le_bytes());
        }
        if let Ending::Damaged(why) = messages.ending() {
            read.damage = Some(why.clone());
        }
        Ok::<_, LogError>(read)
    })?;
    let read = read.map_err(|error| told_of(&name, error))?;
    if read.fields.is_empty() && read.damage.is_none() {
        let there = read.there.join(", ");
        return Err(refused(format!(
            "{name}: no message of a channel {channel} there; those with numbers are {there}"
        )));
    }
    let (times, bodies) = (PyBytes::new(py, &read.times), PyBytes::new(py, &read.bodies));
    Ok((times, bodies, read.fields, read.damage))
}
