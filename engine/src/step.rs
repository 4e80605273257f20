//! One tick, and all the wiring between the blocks.
//!
//! # Equations
//! ```text
//! x' = x + h·(3/2·ẋ − 1/2·ẋ_before)                 rates of the plant (Adams–Bashforth, 2nd order)
//! p' = p + h·(V + V')/2       q' = q ⊗ exp(h·(ω + ω')/4)      position and attitude
//! ```
//! # Assumptions
//! Cockpit, computer, actuators and tyres are sampled: they move once a tick and hold through it.

use crate::aero::{
    Motion, fuselage, horizontal_stabilizer, rotor_wake, vertical_stabilizers, wing_pylon,
};
use crate::frames::{Body, Euler, Load, Ned, Rotation, Structural, Vec3};
use crate::inputs::World;
use crate::landing_gear::{Struts, Tread};
use crate::math::{PI, TAU, atan2, max, min, sqrt, square};
use crate::outputs::{EulerRate, Loads, Outputs, calibrated_airspeed, place, validity};
use crate::pair::Pair;
use crate::state::{Plant, PlantRate, State};
use crate::symmetry::unmirrored;
use crate::{
    Aircraft, Inputs, STEP_S, actuators, cockpit, engines, environment, eom, fcc, landing_gear,
    rotors, weight_balance,
};

/// Rotor speeds of the data, rad/s: 0.7 of 589 rpm, below the slowest of an aeroplane, to the limit of
/// 661 rpm.
const ROTOR_RADPS_MIN: f64 = 43.0;
const ROTOR_RADPS_MAX: f64 = 69.3;
/// Turning faster than this is no flight, rad/s.
const TUMBLING_RADPS: f64 = 3.0;

/// Advances the aircraft by one tick. Same arguments, same bits.
pub fn step(aircraft: &Aircraft, state: &State, inputs: &Inputs) -> (State, Outputs) {
    let pilot = cockpit::update(&aircraft.cockpit, &state.cockpit, inputs.events);
    let held = State { tick: state.tick.wrapping_add(1), cockpit: pilot, ..*state };

    // Sampled once, held through the tick.
    let (environment, air) = weather(state, &inputs.world);
    let sensed = sense(state, &air);
    let (fcc, commands) = fcc::update(&aircraft.fcc, &state.fcc, &pilot, &sensed, &inputs.world);
    if inputs.world.paused != 0 || state.frozen != 0 {
        // What the computer asks for stays to be seen; what it remembers does not move. The rates
        // of the tick before the pause stay too, so that the motion goes on as if there were none.
        let blocks = Blocks::evaluate(aircraft, &held, &inputs.world, &air);
        return (held, Outputs { commands, ..blocks.outputs(&held) });
    }
    let actuators = actuators::update(&aircraft.actuators, &state.actuators, &commands);
    let sampled = State { fcc, actuators, environment, ..held };

    // Integrated across the tick.
    let blocks = Blocks::evaluate(aircraft, &sampled, &inputs.world, &air);
    let plant = advance(&sampled.plant, &blocks, &state.rate);
    let plant = above_ground(aircraft, plant, &inputs.world);
    let next = State { plant, rate: blocks.rate, ..sampled }.without_negative_zeros();
    let next = if next.is_finite() { next } else { State { frozen: 1, ..held } };
    let outputs = Outputs { commands, ..blocks.outputs(&next) };
    (next, outputs)
}

/// Where everything is heading from a state: what moves once a tick after one tick, what moves all the
/// time after a tick at the rates of the state itself, which are kept in `rate`.
///
/// This is no flight. It is what trim and linearisation look at, where all parts are wanted at the
/// same moment.
pub fn derivatives(aircraft: &Aircraft, state: &State, world: &World) -> (State, Outputs) {
    let (environment, air) = weather(state, world);
    let sensed = sense(state, &air);
    let (fcc, commands) = fcc::update(&aircraft.fcc, &state.fcc, &state.cockpit, &sensed, world);
    let actuators = actuators::update(&aircraft.actuators, &state.actuators, &commands);
    let blocks = Blocks::evaluate(aircraft, state, world, &air);
    let plant = advance(&state.plant, &blocks, &blocks.rate);
    let outputs = Outputs { commands, ..blocks.outputs(state) };
    (State { fcc, actuators, environment, plant, rate: blocks.rate, ..*state }, outputs)
}

/// The air of this tick.
fn weather(state: &State, world: &World) -> (environment::State, environment::Outputs) {
    let plant = &state.plant;
    environment::environment(
        &state.environment,
        &environment::Inputs {
            height_m: plant.origin.height_m - plant.position_m.z,
            height_above_ground_m: -plant.position_m.z - world.ground_height_m,
            airspeed_mps: (plant.velocity_mps - world.wind_mps).norm(),
            tick: state.tick,
            world,
        },
    )
}

/// Velocity through the air, body axes.
fn airspeed(plant: &Plant, air: &environment::Outputs) -> Vec3<Body> {
    plant.attitude.ned_from_body().inverse() * (plant.velocity_mps - air.wind_mps)
        - air.turbulence_mps
}

/// What the flight control computer's sensors read in a state at rest in its weather.
pub(crate) fn sensed(state: &State, world: &World) -> fcc::Sensed {
    sense(state, &weather(state, world).1)
}

/// What the flight control computer's sensors read. Ideal: no lag, no noise.
fn sense(state: &State, air: &environment::Outputs) -> fcc::Sensed {
    let plant = &state.plant;
    let airspeed_mps = airspeed(plant, air).norm();
    let euler = plant.attitude.euler();
    // Exactly upside down neither way round is the shorter: taking one would break the symmetry.
    let half_turn = euler.roll_rad.abs() >= PI;
    let euler = Euler { roll_rad: if half_turn { 0.0 } else { euler.roll_rad }, ..euler };
    fcc::Sensed {
        angular_rate_radps: plant.angular_rate_radps,
        euler,
        airspeed_mps,
        dynamic_pressure_pa: 0.5 * air.density_kg_per_m3 * square(airspeed_mps),
        rotor_speed_radps: plant.rotor_speed_radps,
        mast_tilt_rad: state.actuators.mast_tilt_rad.mean(),
        weight_on_wheels: plant.weight_on_wheels != 0,
    }
}

/// The plant one tick later.
fn advance(plant: &Plant, blocks: &Blocks, rate_before: &PlantRate) -> Plant {
    let (rate, gear) = (&blocks.rate, &blocks.gear);
    let ab2 = |now: f64, before: f64| STEP_S * (1.5 * now - 0.5 * before);
    let motion = (&rate.motion, &rate_before.motion);
    let velocity_mps = plant.velocity_mps
        + (motion.0.acceleration_mps2 * 1.5 - motion.1.acceleration_mps2 * 0.5) * STEP_S;
    let angular_rate_radps = plant.angular_rate_radps
        + (motion.0.angular_acceleration_radps2 * 1.5 - motion.1.angular_acceleration_radps2 * 0.5)
            * STEP_S;
    let (tail, tail_before) = (&rate.horizontal_stabilizer, &rate_before.horizontal_stabilizer);
    let (drive, drive_before) = (&rate.engines, &rate_before.engines);
    let engines = plant.engines.zip(drive.power_w_per_s.zip(drive_before.power_w_per_s)).map(
        |(engine, (now, before))| engines::State { power_w: engine.power_w + ab2(now, before) },
    );
    let rotor_speed_radps = max(
        0.0,
        plant.rotor_speed_radps + ab2(drive.rotor_speed_radps2, drive_before.rotor_speed_radps2),
    );
    let turned_rad =
        plant.rotor_azimuth_rad + 0.5 * (plant.rotor_speed_radps + rotor_speed_radps) * STEP_S;
    Plant {
        position_m: plant.position_m + (plant.velocity_mps + velocity_mps) * (0.5 * STEP_S),
        velocity_mps,
        attitude: plant
            .attitude
            .turned_by((plant.angular_rate_radps + angular_rate_radps) * (0.5 * STEP_S)),
        angular_rate_radps,
        rotors: blocks.rotors_next,
        horizontal_stabilizer: horizontal_stabilizer::State {
            downwash_rad: plant.horizontal_stabilizer.downwash_rad
                + ab2(tail.downwash_radps, tail_before.downwash_radps),
        },
        rotor_speed_radps,
        rotor_azimuth_rad: if turned_rad >= TAU { turned_rad - TAU } else { turned_rad },
        engines,
        fuel_kg: max(0.0, plant.fuel_kg + ab2(drive.fuel_kg_per_s, drive_before.fuel_kg_per_s)),
        treads: gear.treads,
        weight_on_wheels: u64::from(gear.legs.main.map(|leg| leg.push_n).sum() > 0.0),
        ..*plant
    }
}

/// The plant where the hull lets it be.
fn above_ground(aircraft: &Aircraft, plant: Plant, world: &World) -> Plant {
    let Plant { position_m, velocity_mps, angular_rate_radps, .. } = plant;
    let landing_gear::Hulled { position_m, velocity_mps, angular_rate_radps } = landing_gear::hull(
        &aircraft.landing_gear,
        landing_gear::Hulled { position_m, velocity_mps, angular_rate_radps },
        world.ground_height_m,
    );
    Plant { position_m, velocity_mps, angular_rate_radps, ..plant }
}

/// The landing gear's answer: next treads, and each leg.
struct Gear {
    treads: Struts<Tread>,
    legs: Struts<landing_gear::Leg>,
}

/// What every block says of one state: the block diagram, once through.
struct Blocks {
    ground_height_m: f64,
    hull_height_m: f64,
    /// A point of the structure.
    fixed_m: Vec3<Structural>,
    air: environment::Outputs,
    motion: Motion,
    balance: weight_balance::Outputs,
    rotors: Pair<rotors::Outputs>,
    rotors_next: Pair<rotors::State>,
    engines: engines::Outputs,
    gear: Gear,
    loads: Loads,
    total: Load,
    rate: PlantRate,
}

impl Blocks {
    fn evaluate(
        aircraft: &Aircraft,
        state: &State,
        world: &World,
        air: &environment::Outputs,
    ) -> Self {
        let plant = &state.plant;
        let surfaces = &state.actuators;
        let ned_from_body = plant.attitude.ned_from_body();

        let balance = weight_balance::balance(
            &aircraft.weight_balance,
            plant.fuel_kg,
            surfaces.mast_tilt_rad.mean(),
        );
        let motion = Motion {
            cg_m: balance.cg_m,
            airspeed_mps: airspeed(plant, air),
            angular_rate_radps: plant.angular_rate_radps,
            density_kg_per_m3: air.density_kg_per_m3,
        };
        // The left side is computed as the mirror image of a right side.
        let motions = Pair { left: motion.mirrored(), right: motion };
        let thrust_axes =
            surfaces.mast_tilt_rad.map(|tilt_rad| aircraft.rotors.thrust_axis(tilt_rad));
        let height_above_ground_m = -plant.position_m.z - world.ground_height_m;

        let from_rotors =
            rotors(aircraft, state, motions, air, &ned_from_body, height_above_ground_m);
        let rotors = from_rotors.map(|(_, outputs)| outputs);
        let (engine_rate, engines) = engines::engines(
            &aircraft.engines,
            &plant.engines,
            &engines::Inputs {
                lever_norm: surfaces.lever_norm,
                rotor_speed_radps: plant.rotor_speed_radps,
                rotor_torque_n_m: rotors.map(|rotor| rotor.torque_n_m),
                rotor_inertia_kg_m2: 2.0 * aircraft.rotors.polar_inertia_kg_m2,
                pressure_pa: air.pressure_pa,
                temperature_k: air.temperature_k,
                fuel_kg: plant.fuel_kg,
                world: *world,
            },
        );
        let (treads, legs) = landing_gear::landing_gear(
            &aircraft.landing_gear,
            &plant.treads,
            &landing_gear::Inputs {
                cg_m: balance.cg_m,
                position_m: plant.position_m,
                velocity_mps: plant.velocity_mps,
                angular_rate_radps: plant.angular_rate_radps,
                ned_from_body,
                ground_height_m: world.ground_height_m,
                extension_norm: surfaces.gear_extension_norm,
                brake_norm: surfaces.brake_norm,
            },
        );
        let wake = wake(aircraft, state, motion, thrust_axes, rotors);
        let mach = motion.airspeed_mps.norm() / air.sound_speed_mps;
        let (stabilizer_rate, stabilizer_load) = horizontal_stabilizer::horizontal_stabilizer(
            &aircraft.horizontal_stabilizer,
            &plant.horizontal_stabilizer,
            &horizontal_stabilizer::Inputs {
                motion,
                mach,
                wing_alpha_rad: wake.wing_alpha_rad,
                wake_mps: wake.tail_mps,
                mast_tilt_rad: surfaces.mast_tilt_rad.mean(),
                flap_rad: surfaces.flap_rad,
                elevator_rad: surfaces.elevator_rad,
            },
        );
        let half_wings = half_wings(aircraft, surfaces, motions, mach, thrust_axes, rotors, &wake);
        let loads = Loads {
            rotors: unmirrored(rotors.map(|rotor| rotor.load)),
            wing_pylon: unmirrored(half_wings.map(|half| half.total())),
            fuselage: fuselage::fuselage(
                &aircraft.fuselage,
                &fuselage::Inputs { motion, gear_extension_norm: surfaces.gear_extension_norm },
            ),
            horizontal_stabilizer: stabilizer_load,
            vertical_stabilizers: unmirrored(fins(aircraft, surfaces, motions, mach)),
            jets: unmirrored(engines.jet_thrust_n.zip(thrust_axes).map(|(thrust_n, axis)| {
                engines::jet(thrust_n, axis, aircraft.rotors.pivot_m, balance.cg_m)
            })),
            landing_gear: Struts { nose: legs.nose.load, main: legs.main.map(|leg| leg.load) },
        };
        let total = loads.total();
        let spin_up = spin_up(aircraft, thrust_axes, engine_rate.rotor_speed_radps2);
        let rate = PlantRate {
            motion: eom::motion(&eom::Inputs {
                load: total,
                balance,
                ned_from_body,
                angular_rate_radps: plant.angular_rate_radps,
                spin_up_n_m: spin_up,
            }),
            horizontal_stabilizer: stabilizer_rate,
            engines: engine_rate,
        };
        let gear = Gear { treads, legs };
        Self {
            ground_height_m: world.ground_height_m,
            hull_height_m: aircraft.landing_gear.hull_height_m,
            fixed_m: aircraft.weight_balance.cg_m,
            air: *air,
            motion,
            balance,
            rotors,
            rotors_next: from_rotors.map(|(next, _)| next),
            engines,
            gear,
            loads,
            total,
            rate,
        }
    }

    /// `next` is the state after the tick; loads are those that led to it.
    fn outputs(&self, next: &State) -> Outputs {
        let plant = &next.plant;
        let euler = plant.attitude.euler();
        let body_from_ned = plant.attitude.ned_from_body().inverse();
        let airspeed_mps = self.motion.airspeed_mps.norm();
        let mach = airspeed_mps / self.air.sound_speed_mps;
        let specific_force_mps2 = self.total.force_n * (1.0 / self.balance.mass_kg);
        let flow = self.motion.airspeed_mps;
        let in_plane_mps = sqrt(square(flow.x) + square(flow.z));
        let fixed = self.fixed_m.from_cg(self.balance.cg_m);
        let place = place(&plant.origin, plant.position_m + plant.attitude.ned_from_body() * fixed);
        Outputs {
            tick: next.tick,
            place,
            position_m: plant.position_m,
            height_above_ground_m: self.height_above_ground_m(next),
            velocity_mps: plant.velocity_mps,
            body_velocity_mps: body_from_ned * plant.velocity_mps,
            euler,
            euler_rate: EulerRate::new(euler, plant.angular_rate_radps),
            angular_rate_radps: plant.angular_rate_radps,
            specific_force_mps2,
            load_factor: -specific_force_mps2.z / crate::GRAVITY_MPS2,
            airspeed_mps,
            calibrated_airspeed_mps: calibrated_airspeed(min(mach, 0.99), self.air.pressure_pa),
            mach,
            alpha_rad: atan2(flow.z, flow.x),
            beta_rad: atan2(flow.y, in_plane_mps),
            air: self.air,
            balance: self.balance,
            fuel_kg: plant.fuel_kg,
            cockpit: next.cockpit,
            actuators: next.actuators,
            rotor_speed_radps: plant.rotor_speed_radps,
            rotor_azimuth_rad: plant.rotor_azimuth_rad,
            rotors: self.rotors,
            engines: self.engines,
            landing_gear: self.gear.legs,
            loads: self.loads,
            total: self.total,
            validity: self.validity(next, place.height_m),
            ..Outputs::default()
        }
    }

    fn height_above_ground_m(&self, next: &State) -> f64 {
        -next.plant.position_m.z - self.ground_height_m
    }

    fn validity(&self, next: &State, height_m: f64) -> u64 {
        let flag = |bit: u64, set: bool| if set { bit } else { 0 };
        let airborne = next.plant.weight_on_wheels == 0;
        let legs = &self.gear.legs;
        let bottomed =
            [legs.nose, legs.main.left, legs.main.right].iter().any(|leg| leg.bottomed != 0);
        flag(validity::ROTOR_STALL, self.rotors.map(|rotor| rotor.stalled).sum() > 0)
            | flag(validity::FLAPPING_STOP, self.rotors.map(|rotor| rotor.on_stop).sum() > 0)
            | flag(
                validity::VORTEX_RING,
                airborne && self.rotors.map(|rotor| rotor.in_vortex_ring).sum() > 0,
            )
            | flag(validity::SPEED, self.motion.airspeed_mps.norm() > 180.0)
            | flag(validity::HEIGHT, height_m > 12e3)
            | flag(validity::GEAR_BOTTOMED, bottomed)
            | flag(validity::FROZEN, next.frozen != 0)
            | flag(
                validity::ROTOR_SPEED,
                !(ROTOR_RADPS_MIN..=ROTOR_RADPS_MAX).contains(&next.plant.rotor_speed_radps),
            )
            | flag(validity::TUMBLING, next.plant.angular_rate_radps.norm() > TUMBLING_RADPS)
            | flag(validity::HULL, self.height_above_ground_m(next) <= self.hull_height_m)
    }
}

/// Both rotors, each as a right one.
fn rotors(
    aircraft: &Aircraft,
    state: &State,
    motions: Pair<Motion>,
    air: &environment::Outputs,
    ned_from_body: &Rotation<Ned, Body>,
    height_above_ground_m: f64,
) -> Pair<(rotors::State, rotors::Outputs)> {
    let surfaces = &state.actuators;
    let cyclic = surfaces.cyclic_forward_rad.zip(surfaces.cyclic_outboard_rad);
    let controls = surfaces
        .mast_tilt_rad
        .zip(surfaces.mast_tilt_rate_radps)
        .zip(surfaces.collective_rad.zip(cyclic));
    let sides = Pair { left: -1.0, right: 1.0 };
    state.plant.rotors.zip(motions.zip(controls.zip(sides))).map(
        |(rotor, (motion, (((mast_tilt_rad, mast_tilt_rate_radps), pitch), side)))| {
            let hub = aircraft.rotors.hub_from_cg(motion.cg_m, mast_tilt_rad);
            let hub: Vec3<Body> = Vec3::new(hub.x, side * hub.y, hub.z);
            let inputs = rotors::Inputs {
                motion,
                sound_speed_mps: air.sound_speed_mps,
                mast_tilt_rad,
                mast_tilt_rate_radps,
                rotor_speed_radps: state.plant.rotor_speed_radps,
                collective_rad: pitch.0,
                cyclic_forward_rad: pitch.1.0,
                cyclic_outboard_rad: pitch.1.1,
                hub_height_m: height_above_ground_m - (*ned_from_body * hub).z,
            };
            rotors::rotor(&aircraft.rotors, &aircraft.blade, &rotor, &inputs)
        },
    )
}

/// The rotors' wake at the airframe.
fn wake(
    aircraft: &Aircraft,
    state: &State,
    motion: Motion,
    thrust_axes: Pair<Vec3<Body>>,
    rotors: Pair<rotors::Outputs>,
) -> rotor_wake::Outputs {
    let inputs = rotor_wake::Inputs {
        motion,
        mast_tilt_rad: state.actuators.mast_tilt_rad.mean(),
        thrust_axes,
        induced_mps: rotors.map(|rotor| rotor.induced_mps),
        rotor_force_n: rotors.map(|rotor| rotor.load.force_n.norm()),
        advance_ratio: rotors.map(|rotor| rotor.advance_ratio),
        rotor_speed_radps: state.plant.rotor_speed_radps,
        rotor_radius_m: aircraft.rotors.radius_m,
    };
    rotor_wake::rotor_wake(&aircraft.rotor_wake, &inputs)
}

/// Both half wings, each as a right one.
fn half_wings(
    aircraft: &Aircraft,
    surfaces: &actuators::State,
    motions: Pair<Motion>,
    mach: f64,
    thrust_axes: Pair<Vec3<Body>>,
    rotors: Pair<rotors::Outputs>,
    wake: &rotor_wake::Outputs,
) -> Pair<wing_pylon::Outputs> {
    let from_rotors = thrust_axes.zip(rotors.map(|rotor| rotor.induced_mps)).zip(wake.wing_mps);
    let controls = surfaces.mast_tilt_rad.zip(surfaces.flaperon_rad);
    motions.zip(from_rotors.zip(controls)).map(|(motion, (from_rotor, control))| {
        let ((thrust_axis, induced_mps), wake_mps) = from_rotor;
        let (mast_tilt_rad, flaperon_rad) = control;
        let inputs = wing_pylon::Inputs {
            motion,
            mach,
            alpha_rad: wake.wing_alpha_rad,
            wake_mps,
            mast_tilt_rad,
            thrust_axis,
            induced_mps,
            rotor_radius_m: aircraft.rotors.radius_m,
            pivot_m: aircraft.rotors.pivot_m,
            hub_from_cg_m: aircraft.rotors.hub_from_cg(motion.cg_m, mast_tilt_rad),
            flap_rad: surfaces.flap_rad,
            flaperon_rad,
        };
        wing_pylon::half_wing(&aircraft.wing_pylon, &inputs)
    })
}

/// Both fins, each as a right one.
fn fins(
    aircraft: &Aircraft,
    surfaces: &actuators::State,
    motions: Pair<Motion>,
    mach: f64,
) -> Pair<Load> {
    let right_rad = surfaces.rudder_right_rad;
    let (mast_tilt_rad, flap_rad) = (surfaces.mast_tilt_rad.mean(), surfaces.flap_rad);
    let pressure_ratio =
        aircraft.horizontal_stabilizer.pressure_ratio_at(mast_tilt_rad, &motions.right);
    motions.zip(Pair { left: -right_rad, right: right_rad }).map(|(motion, rudder_rad)| {
        let inputs = vertical_stabilizers::Inputs {
            motion,
            mach,
            mast_tilt_rad,
            flap_rad,
            pressure_ratio,
            rudder_rad,
        };
        vertical_stabilizers::fin(&aircraft.vertical_stabilizers, &inputs)
    })
}

/// Rate of both rotors' angular momentum from spin-up.
///
/// The right rotor turns about its thrust axis, the left one the other way round. What turns with
/// the airframe is not here: a gimballed rotor does not follow its mast but precesses, and what it
/// gives the airframe is in its load.
fn spin_up(
    aircraft: &Aircraft,
    thrust_axes: Pair<Vec3<Body>>,
    rotor_speed_radps2: f64,
) -> Vec3<Body> {
    let spin_up = aircraft.rotors.polar_inertia_kg_m2 * rotor_speed_radps2;
    let right_handed = thrust_axes.map(|axis| axis * spin_up);
    Pair { left: right_handed.left.mirrored_axial(), right: right_handed.right }.sum()
}
