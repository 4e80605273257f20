//! What is recorded, and on which channel.

use engine::inputs::World;
use engine::{STEP_NS, State};
use serde::{Deserialize, Serialize};

/// Version of the log's format: its records, channels and seals. The fields of a message are not part
/// of it; each log names its own.
pub const FORMAT_VERSION: &str = "2";
/// The formats that are read. 1 had no seals, and at first no last word of the writer.
pub const FORMATS_READ: [&str; 2] = ["1", FORMAT_VERSION];

/// Raw device events, one message each, in the order they were applied.
pub const HARDWARE: &str = "/hardware";
/// The world, one message a tick, before the step that uses it.
pub const INPUTS: &str = "/inputs";
/// The state after each tick, with the digest chain; the first message is the state at the start.
pub const STATE: &str = "/state";
/// How the tick kept time.
pub const TIMING: &str = "/timing";
/// What happened.
pub const EVENTS: &str = "/events";
/// What could be observed, now and then.
pub const OUTPUTS: &str = "/outputs";

/// The world during one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InputsRecord {
    /// Tick whose step uses it.
    pub tick: u64,
    /// How many device events belong to the tick: a missing one is noticed.
    pub events: u64,
    /// The world.
    pub world: World,
}

/// The state after a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StateRecord {
    /// xxh3-64 over the digest before, the tick's events, its inputs and this state.
    pub digest: u64,
    /// The state.
    pub state: State,
}

impl StateRecord {
    /// Place of the tick among the numbers.
    pub(crate) const TICK: usize = 1;
}

/// How one tick kept time. All durations in ns, measured on the loop's thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TimingRecord {
    /// Tick that was flown.
    pub tick: u64,
    /// Wall clock when it was flown, since the Unix epoch.
    pub wall_ns: u64,
    /// Woke up later than wanted by.
    pub late_ns: u64,
    /// Took for the step alone.
    pub step_ns: u64,
    /// From waking up until the picture was on its way.
    pub sent_ns: u64,
    /// From the kernel's time of the tick's oldest device event until the picture was on its way;
    /// 0 without one.
    pub latency_ns: u64,
    /// Handing the tick over to the writer took.
    pub record_ns: u64,
    /// 1 when the tick ended after the next one was due.
    pub overrun: u64,
}

/// Something that happened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EventRecord {
    /// When.
    pub tick: u64,
    /// What: one of [`Happening`].
    pub kind: u64,
    /// Which one, how many, or which bits.
    pub value: u64,
}

/// What an [`EventRecord`] tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Happening {
    /// The pilot pressed the marker; value: its number.
    Marker = 1,
    /// Something failed or was mended; value: the failures now.
    Failures = 2,
    /// A device appeared; value: its number.
    DeviceConnected = 3,
    /// A device went away; value: its number.
    DeviceDisconnected = 4,
    /// The model left its validity or came back; value: the bits now.
    Validity = 5,
    /// The simulation was paused (1) or went on (0).
    Paused = 6,
    /// The wheels took weight (1) or lost it (0).
    WeightOnWheels = 7,
    /// The flight was ended; value: 0 as planned, 1 by the crew, 2 by a signal.
    Landed = 8,
    /// A pilot model went on to its next phase; value: its number.
    Phase = 9,
    /// The flight, reflown while it went on, was not the same; value: the fields that differ.
    SelfCheck = 10,
    /// The log's writer was held up; value: how long, ms.
    WriterHeldUp = 11,
}

impl Happening {
    const ALL: [Self; 11] = [
        Self::Marker,
        Self::Failures,
        Self::DeviceConnected,
        Self::DeviceDisconnected,
        Self::Validity,
        Self::Paused,
        Self::WeightOnWheels,
        Self::Landed,
        Self::Phase,
        Self::SelfCheck,
        Self::WriterHeldUp,
    ];

    /// The one recorded as `kind`, if it is one.
    pub fn from_u64(kind: u64) -> Option<Self> {
        Self::ALL.into_iter().find(|known| *known as u64 == kind)
    }
}

/// Log time of a tick's state, ns since the start of the flight.
pub fn time_ns(tick: u64) -> u64 {
    tick.saturating_mul(STEP_NS)
}

/// The digest that starts a chain: everything the flight is reflown from. Who flew it, and when, is
/// not part of it: the same flight has the same digests.
pub fn first_digest(setup: &[(&str, &str)], state_message: &[u8]) -> u64 {
    let mut bytes = Vec::new();
    for (name, text) in setup {
        for part in [name, text] {
            bytes.extend_from_slice(&(part.len() as u64).to_le_bytes());
            bytes.extend_from_slice(part.as_bytes());
        }
    }
    bytes.extend_from_slice(state_message);
    xxhash_rust::xxh3::xxh3_64(&bytes)
}

/// The chain of digests through a flight.
#[derive(Clone, Debug, Default)]
pub struct Chain {
    digest: u64,
    tick: Vec<u8>,
}

impl Chain {
    /// A chain that starts with `digest`.
    pub fn from(digest: u64) -> Self {
        Self { digest, tick: Vec::new() }
    }

    /// Goes on from another digest.
    pub(crate) fn set(&mut self, digest: u64) {
        self.digest = digest;
    }

    /// The last digest.
    pub fn digest(&self) -> u64 {
        self.digest
    }

    /// Adds a message of the tick under way (device event or inputs).
    pub fn add(&mut self, message: &[u8]) {
        self.tick.extend_from_slice(message);
    }

    /// Ends the tick with its encoded state (without the digest), and returns the new digest.
    pub fn close(&mut self, state_message: &[u8]) -> u64 {
        self.tick.extend_from_slice(state_message);
        self.tick.extend_from_slice(&self.digest.to_le_bytes());
        self.digest = xxhash_rust::xxh3::xxh3_64(&self.tick);
        self.tick.clear();
        self.digest
    }
}
