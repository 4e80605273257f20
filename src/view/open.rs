//! The verb: draws what is not drawn yet, and opens the viewer.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use logs::output::{self, Output};
use logs::text::{at, size};
use replay::Window;
use replay::view::{Layout, Mark, Stamp, Standing};

use super::args::Args;
use super::draw::{self, Drawing, layout};
use super::moment::{self, Align, At, Place};
use super::viewer::Viewer;
use crate::status::Status;
use crate::window::When;

/// Draws the log, unless that is done, and shows it.
pub fn run(args: &Args) -> Result<Status> {
    let at: Option<At> =
        args.at.as_deref().map(str::parse).transpose().map_err(anyhow::Error::msg)?;
    let align: Align = args.align.parse().map_err(anyhow::Error::msg)?;
    let layout = layout(args.layout.as_deref(), args.against.is_some())?;
    let inputs: Vec<&Path> =
        [Some(&args.log), args.against.as_ref()].into_iter().flatten().map(|f| &**f).collect();
    for log in &inputs {
        logs::open(log, replay::OPEN).with_context(|| log.display().to_string())?;
    }
    // Better now than after a minute of drawing.
    let viewer = match args.save {
        Some(_) => None,
        None => Some(Viewer::find(&args.viewer)?),
    };
    let saved = args.save.clone().unwrap_or_else(|| beside_the_log(args));
    let window = args.window.of(&args.log)?;
    if args.against.is_some() && window != Window::default() {
        bail!("--against shows whole flights; `tiltrotor log clip` makes logs of their parts");
    }
    let shift_ticks = match &args.against {
        Some(other) => align.shift_ticks(&args.log, other)?,
        None => 0,
    };
    let beside = args.against.as_deref().map(|other| (other, shift_ticks));
    let at = match at {
        None if layout == Layout::Latency && viewer.is_some() && window == Window::default() => {
            moment::latest(&args.log)?.map(|tick| At::When(When::Tick(tick)))
        }
        at => at,
    };
    let place = at.map(|at| at.place(&args.log, &window, beside)).transpose()?;
    let how = format!("{layout:?} {window:?} {shift_ticks}");
    let drawing = Drawing { stamp: draw::stamp(&inputs, &how)?, layout, window, shift_ticks };
    let mark = match standing(args, &saved, &drawing.stamp, &inputs)? {
        Standing::Fresh(mark) if args.save.is_none() => {
            say!("{}: drawn before, of this log by this program", saved.display());
            mark
        }
        _ => draw(args, &saved, &drawing, &inputs)?,
    };
    let status = Status::of_number(mark.status);
    if let Some(viewer) = viewer {
        viewer.show(&saved, opens_at(args, place, mark))?;
    }
    Ok(status)
}

/// Where a recording is that is not asked for by name: beside the log.
fn beside_the_log(args: &Args) -> PathBuf {
    let Some(other) = &args.against else { return args.log.with_extension("rrd") };
    let stem = |path: &Path| path.file_stem().unwrap_or_default().display().to_string();
    args.log.with_file_name(format!("{}-against-{}.rrd", stem(&args.log), stem(other)))
}

/// What stands in the recording's place; somebody else's file is refused.
fn standing(args: &Args, saved: &Path, stamp: &Stamp, inputs: &[&Path]) -> Result<Standing> {
    let cannot = || format!("cannot read {}", saved.display());
    let standing = match stamp.standing(saved) {
        // What is neither a file nor can be read is for whoever writes there.
        Err(error) if error.kind() == std::io::ErrorKind::IsADirectory => Standing::Foreign,
        standing => standing.with_context(cannot)?,
    };
    // A recording asked for by name is overwritten when asked for, too.
    if standing == Standing::Foreign || args.save.is_some() {
        output::refuse(saved, args.force, inputs)?;
    }
    Ok(standing)
}

fn draw(args: &Args, saved: &Path, drawing: &Drawing, inputs: &[&Path]) -> Result<Mark> {
    let force = args.force || args.save.is_none();
    let output = Output::beside(saved, force, inputs)?;
    let (bytes, mark) = match &args.against {
        Some(other) => draw::two(&args.log, other, &output, drawing)?,
        None => draw::one(&args.log, &output, drawing)?,
    };
    output.finish()?;
    say!("{}: {} for rerun", saved.display(), size(bytes));
    Ok(mark)
}

/// The tick that the viewer opens at.
fn opens_at(args: &Args, wanted: Option<Place>, mark: Mark) -> Option<u64> {
    let tick = match wanted {
        Some(Place::FirstDifference) => {
            if mark.first_difference.is_none() {
                say!("no difference: opening at the start");
            }
            mark.first_difference
        }
        Some(Place::Tick(tick)) => Some(tick),
        None => mark.first_difference.filter(|_| args.against.is_some()),
    };
    if let Some(tick) = tick {
        say!("opens at {}", at(tick));
    }
    tick
}
