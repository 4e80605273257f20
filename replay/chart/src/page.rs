//! A page: marks in the order in which they are drawn, in points from the upper left corner.

use crate::font;
pub use crate::font::Weight;

/// Red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// Letters and frames.
pub const INK: Colour = Colour(0x1A, 0x1A, 0x1A);
/// What is read second: ticks, notes.
pub const GREY: Colour = Colour(0x5C, 0x5C, 0x5C);
/// Lines across a panel.
pub const RULE: Colour = Colour(0xDE, 0xDE, 0xDE);
/// The paper.
pub const PAPER: Colour = Colour(0xFF, 0xFF, 0xFF);

/// How a line is broken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// Not at all.
    #[default]
    Solid,
    /// Into dashes.
    Dashed,
    /// Into dots.
    Dotted,
}

impl Dash {
    /// Lengths of dash and gap, in points.
    pub(crate) fn lengths(self) -> Option<[f64; 2]> {
        match self {
            Self::Solid => None,
            Self::Dashed => Some([5.0, 2.5]),
            Self::Dotted => Some([1.2, 2.2]),
        }
    }
}

/// What a line is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// Colour.
    pub colour: Colour,
    /// Width, points.
    pub width: f64,
    /// Breaks.
    pub dash: Dash,
}

impl Pen {
    /// A line without breaks.
    pub const fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, dash: Dash::Solid }
    }
}

/// Which end of the words is at their place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The first letter.
    Start,
    /// The middle.
    Middle,
    /// The last letter.
    End,
}

/// Words.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// Where: on the base line.
    pub at: [f64; 2],
    /// What.
    pub text: String,
    /// Size, points.
    pub size: f64,
    /// Weight.
    pub weight: Weight,
    /// Colour.
    pub colour: Colour,
    /// Which end is there.
    pub anchor: Anchor,
}

/// Something drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A line through points.
    Line(Vec<[f64; 2]>, Pen),
    /// An area with its part of the ink, 0 to 1.
    Area(Vec<[f64; 2]>, Colour, f64),
    /// A disc: centre, radius, colour inside, and its edge.
    Disc([f64; 2], f64, Colour, Option<Pen>),
    /// Words.
    Words(Words),
}

/// A page.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Width, points.
    pub width: f64,
    /// Height, points.
    pub height: f64,
    /// What it is called.
    pub title: String,
    /// What it shows, for whoever cannot see it.
    pub description: String,
    /// What is drawn, in order.
    pub marks: Vec<Mark>,
}

impl Page {
    /// An empty one.
    pub fn new(width: f64, height: f64, title: &str, description: &str) -> Self {
        let (title, description) = (title.into(), description.into());
        Self { width, height, title, description, marks: Vec::new() }
    }

    /// Draws a line.
    pub fn line(&mut self, points: Vec<[f64; 2]>, pen: Pen) {
        self.marks.push(Mark::Line(points, pen));
    }

    /// Fills an area.
    pub fn area(&mut self, points: Vec<[f64; 2]>, colour: Colour, ink: f64) {
        self.marks.push(Mark::Area(points, colour, ink));
    }

    /// Fills a rectangle between two corners.
    pub fn rectangle(&mut self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], colour: Colour, ink: f64) {
        self.area(vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]], colour, ink);
    }

    /// Draws a disc.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, colour: Colour, edge: Option<Pen>) {
        self.marks.push(Mark::Disc(centre, radius, colour, edge));
    }

    /// Writes words of the usual weight.
    pub fn words(
        &mut self,
        at: [f64; 2],
        text: impl Into<String>,
        size: f64,
        colour: Colour,
        anchor: Anchor,
    ) {
        let (text, weight) = (text.into(), Weight::Regular);
        self.marks.push(Mark::Words(Words { at, text, size, weight, colour, anchor }));
    }

    /// Writes bold words that begin there.
    pub fn bold(&mut self, at: [f64; 2], text: impl Into<String>, size: f64) {
        let (text, weight, anchor) = (text.into(), Weight::Bold, Anchor::Start);
        self.marks.push(Mark::Words(Words { at, text, size, weight, colour: INK, anchor }));
    }
}

/// Width of words of the usual weight, points.
pub fn width(text: &str, size: f64) -> f64 {
    font::width(text, size, Weight::Regular)
}

/// The words, cut with an ellipsis when they are wider than there is room.
pub fn fitted(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.into();
    }
    let mut letters: Vec<char> = text.chars().collect();
    while letters.pop().is_some() {
        let cut: String = letters.iter().collect::<String>().trim_end().to_string() + "…";
        if width(&cut, size) <= room {
            return cut;
        }
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_too_wide_are_cut() {
        assert_eq!(fitted("lift-off", 9.0, 100.0), "lift-off");
        let cut = fitted("a name that is much too long for its place", 9.0, 60.0);
        assert!(cut.ends_with('…') && width(&cut, 9.0) <= 60.0, "{cut}");
        assert_eq!(fitted("anything", 9.0, 1.0), "");
    }
}
