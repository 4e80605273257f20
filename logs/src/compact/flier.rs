//! What a log says that can be said again: states, and what viewers draw.

use std::collections::VecDeque;

use engine::frames::Attitude;
use engine::inputs::{DeviceEvent, World};
use engine::{Aircraft, Inputs, Outputs, State, observe, step};

use crate::records::{InputsRecord, OUTPUTS, StateRecord};
use crate::view::{self, Shape};
use crate::{LogError, cdr};

/// Channels made from the outputs.
pub const VIEWED: [&str; 5] = [OUTPUTS, view::TF, view::JOY, view::JOINT_STATES, view::FIX];

/// Outputs kept: viewers' messages come later in the file than the states, but never by more ticks
/// than this times [`OUTPUTS_TICKS`].
const OUTPUTS_KEPT: usize = 512;
/// Every so many ticks the outputs are kept.
const OUTPUTS_TICKS: u64 = 5;

/// The aircraft of a log, and the world in which its flight begins.
#[derive(Clone)]
pub struct Flown {
    /// With its cockpit map.
    pub aircraft: Aircraft,
    /// By the scenario.
    pub world: World,
}

/// Flies what the log says.
pub struct Flier {
    of: Flown,
    shape: Shape,
    /// After the last tick; as it was recorded, where it was.
    pub state: State,
    /// After the last tick, as it was flown.
    pub flown: Option<(State, Outputs)>,
    events: Vec<DeviceEvent>,
    inputs: InputsRecord,
    outputs: VecDeque<(Outputs, Attitude)>,
    /// Before this, outputs are not known: the reading began in the middle.
    pub begun_tick: u64,
}

impl Flier {
    pub fn new(of: Flown) -> Self {
        Self {
            shape: Shape::of(&of.aircraft),
            of,
            flown: None,
            state: State::default(),
            events: Vec::new(),
            inputs: InputsRecord::default(),
            outputs: VecDeque::with_capacity(OUTPUTS_KEPT),
            begun_tick: 0,
        }
    }

    /// Stands at a recorded state.
    pub fn begin(&mut self, state: State) {
        self.state = state;
        self.begun_tick = state.tick;
        self.events.clear();
        self.outputs.clear();
        self.flown = None;
        if state.tick == 0 {
            // What was there to be seen before the first tick, as it was shown to the crew.
            self.keep(observe(&self.of.aircraft, &state, &self.of.world));
        }
    }

    /// A device event of the tick under way.
    pub fn event(&mut self, message: &[u8]) -> Result<(), LogError> {
        self.events.push(cdr::decode(message)?);
        Ok(())
    }

    /// The world of the tick under way.
    pub fn inputs(&mut self, message: &[u8]) -> Result<(), LogError> {
        self.inputs = cdr::decode(message)?;
        Ok(())
    }

    /// Flies the tick.
    pub fn fly(&mut self) {
        let inputs = Inputs { events: &self.events, world: self.inputs.world };
        let (state, outputs) = step(&self.of.aircraft, &self.state, &inputs);
        self.events.clear();
        self.state = state;
        self.flown = Some((state, outputs));
        self.keep(outputs);
    }

    fn keep(&mut self, outputs: Outputs) {
        if outputs.tick.is_multiple_of(OUTPUTS_TICKS) {
            if self.outputs.len() == OUTPUTS_KEPT {
                self.outputs.pop_front();
            }
            self.outputs.push_back((outputs, self.state.plant.attitude));
        }
    }

    /// The state as its message.
    pub fn state_message(&self, digest: u64) -> Result<Vec<u8>, LogError> {
        cdr::encode(&StateRecord { digest, state: self.state })
    }

    /// What viewers drew of a tick on a channel of [`VIEWED`]; `None` when that tick is too long ago,
    /// or was never flown.
    pub fn view(&self, number: u8, tick: u64) -> Result<Option<Vec<u8>>, LogError> {
        let kept = self.outputs.iter().rev().find(|(outputs, _)| outputs.tick == tick);
        let (Some((outputs, attitude)), Some(topic)) = (kept, VIEWED.get(usize::from(number)))
        else {
            return Ok(None);
        };
        view::message(topic, outputs, *attitude, &self.shape)
    }
}
