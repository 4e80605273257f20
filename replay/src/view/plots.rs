//! What is plotted, and which modes are shown: one line each.

use std::sync::LazyLock;

use engine::Outputs;
use engine::outputs::{Severity, Validity, ValidityFacts};
use engine::pair::Pair;
use engine::units::{FPM_PER_MPS, KT_PER_MPS, RPM_PER_RADPS};

/// One line of a plot.
pub struct Plot {
    /// Entity; its second part is the plot, with the unit.
    pub path: &'static str,
    /// In the legend.
    pub name: &'static str,
    /// RGBA.
    pub colour: u32,
    /// Broad where it lies below another that may equal it: left below right.
    pub width: f32,
    /// Its value.
    pub of: fn(&Outputs) -> f64,
}

/// One lane of modes.
pub struct Mode {
    /// Entity.
    pub path: String,
    /// What it can be, and the colour of each.
    pub values: Vec<(&'static str, u32)>,
    reading: Reading,
}

/// How a mode is read off the outputs.
enum Reading {
    By(fn(&Outputs) -> &'static str),
    Flag(&'static ValidityFacts),
}

impl Mode {
    fn new(path: &str, values: &[(&'static str, u32)], of: fn(&Outputs) -> &'static str) -> Self {
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

    /// What it is.
    pub fn of(&self, outputs: &Outputs) -> &'static str {
        match self.reading {
            Reading::By(of) => of(outputs),
            Reading::Flag(facts) if outputs.validity.contains(facts.flag) => facts.words,
            Reading::Flag(_) => WITHIN,
        }
    }
}

const LEFT: u32 = super::SIDES.left;
const RIGHT: u32 = super::SIDES.right;
const BLUE: u32 = 0x5B_A8_F5_FF;
const ORANGE: u32 = 0xF5_A0_3C_FF;
const VIOLET: u32 = 0xB6_8C_F0_FF;
const WHITE: u32 = 0xE6_E6_E6_FF;
const GREY: u32 = 0x8C_8C_8C_FF;

type Value = fn(&Outputs) -> f64;

const fn plot(path: &'static str, name: &'static str, colour: u32, of: Value) -> Plot {
    Plot { path, name, colour, width: 1.5, of }
}

const fn broad(path: &'static str, name: &'static str, colour: u32, of: Value) -> Plot {
    Plot { path, name, colour, width: 3.5, of }
}

/// Everything plotted.
#[rustfmt::skip]
pub const PLOTS: &[Plot] = &[
    broad("plots/height_m/above_ground", "above ground", ORANGE, |o| o.height_above_ground_m),
    plot("plots/height_m/above_sea", "above sea", BLUE, |o| o.place.height_m),
    broad("plots/airspeed_kt/calibrated", "calibrated", BLUE, |o| o.calibrated_airspeed_mps * KT_PER_MPS),
    plot("plots/airspeed_kt/true", "true", GREY, |o| o.airspeed_mps * KT_PER_MPS),
    plot("plots/climb_ft_per_min", "climb", ORANGE, |o| -o.velocity_mps.z * FPM_PER_MPS),
    plot("plots/attitude_deg/roll", "roll, right +", BLUE, |o| o.euler.roll_rad.to_degrees()),
    plot("plots/attitude_deg/pitch", "pitch, up +", ORANGE, |o| o.euler.pitch_rad.to_degrees()),
    plot("plots/attitude_deg/heading", "heading", VIOLET, |o| o.euler.heading_rad.to_degrees().rem_euclid(360.0)),
    plot("plots/rates_degps/p", "p roll", BLUE, |o| o.angular_rate_radps.x.to_degrees()),
    plot("plots/rates_degps/q", "q pitch", ORANGE, |o| o.angular_rate_radps.y.to_degrees()),
    plot("plots/rates_degps/r", "r yaw", VIOLET, |o| o.angular_rate_radps.z.to_degrees()),
    plot("plots/air_deg/alpha", "angle of attack", ORANGE, |o| o.alpha_rad.to_degrees()),
    plot("plots/air_deg/beta", "sideslip", VIOLET, |o| o.beta_rad.to_degrees()),
    plot("plots/load_factor", "load factor", ORANGE, |o| o.load_factor),
    plot("plots/pilot/stick_aft", "stick aft", ORANGE, |o| o.cockpit.stick_aft_norm),
    plot("plots/pilot/stick_right", "stick right", BLUE, |o| o.cockpit.stick_right_norm),
    plot("plots/pilot/collective", "collective", WHITE, |o| o.cockpit.collective_norm),
    plot("plots/pilot/pedal_right", "right pedal", VIOLET, |o| o.cockpit.pedal_right_norm),
    broad("plots/nacelle_deg/left", "left, 90 = helicopter", LEFT, |o| incidence_deg(o).left),
    plot("plots/nacelle_deg/right", "right", RIGHT, |o| incidence_deg(o).right),
    plot("plots/surfaces_deg/flap", "flap", WHITE, |o| o.actuators.flap_rad.to_degrees()),
    broad("plots/surfaces_deg/flaperon_left", "left flaperon", LEFT, |o| o.actuators.flaperon_rad.left.to_degrees()),
    plot("plots/surfaces_deg/flaperon_right", "right flaperon", RIGHT, |o| o.actuators.flaperon_rad.right.to_degrees()),
    plot("plots/surfaces_deg/elevator", "elevator", ORANGE, |o| o.actuators.elevator_rad.to_degrees()),
    plot("plots/surfaces_deg/rudder", "rudder right", VIOLET, |o| o.actuators.rudder_right_rad.to_degrees()),
    broad("plots/blades_deg/collective_left", "left collective", LEFT, |o| o.actuators.collective_rad.left.to_degrees()),
    plot("plots/blades_deg/collective_right", "right collective", RIGHT, |o| o.actuators.collective_rad.right.to_degrees()),
    broad("plots/cyclic_deg/left", "left, forward +", LEFT, |o| o.actuators.cyclic_forward_rad.left.to_degrees()),
    plot("plots/cyclic_deg/right", "right", RIGHT, |o| o.actuators.cyclic_forward_rad.right.to_degrees()),
    plot("plots/rotor_rpm", "rotors", WHITE, |o| o.rotor_speed_radps * RPM_PER_RADPS),
    broad("plots/power_kW/left", "left", LEFT, |o| 1e-3 * o.engines.power_w.left),
    plot("plots/power_kW/right", "right", RIGHT, |o| 1e-3 * o.engines.power_w.right),
    plot("plots/power_kW/available", "available", GREY, |o| 1e-3 * o.engines.available_w),
    broad("plots/thrust_kN/left", "left", LEFT, |o| 1e-3 * o.rotors.left.thrust_n),
    plot("plots/thrust_kN/right", "right", RIGHT, |o| 1e-3 * o.rotors.right.thrust_n),
    broad("plots/torque_kNm/left", "left", LEFT, |o| 1e-3 * o.rotors.left.torque_n_m),
    plot("plots/torque_kNm/right", "right", RIGHT, |o| 1e-3 * o.rotors.right.torque_n_m),
    broad("plots/induced_mps/left", "left", LEFT, |o| o.rotors.left.induced_mps),
    plot("plots/induced_mps/right", "right", RIGHT, |o| o.rotors.right.induced_mps),
    plot("plots/gear/push_kN/nose", "nose", BLUE, |o| 1e-3 * o.landing_gear.nose.push_n),
    broad("plots/gear/push_kN/left", "left", LEFT, |o| 1e-3 * o.landing_gear.main.left.push_n),
    plot("plots/gear/push_kN/right", "right", RIGHT, |o| 1e-3 * o.landing_gear.main.right.push_n),
    plot("plots/gear/extension", "gear, 1 = down", WHITE, |o| o.actuators.gear_extension_norm),
    plot("plots/fuel_kg", "fuel", WHITE, |o| o.fuel_kg),
];

const QUIET: u32 = 0x4A_5A_6A_FF;
const ACTIVE: u32 = 0x2F_7F_D0_FF;
const CAUTION: u32 = 0xE0_9A_20_FF;
const ALARM: u32 = 0xD0_40_38_FF;

/// What a model is that is outside none of its limits.
const WITHIN: &str = "within its data";

fn severity_colour(severity: Severity) -> u32 {
    match severity {
        Severity::Caution => CAUTION,
        Severity::Warning | Severity::Final => ALARM,
    }
}

/// Every mode shown, and a lane for every flag of validity.
pub static MODES: LazyLock<Vec<Mode>> = LazyLock::new(|| {
    let told = Validity::FACTS.iter().map(|facts| (facts.words, severity_colour(facts.severity)));
    let model: Vec<_> = [(WITHIN, QUIET)].into_iter().chain(told).collect();
    let modes = [
        Mode::new(
            "modes/nacelles",
            &[("helicopter", ACTIVE), ("converting", CAUTION), ("aeroplane", 0x30_90_60_FF)],
            nacelles,
        ),
        Mode::new(
            "modes/weight_on_wheels",
            &[("on the ground", 0x8A_6A_48_FF), ("airborne", ACTIVE)],
            ground,
        ),
        Mode::new(
            "modes/gear",
            &[("up", QUIET), ("moving", CAUTION), ("down", 0x30_90_60_FF)],
            gear,
        ),
        Mode::new(
            "modes/flaps",
            &[("0", QUIET), ("20", 0x2A_5C_90_FF), ("40", ACTIVE), ("75", 0x58_A8_F0_FF)],
            flaps,
        ),
        Mode::new("modes/scas", &[("off", ALARM), ("on", QUIET)], scas),
        Mode::new(
            "modes/rotor_speed",
            &[("helicopter", ACTIVE), ("aeroplane 517", QUIET), ("aeroplane 458", QUIET)],
            rotor_speed,
        ),
        Mode::new("modes/model", &model, model_validity),
    ];
    modes.into_iter().chain(Validity::FACTS.iter().map(Mode::of_flag)).collect()
});

/// As cockpits count: 90° as a helicopter.
fn incidence_deg(outputs: &Outputs) -> Pair<f64> {
    outputs.actuators.mast_tilt_rad.map(|tilt_rad| 90.0 - tilt_rad.to_degrees())
}

fn nacelles(outputs: &Outputs) -> &'static str {
    match incidence_deg(outputs).mean() {
        incidence_deg if incidence_deg > 85.0 => "helicopter",
        incidence_deg if incidence_deg > 1.0 => "converting",
        _ => "aeroplane",
    }
}

fn ground(outputs: &Outputs) -> &'static str {
    if outputs.landing_gear.main.map(|leg| leg.push_n).sum() > 0.0 {
        "on the ground"
    } else {
        "airborne"
    }
}

fn gear(outputs: &Outputs) -> &'static str {
    match outputs.actuators.gear_extension_norm {
        extension if extension >= 1.0 => "down",
        extension if extension <= 0.0 => "up",
        _ => "moving",
    }
}

fn flaps(outputs: &Outputs) -> &'static str {
    match outputs.cockpit.flap_detent {
        0 => "0",
        1 => "20",
        2 => "40",
        _ => "75",
    }
}

fn scas(outputs: &Outputs) -> &'static str {
    if outputs.cockpit.scas_on == 0 { "off" } else { "on" }
}

fn rotor_speed(outputs: &Outputs) -> &'static str {
    match outputs.cockpit.rpm_select {
        0 => "helicopter",
        1 => "aeroplane 517",
        _ => "aeroplane 458",
    }
}

/// The gravest of what it is outside of.
fn model_validity(outputs: &Outputs) -> &'static str {
    outputs.validity.gravest().map_or(WITHIN, |facts| facts.words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_two_lines_share_a_path() {
        let plots = PLOTS.iter().map(|plot| plot.path);
        let paths = plots.chain(MODES.iter().map(|mode| mode.path.as_str()));
        assert_eq!(paths.clone().collect::<BTreeSet<_>>().len(), paths.count());
    }

    fn lanes(outputs: &Outputs) -> Vec<(&'static str, &'static str)> {
        MODES.iter().map(|mode| (mode.path.as_str(), mode.of(outputs))).collect()
    }

    /// Of all 64 bits, those that the engine names: by the bits, not by the list that is shown.
    #[test]
    fn every_validity_bit_has_its_lane_and_changes_that_one_and_the_model_s() {
        let within = lanes(&Outputs::default());
        for bit in 0..64 {
            let flag = Validity::from_bits_retain(1 << bit);
            let outside = lanes(&Outputs { validity: flag, ..Outputs::default() });
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
    fn every_mode_has_a_colour() {
        let flags = (0..64).map(|bit| Validity::from_bits_retain(1 << bit));
        for validity in flags.chain([Validity::empty(), Validity::all()]) {
            let outputs = Outputs { validity, ..Outputs::default() };
            for mode in MODES.iter() {
                let value = mode.of(&outputs);
                assert!(mode.values.iter().any(|(known, _)| *known == value), "{value}");
            }
        }
    }

    #[test]
    fn a_wreck_is_not_within_its_data() {
        let outputs = Outputs { validity: Validity::HULL, ..Outputs::default() };
        assert!(lanes(&outputs).contains(&("modes/model", "hull on the ground")));
        assert!(lanes(&outputs).contains(&("validity/hull", "hull on the ground")));
    }
}
