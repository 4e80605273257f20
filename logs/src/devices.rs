//! Input devices as they call themselves: which stick it was.
//!
//! No step needs it, so it is text and outside the chain of digests: the footer's message digest guards it.

use serde::{Deserialize, Serialize};

use crate::view::RosType;
use crate::{LogError, cdr};

pub(crate) const TYPE: RosType = RosType {
    name: "tiltrotor_msgs/msg/DeviceIdentity",
    own: "uint64 tick\nuint64 device\nuint64 mapped\nuint64 bus\nuint64 vendor\nuint64 product\n\
          uint64 version\nstring name\nstring phys\nstring uniq\nstring port\n",
    parts: &[],
};

/// A message of `/devices`: an input device that was there.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeviceIdentity {
    /// When it was found.
    pub tick: u64,
    /// Its number in `/hardware`; of one that is not mapped, its place among those that were found.
    pub device: u64,
    /// 1 when the cockpit map uses it.
    pub mapped: u64,
    /// The kernel's bus type.
    pub bus: u64,
    /// The maker's USB number.
    pub vendor: u64,
    /// The product's USB number.
    pub product: u64,
    /// The device's version.
    pub version: u64,
    /// What it calls itself.
    pub name: String,
    /// Where it is plugged in, as the kernel names it.
    pub phys: String,
    /// Its serial number, where it has one.
    pub uniq: String,
    /// The device node or the port by which two of the same name are told apart.
    pub port: String,
}

impl DeviceIdentity {
    pub(crate) fn encode(&self) -> Result<Vec<u8>, LogError> {
        cdr::encode_view(self)
    }

    /// A message of `/devices` read back.
    ///
    /// # Errors
    /// When the bytes are none.
    pub(crate) fn decode(message: &[u8]) -> Result<Self, LogError> {
        cdr::decode_view(message, "a device's identity")
    }
}
