//! The standard atmosphere's constants \[ISO2533\]; [`environment`](crate::environment) has its equations.

/// Temperature at sea level, K.
pub const TEMPERATURE_SL_K: f64 = 288.15;
/// Pressure at sea level, Pa.
pub const PRESSURE_SL_PA: f64 = 101_325.0;
/// Density at sea level, kg/m³.
pub const DENSITY_SL_KG_PER_M3: f64 = 1.225;
/// Speed of sound at sea level, m/s.
pub const SOUND_SPEED_SL_MPS: f64 = 340.294;
/// Fall of the temperature with height in the troposphere, K/m.
pub const LAPSE_K_PER_M: f64 = 0.0065;
/// Top of the troposphere, m.
pub const TROPOPAUSE_M: f64 = 11_000.0;
/// Gas constant of dry air, J/(kg·K).
pub const GAS_J_PER_KG_K: f64 = 287.052_87;
/// Ratio of the specific heats of air.
pub const HEAT_RATIO: f64 = 1.4;

#[cfg(test)]
mod tests {
    use super::*;

    /// ρ = p/(R·T) and a = √(γ·R·T), to the digits that are printed.
    #[test]
    fn density_and_speed_of_sound_follow_from_pressure_and_temperature() {
        let density = PRESSURE_SL_PA / (GAS_J_PER_KG_K * TEMPERATURE_SL_K);
        assert!((density - DENSITY_SL_KG_PER_M3).abs() < 5e-7, "{density}");
        let sound_mps = crate::math::sqrt(HEAT_RATIO * GAS_J_PER_KG_K * TEMPERATURE_SL_K);
        assert!((sound_mps - SOUND_SPEED_SL_MPS).abs() < 5e-4, "{sound_mps}");
    }
}
