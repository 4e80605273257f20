//! From values to places, and the values at which an axis has ticks.

use engine::math::{ln, max, min};

/// Steps that an axis counts in, times a power of ten.
const STEPS: [f64; 4] = [1.0, 2.0, 5.0, 10.0];
/// Ratio of a tick that is taken to be on the end of the axis all the same.
const NEAR: f64 = 1e-9;
/// Less than this is nothing.
const LEAST: f64 = 1e-30;

/// An axis: values from `low` to `high` lie from `from` to `to`, in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// First value.
    pub low: f64,
    /// Last value.
    pub high: f64,
    /// Place of the first one.
    pub from: f64,
    /// Place of the last one.
    pub to: f64,
    /// Whether it counts in powers of ten.
    pub logarithmic: bool,
}

/// A tick: its value, and how it is written.
pub type Tick = (f64, String);

impl Scale {
    /// Where a value lies.
    pub fn at(&self, value: f64) -> f64 {
        let part = if self.logarithmic {
            (log10(max(value, self.low)) - log10(self.low)) / (log10(self.high) - log10(self.low))
        } else {
            (value - self.low) / (self.high - self.low)
        };
        self.from + part * (self.to - self.from)
    }

    /// Ticks, about `count` of them.
    pub fn ticks(&self, count: f64) -> Vec<Tick> {
        if self.logarithmic {
            let (low, high) = (log10(self.low).ceil() as i32, log10(self.high).floor() as i32);
            return (low..=high).map(|power| (ten_to(power), written_power(power))).collect();
        }
        self.ticks_every(step(self.high - self.low, count))
    }

    /// Ticks a step apart.
    pub fn ticks_every(&self, step: f64) -> Vec<Tick> {
        let slack = NEAR * step;
        let (first, last) = (
            ((self.low - slack) / step).ceil() as i64,
            ((self.high + slack) / step).floor() as i64,
        );
        (first..=last).map(|n| n as f64 * step).map(|value| (value, written(value, step))).collect()
    }
}

/// Whole decades around a range of positive values.
pub fn decades(low: f64, high: f64) -> (f64, f64) {
    let (low, high) = (log10(low).floor() as i32, log10(high).ceil() as i32);
    (ten_to(low), ten_to(high.max(low + 1)))
}

/// The range, widened to whole steps, and to `least` where it is less. What is never negative does not become
/// it.
pub fn widened(low: f64, high: f64, least: f64, count: f64) -> (f64, f64) {
    let lacking = max(least - (high - low), 0.0);
    let lower = if low >= 0.0 { min(0.5 * lacking, low) } else { 0.5 * lacking };
    let (low, high) = (low - lower, high + lacking - lower);
    let step = step(high - low, count);
    (((low + NEAR * step) / step).floor() * step, ((high - NEAR * step) / step).ceil() * step)
}

fn step(range: f64, count: f64) -> f64 {
    let wanted = max(range / count, LEAST);
    let power = ten_to(log10(wanted).floor() as i32);
    let found = STEPS.into_iter().find(|step| step * power >= wanted * (1.0 - NEAR));
    found.unwrap_or(10.0) * power
}

/// A value to the digits that its step needs.
fn written(value: f64, step: f64) -> String {
    let decimals = max(-log10(step).floor(), 0.0) as usize;
    with_minus(format!("{value:.decimals$}"))
}

/// With the sign that is as wide as a plus, and without a sign before zero.
pub fn with_minus(number: String) -> String {
    match number.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.into(),
        Some(digits) => format!("−{digits}"),
        None => number,
    }
}

fn written_power(power: i32) -> String {
    let decimals = usize::try_from(-power).unwrap_or(0);
    format!("{:.decimals$}", ten_to(power))
}

/// Decimal logarithm; a power of ten has a whole one.
fn log10(value: f64) -> f64 {
    let found = ln(max(value, LEAST)) / std::f64::consts::LN_10;
    if (found - found.round()).abs() < NEAR { found.round() } else { found }
}

fn ten_to(power: i32) -> f64 {
    let product = (0..power.unsigned_abs()).fold(1.0, |product, _| 10.0 * product);
    if power < 0 { 1.0 / product } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(low: f64, high: f64, count: f64) -> Vec<String> {
        let scale = Scale { low, high, from: 0.0, to: 100.0, logarithmic: false };
        scale.ticks(count).into_iter().map(|(_, words)| words).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(ticks(0.0, 218.0, 6.0), ["0", "50", "100", "150", "200"]);
        assert_eq!(ticks(-0.1, 0.1, 4.0), ["−0.10", "−0.05", "0.00", "0.05", "0.10"]);
        assert_eq!(ticks(-10.0, 10.0, 4.0), ["−10", "−5", "0", "5", "10"]);
    }

    #[test]
    fn a_range_is_widened_to_whole_steps_and_to_what_it_has_at_least() {
        let close =
            |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-9 && (b - d).abs() < 1e-9;
        assert!(close(widened(-3.2, 11.0, 0.0, 4.0), (-5.0, 15.0)));
        assert!(close(widened(5.0, 5.0, 10.0, 4.0), (0.0, 10.0)));
        assert!(close(widened(0.0, 2.0, 10.0, 4.0), (0.0, 10.0)), "never below nothing");
    }

    #[test]
    fn decades_hold_what_they_are_for() {
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        let (low, high) = decades(0.009, 150.0);
        assert!(close(low, 0.001) && close(high, 1000.0), "{low} {high}");
        let scale = Scale { low, high, from: 0.0, to: 6.0, logarithmic: true };
        assert!((scale.at(1.0) - 3.0).abs() < 1e-9);
        let words: Vec<_> = scale.ticks(0.0).into_iter().map(|(_, words)| words).collect();
        assert_eq!(words, ["0.001", "0.01", "0.1", "1", "10", "100", "1000"]);
    }
}
