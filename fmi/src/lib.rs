//! The XV-15's flight model as a Functional Mock-up Unit for co-simulation: FMI 2.0 and 3.0 from one library.
//!
//! [`variables`] is the one table of what can be set and read; [`description`] writes it as `modelDescription.xml`
//! of either version. [`instance`] is a flight with its parameters and inputs, without a pointer; `fmi2` and
//! `fmi3` are the C functions, each of which is a few lines over `handle`, where pointers become slices, refusals
//! become words for the simulation tool, and no panic passes.

pub mod description;
mod flying;
mod fmi2;
mod fmi3;
mod handle;
pub mod instance;
mod provenance;
mod units;
mod values;
pub mod variables;
