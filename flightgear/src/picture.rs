//! A picture: all that FlightGear is told of a moment, ready to be sent.

use crate::channel::Channel;
use crate::net_fdm::NetFdm;
use crate::scene::Scene;

/// The packets of one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture {
    /// FlightGear's own packet.
    pub fdm: NetFdm,
    /// What that one cannot carry.
    pub channel: Channel,
    /// Of a second aircraft beside it.
    pub ghost: Option<Channel>,
}

impl Picture {
    /// The picture of a moment. Asks for no memory.
    pub fn of(scene: &Scene<'_>) -> Self {
        Self { fdm: NetFdm::of(scene), channel: Channel::of(scene), ghost: None }
    }

    /// Between two pictures, `part` of the way from one to the other: for display only, no flight was
    /// ever there.
    #[must_use]
    pub fn between(from: &Self, to: &Self, part: f64) -> Self {
        Self {
            fdm: NetFdm::between(&from.fdm, &to.fdm, part),
            channel: Channel::between(&from.channel, &to.channel, part),
            ghost: to.ghost,
        }
    }
}
