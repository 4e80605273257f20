//! The deterministic fixed-step flight model of a tilt-rotor.
//!
//! One function, [`step()`], takes the aircraft, its state and everything that came in from outside,
//! and gives the next state and what can be observed. The same arguments give the same bits on
//! every machine: there is no clock, no file, no thread and no randomness here, and the
//! transcendental functions are the pinned ones of [`math`].
//!
//! Blocks are named as in the block diagram of the literature; [`mod@step`] wires them and is the
//! only place that does. A block that is sampled once a tick is asked by `update`, one that gives loads
//! or rates by `evaluate`. No block knows another: what several of them read is in [`motion`],
//! [`controls`], [`inertia`] and [`struts`].
#![no_std]

extern crate alloc;

pub mod actuators;
pub mod aero;
pub mod aircraft;
pub mod cockpit;
pub mod controls;
pub mod display;
pub mod engines;
pub mod envelope;
pub mod environment;
pub mod eom;
pub mod fcc;
pub mod frames;
pub mod inertia;
pub mod inputs;
pub mod isa;
pub mod landing_gear;
mod lanes;
pub mod listing;
pub mod mast;
pub mod math;
pub mod motion;
pub mod outputs;
pub mod pair;
pub mod pilot;
pub mod references;
pub mod rotors;
pub mod start;
pub mod state;
pub mod step;
pub mod struts;
pub mod symmetry;
pub mod table;
pub mod units;
pub mod weight_balance;

pub use aircraft::Aircraft;
pub use inputs::Inputs;
pub use outputs::Outputs;
pub use state::State;
pub use step::{observe, step, step_state};

/// Length of a tick, s. 250 Hz: every log time is a whole number of nanoseconds.
pub const STEP_S: f64 = 0.004;

/// Length of a tick, ns.
pub const STEP_NS: u64 = 4_000_000;

/// Names the motion: logs flown under another version are not expected to refly to the same bits.
pub const MODEL_VERSION: &str = "4";

/// Standard gravity, m/s².
pub const GRAVITY_MPS2: f64 = 9.806_65;
