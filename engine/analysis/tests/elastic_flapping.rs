//! Each blade's own elastic flapping beside the form that flies: what the cheaper form leaves out.
//!
//! # Equations
//! The blade's displacement out of the hub plane is w = r·(β_p + γ) + φ(r)·q: the gimbal's tilt γ with the hub's
//! inertia, and the first elastic flapping of each blade with states of its own. Multiblade coordinates as in
//! `engine::rotors::flapping`, z = a1 + i·b1, w_γ = ż_γ + (q + i·p), w_q = ż_q:
//! ```text
//! (I_b + I_h/1.5)·(ẇ_γ − 2iΩ·w_γ) + M_γq·(ẇ_q − 2iΩ·w_q) + K_H/1.5·z_γ = −F_γ
//! M_γq·(ẇ_γ − 2iΩ·w_γ) + M_qq·(ẇ_q − 2iΩ·w_q) + (K_q + Ω²·(C_qq − M_qq))·z_q = −F_q
//! M_qq·q̈0 + (K_q + Ω²·C_qq)·q0 + Ω²·M_γq·β_p = F_q0
//! M = ∫m·φ_i·φ_j     C = ∫m·r·∫₀ʳφ_i'·φ_j'     F_i = ∫φ_i·dF_n     φ_γ = r
//! ```
//! The air is the engine's: its elements, station by station, each with the slope and the velocity that the curved
//! blade has there. Today's form is a straight line from the hub and springs in series.
//! # Assumptions
//! Estimates: mass spread evenly over the blade, φ that of a cantilever under an even load, the first elastic frequency
//! 1.85 per rev at 458 rpm (as for today's K_b), hub a flat ring of 10 slug ft² about its axis.
//! Both forms are linearised about the same controls in steady flight; the inflow's states are in both.

mod elastic;

use analysis::trim::{Target, trim};
use elastic::{Form, Input, Output, Steady};
use engine::Aircraft;
use engine::math::{PI, atan2, ln, max, sqrt};
use engine::units::KNOT_MPS as KT;

const DEG: f64 = PI / 180.0;
/// Where responses are compared, rad/s.
const FREQUENCIES_RADPS: [f64; 4] = [1.0, 5.0, 10.0, 20.0];

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

/// Name, nacelle angle, speed, flap detent, rotor speed selected.
const FLIGHTS: [(&str, f64, f64, u64, u64); 4] = [
    ("hover", 90.0, 0.0, 2, 0),
    ("90 deg, 40 kt", 90.0, 40.0, 2, 0),
    ("60 deg, 100 kt", 60.0, 100.0, 1, 0),
    ("0 deg, 180 kt", 0.0, 180.0, 0, 2),
];

fn rotor_in(xv15: &Aircraft, flight: (&str, f64, f64, u64, u64)) -> elastic::Rotor {
    let (_, nacelle_deg, speed_kt, flap_detent, rpm_select) = flight;
    let target = Target {
        mast_tilt_rad: (90.0 - nacelle_deg) * DEG,
        airspeed_mps: speed_kt * KT,
        flap_detent,
        rpm_select,
        ..Target::default()
    };
    let found = trim(xv15, &target).unwrap_or_else(|failure| panic!("{failure}"));
    elastic::Rotor::of(xv15, &found)
}

/// The form that flies, written once more, stands where the engine's own rotor stands.
#[test]
fn the_form_that_flies_is_the_engines() {
    let xv15 = xv15();
    for flight in FLIGHTS {
        let rotor = rotor_in(&xv15, flight);
        let steady = rotor.steady(Form::InSeries);
        for (ours, engines) in [
            (steady.output(Output::Thrust), rotor.engine.thrust_n),
            (steady.output(Output::Torque), rotor.engine.torque_n_m),
            (steady.output(Output::TiltAft), rotor.engine.tilt_aft_rad),
            (steady.output(Output::Coning), rotor.engine.coning_rad),
        ] {
            let off = (ours - engines).abs() / max(engines.abs(), 1e-3);
            assert!(off < 1e-5, "{}: {ours} {engines}", flight.0);
        }
    }
}

/// A rotor without air: the roots are those of the equations by hand. Coning: √((K_q + Ω²·C_qq)/M_qq).
#[test]
fn without_air_a_blade_swings_at_its_elastic_frequency() {
    let xv15 = xv15();
    let mut rotor = rotor_in(&xv15, FLIGHTS[0]);
    rotor.omega_radps = 458.0 * PI / 30.0;
    let wanted = 1.85 * rotor.omega_radps;
    let found = rotor.coning_radps();
    assert!((found / wanted - 1.0).abs() < 1e-9, "{found} {wanted}");
}

/// Size of a difference of two responses, % of the response.
fn off_percent(one: (f64, f64), other: (f64, f64)) -> f64 {
    let (re, im) = (other.0 - one.0, other.1 - one.1);
    100.0 * sqrt((re * re + im * im) / (one.0 * one.0 + one.1 * one.1))
}

/// What docs/model.md says of responses up to 20 rad/s: every one within this, % …
const RESPONSE_PERCENT: f64 = 1.0;
/// … but the small force along the disc that a pitch rate makes, within this.
const FORCE_BY_PITCH_RATE_PERCENT: f64 = 6.0;
/// What it says of steady flight: thrust and torque, %, tilt and coning, deg.
const STEADY_PERCENT: f64 = 0.5;
const STEADY_DEG: [f64; 2] = [0.06, 0.12];

/// What is asked.
const RESPONSES: [(Input, Output); 9] = [
    (Input::CyclicForward, Output::TiltAft),
    (Input::CyclicForward, Output::Forward),
    (Input::CyclicForward, Output::Pitching),
    (Input::Collective, Output::Thrust),
    (Input::Collective, Output::Torque),
    (Input::Collective, Output::Shear),
    (Input::PitchRate, Output::TiltAft),
    (Input::PitchRate, Output::Forward),
    (Input::PitchRate, Output::Pitching),
];

/// The comparison of docs/model.md: the table is what this prints, what its text says is asserted.
#[test]
fn what_the_cheaper_form_leaves_out() {
    let xv15 = xv15();
    for flight in FLIGHTS {
        let rotor = rotor_in(&xv15, flight);
        let (cheap, full) = (rotor.steady(Form::InSeries), rotor.steady(Form::Elastic));
        println!("{}", flight.0);
        let show = |what: &str, output: Output, unit: f64| {
            let (one, other) = (cheap.output(output) / unit, full.output(output) / unit);
            println!("  {what:22} {one:10.3} {other:10.3} {:+7.2} %", 100.0 * (other / one - 1.0));
            (other / one - 1.0, other - one)
        };
        for (what, output) in [("thrust, N", Output::Thrust), ("torque, N m", Output::Torque)] {
            let (part, _) = show(what, output, 1.0);
            assert!(100.0 * part.abs() < STEADY_PERCENT, "{}: {what}", flight.0);
        }
        for (what, output, most_deg) in [
            ("tip path aft, deg", Output::TiltAft, STEADY_DEG[0]),
            ("tip path outboard, deg", Output::TiltOutboard, STEADY_DEG[0]),
            ("coning, deg", Output::Coning, STEADY_DEG[1]),
        ] {
            let (_, off_deg) = show(what, output, DEG);
            assert!(off_deg.abs() < most_deg, "{}: {what}", flight.0);
        }
        show("force forward, N", Output::Forward, 1.0);
        show("hub moment, N m", Output::Pitching, 1.0);
        for (input, output) in RESPONSES {
            let row = FREQUENCIES_RADPS.map(|omega_radps| {
                let at = |steady: &Steady| steady.response(input, output, omega_radps);
                let (one, other) = (at(&cheap), at(&full));
                let gain = |of: (f64, f64)| {
                    10.0 * ln(of.0 * of.0 + of.1 * of.1) / core::f64::consts::LN_10
                };
                let phase = |of: (f64, f64)| atan2(of.1, of.0) / DEG;
                let turn = (phase(other) - phase(one) + 540.0).rem_euclid(360.0) - 180.0;
                (gain(other) - gain(one), turn, off_percent(one, other))
            });
            println!("  {input:?} to {output:?}: dB, deg, % {row:+.2?}");
            let worst = row.into_iter().fold(0.0, |most, (_, _, percent)| max(most, percent));
            let small = (input, output) == (Input::PitchRate, Output::Forward);
            let limit = if small { FORCE_BY_PITCH_RATE_PERCENT } else { RESPONSE_PERCENT };
            assert!(worst < limit, "{}: {input:?} to {output:?}, {worst} %", flight.0);
        }
    }
}
