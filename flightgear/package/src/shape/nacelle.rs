//! Nacelles, as a helicopter, with spinners, intakes and exhausts.

use engine::aircraft::Params as Aircraft;

use super::{Likeness, SIDES, Smooth, steps};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point, ring};

/// A nacelle's end is bare metal over this length, m.
const EXHAUST_M: f64 = 0.30;
/// The painted band begins this far behind the front end, and is this wide, m.
const BAND_M: [f64; 2] = [0.25, 0.30];
/// The same of a line behind it.
const LINE_M: [f64; 2] = [0.60, 0.07];

/// Pivot of the nacelle on a side, −1 left or 1 right.
pub fn pivot_m(aircraft: &Aircraft, side: f64) -> Point {
    let pivot = aircraft.rotors.pivot_m;
    [pivot.x, side * pivot.y, pivot.z]
}

/// The hub with the mast upright.
pub fn hub_m(aircraft: &Aircraft, side: f64) -> Point {
    let [aft, right, up] = pivot_m(aircraft, side);
    [aft, right, up + aircraft.rotors.mast_length_m]
}

/// Rings from the lower end up, in stations.
fn rings(sections: &[[f64; 3]], pivot: Point, count: u16) -> Vec<Vec<Point>> {
    let upwards: Vec<_> = sections.iter().map(|&[down, deep, wide]| [-down, deep, wide]).collect();
    let smooth = Smooth::new(&upwards);
    let [from, to] = smooth.range();
    steps(from, to, count)
        .into_iter()
        .map(|up| {
            let [_, deep, wide] = smooth.at(up);
            ring(32, |s, c| [pivot[0] + deep * c, pivot[1] + wide * s, pivot[2] + up])
        })
        .collect()
}

/// Nacelles, spinners and what glows in the exhausts.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let shape = &aircraft.display.nacelles;
    let mut parts = Vec::new();
    let pivot = pivot_m(aircraft, 1.0);
    let skin = rings(&shape.section_m, pivot, 30);
    let mut nacelle = Mesh::default();
    nacelle.skin(material::WHITE, &skin);
    let [low, high] = [skin[0][0][2], skin[skin.len() - 1][0][2]];
    let like = Likeness::of(aircraft);
    nacelle.paint(&[Half::below(2, low + like.length(EXHAUST_M))], material::METAL);
    let bands = [(BAND_M, material::BLUE), (LINE_M, material::LIGHT_BLUE)];
    for ([from, wide], colour) in bands {
        let [from, to] = [from + wide, from].map(|m| high - like.length(m));
        nacelle.paint(&[Half::above(2, from), Half::below(2, to)], colour);
    }
    let [bottom, top] = [low, high].map(|end| [pivot[0], pivot[1], end]);
    nacelle.join(exhaust().moved(|at| like.from(bottom, at), false));
    nacelle.join(intakes().moved(|at| like.from(top, at), false));
    let mut spinner = Mesh::default();
    spinner.body(material::BLUE, &rings(&shape.spinner_m, pivot, 14));
    let glow = glow().moved(|at| like.from(bottom, at), false);
    for (_, name, side) in SIDES {
        let of = |mesh: &Mesh| if side > 0.0 { mesh.clone() } else { mesh.mirrored() };
        parts.push(Part::new(format!("nacelle.{name}"), of(&nacelle)).smooth(50.0));
        parts.push(Part::new(format!("spinner.{name}"), of(&spinner)).smooth(60.0));
        parts.push(Part::new(format!("glow.{name}"), of(&glow)));
    }
    parts
}

fn circle(radius: f64, up: f64) -> Vec<Point> {
    ring(24, |s, c| [radius * c, radius * s, up])
}

/// The exhaust's inside, from the middle of the nacelle's lower end.
fn exhaust() -> Mesh {
    let mut pipe = Mesh::default();
    pipe.skin(material::DARK, &[circle(0.195, 0.0), circle(0.15, 0.35)]);
    pipe.inside_out()
}

/// The intakes, from the middle of the nacelle's upper end: scoops on the front below the hub.
fn intakes() -> Mesh {
    let mut mesh = Mesh::default();
    let lid = circle(0.36, -0.01);
    mesh.face(material::DARK, &lid.into_iter().rev().collect::<Vec<_>>());
    // Two scoops, aft with the mast up: below as an aeroplane.
    for across in [-0.19, 0.19] {
        let scoop = |up: f64, tall: f64, out: f64| {
            ring(18, |s, c| [out + tall * c, across + 0.135 * s, up])
        };
        let rings = [
            scoop(-0.16, 0.105, 0.36),
            scoop(-0.35, 0.115, 0.40),
            scoop(-0.75, 0.11, 0.42),
            scoop(-1.15, 0.06, 0.42),
        ];
        mesh.body(material::WHITE, &rings);
        let mouth = ring(18, |s, c| [0.36 + 0.085 * c, across + 0.115 * s, -0.155]);
        mesh.body(
            material::BLACK,
            &[mouth.clone(), mouth.iter().map(|&[x, y, z]| [x, y, z - 0.005]).collect()],
        );
    }
    mesh
}

/// A disc inside the exhaust, from the middle of the nacelle's lower end.
fn glow() -> Mesh {
    let mut mesh = Mesh::default();
    let disc = ring(20, |s, c| [0.16 * c, 0.16 * s, 0.22]);
    mesh.face(material::GLOW, &disc);
    mesh.two_sided()
}
