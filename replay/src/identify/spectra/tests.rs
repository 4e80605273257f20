use engine::math::{exp, ln, sin};

use super::*;

const STEP_S: f64 = 0.004;

/// Three exponential sweeps from .3 to 20 rad/s, each coming to rest.
fn sweep() -> Vec<f64> {
    let (low, high, length_s) = (0.3, 20.0, 80.0);
    let growth = ln(high / low) / length_s;
    (0..75_000)
        .map(|i| {
            let t = (f64::from(i) * STEP_S) % 100.0;
            let fade = min(1.0, min(0.2 * t, 0.2 * max(0.0, length_s - t)));
            if t < length_s { fade * sin(low / growth * (exp(growth * t) - 1.0)) } else { 0.0 }
        })
        .collect()
}

/// ẍ = ω₀²·(u − x) − 2ζω₀·ẋ, exactly, for an input that is held through a step.
fn spring(input: &[f64], omega: f64, zeta: f64) -> Vec<f64> {
    let (decay, turn) = (zeta * omega, omega * sqrt(1.0 - zeta * zeta));
    let fade = exp(-decay * STEP_S);
    let (s, c) = (fade * sin(turn * STEP_S), fade * cos(turn * STEP_S));
    let (mut x, mut v) = (0.0, 0.0);
    let mut samples = Vec::with_capacity(input.len());
    for u in input {
        let off = x - u;
        (x, v) = (
            u + off * c + (v + decay * off) / turn * s,
            v * c - (decay * v + omega * omega * off) / turn * s,
        );
        samples.push(x);
    }
    samples
}

fn theory(at: f64, omega: f64, zeta: f64) -> Complex<f64> {
    let s = Complex::new(0.0, at);
    Complex::new(omega * omega, 0.0) / (s * s + s * 2.0 * zeta * omega + omega * omega)
}

#[test]
fn a_line_is_near_every_frequency_that_is_asked_for() {
    let signal = vec![0.0; 3000];
    for (segment_s, low_radps) in [(2.0, 0.3), (10.0, 0.3), (2.0, 5.0)] {
        let spectra = Spectra::of(&signal, &signal, STEP_S, segment_s, low_radps);
        let (least, most) = (0.009 * low_radps, 0.02 * low_radps);
        let spacing = spectra.spacing_radps;
        assert!(spacing <= most && (spacing >= least || segment_s > 5.0), "{spacing} rad/s");
        assert_eq!(spectra.xx.len(), spectra.xy.len());
    }
}

#[test]
fn a_swept_spring_has_the_textbooks_response() {
    let input = sweep();
    let output = spring(&input, 3.0, 0.3);
    let points = estimate(&input, &output, STEP_S, &Options::default()).unwrap();
    assert!(points.len() > 15, "{}", points.len());
    for point in points.iter().filter(|point| point.omega_radps > 0.4) {
        // The input is recorded after the tick through which it is held.
        let angle = -0.5 * STEP_S * point.omega_radps;
        let ours = point.response * Complex::new(engine::math::cos(angle), sin(angle));
        let off = ours / theory(point.omega_radps, 3.0, 0.3);
        let (db, deg) = (20.0 * ln(off.norm()) / ln(10.0), off.arg().to_degrees());
        assert!(point.coherence > 0.95, "{point:?}");
        assert!(db.abs() < 0.3 && deg.abs() < 2.0, "{point:?}: {db:.2} dB, {deg:.2} deg");
    }
}

#[test]
fn noise_takes_coherence_away_and_hardly_moves_the_response() {
    let input = sweep();
    let mut output = spring(&input, 3.0, 0.5);
    // Uniform noise of a linear congruence, as strong as the signal.
    let mut seed = 1_u64;
    for sample in &mut output {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        *sample += 8.0 * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5);
    }
    let points = estimate(&input, &output, STEP_S, &Options::default()).unwrap();
    let at = |omega: f64| {
        let off = |point: &&Point| (point.omega_radps - omega).abs();
        *points.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
    };
    assert!(at(1.0).coherence > 0.8 && at(11.0).coherence < 0.6, "{:?} {:?}", at(1.0), at(11.0));
    let off = at(1.0).response.norm() / theory(at(1.0).omega_radps, 3.0, 0.5).norm();
    assert!((off - 1.0).abs() < 4.0 * at(1.0).error + 0.03, "{off}");
}

#[test]
fn what_carries_no_response_is_refused_in_words() {
    let input = sweep();
    let refused = |input: &[f64], output: &[f64], options: &Options| {
        estimate(input, output, STEP_S, options).unwrap_err()
    };
    let wanted = Options { low_radps: Some(0.3), ..Options::default() };
    let short = refused(&input[..5000], &input[..5000], &wanted);
    assert!(matches!(short, Refusal::TooShort { .. }), "{short}");
    assert!(short.to_string().contains("20 s, and 0.30 rad/s takes 251 s"), "{short}");
    let still = vec![0.25; input.len()];
    assert_eq!(refused(&still, &input, &wanted), Refusal::InputStill);
    assert_eq!(refused(&input, &still, &wanted), Refusal::OutputStill);
    let above = Options { low_radps: Some(60.0), high_radps: 120.0, ..wanted };
    let unswept = refused(&input, &input, &above);
    assert!(matches!(unswept, Refusal::NotSwept { .. }), "{unswept}");
    let odd = Options { segment_s: Some(200.0), ..wanted };
    assert!(matches!(refused(&input, &input, &odd), Refusal::Segment { .. }));
    let turned = Options { low_radps: Some(20.0), ..wanted };
    assert!(matches!(refused(&input, &input, &turned), Refusal::Band { .. }));
    let mut hole = input.clone();
    hole[7] = f64::NAN;
    assert_eq!(refused(&hole, &input, &wanted), Refusal::NotFinite);
    assert!(matches!(refused(&[], &[], &Options::default()), Refusal::TooShort { .. }));
}
