//! What a log is worth: reflown, compared, recovered, damaged, compacted, written anew by others, and of older
//! versions.

#[path = "../common/mod.rs"]
mod common;

mod corpus;
mod diff;
mod divergence;
mod events;
mod foreign_tools;
mod recover;
mod reflight;
mod refly;
mod versions;
