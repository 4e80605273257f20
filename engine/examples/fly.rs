//! The engine as a library: a second of standing on the runway, step by step.
//!
//! `cargo run -p engine --example fly`. The engine reads no file: the crate `aircraft` turns one into its parameters.

use engine::{Inputs, step};

fn main() -> Result<(), aircraft::ConfigError> {
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15)?;
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO)?;
    let mut state = start.on_wheels(&xv15);
    let inputs = Inputs { events: &[], world: start.world.world() };
    for _ in 0..250 {
        let (next, outputs) = step(&xv15, &state, &inputs);
        state = next;
        if state.tick.is_multiple_of(50) {
            let (time_s, height_m) = (state.time_s(), outputs.height_above_ground_m);
            println!(
                "{time_s:.1} s: {height_m:.3} m, rotors {:.1} rad/s",
                outputs.rotor_speed_radps
            );
        }
    }
    Ok(())
}
