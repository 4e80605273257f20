//! docs/events.md and docs/panel.md list what the program lists: each table is generated from the facts.
//!
//! `BLESS=1` writes the tables instead of comparing them.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use engine::cockpit::{AxisControl, ButtonControl};
use engine::inputs::{EventKind, Failures};
use engine::outputs::{Severity, Validity};
use logs::records::{FlightEvent, Levels, RestartCause};
use logs::view::Level;
use recorder::keyboard::KeyAction;

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
    let events = FlightEvent::ALL.iter().map(|&event| {
        let facts = event.facts();
        let (number, key) = (event as u64, code(facts.key));
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
    let restarts = RestartCause::ALL.iter().map(|&cause| {
        let facts = cause.facts();
        row(&[&(cause as u64), &code(facts.key), &facts.words, &facts.description])
    });
    vec![
        ("events", &["kind", "key", "what happened", "value", "level"], events.collect()),
        ("validity", &["bit", "key", "in words", "when", "severity"], validity.collect()),
        ("failures", &["bit", "key", "in words", "what it does"], failures.collect()),
        ("device events", &["kind", "key", "what happened"], kinds.collect()),
        ("axes", &["key", "what it is", "range"], axes.collect()),
        ("buttons", &["key", "what it does"], buttons.collect()),
        ("restarts", &["cause", "key", "in words", "the state is"], restarts.collect()),
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
    let start = page.find(&mark).unwrap_or_else(|| panic!("the page lacks {mark}"));
    let start = start + mark.len();
    let end = start + page[start..].find("<!-- end -->").expect("an end to every table");
    format!("{}{table}{}", &page[..start], &page[end..])
}

/// The keys of a flight by keyboard.
fn keys() -> Vec<Listing> {
    let keys = KeyAction::ALL.iter().map(|action| {
        let facts = action.facts();
        row(&[&code(facts.on), &facts.description])
    });
    let failures = (1..).zip(Failures::FACTS).map(|(number, facts)| {
        row(&[&code(&format!("{number}")), &format!("Fails, or mends: {}.", facts.words)])
    });
    let starts = (5..)
        .zip(aircraft::STARTS)
        .map(|(number, (name, what, _))| row(&[&code(&format!("F{number}")), &code(name), &what]));
    vec![
        ("keys", &["key", "what it does"], keys.chain(failures).collect()),
        ("starts", &["key", "`--start`", "where"], starts.collect()),
    ]
}

#[test]
fn the_page_of_events_lists_what_the_program_lists() {
    lists("docs/events.md", listings());
}

#[test]
fn the_page_of_the_panel_lists_the_keys() {
    lists("docs/panel.md", keys());
}

fn lists(name: &str, listings: Vec<Listing>) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name);
    let page = fs::read_to_string(&path).expect(name);
    let mut fresh = page.clone();
    for (mark, head, rows) in listings {
        assert!(rows.iter().all(|row| row.len() == head.len()), "{mark}");
        fresh = replaced(&fresh, mark, &markdown(head, &rows));
    }
    if std::env::var_os("BLESS").is_some() {
        fs::write(&path, fresh).expect(name);
    } else {
        assert!(fresh == page, "{name} is not what the program lists; write it: BLESS=1");
    }
}
