//! Sticks, throttles, pedals and pads: what is there, which of it the cockpit map knows, and its events.
//!
//! A thread of its own waits for events and hands them to the loop, so that each has the kernel's time
//! and none waits for a tick. Nothing is filtered: what the kernel said is what is recorded.

mod check;
mod found;
#[cfg(not(target_os = "linux"))]
mod gamepads;
mod guide;
#[cfg(target_os = "linux")]
mod linux;
mod matching;
mod plan;
mod shipped;
mod stream;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};

use engine::inputs::DeviceEvent;
use logs::devices::DeviceIdentity;
use rtrb::{Consumer, RingBuffer};

pub use check::called;
pub use found::{Axis, Found, Ignored, Kind, Survey, Why};
pub use guide::Guide;
pub use plan::{Plan, PlanError, combined, missing, plan, why_not};
pub use shipped::{SHIPPED, Shipped, shipped};

#[cfg(not(target_os = "linux"))]
use gamepads as system;
#[cfg(target_os = "linux")]
use linux as system;

/// Events the ring holds: a fast stick sends a thousand a second.
const RING_EVENTS: usize = 16_384;

/// All devices that are there.
pub fn survey() -> Survey {
    system::survey()
}

/// Those of them that another program has taken for itself. Asking takes each for a moment.
#[cfg(target_os = "linux")]
pub fn taken(survey: &Survey) -> Vec<Ignored> {
    linux::taken(survey)
}

/// Those of them that another program has taken for itself: other systems do not tell.
#[cfg(not(target_os = "linux"))]
pub fn taken(_: &Survey) -> Vec<Ignored> {
    Vec::new()
}

/// Devices being read.
pub struct Devices {
    events: Consumer<DeviceEvent>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// Who is there, in the map or not, as the log tells it.
    pub found: Vec<DeviceIdentity>,
    /// Who comes later.
    pub later: Option<Receiver<DeviceIdentity>>,
    /// What the system did not grant.
    pub refused: Vec<String>,
}

impl Devices {
    /// Reads the devices of a plan. Where everything stands is told before this returns.
    pub fn start(plan: &Plan) -> Self {
        let (to_loop, events) = RingBuffer::new(RING_EVENTS);
        let (to_log, later) = mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stream =
            stream::Stream::new(to_loop, to_log, plan.map.clone(), plan.others.len() as u64);
        let (tell, told) = mpsc::channel();
        let (taken, others) = (plan.taken.clone(), plan.others.clone());
        let stopping = Arc::clone(&stop);
        // What reads lives and dies on the thread that reads it.
        let thread = thread::spawn(move || {
            let refused = system::claim_priority();
            if let Some(reader) = begin(stream, &taken, &others) {
                let _ = tell.send(refused);
                reader.run(&stopping);
            }
        });
        let refused = told.recv().unwrap_or_default();
        let mapped = plan.taken.iter().map(|(number, found)| found.identity(*number as u64, true));
        let others = plan.others.iter().enumerate();
        let others = others.map(|(at, found)| found.identity(at as u64, false));
        let found = mapped.chain(others).collect();
        Self { events, stop, thread: Some(thread), found, later: Some(later), refused }
    }

    /// Takes what came in since the tick before, so many events at most: what is left comes in the next
    /// tick, in its order.
    pub fn take(&mut self, tick: u64, events: &mut Vec<DeviceEvent>, most: usize) {
        for _ in 0..most {
            let Ok(event) = self.events.pop() else { return };
            events.push(DeviceEvent { tick, ..event });
        }
    }
}

#[cfg(target_os = "linux")]
fn begin(
    stream: stream::Stream,
    taken: &[(usize, Found)],
    others: &[Found],
) -> Option<linux::Reader> {
    Some(linux::Reader::new(stream, taken, others))
}

#[cfg(not(target_os = "linux"))]
fn begin(
    stream: stream::Stream,
    taken: &[(usize, Found)],
    _: &[Found],
) -> Option<gamepads::Reader> {
    gamepads::Reader::new(stream, taken)
}

impl Drop for Devices {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
