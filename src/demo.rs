//! `tiltrotor demo`.

use std::path::{Path, PathBuf};

use anyhow::Result;
use logs::output;
use replay::Window;
use replay::figures::Figure;

use crate::afterwards::Afterwards;
use crate::fly::{Common, Plan};
use crate::status::Status;
use crate::{fly, page, plot, report, verify};

/// The figures of the paper's flight, with their numbers there.
const PAPER: [(Figure, u32); 3] =
    [(Figure::Trajectory, 6), (Figure::Euler, 7), (Figure::Latency, 8)];

/// The demonstration flight.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    common: Common,
}

/// Where a figure of a log is: beside it.
fn figure_of(log: &Path, figure: Figure) -> PathBuf {
    log.with_file_name(plot::file_name(&[log], figure, "svg"))
}

/// The paper's figures of the flight and the report on it, beside its log.
fn afterwards(log: &Path, force: bool) -> Result<()> {
    let flown = Afterwards::of(log, &Window::default())?;
    for (figure, number) in PAPER {
        let path = figure_of(log, figure);
        let bytes = plot::svg(figure, &[&flown.flight])?;
        plot::write(&path, &bytes, force, &[log])?;
        say!("{}: {}, figure {number} of the paper", path.display(), figure.facts().words);
    }
    page::write(&flown, &page::beside(log), false, force, log)
}

/// Flies, verifies, draws, and sums up.
pub fn run(args: &Args) -> Result<Status> {
    let out = &args.common.out;
    let mut plan = Plan::new(&args.common, None)?;
    plan.flight.self_check = true;
    #[cfg(feature = "rerun")]
    let saved = out.with_extension("rrd");
    #[cfg(feature = "rerun")]
    output::refuse(&saved, args.common.force, &[])?;
    for path in PAPER.map(|(figure, _)| figure_of(out, figure)).iter().chain([&page::beside(out)]) {
        output::refuse(path, args.common.force, &[])?;
    }
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP)?;
    plan.set_pilot("demo", &map)?;
    plan.set_map(map)?;
    say!(
        "Vertical take-off, conversion, left turn, reconversion, landing where it began: flown by a"
    );
    say!("pilot model whose stick, lever, pedals and switches take the path that hardware takes.");
    if args.common.fast {
        say!("Three and a half minutes of flight, as fast as it goes. Ctrl-C ends it.");
    } else {
        say!("It takes three and a half minutes; `--fast` flies it in seconds. Ctrl-C ends it.");
    }
    let _linked = plan.connect()?;
    if let (Some(link), false) = (&plan.flight.link, args.common.fast) {
        let places: Vec<String> = link.destinations().map(|place| place.to_string()).collect();
        say!("Live in FlightGear at {}.", places.join(", "));
    }
    let real_time = plan.flight.real_time.is_some();
    let mut landing = plan.fly()?;
    report::landing(&landing, real_time, &out.display().to_string());
    if landing.log.is_err() {
        args.common.hold(&mut landing)?;
        return Ok(Status::CutShort);
    }
    let status = match verify::verify_one(out) {
        Status::Done if !fly::is_whole(&landing) => Status::CutShort,
        status => status,
    };
    afterwards(out, args.common.force)?;
    #[cfg(feature = "rerun")]
    {
        let output = output::Output::beside(&saved, args.common.force, &[out])?;
        let bytes = crate::view::save_default(out, &output)?;
        output.finish()?;
        let size = logs::text::size(bytes);
        say!("{}: {size}, for `tiltrotor view {}`", saved.display(), out.display());
    }
    args.common.hold(&mut landing)?;
    Ok(status)
}
