//! Environment: the air.
//!
//! # Equations
//! ```text
//! T = T0 − L·h + ΔT        p = (p0 + Δp)·(1 − L·h/T0)^(g/(R·L))       h ≤ 11 km      [ISO2533]
//! T = T11 + ΔT             p = p11·exp(−g·(h − 11 km)/(R·T11))        above
//! ρ = p/(R·T)              a = √(γ·R·T)
//! ```
//! # Assumptions
//! Steady wind, the same everywhere; geometric height taken for geopotential. Gusts, shear and
//! turbulence are not modelled yet.

use serde::{Deserialize, Serialize};

use crate::GRAVITY_MPS2;
use crate::math::{clamp, exp, pow_positive, sqrt};

const TEMPERATURE_SL_K: f64 = 288.15;
const PRESSURE_SL_PA: f64 = 101_325.0;
const LAPSE_K_PER_M: f64 = 0.0065;
const GAS_J_PER_KG_K: f64 = 287.052_87;
const TROPOPAUSE_M: f64 = 11_000.0;
const HEAT_RATIO: f64 = 1.4;

/// Density of the standard atmosphere at sea level, kg/m³.
pub const DENSITY_SL_KG_PER_M3: f64 = 1.225;

/// Where the air is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// Above mean sea level, m.
    pub height_m: f64,
    /// Warmer than standard by, K.
    pub temperature_offset_k: f64,
    /// Sea-level pressure above standard by, Pa.
    pub pressure_offset_pa: f64,
}

/// The air.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// ρ.
    pub density_kg_per_m3: f64,
    /// p.
    pub pressure_pa: f64,
    /// T.
    pub temperature_k: f64,
    /// a.
    pub sound_speed_mps: f64,
}

/// The air at a height; heights beyond −2..20 km count as those, and so do offsets beyond ±80 K and
/// ±20 kPa: no weather is beyond, and there is always some air to divide by.
pub fn air(inputs: &Inputs) -> Outputs {
    let height_m = clamp(inputs.height_m, -2_000.0, 20_000.0);
    let in_troposphere_m = clamp(height_m, -2_000.0, TROPOPAUSE_M);
    let standard_k = TEMPERATURE_SL_K - LAPSE_K_PER_M * in_troposphere_m;
    let exponent = GRAVITY_MPS2 / (GAS_J_PER_KG_K * LAPSE_K_PER_M);
    let above_m = height_m - in_troposphere_m;
    let pressure_pa = (PRESSURE_SL_PA + clamp(inputs.pressure_offset_pa, -20e3, 20e3))
        * pow_positive(standard_k / TEMPERATURE_SL_K, exponent)
        * exp(-GRAVITY_MPS2 * above_m / (GAS_J_PER_KG_K * standard_k));
    let temperature_k = standard_k + clamp(inputs.temperature_offset_k, -80.0, 80.0);
    Outputs {
        density_kg_per_m3: pressure_pa / (GAS_J_PER_KG_K * temperature_k),
        pressure_pa,
        temperature_k,
        sound_speed_mps: sqrt(HEAT_RATIO * GAS_J_PER_KG_K * temperature_k),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(height_m: f64) -> Outputs {
        air(&Inputs { height_m, temperature_offset_k: 0.0, pressure_offset_pa: 0.0 })
    }

    /// Printed values of ISO 2533.
    #[test]
    fn val_the_standard_atmosphere() {
        for (height_m, t_k, p_pa, rho) in [
            (0.0, 288.15, 101_325.0, 1.225),
            (5_000.0, 255.65, 54_019.9, 0.736_116),
            (11_000.0, 216.65, 22_632.0, 0.363_918),
            (15_000.0, 216.65, 12_044.6, 0.193_674),
        ] {
            let air = at(height_m);
            assert!((air.temperature_k / t_k - 1.0).abs() < 1e-5, "{height_m} m");
            assert!((air.pressure_pa / p_pa - 1.0).abs() < 1e-4, "{height_m} m");
            assert!((air.density_kg_per_m3 / rho - 1.0).abs() < 1e-4, "{height_m} m");
        }
    }

    #[test]
    fn no_offset_takes_the_air_away() {
        let air = air(&Inputs {
            height_m: 20e3,
            temperature_offset_k: -1e9,
            pressure_offset_pa: -PRESSURE_SL_PA,
        });
        assert!(air.density_kg_per_m3 > 0.05 && air.temperature_k > 100.0);
    }

    #[test]
    fn warm_air_is_thinner_at_the_same_pressure() {
        let warm =
            air(&Inputs { height_m: 0.0, temperature_offset_k: 20.0, pressure_offset_pa: 0.0 });
        assert!(warm.density_kg_per_m3 < at(0.0).density_kg_per_m3);
        assert_eq!(warm.pressure_pa.to_bits(), at(0.0).pressure_pa.to_bits());
    }
}
