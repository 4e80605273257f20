//! The piloted flight in real time: hands on the controls, the loop at 250 Hz, the log.
//!
//! [`fly`] runs a [`Flight`]. Each tick it takes the device events that came in, lets pilot models and
//! scripts add theirs, hands all of it to the writer, steps the engine, and sends the picture to
//! FlightGear. The loop waits for nothing but time.

mod clock;
mod crew;
#[cfg(feature = "sticks")]
pub mod devices;
mod end;
mod flight;
mod hands;
mod landing;
mod live;
pub mod pilots;
pub mod pipe;
mod progress;
mod rehearsal;
pub mod script;
mod self_check;
pub mod statistics;
pub mod writer;

pub use clock::{Pace, Woken};
pub use end::End;
pub use flight::{Flight, FlyError};
pub use hands::{GaveUp, Hands, Reach};
pub use landing::Landing;
pub use live::fly;
pub use progress::{Progress, Snapshot};
pub use rehearsal::{RehearsedTick, rehearse};
pub use self_check::{Checked, Mismatch};
pub use writer::Delay;
