//! Meshes of polygons that are painted and cut along planes.
//!
//! Points are stations of the drawing, m: aft, right, up.

use engine::math::{TAU, cos, sin, sqrt};

/// A point or a direction.
pub type Point = [f64; 3];

/// A corner of a polygon.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Where it is.
    pub at_m: Point,
    /// Where it is on the texture, 0..1, from the lower left.
    pub uv: [f64; 2],
}

impl Corner {
    /// A corner without a texture.
    pub fn new(at_m: Point) -> Self {
        Self { at_m, uv: [0.0; 2] }
    }

    fn between(&self, other: &Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * part;
        Self {
            at_m: [0, 1, 2].map(|i| mix(self.at_m[i], other.at_m[i])),
            uv: [0, 1].map(|i| mix(self.uv[i], other.uv[i])),
        }
    }
}

/// A flat face, anticlockwise from outside.
#[derive(Clone, Debug)]
pub struct Polygon {
    /// What it is made of: an entry of [`crate::ac3d::MATERIALS`].
    pub material: usize,
    /// Seen from both sides.
    pub both_sides: bool,
    /// At least three.
    pub corners: Vec<Corner>,
}

/// What is on one side of a plane: `along · point ≤ limit`.
#[derive(Clone, Copy, Debug)]
pub struct Half {
    along: Point,
    limit: f64,
}

impl Half {
    /// Points whose `axis` (0 aft, 1 right, 2 up) is below a limit.
    pub fn below(axis: usize, limit: f64) -> Self {
        let mut along = [0.0; 3];
        along[axis] = 1.0;
        Self { along, limit }
    }

    /// Points whose `axis` is above a limit.
    pub fn above(axis: usize, limit: f64) -> Self {
        let mut along = [0.0; 3];
        along[axis] = -1.0;
        Self { along, limit: -limit }
    }

    /// Points at which the line from `a` to `b` has passed them on its left, seen with `axes` as
    /// horizontal and vertical.
    pub fn left_of(axes: [usize; 2], a: [f64; 2], b: [f64; 2]) -> Self {
        let mut along = [0.0; 3];
        along[axes[0]] = b[1] - a[1];
        along[axes[1]] = a[0] - b[0];
        Self { along, limit: along[axes[0]] * a[0] + along[axes[1]] * a[1] }
    }

    fn beyond(&self, at: Point) -> f64 {
        dot(self.along, at) - self.limit
    }
}

/// A convex region: everything inside all of its halves.
pub type Region = Vec<Half>;

/// The inside of a convex outline, anticlockwise with `axes` as horizontal and vertical.
pub fn outline(axes: [usize; 2], corners: &[[f64; 2]]) -> Region {
    (0..corners.len())
        .map(|i| Half::left_of(axes, corners[i], corners[(i + 1) % corners.len()]))
        .collect()
}

/// Polygons that belong together.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// In no order that matters.
    pub polygons: Vec<Polygon>,
}

impl Mesh {
    /// A face.
    pub fn face(&mut self, material: usize, corners: &[Point]) {
        let corners = corners.iter().copied().map(Corner::new).collect();
        self.polygons.push(Polygon { material, both_sides: false, corners });
    }

    /// A skin over rings of equally many points, outside out; its ends are open.
    pub fn skin(&mut self, material: usize, rings: &[Vec<Point>]) {
        self.strip(material, rings, true);
    }

    /// A sheet over lines of equally many points, seen from the side from which the first line's
    /// direction is to the right and the next line above it.
    pub fn sheet(&mut self, material: usize, lines: &[Vec<Point>]) {
        self.strip(material, lines, false);
    }

    fn strip(&mut self, material: usize, rings: &[Vec<Point>], closed: bool) {
        let around = rings.first().map_or(0, Vec::len);
        let inward = closed && outwardness(rings) < 0.0;
        for pair in rings.windows(2) {
            for j in 0..if closed { around } else { around.saturating_sub(1) } {
                let next = (j + 1) % around;
                let mut corners = vec![pair[0][j], pair[0][next], pair[1][next], pair[1][j]];
                if inward {
                    corners.reverse();
                }
                self.face(material, &without_repeats(corners));
            }
        }
        self.polygons.retain(|polygon| polygon.corners.len() > 2);
    }

    /// Closes the first and the last ring of a skin.
    pub fn caps(&mut self, material: usize, rings: &[Vec<Point>]) {
        for (end, other) in [(0, rings.len() - 1), (rings.len() - 1, 0)] {
            let outward = sub(mean(&rings[end]), mean(&rings[other]));
            let mut rim = without_repeats(rings[end].clone());
            if rim.len() < 3 {
                continue;
            }
            if dot(area(&rim), outward) < 0.0 {
                rim.reverse();
            }
            self.face(material, &rim);
        }
    }

    /// A skin with closed ends.
    pub fn body(&mut self, material: usize, rings: &[Vec<Point>]) {
        self.skin(material, rings);
        self.caps(material, rings);
    }

    /// A box between two corners.
    pub fn cuboid(&mut self, material: usize, from: Point, to: Point) {
        let [[a, b, c], [d, e, f]] = [from, to];
        let ring = |x: f64| vec![[x, b, c], [x, e, c], [x, e, f], [x, b, f]];
        self.body(material, &[ring(a), ring(d)]);
    }

    /// A round bar from one point to another.
    pub fn bar(&mut self, material: usize, from: Point, to: Point, radius_m: f64) {
        self.cone(material, (from, radius_m), (to, radius_m), 12);
    }

    /// A round bar whose radius changes.
    pub fn cone(
        &mut self,
        material: usize,
        (from, radius): (Point, f64),
        (to, end_radius): (Point, f64),
        points: u16,
    ) {
        let along = unit(sub(to, from));
        let helper = if along[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let across = unit(cross(along, helper));
        let third = cross(along, across);
        let circle = |at: Point, r: f64| {
            ring(points, |s, c| add(at, add(scale(across, r * c), scale(third, r * s))))
        };
        self.body(material, &[circle(from, radius), circle(to, end_radius)]);
    }

    /// Gives everything inside a region another material.
    pub fn paint(&mut self, region: &[Half], material: usize) {
        let mut inside = self.cut(region);
        inside.polygons.iter_mut().for_each(|polygon| polygon.material = material);
        self.join(inside);
    }

    /// Takes away what is inside a region.
    pub fn cut(&mut self, region: &[Half]) -> Self {
        let mut cut = Self::default();
        let mut kept = Vec::new();
        for polygon in std::mem::take(&mut self.polygons) {
            let mut rest = polygon;
            let mut pieces = Vec::new();
            for half in region {
                let (inside, outside) = split(&rest, half);
                pieces.extend(outside);
                match inside {
                    Some(inside) => rest = inside,
                    None => {
                        rest.corners.clear();
                        break;
                    }
                }
            }
            if rest.corners.len() > 2 {
                cut.polygons.push(rest);
            }
            kept.extend(pieces);
        }
        self.polygons = kept;
        cut
    }

    /// Adds another mesh.
    pub fn join(&mut self, other: Self) {
        self.polygons.extend(other.polygons);
    }

    /// The image in the plane of symmetry.
    pub fn mirrored(&self) -> Self {
        self.moved(|[aft, right, up]| [aft, -right, up], true)
    }

    /// Every point elsewhere; `turned` where right becomes left.
    pub fn moved(&self, to: impl Fn(Point) -> Point, turned: bool) -> Self {
        let mut mesh = self.clone();
        for polygon in &mut mesh.polygons {
            polygon.corners.iter_mut().for_each(|corner| corner.at_m = to(corner.at_m));
            if turned {
                polygon.corners.reverse();
            }
        }
        mesh
    }

    /// The other side out.
    pub fn inside_out(mut self) -> Self {
        self.polygons.iter_mut().for_each(|polygon| polygon.corners.reverse());
        self
    }

    /// Seen from both sides.
    pub fn two_sided(mut self) -> Self {
        self.polygons.iter_mut().for_each(|polygon| polygon.both_sides = true);
        self
    }

    /// With places on the texture.
    pub fn textured(mut self, uv: impl Fn(Point) -> [f64; 2]) -> Self {
        for corner in self.polygons.iter_mut().flat_map(|polygon| &mut polygon.corners) {
            corner.uv = uv(corner.at_m);
        }
        self
    }
}

/// Splits a polygon into what is inside a half and what is outside.
fn split(polygon: &Polygon, half: &Half) -> (Option<Polygon>, Option<Polygon>) {
    /// Nearer to the plane than this is on it, m.
    const ON_M: f64 = 1e-7;
    let beyond: Vec<f64> = polygon.corners.iter().map(|corner| half.beyond(corner.at_m)).collect();
    if beyond.iter().all(|&by| by <= ON_M) {
        return (Some(polygon.clone()), None);
    }
    if beyond.iter().all(|&by| by >= -ON_M) {
        return (None, Some(polygon.clone()));
    }
    let (mut inside, mut outside) = (Vec::new(), Vec::new());
    for (i, (corner, &by)) in polygon.corners.iter().zip(&beyond).enumerate() {
        let next = (i + 1) % beyond.len();
        if by <= ON_M {
            inside.push(*corner);
        }
        if by >= -ON_M {
            outside.push(*corner);
        }
        if (by < -ON_M && beyond[next] > ON_M) || (by > ON_M && beyond[next] < -ON_M) {
            let at = corner.between(&polygon.corners[next], by / (by - beyond[next]));
            inside.push(at);
            outside.push(at);
        }
    }
    let with =
        |corners: Vec<Corner>| (corners.len() > 2).then(|| Polygon { corners, ..polygon.clone() });
    (with(inside), with(outside))
}

/// Whether a skin's faces, as their points run, look away from the middles of its rings.
fn outwardness(rings: &[Vec<Point>]) -> f64 {
    let mut sum = 0.0;
    for pair in rings.windows(2) {
        let middle = scale(add(mean(&pair[0]), mean(&pair[1])), 0.5);
        let around = pair[0].len();
        for j in 0..around {
            let next = (j + 1) % around;
            let face = [pair[0][j], pair[0][next], pair[1][next], pair[1][j]];
            sum += dot(area(&face), sub(mean(&face), middle));
        }
    }
    sum
}

fn without_repeats(mut corners: Vec<Point>) -> Vec<Point> {
    let near = |a: Point, b: Point| dot(sub(a, b), sub(a, b)) < 1e-10;
    corners.dedup_by(|a, b| near(*a, *b));
    while corners.len() > 1 && near(corners[0], corners[corners.len() - 1]) {
        corners.pop();
    }
    corners
}

/// Twice the area of a flat polygon, along its normal.
fn area(rim: &[Point]) -> Point {
    (1..rim.len().saturating_sub(1))
        .fold([0.0; 3], |sum, i| add(sum, cross(sub(rim[i], rim[0]), sub(rim[i + 1], rim[0]))))
}

/// The middle of some points.
pub fn mean(points: &[Point]) -> Point {
    scale(points.iter().fold([0.0; 3], |sum, &at| add(sum, at)), 1.0 / points.len() as f64)
}

/// Sum.
pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Difference.
pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Product with a number.
pub fn scale(a: Point, by: f64) -> Point {
    a.map(|x| x * by)
}

/// Scalar product.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Of length one.
pub fn unit(a: Point) -> Point {
    let length = sqrt(dot(a, a));
    if length > 1e-12 { scale(a, 1.0 / length) } else { [0.0, 0.0, 1.0] }
}

/// Points around a circle from its sine and cosine.
pub fn ring(points: u16, at: impl Fn(f64, f64) -> Point) -> Vec<Point> {
    (0..points)
        .map(|i| {
            let angle_rad = TAU * f64::from(i) / f64::from(points);
            at(sin(angle_rad), cos(angle_rad))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Mesh {
        let mut mesh = Mesh::default();
        mesh.face(0, &[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]);
        mesh
    }

    fn total_area(mesh: &Mesh) -> f64 {
        let faces = mesh.polygons.iter().map(|polygon| {
            let rim: Vec<_> = polygon.corners.iter().map(|corner| corner.at_m).collect();
            0.5 * area(&rim)[2]
        });
        faces.sum()
    }

    #[test]
    fn what_is_cut_and_what_is_left_are_the_whole() {
        let mut mesh = square();
        let window = mesh.cut(&outline([0, 1], &[[0.5, 0.5], [1.5, 0.5], [1.0, 1.5]]));
        assert!((total_area(&window) - 0.5).abs() < 1e-12, "{}", total_area(&window));
        assert!((total_area(&mesh) - 3.5).abs() < 1e-12, "{}", total_area(&mesh));
    }

    #[test]
    fn a_region_beside_the_mesh_changes_nothing() {
        let mut mesh = square();
        assert!(mesh.cut(&[Half::above(0, 3.0)]).polygons.is_empty());
        assert_eq!(mesh.polygons.len(), 1);
    }

    #[test]
    fn a_box_is_seen_from_outside() {
        let mut mesh = Mesh::default();
        mesh.cuboid(0, [1.0, 1.0, 1.0], [2.0, 3.0, 4.0]);
        assert_eq!(mesh.polygons.len(), 6);
        let middle = [1.5, 2.0, 2.5];
        for polygon in &mesh.polygons {
            let rim: Vec<_> = polygon.corners.iter().map(|corner| corner.at_m).collect();
            assert!(dot(area(&rim), sub(mean(&rim), middle)) > 0.0, "{rim:?}");
        }
    }
}
