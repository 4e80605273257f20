//! Tells the program what it was built from: commit, compiler, target.

use std::env;
use std::process::Command;

/// All that the program is built from. What lies beside it (documents, tests) changes no program.
const SOURCES: [&str; 12] = [
    "Cargo.lock",
    "Cargo.toml",
    "build.rs",
    "src",
    "aircraft",
    "engine/Cargo.toml",
    "engine/src",
    "engine/analysis",
    "flightgear",
    "logs",
    "recorder",
    "replay",
];

/// Tells which of them are not as committed.
const STATUS: [&str; 5] =
    ["--no-optional-locks", "status", "--porcelain", "--untracked-files=no", "--"];

fn said_by(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_string())
}

fn main() {
    let unknown = || "unknown".to_string();
    let commit = said_by("git", &["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(unknown);
    let dirty = said_by("git", &[&STATUS[..], &SOURCES[..]].concat())
        .map_or_else(unknown, |changes| (!changes.is_empty()).to_string());
    let rustc = env::var("RUSTC")
        .ok()
        .and_then(|rustc| said_by(&rustc, &["--version"]))
        .unwrap_or_else(unknown);
    let set = |name: &str, value: &str| println!("cargo:rustc-env=TILTROTOR_{name}={value}");
    let state = if dirty == "true" { ", with changes that are not committed" } else { "" };
    let version = env::var("CARGO_PKG_VERSION").unwrap_or_else(|_| unknown());
    set("VERSION", &format!("{version} (commit {commit}{state})"));
    set("COMMIT", &commit);
    set("DIRTY", &dirty);
    set("RUSTC", &rustc);
    set("TARGET", &env::var("TARGET").unwrap_or_else(|_| unknown()));
    set("PROFILE", &env::var("PROFILE").unwrap_or_else(|_| unknown()));
    let features = env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_else(|_| unknown());
    set("TARGET_FEATURES", &features);
    // Whatever changes the commit or what is not committed. Where git keeps it depends: in a work
    // tree beside the main one, `.git` is a file, and a path that is not there builds all anew.
    for git in ["HEAD", "index", "refs"] {
        if let Some(path) = said_by("git", &["rev-parse", "--git-path", git]) {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    for path in SOURCES {
        println!("cargo:rerun-if-changed={path}");
    }
}
