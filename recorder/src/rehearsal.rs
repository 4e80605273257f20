//! A flight without clock, log and link: for tests, and for whoever asks the model a question that
//! takes a pilot.

use analysis::{start::state_at, trim};
use engine::inputs::{DeviceEvent, World};
use engine::start::Start;
use engine::{Aircraft, Inputs, Outputs, State, observe, step};

use crate::controller::Controller;
use crate::controllers::Controllers;

/// One tick of a rehearsal.
pub struct RehearsedTick<'a> {
    /// After the tick.
    pub state: &'a State,
    /// After the tick.
    pub outputs: &'a Outputs,
    /// What the crew did.
    pub events: &'a [DeviceEvent],
    /// What the world was.
    pub world: &'a World,
    /// Name of the pilot's phase.
    pub phase: &'static str,
}

/// Flies until pilot model or script has ended or the time is up; `look` sees every tick. The inputs are the same
/// as those of [`fly`](crate::fly()), and so are the bits.
///
/// # Errors
/// When there is no steady flight to begin in.
pub fn rehearse(
    aircraft: &Aircraft,
    start: &Start,
    controllers: Vec<Box<dyn Controller>>,
    ticks_max: u64,
    mut look: impl FnMut(&RehearsedTick<'_>),
) -> Result<(State, Outputs), trim::Failure> {
    let mut state = state_at(start, aircraft)?;
    let mut controllers = Controllers::new(controllers, start.world.world());
    let mut outputs = observe(aircraft, &state, &controllers.world);
    let mut events = Vec::new();
    while !controllers.done && state.tick < ticks_max {
        events.clear();
        controllers.act(state.tick, &outputs, &mut events);
        let world = controllers.world;
        (state, outputs) = step(aircraft, &state, &Inputs { events: &events, world });
        look(&RehearsedTick {
            state: &state,
            outputs: &outputs,
            events: &events,
            world: &world,
            phase: controllers.phase.1,
        });
    }
    Ok((state, outputs))
}
