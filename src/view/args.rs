//! What `view` is told.

use std::path::PathBuf;

/// What to show.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    pub log: PathBuf,
    /// Another log beside it: both aircraft in one scene, lines over each other, differences plotted
    #[arg(long, value_name = "OTHER")]
    pub against: Option<PathBuf>,
    /// What of the other log is laid beside the first: the same time, the start, the first lift-off, or a marker
    #[arg(
        long,
        value_name = "time|start|lift-off|marker:N",
        requires = "against",
        default_value = "time"
    )]
    pub align: String,
    /// Arrangement: pilot, engineer, rotor, latency, compare, or a file of one's own
    /// [default: pilot; compare with --against]
    #[arg(long, value_name = "NAME|FILE")]
    pub layout: Option<String>,
    /// Open there: a time in s (12.5), a tick (3125t), marker:N, event:N, latest (the tick that was the latest to
    /// begin), first-difference [default: the start; with --layout latency latest, where there is one; with
    /// --against first-difference]
    #[arg(long, value_name = "WHEN", allow_hyphen_values = true, conflicts_with = "save")]
    pub at: Option<String>,
    /// Save for the viewer instead of opening it
    #[arg(long, value_name = "FLIGHT.rrd")]
    pub save: Option<PathBuf>,
    /// Overwrite an existing file that is not a recording of ours
    #[arg(long)]
    pub force: bool,
    /// The viewer's program
    #[arg(long, value_name = "PROGRAM", default_value = "rerun", conflicts_with = "save")]
    pub viewer: PathBuf,
    #[command(flatten)]
    pub window: crate::window::WindowArgs,
}
