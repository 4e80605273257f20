//! All controllers of a flight, asked in their order.

use engine::Outputs;
use engine::inputs::{DeviceEvent, World};

use crate::controller::{Controller, GaveUp, TickContext};
use crate::restart::Restart;

/// All controllers, and what they hold on to between ticks.
pub(crate) struct Controllers {
    controllers: Vec<Box<dyn Controller>>,
    pub(crate) world: World,
    pub(crate) phase: (u64, &'static str),
    pub(crate) done: bool,
    pub(crate) gave_up: Option<GaveUp>,
    /// From where to go on; taken by whoever flies.
    pub(crate) restart: Option<Restart>,
    /// Whether to save the situation; the same.
    pub(crate) save: bool,
}

impl Controllers {
    /// Controllers that have moved nothing yet.
    pub(crate) fn new(controllers: Vec<Box<dyn Controller>>, world: World) -> Self {
        let (phase, done, gave_up) = ((0, ""), false, None);
        Self { controllers, world, phase, done, gave_up, restart: None, save: false }
    }

    /// How many events they send in one tick at most.
    pub(crate) fn events_a_tick(&self) -> usize {
        self.controllers.iter().map(|controller| controller.events_a_tick()).sum()
    }

    /// Lets every controller act; returns the phase if it changed.
    pub(crate) fn act(
        &mut self,
        tick: u64,
        seen: &Outputs,
        events: &mut Vec<DeviceEvent>,
    ) -> Option<(u64, &'static str)> {
        let before = self.phase.0;
        for controller in &mut self.controllers {
            controller.act(
                seen,
                &mut TickContext {
                    tick,
                    events,
                    world: &mut self.world,
                    phase: &mut self.phase,
                    done: &mut self.done,
                    gave_up: &mut self.gave_up,
                    restart: &mut self.restart,
                    save: &mut self.save,
                },
            );
        }
        (self.phase.0 != before).then_some(self.phase)
    }
}
