//! FlightGear's wire formats and link.
//!
//! FlightGear draws the outside world and the instruments; the flight model is ours. This crate turns
//! a [`Scene`] into a [`Picture`]: FlightGear's native flight-model packet, [`NetFdm`] (FGNetFDM version
//! 24, which FlightGear 2020.3 and 2024.1 read), and a second one, [`Channel`], for what a tilt-rotor
//! has and that packet cannot carry. It sends them by UDP over a [`Link`] that neither blocks nor fails:
//! whether FlightGear is there, restarts or has gone makes no difference to the flight.
//!
//! FlightGear listens for both, on this machine only, when it is started with
//! ```text
//! fgfs --fdm=null --native-fdm=socket,in,60,127.0.0.1,5501,udp \
//!     --generic=socket,in,60,127.0.0.1,5502,udp,tiltrotor
//! ```
//! where [`DEFAULT_DESTINATION`] sends; `tiltrotor flightgear` writes that command. FlightGear looks once
//! per frame and takes the newest packet, so sending faster than it draws does no harm.
//!
//! Nothing here reaches the flight model: packets are made from what a step gave, after the step.

pub mod channel;
mod display;
mod hold;
pub mod link;
pub mod net_fdm;
pub mod package;
mod picture;
mod receiver;
pub mod report;
mod scene;

pub use channel::{Channel, ChannelError};
pub use hold::Hold;
pub use link::{DEFAULT_DESTINATION, Link, LinkError, Listener, Sent};
pub use net_fdm::{NetFdm, PacketError};
pub use picture::Picture;
pub use receiver::Receiver;
pub use report::{GroundSample, Report, ReportError};
pub use scene::{Lamps, Recording, Scene};
