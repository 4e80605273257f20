//! The airframe's aerodynamics against the reports.
//!
//! The printouts of CR537 (level helicopter flight at 40, 60, 80 and 100 kt, flaps 40/25) name every
//! component's load. Here each component is asked alone, with the printed motion, inflow, rotor force,
//! advance ratio and elevator forced, so that no trim stands between the two numbers.

use engine::Aircraft;
use engine::aero::{
    fuselage, horizontal_stabilizer, local_flow, rotor_wake, vertical_stabilizers, wing_pylon,
};
use engine::frames::{Load, Vec3};
use engine::mast::TiltedMast;
use engine::math::{PI, sqrt, square};
use engine::motion::Motion;
use engine::pair::Pair;
use engine::table::axis::AdvanceRatio;
use engine::units::{DEGREE_RAD as DEG, FOOT_M as FT, POUND_N as LBF};

const FT_LBF: f64 = FT * LBF;
const SLUG_PER_FT3: f64 = LBF / (FT * FT * FT * FT);

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

/// One printed trim: what goes in.
struct Trim {
    speed_kt: u32,
    u_ftps: f64,
    w_ftps: f64,
    induced_ftps: f64,
    advance_ratio: f64,
    elevator_deg: f64,
    /// X, Y, Z of one rotor.
    rotor_lbf: [f64; 3],
}

/// CR537 pages.
const TRIMS: [Trim; 4] = [
    Trim {
        speed_kt: 40,
        u_ftps: 67.45,
        w_ftps: -2.967,
        induced_ftps: 35.4892,
        advance_ratio: 0.0875,
        elevator_deg: 1.2741,
        rotor_lbf: [-24.558, 367.068, -6091.711],
    },
    Trim {
        speed_kt: 60,
        u_ftps: 100.8,
        w_ftps: -10.04,
        induced_ftps: 24.0344,
        advance_ratio: 0.1307,
        elevator_deg: 2.3398,
        rotor_lbf: [-82.594, 303.834, -5931.493],
    },
    Trim {
        speed_kt: 80,
        u_ftps: 133.2,
        w_ftps: -21.93,
        induced_ftps: 18.6232,
        advance_ratio: 0.1728,
        elevator_deg: 4.7105,
        rotor_lbf: [-137.552, 243.065, -6177.508],
    },
    Trim {
        speed_kt: 100,
        u_ftps: 164.7,
        w_ftps: -36.86,
        induced_ftps: 16.6955,
        advance_ratio: 0.2136,
        elevator_deg: 10.1255,
        rotor_lbf: [-123.945, 212.190, -6898.026],
    },
];

/// Loads of every component of the airframe in one of the trims.
struct Loads {
    fuselage: Load,
    free_wing: Load,
    immersed_wing: Load,
    pylons: Load,
    spinners: Load,
    tail: Load,
    fins: Load,
}

fn both(half: Load) -> Load {
    half + half.mirrored()
}

#[expect(clippy::too_many_lines, reason = "the printout of one flight condition, line by line")]
fn loads(xv15: &Aircraft, trim: &Trim) -> Loads {
    let motion = Motion {
        cg_m: Vec3::new(301.2 * FT / 12.0, 0.0, 81.65 * FT / 12.0),
        airspeed_mps: Vec3::new(trim.u_ftps * FT, 0.0, trim.w_ftps * FT),
        angular_rate_radps: Vec3::zero(),
        density_kg_per_m3: 0.002_377 * SLUG_PER_FT3,
    };
    let flow = local_flow(motion.airspeed_mps, motion.density_kg_per_m3);
    let mach = motion.airspeed_mps.norm() / engine::isa::SOUND_SPEED_SL_MPS;
    let (flap_rad, elevator_rad) = (40.0 * DEG, trim.elevator_deg * DEG);
    let [x, y, z] = trim.rotor_lbf;
    let mast = TiltedMast::new(0.0, 0.0);
    let axis = mast.thrust_axis;
    let wake = rotor_wake::evaluate(
        &xv15.rotor_wake,
        &rotor_wake::Inputs {
            motion,
            flow,
            mast_tilt_rad: 0.0,
            thrust_axes: Pair::both(axis),
            induced_mps: Pair::both(trim.induced_ftps * FT),
            rotor_force_n: Pair::both(sqrt(x * x + y * y + z * z) * LBF),
            advance_ratio: Pair::both(trim.advance_ratio),
            rotor_speed_radps: 589.0 * PI / 30.0,
            rotor_radius_m: 12.5 * FT,
        },
    );
    let half = wing_pylon::evaluate(
        &xv15.wing_pylon,
        &wing_pylon::Inputs {
            motion,
            flow,
            mach,
            alpha_rad: wake.wing_alpha_rad,
            wake_mps: wake.wing_mps.right,
            mast,
            induced_mps: trim.induced_ftps * FT,
            rotor_radius_m: xv15.rotors.radius_m,
            pivot_m: xv15.rotors.pivot_m,
            hub_from_cg_m: xv15.rotors.pivot_m.from_cg(motion.cg_m) + axis * (4.667 * FT),
            flap_rad,
            flaperon_rad: 0.0,
        },
    );
    let pressure_ratio = xv15.horizontal_stabilizer.pressure_ratio_at(0.0, &flow);
    let tail_inputs = horizontal_stabilizer::Inputs {
        motion,
        flow,
        mach,
        wing_alpha_rad: wake.wing_alpha_rad,
        wake_mps: wake.tail_mps,
        mast_tilt_rad: 0.0,
        flap_rad,
        elevator_rad,
        pressure_ratio,
    };
    let settled = horizontal_stabilizer::State {
        downwash_rad: xv15.horizontal_stabilizer.downwash(&tail_inputs),
    };
    let fin_inputs = vertical_stabilizers::Inputs {
        motion,
        flow,
        wake_mps: Vec3::zero(),
        mach,
        mast_tilt_rad: 0.0,
        flap_rad,
        pressure_ratio,
        rudder_rad: 0.0,
    };
    Loads {
        fuselage: fuselage::evaluate(
            &xv15.fuselage,
            &fuselage::Inputs { motion, flow, gear_extension_norm: 0.0 },
        ),
        free_wing: both(half.free_stream),
        immersed_wing: both(half.immersed),
        pylons: both(half.pylon),
        spinners: both(half.spinner),
        tail: horizontal_stabilizer::evaluate(&xv15.horizontal_stabilizer, &settled, &tail_inputs)
            .1,
        fins: both(vertical_stabilizers::evaluate(&xv15.vertical_stabilizers, &fin_inputs)),
    }
}

/// Prints X, Z and M beside the printed ones, and gives those that are further off than the tolerance.
///
/// The tolerance is a part of the printed force or moment as a whole, so that a small component beside
/// a large one is not held to more digits than its print has.
fn misses(name: &str, published: [[f64; 3]; 4], ours: [Load; 4], tolerance: f64) -> Vec<String> {
    let mut missed = Vec::new();
    for ((trim, published), load) in TRIMS.iter().zip(published).zip(ours) {
        let force = load.force_n * (1.0 / LBF);
        let ours = [force.x, force.z, load.moment_n_m.y / FT_LBF];
        let size = sqrt(square(published[0]) + square(published[1]));
        for ((axis, published), (ours, size)) in ["X", "Z", "M"]
            .iter()
            .zip(published)
            .zip(ours.into_iter().zip([size, size, published[2].abs()]))
        {
            let off = (ours - published) / size;
            println!(
                "{name:9} {:3} kt {axis}: published {published:9.1}, ours {ours:9.1}, {:+6.1} %",
                trim.speed_kt,
                100.0 * off
            );
            if off.abs() > tolerance {
                missed.push(format!("{axis} {}", trim.speed_kt));
            }
        }
    }
    missed
}

fn all(load: impl Fn(&Loads) -> Load) -> [Load; 4] {
    let xv15 = xv15();
    [0, 1, 2, 3].map(|i| load(&loads(&xv15, &TRIMS[i])))
}

/// The validation plan's band: what three digits of a table and the printed motion leave open.
const FUSELAGE_TOLERANCE: f64 = 0.02;

/// X misses: the printouts have 1.00 ft² of drag beside D_α, the published DLANG and D_POD make .65.
#[test]
fn val_fuselage_has_the_loads_of_the_trim_printouts() {
    let published = [
        [-15.850, -26.143, -598.516],
        [-42.616, -21.253, -2107.491],
        [-104.003, 44.085, -5308.990],
        [-229.311, 196.522, -10466.281],
    ];
    let missed = misses("fuselage", published, all(|loads| loads.fuselage), FUSELAGE_TOLERANCE);
    assert_eq!(missed, ["X 40", "X 60", "X 80", "X 100"]);
}

/// At 100 kt neither rotor wake nor rotor lift reaches the wing in the printouts.
const WING_TOLERANCE: f64 = 0.01;

/// The printed drag is the table's to .0002 of CD, the printed lift is not: 200, 297 and 189 lb are
/// missing at 40 to 80 kt. It asks for CL .391 and .718 at −8 and −4° (upright, flaps 40/25), where
/// Rev. A prints .291 and .518, on a line whose slope its table 4-IX confirms: the printouts were run
/// with another column. M misses with Z, and by 1.7 % at 100 kt, where the printed moment asks for a Cm
/// of −.111 and the table has −.110.
#[test]
fn val_wing_in_free_stream_has_the_loads_of_the_trim_printouts() {
    let published = [
        [-350.068, -719.309, 451.962],
        [-743.880, -1035.987, 478.278],
        [-1154.732, -676.317, -322.313],
        [-1523.955, 368.162, -2026.303],
    ];
    let missed = misses("wing", published, all(|loads| loads.free_wing), WING_TOLERANCE);
    let known = ["X 40", "Z 40", "M 40", "X 60", "Z 60", "M 60", "X 80", "Z 80", "M 80", "M 100"];
    assert_eq!(missed, known);
}

/// The printouts have nothing immersed from 40 kt on.
#[test]
fn val_the_wake_has_left_the_wing_at_40_kt() {
    for (load, kt) in all(|loads| loads.immersed_wing).iter().zip([40, 60, 80, 100]) {
        let force = load.force_n.norm();
        assert!(force <= 0.0, "{kt} kt: {:.1} lb", force / LBF);
    }
}

/// Nothing but a table of three digits and the printed motion in it.
const PYLON_TOLERANCE: f64 = 0.01;

#[test]
fn val_pylons_have_the_loads_of_the_trim_printouts() {
    let published = [
        [-97.506, 86.379, 140.465],
        [-180.801, 87.006, 267.775],
        [-305.502, 118.605, 455.304],
        [-466.540, 180.068, 695.411],
    ];
    let missed = misses("pylons", published, all(|loads| loads.pylons), PYLON_TOLERANCE);
    assert_eq!(missed, [""; 0]);
}

/// The validation plan's band.
const SPINNER_TOLERANCE: f64 = 0.03;

#[test]
fn val_spinners_have_the_loads_of_the_trim_printouts() {
    let published = [
        [-57.326, 32.686, 351.934],
        [-144.608, 48.895, 891.124],
        [-256.482, 78.063, 1581.401],
        [-388.541, 126.332, 2394.830],
    ];
    let missed = misses("spinners", published, all(|loads| loads.spinners), SPINNER_TOLERANCE);
    assert_eq!(missed, [""; 0]);
}

/// The validation plan's band.
const TAIL_TOLERANCE: f64 = 0.05;

#[test]
fn val_tail_has_the_loads_of_the_trim_printouts() {
    let published = [
        [-3.860, -75.388, -1618.995],
        [-9.946, -78.060, -1665.795],
        [-10.673, 31.094, 689.586],
        [26.079, 320.059, 6856.203],
    ];
    let missed = misses("tail", published, all(|loads| loads.tail), TAIL_TOLERANCE);
    assert_eq!(missed, [""; 0]);
}

/// The validation plan gives the fins no band: their drag is 9 lb at most. Three digits of three tables.
const FIN_TOLERANCE: f64 = 0.03;

/// Its sign at 40 kt comes from the printed sidewash factor of −.5.
#[test]
fn val_fins_have_the_drag_of_the_trim_printouts() {
    let published = [2.227, -1.595, -4.662, -8.512];
    let ours = all(|loads| loads.fins).map(|load| load.force_n.x / LBF);
    println!("fins X: published {published:?} lb, ours {ours:.2?} lb");
    assert!(ours.iter().zip(published).all(|(ours, lb)| (ours / lb - 1.0).abs() < FIN_TOLERANCE));
}

/// One part in five hundred: what four digits of the printed velocities and forces leave open.
const INDUCED_TOLERANCE: f64 = 0.002;

/// Momentum theory times 1 + X_SS leaves the same tip loss at all four speeds; without X_SS it does not.
#[test]
fn val_the_printed_induced_velocities_stand_in_the_other_rotors_upwash() {
    let xv15 = xv15();
    let tip_losses = |abreast: &dyn Fn(f64) -> f64| {
        TRIMS.map(|trim| {
            let [x, y, z] = trim.rotor_lbf;
            let thrust_lbf = sqrt(square(x) + square(y) + square(z));
            let through_ftps = sqrt(square(trim.u_ftps) + square(trim.induced_ftps - trim.w_ftps));
            let disc_ft2 = PI * square(12.5);
            let momentum_ftps = thrust_lbf / (2.0 * 0.002_377 * disc_ft2 * through_ftps);
            trim.induced_ftps / (momentum_ftps * (1.0 + abreast(trim.advance_ratio)))
        })
    };
    let spread = |of: [f64; 4]| {
        let mean = of.iter().sum::<f64>() / 4.0;
        of.iter().fold(0.0, |most, one| engine::math::max(most, (one / mean - 1.0).abs()))
    };
    let with = tip_losses(&|mu| xv15.rotors.other_rotor.abreast.at(AdvanceRatio(mu)));
    let without = tip_losses(&|_| 0.0);
    println!("with X_SS {with:.4?}, without {without:.4?}");
    assert!(spread(with) < INDUCED_TOLERANCE, "{with:?}");
    assert!(spread(without) > 10.0 * INDUCED_TOLERANCE, "{without:?}");
}
