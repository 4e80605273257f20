//! Environment: the air, how it moves on the whole, in gusts and in turbulence.
//!
//! # Equations
//! ```text
//! T = T0 − L·h + ΔT        p = (p0 + Δp)·(1 − L·h/T0)^(g/(R·L))       h ≤ 11 km      [ISO2533]
//! T = T11 + ΔT             p = p11·exp(−g·(h − 11 km)/(R·T11))        above
//! ρ = p/(R·T)              a = √(γ·R·T)
//! shear:  W(h) = W20·ln(h/z0)/ln(20 ft/z0),  1 ft ≤ h ≤ 1000 ft                      [MIL8785]
//! gust:   ½·A·(1 − cos(2πt/D)),  0 ≤ t ≤ D                                           [MIL8785]
//! Dryden: H_u = σu·√(2τu)/(1 + τu·s)     H_v,w = σ·√τ·(1 + √3·τ·s)/(1 + τ·s)²,  τ = L/V   [MIL8785]
//!         h < 1000 ft: Lw = h, Lu = Lv = h/(.177 + .000823h)^1.2, σu = σv = σw/(.177 + .000823h)^.4  [ft]
//!         h > 2000 ft: L = 1750 ft, σ alike;  a straight line between
//! ```
//! # Signs
//! Wind and gusts are motions of the air in NED. Turbulence is a motion of the air in body axes.
//! # Assumptions
//! Geometric height taken for geopotential. The same air everywhere on the aircraft: no gust
//! penetration, no rotary gusts. Below 10 m/s the turbulence passes as if at 10 m/s: it drifts by even
//! where nobody flies. The wind given is that at 20 ft when there is shear.

use serde::{Deserialize, Serialize};

use crate::frames::{Body, Ned, Vec3};
use crate::inputs::World;
use crate::isa::{
    GAS_J_PER_KG_K, HEAT_RATIO, LAPSE_K_PER_M, PRESSURE_SL_PA, TEMPERATURE_SL_K, TROPOPAUSE_M,
};
use crate::math::{TAU, clamp, cos, exp, ln, max, pow_positive, ramp, sqrt};
use crate::units::FOOT_M as FT;
use crate::{GRAVITY_MPS2, STEP_S};

/// Slowest passage of the turbulence, m/s.
const PASSAGE_MPS_MIN: f64 = 10.0;

/// Where the air is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// Above mean sea level, m.
    pub height_m: f64,
    /// Above the ground, m.
    pub height_above_ground_m: f64,
    /// Airspeed of the tick before, m/s.
    pub airspeed_mps: f64,
    /// Now.
    pub tick: u64,
    /// Wind, gust, turbulence, temperature, pressure.
    pub world: &'a World,
}

/// What the turbulence remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Of the generator of its noise; its seed at the start.
    pub noise: u64,
    /// 1 in a mirror image, whose noise from the side is the mirrored noise.
    pub mirrored: u64,
    /// Motion of the air along the body.
    pub turbulence_mps: Vec3<Body>,
    /// First stage of the lateral filter.
    pub lateral_stage_mps: f64,
    /// First stage of the vertical filter.
    pub vertical_stage_mps: f64,
}

/// The air, and how it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// Steady wind with shear, and gust.
    pub wind_mps: Vec3<Ned>,
    /// Turbulence.
    pub turbulence_mps: Vec3<Body>,
    /// ρ.
    pub density_kg_per_m3: f64,
    /// p.
    pub pressure_pa: f64,
    /// T.
    pub temperature_k: f64,
    /// a.
    pub sound_speed_mps: f64,
}

/// The air of this tick, and what the turbulence remembers after it.
pub fn update(state: &State, inputs: &Inputs) -> (State, Outputs) {
    let next = turbulence(state, inputs);
    let still = air(inputs.height_m, inputs.world);
    let outputs = Outputs {
        wind_mps: inputs.world.wind_mps * shear(inputs) + gust(inputs),
        turbulence_mps: next.turbulence_mps,
        ..still
    };
    (next, outputs)
}

/// The still air at a height; heights beyond −2..20 km count as those, and so do offsets beyond ±80 K
/// and ±20 kPa: no weather is beyond, and there is always some air to divide by.
pub fn air(height_m: f64, world: &World) -> Outputs {
    let height_m = clamp(height_m, -2_000.0, 20_000.0);
    let in_troposphere_m = clamp(height_m, -2_000.0, TROPOPAUSE_M);
    let standard_k = TEMPERATURE_SL_K - LAPSE_K_PER_M * in_troposphere_m;
    let exponent = GRAVITY_MPS2 / (GAS_J_PER_KG_K * LAPSE_K_PER_M);
    let above_m = height_m - in_troposphere_m;
    let stratosphere = if above_m > 0.0 {
        exp(-GRAVITY_MPS2 * above_m / (GAS_J_PER_KG_K * standard_k))
    } else {
        1.0
    };
    let pressure_pa = (PRESSURE_SL_PA + clamp(world.pressure_offset_pa, -20e3, 20e3))
        * pow_positive(standard_k / TEMPERATURE_SL_K, exponent)
        * stratosphere;
    let temperature_k = standard_k + clamp(world.temperature_offset_k, -80.0, 80.0);
    Outputs {
        density_kg_per_m3: pressure_pa / (GAS_J_PER_KG_K * temperature_k),
        pressure_pa,
        temperature_k,
        sound_speed_mps: sqrt(HEAT_RATIO * GAS_J_PER_KG_K * temperature_k),
        wind_mps: Vec3::zero(),
        turbulence_mps: Vec3::zero(),
    }
}

/// Wind here over the wind given.
fn shear(inputs: &Inputs) -> f64 {
    let roughness_m = inputs.world.wind_roughness_m;
    if roughness_m <= 0.0 {
        return 1.0;
    }
    let height_m = clamp(inputs.height_above_ground_m, FT, 1000.0 * FT);
    max(0.0, ln(height_m / roughness_m) / ln(20.0 * FT / roughness_m))
}

/// The discrete gust of this moment.
fn gust(inputs: &Inputs) -> Vec3<Ned> {
    let world = inputs.world;
    let Some(ticks) = inputs.tick.checked_sub(world.gust_start_tick) else {
        return Vec3::zero();
    };
    let since_s = ticks as f64 * STEP_S;
    if world.gust_s <= 0.0 || since_s >= world.gust_s {
        return Vec3::zero();
    }
    world.gust_mps * (0.5 * (1.0 - cos(TAU * since_s / world.gust_s)))
}

fn turbulence(state: &State, inputs: &Inputs) -> State {
    let vertical_mps = inputs.world.turbulence_mps;
    if vertical_mps <= 0.0 {
        // The generator rests: a flight through still air does not depend on the seed.
        return State { noise: state.noise, mirrored: state.mirrored, ..State::default() };
    }
    let height_ft = clamp(inputs.height_above_ground_m / FT, 10.0, 1000.0);
    let base = 0.177 + 0.000_823 * height_ft;
    let high = ramp(inputs.height_above_ground_m / FT, 1000.0, 2000.0);
    let between = |low: f64, above: f64| low + high * (above - low);
    let along_m = between(height_ft / pow_positive(base, 1.2), 1750.0) * FT;
    let vertical_m = between(height_ft, 1750.0) * FT;
    let along_mps = between(vertical_mps / pow_positive(base, 0.4), vertical_mps);

    let passage_mps = max(inputs.airspeed_mps, PASSAGE_MPS_MIN);
    let (along_s, vertical_s) = (along_m / passage_mps, vertical_m / passage_mps);
    let mut noise = state.noise;
    // White noise of unit spectral density, held for a tick.
    let mut white = || gaussian(&mut noise) / sqrt(STEP_S);
    let (u, v, w) = (white(), white(), white());
    let v = if state.mirrored != 0 { -v } else { v };
    let before = state.turbulence_mps;
    let second_order = |value: f64, stage: f64, tau_s: f64, sigma_mps: f64, white: f64| {
        // (1 + √3·τs)/(1 + τs)² as a lag whose input is 1/(1 + τs) and √3 times its rest.
        let stage_rate = (white - stage) / tau_s;
        let lead = stage + sqrt(3.0) * tau_s * stage_rate;
        let drive = sigma_mps * sqrt(tau_s) * lead;
        (value + STEP_S / tau_s * (drive - value), stage + STEP_S * stage_rate)
    };
    let (v, lateral_stage_mps) =
        second_order(before.y, state.lateral_stage_mps, along_s, along_mps, v);
    let (w, vertical_stage_mps) =
        second_order(before.z, state.vertical_stage_mps, vertical_s, vertical_mps, w);
    let u = before.x + STEP_S / along_s * (along_mps * sqrt(2.0 * along_s) * u - before.x);
    State {
        noise,
        mirrored: state.mirrored,
        turbulence_mps: Vec3::new(u, v, w),
        lateral_stage_mps,
        vertical_stage_mps,
    }
}

/// A number of mean 0 and variance 1, near enough to normal: twelve uniform ones summed.
fn gaussian(noise: &mut u64) -> f64 {
    let mut sum = -6.0;
    for _ in 0..12 {
        // SplitMix64: any seed will do, zero included.
        *noise = noise.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *noise;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        sum += ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(height_m: f64) -> Outputs {
        air(height_m, &World::default())
    }

    fn inputs(world: &World, tick: u64, height_above_ground_m: f64) -> Inputs<'_> {
        Inputs { height_m: 0.0, height_above_ground_m, airspeed_mps: 50.0, tick, world }
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
        let world = World {
            temperature_offset_k: -1e9,
            pressure_offset_pa: -PRESSURE_SL_PA,
            ..World::default()
        };
        let air = air(20e3, &world);
        assert!(air.density_kg_per_m3 > 0.05 && air.temperature_k > 100.0);
    }

    #[test]
    fn warm_air_is_thinner_at_the_same_pressure() {
        let warm = air(0.0, &World { temperature_offset_k: 20.0, ..World::default() });
        assert!(warm.density_kg_per_m3 < at(0.0).density_kg_per_m3);
        assert_eq!(warm.pressure_pa.to_bits(), at(0.0).pressure_pa.to_bits());
    }

    #[test]
    fn the_wind_given_is_that_at_twenty_feet() {
        let world = World { wind_roughness_m: 0.045, ..World::default() };
        assert!((shear(&inputs(&world, 0, 20.0 * FT)) - 1.0).abs() < 1e-12);
        assert!(shear(&inputs(&world, 0, 2.0)) < 1.0);
        assert!(shear(&inputs(&world, 0, 200.0)) > 1.2);
        assert!((shear(&inputs(&World::default(), 0, 200.0)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_gust_swells_once_to_its_amplitude() {
        let world = World {
            gust_mps: Vec3::new(0.0, 0.0, -8.0),
            gust_s: 2.0,
            gust_start_tick: 100,
            ..World::default()
        };
        let up = |tick| -gust(&inputs(&world, tick, 50.0)).z;
        assert!(up(99) == 0.0 && up(100).abs() < 1e-12 && up(600).abs() < 1e-12);
        assert!((up(350) - 8.0).abs() < 1e-12);
    }

    #[test]
    fn turbulence_has_the_intensity_it_was_given() {
        let world = World { turbulence_mps: 2.0, ..World::default() };
        let mut state = State { noise: 7, ..State::default() };
        let (mut sum, mut square, ticks) = (0.0, 0.0, 2_000_000_u64);
        for tick in 0..ticks {
            state = turbulence(&state, &inputs(&world, tick, 3000.0));
            sum += state.turbulence_mps.z;
            square += state.turbulence_mps.z * state.turbulence_mps.z;
        }
        let mean = sum / ticks as f64;
        let rms = sqrt(square / ticks as f64 - mean * mean);
        // Eight thousand seconds at ten seconds a swing: a few per cent of scatter.
        assert!((rms / 2.0 - 1.0).abs() < 0.1, "{rms}");
        assert!(mean.abs() < 0.2, "{mean}");
    }
}
