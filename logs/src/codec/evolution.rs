//! Logs of other versions: their messages as today's structs, by the names of the fields.
//!
//! A field that the log lacks takes a value that the caller names; one that nobody knows today is left
//! alone. Both are told. Whether the flight can be flown again to the same bits is another question,
//! and `engine::MODEL_VERSION` answers it.

use std::collections::{BTreeMap, BTreeSet};

use engine::State;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::channels::{CHANNELS, COUNT, Channel, ChannelId};
use crate::layout::{Layout, Number};
use crate::records::StateRecord;
use crate::{LogError, cdr};

/// Parts of the state that were called something else: as a log may name them, and as they are called today.
const RENAMED: &[(&str, &str)] = &[("plant.treads.", "plant.tyre_deflections.")];

/// Numbers that are several today, and were one: under each wheel, and under the aircraft.
const WERE_ONE: &[&str] = &["world.ground_height_m"];

/// The name of the one number that several of today were.
fn was_part_of(path: &str) -> Option<&str> {
    let one = |was: &&&str| path.strip_prefix(**was).is_some_and(|part| part.starts_with('.'));
    WERE_ONE.iter().find(one).copied()
}

/// Today's name of a number of a log.
fn todays_name(path: &str) -> String {
    let (of, bare) = path.strip_prefix("state.").map_or(("", path), |bare| ("state.", bare));
    for (old, new) in RENAMED {
        if let Some(rest) = bare.strip_prefix(old) {
            return format!("{of}{new}{rest}");
        }
    }
    path.to_owned()
}

/// A log's layout by today's names.
pub(crate) fn by_todays_names(theirs: &Layout) -> Layout {
    theirs.renamed(todays_name)
}

/// How messages of a log's layout become today's struct: by the names of the fields.
#[derive(Clone, Debug)]
pub struct Mapping {
    theirs: Layout,
    /// For each of today's numbers, where it stands in the log's messages.
    sources: Vec<Option<usize>>,
    same: bool,
    /// What the two layouts do not have in common.
    pub difference: Difference,
}

impl Mapping {
    /// From a log's layout to the struct `T`.
    ///
    /// # Errors
    /// When the struct is not recordable.
    pub fn to<T: Serialize + Default>(theirs: &Layout) -> Result<Self, LogError> {
        let ours = Layout::of::<T>()?;
        let theirs = by_todays_names(theirs);
        let places: BTreeMap<_, _> =
            theirs.numbers().iter().enumerate().map(|(i, n)| (n.path.as_str(), i)).collect();
        let source = |number: &Number| {
            let once = was_part_of(&number.path);
            let place = places.get(number.path.as_str()).or_else(|| places.get(once?)).copied()?;
            // A name whose type has changed means something else.
            (theirs.numbers()[place].kind == number.kind).then_some(place)
        };
        let sources: Vec<_> = ours.numbers().iter().map(source).collect();
        let path = |number: &Number| number.path.clone();
        let missing = ours.numbers().iter().zip(&sources).filter(|(_, source)| source.is_none());
        let used: BTreeSet<_> = sources.iter().flatten().collect();
        let ignored = theirs.numbers().iter().enumerate().filter(|(i, _)| !used.contains(i));
        let difference = Difference {
            missing: missing.map(|(number, _)| path(number)).collect(),
            ignored: ignored.map(|(_, number)| path(number)).collect(),
        };
        Ok(Self { same: ours == theirs, theirs, sources, difference })
    }

    /// Whether the log's layout is today's.
    pub fn is_same(&self) -> bool {
        self.same
    }

    /// Today's struct; what the log does not have is taken from `otherwise`.
    ///
    /// # Errors
    /// When the message is not of the log's layout.
    pub fn decode<T: Serialize + DeserializeOwned>(
        &self,
        message: &[u8],
        otherwise: &T,
    ) -> Result<T, LogError> {
        if self.same {
            return cdr::decode(message);
        }
        let theirs: Vec<u64> = self.theirs.bits(message)?.collect();
        let mut ours = cdr::encode(otherwise)?;
        let (words, _) = ours[cdr::HEADER.len()..].as_chunks_mut::<8>();
        for (word, source) in words.iter_mut().zip(&self.sources) {
            if let Some(source) = source {
                *word = theirs[*source].to_le_bytes();
            }
        }
        cdr::decode(&ours)
    }

    /// One of today's numbers, by its place, out of a message of the log.
    fn word(&self, message: &[u8], place: usize) -> Option<u64> {
        cdr::word(message, self.sources.get(place).copied().flatten()?)
    }
}

/// What a channel of a log and today's struct do not have in common. A field whose type has changed is
/// in both lists.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    /// Fields that the log lacks.
    pub missing: Vec<String>,
    /// Fields of the log that nobody knows today.
    pub ignored: Vec<String>,
}

/// The channels of a log whose layout is not today's, each with its mapping once a message came.
#[derive(Debug, Default)]
pub(crate) struct Mappings([Option<Mapping>; COUNT]);

impl Mappings {
    /// A message of a channel as today's struct; what the log lacks is 0. Without a layout it is taken
    /// for today's: the length will tell.
    pub fn decode<T>(
        &mut self,
        channel: &Channel,
        layout: Option<&Layout>,
        message: &[u8],
    ) -> Result<T, LogError>
    where
        T: Serialize + DeserializeOwned + Default,
    {
        let Some(layout) = layout else { return cdr::decode(message) };
        let slot = &mut self.0[channel.id as usize];
        let mapping = match slot {
            Some(mapping) => mapping,
            None => {
                let mapping = Mapping::to::<T>(layout)?;
                let lacking = &mapping.difference.missing;
                let topic = channel.topic;
                if let Some(name) =
                    channel.needed.iter().find(|name| lacking.iter().any(|l| l == *name))
                {
                    return Err(LogError::Decode(format!("{topic} has no `{name}`")));
                }
                if channel.id == ChannelId::State && !layout.is_of_state() {
                    return Err(LogError::Decode(format!("{topic} is not a digest and a state")));
                }
                slot.insert(mapping)
            }
        };
        mapping.decode(message, &T::default())
    }

    fn of_state(&self) -> Option<&Mapping> {
        self.0[ChannelId::State as usize].as_ref()
    }

    /// The state of a `/state` message, with what the log lacks from `otherwise`.
    pub fn state_over(&self, message: &[u8], otherwise: &State) -> Result<State, LogError> {
        let record = StateRecord { digest: 0, state: *otherwise };
        match self.of_state() {
            Some(mapping) => Ok(mapping.decode(message, &record)?.state),
            None => Ok(cdr::decode::<StateRecord>(message)?.state),
        }
    }

    /// The tick of a `/state` message, without a look at the rest.
    pub fn tick_of(&self, message: &[u8]) -> Option<u64> {
        match self.of_state() {
            Some(mapping) => mapping.word(message, StateRecord::TICK),
            None => cdr::word(message, StateRecord::TICK),
        }
    }

    /// Whether the log's states have today's layout.
    pub fn same_state(&self) -> bool {
        self.of_state().is_none_or(Mapping::is_same)
    }

    /// Where the log's layout is not today's; fields of the state are called as in a bare state.
    pub fn differences(&self) -> Vec<(&'static str, Difference)> {
        let bare = |paths: &[String]| {
            let bare = |path: &String| path.strip_prefix("state.").unwrap_or(path).to_string();
            paths.iter().map(bare).collect()
        };
        let mapped = CHANNELS.iter().zip(&self.0);
        mapped
            .filter_map(|(channel, mapping)| {
                let Difference { missing, ignored } =
                    &mapping.as_ref().filter(|mapping| !mapping.is_same())?.difference;
                let told = Difference { missing: bare(missing), ignored: bare(ignored) };
                Some((channel.topic, told))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::inputs::DeviceEvent;

    #[test]
    fn a_log_that_calls_a_part_of_the_state_by_its_old_name_has_todays_layout() {
        for (old, new) in RENAMED {
            let mut renamed = 0;
            let theirs = Layout::of::<StateRecord>().unwrap().renamed(|path| {
                renamed += usize::from(path.contains(new));
                path.replace(new, old)
            });
            assert!(renamed > 0, "{new}: no part of the state");
            assert!(Mapping::to::<StateRecord>(&theirs).unwrap().is_same(), "{old}");
        }
    }

    #[test]
    fn an_older_event_is_read_by_the_names_of_its_fields() {
        // Without `kernel_time_ns`, in another order, `value` of another type, one field more.
        let theirs = "uint64 code\nuint64 device\nfloat64 force_n\nuint64 tick\nfloat64 value\n";
        let mapping = Mapping::to::<DeviceEvent>(&Layout::parse(theirs).unwrap()).unwrap();
        let mut message = cdr::HEADER.to_vec();
        for number in [30_u64, 2, 0, 77, 5] {
            message.extend_from_slice(&number.to_le_bytes());
        }
        let otherwise = DeviceEvent { kind: 9, value: -4, ..DeviceEvent::default() };
        let event = mapping.decode(&message, &otherwise).unwrap();
        assert_eq!(event, DeviceEvent { tick: 77, device: 2, code: 30, ..otherwise });
        let difference = &mapping.difference;
        assert_eq!(difference.missing, ["kernel_time_ns", "kind", "value", "raw_min", "raw_max"]);
        assert_eq!(difference.ignored, ["force_n", "value"]);
        assert!(mapping.decode(&message[..20], &otherwise).is_err());
    }
}
