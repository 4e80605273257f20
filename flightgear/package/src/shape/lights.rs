//! Lights: position lights, beacon, strobes, landing light.

use engine::aircraft::Params as Aircraft;

use super::{Likeness, nacelle};
use crate::ac3d::{Part, material};
use crate::mesh::{Mesh, Point, add, ring, sub};
use crate::paint;

/// A light with the halo that is seen around it.
pub struct Light {
    /// Of its part; the halo's has `halo.` before it.
    pub name: &'static str,
    /// Where it is.
    pub at_m: Point,
    material: usize,
    radius_m: f64,
}

/// All but the landing light. Those on the nacelles tilt with them.
pub fn lights(aircraft: &Aircraft) -> Vec<Light> {
    let like = Likeness::of(aircraft);
    let light = |name, at_m, material, radius_m| Light {
        name,
        at_m,
        material,
        radius_m: like.length(radius_m),
    };
    let fins = &aircraft.display.vertical_stabilizers;
    let tip = fins.section_m.last().map_or([0.0; 3], |row| *row);
    let tip_m =
        |side: f64| [tip[2] + 0.3 * tip[1], side * fins.buttline_m, tip[0] + like.length(0.02)];
    let on_nacelle =
        |side: f64| like.from(nacelle::pivot_m(aircraft, side), [0.0, side * 0.49, -0.1]);
    vec![
        light("nav.left", on_nacelle(-1.0), material::LIGHT_RED, 0.05),
        light("nav.right", on_nacelle(1.0), material::LIGHT_GREEN, 0.05),
        light("nav.tail", like.at([15.35, 0.0, 2.42]), material::LIGHT_WHITE, 0.045),
        light("beacon", like.at([9.3, 0.0, 2.53]), material::LIGHT_RED, 0.06),
        light("strobe.left", tip_m(-1.0), material::LIGHT_WHITE, 0.04),
        light("strobe.right", tip_m(1.0), material::LIGHT_WHITE, 0.04),
    ]
}

/// The landing light under the nose, in stations of the XV-15.
const LANDING_M: Point = [4.75, 0.0, 0.56];

/// Lamps, halos, and the landing light's beam.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let (cg, like) = (aircraft.weight_balance.cg_m, Likeness::of(aircraft));
    let mut parts = Vec::new();
    for light in lights(aircraft) {
        let mut lamp = Mesh::default();
        let [aft, right, up] = light.at_m;
        let r = light.radius_m;
        let circle = |part: f64, x: f64| {
            ring(12, |s, c| [aft + x * r, right + part * r * s, up + part * r * c])
        };
        lamp.body(
            light.material,
            &[
                circle(0.3, -1.0),
                circle(0.8, -0.6),
                circle(1.0, 0.0),
                circle(0.8, 0.6),
                circle(0.3, 1.0),
            ],
        );
        parts.push(Part::new(light.name, lamp).smooth(80.0));
        parts.push(halo(&light, [cg.x, cg.y, cg.z]));
    }
    let [aft, right, up] = LANDING_M;
    let lamp = ring(16, |s, c| [aft - 0.05 + 0.06 * c, right + 0.09 * s, up - 0.02 + 0.05 * c]);
    let mut mesh = Mesh::default();
    mesh.face(material::LIGHT_WHITE, &lamp);
    let lamp = Part::new("landing.lamp", mesh.two_sided());
    parts.extend([lamp, beam()].map(|part| like.part(part)));
    parts
}

/// A square that is turned to the eye, which FlightGear does about the model's origin: it is made there,
/// and an animation puts it where the light is.
fn halo(light: &Light, origin_m: Point) -> Part {
    let half = 9.0 * light.radius_m;
    let corner = |y: f64, z: f64| add(origin_m, [0.0, y * half, z * half]);
    let mut mesh = Mesh::default();
    mesh.face(
        light.material,
        &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
    );
    let mesh = mesh.two_sided().textured(|at| {
        let [_, y, z] = sub(at, origin_m);
        [y, z].map(|out| 0.5 + 0.5 * out / half)
    });
    Part::new(format!("halo.{}", light.name), mesh).with_texture(paint::HALO)
}

/// A faint cone ahead and down.
fn beam() -> Part {
    let [aft, right, up] = LANDING_M;
    let circle =
        |out: f64, r: f64| ring(20, |s, c| [aft - out, right + r * s, up - 0.30 * out + r * c]);
    let rings = [circle(0.1, 0.08), circle(14.0, 2.2)];
    let mut mesh = Mesh::default();
    mesh.skin(material::BEAM, &rings);
    let mesh = mesh.two_sided().textured(|[x, ..]| [0.5, 0.5 + 0.49 * (aft - x) / 14.0]);
    Part::new("landing.beam", mesh).with_texture(paint::HALO)
}
