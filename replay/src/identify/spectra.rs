//! Frequency response and coherence of two records.
//!
//! # Equations
//! ```text
//! X_k, Y_k          spectra of the k-th segment, less its mean, under a Hann taper
//! G_xx = Σ|X_k|²    G_yy = Σ|Y_k|²    G_xy = Σ X̄_k·Y_k
//! H    = G_xy/G_xx                                                   the response
//! γ²   = |G_xy|²/(G_xx·G_yy)                                        the coherence
//! ε    = √((1 − γ²)/(2·n_d·γ²))             random error of the gain, n_d = record/segment
//! ```
//! # Signs
//! Phase of the output before the input positive.
//! # Assumptions
//! The input is swept, or otherwise moves at every frequency of the band. At each frequency the shortest
//! segment of a ladder is taken that holds [`PERIODS`] of its periods, so that its resolution is a part of the
//! frequency and the averages are many where they can be: what Tischler combines of several segments, picked.
//! Segments overlap by three quarters.
//!
//! Below [`PERIODS`] of them resolution is coarse: a mode with little damping is smeared over what a segment
//! cannot tell apart, and the coherence falls where it is.
//!
//! What a feedback through the same input does (a pilot, a SCAS behind the measured stick) does not bias
//! H unless there is noise on the output: then H is pulled towards the inverse of the feedback.
//! # Source
//! Bendat, Piersol, *Random Data*, 4th ed.: spectra, coherence, random error. Tischler, Remple, *Aircraft and
//! Rotorcraft System Identification*, 2nd ed.: sweeps, segments of several lengths.

use engine::math::{PI, cos, max, min, sqrt};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Periods that a segment holds where the ladder has such a one.
pub const PERIODS: f64 = 12.0;
/// A segment holds no fewer periods of the lowest frequency.
const PERIODS_LEAST: f64 = 4.0;
/// And so many of the lowest that is taken where none is asked for: with fewer the taper smears a sharp mode,
/// which the coherence does not tell.
const PERIODS_OWN: f64 = 8.0;
/// Fewer segments than this, end to end, make no average.
const SEGMENTS_LEAST: f64 = 3.0;
/// Segments begin this part of their length apart.
const HOP: f64 = 0.25;
/// Samples in a period of the highest frequency after thinning out.
const SAMPLES_A_PERIOD: f64 = 8.0;
/// Part of the input's power in the band below which nothing was swept there.
const EXCITED_LEAST: f64 = 0.01;
/// At a frequency with less of the input than this part of its greatest, nothing is told.
const FLOOR: f64 = 1e-6;
/// A signal that moves less than this, of its own size, stands still.
const STILL: f64 = 1e-9;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Lowest frequency, rad/s; without, the lowest that the record's length carries.
    pub low_radps: Option<f64>,
    /// Highest frequency, rad/s.
    pub high_radps: f64,
    /// Frequencies in a decade.
    pub per_decade: f64,
    /// One segment for all frequencies, s, instead of the ladder.
    pub segment_s: Option<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Self { low_radps: None, high_radps: 12.0, per_decade: 12.0, segment_s: None }
    }
}

/// The response at a frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Frequency, rad/s.
    pub omega_radps: f64,
    /// Response, output unit over input unit.
    pub response: Complex<f64>,
    /// Coherence γ², 0 to 1.
    pub coherence: f64,
    /// Random error of the gain, a part of it.
    pub error: f64,
    /// The segment, s.
    pub segment_s: f64,
}

/// Why a record has no response.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// It does not carry the lowest frequency.
    #[error(
        "the record is too short: {have_s:.0} s, and {low_radps:.2} rad/s takes {needed_s:.0} s (three \
         segments of four periods); fly longer, or ask for a higher lowest frequency"
    )]
    TooShort {
        /// The record, s.
        have_s: f64,
        /// What it takes, s.
        needed_s: f64,
        /// The lowest frequency, rad/s.
        low_radps: f64,
    },
    /// The segment is too long for it, or too short for the band.
    #[error(
        "a segment of {segment_s:.1} s is not possible: the record of {have_s:.0} s and {low_radps:.2} rad/s \
         as the lowest frequency allow {least_s:.1} to {most_s:.1} s"
    )]
    Segment {
        /// As asked, s.
        segment_s: f64,
        /// The record, s.
        have_s: f64,
        /// The lowest frequency, rad/s.
        low_radps: f64,
        /// Shortest, s.
        least_s: f64,
        /// Longest, s.
        most_s: f64,
    },
    /// Nothing moves it.
    #[error("the input does not move in this part of the flight: there is no response to nothing")]
    InputStill,
    /// The output does not move.
    #[error("the output does not move in this part of the flight: the input does not reach it")]
    OutputStill,
    /// It moves, but not there.
    #[error(
        "the input is not swept between {low_radps:.2} and {high_radps:.2} rad/s: {percent:.2} % of its power \
         is there; fly a sweep (`tiltrotor fly --pilot sweep-pitch`), or ask for another band"
    )]
    NotSwept {
        /// Lowest, rad/s.
        low_radps: f64,
        /// Highest, rad/s.
        high_radps: f64,
        /// Of the input's power, per cent.
        percent: f64,
    },
    /// No band.
    #[error(
        "no band: {low_radps:.2} to {high_radps:.2} rad/s; the highest is at most {most_radps:.0} rad/s"
    )]
    Band {
        /// Lowest, rad/s.
        low_radps: f64,
        /// Highest, rad/s.
        high_radps: f64,
        /// The highest that there can be, rad/s.
        most_radps: f64,
    },
    /// A number is none.
    #[error("a recorded number is not finite: the flight is no record there")]
    NotFinite,
}

/// The response of the second record to the first, both sampled every `step_s`.
///
/// # Errors
/// When the record carries no response in the band; the message says what would.
pub fn estimate(
    input: &[f64],
    output: &[f64],
    step_s: f64,
    options: &Options,
) -> Result<Vec<Point>, Refusal> {
    if input.iter().chain(output).any(|number| !number.is_finite()) {
        return Err(Refusal::NotFinite);
    }
    let have_s = input.len().min(output.len()) as f64 * step_s;
    let longest_s = have_s / SEGMENTS_LEAST;
    let high_radps = options.high_radps;
    let low_radps = options
        .low_radps
        .unwrap_or_else(|| max(0.1, PERIODS_OWN * 2.0 * PI / max(longest_s, step_s)));
    let most_radps = PI / (4.0 * step_s);
    if options.low_radps.is_none() && low_radps >= high_radps {
        // Not even the highest frequency is carried.
        let needed_s = SEGMENTS_LEAST * PERIODS_LEAST * 2.0 * PI / high_radps;
        return Err(Refusal::TooShort { have_s, needed_s, low_radps: high_radps });
    }
    if !(low_radps > 0.0 && low_radps < high_radps && high_radps <= most_radps) {
        return Err(Refusal::Band { low_radps, high_radps, most_radps });
    }
    let least_s = PERIODS_LEAST * 2.0 * PI / low_radps;
    if longest_s < least_s {
        return Err(Refusal::TooShort { have_s, needed_s: SEGMENTS_LEAST * least_s, low_radps });
    }
    if is_still(input) {
        return Err(Refusal::InputStill);
    }
    if is_still(output) {
        return Err(Refusal::OutputStill);
    }
    let segments_s = match options.segment_s {
        Some(segment_s) if segment_s < least_s || segment_s > longest_s => {
            let most_s = longest_s;
            return Err(Refusal::Segment { segment_s, have_s, low_radps, least_s, most_s });
        }
        Some(segment_s) => vec![segment_s],
        None => ladder(longest_s, high_radps),
    };

    // Thinned out by means, which do the same to both and leave their quotient.
    let thin = (2.0 * PI / (SAMPLES_A_PERIOD * high_radps * step_s)).floor();
    let (input, output) = (thinned(input, thin as usize), thinned(output, thin as usize));
    let step_s = step_s * thin;
    let wanted = frequencies(low_radps, high_radps, options.per_decade);
    let picked = |omega: f64| {
        let enough = |segment_s: &&f64| **segment_s * omega >= PERIODS * 2.0 * PI;
        // From the longest to the shortest.
        segments_s.iter().rev().find(enough).copied().unwrap_or(segments_s[0])
    };
    let mut points = Vec::new();
    let mut share = (0.0, 0.0);
    for &segment_s in &segments_s {
        let spectra = Spectra::of(&input, &output, step_s, segment_s, low_radps);
        if points.is_empty() {
            share = spectra.share(low_radps, high_radps);
        }
        let own = wanted.iter().filter(|&&omega| picked(omega).total_cmp(&segment_s).is_eq());
        points.extend(own.map(|&omega| spectra.at(omega, have_s)));
    }
    let percent = 100.0 * share.0 / share.1;
    if percent < 100.0 * EXCITED_LEAST {
        return Err(Refusal::NotSwept { low_radps, high_radps, percent });
    }
    points.sort_by(|a, b| a.0.omega_radps.total_cmp(&b.0.omega_radps));
    points.dedup_by(|a, b| a.0.omega_radps.total_cmp(&b.0.omega_radps).is_eq());
    let most = points.iter().fold(0.0, |most, (_, power)| max(most, *power));
    Ok(points.into_iter().filter(|(_, power)| *power > FLOOR * most).map(|at| at.0).collect())
}

/// Whether a signal stays what it is.
fn is_still(signal: &[f64]) -> bool {
    let low = signal.iter().fold(f64::INFINITY, |a, &b| min(a, b));
    let high = signal.iter().fold(f64::NEG_INFINITY, |a, &b| max(a, b));
    high - low <= STILL * max(high.abs(), low.abs())
}

/// The longest segment, its half, and so on, as long as it holds enough of the highest frequency.
fn ladder(longest_s: f64, high_radps: f64) -> Vec<f64> {
    let mut segments_s = vec![longest_s];
    let mut next_s = 0.5 * longest_s;
    while next_s * high_radps > PERIODS * 2.0 * PI {
        segments_s.push(next_s);
        next_s *= 0.5;
    }
    segments_s
}

/// From the lowest to the highest, evenly in the logarithm.
fn frequencies(low_radps: f64, high_radps: f64, per_decade: f64) -> Vec<f64> {
    let decades = engine::math::ln(high_radps / low_radps) / core::f64::consts::LN_10;
    let steps = max(1.0, (decades * per_decade).round());
    let ratio = engine::math::ln(high_radps / low_radps) / steps;
    (0..=steps as u32).map(|i| low_radps * engine::math::exp(f64::from(i) * ratio)).collect()
}

/// The means of so many samples each.
fn thinned(signal: &[f64], by: usize) -> Vec<f64> {
    let by = by.max(1);
    signal.chunks_exact(by).map(|some| some.iter().sum::<f64>() / by as f64).collect()
}

/// Averaged spectra with one segment.
struct Spectra {
    segment_s: f64,
    /// Between two lines, rad/s.
    spacing_radps: f64,
    xx: Vec<f64>,
    yy: Vec<f64>,
    xy: Vec<Complex<f64>>,
}

impl Spectra {
    fn of(input: &[f64], output: &[f64], step_s: f64, segment_s: f64, low_radps: f64) -> Self {
        let length = ((segment_s / step_s).round() as usize).clamp(8, input.len());
        let hop = ((HOP * length as f64).round() as usize).max(1);
        // Zeros behind the segment bring a line near every frequency that is asked for.
        let fine = 2.0 * PI / (0.02 * low_radps * step_s);
        let size = length.max(fine as usize).next_power_of_two();
        let taper: Vec<f64> = (0..length)
            .map(|i| 0.5 * (1.0 - cos(2.0 * PI * (i as f64 + 0.5) / length as f64)))
            .collect();
        let fft = FftPlanner::new().plan_fft_forward(size);
        let lines = size / 2;
        let mut spectra = Self {
            segment_s,
            spacing_radps: 2.0 * PI / (size as f64 * step_s),
            xx: vec![0.0; lines],
            yy: vec![0.0; lines],
            xy: vec![Complex::new(0.0, 0.0); lines],
        };
        let tapered = |signal: &[f64]| {
            // The mean under the taper, so that nothing of it is left at low frequencies.
            let weight: f64 = taper.iter().sum();
            let mean = signal.iter().zip(&taper).map(|(s, w)| s * w).sum::<f64>() / weight;
            let mut line: Vec<_> =
                signal.iter().zip(&taper).map(|(s, w)| Complex::new((s - mean) * w, 0.0)).collect();
            line.resize(size, Complex::new(0.0, 0.0));
            fft.process(&mut line);
            line
        };
        for start in (0..=input.len() - length).step_by(hop) {
            let (x, y) =
                (tapered(&input[start..start + length]), tapered(&output[start..start + length]));
            for line in 0..lines {
                spectra.xx[line] += x[line].norm_sqr();
                spectra.yy[line] += y[line].norm_sqr();
                spectra.xy[line] += x[line].conj() * y[line];
            }
        }
        spectra
    }

    fn line(&self, omega: f64) -> usize {
        ((omega / self.spacing_radps).round() as usize).min(self.xx.len() - 1)
    }

    /// The input's power in a band, and in all.
    fn share(&self, low_radps: f64, high_radps: f64) -> (f64, f64) {
        let (low, high) = (self.line(low_radps), self.line(high_radps));
        (self.xx[low..=high].iter().sum(), self.xx.iter().sum())
    }

    /// The response at the line nearest to a frequency, and the input's power there.
    fn at(&self, omega: f64, record_s: f64) -> (Point, f64) {
        let line = self.line(omega);
        let (xx, yy, xy) = (self.xx[line], self.yy[line], self.xy[line]);
        let coherence = if xx * yy > 0.0 { min(1.0, xy.norm_sqr() / (xx * yy)) } else { 0.0 };
        let averages = record_s / self.segment_s;
        let error = sqrt((1.0 - coherence) / (2.0 * averages * max(coherence, 1e-12)));
        let response = if xx > 0.0 { xy / xx } else { Complex::new(0.0, 0.0) };
        let omega_radps = line as f64 * self.spacing_radps;
        let point = Point { omega_radps, response, coherence, error, segment_s: self.segment_s };
        // Per second of segment, so that those of different length compare.
        (point, xx / (self.segment_s * self.segment_s))
    }
}

#[cfg(test)]
mod tests;
