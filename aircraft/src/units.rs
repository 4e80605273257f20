//! Units by the end of a key: which SI key is meant, and by what to multiply.
//!
//! `_min` and `_max` may follow the unit. A key that ends in none of these is in SI already, or has
//! no unit.

use engine::units::{
    DEGREE_RAD as DEG, FOOT_M as FT, FOOT_PER_MINUTE_MPS as FPM, HECTOPASCAL_PA as HPA,
    HORSEPOWER_W as HP, HOUR_S as HOUR, INCH_M as IN, KNOT_MPS as KT, POUND_KG as LB,
    POUND_N as LBF, RPM_RADPS as RPM, SLUG_KG as SLUG,
};

/// (end of the key, end of the SI key, factor). Where two fit, the longer one counts.
const UNITS: &[(&str, &str, f64)] = &[
    ("in", "m", IN),
    ("ft", "m", FT),
    ("ft2", "m2", FT * FT),
    ("ft3", "m3", FT * FT * FT),
    ("ftps", "mps", FT),
    ("inps", "mps", IN),
    ("fpm", "mps", FPM),
    ("kt", "mps", KT),
    ("deg", "rad", DEG),
    ("degps", "radps", DEG),
    ("rpm", "radps", RPM),
    ("rpm_per_s", "radps2", RPM),
    ("lb", "kg", LB),
    ("slug", "kg", SLUG),
    ("slug_ft2", "kg_m2", SLUG * FT * FT),
    ("lbf", "n", LBF),
    ("ft_lbf", "n_m", FT * LBF),
    ("in_lbf", "n_m", IN * LBF),
    ("psf", "pa", LBF / (FT * FT)),
    ("hpa", "pa", HPA),
    ("hp", "w", HP),
    ("lb_per_h", "kg_per_s", LB / HOUR),
    ("lb_per_hp_h", "kg_per_j", LB / (HP * HOUR)),
    ("lbf_per_ft", "n_per_m", LBF / FT),
    ("lbf_s_per_ft", "n_s_per_m", LBF / FT),
    ("ft_lbf_per_deg", "n_m_per_rad", FT * LBF / DEG),
    ("per_deg", "per_rad", 1.0 / DEG),
    ("per_deg2", "per_rad2", 1.0 / (DEG * DEG)),
    ("ft2_per_deg", "m2_per_rad", FT * FT / DEG),
    ("ft2_per_rad", "m2_per_rad", FT * FT),
    ("ft3_per_deg", "m3_per_rad", FT * FT * FT / DEG),
    ("ft3_per_rad", "m3_per_rad", FT * FT * FT),
    ("deg_per_in", "rad_per_m", DEG / IN),
    ("deg_per_rpm", "rad_per_radps", DEG / RPM),
    ("deg_per_rpm_s", "rad_per_rad", DEG / RPM),
    ("in_per_rad", "m_per_rad", IN),
    ("in_per_deg", "m_per_rad", IN / DEG),
    ("in_per_radps", "m_per_radps", IN),
    ("kt_per_deg", "mps_per_rad", KT / DEG),
    ("in_per_degps", "m_per_radps", IN / DEG),
];

/// Before and after the unit, the latter being nothing, `_min` or `_max`.
pub(crate) fn without_bound(key: &str) -> (&str, &str) {
    let at = ["_min", "_max"].iter().find_map(|bound| Some(key.strip_suffix(bound)?.len()));
    key.split_at(at.unwrap_or(key.len()))
}

/// What stands before `unit` at the end of `key`, if it does: nothing, or a name and its `_`.
fn before<'a>(key: &'a str, unit: &str) -> Option<&'a str> {
    key.strip_suffix(unit).filter(|name| name.is_empty() || name.ends_with('_'))
}

/// The SI key for `key`, and the factor that brings its value to SI.
pub fn to_si(key: &str) -> (String, f64) {
    let (stem, bound) = without_bound(key);
    UNITS
        .iter()
        .filter_map(|(unit, si, factor)| Some((before(stem, unit)?, si, factor)))
        .min_by_key(|(name, ..)| name.len())
        .map_or_else(
            || (key.to_owned(), 1.0),
            |(name, si, factor)| (format!("{name}{si}{bound}"), *factor),
        )
}

/// Whether an SI key may be written in another unit.
pub fn has_other_units(si_key: &str) -> bool {
    let (stem, _) = without_bound(si_key);
    UNITS.iter().any(|(_, si, _)| before(stem, si).is_some())
}

#[cfg(test)]
mod tests {
    use engine::math::PI;

    use super::*;

    #[track_caller]
    fn reads(key: &str, value: f64, si_key: &str, si_value: f64) {
        let (name, factor) = to_si(key);
        assert_eq!(name, si_key);
        let error = (value * factor / si_value - 1.0).abs();
        assert!(error < 1e-12, "{key}: {} is not {si_value}", value * factor);
    }

    /// By hand, from the definitions of the foot, the pound and the nautical mile.
    #[test]
    fn units_are_their_definitions() {
        reads("radius_ft", 12.5, "radius_m", 3.81);
        reads("pivot_in", 300.0, "pivot_m", 7.62);
        reads("area_ft2", 100.0, "area_m2", 9.290_304);
        reads("volume_ft3", 1000.0, "volume_m3", 28.316_846_592);
        reads("wind_kt", 360.0, "wind_mps", 185.2);
        reads("speed_ftps_max", 1000.0, "speed_mps_max", 304.8);
        reads("fuel_lb_max", 1000.0, "fuel_kg_max", 453.592_37);
        reads("thrust_lbf", 1.0, "thrust_n", 4.448_221_615_260_5);
        reads("xx_slug_ft2", 1.0, "xx_kg_m2", 1.355_817_948_331_400_4);
        reads("power_hp", 1.0, "power_w", 745.699_871_582_270_2);
        reads("torque_in_lbf_max", 12.0, "torque_n_m_max", 1.355_817_948_331_400_4);
        reads("stiffness_lbf_per_ft", 1.0, "stiffness_n_per_m", 14.593_902_937_206_364);
        reads("damping_lbf_s_per_ft", 1.0, "damping_n_s_per_m", 14.593_902_937_206_364);
        reads("pressure_psf", 1.0, "pressure_pa", 47.880_258_980_335_84);
    }

    #[test]
    fn angles_and_what_goes_by_them() {
        reads("heading_deg", 180.0, "heading_rad", PI);
        reads("deg_min", -180.0, "rad_min", -PI);
        reads("rate_degps_max", 90.0, "rate_radps_max", PI / 2.0);
        reads("rotor_speed_rpm", 30.0, "rotor_speed_radps", PI);
        reads("reference_rpm_per_s", 30.0, "reference_radps2", PI);
        reads("slope_per_deg", PI, "slope_per_rad", 180.0);
        reads("gearing_deg_per_in", 2.54, "gearing_rad_per_m", PI / 1.8);
        // A degree for a turn per minute is a sixth of a radian for a radian per second.
        reads("gain_deg_per_rpm", 6.0, "gain_rad_per_radps", 1.0);
        reads("gain_deg_per_rpm_s", 6.0, "gain_rad_per_rad", 1.0);
        reads("gain_in_per_degps", PI, "gain_m_per_radps", 180.0 * 0.0254);
    }

    /// A pound of fuel per horsepower hour: 0.45359237 kg over 2.684 519 537 7 MJ.
    #[test]
    fn fuel_goes_by_energy_or_by_time() {
        reads("fuel_lb_per_hp_h", 1.0, "fuel_kg_per_j", 0.453_592_37 / 2.684_519_537_696_173e6);
        reads("fuel_lb_per_h", 3600.0, "fuel_kg_per_s", 0.453_592_37);
    }

    /// What a key is turned into is made of the units that recorded names end in; J is N·m.
    #[test]
    fn every_si_key_is_made_of_the_engine_s_units() {
        for (_, si_key, _) in UNITS {
            for word in si_key.split('_').filter(|word| *word != "per" && *word != "j") {
                let known = engine::units::SI.iter().any(|(known, _)| *known == word);
                assert!(known || word == "rad2", "{si_key}: {word}");
            }
        }
    }

    #[test]
    fn what_is_in_si_or_has_no_unit_stays() {
        for key in ["mass_kg", "dead_norm", "code", "raw_max", "flap_detent", "slope_per_rad", "x"]
        {
            assert_eq!(to_si(key), (key.to_owned(), 1.0));
        }
    }
}
