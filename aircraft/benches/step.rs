//! What one tick costs, beside a yardstick by which figures of other machines can be read.

use std::hint::black_box;

use engine::frames::Vec3;
use engine::inputs::World;
use engine::{Inputs, State, step};

fn main() {
    divan::main();
}

/// Hovering out of ground effect, near enough: every block has work to do.
fn hovering(xv15: &engine::Aircraft) -> State {
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO);
    let mut state = start.unwrap_or_else(|e| panic!("{e}")).on_wheels(xv15);
    state.plant.position_m = Vec3::new(0.0, 0.0, -100.0);
    state.cockpit.collective_norm = 0.5;
    let inputs = Inputs { events: &[], world: World::default() };
    for _ in 0..500 {
        state = step(xv15, &state, &inputs).0;
    }
    state
}

/// One tick of the full model.
#[divan::bench]
fn one_tick(bencher: divan::Bencher) {
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|e| panic!("{e}"));
    let state = hovering(&xv15);
    let inputs = Inputs { events: &[], world: World::default() };
    bencher.bench(|| step(black_box(&xv15), black_box(&state), black_box(&inputs)));
}

/// The yardstick: memory bandwidth is what every machine has.
#[divan::bench]
fn copy_of_a_megabyte(bencher: divan::Bencher) {
    let from = vec![1_u8; 1 << 20];
    let mut to = vec![0_u8; 1 << 20];
    bencher
        .counter(divan::counter::BytesCount::new(from.len()))
        .bench_local(move || black_box(&mut to).copy_from_slice(black_box(&from)));
}
