//! The page as PNG: the marks of the SVG, painted.

use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform,
};
use ttf_parser::OutlineBuilder;

use crate::font;
use crate::page::{Anchor, Colour, Mark, PAPER, Page, Pen, Words};

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unpainted(String);

impl std::fmt::Display for Unpainted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the picture cannot be painted: {}", self.0)
    }
}

impl std::error::Error for Unpainted {}

/// The page as a PNG file, so many pixels a point.
///
/// # Errors
/// When the page is empty, or larger than memory.
pub fn png(page: &Page, pixels_per_point: f64) -> Result<Vec<u8>, Unpainted> {
    let pixels = |points: f64| (points * pixels_per_point).ceil() as u32;
    let (width, height) = (pixels(page.width), pixels(page.height));
    let mut map = Pixmap::new(width, height)
        .ok_or_else(|| Unpainted(format!("{width} by {height} pixels")))?;
    map.fill(tiny_skia::Color::from_rgba8(PAPER.0, PAPER.1, PAPER.2, 255));
    let scale = Transform::from_scale(pixels_per_point as f32, pixels_per_point as f32);
    for mark in &page.marks {
        match mark {
            Mark::Line(points, pen) => stroke(&mut map, line(points, false), pen, scale),
            Mark::Area(points, colour, ink) => {
                fill(&mut map, line(points, true), *colour, *ink, scale);
            }
            Mark::Disc([x, y], radius, colour, edge) => {
                let circle = PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32);
                fill(&mut map, circle.clone(), *colour, 1.0, scale);
                if let Some(pen) = edge {
                    stroke(&mut map, circle, pen, scale);
                }
            }
            Mark::Words(words) => fill(&mut map, letters(words), words.colour, 1.0, scale),
        }
    }
    map.encode_png().map_err(|error| Unpainted(error.to_string()))
}

fn line(points: &[[f64; 2]], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (place, [x, y]) in points.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        if place == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn letters(words: &Words) -> Option<Path> {
    let Words { at: [x, y], text, size, weight, anchor, .. } = words;
    let part = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5,
        Anchor::End => 1.0,
    };
    let x = x - part * font::width(text, *size, *weight);
    let mut path = Letters { path: PathBuilder::new(), x: x as f32, y: *y as f32 };
    font::outline(text, *size, *weight, &mut path);
    path.path.finish()
}

/// Outlines on their line: y is upwards in a font, and downwards on the page.
struct Letters {
    path: PathBuilder,
    x: f32,
    y: f32,
}

impl OutlineBuilder for Letters {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, self.y - y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, self.y - y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + x1, self.y - y1, self.x + x, self.y - y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (at_x, at_y) = (self.x, self.y);
        self.path.cubic_to(at_x + x1, at_y - y1, at_x + x2, at_y - y2, at_x + x, at_y - y);
    }
    fn close(&mut self) {
        self.path.close();
    }
}

fn paint(Colour(red, green, blue): Colour, ink: f64) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, (ink * 255.0).round() as u8);
    paint.anti_alias = true;
    paint
}

fn fill(map: &mut Pixmap, path: Option<Path>, colour: Colour, ink: f64, scale: Transform) {
    if let Some(path) = path {
        map.fill_path(&path, &paint(colour, ink), FillRule::Winding, scale, None);
    }
}

fn stroke(map: &mut Pixmap, path: Option<Path>, pen: &Pen, scale: Transform) {
    let Some(path) = path else { return };
    let dash = pen.dash.lengths().map(|lengths| lengths.map(|length| length as f32));
    let stroke = Stroke {
        width: pen.width as f32,
        line_cap: LineCap::Butt,
        line_join: LineJoin::Round,
        dash: dash.and_then(|lengths| StrokeDash::new(lengths.to_vec(), 0.0)),
        ..Stroke::default()
    };
    map.stroke_path(&path, &paint(pen.colour, 1.0), &stroke, scale, None);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::INK;

    #[test]
    fn what_is_painted_is_where_it_was_drawn() {
        let mut page = Page::new(20.0, 10.0, "", "");
        page.rectangle([10.0, 0.0], [20.0, 10.0], INK, 1.0);
        let map = Pixmap::decode_png(&png(&page, 2.0).unwrap()).unwrap();
        assert_eq!((map.width(), map.height()), (40, 20));
        let red = |x, y| map.pixel(x, y).unwrap().red();
        assert_eq!((red(5, 10), red(35, 10)), (PAPER.0, INK.0));
    }

    #[test]
    fn words_are_painted_with_the_font_that_is_brought_along() {
        let mut page = Page::new(60.0, 20.0, "", "");
        page.words([5.0, 15.0], "Mθ", 12.0, INK, Anchor::Start);
        let map = Pixmap::decode_png(&png(&page, 2.0).unwrap()).unwrap();
        let dark = map.pixels().iter().filter(|pixel| pixel.red() < 128).count();
        assert!((50..1000).contains(&dark), "{dark} dark pixels");
    }

    #[test]
    fn a_page_without_room_is_no_picture() {
        assert!(png(&Page::new(0.0, 10.0, "", ""), 1.0).is_err());
    }
}
