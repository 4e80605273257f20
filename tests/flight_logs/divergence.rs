//! Where a flight stops being the recorded one, `verify` says so that one can act on it.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use logs::records::{INPUTS, InputsRecord};
use serde_json::Value;

use crate::common::{
    DIVERGED, Forgery, OK, Said, all, flip_state_bit, folder, hover, place_of, text, tiltrotor,
    verify,
};

/// Fifteen seconds by the pilot model: on the ground, lift-off, hover.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("divergence").join("flight.mcap");
        hover(&log, "15");
        log
    })
}

/// A copy of the flight with something changed and every checksum right.
fn forged(name: &str, change: impl FnOnce(&mut Forgery)) -> PathBuf {
    let mut forgery = Forgery::of(flight());
    change(&mut forgery);
    let log = folder(&format!("divergence-{name}")).join("forged.mcap");
    forgery.write(&log);
    log
}

/// A flight whose wing is a little larger than the one that was recorded.
fn other_wing() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        forged("wing", |log| {
            log.rewrite(
                "aircraft.toml",
                "\narea_ft2 = { value = 181.0",
                "\narea_ft2 = { value = 181.5",
            );
        })
    })
}

fn json(log: &Path) -> Value {
    let said = in_json(log);
    serde_json::from_str(&said.out).unwrap_or_else(|why| panic!("{why}: {said}"))
}

fn in_json(log: &Path) -> Said {
    tiltrotor(&["verify", "--format", "json", text(log)])
}

#[test]
fn the_stage_is_the_one_that_gives_the_field() {
    let cases = [
        ("cockpit.stick_aft_norm", "cockpit"),
        ("environment.turbulence_mps.x", "environment"),
        ("fcc.governor.integral_rad", "fcc"),
        ("actuators.elevator_rad", "actuators"),
        ("plant.rotors.left.flapping.coning_rad", "rotors"),
        ("rate.engines.rotor_speed_radps2", "engines"),
        ("plant.tyre_deflections.main.left.forward_m", "landing_gear"),
        ("rate.horizontal_stabilizer.downwash_radps", "horizontal_stabilizer"),
        ("rate.motion.acceleration_mps2.z", "eom"),
        ("plant.position_m.z", "integration"),
        ("tick", "step"),
    ];
    let whole = Forgery::of(flight());
    let place = folder("divergence-stages");
    all(cases, |(field, stage)| {
        let mut log = whole.clone();
        flip_state_bit(&mut log, 2000, field);
        let file = place.join(format!("{field}.mcap"));
        log.write(&file);
        let said = verify(&file);
        let lines = [format!("  field     {field}\n"), format!("  stage     {stage}")];
        let found =
            said.status == Some(DIVERGED) && lines.iter().all(|line| said.out.contains(line));
        (!found).then(|| format!("{field}, {stage}: {said}"))
    });
}

#[test]
fn of_two_fields_the_one_whose_stage_comes_first_is_named() {
    // The other way round in the order of the state.
    let log = forged("two", |log| {
        flip_state_bit(log, 2000, "plant.fuel_kg");
        flip_state_bit(log, 2000, "rate.engines.fuel_kg_per_s");
    });
    verify(&log)
        .ends(DIVERGED)
        .says("  field     rate.engines.fuel_kg_per_s")
        .says("1 more field differs at this tick; by stage: engines 1, integration 1");
}

#[test]
fn a_single_state_that_was_changed_is_told_from_another_model() {
    let log = forged("single", |log| flip_state_bit(log, 2000, "plant.velocity_mps.x"));
    let said = verify(&log).ends(DIVERGED).says("the same again from tick 2001");
    // The step to the changed state, and the one from it.
    assert!(steps(&said).starts_with("2 of 1751 do not lead"), "{said}");
    let said = verify(other_wing()).ends(DIVERGED).never_says("the same again");
    let words = steps(&said);
    let (differing, of) = words.split_once(" of ").expect("so many of so many");
    let of = of.split(' ').next().expect("a number");
    let number = |text: &str| text.parse::<f64>().expect("a number");
    assert!(number(differing) > 0.5 * number(of), "{said}");
}

fn steps(said: &Said) -> &str {
    said.after("one step  from each recorded state:")
}

#[test]
fn a_block_that_keeps_no_state_is_named_by_what_was_recorded_of_it() {
    // The wing's load shows in the state only as acceleration.
    let said = verify(other_wing()).ends(DIVERGED).says("  stage     eom, or before it a load");
    assert!(said.after("block").starts_with("wing_pylon: loads.wing_pylon."), "{said}");
    // The first tick for which there is a record.
    let single = &json(other_wing())["logs"][0]["divergence"]["single_steps"];
    assert!(single["block"]["tick"].as_u64().expect("a tick") <= 10, "{single:#}");
}

#[test]
fn the_growth_is_told_from_second_to_second() {
    let report = json(other_wing());
    let growth = &report["logs"][0]["divergence"]["growth"];
    let checkpoints = growth["checkpoints"].as_array().expect("checkpoints");
    let after: Vec<_> = checkpoints.iter().filter_map(|at| at["after_s"].as_u64()).collect();
    assert_eq!(after, [0, 1, 2, 5, 10], "{report:#}");
    let velocity = |at: &Value| {
        let groups = at["groups"].as_array().expect("groups").iter();
        let mut found = groups.filter(|group| group["group"] == "plant.velocity_mps");
        found.next().map_or(0.0, |group| {
            assert_eq!(group["unit"], "m/s");
            group["absolute"].as_f64().expect("a number")
        })
    };
    let (first, last) = (&checkpoints[0], &checkpoints[4]);
    assert!(velocity(last) > velocity(first), "{report:#}");
    assert!(last["fields"].as_u64() > first["fields"].as_u64(), "{report:#}");
    let begins = growth["first_tick"].as_u64().expect("a tick");
    assert_eq!(last["tick"], begins + 2500);
    assert_eq!(growth["last_tick"], begins + 2500, "no tick is compared beyond the last look");
}

#[test]
fn the_report_for_programs_has_every_bit() {
    let file = forged("json", |log| flip_state_bit(log, 1234, "plant.velocity_mps.x"));
    let report = json(&file);
    assert_eq!((&report["version"], &report["status"]), (&2.into(), &1.into()));
    assert_eq!(report["count"]["altered"], 1, "{report:#}");
    let log = &report["logs"][0];
    assert_eq!((&log["outcome"], &log["status"]), (&"altered".into(), &1.into()));
    assert_eq!((&log["first_bad_tick"], &log["diverged_tick"]), (&1234.into(), &1234.into()));
    let words = log["words"].as_str().expect("a sentence");
    assert!(words.starts_with("altered at tick 1234 (4.936 s): "), "{words}");
    assert_eq!(log["end"]["reason"], "closed");
    assert_eq!(
        (&log["exact_tick"], &log["last_tick"], &log["altered_tick"]),
        (&1233.into(), &3750.into(), &1234.into())
    );
    let divergence = &log["divergence"];
    assert_eq!(divergence["field"], "plant.velocity_mps.x");
    assert_eq!((&divergence["unit"], &divergence["ulps"]), (&"m/s".into(), &1.into()));
    assert_eq!(divergence["last_input"]["from"], "device");
    // As it is written: the JSON reader used here is an ULP off now and then.
    let out = in_json(&file).out;
    let written: Vec<u64> = out
        .split("\"value\": ")
        .filter_map(|rest| rest.split([',', '\n', ' ']).next()?.parse::<f64>().ok())
        .map(f64::to_bits)
        .collect();
    for side in ["recorded", "reflown"] {
        let hex = divergence[side]["hex"].as_str().expect("bits").trim_start_matches("0x");
        let bits = u64::from_str_radix(hex, 16).expect("hexadecimal");
        assert!(written.contains(&bits), "{:?}, {side}: {report:#}", f64::from_bits(bits));
    }
}

#[test]
fn the_last_change_of_the_world_is_named_with_its_moment() {
    let log = forged("world", |log| {
        let wind = place_of::<InputsRecord>("world.wind_mps.x");
        log.bytes(INPUTS, 3000)[wind..wind + 8].copy_from_slice(&5.0_f64.to_le_bytes());
    });
    let input = &json(&log)["logs"][0]["divergence"]["last_input"];
    assert_eq!((&input["from"], &input["field"]), (&"world".into(), &"world.wind_mps.x".into()));
    assert_eq!((&input["tick"], &input["after"]["value"]), (&3001.into(), &5.0.into()));
}

#[test]
fn an_exact_flight_has_nothing_to_report() {
    let report = json(flight());
    assert_eq!((&report["status"], &report["logs"][0]["divergence"]), (&0.into(), &Value::Null));
    assert_eq!(report["logs"][0]["outcome"], "exact");
    assert_eq!(report["logs"][0]["end"]["reason"], "closed");
    tiltrotor(&["verify", "--format", "json", text(flight())]).ends(OK);
}
