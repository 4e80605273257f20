//! The ground: a plane and lines that move with the aircraft in whole steps, and the pad.

use engine::Outputs;
use engine::frames::{Ned, Vec3};
use engine::math::{cos, sin};
use engine::units::compass_deg;
use rerun::{LineStrips3D, Mesh3D, Points3D, Radius};

use super::columns::point;
use super::solid::{Point, Solid, ring};

/// Between far lines; the plane moves by as much.
pub const PLANE_STEP_M: f64 = 500.0;
/// Between near lines; they move by as much.
pub const GRID_STEP_M: f64 = 20.0;

/// Half the plane's side: beyond, the eye does not tell ground from haze.
const PLANE_M: f32 = 12_000.0;
const FAR_LINES: i16 = 16;
const NEAR_LINES: i16 = 15;

const UP: Point = [0.0, 0.0, -1.0];
const GRASS: u32 = 0x4A_5C_44_FF;
const CONCRETE: u32 = 0x6E_72_76_FF;
const PAINT: u32 = 0xEC_EE_F0_FF;
const LINE: u32 = 0x8C_9C_84_FF;

/// The plane, a little below the ground so that what lies on it is seen.
pub fn plane() -> Mesh3D {
    let mut solid = Solid::default();
    let rim = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    solid.fan(&rim.map(|[north, east]| [north * PLANE_M, east * PLANE_M, 0.3]), UP, GRASS);
    solid.mesh()
}

/// Lines far away.
pub fn far_lines() -> LineStrips3D {
    lines(FAR_LINES, PLANE_STEP_M as f32, 0.2, 0.25)
}

/// Lines around the aircraft.
pub fn near_lines() -> LineStrips3D {
    lines(NEAR_LINES, GRID_STEP_M as f32, 0.1, 0.06)
}

/// North and east, `count` either side. In metres: a width in points is the same at both ends of a
/// line, and the viewer makes a long one that passes the eye as broad as a road.
fn lines(count: i16, step_m: f32, down_m: f32, radius_m: f32) -> LineStrips3D {
    let reach_m = f32::from(count) * step_m;
    let strips = (-count..=count).flat_map(|i| {
        let at_m = f32::from(i) * step_m;
        [
            [[-reach_m, at_m, down_m], [reach_m, at_m, down_m]],
            [[at_m, -reach_m, down_m], [at_m, reach_m, down_m]],
        ]
    });
    LineStrips3D::new(strips).with_radii([radius_m]).with_colors([LINE])
}

/// Concrete around the origin, with a ring and a bar to the north.
pub fn pad() -> Mesh3D {
    let mut solid = Solid::default();
    let mut disc = |radius_m: f32, down_m: f32, colour: u32| {
        solid.fan(&ring(64, |s, c| [radius_m * c, radius_m * s, down_m]), UP, colour);
    };
    disc(18.0, 0.06, CONCRETE);
    disc(15.0, 0.04, PAINT);
    disc(14.4, 0.02, CONCRETE);
    let bar = [[10.0, -0.4], [17.0, -0.4], [17.0, 0.4], [10.0, 0.4]];
    solid.fan(&bar.map(|[north, east]| [north, east, 0.0]), UP, PAINT);
    solid.mesh()
}

/// An outline on the ground where a flight began, along the heading that it had there: the ground of a log is a
/// plane, and of a runway it knows nothing.
#[derive(Clone, Copy, Debug)]
pub struct StartMark {
    on_ground_m: Vec3<Ned>,
    heading_rad: f64,
}

impl StartMark {
    const LENGTH_M: f64 = 300.0;
    const HALF_WIDTH_M: f64 = 15.0;
    const BEHIND_M: f64 = 30.0;
    const STEP_M: f64 = 100.0;
    /// Above the lines on the ground.
    const UP_M: f64 = 0.1;

    /// Where this is the first that is seen.
    pub fn of(outputs: &Outputs) -> Self {
        let Vec3 { x, y, z, .. } = outputs.position_m;
        let on_ground_m = Vec3::new(x, y, z + outputs.height_above_ground_m - Self::UP_M);
        Self { on_ground_m, heading_rad: outputs.euler.heading_rad }
    }

    fn place(&self, ahead_m: f64, right_m: f64) -> Point {
        let (s, c) = (sin(self.heading_rad), cos(self.heading_rad));
        let along = Vec3::new(c * ahead_m - s * right_m, s * ahead_m + c * right_m, 0.0);
        point(self.on_ground_m + along)
    }

    /// Its lines, one across at the start and at every hundred metres, and what they are.
    pub fn drawn(&self) -> (LineStrips3D, Points3D) {
        let (near, far, side) = (-Self::BEHIND_M, Self::LENGTH_M, Self::HALF_WIDTH_M);
        let rim = [[near, -side], [far, -side], [far, side], [near, side], [near, -side]];
        let across = |ahead_m: f64| vec![self.place(ahead_m, -side), self.place(ahead_m, side)];
        let steps = || (0..3).map(|step| f64::from(step) * Self::STEP_M);
        let outline = rim.iter().map(|[ahead_m, right_m]| self.place(*ahead_m, *right_m)).collect();
        let lines = std::iter::once(outline).chain(steps().map(across));
        let heading_deg = compass_deg(self.heading_rad);
        let lines = LineStrips3D::new(lines.collect::<Vec<Vec<Point>>>())
            .with_radii([0.2])
            .with_colors([PAINT]);
        let labels = Points3D::new([self.place(0.0, side)])
            .with_radii([Radius::new_ui_points(2.0)])
            .with_colors([PAINT])
            .with_labels([format!("start, heading {heading_deg:03.0}\u{b0}")])
            .with_show_labels(true);
        (lines, labels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_start_is_marked_on_the_ground_along_its_heading() {
        let mut outputs = Outputs { height_above_ground_m: 5.0, ..Outputs::default() };
        outputs.position_m = Vec3::new(10.0, 20.0, -5.0);
        outputs.euler.heading_rad = engine::math::FRAC_PI_2;
        let mark = StartMark::of(&outputs);
        let near = |at: Point, wanted: [f32; 3]| {
            assert!(at.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-3), "{at:?} {wanted:?}");
        };
        near(mark.place(0.0, 0.0), [10.0, 20.0, -0.1]);
        // Eastward, and to the right of it the south.
        near(mark.place(100.0, 15.0), [-5.0, 120.0, -0.1]);
    }
}
