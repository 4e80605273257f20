//! Loads of the components.

use engine::frames::{Attitude, Body, Euler, Load, Vec3};
use engine::inputs::World;
use engine::math::atan2;
use engine::pair::Pair;
use engine::trim::{GROUND_FAR_BELOW_M, settle};
use engine::{Aircraft, Outputs, State};

use crate::book::{Band, Book, Case, DEG, FOOT_M, POUND_N};

/// A printed steady flight: body velocity ft/s, cyclic forward and elevator deg, thrust of a rotor lbf,
/// and loads lbf, ft·lbf: fuselage, wing with pylons and spinners, tail, one rotor.
struct Printed {
    name: &'static str,
    forward_ftps: f64,
    down_ftps: f64,
    cyclic_deg: f64,
    elevator_deg: f64,
    thrust_lbf: f64,
    fuselage: [f64; 3],
    wing: [f64; 3],
    tail: [f64; 3],
    rotor: [f64; 3],
    /// Of the right rotor, outboard, lbf.
    rotor_outboard_lbf: f64,
}

const PRINTED: [Printed; 2] = [
    Printed {
        name: "40 kt",
        forward_ftps: 67.45,
        down_ftps: -2.967,
        cyclic_deg: 0.57,
        elevator_deg: 1.274,
        thrust_lbf: 6097.2,
        fuselage: [-15.9, -26.1, -598.5],
        wing: [-504.9, -600.2, 944.4],
        tail: [-3.9, -75.4, -1619.0],
        rotor: [-24.6, -6091.7, 627.2],
        rotor_outboard_lbf: 367.1,
    },
    Printed {
        name: "80 kt",
        forward_ftps: 133.2,
        down_ftps: -21.93,
        cyclic_deg: 2.09,
        elevator_deg: 4.71,
        thrust_lbf: 6180.8,
        fuselage: [-104.0, 44.1, -5309.0],
        wing: [-1716.7, -479.6, 1714.4],
        tail: [-10.7, 31.1, 689.6],
        rotor: [-137.6, -6177.5, 1442.4],
        rotor_outboard_lbf: 243.1,
    },
];

/// The aircraft held in a printed flight, its collective such that the thrust is the printed one.
fn held(aircraft: &Aircraft, printed: &Printed) -> Outputs {
    let world = World { ground_height_m: GROUND_FAR_BELOW_M, ..World::default() };
    let mut state = State::default();
    let pitch_rad = atan2(printed.down_ftps, printed.forward_ftps);
    let velocity: Vec3<Body> =
        Vec3::new(printed.forward_ftps * FOOT_M, 0.0, printed.down_ftps * FOOT_M);
    let plant = &mut state.plant;
    plant.attitude = Attitude::from_euler(Euler { pitch_rad, ..Euler::default() });
    plant.velocity_mps = plant.attitude.ned_from_body() * velocity;
    plant.rotor_speed_radps = aircraft.fcc.governor.rotor_speed_radps[0];
    plant.fuel_kg = 669.0;
    state.actuators.cyclic_forward_rad = Pair::both(printed.cyclic_deg / DEG);
    state.actuators.elevator_rad = printed.elevator_deg / DEG;
    state.actuators.flap_rad = aircraft.fcc.mixer.flap_rad[2];
    let (mut low_deg, mut high_deg) = (0.0, 25.0);
    let mut outputs = Outputs::default();
    for _ in 0..20 {
        let middle_deg = 0.5 * (low_deg + high_deg);
        state.actuators.collective_rad = Pair::both(middle_deg / DEG);
        let settled = settle(aircraft, &state, &world, 400);
        (_, outputs) = engine::step::heading(aircraft, &settled, &world);
        if outputs.rotors.right.thrust_n < printed.thrust_lbf * POUND_N {
            low_deg = middle_deg;
        } else {
            high_deg = middle_deg;
        }
    }
    outputs
}

/// Case 14.
pub fn components(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        14,
        "loads of the components, helicopter at 40 and 80 kt, about the centre of gravity",
        "Class B: GTRS, NASA CR-166537 printouts.",
        "The printed velocities, controls and thrust are forced, not the induced velocity, which follows. \
         Fuselage ±2 %, as its tables are known; tail and wing ±5 %; wing, pylons and spinners are one \
         block here, and their printed loads are added. Nothing is lost between points of reference: the \
         printed M of a rotor is that of its X and Z at a hub 6.2 ft above the centre, and a hub moment \
         of −134 and −28 ft·lbf, which by 225 ft·lbf/deg is a disc tilted .6 and .1 deg forward; ours is \
         tilted 1 deg further aft at the same cyclic, and thrust times that is what X misses, and 6.2 ft \
         of it M. The printed Y is outboard: the lateral cyclic that 8a-VIII programmes from 40 kt on, \
         -4 deg, would turn it inboard (ours: -181 and -219 lbf), so the printouts are without it, and \
         so is this case; the trims of case 3 are with it, and by delta3 it holds half of their stick.",
    );
    for printed in &PRINTED {
        let outputs = held(aircraft, printed);
        let loads = &outputs.loads;
        let name = printed.name;
        let mut add = |what: &str, published: &[f64; 3], load: Load, part: f64| {
            let ours = [
                load.force_n.x / POUND_N,
                load.force_n.z / POUND_N,
                load.moment_n_m.y / (POUND_N * FOOT_M),
            ];
            for (i, label) in ["X, lbf", "Z, lbf", "M, ft·lbf"].iter().enumerate() {
                let row = format!("{name}: {what} {label}");
                case.row(row, published[i], ours[i], Band::Part(part), 1);
            }
        };
        add("fuselage", &printed.fuselage, loads.fuselage, 0.02);
        add("wing, pylons, spinners", &printed.wing, loads.wing_pylon.sum(), 0.05);
        add("tail", &printed.tail, loads.horizontal_stabilizer, 0.05);
        add("rotor", &printed.rotor, loads.rotors.right, 0.05);
        let outboard_lbf = loads.rotors.right.force_n.y / POUND_N;
        let row = format!("{name}: rotor Y, outboard, lbf");
        case.row(row, printed.rotor_outboard_lbf, outboard_lbf, Band::Part(0.05), 1);
    }
    book.add(case);
}
