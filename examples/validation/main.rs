//! Writes VALIDATION.md and its pictures: every published case that can be computed, with the
//! published number, ours, the difference and a verdict.
//!
//! `cargo run --release --no-default-features --example validation`, and the same with `cargo test`
//! to ask whether the files are fresh.

mod airframe;
mod book;
mod dynamics;
mod envelope;
mod fits;
mod flaps;
mod flown;
mod hover;
mod identified;
mod lateral;
mod page;
mod performance;
mod pictures;
mod power_off;
mod rotor_stand;
mod sidling;
mod trims;

use std::fs;
use std::path::Path;

use engine::Aircraft;

use crate::book::Book;

/// Everything that is written: path from the repository's root, text.
fn generate() -> Vec<(String, String)> {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
    let mut book = Book::default();
    hover::isolated_rotor(&aircraft, &mut book);
    hover::hover(&aircraft, &mut book);
    trims::helicopter(&aircraft, &mut book);
    trims::nacelles(&aircraft, &mut book);
    performance::bucket(&aircraft, &mut book);
    hover::ceilings(&aircraft, &mut book);
    performance::speed(&aircraft, &mut book);
    performance::stall(&aircraft, &mut book);
    dynamics::responses(&aircraft, &mut book);
    dynamics::control(&aircraft, &mut book);
    performance::conversion(&aircraft, &mut book);
    dynamics::symmetry(&aircraft, &mut book);
    performance::autorotation(&aircraft, &mut book);
    airframe::components(&aircraft, &mut book);
    power_off::descents(&aircraft, &mut book);
    flaps::by_flap(&aircraft, &mut book);
    rotor_stand::in_wind(&aircraft, &mut book);
    envelope::aeroplane(&aircraft, &mut book);
    envelope::ceilings(&aircraft, &mut book);
    lateral::qualities(&aircraft, &mut book);
    lateral::derivatives(&aircraft, &mut book);
    lateral::sideward(&aircraft, &mut book);
    lateral::sideslips(&aircraft, &mut book);
    lateral::engine_out(&aircraft, &mut book);
    identified::responses(&aircraft, &mut book);
    let mut files = pictures::all(&aircraft);
    files.push(("VALIDATION.md".into(), page::page(&book)));
    files
}

/// The aircraft at a weight in pounds, fuel and empty mass as for half-full tanks.
fn weighing(aircraft: &Aircraft, weight_lb: f64) -> (Aircraft, f64) {
    let fuel_kg = 0.5 * aircraft.weight_balance.fuel_kg_max;
    let zero_fuel_mass_kg = weight_lb * book::POUND_KG - fuel_kg;
    let loaded = aircraft.clone().with(|a| a.weight_balance.zero_fuel_mass_kg = zero_fuel_mass_kg);
    (loaded, fuel_kg)
}

fn main() -> std::io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (path, text) in generate() {
        let path = root.join(path);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        logs::output::write(&path, &text, &[]).map_err(std::io::Error::other)?;
        println!("{}", path.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_written_validation_is_what_the_model_does_now() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        for (path, text) in generate() {
            let written = fs::read_to_string(root.join(&path)).unwrap_or_default();
            let line = written.lines().zip(text.lines()).position(|(a, b)| a != b);
            assert!(
                written == text,
                "{path} is stale from line {}: run `cargo run --release --no-default-features \
                 --example validation`",
                line.unwrap_or(0) + 1
            );
        }
    }
}
