//! The log as a library: what was flown, and how high, once a second.
//!
//! `cargo run -p logs --example read -- FLIGHT.mcap`

use std::path::Path;

use logs::{LogError, OpenOptions};

fn main() -> Result<(), LogError> {
    let Some(path) = std::env::args().nth(1) else {
        println!("expected a log: read FLIGHT.mcap");
        return Ok(());
    };
    let mut flight = logs::open(Path::new(&path), OpenOptions::default())?;
    for (key, fact) in &flight.identity.0 {
        println!("{key}: {fact}");
    }
    while let Some(tick) = flight.next_tick()? {
        let state = &tick.record.state;
        if state.tick.is_multiple_of(250) {
            println!(
                "{:.0} s: {:.2} m up, digest {:016x}",
                state.time_s(),
                -state.plant.position_m.z,
                tick.record.digest
            );
        }
    }
    Ok(())
}
