//! Rerunning a flight log: bit-exact verification, and the review in the rerun viewer.

mod refly;
mod verify;
#[cfg(feature = "rerun")]
pub mod view;

pub use refly::{Reflight, Reflown, ReplayError};
pub use verify::{Divergence, Outcome, Verdict, verify};
