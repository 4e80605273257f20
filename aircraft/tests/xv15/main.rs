//! The XV-15's file: read as it is written, and what its numbers make of rotor and airframe beside the reports.

mod airframe;
mod airframe_tables;
mod airframe_wake;
mod envelope;
mod file;
mod rotor;
mod rotor_stand;
mod urdf;
