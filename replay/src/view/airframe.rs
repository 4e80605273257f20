//! The XV-15 as meshes, from the stations of its data sheet.
//!
//! The airframe's axes are the body's (forward, right, down) with their origin at the datum of the
//! drawings: a station (aft, right, up) is drawn at (−aft, right, −up). A nacelle's axes are the
//! Mast's with their origin at the pivot. Shapes are for recognition; only pivots, hubs, rotor
//! radius, spans and chords are the sheet's.

use engine::math::{TAU, cos, sin};
use engine::pair::Pair;
use rerun::Mesh3D;
use rerun::components::AlbedoFactor;

/// In some axes, m.
pub type Point = [f32; 3];

/// Nacelle pivots: SL 300, BL ±193, WL 100 in.
pub const PIVOT_M: Pair<Point> =
    Pair { left: station(7.620, -4.902, 2.540), right: station(7.620, 4.902, 2.540) };
/// Pivot to hub, 4.667 ft.
pub const MAST_M: f64 = 1.4225;
/// The hub in a nacelle's axes.
pub const HUB_M: Point = [0.0, 0.0, -MAST_M as f32];
/// How far the gear moves up.
pub const GEAR_TRAVEL_M: f32 = 0.78;

const ROTOR_RADIUS_M: f32 = 3.81;
const BLADE_CHORD_M: f32 = 0.3556;

const WHITE: u32 = 0xEC_EE_F0_FF;
const BLUE: u32 = 0x24_57_A8_FF;
const GLASS: u32 = 0x1C_2A_38_FF;
const DARK: u32 = 0x3A_3E_44_FF;
const BLADE: u32 = 0x2A_2C_30_FF;
const TIP: u32 = 0xF2_C0_30_FF;

/// A drawing's station in the airframe's axes.
const fn station(aft: f32, right: f32, up: f32) -> Point {
    [-aft, right, -up]
}

/// A mesh that grows.
#[derive(Default)]
pub struct Solid {
    positions: Vec<Point>,
    normals: Vec<Point>,
    colours: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// As rerun draws it.
    pub fn mesh(self) -> Mesh3D {
        Mesh3D::new(self.positions)
            .with_vertex_normals(self.normals)
            .with_vertex_colors(self.colours)
            .with_triangle_indices(self.triangles)
    }

    /// A skin over rings of equally many points, closed at both ends; `colour` of the point's number
    /// in its ring and of the point.
    fn skin(&mut self, rings: &[Vec<Point>], colour: impl Fn(usize, Point) -> u32) {
        let Some(around) = rings.first().map(Vec::len) else { return };
        let base = self.positions.len();
        let centres: Vec<Point> = rings.iter().map(|ring| mean(ring)).collect();
        for (i, ring) in rings.iter().enumerate() {
            let (before, after) =
                (&rings[i.saturating_sub(1)], &rings[(i + 1).min(rings.len() - 1)]);
            for (j, &at) in ring.iter().enumerate() {
                let along = sub(after[j], before[j]);
                let across = sub(ring[(j + 1) % around], ring[(j + around - 1) % around]);
                let normal = unit(cross(along, across));
                let outward = dot(normal, sub(at, centres[i])) >= 0.0;
                self.positions.push(at);
                self.normals.push(if outward { normal } else { scale(normal, -1.0) });
                self.colours.push(colour(j, at));
            }
        }
        for i in 1..rings.len() {
            for j in 0..around {
                let corner =
                    |ring: usize, point: usize| index(base + ring * around + point % around);
                let [a, b] = [corner(i - 1, j), corner(i - 1, j + 1)];
                let [c, d] = [corner(i, j), corner(i, j + 1)];
                self.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        let ends = [(0, rings.len() - 1), (rings.len() - 1, 0)];
        for (end, other) in ends {
            let outward = unit(sub(centres[end], centres[other]));
            self.fan(&rings[end], outward, colour(0, rings[end][0]));
        }
    }

    /// A flat face.
    pub fn fan(&mut self, rim: &[Point], normal: Point, colour: u32) {
        let base = self.positions.len();
        self.positions.extend(rim);
        self.normals.extend(rim.iter().map(|_| normal));
        self.colours.extend(rim.iter().map(|_| colour));
        for j in 2..rim.len() {
            self.triangles.push([index(base), index(base + j - 1), index(base + j)]);
        }
    }
}

/// Everything that neither tilts nor turns.
pub fn airframe() -> Solid {
    let mut solid = Solid::default();
    fuselage(&mut solid);
    wing(&mut solid);
    tail(&mut solid);
    pods(&mut solid);
    solid
}

fn fuselage(solid: &mut Solid) {
    // Aft, half width, bottom, top; SL 112 to 603.8, WL 23 to 97 in.
    const SECTIONS: [(f32, f32, f32, f32); 15] = [
        (2.85, 0.03, 0.96, 1.02),
        (3.00, 0.26, 0.80, 1.18),
        (3.40, 0.50, 0.66, 1.42),
        (3.90, 0.67, 0.60, 1.72),
        (4.40, 0.76, 0.58, 2.10),
        (4.90, 0.81, 0.58, 2.36),
        (5.50, 0.83, 0.58, 2.45),
        (8.60, 0.83, 0.58, 2.46),
        (9.60, 0.80, 0.64, 2.46),
        (10.60, 0.70, 0.86, 2.46),
        (11.60, 0.56, 1.18, 2.46),
        (12.60, 0.43, 1.52, 2.47),
        (13.60, 0.32, 1.83, 2.50),
        (14.60, 0.22, 2.10, 2.52),
        (15.34, 0.08, 2.32, 2.50),
    ];
    let rings: Vec<_> = SECTIONS
        .iter()
        .map(|&(aft, half, bottom, top)| {
            let (middle, tall) = (0.5 * (bottom + top), 0.5 * (top - bottom));
            ring(40, |s, c| {
                // Between an ellipse and a box.
                let round = |v: f32| v.signum() * v.abs().powf(0.72);
                station(aft, half * round(s), middle + tall * round(c))
            })
        })
        .collect();
    let densely = refine(&rings, 5);
    solid.skin(&densely, |point, at| {
        let [aft, right, up] = [-at[0], at[1].abs(), -at[2]];
        let windscreen = (3.75..5.0).contains(&aft) && up > 1.62 && up < 2.27;
        let side_window = (5.15..6.2).contains(&aft) && up > 1.62 && up < 2.1;
        let post = right < 0.05 || (4.45..4.58).contains(&aft);
        let stripe = matches!(point, 11..=12 | 28..=29) && aft > 3.3;
        match () {
            () if (windscreen || side_window) && !post => GLASS,
            () if stripe || aft > 14.2 => BLUE,
            () => WHITE,
        }
    });
}

fn wing(solid: &mut Solid) {
    // Quarter chord through SL 291.7, WL 96, BL 96.6 in; swept 6.5° forward, dihedral 2°.
    let rings: Vec<_> = [-4.75_f32, 0.0, 4.75]
        .iter()
        .map(|&right| {
            let out = right.abs() - 2.454;
            section([7.409 - 0.1139 * out, right, 2.40 + 0.0349 * out], 1.60, 0.23, false)
        })
        .collect();
    solid.skin(&rings, |_, _| WHITE);
}

fn tail(solid: &mut Solid) {
    // SL 560, WL 103, span 12.83 ft, chord 3.92 ft.
    let plane = [-1.955_f32, 1.955].map(|right| section([14.224, right, 2.55], 1.195, 0.15, false));
    solid.skin(&plane, |_, _| WHITE);
    // SL 570, WL 115.7, BL ±77 in; span 7.68 ft, chord 4.09 to 2.40 ft, swept 31.6°.
    for right in [-1.956, 1.956] {
        let fin = [(1.45_f32, 0.90, 0.35), (2.55, 1.247, 0.0), (3.80, 0.732, 0.77)]
            .map(|(up, chord, aft)| section([14.478 + aft, right, up], chord, 0.10, true));
        solid.skin(&refine(&fin, 6), |_, at| if -at[2] > 3.2 { BLUE } else { WHITE });
    }
}

/// The pods of the main gear; 9 ft 8 in over both.
fn pods(solid: &mut Solid) {
    for side in [-1.0, 1.0] {
        let rings: Vec<_> =
            [(6.3_f32, 0.02_f32), (6.6, 0.26), (7.2, 0.41), (8.4, 0.46), (9.4, 0.34), (10.4, 0.03)]
                .iter()
                .map(|&(aft, radius)| {
                    ring(20, |s, c| station(aft, side * 1.015 + radius * s, 0.96 + radius * c))
                })
                .collect();
        solid.skin(&rings, |_, _| WHITE);
    }
}

/// Wheels and legs, extended. Axles: nose SL 137, WL 4; mains SL 326, WL 7, BL ±47 in.
pub fn gear() -> Solid {
    let mut solid = Solid::default();
    let mut leg = |aft: f32, right: f32, axle: f32, radius: f32, top: f32| {
        for offset in [-0.13_f32, 0.13] {
            let wheel = [-0.07_f32, 0.07].map(|half| {
                ring(20, |s, c| station(aft + radius * s, right + offset + half, axle + radius * c))
            });
            solid.skin(&wheel, |_, _| DARK);
        }
        let strut =
            [axle, top].map(|up| ring(10, |s, c| station(aft + 0.06 * s, right + 0.06 * c, up)));
        solid.skin(&strut, |_, _| WHITE);
    };
    leg(3.48, 0.0, 0.10, 0.165, 0.66);
    leg(8.28, -1.19, 0.18, 0.260, 0.60);
    leg(8.28, 1.19, 0.18, 0.260, 0.60);
    solid
}

/// A nacelle and its spinner, in the mast's axes.
pub fn nacelle() -> Solid {
    // Down the mast, half depth (fore and aft), half width.
    const POD: [(f32, f32, f32); 9] = [
        (1.72, 0.20, 0.20),
        (1.60, 0.30, 0.28),
        (1.20, 0.43, 0.38),
        (0.60, 0.54, 0.46),
        (0.00, 0.58, 0.49),
        (-0.50, 0.55, 0.47),
        (-0.90, 0.46, 0.42),
        (-1.15, 0.38, 0.38),
        (-1.20, 0.34, 0.34),
    ];
    const SPINNER: [(f32, f32, f32); 5] = [
        (-1.22, 0.34, 0.34),
        (-1.45, 0.31, 0.31),
        (-1.68, 0.23, 0.23),
        (-1.86, 0.11, 0.11),
        (-1.93, 0.01, 0.01),
    ];
    let rings = |sections: &[(f32, f32, f32)]| -> Vec<Vec<Point>> {
        let one =
            |&(down, deep, wide): &(f32, f32, f32)| ring(28, |s, c| [deep * c, wide * s, down]);
        sections.iter().map(one).collect()
    };
    let mut solid = Solid::default();
    solid.skin(&rings(&POD), |_, at| match at[2] {
        down if down > 1.3 => DARK,
        down if (-0.95..-0.6).contains(&down) => BLUE,
        _ => WHITE,
    });
    solid.skin(&rings(&SPINNER), |_, _| BLUE);
    solid
}

/// Three blades, the first one aft.
pub fn blades() -> Solid {
    let mut solid = Solid::default();
    for blade in 0..3_u8 {
        let azimuth_rad = TAU * f64::from(blade) / 3.0;
        let (s, c) = (sin(azimuth_rad) as f32, cos(azimuth_rad) as f32);
        let rings = [0.10_f32, 0.90, 0.905, 1.0].map(|part| {
            let (out, half) = (part * ROTOR_RADIUS_M, 0.5 * BLADE_CHORD_M);
            // The precone of 2.5°.
            let down = -0.044 * out;
            [(half, -0.02), (half, 0.02), (-half, 0.02), (-half, -0.02)]
                .map(|(across, thick)| [-out * c - across * s, across * c - out * s, down + thick])
                .to_vec()
        });
        let tip_m = 0.903 * ROTOR_RADIUS_M;
        solid.skin(&rings, |_, [x, y, _]| if x * x + y * y > tip_m * tip_m { TIP } else { BLADE });
    }
    solid
}

/// What a turning rotor looks like.
pub fn disc(colour: u32) -> Mesh3D {
    let mut solid = Solid::default();
    let rim = ring(72, |s, c| [ROTOR_RADIUS_M * c, ROTOR_RADIUS_M * s, -0.044 * ROTOR_RADIUS_M]);
    solid.fan(&rim, [0.0, 0.0, -1.0], colour);
    solid.mesh().with_albedo_factor(AlbedoFactor::from(rerun::Rgba32(0xFF_FF_FF_48)))
}

/// A symmetric wing section around its quarter chord (aft, right, up), flat or standing.
fn section(quarter: Point, chord: f32, thickness: f32, standing: bool) -> Vec<Point> {
    ring(28, |s, c| {
        // Cosine spacing from the trailing edge around the nose and back.
        let along = 0.5 * (1.0 + c);
        let half = thickness
            * (1.4845 * along.sqrt() - 0.630 * along - 1.758 * along.powi(2)
                + 1.4215 * along.powi(3)
                - 0.518 * along.powi(4));
        let off = s.signum() * half * chord;
        let [aft, right, up] = quarter;
        let aft = aft + (along - 0.25) * chord;
        if standing { station(aft, right + off, up) } else { station(aft, right, up + off) }
    })
}

/// Points around a circle from its sine and cosine.
pub fn ring(points: u16, at: impl Fn(f32, f32) -> Point) -> Vec<Point> {
    (0..points)
        .map(|i| {
            let angle_rad = TAU * f64::from(i) / f64::from(points);
            at(sin(angle_rad) as f32, cos(angle_rad) as f32)
        })
        .collect()
}

/// Rings with `parts` − 1 more between each two, for colours with sharp edges.
fn refine(rings: &[Vec<Point>], parts: u16) -> Vec<Vec<Point>> {
    let mut fine = Vec::new();
    for pair in rings.windows(2) {
        for part in 0..parts {
            let weight = f32::from(part) / f32::from(parts);
            let between = pair[0].iter().zip(&pair[1]);
            fine.push(between.map(|(&a, &b)| add(a, scale(sub(b, a), weight))).collect());
        }
    }
    fine.extend(rings.last().cloned());
    fine
}

fn index(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(u32::MAX)
}

fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scale(a: Point, by: f32) -> Point {
    a.map(|x| x * by)
}

fn dot(a: Point, b: Point) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Point) -> Point {
    let length = dot(a, a).sqrt();
    if length > 1e-9 { scale(a, 1.0 / length) } else { [0.0, 0.0, -1.0] }
}

fn mean(points: &[Point]) -> Point {
    let sum = points.iter().fold([0.0; 3], |sum, &at| add(sum, at));
    scale(sum, 1.0 / points.len() as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_corner_exists_and_every_number_is_finite() {
        for solid in [airframe(), gear(), nacelle(), blades()] {
            let count = index(solid.positions.len());
            assert_eq!(solid.normals.len(), solid.positions.len());
            assert_eq!(solid.colours.len(), solid.positions.len());
            assert!(solid.triangles.iter().flatten().all(|&corner| corner < count));
            assert!(solid.positions.iter().chain(&solid.normals).flatten().all(|x| x.is_finite()));
        }
    }

    #[test]
    fn the_spans_are_those_of_the_sheet() {
        let solid = airframe();
        let extent = |axis: usize| {
            let along = solid.positions.iter().map(|at| at[axis]);
            along.clone().fold(f32::MIN, f32::max) - along.fold(f32::MAX, f32::min)
        };
        // 9.8 m between nacelle centrelines; the nacelles hide the wing's ends.
        assert!((extent(1) - 9.5).abs() < 0.01, "{}", extent(1));
        assert!((12.4..14.1).contains(&extent(0)), "{}", extent(0));
    }
}
