//! The SCAS with the stick let go: automatic pitch trim through a conversion and back, heading hold, and
//! what is told of its limits.

use analysis::trim::{Target, trim};
use engine::fcc::scas::Saturation;
use engine::frames::Vec3;
use engine::math::{clamp, max, wrap_angle};
use engine::units::{DEGREE_RAD as DEG, FOOT_M as FT, INCH_M as IN, KNOT_MPS as KT};
use engine::{Aircraft, Inputs, STEP_S, State, step};

/// Speed that a let-go stick keeps, and what the SCAS may still add ten seconds after the nacelles stand.
const SPEED_TOLERANCE_MPS: f64 = 10.0 * KT;
const DEMAND_TOLERANCE_M: f64 = 0.1 * IN;

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

/// Steady flight with the SCAS on, the stick at rest where it is.
fn let_go(xv15: &Aircraft, target: &Target) -> State {
    let mut state = trim(xv15, target).unwrap_or_else(|failure| panic!("{failure}")).state;
    state.cockpit.force_trim.stick_aft_norm = state.cockpit.stick_aft_norm;
    state.cockpit.force_trim.stick_right_norm = state.cockpit.stick_right_norm;
    state.cockpit.force_trim.pedal_right_norm = state.cockpit.pedal_right_norm;
    state
}

/// The left hand: the lever holds the height, as in level conversions it does.
struct LeftHand {
    height_m: f64,
    lever_norm: f64,
}

impl LeftHand {
    fn lever(&mut self, state: &State) -> f64 {
        let plant = &state.plant;
        let off_m = self.height_m + plant.position_m.z;
        let off_mps = clamp(0.15 * off_m, -3.0, 3.0) + plant.velocity_mps.z;
        self.lever_norm = clamp(self.lever_norm + STEP_S * 0.004 * off_mps, 0.0, 1.0);
        clamp(self.lever_norm + 0.008 * off_mps, 0.0, 1.0)
    }
}

/// Nobody touches stick or pedals from 80 kt as a helicopter to an aeroplane and back.
#[test]
fn with_the_stick_let_go_a_conversion_and_back_keeps_the_held_speed_and_leaves_no_demand() {
    let xv15 = xv15();
    let (speed_mps, height_m) = (80.0 * KT, 600.0);
    let target = Target {
        airspeed_mps: speed_mps,
        altitude_m: height_m,
        flap_detent: 1,
        scas_on: 1,
        ..Target::default()
    };
    let mut state = let_go(&xv15, &target);
    let mut hand = LeftHand { height_m, lever_norm: state.cockpit.collective_norm };
    let (mut speed_off_mps, mut demand_m, mut fastest_mps, mut moved_s) = (0.0, 0.0, 0.0, 0.0);
    let (mut downmost_rad, mut height_off_m, mut demand_moving_m) = (0.0, 0.0, 0.0);
    for tick in 0..20_000_u64 {
        let time_s = tick as f64 * STEP_S;
        let tilt_rad = state.actuators.mast_tilt_rad.mean();
        state.cockpit.nacelle_aft_norm = match time_s {
            5.0..25.0 => -1.0,
            45.0.. if tilt_rad > 0.002 => 1.0,
            _ => 0.0,
        };
        state.cockpit.collective_norm = hand.lever(&state);
        let (next, seen) = step(&xv15, &state, &Inputs { events: &[], world: target.world });
        state = next;
        assert_eq!(seen.scas.trims, 1, "at {time_s} s");
        let held_mps = state.fcc.scas.held_airspeed_mps;
        speed_off_mps = max(speed_off_mps, (seen.airspeed_mps - held_mps).abs());
        fastest_mps = max(fastest_mps, held_mps);
        downmost_rad = max(downmost_rad, tilt_rad);
        height_off_m = max(height_off_m, (-seen.position_m.z - height_m).abs());
        if state.actuators.mast_tilt_rate_radps.mean().abs() > 1e-6 {
            moved_s = time_s;
            demand_moving_m = max(demand_moving_m, seen.scas.aft_m.abs());
        }
        if time_s > moved_s + 10.0 {
            demand_m = max(demand_m, seen.scas.aft_m.abs());
        }
    }
    println!(
        "speed off {:.1} kt, held up to {:.0} kt, demand {:.2} in, later {:.3} in, height off {:.0} m",
        speed_off_mps / KT,
        fastest_mps / KT,
        demand_moving_m / IN,
        demand_m / IN,
        height_off_m
    );
    assert!(downmost_rad > 89.9 * DEG && state.actuators.mast_tilt_rad.mean() < 0.2 * DEG);
    assert!((130.0 * KT..145.0 * KT).contains(&fastest_mps));
    assert!(speed_off_mps < SPEED_TOLERANCE_MPS, "{} kt", speed_off_mps / KT);
    assert!((state.fcc.scas.held_airspeed_mps - speed_mps).abs() < 0.1 * KT);
    assert!(demand_moving_m > 2.0 * DEMAND_TOLERANCE_M, "nothing was asked of it");
    assert!(demand_m < DEMAND_TOLERANCE_M, "{} in", demand_m / IN);
}

/// Without it the same flight is lost: what the test above shows is the trim's doing.
#[test]
fn without_the_trims_authority_the_same_conversion_is_lost() {
    let xv15 = xv15().with(|params| params.fcc.scas.pitch_trim.attitude_gain_m_per_rad = 0.0);
    let target = Target {
        airspeed_mps: 80.0 * KT,
        altitude_m: 600.0,
        flap_detent: 1,
        scas_on: 1,
        ..Target::default()
    };
    let mut state = let_go(&xv15, &target);
    let mut hand = LeftHand { height_m: 600.0, lever_norm: state.cockpit.collective_norm };
    let mut speed_off_mps = 0.0;
    for tick in 0..7_500 {
        state.cockpit.nacelle_aft_norm = if tick > 1_250 { -1.0 } else { 0.0 };
        state.cockpit.collective_norm = hand.lever(&state);
        state = step(&xv15, &state, &Inputs { events: &[], world: target.world }).0;
        let airspeed_mps = state.plant.velocity_mps.norm();
        speed_off_mps = max(speed_off_mps, (airspeed_mps - state.fcc.scas.held_airspeed_mps).abs());
    }
    assert!(speed_off_mps > 2.0 * SPEED_TOLERANCE_MPS, "{} kt", speed_off_mps / KT);
}

/// A stick that is held out of its detent is the pilot's: the trim stands, and the speed is his.
#[test]
fn a_stick_that_is_held_is_not_trimmed() {
    let xv15 = xv15();
    let target = Target { airspeed_mps: 80.0 * KT, scas_on: 1, ..Target::default() };
    let mut state = let_go(&xv15, &target);
    state.cockpit.force_trim.stick_aft_norm += 0.3 * IN / xv15.fcc.travel.longitudinal_stick_m;
    for _ in 0..2_500 {
        let (next, seen) = step(&xv15, &state, &Inputs { events: &[], world: target.world });
        state = next;
        assert_eq!((seen.scas.trims, seen.scas.trim_aft_m.to_bits()), (0, 0));
    }
}

/// Turned by a gust from the side, the nose comes back; without the hold it stays where it was left.
#[test]
fn the_heading_is_held_in_hover_against_a_gust() {
    let heading_off_rad = |gain: f64| {
        let xv15 = xv15().with(|params| params.fcc.scas.yaw.attitude_gain_m_per_rad *= gain);
        let target = Target { scas_on: 1, altitude_m: 300.0 * FT, ..Target::default() };
        let mut state = let_go(&xv15, &target);
        let heading_rad = state.plant.attitude.euler().heading_rad;
        let mut world = target.world;
        for tick in 0..5_000 {
            world.wind_mps = if tick < 750 { Vec3::new(0.0, -6.0, 0.0) } else { Vec3::zero() };
            state = step(&xv15, &state, &Inputs { events: &[], world }).0;
        }
        wrap_angle(state.plant.attitude.euler().heading_rad - heading_rad).abs()
    };
    let (held_rad, free_rad) = (heading_off_rad(1.0), heading_off_rad(0.0));
    println!("{:.2} deg held, {:.2} deg free", held_rad / DEG, free_rad / DEG);
    assert!(held_rad < 0.5 * free_rad && held_rad < 1.0 * DEG, "{held_rad} {free_rad}");
}

/// A kick in yaw that asks for more than the axis has is told, and it alone.
#[test]
fn an_axis_at_the_end_of_its_authority_is_told() {
    let xv15 = xv15();
    let target = Target { scas_on: 1, ..Target::default() };
    let state = let_go(&xv15, &target);
    let scas =
        |state: &State| step(&xv15, state, &Inputs { events: &[], world: target.world }).1.scas;
    assert_eq!(scas(&state).saturated, Saturation::empty());
    let mut kicked = state;
    kicked.plant.angular_rate_radps.z = 0.2;
    let told = scas(&kicked);
    assert_eq!(told.saturated, Saturation::YAW);
    assert!((told.pedal_right_m.abs() - xv15.fcc.scas.yaw.authority_m).abs() < 1e-12);
}
