//! The font: how wide words are, and their outlines.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Weight of letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// For everything.
    Regular,
    /// For titles.
    Bold,
}

static REGULAR: LazyLock<Option<Face<'static>>> =
    LazyLock::new(|| Face::parse(include_bytes!("../fonts/Arimo-Regular.ttf"), 0).ok());
static BOLD: LazyLock<Option<Face<'static>>> =
    LazyLock::new(|| Face::parse(include_bytes!("../fonts/Arimo-Bold.ttf"), 0).ok());

fn face(weight: Weight) -> Option<&'static Face<'static>> {
    match weight {
        Weight::Regular => REGULAR.as_ref(),
        Weight::Bold => BOLD.as_ref(),
    }
}

/// Width of words, in the unit of `size`.
pub fn width(words: &str, size: f64, weight: Weight) -> f64 {
    let Some(face) = face(weight) else { return 0.0 };
    let units: f64 = words.chars().map(|letter| advance(face, glyph(face, letter))).sum();
    units * size / f64::from(face.units_per_em())
}

/// A letter that the font lacks has the box that stands for it.
fn glyph(face: &Face<'_>, letter: char) -> GlyphId {
    face.glyph_index(letter).unwrap_or(GlyphId(0))
}

fn advance(face: &Face<'_>, glyph: GlyphId) -> f64 {
    f64::from(face.glyph_hor_advance(glyph).unwrap_or(0))
}

/// Draws words into a path: `place` puts a point of the text, x along the line and y upwards from it, on
/// the page.
pub fn outline(words: &str, size: f64, weight: Weight, to: &mut impl OutlineBuilder) {
    let Some(face) = face(weight) else { return };
    let scale = size / f64::from(face.units_per_em());
    let mut pen_x = 0.0;
    for letter in words.chars() {
        let glyph = glyph(face, letter);
        // A letter without an outline is a blank.
        let _ = face.outline_glyph(glyph, &mut Placed { to, scale, pen_x });
        pen_x += advance(face, glyph) * scale;
    }
}

/// A letter's outline, scaled and moved along the line.
struct Placed<'a, B> {
    to: &'a mut B,
    scale: f64,
    pen_x: f64,
}

impl<B: OutlineBuilder> Placed<'_, B> {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        ((f64::from(x) * self.scale + self.pen_x) as f32, (f64::from(y) * self.scale) as f32)
    }
}

impl<B: OutlineBuilder> OutlineBuilder for Placed<'_, B> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.to.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.to.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.to.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.to.curve_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.to.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Adobe's metrics of Helvetica: `A` 667, `i` 222, `0` 556 thousandths of the size.
    #[test]
    fn letters_are_as_wide_as_helvetica_s() {
        for (letter, thousandths) in [("A", 667.0), ("i", 222.0), ("0", 556.0), ("0i", 778.0)] {
            let found = width(letter, 1000.0, Weight::Regular);
            assert!((found - thousandths).abs() < 0.6, "{letter}: {found}");
        }
    }

    #[test]
    fn both_weights_have_every_sign_that_figures_use() {
        for weight in [Weight::Regular, Weight::Bold] {
            let face = face(weight).expect("a font");
            for letter in "AZaz09 −–—°·×²³µΩθφψαβΔδ→≤≥…‘’“”éüÅ".chars()
            {
                assert!(face.glyph_index(letter).is_some(), "{weight:?} lacks {letter}");
            }
        }
    }
}
