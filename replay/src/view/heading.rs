//! What stands above every arrangement: which flight it is, what it is worth, and how it ended.

use engine::aircraft::Params as Aircraft;
use engine::frames::{Ned, Vec3};
use engine::outputs::{Severity, Validity};
use engine::units::KT_PER_MPS;
use engine::{Outputs, STEP_NS, STEP_S};
use logs::records::TimingRecord;

use rerun::{Points3D, Radius, RecordingStream, RecordingStreamResult};

use super::canvas::{About, Canvas};
use super::columns::point;
use super::look::Look;
use super::parts::HEADING;

/// So many endings are told above a flight; the list of events has all.
const ENDINGS_MAX: usize = 2;

/// From one tick on nothing means anything, until the flight goes on from another state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ending {
    /// The first tick of it.
    pub tick: u64,
    /// The tick at which another state took the place of the one that was flown, if one did.
    pub until: Option<u64>,
    /// Whether it is the hull on the ground; else numbers that are none.
    is_crash: bool,
    words: &'static str,
    /// How fast it sank in the tick that was seen before, m/s.
    sink_mps: Option<f64>,
    /// Where it was.
    pub position_m: Vec3<Ned>,
}

impl Ending {
    /// What it is called.
    pub fn name(&self) -> &'static str {
        if self.is_crash { "CRASH" } else { "FROZEN" }
    }

    /// What it is, and when it began.
    pub fn words(&self) -> String {
        let sink = self.sink().map_or_else(String::new, |sink| format!(", {sink}"));
        format!("{} at {:.2} s: {}{sink}", self.name(), self.tick as f64 * STEP_S, self.words)
    }

    /// How fast a wreck came down.
    fn sink(&self) -> Option<String> {
        let sink_mps = self.sink_mps.filter(|sink_mps| self.is_crash && *sink_mps > 0.0)?;
        Some(format!("sinking {sink_mps:.1} m/s"))
    }

    /// What it is, and from when to when.
    pub fn label(&self) -> String {
        match self.until {
            Some(tick) => format!("{}; restarted at {:.2} s", self.words(), tick as f64 * STEP_S),
            None => self.words(),
        }
    }

    /// In bold.
    fn told(&self) -> String {
        // There is room for a line.
        let words = match self.sink() {
            Some(sink) => format!("CRASH at {:.2} s, {sink}", self.tick as f64 * STEP_S),
            None => self.words(),
        };
        match self.until {
            Some(tick) => {
                let at_s = tick as f64 * STEP_S;
                format!("**{words}. Nothing until the restart at {at_s:.2} s means anything.**")
            }
            None => format!("**{words}. Nothing after it means anything.**"),
        }
    }
}

/// What is told of a flight above it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    aircraft: String,
    /// Who flew.
    hands: String,
    /// Whether it is still flown: how long it takes is not known.
    pub live: bool,
    /// The least margin inside the conversion corridor, m/s, and at which tick.
    margin_mps: Option<(f64, u64)>,
    /// First and last tick.
    span: Option<(u64, u64)>,
    /// What the log is.
    verdict: String,
    /// When it ended before its end, and went on.
    endings: Vec<Ending>,
    /// How fast it sank in the last tick seen, m/s.
    sink_mps: Option<f64>,
    /// The last tick that another state took the place of.
    restarted: Option<u64>,
    /// How its ticks kept time, as far as they have times.
    pace: Pace,
}

/// How ticks kept time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pace {
    /// Ticks that have times.
    pub ticks: u64,
    /// Those that ended after the next one was due.
    pub overruns: u64,
    /// The latest to wake up, and by how much, ns; 0 where nothing waited for the clock.
    pub latest: (u64, u64),
}

impl Pace {
    fn words(self) -> Option<String> {
        let Self { ticks, overruns, latest: (tick, late_ns) } = self;
        match (ticks, late_ns) {
            (0, _) => None,
            (_, 0) => Some("not in real time".into()),
            _ => Some(format!(
                "real time: {overruns} of {ticks} ticks overran {} ms, worst {:.1} ms late at {:.1} s",
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

    /// Takes a tick; whether it is the first of some of which nothing means anything.
    pub fn add(&mut self, outputs: &Outputs) -> bool {
        let (first, last) = self.span.unwrap_or((outputs.tick, outputs.tick));
        self.span = Some((first.min(outputs.tick), last.max(outputs.tick)));
        // What was flown before the last restart may be seen after it is known.
        let sink_mps = self.sink_mps.replace(outputs.velocity_mps.z);
        let is_old = self.restarted.is_some_and(|tick| outputs.tick <= tick);
        if is_old || self.over().is_some() {
            return false;
        }
        let mut met = outputs.validity.told().filter(|facts| facts.severity == Severity::Final);
        let Some(met) = met.next() else { return false };
        self.endings.push(Ending {
            tick: outputs.tick,
            until: None,
            is_crash: met.flag == Validity::HULL,
            words: met.words,
            sink_mps,
            position_m: outputs.position_m,
        });
        true
    }

    /// Another state took the place of the one at a tick; whether that one meant nothing.
    pub fn restart(&mut self, tick: u64) -> bool {
        self.restarted = Some(tick);
        self.sink_mps = None;
        let over = self.endings.last_mut().filter(|ending| ending.until.is_none());
        over.map(|ending| ending.until = Some(tick.max(ending.tick))).is_some()
    }

    /// Takes who flew.
    pub fn flown_by(&mut self, who: &str) {
        self.hands = who.into();
    }

    /// Takes how far inside the conversion corridor it is at a tick, m/s.
    pub fn add_margin(&mut self, tick: u64, margin_mps: f64) {
        if self.margin_mps.is_none_or(|(least_mps, _)| margin_mps < least_mps) {
            self.margin_mps = Some((margin_mps, tick));
        }
    }

    /// Takes how a tick kept time.
    pub fn time(&mut self, timing: &TimingRecord) {
        self.pace.ticks += 1;
        self.pace.overruns += u64::from(timing.overrun > 0);
        if timing.late_ns > self.pace.latest.1 {
            self.pace.latest = (timing.tick, timing.late_ns);
        }
    }

    /// Takes how all ticks so far kept time.
    pub fn keep(&mut self, pace: Pace) {
        self.pace = pace;
    }

    /// Takes what the log is.
    pub fn judge(&mut self, verdict: &str) {
        self.verdict = verdict.into();
    }

    /// All its endings.
    pub fn endings(&self) -> &[Ending] {
        &self.endings
    }

    /// The ending that has no end so far.
    pub fn over(&self) -> Option<&Ending> {
        self.endings.last().filter(|ending| ending.until.is_none())
    }

    /// What is told in bold of one that ended before its end: the last ones.
    fn told_endings(&self) -> Vec<String> {
        let left = self.endings.len().saturating_sub(ENDINGS_MAX);
        let mut told: Vec<String> = self.endings[left..].iter().map(Ending::told).collect();
        if left > 0 {
            told.push(format!("{left} more before, each until a restart."));
        }
        told
    }

    /// When it was flown, and by whom.
    fn flown(&self, when: &str) -> String {
        match (when, self.hands.as_str()) {
            (when, "") => escaped(when),
            ("", who) => format!("flown by {}", escaped(who)),
            (when, who) => format!("{} by {}", escaped(when), escaped(who)),
        }
    }

    /// How it kept to the conversion corridor.
    fn corridor(&self) -> Option<String> {
        let (margin_mps, tick) = self.margin_mps?;
        let (kt, at_s) = (margin_mps.abs() * KT_PER_MPS, tick as f64 * STEP_S);
        Some(if margin_mps < 0.0 {
            format!("**outside the conversion corridor** by up to {kt:.1} kt, at {at_s:.1} s")
        } else {
            format!("inside the conversion corridor, least margin {kt:.1} kt at {at_s:.1} s")
        })
    }

    /// The lines below a flight's name.
    fn lines(&self, flown: &str) -> Vec<String> {
        let mut lines = self.told_endings();
        let span = self.span.map(|(first, last)| {
            let [first_s, last_s] = [first, last].map(|tick| tick as f64 * STEP_S);
            match first_s {
                _ if self.live => format!("as of {last_s:.1} s"),
                first_s if first_s < 0.05 => format!("{last_s:.1} s"),
                _ => format!("{first_s:.1} to {last_s:.1} s"),
            }
        });
        let when = [Some(self.flown(flown)), span];
        let when: Vec<String> =
            when.into_iter().flatten().filter(|words| !words.is_empty()).collect();
        lines.extend(self.corridor());
        lines.push(when.join(", "));
        lines.extend((!self.verdict.is_empty()).then(|| format!("log {}", self.verdict)));
        lines.extend(self.pace.words());
        lines.retain(|line| !line.is_empty());
        lines
    }
}

/// Marks where it ended before its end, each time.
pub fn send_endings(
    recording: &RecordingStream,
    look: &Look,
    endings: &[Ending],
) -> RecordingStreamResult<()> {
    let labels = endings.iter().map(|ending| format!("{}{}", look.name, ending.label()));
    recording.log_static(
        look.entity("world/crash"),
        &Points3D::new(endings.iter().map(|ending| point(ending.position_m)))
            .with_radii([Radius::new_ui_points(7.0)])
            .with_colors([0xFF_20_20_FF])
            .with_labels(labels)
            .with_show_labels(true),
    )
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
        ["broad pale lines; white aircraft and path", "thin lines; magenta aircraft and path"];
    let first = flights[0].1.aircraft.clone();
    let mut lines = Vec::new();
    for (of, (look, facts)) in flights.into_iter().enumerate() {
        let flown = canvas.about.flown.get(of).map_or("", String::as_str);
        let name = escaped(look.name.trim_end_matches(": "));
        // There is little room: of the verdict what it says of the whole.
        let verdict = facts.verdict.split(", ").next().unwrap_or_default();
        let verdict = match verdict.starts_with("not reflown") {
            // What is proven of one by reading it.
            true => "digests intact, not reflown",
            false => verdict,
        };
        let verdict = (!verdict.is_empty()).then(|| format!("log {verdict}"));
        let aircraft = (first != facts.aircraft).then(|| escaped(&facts.aircraft));
        let told = aircraft.into_iter().chain([facts.flown(flown)]);
        let told = told.chain(facts.told_endings()).chain(verdict);
        let told: Vec<String> = told.filter(|words| !words.is_empty()).collect();
        lines.push(format!("**{name}** ({}): {}", LINES[of], told.join(" · ")));
    }
    let name = format!("**{} · {}**", escaped(&canvas.about.title), escaped(&first));
    canvas.write(HEADING, page(name, lines));
}

/// In Markdown, a line each: there is little room.
fn page(name: String, lines: Vec<String>) -> String {
    let all: Vec<String> = std::iter::once(name).chain(lines).collect();
    all.join("  \n")
}

/// What Markdown would take for its own: a log may be called anything.
pub fn escaped(words: &str) -> String {
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
            assert!(!facts.add(&Outputs { tick, ..Outputs::default() }));
        }
        facts.judge("exact: all 500 ticks");
        assert!(alone(&about(), &facts).contains("UTC, 2.0 s"));
        facts.flown_by("X_52");
        assert!(alone(&about(), &facts).contains("UTC by X\\_52, 2.0 s"));
        assert!(!alone(&about(), &facts).contains("corridor"));
        facts.add_margin(250, 5.0);
        facts.add_margin(500, 4.0);
        facts.add_margin(501, 6.0);
        let inside = "inside the conversion corridor, least margin 7.8 kt at 2.0 s";
        assert!(alone(&about(), &facts).contains(inside));
        facts.add_margin(750, -1.0);
        let outside = "**outside the conversion corridor** by up to 1.9 kt, at 3.0 s";
        assert!(alone(&about(), &facts).contains(outside));
        let live = Facts { live: true, ..facts.clone() };
        assert!(alone(&about(), &live).contains("UTC by X\\_52, as of 2.0 s"));
        let page = alone(&about(), &facts);
        for words in ["my\\_flight", "Bell XV-15", "2026-11-26", "X\\_52, 2.0 s", "exact: all 500"]
        {
            assert!(page.contains(words), "{words} in {page}");
        }
        assert!(!page.contains("CRASH") && !page.contains("real time"), "{page}");
        facts.time(&TimingRecord { step_ns: 9, ..TimingRecord::default() });
        assert!(alone(&about(), &facts).contains("not in real time"));
        facts.time(&TimingRecord { tick: 500, late_ns: 1_500_000, ..TimingRecord::default() });
        facts.time(&TimingRecord { overrun: 1, ..TimingRecord::default() });
        let told = "real time: 1 of 3 ticks overran 4 ms, worst 1.5 ms late at 2.0 s";
        assert!(alone(&about(), &facts).contains(told));
    }

    fn wreck(tick: u64, validity: Validity) -> Outputs {
        Outputs { tick, validity, ..Outputs::default() }
    }

    #[test]
    fn a_crash_is_told_once_and_stays() {
        let mut facts = facts();
        assert!(facts.add(&wreck(250, Validity::HULL)));
        assert!(!facts.add(&wreck(251, Validity::HULL)));
        facts.add(&Outputs { tick: 300, ..Outputs::default() });
        let page = alone(&about(), &facts);
        let told = "**CRASH at 1.00 s: hull on the ground. Nothing after it means anything.**";
        assert!(page.contains(told), "{page}");
        assert_eq!(
            facts.over().map(Ending::words).as_deref(),
            Some("CRASH at 1.00 s: hull on the ground")
        );
    }

    #[test]
    fn a_crash_ends_with_a_restart_and_the_next_one_is_another() {
        let mut facts = facts();
        facts.add(&wreck(250, Validity::HULL));
        assert!(facts.restart(500));
        assert_eq!(facts.over(), None);
        // Seen late, of before the restart.
        assert!(!facts.add(&wreck(500, Validity::HULL)));
        let page = alone(&about(), &facts);
        assert!(page.contains("Nothing until the restart at 2.00 s means"), "{page}");
        assert!(!page.contains("Nothing after it"), "{page}");
        // One that was not over.
        assert!(!facts.restart(600));
        assert!(facts.add(&wreck(750, Validity::HULL)));
        let page = alone(&about(), &facts);
        assert!(page.contains("at 1.00 s") && page.contains("Nothing after it means"), "{page}");
        facts.restart(800);
        facts.add(&wreck(900, Validity::HULL));
        let page = alone(&about(), &facts);
        assert!(page.contains("1 more before") && !page.contains("at 1.00 s"), "{page}");
    }

    #[test]
    fn a_flight_that_freezes_has_not_crashed() {
        let mut facts = facts();
        facts.add(&wreck(250, Validity::FROZEN));
        let page = alone(&about(), &facts);
        assert!(page.contains("**FROZEN at 1.00 s") && !page.contains("CRASH"), "{page}");
        assert!(facts.endings()[0].label().starts_with("FROZEN at 1.00 s"));
    }
}
