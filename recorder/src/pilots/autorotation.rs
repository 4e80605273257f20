//! Autorotation: down to the ground as a helicopter when neither engine gives anything.
//!
//! # Equations
//! ```text
//! glide:   θ = ∫k_i·(V − V_g) + k_V·(V − V_g)                          lever down, the governor holds the rotors
//! flare:   ẇ_w = −√(2·a·(h − h_c))     θ = θ₀ + ∫k_s·(ẇ_w − ḣ) + k_f·(ẇ_w − ḣ)      below h_f, V falls
//! cushion: below h_c the nose comes level and the lever up, as fast as the sink is too great
//! ```
//! V_g, h_f and h_c are the aircraft's, from its file.
//! # Signs
//! Nose up, lever up, climb positive; height is that of the centre of gravity over the ground.
//! # Assumptions
//! Flown straight ahead onto whatever is there; drift is not taken off, so that a wind from the side is not
//! landed in. The rotors' energy is that of a second of hover: it lasts for one pull of the lever, no earlier than the cushion.

use engine::Outputs;
use engine::math::{clamp, max, min, sqrt};
use engine::pilot;
use engine::units::DEGREE_RAD as DEG;

use super::skill::{HAND_S, Observation};

/// k_V, rad per m/s, and k_i, rad per m.
const BY_SPEED: [f64; 2] = [0.012, 0.003];
/// Pitch that the glide takes at most.
const GLIDE_RAD: [f64; 2] = [-14.0 * DEG, 8.0 * DEG];
/// a, m/s².
const FLARE_MPS2: f64 = 3.4;
/// How far ahead the flare looks: that long the nose takes to come up, s.
const LEAD_S: f64 = 1.7;
/// k_f, rad per m/s, and k_s, rad per m.
const BY_SINK: [f64; 2] = [0.12, 0.08];
/// Pitch of the flare at most, and that of the touchdown.
const FLARE_RAD_MAX: f64 = 20.0 * DEG;
const TOUCHDOWN_RAD: f64 = 10.0 * DEG;
/// Sink that the cushion is to leave, m/s.
const TOUCHDOWN_MPS: f64 = 0.8;
/// How fast the nose comes down before the touchdown, rad/s.
const LEVEL_RADPS: f64 = 12.0 * DEG;
/// Sink by height over the wheels' touch, 1/s.
const CUSHION_PER_S: f64 = 0.6;
/// Lever by sink that is too great, per m/s and second.
const PULL_NORM: f64 = 0.4;
/// Sink at which the flare ends, m/s.
const FLARED_MPS: f64 = 1.0;
/// How fast the lever goes down after the failure: within a second, 1/s.
const LOWER_PER_S: f64 = 1.5;
/// Engines that give less than this part of what they could give nothing.
const OUT_NORM: f64 = 0.1;

/// Whether the gauges show that no engine gives anything.
pub fn engines_are_out(seen: &Outputs) -> bool {
    let power_w = seen.engines.power_w;
    max(power_w.left, power_w.right) < OUT_NORM * seen.engines.available_w
}

/// What the hands remember of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Autorotation {
    pitch_rad: f64,
    lever_norm: f64,
    begun: bool,
}

impl Autorotation {
    /// Pitch and lever for this moment.
    pub fn hands(&mut self, seen: &Outputs, book: &pilot::Params) -> (f64, f64) {
        let eyes = Observation::look(seen);
        if !self.begun {
            *self = Self {
                pitch_rad: seen.euler.pitch_rad,
                lever_norm: seen.cockpit.collective_norm,
                begun: true,
            };
        }
        let height_m = seen.height_above_ground_m;
        if height_m < book.cushion_m {
            return self.cushion(seen, &eyes, book.standing_m);
        }
        self.lever_norm = max(0.0, self.lever_norm - LOWER_PER_S * HAND_S);
        let pitch_rad = if height_m < book.flare_m {
            self.flare(&eyes, height_m - book.cushion_m)
        } else {
            self.glide(seen.airspeed_mps - book.glide_mps)
        };
        (pitch_rad, self.lever_norm)
    }

    fn glide(&mut self, fast_mps: f64) -> f64 {
        let [at_once, learned] = BY_SPEED;
        let within = |rad: f64| clamp(rad, GLIDE_RAD[0], GLIDE_RAD[1]);
        self.pitch_rad = within(self.pitch_rad + learned * fast_mps * HAND_S);
        within(self.pitch_rad + at_once * fast_mps)
    }

    fn flare(&mut self, eyes: &Observation, over_cushion_m: f64) -> f64 {
        let ahead_m = over_cushion_m + LEAD_S * eyes.climb_mps;
        let wanted_mps = -sqrt(2.0 * FLARE_MPS2 * max(0.0, ahead_m)) - FLARED_MPS;
        let too_low_mps = wanted_mps - eyes.climb_mps;
        let [at_once, learned] = BY_SINK;
        let within = |rad: f64| clamp(rad, GLIDE_RAD[0], FLARE_RAD_MAX);
        self.pitch_rad = within(self.pitch_rad + learned * too_low_mps * HAND_S);
        within(self.pitch_rad + at_once * too_low_mps)
    }

    fn cushion(&mut self, seen: &Outputs, eyes: &Observation, standing_m: f64) -> (f64, f64) {
        let height_m = seen.height_above_ground_m;
        let step_rad = LEVEL_RADPS * HAND_S;
        // From where the nose is: the flare may have asked for more than it gave.
        self.pitch_rad = min(self.pitch_rad, max(seen.euler.pitch_rad, TOUCHDOWN_RAD));
        self.pitch_rad += clamp(TOUCHDOWN_RAD - self.pitch_rad, -step_rad, step_rad);
        let wanted_mps = -TOUCHDOWN_MPS - CUSHION_PER_S * max(0.0, height_m - standing_m);
        let too_low_mps = max(0.0, wanted_mps - eyes.climb_mps);
        self.lever_norm = min(1.0, self.lever_norm + PULL_NORM * too_low_mps * HAND_S);
        (self.pitch_rad, self.lever_norm)
    }
}
