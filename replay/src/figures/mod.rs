//! A flight as figures: what a paper or a report shows of it.
//!
//! ```text
//! reflight ─► Gatherer ─► Flight ─► draw(Figure) ─► chart::Page ─► SVG, PNG
//! ```
//! Nothing carries the wall clock or the log's folder: the same log gives the same bytes. Lines are drawn from
//! 50 rows a second; times of ticks from every tick.

mod corridor;
mod flight;
mod latency;
mod look;
mod over_time;
mod track;

use chart::Page;

pub use flight::{Configuration, Flight, Gatherer, Happened, Row, StepTime};

/// What is told of a [`Figure`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FigureFacts {
    /// Its name on the command line and in files; never changed.
    pub key: &'static str,
    /// Its title.
    pub words: &'static str,
    /// What it shows.
    pub description: &'static str,
}

engine::enumeration! {
    /// A figure.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u64)]
    pub enum Figure tells FigureFacts {
        /// The path in space, in a box with its shadow on the ground.
        Trajectory = 1 { key: "trajectory", words: "Trajectory" }
        /// The path seen from above.
        Plan = 2 { key: "plan", words: "Ground track" }
        /// Height, airspeed, climb, nacelles and load factor over time.
        Profile = 3 { key: "profile", words: "Flight profile" }
        /// Roll, pitch and heading over time.
        Euler = 4 { key: "euler", words: "Euler angles" }
        /// Stick, pedals and lever, and the surfaces that follow, over time.
        Controls = 5 { key: "controls", words: "Controls" }
        /// Thrust, torque, collective pitch, flapping and speed of the rotors over time.
        Rotors = 6 { key: "rotors", words: "Rotors" }
        /// Nacelle angle over airspeed, within the conversion corridor.
        Corridor = 7 { key: "corridor", words: "Conversion corridor" }
        /// How late each tick's picture was, and how long its step took.
        Latency = 8 { key: "latency", words: "Latency of each step" }
    }
}

/// Why a figure cannot be drawn of a flight.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it cannot be drawn: {0}")]
pub struct Undrawn(pub &'static str);

/// Draws a figure of a flight, or of two over each other.
///
/// # Errors
/// When the logs do not have what it shows.
pub fn draw(figure: Figure, flights: &[&Flight], tolerance: f64) -> Result<Page, Undrawn> {
    if flights.iter().all(|flight| flight.rows.is_empty()) {
        return Err(Undrawn("the flight is shorter than a row of the figure, 0.020 s"));
    }
    Ok(match figure {
        Figure::Trajectory => track::space(flights).page(tolerance),
        Figure::Plan => track::plan(flights).page(tolerance),
        Figure::Profile | Figure::Euler | Figure::Controls | Figure::Rotors => {
            over_time::stack(figure, flights).page(tolerance)
        }
        Figure::Corridor => corridor::plane(flights).page(tolerance),
        Figure::Latency => latency::stack(flights)?.page(tolerance),
    })
}
