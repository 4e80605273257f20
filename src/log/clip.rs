//! `tiltrotor log clip`.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use engine::STEP_S;
use logs::output::Output;
use logs::text::{at, size};
use replay::{KEYFRAME_TICKS, NewLog, Source, Window, names_parent, parent, rewrite};

use crate::identity;
use crate::made::Made;
use crate::status::Status;
use crate::window::WindowArgs;

/// Where golden flights live.
const GOLDEN: &str = "tests/golden";
/// A golden flight larger than this does not belong into a repository.
const GOLDEN_BYTES_MAX: u64 = 300_000;

/// What to keep.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    #[command(flatten)]
    window: WindowArgs,
    /// The new log [default: LOG with -clip]
    #[arg(long, value_name = "FILE", conflicts_with = "as_golden")]
    out: Option<PathBuf>,
    /// Make a golden flight of it: tests/golden/NAME.mcap, compacted, in its README, verified by the
    /// tests
    #[arg(long, value_name = "NAME", requires = "reason")]
    as_golden: Option<String>,
    /// What it is kept for
    #[arg(long, value_name = "TEXT")]
    reason: Option<String>,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

/// Cuts the part out, flies it, and writes it.
pub fn run(args: &Args) -> Result<Status> {
    // A whole flight may be kept as a golden one.
    if args.window.is_whole() && args.as_golden.is_none() {
        bail!("which part? give --from, --until or --around");
    }
    let window = args.window.of(&args.log)?;
    let Some(name) = &args.as_golden else {
        let stem = args.log.file_stem().unwrap_or_default().display().to_string();
        let name = format!("{stem}-clip.mcap");
        let out = args.out.clone().unwrap_or_else(|| args.log.with_file_name(name));
        let source = source(args)?;
        let output = Output::beside(&out, args.force, &[&args.log])?;
        let (ticks, bytes) = cut(args, &source, &window, &output, true)?;
        let made = Made::of(&source, output)?;
        told(&out, ticks, bytes);
        return Ok(made.say(&args.log));
    };
    let letters = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if name.is_empty() || !name.chars().all(letters) {
        bail!("--as-golden {name}: expected letters, digits, - and _");
    }
    let reason = args.reason.as_deref().unwrap_or_default().trim();
    if reason.is_empty() || reason.contains('\n') {
        bail!("--reason: expected a line that says what the flight is kept for");
    }
    let folder = Path::new(GOLDEN);
    fs::create_dir_all(folder).with_context(|| format!("cannot make {GOLDEN}"))?;
    let out = folder.join(format!("{name}.mcap"));
    let source = source(args)?;
    let whole = Output::beside(&out, args.force, &[&args.log])?;
    let (ticks, _) = cut(args, &source, &window, &whole, false)?;
    // Before the flight takes its place: what can fail has been done then.
    let entry = enter(&folder.join("README.md"), name, reason)?;
    let output = Output::beside(&out, args.force, &[&args.log])?;
    let (from, keyframes) = (whole.unfinished(), KEYFRAME_TICKS);
    let bytes = logs::compact::compact(from, &output, keyframes, replay::flown, |_| ())
        .with_context(|| out.display().to_string())?
        .bytes;
    let made = Made::of(&source, output)?;
    entry.finish()?;
    told(&out, ticks, bytes);
    if bytes > GOLDEN_BYTES_MAX {
        let most = size(GOLDEN_BYTES_MAX);
        complain!("tiltrotor: that is more than {most}: a shorter window would do as well");
    }
    say!("`cargo test --no-default-features --test golden` verifies it");
    Ok(made.say(&args.log))
}

/// The log to be cut, proven from its beginning to its end.
fn source(args: &Args) -> Result<Source> {
    Source::proven(&args.log, "not cut").with_context(|| args.log.display().to_string())
}

fn told(out: &Path, ticks: u64, bytes: u64) {
    say!(
        "{}: {ticks} ticks ({:.3} s), {}, flown to the recorded bits",
        out.display(),
        ticks as f64 * STEP_S,
        size(bytes)
    );
}

/// Writes the part as a log of its own, which is not finished yet; returns its ticks and its size.
fn cut(
    args: &Args,
    source: &Source,
    window: &Window,
    out: &Output,
    timing: bool,
) -> Result<(u64, u64)> {
    let log = &args.log;
    let name = || log.display().to_string();
    let mut reader = logs::open(log, replay::OPEN).with_context(name)?;
    window.apply(&mut reader).with_context(name)?;
    let mut identity = source.marks(names_parent(identity::identity(), log, &reader, "clip"));
    if let Some(reason) = &args.reason {
        identity = identity.with(parent::REASON, reason.trim());
    }
    let (setup, initial) = (reader.setup.clone(), reader.initial);
    let picture_of = Some(log.as_path());
    let devices = &source.devices;
    let new = NewLog { out, setup: &setup, identity: &identity, timing, devices, picture_of };
    let (mut ticks, mut wrong) = (0, None);
    let written = rewrite(&mut reader, &initial, &new, |tick, state, _, _| {
        ticks += 1;
        if !tick.chained || tick.record.state != *state {
            wrong.get_or_insert(state.tick);
        }
    })
    .with_context(name)?;
    if let Some(tick) = wrong {
        bail!(
            "{}: not cut: from {} on it does not refly to the recorded bits; `tiltrotor verify` says \
             more",
            name(),
            at(tick)
        );
    }
    if ticks == 0 {
        bail!("{}: not cut: there is no tick in that window", name());
    }
    Ok((ticks, written.closed.bytes))
}

/// Says in the folder's README what the flight is for; whoever asked for it finishes it.
fn enter(readme: &Path, name: &str, reason: &str) -> Result<Output> {
    let entry = format!("- `{name}.mcap`: {reason}");
    let old = fs::read_to_string(readme).unwrap_or_else(|_| "# Golden flights\n".into());
    let mine = format!("- `{name}.mcap`: ");
    let kept: Vec<_> = old.lines().filter(|line| !line.starts_with(&mine)).collect();
    let output = Output::beside(readme, true, &[])?;
    writeln!(output.file()?, "{}\n{entry}", kept.join("\n"))
        .with_context(|| readme.display().to_string())?;
    Ok(output)
}
