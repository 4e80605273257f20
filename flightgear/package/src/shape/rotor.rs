//! Rotors, as a helicopter: blades, and the discs that stand for them when they turn fast.
//!
//! # Signs
//! The right rotor turns anticlockwise seen from above, the left one is its image. Azimuth counts from
//! aft. Blades have the twist and chord of the aircraft file and no collective: what turns them about
//! their axes is an animation.

use engine::aircraft::Params as Aircraft;
use engine::math::{TAU, cos, max, sin, tan};
use engine::table::axis::RadialStation;

use super::{Likeness, SIDES, front, nacelle, steps};
use crate::ac3d::{Part, material};
use crate::mesh::{Half, Mesh, Point, ring};
use crate::paint;

/// Tips are painted beyond this part of the radius.
const PAINTED_NORM: f64 = 0.93;
/// Where twist counts from, as collective pitch does.
const REFERENCE_NORM: f64 = 0.75;

/// Azimuth of a blade of the right rotor, rad.
pub fn azimuth_rad(aircraft: &Aircraft, blade: u16) -> f64 {
    TAU * f64::from(blade) / aircraft.rotors.blade.count
}

/// Blades of a rotor.
pub fn blades(aircraft: &Aircraft) -> u16 {
    aircraft.rotors.blade.count as u16
}

/// Blades and discs.
pub fn parts(aircraft: &Aircraft) -> Vec<Part> {
    let mut parts = Vec::new();
    for (_, name, side) in SIDES {
        let of = |mesh: &Mesh| if side > 0.0 { mesh.clone() } else { mesh.mirrored() };
        for number in 0..blades(aircraft) {
            let blade = of(&blade(aircraft, azimuth_rad(aircraft, number)));
            parts.push(Part::new(format!("blade.{name}.{number}"), blade).smooth(50.0));
        }
        let disc = Part::new(format!("disc.{name}"), of(&disc(aircraft)));
        parts.push(disc.with_texture(paint::DISC).smooth(60.0));
    }
    parts
}

fn blade(aircraft: &Aircraft, azimuth_rad: f64) -> Mesh {
    let rotors = &aircraft.rotors;
    let hub = nacelle::hub_m(aircraft, 1.0);
    let twist = &rotors.blade.twist_rad;
    let thickness = &rotors.blade.section.thickness_norm;
    let rise = tan(rotors.flapping.precone_rad);
    let (s, c) = (sin(azimuth_rad), cos(azimuth_rad));
    let rings: Vec<_> = steps(rotors.blade.root_norm, 1.0, 12)
        .into_iter()
        .map(|part| {
            let out = part * rotors.radius_m;
            let station = RadialStation(part);
            let chord = rotors.blade.blade_chord_m.at(station);
            let pitch = twist.at(station) - twist.at(RadialStation(REFERENCE_NORM));
            let ratio = max(thickness.at(station), 0.07);
            let section = front(ratio, 1.0).into_iter().step_by(2);
            section
                .map(|[along, off]| {
                    // Ahead along the blade's way, and up.
                    let (ahead, up) = ((0.25 - along) * chord, off * chord);
                    let ahead_turned = ahead * cos(pitch) - up * sin(pitch);
                    let up_turned = ahead * sin(pitch) + up * cos(pitch);
                    place(hub, [out, ahead_turned, up_turned + rise * out], [s, c])
                })
                .collect()
        })
        .collect();
    let mut mesh = Mesh::default();
    mesh.body(material::BLADE, &rings);
    let tip = PAINTED_NORM * rotors.radius_m;
    let beyond = |m: f64| {
        Half::left_of(
            [0, 1],
            [hub[0] + m * c, hub[1] + m * s],
            [hub[0] + m * c + s, hub[1] + m * s - c],
        )
    };
    let outside = beyond(tip);
    mesh.paint(&[outside], material::YELLOW);
    // The grip, from the hub to the root.
    let grip = |out: f64| place(hub, [out, 0.0, rise * out], [s, c]);
    let like = Likeness::of(aircraft);
    let inside = like.length(0.12);
    mesh.cone(
        material::METAL,
        (grip(inside), like.length(0.09)),
        (grip(rotors.blade.root_norm * rotors.radius_m + inside), like.length(0.065)),
        14,
    );
    mesh
}

/// A point out along a blade, ahead of it and above the hub.
fn place(hub: Point, [out, ahead, up]: [f64; 3], [s, c]: [f64; 2]) -> Point {
    [hub[0] + out * c - ahead * s, hub[1] + out * s + ahead * c, hub[2] + up]
}

/// A cone over the disc, textured from its middle.
fn disc(aircraft: &Aircraft) -> Mesh {
    let rotors = &aircraft.rotors;
    let hub = nacelle::hub_m(aircraft, 1.0);
    let rise = tan(rotors.flapping.precone_rad);
    let radius = rotors.radius_m;
    let circle = |part: f64| {
        ring(48, |s, c| {
            let out = part * radius;
            [hub[0] + out * c, hub[1] + out * s, hub[2] + rise * out]
        })
    };
    let mut mesh = Mesh::default();
    mesh.skin(material::DISC, &[circle(0.06), circle(1.0)]);
    mesh.textured(|[aft, right, _]| [aft - hub[0], right - hub[1]].map(|x| 0.5 + 0.5 * x / radius))
        .two_sided()
}
