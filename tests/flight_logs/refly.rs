//! A log reflies to the same bits, and one that does not is found out, whatever was done to it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use engine::inputs::DeviceEvent;
use logs::cdr;
use logs::records::{EVENTS, HARDWARE, INPUTS, InputsRecord, STATE, TIMING};

use crate::common::{
    self, DIVERGED, Dice, Forgery, INCOMPLETE, OK, UNUSABLE, all, command, flip_state_bit, folder,
    hover, place_of, said, text, tiltrotor, verify,
};

/// Twenty seconds by the pilot model: on the ground, lift-off, hover.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("refly").join("flight.mcap");
        hover(&log, "20");
        log
    })
}

/// A second by the pilot model, to be damaged many times.
fn short_flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("refly-short").join("flight.mcap");
        hover(&log, "1");
        log
    })
}

/// A copy of the flight with something changed and every checksum right.
fn forged(name: &str, change: impl FnOnce(&mut Forgery)) -> PathBuf {
    let mut forgery = Forgery::of(flight());
    change(&mut forgery);
    let log = folder(&format!("refly-{name}")).join("forged.mcap");
    forgery.write(&log);
    log
}

#[test]
fn a_flight_reflies_to_the_same_bits() {
    let said = verify(flight())
        .ends(OK)
        .says("exact: all 5000 ticks (20.0 s)")
        .says("exact up to tick 5000 of 5000 (20.000 s): the log ends as its writer closed it");
    assert_eq!(said.err, "");
    tiltrotor(&["log", "info", text(flight())]).ends(OK).says("lift-off").says("closed");
}

#[test]
fn the_demonstration_flies_and_verifies_itself() {
    let log = folder("refly-demo").join("demo.mcap");
    tiltrotor(&["demo", "--fast", "--no-flightgear", "--out", text(&log)])
        .ends(OK)
        .says("ticks reflown in flight, 0 mismatches, 0 ticks dropped")
        .says("exact: all ");
    tiltrotor(&["log", "info", text(&log)]).ends(OK).says("marker 1").says("touchdown");
    verify(&log).ends(OK);
}

#[test]
fn the_same_flight_flown_twice_gives_the_same_digest() {
    let again = folder("refly-again").join("again.mcap");
    hover(&again, "20");
    let digest =
        |log: &Path| tiltrotor(&["log", "info", text(log)]).ends(OK).after("digest").to_string();
    assert_eq!(digest(flight()).len(), 16);
    assert_eq!(digest(flight()), digest(&again));
    assert_ne!(digest(flight()), digest(short_flight()));
}

#[test]
fn a_log_needs_nothing_but_itself() {
    let elsewhere = folder("refly-elsewhere");
    let log = elsewhere.join("moved.mcap");
    fs::copy(flight(), &log).expect("a copy");
    let mut verify = command(&["verify", "moved.mcap"]);
    said(verify.current_dir(&elsewhere)).ends(OK).says("moved.mcap: exact: all 5000 ticks");
}

#[test]
fn a_copy_record_by_record_is_the_same_flight() {
    // Otherwise the forgeries below would show nothing.
    verify(&forged("copy", |_| {})).ends(OK).says("exact: all 5000 ticks");
}

#[test]
fn one_bit_of_a_recorded_state_is_named_by_tick_field_and_values() {
    let log = forged("state", |log| flip_state_bit(log, 1234, "plant.velocity_mps.x"));
    let said = verify(&log)
        .ends(DIVERGED)
        .says("exact up to tick 1233 of 5000")
        .says("first difference: tick 1234 (4.936 s)")
        .says("plant.velocity_mps.x")
        .says("1 ULP")
        .says("0 more fields differ")
        .says("forged.mcap: altered at tick 1234 (4.936 s): the log was changed after the flight")
        .never_says("damaged");
    let (recorded, reflown) = (value(&said, "recorded"), value(&said, "reflown"));
    assert_eq!(recorded.1 ^ reflown.1, 1, "one bit: {said}");
    assert_eq!(recorded.0.to_bits(), recorded.1, "the decimal value says every bit: {said}");
    assert_eq!(reflown.0.to_bits(), reflown.1, "{said}");
    let input = said.after("last input:");
    assert!(input.contains("axis") && input.contains("for tick 12"), "{said}");
}

/// A value as printed: decimal, and the bits in hexadecimal.
fn value(said: &common::Said, name: &str) -> (f64, u64) {
    let line = said.after(name);
    let (decimal, hex) = line.split_once("  (0x").expect("decimal and hexadecimal");
    let decimal = decimal.split(' ').next().expect("a number before its unit");
    let bits = u64::from_str_radix(hex.trim_end_matches(')'), 16).expect("hexadecimal");
    (decimal.parse().expect("a decimal number"), bits)
}

#[test]
fn one_bit_of_any_field_at_any_tick_is_found() {
    let fields = logs::fields::fields(&engine::State::default()).expect("recordable");
    let mut dice = Dice(1);
    let whole = Forgery::of(short_flight());
    let place = folder("refly-any");
    let bits: Vec<_> = (0..40)
        .map(|_| {
            let field = &fields[dice.below(fields.len() as u64) as usize];
            (1 + dice.below(250) as usize, field.path.clone(), dice.below(64))
        })
        .collect();
    all(bits, |(tick, path, bit)| {
        let mut log = whole.clone();
        let start = place_of::<logs::records::StateRecord>(&format!("state.{path}"));
        log.bytes(STATE, tick)[start + bit as usize / 8] ^= 1 << (bit % 8);
        let file = place.join(format!("{tick}-{path}-{bit}.mcap"));
        log.write(&file);
        let said = verify(&file);
        let found = said.status == Some(DIVERGED)
            && said.out.contains(&path)
            && said.out.contains(&format!("exact up to tick {} of 250", tick - 1));
        (!found).then(|| format!("bit {bit} of {path} at tick {tick}: {said}"))
    });
}

#[test]
fn one_bit_of_a_digest_is_found() {
    let log = forged("digest", |log| log.bytes(STATE, 777)[4] ^= 1);
    verify(&log)
        .ends(DIVERGED)
        .says("forged.mcap: altered at tick 777 (3.108 s): the log was changed after the flight")
        .says("exact up to tick 776 of 5000")
        .says("the states refly to the same bits up to tick 5000 (20.000 s)")
        .never_says("as its writer closed it")
        .never_says("first difference");
}

#[test]
fn one_bit_of_the_first_state_is_found() {
    let log = forged("first", |log| flip_state_bit(log, 0, "plant.fuel_kg"));
    verify(&log).ends(DIVERGED).says("altered at tick 0").says("first state");
}

#[test]
fn an_aircraft_changed_after_the_flight_is_found_by_digest_and_by_motion() {
    let log = forged("aircraft", |log| {
        log.rewrite(
            "aircraft.toml",
            "mast_length_ft = { value = 4.667",
            "mast_length_ft = { value = 4.668",
        );
    });
    verify(&log)
        .ends(DIVERGED)
        .says("first difference: tick ")
        .says("  stage     rotors")
        .says("  field     plant.rotors.")
        .says("altered at tick 0 (0.000 s): the log was changed after the flight, its aircraft");
}

#[test]
fn a_comment_added_to_a_file_of_the_log_is_found() {
    for file in ["aircraft.toml", "cockpit.toml", "scenario.toml"] {
        let log = forged(&format!("comment-{file}"), |log| {
            let file = log.attachments.iter_mut().find(|known| known.name == file).expect(file);
            file.data.to_mut().extend_from_slice(b"# harmless\n");
        });
        verify(&log)
            .ends(DIVERGED)
            .says("altered at tick 0 (0.000 s): the log was changed after the flight")
            .says("exact up to tick 0 of 5000")
            .never_says("as its writer closed it");
    }
}

#[test]
fn a_changed_world_is_found() {
    let log = forged("inputs", |log| {
        let wind = place_of::<InputsRecord>("world.wind_mps.x");
        log.bytes(INPUTS, 3000)[wind..wind + 8].copy_from_slice(&5.0_f64.to_le_bytes());
    });
    verify(&log)
        .ends(DIVERGED)
        .says("exact up to tick 3000 of 5000")
        .says("first difference: tick 3001")
        .says("last input: world.wind_mps.x from 0.0 m/s to 5.0 m/s, for tick 3001")
        .says("altered at tick 3001 (12.004 s)");
}

#[test]
fn a_changed_device_event_is_found() {
    let log = forged("hardware", |log| {
        let value = place_of::<DeviceEvent>("value");
        log.bytes(HARDWARE, 900)[value] ^= 0x40;
    });
    verify(&log)
        .ends(DIVERGED)
        .says("first difference: tick ")
        .says("last input: device 0 axis")
        .says("forged.mcap: altered at tick ");
}

#[test]
fn the_kernel_s_time_of_a_device_event_cannot_be_changed_unnoticed() {
    // It moves nothing: only the digest knows.
    let log = forged("kernel-time", |log| {
        let time = place_of::<DeviceEvent>("kernel_time_ns");
        log.bytes(HARDWARE, 900)[time] ^= 1;
    });
    verify(&log)
        .ends(DIVERGED)
        .says("forged.mcap: altered at tick ")
        .never_says("as its writer closed it")
        .never_says("first difference");
}

#[test]
fn a_missing_device_event_is_named() {
    let log = forged("missing-event", |log| {
        let place = log.places(HARDWARE)[700];
        log.messages.remove(place);
    });
    let said = verify(&log).ends(UNUSABLE).says("device events, got ").says("exact up to tick ");
    assert!(said.out.contains(": expected "), "{said}");
}

#[test]
fn an_added_device_event_is_named() {
    let log = forged("added-event", |log| {
        let place = log.places(HARDWARE)[700];
        let again = log.messages[place].clone();
        log.messages.insert(place, again);
    });
    verify(&log).ends(UNUSABLE).says("device events, got ");
}

#[test]
fn two_swapped_device_events_are_found() {
    let log = forged("swapped-events", |log| {
        // Two of the same tick: their order is part of the flight.
        let places = log.places(HARDWARE);
        let tick = |place: usize| log.messages[place].data[4..12].to_vec();
        let pair = places.windows(2).skip(300).find(|pair| tick(pair[0]) == tick(pair[1]));
        let pair = pair.expect("a tick with two events");
        log.messages.swap(pair[0], pair[1]);
    });
    verify(&log).ends(DIVERGED).says("forged.mcap: altered at tick ");
}

#[test]
fn a_missing_tick_is_named() {
    for (name, topic) in [("inputs", INPUTS), ("state", STATE)] {
        let log = forged(&format!("missing-{name}"), |log| {
            let place = log.places(topic)[2000];
            log.messages.remove(place);
        });
        let said = verify(&log);
        assert_ne!(said.status, Some(OK), "{said}");
        let said = said.says("exact up to tick ").says("do not make a flight");
        assert!(said.out.contains("tick 2000") || said.out.contains("tick 2001"), "{said}");
    }
}

#[test]
fn a_log_whose_end_was_taken_off_and_closed_again_is_not_whole() {
    let log = forged("shortened", |log| {
        let last = log.places(STATE)[4900];
        log.messages.truncate(last + 1);
    });
    verify(&log).ends(INCOMPLETE).says("forged.mcap: never closed: ").says("exact up to tick 4900");
}

#[test]
fn a_closed_log_that_ends_in_the_middle_of_a_tick_is_not_accepted() {
    let log = forged("half-tick", |log| {
        let place = *log.places(STATE).last().expect("a state");
        log.messages.truncate(place);
    });
    verify(&log)
        .ends(UNUSABLE)
        .says("forged.mcap: damaged after tick 4999 (19.996 s)")
        .says("exact up to tick 4999")
        .says("the last tick has no state");
}

#[test]
fn two_swapped_states_are_found() {
    let log = forged("swapped-states", |log| {
        let places = log.places(STATE);
        log.messages.swap(places[1000], places[1001]);
    });
    verify(&log)
        .ends(DIVERGED)
        .says("first difference: tick ")
        .says("exact up to tick 999 of 5000");
}

#[test]
fn a_flipped_bit_in_the_middle_of_the_file_is_damage() {
    let mut bytes = fs::read(flight()).expect("a log");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    let log = folder("refly-flip").join("flipped.mcap");
    fs::write(&log, bytes).expect("a file");
    verify(&log).ends(UNUSABLE).says("exact up to tick ").says("damaged").says(" or more");
    tiltrotor(&["log", "info", text(&log)]).ends(UNUSABLE).says("damaged from here");
}

#[test]
fn no_flipped_bit_anywhere_in_the_file_is_accepted() {
    let whole = fs::read(short_flight()).expect("a log");
    let place = folder("refly-flips");
    let mut dice = Dice(2);
    let length = whole.len();
    // All over the file, and closer at both ends, where the structure is.
    let anywhere = (0..150).map(|_| dice.below(length as u64) as usize).collect::<Vec<_>>();
    let ends = (0..100).step_by(3).chain((length - 100..length).step_by(3));
    all(anywhere.into_iter().chain(ends), |byte| {
        let mut bytes = whole.clone();
        bytes[byte] ^= 1 << (byte % 8);
        let file = place.join(format!("{byte}.mcap"));
        fs::write(&file, bytes).expect("a file");
        let said = verify(&file);
        let refused = matches!(said.status, Some(DIVERGED | UNUSABLE | INCOMPLETE));
        (!refused).then(|| format!("byte {byte} of {length}: {said}"))
    });
}

#[test]
fn a_file_cut_short_is_exact_up_to_there_or_refused() {
    let whole = fs::read(short_flight()).expect("a log");
    let place = folder("refly-cut");
    let mut dice = Dice(3);
    let length = whole.len();
    let cuts = (0..60).map(|_| dice.below(length as u64) as usize).collect::<Vec<_>>();
    let ends = [0, 1, 7, 8, 9, 100, length / 2, length - 100, length - 8, length - 1];
    all(cuts.into_iter().chain(ends), |cut| {
        let file = place.join(format!("{cut}.mcap"));
        fs::write(&file, &whole[..cut]).expect("a file");
        let said = verify(&file);
        let honest = match said.status {
            Some(INCOMPLETE) => said.out.contains("exact up to tick ") && said.err.is_empty(),
            Some(UNUSABLE) => said.out.is_empty() && said.err.lines().count() == 1,
            _ => false,
        };
        (!honest).then(|| format!("cut at {cut} of {length}: {said}"))
    });
    let said = verify(&place.join(format!("{}.mcap", length - 1))).ends(INCOMPLETE);
    said.says("exact up to tick 250 of 250 or more (1.000 s)").says("without having been closed");
    verify(&place.join("100.mcap")).refused();
}

#[test]
fn a_log_that_ends_in_the_middle_is_not_replayed_without_a_word() {
    let whole = fs::read(short_flight()).expect("a log");
    let place = folder("refly-replay");
    let replay = |bytes: &[u8]| {
        let log = place.join("replayed.mcap");
        fs::write(&log, bytes).expect("a file");
        tiltrotor(&["replay", text(&log), "--speed", "100", "--flightgear", "127.0.0.1:9"])
    };
    replay(&whole).ends(OK).says("1.0 s reflown");
    let cut = &whole[..whole.len() * 4 / 5];
    replay(cut).ends(INCOMPLETE).says(" s reflown").says("never closed: ");
    let mut flipped = whole.clone();
    flipped[whole.len() * 4 / 5] ^= 1;
    replay(&flipped).ends(UNUSABLE).says(" s reflown").says("damaged after tick ");
}

#[test]
fn every_recorded_number_can_be_read_as_json() {
    let said = tiltrotor(&["log", "cat", text(short_flight()), "--topic", "/state"]).ends(OK);
    let lines: Vec<serde_json::Value> =
        said.out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(lines.len(), 251, "the first state, and one a tick");
    let height = |line: &serde_json::Value| line["state.plant.position_m.z"].as_f64();
    assert!(lines.iter().all(|line| height(line).is_some()), "{}", lines[0]);
    assert_eq!(lines[250]["time_ns"], 1_000_000_000);
}

#[test]
fn bytes_after_the_end_are_damage() {
    let mut bytes = fs::read(short_flight()).expect("a log");
    bytes.extend_from_slice(b"and more");
    let log = folder("refly-appended").join("appended.mcap");
    fs::write(&log, bytes).expect("a file");
    verify(&log).ends(UNUSABLE).says("damaged").says("exact up to tick 250 of 250");
}

#[test]
fn what_is_no_flight_is_refused_in_one_line() {
    let place = folder("refly-foreign");
    let file = |name: &str, bytes: &[u8]| {
        let path = place.join(name);
        fs::write(&path, bytes).expect("a file");
        path
    };
    let foreign = place.join("foreign.mcap");
    let mut other = Forgery::of(short_flight());
    other.metadata.clear();
    other.write(&foreign);
    let blind = place.join("blind.mcap");
    let mut other = Forgery::of(short_flight());
    other.attachments.retain(|file| file.name != "cockpit.toml");
    other.write(&blind);
    let bare = place.join("bare.mcap");
    Forgery { metadata: vec![], attachments: vec![], messages: vec![] }.write(&bare);
    let cases = [
        (file("text.mcap", b"not a log, but a good hundred bytes of text\n"), "not an MCAP file"),
        (file("empty.mcap", b""), "not an MCAP file"),
        (file("zeros.mcap", &[0; 4096]), "not an MCAP file"),
        (foreign, "not a tiltrotor flight"),
        (bare, "not a tiltrotor flight"),
        (blind, "cockpit.toml is not in it"),
        (place.join("missing.mcap"), "No such file"),
    ];
    for (path, why) in cases {
        verify(&path).refused().says(why).says(text(&path));
        tiltrotor(&["log", "info", text(&path)]).refused().says(why);
        tiltrotor(&["replay", text(&path)]).refused().says(why);
        if why == "not an MCAP file" {
            for verb in ["files", "cat", "fields"] {
                tiltrotor(&["log", verb, text(&path)]).refused().says("not a flight log");
            }
        }
    }
    for command in [&["log", "info"][..], &["replay"]] {
        tiltrotor(&[command, &[text(&place)]].concat()).refused().says("a folder");
    }
}

#[test]
fn no_number_in_a_log_makes_the_program_panic() {
    let place = folder("refly-extremes");
    let whole = Forgery::of(short_flight());
    // The largest whole number, which is a NaN as well; the least, which is −0.0; the largest ones with a sign.
    let bits = [u64::MAX, i64::MIN.cast_unsigned(), i64::MAX.cast_unsigned(), f64::MAX.to_bits()];
    let channels =
        [(HARDWARE, 3), (INPUTS, 100), (STATE, 0), (STATE, 100), (TIMING, 5), (EVENTS, 1)];
    let cases = channels.into_iter().flat_map(|channel| bits.map(|bits| (channel, bits)));
    all(cases, |((topic, number), bits)| {
        let fields = (whole.clone().bytes(topic, number).len() - cdr::HEADER.len()) / 8;
        // All fields at once, and some alone.
        let alone = (0..fields).filter(|field| *field < 8 || *field + 3 > fields).map(Some);
        for field in alone.chain([None]) {
            let mut log = whole.clone();
            for field in field.map_or(0..fields, |field| field..field + 1) {
                let at = cdr::HEADER.len() + 8 * field;
                log.bytes(topic, number)[at..at + 8].copy_from_slice(&bits.to_le_bytes());
            }
            if log.messages == whole.messages {
                // It was that already.
                continue;
            }
            let file = place.join(format!("{}-{number}-{field:?}-{bits:x}.mcap", &topic[1..]));
            log.write(&file);
            // None of these panics: that is looked at wherever the command is run.
            let said = verify(&file);
            tiltrotor(&["log", "info", text(&file)]);
            if [HARDWARE, INPUTS, STATE].contains(&topic) && said.status == Some(OK) {
                return Some(format!("{topic} {number}, field {field:?}, {bits:x}: {said}"));
            }
        }
        None
    });
}

#[test]
fn a_log_of_another_model_or_format_is_refused_by_name() {
    let (model, format) = (engine::MODEL_VERSION, logs::records::FORMAT_VERSION);
    for (key, what, ours) in
        [("model_version", "flight model", model), ("format_version", "log format", format)]
    {
        let mut other = Forgery::of(short_flight());
        other.metadata[0].metadata.insert(key.into(), "99".into());
        let log = folder(&format!("refly-{key}")).join("other.mcap");
        other.write(&log);
        verify(&log).refused().says(what).says(&format!("version 99, this program's is {ours}"));
    }
}
