//! Prints `modelDescription.xml`: `describe 2` or `describe 3`, the version of FMI.

use std::process::ExitCode;

use tiltrotor_fmi::description::{Version, model_description};

fn main() -> ExitCode {
    let version = match std::env::args().nth(1).as_deref() {
        Some("2") => Version::Fmi2,
        Some("3") => Version::Fmi3,
        _ => {
            eprintln!("describe: expected 2 or 3, the version of FMI");
            return ExitCode::from(2);
        }
    };
    print!("{}", model_description(version));
    ExitCode::SUCCESS
}
