//! Which lanes there are: what was on, what failed, what the model is worth.

use std::sync::LazyLock;

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::inputs::{Failures, World};
use engine::outputs::{Severity, Validity, ValidityFacts};
use engine::units::degrees;

/// What a lane is read off.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// What can be observed.
    pub outputs: &'a Outputs,
    /// Weather and failures.
    pub world: &'a World,
    /// What flies.
    pub aircraft: &'a Aircraft,
}

/// One lane.
pub struct Mode {
    /// Entity.
    pub path: String,
    /// What it can be, and the colour of each.
    pub values: Vec<(&'static str, u32)>,
    reading: Reading,
}

/// How a mode is read.
enum Reading {
    By(fn(Seen) -> &'static str),
    Flag(&'static ValidityFacts),
}

impl Mode {
    fn new(path: &str, values: &[(&'static str, u32)], of: fn(Seen) -> &'static str) -> Self {
        Self { path: path.into(), values: values.into(), reading: Reading::By(of) }
    }

    /// The lane of a flag of validity.
    fn of_flag(facts: &'static ValidityFacts) -> Self {
        let set = (facts.words, severity_colour(facts.severity));
        Self {
            path: format!("validity/{}", facts.key),
            values: vec![(WITHIN, QUIET), set],
            reading: Reading::Flag(facts),
        }
    }

    /// What each of its values is called beside an aircraft: the flaps by their angles, too.
    pub fn labels(&self, aircraft: &Aircraft) -> Vec<String> {
        let label = |(place, (value, _)): (usize, &(&'static str, u32))| match aircraft
            .fcc
            .mixer
            .flap_rad
            .get(place)
        {
            Some(flap_rad) if self.path == FLAPS => {
                format!("{:.0}\u{b0} {value}", degrees(*flap_rad))
            }
            _ => (*value).to_string(),
        };
        self.values.iter().enumerate().map(label).collect()
    }

    /// What it is.
    pub fn of(&self, seen: Seen) -> &'static str {
        match self.reading {
            Reading::By(of) => of(seen),
            Reading::Flag(facts) if seen.outputs.validity.contains(facts.flag) => facts.words,
            Reading::Flag(_) => WITHIN,
        }
    }
}

const QUIET: u32 = 0x4A_5A_6A_FF;
const ACTIVE: u32 = 0x2F_7F_D0_FF;
const CAUTION: u32 = 0xE0_9A_20_FF;
const ALARM: u32 = 0xD0_40_38_FF;
const GREEN: u32 = 0x30_90_60_FF;

const FLAPS: &str = "modes/flaps";
const GOVERNOR: &str = "modes/governor";
const HOLDS: &str = "holds the speed";

/// The flap lever's detents; their angles are the aircraft's.
const DETENTS: [&str; 4] = ["up", "first detent", "second detent", "last detent"];

/// What a model is that is outside none of its limits.
const WITHIN: &str = "within its data";

fn severity_colour(severity: Severity) -> u32 {
    match severity {
        Severity::Caution => CAUTION,
        Severity::Warning | Severity::Final => ALARM,
    }
}

/// Every lane, and one for every flag of validity.
pub static MODES: LazyLock<Vec<Mode>> = LazyLock::new(|| {
    let told = Validity::FACTS.iter().map(|facts| (facts.words, severity_colour(facts.severity)));
    let model: Vec<_> = [(WITHIN, QUIET)].into_iter().chain(told).collect();
    let failed = Failures::FACTS.iter().map(|facts| (facts.words, ALARM));
    let failures: Vec<_> = [(NONE, QUIET), (SEVERAL, ALARM)].into_iter().chain(failed).collect();
    let modes = [
        Mode::new(
            "modes/nacelles",
            &[("helicopter", ACTIVE), ("converting", CAUTION), ("aeroplane", GREEN)],
            nacelles,
        ),
        Mode::new(
            "modes/gear",
            &[("up", QUIET), ("moving", CAUTION), ("down", GREEN), ("on ground", 0x8A_6A_48_FF)],
            gear,
        ),
        Mode::new(
            FLAPS,
            &[
                (DETENTS[0], QUIET),
                (DETENTS[1], 0x2A_5C_90_FF),
                (DETENTS[2], ACTIVE),
                (DETENTS[3], 0x58_A8_F0_FF),
            ],
            flaps,
        ),
        Mode::new(
            "modes/scas",
            &[("off", ALARM), ("on", QUIET), ("on, at its authority", CAUTION)],
            scas,
        ),
        Mode::new(
            GOVERNOR,
            &[(HOLDS, QUIET), ("underspeed", CAUTION), ("overspeed", ALARM), ("failed", ALARM)],
            governor,
        ),
        Mode::new("modes/failures", &failures, failures_now),
        Mode::new("modes/model", &model, model_validity),
    ];
    modes.into_iter().chain(Validity::FACTS.iter().map(Mode::of_flag)).collect()
});

/// How the nacelles stand: the name of the mode, and whether the trail behind the aircraft has its colour.
fn nacelles(seen: Seen) -> &'static str {
    configuration(seen.outputs).0
}

/// The configuration in a word, and the colour of the trail that is flown in it, RGB.
pub fn configuration(outputs: &Outputs) -> (&'static str, u32) {
    match 90.0 - degrees(outputs.actuators.mast_tilt_rad.mean()) {
        incidence_deg if incidence_deg > 85.0 => ("helicopter", 0x58_B4_FF_00),
        incidence_deg if incidence_deg > 1.0 => ("converting", 0xFF_B0_30_00),
        _ => ("aeroplane", 0x58_D0_80_00),
    }
}

/// Nacelles and gear in words.
pub fn words(outputs: &Outputs) -> [&'static str; 2] {
    [configuration(outputs).0, gear_of(outputs)]
}

fn gear(Seen { outputs, .. }: Seen) -> &'static str {
    gear_of(outputs)
}

fn gear_of(outputs: &Outputs) -> &'static str {
    let on_wheels = outputs.landing_gear.main.map(|leg| leg.push_n).sum() > 0.0;
    match outputs.actuators.gear_extension_norm {
        _ if on_wheels => "on ground",
        extension if extension >= 1.0 => "down",
        extension if extension <= 0.0 => "up",
        _ => "moving",
    }
}

fn flaps(Seen { outputs, .. }: Seen) -> &'static str {
    let detent = usize::try_from(outputs.cockpit.flap_detent).unwrap_or(usize::MAX);
    DETENTS[detent.min(DETENTS.len() - 1)]
}

fn scas(seen: Seen) -> &'static str {
    let outputs = seen.outputs;
    match (outputs.cockpit.scas_on, outputs.scas.saturated.is_empty()) {
        (0, _) => "off",
        (_, true) => "on",
        (_, false) => "on, at its authority",
    }
}

/// Other speeds than the helicopter's are granted with the nacelles on the down stop only.
const DOWN_DEG: f64 = 1.0;

/// Whether it holds the selected speed, as far as the crew would be warned otherwise.
fn governor(Seen { outputs, world, aircraft }: Seen) -> &'static str {
    if world.failures.contains(Failures::GOVERNOR) {
        return "failed";
    }
    let down = 90.0 - degrees(outputs.actuators.mast_tilt_rad.mean()) < DOWN_DEG;
    let speeds = &aircraft.fcc.governor.rotor_speed_radps;
    let selected = if down { outputs.cockpit.rpm_select } else { 0 };
    let selected_radps =
        usize::try_from(selected).ok().and_then(|select| speeds.get(select)).unwrap_or(&speeds[0]);
    let limits = &aircraft.envelope.rotors;
    match outputs.rotor_speed_radps {
        speed_radps if speed_radps < limits.underspeed_norm * selected_radps => "underspeed",
        speed_radps if speed_radps > limits.overspeed_radps => "overspeed",
        _ => HOLDS,
    }
}

/// What is told of a change beside its lane, which may be too short for a word; no other event of a log tells it.
pub fn alarm(mode: &Mode, value: &str) -> Option<String> {
    (mode.path == GOVERNOR && value != HOLDS).then(|| format!("governor {value}"))
}

const NONE: &str = "none";
const SEVERAL: &str = "several";

fn failures_now(seen: Seen) -> &'static str {
    let mut failed =
        Failures::FACTS.iter().filter(|facts| seen.world.failures.contains(facts.flag));
    match (failed.next(), failed.next()) {
        (None, _) => NONE,
        (Some(facts), None) => facts.words,
        (Some(_), Some(_)) => SEVERAL,
    }
}

/// The gravest of what it is outside of.
fn model_validity(seen: Seen) -> &'static str {
    seen.outputs.validity.gravest().map_or(WITHIN, |facts| facts.words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn lanes(outputs: &Outputs, world: &World) -> Vec<(&'static str, &'static str)> {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15)
            .unwrap_or_else(|error| panic!("{error}"));
        let seen = Seen { outputs, world, aircraft: &aircraft };
        MODES
            .iter()
            .map(|mode| {
                let value = mode.of(seen);
                let known = mode.values.iter().any(|(known, _)| *known == value);
                assert!(known, "{} has no colour for {value}", mode.path);
                (mode.path.as_str(), value)
            })
            .collect()
    }

    #[test]
    fn no_two_lanes_share_a_path() {
        let paths = MODES.iter().map(|mode| mode.path.as_str());
        assert_eq!(paths.clone().collect::<BTreeSet<_>>().len(), paths.count());
    }

    /// Of all 64 bits, those that the engine names: by the bits, not by the list that is shown.
    #[test]
    fn every_validity_bit_has_its_lane_and_changes_that_one_and_the_model_s() {
        let world = World::default();
        let within = lanes(&Outputs::default(), &world);
        for bit in 0..64 {
            let flag = Validity::from_bits_retain(1 << bit);
            let outside = lanes(&Outputs { validity: flag, ..Outputs::default() }, &world);
            let changed: Vec<&str> = within
                .iter()
                .zip(&outside)
                .filter(|(before, after)| before != after)
                .map(|(before, _)| before.0)
                .collect();
            if Validity::all().contains(flag) {
                let facts = flag.gravest().expect("told");
                assert_eq!(changed, ["modes/model", &format!("validity/{}", facts.key)]);
                assert!(outside.contains(&("modes/model", facts.words)), "{}", facts.key);
            } else {
                assert!(changed.is_empty(), "bit {bit} has no name, and shows as {changed:?}");
            }
        }
    }

    #[test]
    fn every_failure_is_in_its_lane() {
        let outputs = Outputs::default();
        let at = |failures| lanes(&outputs, &World { failures, ..World::default() });
        assert!(at(Failures::empty()).contains(&("modes/failures", NONE)));
        for facts in Failures::FACTS {
            assert!(at(facts.flag).contains(&("modes/failures", facts.words)), "{}", facts.key);
        }
        assert!(at(Failures::ENGINES).contains(&("modes/failures", SEVERAL)));
        assert!(at(Failures::GOVERNOR).contains(&("modes/governor", "failed")));
    }

    #[test]
    fn flaps_are_called_by_their_angles_too() {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15)
            .unwrap_or_else(|error| panic!("{error}"));
        let labels = |path: &str| {
            let mode = MODES.iter().find(|mode| mode.path == path).expect("a lane");
            assert_eq!(mode.labels(&aircraft).len(), mode.values.len());
            mode.labels(&aircraft)
        };
        let angles = aircraft.fcc.mixer.flap_rad.map(|rad| format!("{:.0}\u{b0} ", degrees(rad)));
        for (label, angle) in labels(FLAPS).iter().zip(angles) {
            assert!(label.starts_with(&angle), "{label}");
        }
        assert_eq!(labels("modes/gear")[0], "up");
    }

    #[test]
    fn a_wreck_is_not_within_its_data() {
        let outputs = Outputs { validity: Validity::HULL, ..Outputs::default() };
        let lanes = lanes(&outputs, &World::default());
        assert!(lanes.contains(&("modes/model", "hull on the ground")));
        assert!(lanes.contains(&("validity/hull", "hull on the ground")));
    }
}
