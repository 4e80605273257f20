//! The scaled file as text.

use std::fmt::Write;

use toml::de::{DeTable, DeValue};

use super::dimension::half_powers;

/// λ: length over the XV-15's.
const LAMBDA: f64 = 0.8;

/// Keys that do not go by their unit: a height at which the data end is the air's.
const STAY: [&str; 1] = ["envelope.model.height_m_max"];

/// What is chosen anew: key, value as the file has it, and why.
const OWN: [(&str, &str, &str); 3] = [
    (
        "fcc.governor.rotor_speed_rpm",
        "[658.5, 604.7, 537.5]",
        "another schedule: 98, 90 and 80 % of the rated 671.94 rpm, where the XV-15 has 98, 86 and 76 %",
    ),
    (
        "fcc.mixer.flap_deg",
        "[0.0, 15.0, 35.0, 60.0]",
        "other detents than the XV-15's 0, 20, 40 and 75 deg",
    ),
    ("actuators.flap.deg_max", "60.0", "the last detent"),
];

/// Tables whose first row is left out: the blade has three sections, the innermost of them to .80 of the radius.
const FEWER_SECTIONS: [&str; 2] =
    ["rotors.blade.section.lift_coefficient", "rotors.blade.section.drag_coefficient"];

const HEAD: &str = "\
# A generic tilt-rotor, made for testing. It was never built, and nothing in it is published.
#
# Written by the example `generic` of the crate `aircraft` from xv15.toml; not to be edited by hand.
# Froude scaling by a length ratio L = 0.8: a length goes by L, a time by L^.5, a mass by L^3, and what is made
# of them accordingly: speeds by L^.5, rotor speeds by L^-.5, forces by L^3, moments by L^4, inertias by L^5,
# power by L^3.5, gains by their units. Angles, coefficients, Mach numbers and parts of a travel stay, and so does
# the height at which the model's data end. The cockpit's travels go by L like any length: a part of them does
# what it does in the XV-15.
# Three choices are its own: the rotor speeds, the flap detents, and three blade sections in place of four.
# Every number is an estimate, trust E.

name = \"Generic tilt-rotor\"
";

/// The whole file.
pub fn generic_toml() -> String {
    let document = DeTable::parse(aircraft::XV15).expect("TOML");
    let mut text = HEAD.to_owned();
    table(&mut text, "", document.get_ref());
    text
}

/// A key with its path and value.
type Entry<'a, 'i> = (&'a str, String, &'a DeValue<'i>);

/// In the order of the file.
fn entries<'a, 'i>(path: &str, table: &'a DeTable<'i>) -> Vec<Entry<'a, 'i>> {
    let mut found: Vec<_> = table.iter().collect();
    found.sort_by_key(|(key, _)| key.span().start);
    let named =
        |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    found
        .into_iter()
        .map(|(key, value)| {
            let name: &'a std::borrow::Cow<'_, str> = key.get_ref();
            (&**name, named(name), value.get_ref())
        })
        .collect()
}

fn table(text: &mut String, path: &str, of: &DeTable<'_>) {
    let entries = entries(path, of);
    let quantity = |value: &DeValue<'_>| match value {
        DeValue::Table(below) if below.get("value").is_some() => Some(is_short(below)),
        _ => None,
    };
    let short: Vec<_> =
        entries.iter().filter(|(.., value)| quantity(value) == Some(true)).collect();
    if !short.is_empty() {
        let _ = write!(text, "\n[{path}]\n");
    }
    for (name, path, value) in short {
        if let DeValue::Table(below) = value {
            let (value, note) = value_of(name, path, below);
            let _ = writeln!(text, "{name} = {{ value = {value}, {} }}", origin(&note).join(", "));
        }
    }
    for (name, path, value) in &entries {
        match value {
            DeValue::Table(below) if quantity(value) == Some(false) => {
                long(text, name, path, below);
            }
            DeValue::Table(below) if quantity(value).is_none() => table(text, path, below),
            _ => {}
        }
    }
}

/// Whether a quantity fits a line: a number, or a few.
fn is_short(quantity: &DeTable<'_>) -> bool {
    let alone = quantity
        .iter()
        .all(|(key, _)| ["value", "source", "trust", "note"].contains(&&**key.get_ref()));
    let few = match quantity.get("value").map(toml::Spanned::get_ref) {
        Some(DeValue::Array(array)) => {
            array.len() <= 4 && !matches!(array[0].get_ref(), DeValue::Array(_))
        }
        _ => true,
    };
    alone && few
}

/// A quantity as a table of its own, with its arguments.
fn long(text: &mut String, name: &str, path: &str, quantity: &DeTable<'_>) {
    let _ = write!(text, "\n[{path}]\n");
    let less = usize::from(FEWER_SECTIONS.contains(&path));
    for (part, _, value) in entries(path, quantity) {
        if let DeValue::Array(_) = value
            && part != "value"
        {
            let skip = if part == "radius_norm" { less } else { 0 };
            let value = number(value, factor(half_powers(part)), skip);
            let _ = writeln!(text, "{part} = {value}");
        }
    }
    let (value, note) = value_of(name, path, quantity);
    let _ = writeln!(text, "value = {value}\n{}", origin(&note).join("\n"));
}

fn origin(note: &str) -> Vec<String> {
    let mut parts = vec!["source = \"scaled from the XV-15\"".into(), "trust = \"E\"".into()];
    if !note.is_empty() {
        parts.push(format!("note = \"{note}\""));
    }
    parts
}

/// The value as it is written, and how it came about.
fn value_of(name: &str, path: &str, quantity: &DeTable<'_>) -> (String, String) {
    if let Some((_, value, why)) = OWN.iter().find(|(key, ..)| *key == path) {
        return ((*value).into(), (*why).into());
    }
    let Some(value) = quantity.get("value").map(toml::Spanned::get_ref) else {
        return Default::default();
    };
    let halves = if STAY.contains(&path) { 0 } else { half_powers(name) };
    let less = usize::from(FEWER_SECTIONS.contains(&path));
    let note = match (halves, less, value) {
        (_, 1, _) => "without the innermost of the XV-15's four sections".into(),
        (0, ..) => String::new(),
        (_, _, DeValue::Array(_)) => format!("by L^{}", f64::from(halves) / 2.0),
        _ => format!("{} by L^{}", number(value, 1.0, 0), f64::from(halves) / 2.0),
    };
    (number(value, factor(halves), less), note)
}

fn factor(halves: i32) -> f64 {
    // Powers of the root, one by one: the same on every machine.
    let root = LAMBDA.sqrt();
    (0..halves.abs())
        .fold(1.0, |product, _| if halves > 0 { product * root } else { product / root })
}

/// A number or an array of them, times a factor, to five places; the first rows left out.
fn number(value: &DeValue<'_>, factor: f64, skip: usize) -> String {
    match value {
        DeValue::Integer(whole) => scaled(whole.as_str(), factor),
        DeValue::Float(real) => scaled(real.as_str(), factor),
        DeValue::Array(array) => {
            let items = array.iter().skip(skip).map(|item| number(item.get_ref(), factor, 0));
            let items: Vec<_> = items.collect();
            lines(&items)
        }
        other => panic!("{other:?} is no number"),
    }
}

/// Items in brackets, on as many lines as they need.
fn lines(items: &[String]) -> String {
    let one = format!("[{}]", items.join(", "));
    if one.len() <= 90 && !one.contains('\n') && !items[0].starts_with('[') {
        return one;
    }
    let mut text = String::from("[");
    let mut column = usize::MAX;
    for item in items {
        if column.saturating_add(item.len()) > 94 || item.starts_with('[') {
            text.push_str("\n    ");
            column = 4;
        } else {
            text.push(' ');
        }
        text.push_str(&item.replace('\n', "\n    "));
        text.push(',');
        column += item.len() + 2;
    }
    text + "\n]"
}

fn scaled(written: &str, factor: f64) -> String {
    if factor.to_bits() == 1.0_f64.to_bits() {
        return written.into();
    }
    let value: f64 = written.parse::<f64>().expect("a number") * factor;
    let rounded: f64 = format!("{value:.4e}").parse().expect("a number");
    format!("{rounded:?}")
}
