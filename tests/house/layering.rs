//! Crates depend on each other as the design draws it, and on nothing more.
//!
//! Dependencies of tests and benchmarks do not count: they are in no program.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use toml::{Table, Value};

use crate::tree::{self, manifest, root};

/// Every arrow between crates. Only the command, the root package, knows all.
const ARROWS: &[(&str, &[&str])] = &[
    ("engine", &[]),
    ("aircraft", &["engine"]),
    ("analysis", &["engine"]),
    ("chart", &["engine"]),
    ("flightgear", &["engine"]),
    ("flightgear-package", &["aircraft", "engine"]),
    ("logs", &["engine"]),
    ("provenance", &[]),
    ("recorder", &["aircraft", "analysis", "engine", "flightgear", "logs"]),
    ("replay", &["aircraft", "analysis", "chart", "engine", "logs"]),
    ("tiltrotor-fmi", &["aircraft", "analysis", "engine", "logs", "provenance", "recorder"]),
    (
        "tiltrotor-python",
        &["aircraft", "analysis", "engine", "logs", "provenance", "recorder", "replay"],
    ),
];

/// Crates of others that one crate of ours alone may know.
const KEPT: &[(&str, &str)] = &[
    ("bincode", "logs"),
    ("cdr-encoding", "logs"),
    ("csv", "logs"),
    ("evdev", "recorder"),
    ("gilrs", "recorder"),
    ("gilrs-core", "recorder"),
    ("inotify", "recorder"),
    ("mcap", "logs"),
    ("parquet", "logs"),
    ("png", "flightgear-package"),
    ("pyo3", "tiltrotor-python"),
    ("re_protos", "replay"),
    ("rerun", "replay"),
    ("rustfft", "replay"),
    ("tiny-skia", "chart"),
    ("tokio", "replay"),
    ("tonic", "replay"),
    ("ttf-parser", "chart"),
    ("udev", "recorder"),
    ("zerocopy", "flightgear"),
];

/// All that the engine may know of the world.
const ENGINE_KNOWS: &[&str] = &["bitflags", "libm", "nalgebra", "serde", "wide"];

/// All that the analysis beside it may know.
const ANALYSIS_KNOWS: &[&str] = &["engine", "nalgebra"];

/// The packages of every workspace in the tree by name, with their manifests; the command, the root
/// package, is not among them.
fn crates() -> BTreeMap<String, Table> {
    let mut packages = tree::packages();
    packages.remove("tiltrotor").expect("the command");
    packages.into_iter().map(|(name, (_, manifest))| (name, manifest)).collect()
}

/// What a package is built from, under the names of the packages.
fn dependencies(manifest: &Table) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut tables = vec![manifest];
    let targets = manifest.get("target").and_then(Value::as_table);
    tables.extend(targets.into_iter().flatten().filter_map(|(_, target)| target.as_table()));
    for table in tables {
        for kind in ["dependencies", "build-dependencies"] {
            let Some(dependencies) = table.get(kind).and_then(Value::as_table) else { continue };
            for (name, how) in dependencies {
                let package = how.get("package").and_then(Value::as_str).unwrap_or(name);
                found.insert(package.to_string());
            }
        }
    }
    found
}

#[test]
fn every_arrow_between_crates_is_in_the_design() {
    let crates = crates();
    let drawn: BTreeSet<_> = ARROWS.iter().map(|(name, _)| (*name).to_string()).collect();
    assert_eq!(crates.keys().cloned().collect::<BTreeSet<_>>(), drawn, "crates and the design");
    let mut wrong = Vec::new();
    for (name, allowed) in ARROWS {
        for to in dependencies(&crates[*name]).intersection(&drawn) {
            if !allowed.contains(&to.as_str()) {
                wrong.push(format!("{name} → {to}: the design does not draw it"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_arrow_of_the_design_has_gone() {
    let crates = crates();
    for (name, arrows) in ARROWS {
        let known = dependencies(&crates[*name]);
        for to in *arrows {
            assert!(known.contains(*to), "{name} → {to}: drawn, but not there");
        }
    }
}

#[test]
fn a_format_and_a_device_and_a_viewer_are_known_to_one_crate_each() {
    let mut everyone = crates();
    everyone.insert("tiltrotor".into(), manifest(&root()));
    let mut wrong = Vec::new();
    for (name, manifest) in &everyone {
        let known = dependencies(manifest);
        for (theirs, keeper) in KEPT {
            if known.contains(*theirs) && name != keeper {
                wrong.push(format!("{name} → {theirs}: only {keeper} may"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for (theirs, keeper) in KEPT.iter().filter(|(theirs, _)| *theirs != "gilrs") {
        assert!(dependencies(&everyone[*keeper]).contains(*theirs), "{keeper} → {theirs}: gone?");
    }
}

#[test]
fn the_engine_knows_neither_the_standard_library_nor_anything_of_the_world() {
    let engine = manifest(&root().join("engine"));
    let allowed = ENGINE_KNOWS.iter().map(|name| (*name).to_string()).collect();
    assert_eq!(dependencies(&engine), allowed);
    let source = fs::read_to_string(root().join("engine/src/lib.rs")).expect("the engine");
    assert!(source.lines().any(|line| line == "#![no_std]"), "engine: no_std");
    assert!(!source.contains("extern crate std"), "engine: no way back to std");
}

#[test]
fn the_engine_s_arithmetic_is_pinned() {
    let workspace = manifest(&root());
    let dependencies = &workspace["workspace"]["dependencies"];
    let libm = dependencies["libm"].as_str().expect("a version");
    assert!(libm.starts_with('='), "libm = \"{libm}\": its results change between versions");
    let nalgebra = &dependencies["nalgebra"];
    assert_eq!(nalgebra["default-features"].as_bool(), Some(false));
    assert_eq!(nalgebra["features"], Value::from(vec!["libm-force"]));
}

/// What begins in trim, and what is printed of it, is the same on every CPU: no product of matrices by a
/// library that looks for FMA.
#[test]
fn the_analysis_knows_the_engine_and_matrices_without_the_standard_library() {
    let analysis = manifest(&root().join("engine/analysis"));
    let allowed = ANALYSIS_KNOWS.iter().map(|name| (*name).to_string()).collect();
    assert_eq!(dependencies(&analysis), allowed);
    let nalgebra = &analysis["dependencies"]["nalgebra"];
    assert_eq!(nalgebra["workspace"].as_bool(), Some(true));
    assert_eq!(nalgebra["features"], Value::from(vec!["alloc"]));
    let source = fs::read_to_string(root().join("engine/analysis/src/lib.rs")).expect("analysis");
    assert!(source.lines().any(|line| line == "#![no_std]"), "analysis: no_std");
    let lock: Table =
        fs::read_to_string(root().join("Cargo.lock")).expect("a lock").parse().expect("TOML");
    let packages = lock["package"].as_array().expect("packages");
    let of_nalgebra = packages.iter().find(|package| package["name"].as_str() == Some("nalgebra"));
    let its = of_nalgebra.expect("nalgebra")["dependencies"].as_array().expect("its dependencies");
    assert!(!its.contains(&Value::from("matrixmultiply")), "nalgebra with std");
}

#[test]
fn unsafe_code_is_forbidden_everywhere_but_in_the_c_interface() {
    let workspace = manifest(&root());
    for workspace in [&workspace, &manifest(&root().join("python"))] {
        let lint = &workspace["workspace"]["lints"]["rust"]["unsafe_code"];
        assert_eq!(lint.as_str(), Some("forbid"));
    }
    // A C interface needs it: denied in the workspace, allowed in the files that speak C.
    let lint = &manifest(&root().join("fmi"))["workspace"]["lints"]["rust"]["unsafe_code"];
    assert_eq!(lint.as_str(), Some("deny"));
    let mut allow = Vec::new();
    for entry in fs::read_dir(root().join("fmi/src")).expect("the FMU") {
        let path = entry.expect("an entry").path();
        let text =
            if path.is_dir() { String::new() } else { fs::read_to_string(&path).expect("text") };
        if text.contains("allow(unsafe_code") {
            allow.push(path.file_name().expect("a name").to_string_lossy().into_owned());
        }
    }
    allow.sort();
    assert_eq!(allow, ["fmi2.rs", "fmi3.rs", "handle.rs"]);
    let mut everyone = crates();
    everyone.insert("tiltrotor".into(), workspace);
    for (name, manifest) in everyone {
        let inherits = manifest.get("lints").and_then(|lints| lints.get("workspace"));
        assert_eq!(
            inherits.and_then(Value::as_bool),
            Some(true),
            "{name}: [lints] workspace = true"
        );
    }
}

#[test]
fn what_is_heavy_can_be_switched_off() {
    let crates = crates();
    let heavies = [
        ("replay", "rerun"),
        ("recorder", "gilrs-core"),
        ("recorder", "evdev"),
        ("recorder", "udev"),
    ];
    for (name, heavy) in heavies {
        let targets = crates[name].get("target").and_then(Value::as_table);
        let of_targets = targets.into_iter().flatten().map(|(_, target)| target);
        let all = Value::Table(crates[name].clone());
        let mut tables = std::iter::once(&all).chain(of_targets);
        let dependency = tables.find_map(|table| table.get("dependencies")?.get(heavy));
        let optional = dependency.and_then(|how| how.get("optional")).and_then(Value::as_bool);
        assert_eq!(optional, Some(true), "{name} → {heavy} is optional");
    }
}
