//! What the flight tests share: the aircraft, ways to begin, the bits of a state, and chance.
#![allow(dead_code, reason = "every test crate takes its own part of it")]

use engine::aircraft::Params;
use engine::frames::{Attitude, Euler, Vec3};
use engine::inputs::{DeviceEvent, EventKind, Failures, World};
use engine::math::{FRAC_PI_2, PI, cos, sin};
use engine::pair::Pair;
use engine::symmetry::Mirror;
pub use engine::units::DEGREE_RAD as DEG;
use engine::{Aircraft, Inputs, Outputs, State, step};

pub const TICKS_PER_S: u64 = 250;

/// The XV-15 with the built-in pilots' cockpit map.
pub fn xv15() -> Aircraft {
    let map =
        aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap_or_else(|e| panic!("{e}"));
    aircraft::aircraft("xv15.toml", aircraft::XV15)
        .unwrap_or_else(|e| panic!("{e}"))
        .with_cockpit(map)
}

/// Standing on its wheels and facing north, brakes set, rotors at speed.
pub fn parked(xv15: &Aircraft) -> State {
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO);
    let start = start.unwrap_or_else(|e| panic!("{e}"));
    // The mirror plane of the world is north and down.
    engine::start::Start { heading_rad: 0.0, ..start }.on_wheels(xv15)
}

/// Aloft, level and heading north at `speed_mps` with the nacelles at `mast_tilt_rad`; not trimmed.
pub fn aloft(parked: &State, mast_tilt_rad: f64, speed_mps: f64) -> State {
    let mut state = *parked;
    state.plant.position_m = Vec3::new(0.0, 0.0, -500.0);
    state.plant.velocity_mps = Vec3::new(speed_mps, 0.0, 0.0);
    state.plant.attitude = Attitude::default();
    state.plant.angular_rate_radps = Vec3::zero();
    state.plant.weight_on_wheels = 0;
    state.actuators.mast_tilt_rad = Pair::both(mast_tilt_rad);
    state.cockpit.collective_norm = 0.5;
    // About what holds the weight, so that the first second is flown and not fallen.
    let inflow_rad = engine::math::atan2(speed_mps * sin(mast_tilt_rad), 0.75 * 3.81 * 61.7);
    let collective_rad = inflow_rad + 9.0 * DEG;
    state.actuators.collective_rad = Pair::both(collective_rad);
    let from_lever_rad = 5.0 * cos(mast_tilt_rad) * 1.6 * DEG;
    let from_linkage_rad = (-2.3 + 23.6 * mast_tilt_rad / FRAC_PI_2) * DEG + from_lever_rad;
    state.fcc.governor.integral_rad = collective_rad - from_linkage_rad;
    state.fcc.governor.correction_rad = state.fcc.governor.integral_rad;
    state.plant.rotors = state.plant.rotors.map(|mut rotor| {
        rotor.inflow.mean_mps = 5.0;
        rotor
    });
    state.plant.engines = Pair::both(engine::engines::State { power_w: 5e5 });
    state
}

pub fn calm() -> Inputs<'static> {
    Inputs { events: &[], world: World::default() }
}

/// Flown hands-off in calm air.
pub fn coast(xv15: &Aircraft, state: &State, ticks: u64) -> (State, Outputs) {
    let mut flown = step(xv15, state, &calm());
    for _ in 1..ticks {
        flown = step(xv15, &flown.0, &calm());
    }
    flown
}

pub fn euler(state: &State) -> Euler {
    state.plant.attitude.euler()
}

/// Every number of the state as it is logged.
pub fn words(state: &State) -> Vec<u64> {
    let config = bincode::config::legacy();
    let bytes = bincode::serde::encode_to_vec(state, config).unwrap();
    bytes.chunks_exact(8).map(|word| u64::from_le_bytes(word.try_into().unwrap())).collect()
}

#[track_caller]
pub fn assert_same_bits(a: &State, b: &State, what: &str) {
    if words(a) != words(b) {
        let (a, b) = (format!("{a:#?}"), format!("{b:#?}"));
        let lines = a.lines().zip(b.lines()).enumerate();
        let different: Vec<_> = lines.filter(|(_, (a, b))| a != b).collect();
        panic!("{what} differs, line by line of the state: {different:#?}");
    }
}

/// A tiny generator (xorshift64*), so that a seed means the same everywhere.
pub struct Chance(u64);

impl Chance {
    pub fn seeded(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn draw(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.draw() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn one_in(&mut self, n: u64) -> bool {
        self.draw().is_multiple_of(n)
    }

    pub fn of(&mut self, n: u64) -> u64 {
        self.draw() % n
    }

    /// Somewhere between standing and flying fast, any way up.
    pub fn start(&mut self, parked: &State) -> State {
        let heading_rad = self.between(-PI, PI);
        if self.one_in(3) {
            let mut state = *parked;
            state.plant.attitude = Attitude::from_euler(Euler { heading_rad, ..Euler::default() });
            return state;
        }
        let mut state = aloft(parked, self.between(0.0, 90.0) * DEG, self.between(0.0, 150.0));
        let height_m_max = if self.one_in(3) { 5000.0 } else { 300.0 };
        state.plant.position_m.z = -self.between(2.0, height_m_max);
        state.plant.velocity_mps.y = self.between(-10.0, 10.0);
        state.plant.velocity_mps.z = self.between(-10.0, 10.0);
        state.plant.angular_rate_radps =
            Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0));
        let tilted_rad = if self.one_in(4) { PI } else { 0.3 };
        state.plant.attitude = Attitude::from_euler(Euler {
            roll_rad: self.between(-tilted_rad, tilted_rad),
            pitch_rad: 0.5 * self.between(-tilted_rad, tilted_rad),
            heading_rad,
        });
        state
    }

    /// Violent hands and feet: now and then an axis jumps or a switch is thrown.
    pub fn events(&mut self, tick: u64) -> Vec<DeviceEvent> {
        let mut events = Vec::new();
        while self.one_in(20) || (events.len() == 1 && self.one_in(3)) {
            let (kind, code, value) = match self.of(20) {
                0 => (EventKind::Disconnected, 0, 0),
                1..=4 => (EventKind::Button, 0x120 + self.of(9), self.of(2) as i64),
                _ => {
                    let code = [0, 1, 6, 7, 9, 10][self.of(6) as usize];
                    (EventKind::Axis, code, self.between(-40e3, 40e3) as i64)
                }
            };
            let kind = kind as u64;
            events.push(DeviceEvent { tick, kind, code, value, ..DeviceEvent::default() });
        }
        events
    }

    /// Now and then another wind, another ground, another failure.
    pub fn world(&mut self, before: &World) -> World {
        let mut world = *before;
        if self.one_in(250) {
            let (speed_mps, from_rad) = (self.between(0.0, 40.0), self.between(-PI, PI));
            world.wind_mps = Vec3::new(
                speed_mps * cos(from_rad),
                speed_mps * sin(from_rad),
                self.between(-5.0, 5.0),
            );
        }
        if self.one_in(500) {
            world = world.with_ground(self.between(-20.0, 20.0));
        }
        if self.one_in(500) {
            world.failures ^= Failures::FACTS[self.of(6) as usize].flag;
        }
        world
    }
}

/// What the same hands do in a mirror.
pub fn mirrored_events(events: &[DeviceEvent]) -> Vec<DeviceEvent> {
    let image = |event: &DeviceEvent| match (EventKind::from_u64(event.kind), event.code) {
        (Some(EventKind::Axis), 0 | 7) => DeviceEvent { value: -event.value, ..*event },
        (Some(EventKind::Axis), 9) => DeviceEvent { code: 10, ..*event },
        (Some(EventKind::Axis), 10) => DeviceEvent { code: 9, ..*event },
        _ => *event,
    };
    events.iter().map(image).collect()
}

/// One seeded violent flight, tick by tick: `look` sees what went in and what came out.
pub fn violent_flight(
    xv15: &Aircraft,
    parked: &State,
    seed: u64,
    ticks: u64,
    mut look: impl FnMut(&State, &Inputs, &State, &Outputs),
) {
    let mut chance = Chance::seeded(seed);
    let mut state = chance.start(parked).without_negative_zeros();
    let mut world = World::default();
    for tick in 0..ticks {
        let events = chance.events(tick);
        world = chance.world(&world);
        let inputs = Inputs { events: &events, world };
        let (next, outputs) = step(xv15, &state, &inputs);
        look(&state, &inputs, &next, &outputs);
        state = next;
    }
}

/// The mirror image of a step's inputs, flown from the mirror image of its state.
pub fn step_in_the_mirror(xv15: &Aircraft, state: &State, inputs: &Inputs) -> State {
    let events = mirrored_events(inputs.events);
    step(xv15, &state.mirrored(), &Inputs { events: &events, world: inputs.world.mirrored() }).0
}

/// Takes the air away: no block but gravity, ground and inertia has anything to say.
pub fn in_vacuum(xv15: &mut Params) {
    xv15.rotors.blade.blade_chord_m.y.fill(0.0);
    xv15.rotors.flapping.hub_spring_n_m_per_rad = 0.0;
    // Blades that flap without air would trade energy with the body: they get next to no mass.
    xv15.rotors.flapping.stop_spring_n_m_per_rad *= 1e-6;
    xv15.rotors.flapping.blade_inertia_kg_m2 *= 1e-6;
    xv15.rotors.polar_inertia_kg_m2 *= 1e-6;
    xv15.wing_pylon.area_m2 = 0.0;
    xv15.wing_pylon.interference_m2.y.fill(0.0);
    xv15.wing_pylon.platform_m2 = 0.0;
    xv15.wing_pylon.spinner_m2 = 0.0;
    xv15.wing_pylon.spinner_across_m2 = 0.0;
    let fuselage = &mut xv15.fuselage;
    for values in [
        &mut fuselage.lift_m2.y,
        &mut fuselage.drag_m2.y,
        &mut fuselage.pitching_m3.y,
        &mut fuselage.lift_by_sideslip_m2.y,
        &mut fuselage.drag_by_sideslip_m2.y,
        &mut fuselage.pitching_by_sideslip_m3.y,
        &mut fuselage.side_m2.y,
        &mut fuselage.rolling_m3.y,
        &mut fuselage.yawing_m3.y,
    ] {
        values.fill(0.0);
    }
    fuselage.lift_offset_m2 = 0.0;
    fuselage.drag_offset_m2 = 0.0;
    fuselage.pitching_offset_m3 = 0.0;
    fuselage.lift_correction_m2 = 0.0;
    fuselage.drag_correction_m2 = 0.0;
    fuselage.pod_drag_m2 = 0.0;
    fuselage.gear_drag_m2 = 0.0;
    xv15.horizontal_stabilizer.area_m2 = 0.0;
    xv15.vertical_stabilizers.area_m2 = 0.0;
    xv15.engines.jet_thrust_n = 0.0;
    xv15.engines.idle_power_norm = 0.0;
    xv15.engines.fuel_idle_kg_per_s = 0.0;
}

/// The same with rotors that stand still and have forgotten that they turned.
pub fn rotors_stopped(state: &State) -> State {
    let mut state = *state;
    state.plant.rotor_speed_radps = 0.0;
    state.plant.rotors = Pair::default();
    state.plant.engines = Pair::default();
    state.rate = engine::state::PlantRate::default();
    state
}

/// Kinetic and potential energy of the rigid body, and what struts and tyres store, J.
pub fn energy_j(xv15: &Aircraft, state: &State, outputs: &Outputs) -> f64 {
    let gear = &xv15.landing_gear;
    let legs = &outputs.landing_gear;
    let spring_j =
        |stiffness_n_per_m: f64, strain_m: f64| 0.5 * stiffness_n_per_m * strain_m * strain_m;
    let tyres = &state.plant.tyre_deflections;
    let tyres_j = [tyres.nose, tyres.main.left, tyres.main.right].map(|tyre| {
        spring_j(gear.tyre_stiffness_n_per_m, tyre.forward_m)
            + spring_j(gear.tyre_stiffness_n_per_m, tyre.right_m)
    });
    let stored_j = spring_j(gear.nose.stiffness_n_per_m, legs.nose.compression_m)
        + legs.main.map(|leg| spring_j(gear.main.stiffness_n_per_m, leg.compression_m)).sum()
        + tyres_j.iter().sum::<f64>();
    let plant = &state.plant;
    let (v, w) = (plant.velocity_mps, plant.angular_rate_radps);
    let balance = &outputs.balance;
    stored_j + 0.5 * balance.mass_kg * v.dot(v) + 0.5 * w.dot(turning(balance.inertia, w))
        - balance.mass_kg * engine::GRAVITY_MPS2 * plant.position_m.z
}

/// Angular momentum of the rigid body, I·ω.
pub fn turning(
    inertia: engine::inertia::Inertia,
    w: Vec3<engine::frames::Body>,
) -> Vec3<engine::frames::Body> {
    Vec3::new(
        inertia.xx_kg_m2 * w.x - inertia.xz_kg_m2 * w.z,
        inertia.yy_kg_m2 * w.y,
        inertia.zz_kg_m2 * w.z - inertia.xz_kg_m2 * w.x,
    )
}
