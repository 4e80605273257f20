//! Keeping time: a tick every 4 ms by the monotonic clock, as punctually as the system allows.

use engine::STEP_NS;
use rustix::thread::{ClockId as SleepClock, clock_nanosleep_absolute};
use rustix::time::{ClockId, Timespec, clock_gettime};

/// Sleeps until this long before a tick is due, and spins for the rest.
const SPIN_NS: u64 = 200_000;

/// Monotonic time, ns.
pub fn now_ns() -> u64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec.cast_unsigned() * 1_000_000_000 + now.tv_nsec.cast_unsigned()
}

/// Wall clock, ns since the Unix epoch.
pub fn wall_ns() -> u64 {
    let now = clock_gettime(ClockId::Realtime);
    now.tv_sec.cast_unsigned() * 1_000_000_000 + now.tv_nsec.cast_unsigned()
}

/// When the ticks are due.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    start_ns: u64,
    step_ns: u64,
}

impl Pace {
    /// Real time; tick 0 is due now.
    pub fn starting_now() -> Self {
        Self { start_ns: now_ns(), step_ns: STEP_NS }
    }

    /// So many times faster than real time; tick 0 is due now.
    pub fn at_speed(speed: f64) -> Self {
        Self { start_ns: now_ns(), step_ns: (STEP_NS as f64 / speed).round() as u64 }
    }

    /// When a tick is due.
    pub fn due_ns(&self, tick: u64) -> u64 {
        self.start_ns + tick * self.step_ns
    }

    /// Waits until the tick is due; returns when it woke up. A late tick does not wait.
    pub fn wait(&self, tick: u64) -> u64 {
        let due_ns = self.due_ns(tick);
        let sleep_ns = due_ns.saturating_sub(SPIN_NS);
        if now_ns() < sleep_ns {
            let until = Timespec {
                tv_sec: (sleep_ns / 1_000_000_000).cast_signed(),
                tv_nsec: (sleep_ns % 1_000_000_000).cast_signed(),
            };
            // Woken early by a signal: the spin takes the rest, and the loop looks at its flag.
            let _ = clock_nanosleep_absolute(SleepClock::Monotonic, &until);
        }
        loop {
            let now_ns = now_ns();
            if now_ns >= due_ns {
                return now_ns;
            }
            std::hint::spin_loop();
        }
    }
}

/// Asks for real-time scheduling of this thread and memory that is never paged out; returns what was
/// not granted, in words.
pub fn claim_real_time() -> Vec<String> {
    use thread_priority::unix::{
        RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy,
        thread_native_id,
    };
    use thread_priority::{ThreadPriority, ThreadPriorityValue};

    let mut refused = Vec::new();
    let fifo = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let priority = ThreadPriorityValue::try_from(40_u8).map(ThreadPriority::Crossplatform);
    let scheduled = priority.is_ok_and(|priority| {
        set_thread_priority_and_policy(thread_native_id(), priority, fifo).is_ok()
    });
    if !scheduled {
        refused.push(
            "no real-time scheduling (SCHED_FIFO): expect late ticks under load; \
             `ulimit -r 40` or CAP_SYS_NICE grants it"
                .to_string(),
        );
    }
    let all = rustix::mm::MlockAllFlags::CURRENT | rustix::mm::MlockAllFlags::FUTURE;
    if rustix::mm::mlockall(all).is_err() {
        refused.push(
            "memory not locked: a page fault may delay a tick; `ulimit -l unlimited` grants it"
                .to_string(),
        );
    }
    refused
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_is_never_early() {
        let pace = Pace::starting_now();
        for tick in 0..5 {
            assert!(pace.wait(tick) >= pace.due_ns(tick));
        }
    }
}
