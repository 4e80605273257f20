//! What the shapes of airframe and surfaces are cut from: stations, sections, colours.

use engine::display::Wing;
use engine::frames::{Structural, Vec3};
use engine::math::tan;

use super::solid::{Point, ring};

/// Of most of it.
pub const WHITE: u32 = 0xEC_EE_F0_FF;
/// Of what is painted.
pub const BLUE: u32 = 0x24_57_A8_FF;

/// A drawing's station in the airframe's axes.
pub fn station(aft: f32, right: f32, up: f32) -> Point {
    [-aft, right, -up]
}

/// The quarter chord of the wing at a buttline.
pub fn wing_quarter_m(wing: &Wing, right: f64) -> Vec3<Structural> {
    let Vec3 { x, y, z, .. } = wing.quarter_chord_m;
    let out = right.abs() - y;
    Vec3::new(x + tan(wing.sweep_rad) * out, right, z + tan(wing.dihedral_rad) * out)
}

/// The whole chord.
pub const WHOLE: [f32; 2] = [0.0, 1.0];

/// A symmetric wing section around its quarter chord, flat or standing; of its chord from one part to another.
pub fn section(
    quarter_m: Vec3<Structural>,
    chord_m: f64,
    thickness_ratio: f64,
    standing: bool,
    [from, to]: [f32; 2],
) -> Vec<Point> {
    let [aft, right, up] = [quarter_m.x, quarter_m.y, quarter_m.z].map(|x| x as f32);
    let (chord, thickness) = (chord_m as f32, thickness_ratio as f32);
    ring(28, |s, c| {
        // Cosine spacing from the rear end around the front and back.
        let along = from + (to - from) * 0.5 * (1.0 + c);
        let half = thickness
            * (1.4845 * along.sqrt() - 0.630 * along - 1.758 * along.powi(2)
                + 1.4215 * along.powi(3)
                - 0.518 * along.powi(4));
        let off = s.signum() * half * chord;
        let aft = aft + (along - 0.25) * chord;
        if standing { station(aft, right + off, up) } else { station(aft, right, up + off) }
    })
}
