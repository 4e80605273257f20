//! docs/events.md lists what the program lists: each table of it is generated from the facts.
//!
//! `BLESS=1` writes the tables instead of comparing them.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use engine::cockpit::{AxisControl, ButtonControl};
use engine::inputs::{EventKind, Failures};
use engine::outputs::{Severity, Validity};
use logs::records::{Happening, Levels};
use logs::view::Level;

/// A table: its mark in the page, its head, and its rows.
type Listing = (&'static str, &'static [&'static str], Vec<Vec<String>>);

fn row(cells: &[&dyn std::fmt::Display]) -> Vec<String> {
    cells.iter().map(ToString::to_string).collect()
}

fn code(key: &str) -> String {
    format!("`{key}`")
}

fn levels(levels: Levels) -> String {
    let name = |level| match level {
        Level::Info => "info",
        Level::Warn => "warn",
        Level::Error => "error",
    };
    let Levels { at_zero, otherwise } = levels;
    if at_zero == otherwise {
        name(otherwise).into()
    } else {
        format!("{}; {} at 0", name(otherwise), name(at_zero))
    }
}

fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::Caution => "caution",
        Severity::Warning => "warning",
        Severity::Final => "final",
    }
}

fn listings() -> Vec<Listing> {
    let events = Happening::ALL.iter().map(|&happening| {
        let facts = happening.facts();
        let (number, key) = (happening as u64, code(facts.key));
        row(&[&number, &key, &facts.description, &facts.value, &levels(facts.levels)])
    });
    let validity = Validity::FACTS.iter().map(|facts| {
        let (bit, key) = (facts.flag.bits().trailing_zeros(), code(facts.key));
        row(&[&bit, &key, &facts.words, &facts.description, &severity(facts.severity)])
    });
    let failures = Failures::FACTS.iter().map(|facts| {
        let (bit, key) = (facts.flag.bits().trailing_zeros(), code(facts.key));
        row(&[&bit, &key, &facts.words, &facts.description])
    });
    let kinds = EventKind::ALL.iter().map(|&kind| {
        let facts = kind.facts();
        row(&[&(kind as u64), &code(facts.key), &facts.description])
    });
    let axes = AxisControl::ALL.iter().map(|control| {
        let facts = control.facts();
        let range = format!("{} to 1", facts.travel.low_norm());
        row(&[&code(facts.key), &facts.description, &range])
    });
    let buttons = ButtonControl::ALL.iter().map(|control| {
        let facts = control.facts();
        row(&[&code(facts.key), &facts.description])
    });
    vec![
        ("events", &["kind", "key", "what happened", "value", "level"], events.collect()),
        ("validity", &["bit", "key", "in words", "when", "severity"], validity.collect()),
        ("failures", &["bit", "key", "in words", "what it does"], failures.collect()),
        ("device events", &["kind", "key", "what happened"], kinds.collect()),
        ("axes", &["key", "what it is", "range"], axes.collect()),
        ("buttons", &["key", "what it does"], buttons.collect()),
    ]
}

/// The table as Markdown.
fn markdown(head: &[&str], rows: &[Vec<String>]) -> String {
    let mut table = format!("| {} |\n|{}\n", head.join(" | "), "---|".repeat(head.len()));
    for row in rows {
        writeln!(table, "| {} |", row.join(" | ")).expect("memory");
    }
    table
}

/// The page with the text between a mark and its end replaced.
fn replaced(page: &str, mark: &str, table: &str) -> String {
    let mark = format!("<!-- {mark} -->\n");
    let start = page.find(&mark).unwrap_or_else(|| panic!("docs/events.md lacks {mark}"));
    let start = start + mark.len();
    let end = start + page[start..].find("<!-- end -->").expect("an end to every table");
    format!("{}{table}{}", &page[..start], &page[end..])
}

#[test]
fn the_page_of_events_lists_what_the_program_lists() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/events.md");
    let page = fs::read_to_string(&path).expect("docs/events.md");
    let mut fresh = page.clone();
    for (mark, head, rows) in listings() {
        assert!(rows.iter().all(|row| row.len() == head.len()), "{mark}");
        fresh = replaced(&fresh, mark, &markdown(head, &rows));
    }
    if std::env::var_os("BLESS").is_some() {
        fs::write(&path, fresh).expect("docs/events.md");
    } else {
        assert!(fresh == page, "docs/events.md is not what the program lists; write it: BLESS=1");
    }
}
