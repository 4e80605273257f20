//! Fuselage: skin, windows, the wing's fairing, pods of the main gear.

use engine::aircraft::Params as Aircraft;
use engine::display::Fuselage;
use engine::math::{pow_positive, sign};

use super::{Likeness, Smooth, bays, steps};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point, Polygon, Region, outline, ring};
use crate::paint;

/// Half the width of the XV-15's middle post of the windscreen, m.
const POST_M: f64 = 0.03;
/// Points around.
const AROUND: u16 = 40;

/// The rings of the skin, `inset_m` inside it.
pub fn rings(shape: &Fuselage, stations_m: &[f64], inset_m: f64) -> Vec<Vec<Point>> {
    let smooth = Smooth::new(&shape.section_m);
    let one = |&aft: &f64| {
        let [_, half, bottom, top] = smooth.at(aft);
        let (middle, tall) = (0.5 * (bottom + top), 0.5 * (top - bottom) - inset_m);
        let half = half - inset_m;
        ring(AROUND, |s, c| {
            // Between an ellipse and a box.
            let round = |v: f64| sign(v) * pow_positive(v.abs(), 0.72);
            [aft, half * round(s), middle + tall * round(c)]
        })
    };
    stations_m.iter().map(one).collect()
}

/// Where the skin is given: closely at the nose.
fn stations_m(shape: &Fuselage, like: Likeness) -> Vec<f64> {
    let [nose, end] = Smooth::new(&shape.section_m).range();
    let cabin = like.aft(5.5);
    let mut stations = vec![nose, nose + like.length(0.03), nose + like.length(0.08)];
    stations.extend(steps(nose + like.length(0.15), cabin, 22));
    stations.extend(steps(cabin, end, 24).into_iter().skip(1));
    stations
}

/// The windows: each a region of the skin.
pub fn windows(shape: &Fuselage, like: Likeness) -> Vec<Region> {
    let (m, post_half) = (|drawn: f64| like.length(drawn), like.length(POST_M));
    let [front, back, sill, head] = shape.windscreen_m;
    let [from, to, bottom, top] = shape.side_window_m;
    let mut windows = Vec::new();
    for side in [-1.0, 1.0] {
        let beside = |from: f64| {
            if side > 0.0 { Half::above(1, from) } else { Half::below(1, -from) }
        };
        let pane = |corners: &[[f64; 2]], from: f64| {
            let mut region = outline([0, 2], corners);
            region.push(beside(from));
            region
        };
        // The windscreen leans back to its head, and ends at a post that leans with it.
        let lean = 0.62;
        let post = |up: f64| front + m(0.62) + lean * (up - sill);
        windows.push(pane(
            &[
                [front - m(0.2), sill],
                [post(sill), sill],
                [post(head), head],
                [front - m(0.2), head],
            ],
            post_half,
        ));
        // The quarter window behind the post.
        windows.push(pane(
            &[
                [post(sill) + m(0.10), sill],
                [back + m(0.02), sill - m(0.12)],
                [back + m(0.02), head - m(0.08)],
                [post(head - m(0.08)) + m(0.10), head - m(0.08)],
            ],
            post_half,
        ));
        // Overhead, for looking into a turn.
        let [before, behind] = [back - m(0.02), back + m(0.48)];
        let [left, right] = if side > 0.0 { [0.12, 0.56] } else { [-0.56, -0.12] }.map(m);
        let corners = [[before, left], [behind, left], [behind, right], [before, right]];
        let mut overhead = outline([0, 1], &corners);
        overhead.push(Half::above(2, head));
        windows.push(overhead);
        let middle = 0.5 * (from + to);
        for [from, to] in [[from, middle - m(0.05)], [middle + m(0.05), to]] {
            let corner = m(0.09);
            windows.push(pane(
                &[
                    [from + corner, bottom],
                    [to - corner, bottom],
                    [to, bottom + corner],
                    [to, top - corner],
                    [to - corner, top],
                    [from + corner, top],
                    [from, top - corner],
                    [from, bottom + corner],
                ],
                post_half,
            ));
        }
    }
    windows
}

/// Fuselage with windows, and the doors of the nose gear that are cut from it.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let (shape, like) = (&aircraft.display.fuselage, Likeness::of(aircraft));
    let rings = rings(shape, &stations_m(shape, like), 0.0);
    let mut skin = Mesh::default();
    skin.body(material::WHITE, &rings);
    let mut glass = Mesh::default();
    for window in windows(shape, like) {
        glass.join(skin.cut(&window));
    }
    glass.polygons.iter_mut().for_each(|pane| pane.material = material::GLASS);
    let mut doors = skin.cut(&bays::nose_bay(like).below(like.up(0.80)));
    let left = doors.cut(&[Half::below(1, 0.0)]);
    let livery = paint::Livery::new(aircraft);
    let paint = |mesh| painted(mesh, &livery);
    vec![
        Part::new("fuselage", paint(skin)).with_texture(paint::LIVERY).smooth(50.0),
        Part::new("glass", glass).smooth(50.0),
        Part::new("door.nose.left", paint(left).two_sided()).with_texture(paint::LIVERY),
        Part::new("door.nose.right", paint(doors).two_sided()).with_texture(paint::LIVERY),
        Part::new("fairing", fairing(shape, like)).smooth(60.0),
    ]
}

/// Puts the skin on the livery: each side on its own half, by what side a face is on.
fn painted(mut mesh: Mesh, livery: &paint::Livery) -> Mesh {
    for Polygon { corners, .. } in &mut mesh.polygons {
        let right: f64 = corners.iter().map(|corner| corner.at_m[1]).sum();
        for corner in corners {
            corner.uv = livery.uv(corner.at_m[0], corner.at_m[2], right > 0.0);
        }
    }
    mesh
}

/// Between the roof and the wing's upper side.
fn fairing(shape: &Fuselage, like: Likeness) -> Mesh {
    let roof_m = Smooth::new(&shape.section_m).at(like.aft(7.5))[3];
    let row = |[aft, half, above]: [f64; 3]| {
        [like.aft(aft), like.length(half), roof_m + like.length(above)]
    };
    let rows = [
        [6.35, 0.05, -0.02],
        [6.75, 0.38, 0.09],
        [7.20, 0.55, 0.185],
        [7.80, 0.58, 0.19],
        [8.60, 0.50, 0.10],
        [9.40, 0.30, 0.04],
        [10.0, 0.05, -0.02],
    ];
    let rows = Smooth::new(&rows.map(row));
    let [from, to] = rows.range();
    let rings: Vec<_> = steps(from, to, 24)
        .into_iter()
        .map(|aft| {
            let [_, half, top] = rows.at(aft);
            let bottom = roof_m - like.length(0.22);
            ring(24, |s, c| {
                let round = |v: f64| sign(v) * pow_positive(v.abs(), 0.8);
                [aft, half * round(s), 0.5 * (bottom + top) + 0.5 * (top - bottom) * round(c)]
            })
        })
        .collect();
    let mut mesh = Mesh::default();
    mesh.body(material::WHITE, &rings);
    mesh
}

/// The pod of the right main gear, with its bay cut out, and the bay's doors.
pub fn pod(aircraft: &Aircraft) -> (Mesh, Mesh) {
    let (shape, like) = (&aircraft.display.gear_pods, Likeness::of(aircraft));
    let smooth = Smooth::new(&shape.section_m);
    let [from, to] = smooth.range();
    let rings: Vec<_> = steps(from, to, 30)
        .into_iter()
        .map(|aft| {
            let [_, radius] = smooth.at(aft);
            ring(28, |s, c| [aft, shape.buttline_m + radius * s, shape.waterline_m + radius * c])
        })
        .collect();
    let mut pod = Mesh::default();
    pod.body(material::WHITE, &rings);
    let below = shape.waterline_m - like.length(0.1);
    let doors = pod.cut(&bays::main_bay(aircraft).below(below));
    // A stripe.
    pod.paint(&[Half::above(2, like.up(0.9)), Half::below(2, like.up(1.0))], material::BLUE);
    (pod, doors)
}
