//! Long work beside the interpreter: without its lock, and left by Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use replay::ReplayError;

use crate::errors::refused;

/// How often it is looked for Ctrl-C.
const LOOK: Duration = Duration::from_millis(50);

/// The first wait, twice as long each time: most of what is asked for takes less than a look.
const FIRST: Duration = Duration::from_micros(50);

/// After Ctrl-C, work that looks for it gets so long to stop: then nothing of it is left behind, and a second
/// attempt finds what the first one found.
const LEAVE: Duration = Duration::from_millis(50);

/// Work goes on as long as it is wanted.
///
/// # Errors
/// After Ctrl-C. Nobody reads the words.
pub fn wanted_still(stop: &AtomicBool) -> Result<(), ReplayError> {
    if stop.load(Ordering::Relaxed) {
        return Err(ReplayError::Refused("left by Ctrl-C".into()));
    }
    Ok(())
}

/// Does something on a thread of its own and waits for it. Ctrl-C ends the wait, and work that looks at the
/// flag that it is given stops too; other work, which only reads and computes, ends by itself.
pub fn wait<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&stop);
    let thread = thread::spawn(move || work(&seen));
    let mut nap = FIRST;
    while !thread.is_finished() {
        py.detach(|| thread::sleep(nap));
        nap = (nap * 2).min(LOOK);
        if let Err(interrupt) = py.check_signals() {
            stop.store(true, Ordering::Relaxed);
            let left = Instant::now();
            while !thread.is_finished() && left.elapsed() < LEAVE {
                py.detach(|| thread::sleep(FIRST));
            }
            return Err(interrupt);
        }
    }
    thread
        .join()
        .map_err(|_| refused("this is a fault of tiltrotor's: please report what you called"))
}
