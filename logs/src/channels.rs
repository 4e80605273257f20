//! The channels of a flight log: one table. Writer, schemas, reader, compaction and export go by it.
//!
//! A new channel that viewers draw is one line here and a function that makes its message of the
//! outputs. One that holds a struct of numbers needs that struct, and whoever calls
//! [`FlightWriter`](crate::FlightWriter) with it.

use std::sync::OnceLock;

use engine::Outputs;
use engine::frames::Attitude;
use engine::inputs::DeviceEvent;

use crate::cdr::append_view;
use crate::devices;
use crate::records::{
    DEVICES, EVENTS, EventRecord, HARDWARE, INPUTS, InputsRecord, OUTPUTS, RESTART, RestartRecord,
    STATE, StateRecord, TIMING, TimingRecord,
};
use crate::schema::{MessageType, Types, numbers};
use crate::view::{self, Shape};
use crate::{LogError, cdr};

/// A channel.
#[derive(Debug)]
pub struct Channel {
    /// Which.
    pub id: ChannelId,
    /// Its name in the file.
    pub topic: &'static str,
    /// When it gets a message.
    pub written: Written,
    describe: fn(&mut Types) -> Result<MessageType, LogError>,
    /// Fields without which a message of it is none.
    pub(crate) needed: &'static [&'static str],
    pub(crate) chain: Chain,
    pub(crate) compacted: Compacted,
}

/// When a channel gets a message.
#[derive(Clone, Copy, Debug)]
pub enum Written {
    /// Before the first tick.
    Once,
    /// When something happens.
    OnEvent,
    /// Every tick.
    EveryTick,
    /// Every so many ticks, made of the outputs.
    FromOutputs {
        /// How many.
        ticks: u64,
        /// Appends the message.
        message: fn(&mut Vec<u8>, &Outputs, Attitude, &Shape) -> Result<(), LogError>,
    },
}

/// What a channel is to the chain of digests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Chain {
    /// Not part of it.
    Outside,
    /// A message that the tick's step uses.
    Adds,
    /// The message that ends the tick.
    Closes,
}

/// What compaction makes of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Compacted {
    /// It stands as it is.
    Kept,
    /// Rows of numbers; the first of each is the tick.
    Rows,
    /// Left out: the state is flown again.
    Reflown,
    /// Left out: made again of the outputs.
    Remade,
}

const fn every(
    ticks: u64,
    message: fn(&mut Vec<u8>, &Outputs, Attitude, &Shape) -> Result<(), LogError>,
) -> Written {
    Written::FromOutputs { ticks, message }
}

macro_rules! channels {
    ($($(#[$doc:meta])* $id:ident $topic:expr, $describe:expr, $needed:expr, $written:expr, $chain:ident, $compacted:ident;)+) => {
        /// Which channel: its place in [`CHANNELS`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum ChannelId { $($(#[$doc])* $id),+ }

        /// How many channels there are.
        pub(crate) const COUNT: usize = [$(ChannelId::$id),+].len();

        /// Every channel of a flight log. A compacted log counts those of a kind in this order: a new
        /// one comes last.
        pub static CHANNELS: [Channel; COUNT] = [$(Channel {
            id: ChannelId::$id,
            topic: $topic,
            describe: $describe,
            needed: $needed,
            written: $written,
            chain: Chain::$chain,
            compacted: Compacted::$compacted,
        }),+];
    };
}

use Written::{EveryTick, OnEvent, Once};

channels! {
    /// Raw device events.
    Hardware HARDWARE, numbers::<DeviceEvent>, &["tick", "device", "kind", "code", "value"], OnEvent, Adds, Rows;
    /// The world.
    Inputs INPUTS, numbers::<InputsRecord>, &["tick", "events"], EveryTick, Adds, Rows;
    /// The state.
    State STATE, numbers::<StateRecord>, &["digest", "state.tick"], EveryTick, Closes, Reflown;
    /// How ticks kept time.
    Timing TIMING, numbers::<TimingRecord>, &[], EveryTick, Outside, Rows;
    /// What happened.
    Events EVENTS, numbers::<EventRecord>, &[], OnEvent, Outside, Kept;
    /// What could be observed.
    Outputs OUTPUTS, numbers::<engine::Outputs>, &[], every(10, |to, o, _, _| cdr::append(to, o)), Outside, Remade;
    /// Frames of the aircraft and its parts.
    Tf view::TF, |_| Ok(view::TF_TYPE.into()), &[], every(5, |to, o, at, shape| append_view(to, &view::frames(o, at, shape))), Outside, Remade;
    /// Where the pilot holds everything.
    Joy view::JOY, |_| Ok(view::JOY_TYPE.into()), &[], every(5, |to, o, _, _| append_view(to, &view::joy(o))), Outside, Remade;
    /// Nacelles, surfaces and gear.
    JointStates view::JOINT_STATES, |_| Ok(view::JOINT_TYPE.into()), &[], every(5, |to, o, _, _| append_view(to, &view::joint_states(o))), Outside, Remade;
    /// Where on earth.
    Fix view::FIX, |_| Ok(view::FIX_TYPE.into()), &[], every(50, |to, o, _, _| append_view(to, &view::fix(o))), Outside, Remade;
    /// Events in words.
    Log view::LOG, |_| Ok(view::LOG_TYPE.into()), &[], OnEvent, Outside, Kept;
    /// The aircraft's shape.
    RobotDescription view::ROBOT_DESCRIPTION, |_| Ok(view::STRING_TYPE.into()), &[], Once, Outside, Kept;
    /// Input devices: which, and what they call themselves.
    Devices DEVICES, |_| Ok(devices::TYPE.into()), &[], OnEvent, Outside, Kept;
    /// States that took the place of the one that was flown.
    Restart RESTART, numbers::<RestartRecord>, &["cause", "state.tick"], OnEvent, Adds, Kept;
}

impl From<ChannelId> for &'static Channel {
    fn from(id: ChannelId) -> Self {
        &CHANNELS[id as usize]
    }
}

impl Channel {
    /// The channel of that name, if it is one of ours.
    pub fn of(topic: &str) -> Option<&'static Self> {
        CHANNELS.iter().find(|channel| channel.topic == topic)
    }

    /// Its message type.
    ///
    /// # Errors
    /// When a struct is not recordable.
    pub fn message_type(&self) -> Result<&'static MessageType, LogError> {
        Ok(&message_types()?[self.id as usize])
    }

    /// Its number among those that are compacted alike.
    pub(crate) fn number(&self) -> usize {
        let before = &CHANNELS[..self.id as usize];
        before.iter().filter(|channel| channel.compacted == self.compacted).count()
    }
}

/// The channels that are compacted in this way, in the order of their numbers.
pub(crate) fn compacted(how: Compacted) -> impl Iterator<Item = &'static Channel> {
    CHANNELS.iter().filter(move |channel| channel.compacted == how)
}

/// Every channel's message type, made once.
fn message_types() -> Result<&'static [MessageType], LogError> {
    static ALL: OnceLock<Vec<MessageType>> = OnceLock::new();
    if let Some(all) = ALL.get() {
        return Ok(all);
    }
    // Of all channels together: a name means one type in the whole file.
    let mut types = Types::default();
    let all = CHANNELS.iter().map(|channel| (channel.describe)(&mut types));
    let all = all.collect::<Result<_, _>>()?;
    Ok(ALL.get_or_init(|| all))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn a_channel_stands_at_the_place_of_its_number() {
        for (place, channel) in CHANNELS.iter().enumerate() {
            assert_eq!(channel.id as usize, place, "{}", channel.topic);
            assert!(std::ptr::eq(Channel::of(channel.topic).unwrap(), channel));
        }
    }

    #[test]
    fn a_type_name_has_one_definition_in_the_whole_file() {
        let mut known: BTreeMap<String, (&str, String)> = BTreeMap::new();
        for channel in &CHANNELS {
            let MessageType { name, text, .. } = channel.message_type().unwrap();
            let own = name.replacen("/msg/", "/", 1);
            let mut parts = vec![(own, String::new())];
            for line in text.lines().filter(|line| !line.starts_with('=')) {
                match line.strip_prefix("MSG: ") {
                    Some(name) => parts.push((name.into(), String::new())),
                    None => parts.last_mut().unwrap().1.extend([line, "\n"]),
                }
            }
            for (name, body) in parts {
                let (topic, first) =
                    known.entry(name.clone()).or_insert_with(|| (channel.topic, body.clone()));
                assert_eq!(*first, body, "{name} of {} and {topic}", channel.topic);
            }
        }
    }
}
