//! The landing gear, extended and without load: legs, wheels, bays and doors.
//!
//! # Assumptions
//! How it folds is not in any source at hand: the nose gear aft, the main gear forward into the pods.

use engine::aircraft::Params as Aircraft;
use engine::display::{GearPods, Wheels};
use engine::landing_gear::Strut;

use super::bays::{MAIN_BAY_HALF_M, MAIN_BAY_M, NOSE_BAY_HALF_M, NOSE_BAY_M, main_bay_middle_m};
use super::fuselage;
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point, ring};

/// Waterline of the nose leg's hinge, m.
const NOSE_HINGE_M: f64 = 0.83;
/// Waterline of a main leg's hinge, m.
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
    let leg = |name, unit, strut, wheels: &Wheels, side, hinge_up, folds| {
        let axle = axle_m(strut, wheels, side);
        let hinge = [axle[0], axle[1], hinge_up];
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
    let pods = &aircraft.display.gear_pods;
    let (middle, half) = (main_bay_middle_m(pods), MAIN_BAY_HALF_M);
    let low = |out: f64| {
        let [_, radius] = super::Smooth::new(&pods.section_m).at(7.9);
        let across = out - pods.buttline_m;
        pods.waterline_m - engine::math::sqrt(radius * radius - across * across)
    };
    match door {
        "nose.left" => [0.0, -NOSE_BAY_HALF_M, 0.60],
        "nose.right" => [0.0, NOSE_BAY_HALF_M, 0.60],
        "left.inner" => [0.0, half - middle, low(middle - half)],
        "left.outer" => [0.0, -half - middle, low(middle + half)],
        "right.inner" => [0.0, middle - half, low(middle - half)],
        _ => [0.0, middle + half, low(middle + half)],
    }
}

/// Legs, wheels, pods, bays and the pods' doors.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let shape = &aircraft.display;
    let mut parts = Vec::new();
    for leg in legs(aircraft) {
        let wheels = if leg.unit == 0 { &shape.nose_wheels } else { &shape.main_wheels };
        let (fixed, sliding, turning) = strut(&leg, wheels);
        parts.push(Part::new(format!("gear.{}.leg", leg.name), fixed).smooth(50.0));
        parts.push(Part::new(format!("gear.{}.fork", leg.name), sliding).smooth(50.0));
        parts.push(Part::new(format!("gear.{}.wheels", leg.name), turning).smooth(40.0));
    }
    let (pod, mut inner) = fuselage::pod(&shape.gear_pods);
    let outer = inner.cut(&[Half::above(1, main_bay_middle_m(&shape.gear_pods))]);
    let mut pods = pod.mirrored();
    pods.join(pod);
    parts.push(Part::new("pods", pods).smooth(50.0));
    for (name, mesh) in [("inner", inner), ("outer", outer)] {
        let mesh = mesh.two_sided();
        parts.push(Part::new(format!("door.left.{name}"), mesh.mirrored()).smooth(50.0));
        parts.push(Part::new(format!("door.right.{name}"), mesh).smooth(50.0));
    }
    parts.push(Part::new("bays", bays(&shape.gear_pods)));
    parts
}

/// The leg's upper part, what slides in it, and the wheels.
fn strut(leg: &Leg, wheels: &Wheels) -> (Mesh, Mesh, Mesh) {
    let ([aft, right, axle], top) = (leg.axle_m, leg.hinge_m[2]);
    let thick = wheels.leg_radius_m;
    let middle = axle + 0.45 * (top - axle);
    let mut fixed = Mesh::default();
    fixed.bar(material::WHITE, [aft, right, middle], [aft, right, top], thick);
    fixed.bar(
        material::METAL,
        [aft, right, middle + 0.02],
        [aft + 0.30 * leg.folds, right, top],
        0.4 * thick,
    );
    let half = 0.5 * wheels.spacing_m;
    let mut sliding = Mesh::default();
    sliding.bar(material::METAL, [aft, right, axle], [aft, right, middle + 0.15], 0.66 * thick);
    sliding.bar(material::METAL, [aft, right - half, axle], [aft, right + half, axle], 0.5 * thick);
    // The scissors behind the leg.
    let behind = aft - 0.13 * leg.folds;
    let knee = 0.5 * (axle + middle);
    sliding.bar(material::GREY, [aft, right, axle + 0.05], [behind, right, knee], 0.25 * thick);
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
fn bays(pods: &GearPods) -> Mesh {
    let open_box = |[front, back]: [f64; 2], [left, right]: [f64; 2], [low, high]: [f64; 2]| {
        let mut mesh = Mesh::default();
        mesh.cuboid(material::DARK, [front, left, low], [back, right, high]);
        // Without its floor.
        mesh.polygons.retain(|face| face.corners.iter().any(|corner| corner.at_m[2] > low + 1e-6));
        mesh.inside_out()
    };
    let mut bays = open_box(NOSE_BAY_M, [-NOSE_BAY_HALF_M, NOSE_BAY_HALF_M], [0.66, 1.02]);
    let middle = main_bay_middle_m(pods);
    let main = open_box(
        MAIN_BAY_M,
        [middle - MAIN_BAY_HALF_M, middle + MAIN_BAY_HALF_M],
        [pods.waterline_m - 0.32, pods.waterline_m + 0.29],
    );
    bays.join(main.mirrored());
    bays.join(main);
    bays
}
