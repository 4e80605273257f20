//! Rerunning a flight log: bit-exact verification, and the review in the rerun viewer.

pub mod compare;
mod diff;
mod divergence;
pub mod growth;
mod refly;
mod stage;
mod verify;
mod versions;
#[cfg(feature = "rerun")]
pub mod view;

pub use diff::{
    Diff, EventsDifference, Extent, FileDifference, FirstEvent, KeyDifference, Side, Which, diff,
};
pub use divergence::{BlockDifference, Divergence, InputChange, SingleSteps};
pub use refly::{Reflight, Reflown, ReplayError};
pub use stage::Stage;
pub use verify::{Options, Outcome, Verdict, verify};
pub use versions::Versions;
