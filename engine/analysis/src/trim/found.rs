//! A steady flight that was found, or why there is none.

use alloc::boxed::Box;

use engine::{Outputs, State};

use super::report::Report;
use super::residual::Residual;

/// A steady flight that was found.
#[derive(Clone, Debug)]
pub struct Trim {
    /// Everything the aircraft remembers in it.
    pub state: State,
    /// What can be observed in it.
    pub outputs: Outputs,
    /// In words that a pilot knows.
    pub report: Report,
}

/// Why there is no trim.
#[derive(Clone, Debug)]
pub enum Failure {
    /// No steady flight was found.
    Unsteady {
        /// The largest in the best trial, in its unit.
        residual: f64,
        /// Of what; nothing where there was no trial.
        of: Option<Residual>,
    },
    /// There is a steady flight, but the aircraft cannot fly it.
    Beyond {
        /// What is asked for too much of.
        what: &'static str,
        /// How much, 1 being all there is.
        wanted_norm: f64,
        /// The flight, with that control at its stop.
        trim: Box<Trim>,
    },
    /// What was asked for makes no sense.
    Senseless(&'static str),
}

impl core::fmt::Display for Failure {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unsteady { residual, of } => {
                f.write_str("no steady flight found")?;
                let Some(of) = of else { return Ok(()) };
                write!(f, ": {of} is left with {residual:.2e}")?;
                let unit = of.unit();
                if unit.is_empty() { Ok(()) } else { write!(f, " {unit}") }
            }
            Self::Beyond { what, wanted_norm, .. } => {
                write!(
                    f,
                    "beyond the aircraft: {what} at {:.0} % of its limit",
                    100.0 * wanted_norm
                )
            }
            Self::Senseless(what) => f.write_str(what),
        }
    }
}

impl core::error::Error for Failure {}
