//! Rerunning a flight log: bit-exact verification, and the review in the rerun viewer.

mod bless;
pub mod changes;
pub mod compare;
mod diagnosis;
mod diff;
mod divergence;
pub mod figures;
pub mod growth;
pub mod identify;
pub mod judgement;
mod made;
mod notice;
mod outputs;
pub mod playback;
mod refly;
mod rewrite;
mod source;
mod stage;
mod stretches;
mod summary;
mod ticks;
mod verify;
mod versions;
#[cfg(feature = "rerun")]
pub mod view;
mod words;

pub use bless::{KEYFRAME_TICKS, Largest, Moved, bless};
pub use diff::{
    Diff, EventsDifference, Extent, FileDifference, FirstEvent, KeyDifference, Side, Which, diff,
};
pub use divergence::{BlockDifference, Divergence, InputChange, OneStepCheck};
pub use judgement::{End, Facts, Judgement, Outcome, judge};
pub use made::{proven, proven_while};
pub use outputs::OutputsDifference;
pub use playback::Playback;
pub use refly::{OPEN, Reflight, Reflown, ReflyOptions, ReplayError, Window, flown};
pub use rewrite::{NewLog, Rewritten, names_parent, parent, rewrite, rewrite_in};
pub use source::Source;
pub use stage::Stage;
pub use summary::{At, Gathered, Summary, Touchdown, summary};
pub use ticks::Irregular;
pub use verify::{Options, THREADS_MAX, Verdict, verify, verify_while};
pub use versions::Versions;
pub use words::differing;
