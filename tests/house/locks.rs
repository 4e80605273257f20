//! Workspaces beside the command's are built from the same packages: the same versions, and as optimised.
//!
//! Another version of `libm` would be another flight.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use toml::{Table, Value};

use crate::tree::{self, manifest, root};

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

/// The optimisation of each package in release builds.
fn optimised(folder: &str) -> BTreeMap<String, Value> {
    let manifest = manifest(&root().join(folder));
    let packages = manifest["profile"]["release"]["package"].as_table().expect("packages").clone();
    packages.into_iter().map(|(name, how)| (name, how["opt-level"].clone())).collect()
}

/// What is slow without optimisation is optimised there too: of path dependencies, too, which `*` leaves
/// out in the command's workspace.
#[test]
fn every_package_is_optimised_as_in_the_command() {
    let command = optimised("");
    for folder in OTHERS {
        let (other, locked) = (optimised(folder), locked(folder));
        for (name, level) in &command {
            if locked.contains_key(name) || name == "*" {
                assert_eq!(other.get(name), Some(level), "{folder}/Cargo.toml: {name}");
            }
        }
        for (name, (path, _)) in tree::packages() {
            if locked.contains_key(&name) && !path.starts_with(root().join(folder)) {
                assert_eq!(other.get(&name), Some(&Value::from(3)), "{folder}/Cargo.toml: {name}");
            }
        }
    }
}

#[test]
fn versions_are_one() {
    let version = manifest(&root())["workspace"]["package"]["version"].clone();
    for folder in OTHERS {
        assert_eq!(manifest(&root().join(folder))["package"]["version"], version, "{folder}");
    }
}
