//! Flights in real time, and what is beside them meanwhile: devices, FlightGear, a viewer, a pipe that nobody
//! reads. They wait more than they compute: two at a time leave each other the machine.

#[path = "../common/mod.rs"]
mod common;

mod flightgear;
mod flightgear_tells;
#[cfg(all(target_os = "linux", feature = "sticks"))]
mod hardware;
#[cfg(all(feature = "rerun", unix))]
mod live_view;
#[cfg(unix)]
mod slip;
#[cfg(unix)]
mod stall;
#[cfg(feature = "sticks")]
mod stick;
