//! Wake at a fin: what a rotor's wake does to the air at the fin on its side.
//!
//! # Equations
//! ```text
//! V_V = c·v·(R/r)²·n        c: mean over the fin's height of what stands in the wake, 0 … 1
//! ```
//! r/R, and where the wake goes, are those of `wake_course`; by continuity
//! the air in it goes as much faster as it has grown narrower.
//! # Signs
//! The component's velocity through the wake, as in [`rotor_wake`](super::rotor_wake): along the thrust.
//! # Assumptions
//! An estimate throughout: the source adds such a velocity at each fin, and its table is not at hand.
//! The fin is a line of four points above one another at its reference station; the other side's rotor
//! does not reach it. The velocity is in the plane of symmetry. What the pair of wakes pushes to the
//! side at the tail is the sidewash factor of the fins, which was measured with all of it: a second
//! sidewash from here would count it twice.
//!
//! In hover and slow flight the wake passes under the fin; it comes up to it between 60 and 80 kt as a
//! helicopter, and its inner edge is no further in than the fin, which is mostly outside.

use super::wake_course::{Course, contracted};
use crate::frames::{Body, Structural, Vec3};
use crate::mast::TiltedMast;
use crate::math::square;
use crate::motion::Motion;

/// Points over the fin's height.
const POINTS: usize = 4;

/// What the right fin's wake depends on.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// This side's mast.
    pub mast: TiltedMast,
    /// Its hub.
    pub hub_from_cg_m: Vec3<Body>,
    /// v of its rotor.
    pub induced_mps: f64,
    /// R.
    pub rotor_radius_m: f64,
    /// The fin's reference point.
    pub centre_m: Vec3<Structural>,
    /// Its span.
    pub span_m: f64,
}

/// Velocity of the right fin through the right rotor's wake.
pub fn evaluate(inputs: &Inputs) -> Vec3<Body> {
    let (hub, radius_m) = (inputs.hub_from_cg_m, inputs.rotor_radius_m);
    let course = Course::new(&inputs.motion, &inputs.mast, hub, inputs.induced_mps);
    let from_hub = inputs.centre_m.from_cg(inputs.motion.cg_m) - hub;

    let mut faster = 0.0;
    for i in 0..POINTS {
        let up_m = inputs.span_m * ((i as f64 + 0.5) / POINTS as f64 - 0.5);
        let point = Vec3::new(from_hub.x, from_hub.y, from_hub.z - up_m) * (1.0 / radius_m);
        let (ahead, down) = (point.dot(course.forward), -point.dot(course.axis));
        if down <= 0.0 || course.is_far(ahead, down) {
            continue;
        }
        let radius = contracted(down);
        let passing = course.passing(ahead, down, radius);
        if passing.is_elsewhere() {
            continue;
        }
        let [covered, ..] = passing.covered(point.y.into()).to_array();
        faster += covered / square(radius);
    }
    course.axis * (faster / POINTS as f64 * inputs.induced_mps)
}
