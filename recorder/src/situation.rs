//! Situations as files: every number of the state and of the world by its name, in TOML.
//!
//! A number is written with as many digits as give the same bits back. Numbers beyond TOML's integers
//! are text in hexadecimal.

use std::io::Write;
use std::path::Path;

use engine::State;
use engine::inputs::World;
use logs::LogError;
use logs::cdr;
use logs::fields::{Value, fields};
use logs::output::Output;
use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value as Toml};

use crate::restart::Situation;

/// Why a situation cannot be flown.
#[derive(Debug, thiserror::Error)]
pub enum SituationError {
    /// It cannot be read or written.
    #[error("{file}: {error}")]
    Io {
        /// File.
        file: String,
        /// What the system says.
        error: std::io::Error,
    },
    /// It is no TOML.
    #[error("{file}:{line}: {what}")]
    Syntax {
        /// File.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// It is no situation of this aircraft and flight model.
    #[error("{file}: {what}")]
    Content {
        /// File.
        file: String,
        /// What is wrong, and what was expected.
        what: String,
    },
    /// Its numbers cannot be written.
    #[error(transparent)]
    Log(#[from] LogError),
}

/// Writes a situation into a file beside the one that may be there, and puts it into its place.
///
/// # Errors
/// When it cannot be written.
pub fn save(path: &Path, situation: &Situation, aircraft: &str) -> Result<(), SituationError> {
    let text = text(situation, aircraft)?;
    let output = Output::beside(path, false, &[])?;
    let failed = |error| SituationError::Io { file: path.display().to_string(), error };
    output.file()?.write_all(text.as_bytes()).map_err(failed)?;
    Ok(output.finish()?)
}

/// Reads a situation's file.
///
/// # Errors
/// When it cannot be read, or is none of this aircraft and flight model.
pub fn load(path: &Path, aircraft: &str) -> Result<Situation, SituationError> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path)
        .map_err(|error| SituationError::Io { file: file.clone(), error })?;
    parse(&file, &text, aircraft)
}

/// As text.
fn text(situation: &Situation, aircraft: &str) -> Result<String, LogError> {
    let mut text = format!(
        "# A situation: `tiltrotor fly --situation FILE` begins with it.\n\
         model_version = {:?}\naircraft = {aircraft:?}\n",
        engine::MODEL_VERSION
    );
    for (name, numbers) in
        [("state", fields(&situation.state)), ("world", fields(&situation.world))]
    {
        text.push_str(&format!("\n[{name}]\n"));
        for field in numbers? {
            let value = match field.value {
                Value::U64(number) if i64::try_from(number).is_err() => format!("\"{number:#x}\""),
                value => value.to_string(),
            };
            text.push_str(&format!("\"{}\" = {value}\n", field.path));
        }
    }
    Ok(text)
}

/// From text.
fn parse(file: &str, text: &str, aircraft: &str) -> Result<Situation, SituationError> {
    let content = |what: String| SituationError::Content { file: file.into(), what };
    let mut table: Table = toml::from_str(text).map_err(|error: toml::de::Error| {
        let start = error.span().map_or(0, |span| span.start);
        let line = 1 + text.as_bytes().iter().take(start).filter(|&&byte| byte == b'\n').count();
        SituationError::Syntax { file: file.into(), line, what: error.message().to_string() }
    })?;
    for (key, ours) in [("model_version", engine::MODEL_VERSION), ("aircraft", aircraft)] {
        match table.remove(key) {
            Some(Toml::String(theirs)) if theirs == ours => {}
            Some(theirs) => {
                return Err(content(format!("{key}: expected {ours:?}, got {theirs}")));
            }
            None => return Err(content(format!("no situation: it has no `{key}`"))),
        }
    }
    let mut part = |name: &str| match table.remove(name) {
        Some(Toml::Table(part)) => Ok(part),
        _ => Err(content(format!("no situation: it has no table [{name}]"))),
    };
    let state: State =
        numbers(part("state")?).map_err(|what| content(format!("[state] {what}")))?;
    let world: World =
        numbers(part("world")?).map_err(|what| content(format!("[world] {what}")))?;
    if let Some(key) = table.keys().next() {
        return Err(content(format!("`{key}` is no part of a situation")));
    }
    if !state.is_finite() || !world.is_finite() {
        return Err(content("a number is not finite".into()));
    }
    Ok(Situation { state: state.without_negative_zeros(), world })
}

/// A recorded struct from its named numbers, every one of them.
fn numbers<T>(mut table: Table) -> Result<T, String>
where
    T: Serialize + DeserializeOwned + Default,
{
    let known = fields(&T::default()).map_err(|error| error.to_string())?;
    let mut message = cdr::HEADER.to_vec();
    for field in known {
        let path = &field.path;
        let value = table.remove(path).ok_or_else(|| format!("`{path}` is missing"))?;
        let bits = bits(field.value, &value).ok_or_else(|| {
            format!("`{path}`: expected a {}, got {value}", field.value.ros_type())
        })?;
        message.extend_from_slice(&bits.to_le_bytes());
    }
    if let Some(key) = table.keys().next() {
        return Err(format!("`{key}` is unknown"));
    }
    cdr::decode(&message).map_err(|error| error.to_string())
}

fn bits(kind: Value, value: &Toml) -> Option<u64> {
    match (kind, value) {
        (Value::F64(_), Toml::Float(number)) => Some(number.to_bits()),
        (Value::U64(_), Toml::Integer(number)) => u64::try_from(*number).ok(),
        (Value::U64(_), Toml::String(text)) => {
            u64::from_str_radix(text.strip_prefix("0x")?, 16).ok()
        }
        (Value::I64(_), Toml::Integer(number)) => Some(number.cast_unsigned()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use engine::inputs::Failures;

    use super::*;

    fn awkward() -> Situation {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
        let mut state = start.on_wheels(&aircraft);
        state.environment.noise = u64::MAX;
        state.plant.position_m.x = f64::MIN_POSITIVE;
        state.plant.position_m.y = -1.0 / 3.0;
        state.plant.fuel_kg = 1e300;
        let world = World { failures: Failures::GOVERNOR, ..start.world.world() };
        Situation { state, world }
    }

    #[test]
    fn a_situation_comes_back_to_the_bit() {
        let situation = awkward();
        let written = text(&situation, "Bell XV-15").unwrap();
        let back = parse("s.toml", &written, "Bell XV-15").unwrap();
        assert_eq!(cdr::encode(&back.state).unwrap(), cdr::encode(&situation.state).unwrap());
        assert_eq!(cdr::encode(&back.world).unwrap(), cdr::encode(&situation.world).unwrap());
    }

    #[test]
    fn what_is_no_situation_is_refused_by_name() {
        let written = text(&awkward(), "Bell XV-15").unwrap();
        let refused = |text: &str| parse("s.toml", text, "Bell XV-15").unwrap_err().to_string();
        let fuel = "\"plant.fuel_kg\"";
        for (text, words) in [
            ("nothing".into(), "s.toml:1"),
            ("a = 1".into(), "no `model_version`"),
            (
                written.replace("Bell XV-15", "Kite"),
                "aircraft: expected \"Bell XV-15\", got \"Kite\"",
            ),
            (written.replace(fuel, "\"plant.coal_kg\""), "[state] `plant.fuel_kg` is missing"),
            (written.replace(fuel, &format!("\"coal\" = 1\n{fuel}")), "[state] `coal` is unknown"),
            (
                written.replace("\"tick\" = 0", "\"tick\" = 0.5"),
                "`tick`: expected a uint64, got 0.5",
            ),
            (written.replace("1e300", "nan"), "not finite"),
            (format!("{written}\n[more]\n"), "`more` is no part of a situation"),
        ] {
            let said = refused(&text);
            assert!(said.contains(words), "{said}");
        }
    }
}
