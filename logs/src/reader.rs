//! Reading a flight: a stream of ticks, every checksum validated before its bytes are used.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;
use std::sync::Arc;

use engine::inputs::DeviceEvent;
use engine::State;
use mcap::McapError;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::fields::Field;
use crate::evolution::{Difference, Mappings};
use crate::layout::Layout;
use crate::records::{
    Chain, EVENTS, EventRecord, HARDWARE, INPUTS, InputsRecord, STATE, StateRecord, TIMING,
    TimingRecord, first_digest,
};
use crate::setup::{CLOSING, CLOSING_DIGEST, CLOSING_TICK, Identity, METADATA, RATE_HZ, Setup};
use crate::view::{self, Remark};
use crate::{LogError, cdr, schema};

/// No record of a flight is larger than this; a length beyond it is damage, not data.
const RECORD_BYTES_MAX: usize = 16 << 20;

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
    /// State at the start.
    pub initial: State,
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
    /// Tick and digest of the last state written, as the writer closed the log.
    closing: Option<(u64, u64)>,
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
    /// version of the flight model.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        let reader = Self::open_across_versions(path)?;
        if reader.same_model {
            return Ok(reader);
        }
        let theirs = reader.identity.get(Identity::MODEL).into();
        Err(LogError::Version { what: "flight model", theirs, ours: engine::MODEL_VERSION })
    }

    /// Opens a log, whatever version of the flight model flew it. Its messages become today's structs
    /// by the names of their fields; [`FlightReader::differences`] says which ones did not.
    ///
    /// # Errors
    /// When the file cannot be read, is not MCAP, or is not a flight of ours.
    pub fn open_across_versions(path: &Path) -> Result<Self, LogError> {
        let file = File::open(path).map_err(LogError::Open)?;
        if file.metadata().map_err(LogError::Open)?.is_dir() {
            return Err(LogError::NotAFlight("a folder".into()));
        }
        let mut records = Records::new(file);
        let mut setup = Setup::default();
        let mut found: Vec<&str> = Vec::new();
        let mut identity = None;
        // A tool that copied the log may have put the writer's last word first.
        let mut closing = None;
        loop {
            match records.next() {
                Some(Item::Metadata(name, facts)) if name == METADATA => {
                    identity = Some(Identity(facts));
                }
                Some(Item::Metadata(name, facts)) if name == CLOSING => {
                    closing = last_word(&facts);
                }
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
                Some(Item::Message(channel, _, data)) if channel.topic == STATE => {
                    let identity = identity.ok_or_else(|| no_flight("no `tiltrotor` metadata"))?;
                    if let Some(missing) = Setup::NAMES.iter().find(|name| !found.contains(name)) {
                        return Err(no_flight(&format!("{missing} is not in it")));
                    }
                    refuse_other_formats(&identity)?;
                    let mut mappings = Mappings::default();
                    let first: StateRecord = mappings.decode(&channel.topic, channel.layout.as_deref(), &data)?;
                    let digest = first_digest(&setup.files(), &without_digest(&data));
                    return Ok(Self {
                        records,
                        setup,
                        same_model: identity.get(Identity::MODEL) == engine::MODEL_VERSION,
                        identity,
                        mappings,
                        first: data,
                        initial: first.state,
                        intact: digest == first.digest,
                        chain: Chain::from(first.digest),
                        pending: Pending::default(),
                        last: (first.state.tick, first.digest),
                        closing,
                        happenings: Vec::new(),
                        remarks: Vec::new(),
                        timings: Vec::new(),
                        outputs: Vec::new(),
                        keep_outputs: false,
                        ending: None,
                    });
                }
                Some(_) => {}
                None => {
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
        loop {
            let Some(item) = self.records.next() else {
                let ending = self.records.ending();
                let begun = self.pending.inputs.is_some() || !self.pending.events.is_empty();
                if ending == Ending::Closed && begun {
                    return Err(LogError::Order("the last tick has no state".into()));
                }
                // An end without the writer's last word was put there by someone else.
                let whole = self.closing == Some(self.last);
                self.ending = Some(if ending == Ending::Closed && !whole {
                    Ending::Truncated
                } else {
                    ending
                });
                return Ok(None);
            };
            let (channel, data) = match item {
                Item::Message(channel, _, data) => (channel, data),
                Item::Metadata(name, facts) if name == CLOSING => {
                    self.closing = last_word(&facts);
                    continue;
                }
                Item::Metadata(..) | Item::Attachment(..) => continue,
            };
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
                OUTPUTS if self.keep_outputs => {
                    let outputs = self.decode(&channel, &data)?;
                    self.outputs.push(outputs);
                }
                EVENTS => {
                    let happening = self.decode(&channel, &data)?;
                    self.happenings.push(happening);
                }
                view::LOG => self.remarks.push(view::remark(&data)?),
                _ => {}
            }
        }
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

    /// How the file ends, once the last tick has been read.
    pub fn ending(&self) -> Option<&Ending> {
        self.ending.as_ref()
    }
}

/// Every message of a log as it stands there, whatever its channel.
pub struct Messages {
    records: Records,
    facts: Vec<(String, BTreeMap<String, String>)>,
    files: Vec<(String, Vec<u8>)>,
}

/// One message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    channel: Arc<Channel>,
    /// Time since the start of the flight, ns.
    pub time_ns: u64,
    /// Its bytes.
    pub data: Vec<u8>,
}

impl Messages {
    /// Opens a log.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        let file = File::open(path).map_err(LogError::Open)?;
        if file.metadata().map_err(LogError::Open)?.is_dir() {
            return Err(LogError::NotAFlight("a folder".into()));
        }
        Ok(Self { records: Records::new(file), facts: Vec::new(), files: Vec::new() })
    }

    /// The metadata records that came so far: name, keys and values.
    pub fn facts(&self) -> &[(String, BTreeMap<String, String>)] {
        &self.facts
    }

    /// The attachments that came so far: name and bytes.
    pub fn files(&self) -> &[(String, Vec<u8>)] {
        &self.files
    }

    /// How the file ends, once the last message has been read.
    pub fn ending(&self) -> Ending {
        self.records.ending()
    }
}

impl Iterator for Messages {
    type Item = Message;

    fn next(&mut self) -> Option<Message> {
        loop {
            match self.records.next()? {
                Item::Message(channel, time_ns, data) => {
                    return Some(Message { channel, time_ns, data });
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
        self.channel.layout.as_deref()
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

/// Tick and digest with which the writer closed the log.
fn last_word(facts: &BTreeMap<String, String>) -> Option<(u64, u64)> {
    let number = |key| facts.get(key).and_then(|text| text.parse().ok());
    number(CLOSING_TICK).zip(number(CLOSING_DIGEST))
}

fn refuse_other_formats(identity: &Identity) -> Result<(), LogError> {
    let known = [
        (Identity::FORMAT, "log format", crate::records::FORMAT_VERSION),
        (Identity::RATE, "number of ticks a second", RATE_HZ),
    ];
    for (key, what, ours) in known {
        let theirs = identity.get(key);
        if theirs != ours {
            return Err(LogError::Version { what, theirs: theirs.into(), ours });
        }
    }
    Ok(())
}

/// A record that matters.
enum Item {
    Metadata(String, BTreeMap<String, String>),
    Attachment(String, Vec<u8>),
    Message(Arc<Channel>, u64, Vec<u8>),
}

/// A channel of the file.
#[derive(Debug, PartialEq, Eq)]
struct Channel {
    topic: String,
    /// `None` when its messages are no recorded struct.
    layout: Option<Arc<Layout>>,
}

/// Records of the file, up to its end or the first damage.
struct Records {
    file: BufReader<File>,
    reader: LinearReader,
    schemas: BTreeMap<u16, Option<Arc<Layout>>>,
    channels: BTreeMap<u16, Arc<Channel>>,
    ending: Ending,
    started: bool,
}

impl Records {
    fn new(file: File) -> Self {
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_check_finishes_after_end_magic(true)
            .with_record_length_limit(RECORD_BYTES_MAX);
        Self {
            file: BufReader::with_capacity(256 * 1024, file),
            reader: LinearReader::new_with_options(options),
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            ending: Ending::Closed,
            started: false,
        }
    }

    fn ending(&self) -> Ending {
        self.ending.clone()
    }

    fn next(&mut self) -> Option<Item> {
        if self.ending != Ending::Closed {
            return None;
        }
        match self.read() {
            Ok(item) => item,
            Err(McapError::UnexpectedEof) if self.started => {
                self.ending = Ending::Truncated;
                None
            }
            Err(McapError::BadMagic | McapError::UnexpectedEof) if !self.started => {
                self.ending = Ending::Damaged("not an MCAP file".into());
                None
            }
            Err(error) => {
                self.ending = Ending::Damaged(error.to_string());
                None
            }
        }
    }

    fn read(&mut self) -> Result<Option<Item>, McapError> {
        while let Some(event) = self.reader.next_event() {
            match event? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let room = self.reader.insert(wanted);
                    let read = self.file.read(room)?;
                    self.reader.notify_read(read);
                }
                LinearReadEvent::Record { data, opcode } => {
                    self.started = true;
                    match mcap::parse_record(opcode, data)? {
                        Record::Schema { header, data } => {
                            let ours = header.encoding == "ros2msg"
                                && header.name.split('/').next() == Some(schema::PACKAGE);
                            let layout = std::str::from_utf8(&data)
                                .ok()
                                .filter(|_| ours)
                                .and_then(Layout::parse)
                                .map(Arc::new);
                            self.schemas.insert(header.id, layout);
                        }
                        Record::Channel(channel) => {
                            let plain = |c: char| c.is_ascii_alphanumeric() || "/_-.".contains(c);
                            let schema = self.schemas.get(&channel.schema_id).cloned().flatten();
                            let layout = schema.filter(|_| channel.topic.chars().all(plain));
                            let known = Arc::new(Channel { topic: channel.topic, layout });
                            self.channels.insert(channel.id, known);
                        }
                        Record::Message { header, data } => {
                            if let Some(channel) = self.channels.get(&header.channel_id) {
                                let (channel, data) = (channel.clone(), data.into_owned());
                                return Ok(Some(Item::Message(channel, header.log_time, data)));
                            }
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
}
