//! Workspaces beside the command's are built from the same packages: the same versions, all optimised.
//!
//! Another version of `libm` would be another flight.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use toml::Table;

use crate::tree::{manifest, root};

/// Folders with a workspace and a lock file of their own.
const OTHERS: &[&str] = &["fmi", "python"];

/// Packages without which there are no flight and no log: a lock file that lacks them is none of ours.
const AT_LEAST: &[&str] = &[
    "bincode",
    "bitflags",
    "engine",
    "libm",
    "logs",
    "mcap",
    "nalgebra",
    "serde",
    "wide",
    "xxhash-rust",
];

/// Every package of a lock file with its versions.
fn locked(folder: &str) -> BTreeMap<String, BTreeSet<String>> {
    let path = root().join(folder).join("Cargo.lock");
    let text = fs::read_to_string(&path).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    let lock: Table = text.parse().expect("a lock file is TOML");
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in lock["package"].as_array().expect("packages") {
        let text = |key: &str| package[key].as_str().expect("a text").to_string();
        found.entry(text("name")).or_default().insert(text("version"));
    }
    found
}

#[test]
fn every_package_that_both_workspaces_have_is_of_the_same_version() {
    let command = locked("");
    for folder in OTHERS {
        let other = locked(folder);
        for name in AT_LEAST {
            assert!(other.contains_key(*name), "{folder}/Cargo.lock: no {name}");
        }
        let mut apart = Vec::new();
        for (name, versions) in &other {
            let Some(known) = command.get(name) else { continue };
            if !versions.is_subset(known) {
                apart.push(format!("{name} {versions:?}, and the command has {known:?}"));
            }
        }
        assert!(
            apart.is_empty(),
            "{folder}/Cargo.lock: `cargo update --package NAME --precise VERSION` there:\n{}",
            apart.join("\n")
        );
    }
}

/// Release builds there optimise all that they have, as cargo does when nothing is said: the list of the command's
/// workspace is there for the viewer's packages, which these lack.
#[test]
fn the_other_workspaces_optimise_all_packages() {
    for folder in OTHERS {
        let manifest = manifest(&root().join(folder));
        let said = manifest.get("profile").and_then(|profile| profile.get("release"));
        assert_eq!(said, None, "{folder}/Cargo.toml: a package without optimisation is slow");
    }
}

#[test]
fn versions_are_one() {
    let version = manifest(&root())["workspace"]["package"]["version"].clone();
    for folder in OTHERS {
        assert_eq!(manifest(&root().join(folder))["package"]["version"], version, "{folder}");
    }
}
