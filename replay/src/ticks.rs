//! Ticks that are not one after the other.

use std::fmt;

use logs::text::at;

/// Ticks that are missing in a log, or are there twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Irregular {
    /// They are not there.
    Missing {
        /// The first of them.
        first: u64,
        /// The last of them.
        last: u64,
    },
    /// It had been there before.
    Doubled {
        /// Which.
        tick: u64,
    },
}

impl Irregular {
    /// The first such tick.
    pub fn tick(self) -> u64 {
        match self {
            Self::Missing { first: tick, .. } | Self::Doubled { tick } => tick,
        }
    }
}

impl fmt::Display for Irregular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Missing { first, last } if first == last => write!(f, "{} is missing", at(first)),
            Self::Missing { first, last } => {
                write!(
                    f,
                    "{} ticks are missing, from {} to {}",
                    last - first + 1,
                    at(first),
                    at(last)
                )
            }
            Self::Doubled { tick } => write!(f, "{} is there once more", at(tick)),
        }
    }
}
