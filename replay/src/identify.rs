//! Frequency responses from a flight: what an output does for an input, and how far the two belong
//! together.
//!
//! [`Record`] takes two signals out of a log (or anything else that flies), [`estimate()`] makes the
//! response and its coherence of them.

mod record;
mod spectra;

pub use record::{Record, Signal, Unknown, record};
pub use spectra::{Options, Point, Refusal, estimate};
