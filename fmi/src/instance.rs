//! What a simulation tool sees: parameters, inputs, outputs, communication steps. No pointer is known here.

use engine::STEP_S;
use logs::cdr;
use recorder::End;

use crate::flying::{Flying, Kept, told};
use crate::values::Values;
use crate::variables::{Role, Target, Value, Variable, table};

/// The most that a communication point may be beside a tick, in ticks: what tools sum up in steps of doubles.
const BESIDE_TICKS: f64 = 1e-3;

/// The most ticks of one communication step: a day.
const TICKS_MAX: f64 = 24.0 * 3600.0 / STEP_S;

/// Where an instance is in its life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Parameters and inputs are set.
    Instantiated,
    /// The same, and outputs of the start can be read.
    Initializing,
    /// Stepped.
    Flying,
    /// Over.
    Terminated,
}

/// A copy of an instance, to which it can be set back.
#[derive(Clone)]
pub struct Copied {
    phase: Phase,
    start_s: f64,
    values: Values,
    flying: Option<Kept>,
}

/// An instance.
pub struct Instance {
    phase: Phase,
    start_s: f64,
    values: Values,
    flying: Option<Flying>,
    /// The outputs as numbers of eight bytes, until the next step.
    outputs: Option<Vec<u8>>,
}

impl Default for Instance {
    fn default() -> Self {
        let (phase, values) = (Phase::Instantiated, Values::default());
        Self { phase, start_s: 0.0, values, flying: None, outputs: None }
    }
}

impl Instance {
    /// The time of the flight's start, as the tool counts it.
    ///
    /// # Errors
    /// When it is no number, or the flight has begun.
    pub fn begins_at(&mut self, start_s: f64) -> Result<(), String> {
        if !start_s.is_finite() {
            return Err(format!("start time: expected a finite number of seconds, got {start_s}"));
        }
        if self.phase != Phase::Instantiated {
            return Err("start time: it is set before the initialization mode".into());
        }
        self.start_s = start_s;
        Ok(())
    }

    /// Into initialization mode.
    ///
    /// # Errors
    /// When it was there already.
    pub fn enter_initialization(&mut self) -> Result<(), String> {
        if self.phase != Phase::Instantiated {
            return Err(
                "initialization mode: it was entered already; reset the instance first".into()
            );
        }
        self.phase = Phase::Initializing;
        Ok(())
    }

    /// Out of initialization mode: the flight begins, and its log.
    ///
    /// # Errors
    /// When there is no such flight, or the log cannot be begun.
    pub fn exit_initialization(&mut self) -> Result<(), String> {
        if self.phase != Phase::Initializing {
            return Err("initialization mode: it is left only once it was entered".into());
        }
        self.begun()?;
        if let Some(flying) = &mut self.flying {
            flying.record(&self.values)?;
        }
        self.phase = Phase::Flying;
        Ok(())
    }

    /// The flight, begun if it has not been since a parameter was set.
    fn begun(&mut self) -> Result<&mut Flying, String> {
        let flying = match self.flying.take() {
            Some(flying) => flying,
            None => Flying::begin(&self.values)?,
        };
        Ok(self.flying.insert(flying))
    }

    /// Ends the flight and its log.
    ///
    /// # Errors
    /// When the log cannot be closed.
    pub fn terminate(&mut self) -> Result<(), String> {
        self.phase = Phase::Terminated;
        self.end(End::Done)
    }

    /// Back to where it was when it was made.
    ///
    /// # Errors
    /// When the log cannot be closed.
    pub fn reset(&mut self) -> Result<(), String> {
        let closed = self.end(End::Stopped(None));
        *self = Self::default();
        closed
    }

    /// Ends the log of a flight that nobody terminated.
    ///
    /// # Errors
    /// When it cannot be closed.
    pub fn leave(&mut self) -> Result<(), String> {
        self.end(End::Stopped(None))
    }

    fn end(&mut self, end: End) -> Result<(), String> {
        self.flying.as_mut().map_or(Ok(()), |flying| flying.close(end))
    }

    /// Flies from a communication point to the next.
    ///
    /// # Errors
    /// When the step is no whole multiple of the flight model's, does not begin where the last one ended, or
    /// the log cannot be written any further.
    pub fn step(&mut self, from_s: f64, step_s: f64) -> Result<(), String> {
        let Some(flying) = self.flying.as_mut().filter(|_| self.phase == Phase::Flying) else {
            return Err("step: the flight begins with the end of the initialization mode, and ends with terminate".into());
        };
        let ticks = step_s / STEP_S;
        let whole = ticks.round();
        if !((ticks - whole).abs() <= BESIDE_TICKS && (1.0..=TICKS_MAX).contains(&whole)) {
            return Err(format!(
                "communication step of {step_s} s: expected a whole multiple of {STEP_S} s, the step of the flight \
                 model; set the tool's communication step size to {STEP_S} s, or to a multiple"
            ));
        }
        let now_s = self.start_s + flying.stepped.state.tick as f64 * STEP_S;
        let beside_s = (from_s - now_s).abs();
        if beside_s.is_nan() || beside_s > BESIDE_TICKS * STEP_S * (1.0 + 1e-3 * now_s.abs()) {
            return Err(format!(
                "communication point {from_s} s: the flight is at {now_s} s; to go back, set the FMU state"
            ));
        }
        self.outputs = None;
        flying.step(&self.values, whole as u64)
    }

    /// Simulated time, s.
    pub fn time_s(&self) -> f64 {
        let tick = self.flying.as_ref().map_or(0, |flying| flying.stepped.state.tick);
        self.start_s + tick as f64 * STEP_S
    }

    /// A number.
    ///
    /// # Errors
    /// When the reference is that of no number, or the flight cannot begin.
    pub fn real(&mut self, reference: u32) -> Result<f64, String> {
        let variable = variable(reference)?;
        match (variable.target, self.values.0.get(reference as usize)) {
            (Target::Time, _) => Ok(self.time_s()),
            (Target::Output(output), _) => self.output(variable, output),
            (_, Some(Value::Real(value))) => Ok(*value),
            _ => Err(format!("{}: this is no number", variable.name)),
        }
    }

    fn output(&mut self, variable: &Variable, output: usize) -> Result<f64, String> {
        if self.phase == Phase::Instantiated {
            return Err(format!(
                "{}: outputs are there from the initialization mode on",
                variable.name
            ));
        }
        if self.outputs.is_none() {
            self.outputs = Some(cdr::encode(&self.begun()?.stepped.outputs).map_err(told)?);
        }
        let bytes = self.outputs.as_deref().unwrap_or_default();
        let from = cdr::HEADER.len() + 8 * output;
        let number = bytes.get(from..from + 8).and_then(|eight| eight.try_into().ok());
        let number = number.ok_or_else(|| format!("{}: no such output", variable.name))?;
        Ok(match variable.role {
            Role::Output { whole: true } => u64::from_le_bytes(number) as f64,
            _ => f64::from_le_bytes(number),
        })
    }

    /// A switch.
    ///
    /// # Errors
    /// When the reference is that of no switch.
    pub fn boolean(&self, reference: u32) -> Result<bool, String> {
        let variable = variable(reference)?;
        match self.values.0.get(reference as usize) {
            Some(Value::Boolean(value)) => Ok(*value),
            _ => Err(format!("{}: this is no switch", variable.name)),
        }
    }

    /// A text.
    ///
    /// # Errors
    /// When the reference is that of no text.
    pub fn text(&self, reference: u32) -> Result<&str, String> {
        let variable = variable(reference)?;
        match self.values.0.get(reference as usize) {
            Some(Value::Text(value)) => Ok(value),
            _ => Err(format!("{}: this is no text", variable.name)),
        }
    }

    /// Sets a parameter or an input.
    ///
    /// # Errors
    /// When it cannot be set, not now, or not to that value.
    pub fn set(&mut self, reference: u32, value: Value) -> Result<(), String> {
        let variable = variable(reference)?;
        let name = &variable.name;
        match variable.role {
            Role::Time | Role::Output { .. } => {
                return Err(format!("{name}: only parameters and inputs can be set"));
            }
            Role::Parameter => {
                if !matches!(self.phase, Phase::Instantiated | Phase::Initializing) {
                    return Err(format!(
                        "{name}: parameters are set before the flight begins; reset the instance first"
                    ));
                }
                (self.flying, self.outputs) = (None, None);
            }
            Role::Input => {}
        }
        if std::mem::discriminant(&variable.start) != std::mem::discriminant(&value) {
            return Err(format!("{name}: a value of another type"));
        }
        if let Value::Real(number) = value
            && !number.is_finite()
        {
            let unit = if variable.unit.is_empty() {
                String::new()
            } else {
                format!(" {}", variable.unit)
            };
            return Err(format!(
                "{name}: expected a finite number, got {number}{unit}; it stays as it was"
            ));
        }
        if let Some(place) = self.values.0.get_mut(reference as usize) {
            *place = value;
        }
        Ok(())
    }

    /// A copy, to which it can be set back.
    pub fn copied(&self) -> Copied {
        Copied {
            phase: self.phase,
            start_s: self.start_s,
            values: self.values.clone(),
            flying: self.flying.as_ref().map(Flying::keep),
        }
    }

    /// Back to a copy. A flight that is recorded cannot go back: its log has one time.
    ///
    /// # Errors
    /// When it is recorded and stands elsewhere.
    pub fn go_to(&mut self, copied: &Copied) -> Result<(), String> {
        let Copied { phase, start_s, values, flying } = copied;
        if let Some(own) = self.flying.as_ref().filter(|own| own.stepped.is_recording()) {
            let is_here = flying.as_ref().is_some_and(|kept| own.stands_at(kept));
            if !is_here || *phase != self.phase {
                return Err("FMU state: a flight that is recorded cannot go back or elsewhere: leave log_file \
                            empty to set states"
                    .into());
            }
        } else {
            self.flying = flying.as_ref().map(Flying::resume).transpose()?;
        }
        (self.phase, self.start_s, self.values) = (*phase, *start_s, values.clone());
        self.outputs = None;
        Ok(())
    }
}

fn variable(reference: u32) -> Result<&'static Variable, String> {
    let found = table().get(reference as usize);
    found.ok_or_else(|| format!("value reference {reference}: there is no such variable"))
}
