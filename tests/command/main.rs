//! What a person meets at the command line: verbs, their numbers, their refusals, and the files they write.

#[path = "../common/mod.rs"]
mod common;

mod bad_input;
mod figures;
mod identify;
mod keys;
mod numbers;
#[cfg(target_os = "linux")]
mod outputs;
mod playback;
mod script;
mod second_aircraft;
mod steady;
#[cfg(feature = "rerun")]
mod view;
mod whatif;
