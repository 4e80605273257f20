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
