//! What the phases of a flight ask of the hands.

use engine::Outputs;
use engine::frames::{Ned, Vec3};
use engine::math::clamp;

use super::habits::{BANK_RAD, GENTLE_MPS, HOVER_MPS2, MOVING_MPS, SIDLE_MPS2};
use super::skill::HAND_S;

/// Which way the nacelles are to go.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Nacelles {
    #[default]
    Stay,
    Forward,
    Aft,
    Autorotation,
}

/// What the phases have asked for so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Order {
    pub forward_mps: f64,
    pub over_ground: bool,
    pub forward_mps2: f64,
    pub forward_mps2_max: f64,
    pub height_m: f64,
    pub climb_mps_max: f64,
    pub sink_mps_max: f64,
    pub heading_rad: f64,
    pub bank_rad_max: f64,
    pub nacelles: Nacelles,
    pub gear_down: bool,
    /// It lands with speed, because one engine does not let it hover.
    pub run_on: bool,
    /// Where it hovers.
    pub spot_m: Option<Vec3<Ned>>,
    /// Forward and to the right, on the way to what a phase of sidling wants.
    pub sidle_mps: [f64; 2],
    pub start_m: Vec3<Ned>,
    pub start_heading_rad: f64,
    /// Calibrated airspeed as the pilot reads it, m/s.
    pub airspeed_mps: f64,
    pub turned_rad: f64,
}

impl Order {
    /// To any side, no faster than hands would ask for.
    pub fn sidle(&mut self, wanted_mps: [f64; 2]) {
        let step_mps = SIDLE_MPS2 * HAND_S;
        for (now, wanted) in self.sidle_mps.iter_mut().zip(wanted_mps) {
            *now += clamp(wanted - *now, -step_mps, step_mps);
        }
        self.forward_mps = 0.0;
        self.spot_m = None;
    }

    /// What the flight is when it begins.
    pub fn beginning(seen: &Outputs) -> Self {
        Self {
            forward_mps: if seen.airspeed_mps > MOVING_MPS { seen.airspeed_mps } else { 0.0 },
            forward_mps2_max: HOVER_MPS2,
            height_m: seen.height_above_ground_m,
            climb_mps_max: GENTLE_MPS,
            sink_mps_max: GENTLE_MPS,
            heading_rad: seen.euler.heading_rad,
            bank_rad_max: BANK_RAD,
            gear_down: seen.cockpit.gear_down != 0,
            start_m: seen.position_m,
            start_heading_rad: seen.euler.heading_rad,
            airspeed_mps: seen.calibrated_airspeed_mps,
            ..Self::default()
        }
    }
}
