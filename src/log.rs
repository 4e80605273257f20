//! `tiltrotor log`.

mod compact;
mod trim;

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use engine::STEP_S;
use logs::{Ending, LogError};
use recorder::statistics::Statistics;

use crate::report;
use crate::window::WindowArgs;

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
        #[command(flatten)]
        window: WindowArgs,
    },
    /// What an engineer reads of a flight: events, greatest values and when, touchdown, where it ended
    Summary {
        /// The log
        log: PathBuf,
        #[command(flatten)]
        window: WindowArgs,
    },
    /// A part of a log as a log of its own, which names its parent; or as a golden flight
    Trim(trim::Args),
    /// Inputs, keyframes and digests kept, states dropped: they can be flown again
    Compact(compact::CompactArgs),
    /// The log that was compacted, to the byte
    Expand(compact::ExpandArgs),
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
        Command::Cat { log, topic, window } => cat(log, topic.as_deref(), window),
        Command::Summary { log, window } => summary(log, window),
        Command::Trim(args) => trim::run(args),
        Command::Compact(args) => compact::compact(args),
        Command::Expand(args) => compact::expand(args),
        Command::Recover { broken, out, force } => recover(broken, out, *force),
    }
}

fn info(log: &Path) -> Result<ExitCode> {
    let mut reader = replay::open(log).with_context(|| log.display().to_string())?;
    say!("{}", log.display());
    for (key, value) in &reader.identity.0 {
        say!("  {key:<16} {value}");
    }
    for (name, text) in reader.setup.files() {
        say!("  {name:<16} {} lines, {} bytes", text.lines().count(), text.len());
    }
    let first_tick = reader.initial.tick;
    let (mut ticks, mut events, mut digest) = (0, 0, 0);
    let mut statistics = Statistics::new();
    let disorder = loop {
        match reader.next_tick() {
            Ok(Some(tick)) => {
                ticks = tick.record.state.tick - first_tick;
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
    if first_tick > 0 {
        say!("  {:<16} {:.3} s, tick {first_tick}", "from", first_tick as f64 * STEP_S);
    }
    if reader.is_compacted() {
        say!("  {:<16} yes: most states are flown again while reading", "compacted");
    }
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

fn summary(log: &Path, window: &WindowArgs) -> Result<ExitCode> {
    let window = window.of(log)?;
    let summary = replay::summary(log, &window).with_context(|| log.display().to_string())?;
    say!("{}: {summary}", log.display());
    Ok(if summary.exact { ExitCode::SUCCESS } else { ExitCode::from(report::DIVERGED) })
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

fn cat(log: &Path, only: Option<&str>, window: &WindowArgs) -> Result<ExitCode> {
    // Whoever closes the pipe early, as `head` does, has seen enough.
    let mut out = BufWriter::new(io::stdout().lock());
    let window = window.of(log)?;
    let mut messages = replay::messages(log).with_context(|| log.display().to_string())?;
    if window != replay::Window::default() {
        let (from, until) = (window.from_tick.unwrap_or(0), window.until_tick.unwrap_or(u64::MAX));
        messages.limit(from, until).with_context(|| log.display().to_string())?;
    }
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
