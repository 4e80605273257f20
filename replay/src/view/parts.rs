//! Parts of the screen, before the viewer is told of them.

/// Entities of all axes are below it.
pub const RAW: &str = "raw";
/// Entity of the page above everything.
pub const HEADING: &str = "heading";
/// Entity of a flight's table of numbers at the cursor.
pub const NUMBERS: &str = "numbers";
/// Entity of that of two.
pub const NUMBERS_OF_TWO: &str = "delta/numbers";

/// What is laid out.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Before the names of the entities of each flight.
    pub roots: Vec<String>,
}

impl Plan {
    /// Of flights with those roots.
    pub fn new(roots: &[&str]) -> Self {
        Self { roots: roots.iter().map(|root| format!("/{root}")).collect() }
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
    /// A page of text.
    Document {
        /// Of the view.
        name: &'static str,
        /// Its entity.
        entity: &'static str,
    },
}
