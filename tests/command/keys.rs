//! What the crew does by key: flown, recorded, verified to the bit, compacted, and told as events.
//!
//! The keys are given to the loop as the panel gives them; how a terminal's keys are read is tested in
//! `src/panel/keys.rs`, and all of it together by `tests/keyboard_flight.sh`.

use std::path::{Path, PathBuf};

use engine::cockpit;
use engine::inputs::Failures;
use engine::{Outputs, State};
use logs::records::{FlightEvent, RESTART, RestartRecord};
use logs::{FlightReader, Identity, OpenOptions, Setup};
use recorder::keyboard::{KeyAction, Keyboard, Order, Orders};
use recorder::{Controller, Flight, Landing, Progress, Restart, TickContext, situation};

use crate::common::{
    DIVERGED, Forgery, INCOMPLETE, OK, UNUSABLE, chain_anew, folder, place_of, text, tiltrotor,
    verify,
};

/// Presses keys at their ticks.
struct Typist {
    orders: Orders,
    keys: Vec<(u64, Order)>,
    next: usize,
    until_tick: u64,
}

impl Controller for Typist {
    fn act(&mut self, _: &Outputs, context: &mut TickContext<'_>) {
        while let Some((_, order)) = self.keys.get(self.next).filter(|key| key.0 <= context.tick) {
            assert!(self.orders.give(*order));
            self.next += 1;
        }
        *context.done = context.tick >= self.until_tick;
    }
}

fn press(tick: u64, action: KeyAction) -> (u64, Order) {
    (tick, Order::Press(action))
}

/// Flies the keys from a start position or a situation.
fn fly(
    log: &Path,
    start: &str,
    from: Option<&Path>,
    keys: Vec<(u64, Order)>,
    until: u64,
) -> Landing {
    let text = aircraft::STARTS.iter().find(|(name, ..)| *name == start).expect("a start").2;
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    let map: cockpit::Params =
        aircraft::cockpit("keyboard.toml", aircraft::KEYBOARD_MAP).expect("a map");
    let (keyboard, orders) = Keyboard::of(&map).expect("a keyboard");
    let typist = Typist { orders, keys, next: 0, until_tick: until };
    let flight = Flight {
        start: aircraft::start(start, text).expect("a scenario"),
        setup: Setup {
            aircraft_toml: aircraft::XV15.into(),
            cockpit_toml: aircraft::KEYBOARD_MAP.into(),
            scenario_toml: text.into(),
        },
        identity: Identity::new(),
        robot_description: aircraft::urdf(&xv15),
        situation: from.map(|file| situation::load(file, &xv15.name).expect("a situation")),
        aircraft: xv15.with_cockpit(map),
        controllers: vec![Box::new(typist), Box::new(keyboard)],
        #[cfg(feature = "sticks")]
        sticks: None,
        out: log.to_path_buf(),
        force: false,
        real_time: None,
        ticks_max: None,
        link: None,
        self_check: true,
    };
    let landing = recorder::fly(flight, &Progress::default()).expect("it flies");
    assert!(landing.log.is_ok());
    let checked = landing.checked.as_ref().expect("checked");
    assert_eq!((checked.mismatches, checked.dropped), (0, 0));
    landing
}

/// Verifies the log, compacts it and verifies that, and reads it.
fn proven(log: &Path) -> FlightReader {
    verify(log).ends(OK).says("exact");
    tiltrotor(&["log", "compact", text(log)]).ends(OK);
    let stem = log.file_stem().expect("a name").to_str().expect("letters");
    verify(&log.with_file_name(format!("{stem}-compact.mcap"))).ends(OK).says("exact");
    let mut reader = logs::open(log, OpenOptions::default()).expect("a log");
    while reader.next_tick().expect("a tick").is_some() {}
    reader
}

/// The states after these ticks.
fn states(log: &Path, ticks: &[u64]) -> Vec<State> {
    let mut reader = logs::open(log, OpenOptions::default()).expect("a log");
    let mut found = Vec::new();
    while let Some(tick) = reader.next_tick().expect("a tick") {
        if ticks.contains(&tick.record.state.tick) {
            found.push(tick.record.state);
        }
    }
    assert_eq!(found.len(), ticks.len());
    found
}

fn events(reader: &FlightReader, kind: FlightEvent) -> Vec<(u64, u64)> {
    let of = reader.events.iter().filter(|event| event.kind == kind as u64);
    of.map(|event| (event.tick, event.value)).collect()
}

fn log(name: &str) -> PathBuf {
    folder(name).join("flight.mcap")
}

#[test]
fn every_key_is_a_recorded_input() {
    let log = log("keys-every");
    // What goes elsewhere has tests of its own.
    let elsewhere = [KeyAction::SaveSituation, KeyAction::ResetToStart];
    let keys = KeyAction::ALL.iter().filter(|action| !elsewhere.contains(action));
    let keys = (1..).zip(keys).map(|(number, &action)| press(20 * number, action)).collect();
    let landing = fly(&log, "hover-50ft", None, keys, 1200);
    assert!(landing.events > 100, "{}", landing.events);
    let reader = proven(&log);
    assert_eq!(events(&reader, FlightEvent::Marker).len(), 1);
}

#[test]
fn a_situation_is_saved_and_loaded_in_the_same_flight_and_in_another() {
    let log = log("keys-situation");
    let keys = vec![
        press(10, KeyAction::LeverUp),
        press(20, KeyAction::StickForward),
        press(200, KeyAction::SaveSituation),
        press(300, KeyAction::StickRight),
        press(600, KeyAction::LoadSituation),
    ];
    fly(&log, "hover-50ft", None, keys, 800);
    let reader = proven(&log);
    assert_eq!(events(&reader, FlightEvent::SituationSaved), [(200, 1)]);
    assert_eq!(events(&reader, FlightEvent::Restarted), [(600, 4)]);
    // The same motion follows from the same state: tick 201 and tick 601 differ in their number alone.
    let [first, again] = states(&log, &[201, 601])[..] else { panic!("two states") };
    assert_eq!(again.plant.position_m, first.plant.position_m);
    // What turns with the tick's number, the dice of turbulence, is part of the state.
    assert_eq!(again.fcc, first.fcc);

    let file = log.with_file_name("flight-situation-1.toml");
    let next = log.with_file_name("next.mcap");
    fly(&next, "runway", Some(&file), Vec::new(), 100);
    let reader = proven(&next);
    assert_eq!(reader.initial.tick, 0);
    let saved = states(&log, &[200])[0];
    assert_eq!(reader.initial.plant, saved.plant);
    let [flown] = states(&next, &[1])[..] else { panic!("a state") };
    assert_eq!(flown.plant.position_m, first.plant.position_m);
    let other = log.with_file_name("other.mcap");
    let common = ["--fast", "--duration", "1", "--pilot", "land", "--out", text(&other)];
    let fly = [&["fly", "--situation", text(&file)], &common[..]].concat();
    tiltrotor(&fly).ends(OK);
    verify(&other).ends(OK).says("exact");
}

#[test]
fn weather_and_failures_by_key_are_recorded() {
    let log = log("keys-weather");
    let keys = vec![
        press(10, KeyAction::WindStronger),
        press(20, KeyAction::WindStronger),
        press(30, KeyAction::WindRight),
        press(50, KeyAction::Turbulence),
        press(100, KeyAction::Gust),
        (200, Order::Fail(Failures::ENGINE_LEFT)),
        (300, Order::Fail(Failures::SCAS_YAW)),
        press(500, KeyAction::MendAll),
    ];
    fly(&log, "hover-50ft", None, keys, 700);
    let reader = proven(&log);
    assert_eq!(events(&reader, FlightEvent::Wind), [(10, 1), (20, 1), (30, 1)]);
    assert_eq!(events(&reader, FlightEvent::Turbulence), [(50, 1)]);
    assert_eq!(events(&reader, FlightEvent::Gust), [(100, 100)]);
    let both = (Failures::ENGINE_LEFT | Failures::SCAS_YAW).bits();
    let left = Failures::ENGINE_LEFT.bits();
    assert_eq!(events(&reader, FlightEvent::Failures), [(200, left), (300, both), (500, 0)]);
    let wind = reader.events.iter().rfind(|event| event.kind == FlightEvent::Wind as u64);
    let [speed_mps, from_deg] = wind.expect("wind").measured;
    // Ahead is 270 deg; ten degrees to the right of it.
    assert!((speed_mps - engine::units::mps_of_knots(10.0)).abs() < 1e-9);
    assert!((from_deg - 280.0).abs() < 1e-9);
}

#[test]
fn a_frozen_aircraft_stands_still_and_goes_on() {
    let log = log("keys-freeze");
    let keys = vec![press(100, KeyAction::Freeze), press(300, KeyAction::Freeze)];
    fly(&log, "downwind", None, keys, 400);
    let reader = proven(&log);
    assert_eq!(events(&reader, FlightEvent::Paused), [(100, 1), (300, 0)]);
    let [before, last, on] = states(&log, &[100, 300, 301])[..] else { panic!("three states") };
    assert_eq!(before.plant, last.plant);
    assert_ne!(last.plant, on.plant);
}

#[test]
fn a_reset_goes_back_to_the_start_or_to_the_last_marker() {
    let log = log("keys-reset");
    let keys = vec![
        press(10, KeyAction::StickForward),
        press(200, KeyAction::Marker),
        (250, Order::Fail(Failures::ENGINE_LEFT)),
        press(400, KeyAction::ResetToMarker),
        press(600, KeyAction::ResetToStart),
    ];
    let landing = fly(&log, "hover-50ft", None, keys, 700);
    assert_eq!(landing.debrief.touchdowns, 0);
    let reader = proven(&log);
    assert_eq!(events(&reader, FlightEvent::Restarted), [(400, 2), (600, 1)]);
    // The engine works again at the marker, because it did then.
    assert_eq!(events(&reader, FlightEvent::Failures).last(), Some(&(400, 0)));
    let [marked, first, again, reset] = states(&log, &[201, 202, 401, 601])[..] else {
        panic!("four states")
    };
    assert_eq!(marked.cockpit.markers, 1);
    assert_eq!(again.plant.position_m, first.plant.position_m);
    let [begun] = states(&log, &[1])[..] else { panic!("a state") };
    assert_eq!(reset.plant.position_m, begun.plant.position_m);
    // Time and the number of markers go on.
    assert_eq!((reset.tick, reset.cockpit.markers), (601, 1));
}

#[test]
fn a_reposition_goes_on_from_a_start_position() {
    let log = log("keys-reposition");
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    let (name, _, scenario) = aircraft::STARTS[3];
    let start = aircraft::start(name, scenario).expect("a scenario");
    let there = analysis::start::state_at(&start, &xv15).expect("steady flight");
    let keys = vec![
        press(10, KeyAction::WindStronger),
        (100, Order::Restart(Restart::Reposition(there))),
        press(200, KeyAction::LeverUp),
    ];
    fly(&log, "runway", None, keys, 400);
    let reader = proven(&log);
    assert_eq!(events(&reader, FlightEvent::Restarted), [(100, 3)]);
    assert_eq!(events(&reader, FlightEvent::Wind).len(), 1, "the weather stays");
    let [state, later] = states(&log, &[101, 400])[..] else { panic!("two states") };
    assert_eq!(state.plant.origin, there.plant.origin);
    // The lever goes on from where the aircraft has it.
    let moved_norm = later.cockpit.collective_norm - there.cockpit.collective_norm;
    assert!((moved_norm - 0.02).abs() < 1e-3, "{moved_norm}");
}

#[test]
fn a_what_if_and_a_clip_of_a_flight_with_a_reset_keep_it() {
    let log = log("keys-whatif");
    let keys = vec![press(10, KeyAction::StickForward), press(300, KeyAction::ResetToStart)];
    fly(&log, "hover-50ft", None, keys, 600);
    let clip = log.with_file_name("clip.mcap");
    let cut =
        ["log", "clip", text(&log), "--from", "200t", "--until", "500t", "--out", text(&clip)];
    tiltrotor(&cut).ends(OK);
    assert_eq!(events(&proven(&clip), FlightEvent::Restarted), [(300, 1)]);
    let other = log.with_file_name("other.mcap");
    let set = ["--set", "fcc.scas.pitch.rate_gain_in_per_radps=2.5", "--out", text(&other)];
    let said = tiltrotor(&[&["whatif", text(&log)], &set[..]].concat()).ends(OK);
    said.says("baseline: flown unchanged, the recorded inputs give the recorded states");
    assert_eq!(events(&proven(&other), FlightEvent::Restarted), [(300, 1)]);
}

#[test]
fn a_restart_that_somebody_changed_took_away_or_doubled_is_found() {
    let log = log("keys-forged");
    let keys = vec![press(10, KeyAction::StickForward), press(300, KeyAction::ResetToStart)];
    fly(&log, "hover-50ft", None, keys, 400);
    let forged = log.with_file_name("forged.mcap");
    let fuel = place_of::<RestartRecord>("state.plant.fuel_kg");

    let mut changed = Forgery::of(&log);
    changed.bytes(RESTART, 0)[fuel] ^= 1;
    changed.write(&forged);
    verify(&forged).ends(DIVERGED).says("altered");
    // Whoever forms the digests anew is betrayed by the motion.
    chain_anew(&mut changed);
    changed.write(&forged);
    verify(&forged).ends(DIVERGED).says("301");

    let mut taken = Forgery::of(&log);
    let place = taken.places(RESTART)[0];
    taken.messages.remove(place);
    taken.write(&forged);
    verify(&forged).ends(DIVERGED).says("altered");

    let mut doubled = Forgery::of(&log);
    let again = doubled.messages[place].clone();
    doubled.messages.insert(place, again);
    doubled.write(&forged);
    verify(&forged).ends(UNUSABLE).says("a message of /restart for tick 300, out of its place");

    let mut late = Forgery::of(&log);
    let again = late.messages[place].clone();
    let end = late.messages.len();
    late.messages.insert(end, again);
    late.write(&forged);
    let status = verify(&forged).status;
    assert_ne!(status, Some(OK));
}

#[test]
fn a_flight_with_a_restart_that_was_cut_is_recovered_beyond_it() {
    let log = log("keys-cut");
    let keys = vec![press(10, KeyAction::StickForward), press(300, KeyAction::ResetToStart)];
    fly(&log, "hover-50ft", None, keys, 2500);
    let cut = log.with_file_name("cut.mcap");
    let bytes = std::fs::read(&log).expect("a log");
    std::fs::write(&cut, &bytes[..bytes.len() * 3 / 4]).expect("a file");
    verify(&cut).ends(INCOMPLETE);
    let recovered = log.with_file_name("recovered.mcap");
    tiltrotor(&["log", "recover", text(&cut), "--out", text(&recovered)]);
    verify(&recovered).ends(INCOMPLETE).says("exact");
    let mut reader = logs::open(&recovered, OpenOptions::default()).expect("a log");
    while reader.next_tick().expect("a tick").is_some() {}
    assert_eq!(events(&reader, FlightEvent::Restarted), [(300, 1)]);
}

#[test]
fn a_hard_landing_is_told_in_the_debrief() {
    let folder = folder("keys-hard");
    let (log, script) = (folder.join("flight.mcap"), folder.join("drop.toml"));
    let drop = "[[event]]\nat_s = 0.5\nover_s = 0.2\naxis = { collective = 0.0 }\n";
    std::fs::write(&script, drop).expect("a script");
    let fly = ["fly", "--start", "hover-50ft", "--script", text(&script), "--fast"];
    let said = tiltrotor(&[&fly[..], &["--duration", "8", "--out", text(&log)]].concat()).ends(OK);
    let debrief = said.after("debrief");
    assert!(debrief.starts_with("touchdown "), "{debrief}");
    assert!(debrief.contains("HARD: beyond the gear's design"), "{debrief}");
    verify(&log).ends(OK).says("exact");
}

#[test]
fn start_positions_are_flown_by_name_and_others_are_refused() {
    let folder = folder("keys-starts");
    for (name, ..) in aircraft::STARTS {
        let log = folder.join(format!("{name}.mcap"));
        let fly = ["fly", "--start", name, "--pilot", "land", "--fast", "--duration", "2"];
        tiltrotor(&[&fly[..], &["--out", text(&log)]].concat()).ends(OK);
        verify(&log).ends(OK).says("exact");
    }
    let wrong = ["fly", "--start", "moon", "--pilot", "land", "--fast"];
    tiltrotor(&wrong).refused().says("no start position is called `moon`; there are runway");
    let keyboard = ["fly", "--keyboard", "--out", "never.mcap"];
    tiltrotor(&keyboard).refused().says("--keyboard needs a terminal");
    tiltrotor(&["fly", "--controls", "--keyboard"]).ends(OK).says("PageUp       Power lever up");
}
