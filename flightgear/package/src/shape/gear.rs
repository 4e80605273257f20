//! The landing gear, extended and without load: legs, wheels, bays and doors.
//!
//! # Assumptions
//! How it folds is not in any source at hand: the nose gear aft, the main gear forward into the pods.

use engine::aircraft::Params as Aircraft;
use engine::display::Wheels;
use engine::landing_gear::Strut;

use super::bays::{Bay, main_bay, nose_bay};
use super::{Likeness, Smooth, fuselage};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point, ring};

/// Waterline of the nose leg's hinge in the XV-15, m.
const NOSE_HINGE_M: f64 = 0.83;
/// Waterline of a main leg's hinge in the XV-15, m.
const MAIN_HINGE_M: f64 = 0.93;

/// One of the legs.
pub struct Leg {
    /// In names of parts.
    pub name: &'static str,
    /// In `tiltrotor/gear/unit[…]`.
    pub unit: usize,
    /// Axle, extended.
    pub axle_m: Point,
    /// Where the leg turns to fold.
    pub hinge_m: Point,
    /// Aft: 1; forward: −1.
    pub folds: f64,
    /// Of the tyres.
    pub radius_m: f64,
}

/// The axle of an unloaded strut: its contact point is the tyre's lowest.
fn axle_m(strut: &Strut, wheels: &Wheels, side: f64) -> Point {
    [strut.tyre_m.x, side * strut.tyre_m.y, strut.tyre_m.z + wheels.radius_m]
}

/// Nose, left and right.
pub fn legs(aircraft: &Aircraft) -> [Leg; 3] {
    let (gear, shape) = (&aircraft.landing_gear, &aircraft.display);
    let like = Likeness::of(aircraft);
    let leg = |name, unit, strut, wheels: &Wheels, side, hinge_up, folds| {
        let axle = axle_m(strut, wheels, side);
        let hinge = [axle[0], axle[1], like.up(hinge_up)];
        Leg { name, unit, axle_m: axle, hinge_m: hinge, folds, radius_m: wheels.radius_m }
    };
    [
        leg("nose", 0, &gear.nose, &shape.nose_wheels, 0.0, NOSE_HINGE_M, 1.0),
        leg("left", 1, &gear.main, &shape.main_wheels, -1.0, MAIN_HINGE_M, -1.0),
        leg("right", 2, &gear.main, &shape.main_wheels, 1.0, MAIN_HINGE_M, -1.0),
    ]
}

/// Where a door turns: a point, and the direction is the aircraft's long axis.
pub fn door_hinge_m(aircraft: &Aircraft, door: &str) -> Point {
    let (pods, like) = (&aircraft.display.gear_pods, Likeness::of(aircraft));
    let ([nose_left, nose_right], nose_up) = (nose_bay(like).right_m, like.up(0.60));
    let Bay { aft_m, right_m: [inner, outer] } = main_bay(aircraft);
    let low = |out: f64| {
        let [_, radius] = Smooth::new(&pods.section_m).at(0.5 * (aft_m[0] + aft_m[1]));
        let across = out - pods.buttline_m;
        pods.waterline_m
            - engine::math::sqrt(engine::math::max(0.0, radius * radius - across * across))
    };
    match door {
        "nose.left" => [0.0, nose_left, nose_up],
        "nose.right" => [0.0, nose_right, nose_up],
        "left.inner" => [0.0, -inner, low(inner)],
        "left.outer" => [0.0, -outer, low(outer)],
        "right.inner" => [0.0, inner, low(inner)],
        _ => [0.0, outer, low(outer)],
    }
}

/// Legs, wheels, pods, bays and the pods' doors.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let shape = &aircraft.display;
    let mut parts = Vec::new();
    for leg in legs(aircraft) {
        let wheels = if leg.unit == 0 { &shape.nose_wheels } else { &shape.main_wheels };
        let (fixed, sliding, turning) = strut(&leg, wheels, Likeness::of(aircraft));
        parts.push(Part::new(format!("gear.{}.leg", leg.name), fixed).smooth(50.0));
        parts.push(Part::new(format!("gear.{}.fork", leg.name), sliding).smooth(50.0));
        parts.push(Part::new(format!("gear.{}.wheels", leg.name), turning).smooth(40.0));
    }
    let (pod, mut inner) = fuselage::pod(aircraft);
    let outer = inner.cut(&[Half::above(1, main_bay(aircraft).middle_m())]);
    let mut pods = pod.mirrored();
    pods.join(pod);
    parts.push(Part::new("pods", pods).smooth(50.0));
    for (name, mesh) in [("inner", inner), ("outer", outer)] {
        let mesh = mesh.two_sided();
        parts.push(Part::new(format!("door.left.{name}"), mesh.mirrored()).smooth(50.0));
        parts.push(Part::new(format!("door.right.{name}"), mesh).smooth(50.0));
    }
    parts.push(Part::new("bays", bays(aircraft)));
    parts
}

/// The leg's upper part, what slides in it, and the wheels.
fn strut(leg: &Leg, wheels: &Wheels, like: Likeness) -> (Mesh, Mesh, Mesh) {
    let m = |drawn: f64| like.length(drawn);
    let ([aft, right, axle], top) = (leg.axle_m, leg.hinge_m[2]);
    let thick = wheels.leg_radius_m;
    let middle = axle + 0.45 * (top - axle);
    let mut fixed = Mesh::default();
    fixed.bar(material::WHITE, [aft, right, middle], [aft, right, top], thick);
    fixed.bar(
        material::METAL,
        [aft, right, middle + m(0.02)],
        [aft + m(0.30) * leg.folds, right, top],
        0.4 * thick,
    );
    let half = 0.5 * wheels.spacing_m;
    let mut sliding = Mesh::default();
    let inside = [aft, right, middle + m(0.15)];
    sliding.bar(material::METAL, [aft, right, axle], inside, 0.66 * thick);
    sliding.bar(material::METAL, [aft, right - half, axle], [aft, right + half, axle], 0.5 * thick);
    // The scissors behind the leg.
    let behind = aft - m(0.13) * leg.folds;
    let knee = 0.5 * (axle + middle);
    sliding.bar(material::GREY, [aft, right, axle + m(0.05)], [behind, right, knee], 0.25 * thick);
    sliding.bar(material::GREY, [behind, right, knee], [aft, right, middle], 0.25 * thick);
    let mut turning = Mesh::default();
    for offset in [-half, half] {
        turning.join(wheel([aft, right + offset, axle], wheels));
    }
    (fixed, sliding, turning)
}

fn wheel([aft, right, up]: Point, wheels: &Wheels) -> Mesh {
    let (radius, half) = (wheels.radius_m, 0.5 * wheels.width_m);
    let circle = |part: f64, across: f64| {
        ring(24, |s, c| [aft + part * radius * s, right + across * half, up + part * radius * c])
    };
    let mut mesh = Mesh::default();
    let profile = [
        (0.62, -0.9),
        (0.86, -1.0),
        (0.97, -0.72),
        (1.0, -0.3),
        (1.0, 0.3),
        (0.97, 0.72),
        (0.86, 1.0),
        (0.62, 0.9),
    ];
    mesh.skin(material::TYRE, &profile.map(|(part, across)| circle(part, across)));
    mesh.body(material::GREY, &[circle(0.62, -0.8), circle(0.62, 0.8)]);
    // A mark, by which turning is seen.
    let spoke = |sign: f64| {
        let at = sign * 0.82 * half + right;
        vec![
            [aft - 0.06 * radius, at, up],
            [aft + 0.06 * radius, at, up],
            [aft + 0.06 * radius, at, up + 0.58 * radius],
            [aft - 0.06 * radius, at, up + 0.58 * radius],
        ]
    };
    let mut marks = Mesh::default();
    marks.face(material::WHITE, &spoke(-1.0));
    marks.face(material::WHITE, &spoke(1.0));
    mesh.join(marks.two_sided());
    mesh
}

/// Boxes open below, dark inside.
fn bays(aircraft: &Aircraft) -> Mesh {
    let like = Likeness::of(aircraft);
    let open_box = |bay: Bay, [low, high]: [f64; 2]| {
        let ([front, back], [left, right]) = (bay.aft_m, bay.right_m);
        let mut mesh = Mesh::default();
        mesh.cuboid(material::DARK, [front, left, low], [back, right, high]);
        // Without its floor.
        mesh.polygons.retain(|face| face.corners.iter().any(|corner| corner.at_m[2] > low + 1e-6));
        mesh.inside_out()
    };
    let mut bays = open_box(nose_bay(like), [0.66, 1.02].map(|up| like.up(up)));
    let waterline_m = aircraft.display.gear_pods.waterline_m;
    let main = open_box(main_bay(aircraft), [-0.32, 0.29].map(|up| waterline_m + like.length(up)));
    bays.join(main.mirrored());
    bays.join(main);
    bays
}
