//! Writes the second aircraft, `aircraft/generic.toml`, from the XV-15's file by laws of scale; run as a test
//! it says whether the file in the tree is fresh.
//!
//! # Equations
//! ```text
//! Froude: length λ, time √λ, mass λ³, so that speeds go by √λ, forces by λ³, moments by λ⁴, power by λ³·⁵
//! ```
//! Angles, coefficients, Mach numbers and parts of a travel stay. An exponent follows from the unit in which
//! a key ends: a parameter that is added to the XV-15's file is scaled without a word here.
//! # Assumptions
//! The air stays what it is: the scaled aircraft flies at lower Mach numbers. Heights at which the model's
//! data end are the air's and stay. What [`OWN`] has is another choice, not a scaled one.

mod generic {
    pub mod dimension;
    pub mod write;
}

use std::fs;
use std::path::{Path, PathBuf};

use generic::write::generic_toml;

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("generic.toml")
}

fn main() -> std::io::Result<()> {
    fs::write(file(), generic_toml())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_in_the_tree_is_the_one_that_is_made() {
        let there = fs::read_to_string(file()).unwrap_or_default();
        assert!(there == generic_toml(), "run `cargo run -p aircraft --example generic`");
    }
}
