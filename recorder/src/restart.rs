//! Going on from another state: reset, reposition, situations.
//!
//! Time goes on: the state that takes the place of the flown one gets its tick. The crew's hardware
//! stays where it is, and so does the number of markers.

use engine::State;
use engine::cockpit;
use engine::controls::PilotControls;
use engine::inputs::World;
use logs::records::{RestartCause, RestartRecord};

/// A moment of a flight that another one can go on from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Situation {
    /// The aircraft.
    pub state: State,
    /// Weather and failures.
    pub world: World,
}

/// From where the flight is to go on.
#[derive(Clone, Copy, Debug, PartialEq)]
// A situation is handed over once in a while; a box would be freed by the loop.
#[allow(clippy::large_enum_variant)]
pub enum Restart {
    /// From the state with which it began, in the weather of then.
    Start,
    /// From the last marker; nowhere when none was pressed.
    Marker,
    /// From the situation saved last; nowhere when none was.
    Saved,
    /// From a start position, in the weather of now.
    Reposition(State),
    /// From a situation.
    Situation(Situation),
}

/// What a flight can go on from without being told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Restarts {
    start: Situation,
    marker: Option<Situation>,
    saved: Option<Situation>,
}

impl Restarts {
    /// Of a flight that begins.
    pub(crate) fn new(start: Situation) -> Self {
        Self { start, marker: None, saved: None }
    }

    /// Notes a state after a tick, if the pilot pressed the marker in it.
    pub(crate) fn look(&mut self, markers_before: u64, state: &State, world: &World) {
        if state.cockpit.markers != markers_before {
            self.marker = Some(Situation { state: *state, world: *world });
        }
    }

    /// Notes what was saved.
    pub(crate) fn saved(&mut self, situation: Situation) {
        self.saved = Some(situation);
    }

    /// What takes the place of the state and the world now; `None` when there is nothing to go on from.
    pub(crate) fn made(
        &self,
        restart: &Restart,
        map: &cockpit::Params,
        now: &State,
        world: &World,
    ) -> Option<(RestartRecord, World)> {
        let (cause, situation) = match *restart {
            Restart::Start => (RestartCause::Start, self.start),
            Restart::Marker => (RestartCause::Marker, self.marker?),
            Restart::Saved => (RestartCause::Situation, self.saved?),
            Restart::Reposition(state) => {
                (RestartCause::Reposition, Situation { state, world: *world })
            }
            Restart::Situation(situation) => (RestartCause::Situation, situation),
        };
        let record =
            RestartRecord { cause: cause as u64, state: placed(&situation.state, map, now) };
        let world = if cause == RestartCause::Reposition {
            *world
        } else {
            weather(&situation, now.tick, world)
        };
        Some((record, world))
    }
}

/// A state in the place of the one now; what the hardware does not stand at waits for pick-up.
fn placed(state: &State, map: &cockpit::Params, now: &State) -> State {
    let controls = cockpit::await_pick_up(map, &now.cockpit, &state.cockpit);
    let cockpit = PilotControls { markers: now.cockpit.markers, ..controls };
    State { tick: now.tick, cockpit, ..*state }
}

/// The weather and failures of a situation, in the world of now: whether it is paused, the ground under
/// the wheels and who moves the actuators are not the situation's.
fn weather(situation: &Situation, tick: u64, now: &World) -> World {
    let World { paused, ground_height_m, input_level, commands, .. } = *now;
    // A gust goes on where it was.
    let since_tick = tick.wrapping_sub(situation.state.tick);
    let gust_start_tick = situation.world.gust_start_tick.wrapping_add(since_tick);
    World { paused, ground_height_m, input_level, commands, gust_start_tick, ..situation.world }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "what is passed on stays the same to the bit")]
mod tests {
    use super::*;

    fn at_tick(tick: u64, markers: u64) -> State {
        let mut state = State { tick, ..State::default() };
        state.cockpit.markers = markers;
        state.plant.fuel_kg = tick as f64;
        state
    }

    #[test]
    fn time_and_markers_go_on() {
        let world = World { turbulence_mps: 1.0, gust_start_tick: 5, ..World::default() };
        let map = cockpit::Params::default();
        let mut restarts = Restarts::new(Situation { state: at_tick(0, 0), world });
        let now = World { paused: 1, ..World::default() };
        let (record, world) = restarts.made(&Restart::Start, &map, &at_tick(700, 2), &now).unwrap();
        assert_eq!((record.state.tick, record.state.cockpit.markers), (700, 2));
        assert_eq!(record.state.plant.fuel_kg, 0.0);
        assert_eq!((world.paused, world.gust_start_tick), (1, 705));
        assert!(restarts.made(&Restart::Marker, &map, &at_tick(700, 2), &now).is_none());
        restarts.look(1, &at_tick(300, 2), &now);
        let (record, _) = restarts.made(&Restart::Marker, &map, &at_tick(700, 2), &now).unwrap();
        assert_eq!((record.state.tick, record.state.plant.fuel_kg), (700, 300.0));
    }
}
