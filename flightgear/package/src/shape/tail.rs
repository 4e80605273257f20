//! The tail: horizontal stabiliser with elevator, fins with rudders.

use engine::aircraft::Params as Aircraft;
use engine::display::{Fins, Tailplane};

use super::{Smooth, front, place, rear, steps};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point};

/// The elevator begins here, in parts of the chord. For recognition.
const ELEVATOR_NORM: f64 = 0.70;
/// The rudders begin here.
const RUDDER_NORM: f64 = 0.70;
/// Waterlines of the rudders' ends, m.
const RUDDER_M: [f64; 2] = [1.75, 3.50];
/// The elevator leaves the fuselage's end free, m.
const GAP_M: f64 = 0.16;

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

/// Hinge of the right rudder, from its lower to its upper end.
pub fn rudder_hinge_m(aircraft: &Aircraft) -> [Point; 2] {
    let fins = &aircraft.display.vertical_stabilizers;
    let section = Smooth::new(&fins.section_m);
    RUDDER_M.map(|up| {
        let [_, chord, aft] = section.at(up);
        [aft + (RUDDER_NORM - 0.25) * chord, fins.buttline_m, up]
    })
}

/// Stabiliser, elevator, fins and rudders.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let mut parts = tailplane(&aircraft.display.horizontal_stabilizer);
    let (fin, rudder) = fin(&aircraft.display.vertical_stabilizers);
    parts.extend([
        Part::new("fin.left", fin.mirrored()).smooth(35.0),
        Part::new("fin.right", fin).smooth(35.0),
        Part::new("rudder.left", rudder.mirrored()).smooth(35.0),
        Part::new("rudder.right", rudder).smooth(35.0),
    ]);
    parts
}

fn tailplane(plane: &Tailplane) -> Vec<Part> {
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
    right.body(material::WHITE, &span(&moving, GAP_M, half - 0.05));
    let mut elevator = right.mirrored();
    elevator.join(right);
    vec![Part::new("tailplane", fixed).smooth(35.0), Part::new("elevator", elevator).smooth(35.0)]
}

fn fin(fins: &Fins) -> (Mesh, Mesh) {
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
    let mut fin = Mesh::default();
    fin.body(material::WHITE, &rings(&whole, lower, RUDDER_M[0]));
    fin.body(material::WHITE, &rings(&cut, RUDDER_M[0], RUDDER_M[1]));
    fin.body(material::WHITE, &rings(&whole, RUDDER_M[1], upper));
    let mut rudder = Mesh::default();
    rudder.body(material::WHITE, &rings(&moving, RUDDER_M[0] + 0.012, RUDDER_M[1] - 0.012));
    for mesh in [&mut fin, &mut rudder] {
        // A broad band of blue with a light one below it.
        mesh.paint(&[Half::above(2, upper - 0.62)], material::BLUE);
        mesh.paint(
            &[Half::above(2, upper - 0.80), Half::below(2, upper - 0.68)],
            material::LIGHT_BLUE,
        );
    }
    (fin, rudder)
}
