//! The rotor's wake on the wing: how much of it, where, and how it comes and goes.

use engine::Aircraft;
use engine::aero::wake_footprint::{Footprint, footprint};
use engine::aero::{local_flow, wing_pylon};
use engine::frames::{Body, Vec3};
use engine::motion::Motion;
use engine::table::axis::{FlapAngle, MastTilt};
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

/// Rolling and yawing moments of both halves by roll and yaw rate, as coefficients: l by p, l by r, n by p, n by r.
fn rate_derivatives(xv15: &Aircraft, flight: &wing_pylon::Inputs) -> [f64; 4] {
    let wing = &xv15.wing_pylon;
    let moment = |rate: Vec3<Body>| {
        let mut right = *flight;
        right.motion.angular_rate_radps = rate;
        let mut left = right;
        left.motion = right.motion.mirrored();
        let of = |half: &wing_pylon::Inputs| {
            let load = wing_pylon::evaluate(wing, half);
            load.free_stream + load.immersed
        };
        (of(&right) + of(&left).mirrored()).moment_n_m
    };
    let speed_mps = flight.motion.airspeed_mps.norm();
    let per_rate = 0.25
        * flight.motion.density_kg_per_m3
        * speed_mps
        * wing.area_m2
        * wing.span_m
        * wing.span_m;
    let rate_radps = 1e-3;
    let [by_roll, by_yaw] =
        [Vec3::new(rate_radps, 0.0, 0.0), Vec3::new(0.0, 0.0, rate_radps)].map(moment);
    [by_roll.x, by_yaw.x, by_roll.z, by_yaw.z].map(|n_m| n_m / (per_rate * rate_radps))
}

/// What the slipstream adds, in parts of how much faster its air is: strips' derivatives are up to
/// three times the published ones (Cnp −CL/6 for −.06 CL).
const SLIPSTREAM_TOLERANCE: f64 = 3.0;
/// The slipstream sways with the rates, and lift goes with it from one part's place to the other's.
const SWAY_TOLERANCE: f64 = 0.03;

/// Two thirds of the wing stand in the slipstream: its rate derivatives are the published ones of the
/// whole wing all the same, once.
#[test]
fn as_an_aeroplane_roll_and_yaw_are_damped_as_published_and_once() {
    let xv15 = xv15();
    for (speed_kt, v) in [(120.0, 0.8), (180.0, 0.5), (250.0, 0.4)] {
        let velocity = Vec3::new(speed_kt * KT, 0.0, 0.02 * speed_kt * KT);
        let mut cruise = inputs(&xv15, 90.0 * DEG, velocity, v);
        cruise.flap_rad = 0.0;
        let wing = &xv15.wing_pylon;
        assert!(footprint(wing, &cruise).area_m2 > 0.25 * wing.area_m2);
        let flap = engine::aero::polar::Flap::new(0.0);
        let cl = wing.lift.lift_at(cruise.mast.tilt_rad, flap, 0.0, cruise.alpha_rad);
        let cd0 = wing.drag_at_no_lift.at(MastTilt(cruise.mast.tilt_rad), FlapAngle(0.0));
        let published = [-0.774, 0.27 * cl, -0.06 * cl, -0.016 * cl * cl - 0.32 * cd0];
        let ours = rate_derivatives(&xv15, &cruise);
        let faster = xv15.rotor_wake.wing_factor * v / velocity.norm();
        println!("{speed_kt} kt: Clp, Clr, Cnp, Cnr {ours:.4?}, published {published:.4?}");
        for (ours, published) in ours.iter().zip(published) {
            let off = (ours - published).abs();
            let part = SLIPSTREAM_TOLERANCE * faster + SWAY_TOLERANCE;
            assert!(off < part * published.abs(), "{ours} {published}");
        }
    }
}

/// Without speed the coefficients have no air: the part in the wake is all that damps, and it does.
#[test]
fn in_hover_the_part_in_the_wake_damps_roll() {
    let xv15 = xv15();
    let rolling = |rate_radps: f64| {
        let mut hover = inputs(&xv15, 0.0, Vec3::zero(), 17.0);
        hover.motion.angular_rate_radps = Vec3::new(rate_radps, 0.0, 0.0);
        let half = wing_pylon::evaluate(&xv15.wing_pylon, &hover).immersed.moment_n_m.x;
        hover.motion.angular_rate_radps = Vec3::new(-rate_radps, 0.0, 0.0);
        half - wing_pylon::evaluate(&xv15.wing_pylon, &hover).immersed.moment_n_m.x
    };
    let part = in_wake(&xv15, 0.0, Vec3::zero(), 17.0);
    // Drag across the flow goes with the square of its speed: d(½ρV²·S·CD)/dp = ρ·V·S·CD·y, at y.
    let through_mps = xv15.rotor_wake.wing_factor * 17.0;
    let per_rate = engine::isa::DENSITY_SL_KG_PER_M3
        * through_mps
        * part.area_m2
        * 1.44
        * part.centroid_from_cg_m.y
        * part.centroid_from_cg_m.y;
    let ours = rolling(0.05) / (2.0 * 0.05);
    println!("{ours:.0} N m s/rad, closed form {:.0}", -per_rate);
    assert!((ours / -per_rate - 1.0).abs() < 0.1, "{ours} {per_rate}");
}
