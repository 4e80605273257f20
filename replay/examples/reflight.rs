//! Reflies flight logs with the libraries alone, and says of each what it is.
//!
//! `cargo run --release --package replay --no-default-features --example reflight -- FLIGHT.mcap...`
//!
//! It ends with 1 when a log is not exact.

use std::path::PathBuf;
use std::process::ExitCode;

use replay::{Options, Outcome, verify};

fn main() -> ExitCode {
    let logs: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let mut all_exact = !logs.is_empty();
    for log in logs {
        match verify(&log, &Options::default(), |_tick| ()) {
            Ok(verdict) => {
                println!("{}: {}", log.display(), verdict.judgement);
                all_exact &= verdict.judgement.outcome == Outcome::Exact;
            }
            Err(error) => {
                println!("{}: {error}", log.display());
                all_exact = false;
            }
        }
    }
    if all_exact { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
