//! `tiltrotor devices`.

#[cfg(feature = "sticks")]
mod look;

use std::path::PathBuf;

use anyhow::Result;

use crate::status::Status;

/// The rule that lets who sits at the machine read its sticks.
const UDEV_RULE: &str = include_str!("../recorder/udev/70-tiltrotor.rules");

/// What to look at.
#[derive(clap::Args)]
pub struct Args {
    /// By this cockpit map: a file, or the name of a shipped one (the shipped ones without)
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Show where every axis and button is, until interrupted
    #[arg(long)]
    watch: bool,
    /// End --watch, or the wait for each movement of --map-new, after so long, s
    #[arg(long, value_name = "SECONDS", value_parser = crate::numbers::duration_s)]
    seconds: Option<f64>,
    /// Write a new cockpit map: asks for one movement after the other
    #[arg(long, value_name = "FILE", conflicts_with_all = ["watch", "map"])]
    map_new: Option<PathBuf>,
    /// Overwrite an existing map
    #[arg(long, requires = "map_new")]
    force: bool,
    /// Print the udev rule by which the user at this machine may read its sticks
    #[arg(long, conflicts_with_all = ["watch", "map", "map_new"])]
    udev_rule: bool,
}

/// Carries it out.
pub fn run(args: &Args) -> Result<Status> {
    if args.udev_rule {
        UDEV_RULE.lines().for_each(|line| say!("{line}"));
        return Ok(Status::Done);
    }
    look(args)
}

#[cfg(feature = "sticks")]
fn look(args: &Args) -> Result<Status> {
    match (&args.map_new, args.watch) {
        (Some(path), _) => look::map_new(path, args.force, args.seconds),
        (None, true) => look::watch(args.seconds),
        (None, false) => look::list(args.map.as_deref()),
    }
}

#[cfg(not(feature = "sticks"))]
fn look(_: &Args) -> Result<Status> {
    anyhow::bail!("this program was built without `sticks`: build it with the default features")
}
