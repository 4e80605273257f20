//! Inner states alone, as on a test stand.

use alloc::vec::Vec;

use engine::inputs::World;
use engine::{Aircraft, State, step};

use crate::variable::Inner;

/// The state after some ticks in which only the plant's inner states move, as on a test stand:
/// the body, the drive and all controls are held.
pub fn settle(aircraft: &Aircraft, state: &State, world: &World, ticks: usize) -> State {
    let inner: Vec<Inner> = Inner::of_plant().collect();
    let mut state = *state;
    for _ in 0..ticks {
        let next = step::derivatives(aircraft, &state, world).0;
        for number in &inner {
            number.set(&mut state, number.get(&next));
        }
    }
    state
}
