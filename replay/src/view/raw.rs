//! What devices said, as they said it: counts of every axis, before any map.

use std::collections::BTreeMap;

use engine::cockpit::{AxisControl, Params};
use engine::inputs::{DeviceEvent, EventKind};
use rerun::components::InterpolationMode;
use rerun::{Scalars, SeriesLines};

use super::canvas::{Canvas, times};
use super::look::{COLOURS, Look};
use super::parts::RAW;

/// The colours that the controls have where the pilot's are drawn.
const OF_CONTROLS: [(AxisControl, u32); 4] = [
    (AxisControl::StickAft, COLOURS[0]),
    (AxisControl::StickRight, COLOURS[1]),
    (AxisControl::PedalRight, COLOURS[2]),
    (AxisControl::Collective, COLOURS[3]),
];

/// What an axis is called, by what it moves in the cockpit map, and its colour.
fn called(map: &Params, (device, code): (u64, u64), number: usize) -> (String, u32) {
    let bound = usize::try_from(device).ok().and_then(|device| map.device.get(device));
    let bound = bound.and_then(|device| device.axis.iter().find(|axis| axis.code.number() == code));
    let words = bound.map_or_else(
        || format!("device {device}, axis 0x{code:02x}"),
        |axis| format!("{} (0x{code:02x})", axis.control.facts().words),
    );
    let own = bound.and_then(|axis| OF_CONTROLS.iter().find(|(of, _)| *of == axis.control));
    (words, own.map_or(COLOURS[(4 + number) % COLOURS.len()], |(_, colour)| *colour))
}

/// Axes that have moved, and how since the last time that they were written.
#[derive(Default)]
pub struct Raw {
    axes: BTreeMap<(u64, u64), Vec<(u64, i64)>>,
}

impl Raw {
    /// Takes the device events of a tick.
    pub fn add(&mut self, tick: u64, events: &[DeviceEvent]) {
        for event in events {
            let kind = EventKind::from_u64(event.kind);
            if matches!(kind, Some(EventKind::Axis | EventKind::AxisPosition)) {
                let moves = self.axes.entry((event.device, event.code)).or_default();
                match moves.last_mut() {
                    // Of one tick the last one counts.
                    Some(last) if last.0 == tick => last.1 = event.value,
                    _ => moves.push((tick, event.value)),
                }
            }
        }
    }

    /// Writes them.
    pub fn flush(
        &mut self,
        canvas: &mut Canvas,
        look: &Look,
        map: &Params,
        told: &mut Vec<(u64, u64)>,
    ) {
        for (&(device, code), moves) in &mut self.axes {
            if moves.is_empty() {
                continue;
            }
            let entity = look.entity(&format!("{RAW}/device_{device}_axis_{code:02x}"));
            if !told.contains(&(device, code)) {
                let (name, colour) = called(map, (device, code), told.len());
                let sent = canvas.recording.log_static(
                    entity.as_str(),
                    &SeriesLines::new()
                        .with_names([format!("{}{name}", look.name)])
                        .with_colors([colour & look.line_mask])
                        .with_widths([1.5 + look.line_width])
                        .with_interpolation_mode(InterpolationMode::StepAfter),
                );
                canvas.keep(sent);
                told.push((device, code));
            }
            let (ticks, values): (Vec<u64>, Vec<i64>) = moves.drain(..).unzip();
            let scalars = Scalars::new(values.into_iter().map(|value| value as f64));
            let columns = scalars.columns_of_unit_batches().map(Vec::from_iter);
            canvas.send(&entity, &times(&ticks), columns);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_is_called_by_what_it_moves() {
        let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP);
        let map = map.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(called(&map, (0, 1), 5), ("stick aft (0x01)".into(), COLOURS[0]));
        assert_eq!(called(&map, (0, 6), 0), ("collective (0x06)".into(), COLOURS[3]));
        assert_eq!(called(&map, (3, 6), 1), ("device 3, axis 0x06".into(), COLOURS[5]));
    }

    #[test]
    fn of_one_tick_the_last_position_of_an_axis_counts_and_buttons_are_none() {
        let mut raw = Raw::default();
        let event = |kind: EventKind, code, value| DeviceEvent {
            kind: kind as u64,
            device: 1,
            code,
            value,
            ..DeviceEvent::default()
        };
        raw.add(7, &[event(EventKind::Axis, 0, 10), event(EventKind::Axis, 0, 20)]);
        raw.add(8, &[event(EventKind::Button, 3, 1), event(EventKind::AxisPosition, 1, -5)]);
        assert_eq!(raw.axes[&(1, 0)], [(7, 20)]);
        assert_eq!(raw.axes[&(1, 1)], [(8, -5)]);
        assert_eq!(raw.axes.len(), 2);
    }
}
