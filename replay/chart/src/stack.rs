//! Panels above each other over one axis, with bands and moments.

use engine::math::{max, min};

use crate::frame::{self, HEAD, LEFT, RIGHT, TITLE_SIZE, WIDTH};
use crate::line::{self, Curve, Guide, Look};
use crate::moments::{self, Moments};
use crate::page::{Anchor, Colour, INK, Page, width};
use crate::scale::{Scale, Tick, decades, widened};

/// Height of a panel's title.
const PANEL_HEAD: f64 = 17.0;
/// Height of a band.
const BAND: f64 = 12.0;
/// Below the last panel: numbers, and what they are.
const FOOT: f64 = 36.0;
/// Below everything.
const MARGIN: f64 = 8.0;

/// A stretch of a band.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// From where.
    pub from: f64,
    /// To where.
    pub to: f64,
    /// What it is.
    pub words: String,
    /// Colour.
    pub colour: Colour,
}

/// A panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What is over the axis, with its unit.
    pub title: String,
    /// Curves.
    pub curves: Vec<Curve>,
    /// Lines across it.
    pub guides: Vec<Guide>,
    /// The axis has at least this range, so that noise stays small.
    pub least: f64,
    /// Values that the axis has in any case.
    pub with: Vec<f64>,
    /// Whether the axis counts in powers of ten.
    pub logarithmic: bool,
    /// Whether the axis counts turns, in degrees: in quarters of one, or halves of a quarter.
    pub turns: bool,
    /// Height, points.
    pub height: f64,
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Stack {
    /// Its title.
    pub title: String,
    /// What is to be known to read it.
    pub subtitle: String,
    /// What the common axis is, with its unit.
    pub x_title: String,
    /// Its range.
    pub x_range: (f64, f64),
    /// Bands above the panels.
    pub bands: Vec<Vec<Span>>,
    /// Panels, from the top.
    pub panels: Vec<Panel>,
    /// What happened.
    pub moments: Vec<Moments>,
}

impl Panel {
    /// One of a usual height.
    pub fn new(title: impl Into<String>, least: f64, curves: Vec<Curve>) -> Self {
        let title = title.into();
        Self {
            title,
            curves,
            guides: Vec::new(),
            least,
            with: Vec::new(),
            logarithmic: false,
            turns: false,
            height: 92.0,
        }
    }

    /// Range of the axis.
    fn range(&self) -> (f64, f64) {
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        let guides = self.guides.iter().flat_map(|guide| [Some(guide.at), guide.to]).flatten();
        let values = points
            .filter(|point| point[0].is_finite())
            .map(|point| point[1])
            .chain(guides)
            .chain(self.with.iter().copied())
            .filter(|value| value.is_finite() && (!self.logarithmic || *value > 0.0));
        let (low, high) = values
            .fold((f64::MAX, f64::MIN), |(low, high), value| (min(low, value), max(high, value)));
        if low <= high && self.turns {
            let step = quarter(low, high);
            let (low, high) = ((low / step).floor(), (high / step).ceil());
            return (low * step, max(high, low + 1.0) * step);
        }
        match (low <= high, self.logarithmic) {
            (true, true) => decades(low, high),
            (true, false) => widened(low, high, self.least, self.tick_count()),
            (false, true) => (1.0, 10.0),
            (false, false) => widened(0.0, 0.0, max(self.least, 1.0), self.tick_count()),
        }
    }

    /// Ticks of its axis.
    fn ticks(&self, scale: &Scale) -> Vec<Tick> {
        if self.turns {
            scale.ticks_every(quarter(scale.low, scale.high))
        } else {
            scale.ticks(self.tick_count())
        }
    }

    fn tick_count(&self) -> f64 {
        max(self.height / 24.0, 2.0)
    }
}

/// Steps of an axis that counts turns, deg: quarters, unless it is more than four turns, or less than half of one.
fn quarter(low: f64, high: f64) -> f64 {
    match high - low {
        range if range > 1440.0 => 360.0,
        range if range > 720.0 => 180.0,
        range if range >= 180.0 => 90.0,
        range if range >= 60.0 => 30.0,
        range if range >= 20.0 => 10.0,
        _ => 5.0,
    }
}

impl Stack {
    /// The chart on a page.
    pub fn page(&self, tolerance: f64) -> Page {
        let (low, high) = self.x_range;
        let high = if high > low { high } else { low + 1.0 };
        let (from, to) = (LEFT, WIDTH - RIGHT);
        let x = Scale { low, high, from, to, logarithmic: false };
        let place = |value: f64| x.at(value);
        let rows = moments::height(&self.moments, place);
        let top = HEAD + self.bands.len() as f64 * (BAND + 2.0) + rows;
        let panels: f64 = self.panels.iter().map(|panel| PANEL_HEAD + panel.height).sum();
        let key = moments::key_height(&self.moments, WIDTH - 24.0);
        let height = top + panels + FOOT + key + MARGIN;
        let mut page = Page::new(WIDTH, height, &self.title, &self.subtitle);
        frame::head(&mut page, &self.title, &self.subtitle);
        for (number, band) in self.bands.iter().enumerate() {
            draw_band(&mut page, band, HEAD + number as f64 * (BAND + 2.0), &x);
        }
        let x_ticks = x.ticks(8.0);
        let mut y = top;
        let mut drawn = Vec::new();
        for panel in &self.panels {
            y += PANEL_HEAD + panel.height;
            let (low, high) = panel.range();
            let logarithmic = panel.logarithmic;
            let scale = Scale { low, high, from: y, to: y - panel.height, logarithmic };
            let y_ticks = panel.ticks(&scale);
            frame::panel(&mut page, &x, &scale, &x_ticks, &y_ticks);
            drawn.push((panel, scale, y_ticks));
        }
        let across: Vec<_> = drawn.iter().map(|(_, scale, _)| (scale.to, scale.from)).collect();
        moments::draw(&mut page, &self.moments, top, &across, place);
        for (panel, scale, y_ticks) in &drawn {
            for guide in &panel.guides {
                line::guide(&mut page, guide, [from, to], |value| scale.at(value));
            }
            for curve in &panel.curves {
                let place = |[a, b]: [f64; 2]| [x.at(a), scale.at(b)];
                line::draw(&mut page, curve, tolerance, place);
            }
            frame::around(&mut page, &x, scale, y_ticks);
            let base = scale.to - 5.0;
            page.words([from, base], panel.title.as_str(), TITLE_SIZE, INK, Anchor::Start);
            line::legend(&mut page, &panel.curves, to, base);
        }
        frame::below(&mut page, &x, y, &x_ticks, &self.x_title);
        moments::key(&mut page, &self.moments, [12.0, y + FOOT], WIDTH - 24.0);
        page
    }
}

impl Curve {
    /// A line of that name.
    pub fn line(name: impl Into<String>, pen: crate::Pen, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), look: Look::Line(pen), points }
    }
}

/// Draws a band: each stretch with its name where there is room.
fn draw_band(page: &mut Page, band: &[Span], top: f64, x: &Scale) {
    for span in band {
        let (from, to) = (max(x.at(span.from), x.from), min(x.at(span.to), x.to));
        if to <= from {
            continue;
        }
        page.rectangle([from, top], [to, top + BAND], span.colour, 1.0);
        let room = to - from - 4.0;
        if let Some(size) = [8.0, 7.0].into_iter().find(|size| width(&span.words, *size) <= room) {
            let at = [0.5 * (from + to), top + BAND - 3.2];
            page.words(at, span.words.as_str(), size, INK, Anchor::Middle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pen;

    fn panel(points: Vec<[f64; 2]>) -> Panel {
        Panel::new("height, m", 10.0, vec![Curve::line("", Pen::solid(INK, 1.0), points)])
    }

    #[test]
    fn an_axis_holds_all_values_and_at_least_its_range() {
        let (low, high) = panel(vec![[0.0, -3.0], [1.0, 61.0]]).range();
        assert!(low <= -3.0 && high >= 61.0);
        let (low, high) = panel(vec![[0.0, 3.0], [1.0, 3.0]]).range();
        assert!(high - low >= 10.0, "{low} {high}");
        let (low, high) = panel(Vec::new()).range();
        assert!(low < high);
    }

    #[test]
    fn a_heading_is_counted_in_quarters() {
        let heading = Panel { turns: true, ..panel(vec![[0.0, 3.0], [1.0, 271.0]]) };
        let (low, high) = heading.range();
        let scale = Scale { low, high, from: 90.0, to: 0.0, logarithmic: false };
        let words: Vec<_> = heading.ticks(&scale).into_iter().map(|(_, words)| words).collect();
        assert_eq!(words, ["0", "90", "180", "270", "360"]);
        let steady = Panel { turns: true, ..panel(vec![[0.0, 90.0], [1.0, 90.0]]) };
        let (low, high) = steady.range();
        assert!(low < high && low <= 90.0 && high >= 90.0, "{low} {high}");
    }

    #[test]
    fn nothing_is_drawn_outside_the_page() {
        let stack = Stack {
            title: "t".into(),
            subtitle: String::new(),
            x_title: "time, s".into(),
            x_range: (0.0, 10.0),
            bands: Vec::new(),
            panels: vec![panel(vec![[0.0, -3.0], [10.0, 61.0]]), panel(vec![[0.0, f64::NAN]])],
            moments: Vec::new(),
        };
        let page = stack.page(line::TOLERANCE);
        for mark in &page.marks {
            let points = match mark {
                crate::page::Mark::Line(points, _) | crate::page::Mark::Area(points, ..) => points,
                _ => continue,
            };
            for [x, y] in points {
                assert!(
                    (0.0..=page.width).contains(x) && (0.0..=page.height).contains(y),
                    "{mark:?}"
                );
            }
        }
    }
}
