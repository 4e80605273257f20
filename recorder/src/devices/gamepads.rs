//! Devices where there is no evdev: through gilrs, raw, before any filter.
//!
//! `gilrs-core` is the layer of gilrs that gives raw integers; the layer above drops small movements and
//! puts a dead zone in the middle of a throttle. It does not tell where an axis stands before it moves:
//! the first value of each counts as found out, and is picked up from there.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use engine::inputs::{DeviceEvent, EventKind};
use gilrs_core::{EvCode, EventType, Gamepad, Gilrs};

use super::found::{Axis, Found, Survey, kind};
use super::stream::{Stream, of_kind};

/// How long the thread waits before it looks whether it should end.
const WAIT: Duration = Duration::from_millis(50);

/// Here devices are read in their own time: nothing is asked for, and nothing refused.
pub fn claim_priority() -> Vec<String> {
    Vec::new()
}

/// All devices that gilrs finds.
pub fn survey() -> Survey {
    let found = Gilrs::new().map(|gilrs| all(&gilrs)).unwrap_or_default();
    Survey { found: found.into_iter().map(|(_, found)| found).collect(), ignored: Vec::new() }
}

fn all(gilrs: &Gilrs) -> Vec<(usize, Found)> {
    let ids = 0..gilrs.last_gamepad_hint();
    let pads = ids.filter_map(|id| Some((id, gilrs.gamepad(id)?)));
    pads.filter(|(_, pad)| pad.is_connected()).map(|(id, pad)| (id, found(id, pad))).collect()
}

fn found(id: usize, pad: &Gamepad) -> Found {
    let axis = |code: &EvCode| {
        let info = pad.axis_info(*code)?;
        let (raw_min, raw_max) = (i64::from(info.min), i64::from(info.max));
        Some(Axis { code: number(*code), raw_min, raw_max, value: None })
    };
    let axes: Vec<Axis> = pad.axes().iter().filter_map(axis).collect();
    let keys: Vec<u64> = pad.buttons().iter().map(|code| number(*code)).collect();
    Found {
        node: id.to_string(),
        name: pad.name().to_string(),
        vendor: pad.vendor_id().map_or(0, u64::from),
        product: pad.product_id().map_or(0, u64::from),
        port: id.to_string(),
        kind: kind(&axes, &keys, false, false, false),
        axes,
        keys,
        ..Found::default()
    }
}

fn number(code: EvCode) -> u64 {
    u64::from(code.into_u32() & 0xffff)
}

/// The thread's end.
pub struct Reader {
    gilrs: Gilrs,
    stream: Stream,
    /// Number in the map of each of gilrs' ids.
    numbers: Vec<Option<usize>>,
    /// Axes that have told where they stand, by id.
    told: Vec<Vec<u64>>,
}

impl Reader {
    /// Takes up the devices with their numbers; nothing where gilrs cannot start.
    pub fn new(mut stream: Stream, numbers: &[(usize, Found)]) -> Option<Self> {
        let gilrs = Gilrs::new().ok()?;
        let mut of_ids = Vec::new();
        for (id, found) in all(&gilrs) {
            let Some((number, _)) = numbers.iter().find(|(_, known)| *known == found) else {
                continue;
            };
            stream.plug_in(*number, &found);
            of_ids.resize(of_ids.len().max(id + 1), None);
            of_ids[id] = Some(*number);
        }
        Some(Self { gilrs, stream, numbers: of_ids, told: Vec::new() })
    }

    /// Reads until it is to end.
    pub fn run(mut self, stop: &AtomicBool) {
        while !stop.load(Ordering::Relaxed) {
            // It may come back without an event before the time is up.
            if let Some(event) = self.gilrs.next_event_blocking(Some(WAIT)) {
                self.take(&event);
            }
        }
    }

    fn take(&mut self, event: &gilrs_core::Event) {
        let id = event.id;
        let slots = self.numbers.len().max(id + 1);
        self.numbers.resize(slots, None);
        self.told.resize(slots, Vec::new());
        let Some(number) = self.numbers[id] else {
            if matches!(event.event, EventType::Connected)
                && let Some(pad) = self.gilrs.gamepad(id)
            {
                self.numbers[id] = self.stream.take_up(&found(id, pad));
            }
            return;
        };
        let button = |code, value| DeviceEvent {
            code: self::number(code),
            value,
            ..of_kind(EventKind::Button)
        };
        let said = match event.event {
            EventType::AxisValueChanged(value, axis) => self.axis(id, i64::from(value), axis),
            EventType::ButtonPressed(pressed) => button(pressed, 1),
            EventType::ButtonReleased(released) => button(released, 0),
            EventType::Disconnected => {
                self.stream.unplug(number);
                self.numbers[id] = None;
                self.told[id].clear();
                return;
            }
            _ => return,
        };
        self.stream.say(number, &said, event.time);
    }

    fn axis(&mut self, id: usize, value: i64, axis: EvCode) -> DeviceEvent {
        let code = number(axis);
        let range = self.gilrs.gamepad(id).and_then(|pad| pad.axis_info(axis));
        let is_first = !self.told[id].contains(&code);
        if is_first {
            self.told[id].push(code);
        }
        DeviceEvent {
            code,
            value,
            raw_min: range.map_or(0, |range| i64::from(range.min)),
            raw_max: range.map_or(0, |range| i64::from(range.max)),
            ..of_kind(if is_first { EventKind::AxisPosition } else { EventKind::Axis })
        }
    }
}
