//! Logs: what they are, and the numbers in them.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use logs::layout::Kind;
use logs::{Ending, Messages};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use replay::verify as judged;

use crate::errors::{TiltrotorError, told_of};
use crate::waiting::wait;

/// What a log is.
#[pyclass(module = "tiltrotor", frozen, get_all, skip_from_py_object)]
#[derive(Clone)]
pub struct Verdict {
    /// One word: exact, never_closed, damaged, altered, diverged, outputs_differ, compared, unusable.
    outcome: String,
    /// The same in a sentence.
    words: String,
    /// Ticks that are proven exact, from the first on.
    exact_ticks: u64,
    /// Ticks in the log.
    ticks: u64,
    /// The first field that differs, if one does.
    field: Option<String>,
}

#[pymethods]
impl Verdict {
    fn __bool__(&self) -> bool {
        self.outcome == "exact"
    }

    fn __repr__(&self) -> String {
        format!("<tiltrotor.Verdict {}>", self.words)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String, u64, u64, Option<String>))> {
        let this = slf.get().clone();
        Ok((slf.get_type().into_any(), (this.outcome, this.words, this.exact_ticks, this.ticks, this.field)))
    }

    #[new]
    fn new(outcome: String, words: String, exact_ticks: u64, ticks: u64, field: Option<String>) -> Self {
        Self { outcome, words, exact_ticks, ticks, field }
    }
}

/// Reflies a log and compares every bit.
#[pyfunction]
#[pyo3(signature = (path, threads=None))]
pub fn verify(py: Python<'_>, path: PathBuf, threads: Option<usize>) -> PyResult<Verdict> {
    let mut options = judged::Options::default();
    options.threads = threads.unwrap_or(options.threads);
    let name = path.display().to_string();
    let found = wait(py, move |_| judged::verify(&path, &options, |_| ()))?;
    Ok(match found {
        Ok(verdict) => Verdict {
            outcome: verdict.judgement.outcome.name().into(),
            words: verdict.judgement.to_string(),
            exact_ticks: verdict.facts.exact_tick(),
            ticks: verdict.facts.last_tick(),
            field: verdict.divergence.map(|divergence| divergence.path.clone()),
        },
        Err(error) => Verdict {
            outcome: "unusable".into(),
            words: format!("{name}: {error}"),
            exact_ticks: 0,
            ticks: 0,
            field: None,
        },
    })
}

/// Name, and code of numpy's, of each number of a message.
type Fields = Vec<(String, &'static str)>;

/// The channels of a log that hold numbers: how many messages each has.
#[pyfunction]
pub fn channels(py: Python<'_>, path: PathBuf) -> PyResult<BTreeMap<String, u64>> {
    let name = path.display().to_string();
    let counted = wait(py, move |stop| {
        let mut messages = Messages::open(&path, replay::OPEN)?;
        let mut counted = BTreeMap::new();
        while let Some(message) = messages.next_message() {
            if message.layout().is_some() {
                *counted.entry(message.topic().trim_start_matches('/').to_string()).or_default() += 1;
            }
            if stop.load(Ordering::Relaxed) {
                break;
            }
        }
        Ok::<_, logs::LogError>(counted)
    })?;
    counted.map_err(|error| told_of(&name, error))
}

/// All messages of a channel between two ticks, laid end to end without their headers: times, ns; bytes;
/// fields; and what is wrong with the log, if it is damaged.
#[pyfunction]
#[pyo3(signature = (path, channel, from_tick=0, until_tick=u64::MAX))]
#[expect(clippy::type_complexity, reason = "it is taken apart at once, in Python")]
pub fn messages<'py>(
    py: Python<'py>,
    path: PathBuf,
    channel: String,
    from_tick: u64,
    until_tick: u64,
) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>, Fields, Option<String>)> {
    let name = path.display().to_string();
    let wanted = channel.clone();
    let read = wait(py, move |stop| {
        let mut messages = Messages::open(&path, replay::OPEN)?;
        if (from_tick, until_tick) != (0, u64::MAX) {
            messages.limit(from_tick, until_tick)?;
        }
        let (mut times, mut bodies, mut fields) = (Vec::new(), Vec::new(), Fields::new());
        while let Some(message) = messages.next_message() {
            let Some(layout) = message.layout().filter(|_| message.topic().trim_start_matches('/') == wanted) else { continue };
            if fields.is_empty() {
                fields = layout.numbers().iter().map(|number| (number.path.clone(), code(number.kind))).collect();
            }
            // The header says little-endian, and the layout has checked the length.
            layout.bits(&message.data)?;
            bodies.extend_from_slice(&message.data[4..]);
            times.extend_from_slice(&message.time_ns.to_le_bytes());
            if stop.load(Ordering::Relaxed) {
                break;
            }
        }
        let damage = match messages.ending() {
            Ending::Damaged(why) => Some(why.to_string()),
            _ => None,
        };
        Ok::<_, logs::LogError>((times, bodies, fields, damage))
    })?;
    let (times, bodies, fields, damage) = read.map_err(|error| told_of(&name, error))?;
    if fields.is_empty() {
        return Err(TiltrotorError::new_err(format!(
            "{name}: no message of a channel {channel}; tiltrotor.channels(path) says which there are; a compacted log is \
             expanded first: `tiltrotor log expand`"
        )));
    }
    Ok((PyBytes::new(py, &times), PyBytes::new(py, &bodies), fields, damage))
}

fn code(kind: Kind) -> &'static str {
    match kind {
        Kind::F64 => "<f8",
        Kind::U64 => "<u8",
        Kind::I64 => "<i8",
    }
}
