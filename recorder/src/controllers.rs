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

#[cfg(test)]
mod tests {
    use super::*;

    /// Presses the button of its number; from the tenth tick on it is in its second phase.
    struct Hand(u64);

    impl Controller for Hand {
        fn act(&mut self, _: &Outputs, context: &mut TickContext<'_>) {
            let event = DeviceEvent { tick: context.tick, code: self.0, ..DeviceEvent::default() };
            context.events.push(event);
            *context.phase = if context.tick < 10 { (1, "first") } else { (2, "second") };
            context.world.turbulence_mps += 1.0;
            *context.done = context.tick == 11;
        }

        fn events_a_tick(&self) -> usize {
            self.0 as usize
        }
    }

    #[test]
    fn all_act_in_their_order_and_a_phase_is_told_when_it_begins() {
        let hands: Vec<Box<dyn Controller>> = vec![Box::new(Hand(7)), Box::new(Hand(3))];
        let mut controllers = Controllers::new(hands, World::default());
        assert_eq!(controllers.events_a_tick(), 10);
        let mut told = Vec::new();
        for tick in 0..12 {
            assert!(!controllers.done, "{tick}");
            let mut events = Vec::new();
            told.extend(controllers.act(tick, &Outputs::default(), &mut events));
            let pressed: Vec<_> = events.iter().map(|event| (event.tick, event.code)).collect();
            assert_eq!(pressed, [(tick, 7), (tick, 3)]);
        }
        assert_eq!(told, [(1, "first"), (2, "second")]);
        assert!(controllers.done);
        // What one does to the world stays, and the next one goes on from it.
        assert!((controllers.world.turbulence_mps - 24.0).abs() < 1e-9);
    }
}
