//! The report of `verify` for programs.

use anyhow::{Context, Result};
use engine::STEP_S;
use logs::evolution::Difference;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use replay::{Verdict, Versions};
use serde_json::{Value, json};

use super::{Run, Verified};
use crate::json;

/// As `docs/reports.md` has it. Names are added with time, but not taken away or given another sense
/// under the same version.
pub fn json(run: &Run) -> Value {
    json!({
        "report": "tiltrotor verify",
        "version": 1,
        "status": run.status(),
        "jobs": run.jobs,
        "shard": run.shard.map(|shard| shard.to_string()),
        "took_s": run.took.as_secs_f64(),
        "flown_s": run.flown_s(),
        "count": {
            "logs": run.logs.len(),
            "exact": run.count("exact"),
            "diverged": run.count("diverged"),
            "incomplete": run.count("incomplete"),
            "compared": run.count("compared"),
            "damaged": run.count("damaged"),
            "unusable": run.count("unusable"),
        },
        "logs": run.logs.iter().map(log).collect::<Vec<_>>(),
    })
}

fn log(verified: &Verified) -> Value {
    let mut about = json!({
        "log": verified.log.display().to_string(),
        "outcome": verified.outcome(),
        "status": verified.status(),
        "took_s": verified.took.as_secs_f64(),
        "error": verified.verdict.as_ref().err(),
    });
    if let (Ok(verdict), Some(about)) = (&verified.verdict, about.as_object_mut()) {
        about.extend(json_of(verdict).as_object().cloned().unwrap_or_default());
    }
    about
}

fn json_of(verdict: &Verdict) -> Value {
    let (reason, words) = verdict.stopped();
    json!({
        "start_tick": verdict.start_tick,
        "exact_tick": verdict.exact_tick(),
        "exact_s": verdict.exact_tick() as f64 * STEP_S,
        "last_tick": verdict.last_tick(),
        "stopped": { "reason": reason, "words": words },
        "altered_tick": verdict.altered,
        "digest": format!("{:016x}", verdict.digest),
        "divergence": verdict.divergence.as_deref().map(json::divergence),
        "versions": verdict.versions.as_deref().map(versions),
    })
}

fn versions(versions: &Versions) -> Value {
    let channel = |(topic, difference): &(&str, Difference)| json!({ "channel": topic, "missing": difference.missing, "ignored": difference.ignored });
    json!({
        "recorded_model": versions.recorded_model,
        "model": versions.model,
        "comparison": versions.comparison(),
        "channels": versions.differences.iter().map(channel).collect::<Vec<_>>(),
        "notes": versions.notes,
    })
}

/// As most CI servers read it: a log is a test case. What is not the same is a failure, what cannot
/// be used is an error.
pub fn junit(run: &Run) -> Result<String> {
    let mut suite = TestSuite::new("tiltrotor verify");
    suite.set_time(run.took);
    for verified in &run.logs {
        let name = verified.log.display().to_string();
        let mut case = TestCase::new(name, status(verified));
        case.set_classname("tiltrotor.verify").set_time(verified.took);
        suite.add_test_case(case);
    }
    let mut report = Report::new("tiltrotor verify");
    report.set_time(run.took).add_test_suite(suite);
    report.to_string().context("cannot write the report")
}

fn status(verified: &Verified) -> TestCaseStatus {
    let (kind, words) = match (&verified.verdict, verified.outcome()) {
        (Ok(_), "exact") => return TestCaseStatus::success(),
        (Ok(verdict), "damaged") => (NonSuccessKind::Error, verdict.to_string()),
        (Ok(verdict), _) => (NonSuccessKind::Failure, verdict.to_string()),
        (Err(error), _) => (NonSuccessKind::Error, error.clone()),
    };
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(verified.outcome());
    status.set_message(words.lines().next().unwrap_or_default());
    status.set_description(words.as_str());
    status
}
