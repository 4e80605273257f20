//! The bays that the gear folds into.

use engine::aircraft::Params as Aircraft;

use super::Likeness;
use crate::mesh::{Half, Region};

/// A bay: stations of its ends, buttlines of its sides, m.
pub struct Bay {
    /// From front to back.
    pub aft_m: [f64; 2],
    /// From left to right.
    pub right_m: [f64; 2],
}

impl Bay {
    /// What of a skin is over it, below a waterline.
    pub fn below(&self, waterline_m: f64) -> Region {
        vec![
            Half::above(0, self.aft_m[0]),
            Half::below(0, self.aft_m[1]),
            Half::above(1, self.right_m[0]),
            Half::below(1, self.right_m[1]),
            Half::below(2, waterline_m),
        ]
    }

    /// The buttline between its doors, m.
    pub fn middle_m(&self) -> f64 {
        0.5 * (self.right_m[0] + self.right_m[1])
    }
}

/// The nose gear's.
pub fn nose_bay(like: Likeness) -> Bay {
    Bay { aft_m: [3.32, 4.52].map(|x| like.aft(x)), right_m: [-0.27, 0.27].map(|y| like.length(y)) }
}

/// The right main gear's, around the leg, as far as the pod is.
pub fn main_bay(aircraft: &Aircraft) -> Bay {
    let like = Likeness::of(aircraft);
    let buttline_m = aircraft.display.gear_pods.buttline_m;
    Bay {
        aft_m: [7.22, 8.62].map(|x| like.aft(x)),
        right_m: [-0.22, 0.38].map(|y| buttline_m + like.length(y)),
    }
}
