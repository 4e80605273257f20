//! What others' packages the program is made of: their licences, none of them twice without need, and
//! those that carry a flight or a log's bytes optimised in the profile of README's command.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use toml::Table;

use crate::tree::{manifest, root};

/// Licences that ask for nothing but their text, or (MPL) for their own files alone.
const LICENCES: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "CDLA-Permissive-2.0",
    "ISC",
    "LLVM-exception",
    "MIT",
    "MPL-2.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Packages of which the lock file has two versions: others ask for the older one.
const TWICE: &[&str] = &[
    "base64",
    "console",
    "convert_case",
    "darling",
    "darling_core",
    "darling_macro",
    "getrandom",
    "hermit-abi",
    "itertools",
    // rerun's importer of MCAP files; it is not built.
    "mcap",
    "miniz_oxide",
    "nix",
    "num-bigint",
    "r-efi",
    "rand",
    "rand_core",
    "signal-hook",
    "strum",
    "strum_macros",
    "syn",
    "thiserror",
    "thiserror-impl",
    "zstd",
    "zstd-safe",
];

/// What `cargo tree` lists, a line a package.
fn listed(arguments: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .current_dir(root())
        .args(["tree", "--locked", "--offline", "--quiet", "--prefix", "none"])
        .args(arguments)
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let lines = text.lines().filter(|line| !line.is_empty());
    lines.map(|line| line.trim_end_matches(" (*)").to_string()).collect()
}

/// What engine, logs and replay are made of, without the viewer.
fn carriers() -> BTreeSet<String> {
    let packages = ["-p", "engine", "-p", "logs", "-p", "replay", "--no-default-features"];
    let edges = ["--edges", "normal,no-proc-macro", "--format", "{p}"];
    listed(&[&packages[..], &edges].concat())
}

/// One alternative of those that OR or a slash offers, all of whose parts are allowed.
fn allowed(licence: &str) -> bool {
    let licence = licence.replace('/', " OR ").replace(['(', ')'], " ");
    licence.split(" OR ").any(|alternative| {
        let mut parts =
            alternative.split_whitespace().filter(|word| !["AND", "WITH"].contains(word));
        parts.all(|part| LICENCES.contains(&part))
    })
}

#[test]
fn every_licence_lets_the_program_be_what_it_is() {
    let packages = listed(&["--workspace", "--edges", "normal,build", "--format", "{p}|{l}"]);
    assert!(packages.len() > 200, "{} packages", packages.len());
    let others = packages.iter().filter_map(|line| {
        let (package, licence) = line.split_once('|')?;
        (!licence.is_empty() && !allowed(licence)).then(|| format!("{package}: {licence}"))
    });
    let unlicensed = packages.iter().filter(|line| line.ends_with('|')).cloned();
    let refused: Vec<String> = others.chain(unlicensed).collect();
    assert!(refused.is_empty(), "{refused:#?}");
    assert!(!allowed("GPL-3.0-only") && !allowed("MIT AND GPL-2.0") && allowed("MIT OR GPL-2.0"));
}

#[test]
fn no_package_is_there_twice_without_a_known_reason() {
    let text = fs::read_to_string(root().join("Cargo.lock")).expect("the lock file");
    let lock: Table = text.parse().expect("TOML");
    let mut versions: BTreeMap<&str, usize> = BTreeMap::new();
    for package in lock["package"].as_array().expect("packages") {
        *versions.entry(package["name"].as_str().expect("a name")).or_default() += 1;
    }
    // Windows' interfaces have a package for each kind of processor, in each version.
    let twice: Vec<&str> = versions
        .into_iter()
        .filter_map(|(name, count)| (count > 1 && !name.starts_with("windows")).then_some(name))
        .collect();
    assert_eq!(twice, TWICE, "what is there twice, and what is known to be");
}

#[test]
fn what_carries_a_flight_is_optimised() {
    let manifest = manifest(&root());
    let profiles = manifest["profile"].as_table().expect("profiles");
    let optimised = |profile: &str| {
        let packages = profiles[profile]["package"].as_table().expect("packages");
        let levels = packages.iter().filter(|(_, how)| how.get("opt-level") == Some(&3.into()));
        levels.map(|(name, _)| name.clone()).collect::<BTreeSet<_>>()
    };
    let release = optimised("release");
    let mut seen = BTreeSet::new();
    let mut missing = Vec::new();
    for package in carriers() {
        let name = package.split(' ').next().expect("a name").to_string();
        let new = seen.insert(name.clone());
        assert!(new || TWICE.contains(&name.as_str()), "two versions of {name} carry a flight");
        // Our own have the profile's own level.
        if !package.contains(" (/") && !release.contains(&name) {
            missing.push(name);
        }
    }
    assert!(seen.contains("mcap") && seen.contains("libm"), "{seen:?}");
    assert!(missing.is_empty(), "no opt-level in [profile.release.package] for {missing:?}");
    assert!(optimised("dist").contains("*"), "dist optimises all");
}
