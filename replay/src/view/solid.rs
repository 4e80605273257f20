//! Meshes that are put together from rings of points.

use engine::math::{TAU, cos, sin};
use rerun::Mesh3D;

/// In some axes, m.
pub type Point = [f32; 3];

/// A mesh that grows.
#[derive(Default)]
pub struct Solid {
    pub(super) positions: Vec<Point>,
    pub(super) normals: Vec<Point>,
    pub(super) colours: Vec<u32>,
    pub(super) triangles: Vec<[u32; 3]>,
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
    pub fn skin(&mut self, rings: &[Vec<Point>], colour: impl Fn(usize, Point) -> u32) {
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
pub fn refine(rings: &[Vec<Point>], parts: u16) -> Vec<Vec<Point>> {
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
