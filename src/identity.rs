//! Who flies: what this program was built from.

use logs::Identity;

/// Everything a log says of the program that wrote it.
pub fn identity() -> Identity {
    logs::identity!("tiltrotor")
}
