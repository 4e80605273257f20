//! What is made of a log by flying it again.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use ::aircraft as files;
use logs::cdr;
use logs::output::Output;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use replay::changes::Changes;
use replay::identify::{Options, Point, Record, Signal, record};
use replay::{
    NewLog, OPEN, Outcome, Reflight, ReflyOptions, ReplayError, Source, Window, names_parent,
    parent, proven_while, rewrite_in,
};

use crate::errors::{refused, told_of};
use crate::numbers::{Fields, body, of_struct};
use crate::provenance::identity;
use crate::verdict::Verdict;
use crate::waiting::{wait, wanted_still};

/// State or outputs of every tick of a log, reflown: what a log holds of the outputs is one tick in ten.
/// The numbers end to end, and the first tick that is not the recorded one.
#[pyfunction]
pub fn refly<'py>(
    py: Python<'py>,
    path: PathBuf,
    which: &str,
    from_tick: Option<u64>,
    until_tick: Option<u64>,
    every: u64,
) -> PyResult<(Bound<'py, PyBytes>, Fields, Option<u64>)> {
    let states = match which {
        "state" => true,
        "outputs" => false,
        _ => return Err(refused(format!("{which}: expected state or outputs"))),
    };
    let fields = if states {
        of_struct(&engine::State::default())?
    } else {
        of_struct(&engine::Outputs::default())?
    };
    let name = path.display().to_string();
    let every = every.max(1);
    let flown = wait(py, move |stop| {
        let window = Window { from_tick, until_tick, clamped: false };
        let mut flight = Reflight::open(&path, &ReflyOptions { window, across_versions: false })?;
        let (mut bodies, mut diverged) = (Vec::new(), None);
        while !stop.load(Ordering::Relaxed)
            && let Some(tick) = flight.next_tick()?
        {
            let number = tick.state.tick;
            if !tick.exact {
                diverged.get_or_insert(number);
            }
            if number.is_multiple_of(every) {
                let message =
                    if states { cdr::encode(tick.state) } else { cdr::encode(tick.outputs) };
                bodies.extend_from_slice(body(&message?));
            }
            flight.reader.forget();
        }
        Ok::<_, ReplayError>((bodies, diverged))
    })?;
    let (bodies, diverged) = flown.map_err(|error| told_of(&name, error))?;
    Ok((PyBytes::new(py, &bodies), fields, diverged))
}

/// What is asked of a what-if.
struct Wanted {
    log: PathBuf,
    out: PathBuf,
    set: Vec<(String, String)>,
    world: Vec<String>,
    fail: Vec<String>,
    mend: Vec<String>,
    window: Window,
    force: bool,
}

/// Flies the recorded inputs with something changed, into a new log; what that one is.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub fn whatif(
    py: Python<'_>,
    log: PathBuf,
    out: PathBuf,
    set: Vec<(String, String)>,
    world: Vec<String>,
    fail: Vec<String>,
    mend: Vec<String>,
    from_tick: u64,
    until_tick: Option<u64>,
    force: bool,
) -> PyResult<Verdict> {
    let name = log.display().to_string();
    let window = Window { from_tick: Some(from_tick), until_tick, clamped: from_tick == 0 };
    let wanted = Wanted { log, out, set, world, fail, mend, window, force };
    let made = wait(py, move |stop| what_if(&wanted, stop))?;
    made.map_err(|error| refused(format!("{name}: {error}")))
}

fn what_if(
    wanted: &Wanted,
    stop: &AtomicBool,
) -> Result<Verdict, Box<dyn std::error::Error + Send + Sync>> {
    let log = wanted.log.as_path();
    let source = Source::proven(log, "not flown")?;
    wanted_still(stop)?;
    let mut reader = logs::open(log, OPEN)?;
    let mut setup = reader.setup.clone();
    let mut said = Vec::new();
    for (key, value) in &wanted.set {
        let file = log.file_name().unwrap_or_default().display().to_string();
        let by = format!("what-if of {file}");
        let words = files::change_in_words("aircraft.toml", &setup.aircraft_toml, key, value)?;
        setup.aircraft_toml = files::set("aircraft.toml", &setup.aircraft_toml, key, value, &by)?;
        // One at a time: the key that is wrong is the one that is told.
        files::aircraft("aircraft.toml", &setup.aircraft_toml)?;
        said.push(words);
    }
    wanted.window.apply(&mut reader)?;
    let initial = reader.initial;
    let changes = Changes::read(&wanted.world, &wanted.fail, &wanted.mend, initial.tick)?;
    said.extend(changes.words.iter().cloned());
    let identity = source
        .marks(names_parent(identity(), log, &reader, "whatif"))
        .with(parent::CHANGES, said.join("; "));
    let output = Output::beside(&wanted.out, wanted.force, &[log])?;
    let new = NewLog {
        out: &output,
        setup: &setup,
        identity: &identity,
        timing: false,
        devices: &source.devices,
        picture_of: Some(Path::new(log)),
    };
    let change = |world| wanted_still(stop).map(|()| changes.apply(world));
    rewrite_in(&mut reader, &initial, &new, change, |_, _, _, _| ())?;
    let sound = [Outcome::Exact, Outcome::NeverClosed];
    let judgement = proven_while(output.unfinished(), &sound, |_| wanted_still(stop))?;
    // What takes long of finishing, before the last look for Ctrl-C.
    output.file()?.sync_all()?;
    wanted_still(stop)?;
    output.finish()?;
    Ok(Verdict::of_judgement(&judgement))
}

/// Name and unit of a signal.
type Named = (String, String);

/// A frequency, rad/s; response, real and imaginary; coherence; error of the gain; segment, s.
type Frequency = (f64, f64, f64, f64, f64, f64);

/// The frequency response of one signal of a log to another.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub fn identify(
    py: Python<'_>,
    log: PathBuf,
    input: &str,
    output: &str,
    low_radps: Option<f64>,
    high_radps: Option<f64>,
    per_decade: Option<f64>,
    segment_s: Option<f64>,
    from_tick: Option<u64>,
    until_tick: Option<u64>,
) -> PyResult<(Named, Named, Vec<Frequency>, Verdict)> {
    let name = log.display().to_string();
    let signal = |what, name| Signal::named(name).map_err(|error| told_of(what, error));
    let (input, output) = (signal("input", input)?, signal("output", output)?);
    let usual = Options::default();
    let options = Options {
        low_radps,
        high_radps: high_radps.unwrap_or(usual.high_radps),
        per_decade: per_decade.unwrap_or(usual.per_decade),
        segment_s,
    };
    let window = Window { from_tick, until_tick, clamped: false };
    let found = wait(py, move |_| {
        let (record, judgement) = record(&log, &window, input, output)?;
        let points =
            record.response(&options).map_err(|why| ReplayError::Refused(why.to_string()))?;
        Ok::<_, ReplayError>((record, points, judgement))
    })?;
    let (Record { input, output, .. }, points, judgement) =
        found.map_err(|error| told_of(&name, error))?;
    let frequency = |point: &Point| {
        let Point { omega_radps, response, coherence, error, segment_s } = *point;
        (omega_radps, response.re, response.im, coherence, error, segment_s)
    };
    let points = points.iter().map(frequency).collect();
    let verdict = Verdict::of_judgement(&judgement);
    Ok(((input.name, input.unit), (output.name, output.unit), points, verdict))
}
