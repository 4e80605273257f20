//! How long something took, as bars: the histogram that a log has of it.

use chart::page::{Anchor, Colour, GREY, INK, Page, Pen, RULE};

/// Size of the picture, points.
const SIZE: (f64, f64) = (720.0, 130.0);
/// Edges of the bars, ms.
const EDGES_MS: [f64; 16] =
    [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 150.0];
/// Place of the panel.
const LEFT: f64 = 12.0;
const RIGHT: f64 = 708.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 104.0;

/// Draws a histogram: the greatest duration of each step in ns, and how many there were.
pub fn page(title: &str, steps: &[(u64, u64)]) -> Page {
    let mut bars = [0_u64; EDGES_MS.len() + 1];
    for (ns, count) in steps {
        let ms = *ns as f64 * 1e-6;
        let bar = EDGES_MS.iter().position(|edge| ms <= *edge).unwrap_or(EDGES_MS.len());
        bars[bar] = bars[bar].saturating_add(*count);
    }
    let all: u64 = bars.iter().fold(0, |sum, count| sum.saturating_add(*count));
    let mut page = Page::new(SIZE.0, SIZE.1, title, "how many of the ticks took how long");
    page.bold([LEFT, 18.0], title, 10.5);
    let wide = (RIGHT - LEFT) / bars.len() as f64;
    for (place, count) in bars.iter().enumerate() {
        let x = LEFT + place as f64 * wide;
        let part = *count as f64 / all.max(1) as f64;
        let late = place >= EDGES_MS.len();
        let colour = if late { Colour(0xC2, 0x1F, 0x1F) } else { Colour(0x15, 0x4A, 0x8C) };
        // What is there at all can be seen.
        let tall = if *count > 0 { 1.5 + part * (BOTTOM - TOP - 14.0) } else { 0.0 };
        page.rectangle([x + 2.0, BOTTOM - tall], [x + wide - 2.0, BOTTOM], colour, 1.0);
        if *count > 0 {
            let at = [x + 0.5 * wide, BOTTOM - tall - 3.0];
            page.words(at, share(part), 7.5, GREY, Anchor::Middle);
        }
        if let Some(edge) = EDGES_MS.get(place) {
            page.line(vec![[x + wide, BOTTOM], [x + wide, BOTTOM + 3.0]], Pen::solid(GREY, 0.6));
            page.words([x + wide, BOTTOM + 12.0], format!("{edge}"), 7.5, INK, Anchor::Middle);
        }
    }
    page.line(vec![[LEFT, BOTTOM], [RIGHT, BOTTOM]], Pen::solid(RULE, 1.0));
    page.words([RIGHT, BOTTOM + 24.0], "up to so many ms", 8.0, GREY, Anchor::End);
    page
}

/// A part of the whole, in percent to two digits.
fn share(part: f64) -> String {
    match 100.0 * part {
        percent if percent < 0.01 => "<0.01 %".into(),
        percent if percent < 1.0 => format!("{percent:.2} %"),
        percent if percent < 10.0 => format!("{percent:.1} %"),
        percent => format!("{percent:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_has_two_digits() {
        let shares = [5e-5, 1e-4, 0.005, 0.0099, 0.01, 0.0123, 0.099, 0.1, 0.123, 1.0].map(share);
        let told = [
            "<0.01 %", "0.01 %", "0.50 %", "0.99 %", "1.0 %", "1.2 %", "9.9 %", "10 %", "12 %",
            "100 %",
        ];
        assert_eq!(shares, told);
    }
}
