//! Linux: sleeping to an absolute time, SCHED_FIFO, locked memory.

use rustix::mm::{MlockAllFlags, mlockall};
use rustix::thread::{ClockId as SleepClock, clock_nanosleep_absolute};
use rustix::time::{ClockId, Timespec, clock_gettime};
use thread_priority::unix::{
    RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy,
    thread_native_id,
};
use thread_priority::{ThreadPriority, ThreadPriorityValue};

/// Monotonic time, ns.
pub(crate) fn now_ns() -> u64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec.cast_unsigned() * 1_000_000_000 + now.tv_nsec.cast_unsigned()
}

/// Sleeps until a moment of [`now_ns`]. A signal may wake it early.
pub(crate) fn sleep_until(until_ns: u64) {
    let until = Timespec {
        tv_sec: (until_ns / 1_000_000_000).cast_signed(),
        tv_nsec: (until_ns % 1_000_000_000).cast_signed(),
    };
    let _ = clock_nanosleep_absolute(SleepClock::Monotonic, &until);
}

/// Asks for real-time scheduling of this thread and memory that is never paged out; returns what was
/// not granted, in words.
pub(crate) fn claim_real_time() -> Vec<String> {
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
    if mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE).is_err() {
        refused.push(
            "memory not locked: a page fault may delay a tick; `ulimit -l unlimited` grants it"
                .to_string(),
        );
    }
    refused
}
