//! `tiltrotor verify`: many logs on many threads, one report.

mod bless;
mod corpus;
mod forms;
mod recordings;
mod run;

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use anyhow::Result;
use engine::STEP_S;
use indicatif::{ProgressBar, ProgressStyle};
use replay::{Options, THREADS_MAX};

use crate::status::Status;
use corpus::Shard;
use run::{How, Run, Verified};

/// Logs to be reflown.
#[derive(clap::Args)]
pub struct Args {
    /// The logs; a folder stands for every *.mcap in it and below
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Threads, for one log or several at a time [default: one a processor]
    #[arg(long, value_name = "N")]
    #[arg(value_parser = crate::numbers::threads, allow_negative_numbers = true)]
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

/// Verifies every log; the gravest outcome is the exit status.
pub fn run(args: &Args) -> Result<Status> {
    if let Some(folder) = &args.rrd {
        recordings::prepare(folder)?;
    }
    let whole = corpus::logs(&args.logs)?;
    let several = whole.len() > 1;
    let logs = match args.shard {
        Some(shard) => shard.of(whole),
        None => whole,
    };
    let jobs = args
        .jobs
        .or_else(|| thread::available_parallelism().ok())
        .map_or(1, NonZero::get)
        .min(THREADS_MAX);
    // Of few logs, each is flown by several threads.
    let threads = (jobs / logs.len().max(1)).max(1);
    let jobs = jobs.min(logs.len()).max(1);
    if args.how.bless || args.how.moved {
        return bless::run(&logs, args.how.aircraft.as_deref(), args.how.bless);
    }
    if args.how.aircraft.is_some() {
        anyhow::bail!(
            "--aircraft: a log is verified with its own aircraft; it goes with --bless or --moved"
        );
    }
    let started = Instant::now();
    let verified = verify_all(&logs, (jobs, threads), Some(&args.how), args.format == Format::Text);
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
    Ok(run.status())
}

/// Verifies a log, prints the verdict, and returns the exit status.
pub fn verify_one(log: &Path) -> Status {
    let threads = Options::default().threads;
    Status::gravest(
        verify_all(&[log.into()], (1, threads), None, true).iter().map(Verified::status),
    )
}

/// Verifies so many at a time, each on so many threads; each is told, in the order of the list, as soon as it and all
/// before it are done.
fn verify_all(
    logs: &[PathBuf],
    (jobs, threads): (usize, usize),
    how: Option<&How>,
    tell: bool,
) -> Vec<Verified> {
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
            let mut told = 0;
            let verified = Verified::new(log, how, threads, |flown| {
                let more = flown.saturating_sub(told);
                if more >= TICKS_PER_WORD {
                    told = flown;
                    let all = ticks.fetch_add(more, Ordering::Relaxed) + more;
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
