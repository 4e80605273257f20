//! Linux: sleeping to an absolute time, SCHED_FIFO, locked memory.

use rustix::mm::{MlockAllFlags, mlockall};
use rustix::thread::{ClockId as SleepClock, CpuSet, clock_nanosleep_absolute, sched_setaffinity};
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

/// Keeps this thread on one processor.
fn stay_on(cpu: usize) -> Result<(), String> {
    let mut set = CpuSet::new();
    if cpu >= CpuSet::MAX_CPU {
        return Err(format!("processor {cpu}: there is none of that number"));
    }
    set.set(cpu);
    sched_setaffinity(None, &set).map_err(|error| {
        format!("the loop does not stay on processor {cpu} (the first is 0): {error}")
    })
}

/// By how much whoever looks on stands behind the rest of the flight, in the system's steps of niceness.
const ASIDE: i32 = 10;

/// Has this thread, and those that it starts, stand behind the others of the flight.
pub fn step_aside() {
    // One that may not looks on as before.
    let _ = rustix::process::setpriority_process(None, ASIDE);
}

/// Asks for real-time scheduling of this thread, memory that is never paged out, and the processor that
/// is asked for; returns what was not granted, in words.
pub(crate) fn claim_real_time(cpu: Option<usize>) -> Vec<String> {
    let mut refused: Vec<String> = cpu.into_iter().filter_map(|cpu| stay_on(cpu).err()).collect();
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
