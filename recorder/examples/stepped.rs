//! Flies ticks from a start position as a program would that has the engine alone, and prints the time:
//! what `benches/python_ratio.sh` holds the Python package against.
//!
//! `stepped TICKS`

use std::hint::black_box;
use std::time::Instant;

use engine::{Inputs, step};

fn main() {
    let ticks = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let ticks: u64 = ticks.expect("how many ticks");
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
    let (.., scenario) = aircraft::STARTS[1];
    let start = aircraft::start("hover-50ft.toml", scenario).expect("our own file");
    let mut state = analysis::start::state_at(&start, &xv15).expect("a steady flight");
    let world = start.world.world();
    let begun = Instant::now();
    for _ in 0..ticks {
        let (next, outputs) = step(&xv15, &state, black_box(&Inputs { events: &[], world }));
        black_box(&outputs);
        state = next;
    }
    println!("{}", begun.elapsed().as_nanos() as f64 / 1e3 / ticks as f64);
    black_box(state);
}
