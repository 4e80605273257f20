//! Keeping time: a tick every 4 ms by the monotonic clock, as punctually as the system allows.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use engine::STEP_NS;

pub(crate) use crate::platform::now_ns;
use crate::platform::sleep_until;

/// Sleeps until this long before a tick is due, and spins for the rest.
const SPIN_NS: u64 = 200_000;

/// Wall clock, ns since the Unix epoch.
pub fn wall_ns() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_nanos()).unwrap_or(u64::MAX)
}

/// Later than this, and the clock is anchored anew, ns: nothing is flown in a burst on stale hands.
pub const SLIP_LIMIT_NS: u64 = 100_000_000;

/// How a flight keeps time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RealTime {
    /// Later than this, and the clock is anchored anew, ns.
    pub slip_limit_ns: u64,
    /// The loop sleeps until this long before a tick is due, and spins for the rest, ns.
    pub spin_ns: u64,
    /// The processor on which the loop stays; wherever the system puts it without.
    pub cpu: Option<usize>,
}

impl Default for RealTime {
    fn default() -> Self {
        Self { slip_limit_ns: SLIP_LIMIT_NS, spin_ns: SPIN_NS, cpu: None }
    }
}

/// When the ticks are due.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    start_ns: u64,
    step_ns: u64,
    slip_limit_ns: u64,
    spin_ns: u64,
}

/// How waiting for a tick ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Woken {
    /// When, by the monotonic clock.
    pub at_ns: u64,
    /// By how much the clock was anchored anew; 0 when it was not.
    pub slip_ns: u64,
}

impl Pace {
    /// Real time; tick 0 is due now.
    pub fn starting_now() -> Self {
        Self::keeping(&RealTime::default())
    }

    /// The same as punctually as is wanted.
    pub fn keeping(wanted: &RealTime) -> Self {
        let RealTime { slip_limit_ns, spin_ns, .. } = *wanted;
        Self { start_ns: now_ns(), step_ns: STEP_NS, slip_limit_ns, spin_ns }
    }

    /// So many times faster than real time; tick 0 is due now.
    pub fn at_speed(speed: f64) -> Self {
        Self { step_ns: (STEP_NS as f64 / speed).round() as u64, ..Self::starting_now() }
    }

    /// When a tick is due.
    pub fn due_ns(&self, tick: u64) -> u64 {
        self.start_ns + tick * self.step_ns
    }

    /// Waits until the tick is due. A late tick does not wait; one that is later than the limit is due
    /// now, and so are those after it in their turn: the process was stopped, or the machine paused.
    pub fn wait(&mut self, tick: u64) -> Woken {
        let due_ns = self.due_ns(tick);
        let sleep_ns = due_ns.saturating_sub(self.spin_ns);
        if now_ns() < sleep_ns {
            // Woken early by a signal: the spin takes the rest, and the loop looks at its flag.
            sleep_until(sleep_ns);
        }
        loop {
            let at_ns = now_ns();
            if at_ns >= due_ns {
                return Woken { at_ns, slip_ns: self.slip(at_ns - due_ns) };
            }
            std::hint::spin_loop();
        }
    }

    /// Anchors the clock anew if the tick is too late; returns by how much.
    fn slip(&mut self, late_ns: u64) -> u64 {
        let slip_ns = if late_ns > self.slip_limit_ns { late_ns } else { 0 };
        self.start_ns += slip_ns;
        slip_ns
    }
}

/// The time in which this process was awake, as its loop knows it: a gap between two beats that is
/// longer than the limit of a slip does not count.
#[derive(Debug, Default)]
pub struct Awake {
    beaten_ns: AtomicU64,
    awake_ns: AtomicU64,
}

impl Awake {
    /// The loop is awake now. Only one thread calls this.
    pub fn beat(&self, now_ns: u64) {
        let gap_ns = now_ns.saturating_sub(self.beaten_ns.load(Ordering::Relaxed));
        self.beaten_ns.store(now_ns, Ordering::Relaxed);
        if gap_ns <= SLIP_LIMIT_NS {
            self.awake_ns.fetch_add(gap_ns, Ordering::Relaxed);
        }
    }

    /// So long it has been awake, ns.
    pub fn ns(&self) -> u64 {
        self.awake_ns.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_is_never_early() {
        let mut pace = Pace::starting_now();
        for tick in 0..5 {
            assert!(pace.wait(tick).at_ns >= pace.due_ns(tick));
        }
    }

    #[test]
    fn a_tick_that_is_far_too_late_is_due_now_and_the_next_one_a_step_later() {
        let mut pace = Pace::starting_now();
        pace.start_ns -= 2_000_000_000;
        let woken = pace.wait(0);
        assert!(woken.slip_ns >= 2_000_000_000, "{woken:?}");
        assert_eq!(pace.due_ns(0), woken.at_ns);
        let next = pace.wait(1);
        assert_eq!(next.slip_ns, 0);
        assert!(next.at_ns >= woken.at_ns + STEP_NS);
    }

    #[test]
    fn a_tick_that_is_a_little_late_catches_up() {
        let mut pace = Pace::starting_now();
        pace.start_ns -= SLIP_LIMIT_NS / 2;
        let due_ns = pace.due_ns(0);
        assert_eq!(pace.wait(0).slip_ns, 0);
        assert_eq!(pace.due_ns(0), due_ns);
    }

    #[test]
    fn another_limit_of_a_slip_is_kept() {
        let wanted = RealTime { slip_limit_ns: 10 * SLIP_LIMIT_NS, ..RealTime::default() };
        let mut pace = Pace::keeping(&wanted);
        pace.start_ns -= 5 * SLIP_LIMIT_NS;
        assert_eq!(pace.wait(0).slip_ns, 0);
        pace.start_ns -= 6 * SLIP_LIMIT_NS;
        assert!(pace.wait(0).slip_ns > 0);
    }

    #[test]
    fn time_in_which_the_process_stood_still_is_not_time_awake() {
        let awake = Awake::default();
        let mut now_ns = 7_000_000_000;
        awake.beat(now_ns);
        for gap_ns in [STEP_NS, 2_000_000_000, STEP_NS] {
            now_ns += gap_ns;
            awake.beat(now_ns);
        }
        assert_eq!(awake.ns(), 2 * STEP_NS);
    }

    #[test]
    fn twice_as_fast_a_tick_is_due_after_half_the_time() {
        // A tick is 4 ms of flight.
        for (speed, step_ns) in
            [(1.0, 4_000_000), (2.0, 2_000_000), (0.5, 8_000_000), (3.0, 1_333_333)]
        {
            let pace = Pace::at_speed(speed);
            assert_eq!(pace.due_ns(10) - pace.due_ns(0), 10 * step_ns, "{speed}");
        }
    }
}
