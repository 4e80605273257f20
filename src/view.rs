//! `tiltrotor view`.

use std::path::PathBuf;

use anyhow::Result;

use crate::status::Status;

/// What to show.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Another log beside it: both aircraft in one scene, lines over each other, differences plotted
    #[arg(long, value_name = "OTHER")]
    against: Option<PathBuf>,
    /// Save for the viewer instead of opening it
    #[arg(long, value_name = "FLIGHT.rrd")]
    save: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    window: crate::window::WindowArgs,
}

#[cfg(feature = "rerun")]
mod with_rerun {
    use std::path::Path;
    use std::process::Command;

    use anyhow::{Context, bail};
    use engine::STEP_NS;
    use logs::output::Output;
    use logs::text::{at, size};
    use replay::judgement::disorder;
    use replay::view::{DrawError, FlightView, Other, Severity, draw_against, severity};
    use replay::{Facts, Reflight, ReflyOptions, Window};

    use super::{Args, Result, Status};

    /// Reflies the log into a recording, and opens the viewer unless it is to be saved.
    pub fn run(args: &Args) -> Result<Status> {
        let saved = args.save.clone().unwrap_or_else(|| args.log.with_extension("rrd"));
        let inputs: Vec<&Path> =
            [Some(&args.log), args.against.as_ref()].into_iter().flatten().map(|f| &**f).collect();
        let output = Output::beside(&saved, args.force, &inputs)?;
        let window = args.window.of(&args.log)?;
        let (bytes, status) = match &args.against {
            Some(_) if window != Window::default() => {
                bail!(
                    "--against shows whole flights; `tiltrotor log clip` makes logs of their parts"
                )
            }
            Some(other) => save_against(&args.log, Other::Log(other), &output)?,
            None => save(&args.log, &output, &window)?,
        };
        output.finish()?;
        say!("{}: {} for rerun", saved.display(), size(bytes));
        if args.save.is_none() {
            Command::new("rerun").arg(&saved).spawn().with_context(|| {
                format!(
                    "no `rerun` program to open {} with; `pip install rerun-sdk==0.36.3` brings one",
                    saved.display()
                )
            })?;
        }
        Ok(status)
    }

    /// Draws the log and what is beside it into a recording; returns its size, and the status of the gravest of the two.
    fn save_against(log: &Path, other: Other, saved: &Output) -> Result<(u64, Status)> {
        let drawn = draw_against(log, other, saved).map_err(|error| match (&error, other) {
            // Which of the two logs it was is not known here.
            (DrawError::Replay(_), Other::Log(other)) => {
                anyhow::anyhow!("{} against {}: {error}", log.display(), other.display())
            }
            (DrawError::Replay(_), Other::Reflown) => anyhow::anyhow!("{}: {error}", log.display()),
            (DrawError::View(_), _) => error.into(),
        })?;
        match drawn.first_difference {
            Some(tick) => {
                say!("first difference at {}", at(tick));
            }
            None => say!("no difference"),
        }
        drawn.judgements.iter().for_each(|judgement| say!("{judgement}"));
        Ok((drawn.bytes, Status::gravest(drawn.judgements.iter().map(Status::from))))
    }

    /// Reflies the log into a recording, whose first event says what the log is; returns its size and the
    /// status.
    pub fn save(log: &Path, saved: &Output, window: &Window) -> Result<(u64, Status)> {
        let options = ReflyOptions { window: *window, across_versions: false };
        let mut flight =
            Reflight::open(log, &options).with_context(|| log.display().to_string())?;
        let title = log.file_stem().map_or_else(String::new, |stem| stem.display().to_string());
        let mut view = FlightView::new(saved, &title, &flight.aircraft)?;
        let mut facts = Facts::of_reflight(&flight);
        let start_tick = flight.state.tick;
        let disorder = loop {
            match flight.next_tick() {
                Ok(Some(reflown)) => {
                    view.push(reflown.outputs);
                    facts.add(reflown.recorded, Some(reflown.exact));
                }
                Ok(None) => break None,
                Err(error) => break Some(disorder(error)?),
            }
            flight.reader.timings.clear();
        };
        facts.end_of_reflight(&mut flight, disorder, window);
        let judgement = facts.judge();
        view.event(start_tick, severity(&judgement), &judgement.words);
        say!("{}: {judgement}", log.display());
        for remark in &flight.reader.remarks {
            let level = match remark.level {
                logs::view::Level::Info => Severity::Info,
                logs::view::Level::Warn => Severity::Warning,
                logs::view::Level::Error => Severity::Error,
            };
            view.event(remark.time_ns / STEP_NS, level, &remark.words);
        }
        Ok((view.finish()?, Status::from(&judgement)))
    }
}

#[cfg(feature = "rerun")]
pub use with_rerun::{run, save};

/// Says what is missing.
#[cfg(not(feature = "rerun"))]
pub fn run(args: &Args) -> Result<Status> {
    let Args { log, against: _, save: _, force: _, window: _ } = args;
    anyhow::bail!(
        "{}: this program was built without `rerun`; build it with the default features, or open the \
         log itself: `rerun {0}`",
        log.display()
    )
}
