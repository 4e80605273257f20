//! A new log from the inputs of another one: what-if, clipping and blessing are all this.

use std::path::Path;

use engine::inputs::World;
use engine::{Inputs, Outputs, State, observe, step};
use logs::devices::DeviceIdentity;
use logs::output::Output;
use logs::records::{EventRecord, FlightEvent, InputsRecord};
use logs::view::LogLine;
use logs::{
    Closed, Ending, EventDetector, FlightReader, FlightWriter, Identity, LogError, Messages,
    Observed, Setup, Tick,
};

use crate::refly::{OPEN, ReplayError, read};

/// Keys of a log's metadata that say what it was made from.
pub mod parent {
    /// What made it: `whatif`, `clip`, `bless`.
    pub const MADE_BY: &str = "made_by";
    /// File name of the log whose inputs it has.
    pub const NAME: &str = "parent";
    /// That log's last digest.
    pub const DIGEST: &str = "parent_digest";
    /// That log's digest at the state with which this one begins.
    pub const DIGEST_AT_START: &str = "parent_digest_at_start";
    /// Tick of that state.
    pub const FROM_TICK: &str = "parent_from_tick";
    /// What was changed.
    pub const CHANGES: &str = "changes";
    /// What it is kept for.
    pub const REASON: &str = "reason";
    /// What that log was, where it was not sound; or what one was that it was made from.
    pub const JUDGEMENT: &str = "parent_judgement";
    /// The first tick of that log that was not as it should be, or that it lacks.
    pub const FIRST_BAD_TICK: &str = "parent_first_bad_tick";
    /// The last digest before it was blessed.
    pub const BLESSED_FROM: &str = "blessed_from_digest";
}

/// The log to be written.
pub struct NewLog<'a> {
    /// Where; whoever asked for it finishes it.
    pub out: &'a Output,
    /// What it is flown with.
    pub setup: &'a Setup,
    /// Who flies.
    pub identity: &'a Identity,
    /// Whether to take over how the ticks kept time, and what is told of it: the flight is the recorded
    /// one, and not one that would have been.
    pub timing: bool,
    /// Input devices of the log whose inputs it has.
    pub devices: &'a [DeviceIdentity],
    /// The log whose pictures of the first state are taken over, message for message, where nothing was
    /// changed.
    pub picture_of: Option<&'a Path>,
}

/// A log that was written.
#[derive(Clone, Debug)]
pub struct Rewritten {
    /// Its size and last digest.
    pub closed: Closed,
    /// Ticks at which the wheels took weight in the log whose inputs it has.
    pub touchdown_ticks: Vec<u64>,
}

/// The facts that name a parent: `log` as it stands where `reader` begins.
pub fn names_parent(identity: Identity, log: &Path, reader: &FlightReader, by: &str) -> Identity {
    let name = log.file_name().map_or_else(String::new, |name| name.display().to_string());
    let digest =
        logs::closing(log).map_or("unknown".into(), |(_, digest)| format!("{digest:016x}"));
    // Its inputs are theirs.
    let identity = match reader.identity.0.get(Identity::FLOWN_BY) {
        Some(who) => identity.with(Identity::FLOWN_BY, who),
        None => identity,
    };
    identity
        .with(parent::MADE_BY, by)
        .with(parent::NAME, name)
        .with(parent::DIGEST, digest)
        .with(parent::DIGEST_AT_START, format!("{:016x}", reader.digest()))
        .with(parent::FROM_TICK, reader.initial.tick.to_string())
}

/// Flies the inputs of `reader`, from where it stands, with the aircraft of the new log, from `initial`
/// on, and writes all of it. `watch` sees every tick: as recorded, the state flown, and what could be
/// observed.
///
/// # Errors
/// When the files of the new log cannot be read, the old one is not a whole flight as far as it is
/// read, or the new one cannot be written.
pub fn rewrite(
    reader: &mut FlightReader,
    initial: &State,
    new: &NewLog<'_>,
    watch: impl FnMut(&Tick, &State, &Outputs, &FlightReader),
) -> Result<Rewritten, ReplayError> {
    rewrite_in(reader, initial, new, Ok, watch)
}

/// The same in another world: `change` makes that of each tick of the recorded one, or refuses to go on.
///
/// # Errors
/// As for [`rewrite`], and what `change` says.
pub fn rewrite_in(
    reader: &mut FlightReader,
    initial: &State,
    new: &NewLog<'_>,
    change: impl Fn(World) -> Result<World, ReplayError>,
    mut watch: impl FnMut(&Tick, &State, &Outputs, &FlightReader),
) -> Result<Rewritten, ReplayError> {
    let flown = read(new.setup)?;
    let aircraft = &flown.aircraft;
    let same_aircraft = new.setup.aircraft_toml == reader.setup.aircraft_toml;
    let shape = match reader.robot_description.as_str() {
        known if same_aircraft && !known.is_empty() => known.to_string(),
        _ => aircraft::urdf(aircraft),
    };
    let mut writer =
        FlightWriter::create(new.out.file()?, new.setup, new.identity, aircraft, &shape, initial)?;
    let mut touchdown_ticks = Vec::new();
    let mut written = || -> Result<(), ReplayError> {
        let mut detector = EventDetector::new(initial, &aircraft.envelope.airframe);
        let mut state = *initial;
        let log = new.picture_of.filter(|_| same_aircraft && reader.initial == *initial);
        let pictured = log.map(|log| take_picture(log, state.tick, &mut writer)).transpose()?;
        if state.tick == 0 && pictured != Some(true) {
            let seen = observe(aircraft, &state, &flown.world);
            writer.view(&seen, state.plant.attitude)?;
        }
        for device in new.devices.iter().filter(|device| device.tick <= state.tick) {
            writer.device(device)?;
        }
        while reader.next_tick()?.is_some() {
            let tick = &reader.tick;
            if let Some(restart) = &tick.restart {
                writer.restart(restart)?;
                detector.restart(&mut writer, restart)?;
            }
            for event in &tick.events {
                writer.event(event)?;
                detector.event(&mut writer, event)?;
            }
            let inputs = InputsRecord { world: change(tick.inputs.world)?, ..tick.inputs };
            writer.inputs(&inputs)?;
            detector.inputs(&mut writer, &inputs)?;
            crew_said(reader, &mut writer, new.timing, &mut touchdown_ticks)?;
            for device in reader.devices.drain(..).filter(|device| device.tick > initial.tick) {
                writer.device(&device)?;
            }
            let tick = &reader.tick;
            let inputs = Inputs { events: &tick.events, world: inputs.world };
            let (next, outputs) = step(aircraft, &tick.begins_with(&state), &inputs);
            state = next;
            for timing in reader.timings.drain(..).filter(|_| new.timing) {
                writer.timing(&timing)?;
            }
            writer.state(&state)?;
            detector.state(&mut writer, &state, &Observed::of(&outputs))?;
            writer.view(&outputs, state.plant.attitude)?;
            watch(&reader.tick, &state, &outputs, reader);
            reader.outputs.retain(|outputs| outputs.tick > state.tick);
        }
        crew_said(reader, &mut writer, new.timing, &mut touchdown_ticks)?;
        match reader.ending() {
            Some(Ending::Damaged(why)) => Err(LogError::Order(format!("damaged: {why}")).into()),
            _ => Ok(()),
        }
    };
    written()?;
    Ok(Rewritten { closed: writer.finish()?, touchdown_ticks })
}

/// Takes over what viewers drew of a tick; `false` when there is nothing of it.
fn take_picture(log: &Path, tick: u64, writer: &mut FlightWriter) -> Result<bool, LogError> {
    let mut messages = Messages::open(log, OPEN)?;
    messages.limit(tick, tick)?;
    let mut any = false;
    while let Some(message) = messages.next_message() {
        any |= writer.picture(message)?;
    }
    Ok(any)
}

/// Takes over what only the crew could know, and with `timing` the machine; everything else is told anew
/// from the numbers.
fn crew_said(
    reader: &mut FlightReader,
    writer: &mut FlightWriter,
    timing: bool,
    touchdown_ticks: &mut Vec<u64>,
) -> Result<(), LogError> {
    let log_lines: Vec<LogLine> = reader.log_lines.drain(..).collect();
    let events: Vec<EventRecord> = reader.events.drain(..).collect();
    let touchdown =
        |event: &&EventRecord| event.kind == FlightEvent::WeightOnWheels as u64 && event.value == 1;
    touchdown_ticks.extend(events.iter().filter(touchdown).map(|event| event.tick));
    for (event, line) in events.iter().zip(&log_lines) {
        let Some(what) = FlightEvent::from_u64(event.kind) else { continue };
        let known_by_machine =
            matches!(what, FlightEvent::Slip | FlightEvent::WriterHeldUp | FlightEvent::SelfCheck);
        let by_crew = matches!(
            what,
            FlightEvent::Phase
                | FlightEvent::Landed
                | FlightEvent::GaveUp
                | FlightEvent::SituationSaved
        );
        if by_crew || timing && known_by_machine {
            writer.flight_event(event.tick, what, event.value, event.measured, &line.words)?;
        }
    }
    Ok(())
}
