//! For build scripts: tells a program what it is built from: commit, compiler, target. The command, the Python package
//! and the FMU say it in the same way, and `logs::identity!` puts it into every log.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// What every program is built from. What lies beside it (documents, tests) changes none.
const SOURCES: [&str; 10] = [
    "Cargo.toml",
    "aircraft",
    "engine/Cargo.toml",
    "engine/src",
    "engine/analysis",
    "flightgear",
    "logs",
    "provenance",
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

/// Where the structs are defined whose numbers a log holds.
const RECORDED: [&str; 2] = ["engine/src", "logs/src"];

/// Writes down what is said of the fields of every public struct, so that `log fields` tells it: a table of
/// structs, each with the names of its fields and their doc comments.
fn describe() {
    let mut files = Vec::new();
    for folder in RECORDED {
        sources(Path::new(folder), &mut files);
    }
    files.sort();
    let mut table = String::from("&[\n");
    for file in files {
        let Ok(text) = fs::read_to_string(&file) else { continue };
        for (name, fields) in structs(&text) {
            let _ = writeln!(table, "    ({name:?}, &{fields:?}),");
        }
    }
    table.push_str("]\n");
    if let Some(folder) = env::var_os("OUT_DIR") {
        let written = fs::write(Path::new(&folder).join("descriptions.rs"), table);
        assert!(written.is_ok(), "the list of descriptions cannot be written: {written:?}");
    }
}

fn sources(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// A struct's fields: each with its doc comment.
type Fields = Vec<(String, String)>;

/// The public structs with named fields, as rustfmt writes them: a field a line, its doc comment above it.
fn structs(text: &str) -> Vec<(String, Fields)> {
    let mut found: Vec<(String, Fields)> = Vec::new();
    let (mut inside, mut doc) = (false, Vec::new());
    for line in text.lines() {
        let line = line.trim_end();
        if let Some(name) = line.strip_prefix("pub struct ").filter(|_| line.ends_with('{')) {
            let name = name.split(['<', ' ']).next().unwrap_or_default();
            found.push((name.into(), Vec::new()));
            inside = true;
            doc.clear();
        } else if line == "}" {
            inside = false;
        } else if let Some(words) = line.trim_start().strip_prefix("///").filter(|_| inside) {
            doc.push(words.trim());
        } else if let Some((name, _)) =
            line.trim_start().strip_prefix("pub ").and_then(|field| field.split_once(':'))
            && inside
            && let Some((_, fields)) = found.last_mut()
        {
            fields.push((name.into(), doc.join(" ")));
            doc.clear();
        }
    }
    found
}

/// The tree's root: the package's own folder, or the one above it, for packages with a workspace of their
/// own.
fn root() -> PathBuf {
    let package = env::var_os("CARGO_MANIFEST_DIR").map_or_else(PathBuf::new, PathBuf::from);
    match package.parent() {
        Some(above) if !package.join("engine").is_dir() => above.into(),
        _ => package,
    }
}

/// The commit, and whether the sources are not as committed: by git, or by the file of a source distribution, which may
/// lie in a repository that is none of ours.
fn commit(sources: &[&str]) -> (String, String) {
    let unknown = || "unknown".to_string();
    if said_by("git", &["ls-files", "--error-unmatch", "--", "provenance/Cargo.toml"]).is_some() {
        let commit = said_by("git", &["rev-parse", "--short=12", "HEAD"]);
        let changes = said_by("git", &[&STATUS[..], sources].concat());
        let dirty = changes.map(|changes| (!changes.is_empty()).to_string());
        return (commit.unwrap_or_else(unknown), dirty.unwrap_or_else(unknown));
    }
    let told = fs::read_to_string("COMMIT").unwrap_or_default();
    let mut words = told.split_whitespace().map(str::to_string);
    (words.next().unwrap_or_else(unknown), words.next().unwrap_or_else(unknown))
}

/// Tells the compiler, and with it the program, what it is built from: the sources of all, and its own, whose paths
/// begin at the tree's root.
pub fn tell(own: &[&str]) {
    let root = root();
    let entered = env::set_current_dir(&root);
    assert!(entered.is_ok(), "{}: {entered:?}", root.display());
    let sources = [own, &SOURCES].concat();
    describe();
    let unknown = || "unknown".to_string();
    let (commit, dirty) = commit(&sources);
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
            println!("cargo:rerun-if-changed={}", root.join(path).display());
        }
    }
    for path in sources {
        println!("cargo:rerun-if-changed={}", root.join(path).display());
    }
}
