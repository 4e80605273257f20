//! README and docs say what is there: every link leads to a file, every file that is named exists, every documented
//! command line names verbs and options that the program has.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::tree::root;

/// Every page for readers, with its text.
fn pages() -> Vec<(PathBuf, String)> {
    let mut pages: Vec<PathBuf> =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "SECURITY.md"]
            .iter()
            .map(|name| root().join(name))
            .collect();
    for entry in fs::read_dir(root().join("docs")).expect("docs") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
    pages.sort();
    let read = |page: PathBuf| (page.clone(), fs::read_to_string(page).expect("a page"));
    pages.into_iter().map(read).collect()
}

/// What a heading's link is called.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches(['#', ' ']).to_lowercase();
    let kept: String =
        kept.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c)).collect();
    kept.replace(' ', "-")
}

#[test]
fn every_link_between_pages_leads_somewhere() {
    let mut broken = Vec::new();
    let mut links = 0;
    for (page, text) in pages() {
        for rest in text.split("](").skip(1) {
            let link = rest.split(')').next().unwrap_or_default();
            if link.contains("://") || link.contains(' ') {
                continue;
            }
            links += 1;
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = match file {
                "" => page.clone(),
                file => page.parent().unwrap_or(Path::new("")).join(file),
            };
            let there = target.exists()
                && (heading.is_empty()
                    || fs::read_to_string(&target).is_ok_and(|text| {
                        text.lines().any(|line| line.starts_with('#') && anchor(line) == heading)
                    }));
            if !there {
                broken.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(links > 100, "{links} links");
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Tests, scripts and sources that a page calls by their place in the tree.
#[test]
fn every_file_that_a_page_names_is_there() {
    let of_a_path = |c: char| c.is_alphanumeric() || "_-./*".contains(c);
    let (mut missing, mut named) = (Vec::new(), 0);
    for (page, text) in pages() {
        for word in text.split(|c| !of_a_path(c)) {
            let path = word.trim_end_matches('.');
            let source = [".rs", ".sh", ".py"].iter().any(|end| path.ends_with(end));
            if source && path.contains('/') && !path.starts_with('/') && !path.contains('*') {
                named += 1;
                if !root().join(path).is_file() {
                    missing.push(format!("{}: {path}", page.display()));
                }
            }
        }
    }
    assert!(named > 100, "{named} files");
    assert!(missing.is_empty(), "{missing:#?}");
}

/// The help of a verb, asked once.
fn help(verb: &[&str], known: &mut BTreeMap<String, Option<String>>) -> Option<String> {
    known
        .entry(verb.join(" "))
        .or_insert_with(|| {
            let output = Command::new(env!("CARGO_BIN_EXE_tiltrotor"))
                .args(verb)
                .arg("--help")
                .output()
                .expect("the program runs");
            output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
        })
        .clone()
}

/// Command lines of the program between the fences, and in the tables: from `tiltrotor` to the end of the
/// command.
fn command_lines(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for part in text.split("tiltrotor ").skip(1) {
        let end = part.find(['`', '\n', '|', ';', '>', '#', '&', '(']).unwrap_or(part.len());
        found.push(part[..end].trim().to_string());
    }
    found
}

#[test]
fn every_documented_command_has_its_verb_and_options() {
    let mut known = BTreeMap::new();
    let top = help(&[], &mut known).expect("the program has a help");
    let mut wrong = Vec::new();
    let mut commands = 0;
    for (page, text) in pages() {
        for line in command_lines(&text) {
            let words: Vec<&str> = line.split_whitespace().collect();
            let Some(&first) = words.first() else { continue };
            let is_verb =
                top.lines().any(|help| help.trim_start().split(' ').next() == Some(first));
            if !is_verb {
                continue;
            }
            commands += 1;
            let mut verb = vec![first];
            if first == "log"
                && let Some(&second) = words.get(1)
            {
                verb.push(second.trim_end_matches(','));
            }
            let Some(help) = help(&verb, &mut known) else {
                wrong.push(format!("{}: no verb `{}`", page.display(), verb.join(" ")));
                continue;
            };
            for option in words.iter().filter(|word| word.starts_with("--")) {
                let name =
                    option.split('=').next().unwrap_or(option).trim_end_matches([',', '.', ':']);
                if !help.split([' ', ',', '\n', '=', '`', '[', ']']).any(|word| word == name) {
                    wrong.push(format!("{}: {line}: no {name}", page.display()));
                }
            }
        }
    }
    assert!(commands > 60, "{commands} commands");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
