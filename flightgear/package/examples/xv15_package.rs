//! Writes FlightGear's XV-15; run as a test it says whether the files in the tree are fresh.

use std::fs;
use std::path::{Path, PathBuf};

use flightgear_package::{FOLDER, File};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(FOLDER)
}

fn made() -> Vec<File> {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    flightgear_package::files(&aircraft)
}

fn main() -> std::io::Result<()> {
    for file in made() {
        let path = folder().join(&file.path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(&path, &file.bytes)?;
        println!("{:>8} bytes  {FOLDER}/{}", file.bytes.len(), file.path);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_in_the_tree_are_those_that_are_made() {
        for file in made() {
            let path = folder().join(&file.path);
            let there = fs::read(&path).unwrap_or_default();
            let fresh = there == file.bytes;
            assert!(
                fresh,
                "{}: run `cargo run -p flightgear-package --example xv15_package`",
                file.path
            );
        }
    }

    #[test]
    fn the_package_is_small() {
        let bytes: usize = made().iter().map(|file| file.bytes.len()).sum();
        assert!(bytes < 3_000_000, "{bytes} bytes");
    }
}
