//! FlightGear's own stick, keyboard and mouse as a device: raw events, recorded like those of any other.
//!
//! What is reported is held until the next report. Without one for half a second the device is gone:
//! everything but the power lever is let go, as the map says, until reports come again.

use std::sync::Arc;

use engine::inputs::{DeviceEvent, EventKind};
use engine::{Outputs, cockpit};
use flightgear::Receiver;
use flightgear::report::{Controls, PRESSES};

use crate::controller::{Controller, TickContext};

/// Its name in the map.
pub const DEVICE: &str = "FlightGear";
/// Full travel of an axis, raw.
const FULL: f64 = 32_767.0;
/// Without a report for so long, nobody is there: half a second.
const SILENT_TICKS: u64 = 125;
/// Presses of one button in one tick; more are a counter that began anew.
const PRESSES_A_TICK: i64 = 3;
/// Event codes of the axes, in the order of [`axes`], as in the map.
const AXES: [u64; 7] = [0, 1, 6, 7, 9, 10, 17];
/// Event code of the first of the buttons, which follow in the order of [`PRESSES`].
const BUTTONS: u64 = 0x122;

/// FlightGear's controls.
pub struct FlightGearControls {
    receiver: Arc<Receiver>,
    device: u64,
    /// Last ones; `None` while it is not there.
    held: Option<Held>,
    silent_ticks: u64,
}

#[derive(Clone, Copy)]
struct Held {
    axes: [i64; AXES.len()],
    presses: [i64; PRESSES.len()],
}

impl FlightGearControls {
    /// The device of that map; `None` when the map has none.
    pub fn new(receiver: Arc<Receiver>, map: &cockpit::Params) -> Option<Self> {
        let device = map.device.iter().position(|device| device.name == DEVICE)? as u64;
        Some(Self { receiver, device, held: None, silent_ticks: 0 })
    }

    /// One tick with a report, or without one.
    fn update(&mut self, controls: Option<&Controls>, context: &mut TickContext<'_>) {
        let Some(controls) = controls else {
            self.silent_ticks += 1;
            if self.silent_ticks > SILENT_TICKS && self.held.take().is_some() {
                self.tell(context, EventKind::Disconnected);
            }
            return;
        };
        self.silent_ticks = 0;
        let now = Held { axes: axes(controls), presses: controls.presses };
        match self.held.replace(now) {
            None => {
                self.tell(context, EventKind::Connected);
                for (code, at) in AXES.into_iter().zip(now.axes) {
                    self.move_axis(context, code, at);
                }
            }
            Some(before) => {
                for ((code, at), was) in AXES.into_iter().zip(now.axes).zip(before.axes) {
                    if at != was {
                        self.move_axis(context, code, at);
                    }
                }
                let counts = now.presses.into_iter().zip(before.presses);
                for (code, (now, before)) in (BUTTONS..).zip(counts) {
                    for _ in 0..now.saturating_sub(before).clamp(0, PRESSES_A_TICK) {
                        context.send(self.device, EventKind::Button, code, 1);
                        context.send(self.device, EventKind::Button, code, 0);
                    }
                }
            }
        }
    }

    fn move_axis(&self, context: &mut TickContext<'_>, code: u64, value: i64) {
        context.send(self.device, EventKind::Axis, code, value);
    }

    fn tell(&self, context: &mut TickContext<'_>, kind: EventKind) {
        context.events.push(DeviceEvent {
            tick: context.tick,
            device: self.device,
            kind: kind as u64,
            ..DeviceEvent::default()
        });
    }
}

impl Controller for FlightGearControls {
    fn act(&mut self, _: &Outputs, context: &mut TickContext<'_>) {
        let report = self.receiver.take();
        self.update(report.as_ref().map(|report| &report.controls), context);
    }
}

/// Raw values of the axes.
fn axes(controls: &Controls) -> [i64; AXES.len()] {
    let raw = |norm: f64| (norm * FULL).round() as i64;
    [
        raw(controls.aileron),
        raw(controls.elevator),
        raw(controls.throttle),
        raw(controls.rudder),
        raw(controls.brakes[0]),
        raw(controls.brakes[1]),
        controls.nacelle,
    ]
}

#[cfg(test)]
mod tests {
    use std::net::{IpAddr, Ipv4Addr};

    use engine::inputs::World;

    use super::*;

    fn map() -> cockpit::Params {
        aircraft::cockpit("flightgear.toml", aircraft::FLIGHTGEAR_MAP).expect("our own file")
    }

    fn device() -> FlightGearControls {
        let here = IpAddr::from(Ipv4Addr::LOCALHOST);
        let receiver = Receiver::open(here, 0).expect("a port");
        FlightGearControls::new(Arc::new(receiver), &map()).expect("in the map")
    }

    /// Where the cockpit's controls are after a report, and how many events it took.
    fn after(
        device: &mut FlightGearControls,
        state: &mut cockpit::State,
        controls: Option<Controls>,
    ) -> usize {
        let (mut events, mut world) = (Vec::new(), World::default());
        let (mut phase, mut done, mut gave_up) = ((0, ""), false, None);
        device.update(
            controls.as_ref(),
            &mut TickContext {
                tick: 1,
                events: &mut events,
                world: &mut world,
                phase: &mut phase,
                done: &mut done,
                gave_up: &mut gave_up,
                restart: &mut None,
                save: &mut false,
            },
        );
        *state = cockpit::update(&map(), state, &events, engine::STEP_S);
        events.len()
    }

    #[test]
    fn flightgear_s_controls_move_ours_in_our_senses() {
        let (mut device, mut state) = (device(), cockpit::State::default());
        let pulled = Controls {
            aileron: 1.0,
            elevator: -1.0,
            rudder: -0.5,
            throttle: 0.75,
            nacelle: -1,
            presses: [5; PRESSES.len()],
            ..Controls::default()
        };
        after(&mut device, &mut state, Some(pulled));
        assert!((state.stick_aft_norm - 1.0).abs() < 1e-9, "pulled is aft");
        assert!((state.stick_right_norm - 1.0).abs() < 1e-9);
        assert!((state.pedal_right_norm + 0.5).abs() < 1e-3);
        assert!((state.collective_norm - 0.75).abs() < 1e-3);
        assert!((state.nacelle_aft_norm + 1.0).abs() < 1e-9);
        assert_eq!((state.markers, state.flap_detent), (0, 0), "what was pressed before is over");
        assert_eq!(after(&mut device, &mut state, Some(pulled)), 0, "held, and said once");
        let pressed = Controls { presses: [6, 5, 5, 5, 6, 5, 7], ..pulled };
        after(&mut device, &mut state, Some(pressed));
        assert_eq!((state.flap_detent, state.scas_on, state.markers), (1, 1, 2));
    }

    #[test]
    fn when_reports_stop_all_but_the_lever_is_let_go() {
        let (mut device, mut state) = (device(), cockpit::State::default());
        let controls =
            Controls { elevator: -1.0, throttle: 0.5, nacelle: 1, ..Controls::default() };
        after(&mut device, &mut state, Some(controls));
        for _ in 0..SILENT_TICKS {
            assert_eq!(after(&mut device, &mut state, None), 0, "held");
        }
        assert!((state.stick_aft_norm - 1.0).abs() < 1e-9);
        assert_eq!(after(&mut device, &mut state, None), 1);
        assert!(state.stick_aft_norm.abs() < 1e-9 && state.nacelle_aft_norm.abs() < 1e-9);
        assert!((state.collective_norm - 0.5).abs() < 1e-3);
        after(&mut device, &mut state, Some(controls));
        assert!((state.stick_aft_norm - 1.0).abs() < 1e-9, "and back");
    }
}
