//! `tiltrotor whatif`.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use engine::math::{atan2, min, sqrt};
use engine::units::{degrees, knots};
use engine::{Outputs, STEP_S, State};
use logs::text::size;
use replay::{NewLog, Source, Window, names_parent, parent, rewrite};

use crate::identity;
use crate::made::Made;
use crate::status::Status;
use crate::window::When;

/// What to change, and from when on.
#[derive(clap::Args)]
pub struct Args {
    /// The log whose inputs are flown
    log: PathBuf,
    /// A number of the aircraft file, its unit in the key: rotors.gimbal.stop_deg=8 (several times)
    #[arg(long, value_name = "KEY=VALUE", required_unless_present = "aircraft")]
    set: Vec<String>,
    /// Another aircraft file instead of the log's
    #[arg(long, value_name = "FILE")]
    aircraft: Option<PathBuf>,
    /// From there on: a time in s (12.5), a tick (3125t), or a marker (marker:1)
    #[arg(long, value_name = "WHEN", default_value = "0t")]
    from: When,
    /// End there
    #[arg(long, value_name = "WHEN")]
    until: Option<When>,
    /// The new log [default: LOG with -whatif]
    #[arg(long, value_name = "NEW.mcap")]
    out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

/// Flies what would have been, and says what became of it.
pub fn run(args: &Args) -> Result<Status> {
    let log = &args.log;
    let name = || log.display().to_string();
    let source = Source::proven(log, "not flown").with_context(name)?;
    let mut reader = logs::open(log, replay::OPEN).with_context(name)?;
    let mut setup = reader.setup.clone();
    let mut changes = Vec::new();
    if let Some(path) = &args.aircraft {
        setup.aircraft_toml = std::fs::read_to_string(path)
            .with_context(|| format!("cannot read {}", path.display()))?;
        aircraft::aircraft(&path.display().to_string(), &setup.aircraft_toml)?;
        changes.push(format!("aircraft {}", path.display()));
    }
    for change in &args.set {
        let Some((key, value)) = change.split_once('=').map(|(k, v)| (k.trim(), v.trim())) else {
            bail!("--set {change}: expected KEY=VALUE");
        };
        let source = format!("what-if of {}", log.file_name().unwrap_or_default().display());
        setup.aircraft_toml =
            aircraft::set("aircraft.toml", &setup.aircraft_toml, key, value, &source)
                .with_context(|| format!("--set {change}"))?;
        // One at a time: the key that is wrong is the one that is told.
        aircraft::aircraft("aircraft.toml", &setup.aircraft_toml)
            .with_context(|| format!("--set {change}"))?;
        changes.push(format!("{key} = {value}"));
    }
    let from_tick = args.from.tick(log)?;
    let until_tick = args.until.map(|until| until.tick(log)).transpose()?;
    if until_tick.is_some_and(|until| until <= from_tick) {
        bail!("--until is not after --from");
    }
    // A log that does not begin at tick 0 is flown from where it begins, unless told otherwise.
    let clamped = args.from == When::Tick(0);
    let window = Window { from_tick: Some(from_tick), until_tick, clamped };
    window.apply(&mut reader).with_context(name)?;
    let out = args.out.clone().unwrap_or_else(|| beside(log));
    refuse_itself(log, &out)?;
    let identity = source
        .marks(names_parent(identity::identity(), log, &reader, "whatif"))
        .with(parent::CHANGES, changes.join("; "));
    let new = NewLog {
        out: &out,
        force: args.force,
        setup: &setup,
        identity: &identity,
        timing: false,
        picture_of: Some(log),
    };
    let initial = reader.initial;
    let mut apart = Apart::default();
    let written = rewrite(&mut reader, &initial, &new, |tick, state, outputs, _| {
        apart.add(&tick.record.state, state, outputs);
    })
    .with_context(name)?;
    let made = Made::of(&source, &out)?;
    say!("{}: {}", out.display(), changes.join("; "));
    say!(
        "{:.3} s to {:.3} s of {} by its recorded inputs, {}, digest {:016x}",
        initial.time_s(),
        apart.last_tick as f64 * STEP_S,
        log.display(),
        size(written.closed.bytes),
        written.closed.digest
    );
    apart.say();
    say!("`tiltrotor diff {} {}` says more", log.display(), out.display());
    Ok(made.say(log))
}

fn beside(log: &Path) -> PathBuf {
    let stem = log.file_stem().unwrap_or_default().display().to_string();
    log.with_file_name(format!("{stem}-whatif.mcap"))
}

/// A log is not to be written over while it is read.
pub fn refuse_itself(log: &Path, out: &Path) -> Result<()> {
    if let (Ok(log), Ok(out)) = (log.canonicalize(), out.canonicalize())
        && log == out
    {
        bail!("{}: the new log cannot be the old one", log.display());
    }
    Ok(())
}

/// How far the two flights came apart.
#[derive(Default)]
struct Apart {
    first_tick: Option<u64>,
    last_tick: u64,
    distance_m: f64,
    attitude_deg: f64,
    airspeed_kt: f64,
    outside: Option<u64>,
}

impl Apart {
    fn add(&mut self, recorded: &State, state: &State, outputs: &Outputs) {
        self.last_tick = state.tick;
        if self.first_tick.is_none() && recorded != state {
            self.first_tick = Some(state.tick);
        }
        let (was, is) = (&recorded.plant, &state.plant);
        self.distance_m = (is.position_m - was.position_m).norm();
        let (a, b) = (was.attitude, is.attitude);
        let cosine = min((a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z).abs(), 1.0);
        let sine = sqrt(1.0 - cosine * cosine);
        self.attitude_deg = degrees(2.0 * atan2(sine, cosine));
        self.airspeed_kt = knots(is.velocity_mps.norm() - was.velocity_mps.norm());
        if !outputs.validity.is_empty() {
            self.outside.get_or_insert(state.tick);
        }
    }

    fn say(&self) {
        match self.first_tick {
            None => say!("it makes no difference: every state is the recorded one, to the bit"),
            Some(tick) => {
                say!("apart from {:.3} s on; at the end", tick as f64 * STEP_S);
                say!("  position       {:.3} m", self.distance_m);
                say!("  attitude       {:.3} deg", self.attitude_deg);
                say!("  ground speed   {:+.3} kt", self.airspeed_kt);
            }
        }
        if let Some(tick) = self.outside {
            say!("outside the model's validity from {:.3} s on", tick as f64 * STEP_S);
        }
    }
}
