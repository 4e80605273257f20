//! The page that a book makes.

use std::fmt::Write as _;

use crate::book::{Band, Book, Case, Class, LEAST_FORCE_LBF, Missing, Row, Verdict};
use crate::fits::Fit;

const HEAD: &str = "\
# Validation

Written by `cargo run --release --no-default-features --example validation`; do not edit. A test fails
when the page is not what the model does now, so every change of the model shows here what it moved.

Classes: **A** measured in flight, tunnel or on a stand; **B** output of the reference model (GTRS) or
another simulation; **C** prediction of 1975, before the first flight; **theory**, a closed form worked
out for this aircraft; **own**, no source: a requirement of ours. A is what counts. B says whether our
blocks do what those of the reference do; where B disagrees with A, no model can agree with both. C only
shows that a number is plausible. A number outside its tolerance is a MISS and stays one until the model,
not the tolerance, changes; a condition that our model cannot fly is a MISS too. *Not yet*: the model was
not computed there. A number that passes within the last twentieth of its band passes *at the edge*.

A **prediction** is a number of class A, B or C that nobody put in: no parameter was chosen with it in
view (then it is *fitted to*), no other row is the same measurement, and the set-up of the case does not
force it (then it is *checked twice*). Only predictions say how far to trust the model. Each point of a
curve counts as a number, and so do gain and phase at one frequency.

Speeds are true, at sea level on a standard day, gross weight 13,000 lb, unless a case says otherwise.
Stick is in inches from the aft stop, neutral at 4.8. Power is that of both rotors. There is no case 18.
";

const FOOT: &str = "
## Compared elsewhere
Tests whose names begin with `val_` compare with a report too: the standard atmosphere with ISO 2533
(`engine::environment`), figure of merit, thrust slope and download (`aircraft`).
";

/// What rounds to nothing is nothing, with no sign.
fn zeroed(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.digits$}");
    if text.trim_start_matches(['-', '0', '.']).is_empty() { 0.0 } else { value }
}

fn number(value: f64, digits: usize) -> String {
    format!("{:.digits$}", zeroed(value, digits))
}

fn tolerance(row: &Row) -> String {
    let digits = row.digits;
    match row.band {
        Band::Within(most) => format!("±{most}"),
        Band::Part(part) => format!("±{:.0} %", 100.0 * part),
        Band::PartOrForce(part) if part * row.published.abs() < LEAST_FORCE_LBF => {
            format!("±{LEAST_FORCE_LBF:.0} lbf")
        }
        Band::PartOrForce(part) => format!("±{:.0} %", 100.0 * part),
        Band::Between(low, high) => format!("{low:.digits$} to {high:.digits$}"),
        Band::AtMost(high) => format!("≤ {high:.digits$}"),
        Band::AtLeast(low) => format!("≥ {low:.digits$}"),
    }
}

fn line(row: &Row) -> String {
    let digits = row.digits;
    let (ours, difference) = match &row.ours {
        Ok(ours) => {
            (number(*ours, digits), format!("{:+.digits$}", zeroed(ours - row.published, digits)))
        }
        Err(Missing::Cannot(why)) => (why.clone(), String::new()),
        Err(Missing::NotYet(why)) => ((*why).to_owned(), String::new()),
    };
    let verdict = match row.verdict() {
        Verdict::Pass => "pass",
        Verdict::Edge => "pass, at the edge",
        Verdict::Miss => "**MISS**",
        Verdict::NotYet => "not yet",
    };
    let fits: Vec<&str> = row.fits.iter().map(|fit| fit.name()).collect();
    format!(
        "| {} | {} | {} | {ours} | {difference} | {} | {verdict} | {} | {} | {} |\n",
        row.what,
        row.class.name(),
        number(row.published, digits),
        tolerance(row),
        if row.is_prediction() { "yes" } else { "" },
        fits.join(", "),
        row.twice.unwrap_or_default(),
    )
}

/// So many, inside, at the edge of it.
#[derive(Default)]
struct Count {
    all: usize,
    inside: usize,
    edge: usize,
    missed: usize,
    not_yet: usize,
}

impl Count {
    fn of<'a>(rows: impl Iterator<Item = &'a Row>) -> Self {
        let mut count = Self::default();
        for row in rows {
            let verdict = row.verdict();
            count.all += 1;
            count.inside += usize::from(verdict.is_pass());
            count.edge += usize::from(verdict == Verdict::Edge);
            count.missed += usize::from(verdict == Verdict::Miss);
            count.not_yet += usize::from(verdict == Verdict::NotYet);
        }
        count
    }

    /// Inside of all, and per cent.
    fn share(&self) -> String {
        match self.all {
            0 => String::new(),
            all => {
                let percent = 100.0 * self.inside as f64 / all as f64;
                format!("{} of {all}, {percent:.0} %", self.inside)
            }
        }
    }
}

fn summary(book: &Book) -> String {
    let all = Count::of(book.rows());
    let foreseen = Count::of(book.rows().filter(|row| row.is_prediction()));
    let measured =
        Count::of(book.rows().filter(|row| row.is_prediction() && row.class == Class::A));
    let mut text = format!(
        "\n## Summary\nOf the predictions, {} are inside; of those that were measured (class A), {}. Of all \
         numbers {} pass ({} of them at the edge), {} miss, {} not yet.\n\n",
        foreseen.share(),
        measured.share(),
        all.inside,
        all.edge,
        all.missed,
        all.not_yet
    );
    text += "| class | all numbers inside | predictions inside | fitted to, inside | checked twice, inside |\n";
    text += "|---|---|---|---|---|\n";
    for class in Class::ALL {
        let rows = || book.rows().filter(move |row| row.class == class);
        if rows().next().is_none() {
            continue;
        }
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} |",
            class.name(),
            Count::of(rows()).share(),
            Count::of(rows().filter(|row| row.is_prediction())).share(),
            Count::of(rows().filter(|row| !row.fits.is_empty())).share(),
            Count::of(rows().filter(|row| row.fits.is_empty() && row.twice.is_some())).share(),
        );
    }
    text += "\nWhat is fitted *and* checked twice stands under fitted.\n\n";
    text +=
        "| case | what | pass | miss | not yet | predictions inside |\n|---|---|---|---|---|---|\n";
    for case in &book.cases {
        let count = Count::of(case.rows.iter());
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            case.number,
            case.title,
            count.inside,
            count.missed,
            count.not_yet,
            Count::of(case.rows.iter().filter(|row| row.is_prediction())).share(),
        );
    }
    text
}

fn table(case: &Case) -> String {
    let mut text =
        format!("\n## Case {}: {}\n- **Source.** {}\n", case.number, case.title, case.source);
    for (topic, note) in &case.notes {
        let _ = writeln!(text, "- **{}.** {note}", topic.name());
    }
    text.push('\n');
    text += "| number | class | published | ours | difference | tolerance | verdict | prediction | fitted to \
             | checked twice |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for row in &case.rows {
        text += &line(row);
    }
    text
}

/// The measured numbers that are missed, case by case, and what would decide about them.
fn unsettled(book: &Book) -> String {
    let mut text = String::from(
        "\n## Measured numbers that are missed\nOf class A, repeats of a measurement included.\n\n| case | missed | of them predictions | what would settle it |\n|---|---|---|---|\n",
    );
    for case in &book.cases {
        let missed = case.measured_misses().count();
        let predictions = case.measured_misses().filter(|row| row.is_prediction()).count();
        if missed > 0 {
            let settled = case.would_be_settled_by();
            let _ = writeln!(text, "| {} | {missed} | {predictions} | {settled} |", case.number);
        }
    }
    text
}

fn fitted(book: &Book) -> String {
    let mut text = String::from(
        "\n## What was fitted\nAgreement with what a parameter was fitted to is calibration, not proof.\n\n\
         | fit | what, and to what | numbers |\n|---|---|---|\n",
    );
    for fit in Fit::ALL {
        let rows = || book.rows().filter(move |row| row.fits.contains(&fit));
        let cases: Vec<String> = book
            .cases
            .iter()
            .filter(|case| case.rows.iter().any(|row| row.fits.contains(&fit)))
            .map(|case| case.number.to_string())
            .collect();
        let numbers = match rows().count() {
            0 => "none on this page".to_owned(),
            count => format!("{count}, case {}", cases.join(", ")),
        };
        let _ = writeln!(text, "| {} | {} | {numbers} |", fit.name(), fit.story());
    }
    text
}

/// The page of a book.
pub fn page(book: &Book) -> String {
    let mut page = String::from(HEAD);
    page += &summary(book);
    page += "\n![pitch](docs/trim_pitch.svg) ![stick](docs/trim_stick.svg)\n\
             ![power](docs/trim_power.svg) ![hover response](docs/response_hover.svg)\n";
    page += &unsettled(book);
    for case in &book.cases {
        page += &table(case);
    }
    page + &fitted(book) + FOOT
}
