//! Reading a flight: a stream of ticks, every checksum validated before its bytes are used.

mod messages;
mod stream;

pub use messages::{Message, Messages};
use stream::{Channel, Item, Records};
pub(crate) use stream::{Definition, RECORD_BYTES_MAX};

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use engine::inputs::DeviceEvent;
use engine::{Outputs, State};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::compact::Open;
use crate::evolution::{Difference, Mappings};
use crate::records::{
    Chain, EVENTS, EventRecord, FORMAT_VERSION, FORMATS_READ, HARDWARE, INPUTS, InputsRecord,
    OUTPUTS, STATE, StateRecord, TIMING, TimingRecord, first_digest,
};
use crate::recover::Recovery;
use crate::seal::is_whole;
use crate::setup::{
    CLOSING, CLOSING_DIGEST, CLOSING_MESSAGES, CLOSING_TICK, Identity, METADATA, RATE_HZ, Setup,
};
use crate::view::{self, Remark};
use crate::{LogError, cdr};

/// One tick as recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Device events, in order.
    pub events: Vec<DeviceEvent>,
    /// The world.
    pub inputs: InputsRecord,
    /// The state after it, with its digest.
    pub record: StateRecord,
    /// The bytes of the state, as recorded.
    pub state_message: Vec<u8>,
    /// Whether the digest is the one that follows from the digest before and this tick's messages.
    pub chained: bool,
    /// The whole `/state` message, when its layout is not today's. What it lacks is 0 above, until
    /// [`FlightReader::fill`] knows better.
    pub foreign: Option<Vec<u8>>,
}

/// How the file ends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// As the writer ended it.
    Closed,
    /// Short of its end: the program was killed, or the file was cut.
    Truncated,
    /// Bytes that do not belong there, from which on nothing is read.
    Damaged(String),
}

/// A flight being read.
pub struct FlightReader {
    records: Records,
    /// Files the flight was flown with.
    pub setup: Setup,
    /// Who flew it.
    pub identity: Identity,
    /// Metadata records that are not known here: name, keys and values.
    pub other_facts: Vec<(String, BTreeMap<String, String>)>,
    /// The aircraft's shape for viewers, URDF.
    pub robot_description: String,
    /// State at the start.
    pub initial: State,
    /// Nothing is read after the state of this tick.
    pub until_tick: Option<u64>,
    /// Whether the files and the state at the start are those of the first digest.
    pub intact: bool,
    /// The same version of the flight model as this program's.
    pub same_model: bool,
    mappings: Mappings,
    first: Vec<u8>,
    chain: Chain,
    pending: Pending,
    /// Tick and digest of the last state read.
    last: (u64, u64),
    /// Whether every digest so far follows from the one before.
    unbroken: bool,
    /// The writer's last word.
    closing: Option<LastWord>,
    /// Events in the order they were recorded.
    pub happenings: Vec<EventRecord>,
    /// The same in words.
    pub remarks: Vec<Remark>,
    /// How the ticks kept time; cleared by whoever takes them.
    pub timings: Vec<TimingRecord>,
    /// What could be observed, if it is to be kept; cleared by whoever takes it.
    pub outputs: Vec<Outputs>,
    /// Whether `outputs` is to be kept: no flight depends on it.
    pub keep_outputs: bool,
    ending: Option<Ending>,
}

/// Messages of the tick under way.
#[derive(Default)]
struct Pending {
    events: Vec<DeviceEvent>,
    inputs: Option<InputsRecord>,
}

impl FlightReader {
    /// Opens a log and reads up to the state at the start.
    ///
    /// # Errors
    /// When the file cannot be read, is not MCAP, is not a flight of ours, or was flown by another
    /// version of the flight model; [`LogError::Compacted`] for a compacted log, which
    /// [`FlightReader::open_any`] reads as well.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        Self::open_across_versions(path)?.of_this_model()
    }

    /// Opens a log, compacted or not, and reads up to the state at the start. `open` makes the
    /// aircraft that flies what a compacted log leaves out.
    ///
    /// # Errors
    /// As for [`FlightReader::open`].
    pub fn open_any(path: &Path, open: Open) -> Result<Self, LogError> {
        Self::of(Records::open(path, Some(open))?)?.of_this_model()
    }

    /// Opens a log, whatever version of the flight model flew it. Its messages become today's structs
    /// by the names of their fields; [`FlightReader::differences`] says which ones did not.
    ///
    /// # Errors
    /// When the file cannot be read, is not MCAP, or is not a flight of ours; [`LogError::Compacted`]
    /// for a compacted log, whose states are this version's or nobody's.
    pub fn open_across_versions(path: &Path) -> Result<Self, LogError> {
        Self::of(Records::open(path, None)?)
    }

    fn of_this_model(self) -> Result<Self, LogError> {
        refuse_other_versions(&self.identity)?;
        Ok(self)
    }

    /// Reads a log from anywhere, up to the state at the start.
    ///
    /// # Errors
    /// When it is not MCAP, or not a flight of ours.
    pub fn read(source: impl Read + Send + 'static) -> Result<Self, LogError> {
        Self::of(Records::new(source))
    }

    /// Opens a log, compacted or not, of whatever version of the flight model. The states of a
    /// compacted one are then not those that were flown, but where [`FlightReader::is_recorded`].
    ///
    /// # Errors
    /// When the file cannot be read, is not MCAP, or is not a flight of ours.
    pub fn open_across(path: &Path, open: Open) -> Result<Self, LogError> {
        let mut records = Records::open(path, Some(open))?;
        if let Some(expander) = &mut records.expander {
            expander.across = true;
        }
        Self::of(records)
    }

    fn of(mut records: Records) -> Result<Self, LogError> {
        let mut robot_description = String::new();
        let mut setup = Setup::default();
        let mut found: Vec<&str> = Vec::new();
        let mut identity = None;
        let mut other_facts = Vec::new();
        // A tool that copied the log may have put the writer's last word first.
        let mut closing = None;
        loop {
            match records.next() {
                Some(Item::Metadata(name, facts)) if name == METADATA => {
                    let sealed =
                        facts.get(Identity::FORMAT).is_none_or(|format| format != UNSEALED);
                    if sealed && !is_whole(&facts) {
                        records.oddity("the metadata that says who flew is not as written");
                    }
                    identity = Some(Identity(facts));
                }
                Some(Item::Metadata(name, facts)) if name == CLOSING => {
                    closing = last_word(&facts);
                }
                Some(Item::Metadata(name, facts)) => other_facts.push((name, facts)),
                Some(Item::Attachment(name, data)) => {
                    let Some(known) = Setup::NAMES.iter().find(|known| **known == name) else {
                        continue;
                    };
                    let text = String::from_utf8(data)
                        .map_err(|_| LogError::NotAFlight(format!("{name} is not text")))?;
                    if let Some(file) = setup.file_mut(known) {
                        *file = text;
                        found.push(known);
                    }
                }
                Some(Item::Message(message)) if message.topic() == view::ROBOT_DESCRIPTION => {
                    robot_description = view::text(&message.data)?;
                }
                // Nothing would look at it again.
                Some(Item::Message(message)) if [HARDWARE, INPUTS].contains(&message.topic()) => {
                    let topic = message.topic();
                    return Err(LogError::Order(format!("{topic} before the first {STATE}")));
                }
                Some(Item::Message(message)) if message.topic() == STATE => {
                    let identity = identity.ok_or_else(|| no_flight("no `tiltrotor` metadata"))?;
                    if let Some(missing) = Setup::NAMES.iter().find(|name| !found.contains(name)) {
                        return Err(no_flight(&format!("{missing} is not in it")));
                    }
                    refuse_other_formats(&identity)?;
                    let mut mappings = Mappings::default();
                    let (layout, data) = (message.layout(), &message.data);
                    let first: StateRecord = mappings.decode(STATE, layout, data)?;
                    let digest = first_digest(&setup.files(), &without_digest(data));
                    return Ok(Self {
                        records,
                        setup,
                        same_model: identity.get(Identity::MODEL) == engine::MODEL_VERSION,
                        identity,
                        other_facts,
                        mappings,
                        first: message.data,
                        robot_description,
                        initial: first.state,
                        until_tick: None,
                        intact: digest == first.digest,
                        unbroken: digest == first.digest,
                        chain: Chain::from(first.digest),
                        pending: Pending::default(),
                        last: (first.state.tick, first.digest),
                        closing,
                        happenings: Vec::new(),
                        remarks: Vec::new(),
                        timings: Vec::new(),
                        keep_outputs: false,
                        outputs: Vec::new(),
                        ending: None,
                    });
                }
                Some(_) => {}
                None => {
                    if let Some(error) = records.refused.take() {
                        return Err(error);
                    }
                    return Err(match records.ending() {
                        Ending::Damaged(why) => LogError::NotAFlight(why),
                        _ if identity.is_some() => no_flight("it ends before the first state"),
                        _ => no_flight("no `tiltrotor` metadata"),
                    });
                }
            }
        }
    }

    /// The next whole tick; `None` at the end of what can be read.
    ///
    /// # Errors
    /// When the messages do not make a flight: out of order, missing, or of another layout.
    pub fn next_tick(&mut self) -> Result<Option<Tick>, LogError> {
        if self.until_tick.is_some_and(|until| self.last.0 >= until) {
            // As far as it was wanted, it is whole.
            self.ending = Some(Ending::Closed);
            return Ok(None);
        }
        loop {
            let Some(item) = self.records.next() else {
                self.ending = Some(self.end()?);
                return Ok(None);
            };
            let message = match item {
                Item::Message(message) => message,
                Item::Metadata(name, facts) if name == CLOSING => {
                    self.closing = last_word(&facts);
                    continue;
                }
                Item::Metadata(name, facts) => {
                    self.other_facts.push((name, facts));
                    continue;
                }
                Item::Attachment(..) => continue,
            };
            let (channel, data) = (message.channel, message.data);
            match channel.topic.as_str() {
                HARDWARE => {
                    self.chain.add(&data);
                    let event = self.decode(&channel, &data)?;
                    self.pending.events.push(event);
                }
                INPUTS => {
                    self.chain.add(&data);
                    let inputs: InputsRecord = self.decode(&channel, &data)?;
                    if self.pending.inputs.replace(inputs).is_some() {
                        return Err(LogError::Order(format!(
                            "two inputs before the state of tick {}",
                            inputs.tick.saturating_add(1)
                        )));
                    }
                }
                STATE => return self.close_tick(&channel, &data).map(Some),
                TIMING => {
                    let timing = self.decode(&channel, &data)?;
                    self.timings.push(timing);
                }
                EVENTS => {
                    let happening = self.decode(&channel, &data)?;
                    self.happenings.push(happening);
                }
                view::LOG => self.remarks.push(view::remark(&data)?),
                // No flight depends on it: one of another form is none.
                OUTPUTS if self.keep_outputs => {
                    let outputs: Option<Outputs> = self.decode(&channel, &data).ok();
                    self.outputs.extend(outputs);
                }
                _ => {}
            }
        }
    }

    /// How the file ends, now that nothing more can be read.
    fn end(&self) -> Result<Ending, LogError> {
        let ending = self.records.ending();
        let begun = self.pending.inputs.is_some() || !self.pending.events.is_empty();
        if ending == Ending::Closed && begun {
            return Err(LogError::Order("the last tick has no state".into()));
        }
        if matches!(ending, Ending::Damaged(_)) {
            return Ok(ending);
        }
        if let Some(oddity) = &self.records.oddity {
            return Ok(Ending::Damaged(oddity.clone()));
        }
        // An end without the writer's last word was put there by someone else.
        let Some(closing) = self.closing.filter(|_| ending == Ending::Closed) else {
            return Ok(Ending::Truncated);
        };
        let sealed = self.identity.get(Identity::FORMAT) != UNSEALED;
        if closing.last != self.last || sealed && closing.messages.is_none() {
            return Ok(Ending::Truncated);
        }
        // When the chain says that the flight is what was flown, it is something beside it. What a
        // compacted log says is guarded by a hash of its own, and what it does not say is made again.
        let all_read = self.unbroken && !self.records.sought && !self.is_compacted();
        if sealed && all_read && closing.messages != Some(self.records.roll_call.digest()) {
            return Ok(Ending::Damaged(
                "a message beside the flight itself (timing, events, viewers' channels, what any is \
                 called, its order or time) is not as written, though every checksum is right: a tool that \
                 repairs logs may have done this"
                    .into(),
            ));
        }
        // A recovered log is a proper file, and still not the whole flight.
        Ok(if self.recovered_from().is_some() { Ending::Truncated } else { Ending::Closed })
    }

    fn close_tick(&mut self, channel: &Channel, data: &[u8]) -> Result<Tick, LogError> {
        let record: StateRecord = self.decode(channel, data)?;
        let tick = record.state.tick;
        let events = std::mem::take(&mut self.pending.events);
        let inputs = self
            .pending
            .inputs
            .take()
            .ok_or_else(|| LogError::Order(format!("tick {tick} has no inputs")))?;
        if events.len() as u64 != inputs.events {
            return Err(LogError::Order(format!(
                "tick {tick}: expected {} device events, got {}",
                inputs.events,
                events.len()
            )));
        }
        let raw = without_digest(data);
        let chained = self.chain.close(&raw) == record.digest;
        self.unbroken &= chained;
        // From a break on, the chain goes on from what is recorded: one break is told once.
        self.chain = Chain::from(record.digest);
        self.last = (tick, record.digest);
        let (state_message, foreign) = if self.mappings.same_state() {
            (raw, None)
        } else {
            (cdr::encode(&record.state)?, Some(data.to_vec()))
        };
        Ok(Tick { events, inputs, record, state_message, chained, foreign })
    }

    /// Whether the log's states have the fields that states have today.
    pub fn has_todays_state(&self) -> bool {
        self.mappings.same_state()
    }

    /// The state at the start, with what the log does not say of it taken from `otherwise`.
    ///
    /// # Errors
    /// When the message is not of the log's layout.
    pub fn initial_over(&self, otherwise: &State) -> Result<State, LogError> {
        self.mappings.state_over(&self.first, otherwise)
    }

    /// Takes what a state of another layout lacks from `otherwise`, so that it differs from that state
    /// only where both know the field.
    ///
    /// # Errors
    /// When the message is not of the log's layout.
    pub fn fill(&self, tick: &mut Tick, otherwise: &State) -> Result<(), LogError> {
        if let Some(message) = &tick.foreign {
            tick.record.state = self.mappings.state_over(message, otherwise)?;
            tick.state_message = cdr::encode(&tick.record.state)?;
        }
        Ok(())
    }

    fn decode<T>(&mut self, channel: &Channel, message: &[u8]) -> Result<T, LogError>
    where
        T: Serialize + DeserializeOwned + Default,
    {
        self.mappings.decode(&channel.topic, channel.layout.as_deref(), message)
    }

    /// Where the log's layout is not today's, channel by channel.
    ///
    /// # Errors
    /// Never, for the structs that are recorded.
    pub fn differences(&self) -> Result<Vec<(&'static str, Difference)>, LogError> {
        self.mappings.differences()
    }

    /// Begins at the recorded state of a tick, found by the log's index where it has one.
    ///
    /// # Errors
    /// [`LogError::Outside`], or what is wrong with the log up to there.
    pub fn seek(&mut self, tick: u64) -> Result<(), LogError> {
        let first = self.initial.tick;
        if tick == self.last.0 {
            return Ok(());
        }
        if tick < self.last.0 {
            return Err(LogError::Outside { tick, first, last: self.last_tick() });
        }
        self.records.seek(tick)?;
        self.pending = Pending::default();
        loop {
            match self.records.next() {
                Some(Item::Message(message)) if message.topic() == STATE => {
                    let Message { channel, data, .. } = message;
                    // Of all the states that are passed by, only the tick is looked at.
                    let found = self.mappings.tick_of(&data).unwrap_or(0);
                    if found > tick {
                        return Err(LogError::Order(format!("tick {tick} is not there")));
                    }
                    self.last.0 = found;
                    if found == tick {
                        let record: StateRecord = self.decode(&channel, &data)?;
                        self.first = data;
                        self.initial = record.state;
                        self.chain = Chain::from(record.digest);
                        self.last = (tick, record.digest);
                        return Ok(());
                    }
                }
                Some(Item::Metadata(name, facts)) if name == CLOSING => {
                    self.closing = last_word(&facts);
                }
                Some(_) => {}
                None => {
                    return Err(match self.records.ending() {
                        Ending::Damaged(why) => LogError::Order(format!("damaged: {why}")),
                        _ => LogError::Outside { tick, first, last: self.last_tick() },
                    });
                }
            }
        }
    }

    /// The last tick as the writer closed the log, or as far as it was read.
    pub fn last_tick(&self) -> u64 {
        self.closing.map_or(self.last.0, |closing| closing.last.0.max(self.last.0))
    }

    /// Digest of the state that was read last; at first, of the state at the start.
    pub fn digest(&self) -> u64 {
        self.last.1
    }

    /// Whether the last state is as it was recorded. In a compacted log, states between keyframes are
    /// flown again.
    pub fn is_recorded(&self) -> bool {
        self.records.expander.as_ref().is_none_or(|expander| expander.recorded)
    }

    /// In a compacted log, the last tick as it was flown again while reading.
    pub fn flown(&self) -> Option<(&State, &Outputs)> {
        self.records.expander.as_ref()?.flown()
    }

    /// Whether the log is compacted.
    pub fn is_compacted(&self) -> bool {
        self.records.expander.is_some()
    }

    /// What no checksum found and is not as written, so far.
    pub fn oddity(&self) -> Option<&str> {
        self.records.oddity.as_deref()
    }

    /// The file that this log was recovered from, if it was.
    pub fn recovered_from(&self) -> Option<&str> {
        self.identity.0.get(Recovery::PARENT).map(String::as_str)
    }

    /// Lets go of what was read beside the ticks: for whoever reads on and on and does not ask for it.
    pub fn forget(&mut self) {
        self.timings.clear();
        self.happenings.clear();
        self.remarks.clear();
    }

    /// How the file ends, once the last tick has been read.
    pub fn ending(&self) -> Option<&Ending> {
        self.ending.as_ref()
    }
}

/// A `/state` message without its digest, which comes first.
fn without_digest(data: &[u8]) -> Vec<u8> {
    let mut state = cdr::HEADER.to_vec();
    state.extend_from_slice(data.get(cdr::HEADER.len() + size_of::<u64>()..).unwrap_or_default());
    state
}

fn no_flight(why: &str) -> LogError {
    LogError::NotAFlight(format!("an MCAP file, but not a tiltrotor flight: {why}"))
}

/// With what the writer closed the log.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LastWord {
    /// Tick and digest of the last state.
    pub last: (u64, u64),
    /// Roll call of all messages; `None` without a seal.
    messages: Option<u64>,
}

/// The log format that knew no seals.
const UNSEALED: &str = "1";

pub(crate) fn last_word(facts: &BTreeMap<String, String>) -> Option<LastWord> {
    let number = |key| facts.get(key).and_then(|text| text.parse().ok());
    let last = number(CLOSING_TICK).zip(number(CLOSING_DIGEST))?;
    Some(LastWord { last, messages: number(CLOSING_MESSAGES).filter(|_| is_whole(facts)) })
}

pub(crate) fn refuse_other_versions(identity: &Identity) -> Result<(), LogError> {
    refuse_other_formats(identity)?;
    let theirs = identity.get(Identity::MODEL);
    if theirs == engine::MODEL_VERSION {
        return Ok(());
    }
    Err(LogError::Version {
        what: "flight model",
        theirs: theirs.into(),
        ours: engine::MODEL_VERSION,
    })
}

fn refuse_other_formats(identity: &Identity) -> Result<(), LogError> {
    let known = [
        (Identity::FORMAT, "log format", FORMAT_VERSION, &FORMATS_READ[..]),
        (Identity::RATE, "number of ticks a second", RATE_HZ, &[RATE_HZ]),
    ];
    for (key, what, ours, read) in known {
        let theirs = identity.get(key);
        if !read.contains(&theirs) {
            return Err(LogError::Version { what, theirs: theirs.into(), ours });
        }
    }
    Ok(())
}
