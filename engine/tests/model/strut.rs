//! A mass on the main struts is the damped oscillator of the textbook.

use engine::frames::{Attitude, Vec3};
use engine::landing_gear::{Inputs, Params, Strut, evaluate};
use engine::math::{cos, exp, sin, sqrt};
use engine::pair::Pair;
use engine::struts::Struts;
use engine::{GRAVITY_MPS2, STEP_S};

const MASS_KG: f64 = 5000.0;
/// Both struts together.
const STIFFNESS_N_PER_M: f64 = 350e3;
const DAMPING_N_S_PER_M: f64 = 15e3;

/// Mains under the centre of gravity, and no nose gear to speak of.
fn params() -> Params {
    let main = Strut {
        tyre_m: Vec3::new(0.0, 1.0, 0.0),
        stiffness_n_per_m: 0.5 * STIFFNESS_N_PER_M,
        damping_n_s_per_m: 0.5 * DAMPING_N_S_PER_M,
        stroke_m: 1.0,
        rolling_friction: 0.0,
        braking_friction: 0.0,
        sideways_friction: 0.0,
    };
    let nose = Strut { stiffness_n_per_m: 0.0, damping_n_s_per_m: 0.0, ..main.clone() };
    Params {
        nose,
        main,
        tyre_stiffness_n_per_m: 1.0,
        tyre_damping_n_s_per_m: 0.0,
        retraction_m: 0.0,
        contact_height_m: 0.0,
    }
}

/// Acceleration of the mass, down, with its centre `height_m` over the ground.
fn acceleration_mps2(params: &Params, height_m: f64, down_mps: f64) -> f64 {
    let inputs = Inputs {
        cg_m: Vec3::new(0.0, 0.0, 2.0),
        position_m: Vec3::new(0.0, 0.0, -height_m),
        velocity_mps: Vec3::new(0.0, 0.0, down_mps),
        angular_rate_radps: Vec3::zero(),
        ned_from_body: Attitude::default().ned_from_body(),
        ground_height_m: Struts::all(0.0),
        extension_norm: 1.0,
        brake_norm: Pair::both(0.0),
    };
    let (_, legs) = evaluate(params, &Struts::default(), &inputs);
    GRAVITY_MPS2 + legs.main.map(|leg| leg.load.force_n.z).sum() / MASS_KG
}

/// The step's own rule has an error of 5/12·(ωh)³ a tick, 5e-5·(1/30) of the swing here, for some
/// thirty ticks before the damping forgets them: a thousandth.
const TOLERANCE_M: f64 = 1e-3 * 0.1;

#[test]
fn a_mass_on_its_struts_swings_as_the_damped_oscillator_does() {
    let params = params();
    let sag_m = MASS_KG * GRAVITY_MPS2 / STIFFNESS_N_PER_M;
    let decay_per_s = 0.5 * DAMPING_N_S_PER_M / MASS_KG;
    let swing_radps = sqrt(STIFFNESS_N_PER_M / MASS_KG - decay_per_s * decay_per_s);
    // Let go a tenth of a metre below where it would rest.
    let (mut height_m, mut down_mps) = (2.0 - sag_m - 0.1, 0.0);
    let mut before = acceleration_mps2(&params, height_m, down_mps);
    for tick in 1..=1000 {
        // Integrated as in the step.
        let now = acceleration_mps2(&params, height_m, down_mps);
        let next_mps = down_mps + STEP_S * (1.5 * now - 0.5 * before);
        height_m -= 0.5 * STEP_S * (down_mps + next_mps);
        (before, down_mps) = (now, next_mps);

        let time_s = f64::from(tick) * STEP_S;
        let (s, c) = (sin(swing_radps * time_s), cos(swing_radps * time_s));
        let below_m = 0.1 * exp(-decay_per_s * time_s) * (c + decay_per_s / swing_radps * s);
        let analytic_m = 2.0 - sag_m - below_m;
        assert!(
            (height_m - analytic_m).abs() < TOLERANCE_M,
            "tick {tick}: {height_m} is not {analytic_m}"
        );
    }
}
