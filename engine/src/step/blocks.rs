//! The blocks of physics, asked once: the block diagram from the actuators to the equations of motion.
//!
//! Mass and motion come first; then rotors and drive, landing gear and airframe; then the sum of
//! their loads, and what it does to the body.

use crate::aero::{
    LocalFlow, fin_wake, fuselage, horizontal_stabilizer, local_flow, rotor_wake,
    vertical_stabilizers, wing_pylon,
};
use crate::frames::{Body, Load, Ned, Rotation, Vec3};
use crate::inputs::World;
use crate::landing_gear::TyreDeflection;
use crate::mast::TiltedMast;
use crate::motion::Motion;
use crate::outputs::Loads;
use crate::pair::Pair;
use crate::state::{Plant, PlantRate, State};
use crate::struts::Struts;
use crate::symmetry::unmirrored;
use crate::{Aircraft, actuators, engines, environment, eom, landing_gear, rotors, weight_balance};

/// What every block says of one state.
pub(super) struct Blocks {
    pub air: environment::Outputs,
    pub ground_height_m: f64,
    pub motion: Motion,
    pub balance: weight_balance::Outputs,
    pub rotors: Pair<rotors::Outputs>,
    pub rotors_next: Pair<rotors::State>,
    pub engines: engines::Outputs,
    pub gear: Gear,
    pub loads: Loads,
    pub total: Load,
    pub rate: PlantRate,
}

/// The landing gear's answer.
pub(super) struct Gear {
    /// After the tick.
    pub tyre_deflections: Struts<TyreDeflection>,
    pub legs: Struts<landing_gear::Leg>,
}

/// What the blocks are asked about.
#[derive(Clone, Copy)]
struct Situation<'a> {
    aircraft: &'a Aircraft,
    plant: &'a Plant,
    surfaces: &'a actuators::State,
    world: &'a World,
    air: &'a environment::Outputs,
}

/// Where the mass is, how it moves through the air, and the same as each side sees it.
struct MassAndMotion {
    ned_from_body: Rotation<Ned, Body>,
    balance: weight_balance::Outputs,
    motion: Motion,
    flow: LocalFlow,
    mach: f64,
    sides: Pair<SideInputs>,
}

/// What the blocks of one side read. The left side is computed as the mirror image of a right one: here
/// stands what a right one reads.
#[derive(Clone, Copy)]
struct SideInputs {
    motion: Motion,
    flow: LocalFlow,
    mast: TiltedMast,
    mast_tilt_rate_radps: f64,
    collective_rad: f64,
    cyclic_forward_rad: f64,
    cyclic_outboard_rad: f64,
    flaperon_rad: f64,
    /// To the right on the right fin: outboard.
    rudder_outboard_rad: f64,
    hub_from_cg_m: Vec3<Body>,
    /// Hub over the ground.
    hub_height_m: f64,
}

/// What rotors, engines and shafts answer.
struct RotorsAndDrive {
    rotors: Pair<rotors::Outputs>,
    rotors_next: Pair<rotors::State>,
    engines: engines::Outputs,
    rate: engines::Rate,
    jets: Pair<Load>,
}

/// What the airframe's surfaces answer in the air and in the rotors' wake. Pairs are each as a right side's.
struct Airframe {
    wing_pylon: Pair<Load>,
    fuselage: Load,
    horizontal_stabilizer: Load,
    horizontal_stabilizer_rate: horizontal_stabilizer::Rate,
    vertical_stabilizers: Pair<Load>,
}

impl Blocks {
    pub fn evaluate(
        aircraft: &Aircraft,
        state: &State,
        world: &World,
        air: &environment::Outputs,
    ) -> Self {
        let now =
            Situation { aircraft, plant: &state.plant, surfaces: &state.actuators, world, air };
        let body = mass_and_motion(now);
        let drive = rotors_and_drive(now, &body);
        let gear = landing_gear(now, &body);
        let airframe = airframe(now, &body, &drive.rotors);
        let loads = loads(&drive, &gear, &airframe);
        let total = loads.total();
        let rate = PlantRate {
            motion: eom::evaluate(&eom::Inputs {
                load: total,
                mass_kg: body.balance.mass_kg,
                inertia: body.balance.inertia,
                ned_from_body: body.ned_from_body,
                angular_rate_radps: now.plant.angular_rate_radps,
                spin_up_n_m: spin_up(aircraft, &body.sides, drive.rate.rotor_speed_radps2),
            }),
            horizontal_stabilizer: airframe.horizontal_stabilizer_rate,
            engines: drive.rate,
        };
        Self {
            air: *air,
            ground_height_m: world.ground_under_aircraft_m(),
            motion: body.motion,
            balance: body.balance,
            rotors: drive.rotors,
            rotors_next: drive.rotors_next,
            engines: drive.engines,
            gear,
            loads,
            total,
            rate,
        }
    }
}

/// Velocity through the air, body axes.
pub(super) fn airspeed(plant: &Plant, air: &environment::Outputs) -> Vec3<Body> {
    plant.attitude.ned_from_body().inverse() * (plant.velocity_mps - air.wind_mps)
        - air.turbulence_mps
}

fn mass_and_motion(now: Situation<'_>) -> MassAndMotion {
    let Situation { aircraft, plant, surfaces, air, .. } = now;
    let ned_from_body = plant.attitude.ned_from_body();
    let balance = weight_balance::evaluate(
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
    let flow = local_flow(motion.airspeed_mps, motion.density_kg_per_m3);
    let masts = masts(aircraft, surfaces.mast_tilt_rad);
    let left = SideInputs::new(
        now,
        (motion.mirrored(), flow.mirrored(), masts.left),
        &ned_from_body,
        -1.0,
        |of| of.left,
    );
    let right =
        SideInputs::new(now, (motion, flow, masts.right), &ned_from_body, 1.0, |of| of.right);
    MassAndMotion {
        ned_from_body,
        balance,
        motion,
        flow,
        mach: motion.airspeed_mps.norm() / air.sound_speed_mps,
        sides: Pair { left, right },
    }
}

/// Both masts, each as a right one: the same one while they are tilted alike.
fn masts(aircraft: &Aircraft, tilt_rad: Pair<f64>) -> Pair<TiltedMast> {
    let left = aircraft.rotors.mast(tilt_rad.left);
    let alike = tilt_rad.left.to_bits() == tilt_rad.right.to_bits();
    let right = if alike { left } else { aircraft.rotors.mast(tilt_rad.right) };
    Pair { left, right }
}

impl SideInputs {
    /// `motion`, `flow` and `mast` are as a right side has them; `outboard` is 1 where outboard is to the right,
    /// −1 where it is to the left; `own` picks the side's value.
    fn new(
        now: Situation<'_>,
        (motion, flow, mast): (Motion, LocalFlow, TiltedMast),
        ned_from_body: &Rotation<Ned, Body>,
        outboard: f64,
        own: fn(Pair<f64>) -> f64,
    ) -> Self {
        let Situation { aircraft, plant, surfaces, world, .. } = now;
        let hub_from_cg_m = aircraft.rotors.hub_from_cg(motion.cg_m, &mast);
        let hub = Vec3::new(hub_from_cg_m.x, outboard * hub_from_cg_m.y, hub_from_cg_m.z);
        let height_above_ground_m = -plant.position_m.z - world.ground_under_aircraft_m();
        Self {
            motion,
            flow,
            mast,
            mast_tilt_rate_radps: own(surfaces.mast_tilt_rate_radps),
            collective_rad: own(surfaces.collective_rad),
            cyclic_forward_rad: own(surfaces.cyclic_forward_rad),
            cyclic_outboard_rad: own(surfaces.cyclic_outboard_rad),
            flaperon_rad: own(surfaces.flaperon_rad),
            rudder_outboard_rad: outboard * surfaces.rudder_right_rad,
            hub_from_cg_m,
            hub_height_m: height_above_ground_m - (*ned_from_body * hub).z,
        }
    }
}

fn rotors_and_drive(now: Situation<'_>, body: &MassAndMotion) -> RotorsAndDrive {
    let Situation { aircraft, plant, surfaces, world, air } = now;
    let others = plant.rotors.swapped().map(|other| other.inflow.mean_mps);
    let sides = body.sides.zip(others);
    let from_rotors = plant.rotors.zip(sides).map(|(rotor, (side, other_induced_mps))| {
        let inputs = rotors::Inputs {
            motion: side.motion,
            sound_speed_mps: air.sound_speed_mps,
            mast_tilt_rad: side.mast.tilt_rad,
            mast_tilt_rate_radps: side.mast_tilt_rate_radps,
            rotor_speed_radps: plant.rotor_speed_radps,
            collective_rad: side.collective_rad,
            cyclic_forward_rad: side.cyclic_forward_rad,
            cyclic_outboard_rad: side.cyclic_outboard_rad,
            hub_height_m: side.hub_height_m,
            other_induced_mps,
        };
        rotors::evaluate(&aircraft.rotors, &aircraft.blade, &rotor, &inputs)
    });
    let rotors = from_rotors.map(|(_, outputs)| outputs);
    let inputs = engines::Inputs {
        lever_norm: surfaces.lever_norm,
        rotor_speed_radps: plant.rotor_speed_radps,
        rotor_torque_n_m: rotors.map(|rotor| rotor.torque_n_m),
        rotor_inertia_kg_m2: 2.0 * aircraft.rotors.polar_inertia_kg_m2,
        pressure_pa: air.pressure_pa,
        temperature_k: air.temperature_k,
        fuel_kg: plant.fuel_kg,
        world: *world,
    };
    let (rate, engines) = engines::evaluate(&aircraft.engines, &plant.engines, &inputs);
    let (pivot_m, cg_m) = (aircraft.rotors.pivot_m, body.balance.cg_m);
    let jets = engines
        .jet_thrust_n
        .zip(body.sides)
        .map(|(thrust_n, side)| engines::jet(thrust_n, side.mast.thrust_axis, pivot_m, cg_m));
    RotorsAndDrive { rotors, rotors_next: from_rotors.map(|(next, _)| next), engines, rate, jets }
}

fn landing_gear(now: Situation<'_>, body: &MassAndMotion) -> Gear {
    let Situation { aircraft, plant, surfaces, world, .. } = now;
    let inputs = landing_gear::Inputs {
        cg_m: body.balance.cg_m,
        position_m: plant.position_m,
        velocity_mps: plant.velocity_mps,
        angular_rate_radps: plant.angular_rate_radps,
        ned_from_body: body.ned_from_body,
        ground_height_m: world.ground_height_m,
        extension_norm: surfaces.gear_extension_norm,
        brake_norm: surfaces.brake_norm,
    };
    let (tyre_deflections, legs) =
        landing_gear::evaluate(&aircraft.landing_gear, &plant.tyre_deflections, &inputs);
    Gear { tyre_deflections, legs }
}

fn airframe(now: Situation<'_>, body: &MassAndMotion, rotors: &Pair<rotors::Outputs>) -> Airframe {
    let Situation { aircraft, plant, surfaces, .. } = now;
    let wake = wake(now, body, rotors);
    let pressure_ratio =
        aircraft.horizontal_stabilizer.pressure_ratio_at(surfaces.mast_tilt_rad.mean(), &body.flow);
    let (horizontal_stabilizer_rate, horizontal_stabilizer) = horizontal_stabilizer::evaluate(
        &aircraft.horizontal_stabilizer,
        &plant.horizontal_stabilizer,
        &horizontal_stabilizer::Inputs {
            motion: body.motion,
            flow: body.flow,
            mach: body.mach,
            wing_alpha_rad: wake.wing_alpha_rad,
            wake_mps: wake.tail_mps,
            mast_tilt_rad: surfaces.mast_tilt_rad.mean(),
            flap_rad: surfaces.flap_rad,
            elevator_rad: surfaces.elevator_rad,
            pressure_ratio,
        },
    );
    Airframe {
        wing_pylon: half_wings(now, body, rotors, &wake),
        fuselage: fuselage::evaluate(
            &aircraft.fuselage,
            &fuselage::Inputs {
                motion: body.motion,
                flow: body.flow,
                gear_extension_norm: surfaces.gear_extension_norm,
            },
        ),
        horizontal_stabilizer,
        horizontal_stabilizer_rate,
        vertical_stabilizers: fins(now, body, rotors, pressure_ratio),
    }
}

/// The rotors' wake at the airframe.
fn wake(
    now: Situation<'_>,
    body: &MassAndMotion,
    rotors: &Pair<rotors::Outputs>,
) -> rotor_wake::Outputs {
    let Situation { aircraft, plant, surfaces, .. } = now;
    let inputs = rotor_wake::Inputs {
        motion: body.motion,
        flow: body.flow,
        mast_tilt_rad: surfaces.mast_tilt_rad.mean(),
        thrust_axes: body.sides.map(|side| side.mast.thrust_axis),
        induced_mps: rotors.map(|rotor| rotor.induced_mps),
        rotor_force_n: rotors.map(|rotor| rotor.load.force_n.norm()),
        advance_ratio: rotors.map(|rotor| rotor.advance_ratio),
        rotor_speed_radps: plant.rotor_speed_radps,
        rotor_radius_m: aircraft.rotors.radius_m,
    };
    rotor_wake::evaluate(&aircraft.rotor_wake, &inputs)
}

/// Both half wings with their pylons, each as a right one.
fn half_wings(
    now: Situation<'_>,
    body: &MassAndMotion,
    rotors: &Pair<rotors::Outputs>,
    wake: &rotor_wake::Outputs,
) -> Pair<Load> {
    let Situation { aircraft, surfaces, .. } = now;
    let inputs =
        |side: &SideInputs, rotor: &rotors::Outputs, wake_mps: Vec3<Body>| wing_pylon::Inputs {
            motion: side.motion,
            flow: side.flow,
            mach: body.mach,
            alpha_rad: wake.wing_alpha_rad,
            wake_mps,
            mast: side.mast,
            induced_mps: rotor.induced_mps,
            rotor_radius_m: aircraft.rotors.radius_m,
            pivot_m: aircraft.rotors.pivot_m,
            hub_from_cg_m: side.hub_from_cg_m,
            flap_rad: surfaces.flap_rad,
            flaperon_rad: side.flaperon_rad,
        };
    let inputs = Pair {
        left: inputs(&body.sides.left, &rotors.left, wake.wing_mps.left),
        right: inputs(&body.sides.right, &rotors.right, wake.wing_mps.right),
    };
    wing_pylon::evaluate_both(&aircraft.wing_pylon, inputs).map(|half| half.total())
}

/// Both fins, each as a right one, each in its rotor's wake.
fn fins(
    now: Situation<'_>,
    body: &MassAndMotion,
    rotors: &Pair<rotors::Outputs>,
    pressure_ratio: f64,
) -> Pair<Load> {
    let Situation { aircraft, surfaces, .. } = now;
    let params = &aircraft.vertical_stabilizers;
    let inputs = body.sides.zip(*rotors).map(|(side, rotor)| vertical_stabilizers::Inputs {
        motion: side.motion,
        flow: side.flow,
        wake_mps: fin_wake::evaluate(&fin_wake::Inputs {
            motion: side.motion,
            mast: side.mast,
            hub_from_cg_m: side.hub_from_cg_m,
            induced_mps: rotor.induced_mps,
            rotor_radius_m: aircraft.rotors.radius_m,
            centre_m: params.centre_m,
            span_m: params.span_m,
        }),
        mach: body.mach,
        mast_tilt_rad: surfaces.mast_tilt_rad.mean(),
        flap_rad: surfaces.flap_rad,
        pressure_ratio,
        rudder_rad: side.rudder_outboard_rad,
    });
    vertical_stabilizers::evaluate_both(params, inputs)
}

/// Every load on the airframe, both sides as they are.
fn loads(drive: &RotorsAndDrive, gear: &Gear, airframe: &Airframe) -> Loads {
    Loads {
        rotors: unmirrored(drive.rotors.map(|rotor| rotor.load)),
        wing_pylon: unmirrored(airframe.wing_pylon),
        fuselage: airframe.fuselage,
        horizontal_stabilizer: airframe.horizontal_stabilizer,
        vertical_stabilizers: unmirrored(airframe.vertical_stabilizers),
        jets: unmirrored(drive.jets),
        landing_gear: Struts {
            nose: gear.legs.nose.load,
            main: gear.legs.main.map(|leg| leg.load),
        },
    }
}

/// Rate of both rotors' angular momentum from spin-up.
///
/// The right rotor turns about its thrust axis, the left one the other way round. What turns with
/// the airframe is not here: a gimballed rotor does not follow its mast but precesses, and what it
/// gives the airframe is in its load.
fn spin_up(aircraft: &Aircraft, sides: &Pair<SideInputs>, rotor_speed_radps2: f64) -> Vec3<Body> {
    let spin_up = aircraft.rotors.polar_inertia_kg_m2 * rotor_speed_radps2;
    let right_handed = sides.map(|side| side.mast.thrust_axis * spin_up);
    Pair { left: right_handed.left.mirrored_axial(), right: right_handed.right }.sum()
}
