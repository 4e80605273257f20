//! What happened: a list, and a lane on the same time axis as everything else.

use std::collections::BTreeSet;

use engine::STEP_S;
use rerun::{StateChange, StateConfiguration, TextLog};

use super::basics::Severity;
use super::canvas::{Canvas, times};
use super::look::Look;

/// Entity of the list; each flight of several has its own below it.
pub const LIST: &str = "events";
/// Entity of the lane.
pub const LANE: &str = "modes/events";

/// An event is seen in its lane for so long, s, unless the next one comes.
const SEEN_S: f64 = 4.0;
/// Of a long flight for this part of it, so that there is room for its words.
const SEEN_NORM: f64 = 0.12;

/// Something that happened.
#[derive(Clone, Copy, Debug)]
pub struct Happened<'a> {
    /// When.
    pub tick: u64,
    /// How much it matters.
    pub level: Severity,
    /// What.
    pub words: &'a str,
    /// The so-manieth event of the log it is, from 1, as `--at event:N` counts.
    pub number: Option<u64>,
}

/// What happened in a flight.
#[derive(Default)]
pub struct Events {
    all: Vec<(u64, Severity, String)>,
    /// After this one nothing means anything: the lane shows it to the end.
    last: Option<(u64, String)>,
    /// While it is flown: changes of the lane that were written, by their ticks, and for how many events their
    /// colours were.
    written: BTreeSet<u64>,
    coloured: usize,
}

fn colour(severity: Severity) -> u32 {
    match severity {
        Severity::Info => 0x4A_8A_6A_FF,
        Severity::Warning => 0xE0_9A_20_FF,
        Severity::Error => 0xD0_40_38_FF,
    }
}

/// The part of the words that a lane has room for.
fn short(words: &str) -> &str {
    words.split([',', ';', '(', ':']).next().unwrap_or_default().trim_end()
}

impl Events {
    /// Nothing was told.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Notes an event in the list, and for the lane.
    ///
    /// It begins with its number: in a lane there is room for that, however soon the next one comes.
    pub fn add(&mut self, canvas: &mut Canvas, look: &Look, happened: Happened) {
        let Happened { tick, level, words: text, number } = happened;
        let number = number.map_or_else(String::new, |number| format!("{number} "));
        let words = format!("{}{number}{text}", look.name);
        let columns = TextLog::new(words)
            .with_level(level.name())
            .columns_of_unit_batches()
            .map(Vec::from_iter);
        canvas.send(&look.entity(LIST), &times(&[tick]), columns);
        self.all.push((tick, level, format!("{number}{}", short(text))));
    }

    /// Ends the lane with these words: the list has what comes after.
    pub fn end(&mut self, tick: u64, words: &str) {
        self.last = Some((tick, short(words).into()));
    }

    /// Writes the lane.
    pub fn finish(&mut self, canvas: &mut Canvas, look: &Look) {
        let end = canvas.span.map_or(u64::MAX, |(_, last)| last);
        let last = self.all.iter().map(|(tick, ..)| *tick).max().unwrap_or(0);
        let seen = engine::math::max(SEEN_S / STEP_S, SEEN_NORM * last as f64) as u64;
        let changes = lane(&mut self.all, self.last.as_ref(), end, seen);
        write(canvas, look, &changes);
        self.colour(canvas, look);
    }

    /// Writes what the lane shows up to now and did not before, while the flight goes on.
    pub fn go_on(&mut self, canvas: &mut Canvas, look: &Look, now: u64) {
        let seen = (SEEN_S / STEP_S) as u64;
        let mut changes = lane(&mut self.all, self.last.as_ref(), now, seen);
        changes.retain(|(tick, _)| *tick <= now && self.written.insert(*tick));
        write(canvas, look, &changes);
        if self.coloured < self.all.len() {
            self.coloured = self.all.len();
            self.colour(canvas, look);
        }
    }

    /// Tells the colours of all words.
    fn colour(&self, canvas: &mut Canvas, look: &Look) {
        if self.all.is_empty() {
            return;
        }
        let mut known: Vec<(&str, u32)> = Vec::new();
        for (_, level, words) in &self.all {
            if !known.iter().any(|(known, _)| known == words) {
                known.push((words, colour(*level)));
            }
        }
        let (values, colours): (Vec<&str>, Vec<u32>) = known.into_iter().unzip();
        let told = StateConfiguration::new().with_values(values).with_colors(colours);
        let sent = canvas.recording.log_static(look.entity(LANE), &told);
        canvas.keep(sent);
    }
}

/// Writes changes of the lane.
fn write(canvas: &mut Canvas, look: &Look, changes: &[(u64, &str)]) {
    if changes.is_empty() {
        return;
    }
    let ticks: Vec<u64> = changes.iter().map(|(tick, _)| *tick).collect();
    let words = changes.iter().map(|(_, words)| *words);
    let columns =
        StateChange::new().with_state(words).columns_of_unit_batches().map(Vec::from_iter);
    canvas.send(&look.entity(LANE), &times(&ticks), columns);
}

fn gravity(severity: Severity) -> u8 {
    match severity {
        Severity::Error => 0,
        Severity::Warning => 1,
        Severity::Info => 2,
    }
}

/// What the lane shows from when on, up to the end of the flight, each for so many ticks; nothing is an empty
/// word. Of several at once the gravest is shown; the list has all.
fn lane<'a>(
    all: &'a mut [(u64, Severity, String)],
    last: Option<&'a (u64, String)>,
    end: u64,
    seen: u64,
) -> Vec<(u64, &'a str)> {
    all.sort_by_key(|(tick, severity, _)| (*tick, gravity(*severity)));
    let mut changes: Vec<(u64, &str)> = Vec::new();
    for (number, (tick, _, words)) in all.iter().enumerate() {
        if number > 0 && all[number - 1].0 == *tick {
            continue;
        }
        if last.is_some_and(|(last, _)| last <= tick) {
            break;
        }
        changes.push((*tick, words));
        let until = tick.saturating_add(seen);
        let next = all[number + 1..].iter().map(|(next, ..)| next).find(|next| *next > tick);
        if until < end && next.is_none_or(|next| *next > until) {
            changes.push((until, ""));
        }
    }
    if let Some((tick, words)) = last {
        changes.retain(|(changed, _)| changed < tick);
        changes.push((*tick, words));
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_is_seen_until_the_next_one_or_for_a_while() {
        let mut all = vec![
            (5000, Severity::Info, "marker 1".into()),
            (0, Severity::Info, "exact".to_string()),
            (5100, Severity::Info, "touchdown".into()),
            (5100, Severity::Error, "impact".into()),
        ];
        let changes = lane(&mut all, None, 6000, 1000);
        let expected = [(0, "exact"), (1000, ""), (5000, "marker 1"), (5100, "impact")];
        assert_eq!(changes, expected);
        let crash = (5050, "CRASH".to_string());
        let changes = lane(&mut all, Some(&crash), 6000, 1000);
        assert_eq!(changes.last(), Some(&(5050, "CRASH")));
        assert_eq!(short("lift-off, climbing 0.03 m/s"), "lift-off");
    }
}
