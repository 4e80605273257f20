//! The cockpit: lining, panel with screens, seats, crew, sticks, power levers, pedals.
//!
//! # Assumptions
//! No drawing of the cockpit is at hand: two seats side by side, the first pilot's on the right.
//! Everything here is for recognition, in stations of the XV-15.

use engine::aircraft::Params as Aircraft;

use super::{Likeness, SIDES, Smooth, fuselage, steps};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point, ring};
use crate::paint;

/// Buttline of a seat's middle, m.
pub const SEAT_M: f64 = 0.36;
/// Pilot's eye over the seat's middle: station and waterline, m.
pub const EYE_M: [f64; 2] = [4.95, 1.83];
/// Where the sticks turn, m.
pub const STICK_M: [f64; 2] = [4.60, 0.98];
/// Where the power levers turn: station, waterline, and how far left of the seat, m.
pub const LEVER_M: [f64; 3] = [5.02, 1.22, 0.27];
/// The pedals' middle, m.
pub const PEDALS_M: [f64; 2] = [4.12, 1.13];
/// The gear's handle, m.
pub const GEAR_HANDLE_M: Point = [4.27, 0.10, 1.40];
/// The flaps' lever turns here, m.
pub const FLAP_LEVER_M: Point = [4.62, 0.06, 1.19];

const FLOOR_M: f64 = 1.02;
const REAR_M: f64 = 6.35;
/// The panel's lower and upper edge: station and waterline.
const PANEL_M: [[f64; 2]; 2] = [[4.31, 1.20], [4.20, 1.655]];
/// Half the side of a screen.
const SCREEN_M: f64 = 0.172;
/// Waterline of a screen's middle.
const SCREEN_UP_M: f64 = 1.472;

/// A bar of one cross-section (station, waterline) from buttline to buttline.
fn prism(mesh: &mut Mesh, material: usize, section: &[[f64; 2]], [left, right]: [f64; 2]) {
    let ring = |y: f64| section.iter().map(|&[aft, up]| [aft, y, up]).collect::<Vec<_>>();
    mesh.body(material, &[ring(left), ring(right)]);
}

/// All of it.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let like = Likeness::of(aircraft);
    let lining = Part::new("lining", lining(aircraft)).smooth(50.0);
    std::iter::once(lining).chain(fittings().into_iter().map(|part| like.part(part))).collect()
}

/// What is inside the lining.
fn fittings() -> Vec<Part> {
    let mut parts = vec![
        Part::new("panel", panel()).smooth(20.0),
        Part::new("seats", seats()).smooth(40.0),
        Part::new("gear.handle", gear_handle()),
        Part::new("flap.lever", flap_lever()),
        Part::new("warning.lamp", warning_lamp()),
    ];
    for (_, name, side) in SIDES {
        let seat = side * SEAT_M;
        parts.push(Part::new(format!("pfd.{name}"), screen(seat)).with_texture(paint::SCREEN));
        parts.push(Part::new(format!("stick.{name}"), stick(seat)).smooth(50.0));
        parts.push(Part::new(format!("lever.{name}"), lever(seat)).smooth(50.0));
        for (foot, right) in [("left", -0.11), ("right", 0.11)] {
            parts.push(Part::new(format!("pedal.{name}.{foot}"), pedal(seat + right)));
        }
        parts.push(Part::new(format!("crew.{name}"), crew(seat)).smooth(60.0));
    }
    parts
}

/// The skin's inside with its windows, floor and bulkhead.
fn lining(aircraft: &Aircraft) -> Mesh {
    let (shape, like) = (&aircraft.display.fuselage, Likeness::of(aircraft));
    let [front, rear, floor] = [like.aft(3.45), like.aft(REAR_M), like.up(FLOOR_M)];
    let rings = fuselage::rings(shape, &steps(front, rear, 24), like.length(0.035));
    let mut skin = Mesh::default();
    skin.skin(material::INTERIOR, &rings);
    for window in fuselage::windows(shape, like) {
        skin.cut(&window);
    }
    skin.cut(&[Half::below(2, floor)]);
    skin.paint(&[Half::below(2, like.up(1.55))], material::FLOOR);
    let mut mesh = skin.inside_out();
    let smooth = Smooth::new(&shape.section_m);
    let lines: Vec<Vec<Point>> = steps(front, rear, 10)
        .into_iter()
        .map(|aft| {
            let half = smooth.at(aft)[1] - like.length(0.03);
            vec![[aft, half, floor], [aft, -half, floor]]
        })
        .collect();
    mesh.sheet(material::FLOOR, &lines);
    if let Some(last) = fuselage::rings(shape, &[rear], like.length(0.035)).pop() {
        mesh.polygons.push(two_sided_face(material::INTERIOR, &last));
    }
    mesh
}

fn two_sided_face(material: usize, rim: &[Point]) -> crate::mesh::Polygon {
    let mut mesh = Mesh::default();
    mesh.face(material, rim);
    let mut face = mesh.two_sided().polygons.remove(0);
    face.material = material;
    face
}

/// A point of the panel at a waterline, `out_m` off it towards the crew.
fn on_panel(right: f64, up: f64, out_m: f64) -> Point {
    let [[low_aft, low], [high_aft, high]] = PANEL_M;
    [low_aft + (high_aft - low_aft) * (up - low) / (high - low) + out_m, right, up]
}

fn panel() -> Mesh {
    let mut mesh = Mesh::default();
    let [low, high] = PANEL_M;
    let back = 4.06;
    prism(&mut mesh, material::PANEL, &[low, high, [back, high[1]], [back, low[1]]], [-0.60, 0.60]);
    // The hood over it.
    prism(
        &mut mesh,
        material::BLACK,
        &[[4.28, 1.668], [4.28, 1.682], [4.22, 1.70], [3.90, 1.685], [3.90, 1.655]],
        [-0.60, 0.60],
    );
    // The pedestal between the seats.
    prism(
        &mut mesh,
        material::PANEL,
        &[[4.25, FLOOR_M], [4.25, 1.28], [4.40, 1.22], [5.05, 1.14], [5.05, FLOOR_M]],
        [-0.10, 0.10],
    );
    // Frames around the screens.
    for (_, _, side) in SIDES {
        let frame = SCREEN_M + 0.012;
        let corner = |y: f64, z: f64| on_panel(side * SEAT_M + y, SCREEN_UP_M + z, 0.004);
        mesh.face(
            material::BLACK,
            &[
                corner(-frame, -frame),
                corner(frame, -frame),
                corner(frame, frame),
                corner(-frame, frame),
            ],
        );
    }
    // Breakers and boxes in the middle.
    for row in 0..4_u8 {
        for column in 0..3_u8 {
            let (y, z) = (-0.13 + 0.065 * f64::from(column), 1.29 + 0.075 * f64::from(row));
            let corner = |dy: f64, dz: f64| on_panel(y + dy, z + dz, 0.003);
            let face =
                [corner(0.0, 0.0), corner(0.052, 0.0), corner(0.052, 0.05), corner(0.0, 0.05)];
            let colour = if (row + column) % 3 == 0 { material::DARK } else { material::FLOOR };
            mesh.face(colour, &face);
        }
    }
    mesh
}

fn screen(seat: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let corner = |y: f64, z: f64| on_panel(seat + y * SCREEN_M, SCREEN_UP_M + z * SCREEN_M, 0.008);
    mesh.face(
        material::SCREEN,
        &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
    );
    mesh.textured(|[_, y, z]| {
        [0.5 + 0.5 * (y - seat) / SCREEN_M, 0.5 + 0.5 * (z - SCREEN_UP_M) / SCREEN_M]
    })
}

fn seats() -> Mesh {
    let mut mesh = Mesh::default();
    for (_, _, side) in SIDES {
        let seat = side * SEAT_M;
        let width = [seat - 0.20, seat + 0.20];
        prism(
            &mut mesh,
            material::SEAT,
            &[[4.72, 1.24], [4.72, 1.34], [5.16, 1.30], [5.16, 1.20]],
            width,
        );
        prism(
            &mut mesh,
            material::SEAT,
            &[[5.13, 1.26], [5.27, 1.86], [5.34, 1.86], [5.22, 1.24]],
            [seat - 0.19, seat + 0.19],
        );
        prism(
            &mut mesh,
            material::SEAT,
            &[[5.24, 1.87], [5.26, 2.08], [5.32, 2.08], [5.33, 1.87]],
            [seat - 0.11, seat + 0.11],
        );
        prism(
            &mut mesh,
            material::DARK,
            &[[4.80, FLOOR_M], [4.80, 1.25], [5.15, 1.22], [5.15, FLOOR_M]],
            [seat - 0.15, seat + 0.15],
        );
    }
    mesh
}

fn stick(seat: f64) -> Mesh {
    let [aft, up] = STICK_M;
    let mut mesh = Mesh::default();
    mesh.bar(material::METAL, [aft, seat, up], [aft - 0.03, seat, up + 0.22], 0.014);
    mesh.bar(material::METAL, [aft - 0.03, seat, up + 0.22], [aft + 0.05, seat, up + 0.36], 0.014);
    mesh.cone(
        material::BLACK,
        ([aft + 0.045, seat, up + 0.35], 0.021),
        ([aft + 0.075, seat, up + 0.47], 0.026),
        14,
    );
    mesh.bar(
        material::RED,
        [aft + 0.055, seat - 0.01, up + 0.47],
        [aft + 0.055, seat - 0.01, up + 0.485],
        0.009,
    );
    mesh.cone(
        material::DARK,
        ([aft, seat, up - 0.01], 0.07),
        ([aft - 0.01, seat, up + 0.07], 0.025),
        14,
    );
    mesh
}

/// The power lever with the nacelle switch on its head.
fn lever(seat: f64) -> Mesh {
    let [aft, up, left] = LEVER_M;
    let right = seat - left;
    let mut mesh = Mesh::default();
    mesh.bar(material::METAL, [aft, right, up], [aft - 0.30, right, up + 0.10], 0.014);
    mesh.cone(
        material::BLACK,
        ([aft - 0.28, right, up + 0.095], 0.022),
        ([aft - 0.42, right, up + 0.145], 0.024),
        14,
    );
    mesh.cuboid(
        material::PANEL,
        [aft - 0.46, right - 0.028, up + 0.13],
        [aft - 0.41, right + 0.028, up + 0.18],
    );
    mesh.bar(
        material::YELLOW,
        [aft - 0.44, right, up + 0.18],
        [aft - 0.44, right, up + 0.195],
        0.012,
    );
    mesh
}

fn pedal(right: f64) -> Mesh {
    let [aft, up] = PEDALS_M;
    let mut mesh = Mesh::default();
    prism(
        &mut mesh,
        material::METAL,
        &[
            [aft - 0.05, up + 0.10],
            [aft + 0.02, up - 0.06],
            [aft + 0.035, up - 0.055],
            [aft - 0.035, up + 0.105],
        ],
        [right - 0.055, right + 0.055],
    );
    mesh.bar(material::DARK, [aft - 0.02, right, up], [aft - 0.25, right, up - 0.05], 0.012);
    mesh
}

fn gear_handle() -> Mesh {
    let [aft, right, up] = GEAR_HANDLE_M;
    let mut mesh = Mesh::default();
    mesh.bar(material::METAL, [aft - 0.02, right, up], [aft + 0.07, right, up], 0.007);
    mesh.bar(
        material::RED,
        [aft + 0.08, right - 0.012, up],
        [aft + 0.08, right + 0.012, up],
        0.024,
    );
    mesh
}

fn flap_lever() -> Mesh {
    let [aft, right, up] = FLAP_LEVER_M;
    let mut mesh = Mesh::default();
    mesh.bar(material::METAL, [aft, right, up], [aft, right, up + 0.10], 0.006);
    mesh.cuboid(
        material::LIGHT_BLUE,
        [aft - 0.012, right - 0.025, up + 0.10],
        [aft + 0.012, right + 0.025, up + 0.115],
    );
    mesh
}

/// Both pilots' master warning, on the hood.
fn warning_lamp() -> Mesh {
    let mut mesh = Mesh::default();
    for (_, _, side) in SIDES {
        let right = side * SEAT_M;
        mesh.cuboid(
            material::LIGHT_RED,
            [4.280, right - 0.018, 1.669],
            [4.284, right + 0.018, 1.680],
        );
    }
    mesh
}

/// Somebody in a flight suit, seen from outside.
fn crew(seat: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let body = |up: f64, deep: f64, wide: f64, aft: f64| {
        ring(16, |s, c| [aft + deep * c, seat + wide * s, up])
    };
    mesh.body(
        material::OVERALL,
        &[
            body(1.30, 0.13, 0.17, 5.02),
            body(1.48, 0.13, 0.18, 5.06),
            body(1.62, 0.12, 0.20, 5.09),
            body(1.69, 0.08, 0.10, 5.10),
        ],
    );
    mesh.body(
        material::SKIN,
        &[
            body(1.68, 0.05, 0.05, 5.10),
            body(1.76, 0.085, 0.065, 5.08),
            body(1.84, 0.09, 0.07, 5.08),
        ],
    );
    mesh.body(
        material::WHITE,
        &[
            body(1.80, 0.11, 0.10, 5.10),
            body(1.88, 0.135, 0.12, 5.10),
            body(1.95, 0.11, 0.10, 5.10),
            body(1.985, 0.04, 0.04, 5.10),
        ],
    );
    for side in [-1.0, 1.0] {
        let y = |out: f64| seat + side * out;
        mesh.bar(material::OVERALL, [5.0, y(0.09), 1.36], [4.60, y(0.10), 1.38], 0.075);
        mesh.bar(material::OVERALL, [4.60, y(0.10), 1.38], [4.25, y(0.10), 1.10], 0.055);
        mesh.bar(material::OVERALL, [5.09, y(0.21), 1.62], [4.90, y(0.25), 1.38], 0.05);
        mesh.bar(material::OVERALL, [4.90, y(0.25), 1.38], [4.64, y(0.12), 1.42], 0.04);
    }
    mesh
}
