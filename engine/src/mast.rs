//! Mast: where a tilted nacelle's thrust points.

use crate::frames::{Body, Vec3};
use crate::math::sin_cos;

/// A mast at its tilt, as the right one.
#[derive(Clone, Copy, Debug)]
pub struct TiltedMast {
    /// βm.
    pub tilt_rad: f64,
    /// sin βm.
    pub sin_tilt: f64,
    /// cos βm.
    pub cos_tilt: f64,
    /// Unit vector of the thrust, cant included.
    pub thrust_axis: Vec3<Body>,
}

impl TiltedMast {
    /// The mast tilted by `tilt_rad`; `cant_rad` is its outboard cant as a helicopter, which fades as it
    /// tilts.
    pub fn new(tilt_rad: f64, cant_rad: f64) -> Self {
        let (sin_tilt, cos_tilt) = sin_cos(tilt_rad);
        let (sin_cant, cos_cant) = sin_cos(cant_rad * cos_tilt);
        let thrust_axis = Vec3::new(sin_tilt * cos_cant, sin_cant, -cos_tilt * cos_cant);
        Self { tilt_rad, sin_tilt, cos_tilt, thrust_axis }
    }
}
