//! Moments, sizes and errors as they are written for people, everywhere in the same way.

use std::error::Error;

use engine::STEP_S;

/// Size of a decimal prefix's step.
const THOUSAND: f64 = 1000.0;

/// `tick 5 (0.020 s)`.
pub fn at(tick: u64) -> String {
    format!("tick {tick} ({:.3} s)", tick as f64 * STEP_S)
}

/// A size in decimal units: `832 B`, `46.1 kB`, `47.0 MB`.
pub fn size(bytes: u64) -> String {
    let (mut number, mut unit) = (bytes as f64, "B");
    for larger in ["kB", "MB", "GB", "TB"] {
        // What would be written as 1000.0 is 1.0 of the next one.
        if number < THOUSAND - 0.05 {
            break;
        }
        (number, unit) = (number / THOUSAND, larger);
    }
    if unit == "B" { format!("{bytes} B") } else { format!("{number:.1} {unit}") }
}

/// An error in words, with all that led to it.
pub fn with_causes(error: &dyn Error) -> String {
    let mut words = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        let cause_words = cause.to_string();
        // Some errors name their cause themselves.
        if !words.contains(&cause_words) {
            words = format!("{words}: {cause_words}");
        }
        source = cause.source();
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_has_its_time_beside_it() {
        assert_eq!(at(5), "tick 5 (0.020 s)");
    }

    #[test]
    fn a_size_is_written_in_the_largest_unit_of_which_it_has_one() {
        let cases = [
            (0, "0 B"),
            (999, "999 B"),
            (1_000, "1.0 kB"),
            (46_116, "46.1 kB"),
            (999_949, "999.9 kB"),
            (999_951, "1.0 MB"),
            (46_116_600, "46.1 MB"),
            (46_116_600_000, "46.1 GB"),
            (u64::MAX, "18446744.1 TB"),
        ];
        for (bytes, written) in cases {
            assert_eq!(size(bytes), written);
        }
    }
}
