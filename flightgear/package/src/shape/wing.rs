//! The wing with its flaps and flaperons.

use engine::aircraft::Params as Aircraft;
use engine::display::Wing;
use engine::math::tan;

use super::{Likeness, Outline, front, half_thickness, place, rear};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point};

/// Flaps and flaperons begin here, in parts of the chord. For recognition.
const HINGE_NORM: f64 = 0.74;
/// From buttline to buttline, in parts of the half span. For recognition.
const FLAP_NORM: [f64; 2] = [0.95 / 4.75, 2.33 / 4.75];
/// The same of the flaperon.
const FLAPERON_NORM: [f64; 2] = [2.36 / 4.75, 4.34 / 4.75];

/// The quarter chord at a buttline of the right side.
fn quarter_m(wing: &Wing, right: f64) -> Point {
    let at = wing.quarter_chord_m;
    let out = right - at.y;
    [at.x + tan(wing.sweep_rad) * out, right, at.z + tan(wing.dihedral_rad) * out]
}

/// Buttlines of the right side from parts of the half span, m.
fn buttlines_m(wing: &Wing, norm: [f64; 2]) -> [f64; 2] {
    norm.map(|part| 0.5 * wing.span_m * part)
}

/// The hinge line of the right side's surface between two parts of the half span.
fn hinge_m(wing: &Wing, norm: [f64; 2]) -> [Point; 2] {
    buttlines_m(wing, norm).map(|right| {
        let [aft, right, up] = quarter_m(wing, right);
        // Below the chord, where Fowler and plain flaps of thick wings have it.
        let down = 0.3 * half_thickness(wing.thickness_ratio, HINGE_NORM) * wing.chord_m;
        [aft + (HINGE_NORM - 0.25) * wing.chord_m, right, up - down]
    })
}

/// Hinge of the right flap, from its inner to its outer end.
pub fn flap_hinge_m(aircraft: &Aircraft) -> [Point; 2] {
    hinge_m(&aircraft.display.wing, FLAP_NORM)
}

/// Hinge of the right flaperon, from its inner to its outer end.
pub fn flaperon_hinge_m(aircraft: &Aircraft) -> [Point; 2] {
    hinge_m(&aircraft.display.wing, FLAPERON_NORM)
}

/// The wing, and for each side its flap and flaperon.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let wing = &aircraft.display.wing;
    let (half_span, like) = (0.5 * wing.span_m, Likeness::of(aircraft));
    let flaps_m = buttlines_m(wing, FLAP_NORM);
    let flaperons_m = buttlines_m(wing, FLAPERON_NORM);
    let span = |outline: &Outline, from: f64, to: f64| -> Vec<Vec<Point>> {
        [from, to].map(|right| place(outline, quarter_m(wing, right), wing.chord_m, false)).to_vec()
    };
    let whole = front(wing.thickness_ratio, 1.0);
    let cut = front(wing.thickness_ratio, HINGE_NORM);
    let moving = rear(wing.thickness_ratio, HINGE_NORM + 0.04);
    let mut right = Mesh::default();
    right.body(material::WHITE, &span(&whole, 0.0, flaps_m[0]));
    right.body(material::WHITE, &span(&cut, flaps_m[0], flaperons_m[1]));
    right.body(material::WHITE, &span(&whole, flaperons_m[1], half_span));
    // A walkway's edge and the leading edge's boot.
    right.paint(&[Half::above(1, like.length(1.0)), leading_edge(wing)], material::GREY);
    let gap = like.length(0.012);
    let surface = |[from, to]: [f64; 2], painted: usize| {
        let mut mesh = Mesh::default();
        mesh.body(material::WHITE, &span(&moving, from + gap, to - gap));
        mesh.paint(&[trailing_edge(wing)], painted);
        mesh
    };
    let flap = surface(flaps_m, material::LIGHT_BLUE);
    let flaperon = surface(flaperons_m, material::BLUE);
    let mut both = right.mirrored();
    both.join(right);
    vec![
        Part::new("wing", both).smooth(35.0),
        Part::new("flap.left", flap.mirrored()).smooth(35.0),
        Part::new("flap.right", flap).smooth(35.0),
        Part::new("flaperon.left", flaperon.mirrored()).smooth(35.0),
        Part::new("flaperon.right", flaperon).smooth(35.0),
    ]
}

/// What is before this part of the chord on the right side.
fn ahead_of(wing: &Wing, part: f64) -> [[f64; 2]; 2] {
    [0.0, 5.0].map(|right| {
        let [aft, right, _] = quarter_m(wing, right);
        [aft + (part - 0.25) * wing.chord_m, right]
    })
}

fn leading_edge(wing: &Wing) -> Half {
    let [a, b] = ahead_of(wing, 0.045);
    Half::left_of([0, 1], a, b)
}

fn trailing_edge(wing: &Wing) -> Half {
    let [a, b] = ahead_of(wing, 0.93);
    Half::left_of([0, 1], b, a)
}
