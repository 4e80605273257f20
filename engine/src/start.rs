//! Where a flight begins.

use serde::Deserialize;

use crate::frames::{Attitude, Euler, Ned, Vec3};
use crate::inputs::{Inputs, World};
use crate::pair::Pair;
use crate::state::{Geodetic, Plant, State};
use crate::{Aircraft, GRAVITY_MPS2, cockpit, fcc, rotors, step};

/// How long the aircraft settles on its wheels before the flight, in ticks: twenty seconds, the time
/// the governor takes to find the idling collective.
const SETTLING_TICKS: u64 = 5000;

/// Where and how a flight begins: standing on its wheels, rotors turning, nacelles up.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Ground at the origin.
    pub origin: Geodetic,
    /// Heading.
    pub heading_rad: f64,
    /// Fuel aboard.
    pub fuel_kg: f64,
    /// Flap lever's detent, 0..3.
    pub flap_detent: u64,
    /// The world.
    pub world: WorldStart,
}

/// The world as a flight begins.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorldStart {
    /// Speed of the wind.
    pub wind_mps: f64,
    /// Where it comes from, clockwise from north.
    pub wind_from_rad: f64,
    /// Warmer than standard by, K.
    pub temperature_offset_k: f64,
    /// Sea-level pressure above standard by, Pa.
    pub pressure_offset_pa: f64,
}

impl WorldStart {
    /// As the step takes it.
    pub fn world(&self) -> World {
        let wind_mps: Vec3<Ned> = Vec3::new(
            -self.wind_mps * crate::math::cos(self.wind_from_rad),
            -self.wind_mps * crate::math::sin(self.wind_from_rad),
            0.0,
        );
        World {
            wind_mps,
            temperature_offset_k: self.temperature_offset_k,
            pressure_offset_pa: self.pressure_offset_pa,
            ..World::default()
        }
    }
}

impl Start {
    /// The state at tick 0: the aircraft has come to rest on its wheels, brakes set, rotors at speed.
    pub fn state(&self, aircraft: &Aircraft) -> State {
        let gear = &aircraft.landing_gear;
        let weights = &aircraft.weight_balance;
        let weight_n = (weights.zero_fuel_mass_kg + self.fuel_kg) * GRAVITY_MPS2;
        let sag_m = weight_n / (2.0 * gear.main.stiffness_n_per_m + gear.nose.stiffness_n_per_m);
        let height_m = weights.cg_m.z - gear.main.tyre_m.z - sag_m;
        let rotor_speed_radps = aircraft.fcc.governor.rotor_speed_radps[0];
        let collective_rad = aircraft.fcc.governor.lowest_rad(0.0);
        let mut state = State {
            cockpit: cockpit::State {
                flap_detent: self.flap_detent.min(cockpit::FLAP_DETENT_LAST),
                gear_down: 1,
                parking_brake: 1,
                scas_on: 1,
                ..cockpit::State::default()
            },
            fcc: fcc::State {
                governor: fcc::governor::State {
                    reference_radps: rotor_speed_radps,
                    integral_rad: collective_rad,
                    correction_rad: collective_rad,
                },
                ..fcc::State::default()
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
                fuel_kg: self.fuel_kg,
                ..Plant::default()
            },
            ..State::default()
        };
        state.actuators.gear_extension_norm = 1.0;
        state.actuators.collective_rad = Pair::both(collective_rad);
        state.actuators.flap_rad = aircraft.fcc.mixer.flap_rad[state.cockpit.flap_detent as usize];
        let world = self.world.world();
        for _ in 0..SETTLING_TICKS {
            (state, _) = step(aircraft, &state, &Inputs { events: &[], world });
        }
        state.tick = 0;
        state.plant.fuel_kg = self.fuel_kg;
        state.plant.position_m.x = 0.0;
        state.plant.position_m.y = 0.0;
        state
    }
}
