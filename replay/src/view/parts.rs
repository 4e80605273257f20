//! Parts of the screen, before the viewer is told of them.

use std::collections::BTreeMap;

use engine::math::{max, min};

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
    pub ranges: BTreeMap<String, Option<[f64; 2]>>,
}

impl Plan {
    /// Of flights with those roots.
    pub fn new(roots: &[&str]) -> Self {
        let roots = roots.iter().map(|root| format!("/{root}")).collect();
        Self { roots, ranges: BTreeMap::new() }
    }

    /// Notes values that a graph draws.
    pub fn see(&mut self, entity: &str, values: impl Iterator<Item = f64>) {
        let range = self.ranges.entry(entity.into()).or_default();
        for value in values.filter(|value| value.is_finite()) {
            let [least, most] = range.unwrap_or([value, value]);
            *range = Some([min(least, value), max(most, value)]);
        }
    }

    /// A graph's title with its range: a low plot has room for one number at its axis.
    pub fn titled(&self, title: &str, entity: &str) -> String {
        match self.ranges.get(entity) {
            None => title.into(),
            Some(None) => format!("{title} · none in this flight"),
            Some(Some(range)) => {
                let [least, most] = told(*range);
                format!("{title} · {least} to {most}")
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

/// Both ends of a range, as many decimals as make three figures of the larger.
fn told(range: [f64; 2]) -> [String; 2] {
    let size = max(range[0].abs(), range[1].abs());
    let decimals = match size {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        size if size >= 1e-2 => 3,
        _ => return range.map(|end| if end == 0.0 { "0".into() } else { format!("{end:.1e}") }),
    };
    range.map(|end| {
        let text = format!("{end:.decimals$}");
        // What rounds to nothing has no sign.
        let is_nothing = text.trim_start_matches(['-', '0', '.']).is_empty();
        if is_nothing { "0".into() } else { text }
    })
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
        let mut of = |values: &[f64]| {
            plan.see("plots/x", values.iter().copied());
            plan.titled("Thrust, kN", "plots/x")
        };
        assert_eq!(of(&[f64::NAN]), "Thrust, kN · none in this flight");
        assert_eq!(of(&[0.0]), "Thrust, kN · 0 to 0");
        assert_eq!(of(&[-2e-4]), "Thrust, kN · -2.0e-4 to 0");
        assert_eq!(of(&[0.0371]), "Thrust, kN · 0 to 0.037");
        assert_eq!(of(&[-1.234, f64::INFINITY]), "Thrust, kN · -1.23 to 0.04");
        assert_eq!(of(&[31.26]), "Thrust, kN · -1.2 to 31.3");
        assert_eq!(of(&[1234.5]), "Thrust, kN · -1 to 1234");
        assert_eq!(plan.titled("Torque, kN·m", "plots/y"), "Torque, kN·m");
    }
}
