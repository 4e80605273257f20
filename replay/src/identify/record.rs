//! Two signals of a flight, tick by tick.

use std::path::Path;

use analysis::linearize::{INPUTS, OUTPUTS, inputs_of, outputs_of};
use engine::units::{DEG_PER_RAD as DEG, INCH_M, RPM_RADPS};
use engine::{Aircraft, GRAVITY_MPS2, Outputs, STEP_S, State};
use logs::layout::{Kind, Layout};
use logs::units::unit_of;
use logs::{LogError, cdr};

use super::spectra::{Options, Point, Refusal, estimate};
use crate::judgement::{Facts, Judgement, disorder};
use crate::refly::{Reflight, ReflyOptions, ReplayError, Window};

/// A number of every tick, by its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// As `linearize` or the log calls it.
    pub name: String,
    /// What it is told in.
    pub unit: String,
    source: Source,
    /// From the recorded unit to that one.
    factor: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// One of the inputs of `linearize`.
    Input(usize),
    /// One of its outputs.
    Output(usize),
    /// A number of the state, by its place among its bytes; whether it is held through a tick.
    State { place: usize, held: bool },
}

/// No such signal.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{name}` is no signal: there are {there}; and every number of the state by the name that \
     `tiltrotor log cat --channel state` has for it"
)]
pub struct Unknown {
    name: String,
    there: String,
}

/// A pilot's unit for a name of `linearize`: unit and factor from SI.
fn unit(name: &str) -> (&'static str, f64) {
    const ENDS: [(&str, &str, f64); 7] = [
        ("_force_forward_mps2", "g", 1.0 / GRAVITY_MPS2),
        ("_force_right_mps2", "g", 1.0 / GRAVITY_MPS2),
        ("_force_down_mps2", "g", 1.0 / GRAVITY_MPS2),
        ("rotor_speed_radps", "rpm", 1.0 / RPM_RADPS),
        ("_radps", "deg/s", DEG),
        ("_rad", "deg", DEG),
        ("power_w", "kW", 1e-3),
    ];
    let told = ENDS.iter().find(|(end, ..)| name.ends_with(end)).map(|&(_, unit, by)| (unit, by));
    told.unwrap_or(if name.ends_with("_mps") { ("m/s", 1.0) } else { ("in", 1.0 / INCH_M) })
}

/// A name of `linearize` with its unit, or without.
fn is_called(name: &str, full: &str) -> bool {
    name == full
        || full.strip_prefix(name).is_some_and(|unit| unit.starts_with('_') && short(full) == name)
}

/// A name of `linearize` without its unit.
fn short(full: &str) -> &str {
    full.rsplit_once('_').map_or(full, |(name, _)| name)
}

impl Signal {
    /// The signal of that name: an input or output of `linearize`, its unit may be left out, or a number
    /// of the state by its full name.
    ///
    /// # Errors
    /// When there is none.
    pub fn named(name: &str) -> Result<Self, Unknown> {
        let of = |names: &[&str]| names.iter().position(|full| is_called(name, full));
        let told = |full: &str, source| {
            let (unit, factor) = unit(full);
            Self { name: full.into(), unit: unit.into(), source, factor }
        };
        if let Some(place) = of(&INPUTS) {
            return Ok(told(INPUTS[place], Source::Input(place)));
        }
        if let Some(place) = of(&OUTPUTS) {
            return Ok(told(OUTPUTS[place], Source::Output(place)));
        }
        let path = name.strip_prefix("state.").unwrap_or(name);
        let layout = Layout::of::<State>().unwrap_or_default();
        let is_it =
            |number: &&logs::layout::Number| number.path == path && number.kind == Kind::F64;
        if let Some(place) = layout.numbers().iter().position(|number| is_it(&number)) {
            let unit = unit_of(path);
            let held = path.starts_with("cockpit.") || path.starts_with("actuators.");
            let (unit, factor) = match unit.strip_prefix("rad") {
                Some(rest) => (format!("deg{rest}"), DEG),
                None => (unit, 1.0),
            };
            let source = Source::State { place, held };
            return Ok(Self { name: path.into(), unit, source, factor });
        }
        let there: Vec<&str> = INPUTS.iter().chain(&OUTPUTS).map(|full| short(full)).collect();
        Err(Unknown { name: name.into(), there: there.join(", ") })
    }

    /// Its number after a tick.
    ///
    /// # Errors
    /// When the state cannot be encoded, which it always can.
    fn of(&self, aircraft: &Aircraft, state: &State, seen: &Outputs) -> Result<f64, LogError> {
        let number = match self.source {
            Source::Input(place) => inputs_of(aircraft, state)[place],
            Source::Output(place) => outputs_of(state, seen)[place],
            Source::State { place, .. } => {
                let bytes = cdr::encode(state)?;
                let at = bytes.len() - Layout::of::<State>()?.numbers().len() * 8 + place * 8;
                let eight = bytes.get(at..at + 8).and_then(|eight| eight.try_into().ok());
                f64::from_le_bytes(eight.unwrap_or_default())
            }
        };
        Ok(number * self.factor)
    }

    /// Whether it stands still through the tick after which it is recorded.
    fn is_held(&self) -> bool {
        matches!(self.source, Source::Input(_) | Source::State { held: true, .. })
    }
}

/// Two signals of a flight.
#[derive(Clone, Debug)]
pub struct Record {
    /// What moves.
    pub input: Signal,
    /// What answers.
    pub output: Signal,
    numbers: [Vec<f64>; 2],
}

impl Record {
    /// Nothing yet.
    pub fn new(input: Signal, output: Signal) -> Self {
        Self { input, output, numbers: [Vec::new(), Vec::new()] }
    }

    /// Adds a tick.
    ///
    /// # Errors
    /// When the state cannot be encoded, which it always can.
    pub fn add(
        &mut self,
        aircraft: &Aircraft,
        state: &State,
        seen: &Outputs,
    ) -> Result<(), LogError> {
        let [input, output] = &mut self.numbers;
        input.push(self.input.of(aircraft, state, seen)?);
        output.push(self.output.of(aircraft, state, seen)?);
        Ok(())
    }

    /// How long it is, s.
    pub fn length_s(&self) -> f64 {
        self.numbers[0].len() as f64 * STEP_S
    }

    /// The response. What is held through a tick is recorded after it, half a tick later than it was on
    /// average: that much is taken off the phase.
    ///
    /// # Errors
    /// As [`estimate()`] says.
    pub fn response(&self, options: &Options) -> Result<Vec<Point>, Refusal> {
        let [input, output] = &self.numbers;
        let mut points = estimate(input, output, STEP_S, options)?;
        let half = |signal: &Signal| if signal.is_held() { 0.5 * STEP_S } else { 0.0 };
        let early_s = half(&self.input) - half(&self.output);
        for point in &mut points {
            let angle_rad = -early_s * point.omega_radps;
            let (sin, cos) = engine::math::sin_cos(angle_rad);
            point.response *= rustfft::num_complex::Complex::new(cos, sin);
        }
        Ok(points)
    }
}

/// The two signals of a log, or of a part of it, as it reflies, and what the log is.
///
/// # Errors
/// When it cannot be reflown, or goes on from another state on the way.
pub fn record(
    log: &Path,
    window: &Window,
    input: Signal,
    output: Signal,
) -> Result<(Record, Judgement), ReplayError> {
    let options = ReflyOptions { window: *window, across_versions: false };
    let mut flight = Reflight::open(log, &options)?;
    let mut facts = Facts::of_reflight(&flight);
    let mut record = Record::new(input, output);
    let aircraft = flight.aircraft.clone();
    let disorder = loop {
        match flight.next_tick() {
            Ok(Some(reflown)) => {
                if reflown.recorded.restart.is_some() {
                    // What was before is another flight.
                    record.numbers.iter_mut().for_each(Vec::clear);
                }
                record.add(&aircraft, reflown.state, reflown.outputs)?;
                facts.add(reflown.recorded, Some(reflown.exact));
                flight.reader.timings.clear();
            }
            Ok(None) => break None,
            Err(error) => break Some(disorder(error)?),
        }
    };
    facts.end_of_reflight(&mut flight, disorder, window);
    Ok((record, facts.judge()))
}
