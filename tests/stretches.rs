//! A log that is flown in stretches by several threads gets the verdict and the report of one pass, whatever
//! is wrong with it.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use common::{
    Forgery, INCOMPLETE, OK, all, chain_anew, flip_state_bit, folder, hover, place_of, text,
    tiltrotor,
};
use engine::inputs::DeviceEvent;
use logs::records::{HARDWARE, INPUTS, InputsRecord, OUTPUTS, RESTART, STATE, TIMING};
use replay::{Options, Outcome, ReplayError, Window, verify, verify_while};

/// Two seconds by the pilot model: eight stretches.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("stretches").join("flight.mcap");
        hover(&log, "2");
        log
    })
}

/// All that verifying a log says, for people and inside.
fn said(log: &Path, threads: usize, window: Window) -> (Option<Outcome>, String) {
    match verify(log, &Options { threads, window, ..Options::default() }, |_| ()) {
        Ok(verdict) => (Some(verdict.judgement.outcome), format!("{verdict}\n{verdict:#?}")),
        Err(error) => (None, error.to_string()),
    }
}

/// Compares what comes out by any number of threads with one pass; returns what it is.
#[track_caller]
fn same_for_all(log: &Path, window: Window) -> Result<Option<Outcome>, String> {
    let (outcome, one_pass) = said(log, 0, window);
    for threads in [1, 2, 5, usize::MAX] {
        let (_, by_threads) = said(log, threads, window);
        if by_threads != one_pass {
            return Err(format!("{}: {threads} threads\n{by_threads}\n{one_pass}", log.display()));
        }
    }
    Ok(outcome)
}

type Change = fn(&mut Forgery);

/// What is done to a log, and what it is then.
const CHANGES: [(&str, Outcome, Change); 14] = [
    ("nothing", Outcome::Exact, |_| ()),
    ("first-tick", Outcome::Diverged, |log| diverged(log, 1)),
    ("end-of-a-stretch", Outcome::Diverged, |log| diverged(log, 64)),
    ("start-of-a-stretch", Outcome::Diverged, |log| diverged(log, 65)),
    ("in-a-stretch", Outcome::Diverged, |log| diverged(log, 300)),
    ("last-tick", Outcome::Diverged, |log| diverged(log, 500)),
    ("two-states", Outcome::Altered, |log| {
        flip_state_bit(log, 100, "plant.fuel_kg");
        flip_state_bit(log, 400, "plant.velocity_mps.x");
    }),
    ("world", Outcome::Diverged, |log| {
        let place = place_of::<InputsRecord>("world.wind_mps.x");
        log.bytes(INPUTS, 200)[place..place + 8].copy_from_slice(&3.0_f64.to_le_bytes());
        chain_anew(log);
    }),
    ("kernel-time", Outcome::Altered, |log| {
        let place = place_of::<DeviceEvent>("kernel_time_ns");
        log.bytes(HARDWARE, 30)[place] ^= 1;
    }),
    ("ticks-missing", Outcome::Altered, |log| {
        let (from, to) = (log.places(STATE)[128] + 1, log.places(STATE)[140] + 1);
        log.messages.drain(from..to);
    }),
    ("tick-doubled", Outcome::Altered, |log| {
        let (from, to) = (log.places(STATE)[191] + 1, log.places(STATE)[192] + 1);
        let again: Vec<_> = log.messages[from..to].to_vec();
        log.messages.splice(to..to, again);
    }),
    ("outputs", Outcome::OutputsDiffer, |log| {
        let place = place_of::<engine::Outputs>("body_velocity_mps.x");
        log.bytes(OUTPUTS, 12)[place] ^= 1;
        log.bytes(OUTPUTS, 45)[place] ^= 1;
    }),
    ("outputs-then-diverged", Outcome::Diverged, |log| {
        let place = place_of::<engine::Outputs>("body_velocity_mps.x");
        log.bytes(OUTPUTS, 12)[place] ^= 1;
        diverged(log, 320);
    }),
    ("inputs-missing", Outcome::Damaged, |log| {
        let place = log.places(INPUTS)[250];
        log.messages.remove(place);
    }),
];

/// The state after a tick is another one, and all digests follow from it.
fn diverged(log: &mut Forgery, tick: usize) {
    flip_state_bit(log, tick, "plant.velocity_mps.x");
    chain_anew(log);
}

#[test]
fn verifying_can_be_left() {
    for threads in [0, 1, 3] {
        let options = Options { threads, ..Options::default() };
        let mut asked = 0;
        let left = verify_while(flight(), &options, |ticks| {
            asked += 1;
            if ticks < 200 { Ok(()) } else { Err(ReplayError::Refused("enough".into())) }
        });
        assert_eq!(left.expect_err("left").to_string(), "enough");
        assert!((2..=200).contains(&asked), "{asked}");
    }
}

#[test]
fn whatever_is_wrong_with_a_log_the_report_is_that_of_one_pass() {
    let place = folder("stretches-changed");
    flight();
    all(&CHANGES, |(name, expected, change)| {
        let mut log = Forgery::of(flight());
        change(&mut log);
        let file = place.join(format!("{name}.mcap"));
        log.write(&file);
        match same_for_all(&file, Window::default()) {
            Ok(Some(outcome)) if outcome == *expected => None,
            Ok(outcome) => Some(format!("{name}: {outcome:?}")),
            Err(what) => Some(what),
        }
    });
}

#[test]
fn a_damaged_or_cut_log_gets_the_report_of_one_pass() {
    let place = folder("stretches-damaged");
    let whole = fs::read(flight()).expect("a log");
    let mut cases = vec![];
    for part in [3, 5, 6, 7] {
        let cut = whole[..whole.len() * part / 8].to_vec();
        let mut flipped = whole.clone();
        flipped[whole.len() * part / 8] ^= 4;
        cases.push((format!("cut-{part}"), cut));
        cases.push((format!("flipped-{part}"), flipped));
    }
    let beside = |change: Change| {
        let mut log = Forgery::of(flight());
        change(&mut log);
        let file = place.join("forged.mcap");
        log.write(&file);
        fs::read(&file).expect("a log")
    };
    cases.push(("timing".into(), beside(|log| log.bytes(TIMING, 100)[40] ^= 1)));
    cases.push((
        "view-missing".into(),
        beside(|log| {
            let at = log.places("/tf")[30];
            log.messages.remove(at);
        }),
    ));
    all(cases, |(name, bytes)| {
        let file = place.join(format!("{name}.mcap"));
        fs::write(&file, bytes).expect("a file");
        match same_for_all(&file, Window::default()) {
            Ok(Some(Outcome::Exact)) => Some(format!("{name}: exact")),
            Ok(_) => None,
            Err(what) => Some(what),
        }
    });
}

#[test]
fn a_part_gets_the_report_of_one_pass() {
    let place = folder("stretches-part");
    let mut log = Forgery::of(flight());
    diverged(&mut log, 300);
    let file = place.join("diverged.mcap");
    log.write(&file);
    for (from_tick, until_tick, expected) in [
        (Some(10), Some(200), Some(Outcome::Exact)),
        (Some(100), None, Some(Outcome::Diverged)),
        (Some(301), Some(400), Some(Outcome::Exact)),
        (None, Some(299), Some(Outcome::Exact)),
        (Some(20), Some(20), Some(Outcome::Exact)),
        (Some(10_000), None, None),
    ] {
        let window = Window { from_tick, until_tick, clamped: false };
        assert_eq!(same_for_all(&file, window), Ok(expected), "{window:?}");
    }
}

#[test]
fn a_flight_with_restarts_is_proven_in_stretches_and_in_blocks() {
    let place = folder("stretches-restarts");
    let (log, script) = (place.join("flight.mcap"), place.join("script.toml"));
    // At the beginning, the end and in the middle of stretches, and of blocks.
    let restarts = [0.256, 0.26, 0.4, 0.8, 0.804, 1.1];
    let lines = restarts.map(|at_s| format!("[[event]]\nat_s = {at_s}\nrestart = \"start\"\n\n"));
    let moved = "[[event]]\nat_s = 0.1\naxis = { stick_aft = 0.3 }\nover_s = 0.1\n\n";
    let end = "[[event]]\nat_s = 1.4\nend = true\n";
    fs::write(&script, format!("{moved}{}{end}", lines.concat())).expect("a file");
    let fly = ["fly", "--fast", "--no-flightgear", "--script", text(&script), "--out", text(&log)];
    tiltrotor(&fly).ends(OK);
    let changed = {
        let mut log = Forgery::of(&log);
        diverged(&mut log, 220);
        let file = place.join("diverged.mcap");
        log.write(&file);
        file
    };
    let compact = place.join("compact.mcap");
    let keyframes = ["--keyframes", "0.2", "--out", text(&compact)];
    tiltrotor(&[&["log", "compact", text(&log)], &keyframes[..]].concat()).ends(OK);
    for (log, expected) in
        [(&log, Outcome::Exact), (&compact, Outcome::Exact), (&changed, Outcome::Diverged)]
    {
        assert_eq!(same_for_all(log, Window::default()), Ok(Some(expected)), "{}", log.display());
    }
    assert_eq!(Forgery::of(&log).places(RESTART).len(), restarts.len());
    // What can be trusted of it, whole or compacted, is the same flight.
    for log in [&log, &compact] {
        let (cut, fixed) = (place.join("cut.mcap"), place.join("fixed.mcap"));
        let bytes = fs::read(log).expect("a log");
        let index = mcap::Summary::read(&bytes).expect("an index").expect("an index");
        let last = index.chunk_indexes.last().expect("a chunk").chunk_start_offset as usize;
        fs::write(&cut, &bytes[..last]).expect("a file");
        let out = ["--force", "--out", text(&fixed)];
        tiltrotor(&[&["log", "recover", text(&cut)], &out[..]].concat()).ends(INCOMPLETE);
    }
}

#[test]
fn logs_of_older_versions_and_compacted_ones_get_the_report_of_one_pass() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let logs = ["tests/corpus", "tests/golden"].map(|folder| fs::read_dir(root.join(folder)));
    let logs = logs.into_iter().flat_map(|folder| folder.expect("a folder"));
    let logs = logs.map(|entry| entry.expect("a file").path());
    let logs: Vec<_> = logs.filter(|path| path.extension().is_some_and(|x| x == "mcap")).collect();
    assert!(logs.len() > 5);
    // Of the compacted ones some are long; two are enough.
    let short = |log: &PathBuf| fs::metadata(log).is_ok_and(|file| file.len() < 170_000);
    all(logs.into_iter().filter(short), |log| {
        same_for_all(&log, Window { until_tick: Some(500), ..Window::default() }).err()
    });
}
