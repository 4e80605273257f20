//! What a log says that can be said again: states, and what viewers draw.

use std::collections::VecDeque;

use engine::frames::Attitude;
use engine::inputs::{DeviceEvent, World};
use engine::{Aircraft, Inputs, Outputs, State, observe, step, step_state};

use crate::channels::{Channel, ChannelId, Written};
use crate::records::{InputsRecord, RestartRecord, StateRecord};
use crate::setup::Setup;
use crate::view::Shape;
use crate::{LogError, cdr};

/// Outputs kept: viewers' messages come later in the file than the states, but never by more ticks
/// than this times [`OUTPUTS_TICKS`].
const OUTPUTS_KEPT: usize = 512;
/// Every so many ticks the outputs are kept.
const OUTPUTS_TICKS: u64 = 5;

/// Makes an aircraft, and the world in which its flight begins, of the files in the log. This crate
/// does not read them itself.
pub type FlightModelOf = fn(&Setup) -> Result<FlightModel, LogError>;

/// The aircraft of a log, and the world in which its flight begins.
#[derive(Clone)]
pub struct FlightModel {
    /// With its cockpit map.
    pub aircraft: Aircraft,
    /// By the scenario.
    pub world: World,
}

/// A digest that tells one message from another that takes its place by a fault, in few bytes.
pub fn short_digest(message: &[u8]) -> u32 {
    xxhash_rust::xxh3::xxh3_64(message) as u32
}

/// Flies what the log says.
pub struct Regenerator {
    pub of: FlightModel,
    shape: Shape,
    /// After the last tick; as it was recorded, where it was.
    pub state: State,
    /// After the last tick, as it was flown.
    pub flown: Option<(State, Outputs)>,
    /// What takes the place of the state in the tick under way.
    restart: Option<State>,
    events: Vec<DeviceEvent>,
    inputs: InputsRecord,
    outputs: VecDeque<(Outputs, Attitude)>,
    /// Before this, outputs are not known: the reading began in the middle.
    pub begun_tick: u64,
    /// Outputs are computed only where they are kept.
    pub states_only: bool,
}

/// Whether the outputs of a tick are kept.
pub fn is_kept(tick: u64) -> bool {
    tick.is_multiple_of(OUTPUTS_TICKS)
}

/// A tick that was flown.
pub struct FlownTick {
    pub state: State,
    /// Where they are kept.
    pub outputs: Option<Box<Outputs>>,
}

impl Regenerator {
    /// With the aircraft and the world of the log.
    pub fn new(of: FlightModel) -> Self {
        Self {
            shape: Shape::of(&of.aircraft),
            of,
            flown: None,
            state: State::default(),
            restart: None,
            events: Vec::new(),
            inputs: InputsRecord::default(),
            outputs: VecDeque::with_capacity(OUTPUTS_KEPT),
            begun_tick: 0,
            states_only: false,
        }
    }

    /// Stands at a recorded state.
    pub fn begin(&mut self, state: State) {
        self.state = state;
        self.begun_tick = state.tick;
        self.restart = None;
        self.events.clear();
        self.outputs.clear();
        self.flown = None;
        if state.tick == 0 {
            // What was there to be seen before the first tick, as it was shown to the crew.
            self.keep(&observe(&self.of.aircraft, &state, &self.of.world));
        }
    }

    /// A message that the tick under way uses.
    pub fn takes(&mut self, channel: ChannelId, message: &[u8]) -> Result<(), LogError> {
        match channel {
            ChannelId::Hardware => self.events.push(cdr::decode(message)?),
            ChannelId::Inputs => self.inputs = cdr::decode(message)?,
            ChannelId::Restart => {
                self.restart = Some(cdr::decode::<RestartRecord>(message)?.state);
            }
            _ => {}
        }
        Ok(())
    }

    /// Flies the tick.
    pub fn fly(&mut self) {
        let inputs = Inputs { events: &self.events, world: self.inputs.world };
        let aircraft = &self.of.aircraft;
        self.state = self.restart.take().unwrap_or(self.state);
        if self.states_only && !is_kept(self.state.tick.wrapping_add(1)) {
            step_state(aircraft, &mut self.state, &inputs);
            self.flown_state(None);
        } else {
            let (state, outputs) = step(aircraft, &self.state, &inputs);
            self.state = state;
            self.flown_state(Some(&outputs));
        }
    }

    /// Takes the tick as another thread flew it.
    pub fn take(&mut self, flown: &FlownTick) {
        self.state = flown.state;
        self.flown_state(flown.outputs.as_deref());
    }

    fn flown_state(&mut self, outputs: Option<&Outputs>) {
        self.events.clear();
        self.restart = None;
        let flown = self.flown.get_or_insert_default();
        flown.0 = self.state;
        if let Some(outputs) = outputs {
            flown.1 = *outputs;
            self.keep(outputs);
        }
    }

    fn keep(&mut self, outputs: &Outputs) {
        if is_kept(outputs.tick) {
            if self.outputs.len() == OUTPUTS_KEPT {
                self.outputs.pop_front();
            }
            self.outputs.push_back((*outputs, self.state.plant.attitude));
        }
    }

    /// Appends the state as its message.
    pub fn state_message(&self, to: &mut Vec<u8>, digest: u64) -> Result<(), LogError> {
        cdr::append(to, &StateRecord { digest, state: self.state })
    }

    /// Appends what viewers drew of a tick on a channel that is made of the outputs; `false` when that
    /// tick is too long ago, or was never flown.
    pub fn view(&self, to: &mut Vec<u8>, channel: &Channel, tick: u64) -> Result<bool, LogError> {
        let kept = self.outputs.iter().rev().find(|(outputs, _)| outputs.tick == tick);
        match (kept, channel.written) {
            (Some((outputs, attitude)), Written::FromOutputs { message, .. }) => {
                message(to, outputs, *attitude, &self.shape).map(|()| true)
            }
            _ => Ok(false),
        }
    }
}
