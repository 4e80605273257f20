//! AC3D: the text format of models that FlightGear reads.
//!
//! # Signs
//! FlightGear's models have x aft, y right and z up; in the file they are x, z, −y. Texture places
//! count from the lower left. Normals are not in the file: FlightGear makes them, smooth where faces
//! meet at less than the crease angle.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::mesh::{Mesh, Point};

/// A material: diffuse and ambient colour, emission, specular, shininess, transparency.
pub struct Material {
    name: &'static str,
    colour: [f64; 3],
    emission: f64,
    specular: f64,
    shininess: u8,
    transparency: f64,
}

const fn dull(name: &'static str, colour: [f64; 3]) -> Material {
    Material { name, colour, emission: 0.0, specular: 0.08, shininess: 8, transparency: 0.0 }
}

const fn glossy(name: &'static str, colour: [f64; 3]) -> Material {
    Material { name, colour, emission: 0.0, specular: 0.35, shininess: 48, transparency: 0.0 }
}

const fn lit(name: &'static str, colour: [f64; 3]) -> Material {
    Material { name, colour, emission: 1.0, specular: 0.0, shininess: 1, transparency: 0.0 }
}

/// Numbers of the entries of [`MATERIALS`].
#[allow(missing_docs, reason = "the entries say what they are")]
pub mod material {
    pub const WHITE: usize = 0;
    pub const BLUE: usize = 1;
    pub const LIGHT_BLUE: usize = 2;
    pub const BLACK: usize = 3;
    pub const DARK: usize = 4;
    pub const GREY: usize = 5;
    pub const METAL: usize = 6;
    pub const TYRE: usize = 7;
    pub const GLASS: usize = 8;
    pub const BLADE: usize = 9;
    pub const YELLOW: usize = 10;
    pub const RED: usize = 11;
    pub const INTERIOR: usize = 12;
    pub const FLOOR: usize = 13;
    pub const SEAT: usize = 14;
    pub const PANEL: usize = 15;
    pub const SCREEN: usize = 16;
    pub const LIGHT_RED: usize = 17;
    pub const LIGHT_GREEN: usize = 18;
    pub const LIGHT_WHITE: usize = 19;
    pub const GLOW: usize = 20;
    pub const DISC: usize = 21;
    pub const SKIN: usize = 22;
    pub const OVERALL: usize = 23;
    pub const BEAM: usize = 24;
}

/// Of what the model is made.
pub const MATERIALS: &[Material] = &[
    glossy("white", [0.90, 0.91, 0.92]),
    glossy("blue", [0.07, 0.20, 0.46]),
    glossy("light blue", [0.32, 0.58, 0.84]),
    dull("black", [0.04, 0.04, 0.05]),
    dull("dark", [0.15, 0.16, 0.18]),
    dull("grey", [0.45, 0.47, 0.50]),
    glossy("metal", [0.58, 0.59, 0.62]),
    dull("tyre", [0.06, 0.06, 0.065]),
    Material {
        name: "glass",
        colour: [0.05, 0.08, 0.11],
        emission: 0.0,
        specular: 0.9,
        shininess: 110,
        transparency: 0.45,
    },
    dull("blade", [0.13, 0.14, 0.15]),
    dull("yellow", [0.92, 0.72, 0.12]),
    dull("red", [0.75, 0.10, 0.08]),
    dull("interior", [0.46, 0.48, 0.50]),
    dull("floor", [0.24, 0.25, 0.27]),
    dull("seat", [0.13, 0.18, 0.27]),
    dull("panel", [0.20, 0.21, 0.23]),
    lit("screen", [1.0, 1.0, 1.0]),
    lit("light red", [1.0, 0.10, 0.06]),
    lit("light green", [0.08, 1.0, 0.25]),
    lit("light white", [1.0, 0.98, 0.92]),
    lit("glow", [0.62, 0.20, 0.05]),
    Material {
        name: "disc",
        colour: [0.35, 0.36, 0.38],
        emission: 0.25,
        specular: 0.0,
        shininess: 1,
        transparency: 0.0,
    },
    dull("skin", [0.74, 0.56, 0.44]),
    dull("overall", [0.30, 0.33, 0.24]),
    Material {
        name: "beam",
        colour: [1.0, 0.98, 0.9],
        emission: 1.0,
        specular: 0.0,
        shininess: 1,
        transparency: 0.0,
    },
];

/// A part of the model that can be moved or hidden by its name.
pub struct Part {
    /// Its name in animations.
    pub name: String,
    /// A picture beside the model.
    pub texture: Option<&'static str>,
    /// Faces that meet at less than this are smooth, deg.
    pub crease_deg: f64,
    /// Its shape.
    pub mesh: Mesh,
}

impl Part {
    /// A part without a texture.
    pub fn new(name: impl Into<String>, mesh: Mesh) -> Self {
        Self { name: name.into(), texture: None, crease_deg: 40.0, mesh }
    }

    /// With a texture.
    pub fn with_texture(mut self, texture: &'static str) -> Self {
        self.texture = Some(texture);
        self
    }

    /// Smooth over sharper edges.
    pub fn smooth(mut self, crease_deg: f64) -> Self {
        self.crease_deg = crease_deg;
        self
    }
}

/// The model's file; its origin is at a station.
pub fn write(parts: &[Part], origin_m: Point) -> String {
    let mut text = String::from("AC3Db\n");
    for material in MATERIALS {
        let [r, g, b] = material.colour;
        let emission = material.colour.map(|x| number(x * material.emission));
        let _ = writeln!(
            text,
            "MATERIAL \"{}\" rgb {r} {g} {b}  amb {r} {g} {b}  emis {}  spec {s} {s} {s}  shi {}  trans {}",
            material.name,
            emission.join(" "),
            material.shininess,
            material.transparency,
            s = material.specular,
        );
    }
    let _ = writeln!(text, "OBJECT world\nkids {}", parts.len());
    for part in parts {
        object(&mut text, part, origin_m);
    }
    text
}

fn object(text: &mut String, part: &Part, origin_m: Point) {
    // Corners at the same place are one, or the surface would not be smooth there.
    let mut numbers = BTreeMap::new();
    let mut places = Vec::new();
    let mut surfaces = String::new();
    for polygon in &part.mesh.polygons {
        let flags = if polygon.both_sides { "0x30" } else { "0x10" };
        let count = polygon.corners.len();
        let _ = writeln!(surfaces, "SURF {flags}\nmat {}\nrefs {count}", polygon.material);
        for corner in &polygon.corners {
            let [aft, right, up] = [0, 1, 2].map(|i| number(corner.at_m[i] - origin_m[i]));
            let minus_right =
                right.strip_prefix('-').map_or_else(|| minus(&right), ToString::to_string);
            let place = format!("{aft} {up} {minus_right}");
            let next = numbers.len();
            let index = *numbers.entry(place.clone()).or_insert(next);
            if index == next {
                places.push(place);
            }
            let _ = writeln!(surfaces, "{index} {} {}", number(corner.uv[0]), number(corner.uv[1]));
        }
    }
    let _ = writeln!(text, "OBJECT poly\nname \"{}\"", part.name);
    if let Some(texture) = part.texture {
        let _ = writeln!(text, "texture \"{texture}\"");
    }
    let _ = writeln!(text, "crease {}\nnumvert {}", number(part.crease_deg), places.len());
    for place in places {
        text.push_str(&place);
        text.push('\n');
    }
    let _ = writeln!(text, "numsurf {}\n{surfaces}kids 0", part.mesh.polygons.len());
}

fn minus(number: &str) -> String {
    if number == "0" { "0".to_owned() } else { format!("-{number}") }
}

/// A number to a tenth of a millimetre, as short as it can be said.
pub fn number(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_at_one_place_are_written_once() {
        let mut mesh = Mesh::default();
        mesh.cuboid(0, [0.0; 3], [1.0, 2.0, 3.0]);
        let text = write(&[Part::new("box", mesh)], [0.5, 0.0, 0.0]);
        assert!(text.contains("numvert 8\n") && text.contains("numsurf 6\n"), "{text}");
        // Right is minus z in the file, up is y.
        assert!(text.contains("\n0.5 3 -2\n"), "{text}");
    }

    #[test]
    fn every_material_is_numbered() {
        assert_eq!(MATERIALS[material::BEAM].name, "beam");
        assert_eq!(MATERIALS[material::GLASS].name, "glass");
        assert_eq!(MATERIALS[material::SKIN].name, "skin");
        assert_eq!(MATERIALS.len(), material::BEAM + 1);
    }
}
