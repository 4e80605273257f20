//! tiltrotor.
fn main() {}
