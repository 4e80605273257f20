//! The piloted flight in real time: hands on the controls, the loop at 250 Hz, the log.
//!
//! [`fly`] runs a [`Flight`]. Each tick it takes the device events that came in, lets pilot models and
//! scripts add theirs, hands all of it to the writer, steps the engine, and sends the picture to
//! FlightGear. The loop waits for nothing but time.

mod clock;
mod clock_check;
mod controller;
mod controllers;
pub mod debrief;
#[cfg(feature = "sticks")]
pub mod devices;
mod end;
mod flight;
pub mod flightgear_controls;
pub mod ground;
pub mod keyboard;
mod landing;
mod live;
pub mod pilots;
mod platform;
mod progress;
mod rehearsal;
mod restart;
pub mod script;
mod self_check;
pub mod situation;
pub mod statistics;
mod stepped;
pub mod writer;

pub use clock::{Pace, RealTime, Woken};
pub use clock_check::{ClockCheck, check_clock};
pub use controller::{Controller, GaveUp, TickContext};
pub use end::End;
pub use flight::{Flight, FlyError};
pub use landing::Landing;
pub use live::fly;
pub use platform::{open_pipe, step_aside};
pub use progress::{Progress, Shown, Snapshot, Told};
pub use rehearsal::{RehearsedTick, rehearse};
pub use restart::{Restart, Situation};
pub use self_check::{Checked, Mismatch};
pub use stepped::{Moment, Movement, StepError, Stepped};
pub use writer::Delay;
