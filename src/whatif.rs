//! `tiltrotor whatif`.

use std::path::{Path, PathBuf};

use aircraft::EditError;
use anyhow::{Context, Result, anyhow, bail};
use engine::inputs::{Failures, World};
use engine::math::{atan2, min, sqrt};
use engine::units::{compass_deg, degrees, knots};
use engine::{Aircraft, Inputs, Outputs, STEP_S, State, step};
use logs::output::Output;
use logs::text::{at, size};
use logs::{FlightReader, Setup, Tick};
use replay::changes::{Changes, KEYS};
use replay::{NewLog, Source, Window, names_parent, parent, rewrite_in};

use crate::identity;
use crate::made::Made;
use crate::status::Status;
use crate::window::When;

/// What to change, and from when on.
#[derive(clap::Args)]
pub struct Args {
    /// The log whose inputs are flown
    log: PathBuf,
    #[command(flatten)]
    wanted: Wanted,
    /// From there on: a time in s (12.5), a tick (3125t), or a marker (marker:1)
    #[arg(long, value_name = "WHEN", default_value = "0t", allow_hyphen_values = true)]
    from: When,
    /// End there
    #[arg(long, value_name = "WHEN", allow_hyphen_values = true)]
    until: Option<When>,
    /// The new log [default: LOG with -whatif]
    #[arg(long, value_name = "NEW.mcap")]
    out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

/// The changes.
#[derive(clap::Args)]
#[group(required = true, multiple = true)]
struct Wanted {
    /// A number of the aircraft file, its unit in the key: rotors.gimbal.stop_deg=8 (several times)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Another aircraft file instead of the log's
    #[arg(long, value_name = "FILE")]
    aircraft: Option<PathBuf>,
    /// A number of the recorded world: wind_mps.x=5, gust_s=0, turbulence_mps=2 (several times)
    #[arg(long, value_name = "KEY=VALUE")]
    world: Vec<String>,
    /// A failure, from there to the end: engine_left, scas_yaw (several times)
    #[arg(long, value_name = "KEY")]
    fail: Vec<String>,
    /// A recorded failure taken away, from there to the end (several times)
    #[arg(long, value_name = "KEY")]
    mend: Vec<String>,
    /// Fly nothing: list the keys with their values and units
    #[arg(long, conflicts_with_all = ["set", "world", "fail", "mend", "until", "out", "force"])]
    list: bool,
}

/// Flies what would have been, and says what became of it.
pub fn run(args: &Args) -> Result<Status> {
    let (log, wanted) = (&args.log, &args.wanted);
    let name = || log.display().to_string();
    let source = Source::proven(log, "not flown").with_context(name)?;
    let mut reader = logs::open(log, replay::OPEN).with_context(name)?;
    let (setup, mut said) = wanted.setup(log, &reader.setup)?;
    let from_tick = args.from.tick(log)?;
    let until_tick = args.until.map(|until| until.tick(log)).transpose()?;
    if until_tick.is_some_and(|until| until <= from_tick) {
        bail!("--until is not after --from");
    }
    // A log that does not begin at tick 0 is flown from where it begins, unless told otherwise.
    let clamped = args.from == When::Tick(0);
    let window = Window { from_tick: Some(from_tick), until_tick, clamped };
    window.apply(&mut reader).with_context(name)?;
    if wanted.list {
        return list(&mut reader, &setup).with_context(name);
    }
    let initial = reader.initial;
    let changes = Changes::read(&wanted.world, &wanted.fail, &wanted.mend, initial.tick)?;
    said.extend(changes.words.iter().cloned());
    let out = args.out.clone().unwrap_or_else(|| beside(log));
    let identity = source
        .marks(names_parent(identity::identity(), log, &reader, "whatif"))
        .with(parent::CHANGES, said.join("; "));
    let inputs: Vec<&Path> =
        [Some(log), wanted.aircraft.as_ref()].into_iter().flatten().map(PathBuf::as_path).collect();
    let output = Output::beside(&out, args.force, &inputs)?;
    let new = NewLog {
        out: &output,
        setup: &setup,
        identity: &identity,
        timing: false,
        devices: &source.devices,
        picture_of: Some(log),
    };
    let mut baseline = Baseline::of(&reader).with_context(name)?;
    let mut apart = Apart::default();
    let written = rewrite_in(
        &mut reader,
        &initial,
        &new,
        |world| Ok(changes.apply(world)),
        |tick, state, outputs, _| apart.add(baseline.fly(tick), state, outputs),
    )
    .with_context(name)?;
    let made = Made::of(&source, output)?;
    say!("{}: {}", out.display(), said.join("; "));
    say!(
        "{:.3} s to {:.3} s of {} by its recorded inputs, {}, digest {:016x}",
        initial.time_s(),
        apart.last_tick as f64 * STEP_S,
        log.display(),
        size(written.closed.bytes),
        written.closed.digest
    );
    baseline.say();
    apart.say(&baseline);
    say!("`tiltrotor diff {} {}` says more", log.display(), out.display());
    Ok(made.say(log))
}

impl Wanted {
    /// The files to fly with, and what was changed of them in words.
    fn setup(&self, log: &Path, recorded: &Setup) -> Result<(Setup, Vec<String>)> {
        let (mut setup, mut said) = (recorded.clone(), Vec::new());
        if let Some(path) = &self.aircraft {
            setup.aircraft_toml = std::fs::read_to_string(path)
                .with_context(|| format!("cannot read {}", path.display()))?;
            aircraft::aircraft(&path.display().to_string(), &setup.aircraft_toml)?;
            said.push(format!("aircraft {}", path.display()));
        }
        for change in &self.set {
            let Some((key, value)) = change.split_once('=').map(|(k, v)| (k.trim(), v.trim()))
            else {
                bail!("--set {change}: expected KEY=VALUE");
            };
            let words =
                aircraft::change_in_words("aircraft.toml", &setup.aircraft_toml, key, value)?;
            let source = format!("what-if of {}", log.file_name().unwrap_or_default().display());
            setup.aircraft_toml =
                aircraft::set("aircraft.toml", &setup.aircraft_toml, key, value, &source)
                    .map_err(|error| with_a_way_out(error, log))
                    .with_context(|| format!("--set {change}"))?;
            // One at a time: the key that is wrong is the one that is told.
            aircraft::aircraft("aircraft.toml", &setup.aircraft_toml)
                .with_context(|| format!("--set {change}"))?;
            said.push(words);
        }
        Ok((setup, said))
    }
}

/// A key that is like no other is to be looked up.
fn with_a_way_out(error: EditError, log: &Path) -> anyhow::Error {
    match &error {
        EditError::UnknownKey { near, .. } if near.is_empty() => {
            anyhow!("{error}; `tiltrotor whatif {} --list` lists them all", log.display())
        }
        _ => error.into(),
    }
}

/// Prints every key that can be changed, with its value and unit.
fn list(reader: &mut FlightReader, setup: &Setup) -> Result<Status> {
    reader.next_tick()?;
    list_world(reader.tick.inputs.world);
    say!("--set KEY=VALUE, the unit in the key");
    for (key, value) in aircraft::values("aircraft.toml", &setup.aircraft_toml)? {
        say!("  {key} = {value}");
    }
    Ok(Status::Done)
}

/// Prints every key of the world with its value and unit, and every failure.
fn list_world(world: World) {
    let (wind, failures) = (world.wind_mps, world.failures);
    say!("--world KEY=VALUE");
    for key in &KEYS {
        let (value, (least, greatest)) = (key.value(world), key.range);
        let number = format!("{} = {value}", key.name);
        say!("  {number:<32} {:<4} {}, {least} to {greatest}", key.unit, key.description);
    }
    let speed_mps = sqrt(wind.x * wind.x + wind.y * wind.y);
    if speed_mps > 0.0 {
        let from_deg = compass_deg(atan2(-wind.y, -wind.x));
        say!("  {:<37} wind from {from_deg:03.0} deg, {speed_mps:.1} m/s", "");
    }
    say!("--fail KEY, --mend KEY");
    for fact in Failures::FACTS {
        let now = if failures.contains(fact.flag) { "failed" } else { "works" };
        say!("  {:<32} {now:<6} {}", fact.key, fact.description);
    }
}

/// The recorded inputs flown unchanged beside what is changed: without it nobody could tell what the
/// change did from what another program does.
struct Baseline {
    aircraft: Aircraft,
    state: State,
    /// The first tick that is not what was recorded.
    differs: Option<u64>,
}

impl Baseline {
    /// From where the reader stands.
    fn of(reader: &FlightReader) -> Result<Self> {
        let aircraft = replay::flown(&reader.setup)?.aircraft;
        let differs = (!reader.intact).then_some(reader.initial.tick);
        Ok(Self { aircraft, state: reader.initial, differs })
    }

    /// Flies the tick as it was recorded.
    fn fly(&mut self, tick: &Tick) -> &State {
        let inputs = Inputs { events: &tick.events, world: tick.inputs.world };
        self.state = step(&self.aircraft, &tick.begins_with(&self.state), &inputs).0;
        if !tick.chained || tick.record.state != self.state {
            self.differs.get_or_insert(self.state.tick);
        }
        &self.state
    }

    fn say(&self) {
        let Some(tick) = self.differs else {
            say!(
                "baseline: flown unchanged, the recorded inputs give the recorded states, to the bit"
            );
            return;
        };
        say!(
            "baseline: flown unchanged, the recorded inputs do not give the recorded states from {} on: \
             what differs from the recording is by the program (or an altered log) and by the change; \
             `tiltrotor verify` says more",
            at(tick)
        );
    }
}

fn beside(log: &Path) -> PathBuf {
    let stem = log.file_stem().unwrap_or_default().display().to_string();
    log.with_file_name(format!("{stem}-whatif.mcap"))
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
    fn add(&mut self, unchanged: &State, state: &State, outputs: &Outputs) {
        self.last_tick = state.tick;
        if self.first_tick.is_none() && unchanged != state {
            self.first_tick = Some(state.tick);
        }
        let (was, is) = (&unchanged.plant, &state.plant);
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

    fn say(&self, baseline: &Baseline) {
        match (self.first_tick, baseline.differs) {
            (None, None) => {
                say!("it makes no difference: every state is the recorded one, to the bit");
            }
            (None, Some(_)) => {
                say!("the change makes no difference: every state is the baseline's");
            }
            (Some(tick), differs) => {
                if differs.is_some() {
                    say!(
                        "what follows is the change alone, against the baseline as this program flies it"
                    );
                }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_like_no_other_is_to_be_looked_up_and_one_like_another_is_suggested() {
        let told = |error| with_a_way_out(error, Path::new("flight.mcap")).to_string();
        let unknown = |near: &[&str]| EditError::UnknownKey {
            key: "quux".into(),
            near: near.iter().map(ToString::to_string).collect(),
        };
        let list = "`tiltrotor whatif flight.mcap --list` lists them all";
        let lost = told(unknown(&[]));
        assert!(lost.contains("unknown key quux") && lost.ends_with(list), "{lost}");
        let meant = told(unknown(&["rotors.chord_ft"]));
        assert!(meant.contains("rotors.chord_ft") && !meant.contains("--list"), "{meant}");
        let table = told(EditError::Table { key: "rotors".into() });
        assert!(table.starts_with("rotors is a table") && !table.contains("--list"), "{table}");
    }

    #[test]
    fn a_new_log_stands_beside_its_source() {
        assert_eq!(beside(Path::new("flown/day.mcap")), Path::new("flown/day-whatif.mcap"));
    }
}
