//! The flight log: one flight, one MCAP file that holds all that is needed to refly it and opens
//! without conversion in other people's viewers.
//!
//! The only crate that knows MCAP. [`FlightWriter`] writes, [`open`](open()) reads; [`channels`] says what a log
//! holds, [`records`] what is recorded, [`view`] what is added for viewers, [`fields`] what a struct's
//! numbers are called.
//!
//! From below: `container` drives mcap, `codec` knows bytes and names, `compact` makes the records of a
//! compacted log, and `reader` makes a flight of any records.

pub mod channels;
mod codec;
pub mod compact;
mod container;
pub mod devices;
mod error;
mod event_detector;
pub mod export;
mod level;
mod open;
pub mod output;
mod reader;
pub mod records;
mod recover;
mod setup;
pub mod text;
pub mod view;
mod writer;

pub use codec::{cdr, evolution, fields, layout, schema, units};
pub use error::LogError;
pub use event_detector::{EventDetector, Observed};
pub use open::OpenOptions;
pub use reader::{Ending, FlightReader, Message, Messages, Remade, Tick, closing, marker, open};
pub use recover::{Recovery, recover};
pub use setup::{Identity, Setup};
pub use writer::{Closed, FlightWriter, Listener};
