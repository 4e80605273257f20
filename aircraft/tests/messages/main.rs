//! What a file with one thing wrong in it is told. Each test changes one line of a good file.

mod cockpit;
mod limits;
mod numbers;
mod tables;

use aircraft::XV15;

/// The line, from 1, that begins with `start` behind the header `table`.
fn line_of(text: &str, table: &str, start: &str) -> usize {
    let lines: Vec<_> = text.lines().collect();
    let header = lines.iter().position(|line| *line == format!("[{table}]")).unwrap();
    header + 1 + lines[header..].iter().position(|line| line.starts_with(start)).unwrap()
}

/// The XV-15 with the line that begins with `start` behind `[table]` replaced, and that line.
fn with_line(table: &str, start: &str, new: &str) -> (String, usize) {
    let line = line_of(XV15, table, start);
    let mut lines: Vec<_> = XV15.lines().collect();
    lines[line - 1] = new;
    (lines.join("\n"), line)
}

#[track_caller]
fn told(text: &str, message: &str) {
    let error = aircraft::aircraft("xv15.toml", text).unwrap_err();
    assert_eq!(error.to_string(), message);
}

/// Replaces a line, and expects to be told `message` about that line.
#[track_caller]
fn changed(table: &str, start: &str, new: &str, message: &str) {
    let (text, line) = with_line(table, start, new);
    told(&text, &format!("xv15.toml:{line}: {message}"));
}

const SOURCED: &str = "source = \"TMX\", trust = \"V\" }";

#[test]
fn a_syntax_error() {
    let (text, line) = with_line("rotors", "radius_ft", "radius_ft = = 1");
    let error = aircraft::aircraft("xv15.toml", &text).unwrap_err().to_string();
    assert!(error.starts_with(&format!("xv15.toml:{line}: not valid TOML: ")), "{error}");
}

#[test]
fn an_unknown_key() {
    changed(
        "rotors",
        "radius_ft",
        &format!("chrod_in = {{ value = 14.0, {SOURCED}"),
        "rotors.chrod_in: unknown key; expected one of radius_m, solidity, polar_inertia_kg_m2, \
         pivot_m, mast_length_m, mast_cant_rad, blade, inflow, flapping, bending, \
         other_rotor \
         (or the same in another unit)",
    );
}

#[test]
fn a_missing_key_is_told_with_its_tables_line() {
    let (text, _) = with_line("rotors", "radius_ft", "");
    let table = line_of(XV15, "rotors", "[rotors]");
    told(
        &text,
        &format!("xv15.toml:{table}: rotors: missing key radius_m (or the same in another unit)"),
    );
}

#[test]
fn a_missing_table() {
    told("name = \"nothing\"", "xv15.toml:1: missing key fcc");
}

/// Whatever a line is replaced by, the answer is a message about the file, never a panic.
#[test]
fn any_line_may_be_missing_or_nonsense() {
    let lines: Vec<_> = XV15.lines().collect();
    let at = |header: &str| lines.iter().position(|line| *line == header).unwrap();
    // The lines of the airframe's tables are all alike: one in ten stands for the rest.
    let tables = at("[rotor_wake]")..at("[engines]");
    let told_apart = |i: &usize| !tables.contains(i) || i.is_multiple_of(10);
    for i in (0..lines.len()).filter(told_apart) {
        let mut changed = lines.clone();
        changed[i] = ["", "x = 1", "]"][i % 3];
        if let Err(error) = aircraft::aircraft("xv15.toml", &changed.join("\n")) {
            assert!(error.to_string().starts_with("xv15.toml:"), "{error}");
        }
    }
}
