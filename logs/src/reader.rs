//! Reading a flight: a stream of ticks, every checksum validated before its bytes are used.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use engine::inputs::DeviceEvent;
use engine::{Outputs, State};
use mcap::McapError;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::compact::Open;
use crate::compact::expander::Expander;
use crate::evolution::{Difference, Mappings};
use crate::fields::Field;
use crate::index::Index;
use crate::layout::Layout;
use crate::raw::{Raw, parse_record};
use crate::records::{
    Chain, EVENTS, EventRecord, FORMAT_VERSION, FORMATS_READ, HARDWARE, INPUTS, InputsRecord,
    OUTPUTS, STATE, StateRecord, TIMING, TimingRecord, first_digest,
};
use crate::recover::Recovery;
use crate::seal::{RollCall, Stamp, is_whole};
use crate::setup::{
    CLOSING, CLOSING_DIGEST, CLOSING_MESSAGES, CLOSING_TICK, Identity, METADATA, RATE_HZ, Setup,
};
use crate::view::{self, Remark};
use crate::{LogError, cdr, schema};

/// Bytes asked for at a time.
const BUFFER_BYTES: usize = 256 * 1024;
/// No record of a flight is larger than this; a length beyond it is damage, not data.
pub(crate) const RECORD_BYTES_MAX: usize = 4 << 20;

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
        // When the chain says that the flight is what was flown, it is something beside it.
        let all_read = self.unbroken && !self.records.sought;
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
        self.mappings.decode(&channel.topic, channel.layout.as_ref(), message)
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
    fn last_tick(&self) -> u64 {
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

/// So many ticks after a state, viewers' messages of its tick are written, too.
const PAST_TICKS: u64 = 2500;

/// Every message of a log as it stands there, whatever its channel.
pub struct Messages {
    records: Records,
    facts: Vec<(String, BTreeMap<String, String>)>,
    files: Vec<(String, Vec<u8>)>,
    from_tick: u64,
    until_tick: u64,
}

/// One message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    channel: Arc<Channel>,
    /// Time since the start of the flight, ns.
    pub time_ns: u64,
    /// Its bytes.
    pub data: Vec<u8>,
    /// What it carries beside them.
    pub(crate) stamp: Stamp,
}

impl Messages {
    /// Opens a log.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        Ok(Self::of(Records::open(path, None)?))
    }

    /// Opens a log, compacted or not.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open_any(path: &Path, open: Open) -> Result<Self, LogError> {
        Ok(Self::of(Records::open(path, Some(open))?))
    }

    fn of(records: Records) -> Self {
        let (facts, files) = (Vec::new(), Vec::new());
        Self { records, facts, files, from_tick: 0, until_tick: u64::MAX }
    }

    /// The metadata records that came so far: name, keys and values.
    pub fn facts(&self) -> &[(String, BTreeMap<String, String>)] {
        &self.facts
    }

    /// The attachments that came so far: name and bytes.
    pub fn files(&self) -> &[(String, Vec<u8>)] {
        &self.files
    }

    /// Only the messages from one tick to another; those before are not read where the log's index
    /// says where they are.
    ///
    /// # Errors
    /// When the log cannot be read.
    pub fn limit(&mut self, from_tick: u64, until_tick: u64) -> Result<(), LogError> {
        (self.from_tick, self.until_tick) = (from_tick, until_tick);
        // The channels are defined before the first message.
        while self.records.channels.is_empty() && self.records.next().is_some() {}
        if from_tick > 0 { self.records.seek(from_tick) } else { Ok(()) }
    }

    /// How the file ends, once the last message has been read.
    pub fn ending(&self) -> Ending {
        match self.records.ending() {
            // An end without the writer's last word was put there by someone else.
            Ending::Closed if self.facts.iter().all(|(name, _)| name != CLOSING) => {
                Ending::Truncated
            }
            ending => ending,
        }
    }
}

impl Iterator for Messages {
    type Item = Message;

    fn next(&mut self) -> Option<Message> {
        loop {
            match self.records.next()? {
                Item::Message(message) => {
                    let tick = message.time_ns / engine::STEP_NS;
                    // What viewers draw is written after the states, but not ten seconds after.
                    if tick > self.until_tick.saturating_add(PAST_TICKS) {
                        return None;
                    }
                    if (self.from_tick..=self.until_tick).contains(&tick) {
                        return Some(message);
                    }
                }
                Item::Metadata(name, facts) => self.facts.push((name, facts)),
                Item::Attachment(name, data) => self.files.push((name, data)),
            }
        }
    }
}

impl Message {
    /// Its channel's name.
    pub fn topic(&self) -> &str {
        &self.channel.topic
    }

    /// What its numbers are called, by the log's own schema; `None` on channels for viewers.
    pub fn layout(&self) -> Option<&Layout> {
        self.channel.layout.as_ref()
    }

    /// The numbers of a recorded struct, by the log's own schema; `None` on channels for viewers.
    ///
    /// # Errors
    /// When the bytes are not what the channel holds.
    pub fn fields(&self) -> Option<Result<Vec<Field>, LogError>> {
        self.layout().map(|layout| layout.fields(&self.data))
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

/// A record that matters.
enum Item {
    Metadata(String, BTreeMap<String, String>),
    Attachment(String, Vec<u8>),
    Message(Message),
}

/// A channel of the file.
#[derive(Debug, PartialEq, Eq)]
struct Channel {
    topic: String,
    /// `None` when its messages are no recorded struct.
    layout: Option<Layout>,
    definition: Arc<Definition>,
}

/// What a channel's messages are, as the log says it.
#[derive(Debug, Default, PartialEq, Eq)]
struct Definition {
    name: String,
    encoding: String,
    text: Vec<u8>,
}

/// The parts of a file, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Start,
    Data,
    Index,
    Footer,
}

/// Records of the file, up to its end or the first damage.
struct Records {
    /// Where it is, if it is a file.
    path: Option<PathBuf>,
    source: BufReader<Box<dyn Read + Send>>,
    reader: LinearReader,
    /// The last bytes that were read.
    tail: Vec<u8>,
    part: Part,
    definitions: BTreeMap<u16, Arc<Definition>>,
    channels: BTreeMap<u16, Arc<Channel>>,
    roll_call: RollCall,
    /// The first thing that no checksum found and that is not as written.
    oddity: Option<String>,
    ending: Ending,
    /// Makes the records of a compacted log.
    expander: Option<Box<Expander>>,
    /// Reading went on somewhere else in the file.
    sought: bool,
    /// What is no damage: a log that is not for this program.
    refused: Option<LogError>,
}

impl Records {
    /// Opens a log; one that is compacted only if its states can be flown again.
    fn open(path: &Path, open: Option<Open>) -> Result<Self, LogError> {
        let file = File::open(path).map_err(LogError::Open)?;
        if file.metadata().map_err(LogError::Open)?.is_dir() {
            return Err(LogError::NotAFlight("a folder".into()));
        }
        let mut records = Self { path: Some(path.into()), ..Self::new(file) };
        let nobody: Open = |_| Err(LogError::Compacted);
        if let Some(expander) = Expander::open(path, open.unwrap_or(nobody), false)? {
            if open.is_none() {
                return Err(LogError::Compacted);
            }
            records.expander = Some(Box::new(expander));
        }
        Ok(records)
    }

    /// Goes where the state of a tick is not far ahead, if the log's index says where.
    fn seek(&mut self, tick: u64) -> Result<(), LogError> {
        self.sought = true;
        if let Some(expander) = &mut self.expander {
            return expander.seek(tick);
        }
        let Some(path) = &self.path else { return Ok(()) };
        let Some(index) = Index::read(path) else { return Ok(()) };
        let Some(place) = index.chunk_of(tick).filter(|&place| place > 0) else { return Ok(()) };
        let mut file = File::open(path).map_err(LogError::Open)?;
        file.seek(SeekFrom::Start(index.chunks[place].offset))?;
        self.source = BufReader::with_capacity(BUFFER_BYTES, Box::new(file));
        // Chunks keep their own checksums; that of the whole file cannot be looked at any more.
        let options = options().with_skip_start_magic(true).with_validate_data_section_crc(false);
        self.reader = LinearReader::new_with_options(options);
        self.part = Part::Data;
        Ok(())
    }

    fn new(source: impl Read + Send + 'static) -> Self {
        Self {
            path: None,
            source: BufReader::with_capacity(BUFFER_BYTES, Box::new(source)),
            reader: LinearReader::new_with_options(options()),
            tail: Vec::with_capacity(2 * mcap::MAGIC.len()),
            part: Part::Start,
            definitions: BTreeMap::new(),
            channels: BTreeMap::new(),
            roll_call: RollCall::default(),
            oddity: None,
            ending: Ending::Closed,
            expander: None,
            sought: false,
            refused: None,
        }
    }

    fn ending(&self) -> Ending {
        self.ending.clone()
    }

    fn oddity(&mut self, what: &str) {
        self.oddity.get_or_insert_with(|| what.to_string());
    }

    fn next(&mut self) -> Option<Item> {
        if self.ending != Ending::Closed {
            return None;
        }
        if self.expander.is_some() {
            return self.expanded();
        }
        match self.read() {
            Ok(item) => item,
            Err(McapError::BadMagic | McapError::UnexpectedEof) if self.part == Part::Start => {
                self.ending = Ending::Damaged("not an MCAP file".into());
                None
            }
            Err(McapError::UnexpectedEof) if self.tail != mcap::MAGIC => {
                self.ending = Ending::Truncated;
                None
            }
            Err(error) => {
                self.ending = Ending::Damaged(in_words(&error));
                None
            }
        }
    }

    /// The next record of a compacted log.
    fn expanded(&mut self) -> Option<Item> {
        loop {
            match self.expander.as_mut()?.next() {
                Ok(Some(Raw::Schema { id, name, encoding, data: text })) => {
                    self.definitions.insert(id, Arc::new(Definition { name, encoding, text }));
                }
                Ok(Some(Raw::Channel(channel))) => self.meet(channel),
                Ok(Some(Raw::Message(header, data))) => {
                    if let Some(channel) = self.channels.get(&header.channel_id).cloned() {
                        let stamp = Stamp {
                            sequence: header.sequence,
                            log_time_ns: header.log_time,
                            publish_time_ns: header.publish_time,
                        };
                        self.roll_call.add(&channel.topic, &channel.definition.text, stamp, &data);
                        let time_ns = header.log_time;
                        return Some(Item::Message(Message { channel, time_ns, data, stamp }));
                    }
                }
                Ok(Some(Raw::Metadata(record))) => {
                    return Some(Item::Metadata(record.name, record.metadata));
                }
                Ok(Some(Raw::Attachment(header, data))) => {
                    return Some(Item::Attachment(header.name, data));
                }
                Ok(Some(_)) => {}
                Ok(None) => return None,
                Err(LogError::Mcap(McapError::UnexpectedEof)) => {
                    self.ending = Ending::Truncated;
                    return None;
                }
                Err(error) => {
                    self.ending = Ending::Damaged(error.to_string());
                    if matches!(error, LogError::Version { .. } | LogError::Setup(_)) {
                        self.refused = Some(error);
                    }
                    return None;
                }
            }
        }
    }

    fn read(&mut self) -> Result<Option<Item>, McapError> {
        while let Some(event) = self.reader.next_event() {
            match event? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let room = self.reader.insert(wanted);
                    let read = self.source.read(room)?;
                    remember(&mut self.tail, &room[..read]);
                    self.reader.notify_read(read);
                }
                LinearReadEvent::Record { data, opcode } => {
                    let record = parse_record(opcode, data)?;
                    let part = part_of(&record, self.part);
                    if let Some(what) = misplaced(&record, part, self.part) {
                        self.ending = Ending::Damaged(what);
                        return Ok(None);
                    }
                    self.part = part;
                    match record {
                        Record::Schema { header, data } => {
                            let definition = Definition {
                                name: header.name,
                                encoding: header.encoding,
                                text: data.into_owned(),
                            };
                            self.definitions.insert(header.id, Arc::new(definition));
                        }
                        Record::Channel(channel) => self.meet(channel),
                        Record::Message { header, data } => {
                            let Some(channel) = self.channels.get(&header.channel_id).cloned()
                            else {
                                self.ending = Ending::Damaged(
                                    "a message on a channel that is not there".into(),
                                );
                                return Ok(None);
                            };
                            let stamp = Stamp {
                                sequence: header.sequence,
                                log_time_ns: header.log_time,
                                publish_time_ns: header.publish_time,
                            };
                            let definition = &channel.definition.text;
                            self.roll_call.add(&channel.topic, definition, stamp, &data);
                            return Ok(Some(Item::Message(Message {
                                channel,
                                time_ns: header.log_time,
                                data: data.into_owned(),
                                stamp,
                            })));
                        }
                        Record::Metadata(metadata) => {
                            return Ok(Some(Item::Metadata(metadata.name, metadata.metadata)));
                        }
                        Record::Attachment { header, data, .. } => {
                            return Ok(Some(Item::Attachment(header.name, data.into_owned())));
                        }
                        _ => {}
                    }
                }
            }
        }
        Ok(None)
    }

    /// Takes a channel's name, and looks whether it can hold what a channel of that name holds.
    fn meet(&mut self, channel: mcap::records::Channel) {
        let definition = self.definitions.get(&channel.schema_id).cloned().unwrap_or_default();
        let plain = |c: char| c.is_ascii_alphanumeric() || "/_-.".contains(c);
        let ours = definition.encoding == schema::ENCODING
            && definition.name.split('/').next() == Some(schema::PACKAGE)
            && channel.topic.chars().all(plain);
        let layout = std::str::from_utf8(&definition.text).ok().filter(|_| ours);
        let layout = layout.and_then(Layout::parse);
        let kinds = schema::kinds().unwrap_or_default();
        if let Some(kind) = kinds.iter().find(|kind| kind.topic == channel.topic) {
            // Its fields may be others than today's; what they are called has to be said.
            let named = layout.is_some() || Layout::parse(&kind.text).is_none();
            if !named || definition.name != kind.name || channel.message_encoding != cdr::ENCODING {
                self.oddity(&format!("the definition of {} is not as written", kind.topic));
            }
        }
        let known = Channel { topic: channel.topic, layout, definition };
        self.channels.insert(channel.id, Arc::new(known));
    }
}

/// Keeps the last bytes, as many as the magic number has.
fn remember(tail: &mut Vec<u8>, read: &[u8]) {
    let kept = mcap::MAGIC.len();
    tail.extend_from_slice(&read[read.len().saturating_sub(kept)..]);
    tail.drain(..tail.len().saturating_sub(kept));
}

/// The part of the file that a record is in, or begins.
fn part_of(record: &Record<'_>, now: Part) -> Part {
    match record {
        Record::Header(_) => Part::Data,
        Record::DataEnd(_) => Part::Index,
        Record::Footer(_) => Part::Footer,
        _ => now,
    }
}

/// What is wrong with a record's place, if anything.
fn misplaced(record: &Record<'_>, part: Part, before: Part) -> Option<String> {
    let repeated = match record {
        Record::Header(_) => before != Part::Start,
        Record::DataEnd(_) => before != Part::Data,
        Record::Footer(_) => before != Part::Index,
        Record::Unknown { opcode, .. } => {
            return Some(format!("a record of a kind that no log has (0x{opcode:02x})"));
        }
        Record::Message { .. } | Record::Attachment { .. } | Record::Metadata(_) => {
            part != Part::Data
        }
        _ => part == Part::Start || part == Part::Footer,
    };
    repeated.then(|| "a record where it does not belong".to_string())
}

/// What MCAP's own checks found, and where that is.
fn in_words(error: &McapError) -> String {
    let what = match error {
        McapError::BadAttachmentCrc { .. } => "one of the files the flight was flown with",
        McapError::BadChunkCrc { .. } | McapError::DecompressionError(_) => "a chunk of messages",
        McapError::BadDataCrc { .. } => {
            "something beside messages and files: header, metadata, a chunk's frame or its index"
        }
        McapError::BadSummaryCrc { .. } => "the index at the end",
        McapError::UnexpectedEof => "a length: it points beyond the end",
        McapError::BadMagic => "the last bytes",
        McapError::BytesAfterEndMagic => return "bytes after the end".into(),
        error => return error.to_string(),
    };
    format!("{what} is not as written ({error})")
}

fn options() -> LinearReaderOptions {
    LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(RECORD_BYTES_MAX)
}
