//! Parts of the screen, before the viewer is told of them.

use std::collections::BTreeMap;

use engine::STEP_S;
use engine::math::{max, min};

use super::basics::rounded;

/// Entities of all axes are below it.
pub const RAW: &str = "raw";
/// Entity of the page above everything.
pub const HEADING: &str = "heading";
/// Entity of a flight's table of numbers at the cursor.
pub const NUMBERS: &str = "numbers";
/// Entity of that of its rotors.
pub const NUMBERS_OF_ROTORS: &str = "numbers_of_rotors";
/// Entity of that of two.
pub const NUMBERS_OF_TWO: &str = "delta/numbers";

/// What is laid out.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Before the names of the entities of each flight.
    pub roots: Vec<String>,
    /// The range of what a graph draws, by its entity, once that is known; `None` where it draws nothing.
    pub ranges: BTreeMap<String, Option<Range>>,
}

impl Plan {
    /// Of flights with those roots.
    pub fn new(roots: &[&str]) -> Self {
        let roots = roots.iter().map(|root| format!("/{root}")).collect();
        Self { roots, ranges: BTreeMap::new() }
    }

    /// Notes values that a graph draws.
    pub fn see(&mut self, entity: &str, points: impl Iterator<Item = PointDrawn>) {
        let range = self.ranges.entry(entity.into()).or_default();
        for (tick, line, value) in points.filter(|(.., value)| value.is_finite()) {
            let range = range.get_or_insert(Range { least: value, most: value, tick, line });
            if value.abs() > range.size() {
                (range.tick, range.line) = (tick, line);
            }
            (range.least, range.most) = (min(range.least, value), max(range.most, value));
        }
    }

    /// A graph's title with its range, for a low plot has room for one number at its axis; so many letters have
    /// room.
    pub fn titled(&self, title: &str, entity: &str, room: usize) -> String {
        match self.ranges.get(entity) {
            None => title.into(),
            Some(None) => format!("{title} · none in this flight"),
            Some(Some(range)) => {
                let long = format!("{title} · {}", told(range, range.line));
                let fits = long.chars().count() <= room;
                if fits { long } else { format!("{title} · {}", told(range, "")) }
            }
        }
    }

    /// Whether it is of two flights.
    pub fn is_comparison(&self) -> bool {
        self.roots.len() > 1
    }

    /// An entity of every flight.
    pub fn each(&self, name: &str) -> Vec<String> {
        self.roots.iter().map(|root| format!("{root}{name}")).collect()
    }
}

/// A tick, the name of a line where its graph has several, and its value.
pub type PointDrawn = (u64, &'static str, f64);

/// From where to where the lines of a graph go.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    least: f64,
    most: f64,
    /// When the end that is further from 0 was reached first.
    tick: u64,
    /// By which line.
    line: &'static str,
}

impl Range {
    fn size(&self) -> f64 {
        max(self.least.abs(), self.most.abs())
    }
}

/// A range, the end that is further from 0 last, with its time: as many decimals as make three figures of it.
fn told(range: &Range, line: &str) -> String {
    let decimals = match range.size() {
        size if size >= 100.0 => Some(0),
        size if size >= 10.0 => Some(1),
        size if size >= 1.0 => Some(2),
        size if size >= 1e-2 => Some(3),
        _ => None,
    };
    let figure = |end: f64| {
        let text = decimals.map_or_else(|| format!("{end:.1e}"), |decimals| rounded(end, decimals));
        // Of nothing no decimals are told.
        if text.parse() == Ok(0.0) { "0".into() } else { text }
    };
    let (near, far) = if range.most.abs() >= range.least.abs() {
        (figure(range.least), figure(range.most))
    } else {
        (figure(range.most), figure(range.least))
    };
    if near == far {
        return format!("{far} throughout");
    }
    let line = if line.is_empty() { String::new() } else { format!(" ({line})") };
    format!("{near} to {far} at {:.1} s{line}", range.tick as f64 * STEP_S)
}

/// A part of the screen: a view, or several parts in tabs, from left to right, or from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// One view.
    View(Shown),
    /// A name and its parts.
    Tabs(String, Vec<Part>),
    /// The same, with the share of each.
    Across(String, Vec<f32>, Vec<Part>),
    /// The same.
    Down(String, Vec<f32>, Vec<Part>),
}

/// What a view shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// The aircraft from beside it, without some parts of the world.
    Aircraft {
        /// The eye in the chase frame.
        eye_m: [f32; 3],
        /// Entities of the world.
        without: &'static [&'static str],
    },
    /// The whole flight in space.
    Overview,
    /// The whole flight on a map.
    Map,
    /// The conversion corridor.
    Corridor,
    /// What happened, as a list.
    Events,
    /// Lanes of states.
    Lanes {
        /// Of the view.
        name: &'static str,
        /// Entities of every flight.
        of: &'static str,
    },
    /// Lines over time.
    Plot {
        /// With the unit.
        title: String,
        /// Entities.
        queries: Vec<String>,
        /// Whether it says which line is which.
        legend: bool,
    },
    /// Which flight it is, and what it is worth.
    Heading,
    /// Numbers at the cursor.
    Numbers,
    /// Those of both rotors.
    NumbersOfRotors,
    /// A page of text.
    Document {
        /// Of the view.
        name: &'static str,
        /// Its entity.
        entity: &'static str,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_says_from_where_to_where_its_lines_go() {
        let mut plan = Plan::new(&[""]);
        let mut ticks = 0;
        let mut of = |values: &[f64]| {
            ticks += 250;
            plan.see("plots/x", values.iter().map(|value| (ticks, "left", *value)));
            plan.titled("Thrust, kN", "plots/x", 60)
        };
        assert_eq!(of(&[f64::NAN]), "Thrust, kN · none in this flight");
        assert_eq!(of(&[0.0]), "Thrust, kN · 0 throughout");
        assert_eq!(of(&[-2e-4]), "Thrust, kN · 0 to -2.0e-4 at 3.0 s (left)");
        assert_eq!(of(&[0.0371]), "Thrust, kN · 0 to 0.037 at 4.0 s (left)");
        assert_eq!(of(&[-1.234, f64::INFINITY]), "Thrust, kN · 0.04 to -1.23 at 5.0 s (left)");
        assert_eq!(of(&[31.26]), "Thrust, kN · -1.2 to 31.3 at 6.0 s (left)");
        assert_eq!(of(&[31.26]), "Thrust, kN · -1.2 to 31.3 at 6.0 s (left)");
        assert_eq!(of(&[1234.5]), "Thrust, kN · -1 to 1234 at 8.0 s (left)");
        assert_eq!(plan.titled("Torque, kN·m", "plots/y", 60), "Torque, kN·m");
        assert_eq!(plan.titled("Thrust, kN", "plots/x", 30), "Thrust, kN · -1 to 1234 at 8.0 s");
    }
}
