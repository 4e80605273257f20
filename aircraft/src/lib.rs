//! The aircraft's data, and its reader: TOML text to the engine's parameters.
//!
//! Nothing here opens a file; whoever does passes the text and the name to show in messages.
//!
//! - A key names its unit, and any unit of [`units`] will do: `radius_ft = 12.5` fills the engine's
//!   `radius_m`.
//! - Every number of an aircraft file is written with where it comes from and how far to trust it:
//!   `radius_ft = { value = 12.5, source = "TMX §3.7", trust = "V" }`. Vectors are arrays of x, y, z.
//!   A table has its arguments beside its values, the first argument's key first:
//!   `nacelle_degps = { mast_tilt_deg = [0, 90], value = [7.8, 1.9], source = "…", trust = "…" }`.
//! - What cannot be used is refused with file, line, key and what was expected: [`ConfigError`].

mod builtin;
mod check;
mod complete;
mod edit;
mod error;
mod provenance;
mod read;
mod sections;
mod tree;
pub mod units;
mod urdf;

pub use builtin::{
    DEFAULT_SCENARIO, FLIGHTGEAR_MAP, KEYBOARD_MAP, PILOT_MAP, STARTS, STICK_MAP, XV15,
};
pub use edit::{EditError, change_in_words, near, set, values};
pub use error::{ConfigError, Problem};
pub use provenance::{Provenance, Trust};
pub use urdf::urdf;

use engine::cockpit;
use engine::start::Start;
use serde::de::DeserializeOwned;
use tree::Numbers;

/// Reads an aircraft file. Its cockpit map is empty: that has a file of its own.
///
/// A file without `[envelope]`, `[pilot]` or `[display]` is one of before these tables existed, as old logs carry
/// them: it gets the XV-15's.
pub fn aircraft(file_name: &str, text: &str) -> Result<engine::Aircraft, ConfigError> {
    let mut tree = tree::parse(file_name, text, Numbers::Sourced)?.0;
    complete::complete(&mut tree)?;
    sections::divide(&mut tree);
    check::ranges(file_name, &tree)?;
    let params = read::read(file_name, &tree)?;
    check::aircraft(file_name, &tree, &params)?;
    Ok(engine::Aircraft::new(params))
}

/// Reads a cockpit map.
pub fn cockpit(file_name: &str, text: &str) -> Result<cockpit::Params, ConfigError> {
    bare(file_name, text)
}

/// Reads a scenario.
pub fn start(file_name: &str, text: &str) -> Result<Start, ConfigError> {
    bare(file_name, text)
}

/// Lists where the numbers of an aircraft file come from, in the file's order.
pub fn provenance(file_name: &str, text: &str) -> Result<Vec<Provenance>, ConfigError> {
    Ok(tree::parse(file_name, text, Numbers::Sourced)?.1)
}

/// Reads a file whose numbers carry no source.
fn bare<T: DeserializeOwned>(file_name: &str, text: &str) -> Result<T, ConfigError> {
    let tree = tree::parse(file_name, text, Numbers::Bare)?.0;
    check::ranges(file_name, &tree)?;
    read::read(file_name, &tree)
}
