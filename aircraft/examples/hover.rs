//! Flies ticks of a hover and prints nothing: what is counted or timed from outside.
//!
//! `hover TICKS`; see `tests/instructions.sh` and `benches/jsbsim_ratio.py`.

use std::hint::black_box;

use engine::frames::Vec3;
use engine::inputs::World;
use engine::{Inputs, step};

fn main() {
    let ticks = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let ticks: u64 = ticks.expect("how many ticks");
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).expect("our own file");
    let mut state = start.on_wheels(&xv15);
    // Out of ground effect, and about what holds the weight.
    state.plant.position_m = Vec3::new(0.0, 0.0, -100.0);
    state.cockpit.collective_norm = 0.5;
    let inputs = Inputs { events: &[], world: World::default() };
    for _ in 0..ticks {
        let (next, outputs) = step(&xv15, &state, black_box(&inputs));
        black_box(&outputs);
        state = next;
    }
    black_box(state);
}
