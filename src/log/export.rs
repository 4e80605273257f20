//! `tiltrotor log export`.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use logs::Ending;
use logs::export::{Exported, Form, Judged, export};
use logs::text::size;
use replay::{Judgement, Outcome, Window};

use crate::status::Status;

/// What to export, and where to.
#[derive(clap::Args)]
pub struct Args {
    /// The logs
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// As CSV below this folder
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
    /// As Parquet below this folder
    #[arg(long, value_name = "DIR")]
    parquet: Option<PathBuf>,
    /// Export flights anew that are there already
    #[arg(long)]
    force: bool,
}

/// Exports every log; the worst outcome is the exit status.
pub fn run(args: &Args) -> Result<Status> {
    let mut statuses = Vec::new();
    for (folder, form) in forms(args)? {
        for log in &args.logs {
            statuses.push(one(log, folder, form, args.force));
        }
    }
    Ok(Status::gravest(statuses))
}

fn forms(args: &Args) -> Result<Vec<(&Path, Form)>> {
    let mut forms = Vec::new();
    forms.extend(args.csv.as_deref().map(|folder| (folder, Form::Csv)));
    #[cfg(feature = "parquet")]
    forms.extend(args.parquet.as_deref().map(|folder| (folder, Form::Parquet)));
    #[cfg(not(feature = "parquet"))]
    if args.parquet.is_some() {
        bail!("this program was built without `parquet`; build it with `--features parquet`");
    }
    if forms.is_empty() {
        bail!("as what? give --csv DIR, --parquet DIR or both");
    }
    for (folder, _) in &forms {
        if folder.exists() && !folder.is_dir() {
            bail!("{}: a file, and not a folder to export to", folder.display());
        }
    }
    Ok(forms)
}

/// Exports a log, says what became of it, and returns the exit status.
fn one(log: &Path, folder: &Path, form: Form, force: bool) -> Status {
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
        bar.set_style(style);
    }
    let mut shown_s = 0;
    let judgement = replay::judge(log, &Window::default());
    let judged = Judged { outcome: judgement.outcome.name(), words: &judgement.words };
    let exported = export(log, folder, form, force, judged, replay::flown, |time_ns| {
        let now_s = time_ns / 1_000_000_000;
        if now_s != shown_s {
            shown_s = now_s;
            bar.set_message(format!("{}: {now_s} s exported", log.display()));
            bar.tick();
        }
    });
    bar.finish_and_clear();
    match exported {
        Ok(Exported { flight, rows, .. }) if rows.is_empty() => {
            say!("{}: {flight} is there already; --force exports it anew", log.display());
            status(log, &judgement, Status::Done)
        }
        Ok(Exported { flight, rows, bytes, ending }) => {
            let rows: Vec<_> = rows
                .iter()
                .filter(|(table, _)| *table != "flights")
                .map(|(table, rows)| format!("{table} {rows}"))
                .collect();
            say!("{}: {flight}, {}, rows: {}", log.display(), size(bytes), rows.join(", "));
            let ended = match ending {
                Ending::Closed => Status::Done,
                Ending::Truncated => {
                    say!("  it ends there without having been closed");
                    Status::NeverClosed
                }
                Ending::Damaged(why) => {
                    complain!("tiltrotor: {}: damaged after that: {why}", log.display());
                    Status::Unusable
                }
            };
            status(log, &judgement, ended)
        }
        Err(error) => {
            complain!("tiltrotor: {}: {error}", log.display());
            Status::Unusable
        }
    }
}

/// Says what the log is; what cannot be judged can still be exported.
fn status(log: &Path, judgement: &Judgement, ended: Status) -> Status {
    say!("{}: {judgement}", log.display());
    match judgement.outcome {
        Outcome::Unusable => ended,
        _ => Status::gravest([ended, Status::from(judgement)]),
    }
}
