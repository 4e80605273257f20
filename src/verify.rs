//! `tiltrotor verify`: many logs on many threads, one report.

mod corpus;
mod forms;
mod recordings;

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Result;
use engine::STEP_S;
use indicatif::{ProgressBar, ProgressStyle};
use replay::{Options, Outcome, Verdict, verify};

use crate::report;
use corpus::Shard;

/// Logs to be reflown.
#[derive(clap::Args)]
pub struct Args {
    /// The logs; a folder stands for every *.mcap in it and below
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Logs at a time [default: one a processor]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Only every N-th log of the sorted list, from the I-th on: 1/N to N/N together are all
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// How to report
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Save a recording for the viewer of every log that diverged: recorded, reflown, difference
    #[arg(long, value_name = "FOLDER")]
    rrd: Option<PathBuf>,
    #[command(flatten)]
    how: How,
}

/// How each log is reflown.
#[derive(clap::Args)]
struct How {
    /// Fly logs of other versions of the flight model too, as a comparison: exit 6, never 0
    #[arg(long)]
    across_versions: bool,
}

impl How {
    fn options(&self) -> Options {
        Options { across_versions: self.across_versions, ..Options::default() }
    }
}

/// Form of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// For people
    Text,
    /// For programs: docs/reports.md
    Json,
    /// For CI servers: JUnit's XML
    Junit,
}

/// What became of one log.
struct Verified {
    log: PathBuf,
    /// The verdict, or why there is none.
    verdict: Result<Verdict, String>,
    took: Duration,
}

impl Verified {
    fn new(log: &Path, options: &Options, progress: impl FnMut(u64)) -> Self {
        let started = Instant::now();
        let verdict = verify(log, options, progress).map_err(|error| report::refusal(&error));
        Self { log: log.into(), verdict, took: started.elapsed() }
    }

    /// The exit status it alone would give.
    fn status(&self) -> u8 {
        match self.verdict.as_ref().map(Verdict::outcome) {
            Ok(Outcome::Exact) => 0,
            Ok(Outcome::Diverged) => report::DIVERGED,
            Ok(Outcome::Damaged) | Err(_) => report::UNUSABLE,
            Ok(Outcome::Incomplete) => report::NEVER_CLOSED,
            Ok(Outcome::Compared) => report::COMPARED,
        }
    }

    /// In one word.
    fn outcome(&self) -> &'static str {
        self.verdict.as_ref().map_or("unusable", |verdict| verdict.outcome().name())
    }

    /// Simulated time that was reflown, s.
    fn flown_s(&self) -> f64 {
        self.verdict.as_ref().map_or(0.0, |verdict| verdict.exact as f64 * STEP_S)
    }

    fn say(&self) {
        match &self.verdict {
            Ok(verdict) => {
                say!("{}: {verdict}", self.log.display());
                let (flown_s, took_s) = (self.flown_s(), self.took.as_secs_f64());
                say!("reflown in {took_s:.2} s, {:.0} times real time", flown_s / took_s);
            }
            Err(error) => complain!("tiltrotor: {}: {error}", self.log.display()),
        }
    }
}

/// Everything that was verified.
struct Run {
    logs: Vec<Verified>,
    jobs: usize,
    shard: Option<Shard>,
    took: Duration,
}

impl Run {
    /// The worst of all.
    fn status(&self) -> u8 {
        self.logs.iter().map(Verified::status).fold(0, worse)
    }

    fn count(&self, outcome: &str) -> usize {
        self.logs.iter().filter(|log| log.outcome() == outcome).count()
    }

    fn flown_s(&self) -> f64 {
        self.logs.iter().map(Verified::flown_s).sum()
    }

    fn say_sum(&self) {
        let all = ["exact", "diverged", "incomplete", "compared", "damaged", "unusable"];
        let counts: Vec<_> = all
            .into_iter()
            .map(|outcome| (self.count(outcome), outcome))
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

/// Verifies every log; the worst outcome is the exit status.
pub fn run(args: &Args) -> Result<ExitCode> {
    if let Some(folder) = &args.rrd {
        recordings::prepare(folder)?;
    }
    let whole = corpus::logs(&args.logs)?;
    let several = whole.len() > 1;
    let logs = match args.shard {
        Some(shard) => shard.of(whole),
        None => whole,
    };
    let jobs = args.jobs.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZero::get);
    let jobs = jobs.min(logs.len()).max(1);
    let started = Instant::now();
    let verified = verify_all(&logs, jobs, &args.how.options(), args.format == Format::Text);
    let run = Run { logs: verified, jobs, shard: args.shard, took: started.elapsed() };
    match args.format {
        Format::Text if several || run.logs.is_empty() => run.say_sum(),
        Format::Text => {}
        Format::Json => say!("{:#}", forms::json(&run)),
        Format::Junit => say!("{}", forms::junit(&run)?.trim_end()),
    }
    if let Some(folder) = &args.rrd {
        recordings::save(&run, folder)?;
    }
    Ok(ExitCode::from(run.status()))
}

/// Verifies a log, prints the verdict, and returns the exit status.
pub fn verify_one(log: &Path, options: &Options) -> u8 {
    let verified = verify_all(&[log.into()], 1, options, true);
    verified.iter().map(Verified::status).fold(0, worse)
}

/// Verifies them on so many threads; each is told, in the order of the list, as soon as it and all
/// before it are done.
fn verify_all(logs: &[PathBuf], jobs: usize, options: &Options, tell: bool) -> Vec<Verified> {
    // Draws itself on a terminal only.
    let bar = ProgressBar::new(logs.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {pos} of {len} logs, {msg}") {
        bar.set_style(style);
    }
    let next = AtomicUsize::new(0);
    let ticks = AtomicU64::new(0);
    let done = Mutex::new(Done { logs: logs.iter().map(|_| None).collect(), told: 0 });
    let work = || {
        while let Some(log) = logs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let verified = Verified::new(log, options, |flown| {
                if flown.is_multiple_of(TICKS_PER_WORD) {
                    let all = ticks.fetch_add(TICKS_PER_WORD, Ordering::Relaxed) + TICKS_PER_WORD;
                    bar.set_message(format!("{:.0} s reflown", all as f64 * STEP_S));
                    bar.tick();
                }
            });
            let mut done = done.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            if let Some(place) = logs.iter().position(|known| known == log) {
                done.logs[place] = Some(verified);
            }
            if tell {
                bar.suspend(|| done.tell());
            }
            bar.inc(1);
        }
    };
    thread::scope(|scope| {
        for _ in 1..jobs {
            scope.spawn(work);
        }
        work();
    });
    bar.finish_and_clear();
    let done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.logs.into_iter().flatten().collect()
}

/// Ticks between words on the progress: ten seconds of flight.
const TICKS_PER_WORD: u64 = 2500;

/// What is done, in the order of the list.
struct Done {
    logs: Vec<Option<Verified>>,
    told: usize,
}

impl Done {
    fn tell(&mut self) {
        while let Some(Some(verified)) = self.logs.get(self.told) {
            verified.say();
            self.told += 1;
        }
    }
}

/// The graver of two statuses: unusable, then diverged, then compared, then never closed.
fn worse(a: u8, b: u8) -> u8 {
    let grave = |status| match status {
        0 => 0,
        report::NEVER_CLOSED => 1,
        report::COMPARED => 2,
        report::DIVERGED => 3,
        _ => 4,
    };
    if grave(b) > grave(a) { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_of_several_statuses_is_told() {
        use report::{DIVERGED, NEVER_CLOSED, UNUSABLE};
        assert_eq!([0, 0].into_iter().fold(0, worse), 0);
        assert_eq!([0, NEVER_CLOSED].into_iter().fold(0, worse), NEVER_CLOSED);
        assert_eq!([NEVER_CLOSED, DIVERGED, 0].into_iter().fold(0, worse), DIVERGED);
        assert_eq!([DIVERGED, UNUSABLE, NEVER_CLOSED].into_iter().fold(0, worse), UNUSABLE);
    }
}
