//! FlightGear's wire formats and link.
//!
//! FlightGear draws the outside world; the flight model is ours. This crate turns
//! [`engine::Outputs`] into FlightGear's native flight-model packet, [`NetFdm`] (FGNetFDM version
//! 24, which FlightGear 2020.3 and 2024.1 read), and sends it by UDP over a [`Link`] that neither
//! blocks nor fails: whether FlightGear is there, restarts or has gone makes no difference to the
//! flight.
//!
//! To see a flight, start FlightGear with
//! ```text
//! fgfs --fdm=null --native-fdm=socket,in,60,127.0.0.1,5501,udp
//! ```
//! which listens where [`DEFAULT_DESTINATION`] sends, on this machine only. FlightGear looks once
//! per frame and takes the newest packet, so sending faster than it draws does no harm.
//!
//! Nothing here reaches the flight model: packets are made from what a step gave, after the step.

pub mod channel;
mod display;
pub mod link;
pub mod net_fdm;
mod scene;

pub use channel::{Channel, ChannelError};
pub use link::{DEFAULT_DESTINATION, Link, LinkError};
pub use net_fdm::{NetFdm, PacketError};
pub use scene::{Lamps, Recording, Scene};
