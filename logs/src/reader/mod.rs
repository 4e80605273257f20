//! Reading a flight: a stream of ticks, every checksum validated before its bytes are used.

mod ending;
mod flight;
mod lookup;
mod messages;
mod stream;

pub use ending::Ending;
pub use flight::{FlightReader, Tick, open};
pub use lookup::{closing, marker};
pub use messages::{Message, Messages};
