//! Curves in space, in a box that is seen from above and from the side.

use engine::math::{max, min};

use crate::frame::{self, HEAD, TICK_SIZE, TITLE_SIZE, WIDTH};
use crate::line::{self, Curve, Look};
use crate::moments::{self, Moments};
use crate::page::{Anchor, Colour, GREY, INK, Page, Pen, RULE};
use crate::plane::mark;
use crate::scale::{Scale, Tick, widened};

/// How far the eye has turned about the upright axis, and how far it is above the ground: sine and cosine.
const TURN: (f64, f64) = (0.5, 0.866_025_403_784_438_6);
const RISE: (f64, f64) = (0.422_618_261_740_699_4, 0.906_307_787_036_649_9);
/// Height of the box, as a part of its longer side, is at least this much.
const TALL: f64 = 0.28;
/// Room on the page for the box.
const ROOM: [f64; 2] = [600.0, 360.0];
/// A side is at least this part of the other one, and one of them this part of the height.
const NARROW: f64 = 0.25;
const SLENDER: f64 = 0.6;
/// One of the sides is at least so long.
const LEAST_SIDE: f64 = 20.0;

/// A curve in space: right, away and up, or as the axes are called.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// In the legend; empty for none.
    pub name: String,
    /// Pieces of the curve, each with its pen.
    pub pieces: Vec<(String, Pen, Vec<[f64; 3]>)>,
    /// Lines from there to the floor.
    pub posts: Vec<[f64; 3]>,
    /// Colour of its shadow.
    pub shadow: Colour,
    /// Where each of its moments is.
    pub places: Vec<[f64; 3]>,
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    /// Its title.
    pub title: String,
    /// What is to be known to read it.
    pub subtitle: String,
    /// What the axes are, with their units.
    pub axes: [String; 3],
    /// What is flown.
    pub flights: Vec<Flight>,
    /// What happened.
    pub moments: Vec<Moments>,
}

/// The box and its place on the page.
struct View {
    ranges: [(f64, f64); 3],
    /// Points of the page a unit, each axis.
    scale: [f64; 3],
    origin: [f64; 2],
}

impl View {
    /// Where a point in space is on the page.
    fn at(&self, point: [f64; 3]) -> [f64; 2] {
        let [x, y] = turned(self.scaled(point));
        [self.origin[0] + x, self.origin[1] - y]
    }

    fn scaled(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| (point[axis] - self.ranges[axis].0) * self.scale[axis])
    }

    fn floor(&self, [x, y, _]: [f64; 3]) -> [f64; 2] {
        self.at([x, y, self.ranges[2].0])
    }
}

/// Right and up on the page of a point: seen from afar, so that what is parallel stays it.
fn turned([x, y, z]: [f64; 3]) -> [f64; 2] {
    let right = x * TURN.1 - y * TURN.0;
    let away = x * TURN.0 + y * TURN.1;
    [right, away * RISE.0 + z * RISE.1]
}

impl Space {
    fn points(&self) -> impl Iterator<Item = &[f64; 3]> {
        self.flights.iter().flat_map(|flight| flight.pieces.iter().flat_map(|piece| &piece.2))
    }

    /// How many times as tall as long heights are drawn, and the ranges of the axes.
    fn shape(&self) -> ([(f64, f64); 3], f64) {
        let mut ranges = [0, 1, 2].map(|axis| {
            let values = self.points().map(|point| point[axis]).filter(|value| value.is_finite());
            values.fold((f64::MAX, f64::MIN), |(low, high), value| {
                (min(low, value), max(high, value))
            })
        });
        for range in &mut ranges {
            if range.0 > range.1 {
                *range = (0.0, 0.0);
            }
        }
        // The floor is the ground unless the flight goes below it.
        ranges[2].0 = min(ranges[2].0, 0.0);
        let [east, north, up] = ranges;
        let side = max(east.1 - east.0, north.1 - north.0);
        let longer = max(max(side, LEAST_SIDE), SLENDER * (up.1 - up.0));
        let least = if side < longer { longer } else { NARROW * longer };
        let [east, north] = [east, north].map(|(low, high)| widened(low, high, least, 5.0));
        let up = widened(up.0, up.1, 10.0, 4.0);
        let longer = max(east.1 - east.0, north.1 - north.0);
        let stretch = max(TALL * longer / (up.1 - up.0), 1.0);
        // A whole number, or one and a half: it is to be said.
        let stretch = if stretch < 1.25 { 1.0 } else { max(stretch.round(), 1.5) };
        ([east, north, up], stretch)
    }

    fn view(&self) -> (View, f64) {
        let (ranges, stretch) = self.shape();
        let lengths = [
            ranges[0].1 - ranges[0].0,
            ranges[1].1 - ranges[1].0,
            (ranges[2].1 - ranges[2].0) * stretch,
        ];
        let corners: Vec<[f64; 2]> = (0..8)
            .map(|corner: usize| {
                let part = |axis: usize| if corner >> axis & 1 == 1 { lengths[axis] } else { 0.0 };
                turned([part(0), part(1), part(2)])
            })
            .collect();
        let side = |axis: usize| {
            let values = corners.iter().map(|corner| corner[axis]);
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(a, b), v| (min(a, v), max(b, v)));
            (low, high - low)
        };
        let (left, wide) = side(0);
        let (low, tall) = side(1);
        let scale = min(ROOM[0] / wide, ROOM[1] / tall);
        let middle = 0.5 * WIDTH + 8.0;
        let origin = [middle - scale * (left + 0.5 * wide), HEAD + 22.0 + scale * (low + tall)];
        (View { ranges, scale: [scale, scale, scale * stretch], origin }, stretch)
    }

    /// The chart on a page.
    pub fn page(&self, tolerance: f64) -> Page {
        let (view, stretch) = self.view();
        let lowest = view.at([view.ranges[0].0, view.ranges[1].0, view.ranges[2].0])[1];
        let foot = lowest + 40.0;
        let key = moments::key_height(&self.moments, WIDTH - 24.0);
        let mut page = Page::new(WIDTH, foot + key + 8.0, &self.title, &self.subtitle);
        let subtitle = if stretch > 1.0 {
            format!("{}; heights are drawn {stretch} times as large", self.subtitle)
        } else {
            self.subtitle.clone()
        };
        frame::head(&mut page, &self.title, &subtitle);
        walls(&mut page, &view, &self.axes);
        for flight in &self.flights {
            draw(&mut page, &view, flight, tolerance);
        }
        for (moments, flight) in self.moments.iter().zip(&self.flights) {
            let places = flight.places.iter().map(|place| view.at(*place));
            mark(&mut page, places, moments);
        }
        let curves: Vec<Curve> = self
            .flights
            .iter()
            .flat_map(|flight| &flight.pieces)
            .map(|(name, pen, _)| Curve::line(name.as_str(), *pen, Vec::new()))
            .collect();
        line::legend(&mut page, &curves, WIDTH - 16.0, HEAD + 6.0);
        moments::key(&mut page, &self.moments, [12.0, foot], WIDTH - 24.0);
        page
    }
}

/// A flight: its shadow, its posts, itself.
fn draw(page: &mut Page, view: &View, flight: &Flight, tolerance: f64) {
    for (_, pen, points) in &flight.pieces {
        let shadow: Vec<_> = points.iter().map(|point| view.floor(*point)).collect();
        let look = Look::Line(Pen::solid(flight.shadow, 0.7 * pen.width));
        let curve = Curve { name: String::new(), look, points: shadow };
        line::draw(page, &curve, tolerance, |point| point);
    }
    for post in &flight.posts {
        page.line(vec![view.at(*post), view.floor(*post)], Pen::solid(flight.shadow, 0.5));
    }
    for (_, pen, points) in &flight.pieces {
        let points = points.iter().map(|point| view.at(*point)).collect();
        let curve = Curve::line("", *pen, points);
        line::draw(page, &curve, tolerance, |point| point);
    }
}

/// Floor and far walls with their rules; numbers along the near edges.
fn walls(page: &mut Page, view: &View, axes: &[String; 3]) {
    let [east, north, up] = view.ranges;
    let ticks = |(low, high): (f64, f64), count: f64| -> Vec<Tick> {
        Scale { low, high, from: 0.0, to: 1.0, logarithmic: false }.ticks(count)
    };
    let (of_east, of_north, of_up) = (ticks(east, 5.0), ticks(north, 5.0), ticks(up, 4.0));
    let rule = Pen::solid(RULE, 0.6);
    let mut rule_between = |a: [f64; 3], b: [f64; 3], pen: Pen| {
        page.line(vec![view.at(a), view.at(b)], pen);
    };
    for (x, _) in &of_east {
        rule_between([*x, north.0, up.0], [*x, north.1, up.0], rule);
        rule_between([*x, north.1, up.0], [*x, north.1, up.1], rule);
    }
    for (y, _) in &of_north {
        rule_between([east.0, *y, up.0], [east.1, *y, up.0], rule);
        rule_between([east.1, *y, up.0], [east.1, *y, up.1], rule);
    }
    for (z, _) in &of_up {
        rule_between([east.0, north.1, *z], [east.1, north.1, *z], rule);
        rule_between([east.1, north.0, *z], [east.1, north.1, *z], rule);
    }
    let edge = Pen::solid(GREY, 0.8);
    rule_between([east.0, north.0, up.0], [east.1, north.0, up.0], edge);
    rule_between([east.0, north.0, up.0], [east.0, north.1, up.0], edge);
    rule_between([east.0, north.1, up.0], [east.0, north.1, up.1], edge);
    for (x, words) in &of_east {
        let [px, py] = view.at([*x, north.0, up.0]);
        page.words([px + 3.0, py + 13.0], words.as_str(), TICK_SIZE, INK, Anchor::Start);
    }
    for (y, words) in &of_north {
        let [px, py] = view.at([east.0, *y, up.0]);
        page.words([px - 5.0, py + 9.0], words.as_str(), TICK_SIZE, INK, Anchor::End);
    }
    // The lowest one would stand in the numbers of the corner.
    for (z, words) in of_up.iter().filter(|(z, _)| *z > up.0) {
        let [px, py] = view.at([east.0, north.1, *z]);
        page.words([px - 6.0, py + 3.0], words.as_str(), TICK_SIZE, INK, Anchor::End);
    }
    let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
    let [px, py] = view.at([middle(east), north.0, up.0]);
    page.words([px + 30.0, py + 26.0], axes[0].as_str(), TITLE_SIZE, INK, Anchor::Start);
    let [px, py] = view.at([east.0, middle(north), up.0]);
    page.words([px - 30.0, py + 24.0], axes[1].as_str(), TITLE_SIZE, INK, Anchor::End);
    let [px, py] = view.at([east.0, north.1, up.1]);
    page.words([px - 6.0, py - 10.0], axes[2].as_str(), TITLE_SIZE, INK, Anchor::Middle);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space(points: Vec<[f64; 3]>) -> Space {
        let pieces = vec![(String::new(), Pen::solid(INK, 1.0), points)];
        let flight = Flight {
            name: String::new(),
            pieces,
            posts: Vec::new(),
            shadow: RULE,
            places: Vec::new(),
        };
        Space {
            title: String::new(),
            subtitle: String::new(),
            axes: ["east, m".into(), "north, m".into(), "height, m".into()],
            flights: vec![flight],
            moments: Vec::new(),
        }
    }

    #[test]
    fn the_box_is_on_the_page_whatever_is_flown() {
        for points in [
            vec![[0.0, 0.0, 0.0]],
            vec![[0.0, 0.0, 2.0], [9000.0, 10.0, 300.0]],
            vec![[0.0, 0.0, 2.0], [10.0, -9000.0, 300.0]],
            vec![[0.0, 0.0, 0.0], [5.0, 5.0, 3000.0]],
            vec![[f64::NAN, 0.0, 0.0]],
        ] {
            let space = space(points);
            let (view, _) = space.view();
            let page = space.page(0.1);
            for corner in 0..8_usize {
                let side = |axis: usize| {
                    let (low, high) = view.ranges[axis];
                    if corner >> axis & 1 == 1 { high } else { low }
                };
                let [x, y] = view.at([side(0), side(1), side(2)]);
                assert!((0.0..=page.width).contains(&x), "{x}");
                assert!((HEAD..=page.height).contains(&y), "{y} of {}", page.height);
            }
        }
    }

    #[test]
    fn heights_are_stretched_when_a_flight_is_flat_and_never_squeezed() {
        let (_, flat) = space(vec![[0.0, 0.0, 0.0], [9000.0, 5000.0, 300.0]]).view();
        let (_, tall) = space(vec![[0.0, 0.0, 0.0], [5.0, 5.0, 3000.0]]).view();
        assert!(flat > 3.0, "{flat}");
        assert!((tall - 1.0).abs() < 1e-12, "{tall}");
    }
}
