//! What the event detector looks at after every tick.

use engine::Outputs;
use engine::fcc::scas::Saturation;
use engine::outputs::Validity;

/// What is looked at after every tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Observed {
    /// Where the answer is not to be trusted.
    pub validity: Validity,
    /// What of the SCAS is at its limit.
    pub saturated: Saturation,
    /// Downwards.
    pub sink_mps: f64,
    /// Over the ground, level.
    pub ground_speed_mps: f64,
    /// Whether a wheel touches the ground.
    pub on_ground: bool,
}

impl Observed {
    /// Of a tick's outputs.
    pub fn of(outputs: &Outputs) -> Self {
        let (v, legs) = (outputs.velocity_mps, &outputs.landing_gear);
        let push_n = legs.nose.push_n + legs.main.map(|leg| leg.push_n).sum();
        Self {
            validity: outputs.validity,
            saturated: outputs.scas.saturated,
            sink_mps: v.z,
            ground_speed_mps: engine::math::sqrt(v.x * v.x + v.y * v.y),
            on_ground: push_n > 0.0,
        }
    }

    /// Sink and speed, as an event has them.
    pub(super) fn measured(&self) -> [f64; 2] {
        [self.sink_mps, self.ground_speed_mps]
    }
}
