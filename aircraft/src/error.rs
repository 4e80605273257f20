//! What is wrong with a file, and where.

use crate::provenance::Trust;

/// A file that cannot be used: where, and what was expected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}:{line}: {}{problem}", prefix(key))]
pub struct ConfigError {
    /// The file's name, as the caller gave it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// The key with the tables it is in, as written; empty for the file as a whole.
    pub key: String,
    /// What is wrong.
    pub problem: Problem,
}

fn prefix(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("{key}: ") }
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// Not TOML.
    #[error("not valid TOML: {0}")]
    Syntax(String),
    /// A key that nothing reads.
    #[error("unknown key; expected one of {}{}", expected.join(", "), in_other_units(expected))]
    UnknownKey {
        /// Keys that would be read here.
        expected: Vec<String>,
    },
    /// A key that is not there.
    #[error("missing key {name}{}", in_other_units(std::slice::from_ref(name)))]
    MissingKey {
        /// The key, in SI.
        name: String,
    },
    /// The same quantity in two units.
    #[error("given twice: {other} on line {line} is the same in another unit")]
    GivenTwice {
        /// The other key.
        other: String,
        /// Its line.
        line: usize,
    },
    /// Not what belongs there.
    #[error("expected {expected}, found {found}")]
    WrongType {
        /// What belongs there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A name that is none of the known ones.
    #[error("unknown name `{found}`; expected one of {}", expected.join(", "))]
    UnknownName {
        /// What is there.
        found: String,
        /// What could be.
        expected: Vec<String>,
    },
    /// A number without its source.
    #[error(
        "a number without its source; expected \
         {{ value = {found}, source = \"...\", trust = \"...\" }}"
    )]
    Unsourced {
        /// The number.
        found: String,
    },
    /// A part of a sourced number is not there.
    #[error("no {0}; expected {{ value = ..., source = \"...\", trust = \"...\" }}")]
    Incomplete(&'static str),
    /// A trust label that is not one.
    #[error("unknown trust label `{found}`; expected one of {}", Trust::LABELS.join(", "))]
    UnknownTrust {
        /// What is there.
        found: String,
    },
    /// A table over other arguments than the engine's.
    #[error(
        "expected a table over {}{}, found {}; give its values over {}",
        expected.join(", "),
        in_other_units(expected),
        over_or_none(found),
        in_order(expected)
    )]
    Arguments {
        /// The engine's arguments, in SI.
        expected: Vec<String>,
        /// The arguments found, as written.
        found: Vec<String>,
    },
    /// What the engine cannot use, in its words for what it can.
    #[error("expected {0}")]
    Unusable(&'static str),
    /// NaN, an infinity, or a number too large to be held.
    #[error("expected a finite number, found {0}")]
    NotFinite(String),
    /// A number the engine could not work with.
    #[error("expected {} to {}, found {}", figure(*min, 3), figure(*max, 3), figure(*found, 11))]
    OutOfRange {
        /// Least, in the unit of the key.
        min: f64,
        /// Greatest, in the unit of the key.
        max: f64,
        /// Found, in the unit of the key.
        found: f64,
    },
    /// Another number than the one that the model fixes.
    #[error("expected {expected}; found {found}")]
    Fixed {
        /// The number, and why it is fixed.
        expected: &'static str,
        /// Found.
        found: f64,
    },
    /// A least value that is not below the greatest.
    #[error("expected less than {other}")]
    Crossed {
        /// The key of the greatest.
        other: String,
    },
    /// An inertia that no body has.
    #[error("no body has this inertia; expected positive moments with xx*zz above xz squared")]
    Inertia,
    /// Anything else, in its own words.
    #[error("{0}")]
    Other(String),
}

/// A number to so many figures after the first: what was found is told as it was written, but for the rounding of
/// its unit.
fn figure(number: f64, figures: usize) -> String {
    let rounded: f64 = format!("{number:.figures$e}").parse().unwrap_or(number);
    let is_plain = number == 0.0 || (1e-3..1e6).contains(&number.abs());
    if is_plain { rounded.to_string() } else { format!("{rounded:e}") }
}

/// The hint that a key may carry another unit, where one of the keys has one.
fn in_other_units(names: &[String]) -> &'static str {
    if names.iter().any(|name| crate::units::has_other_units(name)) {
        " (or the same in another unit)"
    } else {
        ""
    }
}

fn over_or_none(names: &[String]) -> String {
    if names.is_empty() {
        "no arguments".to_owned()
    } else {
        format!("one over {}", names.join(", "))
    }
}

fn in_order(names: &[String]) -> String {
    let order = if names.len() > 1 { ", in this order" } else { "" };
    format!("{}{order}", names.join(", "))
}
