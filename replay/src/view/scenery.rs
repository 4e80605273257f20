//! The ground: a plane and lines that move with the aircraft in whole steps, and the pad.

use rerun::{LineStrips3D, Mesh3D};

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
