//! Whatever comes in from outside, changed at random: no panic, no hang, nothing accepted that is not
//! what was written.
//!
//! Each target runs a number of rounds from a seed, the same ones every time. For more of them:
//! `TILTROTOR_FUZZ_ROUNDS=100000 TILTROTOR_FUZZ_SEED=7 cargo test --release --test fuzz`. What breaks
//! a target is saved, and its path is printed.

mod common;

use std::fs;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use common::{Dice, Forgery, folder, hover};
use engine::inputs::World;
use engine::{Inputs, Outputs, State, step};
use flightgear::net_fdm::NetFdm;
use logs::output::Output;
use logs::records::{EVENTS, HARDWARE, INPUTS, OUTPUTS, STATE, TIMING};
use logs::{Ending, FlightReader, LogError, Messages, OpenOptions};
use recorder::script::Script;
use recorder::{Controller, TickContext};
use replay::{Options, Outcome, verify};

/// Longer than this for one input is a hang, on however busy a machine.
const HANG: Duration = Duration::from_secs(20);

const SCENARIO: &str = include_str!("../aircraft/scenario/default.toml");
const STICK_MAP: &str = include_str!("../aircraft/cockpit/stick.toml");
const SCRIPT: &str = r#"
[[event]]
at_s = 0.01
over_s = 0.02
axis = { stick_aft = 0.2, collective = 0.6 }
[[event]]
at_s = 0.05
press = ["marker"]
hold = ["nacelle_forward"]
fail = ["engine_left"]
wind = { from_deg = 270.0, kt = 15.0 }
gust = { up_mps = 6.0, s = 2.0 }
turbulence_mps = 1.5
pause = false
[[event]]
at_s = 0.08
release = ["nacelle_forward"]
mend = ["engine_left"]
end = true
"#;

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|number| number.parse().ok())
}

/// Runs a target on `rounds` inputs, unless the environment asks for another number.
fn fuzz(name: &str, rounds: u64, make: impl Fn(&mut Dice) -> Vec<u8>, target: impl Fn(&[u8])) {
    let rounds = number("TILTROTOR_FUZZ_ROUNDS").unwrap_or(rounds);
    let seed = number("TILTROTOR_FUZZ_SEED").unwrap_or(1);
    for round in 0..rounds {
        let mut dice = Dice(seed.wrapping_mul(0x1000_0000).wrapping_add(round));
        let input = make(&mut dice);
        let started = Instant::now();
        let fate = catch_unwind(AssertUnwindSafe(|| target(&input)));
        let hung = started.elapsed() > HANG;
        if fate.is_err() || hung {
            let saved = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{name}.bin"));
            fs::write(&saved, &input).expect("a file");
            let what = if hung { "hung" } else { "failed" };
            panic!("{name}, seed {seed}, round {round}: {what}; the input is {}", saved.display());
        }
    }
}

/// Numbers that parsers trip over.
const BYTES: [&[u8]; 8] = [
    &[0],
    &[0xff],
    &[0x7f],
    &[0x80],
    &[0; 8],
    &[0xff; 8],
    &[0, 0, 0, 0, 0, 0, 0xf0, 0x7f],
    b"\x89MCAP",
];

/// Bytes changed in one to four places.
fn mutated(seed: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=dice.below(4) {
        if bytes.is_empty() {
            break;
        }
        let at = dice.below(bytes.len() as u64) as usize;
        let to = (at + 1 + dice.below(64) as usize).min(bytes.len());
        let odd = BYTES[dice.below(BYTES.len() as u64) as usize];
        match dice.below(7) {
            0 => bytes[at] ^= 1 << dice.below(8),
            1 => bytes[at] = dice.below(256) as u8,
            2 => bytes.truncate(at),
            3 => drop(bytes.drain(at..to)),
            4 => drop(bytes.splice(at..at, bytes[at..to].to_vec())),
            5 => drop(bytes.splice(at..(at + odd.len()).min(bytes.len()), odd.iter().copied())),
            _ => bytes.swap(at, to - 1),
        }
    }
    bytes
}

/// What TOML and our readers of it trip over.
const WORDS: [&str; 24] = [
    "nan",
    "inf",
    "-inf",
    "-0.0",
    "0",
    "1e308",
    "-1e308",
    "1e-320",
    "9223372036854775807",
    "-9223372036854775808",
    "true",
    "\"\"",
    "[]",
    "{}",
    "[[event]]",
    "[trim]",
    "=",
    "\"\\u0000\"",
    "1979-05-27",
    "'''",
    "{ value = 0.0, source = \"\" }",
    "unit",
    "[[[[[[[[[[[[[[[[",
    "999999999999999",
];

/// A text changed in one to three places, by words and lines.
fn reworded(seed: &str, dice: &mut Dice) -> Vec<u8> {
    let mut lines: Vec<String> = seed.lines().map(str::to_string).collect();
    for _ in 0..=dice.below(3) {
        let at = dice.below(lines.len() as u64) as usize;
        let other = dice.below(lines.len() as u64) as usize;
        let word = WORDS[dice.below(WORDS.len() as u64) as usize];
        match dice.below(6) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[other].clone()),
            2 => lines.swap(at, other),
            3 => lines.insert(at, word.into()),
            _ => {
                // One word, a number most of the time.
                let line = &mut lines[at];
                let words: Vec<&str> = line.split(' ').collect();
                let numeric =
                    |word: &&str| word.starts_with(|c: char| c.is_ascii_digit() || c == '-');
                let chosen = words.iter().filter(|word| numeric(word)).count() as u64;
                let mut skip = dice.below(chosen.max(1));
                let any = dice.below(words.len() as u64) as usize;
                let place = if chosen == 0 || dice.below(4) == 0 {
                    any
                } else {
                    words
                        .iter()
                        .position(|word| {
                            numeric(word) && {
                                let now = skip == 0;
                                skip = skip.saturating_sub(1);
                                now
                            }
                        })
                        .unwrap_or(any)
                };
                let comma = if words[place].ends_with(',') { "," } else { "" };
                let replaced = format!("{word}{comma}");
                let mut words = words;
                words[place] = &replaced;
                *line = words.join(" ");
            }
        }
        if lines.is_empty() {
            break;
        }
    }
    let text = lines.join("\n").into_bytes();
    if dice.below(8) == 0 { mutated(&text, dice) } else { text }
}

fn small_log(name: &str) -> (Vec<u8>, std::path::PathBuf) {
    let log = folder(name).join("flight.mcap");
    hover(&log, "0.2");
    (fs::read(&log).expect("a log"), log)
}

#[test]
fn no_bytes_of_a_log_break_its_reader() {
    let (log, _) = small_log("fuzz-log");
    fuzz(
        "log",
        3000,
        |dice| mutated(&log, dice),
        |bytes| {
            let read = |bytes: &[u8]| -> Result<(u64, Ending, bool), LogError> {
                let mut reader = FlightReader::read(Cursor::new(bytes.to_vec()))?;
                let mut whole = reader.intact;
                let mut ticks = 0;
                while let Some(tick) = reader.next_tick()? {
                    whole &= tick.chained;
                    ticks += 1;
                }
                Ok((ticks, reader.ending().cloned().expect("an end"), whole))
            };
            if let Ok((ticks, Ending::Closed, true)) = read(bytes) {
                assert!(bytes == log && ticks == 50, "accepted");
            }
        },
    );
}

#[test]
fn no_log_with_every_checksum_right_breaks_verify_or_recover() {
    let (_, log) = small_log("fuzz-forged");
    let whole = Forgery::of(&log);
    let place = folder("fuzz-forged-logs");
    let forged = |dice: &mut Dice| {
        let mut log = whole.clone();
        for _ in 0..=dice.below(3) {
            if log.messages.is_empty() {
                break;
            }
            let at = dice.below(log.messages.len() as u64) as usize;
            let other = dice.below(log.messages.len() as u64) as usize;
            match dice.below(8) {
                0 => drop(log.messages.remove(at)),
                1 => log.messages.insert(at, log.messages[other].clone()),
                2 => log.messages.swap(at, other),
                3 => log.messages.truncate(at),
                4 => log.messages[at].log_time = dice.below(u64::MAX),
                5 => {
                    let file = dice.below(log.attachments.len() as u64) as usize;
                    let text = String::from_utf8_lossy(&log.attachments[file].data).into_owned();
                    log.attachments[file].data = reworded(&text, dice).into();
                }
                6 => log.messages[at].channel = log.messages[other].channel.clone(),
                _ => {
                    let data = mutated(&log.messages[at].data, dice);
                    log.messages[at].data = data.into();
                }
            }
        }
        let file = place.join("forged.mcap");
        log.write(&file);
        fs::read(&file).expect("a log")
    };
    let flown = [HARDWARE, INPUTS, STATE];
    let flight = |log: &Forgery| -> Vec<(String, Vec<u8>)> {
        let of_flight = log.messages.iter().filter(|m| flown.contains(&m.channel.topic.as_str()));
        of_flight.map(|m| (m.channel.topic.clone(), m.data.to_vec())).collect()
    };
    let (broken, fixed) = (place.join("broken.mcap"), place.join("fixed.mcap"));
    fuzz("forged", 300, forged, |bytes| {
        fs::write(&broken, bytes).expect("a file");
        let verdict = verify(&broken, &Options::default(), |_| {});
        if verdict.as_ref().is_ok_and(|verdict| verdict.judgement.outcome == Outcome::Exact) {
            assert!(flight(&Forgery::of(&broken)) == flight(&whole), "accepted");
        }
        let _ = verdict.map(|verdict| verdict.to_string());
        let output = Output::beside(&fixed, true, &[]).expect("a place");
        if logs::recover(&broken, &output, flown_by).is_ok() {
            output.finish().expect("in its place");
            // What was recovered was flown: the same messages, from the first on.
            let (kept, flown) = (flight(&Forgery::of(&fixed)), flight(&whole));
            assert!(kept.len() <= flown.len() && kept == flown[..kept.len()], "upgraded");
        }
        let mut messages = Messages::open(&broken, OpenOptions::default()).expect("a file");
        while let Some(message) = messages.next_message() {
            let _ = message.fields();
        }
    });
    for topic in [TIMING, EVENTS, OUTPUTS] {
        assert!(!whole.places(topic).is_empty(), "{topic}: the seed has all channels");
    }
}

/// The aircraft of a log, for compacted ones.
fn flown_by(setup: &logs::Setup) -> Result<logs::compact::FlightModel, LogError> {
    let refused = |error: aircraft::ConfigError| LogError::NotAFlight(error.to_string());
    let map = aircraft::cockpit("cockpit.toml", &setup.cockpit_toml).map_err(refused)?;
    let aircraft = aircraft::aircraft("aircraft.toml", &setup.aircraft_toml)
        .map_err(refused)?
        .with_cockpit(map);
    let start = aircraft::start("scenario.toml", &setup.scenario_toml).map_err(refused)?;
    Ok(logs::compact::FlightModel { aircraft, world: start.world.world() })
}

#[test]
fn no_bytes_of_a_log_break_looking_things_up_in_it() {
    let (log, _) = small_log("fuzz-places");
    let file = folder("fuzz-places-logs").join("places.mcap");
    // The index is at the end: half of the changes are there.
    let make = |dice: &mut Dice| {
        let from = if dice.below(2) == 0 { 0 } else { log.len() - log.len() / 8 };
        [&log[..from], &mutated(&log[from..], dice)].concat()
    };
    fuzz("places", 1500, make, |bytes| {
        fs::write(&file, bytes).expect("a file");
        let _ = logs::closing(&file);
        let _ = logs::marker(&file, 1).map_err(|error| error.to_string());
        if let Ok(mut reader) = logs::open(&file, OpenOptions::default()) {
            let sought = reader.seek(30);
            if sought.is_ok() && reader.intact {
                while let Ok(Some(tick)) = reader.next_tick() {
                    if !tick.chained {
                        break;
                    }
                }
            }
        }
    });
}

#[test]
fn no_bytes_of_a_compacted_log_break_its_reader() {
    let (_, log) = small_log("fuzz-compacted");
    let place = folder("fuzz-compacted-logs");
    let (compacted, file) = (place.join("compacted.mcap"), place.join("broken.mcap"));
    let output = Output::beside(&compacted, true, &[]).expect("a place");
    logs::compact::compact(&log, &output, 10, flown_by, |_| {}).expect("compacted");
    output.finish().expect("in its place");
    let bytes = fs::read(&compacted).expect("a log");
    // Most of it is the aircraft: half of the changes are after that.
    let flight = bytes.len() - bytes.len() / 4;
    let make = |dice: &mut Dice| {
        let from = if dice.below(2) == 0 { 0 } else { flight };
        [&bytes[..from], &mutated(&bytes[from..], dice)].concat()
    };
    fuzz("compacted", 300, make, |broken| {
        fs::write(&file, broken).expect("a file");
        let open = OpenOptions { aircraft_of: Some(flown_by), across_versions: false };
        let Ok(mut reader) = logs::open(&file, open) else { return };
        let (mut ticks, mut whole) = (0, reader.intact);
        while let Ok(Some(tick)) = reader.next_tick() {
            ticks += 1;
            whole &= tick.chained;
        }
        let closed = whole && ticks == 50 && reader.ending() == Some(&Ending::Closed);
        assert!(!closed || broken == bytes, "accepted");
    });
}

#[test]
fn no_aircraft_breaks_its_reader_and_what_it_accepts_can_be_flown() {
    let make = |dice: &mut Dice| reworded(aircraft::XV15, dice);
    fuzz("aircraft", 300, make, |bytes| {
        let text = String::from_utf8_lossy(bytes);
        let _ = aircraft::provenance("fuzz.toml", &text).map_err(|error| error.to_string());
        match aircraft::aircraft("fuzz.toml", &text) {
            Ok(aircraft) => fly_a_little(&aircraft, &start(SCENARIO).expect("ours")),
            Err(error) => assert!(error.to_string().starts_with("fuzz.toml"), "{error}"),
        }
    });
}

fn start(text: &str) -> Option<engine::start::Start> {
    aircraft::start("fuzz.toml", text).ok()
}

fn fly_a_little(aircraft: &engine::Aircraft, start: &engine::start::Start) {
    // Standing: to find a steady flight takes a long time, and is no reader's work.
    let mut state = start.on_wheels(aircraft);
    for _ in 0..3 {
        let inputs = Inputs { events: &[], world: start.world.world() };
        let (next, _): (State, Outputs) = step(aircraft, &state, &inputs);
        state = next;
    }
    assert_eq!(state.tick, 3);
}

#[test]
fn no_scenario_breaks_its_reader_and_what_it_accepts_can_be_flown() {
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    let seed = format!("{SCENARIO}\n[trim]\nmast_tilt_deg = 30.0\nairspeed_kt = 100.0\n");
    fuzz(
        "scenario",
        1500,
        |dice| reworded(&seed, dice),
        |bytes| {
            if let Some(start) = start(&String::from_utf8_lossy(bytes)) {
                fly_a_little(&xv15, &start);
            }
        },
    );
}

#[test]
fn no_cockpit_map_and_no_device_event_breaks_the_cockpit() {
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    let state = start(SCENARIO).expect("ours").on_wheels(&xv15);
    let seed = format!("{STICK_MAP}\n{}", aircraft::PILOT_MAP);
    fuzz(
        "cockpit",
        1500,
        |dice| reworded(&seed, dice),
        |bytes| {
            let text = String::from_utf8_lossy(bytes);
            let Ok(map) = aircraft::cockpit("fuzz.toml", &text) else { return };
            let aircraft = xv15.clone().with_cockpit(map);
            let mut dice = Dice(bytes.len() as u64);
            let mut odd =
                || [0, 1, 2, u64::MAX, 1 << 63, dice.below(u64::MAX)][dice.below(6) as usize];
            let events = [(); 8].map(|()| engine::inputs::DeviceEvent {
                tick: odd(),
                kernel_time_ns: odd(),
                device: odd(),
                kind: odd(),
                code: odd(),
                value: odd().cast_signed(),
                raw_min: odd().cast_signed(),
                raw_max: odd().cast_signed(),
            });
            step(&aircraft, &state, &Inputs { events: &events, world: World::default() });
        },
    );
}

#[test]
fn no_script_breaks_its_reader_and_what_it_accepts_can_be_played() {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).expect("ours");
    fuzz(
        "script",
        3000,
        |dice| reworded(SCRIPT, dice),
        |bytes| {
            let text = String::from_utf8_lossy(bytes);
            let mut script = match Script::parse("fuzz.toml", &text, &map) {
                Ok(script) => script,
                Err(error) => {
                    return assert!(error.to_string().starts_with("fuzz.toml"), "{error}");
                }
            };
            let (mut events, mut world, mut done) = (Vec::new(), World::default(), false);
            for tick in (0..40).chain([250, u64::from(u32::MAX), u64::MAX / 2]) {
                let seen = Outputs { tick, ..Default::default() };
                events.clear();
                let (events, world) = (&mut events, &mut world);
                let (mut phase, mut gave_up) = ((0, ""), None);
                let (phase, done, gave_up) = (&mut phase, &mut done, &mut gave_up);
                let (restart, save) = (&mut None, &mut false);
                let mut context =
                    TickContext { tick, events, world, phase, done, gave_up, restart, save };
                script.act(&seen, &mut context);
            }
        },
    );
}

#[test]
fn no_packet_breaks_its_reader() {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
    let (outputs, world) = (Outputs::default(), World::default());
    let lamps = flightgear::Lamps::default();
    let scene = flightgear::Scene { aircraft: &aircraft, outputs: &outputs, world: &world, lamps };
    let packet = NetFdm::of(&scene);
    fuzz(
        "packet",
        20_000,
        |dice| mutated(packet.bytes(), dice),
        |bytes| {
            if let Ok(packet) = NetFdm::parse(bytes) {
                // Read back as it came, and finite where we look.
                assert_eq!(packet.bytes(), bytes);
                assert!(packet.longitude_deg().is_finite() && packet.latitude_deg().is_finite());
            }
        },
    );
    let channel = flightgear::Channel::of(&scene);
    fuzz(
        "channel packet",
        20_000,
        |dice| mutated(channel.bytes(), dice),
        |bytes| {
            if let Ok(channel) = flightgear::Channel::parse(bytes) {
                assert_eq!(channel.bytes(), bytes);
                assert!(channel.values().all(|(_, _, value)| value.is_finite()));
            }
        },
    );
}
