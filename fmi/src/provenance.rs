//! Who flies: what this library was built from.

use logs::Identity;

/// Everything a log says of the program that wrote it.
pub fn identity() -> Identity {
    Identity::new()
        .with("program", concat!("tiltrotor (FMU) ", env!("CARGO_PKG_VERSION")))
        .with("commit", env!("TILTROTOR_COMMIT"))
        .with("dirty", env!("TILTROTOR_DIRTY"))
        .with("compiler", env!("TILTROTOR_RUSTC"))
        .with("target", env!("TILTROTOR_TARGET"))
        .with("target_features", env!("TILTROTOR_TARGET_FEATURES"))
        .with("profile", env!("TILTROTOR_PROFILE"))
}
