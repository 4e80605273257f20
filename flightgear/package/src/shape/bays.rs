//! The bays that the gear folds into.

use engine::display::GearPods;

use crate::mesh::{Half, Region};

/// Stations of the nose gear's bay, m.
pub const NOSE_BAY_M: [f64; 2] = [3.32, 4.52];
/// Half its width, m.
pub const NOSE_BAY_HALF_M: f64 = 0.27;
/// Stations of a main gear's bay, m.
pub const MAIN_BAY_M: [f64; 2] = [7.22, 8.62];
/// Half its width, m.
pub const MAIN_BAY_HALF_M: f64 = 0.30;

/// The bay in the right pod's skin.
pub fn main_bay(shape: &GearPods) -> Region {
    vec![
        Half::above(0, MAIN_BAY_M[0]),
        Half::below(0, MAIN_BAY_M[1]),
        Half::above(1, main_bay_middle_m(shape) - MAIN_BAY_HALF_M),
        Half::below(1, main_bay_middle_m(shape) + MAIN_BAY_HALF_M),
        Half::below(2, shape.waterline_m - 0.1),
    ]
}

/// The bay is around the leg, as far as the pod is.
pub fn main_bay_middle_m(shape: &GearPods) -> f64 {
    shape.buttline_m + 0.08
}
