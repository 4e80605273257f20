//! Changing numbers of an aircraft file, as text: everything else stays as it is written.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::ConfigError;
use crate::units::to_si;

/// Why a number cannot be changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// No key is called so.
    #[error("unknown key {key}{}", meant(near))]
    UnknownKey {
        /// As given.
        key: String,
        /// Keys that look like it, the likeliest first.
        near: Vec<String>,
    },
    /// The key of a table of keys.
    #[error("{key} is a table of keys; name one of them")]
    Table {
        /// As given.
        key: String,
    },
    /// Not a value as TOML writes them.
    #[error(
        "{key}: `{value}` is not a value; write a number, an array `[1, 2]`, or text in quotes"
    )]
    Value {
        /// As given.
        key: String,
        /// As given.
        value: String,
    },
    /// The file, before or after the change.
    #[error(transparent)]
    Config(#[from] ConfigError),
}

fn meant(near: &[String]) -> String {
    if near.is_empty() { String::new() } else { format!("; did you mean {}?", near.join(", or ")) }
}

/// How many keys are suggested.
const SUGGESTIONS: usize = 3;
/// Keys less like the one that was given are not.
const LIKENESS_MIN: f64 = 0.7;

/// The text with a value changed. `key` has the tables it is in, joined by dots; it may name another
/// unit than the file does. The number's source becomes `source`, its trust an estimate's.
///
/// # Errors
/// When there is no such key, or the value is none. The limits of values are those of
/// [`aircraft`](crate::aircraft()), which reads the result.
pub fn set(
    file_name: &str,
    text: &str,
    key: &str,
    value: &str,
    source: &str,
) -> Result<String, EditError> {
    crate::provenance(file_name, text)?;
    let wrong = || EditError::Value { key: key.into(), value: value.into() };
    let sample = format!("x = {value}");
    let parsed = DeTable::parse(&sample).map_err(|_| wrong())?;
    if parsed.get_ref().len() != 1 || value.contains(['\n', '\r', '#']) {
        return Err(wrong());
    }
    let Ok(document) = DeTable::parse(text) else { return Err(wrong()) };
    let unknown = || {
        let mut keys = Vec::new();
        leaves("", document.get_ref(), &mut keys);
        let keys: Vec<&str> = keys.iter().map(|(key, _)| key.as_str()).collect();
        EditError::UnknownKey { key: key.into(), near: near(key, &keys) }
    };
    let mut table = document.get_ref();
    let mut segments = key.split('.').peekable();
    while let Some(segment) = segments.next() {
        let (name, found) = entry(table, segment).ok_or_else(unknown)?;
        match (found.get_ref(), segments.peek()) {
            (DeValue::Table(below), Some(_)) if !is_quantity(below) => table = below,
            (_, Some(_)) => return Err(unknown()),
            (DeValue::Table(below), None) if !is_quantity(below) => {
                return Err(EditError::Table { key: key.into() });
            }
            (found_value, None) => {
                let mut changes = vec![(name.span(), segment.to_string())];
                if let DeValue::Table(quantity) = found_value {
                    let quoted = toml::Value::String(source.into()).to_string();
                    let parts = [("value", value), ("source", &quoted), ("trust", "\"E\"")];
                    for (part, new) in parts {
                        if let Some((_, old)) = entry(quantity, part) {
                            changes.push((old.span(), new.to_string()));
                        }
                    }
                } else {
                    changes.push((found.span(), value.to_string()));
                }
                return Ok(changed(text, changes));
            }
        }
    }
    Err(unknown())
}

fn changed(text: &str, mut changes: Vec<(std::ops::Range<usize>, String)>) -> String {
    let mut text = text.to_string();
    // From the back: what comes before stays where it is.
    changes.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    for (span, new) in changes {
        text.replace_range(span, &new);
    }
    text
}

/// The entry of that name, or of the same quantity in another unit.
fn entry<'a, 'i>(
    table: &'a DeTable<'i>,
    name: &str,
) -> Option<(&'a Spanned<std::borrow::Cow<'i, str>>, &'a Spanned<DeValue<'i>>)> {
    let same = |key: &Spanned<std::borrow::Cow<'i, str>>| to_si(key.get_ref()).0 == to_si(name).0;
    table
        .iter()
        .find(|(key, _)| key.get_ref() == name)
        .or_else(|| table.iter().find(|(key, _)| same(key)))
}

fn is_quantity(table: &DeTable<'_>) -> bool {
    table.get("value").is_some()
}

/// Every key that [`set`] changes, with its value as written, in the order of the alphabet.
///
/// # Errors
/// When the text is not TOML.
pub fn values(file_name: &str, text: &str) -> Result<Vec<(String, String)>, ConfigError> {
    crate::provenance(file_name, text)?;
    let Ok(document) = DeTable::parse(text) else { return Ok(Vec::new()) };
    let mut spans = Vec::new();
    leaves("", document.get_ref(), &mut spans);
    let one_line = |span: std::ops::Range<usize>| {
        let value = text.get(span)?;
        // A comment ends with its line: in an array of several lines it has to go.
        let several = value.contains('\n');
        let words = value.lines().flat_map(|line| {
            let told = if several { line.split('#').next().unwrap_or_default() } else { line };
            told.split_whitespace()
        });
        Some(words.collect::<Vec<_>>())
    };
    let mut values: Vec<_> = spans
        .into_iter()
        .filter_map(|(key, span)| Some((key, one_line(span)?.join(" "))))
        .collect();
    values.sort();
    Ok(values)
}

/// Every key that has a value, and where that is.
fn leaves(path: &str, table: &DeTable<'_>, into: &mut Vec<(String, std::ops::Range<usize>)>) {
    for (key, value) in table.iter() {
        let name = key.get_ref();
        let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
        match value.get_ref() {
            DeValue::Table(below) if !is_quantity(below) => leaves(&path, below, into),
            DeValue::Table(quantity) => {
                let number = quantity.get("value").map_or(value.span(), Spanned::span);
                into.push((path, number));
            }
            _ => into.push((path, value.span())),
        }
    }
}

/// Keys that look like one that is not there: by their whole, or by their last word.
pub fn near(key: &str, keys: &[&str]) -> Vec<String> {
    let last = |key: &str| key.rsplit('.').next().unwrap_or_default().to_string();
    let mut ranked: Vec<_> = keys
        .iter()
        .map(|known| {
            let whole = strsim::normalized_damerau_levenshtein(key, known);
            let word = strsim::normalized_damerau_levenshtein(&last(key), &last(known));
            (if whole > word { whole } else { 0.99 * word + 0.01 * whole }, known)
        })
        .filter(|(likeness, _)| *likeness >= LIKENESS_MIN)
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.into_iter().take(SUGGESTIONS).map(|(_, known)| (*known).to_string()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set_ours(key: &str, value: &str) -> Result<String, EditError> {
        set("aircraft.toml", crate::XV15, key, value, "a trial")
    }

    #[test]
    fn a_value_changes_and_nothing_else_does() {
        let text = set_ours("fcc.travel.pedal_in", "3").expect("a key");
        let differing: Vec<_> =
            text.lines().zip(crate::XV15.lines()).filter(|(new, old)| new != old).collect();
        let [(new, _)] = differing[..] else { panic!("one line: {differing:?}") };
        assert_eq!(new, r#"pedal_in = { value = 3, source = "a trial", trust = "E" }"#);
        let aircraft = crate::aircraft("aircraft.toml", &text).expect("an aircraft");
        assert_eq!(aircraft.fcc.travel.pedal_m.to_bits(), (3.0_f64 * 0.0254).to_bits());
    }

    #[test]
    fn the_same_key_in_another_unit_is_the_same_key() {
        let text = set_ours("fcc.travel.pedal_m", "0.1").expect("a key");
        let aircraft = crate::aircraft("aircraft.toml", &text).expect("an aircraft");
        assert_eq!(aircraft.fcc.travel.pedal_m.to_bits(), 0.1_f64.to_bits());
    }

    #[test]
    fn what_is_not_there_suggests_what_is() {
        let near = |key| match set_ours(key, "1") {
            Err(EditError::UnknownKey { near, .. }) => near,
            other => panic!("{key}: {other:?}"),
        };
        assert_eq!(near("fcc.travel.pedals_in")[0], "fcc.travel.pedal_in");
        assert_eq!(near("pedal_in")[0], "fcc.travel.pedal_in");
        assert_eq!(near("quux_frobnicated"), [""; 0]);
        assert!(matches!(set_ours("fcc.travel", "1"), Err(EditError::Table { .. })));
    }

    #[test]
    fn every_value_that_is_told_can_be_set() {
        let values = values("aircraft.toml", crate::XV15).expect("TOML");
        assert!(values.len() > 100, "{}", values.len());
        let told =
            |key: &str| values.iter().find(|(known, _)| known == key).map(|(_, value)| &**value);
        assert_eq!(told("rotors.mast_length_ft"), Some("4.667"));
        for (key, value) in &values {
            set_ours(key, value).unwrap_or_else(|error| panic!("{key} = {value}: {error}"));
        }
    }

    #[test]
    fn a_value_is_one_value() {
        for value in ["", "fast", "1\ny = 2", "1 # one", "]"] {
            let refused = set_ours("fcc.travel.pedal_in", value);
            assert!(matches!(refused, Err(EditError::Value { .. })), "{value}: {refused:?}");
        }
    }
}
