//! Who flies: what this library was built from.

use logs::Identity;

/// Everything a log says of the program that wrote it.
pub fn identity() -> Identity {
    logs::identity!("tiltrotor (FMU)")
}
