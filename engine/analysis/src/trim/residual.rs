//! What must vanish in steady flight.

use alloc::string::ToString;
use core::fmt;

use crate::variable::Inner;

/// What must vanish in steady flight, beside the rates of the inner states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equation {
    /// u̇.
    Forward,
    /// ẇ.
    Down,
    /// q̇.
    Pitch,
    /// Ω̇.
    RotorSpeed,
    /// Change of the engines' power with the lever given, in rated powers a second.
    Power,
    /// v̇.
    Right,
    /// ṗ.
    Roll,
    /// ṙ.
    Yaw,
}

impl Equation {
    /// What must vanish, and its unit.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Forward => ("acceleration forward", "m/s²"),
            Self::Down => ("acceleration down", "m/s²"),
            Self::Pitch => ("pitch acceleration", "rad/s²"),
            Self::RotorSpeed => ("rotor acceleration", "rad/s²"),
            Self::Power => ("engine power", "1/s of rated power"),
            Self::Right => ("acceleration to the right", "m/s²"),
            Self::Roll => ("roll acceleration", "rad/s²"),
            Self::Yaw => ("yaw acceleration", "rad/s²"),
        }
    }

    /// Weighed against the others, for the line search: an m/s² counts like this many of it.
    pub(super) fn weight(self) -> f64 {
        match self {
            Self::Pitch | Self::Roll | Self::Yaw => 3.0,
            Self::Forward | Self::Down | Self::RotorSpeed | Self::Power | Self::Right => 1.0,
        }
    }
}

/// Inner states are fast: their rates are large where their effect is small.
pub(super) const INNER_WEIGHT: f64 = 0.02;

/// Ends of inner states' names, and the units of their rates.
const RATES: [(&str, &str); 4] =
    [("_rad", "rad/s"), ("_radps", "rad/s²"), ("_mps", "m/s²"), ("_w", "W/s")];

/// What is left of a flight that is not steady.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Residual {
    /// Of an equation of the aircraft.
    Equation(Equation),
    /// Of an inner state: its rate, weighed against accelerations.
    Inner(Inner),
}

impl Residual {
    /// Its unit: for an inner state that of its rate.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Equation(equation) => equation.words().1,
            Self::Inner(inner) => {
                let name = inner.to_string();
                RATES.iter().find(|(end, _)| name.ends_with(end)).map_or("1/s", |(_, unit)| unit)
            }
        }
    }

    /// How much is left, in its unit: of an inner state the rate without its weight.
    pub fn left(self, residual: f64) -> f64 {
        match self {
            Self::Equation(_) => residual,
            Self::Inner(_) => residual / INNER_WEIGHT,
        }
    }
}

impl fmt::Display for Residual {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Equation(equation) => f.write_str(equation.words().0),
            Self::Inner(inner) => write!(f, "the rate of {inner}"),
        }
    }
}
