//! The bits of one tick from very many states, in the envelope and far out of it.
//!
//! Golden flights see the states that somebody flies. A change that must not move a bit is seen by
//! these: stalled blades, reverse flow, rotors that stand still, zeros of either sign, rates that
//! nobody survives, numbers that overflow. They go through [`step`] and [`derivatives`]; the bits of
//! every [`State`] and [`Outputs`] are hashed and compared with what was recorded.
//!
//! When the motion changes deliberately, the hashes are recorded anew, together with the golden
//! flights: run this test with `--release` (an unoptimised build looks at the first states of each
//! kind only) and put the table that it prints into [`RECORDED`]. A change that claims to leave the
//! motion alone never does that.

mod flying;

use engine::frames::{Attitude, Euler, Vec3};
use engine::inputs::{Failures, World};
use engine::math::{PI, exp};
use engine::pair::Pair;
use engine::step::derivatives;
use engine::{Aircraft, Inputs, Outputs, State, step, step_state};
use flying::{Chance, DEG, aloft, assert_same_bits, parked, violent_flight, xv15};
use serde::Serialize;

/// States of each kind.
const STATES: usize = 12_000;
/// So many of them where nothing is optimised.
const FIRST_STATES: usize = 600;

/// What was recorded of a kind: a hash of the first states, and one of all.
struct Recorded {
    kind: Kind,
    first: u64,
    all: u64,
}

/// How the states come about.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Out of flights with violent hands.
    Flown,
    /// Anywhere a pilot may get to, every part by itself.
    Envelope,
    /// Blades far beyond their stall: descents, stopped and reversed rotors, any pitch and flapping.
    Stalled,
    /// Some numbers are zero of either sign.
    Zeros,
    /// Some numbers are anything up to 1e9.
    Beyond,
    /// Some numbers overflow, are infinite or not a number: the aircraft freezes.
    Broken,
}

const RECORDED: [Recorded; 6] = [
    Recorded { kind: Kind::Flown, first: 0x89d9_bea4_821d_c3cd, all: 0x128a_ca11_ad10_5d94 },
    Recorded { kind: Kind::Envelope, first: 0x047f_b480_502a_251f, all: 0x3eab_b215_82a5_0cec },
    Recorded { kind: Kind::Stalled, first: 0x2f68_f21e_97db_3974, all: 0x0192_2257_9a52_0c42 },
    Recorded { kind: Kind::Zeros, first: 0xc903_995e_f860_5522, all: 0x01ee_f31d_3ee0_adf6 },
    Recorded { kind: Kind::Beyond, first: 0xac74_1168_27d1_d4e1, all: 0x26c3_00ac_0c1e_e2da },
    Recorded { kind: Kind::Broken, first: 0x4523_9738_3274_e598, all: 0x004a_7620_9406_329f },
];

/// The bits of what has been seen so far (FNV-1a, by words of eight bytes).
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn see(&mut self, seen: &impl Serialize) {
        let config = bincode::config::legacy();
        let bytes = bincode::serde::encode_to_vec(seen, config).unwrap();
        for word in bytes.chunks_exact(8) {
            let word = u64::from_le_bytes(word.try_into().unwrap());
            // Which of the many bit patterns of a NaN comes out is the machine's choice. No integer
            // that is recorded looks like one.
            let word = if f64::from_bits(word).is_nan() { u64::MAX } else { word };
            self.0 = (self.0 ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(29);
        }
    }
}

/// Any sign, any order of magnitude.
fn of_any_size(chance: &mut Chance, ln_min: f64, ln_max: f64) -> f64 {
    let size = exp(chance.between(ln_min, ln_max));
    if chance.one_in(2) { size } else { -size }
}

/// Changes about one in `n` numbers of the state.
fn change(state: &mut State, chance: &mut Chance, n: u64, f: impl Fn(&mut Chance, f64) -> f64) {
    state.each_number(|number| {
        if chance.one_in(n) {
            *number = f(chance, *number);
        }
    });
}

/// Masts, controls and blades anywhere between their stops and a little beyond; often near the middle.
fn anywhere(chance: &mut Chance, parked: &State) -> State {
    let left_rad = chance.between(-5.0, 95.0) * DEG;
    let mut state = aloft(parked, left_rad, chance.between(0.0, 150.0));
    let stray_rad = chance.between(-3.0, 3.0) * DEG;
    state.actuators.mast_tilt_rad.right += stray_rad * chance.of(2) as f64;
    let part = engine::math::square(chance.between(0.0, 1.0));
    let mut around = |middle: f64, width: f64| middle + part * chance.between(-width, width);
    let surfaces = &mut state.actuators;
    surfaces.mast_tilt_rate_radps = Pair::both(around(0.0, 0.14));
    surfaces.collective_rad = surfaces.collective_rad.map(|rad| around(rad, 0.1));
    surfaces.cyclic_forward_rad = surfaces.cyclic_forward_rad.map(|_| around(0.0, 0.17));
    surfaces.cyclic_outboard_rad = surfaces.cyclic_outboard_rad.map(|_| around(0.0, 0.05));
    surfaces.elevator_rad = around(0.0, 0.35);
    surfaces.flaperon_rad = surfaces.flaperon_rad.map(|_| around(0.0, 0.3));
    surfaces.rudder_right_rad = around(0.0, 0.35);
    surfaces.flap_rad = around(0.65, 0.7);
    surfaces.gear_extension_norm = around(0.5, 0.5);
    surfaces.lever_norm = around(0.5, 0.5);
    let plant = &mut state.plant;
    plant.position_m.z = around(-2_000.0, 1_998.0);
    plant.velocity_mps.y = around(0.0, 15.0);
    plant.velocity_mps.z = around(0.0, 15.0);
    plant.angular_rate_radps = Vec3::new(around(0.0, 0.8), around(0.0, 0.8), around(0.0, 0.8));
    plant.attitude = Attitude::from_euler(Euler {
        roll_rad: around(0.0, 0.8),
        pitch_rad: around(0.0, 0.5),
        heading_rad: around(0.0, PI),
    });
    plant.rotor_speed_radps = around(56.0, 12.0);
    plant.fuel_kg = around(330.0, 330.0);
    plant.horizontal_stabilizer.downwash_rad = around(0.0, 0.2);
    plant.rotors = plant.rotors.map(|mut rotor| {
        rotor.inflow.mean_mps = around(6.0, 8.0);
        rotor.inflow.aft_mps = around(0.0, 6.0);
        rotor.inflow.right_mps = around(0.0, 6.0);
        rotor.flapping.coning_rad = around(0.05, 0.05);
        rotor.flapping.coning_radps = around(0.0, 1.0);
        rotor.flapping.aft_rad = around(0.0, 0.2);
        rotor.flapping.aft_radps = around(0.0, 3.0);
        rotor.flapping.right_rad = around(0.0, 0.2);
        rotor.flapping.right_radps = around(0.0, 3.0);
        rotor
    });
    plant.weight_on_wheels = chance.of(2);
    state.cockpit.scas_on = chance.of(2);
    state.cockpit.flap_detent = chance.of(4);
    state.cockpit.rpm_select = chance.of(3);
    state.cockpit.gear_down = chance.of(2);
    state.environment.noise = chance.of(1 << 40);
    state
}

/// Any pitch, any flow: what the tables of the blade's sections do not know.
fn stalled(chance: &mut Chance, parked: &State) -> State {
    let mut state = anywhere(chance, parked);
    let mut any = |most: f64| chance.between(-most, most);
    let surfaces = &mut state.actuators;
    surfaces.collective_rad = surfaces.collective_rad.map(|_| any(1.2));
    surfaces.cyclic_forward_rad = surfaces.cyclic_forward_rad.map(|_| any(0.6));
    let plant = &mut state.plant;
    plant.velocity_mps = Vec3::new(any(120.0), any(60.0), any(80.0));
    plant.angular_rate_radps = Vec3::new(any(8.0), any(8.0), any(8.0));
    plant.attitude = Attitude::from_euler(Euler {
        roll_rad: any(PI),
        pitch_rad: any(1.57),
        heading_rad: any(PI),
    });
    plant.rotor_speed_radps = any(120.0);
    plant.rotors = plant.rotors.map(|mut rotor| {
        rotor.inflow.mean_mps = any(30.0);
        rotor.flapping.coning_rad = any(0.4);
        rotor.flapping.aft_rad = any(0.5);
        rotor.flapping.right_rad = any(0.5);
        rotor
    });
    if chance.one_in(4) {
        plant.rotor_speed_radps = 0.0;
    }
    state
}

fn state_of(kind: Kind, chance: &mut Chance, parked: &State) -> State {
    let mut state =
        if chance.one_in(2) { anywhere(chance, parked) } else { stalled(chance, parked) };
    match kind {
        Kind::Flown => unreachable!("flown, not made"),
        Kind::Envelope => return anywhere(chance, parked),
        Kind::Stalled => return stalled(chance, parked),
        Kind::Zeros => {
            let n = [1, 2, 4, 20][chance.of(4) as usize];
            let attitude = state.plant.attitude;
            change(&mut state, chance, n, |chance, _| if chance.one_in(2) { 0.0 } else { -0.0 });
            state.plant.attitude = attitude;
        }
        Kind::Beyond => {
            let n = [4, 20, 100][chance.of(3) as usize];
            change(&mut state, chance, n, |chance, number| match chance.of(3) {
                0 => of_any_size(chance, -20.0, 20.0),
                1 => number * of_any_size(chance, -3.0, 6.0),
                _ => -number,
            });
        }
        Kind::Broken => {
            let n = [20, 100, 400][chance.of(3) as usize];
            change(&mut state, chance, n, |chance, _| match chance.of(4) {
                0 => f64::NAN,
                1 => f64::INFINITY,
                2 => f64::NEG_INFINITY,
                _ => of_any_size(chance, 300.0, 709.0),
            });
        }
    }
    state
}

fn world_of(chance: &mut Chance) -> World {
    let mut world = World::default();
    if chance.one_in(2) {
        world.wind_mps = Vec3::new(chance.between(-20.0, 20.0), chance.between(-20.0, 20.0), 0.0);
        world.turbulence_mps = chance.between(0.0, 3.0) * chance.of(2) as f64;
    }
    if chance.one_in(4) {
        world = world.with_ground(chance.between(-20.0, 20.0));
        world.failures = Failures::from_bits_retain(chance.of(64));
        world.temperature_offset_k = chance.between(-40.0, 40.0);
    }
    world.paused = u64::from(chance.one_in(50));
    world
}

/// How often states of a kind met what they are there for.
#[derive(Default)]
struct Met {
    frozen: usize,
    stalled: usize,
    on_stop: usize,
    in_vortex_ring: usize,
}

impl Met {
    fn see(&mut self, next: &State, outputs: &Outputs) {
        let rotors = outputs.rotors;
        self.frozen += usize::from(next.frozen != 0);
        self.stalled += usize::from(rotors.map(|rotor| rotor.stalled).sum() > 0);
        self.on_stop += usize::from(rotors.map(|rotor| rotor.on_stop).sum() > 0);
        self.in_vortex_ring += usize::from(rotors.map(|rotor| rotor.in_vortex_ring).sum() > 0);
    }
}

/// Hands `look` the states of a kind, in the same order everywhere.
fn states(
    xv15: &Aircraft,
    parked: &State,
    kind: Kind,
    count: usize,
    mut look: impl FnMut(&State, &Inputs),
) {
    const TICKS_BETWEEN: u64 = 25;
    const TICKS: u64 = 60 * TICKS_BETWEEN;
    if kind == Kind::Flown {
        for seed in 0..count as u64 / (TICKS / TICKS_BETWEEN) {
            violent_flight(xv15, parked, 1_000 + seed, TICKS, |state, inputs, _, _| {
                if state.tick % TICKS_BETWEEN == 0 {
                    look(state, inputs);
                }
            });
        }
        return;
    }
    let mut chance = Chance::seeded(kind as u64);
    for _ in 0..count {
        let state = state_of(kind, &mut chance, parked);
        let world = world_of(&mut chance);
        let events = chance.events(state.tick);
        look(&state, &Inputs { events: &events, world });
    }
}

/// The hash of a kind's first `count` states after a tick, and what was met on the way.
fn hash(xv15: &Aircraft, parked: &State, kind: Kind, counts: &[usize]) -> (Vec<u64>, Met) {
    let (mut hash, mut met, mut seen) = (Hash::new(), Met::default(), 0);
    let mut hashes = Vec::new();
    let most = counts.iter().copied().max().unwrap_or(0);
    states(xv15, parked, kind, most, |state, inputs| {
        let (next, outputs) = step(xv15, state, inputs);
        hash.see(&next);
        hash.see(&outputs);
        met.see(&next, &outputs);
        if seen % 8 == 0 {
            let mut in_place = *state;
            step_state(xv15, &mut in_place, inputs);
            assert_same_bits(&in_place, &next, "the step in place");
        }
        if kind == Kind::Broken && next.frozen != 0 {
            assert_standing(state, &next);
        }
        let (rates, outputs) = derivatives(xv15, state, &inputs.world);
        hash.see(&rates);
        hash.see(&outputs);
        seen += 1;
        if counts.contains(&seen) {
            hashes.push(hash.0);
        }
    });
    (hashes, met)
}

/// A frozen aircraft keeps the bits that it had: the tick and the cockpit alone go on.
fn assert_standing(state: &State, next: &State) {
    let mut held = State { tick: next.tick, cockpit: next.cockpit, frozen: 1, ..*state };
    let mut bits = Vec::new();
    held.each_number(|number| bits.push(number.to_bits()));
    let mut at = 0;
    let mut next = *next;
    next.each_number(|number| {
        assert_eq!(number.to_bits(), bits[at], "number {at} of a frozen state moved");
        at += 1;
    });
}

/// As it is written here: in groups of four digits.
fn hexadecimal(number: u64) -> String {
    let part = |shift: u32| format!("{:04x}", number >> shift & 0xffff);
    format!("0x{}_{}_{}_{}", part(48), part(32), part(16), part(0))
}

#[test]
fn regress_a_tick_from_any_state_has_the_recorded_bits() {
    let xv15 = xv15();
    let parked = parked(&xv15);
    let counts: &[usize] =
        if cfg!(debug_assertions) { &[FIRST_STATES] } else { &[FIRST_STATES, STATES] };
    let mut table = String::new();
    let mut moved = Vec::new();
    for recorded in &RECORDED {
        let kind = recorded.kind;
        let (hashes, met) = hash(&xv15, &parked, kind, counts);
        let share = |count: usize| 100 * count / counts[counts.len() - 1];
        println!(
            "{kind:?}: frozen {} %, stalled {} %, on the stop {} %, vortex ring {} %",
            share(met.frozen),
            share(met.stalled),
            share(met.on_stop),
            share(met.in_vortex_ring)
        );
        let written: Vec<_> = hashes.iter().copied().map(hexadecimal).collect();
        let all = written.get(1).map_or("?", String::as_str);
        let row = format!("kind: Kind::{kind:?}, first: {}, all: {all}", written[0]);
        table += &format!("    Recorded {{ {row} }},\n");
        if hashes != [recorded.first, recorded.all][..hashes.len()] {
            moved.push(format!("{kind:?}"));
        }
        match kind {
            Kind::Stalled => assert!(share(met.stalled) > 50, "blades hardly stall"),
            Kind::Broken => assert!(share(met.frozen) > 40, "next to nothing freezes"),
            Kind::Flown | Kind::Envelope => assert_eq!(met.frozen, 0, "{kind:?}: a flight froze"),
            Kind::Zeros | Kind::Beyond => {}
        }
    }
    assert!(moved.is_empty(), "the motion moved: {}\n{table}", moved.join(", "));
}
