//! The row of a flight in the table of flights: what the log says of itself, and what was counted.

use std::collections::BTreeSet;
use std::path::Path;

use engine::{STEP_NS, STEP_S};
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use super::table::{Cell, Column};
use crate::channels::ChannelId;
use crate::fields::Value;
use crate::layout::Kind;
use crate::setup::{CLOSING, Identity, METADATA, Setup};
use crate::{Ending, LogError, Message, Messages};

/// What a log is, as whoever exports it has found.
#[derive(Clone, Copy, Debug)]
pub struct Judged<'a> {
    /// In one word.
    pub outcome: &'a str,
    /// In a sentence.
    pub words: &'a str,
}

/// What is counted on the way through a log.
pub(super) struct Flight {
    file: String,
    stem: String,
    states: u64,
    last_tick: Option<u64>,
    missing: u64,
    doubled: u64,
    device_events: u64,
    digest: u64,
}

impl Flight {
    pub fn new(log: &Path) -> Self {
        let name = |part: Option<&std::ffi::OsStr>| {
            part.map_or_else(String::new, |part| part.to_string_lossy().into_owned())
        };
        // What a path, a shell and SQL take as it is.
        let plain = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' };
        Self {
            file: name(log.file_name()),
            stem: name(log.file_stem()).chars().map(plain).take(100).collect(),
            states: 0,
            last_tick: None,
            missing: 0,
            doubled: 0,
            device_events: 0,
            digest: 0,
        }
    }

    /// The flight's name in the tables: the file's, and a digest of who flew what, when, and from
    /// which first state. Two files of one name are told apart, and a log exported twice is one flight.
    pub fn name(
        &self,
        facts: &Facts,
        files: &Files,
        first_state: &[u8],
    ) -> Result<String, LogError> {
        let mut digest = Xxh3::new();
        let identity = facts.iter().find(|(record, _)| record == METADATA);
        let Some((_, identity)) = identity else {
            return Err(LogError::NotAFlight("no `tiltrotor` metadata".into()));
        };
        for (key, value) in identity {
            for part in [key, value] {
                digest.update(&(part.len() as u64).to_le_bytes());
                digest.update(part.as_bytes());
            }
        }
        for (name, data) in files.iter().filter(|(name, _)| Setup::NAMES.contains(&name.as_str())) {
            digest.update(name.as_bytes());
            digest.update(&xxh3_64(data).to_le_bytes());
        }
        digest.update(first_state);
        Ok(format!("{}-{:08x}", self.stem, digest.digest() >> 32))
    }

    pub fn saw(&mut self, message: &Message) -> Result<(), LogError> {
        match message.channel().map(|channel| channel.id) {
            Some(ChannelId::Hardware) => self.device_events += 1,
            Some(ChannelId::State) => {
                let Some(layout) = message.layout() else { return Ok(()) };
                let number = |path: &str| layout.numbers().iter().position(|n| n.path == path);
                if let Some(place) = number("digest") {
                    self.digest = layout.bits(&message.data)?.nth(place).unwrap_or_default();
                }
                self.states += 1;
                let tick = message.time_ns / STEP_NS;
                match self.last_tick.map(|last| tick.checked_sub(last)) {
                    Some(None | Some(0)) => self.doubled += 1,
                    Some(Some(step)) => self.missing = self.missing.saturating_add(step - 1),
                    None => {}
                }
                self.last_tick = self.last_tick.max(Some(tick));
            }
            _ => {}
        }
        Ok(())
    }

    /// Column and fact, in order.
    pub fn row(
        &self,
        messages: &Messages,
        ending: &Ending,
        judged: Judged,
    ) -> Vec<(Column, Cell<'static>)> {
        let whole = |number| Cell::Number(Value::U64(number));
        let text = |name: &str, text: String| (Column::text(name), Cell::Text(text.into()));
        let flown = self.states.saturating_sub(1);
        let flown_s = flown as f64 * STEP_S;
        let ending = match ending {
            Ending::Closed => "closed".into(),
            Ending::Truncated => "never closed".into(),
            Ending::Damaged(why) => format!("damaged: {why}"),
        };
        let mut row = vec![
            text("file", self.file.clone()),
            (Column::number("ticks", Kind::U64), whole(flown)),
            (Column::number("duration_s", Kind::F64), Cell::Number(Value::F64(flown_s))),
            (Column::number("device_events", Kind::U64), whole(self.device_events)),
            text("digest", format!("{:016x}", self.digest)),
            (Column::number("ticks_missing", Kind::U64), whole(self.missing)),
            (Column::number("ticks_doubled", Kind::U64), whole(self.doubled)),
            text("ending", ending),
            text("judgement", judged.outcome.into()),
            text("judgement_words", judged.words.into()),
        ];
        for (file, data) in messages.files() {
            let name = file.strip_suffix(".toml").unwrap_or(file);
            if name == "aircraft" {
                row.push(text("aircraft", name_in(data)));
            }
            row.push(text(&format!("{}_digest", plain(name)), format!("{:016x}", xxh3_64(data))));
        }
        for (record, facts) in messages.facts().iter().filter(|(record, _)| record != CLOSING) {
            for (key, value) in facts {
                let name =
                    if record == METADATA { plain(key) } else { plain(&format!("{record}_{key}")) };
                row.push(match value.parse() {
                    Ok(number) if key == Identity::STARTED => {
                        (Column::number(name, Kind::U64), whole(number))
                    }
                    _ => text(&name, value.clone()),
                });
            }
        }
        let mut taken = BTreeSet::from(["flight".to_string()]);
        row.retain(|(column, _)| taken.insert(column.name.clone()));
        row
    }
}

/// Metadata records: name, keys and values.
type Facts = [(String, std::collections::BTreeMap<String, String>)];
/// Attachments: name and bytes.
type Files = [(String, Vec<u8>)];

/// A name for a column.
fn plain(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    name.chars().map(plain).collect()
}

/// What an aircraft file calls the aircraft.
fn name_in(aircraft_toml: &[u8]) -> String {
    let text = String::from_utf8_lossy(aircraft_toml);
    let name = text.lines().find_map(|line| {
        let (key, value) = line.split_once('=')?;
        (key.trim() == "name").then(|| value.trim().trim_matches('"').to_string())
    });
    name.unwrap_or_default()
}
