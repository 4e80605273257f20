//! Where a reflown flight stops being the recorded one, and what became of it.

use engine::cockpit::{Code, Params as Cockpit};
use engine::inputs::{DeviceEvent, EventKind};
use logs::fields::Value;
use logs::records::InputsRecord;
use logs::{LogError, cdr};

use crate::compare::Names;
use crate::growth::Growth;
use crate::stage::Stage;

/// The first difference between the recorded and the reflown flight.
#[derive(Clone, Debug)]
pub struct Divergence {
    /// Tick; of a compacted log, that of the first state that was kept and differs.
    pub tick: u64,
    /// Of a compacted log, the last tick whose digest is the one that was kept: the first difference is
    /// after it.
    pub after_tick: Option<u64>,
    /// Stage of the step whose result differs first, in the order of its wiring.
    pub stage: Option<Stage>,
    /// Field of the state that differs first: the first one of that stage.
    pub path: String,
    /// Its unit; empty for a count, a flag, a ratio.
    pub unit: String,
    /// As recorded.
    pub recorded: Value,
    /// As reflown.
    pub reflown: Value,
    /// How many other fields differ at this tick.
    pub others: usize,
    /// Every stage whose result differs at this tick, in the order of the wiring, with the number of
    /// its fields that do.
    pub stages: Vec<(Stage, u64)>,
    /// The last change of an input before it, if there was one.
    pub last_input: Option<InputChange>,
    /// How the difference grew while the reflight went on by the recorded inputs.
    pub growth: Growth,
    /// How single steps from the recorded states did.
    pub single: OneStepCheck,
}

/// Steps of one tick each, from every recorded state of the window: differences that do not add up. Of a
/// compacted log, only the states at keyframes were recorded, and each step goes from one to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OneStepCheck {
    /// How many were flown.
    pub ticks: u64,
    /// How many did not lead to the recorded state.
    pub differing: u64,
    /// In how many of them which stage differed first.
    pub first_stages: Vec<(Stage, u64)>,
    /// The first block whose recorded result, at the first tick for which there is one, is not what
    /// it gives from the recorded state before.
    pub block: Option<BlockDifference>,
    /// How many ticks with a recorded result of every block were compared, up to that one.
    pub outputs: u64,
    /// Whether each goes from one keyframe of a compacted log to the next.
    pub between_keyframes: bool,
}

/// What a block gave, recorded and computed anew from the recorded state.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockDifference {
    /// When.
    pub tick: u64,
    /// Which block.
    pub stage: Stage,
    /// Field of the outputs.
    pub path: String,
    /// Its unit.
    pub unit: String,
    /// As recorded.
    pub recorded: Value,
    /// As reflown.
    pub reflown: Value,
}

/// Something that came from outside.
#[derive(Clone, Debug, PartialEq)]
pub enum InputChange {
    /// A device.
    Device {
        /// What it said.
        event: DeviceEvent,
        /// What it moves, by the cockpit map of the log; empty for nothing.
        moves: String,
    },
    /// The world: wind, failures, pause.
    World {
        /// The tick whose step used it first.
        tick: u64,
        /// Field of the inputs.
        path: String,
        /// Its unit.
        unit: String,
        /// Before.
        from: Value,
        /// From then on.
        to: Value,
    },
}

impl InputChange {
    /// The tick that it led to.
    pub fn led_to_tick(&self) -> u64 {
        let (Self::Device { event: DeviceEvent { tick, .. }, .. } | Self::World { tick, .. }) =
            self;
        tick.saturating_add(1)
    }
}

/// Remembers the last change of an input.
#[derive(Debug)]
pub(crate) struct LastInput {
    names: Names,
    world: Option<InputsRecord>,
    event: Option<DeviceEvent>,
    changed: Option<InputChange>,
}

impl LastInput {
    pub(crate) fn new() -> Result<Self, LogError> {
        Ok(Self { names: Names::of::<InputsRecord>()?, world: None, event: None, changed: None })
    }

    /// The inputs of one tick.
    pub(crate) fn add(
        &mut self,
        events: &[DeviceEvent],
        inputs: &InputsRecord,
    ) -> Result<(), LogError> {
        if let Some(before) = self.world.replace(*inputs)
            && before.world != inputs.world
        {
            let (a, b) = (cdr::encode(&before)?, cdr::encode(inputs)?);
            let changed = self
                .names
                .differences(&a, &b)
                .find(|difference| difference.name.path.starts_with("world."));
            if let Some(difference) = changed {
                self.changed = Some(InputChange::World {
                    tick: inputs.tick,
                    path: difference.name.path.clone(),
                    unit: difference.name.unit.clone(),
                    from: difference.a,
                    to: difference.b,
                });
            }
        }
        self.event = events.last().copied().or(self.event);
        Ok(())
    }

    /// The last one, in the words of the cockpit map; of the same tick the world's, which changes
    /// less often than a stick.
    pub(crate) fn told(&self, map: &Cockpit) -> Option<InputChange> {
        let device =
            self.event.map(|event| InputChange::Device { event, moves: moves(map, &event) });
        match (&self.changed, device) {
            (Some(world), Some(device)) if device.led_to_tick() > world.led_to_tick() => {
                Some(device)
            }
            (Some(world), _) => Some(world.clone()),
            (None, device) => device,
        }
    }
}

/// What an event moves.
fn moves(map: &Cockpit, event: &DeviceEvent) -> String {
    let code = match EventKind::from_u64(event.kind) {
        Some(EventKind::Axis) => Code::Axis(event.code),
        Some(EventKind::Button) => Code::Key(event.code),
        _ => return String::new(),
    };
    let Some(device) = map.device(event.device) else { return String::new() };
    let axes = device.axes_of(code).map(|axis| axis.control.facts().words);
    let buttons = device.buttons_of(code).map(|button| button.control.facts().words);
    axes.chain(buttons).collect::<Vec<_>>().join(", ")
}

/// The states after the first tick that differs, as messages.
pub(crate) struct StatePair<'a> {
    pub(crate) tick: u64,
    pub(crate) recorded: &'a [u8],
    pub(crate) reflown: &'a [u8],
}

impl Divergence {
    /// What there is to say at once.
    pub(crate) fn new(
        names: &Names,
        at: &StatePair,
        last_input: Option<InputChange>,
    ) -> Result<Option<Self>, LogError> {
        let mut found: Vec<_> = names
            .differences(at.recorded, at.reflown)
            .map(|difference| (Stage::of_state(&difference.name.path), difference))
            .collect();
        // What has no stage comes last; the order of the state decides within a stage.
        found.sort_by_key(|(stage, difference)| (stage.is_none(), *stage, difference.index));
        let Some((stage, first)) = found.first() else { return Ok(None) };
        let mut stages: Vec<(Stage, u64)> = Vec::new();
        for stage in found.iter().filter_map(|(stage, _)| *stage) {
            count(&mut stages, stage);
        }
        let mut growth = Growth::new(at.tick, &first.name.path)?;
        growth.add(at.tick, at.recorded, at.reflown);
        Ok(Some(Self {
            tick: at.tick,
            after_tick: None,
            stage: *stage,
            path: first.name.path.clone(),
            unit: first.name.unit.clone(),
            recorded: first.a,
            reflown: first.b,
            others: found.len() - 1,
            stages,
            last_input,
            growth,
            single: OneStepCheck::default(),
        }))
    }
}

impl OneStepCheck {
    /// What a step from the recorded state before gave, beside the recorded state after it.
    pub(crate) fn add(&mut self, names: &Names, recorded: &[u8], stepped: &[u8]) {
        self.ticks += 1;
        if recorded == stepped {
            return;
        }
        self.differing += 1;
        let stages = names
            .differences(recorded, stepped)
            .filter_map(|difference| Stage::of_state(&difference.name.path));
        if let Some(first) = stages.min() {
            count(&mut self.first_stages, first);
        }
    }

    /// What the flight from the keyframe before led to, beside the keyframe.
    pub(crate) fn add_keyframe(&mut self, recorded: &[u8], flown: &[u8]) {
        self.ticks += 1;
        self.differing += u64::from(recorded != flown);
    }

    /// What every block gave in such a step, beside what was recorded of it.
    pub(crate) fn add_outputs(
        &mut self,
        names: &Names,
        tick: u64,
        recorded: &[u8],
        stepped: &[u8],
    ) {
        self.outputs += 1;
        let found = names
            .differences(recorded, stepped)
            .map(|difference| (Stage::of_outputs(&difference.name.path), difference))
            .min_by_key(|(stage, difference)| (*stage, difference.index));
        let Some((stage, first)) = found.filter(|_| self.block.is_none()) else { return };
        self.block = Some(BlockDifference {
            tick,
            stage,
            path: first.name.path.clone(),
            unit: first.name.unit.clone(),
            recorded: first.a,
            reflown: first.b,
        });
    }
}

/// Adds one to a stage's count, in the order of the wiring.
fn count(counts: &mut Vec<(Stage, u64)>, stage: Stage) {
    match counts.iter_mut().find(|(known, _)| *known == stage) {
        Some((_, number)) => *number += 1,
        None => {
            counts.push((stage, 1));
            counts.sort_by_key(|(stage, _)| *stage);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_is_told_by_the_controls_that_it_moves() {
        // One switch works two controls, and a lever is a button as well towards its end.
        let map = r#"
            [[device]]
            name = "stick"
            axis = [{ code = 0, control = "stick_right" }, { code = 6, control = "collective" }]
            button = [
                { code = 0x120, control = "marker" },
                { code = 0x121, control = "flap_up" },
                { code = 0x121, control = "gear_toggle" },
                { code = "ABS_THROTTLE", control = "flap_down", beyond_norm = 0.5 },
            ]
            [[device]]
            name = "pedals"
            axis = [{ code = 0, control = "pedal_right" }]
        "#;
        let map: Cockpit = toml::from_str(map).expect("a cockpit map");
        let told = |device, kind: EventKind, code| {
            moves(&map, &DeviceEvent { device, kind: kind as u64, code, ..DeviceEvent::default() })
        };
        assert_eq!(told(0, EventKind::Axis, 0), "stick right");
        assert_eq!(told(1, EventKind::Axis, 0), "pedal right");
        assert_eq!(told(0, EventKind::Button, 0x120), "marker");
        assert_eq!(told(0, EventKind::Button, 0x121), "flap up, gear toggle");
        assert_eq!(told(0, EventKind::Axis, 6), "collective, flap down");
        // Axes and buttons are counted apart, and some have nothing to do.
        for (device, kind, code) in [
            (0, EventKind::Button, 0),
            (0, EventKind::Axis, 0x120),
            (0, EventKind::Axis, 1),
            (2, EventKind::Axis, 0),
            (0, EventKind::Connected, 0),
            (0, EventKind::AxisPosition, 0),
            (0, EventKind::ButtonPosition, 0x120),
        ] {
            assert_eq!(told(device, kind, code), "", "device {device}, {kind:?} {code}");
        }
        let unknown = DeviceEvent { kind: 99, ..DeviceEvent::default() };
        assert_eq!(moves(&map, &unknown), "");
    }

    #[test]
    fn of_the_last_inputs_the_later_one_is_told_and_of_one_tick_the_world() {
        let inputs = |tick, north_mps| {
            let mut inputs = InputsRecord { tick, ..InputsRecord::default() };
            inputs.world.wind_mps.x = north_mps;
            inputs
        };
        let event = |tick| DeviceEvent { tick, ..DeviceEvent::default() };
        let map = Cockpit::default();
        let mut last = LastInput::new().expect("recordable");
        last.add(&[], &inputs(0, 0.0)).expect("read");
        assert_eq!(last.told(&map), None, "a tick is no change");
        last.add(&[event(1)], &inputs(1, 0.0)).expect("read");
        let device = |tick| InputChange::Device { event: event(tick), moves: String::new() };
        assert_eq!(last.told(&map), Some(device(1)));
        last.add(&[event(2)], &inputs(2, 5.0)).expect("read");
        let world = InputChange::World {
            tick: 2,
            path: "world.wind_mps.x".into(),
            unit: "m/s".into(),
            from: Value::F64(0.0),
            to: Value::F64(5.0),
        };
        assert_eq!(last.told(&map), Some(world));
        last.add(&[event(3)], &inputs(3, 5.0)).expect("read");
        assert_eq!(last.told(&map), Some(device(3)));
        assert_eq!(device(3).led_to_tick(), 4);
    }
}
