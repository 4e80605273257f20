//! What stands above every arrangement: which flight it is, what it is worth, and how it ended.

use engine::aircraft::Params as Aircraft;
use engine::outputs::{Severity, Validity};
use engine::{Outputs, STEP_NS, STEP_S};
use logs::records::TimingRecord;
use logs::text::at;

use super::canvas::{About, Canvas};
use super::look::Look;
use super::parts::HEADING;

/// What is told of a flight above it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    aircraft: String,
    /// First and last tick.
    span: Option<(u64, u64)>,
    /// What the log is.
    verdict: String,
    /// When it ended before its end, and as what.
    crash: Option<(u64, &'static str)>,
    /// How its ticks kept time, as far as they have times.
    pace: Pace,
}

/// How ticks kept time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pace {
    /// Ticks that have times.
    ticks: u64,
    /// Those that ended after the next one was due.
    overruns: u64,
    /// The latest to wake up, and by how much; 0 where nothing waited for the clock.
    latest: (u64, u64),
}

impl Pace {
    fn words(self) -> Option<String> {
        let Self { ticks, overruns, latest: (tick, late_ns) } = self;
        match (ticks, late_ns) {
            (0, _) => None,
            (_, 0) => Some("not in real time: no tick could be late".into()),
            _ => Some(format!(
                "real time: {overruns} of {ticks} ticks over their {} ms, the latest by {:.1} ms at {:.1} s",
                STEP_NS / 1_000_000,
                late_ns as f64 * 1e-6,
                tick as f64 * STEP_S
            )),
        }
    }
}

impl Facts {
    /// Nothing is known but what flies.
    pub fn new(aircraft: &Aircraft) -> Self {
        Self { aircraft: aircraft.name.clone(), ..Self::default() }
    }

    /// Takes a tick; whether nothing after it means anything, and why, where that is new.
    pub fn add(&mut self, outputs: &Outputs) -> Option<&'static str> {
        let (first, last) = self.span.unwrap_or((outputs.tick, outputs.tick));
        self.span = Some((first.min(outputs.tick), last.max(outputs.tick)));
        if self.crash.is_some() {
            return None;
        }
        let met = outputs.validity.told().find(|facts| facts.severity == Severity::Final)?;
        self.crash = Some((outputs.tick, met.words));
        Some(if met.flag == Validity::HULL { "CRASH" } else { "FROZEN" })
    }

    /// Takes how a tick kept time.
    pub fn time(&mut self, timing: &TimingRecord) {
        self.pace.ticks += 1;
        self.pace.overruns += u64::from(timing.overrun > 0);
        if timing.late_ns > self.pace.latest.1 {
            self.pace.latest = (timing.tick, timing.late_ns);
        }
    }

    /// Takes what the log is.
    pub fn judge(&mut self, verdict: &str) {
        self.verdict = verdict.into();
    }

    /// When it ended before its end.
    pub fn crash_words(&self) -> Option<String> {
        let (tick, words) = self.crash?;
        Some(format!("CRASH at {:.2} s: {words}", tick as f64 * STEP_S))
    }

    /// What is told in bold of one that ended before its end.
    fn crash(&self) -> Option<String> {
        let (tick, words) = self.crash?;
        Some(format!("**CRASH at {}: {words}. Nothing after it means anything.**", at(tick)))
    }

    /// The lines below a flight's name.
    fn lines(&self, flown: &str) -> Vec<String> {
        let mut lines = Vec::new();
        lines.extend(self.crash());
        let length = self.span.map(|(first, last)| {
            format!("{:.1} to {:.1} s", first as f64 * STEP_S, last as f64 * STEP_S)
        });
        let first = [Some(flown.to_string()), length, self.pace.words()];
        let first: Vec<String> =
            first.into_iter().flatten().filter(|words| !words.is_empty()).collect();
        lines.push(first.join(" · "));
        lines.extend((!self.verdict.is_empty()).then(|| self.verdict.clone()));
        lines
    }
}

/// Writes what is known of the only flight.
pub fn send(canvas: &mut Canvas, look: &Look, facts: &Facts) {
    // Of two flights the comparison tells.
    if look.root.is_empty() {
        let page = alone(&canvas.about, facts);
        canvas.write(HEADING, page);
    }
}

fn alone(about: &About, facts: &Facts) -> String {
    let flown = about.flown.first().map_or("", String::as_str);
    let name = format!("**{} · {}**", escaped(&about.title), escaped(&facts.aircraft));
    page(name, facts.lines(flown))
}

/// Writes what is known of two flights, each with its name and how its lines look.
pub fn send_two(canvas: &mut Canvas, flights: [(&Look, &Facts); 2]) {
    const LINES: [&str; 2] =
        ["broad pale lines, blue path", "thin lines, orange path and aircraft"];
    let mut lines = Vec::new();
    for (of, (look, facts)) in flights.into_iter().enumerate() {
        let flown = canvas.about.flown.get(of).map_or("", String::as_str);
        let name = escaped(look.name.trim_end_matches(": "));
        let told = [Some(escaped(&facts.aircraft)), Some(flown.to_string()), facts.crash()];
        let told: Vec<String> =
            told.into_iter().flatten().filter(|words| !words.is_empty()).collect();
        lines.push(format!("**{name}** ({}): {}", LINES[of], told.join(" · ")));
    }
    let name = format!("**{}**", escaped(&canvas.about.title));
    canvas.write(HEADING, page(name, lines));
}

/// In Markdown, a line each: there is little room.
fn page(name: String, lines: Vec<String>) -> String {
    let all: Vec<String> = std::iter::once(name).chain(lines).collect();
    all.join("  \n")
}

/// What Markdown would take for its own: a log may be called anything.
fn escaped(words: &str) -> String {
    let own = |letter: char| "\\`*_{}[]<>()#!|~".contains(letter);
    words.chars().flat_map(|c| own(c).then_some('\\').into_iter().chain([c])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts() -> Facts {
        Facts { aircraft: "Bell XV-15".into(), ..Facts::default() }
    }

    fn about() -> About {
        About {
            title: "my_flight".into(),
            flown: vec!["flown 2026-11-26 12:00 UTC".into()],
            ..About::default()
        }
    }

    #[test]
    fn a_page_says_which_flight_it_is_and_whether_it_was_in_real_time() {
        let mut facts = facts();
        for tick in 1..=500 {
            assert_eq!(facts.add(&Outputs { tick, ..Outputs::default() }), None);
        }
        facts.judge("exact: all 500 ticks");
        let page = alone(&about(), &facts);
        for words in ["my\\_flight", "Bell XV-15", "2026-11-26", "to 2.0 s", "exact: all 500"] {
            assert!(page.contains(words), "{words} in {page}");
        }
        assert!(!page.contains("CRASH") && !page.contains("real time"), "{page}");
        facts.time(&TimingRecord { step_ns: 9, ..TimingRecord::default() });
        assert!(alone(&about(), &facts).contains("not in real time"));
        facts.time(&TimingRecord { tick: 500, late_ns: 1_500_000, ..TimingRecord::default() });
        facts.time(&TimingRecord { overrun: 1, ..TimingRecord::default() });
        let told = "real time: 1 of 3 ticks over their 4 ms, the latest by 1.5 ms at 2.0 s";
        assert!(alone(&about(), &facts).contains(told));
    }

    #[test]
    fn a_crash_is_told_once_and_stays() {
        let mut facts = facts();
        let wreck = |tick| Outputs { tick, validity: Validity::HULL, ..Outputs::default() };
        assert_eq!(facts.add(&wreck(250)), Some("CRASH"));
        assert_eq!(facts.add(&wreck(251)), None);
        facts.add(&Outputs { tick: 300, ..Outputs::default() });
        let page = alone(&about(), &facts);
        assert!(page.contains("**CRASH at tick 250 (1.000 s): hull on the ground."), "{page}");
    }
}
