//! `tiltrotor report`: a flight on one page.

mod content;
mod histogram;
mod html;
mod words;

use std::path::{Path, PathBuf};

use anyhow::Result;
use logs::output;
use logs::text::size;

use crate::afterwards::Afterwards;
use crate::plot;
use crate::status::Status;
use crate::window::WindowArgs;

/// What to report on.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// The page [default: beside the log, .html]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// For mail: three figures with coarser lines, the gravest events, no histograms and no devices
    #[arg(long)]
    compact: bool,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    window: WindowArgs,
}

/// Reflies the log, and writes the page.
pub fn run(args: &Args) -> Result<Status> {
    let out = args.out.clone().unwrap_or_else(|| beside(&args.log));
    output::refuse(&out, args.force, &[&args.log])?;
    let window = args.window.of(&args.log)?;
    let flown = Afterwards::of(&args.log, &window)?;
    write(&flown, &out, args.compact, args.force, &args.log)?;
    say!("{}: {}", args.log.display(), flown.judgement);
    Ok(Status::from(&flown.judgement))
}

/// Where the page of a log is.
pub fn beside(log: &Path) -> PathBuf {
    log.with_extension("html")
}

/// Writes the page, and says where it is.
pub fn write(flown: &Afterwards, out: &Path, compact: bool, force: bool, log: &Path) -> Result<()> {
    let text = content::page(flown, compact);
    plot::write(out, text.as_bytes(), force, &[log])?;
    say!("{}: report, {}, for any browser", out.display(), size(text.len() as u64));
    Ok(())
}
