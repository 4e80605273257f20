//! The book of cases: rows, verdicts, and what a row counts for.
//!
//! # How a row is written
//! A case has a class, and its rows have it too unless they say otherwise. A row is a number, and says
//! what stands against counting it as a prediction:
//! ```text
//! let mut case = Case::new(15, Class::A, "title", "source")
//!     .tolerance("why this wide")
//!     .set_up("what was assumed")
//!     .misses("why ours differs, as far as is known")
//!     .settled_by("which information would decide it");
//! case.row("power, kW", 1480.0, ours, Band::Part(0.08), 0);
//! case.row("pitch, deg", 1.11, ours, Band::Within(0.3), 2).class(Class::B);
//! case.row("C_T", 0.01, ours, Band::Part(0.03), 4).fitted(&[Fit::InducedPower]);
//! case.row("C_P", 0.01, ours, Band::Part(0.03), 4).twice("the figure of merit above");
//! book.add(case);
//! ```
//! - `.class(...)`: A, B, C as the page's head has them; `Theory` where the number is that of a closed
//!   form; `Own` where no source has the number and it is our own requirement.
//! - `.fitted(...)`: a parameter was chosen with this very number in view. A new fit is an entry of
//!   `fits.rs`, which the page lists.
//! - `.twice(...)`: another row holds the same published measurement, or the set-up forces the number;
//!   says which. Of two such rows only one is marked: the looser, or the derived one.
//!
//! A row with neither, of class A, B or C, is a prediction. `ours` is a number, a `Result` whose error
//! says why ours cannot fly it (a miss), or `Missing::NotYet`.
//!
//! A load near zero has `Band::PartOrForce`: so many per cent, or 10 lbf where that is more.

pub use engine::math::PI;
pub use engine::units::{
    DEG_PER_RAD as DEG, FOOT_M, INCH_M, KNOT_MPS, POUND_KG, POUND_N, RPM_RADPS,
};

use crate::fits::Fit;

/// A slug square foot, kg m².
pub const SLUG_FT2_KG_M2: f64 = POUND_N * FOOT_M;

/// The least tolerance of a force, lbf: less than .1 % of the weight.
pub const LEAST_FORCE_LBF: f64 = 10.0;

/// Nearer to a limit than this part of the band, a pass is one at the edge.
const EDGE: f64 = 0.05;

/// Where a published number comes from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Measured in flight, tunnel or on a stand.
    A,
    /// Output of the reference model or another simulation.
    B,
    /// Prediction of 1975, before the first flight.
    C,
    /// A closed form of the literature, worked out for this aircraft.
    Theory,
    /// No source: our own requirement.
    Own,
}

impl Class {
    /// All, in the order of the page.
    pub const ALL: [Self; 5] = [Self::A, Self::B, Self::C, Self::Theory, Self::Own];

    /// In the column.
    pub const fn name(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
            Self::C => "C",
            Self::Theory => "theory",
            Self::Own => "own",
        }
    }
}

/// What counts as agreement.
#[derive(Clone, Copy)]
pub enum Band {
    /// So much either way.
    Within(f64),
    /// Such a part of the published value either way.
    Part(f64),
    /// Such a part of a published force, in lbf, or `LEAST_FORCE_LBF` where that is more.
    PartOrForce(f64),
    /// From here to there.
    Between(f64, f64),
    /// No more than this.
    AtMost(f64),
    /// No less than this.
    AtLeast(f64),
}

/// Why there is no number of ours.
#[derive(Clone)]
pub enum Missing {
    /// The aircraft flew it, ours cannot: a miss.
    Cannot(String),
    /// Nobody has asked ours yet.
    #[allow(dead_code, reason = "every case of the plan has been asked; the next one may not")]
    NotYet(&'static str),
}

/// One number of a case.
pub struct Row {
    /// Which number.
    pub what: String,
    /// Where it comes from.
    pub class: Class,
    /// As published.
    pub published: f64,
    /// Ours, or why there is none.
    pub ours: Result<f64, Missing>,
    /// What counts as agreement.
    pub band: Band,
    /// Digits behind the point.
    pub digits: usize,
    /// What was fitted to it.
    pub fits: &'static [Fit],
    /// Where the same measurement is compared, too.
    pub twice: Option<&'static str>,
}

/// What a note to a case is about.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Topic {
    /// Why the tolerances are as wide as they are.
    Tolerance,
    /// Conditions, and what was assumed where the source is silent.
    SetUp,
    /// Why ours differs, as far as it is known.
    Misses,
    /// Which information would decide who is right. A measured number that is missed must have it.
    SettledBy,
}

impl Topic {
    /// In front of a note.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tolerance => "Tolerance",
            Self::SetUp => "Set-up",
            Self::Misses => "Why it misses",
            Self::SettledBy => "What would settle it",
        }
    }
}

/// One case of the validation plan.
pub struct Case {
    /// Its number in the plan.
    pub number: u64,
    /// Of its rows, unless they say otherwise.
    class: Class,
    /// What is compared.
    pub title: String,
    /// Where the published numbers come from.
    pub source: String,
    /// What is to be known about it, in the order of the page.
    pub notes: Vec<(Topic, String)>,
    /// The numbers.
    pub rows: Vec<Row>,
}

/// The book.
#[derive(Default)]
pub struct Book {
    /// In the order of the page.
    pub cases: Vec<Case>,
}

/// What became of a number.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Inside its tolerance.
    Pass,
    /// Inside, but hardly.
    Edge,
    /// Outside, or cannot be flown.
    Miss,
    /// Not asked.
    NotYet,
}

impl Verdict {
    /// Whether it is inside, edge included.
    pub fn is_pass(self) -> bool {
        matches!(self, Self::Pass | Self::Edge)
    }
}

impl Row {
    /// The row is of another class than its case.
    pub fn class(&mut self, class: Class) -> &mut Self {
        self.class = class;
        self
    }

    /// These were chosen with this number in view.
    pub fn fitted(&mut self, fits: &'static [Fit]) -> &mut Self {
        self.fits = fits;
        self
    }

    /// The same measurement stands there, too, or the set-up forces it.
    pub fn twice(&mut self, whereabouts: &'static str) -> &mut Self {
        self.twice = Some(whereabouts);
        self
    }

    /// Whether agreement would say something that nobody put in.
    pub fn is_prediction(&self) -> bool {
        matches!(self.class, Class::A | Class::B | Class::C)
            && self.fits.is_empty()
            && self.twice.is_none()
    }

    fn limits(&self) -> (f64, f64) {
        let around = |most: f64| (self.published - most, self.published + most);
        let size = self.published.abs();
        match self.band {
            Band::Within(most) => around(most),
            Band::Part(part) => around(part * size),
            Band::PartOrForce(part) => around(engine::math::max(part * size, LEAST_FORCE_LBF)),
            Band::Between(low, high) => (low, high),
            Band::AtMost(high) => (f64::NEG_INFINITY, high),
            Band::AtLeast(low) => (low, f64::INFINITY),
        }
    }

    /// How far an edge reaches inside.
    fn edge(&self) -> f64 {
        let (low, high) = self.limits();
        match self.band {
            Band::AtMost(limit) | Band::AtLeast(limit) => EDGE * limit.abs(),
            _ => EDGE * 0.5 * (high - low),
        }
    }

    /// What became of it.
    pub fn verdict(&self) -> Verdict {
        let (low, high) = self.limits();
        let edge = self.edge();
        match &self.ours {
            Ok(ours) if !(*ours >= low && *ours <= high) => Verdict::Miss,
            Ok(ours) if *ours < low + edge || *ours > high - edge => Verdict::Edge,
            Ok(_) => Verdict::Pass,
            Err(Missing::Cannot(_)) => Verdict::Miss,
            Err(Missing::NotYet(_)) => Verdict::NotYet,
        }
    }
}

impl Case {
    /// A case without rows.
    pub fn new(number: u64, class: Class, title: &str, source: &str) -> Self {
        Self {
            number,
            class,
            title: title.into(),
            source: source.into(),
            notes: Vec::new(),
            rows: Vec::new(),
        }
    }

    fn note(mut self, topic: Topic, text: impl Into<String>) -> Self {
        self.notes.push((topic, text.into()));
        self
    }

    /// Why the tolerances are as wide as they are.
    pub fn tolerance(self, text: impl Into<String>) -> Self {
        self.note(Topic::Tolerance, text)
    }

    /// Conditions, and what was assumed where the source is silent.
    pub fn set_up(self, text: impl Into<String>) -> Self {
        self.note(Topic::SetUp, text)
    }

    /// Why ours differs, as far as it is known.
    pub fn misses(self, text: impl Into<String>) -> Self {
        self.note(Topic::Misses, text)
    }

    /// Which information would decide who is right.
    pub fn settled_by(self, text: impl Into<String>) -> Self {
        self.note(Topic::SettledBy, text)
    }

    /// Which information would decide about its misses.
    ///
    /// # Panics
    /// If a measured number is missed and nothing is said of it.
    pub fn would_be_settled_by(&self) -> &str {
        let found = self.notes.iter().find(|(topic, _)| *topic == Topic::SettledBy);
        let Some((_, text)) = found else {
            panic!("case {} misses a measured number: say what would settle it", self.number)
        };
        text
    }

    /// The measured numbers that are missed.
    pub fn measured_misses(&self) -> impl Iterator<Item = &Row> {
        let is_missed = |row: &&Row| row.class == Class::A && row.verdict() == Verdict::Miss;
        self.rows.iter().filter(is_missed)
    }

    /// Adds a number; what stands against counting it is said of what comes back.
    pub fn row(
        &mut self,
        what: impl Into<String>,
        published: f64,
        ours: impl Into<Ours>,
        band: Band,
        digits: usize,
    ) -> &mut Row {
        let Ours(ours) = ours.into();
        let (what, class) = (what.into(), self.class);
        let row = Row { what, class, published, ours, band, digits, fits: &[], twice: None };
        self.rows.push(row);
        let last = self.rows.len() - 1;
        &mut self.rows[last]
    }
}

/// Our number, or why there is none.
pub struct Ours(Result<f64, Missing>);

impl From<f64> for Ours {
    fn from(value: f64) -> Self {
        Self(Ok(value))
    }
}

impl From<Result<f64, String>> for Ours {
    fn from(value: Result<f64, String>) -> Self {
        Self(value.map_err(Missing::Cannot))
    }
}

impl From<Missing> for Ours {
    fn from(none: Missing) -> Self {
        Self(Err(none))
    }
}

impl Book {
    /// Adds a case.
    pub fn add(&mut self, case: Case) {
        self.cases.push(case);
    }

    /// Every number of every case.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.cases.iter().flat_map(|case| &case.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(published: f64, ours: f64, band: Band) -> Verdict {
        let mut case = Case::new(0, Class::A, "", "");
        case.row("", published, ours, band, 0).verdict()
    }

    #[test]
    fn a_pass_in_the_last_twentieth_of_its_band_is_one_at_the_edge() {
        let stall = Band::Between(90.0, 105.0);
        assert!(verdict(97.5, 105.0, stall) == Verdict::Edge);
        assert!(verdict(97.5, 104.0, stall) == Verdict::Pass);
        assert!(verdict(97.5, 105.1, stall) == Verdict::Miss);
        assert!(verdict(3.0, 2.9, Band::AtMost(3.0)) == Verdict::Edge);
        assert!(verdict(0.0, 0.0, Band::Within(0.0)) == Verdict::Pass);
    }

    #[test]
    fn a_force_near_zero_may_be_ten_pounds_off_and_a_large_one_five_per_cent() {
        let band = Band::PartOrForce(0.05);
        assert!(verdict(-24.6, -34.0, band).is_pass());
        assert!(verdict(-24.6, -35.0, band) == Verdict::Miss);
        assert!(verdict(6000.0, 6200.0, band).is_pass());
        assert!(verdict(6000.0, 6301.0, band) == Verdict::Miss);
    }

    #[test]
    fn what_was_fitted_checked_twice_or_ours_is_no_prediction() {
        let counts = |mark: fn(&mut Row)| {
            let mut case = Case::new(0, Class::A, "", "");
            let row = case.row("", 1.0, 1.0, Band::Part(0.1), 0);
            mark(row);
            row.is_prediction()
        };
        assert!(counts(|_| ()));
        assert!(counts(|row| _ = row.class(Class::C)));
        assert!(!counts(|row| _ = row.class(Class::Own)));
        assert!(!counts(|row| _ = row.fitted(&[Fit::Scas])));
        assert!(!counts(|row| _ = row.twice("above")));
    }
}
