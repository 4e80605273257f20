//! `tiltrotor log compact` and `log expand`.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use engine::STEP_S;
use indicatif::{ProgressBar, ProgressStyle};
use logs::compact::{self, Copied};
use logs::text::{at, size};

use crate::numbers::between;
use crate::status::Status;
use crate::whatif::refuse_itself;

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
    let out = out(&args.log, args.out.as_deref(), &format!("{stem}-compact.mcap"))?;
    let copied = work(&args.log, &out, args.force, |progress| {
        let ticks = keyframe_ticks as u64;
        compact::compact(&args.log, &out, args.force, ticks, replay::flown, progress)
    })?;
    let ticks = copied.states.saturating_sub(1);
    say!(
        "{}: {} of {}, {:.1} B a tick; {ticks} ticks ({:.1} s) flown again to the same bits",
        out.display(),
        size(copied.bytes),
        size(copied.bytes_before),
        copied.bytes as f64 / ticks.max(1) as f64,
        ticks as f64 * STEP_S
    );
    Ok(Status::Done)
}

/// Expands.
pub fn expand(args: &ExpandArgs) -> Result<Status> {
    let stem = stem(&args.log);
    let name = match stem.strip_suffix("-compact") {
        Some(before) => format!("{before}.mcap"),
        None => format!("{stem}-expanded.mcap"),
    };
    let out = out(&args.log, args.out.as_deref(), &name)?;
    let copied = work(&args.log, &out, args.force, |progress| {
        compact::expand(&args.log, &out, args.force, replay::flown, progress)
    })?;
    // Every state that was flown again has to have the digest that was kept.
    let mut reader = logs::open(&out, replay::OPEN).with_context(|| out.display().to_string())?;
    let mut broken = None;
    while let Some(tick) = reader.next_tick().with_context(|| out.display().to_string())? {
        if !tick.chained {
            broken.get_or_insert(tick.record.state.tick);
        }
        reader.forget();
    }
    let ticks = copied.states.saturating_sub(1);
    say!(
        "{}: {}, {ticks} ticks ({:.1} s)",
        out.display(),
        size(copied.bytes),
        ticks as f64 * STEP_S
    );
    if let Some(tick) = broken {
        complain!(
            "tiltrotor: {}: not what was compacted: the digest breaks at {}",
            out.display(),
            at(tick)
        );
        return Ok(Status::Differs);
    }
    say!(
        "every digest follows from the states that were flown again, last {:016x}",
        reader.digest()
    );
    match copied.same_file {
        Some(true) => say!("the file is the one that was compacted, byte for byte"),
        _ => say!(
            "every message is there, in order; the file is not the same to the byte: another program \
             had put it together"
        ),
    }
    Ok(Status::Done)
}

/// Carries it out with a line of progress on a terminal; when it fails, no file is left.
fn work(
    log: &Path,
    out: &Path,
    force: bool,
    copy: impl FnOnce(&mut dyn FnMut(u64)) -> Result<Copied, logs::LogError>,
) -> Result<Copied> {
    let bar = ProgressBar::new_spinner();
    bar.set_style(ProgressStyle::with_template("{spinner} {msg}")?);
    let there_before = out.exists();
    let copied = copy(&mut |states| {
        if states.is_multiple_of(2500) {
            bar.set_message(format!("{}: {:.0} s", log.display(), states as f64 * STEP_S));
            bar.tick();
        }
    });
    bar.finish_and_clear();
    if copied.is_err() && (force || !there_before) {
        let _ = std::fs::remove_file(out);
    }
    copied.with_context(|| log.display().to_string())
}

fn stem(log: &Path) -> String {
    log.file_stem().unwrap_or_default().display().to_string()
}

fn out(log: &Path, out: Option<&Path>, name: &str) -> Result<PathBuf> {
    let out = out.map_or_else(|| log.with_file_name(name), Path::to_path_buf);
    refuse_itself(log, &out)?;
    Ok(out)
}
