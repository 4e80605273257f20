//! Units as FMI describes them: powers of SI's base units, and a factor.

/// Powers of kg, m, s, K, rad, and what the unit is multiplied with to be in those.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseUnit {
    /// kg, m, s, K, rad.
    pub powers: [i32; 5],
    /// How many of the base units one of this unit is.
    pub factor: f64,
}

/// The attributes of the powers, in FMI's schema.
pub const BASES: [&str; 5] = ["kg", "m", "s", "K", "rad"];

/// One unit without products, quotients or powers.
fn atom(name: &str) -> Option<BaseUnit> {
    use engine::units::{DEG_PER_RAD, FOOT_M, KNOT_MPS, POUND_KG};
    let (powers, factor) = match name {
        "kg" => ([1, 0, 0, 0, 0], 1.0),
        "m" => ([0, 1, 0, 0, 0], 1.0),
        "s" => ([0, 0, 1, 0, 0], 1.0),
        "K" => ([0, 0, 0, 1, 0], 1.0),
        "rad" => ([0, 0, 0, 0, 1], 1.0),
        "N" => ([1, 1, -2, 0, 0], 1.0),
        "W" => ([1, 2, -3, 0, 0], 1.0),
        "Pa" => ([1, -1, -2, 0, 0], 1.0),
        "ns" => ([0, 0, 1, 0, 0], 1e-9),
        "deg" => ([0, 0, 0, 0, 1], 1.0 / DEG_PER_RAD),
        "kt" => ([0, 1, -1, 0, 0], KNOT_MPS),
        "ft" => ([0, 1, 0, 0, 0], FOOT_M),
        "min" => ([0, 0, 1, 0, 0], 60.0),
        "lb" => ([1, 0, 0, 0, 0], POUND_KG),
        // A part of a control's travel.
        "norm" => ([0; 5], 1.0),
        _ => return None,
    };
    Some(BaseUnit { powers, factor })
}

/// What a unit as logs and parameters write it (`kg·m²`, `N·m/rad`) is in base units.
pub fn base_unit(name: &str) -> Option<BaseUnit> {
    let mut found = BaseUnit { powers: [0; 5], factor: 1.0 };
    for (place, product) in name.split('/').enumerate() {
        for factor in product.split('·') {
            let (factor, times) = match (factor.strip_suffix('²'), factor.strip_suffix('³')) {
                (Some(name), _) => (name, 2),
                (_, Some(name)) => (name, 3),
                _ => (factor, 1),
            };
            let base = atom(factor)?;
            for _ in 0..times {
                for (power, more) in found.powers.iter_mut().zip(base.powers) {
                    *power += if place == 0 { more } else { -more };
                }
                found.factor = if place == 0 {
                    found.factor * base.factor
                } else {
                    found.factor / base.factor
                };
            }
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_quotients_and_powers_are_taken_apart() {
        let powers = |name| base_unit(name).map(|unit| unit.powers);
        assert_eq!(powers("m/s²"), Some([0, 1, -2, 0, 0]));
        assert_eq!(powers("kg·m²"), Some([1, 2, 0, 0, 0]));
        assert_eq!(powers("N·m/rad"), Some([1, 2, -2, 0, -1]));
        assert_eq!(powers("furlong"), None);
        assert_eq!(base_unit("ft/min").map(|unit| unit.factor), Some(0.3048 / 60.0));
    }
}
