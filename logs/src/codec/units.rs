//! The unit of a recorded number, read off its name: the last words of `plant.velocity_mps.x` say m/s.

use std::fmt;

use engine::units::SI;

/// The unit of the number at `path`; empty for a count, a flag or a ratio. `norm` is travel of a
/// control as a part of the whole.
pub fn unit_of(path: &str) -> String {
    // What comes after the name that has the unit: an axis, a side, a place in an array.
    const PARTS: [&str; 7] = ["x", "y", "z", "left", "right", "nose", "main"];
    let name = path
        .split(['.', '['])
        .rev()
        .find(|part| !PARTS.contains(part) && !part.ends_with(']'))
        .unwrap_or_default();
    if !name.contains('_') {
        // A name is more than its unit.
        return String::new();
    }
    let written = |word: &str| SI.iter().find(|(known, _)| *known == word).map(|unit| unit.1);
    let mut words = name.rsplit('_').peekable();
    let mut unit = String::new();
    while let Some(word) = words.next() {
        let Some(written) = written(word) else { break };
        unit.insert_str(0, written);
        match words.peek() {
            Some(&"per") => {
                unit.insert(0, '/');
                words.next();
            }
            // The products there are: kg·m², N·m, N·m·s.
            Some(&"n" | &"kg") => unit.insert(0, '·'),
            Some(&"m") if word == "s" => unit.insert(0, '·'),
            _ => break,
        }
    }
    // A name that only ends like one: `per_m` with nothing before it.
    unit.trim_start_matches(['/', '·']).to_string()
}

/// A value with its unit behind it, if it has one.
pub fn with_unit(value: impl fmt::Display, unit: &str) -> String {
    if unit.is_empty() { value.to_string() } else { format!("{value} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_its_unit() {
        let said = [
            ("plant.velocity_mps.x", "m/s"),
            ("plant.rotors.left.flapping.right_rad", "rad"),
            ("total.moment_n_m.z", "N·m"),
            ("balance.inertia.xx_kg_m2", "kg·m²"),
            ("air.density_kg_per_m3", "kg/m³"),
            ("rate.engines.power_w_per_s.left", "W/s"),
            ("damping_n_m_s_per_rad", "N·m·s/rad"),
            ("plant.tyre_deflections.main.left.forward_m", "m"),
            ("cockpit.brake_norm.right", "norm"),
            ("world.gust_s", "s"),
        ];
        for (path, unit) in said {
            assert_eq!(unit_of(path), unit, "{path}");
        }
    }

    #[test]
    fn what_has_no_unit_gets_none() {
        for path in ["tick", "plant.attitude.w", "cockpit.flap_detent", "mach", "plant.frozen", ""]
        {
            assert_eq!(unit_of(path), "", "{path}");
        }
    }
}
