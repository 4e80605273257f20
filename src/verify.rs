//! `tiltrotor verify`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use engine::STEP_S;
use indicatif::{ProgressBar, ProgressStyle};
use replay::{Options, Outcome, Verdict, verify};

use crate::report;

/// Logs to be reflown.
#[derive(clap::Args)]
pub struct Args {
    /// The logs
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    #[command(flatten)]
    how: How,
}

/// How each log is reflown.
#[derive(clap::Args)]
struct How {}

impl How {
    fn options(&self) -> Options {
        let Self {} = self;
        Options::default()
    }
}

/// Verifies every log; the worst outcome is the exit status.
pub fn run(args: &Args) -> Result<ExitCode> {
    let options = args.how.options();
    let mut worst = 0;
    for log in &args.logs {
        worst = worse(worst, verify_one(log, &options));
    }
    Ok(ExitCode::from(worst))
}

/// The exit status of an outcome.
fn status(outcome: Outcome) -> u8 {
    match outcome {
        Outcome::Exact => 0,
        Outcome::Diverged => report::DIVERGED,
        Outcome::Damaged => report::UNUSABLE,
        Outcome::Incomplete => report::NEVER_CLOSED,
    }
}

/// The graver of two statuses: unusable, then diverged, then never closed.
fn worse(a: u8, b: u8) -> u8 {
    let grave = |status| match status {
        0 => 0,
        report::NEVER_CLOSED => 1,
        report::DIVERGED => 2,
        _ => 3,
    };
    if grave(b) > grave(a) { b } else { a }
}

/// Verifies a log, prints the verdict, and returns the exit status.
pub fn verify_one(log: &Path, options: &Options) -> u8 {
    let started = Instant::now();
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
        bar.set_style(style);
    }
    let verdict = verify(log, options, |ticks| {
        if ticks.is_multiple_of(2500) {
            bar.set_message(format!("{}: {:.0} s reflown", log.display(), ticks as f64 * STEP_S));
            bar.tick();
        }
    });
    bar.finish_and_clear();
    match verdict {
        Ok(verdict) => {
            say!("{}: {verdict}", log.display());
            let took_s = started.elapsed().as_secs_f64();
            say!("reflown in {took_s:.2} s, {:.0} times real time", flown_s(&verdict) / took_s);
            status(verdict.outcome())
        }
        Err(error) => {
            complain!("tiltrotor: {}: {error}", log.display());
            report::UNUSABLE
        }
    }
}

/// Simulated time that was reflown, s.
fn flown_s(verdict: &Verdict) -> f64 {
    verdict.exact as f64 * STEP_S
}
