//! Systems other than Linux: the standard library's clock and sleep, the highest priority of a thread.

use std::sync::LazyLock;
use std::thread;
use std::time::{Duration, Instant};

use thread_priority::{ThreadPriority, set_current_thread_priority};

/// Where the monotonic clock begins: it has no zero of its own here.
static BEGINNING: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Monotonic time, ns.
pub(crate) fn now_ns() -> u64 {
    // A year has 3e16 ns.
    u64::try_from(BEGINNING.elapsed().as_nanos()).unwrap_or(u64::MAX)
}

/// Sleeps until a moment of [`now_ns`], or a little longer.
pub(crate) fn sleep_until(until_ns: u64) {
    thread::sleep(Duration::from_nanos(until_ns.saturating_sub(now_ns())));
}

/// Has this thread stand behind the others of the flight.
pub fn step_aside() {
    // One that may not looks on as before.
    let _ = set_current_thread_priority(ThreadPriority::Min);
}

/// Asks for the highest priority that a thread may have; returns what was not granted, in words.
pub(crate) fn claim_real_time(cpu: Option<usize>) -> Vec<String> {
    let mut refused =
        vec!["memory is not locked on this system: a page fault may delay a tick".to_string()];
    if let Some(cpu) = cpu {
        refused.push(format!("the loop cannot be kept on processor {cpu} on this system"));
    }
    if set_current_thread_priority(ThreadPriority::Max).is_err() {
        refused.push("no high priority for the loop: expect late ticks under load".to_string());
    }
    refused
}
