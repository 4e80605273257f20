//! What is asked of the flight model beside flying it: steady flight, small motions about it, and
//! their modes.
//!
//! A [`Condition`](condition::Condition) asks for a steady flight in a pilot's units,
//! [`trim()`](trim::trim) finds it, [`linearize()`](linearize::linearize) the state-space matrices
//! about it, [`modes()`](modes::modes) their eigenvalues and what these are called;
//! [`state_at()`](start::state_at) begins a flight as its scenario says. All of them evaluate
//! [`engine::step::derivatives`] and nothing else of the engine's physics, and none of them is part of a
//! flight: what a flight begins with is recorded.
//!
//! Results are the same on every machine, as the engine's are. The matrices are nalgebra's without its
//! `std`: products are then plain loops without FMA, square roots and the like those of `libm`.
#![no_std]

extern crate alloc;

pub mod condition;
mod eigen;
mod francis;
pub mod linearize;
mod matrix;
pub mod modes;
mod solve;
pub mod start;
pub mod trim;
pub mod variable;

pub use eigen::Unsolved;
pub use matrix::{Complex, Matrix, Polar};
