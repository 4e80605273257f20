//! What a log is: decided in one place, from what was found while it was read.

use std::fmt;
use std::path::Path;

use engine::STEP_S;
use logs::text::at;
use logs::{Ending, FlightReader, Identity, LogError, Recovery, Tick};

use crate::outputs::OutputsDifference;
use crate::refly::{OPEN, Reflight, ReplayError, Window};
use crate::rewrite::parent;
use crate::ticks::Irregular;

/// What a log is, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Reflown to the same bits, and closed by its writer.
    Exact,
    /// Nothing is wrong with it as far as reading shows; nobody has reflown it.
    NotReflown,
    /// Sound as far as it goes, but it was never closed, or was recovered from such a log.
    NeverClosed,
    /// Bytes are damaged, or messages missing.
    Damaged,
    /// Something in it was changed after the flight.
    Altered,
    /// It does not refly to the same bits.
    Diverged,
    /// Its states refly to the same bits, but what was shown, sent and exported of them is not what is
    /// computed now.
    OutputsDiffer,
    /// Flown by another version than recorded, or not comparable in every field: never exact.
    Compared,
    /// No flight log, or one that cannot be flown.
    Unusable,
}

impl Outcome {
    /// Every one.
    pub const ALL: [Self; 9] = [
        Self::Exact,
        Self::NotReflown,
        Self::NeverClosed,
        Self::Damaged,
        Self::Altered,
        Self::Diverged,
        Self::OutputsDiffer,
        Self::Compared,
        Self::Unusable,
    ];

    /// As it stands in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::NotReflown => "not_reflown",
            Self::NeverClosed => "never_closed",
            Self::Damaged => "damaged",
            Self::Altered => "altered",
            Self::Diverged => "diverged",
            Self::OutputsDiffer => "outputs_differ",
            Self::Compared => "compared",
            Self::Unusable => "unusable",
        }
    }

    /// The one of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|outcome| outcome.name() == name)
    }

    /// The exit status with which a program ends that judged one log, as `docs/exit-statuses.md` has it.
    pub fn status(self) -> u8 {
        match self {
            Self::Exact | Self::NotReflown => 0,
            Self::Altered | Self::Diverged | Self::OutputsDiffer => 1,
            Self::Damaged | Self::Unusable => 2,
            Self::NeverClosed => 3,
            Self::Compared => 6,
        }
    }
}

/// What a log is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// In one word.
    pub outcome: Outcome,
    /// The first tick that is not as it should be, if there is one.
    pub first_bad_tick: Option<u64>,
    /// In a sentence, which begins with that word.
    pub words: String,
}

impl Judgement {
    /// Of what is no flight log, or cannot be flown.
    pub fn unusable(why: impl Into<String>) -> Self {
        Self { outcome: Outcome::Unusable, first_bad_tick: None, words: why.into() }
    }
}

impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words)
    }
}

/// How the reading of a log ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// As the log's writer closed it.
    Closed,
    /// Where the part ends that was asked for.
    Window,
    /// Without having been closed.
    NeverClosed,
    /// Where a broken log was recovered up to: from which, up to which tick, and why no further.
    Recovered(String),
    /// The file is damaged: how.
    Damaged(String),
    /// Messages do not make a flight: which, and why.
    Disorder(String),
}

impl End {
    /// As it stands in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Closed => "closed",
            Self::Window => "window",
            Self::NeverClosed => "never_closed",
            Self::Recovered(_) => "recovered",
            Self::Damaged(_) => "damaged",
            Self::Disorder(_) => "disorder",
        }
    }

    /// Whether the log could be read to its end.
    pub fn is_readable(&self) -> bool {
        !matches!(self, Self::Damaged(_) | Self::Disorder(_))
    }
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Closed => f.write_str("the log ends as its writer closed it"),
            Self::Window => f.write_str("there the part ends that was asked for"),
            Self::NeverClosed => f.write_str(
                "the log ends without having been closed: the flight was killed or the file was \
                 cut, and what came after is lost",
            ),
            Self::Recovered(words) | Self::Disorder(words) => f.write_str(words),
            Self::Damaged(why) => write!(f, "the file is damaged: {why}"),
        }
    }
}

/// What was found while a log was read, reflown or not.
#[derive(Clone, Debug)]
pub struct Facts {
    /// Whether it was reflown.
    pub reflown: bool,
    /// The log is compacted: of most ticks, only the digest was kept.
    pub compacted: bool,
    /// The tick that it begins with: ticks are counted from there.
    pub start_tick: u64,
    /// Ticks read.
    pub ticks: u64,
    /// Ticks, from the first on, whose reflown state is the recorded one to the bit.
    pub same: u64,
    /// Digest of the last tick read.
    pub digest: u64,
    /// First tick whose digest does not follow from what came before; the first of all when the files
    /// or the first state are not those that the flight was begun with.
    pub altered: Option<u64>,
    /// The first ticks that are missing, or are there twice.
    pub irregular: Option<Irregular>,
    /// How many ticks are missing.
    pub missing: u64,
    /// How many ticks are there once more.
    pub doubled: u64,
    /// First tick whose reflown state is not the recorded one.
    pub diverged: Option<u64>,
    /// The field of the state that shows it, where one does.
    pub diverged_field: Option<String>,
    /// Another version flew it than recorded it, so that no difference says anything of the log.
    pub comparison: bool,
    /// The first recorded outputs that are not those computed now.
    pub outputs: Option<OutputsDifference>,
    /// For a log that was recovered from a broken one: which, up to which tick, and why no further.
    pub recovered: Option<String>,
    /// For a log that was made from one that was not sound: from which, and what that one was.
    pub origin: Option<String>,
    /// How it ended.
    pub end: End,
}

impl Facts {
    /// Of a log that is about to be read.
    pub fn of_reading(reader: &FlightReader) -> Self {
        let start_tick = reader.initial.tick;
        Self {
            reflown: false,
            compacted: reader.is_compacted(),
            start_tick,
            ticks: 0,
            same: 0,
            digest: 0,
            altered: (!reader.intact).then_some(start_tick),
            irregular: None,
            missing: 0,
            doubled: 0,
            diverged: None,
            diverged_field: None,
            comparison: false,
            outputs: None,
            recovered: recovered(&reader.identity),
            origin: origin(&reader.identity),
            end: End::NeverClosed,
        }
    }

    /// Of a log as it was recorded, read from where it stands to its end: nothing is reflown.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(reader: &mut FlightReader, window: &Window) -> Result<Self, ReplayError> {
        let mut facts = Self::of_reading(reader);
        reader.states_as_bytes = true;
        reader.fly_states_only(0);
        let disorder = loop {
            match reader.next_tick() {
                Ok(Some(tick)) => facts.add(tick, None),
                Ok(None) => break None,
                Err(error) => break Some(disorder(error.into())?),
            }
            reader.forget();
        };
        facts.end(reader, disorder, window);
        Ok(facts)
    }

    /// Of a log that is about to be reflown.
    pub fn of_reflight(flight: &Reflight) -> Self {
        let start_tick = flight.state.tick;
        let altered = (!flight.reader.intact).then_some(start_tick);
        Self { reflown: true, start_tick, altered, ..Self::of_reading(&flight.reader) }
    }

    /// Adds a tick; `same` says whether the reflown state is the recorded one, where it was reflown.
    pub fn add(&mut self, recorded: &Tick, same: Option<bool>) {
        let expected = self.last_tick().saturating_add(1);
        let found = recorded.record.state.tick;
        self.ticks += 1;
        self.digest = recorded.record.digest;
        // A state that has another tick than its inputs was changed, and no tick is missing for it.
        let regular = found == expected || recorded.inputs.tick.saturating_add(1) != found;
        if !regular {
            self.irregular(expected, found);
        }
        let tick = self.last_tick();
        if !recorded.chained {
            self.altered.get_or_insert(tick);
        }
        match same {
            Some(true) if self.diverged.is_none() => self.same += 1,
            Some(false) => {
                self.diverged.get_or_insert(tick);
            }
            _ => {}
        }
    }

    /// Notes a tick that does not follow the one before.
    fn irregular(&mut self, expected: u64, found: u64) {
        let irregular = if found > expected {
            self.missing = self.missing.saturating_add(found - expected);
            Irregular::Missing { first: expected, last: found - 1 }
        } else {
            self.doubled += 1;
            Irregular::Doubled { tick: found }
        };
        self.irregular.get_or_insert(irregular);
        self.altered.get_or_insert(irregular.tick());
    }

    /// Notes how it ended: `disorder` is what stopped the reading, if anything did.
    pub fn end(&mut self, reader: &FlightReader, disorder: Option<String>, window: &Window) {
        self.outputs = self.outputs.take().or_else(|| OutputsDifference::of_compacted(reader));
        let windowed = window.until_tick.is_some_and(|until| self.last_tick() >= until);
        self.end = match (disorder, reader.ending(), &self.recovered) {
            (Some(disorder), ..) => End::Disorder(disorder),
            (None, Some(Ending::Damaged(why)), _) => End::Damaged(why.clone()),
            (None, Some(Ending::Closed), _) if windowed => End::Window,
            (None, Some(Ending::Closed), _) => End::Closed,
            (None, Some(Ending::Truncated) | None, Some(words)) => End::Recovered(words.clone()),
            (None, Some(Ending::Truncated) | None, None) => End::NeverClosed,
        };
    }

    /// Notes how a reflight ended: `disorder` is what stopped it, if anything did.
    pub fn end_of_reflight(
        &mut self,
        flight: &mut Reflight,
        disorder: Option<String>,
        window: &Window,
    ) {
        self.comparison = flight.versions().is_some_and(|versions| versions.comparison());
        self.outputs = flight.outputs_difference().cloned();
        self.end(&flight.reader, disorder, window);
    }

    /// The last tick read.
    pub fn last_tick(&self) -> u64 {
        let last = self.start_tick.saturating_add(self.ticks).saturating_add(self.missing);
        last.saturating_sub(self.doubled)
    }

    /// The last tick whose state is the recorded one, to the bit.
    pub fn same_tick(&self) -> u64 {
        self.start_tick.saturating_add(self.same)
    }

    /// The last tick that is proven: its state is the recorded one, and its digest follows.
    pub fn exact_tick(&self) -> u64 {
        let proven = |bad: u64| bad.saturating_sub(1).max(self.start_tick);
        let outputs = self.outputs.as_ref().and_then(|difference| difference.tick);
        let bad = [self.altered, outputs].into_iter().flatten().min();
        bad.map_or(u64::MAX, proven).min(self.same_tick())
    }

    /// Whether the state itself is not the one that led to the digest that was kept: of a compacted
    /// log nothing tells whether the program or the log has changed.
    pub fn differs_by_digest(&self) -> bool {
        self.compacted
            && self.irregular.is_none()
            && (self.altered == self.diverged || !self.reflown)
            && self.altered > Some(self.start_tick)
    }

    /// What the log is. Nowhere else is it decided.
    pub fn judge(&self) -> Judgement {
        let (outcome, first_bad_tick) = match (self.altered, self.diverged) {
            (Some(tick), _) if self.differs_by_digest() && !self.comparison => {
                (Outcome::Diverged, Some(tick))
            }
            // Whoever changed a log may have changed it so that it diverges before.
            (Some(tick), _) => (Outcome::Altered, Some(tick)),
            (None, Some(tick)) if !self.comparison => (Outcome::Diverged, Some(tick)),
            (None, _) if self.outputs.is_some() && !self.comparison => {
                let tick = self.outputs.as_ref().and_then(|difference| difference.tick);
                (Outcome::OutputsDiffer, tick)
            }
            (None, _) if !self.end.is_readable() => {
                (Outcome::Damaged, Some(self.last_tick().saturating_add(1)))
            }
            (None, _) if self.comparison => (Outcome::Compared, None),
            (None, _) => (self.sound(), None),
        };
        Judgement { outcome, first_bad_tick, words: self.words(outcome) }
    }

    /// What a log is with which nothing is wrong.
    fn sound(&self) -> Outcome {
        match (&self.end, self.reflown) {
            (End::NeverClosed | End::Recovered(_), _) => Outcome::NeverClosed,
            (_, true) => Outcome::Exact,
            (_, false) => Outcome::NotReflown,
        }
    }

    fn words(&self, outcome: Outcome) -> String {
        let all = format!("{} ticks ({:.1} s)", self.ticks, self.ticks as f64 * STEP_S);
        let from = match self.start_tick {
            0 => String::new(),
            tick => format!(" from {} on", at(tick)),
        };
        let digest = format!("digest {:016x}", self.digest);
        match outcome {
            Outcome::Exact => format!("exact: all {all}{from}, {digest}"),
            Outcome::NotReflown => {
                format!(
                    "not reflown: {all}{from}, each digest follows from what was before, {digest}"
                )
            }
            Outcome::NeverClosed => {
                let what = if self.reflown { "exact" } else { "read, not reflown" };
                let why = match &self.end {
                    End::Recovered(_) => "the log was recovered from a broken one",
                    _ => {
                        "the flight was killed or the file was cut; `tiltrotor log recover` makes a whole log of it"
                    }
                };
                format!("never closed: {all}{from} {what}; {why}")
            }
            Outcome::Damaged => format!("damaged after {}: {}", at(self.last_tick()), self.end),
            Outcome::Altered => self.altered_words(),
            Outcome::Diverged => self.diverged_words(),
            Outcome::OutputsDiffer => {
                let words = self.outputs.as_ref().map_or_else(String::new, ToString::to_string);
                format!("outputs differ {words}")
            }
            Outcome::Compared => "compared: the log is of another version".into(),
            // Not decided from facts: there are none.
            Outcome::Unusable => "unusable".into(),
        }
    }

    fn altered_words(&self) -> String {
        let tick = self.altered.unwrap_or(self.start_tick);
        let what = match self.irregular.filter(|irregular| irregular.tick() == tick) {
            Some(irregular) => irregular.to_string(),
            None if tick == self.start_tick => {
                "its aircraft, cockpit map, scenario or first state is not what it was flown with"
                    .into()
            }
            None => "the digest does not follow from what was before".into(),
        };
        format!("altered at {}: the log was changed after the flight, {what}", at(tick))
    }

    fn diverged_words(&self) -> String {
        let tick = self.diverged.or(self.altered).unwrap_or(self.start_tick);
        let what = match &self.diverged_field {
            _ if self.differs_by_digest() => {
                "the reflown state has not the digest that was kept: this program flies otherwise, or \
                 the log was changed after the flight"
                    .into()
            }
            Some(field) => format!("the reflown {field} is not the recorded one"),
            None => "the reflown state is not the recorded one".to_string(),
        };
        format!("diverged at {}: {what}", at(tick))
    }
}

/// What stops the reading of a log and is a fact of it: messages that do not make a flight.
///
/// # Errors
/// Every other error.
pub fn disorder(error: ReplayError) -> Result<String, ReplayError> {
    match error {
        ReplayError::Log(error @ (LogError::Order(_) | LogError::Decode(_))) => {
            Ok(error.to_string())
        }
        error => Err(error),
    }
}

/// What a log is as it was recorded, in the part that the window shows: nothing is reflown. Of one that
/// is none, or of another version, that is what is said of it.
pub fn judge(log: &Path, window: &Window) -> Judgement {
    let facts = || -> Result<Facts, ReplayError> {
        let mut reader = logs::open(log, OPEN)?;
        window.apply(&mut reader)?;
        Facts::read(&mut reader, window)
    };
    match facts() {
        Ok(facts) => facts.judge(),
        Err(error) => Judgement::unusable(format!("not judged: {error}")),
    }
}

/// What a log that was made from one that was not sound says of it.
fn origin(identity: &Identity) -> Option<String> {
    let judgement = identity.0.get(parent::JUDGEMENT)?;
    let (name, tick) = (identity.get(parent::NAME), identity.get(parent::FIRST_BAD_TICK));
    if let Some(digest) = identity.0.get(parent::BLESSED_FROM) {
        let words = format!("it was blessed: the flight of digest {digest} {judgement}");
        return Some(format!("{words}; first bad tick {tick}"));
    }
    Some(format!("it was made from {name}, whose first bad tick is {tick}: {judgement}"))
}

fn recovered(identity: &Identity) -> Option<String> {
    let parent = identity.0.get(Recovery::PARENT)?;
    let (tick, reason) = (identity.get(Recovery::TICK), identity.get(Recovery::REASON));
    Some(format!("it was recovered from {parent} up to tick {tick}, because {reason}"))
}

#[cfg(test)]
mod tests;
