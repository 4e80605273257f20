//! What both back ends do with what they read: events to the loop, identities to the log.

use std::sync::mpsc::Sender;
use std::thread;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use engine::cockpit::Params;
use engine::inputs::{DeviceEvent, EventKind};
use logs::devices::DeviceIdentity;
use rtrb::{Producer, PushError};

use super::check::clash;
use super::found::Found;
use super::matching;

/// Hands over events, and knows which device has which number.
pub struct Stream {
    to_loop: Producer<DeviceEvent>,
    to_log: Sender<DeviceIdentity>,
    map: Params,
    /// Numbers of the map that a device has, by the number.
    taken: Vec<bool>,
    /// Devices seen so far that the map does not have.
    pub unmapped: u64,
}

impl Stream {
    /// Nothing is read yet.
    pub fn new(
        to_loop: Producer<DeviceEvent>,
        to_log: Sender<DeviceIdentity>,
        map: Params,
        unmapped: u64,
    ) -> Self {
        let taken = vec![false; map.device.len()];
        Self { to_loop, to_log, map, taken, unmapped }
    }

    /// A device of the map has appeared: who it is and where everything stands.
    pub fn plug_in(&mut self, number: usize, found: &Found) {
        self.taken[number] = true;
        self.put(number, &of_kind(EventKind::Connected));
        for axis in &found.axes {
            let Some(value) = axis.value else { continue };
            let (raw_min, raw_max) = (axis.raw_min, axis.raw_max);
            let event = of_kind(EventKind::AxisPosition);
            self.put(number, &DeviceEvent { code: axis.code, value, raw_min, raw_max, ..event });
        }
        for &code in &found.pressed {
            let event = of_kind(EventKind::ButtonPosition);
            self.put(number, &DeviceEvent { code, value: 1, ..event });
        }
    }

    /// A device that appeared while it is read: its number if the map has it, which it is told then.
    pub fn take_up(&mut self, found: &Found) -> Option<usize> {
        let free = |number: usize| !self.taken[number] && !self.is_rivalled(number);
        let number = matching::number_of(&self.map, found, free);
        let identity = match number {
            Some(number) => found.identity(number as u64, true),
            None => {
                self.unmapped += 1;
                found.identity(self.unmapped - 1, false)
            }
        };
        // Nobody reads them when there is no log.
        let _ = self.to_log.send(identity);
        if let Some(number) = number {
            self.plug_in(number, found);
        }
        number
    }

    /// Whether a device that is there moves what the one of this number would.
    fn is_rivalled(&self, number: usize) -> bool {
        let firm =
            |number: usize| self.map.device[number].axis.iter().filter(|axis| !axis.fallback);
        let mut others = (0..self.taken.len()).filter(|&other| self.taken[other]).flat_map(firm);
        others.any(|other| firm(number).any(|axis| clash(axis, other)))
    }

    /// A device of the map has gone.
    pub fn unplug(&mut self, number: usize) {
        self.taken[number] = false;
        self.put(number, &of_kind(EventKind::Disconnected));
    }

    /// What the kernel said at a time.
    pub fn say(&mut self, number: usize, event: &DeviceEvent, time: SystemTime) {
        let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
        let kernel_time_ns = u64::try_from(since.as_nanos()).unwrap_or(0);
        self.put(number, &DeviceEvent { kernel_time_ns, ..*event });
    }

    /// What was found out and has no time of the kernel's.
    pub fn put(&mut self, number: usize, event: &DeviceEvent) {
        let mut event = DeviceEvent { device: number as u64, ..*event };
        // Full only if the loop stood still for many seconds: then wait, the kernel keeps the rest.
        while let Err(PushError::Full(back)) = self.to_loop.push(event) {
            event = back;
            if self.to_loop.is_abandoned() {
                return;
            }
            thread::sleep(Duration::from_millis(1));
        }
    }
}

/// An event of a kind, of which nothing else is known yet.
pub fn of_kind(kind: EventKind) -> DeviceEvent {
    DeviceEvent { kind: kind as u64, ..DeviceEvent::default() }
}
