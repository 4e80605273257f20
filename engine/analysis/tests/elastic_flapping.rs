//! Each blade's own elastic flapping: the engine's rotor beside the full form solved once more, and what the cheaper form
//! would leave out.
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
//! The air is the engine's elements, asked station by station for a straight blade that has the slope and the velocity of
//! the curved one there. The cheaper form, which flew before, is a straight line from the hub and springs in series.
//! # Assumptions
//! Estimates: mass spread evenly over the blade, φ that of a cantilever under an even load, the first elastic frequency
//! 1.85 per rev at 458 rpm (as for the cheaper form's K_b), hub a flat ring.
//! Both forms are linearised about the same controls in steady flight; the inflow's states are in both.

mod elastic;

use analysis::trim::{Target, Trim, trim};
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

fn found_in(xv15: &Aircraft, flight: (&str, f64, f64, u64, u64)) -> Trim {
    let (_, nacelle_deg, speed_kt, flap_detent, rpm_select) = flight;
    let target = Target {
        mast_tilt_rad: (90.0 - nacelle_deg) * DEG,
        airspeed_mps: speed_kt * KT,
        flap_detent,
        rpm_select,
        ..Target::default()
    };
    trim(xv15, &target).unwrap_or_else(|failure| panic!("{failure}"))
}

fn rotor_in(xv15: &Aircraft, flight: (&str, f64, f64, u64, u64)) -> elastic::Rotor {
    elastic::Rotor::of(xv15, &found_in(xv15, flight))
}

/// Where the engine's rotor stands and how it answers, tick by tick, is the full form's, up to 100 rad/s: what is left
/// is the sums that stand for integrals here.
#[test]
fn the_engine_flies_the_full_form() {
    let xv15 = xv15();
    for flight in FLIGHTS {
        let rotor = rotor_in(&xv15, flight);
        let steady = rotor.steady(Form::Elastic);
        for (ours, engines) in [
            (steady.output(Output::Thrust), rotor.engine.thrust_n),
            (steady.output(Output::Torque), rotor.engine.torque_n_m),
            (steady.output(Output::TiltAft), rotor.engine.tilt_aft_rad),
            (steady.output(Output::TiltOutboard), rotor.engine.tilt_outboard_rad),
            (steady.output(Output::Coning), rotor.engine.coning_rad),
        ] {
            let off = (ours - engines).abs() / max(engines.abs(), 1e-2);
            assert!(off < 1e-5, "{}: {ours} {engines}", flight.0);
        }
        let (flown, ours) = (rotor.flown(), rotor.in_ticks(&steady));
        println!("{}: roots {:.1?} 1/s, rad/s", flight.0, flown.roots());
        let pitching_n_m = (flown.output(Output::Pitching), ours.output(Output::Pitching));
        assert!((pitching_n_m.0 - pitching_n_m.1).abs() < 0.1, "{}: {pitching_n_m:?}", flight.0);
        for (input, output) in RESPONSES {
            for omega_radps in [1.0, 5.0, 10.0, 20.0, 100.0] {
                let at = |ticks: &elastic::Ticks| ticks.response(input, output, omega_radps);
                let off = off_percent(at(&flown), at(&ours));
                println!("{}: {input:?} to {output:?}, {omega_radps} rad/s: {off:.5} %", flight.0);
                assert!(off < 1e-3, "{}: {input:?} to {output:?}, {omega_radps}", flight.0);
            }
        }
    }
}

/// How fast the tilt turns without air, rad/s, both ways round: Ω ± √(Ω² + λ), λ of S·v = λ·M·v.
fn turns(omega_radps: f64, [lambda, other]: [f64; 2]) -> [f64; 4] {
    let root = |lambda: f64| sqrt(omega_radps * omega_radps + lambda);
    let (one, two) = (root(lambda), root(other));
    [omega_radps + one, one - omega_radps, omega_radps + two, two - omega_radps]
}

fn assert_roots(found: &[(f64, f64)], wanted: &[f64]) {
    for wanted in wanted {
        let there = found.iter().any(|(re, im)| {
            (im.abs() - wanted).abs() < 1e-5 * wanted + 1e-6 && re.abs() < 1e-5 * wanted + 1e-4
        });
        assert!(there, "{wanted} rad/s is not in {found:?}");
    }
}

/// The engine's rotor without air: gimbal and elastic flapping, with and against the rotation, and coning at
/// √((K_q + Ω²·C_qq)/M_qq), which at 458 rpm is 1.85 per rev.
#[test]
fn without_air_the_rotor_swings_at_the_roots_of_its_equations() {
    let xv15 = xv15();
    let mut rotor = rotor_in(&xv15, FLIGHTS[0]);
    for rpm in [100.0, 458.0, 589.0] {
        rotor.in_vacuum(rpm * PI / 30.0);
        let roots = rotor.flown().roots();
        let turning = turns(rotor.omega_radps, rotor.cyclic_per_s2());
        println!("{rpm} rpm: tilt {turning:.2?}, coning {:.2} rad/s", rotor.coning_radps());
        assert_roots(&roots, &turning);
        assert_roots(&roots, &[rotor.coning_radps()]);
    }
    rotor.in_vacuum(458.0 * PI / 30.0);
    assert!((rotor.coning_radps() / (1.85 * rotor.omega_radps) - 1.0).abs() < 1e-6);
}

/// Blades too stiff to bend: the gimbal swings as a rigid disc with its hub, and the cone is the precone.
#[test]
fn blades_of_an_infinite_elastic_frequency_are_rigid() {
    let xv15 = xv15();
    // The controls of the XV-15 as it is.
    let found = found_in(&xv15, FLIGHTS[1]);
    let xv15 = xv15.with(|params| params.rotors.bending.frequency_radps = 2e4);
    let mut rotor = elastic::Rotor::of(&xv15, &found);
    rotor.straighten();
    let params = &xv15.rotors;
    let flown = rotor.flown();
    let bent = flown.output(Output::Coning) / params.flapping.precone_rad - 1.0;
    assert!(bent.abs() < 1e-4, "{bent}");
    rotor.in_vacuum(589.0 * PI / 30.0);
    let inertia_kg_m2 = params.flapping.blade_inertia_kg_m2 + params.hub_inertia_kg_m2() / 1.5;
    let lambda = params.flapping.hub_spring_n_m_per_rad / 1.5 / inertia_kg_m2;
    assert_roots(&rotor.flown().roots(), &turns(rotor.omega_radps, [lambda; 2]));
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
