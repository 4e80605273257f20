//! The log as a library: what was flown, and how high, once a second.
//!
//! `cargo run -p logs --example read -- FLIGHT.mcap`

use std::path::Path;

use logs::{LogError, OpenOptions};

fn main() {
    let found = std::env::args().nth(1).ok_or("expected a log: read FLIGHT.mcap".to_string());
    let read = |path: String| read(Path::new(&path)).map_err(|error| format!("{path}: {error}"));
    if let Err(why) = found.and_then(read) {
        eprintln!("{why}");
        std::process::exit(2);
    }
}

fn read(path: &Path) -> Result<(), LogError> {
    let mut flight = logs::open(path, OpenOptions::default())?;
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
