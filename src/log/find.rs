//! `tiltrotor log find`.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use engine::STEP_S;
use engine::cockpit;
use engine::inputs::{DeviceEvent, EventKind, World};
use logs::fields::{Field, fields};
use logs::records::FlightEvent;
use logs::{Ending, FlightReader, LogError, OpenOptions};
use replay::Outcome;

use crate::status::Status;
use crate::window::WindowArgs;

/// Kinds beside those of events: what the world's numbers and the buttons did.
const WORLD: &str = "world";
const BUTTON: &str = "button";

/// What to look for.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Only this kind: the key of an event (docs/events.md), `world`, or `button`; may stand several times
    #[arg(long, value_name = "KEY")]
    kind: Vec<String>,
    #[command(flatten)]
    window: WindowArgs,
}

/// Something that was found.
struct Found {
    tick: u64,
    kind: &'static str,
    words: String,
}

/// Prints what happened, and every change of the world and of a button, in order of time.
pub fn run(args: &Args) -> Result<Status> {
    let name = args.log.display();
    let known = || FlightEvent::KEYS.iter().copied().chain([WORLD, BUTTON]);
    if let Some(odd) = args.kind.iter().find(|kind| !known().any(|key| key == kind.as_str())) {
        bail!("--kind {odd}: expected one of {}", known().collect::<Vec<_>>().join(", "));
    }
    let window = args.window.of(&args.log)?;
    let across = OpenOptions { aircraft_of: None, across_versions: true };
    let mut reader = match logs::open(&args.log, across) {
        // A compacted log is this version's, or nobody's.
        Err(LogError::Compacted) => logs::open(&args.log, replay::OPEN),
        opened => opened,
    }
    .with_context(|| name.to_string())?;
    // One that cannot be understood has no buttons with names; what was pressed is told all the same.
    let map = aircraft::cockpit("cockpit.toml", &reader.setup.cockpit_toml).unwrap_or_default();
    let (from, until) = (window.from_tick.unwrap_or(0), window.until_tick.unwrap_or(u64::MAX));
    let mut found = Vec::new();
    let disorder = search(&mut reader, &map, until, &mut found)?;
    // Inputs come before what they lead to, and events are told when they are known.
    found.sort_by_key(|found| found.tick);
    let wanted = |found: &&Found| {
        (from..=until).contains(&found.tick)
            && (args.kind.is_empty() || args.kind.iter().any(|kind| kind == found.kind))
    };
    let mut count = 0;
    for Found { tick, kind, words } in found.iter().filter(wanted) {
        count += 1;
        say!("{:>10.3} s  {kind:<16} {words}", *tick as f64 * STEP_S);
    }
    if count == 0 {
        say!("{name}: nothing of the kind happened there");
    }
    if let Some(error) = disorder {
        bail!("{name}: unusable from there on: {error}");
    }
    if let Some(Ending::Damaged(why)) = reader.ending() {
        bail!("{name}: damaged from there on: {why}");
    }
    let never_closed = reader.ending() == Some(&Ending::Truncated);
    let judgement = replay::judge(&args.log, &window);
    complain!("tiltrotor: {name}: {judgement}");
    // What cannot be judged can still be read.
    Ok(match judgement.outcome {
        Outcome::Unusable if never_closed => Status::NeverClosed,
        Outcome::Unusable => Status::Done,
        _ => Status::from(&judgement),
    })
}

/// Reads up to a tick and finds everything; what is wrong with the order of messages, if anything.
fn search(
    reader: &mut FlightReader,
    map: &cockpit::Params,
    until: u64,
    found: &mut Vec<Found>,
) -> Result<Option<LogError>> {
    let mut world = fields(&World::default())?;
    let disorder = loop {
        match reader.next_tick() {
            Ok(Some(tick)) => {
                found.extend(tick.events.iter().filter_map(|event| button(event, map)));
                let now = fields(&tick.inputs.world)?;
                changes(tick.inputs.tick, &world, &now, found);
                world = now;
                // What is told of the last tick comes after its state.
                if tick.record.state.tick > until {
                    break None;
                }
            }
            Ok(None) => break None,
            Err(error @ (LogError::Order(_) | LogError::Decode(_))) => break Some(error),
            Err(error) => return Err(error.into()),
        }
        reader.timings.clear();
    };
    for (event, line) in reader.events.iter().zip(&reader.log_lines) {
        let kind = FlightEvent::from_u64(event.kind).map_or("unknown", |known| known.facts().key);
        found.push(Found { tick: event.tick, kind, words: line.words.clone() });
    }
    Ok(disorder)
}

/// What a button did, by the name of what it does.
fn button(event: &DeviceEvent, map: &cockpit::Params) -> Option<Found> {
    if EventKind::from_u64(event.kind) != Some(EventKind::Button) {
        return None;
    }
    let code = cockpit::Code::Key(event.code);
    let bound = map.device(event.device).and_then(|device| device.buttons_of(code).next());
    let name = bound.map_or_else(
        || format!("{} of device {}", code.name(), event.device),
        |bound| bound.control.facts().words.to_string(),
    );
    let did = if event.value != 0 { "pressed" } else { "released" };
    Some(Found { tick: event.tick, kind: BUTTON, words: format!("{name} {did}") })
}

/// Every number of the world that is not what it was.
fn changes(tick: u64, was: &[Field], now: &[Field], found: &mut Vec<Found>) {
    for (was, now) in was.iter().zip(now).filter(|(was, now)| was.value != now.value) {
        let words = format!("{}: {} -> {}", now.path, was.value, now.value);
        found.push(Found { tick, kind: WORLD, words });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_button_is_told_by_what_it_does_and_by_its_code_where_it_does_nothing() {
        let map = "[[device]]\nname = \"T\"\nbutton = [{ code = 288, control = \"marker\" }]";
        let map = aircraft::cockpit("map.toml", map).unwrap();
        let told = |kind: EventKind, device, code, value| {
            let event = DeviceEvent {
                tick: 9,
                kind: kind as u64,
                device,
                code,
                value,
                ..Default::default()
            };
            button(&event, &map).map(|Found { tick, kind, words }| {
                assert_eq!((tick, kind), (9, "button"));
                words
            })
        };
        let is = |words: &str| Some(words.to_string());
        assert_eq!(told(EventKind::Button, 0, 288, 1), is("marker pressed"));
        assert_eq!(told(EventKind::Button, 0, 288, 0), is("marker released"));
        assert_eq!(told(EventKind::Button, 0, 289, 1), is("BTN_THUMB of device 0 pressed"));
        assert_eq!(told(EventKind::Button, 3, 288, 0), is("BTN_TRIGGER of device 3 released"));
        for kind in [EventKind::Axis, EventKind::ButtonPosition, EventKind::Disconnected] {
            assert_eq!(told(kind, 0, 288, 1), None, "{kind:?}");
        }
    }

    #[test]
    fn numbers_that_changed_are_told_and_others_are_not() {
        let mut world = World::default();
        let was = fields(&world).unwrap();
        world.turbulence_mps = 1.5;
        world.paused = 1;
        let mut found = Vec::new();
        changes(7, &was, &fields(&world).unwrap(), &mut found);
        let mut words: Vec<_> = found.iter().map(|found| found.words.as_str()).collect();
        words.sort_unstable();
        assert_eq!(words, ["paused: 0 -> 1", "turbulence_mps: 0.0 -> 1.5"]);
        assert!(found.iter().all(|found| found.tick == 7 && found.kind == "world"));
    }
}
