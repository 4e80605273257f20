//! The report of `verify` for programs: JSON and JUnit.

use anyhow::{Context, Result};
use engine::STEP_S;
use logs::evolution::Difference;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use replay::{Outcome, Verdict, Versions};
use serde_json::{Value, json};

use super::run::{Run, Verified};
use crate::json;
use crate::status::Status;

/// As `docs/reports.md` has it. Names are added with time, but not taken away or given another sense
/// under the same version.
pub fn json(run: &Run) -> Value {
    let mut count = serde_json::Map::from_iter([("logs".into(), json!(run.logs.len()))]);
    count.extend(Outcome::ALL.map(|outcome| (outcome.name().into(), json!(run.count(outcome)))));
    json!({
        "report": "tiltrotor verify",
        "version": 2,
        "status": run.status().number(),
        "jobs": run.jobs,
        "shard": run.shard.map(|shard| shard.to_string()),
        "took_s": run.took.as_secs_f64(),
        "flown_s": run.flown_s(),
        "count": count,
        "logs": run.logs.iter().map(log).collect::<Vec<_>>(),
    })
}

fn log(verified: &Verified) -> Value {
    let mut about = json!({
        "log": verified.log.display().to_string(),
        "took_s": verified.took.as_secs_f64(),
    });
    if let Some(about) = about.as_object_mut() {
        let found = verified.verdict.as_ref().map(found).unwrap_or_default();
        for more in [json::judgement(verified.judgement()), found] {
            about.extend(more.as_object().cloned().unwrap_or_default());
        }
    }
    about
}

fn found(verdict: &Verdict) -> Value {
    let Verdict { facts, divergence, versions, judgement: _ } = verdict;
    json!({
        "start_tick": facts.start_tick,
        "exact_tick": facts.exact_tick(),
        "exact_s": facts.exact_tick() as f64 * STEP_S,
        "same_tick": facts.same_tick(),
        "last_tick": facts.last_tick(),
        "end": json::end(&facts.end),
        "altered_tick": facts.altered,
        "ticks_missing": facts.missing,
        "ticks_doubled": facts.doubled,
        "outputs": facts.outputs.as_ref().map(|outputs| json!({
            "tick": outputs.tick,
            "field": outputs.field,
            "words": outputs.to_string(),
        })),
        "origin": facts.origin,
        "diverged_tick": facts.diverged,
        "digest": format!("{:016x}", facts.digest),
        "divergence": divergence.as_deref().map(json::divergence),
        "versions": versions.as_deref().map(json_of_versions),
    })
}

fn json_of_versions(versions: &Versions) -> Value {
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
    let kind = match verified.status() {
        Status::Done => return TestCaseStatus::success(),
        Status::Unusable => NonSuccessKind::Error,
        _ => NonSuccessKind::Failure,
    };
    let judgement = verified.judgement();
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(judgement.outcome.name());
    status.set_message(judgement.words.as_str());
    let text = verified.verdict.as_ref().map_or_else(ToString::to_string, ToString::to_string);
    status.set_description(text);
    status
}
