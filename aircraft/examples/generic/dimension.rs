//! The power of the length ratio by which a quantity goes, from the unit that its key ends in.

/// Units by their words in a key, with the powers of length, mass and time.
const UNITS: [(&str, i32, i32, i32); 17] = [
    ("m", 1, 0, 0),
    ("m2", 2, 0, 0),
    ("m3", 3, 0, 0),
    ("s", 0, 0, 1),
    ("kg", 0, 1, 0),
    ("n", 1, 1, -2),
    ("w", 2, 1, -3),
    ("j", 2, 1, -2),
    ("pa", -1, 1, -2),
    ("mps", 1, 0, -1),
    ("mps2", 1, 0, -2),
    ("radps", 0, 0, -1),
    ("radps2", 0, 0, -2),
    ("rad", 0, 0, 0),
    ("rad2", 0, 0, 0),
    ("norm", 0, 0, 0),
    ("k", 0, 0, 0),
];

/// Twice the power of the length ratio: length counts 1, mass 3, time ½.
pub fn half_powers(key: &str) -> i32 {
    let (si_key, _) = aircraft::units::to_si(key);
    let stem = si_key.strip_suffix("_min").or(si_key.strip_suffix("_max")).unwrap_or(&si_key);
    let unit = |word: &str| UNITS.iter().find(|(known, ..)| *known == word);
    let words: Vec<&str> = stem.split('_').collect();
    let name = words.iter().rposition(|word| *word != "per" && unit(word).is_none());
    let mut sign = 1;
    let mut sum = 0;
    for word in &words[name.map_or(0, |at| at + 1)..] {
        match unit(word) {
            Some((_, length, mass, time)) => sum += sign * (2 * length + 6 * mass + time),
            None => sign = -1,
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: twice 1, 3, 5, 3, 4, 3.5, −1, ½, −½, 0, 2, 2.5, −1 (kg/J), 1 (Pa), −1 (rad/m), −½ (s·rad/m).
    #[test]
    fn powers_are_those_of_froude() {
        for (key, twice) in [
            ("radius_ft", 2),
            ("zero_fuel_mass_lb", 6),
            ("xx_slug_ft2", 10),
            ("jet_thrust_lbf", 6),
            ("torque_in_lbf_max", 8),
            ("rated_power_hp", 7),
            ("reference_rpm_per_s", -2),
            ("cruise_kt", 1),
            ("rotor_speed_rpm", -1),
            ("precone_deg", 0),
            ("solidity", 0),
            ("stiffness_lbf_per_ft", 4),
            ("damping_lbf_s_per_ft", 5),
            ("fuel_lb_per_hp_h", -2),
            ("dynamic_pressure_pa", 2),
            ("elevator_per_longitudinal_stick_deg_per_in", -2),
            ("attitude_by_speed_s_rad_per_m", -1),
            ("deflection_per_tilt_per_deg", 0),
            ("integral_deg_per_rpm_s", 0),
            ("lift_m2_per_kg_rad", -2),
        ] {
            assert_eq!(half_powers(key), twice, "{key}");
        }
    }
}
