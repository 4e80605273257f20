//! `tiltrotor verify`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;
use engine::STEP_S;
use indicatif::{ProgressBar, ProgressStyle};
use replay::{Outcome, verify};

use crate::report;

/// Logs to be reflown.
#[derive(clap::Args)]
pub struct Args {
    /// The logs
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
}

/// Verifies every log; the worst outcome is the exit status.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut worst = 0;
    for log in &args.logs {
        worst = worst.max(verify_one(log));
    }
    Ok(ExitCode::from(worst))
}

/// Verifies a log, prints the verdict, and returns the exit status.
pub fn verify_one(log: &Path) -> u8 {
    let started = Instant::now();
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
        bar.set_style(style);
    }
    let verdict = verify(log, |ticks| {
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
            let flown_s = verdict.exact as f64 * STEP_S;
            say!("reflown in {took_s:.2} s, {:.0} times real time", flown_s / took_s);
            match verdict.outcome() {
                Outcome::Exact => 0,
                Outcome::Diverged => report::DIVERGED,
                Outcome::Damaged => report::UNUSABLE,
                Outcome::Incomplete => report::NEVER_CLOSED,
            }
        }
        Err(error) => {
            complain!("tiltrotor: {}: {error}", log.display());
            report::UNUSABLE
        }
    }
}
