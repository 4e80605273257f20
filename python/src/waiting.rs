//! Long work beside the interpreter: without its lock, and ended by Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// How often it is looked for Ctrl-C.
const LOOK: Duration = Duration::from_millis(50);

/// Does something on a thread of its own and waits for it; Ctrl-C ends the wait at once, and `stop`, which
/// the work sees, is set then.
pub fn wait<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(Arc<AtomicBool>) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&stop);
    let thread = thread::spawn(move || work(seen));
    // Most of what is asked for takes less than a look.
    let mut nap = Duration::from_micros(50);
    while !thread.is_finished() {
        py.detach(|| thread::sleep(nap));
        nap = (nap * 2).min(LOOK);
        if let Err(interrupt) = py.check_signals() {
            stop.store(true, Ordering::Relaxed);
            return Err(interrupt);
        }
    }
    thread.join().map_err(|_| super::errors::TiltrotorError::new_err("the work died of a fault of ours"))
}
