//! What was verified, and what is said of it.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Result;
use engine::STEP_S;
use replay::{Judgement, Options, Outcome, Verdict, verify};

use super::corpus::Shard;
use crate::report;
use crate::status::Status;
use crate::window::WindowArgs;

/// How each log is reflown.
#[derive(clap::Args)]
pub struct How {
    #[command(flatten)]
    pub window: WindowArgs,
    /// Instead of verifying, say what moved since each log was flown, by how much and when; exit 1 when
    /// something did
    #[arg(long, conflicts_with_all = ["from", "until", "around", "shard"])]
    pub moved: bool,
    /// Like --moved, and put today's flight in the place of each log that moved: after a deliberate change of
    /// the model, for golden flights
    #[arg(long, conflicts_with_all = ["from", "until", "around", "shard"])]
    pub bless: bool,
    /// Fly them with this aircraft file instead of their own
    #[arg(long, value_name = "FILE")]
    pub aircraft: Option<PathBuf>,
    /// Fly logs of other versions of the flight model too, as a comparison: exit 6, never 0
    #[arg(long, conflicts_with_all = ["from", "until", "around"])]
    pub across_versions: bool,
}

impl How {
    fn options(&self, log: &Path, threads: usize) -> Result<Options> {
        let (window, across_versions) = (self.window.of(log)?, self.across_versions);
        Ok(Options { window, across_versions, threads, ..Options::default() })
    }
}

/// What became of one log.
pub struct Verified {
    pub log: PathBuf,
    /// The verdict; of what cannot be reflown, why not.
    pub verdict: Result<Verdict, Judgement>,
    pub took: Duration,
}

impl Verified {
    pub fn new(log: &Path, how: Option<&How>, threads: usize, progress: impl FnMut(u64)) -> Self {
        let started = Instant::now();
        let whole = Options { threads, ..Options::default() };
        let options = how.map_or(Ok(whole), |how| how.options(log, threads));
        let verdict = options.map_err(|error| format!("{error:#}")).and_then(|options| {
            verify(log, &options, progress).map_err(|error| report::refusal(&error))
        });
        let verdict = verdict.map_err(Judgement::unusable);
        Self { log: log.into(), verdict, took: started.elapsed() }
    }

    /// What the log is.
    pub fn judgement(&self) -> &Judgement {
        match &self.verdict {
            Ok(verdict) => &verdict.judgement,
            Err(judgement) => judgement,
        }
    }

    /// The exit status it alone would give.
    pub fn status(&self) -> Status {
        self.judgement().into()
    }

    /// Simulated time that was reflown, s.
    pub fn flown_s(&self) -> f64 {
        self.verdict.as_ref().map_or(0.0, |verdict| verdict.facts.same as f64 * STEP_S)
    }

    pub fn say(&self) {
        match &self.verdict {
            Ok(verdict) => {
                say!("{}: {verdict}", self.log.display());
                let (flown_s, took_s) = (self.flown_s(), self.took.as_secs_f64());
                say!("reflown in {took_s:.2} s, {:.0} times real time", flown_s / took_s);
            }
            Err(unusable) => complain!("tiltrotor: {}: {unusable}", self.log.display()),
        }
    }
}

/// Everything that was verified.
pub struct Run {
    pub logs: Vec<Verified>,
    pub jobs: usize,
    pub shard: Option<Shard>,
    pub took: Duration,
}

impl Run {
    /// The gravest of all.
    pub fn status(&self) -> Status {
        Status::gravest(self.logs.iter().map(Verified::status))
    }

    pub fn count(&self, outcome: Outcome) -> usize {
        self.logs.iter().filter(|log| log.judgement().outcome == outcome).count()
    }

    pub fn flown_s(&self) -> f64 {
        self.logs.iter().map(Verified::flown_s).sum()
    }

    pub fn say_sum(&self) {
        let counts: Vec<_> = Outcome::ALL
            .into_iter()
            .map(|outcome| (self.count(outcome), outcome.name().replace('_', " ")))
            .filter(|(count, _)| *count > 0)
            .map(|(count, outcome)| format!("{count} {outcome}"))
            .collect();
        let (flown_s, took_s) = (self.flown_s(), self.took.as_secs_f64());
        say!(
            "{} logs{}: {}; {flown_s:.1} s reflown in {took_s:.2} s by {} jobs, {:.0} times real time",
            self.logs.len(),
            self.shard.map_or_else(String::new, |shard| format!(" of shard {shard}")),
            counts.join(", "),
            self.jobs,
            flown_s / took_s
        );
    }
}
