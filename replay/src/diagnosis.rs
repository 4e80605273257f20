//! What became of a flight that stops being the recorded one: gathered while its log is reflown.

use std::collections::BTreeMap;

use engine::{Aircraft, Inputs, Outputs, State, step};
use logs::{LogError, Tick, cdr};

use crate::compare::Names;
use crate::divergence::{Divergence, LastInput, OneStepCheck, StatePair};
use crate::refly::Reflight;

/// The first difference, if there is one, and what is known of it so far.
pub(crate) struct Diagnosis {
    last_input: LastInput,
    single: SingleStepper,
    /// The recorded state before the tick.
    before: State,
    /// Only what was kept of a compacted log can be compared: its keyframes.
    compacted: bool,
    /// The last tick that was the recorded one.
    last_same: u64,
    /// What was found.
    pub(crate) divergence: Option<Box<Divergence>>,
}

impl Diagnosis {
    pub(crate) fn of(flight: &Reflight) -> Result<Self, LogError> {
        Ok(Self {
            last_input: LastInput::new()?,
            single: SingleStepper::new()?,
            before: flight.state,
            compacted: flight.reader.is_compacted(),
            last_same: flight.state.tick,
            divergence: None,
        })
    }

    /// Adds a tick; `same` says whether the reflown state is the recorded one, where it was reflown.
    pub(crate) fn add(
        &mut self,
        tick: u64,
        flight: &mut Reflight,
        same: Option<bool>,
    ) -> Result<(), LogError> {
        if self.compacted {
            return self.add_compacted(tick, flight, same);
        }
        let recorded = &flight.reader.tick;
        let parted =
            StatePair { tick, recorded: &recorded.state_message, reflown: flight.message() };
        match (&mut self.divergence, same) {
            (None, Some(same)) => {
                self.last_input.add(&recorded.events, &recorded.inputs)?;
                if !same {
                    let input = self.last_input.told(&flight.aircraft.cockpit);
                    let names = &self.single.states;
                    self.divergence = Divergence::new(names, &parted, input)?.map(Box::new);
                }
            }
            (Some(divergence), Some(_)) => {
                divergence.growth.add(tick, parted.recorded, parted.reflown);
            }
            (_, None) => {}
        }
        if let Some(divergence) = &mut self.divergence
            && same.is_some()
        {
            let aircraft = &flight.aircraft;
            self.single.step(aircraft, &self.before, recorded, &mut divergence.single)?;
        }
        self.before = recorded.record.state;
        self.blocks(&flight.reader.outputs)?;
        // What blocks gave stands some way behind the states in the file, or before them.
        flight.reader.outputs.retain(|outputs| outputs.tick > tick);
        Ok(())
    }

    /// The same of a compacted log: what is read of it between keyframes is computed, and would be compared
    /// with itself.
    fn add_compacted(
        &mut self,
        tick: u64,
        flight: &Reflight,
        same: Option<bool>,
    ) -> Result<(), LogError> {
        let recorded = &flight.reader.tick;
        if same.is_some() && self.divergence.is_none() {
            self.last_input.add(&recorded.events, &recorded.inputs)?;
        }
        if same == Some(true) {
            self.last_same = tick;
        }
        if same.is_none() || !flight.reader.is_recorded() {
            return Ok(());
        }
        let parted =
            StatePair { tick, recorded: &recorded.state_message, reflown: flight.message() };
        match &mut self.divergence {
            Some(divergence) => divergence.growth.add(tick, parted.recorded, parted.reflown),
            None if same == Some(false) => {
                let input = self.last_input.told(&flight.aircraft.cockpit);
                let found = Divergence::new(&self.single.states, &parted, input)?;
                self.divergence = found.map(Box::new);
                if let Some(divergence) = &mut self.divergence {
                    divergence.after_tick = Some(self.last_same);
                    divergence.single.between_keyframes = true;
                }
            }
            None => {}
        }
        // Reading began this stretch with the keyframe before.
        if let (Some(divergence), Some((state, _))) = (&mut self.divergence, flight.reader.flown())
        {
            divergence.single.add_keyframe(&recorded.state_message, &cdr::encode(state)?);
        }
        Ok(())
    }

    /// Compares what blocks gave with what was recorded of it.
    pub(crate) fn blocks(&mut self, recorded: &[Outputs]) -> Result<(), LogError> {
        match &mut self.divergence {
            Some(divergence) => self.single.blocks(recorded, &mut divergence.single),
            None => Ok(()),
        }
    }
}

/// Flies single steps from the recorded states.
struct SingleStepper {
    states: Names,
    blocks: Names,
    /// What they gave, until it is found in the log.
    outputs: BTreeMap<u64, Outputs>,
}

impl SingleStepper {
    fn new() -> Result<Self, LogError> {
        Ok(Self {
            states: Names::of::<State>()?,
            blocks: Names::of::<Outputs>()?,
            outputs: BTreeMap::new(),
        })
    }

    fn step(
        &mut self,
        aircraft: &Aircraft,
        before: &State,
        recorded: &Tick,
        single: &mut OneStepCheck,
    ) -> Result<(), LogError> {
        let inputs = Inputs { events: &recorded.events, world: recorded.inputs.world };
        let (stepped, outputs) = step(aircraft, &recorded.begins_with(before), &inputs);
        if single.block.is_none() {
            self.outputs.insert(outputs.tick, outputs);
        }
        single.add(&self.states, &recorded.state_message, &cdr::encode(&stepped)?);
        Ok(())
    }

    fn blocks(&mut self, recorded: &[Outputs], single: &mut OneStepCheck) -> Result<(), LogError> {
        for recorded in recorded {
            if let Some(stepped) = self.outputs.remove(&recorded.tick)
                && single.block.is_none()
            {
                let (recorded, of_step) = (cdr::encode(recorded)?, cdr::encode(&stepped)?);
                single.add_outputs(&self.blocks, stepped.tick, &recorded, &of_step);
            }
        }
        Ok(())
    }
}
