//! Does a log refly to the same bits?

use std::path::PathBuf;

use logs::LogError;
use pyo3::prelude::*;
use replay::{Judgement, Options, Outcome, ReplayError, Window, verify_while};

use crate::waiting::{wait, wanted_still};

/// What a log is.
#[pyclass(module = "tiltrotor._native", frozen, get_all, eq)]
#[derive(Clone, PartialEq)]
pub struct Verdict {
    outcome: String,
    words: String,
    report: String,
    first_bad_tick: Option<u64>,
    start_tick: Option<u64>,
    exact_tick: Option<u64>,
    last_tick: Option<u64>,
    diverged_tick: Option<u64>,
    field: Option<String>,
    end: Option<String>,
    digest: Option<String>,
}

type Parts = (
    String,
    String,
    String,
    Option<u64>,
    Option<u64>,
    Option<u64>,
    Option<u64>,
    Option<u64>,
    Option<String>,
    Option<String>,
    Option<String>,
);

impl Verdict {
    /// Of a log that is none, or of another version.
    pub fn unusable(why: String) -> Self {
        Self::of_judgement(&Judgement::unusable(why))
    }

    pub fn of_judgement(judgement: &Judgement) -> Self {
        Self {
            outcome: judgement.outcome.name().into(),
            words: judgement.words.clone(),
            report: judgement.words.clone(),
            first_bad_tick: judgement.first_bad_tick,
            start_tick: None,
            exact_tick: None,
            last_tick: None,
            diverged_tick: None,
            field: None,
            end: None,
            digest: None,
        }
    }
}

impl From<replay::Verdict> for Verdict {
    fn from(found: replay::Verdict) -> Self {
        let report = found.to_string();
        let replay::Verdict { judgement, facts, divergence, versions: _ } = found;
        Self {
            report,
            start_tick: Some(facts.start_tick),
            exact_tick: Some(facts.exact_tick()),
            last_tick: Some(facts.last_tick()),
            diverged_tick: facts.diverged,
            field: divergence.map(|divergence| divergence.path.clone()),
            end: Some(facts.end.name().into()),
            digest: Some(format!("{:016x}", facts.digest)),
            ..Self::of_judgement(&judgement)
        }
    }
}

#[pymethods]
impl Verdict {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "what pickle puts together again")]
    fn new(
        outcome: String,
        words: String,
        report: String,
        first_bad_tick: Option<u64>,
        start_tick: Option<u64>,
        exact_tick: Option<u64>,
        last_tick: Option<u64>,
        diverged_tick: Option<u64>,
        field: Option<String>,
        end: Option<String>,
        digest: Option<String>,
    ) -> Self {
        Self {
            outcome,
            words,
            report,
            first_bad_tick,
            start_tick,
            exact_tick,
            last_tick,
            diverged_tick,
            field,
            end,
            digest,
        }
    }

    /// The exit status of the command for a log like that.
    #[getter]
    fn status(&self) -> u8 {
        Outcome::from_name(&self.outcome).unwrap_or(Outcome::Unusable).status()
    }

    fn __bool__(&self) -> bool {
        self.outcome == Outcome::Exact.name()
    }

    fn __repr__(&self) -> String {
        format!("<tiltrotor.Verdict {}>", self.words)
    }

    fn __str__(&self) -> &str {
        &self.report
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, Parts) {
        let this = slf.get().clone();
        let parts = (
            this.outcome,
            this.words,
            this.report,
            this.first_bad_tick,
            this.start_tick,
            this.exact_tick,
            this.last_tick,
            this.diverged_tick,
            this.field,
            this.end,
            this.digest,
        );
        (slf.get_type().into_any(), parts)
    }
}

/// Reflies a log and compares every bit.
#[pyfunction]
#[pyo3(signature = (path, threads=None, from_tick=None, until_tick=None, across_versions=false))]
pub fn verify(
    py: Python<'_>,
    path: PathBuf,
    threads: Option<usize>,
    from_tick: Option<u64>,
    until_tick: Option<u64>,
    across_versions: bool,
) -> PyResult<Verdict> {
    let mut options = Options { across_versions, ..Options::default() };
    options.threads = threads.unwrap_or(options.threads);
    options.window = Window { from_tick, until_tick, clamped: false };
    let found = wait(py, move |stop| verify_while(&path, &options, |_| wanted_still(stop)))?;
    Ok(found.map_or_else(|error| Verdict::unusable(refusal(&error)), Verdict::from))
}

/// Why a log is not reflown, and what can be done about it.
fn refusal(error: &ReplayError) -> String {
    match error {
        ReplayError::Log(LogError::Version { what: "flight model", .. }) => {
            format!("{error}; across_versions=True flies it for comparison")
        }
        _ => error.to_string(),
    }
}
