//! Curves in a plane: a track seen from above, one quantity over another.

use engine::math::{max, min, sqrt, square};

use crate::frame::{self, HEAD, LEFT, RIGHT, TITLE_SIZE, WIDTH};
use crate::line::{self, Curve};
use crate::moments::{self, Gravity, Moments, disc};
use crate::page::{Anchor, Colour, GREY, INK, PAPER, Page, Pen, width};
use crate::scale::{Scale, widened};

/// Room for the legend and the title of the upright axis.
const LEGEND: f64 = 20.0;
/// Below the panel: numbers, and what they are.
const FOOT: f64 = 36.0;
/// Below everything.
const MARGIN: f64 = 8.0;
/// Height of the panel where the axes are not of the same scale.
const HEIGHT: f64 = 380.0;
/// And at least and at most, where they are.
const HEIGHTS: (f64, f64) = (220.0, 560.0);
/// Ticks across.
const TICKS: f64 = 8.0;

/// An area between curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// Its edge.
    pub edge: Vec<[f64; 2]>,
    /// Colour.
    pub colour: Colour,
    /// Part of the ink, 0 to 1.
    pub ink: f64,
}

/// Words in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Where.
    pub at: [f64; 2],
    /// What.
    pub words: String,
    /// Which end is there.
    pub anchor: Anchor,
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Its title.
    pub title: String,
    /// What is to be known to read it.
    pub subtitle: String,
    /// What the axes are, with their units.
    pub axes: [String; 2],
    /// Whether a step is as long across as upwards.
    pub equal: bool,
    /// Least ranges of the axes.
    pub least: [f64; 2],
    /// Points that are in it in any case.
    pub with: Vec<[f64; 2]>,
    /// The range of the upright axis, where it is not to follow from the curves.
    pub upright: Option<(f64, f64)>,
    /// Areas below the curves.
    pub areas: Vec<Area>,
    /// Curves.
    pub curves: Vec<Curve>,
    /// Of these curves, by their names, arrows say which way they go.
    pub directed: Vec<String>,
    /// Words.
    pub labels: Vec<Label>,
    /// Where each moment of each flight is.
    pub places: Vec<Vec<[f64; 2]>>,
    /// What happened.
    pub moments: Vec<Moments>,
}

impl Plane {
    /// Ranges of both axes.
    fn ranges(&self) -> [(f64, f64); 2] {
        [0, 1].map(|axis| {
            let curves = self.curves.iter().flat_map(|curve| &curve.points);
            let edges = self.areas.iter().flat_map(|area| &area.edge);
            let all = curves.chain(edges).chain(&self.with);
            let values = all.map(|point| point[axis]).filter(|value| value.is_finite());
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
                (min(low, value), max(high, value))
            });
            let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
            widened(low, high, max(self.least[axis], 1e-6), TICKS)
        })
    }

    /// The axes on the page, the panel beginning at `top`.
    fn scales(&self, top: f64) -> [Scale; 2] {
        let [mut across, upwards] = self.ranges();
        let upwards = self.upright.unwrap_or(upwards);
        let (from, to) = (LEFT + 6.0, WIDTH - RIGHT);
        let mut height = HEIGHT;
        if self.equal {
            let (least, most) = HEIGHTS;
            let wanted = (to - from) * (upwards.1 - upwards.0) / (across.1 - across.0);
            height = wanted.clamp(least, most);
            if wanted > most {
                // Taller than the page: more room left and right of it.
                across = around(across, (to - from) * (upwards.1 - upwards.0) / height);
            }
        }
        let logarithmic = false;
        let x = Scale { low: across.0, high: across.1, from, to, logarithmic };
        let (mut low, mut high) = upwards;
        if self.equal {
            let points_per_unit = (to - from) / (across.1 - across.0);
            (low, high) = around(upwards, height / points_per_unit);
        }
        [x, Scale { low, high, from: top + height, to: top, logarithmic }]
    }

    /// The chart on a page.
    pub fn page(&self, tolerance: f64) -> Page {
        // A legend that does not fit beside the title of the upright axis has a row above it.
        let beside = LEFT + width(&self.axes[1], TITLE_SIZE) + line::legend_width(&self.curves);
        let row = if beside > WIDTH - RIGHT { LEGEND } else { 0.0 };
        let top = HEAD + row + LEGEND;
        let [x, y] = self.scales(top);
        let key = moments::key_height(&self.moments, WIDTH - 24.0);
        let height = y.from + FOOT + key + MARGIN;
        let mut page = Page::new(WIDTH, height, &self.title, &self.subtitle);
        frame::head(&mut page, &self.title, &self.subtitle);
        let (x_ticks, y_ticks) = (x.ticks(TICKS), y.ticks((y.from - y.to) / 45.0));
        frame::panel(&mut page, &x, &y, &x_ticks, &y_ticks);
        let place = |[a, b]: [f64; 2]| [x.at(a), y.at(b)];
        for area in &self.areas {
            let edge = area.edge.iter().copied().map(place).collect();
            page.area(edge, area.colour, area.ink);
        }
        for curve in &self.curves {
            line::draw(&mut page, curve, tolerance, place);
        }
        for curve in self.curves.iter().filter(|curve| self.directed.contains(&curve.name)) {
            if let line::Look::Line(pen) = curve.look {
                let points: Vec<_> = curve.points.iter().copied().map(place).collect();
                arrows(&points).into_iter().for_each(|head| page.area(head, pen.colour, 1.0));
            }
        }
        for label in &self.labels {
            let at = place(label.at);
            page.words(at, label.words.as_str(), 8.5, GREY, label.anchor);
        }
        frame::around(&mut page, &x, &y, &y_ticks);
        for (moments, places) in self.moments.iter().zip(&self.places) {
            mark(&mut page, places.iter().copied().map(place), moments);
        }
        page.words([x.from, top - 6.0], self.axes[1].as_str(), TITLE_SIZE, INK, Anchor::Start);
        line::legend(&mut page, &self.curves, x.to, top - row - 6.0);
        frame::below(&mut page, &x, y.from, &x_ticks, &self.axes[0]);
        moments::key(&mut page, &self.moments, [12.0, y.from + FOOT], WIDTH - 24.0);
        page
    }
}

/// From one arrow along a curve to the next, points.
const ARROWS_APART: f64 = 90.0;
/// Length of an arrow's head, and half of its width.
const HEAD_LENGTH: f64 = 8.0;
const HEAD_HALF: f64 = 3.4;

/// Heads of arrows along a curve on the page; a point that is not finite breaks it.
fn arrows(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut heads = Vec::new();
    // The first one stands half as far from the beginning.
    let mut gone = 0.5 * ARROWS_APART;
    let mut tail = None;
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let far = distance(from, to);
        if !far.is_finite() {
            tail = None;
            continue;
        }
        // Over the length of a head, so that noise does not turn it.
        let back = *tail.get_or_insert(from);
        if distance(back, to) < HEAD_LENGTH {
            gone += far;
            continue;
        }
        gone += far;
        tail = Some(to);
        if gone >= ARROWS_APART {
            gone = 0.0;
            heads.push(head(back, to));
        }
    }
    heads
}

/// A triangle whose point is at `to`.
fn head([fx, fy]: [f64; 2], [tx, ty]: [f64; 2]) -> Vec<[f64; 2]> {
    let far = max(distance([fx, fy], [tx, ty]), 1e-9);
    let (dx, dy) = ((tx - fx) / far, (ty - fy) / far);
    let (bx, by) = (tx - HEAD_LENGTH * dx, ty - HEAD_LENGTH * dy);
    vec![
        [tx, ty],
        [bx - HEAD_HALF * dy, by + HEAD_HALF * dx],
        [bx + HEAD_HALF * dy, by - HEAD_HALF * dx],
    ]
}

/// The range, widened around its middle.
fn around((low, high): (f64, f64), wide: f64) -> (f64, f64) {
    let middle = 0.5 * (low + high);
    (middle - 0.5 * wide, middle + 0.5 * wide)
}

/// Numbers moments along a curve. Those at one place share a label, which stands above it.
pub fn mark(page: &mut Page, places: impl Iterator<Item = [f64; 2]>, moments: &Moments) {
    let gravity =
        |place: usize| moments.list.get(place).map_or(Gravity::Told, |moment| moment.gravity);
    let apart = 2.0 * moments::RADIUS;
    let mut clusters: Vec<([f64; 2], Vec<usize>)> = Vec::new();
    for (place, at) in places.enumerate() {
        match clusters.iter_mut().find(|(known, _)| distance(*known, at) < apart) {
            Some((_, numbers)) => numbers.push(place + 1),
            None => clusters.push((at, vec![place + 1])),
        }
    }
    for (at, numbers) in clusters {
        match numbers[..] {
            [number] => disc(page, at, number, moments.disc(gravity(number - 1))),
            _ => {
                // That of the gravest of them.
                let gravest = numbers.iter().map(|number| gravity(number - 1)).max();
                let colour = gravest.unwrap_or_default().colour(moments.colour);
                label(page, at, &ranges(&numbers), colour);
            }
        }
    }
}

/// Numbers in a box with round ends above a dot.
fn label(page: &mut Page, [x, y]: [f64; 2], words: &str, colour: Colour) {
    const ABOVE: f64 = 15.0;
    let radius = moments::RADIUS;
    let half = 0.5 * width(words, 7.5);
    let middle = max(min(x, WIDTH - RIGHT - half - radius), LEFT + half + radius + 8.0);
    let up = y - ABOVE;
    page.line(vec![[x, y], [middle, up]], Pen::solid(colour, 0.6));
    page.disc([x, y], 2.2, colour, Some(Pen::solid(PAPER, 0.8)));
    let edge = Some(Pen::solid(PAPER, 0.8));
    page.disc([middle - half, up], radius, colour, edge);
    page.disc([middle + half, up], radius, colour, edge);
    page.rectangle([middle - half, up - radius], [middle + half, up + radius], colour, 1.0);
    page.words([middle, up + 2.7], words, 7.5, PAPER, Anchor::Middle);
}

/// `1–4, 7`.
fn ranges(numbers: &[usize]) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for number in numbers {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == *number => *last = *number,
            _ => runs.push((*number, *number)),
        }
    }
    let run = |(first, last): &(usize, usize)| match last - first {
        0 => first.to_string(),
        1 => format!("{first}, {last}"),
        _ => format!("{first}–{last}"),
    };
    runs.iter().map(run).collect::<Vec<_>>().join(", ")
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    sqrt(square(ax - bx) + square(ay - by))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(points: Vec<[f64; 2]>) -> Plane {
        Plane {
            title: String::new(),
            subtitle: String::new(),
            axes: ["east, m".into(), "north, m".into()],
            equal: true,
            least: [50.0, 50.0],
            with: Vec::new(),
            upright: None,
            areas: Vec::new(),
            curves: vec![Curve::line("", Pen::solid(INK, 1.0), points)],
            directed: Vec::new(),
            labels: Vec::new(),
            places: Vec::new(),
            moments: Vec::new(),
        }
    }

    #[test]
    fn a_metre_is_as_long_north_as_east() {
        for points in [
            vec![[0.0, 0.0], [5000.0, 100.0]],
            vec![[0.0, 0.0], [100.0, 5000.0]],
            vec![[0.0, 0.0], [900.0, 700.0]],
            vec![[0.0, 0.0]],
        ] {
            let [x, y] = plane(points).scales(60.0);
            let across = (x.to - x.from) / (x.high - x.low);
            let upwards = (y.from - y.to) / (y.high - y.low);
            assert!((across / upwards - 1.0).abs() < 1e-9, "{x:?} {y:?}");
        }
    }

    #[test]
    fn arrows_point_the_way_that_a_curve_goes() {
        let east: Vec<_> = (0..300).map(|i| [f64::from(i), 5.0]).collect();
        let heads = arrows(&east);
        assert_eq!(heads.len(), 3, "{heads:?}");
        for head in &heads {
            assert!(head[0][0] > head[1][0] && head[0][0] > head[2][0], "{head:?}");
        }
        let west: Vec<_> = east.iter().rev().copied().collect();
        assert!(arrows(&west).iter().all(|head| head[0][0] < head[1][0]));
        assert!(arrows(&[[0.0, 0.0]]).is_empty() && arrows(&[[f64::NAN; 2]; 5]).is_empty());
    }

    #[test]
    fn numbers_at_one_place_share_a_label() {
        let words = |places: &[[f64; 2]]| -> Vec<String> {
            let mut page = Page::new(WIDTH, 100.0, "", "");
            let moments =
                Moments { of: String::new(), colour: INK, list: Vec::new(), rest: String::new() };
            mark(&mut page, places.iter().copied(), &moments);
            let of = |mark: &crate::page::Mark| match mark {
                crate::page::Mark::Words(words) => Some(words.text.clone()),
                _ => None,
            };
            page.marks.iter().filter_map(of).collect()
        };
        assert_eq!(words(&[[300.0, 50.0], [340.0, 50.0]]), ["1", "2"]);
        let there = [300.0, 50.0];
        assert_eq!(words(&[there, there, there, [500.0, 50.0], there]), ["1–3, 5", "4"]);
        assert_eq!(ranges(&[1, 2, 5, 7, 8, 9]), "1, 2, 5, 7–9");
    }
}
