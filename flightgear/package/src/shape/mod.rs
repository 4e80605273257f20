//! The aircraft's shape, from the aircraft file: parts by name, in stations of the drawing.
//!
//! Pivots, hubs, rotors, spans, chords and wheels are those that the aircraft is given; what the file
//! does not have (hinges, doors, the cockpit) is for recognition.

pub mod bays;
pub mod cockpit;
pub mod fuselage;
pub mod gear;
pub mod lights;
pub mod nacelle;
pub mod rotor;
pub mod tail;
pub mod wing;

use engine::math::{TAU, cos, max, min, sin, sqrt};

use crate::mesh::Point;

/// The sides: index and sign of the buttline. The left one is made as the image of the right one.
pub const SIDES: [(usize, &str, f64); 2] = [(0, "left", -1.0), (1, "right", 1.0)];

/// `count` + 1 numbers from one to another.
pub fn steps(from: f64, to: f64, count: u16) -> Vec<f64> {
    (0..=count).map(|i| from + (to - from) * f64::from(i) / f64::from(count)).collect()
}

/// Rows of numbers over their first one, smooth between and without overshoot: monotone cubics.
pub struct Smooth<const N: usize> {
    rows: Vec<[f64; N]>,
    slopes: Vec<[f64; N]>,
}

impl<const N: usize> Smooth<N> {
    /// Through the rows, at least two, the first number ascending.
    pub fn new(rows: &[[f64; N]]) -> Self {
        let last = rows.len() - 1;
        let slope = |i: usize, k: usize| {
            let pair = [rows[i][k], rows[i + 1][k]];
            (pair[1] - pair[0]) / (rows[i + 1][0] - rows[i][0])
        };
        let at = |i: usize, k: usize| match i {
            0 => slope(0, k),
            i if i == last => slope(last - 1, k),
            i => {
                let (before, after) = (slope(i - 1, k), slope(i, k));
                if before * after <= 0.0 { 0.0 } else { 2.0 * before * after / (before + after) }
            }
        };
        let slopes = (0..rows.len()).map(|i| std::array::from_fn(|k| at(i, k))).collect();
        Self { rows: rows.to_vec(), slopes }
    }

    /// Where the rows begin and end.
    pub fn range(&self) -> [f64; 2] {
        [self.rows[0][0], self.rows[self.rows.len() - 1][0]]
    }

    /// The row at a place, held beyond the ends.
    pub fn at(&self, x: f64) -> [f64; N] {
        let [first, last] = self.range();
        let x = max(first, min(last, x));
        let inner = &self.rows[1..self.rows.len() - 1];
        let i = inner.iter().filter(|row| row[0] <= x).count();
        let (a, b) = (&self.rows[i], &self.rows[i + 1]);
        let width = b[0] - a[0];
        let t = (x - a[0]) / width;
        let (t2, t3) = (t * t, t * t * t);
        std::array::from_fn(|k| {
            a[k] * (2.0 * t3 - 3.0 * t2 + 1.0)
                + width * self.slopes[i][k] * (t3 - 2.0 * t2 + t)
                + b[k] * (3.0 * t2 - 2.0 * t3)
                + width * self.slopes[i + 1][k] * (t3 - t2)
        })
    }
}

/// Half the thickness of a symmetric four-digit section over its chord.
pub fn half_thickness(thickness_ratio: f64, along: f64) -> f64 {
    let x = along;
    thickness_ratio
        * (1.4845 * sqrt(x) - 0.630 * x - 1.758 * x * x + 1.4215 * x * x * x
            - 0.518 * x * x * x * x)
}

/// An outline of a section in parts of the chord: along it from the nose, and off it.
pub type Outline = Vec<[f64; 2]>;

/// A section's front part, up to `hinge`.
pub fn front(thickness_ratio: f64, hinge: f64) -> Outline {
    let mut outline = Vec::new();
    for side in [1.0, -1.0] {
        let along = (0..=12).map(|i| {
            let part = 0.5 * (1.0 - cos(0.5 * TAU * f64::from(i) / 12.0));
            hinge * part
        });
        let points = along.map(|x| [x, side * half_thickness(thickness_ratio, x)]);
        if side > 0.0 {
            outline.extend(points.collect::<Vec<_>>().into_iter().rev());
        } else {
            outline.extend(points.skip(1));
        }
    }
    outline
}

/// A section's rear part from `hinge`, with a round nose.
pub fn rear(thickness_ratio: f64, hinge: f64) -> Outline {
    let radius = half_thickness(thickness_ratio, hinge) * 0.96;
    let mut outline = Vec::new();
    let along = steps(1.0, hinge, 4);
    outline.extend(along.iter().map(|&x| [x, 0.96 * half_thickness(thickness_ratio, x)]));
    outline.extend((1..6).map(|i| {
        let angle_rad = 0.5 * TAU * f64::from(i) / 6.0;
        [hinge - radius * sin(angle_rad), radius * cos(angle_rad)]
    }));
    outline.extend(along.iter().rev().map(|&x| [x, -0.96 * half_thickness(thickness_ratio, x)]));
    outline
}

/// A section in its place: by its quarter chord, lying or standing.
pub fn place(outline: &Outline, quarter_m: Point, chord_m: f64, standing: bool) -> Vec<Point> {
    let [aft, right, up] = quarter_m;
    outline
        .iter()
        .map(|&[along, off]| {
            let (along, off) = ((along - 0.25) * chord_m, off * chord_m);
            if standing { [aft + along, right + off, up] } else { [aft + along, right, up + off] }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_row_goes_through_its_points_and_not_beyond_them() {
        let rows = [[0.0, 0.0], [1.0, 2.0], [2.0, 2.0], [3.0, 5.0]];
        let smooth = Smooth::new(&rows);
        for [x, y] in rows {
            assert!((smooth.at(x)[1] - y).abs() < 1e-12);
        }
        for x in steps(1.0, 2.0, 20) {
            assert!((smooth.at(x)[1] - 2.0).abs() < 1e-12, "flat stays flat");
        }
        assert!((smooth.at(-1.0)[1]).abs() < 1e-12 && (smooth.at(9.0)[1] - 5.0).abs() < 1e-12);
    }
}
