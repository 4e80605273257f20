//! `tiltrotor log`.

mod cat;
mod export;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use engine::STEP_S;
use logs::{Ending, FlightReader, LogError};
use recorder::statistics::Statistics;

use crate::report;

/// What to do with a log.
#[derive(clap::Subcommand)]
pub enum Command {
    /// What is in a log: who flew what, how long, what happened
    Info {
        /// The log
        log: PathBuf,
    },
    /// Every recorded number of a log, a line of JSON a message, units in the names
    Cat(cat::Args),
    /// Logs as tables, CSV or Parquet, units in the columns' names: a folder a channel, a file a flight
    Export(export::Args),
}

/// Carries it out.
pub fn run(command: &Command) -> Result<ExitCode> {
    match command {
        Command::Info { log } => info(log),
        Command::Cat(args) => cat::run(args),
        Command::Export(args) => export::run(args),
    }
}

fn info(log: &Path) -> Result<ExitCode> {
    let mut reader = FlightReader::open(log).with_context(|| log.display().to_string())?;
    say!("{}", log.display());
    for (key, value) in &reader.identity.0 {
        say!("  {key:<16} {value}");
    }
    for (name, text) in reader.setup.files() {
        say!("  {name:<16} {} lines, {} bytes", text.lines().count(), text.len());
    }
    let (mut ticks, mut events, mut digest) = (0, 0, 0);
    let mut statistics = Statistics::new();
    let disorder = loop {
        match reader.next_tick() {
            Ok(Some(tick)) => {
                ticks = tick.record.state.tick;
                events += tick.events.len();
                digest = tick.record.digest;
            }
            Ok(None) => break None,
            Err(error @ (LogError::Order(_) | LogError::Decode(_))) => break Some(error),
            Err(error) => return Err(error.into()),
        }
        for timing in reader.timings.drain(..) {
            statistics.add(&timing);
        }
    };
    say!("  {:<16} {:.3} s, {ticks} ticks", "flown", ticks as f64 * STEP_S);
    say!("  {:<16} {events}", "device events");
    say!("  {:<16} {} late ticks", "overruns", statistics.overruns);
    say!(
        "  {:<16} p50 {:.3} ms, p99.9 {:.3} ms, max {:.3} ms",
        "to picture",
        statistics.sent.percentile_ms(50.0),
        statistics.sent.percentile_ms(99.9),
        statistics.sent.longest_ms()
    );
    say!("  {:<16} {digest:016x}", "digest");
    for remark in &reader.remarks {
        say!("  {:>10.3} s  {}", remark.time_ns as f64 * 1e-9, remark.words);
    }
    let ending = match (disorder, reader.ending()) {
        (Some(error), _) => format!("unusable from here: {error}"),
        (None, Some(Ending::Closed)) => "closed".into(),
        (None, Some(Ending::Damaged(why))) => format!("damaged from here: {why}"),
        (None, _) => "not closed: killed, or cut".into(),
    };
    say!("  {:<16} {ending}", "end of the log");
    Ok(if ending == "closed" { ExitCode::SUCCESS } else { ExitCode::from(report::UNUSABLE) })
}
