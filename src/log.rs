//! `tiltrotor log`.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use engine::STEP_S;
use logs::{Ending, FlightReader, LogError, Messages};
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
    Cat {
        /// The log
        log: PathBuf,
        /// Only this channel (/state, /inputs, /hardware, /timing, /events, /outputs)
        #[arg(long)]
        topic: Option<String>,
    },
    /// A proper log from a broken one: every tick up to the first bad one
    Recover {
        /// The broken log
        broken: PathBuf,
        /// The log to be written
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
        /// Overwrite an existing log
        #[arg(long)]
        force: bool,
    },
}

/// Carries it out.
pub fn run(command: &Command) -> Result<ExitCode> {
    match command {
        Command::Info { log } => info(log),
        Command::Cat { log, topic } => cat(log, topic.as_deref()),
        Command::Recover { broken, out, force } => recover(broken, out, *force),
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
        (None, Some(Ending::Truncated)) if reader.recovered_from().is_some() => {
            "recovered: the flight went on, this log does not".into()
        }
        (None, _) => "not closed: killed, or cut".into(),
    };
    say!("  {:<16} {ending}", "end of the log");
    Ok(if ending == "closed" { ExitCode::SUCCESS } else { ExitCode::from(report::UNUSABLE) })
}

fn recover(broken: &Path, out: &Path, force: bool) -> Result<ExitCode> {
    let done = logs::recover(broken, out, force).with_context(|| broken.display().to_string())?;
    say!(
        "{}: kept {} ticks ({:.3} s) of {}, each proven by its checksum and digest",
        out.display(),
        done.tick,
        done.tick as f64 * STEP_S,
        broken.display()
    );
    say!("lost       all after tick {}: {}", done.tick, done.reason);
    if done.ticks_distrusted > 0 {
        say!("           {} ticks after it can be read, but not trusted", done.ticks_distrusted);
    }
    if done.messages_foreign > 0 {
        say!("           {} messages on channels of others", done.messages_foreign);
    }
    say!(
        "size       {:.1} kB of {:.1} kB",
        done.bytes_written as f64 * 1e-3,
        done.bytes_read as f64 * 1e-3
    );
    Ok(ExitCode::SUCCESS)
}

fn cat(log: &Path, only: Option<&str>) -> Result<ExitCode> {
    // Whoever closes the pipe early, as `head` does, has seen enough.
    let mut out = BufWriter::new(io::stdout().lock());
    let mut messages = Messages::open(log).with_context(|| log.display().to_string())?;
    for message in &mut messages {
        if only.is_some_and(|only| only != message.topic) {
            continue;
        }
        let Some(fields) = message.fields() else { continue };
        let numbers: Vec<_> =
            fields?.iter().map(|field| format!("\"{}\":{}", field.path, field.value)).collect();
        let written = writeln!(
            out,
            "{{\"topic\":\"{}\",\"time_ns\":{},{}}}",
            message.topic,
            message.time_ns,
            numbers.join(",")
        );
        if written.is_err() {
            return Ok(ExitCode::SUCCESS);
        }
    }
    let _ = out.flush();
    Ok(match messages.ending() {
        Ending::Closed => ExitCode::SUCCESS,
        Ending::Truncated => ExitCode::from(report::NEVER_CLOSED),
        Ending::Damaged(why) => {
            complain!("tiltrotor: {}: {why}", log.display());
            ExitCode::from(report::UNUSABLE)
        }
    })
}
