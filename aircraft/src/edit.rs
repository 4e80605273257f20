//! Changing numbers of an aircraft file, as text: everything else stays as it is written.

use engine::table::VALUE;
use toml_edit::{DocumentMut, Item, TableLike, Value};

use crate::error::{ConfigError, Problem};
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
    let mut document = document(file_name, text)?;
    let wrong = || EditError::Value { key: key.into(), value: value.into() };
    let new: Value = value.parse().map_err(|_| wrong())?;
    if value.contains(['\n', '\r', '#']) {
        return Err(wrong());
    }
    let names = place(document.as_table(), key)?;
    let (Some((name, tables)), Some(segment)) = (names.split_last(), key.rsplit('.').next()) else {
        return Err(wrong());
    };
    let mut table: &mut dyn TableLike = document.as_table_mut();
    for name in tables {
        table = table.get_mut(name).and_then(Item::as_table_like_mut).ok_or_else(wrong)?;
    }
    let item = table.get_mut(name).ok_or_else(wrong)?;
    if let Some(quantity) = item.as_table_like_mut() {
        for (part, new) in [(VALUE, new), ("source", source.into()), ("trust", "E".into())] {
            replace(quantity.get_mut(part), new);
        }
    } else {
        replace(Some(item), new);
    }
    rename(table, name, segment);
    let changed = document.to_string();
    // What is written again has its lines ended as on Unix.
    Ok(if text.contains("\r\n") { changed.replace('\n', "\r\n") } else { changed })
}

/// The text's tables, with what is between them.
fn document(file_name: &str, text: &str) -> Result<DocumentMut, ConfigError> {
    crate::provenance(file_name, text)?;
    text.parse().map_err(|error: toml_edit::TomlError| ConfigError {
        file: file_name.to_owned(),
        line: 1,
        key: String::new(),
        problem: Problem::Syntax(error.message().replace('\n', "; ")),
    })
}

/// The names, as written, of the tables that a key is in and of the key itself.
fn place(document: &dyn TableLike, key: &str) -> Result<Vec<String>, EditError> {
    let unknown = || {
        let mut known = Vec::new();
        leaves("", document, &mut known);
        let known: Vec<&str> = known.iter().map(|(key, _)| key.as_str()).collect();
        EditError::UnknownKey { key: key.into(), near: near(key, &known) }
    };
    let mut table = document;
    let mut names = Vec::new();
    let mut segments = key.split('.').peekable();
    while let Some(segment) = segments.next() {
        let (name, item) = entry(table, segment).ok_or_else(unknown)?;
        names.push(name.to_owned());
        match (table_of_keys(item), segments.peek()) {
            (Some(below), Some(_)) => table = below,
            (Some(_), None) => return Err(EditError::Table { key: key.into() }),
            (None, Some(_)) => return Err(unknown()),
            (None, None) => {}
        }
    }
    Ok(names)
}

/// The entry of that name, or of the same quantity in another unit.
fn entry<'a>(table: &'a dyn TableLike, name: &str) -> Option<(&'a str, &'a Item)> {
    let same = |(key, _): &(&str, &Item)| to_si(key).0 == to_si(name).0;
    table.iter().find(|(key, _)| *key == name).or_else(|| table.iter().find(same))
}

/// The table, if it is one that has keys, and no number with its source.
fn table_of_keys(item: &Item) -> Option<&dyn TableLike> {
    item.as_table_like().filter(|table| !table.contains_key(VALUE))
}

/// Puts a value in another's place, between the same spaces and comments.
fn replace(old: Option<&mut Item>, mut new: Value) {
    if let Some(old) = old.and_then(Item::as_value_mut) {
        *new.decor_mut() = old.decor().clone();
        *old = new;
    }
}

/// Gives an entry another name, in its place.
fn rename(table: &mut dyn TableLike, old: &str, new: &str) {
    if old == new {
        return;
    }
    // An entry is added behind the others: all are, in their order.
    let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
    for name in names {
        let Some(key) = table.key(&name).cloned() else { continue };
        let Some(item) = table.remove(&name) else { continue };
        let key = if name == old {
            toml_edit::Key::new(new)
                .with_leaf_decor(key.leaf_decor().clone())
                .with_dotted_decor(key.dotted_decor().clone())
        } else {
            key
        };
        table.entry_format(&key).or_insert(item);
    }
}

/// Every key that [`set`] changes, with its value as written, in the order of the alphabet.
///
/// # Errors
/// When the text is not TOML.
pub fn values(file_name: &str, text: &str) -> Result<Vec<(String, String)>, ConfigError> {
    let document = document(file_name, text)?;
    let mut values = Vec::new();
    leaves("", document.as_table(), &mut values);
    let one_line = |value: String| {
        // A comment ends with its line: in an array of several lines it has to go.
        let several = value.contains('\n');
        let words = value.lines().flat_map(|line| {
            let told = if several { line.split('#').next().unwrap_or_default() } else { line };
            told.split_whitespace()
        });
        words.collect::<Vec<_>>().join(" ")
    };
    let mut values: Vec<_> =
        values.into_iter().map(|(key, value)| (key, one_line(value))).collect();
    values.sort();
    Ok(values)
}

/// What [`set`] does to a text, in words: what the key becomes, and what it was.
///
/// # Errors
/// When the text is not TOML.
pub fn change_in_words(
    file_name: &str,
    text: &str,
    key: &str,
    value: &str,
) -> Result<String, ConfigError> {
    /// A table would be a long word.
    const TOLD_MAX: usize = 24;
    let before = values(file_name, text)?;
    let was = before.iter().find(|(known, was)| known == key && was.len() <= TOLD_MAX);
    let was = was.map_or_else(String::new, |(_, was)| format!(" (was {was})"));
    Ok(format!("{key} = {value}{was}"))
}

/// Every key that has a value, and that as written.
fn leaves(path: &str, table: &dyn TableLike, into: &mut Vec<(String, String)>) {
    for (name, item) in table.iter() {
        let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
        if let Some(below) = table_of_keys(item) {
            leaves(&path, below, into);
        } else {
            let quantity = item.as_table_like().and_then(|quantity| quantity.get(VALUE));
            let value = quantity.unwrap_or(item).as_value().cloned();
            let written = value.map(|value| value.decorated("", "").to_string());
            into.push((path, written.unwrap_or_default()));
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

    /// A table's key, and a key between others: the order and all that is between stay.
    #[test]
    fn another_unit_is_written_where_the_key_was() {
        for (key, value, old, new) in [
            ("fcc.travel.pedal_m", "0.1", "pedal_in = { value = 2.5,", "pedal_m = { value = 0.1,"),
            (
                "actuators.nacelle_radps",
                "[0, 0.1, 0.1, 0.1, 0.1, 0]",
                "[actuators.nacelle_degps]",
                "[actuators.nacelle_radps]",
            ),
        ] {
            let text = set_ours(key, value).expect("a key");
            let line =
                |text: &str, start: &str| text.lines().position(|line| line.starts_with(start));
            assert!(line(crate::XV15, old).is_some(), "{old}");
            assert_eq!(line(&text, new), line(crate::XV15, old), "{key}");
            assert_eq!(text.lines().count(), crate::XV15.lines().count());
        }
    }

    #[test]
    fn lines_end_as_they_did() {
        let windows = crate::XV15.replace('\n', "\r\n");
        let text = set("aircraft.toml", &windows, "fcc.travel.pedal_in", "3", "a trial");
        let ours = set_ours("fcc.travel.pedal_in", "3").expect("a key");
        assert_eq!(text.expect("a key"), ours.replace('\n', "\r\n"));
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
