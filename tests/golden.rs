//! Golden flights refly to the same bits; what an engineer reads of them is kept as snapshots.
//!
//! After a deliberate change: `tiltrotor verify --bless tests/golden/*.mcap`, then
//! `INSTA_UPDATE=always cargo test --test golden`. Both differences are to be looked at.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{DIVERGED, Dice, OK, UNUSABLE, folder, text, tiltrotor, verify};

/// A golden flight larger than this does not belong into a repository.
const BYTES_MAX: u64 = 300_000;

fn golden() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut logs: Vec<_> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "mcap"))
        .collect();
    logs.sort();
    assert!(logs.len() >= 6, "golden flights: {logs:?}");
    logs
}

fn stem(log: &Path) -> String {
    log.file_stem().expect("a name").to_str().expect("letters").to_string()
}

#[test]
fn regress_every_golden_flight_reflies_to_the_same_bits() {
    let logs = golden();
    let logs: Vec<_> = logs.iter().map(|log| text(log)).collect();
    let said = tiltrotor(&[&["verify"], &logs[..]].concat()).ends(OK);
    assert_eq!(said.out.matches(": exact: all ").count(), logs.len(), "{said}");
}

#[test]
fn every_golden_flight_says_what_it_is_kept_for_and_is_small() {
    let readme = include_str!("golden/README.md");
    for log in golden() {
        let info = tiltrotor(&["log", "info", text(&log)]).ends(OK);
        let entry = format!("- `{}.mcap`: {}", stem(&log), info.after("reason "));
        assert!(readme.lines().any(|line| line == entry), "not in the README: {entry}");
        let bytes = fs::metadata(&log).expect("a file").len();
        assert!(bytes <= BYTES_MAX, "{}: {bytes} bytes", log.display());
    }
}

#[test]
fn regress_what_an_engineer_reads_of_the_golden_flights() {
    for log in golden() {
        let said = tiltrotor(&["log", "summary", text(&log)]).ends(OK).out;
        let (_, summary) = said.split_once(": ").expect("the name before it");
        insta::assert_snapshot!(format!("golden_{}", stem(&log)), summary.trim_end());
    }
}

#[test]
fn regress_steady_flight_at_four_nacelle_angles() {
    let points = [("90", "0"), ("75", "60"), ("30", "120"), ("0", "180")];
    let tables: Vec<_> = points
        .into_iter()
        .map(|(nacelle, speed)| {
            tiltrotor(&["trim", "--nacelle", nacelle, "--speed-kt", speed]).ends(OK).out
        })
        .collect();
    insta::assert_snapshot!(tables.join("\n"));
}

#[test]
fn what_did_not_move_is_blessed_as_the_same_flight() {
    let log = folder("golden-same").join("golden.mcap");
    for whole in golden() {
        fs::copy(&whole, &log).expect("a copy");
        tiltrotor(&["verify", "--moved", text(&log)]).ends(OK).says("nothing moved");
        tiltrotor(&["verify", "--bless", text(&log)]).ends(OK).says("nothing moved");
        verify(&log).ends(OK);
        let (before, now) = (tiltrotor(&["log", "info", text(&whole)]), info(&log));
        for key in ["reason ", "parent ", "digest "] {
            assert_eq!(before.after(key), now.after(key));
        }
    }
}

fn info(log: &Path) -> common::Said {
    tiltrotor(&["log", "info", text(log)]).ends(OK)
}

#[test]
fn motion_is_blessed_and_said_with_units_and_time() {
    let place = folder("golden-moved");
    let log = place.join("golden.mcap");
    fs::copy(golden().remove(0), &log).expect("a copy");
    // Another aircraft stands in for a change of the model.
    let changed = include_str!("../aircraft/xv15.toml").replacen(
        "pedal_in = { value = 2.5,",
        "pedal_in = { value = 2.4,",
        1,
    );
    let xv15 = place.join("heavier.toml");
    let line = changed.lines().find(|line| line.starts_with("zero_fuel_mass_lb")).expect("a key");
    let value = line.split("value = ").nth(1).expect("a value").split(',').next().expect("one");
    let heavier: f64 = value.parse::<f64>().expect("a number") + 1.0;
    let heavier = line.replacen(value, &heavier.to_string(), 1);
    fs::write(&xv15, changed.replacen(line, &heavier, 1)).expect("a file");
    let before = fs::read(&log).expect("a log");
    let with = ["--aircraft", text(&xv15), text(&log)];
    let said = tiltrotor(&[&["verify", "--moved"], &with[..]].concat()).ends(DIVERGED);
    said.says("plant.velocity_mps").says("m/s").says("last position").says("touchdown");
    assert_eq!(fs::read(&log).expect("a log"), before, "--moved writes nothing");
    tiltrotor(&[&["verify", "--bless"], &with[..]].concat()).ends(OK).says("blessed");
    assert_ne!(fs::read(&log).expect("a log"), before);
    verify(&log).ends(OK).says("exact: all ");
    info(&log).says("reason").says("blessed_from_digest");
    assert_eq!(fs::read_dir(&place).expect("a folder").count(), 2, "nothing is left behind");
}

#[test]
fn damage_is_not_blessed() {
    let log = folder("golden-damaged").join("golden.mcap");
    let whole = fs::read(golden().remove(0)).expect("a log");
    let mut dice = Dice(5);
    for _ in 0..12 {
        let mut damaged = whole.clone();
        let place = dice.below(damaged.len() as u64) as usize;
        damaged[place] ^= 1 << dice.below(8);
        fs::write(&log, &damaged).expect("a file");
        tiltrotor(&["verify", "--bless", text(&log)]).ends(UNUSABLE);
        assert_eq!(fs::read(&log).expect("a log"), damaged, "left as it was: byte {place}");
    }
    fs::write(&log, &whole[..whole.len() / 2]).expect("a file");
    tiltrotor(&["verify", "--bless", text(&log)]).ends(UNUSABLE);
}
