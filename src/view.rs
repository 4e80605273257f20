//! `tiltrotor view`.

#[cfg(feature = "rerun")]
mod draw;
#[cfg(feature = "rerun")]
mod moment;
#[cfg(feature = "rerun")]
mod open;
#[cfg(feature = "rerun")]
mod viewer;

use std::path::PathBuf;

/// What to show.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Another log beside it: both aircraft in one scene, lines over each other, differences plotted
    #[arg(long, value_name = "OTHER")]
    against: Option<PathBuf>,
    /// What of the other log is laid beside the first: the same time, the start, the first lift-off, or a marker
    #[arg(
        long,
        value_name = "time|start|lift-off|marker:N",
        requires = "against",
        default_value = "time"
    )]
    align: String,
    /// Arrangement: pilot, engineer, rotor, latency, compare, or a file of one's own
    /// [default: pilot; compare with --against]
    #[arg(long, value_name = "NAME|FILE")]
    layout: Option<String>,
    /// Open there: a time in s (12.5), a tick (3125t), marker:N, event:N, first-difference
    /// [default: the start; first-difference with --against]
    #[arg(long, value_name = "WHEN", allow_hyphen_values = true, conflicts_with = "save")]
    at: Option<String>,
    /// Save for the viewer instead of opening it
    #[arg(long, value_name = "FLIGHT.rrd")]
    save: Option<PathBuf>,
    /// Overwrite an existing file that is not a recording of ours
    #[arg(long)]
    force: bool,
    /// The viewer's program
    #[arg(long, value_name = "PROGRAM", default_value = "rerun", conflicts_with = "save")]
    viewer: PathBuf,
    #[command(flatten)]
    window: crate::window::WindowArgs,
}

#[cfg(feature = "rerun")]
pub use draw::save_default;
#[cfg(feature = "rerun")]
pub use open::run;

/// Says what is missing.
#[cfg(not(feature = "rerun"))]
pub fn run(args: &Args) -> anyhow::Result<crate::status::Status> {
    let Args {
        log,
        against: _,
        align: _,
        layout: _,
        at: _,
        save: _,
        force: _,
        viewer: _,
        window: _,
    } = args;
    anyhow::bail!(
        "{}: this program was built without `rerun`; build it with the default features, or open the \
         log itself: `rerun {0}`",
        log.display()
    )
}
