//! Curves in a plane: a track seen from above, one quantity over another.

use engine::math::{max, min, sqrt, square};

use crate::frame::{self, HEAD, LEFT, RIGHT, TITLE_SIZE, WIDTH};
use crate::line::{self, Curve};
use crate::moments::{self, Moments, disc};
use crate::page::{Anchor, Colour, GREY, INK, Page, Pen};
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
    /// Areas below the curves.
    pub areas: Vec<Area>,
    /// Curves.
    pub curves: Vec<Curve>,
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
        let top = HEAD + LEGEND;
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
        for label in &self.labels {
            let at = place(label.at);
            page.words(at, label.words.as_str(), 8.5, GREY, Anchor::Start);
        }
        for (moments, places) in self.moments.iter().zip(&self.places) {
            mark(&mut page, places.iter().copied().map(place), moments.colour);
        }
        frame::around(&mut page, &x, &y, &y_ticks);
        page.words([x.from, top - 6.0], self.axes[1].as_str(), TITLE_SIZE, INK, Anchor::Start);
        line::legend(&mut page, &self.curves, x.to, top - 6.0);
        frame::below(&mut page, &x, y.from, &x_ticks, &self.axes[0]);
        moments::key(&mut page, &self.moments, [12.0, y.from + FOOT], WIDTH - 24.0);
        page
    }
}

/// The range, widened around its middle.
fn around((low, high): (f64, f64), wide: f64) -> (f64, f64) {
    let middle = 0.5 * (low + high);
    (middle - 0.5 * wide, middle + 0.5 * wide)
}

/// Numbers moments along a curve; one that would cover others stands beside its place, at the end of a line.
pub fn mark(page: &mut Page, places: impl Iterator<Item = [f64; 2]>, colour: Colour) {
    let apart = 2.0 * moments::RADIUS + 0.5;
    let mut taken: Vec<[f64; 2]> = Vec::new();
    for (number, at) in places.enumerate() {
        let free = |spot: &[f64; 2]| {
            let away = |other: &[f64; 2]| distance(*spot, *other) >= apart;
            taken.iter().all(away) && spot[0] < WIDTH - RIGHT && spot[0] > LEFT
        };
        let ring = (1..6).flat_map(|ring| {
            // Around the place, the upper right first: turns of 45 degrees.
            const TURNS: [[f64; 2]; 8] = [
                [0.7, -0.7],
                [1.0, 0.0],
                [0.7, 0.7],
                [0.0, 1.0],
                [-0.7, 0.7],
                [-1.0, 0.0],
                [-0.7, -0.7],
                [0.0, -1.0],
            ];
            let far = apart * f64::from(ring);
            TURNS.map(|[x, y]| [at[0] + far * x, at[1] + far * y])
        });
        let spot = std::iter::once(at).chain(ring).find(free).unwrap_or(at);
        if distance(spot, at) > 0.0 {
            page.line(vec![at, spot], Pen::solid(colour, 0.5));
            page.disc(at, 1.4, colour, None);
        }
        taken.push(spot);
        disc(page, spot, number + 1, colour);
    }
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
            areas: Vec::new(),
            curves: vec![Curve::line("", Pen::solid(INK, 1.0), points)],
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
    fn numbers_at_one_place_do_not_cover_each_other() {
        let mut page = Page::new(WIDTH, 100.0, "", "");
        mark(&mut page, [[300.0, 50.0]; 5].into_iter(), INK);
        let discs: Vec<[f64; 2]> = page
            .marks
            .iter()
            .filter_map(|mark| match mark {
                crate::page::Mark::Disc(at, radius, ..) if *radius > 2.0 => Some(*at),
                _ => None,
            })
            .collect();
        assert_eq!(discs.len(), 5);
        for (i, a) in discs.iter().enumerate() {
            for b in &discs[..i] {
                assert!(distance(*a, *b) >= 2.0 * moments::RADIUS, "{a:?} {b:?}");
            }
        }
    }
}
