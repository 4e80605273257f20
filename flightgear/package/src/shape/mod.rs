//! The aircraft's shape, from the aircraft file: parts by name, in stations of the drawing.
//!
//! Pivots, hubs, rotors, spans, chords and wheels are those that the aircraft is given; what the file
//! does not have (hinges, doors, the cockpit) is for recognition: drawn for the XV-15, and of another
//! aircraft in the same place of its own fuselage ([`Likeness`]).

pub mod bays;
pub mod cockpit;
pub mod fuselage;
pub mod gear;
pub mod lights;
pub mod nacelle;
pub mod rotor;
pub mod tail;
pub mod wing;

use engine::aircraft::Params as Aircraft;
use engine::math::{TAU, cos, max, min, sin, sqrt};

use crate::ac3d::Part;
use crate::mesh::{Point, add, scale};

/// The sides: index and sign of the buttline. The left one is made as the image of the right one.
pub const SIDES: [(usize, &str, f64); 2] = [(0, "left", -1.0), (1, "right", 1.0)];

/// Where another aircraft has what was drawn in stations of the XV-15: as far along its own fuselage.
#[derive(Clone, Copy)]
pub struct Likeness {
    nose_m: f64,
    keel_m: f64,
    size: f64,
}

impl Likeness {
    /// Stations of the XV-15's nose and tail, and the waterline of its keel, m.
    const DRAWN_M: [f64; 3] = [2.85, 15.34, 0.58];

    /// Of an aircraft.
    pub fn of(aircraft: &Aircraft) -> Self {
        let section = &aircraft.display.fuselage.section_m;
        let [nose, tail, keel] = Self::DRAWN_M;
        let ends = section.first().zip(section.last());
        let [nose_m, tail_m] = ends.map_or([nose, tail], |(first, last)| [first[0], last[0]]);
        let keel_m = section.iter().map(|row| row[2]).reduce(min).unwrap_or(keel);
        Self { nose_m, keel_m, size: (tail_m - nose_m) / (tail - nose) }
    }

    /// A station.
    pub fn aft(self, drawn_m: f64) -> f64 {
        self.nose_m + self.size * (drawn_m - Self::DRAWN_M[0])
    }

    /// A waterline.
    pub fn up(self, drawn_m: f64) -> f64 {
        self.keel_m + self.size * (drawn_m - Self::DRAWN_M[2])
    }

    /// A length, or a buttline.
    pub fn length(self, drawn_m: f64) -> f64 {
        self.size * drawn_m
    }

    /// A point.
    pub fn at(self, [aft, right, up]: Point) -> Point {
        [self.aft(aft), self.length(right), self.up(up)]
    }

    /// A part.
    pub fn part(self, mut part: Part) -> Part {
        part.mesh = part.mesh.moved(|at| self.at(at), false);
        part
    }

    /// A point that was drawn from `origin_m`, which the file has.
    pub fn from(self, origin_m: Point, drawn_m: Point) -> Point {
        add(origin_m, scale(drawn_m, self.size))
    }
}

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
