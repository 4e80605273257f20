//! What is recorded, and on which channel.

use engine::State;
use engine::inputs::World;
use serde::{Deserialize, Serialize};

use crate::level::Level;

pub use crate::container::time_ns;

/// Version of the log's format: its records, channels and checksums. The fields of a message are not part
/// of it; each log names its own.
pub const FORMAT_VERSION: &str = "4";
/// The formats that are read. 1 had no checksums of metadata and messages, and at first no footer record of
/// the writer; 2 knew no devices, and two message types by one name; 3 knew no restarts.
pub const FORMATS_READ: [&str; 4] = ["1", "2", "3", FORMAT_VERSION];

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
/// Which input devices there were.
pub const DEVICES: &str = "/devices";
/// States that took the place of the one that was flown, before the step of their tick.
pub const RESTART: &str = "/restart";

/// Name of the metadata record with how the flight kept time, at the end of its log: counts, and for
/// each kind of duration a histogram, as the greatest duration of each step in ns and how many there were.
pub const TIMING_FACTS: &str = "tiltrotor_timing";

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

/// What is told of a [`RestartCause`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RestartFacts {
    /// Its name; never changed.
    pub key: &'static str,
    /// What the crew did, in words.
    pub words: &'static str,
    /// Where the state came from.
    pub description: &'static str,
}

engine::enumeration! {
    /// Why a state took the place of the one that was flown.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u64)]
    pub enum RestartCause tells RestartFacts {
        /// The state with which the flight began.
        Start = 1 { key: "start", words: "reset to the start" }
        /// The state at the last marker.
        Marker = 2 { key: "marker", words: "reset to the last marker" }
        /// A start position chosen in flight.
        Reposition = 3 { key: "reposition", words: "repositioned" }
        /// A situation that was saved before.
        Situation = 4 { key: "situation", words: "situation loaded" }
    }
}

impl RestartCause {
    /// The one recorded as `cause`, if it is one.
    pub fn from_u64(cause: u64) -> Option<Self> {
        Self::ALL.iter().copied().find(|&known| known as u64 == cause)
    }
}

/// A state that takes the place of the one that was flown, before the step of its tick: the aircraft is
/// somewhere else, time goes on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RestartRecord {
    /// Why: one of [`RestartCause`].
    pub cause: u64,
    /// The state; its tick is the one before the step.
    pub state: State,
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
    /// How far the clock was anchored anew before the tick, because it had stood still; 0 as a rule.
    pub slip_ns: u64,
    /// Device events of the tick with a time of the kernel's: hardware, not pilot models or scripts.
    pub stamped_events: u64,
    /// Those of them whose time cannot be: in the future, or from before the flight.
    pub implausible_events: u64,
}

/// Something that happened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EventRecord {
    /// When.
    pub tick: u64,
    /// What: one of [`FlightEvent`].
    pub kind: u64,
    /// Which one, how many, or which bits.
    pub value: u64,
    /// What was measured, as the kind of event says; 0 where it says nothing.
    pub measured: [f64; 2],
}

/// How grave an event is in `/log`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    /// Where its value is 0: nothing is left of it.
    pub at_zero: Level,
    /// Otherwise.
    pub otherwise: Level,
}

impl Levels {
    /// The same whatever the value.
    const fn always(level: Level) -> Self {
        Self { at_zero: level, otherwise: level }
    }

    /// Another one where the value is 0.
    const fn with_zero(at_zero: Level, otherwise: Level) -> Self {
        Self { at_zero, otherwise }
    }

    /// That of a value.
    pub const fn of(self, value: u64) -> Level {
        if value == 0 { self.at_zero } else { self.otherwise }
    }
}

/// What is told of a [`FlightEvent`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlightEventFacts {
    /// Its name; never changed.
    pub key: &'static str,
    /// What happened.
    pub description: &'static str,
    /// What the event's value is.
    pub value: &'static str,
    /// How grave it is.
    pub levels: Levels,
}

engine::enumeration! {
    /// What an [`EventRecord`] tells.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u64)]
    pub enum FlightEvent tells FlightEventFacts {
        /// The pilot pressed the marker.
        Marker = 1 {
            key: "marker", value: "its number", levels: Levels::always(Level::Info),
        }
        /// Something failed or was mended.
        Failures = 2 {
            key: "failures", value: "the failures now", levels: Levels::always(Level::Warn),
        }
        /// A device appeared.
        DeviceConnected = 3 {
            key: "device_connected", value: "its number", levels: Levels::always(Level::Info),
        }
        /// A device went away.
        DeviceDisconnected = 4 {
            key: "device_disconnected", value: "its number", levels: Levels::always(Level::Warn),
        }
        /// The model left its validity or came back.
        Validity = 5 {
            key: "validity", value: "the flags now", levels: Levels::with_zero(Level::Info, Level::Warn),
        }
        /// The simulation was paused or went on.
        Paused = 6 {
            key: "paused", value: "1 paused, 0 going on", levels: Levels::always(Level::Info),
        }
        /// The main wheels took weight or lost it; measured are sink and speed, m/s.
        WeightOnWheels = 7 {
            key: "weight_on_wheels", value: "1 touchdown, 0 lift-off", levels: Levels::always(Level::Info),
        }
        /// The flight was ended.
        Landed = 8 {
            key: "landed", value: "0 as planned, 1 by the crew, 2 by a signal, 3 a pilot gave up", levels: Levels::always(Level::Info),
        }
        /// A pilot model went on to its next phase.
        Phase = 9 {
            key: "phase", value: "its number", levels: Levels::always(Level::Info),
        }
        /// The flight, reflown while it went on, was not the same.
        SelfCheck = 10 {
            key: "self_check", value: "how many numbers of the state differ", levels: Levels::always(Level::Error),
        }
        /// The log's writer was held up.
        WriterHeldUp = 11 {
            key: "writer_held_up", value: "for how long, ms", levels: Levels::always(Level::Warn),
        }
        /// The clock was anchored anew, because the machine or the program had stood still.
        Slip = 12 {
            key: "slip", value: "by how long, ms", levels: Levels::always(Level::Warn),
        }
        /// The kernel lost events of a device.
        EventsLost = 13 {
            key: "events_lost", value: "the device's number", levels: Levels::always(Level::Warn),
        }
        /// The aircraft hit the ground harder than it is designed for; measured are sink and speed, m/s.
        Impact = 14 {
            key: "impact", value: "0 beyond the gear's design, 1 beyond its reserve, 2 the hull",
            levels: Levels::with_zero(Level::Warn, Level::Error),
        }
        /// The steady wind was set; measured are its speed, m/s, and whence it comes, deg.
        Wind = 15 {
            key: "wind", value: "1 wind, 0 calm", levels: Levels::always(Level::Info),
        }
        /// A gust begins; measured are its amplitude, m/s, and its duration, s.
        Gust = 16 {
            key: "gust", value: "the tick at which it begins", levels: Levels::always(Level::Info),
        }
        /// The turbulence was set; measured is its vertical intensity, m/s.
        Turbulence = 17 {
            key: "turbulence", value: "1 rough, 0 still air", levels: Levels::always(Level::Info),
        }
        /// The tanks are empty, and the engines stop.
        Fuel = 18 {
            key: "fuel", value: "the engines that go out by it, as failures have them",
            levels: Levels::always(Level::Warn),
        }
        /// A pilot model gave up its task.
        GaveUp = 19 {
            key: "gave_up", value: "number of the phase", levels: Levels::always(Level::Warn),
        }
        /// Another state took the place of the one that was flown.
        Restarted = 20 {
            key: "restarted", value: "1 reset to the start, 2 to a marker, 3 repositioned, 4 situation loaded",
            levels: Levels::always(Level::Info),
        }
        /// A situation was saved, to be loaded again.
        SituationSaved = 21 {
            key: "situation_saved", value: "its number in the flight, 0 when it could not be saved",
            levels: Levels::with_zero(Level::Warn, Level::Info),
        }
        /// An axis of the SCAS, or its pitch trim, came to the end of what it may add, or has room again.
        Saturation = 22 {
            key: "scas_saturation", value: "the axes now: bit 0 pitch, 1 roll, 2 yaw, 3 the pitch trim",
            levels: Levels::always(Level::Info),
        }
        /// Somebody else's computer took the actuators, or gave them back to the aircraft's own.
        InputLevel = 23 {
            key: "input_level", value: "1 commands from outside, 0 the aircraft's own computer",
            levels: Levels::with_zero(Level::Info, Level::Warn),
        }
    }
}

impl FlightEvent {
    /// The one recorded as `kind`, if it is one.
    pub fn from_u64(kind: u64) -> Option<Self> {
        Self::ALL.iter().copied().find(|&known| known as u64 == kind)
    }
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
