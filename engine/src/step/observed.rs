//! What can be observed after a tick.

use super::blocks::Blocks;
use crate::math::{atan2, min, sqrt, square};
use crate::outputs::{EulerRate, Outputs, Validity, calibrated_airspeed, place};
use crate::state::State;
use crate::{Aircraft, fcc};

/// What can be observed of `next`, the state after the tick; loads are those that led to it.
pub(super) fn outputs(
    aircraft: &Aircraft,
    blocks: &Blocks,
    next: &State,
    computer: &fcc::Outputs,
) -> Outputs {
    let Blocks { air, motion, balance, rotors, engines, gear, loads, total, .. } = blocks;
    let plant = &next.plant;
    let euler = plant.attitude.euler();
    let body_from_ned = plant.attitude.ned_from_body().inverse();
    let velocity = motion.airspeed_mps;
    let airspeed_mps = velocity.norm();
    let mach = airspeed_mps / air.sound_speed_mps;
    let in_plane_mps = sqrt(square(velocity.x) + square(velocity.z));
    let specific_force_mps2 = total.force_n * (1.0 / balance.mass_kg);
    // A point that is fixed in the structure: the centre of gravity as a helicopter.
    let fixed = aircraft.weight_balance.cg_m.from_cg(balance.cg_m);
    let place = place(&plant.origin, plant.position_m + plant.attitude.ned_from_body() * fixed);
    let height_above_ground_m = -plant.position_m.z - blocks.ground_height_m;
    Outputs {
        tick: next.tick,
        place,
        position_m: plant.position_m,
        height_above_ground_m,
        velocity_mps: plant.velocity_mps,
        body_velocity_mps: body_from_ned * plant.velocity_mps,
        euler,
        euler_rate: EulerRate::new(euler, plant.angular_rate_radps),
        angular_rate_radps: plant.angular_rate_radps,
        specific_force_mps2,
        load_factor: -specific_force_mps2.z / crate::GRAVITY_MPS2,
        airspeed_mps,
        calibrated_airspeed_mps: calibrated_airspeed(min(mach, 0.99), air.pressure_pa),
        mach,
        alpha_rad: atan2(velocity.z, velocity.x),
        beta_rad: atan2(velocity.y, in_plane_mps),
        air: *air,
        balance: *balance,
        fuel_kg: plant.fuel_kg,
        cockpit: next.cockpit,
        commands: computer.commands,
        scas: computer.scas,
        actuators: next.actuators,
        rotor_speed_radps: plant.rotor_speed_radps,
        rotor_azimuth_rad: plant.rotor_azimuth_rad,
        rotors: *rotors,
        engines: *engines,
        landing_gear: gear.legs,
        loads: *loads,
        total: *total,
        validity: blocks.validity(aircraft, next, place.height_m, height_above_ground_m),
    }
}

impl Blocks {
    fn validity(
        &self,
        aircraft: &Aircraft,
        next: &State,
        height_m: f64,
        height_above_ground_m: f64,
    ) -> Validity {
        let flag = |flag: Validity, set: bool| if set { flag } else { Validity::empty() };
        let airborne = next.plant.weight_on_wheels == 0;
        let (legs, model) = (&self.gear.legs, &aircraft.envelope.model);
        let bottomed =
            [legs.nose, legs.main.left, legs.main.right].iter().any(|leg| leg.bottomed != 0);
        flag(Validity::ROTOR_STALL, self.rotors.map(|rotor| rotor.stalled).sum() > 0)
            | flag(Validity::FLAPPING_STOP, self.rotors.map(|rotor| rotor.on_stop).sum() > 0)
            | flag(
                Validity::VORTEX_RING,
                airborne && self.rotors.map(|rotor| rotor.in_vortex_ring).sum() > 0,
            )
            | flag(Validity::SPEED, self.motion.airspeed_mps.norm() > model.airspeed_mps_max)
            | flag(Validity::HEIGHT, height_m > model.height_m_max)
            | flag(Validity::GEAR_BOTTOMED, bottomed)
            | flag(Validity::FROZEN, next.frozen != 0)
            | flag(
                Validity::ROTOR_SPEED,
                !(model.rotor_speed_radps_min..=model.rotor_speed_radps_max)
                    .contains(&next.plant.rotor_speed_radps),
            )
            | flag(
                Validity::TUMBLING,
                next.plant.angular_rate_radps.norm() > model.angular_rate_radps_max,
            )
            | flag(Validity::HULL, height_above_ground_m <= aircraft.landing_gear.contact_height_m)
    }
}
