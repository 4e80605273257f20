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

/// The words of an event are seen in its lane for so long, s, unless the next one comes.
const SEEN_S: f64 = 4.0;
/// Of a long flight for this part of it, so that there is room for them.
const SEEN_NORM: f64 = 0.12;
/// They are dark, behind a bright mark that is where the event is, and as wide as this part of what they are.
const MARK_NORM: f64 = 0.03;
/// Behind the words of an event in the lane, where it is the mark and not what follows.
const MARK: &str = " \u{2022}";

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

/// From when until when nothing means anything, and what the lane shows instead.
struct Over {
    from: u64,
    until: Option<u64>,
    words: String,
}

impl Over {
    fn covers(&self, tick: u64) -> bool {
        self.from <= tick && self.until.is_none_or(|until| tick < until)
    }
}

/// What happened in a flight.
#[derive(Default)]
pub struct Events {
    all: Vec<(u64, Severity, String)>,
    /// Where nothing means anything, in order.
    over: Vec<Over>,
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

/// Behind words, which are no part of what happened.
fn dark(severity: Severity) -> u32 {
    match severity {
        Severity::Info => 0x22_30_2A_FF,
        Severity::Warning => 0x46_35_14_FF,
        Severity::Error => 0x4A_1E_1C_FF,
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

    /// From there on the lane shows these words: the list has what comes after.
    pub fn end(&mut self, tick: u64, words: &str) {
        self.over.push(Over { from: tick, until: None, words: short(words).into() });
    }

    /// The flight goes on, and so does the lane.
    pub fn resume(&mut self, tick: u64) {
        if let Some(over) = self.over.last_mut().filter(|over| over.until.is_none()) {
            over.until = Some(tick);
        }
    }

    /// Writes the lane.
    pub fn finish(&mut self, canvas: &mut Canvas, look: &Look) {
        let end = canvas.span.map_or(u64::MAX, |(_, last)| last);
        let last = self.all.iter().map(|(tick, ..)| *tick).max().unwrap_or(0);
        let seen = engine::math::max(SEEN_S / STEP_S, SEEN_NORM * last as f64) as u64;
        let changes = lane(&mut self.all, &self.over, end, seen);
        write(canvas, look, &changes);
        self.colour(canvas, look);
    }

    /// Writes what the lane shows up to now and did not before, while the flight goes on.
    pub fn go_on(&mut self, canvas: &mut Canvas, look: &Look, now: u64) {
        let seen = (SEEN_S / STEP_S) as u64;
        let mut changes = lane(&mut self.all, &self.over, now, seen);
        changes.retain(|(tick, _)| *tick <= now && self.written.insert(*tick));
        write(canvas, look, &changes);
        let known = self.all.len() + self.over.len();
        if self.coloured < known {
            self.coloured = known;
            self.colour(canvas, look);
        }
    }

    /// Tells how all words look.
    fn colour(&self, canvas: &mut Canvas, look: &Look) {
        let mut known: Vec<(String, &str, u32)> = Vec::new();
        let over = self
            .over
            .iter()
            .map(|over| (over.words.clone(), &*over.words, colour(Severity::Error)));
        let marks =
            self.all.iter().map(|(_, level, words)| (marked(words), &**words, colour(*level)));
        let words =
            self.all.iter().map(|(_, level, words)| (words.clone(), &**words, dark(*level)));
        for one in over.chain(marks).chain(words) {
            if !known.iter().any(|(known, ..)| *known == one.0) {
                known.push(one);
            }
        }
        if known.is_empty() {
            return;
        }
        let told = StateConfiguration::new()
            .with_values(known.iter().map(|(value, ..)| value.as_str()))
            .with_labels(known.iter().map(|(_, label, _)| *label))
            .with_colors(known.iter().map(|(.., colour)| *colour));
        let sent = canvas.recording.log_static(look.entity(LANE), &told);
        canvas.keep(sent);
    }
}

/// The value of the lane where an event is.
fn marked(words: &str) -> String {
    format!("{words}{MARK}")
}

/// Writes changes of the lane.
fn write(canvas: &mut Canvas, look: &Look, changes: &[(u64, String)]) {
    if changes.is_empty() {
        return;
    }
    let ticks: Vec<u64> = changes.iter().map(|(tick, _)| *tick).collect();
    let words = changes.iter().map(|(_, words)| words.as_str());
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

/// What the lane shows from when on, up to the end of the flight: a mark, and then the words for so many ticks;
/// nothing is an empty word. Of several at once the gravest is shown; the list has all.
fn lane(
    all: &mut [(u64, Severity, String)],
    over: &[Over],
    end: u64,
    seen: u64,
) -> Vec<(u64, String)> {
    all.sort_by_key(|(tick, severity, _)| (*tick, gravity(*severity)));
    let mark = ((seen as f64 * MARK_NORM) as u64).max(1);
    let mut changes: Vec<(u64, String)> = Vec::new();
    for (number, (tick, _, words)) in all.iter().enumerate() {
        if number > 0 && all[number - 1].0 == *tick || over.iter().any(|over| over.covers(*tick)) {
            continue;
        }
        let next = all[number + 1..].iter().map(|(next, ..)| *next).find(|next| next > tick);
        changes.push((*tick, marked(words)));
        for (after, words) in [(mark, words.as_str()), (seen, "")] {
            let tick = tick.saturating_add(after);
            if tick < end && next.is_none_or(|next| next > tick) {
                changes.push((tick, words.into()));
            }
        }
    }
    for over in over.iter().filter(|over| over.until != Some(over.from)) {
        changes.retain(|(tick, _)| !over.covers(*tick));
        changes.push((over.from, over.words.clone()));
        if let Some(until) =
            over.until.filter(|until| changes.iter().all(|(tick, _)| tick != until))
        {
            changes.push((until, String::new()));
        }
    }
    changes.sort_by_key(|(tick, _)| *tick);
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(changes: &[(u64, String)]) -> Vec<(u64, &str)> {
        changes.iter().map(|(tick, words)| (*tick, words.as_str())).collect()
    }

    #[test]
    fn an_event_is_a_mark_and_its_words_are_seen_until_the_next_one_or_for_a_while() {
        let mut all = vec![
            (5000, Severity::Info, "marker 1".into()),
            (0, Severity::Info, "exact".to_string()),
            (5100, Severity::Info, "touchdown".into()),
            (5100, Severity::Error, "impact".into()),
        ];
        let changes = lane(&mut all, &[], 6000, 1000);
        let expected = [
            (0, "exact •"),
            (30, "exact"),
            (1000, ""),
            (5000, "marker 1 •"),
            (5030, "marker 1"),
            (5100, "impact •"),
            (5130, "impact"),
        ];
        assert_eq!(told(&changes), expected);
        assert_eq!(short("lift-off, climbing 0.03 m/s"), "lift-off");
    }

    #[test]
    fn a_crash_is_seen_to_the_end_or_until_the_restart() {
        let event = |tick, words: &str| (tick, Severity::Info, words.to_string());
        let mut all =
            vec![event(5000, "marker 1"), event(5100, "impact"), event(5300, "restarted")];
        let over = |until| Over { from: 5050, until, words: "CRASH".into() };
        let changes = lane(&mut all, &[over(None)], 6000, 1000);
        assert_eq!(told(&changes)[2..], [(5050, "CRASH")]);
        let changes = lane(&mut all, &[over(Some(5300))], 6000, 1000);
        let expected = [(5050, "CRASH"), (5300, "restarted •"), (5330, "restarted")];
        assert_eq!(told(&changes)[2..], expected);
        // Nothing says that it was restarted; and one that lasts no tick.
        let changes = lane(&mut all, &[over(Some(5200))], 6000, 1000);
        assert_eq!(told(&changes)[2..4], [(5050, "CRASH"), (5200, "")]);
        let changes = lane(&mut all, &[over(Some(5050))], 6000, 1000);
        assert!(changes.iter().all(|(_, words)| words != "CRASH"), "{changes:?}");
    }
}
