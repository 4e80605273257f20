//! `tiltrotor log compact` and `log expand`.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use engine::STEP_S;
use indicatif::{ProgressBar, ProgressStyle};
use logs::compact::{self, Copied};
use logs::output::Output;
use logs::text::size;
use replay::Source;

use crate::made::Made;
use crate::numbers::between;
use crate::status::Status;

/// Seconds between two states that are kept: an eighth of what is kept at all, and soon flown.
const KEYFRAMES_S: f64 = 2.0;

/// A log to be compacted.
#[derive(clap::Args)]
pub struct CompactArgs {
    /// The log
    log: PathBuf,
    /// The compacted log [default: LOG with -compact]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Seconds between two states that are kept
    #[arg(long, value_name = "SECONDS", default_value_t = KEYFRAMES_S)]
    #[arg(value_parser = between(STEP_S, 1000.0, "s"), allow_negative_numbers = true)]
    keyframes: f64,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

/// A log to be expanded.
#[derive(clap::Args)]
pub struct ExpandArgs {
    /// The compacted log
    log: PathBuf,
    /// The log that it was [default: LOG without -compact, or with -expanded]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

/// Compacts.
pub fn compact(args: &CompactArgs) -> Result<Status> {
    let keyframe_ticks = (args.keyframes / STEP_S).round();
    let stem = stem(&args.log);
    let out = out(&args.log, args.out.as_deref(), &format!("{stem}-compact.mcap"));
    let source = Source::proven(&args.log, "not compacted")
        .with_context(|| args.log.display().to_string())?;
    let output = Output::beside(&out, args.force, &[&args.log])?;
    let copied = work(&args.log, |progress| {
        let ticks = keyframe_ticks as u64;
        compact::compact(&args.log, &output, ticks, replay::flown, progress)
    })?;
    let made = Made::of(&source, output)?;
    let ticks = copied.states.saturating_sub(1);
    say!(
        "{}: {} of {}, {:.1} B a tick; {ticks} ticks ({:.1} s) flown again to the same bits",
        out.display(),
        size(copied.bytes),
        size(copied.bytes_before),
        copied.bytes as f64 / ticks.max(1) as f64,
        ticks as f64 * STEP_S
    );
    say!("expanded again, it is the log that it was, message for message");
    Ok(made.say(&args.log))
}

/// Expands.
pub fn expand(args: &ExpandArgs) -> Result<Status> {
    let stem = stem(&args.log);
    let name = match stem.strip_suffix("-compact") {
        Some(before) => format!("{before}.mcap"),
        None => format!("{stem}-expanded.mcap"),
    };
    let out = out(&args.log, args.out.as_deref(), &name);
    let source = Source::proven(&args.log, "not expanded")
        .with_context(|| args.log.display().to_string())?;
    let output = Output::beside(&out, args.force, &[&args.log])?;
    let copied =
        work(&args.log, |progress| compact::expand(&args.log, &output, replay::flown, progress))?;
    let made = Made::of(&source, output)?;
    let ticks = copied.states.saturating_sub(1);
    say!(
        "{}: {}, {ticks} ticks ({:.1} s)",
        out.display(),
        size(copied.bytes),
        ticks as f64 * STEP_S
    );
    match copied.same_file {
        Some(true) => say!("the file is the one that was compacted, byte for byte"),
        _ => say!(
            "every message is there, in order; the file is not the same to the byte: another program \
             had put it together"
        ),
    }
    Ok(made.say(&args.log))
}

/// Carries it out with a line of progress on a terminal.
fn work(
    log: &Path,
    copy: impl FnOnce(&mut dyn FnMut(u64)) -> Result<Copied, logs::LogError>,
) -> Result<Copied> {
    let bar = ProgressBar::new_spinner();
    bar.set_style(ProgressStyle::with_template("{spinner} {msg}")?);
    let copied = copy(&mut |states| {
        if states.is_multiple_of(2500) {
            bar.set_message(format!("{}: {:.0} s", log.display(), states as f64 * STEP_S));
            bar.tick();
        }
    });
    bar.finish_and_clear();
    copied.with_context(|| log.display().to_string())
}

fn stem(log: &Path) -> String {
    log.file_stem().unwrap_or_default().display().to_string()
}

fn out(log: &Path, out: Option<&Path>, name: &str) -> PathBuf {
    out.map_or_else(|| log.with_file_name(name), Path::to_path_buf)
}
