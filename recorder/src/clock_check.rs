//! How punctually this machine wakes a loop, tried before a flight depends on it.

use std::thread;
use std::time::Duration;

use engine::STEP_NS;

use crate::clock::{Pace, RealTime};
use crate::platform::claim_real_time;
use crate::statistics::Durations;

/// Up to this late at p99.9 the machine holds real time well, ms.
const WELL_MS: f64 = 0.5;

/// What came of it.
#[derive(Clone, Debug)]
pub struct ClockCheck {
    /// From when a tick was due until it ran.
    pub late: Durations,
    /// What the system did not grant.
    pub refused: Vec<String>,
}

/// Waits for ticks as the loop does, on a thread of its own, and does nothing in them.
pub fn check_clock(wanted: RealTime, duration: Duration) -> ClockCheck {
    let ticks = duration.as_nanos() as u64 / STEP_NS;
    let check = thread::spawn(move || {
        let refused = claim_real_time(wanted.cpu);
        let mut late = Durations::new();
        let mut pace = Pace::keeping(&wanted);
        for tick in 0..ticks {
            let woken = pace.wait(tick);
            late.add((woken.at_ns - pace.due_ns(tick)) + woken.slip_ns);
        }
        ClockCheck { late, refused }
    });
    check.join().unwrap_or_else(|_| ClockCheck {
        late: Durations::new(),
        refused: vec!["the clock could not be tried".into()],
    })
}

impl ClockCheck {
    /// Whether a tick of 4 ms would have been missed.
    pub fn misses_ticks(&self) -> bool {
        self.late.longest_ms() > STEP_NS as f64 * 1e-6
    }

    /// In a line.
    pub fn verdict(&self) -> String {
        let (p999_ms, max_ms) = (self.late.percentile_ms(99.9), self.late.longest_ms());
        let late = format!("ticks up to {max_ms:.3} ms late when tried");
        let scheduling = if self.refused.is_empty() { "" } else { "; not all was granted" };
        if self.misses_ticks() {
            format!(
                "real time NOT HELD: {late}{scheduling}; `tiltrotor doctor` says what to change"
            )
        } else if p999_ms > WELL_MS {
            format!("real time held roughly: {late}{scheduling}; `tiltrotor doctor` says more")
        } else {
            format!("real time held: {late}{scheduling}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two thousand ticks that woke at once, but for as many as were late by that much.
    fn tried(late: u64, late_ms: f64, refused: &[&str]) -> ClockCheck {
        let mut durations = Durations::new();
        (0..2000 - late).for_each(|_| durations.add(1000));
        (0..late).for_each(|_| durations.add((late_ms * 1e6) as u64));
        let refused = refused.iter().map(ToString::to_string).collect();
        ClockCheck { late: durations, refused }
    }

    #[test]
    fn the_verdict_is_by_the_latest_of_all_and_by_one_of_a_thousand() {
        // Half a millisecond is well held, a tick of 4 ms is the limit.
        for (late, late_ms, words, misses) in [
            (3, 0.49, "real time held: ", false),
            (3, 0.51, "real time held roughly: ", false),
            // A single one is beyond p99.9.
            (1, 3.9, "real time held: ", false),
            (3, 3.9, "real time held roughly: ", false),
            (1, 4.1, "real time NOT HELD: ", true),
        ] {
            let check = tried(late, late_ms, &[]);
            let verdict = check.verdict();
            assert!(verdict.starts_with(words), "{late} by {late_ms} ms: {verdict}");
            assert_eq!(check.misses_ticks(), misses, "{late} by {late_ms} ms");
            assert!(!verdict.contains("not all was granted"), "{verdict}");
        }
        let refused = tried(0, 0.0, &["no real-time scheduling"]).verdict();
        assert!(refused.ends_with("late when tried; not all was granted"), "{refused}");
    }
}
