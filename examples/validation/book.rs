//! The book of cases: rows, verdicts, and the page they make.

use std::fmt::Write as _;

pub use engine::math::PI;
pub use engine::units::{
    DEG_PER_RAD as DEG, FOOT_M, INCH_M, KNOT_MPS, POUND_KG, POUND_N, RPM_RADPS,
};

/// A slug square foot, kg m².
pub const SLUG_FT2_KG_M2: f64 = POUND_N * FOOT_M;

/// What counts as agreement.
#[derive(Clone, Copy)]
pub enum Band {
    /// So much either way.
    Within(f64),
    /// Such a part of the published value either way.
    Part(f64),
    /// From here to there.
    Between(f64, f64),
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
    /// As published.
    pub published: f64,
    /// Ours, or why there is none.
    pub ours: Result<f64, Missing>,
    /// What counts as agreement.
    pub band: Band,
    /// Digits behind the point.
    pub digits: usize,
}

/// One case of the validation plan.
pub struct Case {
    /// Its number in the plan.
    pub number: u64,
    /// What is compared.
    pub title: String,
    /// Where the published numbers come from, and their class.
    pub source: String,
    /// Why the tolerances are what they are, and how the case was set up.
    pub why: String,
    /// Unit of the numbers, where all have the same; otherwise in the rows.
    pub rows: Vec<Row>,
}

/// The book.
#[derive(Default)]
pub struct Book {
    cases: Vec<Case>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Pass,
    Miss,
    NotYet,
}

impl Row {
    fn limits(&self) -> (f64, f64) {
        let around = |most: f64| (self.published - most, self.published + most);
        match self.band {
            Band::Within(most) => around(most),
            Band::Part(part) => around(part * self.published.abs()),
            Band::Between(low, high) => (low, high),
        }
    }

    fn verdict(&self) -> Verdict {
        let (low, high) = self.limits();
        match &self.ours {
            Ok(ours) if *ours >= low && *ours <= high => Verdict::Pass,
            Ok(_) => Verdict::Miss,
            Err(Missing::Cannot(_)) => Verdict::Miss,
            Err(Missing::NotYet(_)) => Verdict::NotYet,
        }
    }

    fn tolerance(&self) -> String {
        let digits = self.digits;
        match self.band {
            Band::Within(most) => format!("±{most}"),
            Band::Part(part) => format!("±{:.0} %", 100.0 * part),
            Band::Between(low, high) => format!("{low:.digits$} to {high:.digits$}"),
        }
    }

    fn line(&self) -> String {
        let digits = self.digits;
        let (ours, difference) = match &self.ours {
            Ok(ours) => (
                number(*ours, digits),
                format!("{:+.digits$}", zeroed(ours - self.published, digits)),
            ),
            Err(Missing::Cannot(why)) => (why.clone(), String::new()),
            Err(Missing::NotYet(why)) => ((*why).to_owned(), String::new()),
        };
        let verdict = match self.verdict() {
            Verdict::Pass => "pass",
            Verdict::Miss => "**MISS**",
            Verdict::NotYet => "not yet",
        };
        format!(
            "| {} | {} | {ours} | {difference} | {} | {verdict} |\n",
            self.what,
            number(self.published, digits),
            self.tolerance()
        )
    }
}

/// What rounds to nothing is nothing, with no sign.
fn zeroed(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.digits$}");
    if text.trim_start_matches(['-', '0', '.']).is_empty() { 0.0 } else { value }
}

fn number(value: f64, digits: usize) -> String {
    format!("{:.digits$}", zeroed(value, digits))
}

impl Case {
    /// A case without rows.
    pub fn new(number: u64, title: &str, source: &str, why: &str) -> Self {
        Self {
            number,
            title: title.into(),
            source: source.into(),
            why: why.into(),
            rows: Vec::new(),
        }
    }

    /// Adds a number.
    pub fn row(
        &mut self,
        what: impl Into<String>,
        published: f64,
        ours: impl Into<Ours>,
        band: Band,
        digits: usize,
    ) {
        let Ours(ours) = ours.into();
        self.rows.push(Row { what: what.into(), published, ours, band, digits });
    }

    fn count(&self, verdict: Verdict) -> usize {
        self.rows.iter().filter(|row| row.verdict() == verdict).count()
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

const HEAD: &str = "\
# Validation

Written by `cargo run --release --no-default-features --example validation`; do not edit. A test fails
when the page is not what the model does now, so every change of the model shows here what it moved.

Classes: **A** measured in flight, tunnel or on a stand; **B** output of the reference model (GTRS) or
another simulation; **C** prediction of 1975, before the first flight. A is what counts; B says whether
our blocks do what the reference's do, and where B disagrees with A, nobody can agree with both; C is
sanity only. A number outside its tolerance is a MISS and stays one until the model, not the
tolerance, changes; a flight that ours cannot fly is a MISS too. *Not yet*: nobody has asked the model.

Speeds are true, at sea level on a standard day, gross weight 13,000 lb, unless a case says otherwise.
Stick is in inches from the aft stop, neutral at 4.8. Power is that of both rotors.
";

const FOOT: &str = "
## What was fitted
The rotor's induced factor is an estimate fitted to the isolated rotor of case 1, what hover costs beyond it is
the ratio of the tests of cases 2 and 1, the engine's fuel flow is fitted to two points of case 5, and the
flap's lift and drag to the reference model's wing tables: agreement there is calibration, not proof.

## Compared elsewhere
Tests whose names begin with `val_` compare with a report too: the standard atmosphere with ISO 2533
(`engine::environment`), figure of merit, thrust slope and download (`aircraft`).
";

impl Book {
    /// Adds a case.
    pub fn add(&mut self, case: Case) {
        self.cases.push(case);
    }

    /// The page.
    pub fn text(&self) -> String {
        let mut page = String::from(HEAD);
        let total = |verdict| self.cases.iter().map(|case| case.count(verdict)).sum::<usize>();
        let _ = writeln!(
            page,
            "\n## Summary\n{} numbers pass, {} miss, {} not yet.\n",
            total(Verdict::Pass),
            total(Verdict::Miss),
            total(Verdict::NotYet)
        );
        page += "| case | what | pass | miss | not yet |\n|---|---|---|---|---|\n";
        for case in &self.cases {
            let _ = writeln!(
                page,
                "| {} | {} | {} | {} | {} |",
                case.number,
                case.title,
                case.count(Verdict::Pass),
                case.count(Verdict::Miss),
                case.count(Verdict::NotYet)
            );
        }
        page += "\n![pitch](docs/trim_pitch.svg) ![stick](docs/trim_stick.svg)\n\
                 ![power](docs/trim_power.svg) ![hover response](docs/response_hover.svg)\n";
        for case in &self.cases {
            let _ = writeln!(page, "\n## Case {}: {}\n{}\n", case.number, case.title, case.source);
            let _ = writeln!(page, "{}\n", case.why);
            page += "| number | published | ours | difference | tolerance | verdict |\n";
            page += "|---|---|---|---|---|---|\n";
            for row in &case.rows {
                page += &row.line();
            }
        }
        page + FOOT
    }
}
