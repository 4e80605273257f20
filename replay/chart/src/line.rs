//! Curves, made of no more points than can be seen, and their legend.

use engine::math::{max, sqrt};

use crate::page::{Anchor, Colour, GREY, INK, PAPER, Page, Pen, width};

/// How far a curve may lie beside its points, in points of the page: less than a printer's dot.
pub const TOLERANCE: f64 = 0.08;
/// Size of a legend's words.
const LEGEND_SIZE: f64 = 8.5;
/// Length of the piece of line before them.
const SAMPLE: f64 = 16.0;

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// As a line.
    Line(Pen),
    /// As dots of that radius, points.
    Dots(Colour, f64),
    /// As the area between each two points that follow each other: upper and lower edge.
    Band(Colour, f64),
}

/// A curve. A point that is not finite breaks it.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// In the legend; empty for none.
    pub name: String,
    /// How it is drawn.
    pub look: Look,
    /// Its points.
    pub points: Vec<[f64; 2]>,
}

/// A line across a panel at a value, or the band up to another one.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// At which value.
    pub at: f64,
    /// Up to which other one.
    pub to: Option<f64>,
    /// What it is.
    pub words: String,
    /// Colour.
    pub colour: Colour,
}

/// Draws a curve, each value put in its place.
pub fn draw(page: &mut Page, curve: &Curve, tolerance: f64, place: impl Fn([f64; 2]) -> [f64; 2]) {
    let pieces = curve.points.split(|point| !point.iter().all(|value| value.is_finite()));
    for piece in pieces.filter(|piece| !piece.is_empty()) {
        let placed: Vec<_> = piece.iter().map(|point| place(*point)).collect();
        match curve.look {
            Look::Line(pen) => page.line(simplified(&placed, tolerance), pen),
            Look::Dots(colour, radius) => {
                placed.into_iter().for_each(|at| page.disc(at, radius, colour, None));
            }
            Look::Band(colour, ink) => {
                let upper: Vec<_> = placed.iter().step_by(2).copied().collect();
                let lower: Vec<_> = placed.iter().skip(1).step_by(2).copied().collect();
                let mut edge = simplified(&upper, tolerance);
                edge.extend(simplified(&lower, tolerance).into_iter().rev());
                page.area(edge, colour, ink);
            }
        }
    }
}

/// The line with as few of its points as keep it where it is (Ramer, Douglas and Peucker).
pub fn simplified(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let mut kept = vec![false; points.len()];
    (kept[0], kept[last]) = (true, true);
    let mut stretches = vec![(0, last)];
    while let Some((first, last)) = stretches.pop() {
        let mut farthest = (tolerance, None);
        for middle in first + 1..last {
            let apart = beside(points[middle], points[first], points[last]);
            if apart > farthest.0 {
                farthest = (apart, Some(middle));
            }
        }
        if let (_, Some(middle)) = farthest {
            kept[middle] = true;
            stretches.extend([(first, middle), (middle, last)]);
        }
    }
    points.iter().zip(kept).filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

/// How far a point lies from the line between two others.
fn beside([x, y]: [f64; 2], [ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    let (dx, dy) = (bx - ax, by - ay);
    let length2 = dx * dx + dy * dy;
    let part = if length2 > 0.0 { ((x - ax) * dx + (y - ay) * dy) / length2 } else { 0.0 };
    let part = part.clamp(0.0, 1.0);
    let (px, py) = (x - ax - part * dx, y - ay - part * dy);
    sqrt(px * px + py * py)
}

/// Each name of a legend once, with the look of its first curve.
fn named(curves: &[Curve]) -> Vec<(&str, Look)> {
    let mut named: Vec<(&str, Look)> = Vec::new();
    for curve in curves.iter().filter(|curve| !curve.name.is_empty()) {
        if !named.iter().any(|(name, _)| *name == curve.name) {
            named.push((&curve.name, curve.look));
        }
    }
    named
}

/// How much room a legend takes across.
pub fn legend_width(curves: &[Curve]) -> f64 {
    named(curves).iter().map(|(name, _)| width(name, LEGEND_SIZE) + SAMPLE + 16.0).sum()
}

/// Writes the legend of curves so that it ends at `end`, on the base line `y`; where it begins.
pub fn legend(page: &mut Page, curves: &[Curve], end: f64, y: f64) -> f64 {
    let mut x = end;
    for (name, look) in named(curves).into_iter().rev() {
        x -= width(name, LEGEND_SIZE);
        page.words([x, y], name, LEGEND_SIZE, INK, Anchor::Start);
        x -= SAMPLE + 4.0;
        let middle = y - 3.0;
        match look {
            Look::Line(pen) => page.line(vec![[x, middle], [x + SAMPLE, middle]], pen),
            Look::Dots(colour, radius) => {
                page.disc([x + 0.5 * SAMPLE, middle], max(radius, 1.2), colour, None);
            }
            Look::Band(colour, ink) => {
                page.rectangle([x, middle - 3.0], [x + SAMPLE, middle + 3.0], colour, ink);
            }
        }
        x -= 12.0;
    }
    x
}

/// Draws a guide across a panel; its words stand above it, at the right.
pub fn guide(page: &mut Page, guide: &Guide, [left, right]: [f64; 2], place: impl Fn(f64) -> f64) {
    let y = place(guide.at);
    if let Some(to) = guide.to {
        page.rectangle([left, place(to)], [right, y], guide.colour, 0.18);
    }
    let top = guide.to.map_or(y, &place);
    if guide.to.is_none() {
        let dash = crate::Dash::Dashed;
        page.line(vec![[left, y], [right, y]], Pen { colour: guide.colour, width: 0.9, dash });
    }
    let wide = width(&guide.words, 8.0);
    page.rectangle([right - wide - 6.0, top - 11.0], [right - 2.0, top - 0.6], PAPER, 0.85);
    page.words([right - 4.0, top - 3.0], guide.words.as_str(), 8.0, GREY, Anchor::End);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_needs_two_points_and_a_corner_one_more() {
        let straight: Vec<_> = (0..100).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        assert_eq!(simplified(&straight, 0.1).len(), 2);
        let bent: Vec<_> =
            (0..100_i32).map(|i| [f64::from(i), f64::from((i - 50).abs())]).collect();
        assert_eq!(simplified(&bent, 0.1), [[0.0, 50.0], [50.0, 0.0], [99.0, 49.0]]);
        assert!(simplified(&[], 0.1).is_empty());
        assert_eq!(simplified(&[[1.0, 1.0]], 0.1), [[1.0, 1.0]]);
    }

    #[test]
    fn a_peak_of_one_point_stays() {
        let mut points: Vec<_> = (0..1000).map(|i| [0.1 * f64::from(i), 0.0]).collect();
        points[500][1] = 5.0;
        assert!(simplified(&points, 0.1).contains(&[50.0, 5.0]));
    }

    #[test]
    fn what_is_not_finite_breaks_the_curve() {
        let points = vec![[0.0, 0.0], [1.0, 1.0], [2.0, f64::NAN], [3.0, 1.0], [4.0, 0.0]];
        let look = Look::Line(Pen::solid(INK, 1.0));
        let curve = Curve { name: String::new(), look, points };
        let mut page = Page::new(10.0, 10.0, "", "");
        draw(&mut page, &curve, TOLERANCE, |point| point);
        assert_eq!(page.marks.len(), 2);
    }
}
