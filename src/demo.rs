//! `tiltrotor demo`.

use anyhow::Result;
#[cfg(feature = "rerun")]
use logs::output;

use crate::fly::{Common, Plan};
use crate::status::Status;
use crate::{fly, report, verify};

/// The demonstration flight.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    common: Common,
}

/// Flies, verifies, saves for the viewer, and sums up.
pub fn run(args: &Args) -> Result<Status> {
    let out = &args.common.out;
    let mut plan = Plan::new(&args.common, None)?;
    plan.flight.self_check = true;
    #[cfg(feature = "rerun")]
    let saved = out.with_extension("rrd");
    #[cfg(feature = "rerun")]
    output::refuse(&saved, args.common.force, &[])?;
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
    #[cfg(feature = "rerun")]
    {
        let output = output::Output::beside(&saved, args.common.force, &[out])?;
        let (bytes, _) = crate::view::save(out, &output, &replay::Window::default())?;
        output.finish()?;
        say!("{}: {}, for `rerun {0}`", saved.display(), logs::text::size(bytes));
    }
    args.common.hold(&mut landing)?;
    Ok(status)
}
