//! Logs of other versions: what only reads goes by the log's own names, and what flies says what it
//! is worth. `tests/corpus/README.md` says where the logs are from.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use logs::cdr::HEADER;
use logs::layout::Layout;
use logs::records::{HARDWARE, INPUTS, STATE, TIMING};

use crate::common::{
    DIVERGED, Forgery, INCOMPLETE, OK, UNUSABLE, chain_anew, folder, text, tiltrotor, verify,
};

/// Flown for comparison.
const COMPARED: i32 = 6;

/// A log of an earlier version.
struct Old {
    name: &'static str,
    model: &'static str,
    /// As that version said it.
    digest: &'static str,
    /// Exit status of what reads it to its end.
    end: i32,
}

const CORPUS: [Old; 5] = [
    Old { name: "model-1-first", model: "1", digest: "f57a7a71ce0a6bcf", end: INCOMPLETE },
    Old { name: "model-1", model: "1", digest: "f0118277a7e1d1ed", end: OK },
    Old { name: "model-2-airframe", model: "2", digest: "85da94d18c1f4929", end: OK },
    Old { name: "model-2", model: "2", digest: "7bceb63849668570", end: OK },
    Old { name: "model-3", model: "3", digest: "d99fec59f1f81826", end: OK },
];

/// Ticks in each.
const TICKS: usize = 61;

impl Old {
    fn file(&self, kind: &str) -> PathBuf {
        let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
        corpus.join(format!("{}.{kind}", self.name))
    }

    fn log(&self) -> String {
        text(&self.file("mcap")).into()
    }

    fn is_of_this_model(&self) -> bool {
        self.model == engine::MODEL_VERSION
    }
}

#[test]
fn every_log_of_the_corpus_is_in_the_table() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    let files = fs::read_dir(folder).expect("the corpus").map(|file| file.expect("a file").path());
    let logs = files.filter(|file| file.extension().is_some_and(|kind| kind == "mcap"));
    assert_eq!(logs.count(), CORPUS.len());
}

#[test]
fn info_says_the_version_and_the_digest_of_every_older_log() {
    for old in &CORPUS {
        let said = tiltrotor(&["log", "info", &old.log()]);
        let said = said.ends(old.end);
        assert_eq!(said.after("model_version"), old.model);
        assert_eq!(said.after("digest"), old.digest, "{said}");
        let said = said.says("0.244 s, 61 ticks").says("marker 1");
        if !old.is_of_this_model() {
            said.says(&format!("{}; `verify --across-versions` flies it", engine::MODEL_VERSION));
        }
    }
}

#[test]
fn cat_prints_of_every_older_log_what_its_own_version_printed() {
    for old in &CORPUS {
        let recorded = fs::read_to_string(old.file("jsonl")).expect("what it printed");
        assert_eq!(recorded.lines().count(), 4);
        let said = tiltrotor(&["log", "cat", &old.log()]).ends(old.end);
        for line in recorded.lines() {
            assert!(said.out.lines().any(|now| now == line), "{}: no more\n{line}", old.name);
        }
    }
}

#[test]
fn export_names_columns_as_the_older_log_names_its_fields() {
    let tables = folder("versions-export");
    let logs: Vec<_> = CORPUS.iter().map(Old::log).collect();
    let mut arguments = vec!["log", "export", "--csv", text(&tables)];
    arguments.extend(logs.iter().map(String::as_str));
    // One of them was never closed, and that is the status of all.
    tiltrotor(&arguments).ends(INCOMPLETE);
    for old in &CORPUS {
        let recorded = fs::read_to_string(old.file("jsonl")).expect("what it printed");
        let line = recorded.lines().nth(2).expect("a state");
        let state: BTreeMap<String, serde_json::Value> = serde_json::from_str(line).expect("JSON");
        let flights = fs::read_dir(tables.join("state")).expect("a table");
        let named = |name: &str| name.starts_with(&format!("flight={}-", old.name));
        let flight = flights
            .map(|entry| entry.expect("a folder").path())
            // `model-1-` is the beginning of `model-1-first-` as well.
            .filter(|path| path.file_name().and_then(|name| name.to_str()).is_some_and(named))
            .min_by_key(|path| path.as_os_str().len())
            .expect("its part of the table");
        let csv = fs::read_to_string(flight.join("data.csv")).expect("a file");
        let rows: Vec<_> = csv.lines().collect();
        assert_eq!(rows.len(), 1 + 1 + TICKS, "a header, the first state, the ticks");
        let row: BTreeMap<_, _> = rows[0].split(',').zip(rows[1 + TICKS].split(',')).collect();
        for path in state.keys().filter(|path| path.starts_with("state.")) {
            let name = path["state.".len()..].replace(['.', '['], "_").replace(']', "");
            // As text: no reader's rounding comes between.
            let value = format!("\"{path}\":{}", row[name.as_str()]);
            let there = [",", "}"].iter().any(|end| line.contains(&format!("{value}{end}")));
            assert!(there, "{}: {value} is not as recorded", old.name);
        }
    }
}

#[test]
fn an_older_model_is_refused_by_name_and_flown_for_comparison_when_asked() {
    for old in CORPUS.iter().filter(|old| !old.is_of_this_model()) {
        let log = old.log();
        let ours = engine::MODEL_VERSION;
        for verb in ["verify", "replay"] {
            tiltrotor(&[verb, &log])
                .refused()
                .says(&format!(
                    "the log's flight model is version {}, this program's is {ours}",
                    old.model
                ))
                .says("--across-versions");
        }
        let said = tiltrotor(&["verify", "--across-versions", &log]).ends(COMPARED);
        said.says("a comparison, and never exact")
            .says(&format!("recorded by flight model {}, flown by {ours}", old.model))
            .never_says("exact: all");
    }
}

#[test]
fn a_log_of_this_model_is_judged_the_same_with_and_without_leave_to_compare() {
    for old in CORPUS.iter().filter(|old| old.is_of_this_model()) {
        let log = old.log();
        let strict = tiltrotor(&["verify", &log]);
        let across = tiltrotor(&["verify", "--across-versions", &log]);
        if old.name == "model-2-airframe" {
            // Under the same version, but its aircraft file and its states are not today's.
            strict.refused().says("aircraft.toml");
            across.ends(COMPARED).says("flown with this version's XV-15").says("plant.rotors.left");
        } else {
            strict.ends(OK).says("exact: all 61 ticks");
            across.ends(OK).says("exact: all 61 ticks");
        }
    }
}

#[test]
fn what_was_recorded_by_one_model_and_flown_by_another_is_never_called_exact() {
    // Today's own flight under another version's name: to the same bits, and still a comparison.
    let log = short_flight("versions-renamed-model", |log| set_fact(log, "model_version", "0.9"));
    verify(&log).refused().says("version 0.9");
    let said = tiltrotor(&["verify", "--across-versions", text(&log)]).ends(COMPARED);
    said.says("recorded by flight model 0.9")
        .says("both know up to tick 61 of 61")
        .never_says("exact up");
}

#[test]
fn an_unknown_log_format_is_refused_by_name_and_still_read_by_its_schema() {
    let log = short_flight("versions-format", |log| set_fact(log, "format_version", "99"));
    verify(&log).refused().says("the log's log format is version 99");
    tiltrotor(&["verify", "--across-versions", text(&log)]).refused().says("version 99");
    tiltrotor(&["log", "info", text(&log)])
        .ends(UNUSABLE)
        .says("log format 99")
        .says("messages of")
        .says("log export");
    tiltrotor(&["log", "cat", "--channel", "state", text(&log)])
        .ends(OK)
        .says("plant.position_m.x");
}

#[test]
fn a_field_that_was_added_since_is_named_and_the_flight_is_still_exact() {
    // As if `paused` and `fuel_kg` had come later: 0 in this flight, and what the scenario begins with.
    let log = short_flight("versions-added", |log| {
        reshape(log, INPUTS, |definition| definition.replace("uint64 paused\n", ""));
        reshape(log, STATE, |definition| definition.replace("float64 fuel_kg\n", ""));
        reshape(log, TIMING, |definition| definition.replace("late_ns", "lateness_ns"));
    });
    verify(&log)
        .ends(OK)
        .says("exact: all 61 ticks")
        .says("/inputs of the log lacks world.paused")
        .says("/state of the log lacks plant.fuel_kg")
        .says("/timing of the log lacks late_ns")
        .says("/timing of the log has, and nobody knows today, lateness_ns");
    tiltrotor(&["log", "info", text(&log)]).ends(OK).says("1 fields of today are not in it");
    tiltrotor(&["log", "cat", "--field", "lateness_ns", text(&log)]).ends(OK).says("lateness_ns");
}

#[test]
fn a_field_that_nobody_knows_today_is_named_and_the_state_with_one_is_not_exact() {
    let inputs = short_flight("versions-input-more", |log| {
        let more = |definition: &str| {
            definition.replace("uint64 paused\n", "uint64 paused\nfloat64 rain_mm\n")
        };
        reshape(log, INPUTS, more);
    });
    verify(&inputs).ends(OK).says("/inputs of the log has, and nobody knows today, world.rain_mm");
    let state = short_flight("versions-state-more", |log| {
        let renamed =
            |definition: &str| definition.replace("float64 fuel_kg\n", "float64 kerosene_kg\n");
        reshape(log, STATE, renamed);
    });
    verify(&state)
        .ends(COMPARED)
        .says("/state of the log lacks plant.fuel_kg")
        .says("nobody knows today, plant.kerosene_kg")
        .never_says("exact: all");
}

#[test]
fn a_changed_bit_is_found_in_another_layout_too() {
    let log = short_flight("versions-flipped", |log| {
        reshape(log, STATE, |definition| definition.replace("float64 fuel_kg\n", ""));
        // The last number of the state.
        log.bytes(STATE, 20).last_mut().map(|byte| *byte ^= 1).expect("a byte");
    });
    verify(&log).ends(DIVERGED).says("altered at tick 20 (0.080 s)");
}

#[test]
fn a_log_without_what_makes_a_flight_is_refused() {
    let log = short_flight("versions-nameless", |log| {
        reshape(log, HARDWARE, |definition| definition.replace("uint64 code\n", "uint64 which\n"));
    });
    verify(&log).ends(UNUSABLE).says("/hardware has no `code`");
}

#[test]
fn a_compacted_log_of_another_layout_is_refused_by_its_format_in_every_verb() {
    let log = short_flight("versions-compacted", |_| ());
    let compact = log.with_file_name("compact.mcap");
    tiltrotor(&["log", "compact", text(&log), "--out", text(&compact)]).ends(OK);
    let mut forged = Forgery::of(&compact);
    // Its definitions are in its first message, texts as they are.
    let (was, is) = (b"float64 fuel_kg\n", b"float64 fuel_lb\n");
    let first = forged.bytes("/compact", 0);
    let at = first.windows(was.len()).position(|bytes| bytes == was).expect("a definition");
    first[at..at + was.len()].copy_from_slice(is);
    forged.write(&compact);
    let (compact, out) = (text(&compact), text(&log.with_file_name("new.mcap")).to_owned());
    let tables = format!("{out}-tables");
    for verb in [
        vec!["verify"],
        vec!["replay"],
        vec!["log", "info"],
        vec!["log", "summary"],
        vec!["log", "cat"],
        vec!["log", "find"],
        vec!["log", "files"],
        vec!["log", "export", "--csv", &tables],
        vec!["log", "clip", "--until", "20t", "--out", &out],
        vec!["log", "expand", "--out", &out],
        vec!["log", "recover", "--out", &out],
        vec!["whatif", "--fail", "scas_yaw", "--out", &out],
        vec!["diff", compact],
    ] {
        tiltrotor(&[&verb[..], &[compact]].concat())
            .ends(UNUSABLE)
            .says("its /state has not the fields of today")
            .says("the log is of format 1, written by tiltrotor");
    }
    // What is not compacted yet cannot be.
    let log = short_flight("versions-not-compacted", |log| {
        reshape(log, STATE, |definition| definition.replace("float64 fuel_kg\n", ""));
    });
    tiltrotor(&["log", "compact", text(&log)])
        .refused()
        .says("its /state has not the fields of today");
}

/// The corpus's flight by this program, with something changed and the digests formed anew. Without
/// checksums, as the first log format was.
fn short_flight(name: &str, change: impl FnOnce(&mut Forgery)) -> PathBuf {
    let folder = folder(name);
    let flown = folder.join("flown.mcap");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/flight.toml");
    let fly =
        ["fly", "--fast", "--no-flightgear", "--script", text(&script), "--out", text(&flown)];
    tiltrotor(&fly).ends(OK);
    let mut log = Forgery::of(&flown);
    set_fact(&mut log, "format_version", "1");
    for record in &mut log.metadata {
        record.metadata.remove("seal");
    }
    change(&mut log);
    let forged = folder.join("forged.mcap");
    log.write(&forged);
    forged
}

fn set_fact(log: &mut Forgery, key: &str, value: &str) {
    let identity = log.metadata.iter_mut().find(|record| record.name == "tiltrotor").expect("one");
    identity.metadata.insert(key.into(), value.into());
}

/// Gives a channel another definition, its messages the same numbers by their names (7 where there was
/// none), and the flight digests that follow.
fn reshape(log: &mut Forgery, topic: &str, edit: impl Fn(&str) -> String) {
    let (mut channels, mut changed) = (BTreeMap::new(), false);
    for message in log.messages.iter_mut().filter(|message| message.channel.topic == topic) {
        let schema = message.channel.schema.clone().expect("a schema");
        let old = std::str::from_utf8(&schema.data).expect("text");
        let new = edit(old);
        changed |= new != old;
        let (from, to) = (Layout::parse(old).expect("ours"), Layout::parse(&new).expect("ours"));
        let numbers = from.numbers().iter().map(|number| number.path.clone());
        let numbers: BTreeMap<_, _> = numbers.zip(from.bits(&message.data).expect("it")).collect();
        let mut data = HEADER.to_vec();
        for number in to.numbers() {
            let bits = numbers.get(&number.path).copied().unwrap_or(7.0_f64.to_bits());
            data.extend_from_slice(&bits.to_le_bytes());
        }
        message.data = data.into();
        let channel = channels.entry(message.channel.id).or_insert_with(|| {
            let schema = mcap::Schema { data: new.into_bytes().into(), ..(*schema).clone() };
            Arc::new(mcap::Channel { schema: Some(Arc::new(schema)), ..(*message.channel).clone() })
        });
        message.channel = channel.clone();
    }
    assert!(changed, "the definition of {topic} is as before");
    chain_anew(log);
}
