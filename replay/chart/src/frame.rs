//! What a chart stands in: title, panel, axes.

use crate::page::{Anchor, GREY, INK, PAPER, Page, Pen, RULE, fitted};
use crate::scale::{Scale, Tick};

/// Width of every chart, points.
pub const WIDTH: f64 = 720.0;
/// Room left of the panels, for the numbers.
pub const LEFT: f64 = 50.0;
/// Room right of them.
pub const RIGHT: f64 = 16.0;
/// Size of an axis' numbers.
pub const TICK_SIZE: f64 = 8.5;
/// Size of an axis' title.
pub const TITLE_SIZE: f64 = 9.5;
/// Room for the title and what stands below it.
pub const HEAD: f64 = 46.0;
/// The frame.
const FRAME: Pen = Pen::solid(GREY, 0.8);

/// Writes the title and the line below it.
pub fn head(page: &mut Page, title: &str, subtitle: &str) {
    page.bold([12.0, 21.0], title, 13.5);
    let subtitle = fitted(subtitle, 9.0, WIDTH - 24.0);
    page.words([12.0, 36.0], subtitle, 9.0, GREY, Anchor::Start);
}

/// Draws paper and rules of a panel.
pub fn panel(page: &mut Page, x: &Scale, y: &Scale, x_ticks: &[Tick], y_ticks: &[Tick]) {
    page.rectangle([x.from, y.to], [x.to, y.from], PAPER, 1.0);
    let rule = Pen::solid(RULE, 0.6);
    for (value, _) in y_ticks {
        page.line(vec![[x.from, y.at(*value)], [x.to, y.at(*value)]], rule);
    }
    for (value, _) in x_ticks {
        page.line(vec![[x.at(*value), y.from], [x.at(*value), y.to]], rule);
    }
}

/// Draws the frame of a panel over what is in it, and the numbers left of it.
pub fn around(page: &mut Page, x: &Scale, y: &Scale, y_ticks: &[Tick]) {
    let corners =
        vec![[x.from, y.from], [x.to, y.from], [x.to, y.to], [x.from, y.to], [x.from, y.from]];
    page.line(corners, FRAME);
    for (value, words) in y_ticks {
        let at = y.at(*value);
        page.line(vec![[x.from - 3.0, at], [x.from, at]], FRAME);
        page.words([x.from - 6.0, at + 3.0], words.as_str(), TICK_SIZE, INK, Anchor::End);
    }
}

/// Writes the numbers below a panel, and what they are.
pub fn below(page: &mut Page, x: &Scale, y: f64, ticks: &[Tick], title: &str) {
    for (value, words) in ticks {
        let at = x.at(*value);
        page.line(vec![[at, y], [at, y + 3.0]], FRAME);
        page.words([at, y + 13.0], words.as_str(), TICK_SIZE, INK, Anchor::Middle);
    }
    let middle = 0.5 * (x.from + x.to);
    page.words([middle, y + 27.0], title, TITLE_SIZE, INK, Anchor::Middle);
}
