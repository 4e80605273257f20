//! `tiltrotor log`.

mod cat;
mod clip;
mod compact;
mod ended;
mod export;
mod fields;
mod files;
mod find;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use engine::STEP_S;
use logs::devices::DeviceIdentity;
use logs::evolution::Difference;
use logs::output::Output;
use logs::text::{at, size};
use logs::{Ending, FlightReader, LogError, Messages, OpenOptions};
use recorder::statistics::Statistics;
use replay::{Facts, Outcome, Window};

use crate::made;
use crate::status::Status;
use crate::timing;
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
    Cat(cat::Args),
    /// What happened: events, and every change of the world and of a button; `--around 135` for a moment
    Find(find::Args),
    /// The files in a log: aircraft, cockpit map, scenario and whatever else was attached
    Files(files::Args),
    /// Every field of every channel of a log: its unit, and what it is
    Fields(fields::Args),
    /// Logs as tables, CSV or Parquet, units in the columns' names: a folder a channel, a file a flight
    Export(export::Args),
    /// What an engineer reads of a flight: events, greatest values and when, touchdown, where it ended
    Summary {
        /// The log
        log: PathBuf,
        #[command(flatten)]
        window: WindowArgs,
    },
    /// A part of a log as a log of its own, which names its parent; or as a golden flight
    // The name that it had, for one version more.
    #[command(alias = "trim")]
    Clip(clip::Args),
    /// A small log of a flight: inputs, digests and a state now and then are kept, the rest is flown again
    Compact(compact::CompactArgs),
    /// The whole log again of a compacted one, byte for byte
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
pub fn run(command: &Command) -> Result<Status> {
    match command {
        Command::Info { log } => info(log),
        Command::Cat(args) => cat::run(args),
        Command::Find(args) => find::run(args),
        Command::Files(args) => files::run(args),
        Command::Fields(args) => fields::run(args),
        Command::Export(args) => export::run(args),
        Command::Summary { log, window } => summary(log, window),
        Command::Clip(args) => clip::run(args),
        Command::Compact(args) => compact::compact(args),
        Command::Expand(args) => compact::expand(args),
        Command::Recover { broken, out, force } => recover(broken, out, *force),
    }
}

fn info(log: &Path) -> Result<Status> {
    let across = OpenOptions { aircraft_of: None, across_versions: true };
    let opened = match logs::open(log, across) {
        // A compacted log is this version's, or nobody's.
        Err(LogError::Compacted) => logs::open(log, replay::OPEN),
        opened => opened,
    };
    let mut reader = match opened {
        Err(LogError::Version { what, theirs, ours }) if what != "flight model" => {
            say!("{}: {what} {theirs}, and this program knows {ours}", log.display());
            return what_is_there(log);
        }
        reader => reader.with_context(|| log.display().to_string())?,
    };
    say!("{}", log.display());
    say_who_and_what(&reader);
    let (mut events, mut digest) = (0, 0);
    let mut facts = Facts::of_reading(&reader);
    let start = reader.initial.tick;
    let mut last = start;
    let mut statistics = Statistics::new();
    let disorder = loop {
        match reader.next_tick() {
            Ok(Some(tick)) => {
                last = tick.record.state.tick;
                events += tick.events.len();
                digest = tick.record.digest;
                facts.add(tick, None);
            }
            Ok(None) => break None,
            Err(error @ (LogError::Order(_) | LogError::Decode(_))) => break Some(error),
            Err(error) => return Err(error.into()),
        }
        for timing in reader.timings.drain(..) {
            statistics.add(&timing);
        }
    };
    let ticks = last.saturating_sub(start);
    say!("  {:<16} {:.3} s, {ticks} ticks", "flown", ticks as f64 * STEP_S);
    if let Some(irregular) = facts.irregular {
        say!("  {:<16} {irregular}", "not regular");
    }
    if start != 0 {
        say!("  {:<16} {}", "begins at", at(start));
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
    say_beside_the_flight(&reader);
    facts.end(&reader, disorder.as_ref().map(ToString::to_string), &Window::default());
    let judgement = facts.judge();
    say!("  {:<16} {}", "end of the log", ending(disorder, &reader));
    say!("  {:<16} {judgement}", "judgement");
    if let Some(origin) = &facts.origin {
        say!("  {:<16} {origin}", "origin");
    }
    Ok(Status::from(&judgement))
}

/// Who flew, and what is flown with.
fn say_who_and_what(reader: &FlightReader) {
    say_facts("", &reader.identity.0);
    if !reader.same_model {
        say!(
            "  {:<16} {}; `verify --across-versions` flies it",
            "this program's",
            engine::MODEL_VERSION
        );
    }
    for (name, text) in reader.setup.files() {
        say!("  {name:<16} {} lines, {} bytes", text.lines().count(), text.len());
    }
}

/// What was read beside the ticks: other metadata, fields of another layout, devices, events.
fn say_beside_the_flight(reader: &FlightReader) {
    for (name, facts) in &reader.other_facts {
        if timing::is_timing(name) {
            timing::say(facts);
        } else {
            say_facts(&format!("{name}."), facts);
        }
    }
    for (topic, difference) in reader.differences() {
        let Difference { missing, ignored } = difference;
        say!(
            "  {topic:<16} {} fields of today are not in it, {} of its fields are not known today",
            missing.len(),
            ignored.len()
        );
    }
    for device in &reader.devices {
        let name = format!("device {}", device.device);
        let mapped = if device.mapped == 0 { " (not in the cockpit map)" } else { "" };
        say!("  {name:<16} {}{mapped}", identity(device));
    }
    for line in &reader.log_lines {
        say!("  {:>10.3} s  {}", line.time_ns as f64 * 1e-9, line.words);
    }
}

/// Name, bus:vendor:product:version as far as they are known, port and serial number of a device.
fn identity(device: &DeviceIdentity) -> String {
    let DeviceIdentity { bus, vendor, product, version, .. } = device;
    let mut words = device.name.clone();
    if [bus, vendor, product, version].into_iter().any(|&number| number != 0) {
        words.push_str(&format!(", {bus:04x}:{vendor:04x}:{product:04x}:{version:04x}"));
    }
    for (what, text) in [("port", &device.port), ("serial number", &device.uniq)] {
        if !text.is_empty() {
            words.push_str(&format!(", {what} {text}"));
        }
    }
    words
}

fn ending(disorder: Option<LogError>, reader: &FlightReader) -> String {
    match (disorder, reader.ending()) {
        (Some(error), _) => format!("unusable from here: {error}"),
        (None, Some(Ending::Closed)) => "closed".into(),
        (None, Some(Ending::Damaged(why))) => format!("damaged from here: {why}"),
        (None, Some(Ending::Truncated)) if reader.recovered_from().is_some() => {
            "recovered: the flight went on, this log does not".into()
        }
        (None, _) => "not closed: killed, or cut".into(),
    }
}

fn summary(log: &Path, window: &WindowArgs) -> Result<Status> {
    let window = window.of(log)?;
    let summary = replay::summary(log, &window).with_context(|| log.display().to_string())?;
    say!("{}: {summary}", log.display());
    let kept_time = summary.facts.iter().filter(|(name, _)| timing::is_timing(name));
    kept_time.for_each(|(_, facts)| timing::say(facts));
    Ok(Status::from(&summary.judgement))
}

fn recover(broken: &Path, out: &Path, force: bool) -> Result<Status> {
    let output = Output::beside(out, force, &[broken])?;
    let done = logs::recover(broken, &output, replay::flown)
        .with_context(|| broken.display().to_string())?;
    // Its digests follow from each other; where this program flies otherwise, that is what it is.
    let made = made::finished(output, &[Outcome::NeverClosed, Outcome::Diverged])?;
    let kept = done.tick - done.first_tick;
    say!(
        "{}: kept {kept} ticks ({:.3} s) of {}, each proven by its checksum and digest",
        out.display(),
        kept as f64 * STEP_S,
        broken.display()
    );
    say!("lost       all after tick {}: {}", done.tick, done.reason);
    if done.ticks_distrusted > 0 {
        say!("           {} ticks after it can be read, but not trusted", done.ticks_distrusted);
    }
    if done.messages_foreign > 0 {
        say!("           {} messages on channels of others", done.messages_foreign);
    }
    if done.files_foreign > 0 {
        say!("           {} files and metadata records of others", done.files_foreign);
    }
    if done.messages_unproven > 0 {
        say!(
            "           {} messages for viewers and tables that the kept ticks do not prove",
            done.messages_unproven
        );
    }
    say!("size       {} of {}", size(done.bytes_written), size(done.bytes_read));
    say!("new log    {made}");
    Ok(Status::from(&made))
}

fn say_facts(of: &str, facts: &BTreeMap<String, String>) {
    for (key, value) in facts {
        say!("  {:<16} {value}", format!("{of}{key}"));
    }
}

/// What any version can say of a log: what it says of itself, and how many messages there are.
fn what_is_there(log: &Path) -> Result<Status> {
    let mut messages = match Messages::open(log, OpenOptions::default()) {
        Err(LogError::Compacted) => {
            say!("  it is compacted: only the program that wrote it says more of it");
            return Ok(Status::Unusable);
        }
        opened => opened?,
    };
    let mut channels: BTreeMap<String, (u64, usize)> = BTreeMap::new();
    while let Some(message) = messages.next_message() {
        let numbers = message.layout().map_or(0, |layout| layout.numbers().len());
        let (count, _) = channels.entry(message.topic().into()).or_insert((0, numbers));
        *count += 1;
    }
    for (name, facts) in messages.facts() {
        say_facts(&if name == "tiltrotor" { String::new() } else { format!("{name}.") }, facts);
    }
    for (name, data) in messages.files() {
        say!("  {name:<16} {} bytes", data.len());
    }
    for (topic, (count, numbers)) in channels {
        say!("  {topic:<16} {count} messages of {numbers} numbers");
    }
    say!("  it cannot be reflown; `log cat` and `log export` read it by its own schema");
    Ok(Status::Unusable)
}
