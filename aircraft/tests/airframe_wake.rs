//! The rotor's wake on the wing: how much of it, where, and how it comes and goes.

use engine::Aircraft;
use engine::aero::wake_footprint::{Footprint, footprint};
use engine::aero::{local_flow, wing_pylon};
use engine::frames::{Body, Vec3};
use engine::motion::Motion;
use engine::units::{DEGREE_RAD as DEG, FOOT_M as FT, INCH_M as INCH, KNOT_MPS as KT};

/// Half the chord, SL 338.19 less half of 5.225 ft, and the centre of gravity's station.
const MIDDLE_FROM_CG_M: f64 = -(338.19 - 0.5 * 5.225 * 12.0 - 301.2) * INCH;

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

fn inputs(xv15: &Aircraft, tilt_rad: f64, velocity: Vec3<Body>, v: f64) -> wing_pylon::Inputs {
    let cg_m = Vec3::new(301.2 * INCH, 0.0, 81.65 * INCH);
    let mast = xv15.rotors.mast(tilt_rad);
    let motion = Motion {
        cg_m,
        airspeed_mps: velocity,
        angular_rate_radps: Vec3::zero(),
        density_kg_per_m3: engine::isa::DENSITY_SL_KG_PER_M3,
    };
    wing_pylon::Inputs {
        motion,
        flow: local_flow(motion.airspeed_mps, motion.density_kg_per_m3),
        mach: 0.0,
        alpha_rad: engine::math::atan2(velocity.z, velocity.x),
        wake_mps: mast.thrust_axis * (xv15.rotor_wake.wing_factor * v),
        mast,
        induced_mps: v,
        rotor_radius_m: xv15.rotors.radius_m,
        pivot_m: xv15.rotors.pivot_m,
        hub_from_cg_m: xv15.rotors.hub_from_cg(cg_m, &mast),
        flap_rad: 40.0 * DEG,
        flaperon_rad: 0.0,
    }
}

fn in_wake(xv15: &Aircraft, tilt_rad: f64, velocity: Vec3<Body>, v: f64) -> Footprint {
    footprint(&xv15.wing_pylon, &inputs(xv15, tilt_rad, velocity, v))
}

/// Induced velocity of half the weight, by momentum theory.
fn induced(speed_mps: f64) -> f64 {
    let hover_mps: f64 = 17.0;
    let mut v = hover_mps;
    for _ in 0..100 {
        v = 0.5 * (v + hover_mps * hover_mps / engine::math::sqrt(v * v + speed_mps * speed_mps));
    }
    v
}

/// CR536's and KH's largest immersed area of a half wing.
const IMMERSED_FT2: f64 = 56.0;
/// Ours follows from the wake's contraction (CR176970): what two digits of .707 leave open.
const IMMERSED_TOLERANCE: f64 = 0.03;

#[test]
fn val_in_hover_the_wake_covers_the_published_area() {
    let xv15 = xv15();
    let hover = in_wake(&xv15, 0.0, Vec3::zero(), 17.0);
    let area_ft2 = hover.area_m2 / (FT * FT);
    println!("{area_ft2:.1} ft2");
    assert!((area_ft2 / IMMERSED_FT2 - 1.0).abs() < IMMERSED_TOLERANCE);
    assert!((hover.centroid_from_cg_m.x - MIDDLE_FROM_CG_M).abs() < 0.2 * INCH);
}

/// Straight down on a plate: its middle.
#[test]
fn in_hover_the_download_acts_in_the_middle_of_the_chord() {
    let xv15 = xv15();
    let hover = inputs(&xv15, 0.0, Vec3::zero(), 17.0);
    let load = wing_pylon::evaluate(&xv15.wing_pylon, &hover).immersed;
    let down_at_m = -load.moment_n_m.y / load.force_n.z;
    assert!(load.force_n.z > 3000.0 && load.force_n.x.abs() < 0.05 * load.force_n.z);
    assert!((down_at_m - MIDDLE_FROM_CG_M).abs() < 1.0 * INCH, "{down_at_m} m");
}

/// The rest of its wake leaves the wing at its trailing edge, a little at every knot.
#[test]
fn with_speed_the_wake_leaves_the_wing_backwards_and_without_a_jump() {
    let xv15 = xv15();
    let whole_m2 = in_wake(&xv15, 0.0, Vec3::zero(), 17.0).area_m2;
    let mut before = in_wake(&xv15, 0.0, Vec3::zero(), 17.0);
    let mut gone_kt = None;
    for tenth in 1..600 {
        let speed_mps = 0.1 * f64::from(tenth) * KT;
        let now = in_wake(&xv15, 0.0, Vec3::new(speed_mps, 0.0, 0.0), induced(speed_mps));
        assert!(now.area_m2 < before.area_m2 + 1e-3 * whole_m2, "{tenth} tenths of a knot");
        assert!(before.area_m2 - now.area_m2 < 0.025 * whole_m2, "{tenth} tenths of a knot");
        if now.area_m2 <= 0.0 {
            gone_kt.get_or_insert(0.1 * f64::from(tenth));
        }
        before = now;
    }
    println!("gone at {gone_kt:?} kt");
    assert!(gone_kt.is_some_and(|kt| (25.0..40.0).contains(&kt)), "{gone_kt:?}");
}

#[test]
fn sideways_the_lee_wing_loses_its_wake_and_the_other_is_covered_further_in() {
    let xv15 = xv15();
    let to = |right: f64| in_wake(&xv15, 0.0, Vec3::new(0.0, right * KT, 0.0), 15.0);
    let (away, still, towards) = (to(-20.0), to(0.0), to(20.0));
    assert!(away.area_m2 < still.area_m2 && still.area_m2 < towards.area_m2);
    assert!(towards.centroid_from_cg_m.y < away.centroid_from_cg_m.y);
}

/// A tractor's slipstream: the wing's outer two thirds, whatever the speed.
#[test]
fn as_an_aeroplane_the_wing_stands_in_the_slipstream() {
    let xv15 = xv15();
    for (speed_kt, v) in [(100.0, 1.5), (250.0, 0.5)] {
        let cruise = Vec3::new(speed_kt * KT, 0.0, 0.03 * speed_kt * KT);
        let part = in_wake(&xv15, 90.0 * DEG, cruise, v).area_m2 / (0.5 * xv15.wing_pylon.area_m2);
        assert!((0.55..0.75).contains(&part), "{speed_kt} kt: {part}");
    }
}
