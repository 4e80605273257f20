//! Tells the program what it was built from: commit, compiler, target.

use std::env;
use std::process::Command;

fn said_by(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_string())
}

fn main() {
    let unknown = || "unknown".to_string();
    let commit = said_by("git", &["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(unknown);
    let dirty =
        said_by("git", &["--no-optional-locks", "status", "--porcelain", "--untracked-files=no"])
            .map_or_else(unknown, |changes| (!changes.is_empty()).to_string());
    let rustc = env::var("RUSTC")
        .ok()
        .and_then(|rustc| said_by(&rustc, &["--version"]))
        .unwrap_or_else(unknown);
    let set = |name: &str, value: &str| println!("cargo:rustc-env=TILTROTOR_{name}={value}");
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
    for path in ["src", "engine/src", "logs/src", "aircraft"] {
        println!("cargo:rerun-if-changed={path}");
    }
}
