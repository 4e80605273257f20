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
mod list;
mod look;
mod over_time;
mod track;

use chart::Page;

pub use flight::{Configuration, Flight, Gatherer, Happened, Row, StepTime};
pub use list::{Figure, FigureFacts, Undrawn};

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
