//! The tail: horizontal stabiliser with elevator, fins with rudders.

use engine::aircraft::Params as Aircraft;
use engine::display::{Fins, Tailplane};

use super::{Likeness, Smooth, front, place, rear, steps};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point};

/// The elevator begins here, in parts of the chord. For recognition.
const ELEVATOR_NORM: f64 = 0.70;
/// The rudders begin here.
const RUDDER_NORM: f64 = 0.70;
/// The rudders' ends, in parts of the fins' height from the lower tip.
const RUDDER_HEIGHT_NORM: [f64; 2] = [0.30 / 2.35, 2.05 / 2.35];

fn quarter_m(plane: &Tailplane, right: f64) -> Point {
    [plane.quarter_chord_m.x, right, plane.quarter_chord_m.z]
}

/// Hinge of the elevator, from left to right.
pub fn elevator_hinge_m(aircraft: &Aircraft) -> [Point; 2] {
    let plane = &aircraft.display.horizontal_stabilizer;
    [-1.0, 1.0].map(|right| {
        let [aft, right, up] = quarter_m(plane, right);
        [aft + (ELEVATOR_NORM - 0.25) * plane.chord_m, right, up]
    })
}

/// Waterlines of the rudders' ends, m.
fn rudder_m(section: &Smooth<3>) -> [f64; 2] {
    let [lower, upper] = section.range();
    RUDDER_HEIGHT_NORM.map(|part| lower + part * (upper - lower))
}

/// Hinge of the right rudder, from its lower to its upper end.
pub fn rudder_hinge_m(aircraft: &Aircraft) -> [Point; 2] {
    let fins = &aircraft.display.vertical_stabilizers;
    let section = Smooth::new(&fins.section_m);
    rudder_m(&section).map(|up| {
        let [_, chord, aft] = section.at(up);
        [aft + (RUDDER_NORM - 0.25) * chord, fins.buttline_m, up]
    })
}

/// Stabiliser, elevator, fins and rudders.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let like = Likeness::of(aircraft);
    let mut parts = tailplane(&aircraft.display.horizontal_stabilizer, like);
    let (fin, rudder) = fin(&aircraft.display.vertical_stabilizers, like);
    parts.extend([
        Part::new("fin.left", fin.mirrored()).smooth(35.0),
        Part::new("fin.right", fin).smooth(35.0),
        Part::new("rudder.left", rudder.mirrored()).smooth(35.0),
        Part::new("rudder.right", rudder).smooth(35.0),
    ]);
    parts
}

fn tailplane(plane: &Tailplane, like: Likeness) -> Vec<Part> {
    let half = 0.5 * plane.span_m;
    let span = |outline, from: f64, to: f64| {
        [from, to].map(|right| place(outline, quarter_m(plane, right), plane.chord_m, false))
    };
    let cut = front(plane.thickness_ratio, ELEVATOR_NORM);
    let moving = rear(plane.thickness_ratio, ELEVATOR_NORM + 0.02);
    let mut fixed = Mesh::default();
    fixed.body(material::WHITE, &span(&cut, -half, half));
    let before = quarter_m(plane, 0.0)[0] - 0.20 * plane.chord_m;
    fixed.paint(&[Half::below(0, before)], material::GREY);
    let mut right = Mesh::default();
    // The elevator leaves the fuselage's end free.
    right.body(material::WHITE, &span(&moving, like.length(0.16), half - like.length(0.05)));
    let mut elevator = right.mirrored();
    elevator.join(right);
    vec![Part::new("tailplane", fixed).smooth(35.0), Part::new("elevator", elevator).smooth(35.0)]
}

fn fin(fins: &Fins, like: Likeness) -> (Mesh, Mesh) {
    let section = Smooth::new(&fins.section_m);
    let [lower, upper] = section.range();
    let rings = |outline: &super::Outline, from: f64, to: f64| -> Vec<Vec<Point>> {
        steps(from, to, 8)
            .into_iter()
            .map(|up| {
                let [_, chord, aft] = section.at(up);
                place(outline, [aft, fins.buttline_m, up], chord, true)
            })
            .collect()
    };
    let whole = front(fins.thickness_ratio, 1.0);
    let cut = front(fins.thickness_ratio, RUDDER_NORM);
    let moving = rear(fins.thickness_ratio, RUDDER_NORM + 0.02);
    let ([low, high], gap) = (rudder_m(&section), like.length(0.012));
    let mut fin = Mesh::default();
    fin.body(material::WHITE, &rings(&whole, lower, low));
    fin.body(material::WHITE, &rings(&cut, low, high));
    fin.body(material::WHITE, &rings(&whole, high, upper));
    let mut rudder = Mesh::default();
    rudder.body(material::WHITE, &rings(&moving, low + gap, high - gap));
    let below_tip = |m: f64| upper - like.length(m);
    for mesh in [&mut fin, &mut rudder] {
        // A broad band of blue with a light one below it.
        mesh.paint(&[Half::above(2, below_tip(0.62))], material::BLUE);
        mesh.paint(
            &[Half::above(2, below_tip(0.80)), Half::below(2, below_tip(0.68))],
            material::LIGHT_BLUE,
        );
    }
    (fin, rudder)
}
