//! What differs from system to system, and nothing else: the clock that the loop sleeps by, what a thread
//! may claim, the signals that end a flight, named pipes.
//!
//! Each system has a file here that offers the same functions; no other file asks which system it is,
//! but for the devices, which have a back end each.

#[cfg(target_os = "linux")]
mod linux;
#[cfg(not(target_os = "linux"))]
mod portable;
#[cfg(unix)]
mod unix;
#[cfg(not(unix))]
mod without_unix;

#[cfg(target_os = "linux")]
pub use linux::step_aside;
#[cfg(target_os = "linux")]
pub(crate) use linux::{claim_real_time, now_ns, sleep_until};
#[cfg(not(target_os = "linux"))]
pub use portable::step_aside;
#[cfg(not(target_os = "linux"))]
pub(crate) use portable::{claim_real_time, now_ns, sleep_until};
#[cfg(unix)]
pub use unix::open_pipe;
#[cfg(unix)]
pub(crate) use unix::{ENDING, is_ignored};
#[cfg(not(unix))]
pub use without_unix::open_pipe;
#[cfg(not(unix))]
pub(crate) use without_unix::{ENDING, is_ignored};
