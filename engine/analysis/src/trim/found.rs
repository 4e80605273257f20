//! A steady flight that was found, or why there is none.

use alloc::boxed::Box;

use engine::{Outputs, State};

use super::limit::Limit;
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
        /// The largest in the best trial; an inner state's rate counts by its weight, see [`Residual::left`].
        residual: f64,
        /// Of what; nothing where there was no trial.
        of: Option<Residual>,
    },
    /// There is a steady flight, but the aircraft cannot fly it.
    Beyond {
        /// Which of its limits.
        limit: Limit,
        /// How much is wanted, 1 being the limit.
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
                if let Some(of) = of {
                    let (left, unit) = (of.left(*residual), of.unit());
                    write!(f, ": {of} is left with {left:.2e} {unit} in the best trial")?;
                }
                f.write_str(
                    "; begin with a flight that trims, and change speed, nacelles, flaps or climb in \
                     small steps",
                )
            }
            Self::Beyond { limit, wanted_norm, .. } => {
                let (wanted, instead) = limit.words(*wanted_norm);
                write!(f, "beyond the aircraft: {wanted}; ask for {instead}")
            }
            Self::Senseless(what) => f.write_str(what),
        }
    }
}

impl core::error::Error for Failure {}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::super::residual::Equation;
    use super::*;
    use crate::variable::Inner;

    #[test]
    fn a_failure_tells_how_much_is_left_in_which_unit_and_what_to_do() {
        let told = |residual, of| Failure::Unsteady { residual, of }.to_string();
        let way_out = "; begin with a flight that trims, and change speed, nacelles, flaps or climb in \
                       small steps";
        assert_eq!(
            told(0.0119, Some(Residual::Equation(Equation::Down))),
            "no steady flight found: acceleration down is left with 1.19e-2 m/s² in the best trial"
                .to_string()
                + way_out
        );
        // .02 of the rate is what counts.
        assert_eq!(
            told(0.0119, Some(Residual::Inner(Inner::Downwash))),
            "no steady flight found: the rate of plant.horizontal_stabilizer.downwash_rad is left with \
             5.95e-1 rad/s in the best trial"
                .to_string()
                + way_out
        );
        assert_eq!(told(f64::MAX, None), "no steady flight found".to_string() + way_out);
        for inner in Inner::of_plant() {
            let unit = Residual::Inner(inner).unit();
            assert!(unit.contains("/s"), "{inner}: {unit}");
        }
    }
}
