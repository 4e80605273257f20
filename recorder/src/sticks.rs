//! USB sticks through gilrs, raw: what the kernel says, before any filter.
//!
//! A thread of its own waits for events and hands them to the loop. `gilrs-core` is the layer of gilrs
//! that gives raw integers; the layer above drops small movements and puts a dead zone in the middle
//! of a throttle.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use engine::cockpit;
use engine::inputs::{DeviceEvent, EventKind};
use gilrs_core::{EventType, Gilrs};
use rtrb::{Consumer, Producer, RingBuffer};

/// Events the ring holds: a fast stick sends a thousand a second.
const RING_EVENTS: usize = 16_384;
/// How long the thread waits before it looks whether it should end.
const WAIT: Duration = Duration::from_millis(50);

/// Why there are no sticks.
#[derive(Debug, thiserror::Error)]
pub enum StickError {
    /// gilrs cannot start.
    #[error("cannot look for input devices: {0}")]
    Gilrs(String),
    /// Nothing is plugged in that the map knows.
    #[error("no stick found{seen}: plug one in, or fly with `--pilot hover`")]
    Nothing {
        /// What is plugged in instead.
        seen: String,
    },
    /// The thread died.
    #[error("the input thread died")]
    Thread,
}

/// Sticks being read.
pub struct Sticks {
    events: Consumer<DeviceEvent>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// What was found: number in the map, and the device's own name.
    pub found: Vec<(u64, String)>,
}

impl Sticks {
    /// Finds the map's devices, completes the map with the ranges that the devices tell, and starts
    /// reading them.
    ///
    /// # Errors
    /// When there is none.
    pub fn start(map: &mut cockpit::Params) -> Result<Self, StickError> {
        let (to_loop, events) = RingBuffer::new(RING_EVENTS);
        let stop = Arc::new(AtomicBool::new(false));
        let (tell, told) = std::sync::mpsc::channel();
        let known = map.clone();
        let stopping = Arc::clone(&stop);
        // gilrs lives and dies on the thread that reads it.
        let thread = thread::spawn(move || match Reader::new(known, to_loop) {
            Ok((mut reader, completed)) => {
                if tell.send(Ok((completed, reader.found()))).is_ok() {
                    reader.run(&stopping);
                }
            }
            Err(error) => {
                let _ = tell.send(Err(error));
            }
        });
        let (completed, found) = told.recv().map_err(|_| StickError::Thread)??;
        *map = completed;
        Ok(Self { events, stop, thread: Some(thread), found })
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

impl Drop for Sticks {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The thread's end.
struct Reader {
    gilrs: Gilrs,
    to_loop: Producer<DeviceEvent>,
    map: cockpit::Params,
    /// Number in the map of each of gilrs' ids.
    numbers: Vec<Option<u64>>,
}

impl Reader {
    fn new(
        map: cockpit::Params,
        to_loop: Producer<DeviceEvent>,
    ) -> Result<(Self, cockpit::Params), StickError> {
        let gilrs = Gilrs::new().map_err(|error| StickError::Gilrs(format!("{error:?}")))?;
        let mut reader = Self { gilrs, to_loop, map, numbers: Vec::new() };
        let ids = 0..reader.gilrs.last_gamepad_hint();
        for id in ids.clone() {
            reader.recognise(id);
        }
        if reader.numbers.iter().all(Option::is_none) {
            let names: Vec<_> = ids
                .filter_map(|id| reader.gilrs.gamepad(id))
                .map(gilrs_core::Gamepad::name)
                .collect();
            let seen = if names.is_empty() {
                String::new()
            } else {
                format!(" (the cockpit map does not know: {})", names.join(", "))
            };
            return Err(StickError::Nothing { seen });
        }
        let completed = reader.map.clone();
        Ok((reader, completed))
    }

    fn found(&self) -> Vec<(u64, String)> {
        let named = |(id, number): (usize, &Option<u64>)| {
            Some(((*number)?, self.gilrs.gamepad(id)?.name().to_string()))
        };
        self.numbers.iter().enumerate().filter_map(named).collect()
    }

    /// Finds the map's device of that name that nobody has taken, and completes its ranges.
    fn recognise(&mut self, id: usize) -> Option<u64> {
        if self.numbers.len() <= id {
            self.numbers.resize(id + 1, None);
        }
        let pad = self.gilrs.gamepad(id)?;
        let taken = &self.numbers;
        let (number, device) =
            self.map.device.iter_mut().enumerate().find(|(number, device)| {
                pad.name().contains(device.name.as_str()) && !taken.contains(&Some(*number as u64))
            })?;
        for code in pad.axes() {
            let Some(info) = pad.axis_info(*code) else { continue };
            let code = u64::from(code.into_u32() & 0xffff);
            for axis in device.axis.iter_mut().filter(|axis| axis.code == code) {
                axis.raw_min.get_or_insert(i64::from(info.min));
                axis.raw_max.get_or_insert(i64::from(info.max));
            }
        }
        self.numbers[id] = Some(number as u64);
        self.numbers[id]
    }

    fn run(&mut self, stop: &AtomicBool) {
        for number in self.numbers.clone().into_iter().flatten() {
            let event = DeviceEvent { device: number, ..of_kind(EventKind::Connected) };
            self.send(event, SystemTime::now());
        }
        while !stop.load(Ordering::Relaxed) {
            // It may come back without an event before the time is up.
            let Some(event) = self.gilrs.next_event_blocking(Some(WAIT)) else { continue };
            let number = match self.numbers.get(event.id).copied().flatten() {
                Some(number) => number,
                None => match self.recognise(event.id) {
                    Some(number) => number,
                    None => continue,
                },
            };
            let code = |code: gilrs_core::EvCode| u64::from(code.into_u32() & 0xffff);
            let button = |button, value| DeviceEvent {
                code: code(button),
                value,
                ..of_kind(EventKind::Button)
            };
            let said = match event.event {
                EventType::AxisValueChanged(value, axis) => {
                    let pad = self.gilrs.gamepad(event.id);
                    let range = pad.and_then(|pad| pad.axis_info(axis));
                    DeviceEvent {
                        code: code(axis),
                        value: i64::from(value),
                        raw_min: range.map_or(0, |range| i64::from(range.min)),
                        raw_max: range.map_or(0, |range| i64::from(range.max)),
                        ..of_kind(EventKind::Axis)
                    }
                }
                EventType::ButtonPressed(pressed) => button(pressed, 1),
                EventType::ButtonReleased(released) => button(released, 0),
                EventType::Connected => of_kind(EventKind::Connected),
                EventType::Disconnected => of_kind(EventKind::Disconnected),
                _ => continue,
            };
            self.send(DeviceEvent { device: number, ..said }, event.time);
        }
    }

    fn send(&mut self, event: DeviceEvent, time: SystemTime) {
        let kernel_time_ns = time
            .duration_since(UNIX_EPOCH)
            .map_or(0, |since| u64::try_from(since.as_nanos()).unwrap_or(0));
        let mut event = DeviceEvent { kernel_time_ns, ..event };
        // Full only if the loop stood still for many seconds: then wait, the kernel keeps the rest.
        while let Err(rtrb::PushError::Full(back)) = self.to_loop.push(event) {
            event = back;
            thread::sleep(Duration::from_millis(1));
            if self.to_loop.is_abandoned() {
                return;
            }
        }
    }
}

/// An event of a kind, of which nothing else is known yet.
fn of_kind(kind: EventKind) -> DeviceEvent {
    DeviceEvent { kind: kind as u64, ..DeviceEvent::default() }
}
