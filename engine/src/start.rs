//! Where a flight begins.

use serde::Deserialize;

use crate::frames::{Attitude, Euler, Ned, Vec3};
use crate::inputs::{Inputs, World};
use crate::pair::Pair;
use crate::state::{Geodetic, Plant, State};
use crate::{Aircraft, GRAVITY_MPS2, cockpit, environment, fcc, rotors, step_state};

/// How long the aircraft settles on its wheels before the flight, in ticks.
///
/// Half a minute: the governor needs most of it to find the collective that idle power holds.
const SETTLING_TICKS: u64 = 7500;

/// Where and how a flight begins: standing on its wheels, rotors turning, nacelles up; or in the air.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Ground at the origin.
    pub origin: Geodetic,
    /// Heading.
    pub heading_rad: f64,
    /// Fuel aboard; without it the tanks are full.
    #[serde(default)]
    pub fuel_kg: Option<f64>,
    /// Flap lever's detent, 0..3.
    pub flap_detent: u64,
    /// The world.
    pub world: WorldStart,
    /// The steady flight in which it begins; without it, it stands on its wheels.
    #[serde(default)]
    pub trim: Option<TrimStart>,
}

/// A steady flight as a flight begins, nose along the start's heading.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrimStart {
    /// βm.
    pub mast_tilt_rad: f64,
    /// True airspeed.
    pub airspeed_mps: f64,
    /// Above mean sea level.
    pub altitude_m: f64,
    /// Upwards.
    #[serde(default)]
    pub climb_mps: f64,
    /// To the right.
    #[serde(default)]
    pub turn_radps: f64,
    /// Flap lever's detent, 0..3; without it, that of the start.
    #[serde(default)]
    pub flap_detent: Option<u64>,
    /// Rotor speed selected: 0 helicopter, 1 and 2 aeroplane.
    #[serde(default)]
    pub rpm_select: u64,
    /// 1 with the gear down.
    #[serde(default)]
    pub gear_down: u64,
    /// 1 with the SCAS on.
    #[serde(default)]
    pub scas_on: u64,
}

/// The world as a flight begins.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorldStart {
    /// Speed of the wind.
    pub wind_mps: f64,
    /// Where it comes from, clockwise from north.
    pub wind_from_rad: f64,
    /// Roughness length of the ground; 0 for the same wind at every height.
    #[serde(default)]
    pub wind_roughness_m: f64,
    /// Intensity of the vertical turbulence; 0 for still air.
    #[serde(default)]
    pub turbulence_mps: f64,
    /// Seed of the turbulence.
    #[serde(default)]
    pub turbulence_seed: u64,
    /// Warmer than standard by, K.
    pub temperature_offset_k: f64,
    /// Sea-level pressure above standard by, Pa.
    pub pressure_offset_pa: f64,
}

impl WorldStart {
    /// As the step takes it.
    pub fn world(&self) -> World {
        let wind_mps: Vec3<Ned> = Vec3::new(
            0.0 - self.wind_mps * crate::math::cos(self.wind_from_rad),
            0.0 - self.wind_mps * crate::math::sin(self.wind_from_rad),
            0.0,
        );
        World {
            wind_mps,
            wind_roughness_m: self.wind_roughness_m,
            turbulence_mps: self.turbulence_mps,
            temperature_offset_k: self.temperature_offset_k,
            pressure_offset_pa: self.pressure_offset_pa,
            ..World::default()
        }
    }
}

impl Start {
    /// Fuel aboard that aircraft.
    pub fn fuel_aboard_kg(&self, aircraft: &Aircraft) -> f64 {
        self.fuel_kg.unwrap_or(aircraft.weight_balance.fuel_kg_max)
    }

    /// The aircraft come to rest on its wheels, brakes set, rotors at speed, at tick 0. Where there is a
    /// `trim`, this is not how the flight begins: `analysis::start::state_at` says that.
    pub fn on_wheels(&self, aircraft: &Aircraft) -> State {
        let gear = &aircraft.landing_gear;
        let weights = &aircraft.weight_balance;
        let weight_n = (weights.zero_fuel_mass_kg + self.fuel_aboard_kg(aircraft)) * GRAVITY_MPS2;
        let sag_m = weight_n / (2.0 * gear.main.stiffness_n_per_m + gear.nose.stiffness_n_per_m);
        let height_m = weights.cg_m.z - gear.main.tyre_m.z - sag_m;
        let rotor_speed_radps = aircraft.fcc.governor.rotor_speed_radps[0];
        let governor = &aircraft.fcc.governor;
        let collective_rad = governor.lowest_rad(0.0);
        // The lever at its bottom, the masts upright.
        let to_governor = fcc::governor::Inputs {
            from_lever_rad: 0.0,
            rpm_select: 0,
            rotor_speed_radps,
            mast_tilt_rad: 0.0,
            failed: false,
        };
        let mut state = State {
            cockpit: cockpit::State {
                flap_detent: self.flap_detent.min(cockpit::FLAP_DETENT_LAST),
                gear_down: 1,
                parking_brake: 1,
                scas_on: 1,
                ..cockpit::State::default()
            },
            fcc: fcc::State {
                governor: fcc::governor::settled(governor, &to_governor, collective_rad),
                ..fcc::State::default()
            },
            environment: environment::State {
                noise: self.world.turbulence_seed,
                ..environment::State::default()
            },
            plant: Plant {
                origin: self.origin,
                position_m: Vec3::new(0.0, 0.0, -height_m),
                attitude: Attitude::from_euler(Euler {
                    heading_rad: self.heading_rad,
                    ..Euler::default()
                }),
                rotors: Pair::both(rotors::State::default()),
                rotor_speed_radps,
                fuel_kg: self.fuel_aboard_kg(aircraft),
                ..Plant::default()
            },
            ..State::default()
        };
        state.actuators.gear_extension_norm = 1.0;
        state.actuators.collective_rad = Pair::both(collective_rad);
        state.actuators.flap_rad = aircraft.fcc.mixer.flap_rad[state.cockpit.flap_detent as usize];
        // It settles in still air: what it settles to does not depend on the seed.
        let world = World { turbulence_mps: 0.0, ..self.world.world() };
        for _ in 0..SETTLING_TICKS {
            step_state(aircraft, &mut state, &Inputs { events: &[], world });
        }
        state.tick = 0;
        state.plant.fuel_kg = self.fuel_aboard_kg(aircraft);
        state.plant.position_m.x = 0.0;
        state.plant.position_m.y = 0.0;
        state
    }
}
