//! What must vanish in steady flight.

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

/// What is left of a flight that is not steady.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Residual {
    /// Of an equation of the aircraft.
    Equation(Equation),
    /// Of an inner state: its rate, weighed against accelerations.
    Inner(Inner),
}

impl Residual {
    /// Its unit; nothing for inner states, whose rates are weighed.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Equation(equation) => equation.words().1,
            Self::Inner(_) => "",
        }
    }
}

impl fmt::Display for Residual {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Equation(equation) => f.write_str(equation.words().0),
            Self::Inner(inner) => inner.fmt(f),
        }
    }
}
