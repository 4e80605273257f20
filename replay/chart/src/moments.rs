//! Moments of a chart: numbers in discs, and the key that says what they are.

use engine::math::max;

use crate::page::{Anchor, Colour, GREY, INK, PAPER, Page, Pen, fitted, width};
use crate::{Dash, page};

/// Radius of the disc that a number stands in.
pub const RADIUS: f64 = 5.6;
/// Least distance of two discs in a row.
const APART: f64 = 2.0 * RADIUS + 1.5;
/// Height of a row of discs.
pub const ROW: f64 = 13.0;
/// Size of the key's words.
const KEY_SIZE: f64 = 8.5;
/// From line to line of the key.
const KEY_LINE: f64 = 13.0;

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// When, in the unit of the axis.
    pub at: f64,
    /// What.
    pub words: String,
    /// How grave: that decides the colour of its disc.
    pub gravity: Gravity,
}

/// How grave a moment is, least first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gravity {
    /// Good to know.
    #[default]
    Told,
    /// Needs attention.
    Warned,
    /// Something failed.
    Failed,
}

impl Gravity {
    /// Colour of a disc; what is good to know has that of its flight.
    pub fn colour(self, of: Colour) -> Colour {
        match self {
            Self::Told => of,
            Self::Warned => Colour(0xB4, 0x69, 0x00),
            Self::Failed => Colour(0xC2, 0x1F, 0x1F),
        }
    }
}

/// The moments of a flight, numbered from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    /// Whose, where there are several.
    pub of: String,
    /// Colour of the discs.
    pub colour: Colour,
    /// In order.
    pub list: Vec<Moment>,
    /// What more there is to say, after the last one.
    pub rest: String,
}

impl Moments {
    /// Colour of a moment's disc, and its edge: of several flights the one that it belongs to.
    pub(crate) fn disc(&self, gravity: Gravity) -> (Colour, Pen) {
        let edge = if self.of.is_empty() || gravity == Gravity::Told {
            Pen::solid(PAPER, 0.8)
        } else {
            Pen::solid(self.colour, 1.4)
        };
        (gravity.colour(self.colour), edge)
    }
}

/// A number in a disc of that colour with that edge.
pub fn disc(page: &mut Page, [x, y]: [f64; 2], number: usize, (colour, edge): (Colour, Pen)) {
    page.disc([x, y], RADIUS, colour, Some(edge));
    page.words([x, y + 2.7], number.to_string(), 7.5, PAPER, Anchor::Middle);
}

/// In which row each disc stands, so that none covers another; as many rows as are needed, four at most.
fn rows(places: &[f64]) -> Vec<usize> {
    let mut ends = [f64::MIN; 4];
    let row = |x: &f64| {
        let free = ends.iter().position(|end| x - end >= APART);
        let row = free.unwrap_or(0);
        ends[row] = *x;
        row
    };
    places.iter().map(row).collect()
}

/// Height of the rows of discs above an axis.
pub fn height(all: &[Moments], place: impl Fn(f64) -> f64) -> f64 {
    let of = |moments: &Moments| {
        let places: Vec<_> = moments.list.iter().map(|moment| place(moment.at)).collect();
        rows(&places).into_iter().max().map_or(0.0, |row| (row + 1) as f64 * ROW)
    };
    all.iter().map(of).sum()
}

/// Draws discs above `bottom`, and lines across each of the panels, from its top to its foot.
pub fn draw(
    page: &mut Page,
    all: &[Moments],
    bottom: f64,
    panels: &[(f64, f64)],
    place: impl Fn(f64) -> f64,
) {
    let mut bottom = bottom;
    for moments in all {
        let places: Vec<_> = moments.list.iter().map(|moment| place(moment.at)).collect();
        let rows = rows(&places);
        let y = |row: usize| bottom - (row as f64 + 0.5) * ROW;
        for (x, (top, foot)) in
            places.iter().flat_map(|x| panels.iter().map(move |panel| (x, panel)))
        {
            let pen = Pen { colour: page::GREY, width: 0.5, dash: Dash::Dotted };
            page.line(vec![[*x, *top], [*x, *foot]], pen);
        }
        for (number, (x, row)) in places.iter().zip(&rows).enumerate() {
            let look = moments.disc(moments.list[number].gravity);
            disc(page, [*x, y(*row)], number + 1, look);
        }
        bottom -= rows.into_iter().max().map_or(0.0, |row| (row + 1) as f64 * ROW);
    }
}

/// Where the key's words go: columns of the same width.
fn columns(all: &[Moments], room: f64) -> (usize, f64) {
    let wide = |moment: &Moment| width(&moment.words, KEY_SIZE) + 2.0 * RADIUS + 16.0;
    let widest = all.iter().flat_map(|moments| &moments.list).map(wide).fold(60.0, max);
    let columns = (room / widest).floor().clamp(2.0, 4.0);
    (columns as usize, room / columns)
}

/// Height of the key.
pub fn key_height(all: &[Moments], room: f64) -> f64 {
    let (columns, _) = columns(all, room);
    let of = |moments: &Moments| {
        let lines = moments.list.len().div_ceil(columns)
            + usize::from(!moments.of.is_empty())
            + usize::from(!moments.rest.is_empty());
        lines as f64 * KEY_LINE
    };
    all.iter().map(of).sum()
}

/// Writes the key from `top` downwards, in columns that are read from top to bottom.
pub fn key(page: &mut Page, all: &[Moments], [left, top]: [f64; 2], room: f64) {
    let (count, wide) = columns(all, room);
    let mut y = top;
    for moments in all {
        if !moments.of.is_empty() {
            let of = fitted(&moments.of, KEY_SIZE, room - 20.0);
            page.disc([left + RADIUS, y + 6.0], 3.5, moments.colour, None);
            page.words([left + 2.0 * RADIUS + 4.0, y + 9.0], of, KEY_SIZE, INK, Anchor::Start);
            y += KEY_LINE;
        }
        let lines = moments.list.len().div_ceil(count);
        for (number, moment) in moments.list.iter().enumerate() {
            let (column, line) = (number / lines, number % lines);
            let (x, y) = (left + column as f64 * wide, y + line as f64 * KEY_LINE);
            disc(page, [x + RADIUS, y + 6.0], number + 1, moments.disc(moment.gravity));
            let words = fitted(&moment.words, KEY_SIZE, wide - 2.0 * RADIUS - 10.0);
            page.words([x + 2.0 * RADIUS + 4.0, y + 9.0], words, KEY_SIZE, INK, Anchor::Start);
        }
        y += lines as f64 * KEY_LINE;
        if !moments.rest.is_empty() {
            let rest = fitted(&moments.rest, KEY_SIZE, room);
            page.words([left, y + 9.0], rest, KEY_SIZE, GREY, Anchor::Start);
            y += KEY_LINE;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_that_are_near_stand_in_rows() {
        assert_eq!(rows(&[0.0, 50.0, 100.0]), [0, 0, 0]);
        assert_eq!(rows(&[0.0, 2.0, 4.0, 50.0]), [0, 1, 2, 0]);
    }

    #[test]
    fn what_is_grave_has_a_colour_of_its_own_and_the_edge_says_whose_it_is() {
        let of = |of: &str| Moments {
            of: of.into(),
            colour: INK,
            list: Vec::new(),
            rest: String::new(),
        };
        assert_eq!(of("").disc(Gravity::Told).0, INK);
        let (fill, edge) = of("b").disc(Gravity::Failed);
        assert!(fill != INK && edge.colour == INK);
        assert!(Gravity::Told < Gravity::Warned && Gravity::Warned < Gravity::Failed);
    }

    #[test]
    fn no_moment_takes_no_room() {
        assert!(height(&[], |x| x).abs() < 1e-12 && key_height(&[], 700.0).abs() < 1e-12);
    }
}
