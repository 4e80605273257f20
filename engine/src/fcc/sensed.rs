//! What the flight control computer's sensors read.

use crate::frames::{Body, Euler, Vec3};

/// What the computer's sensors read.
#[derive(Clone, Copy, Debug)]
pub struct Sensed {
    /// Angular rate of the body.
    pub angular_rate_radps: Vec3<Body>,
    /// Attitude.
    pub euler: Euler,
    /// True airspeed.
    pub airspeed_mps: f64,
    /// ½ρV².
    pub dynamic_pressure_pa: f64,
    /// Ω.
    pub rotor_speed_radps: f64,
    /// βm, mean of both nacelles.
    pub mast_tilt_rad: f64,
    /// How fast both tilt, mean.
    pub mast_tilt_rate_radps: f64,
    /// Whether a main wheel bears weight.
    pub weight_on_wheels: bool,
}
