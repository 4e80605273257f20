//! Reading a flight: a stream of ticks, every checksum validated before its bytes are used.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use engine::inputs::DeviceEvent;
use engine::{Outputs, State};
use mcap::McapError;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::fields::{Field, fields};
use crate::records::{
    Chain, EVENTS, EventRecord, HARDWARE, INPUTS, InputsRecord, OUTPUTS, STATE, StateRecord,
    TIMING, TimingRecord, first_digest,
};
use crate::compact::Open;
use crate::compact::expander::Expander;
use crate::index::Index;
use crate::raw::Raw;
use crate::setup::{CLOSING, Identity, METADATA, RATE_HZ, Setup, last_word};
use crate::view::{self, Remark};
use crate::{LogError, cdr};

/// No record of a flight is larger than this; a length beyond it is damage, not data.
pub(crate) const RECORD_BYTES_MAX: usize = 16 << 20;

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
    /// The aircraft's shape for viewers, URDF.
    pub robot_description: String,
    /// State at the start.
    pub initial: State,
    /// Nothing is read after the state of this tick.
    pub until_tick: Option<u64>,
    /// Whether the files and the state at the start are those of the first digest.
    pub intact: bool,
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
    /// When the file cannot be read, is not MCAP, or is not a flight of ours.
    ///
    /// [`LogError::Compacted`] for a compacted log; [`FlightReader::open_any`] reads those as well.
    pub fn open(path: &Path) -> Result<Self, LogError> {
        Self::of(Records::open(path, None)?)
    }

    /// Opens a log, compacted or not, and reads up to the state at the start. `open` makes the
    /// aircraft that flies what a compacted log leaves out.
    ///
    /// # Errors
    /// As for [`FlightReader::open`].
    pub fn open_any(path: &Path, open: Open) -> Result<Self, LogError> {
        Self::of(Records::open(path, Some(open))?)
    }

    fn of(mut records: Records) -> Result<Self, LogError> {
        let mut robot_description = String::new();
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
                Some(Item::Message(topic, _, data)) if topic == view::ROBOT_DESCRIPTION => {
                    robot_description = view::text(&data)?;
                }
                Some(Item::Message(topic, _, data)) if topic == STATE => {
                    let identity = identity.ok_or_else(|| no_flight("no `tiltrotor` metadata"))?;
                    if let Some(missing) = Setup::NAMES.iter().find(|name| !found.contains(name)) {
                        return Err(no_flight(&format!("{missing} is not in it")));
                    }
                    refuse_other_versions(&identity)?;
                    let first: StateRecord = cdr::decode(&data)?;
                    let digest = first_digest(&setup.files(), &cdr::encode(&first.state)?);
                    return Ok(Self {
                        records,
                        setup,
                        identity,
                        robot_description,
                        initial: first.state,
                        until_tick: None,
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
            let (topic, data) = match item {
                Item::Message(topic, _, data) => (topic, data),
                Item::Metadata(name, facts) if name == CLOSING => {
                    self.closing = last_word(&facts);
                    continue;
                }
                Item::Metadata(..) | Item::Attachment(..) => continue,
            };
            match topic.as_str() {
                HARDWARE => {
                    self.chain.add(&data);
                    self.pending.events.push(cdr::decode(&data)?);
                }
                INPUTS => {
                    self.chain.add(&data);
                    let inputs: InputsRecord = cdr::decode(&data)?;
                    if self.pending.inputs.replace(inputs).is_some() {
                        return Err(LogError::Order(format!(
                            "two inputs before the state of tick {}",
                            inputs.tick.saturating_add(1)
                        )));
                    }
                }
                STATE => return self.close_tick(&data).map(Some),
                TIMING => self.timings.push(cdr::decode(&data)?),
                OUTPUTS if self.keep_outputs => self.outputs.push(cdr::decode(&data)?),
                EVENTS => self.happenings.push(cdr::decode(&data)?),
                view::LOG => self.remarks.push(view::remark(&data)?),
                _ => {}
            }
        }
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
                Some(Item::Message(topic, _, data)) if topic == STATE => {
                    let place = cdr::HEADER.len() + size_of::<u64>();
                    let word = data.get(place..).and_then(|rest| rest.first_chunk::<8>());
                    let found = word.map_or(0, |word| u64::from_le_bytes(*word));
                    if found > tick {
                        return Err(LogError::Order(format!("tick {tick} is not there")));
                    }
                    self.last.0 = found;
                    if found == tick {
                        let record: StateRecord = cdr::decode(&data)?;
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
        self.closing.map_or(self.last.0, |closing| closing.0.max(self.last.0))
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

    /// Whether the log is compacted.
    pub fn is_compacted(&self) -> bool {
        self.records.expander.is_some()
    }

    fn close_tick(&mut self, data: &[u8]) -> Result<Tick, LogError> {
        let record: StateRecord = cdr::decode(data)?;
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
        // The state follows the digest.
        let mut state_message = cdr::HEADER.to_vec();
        state_message.extend_from_slice(&data[cdr::HEADER.len() + size_of::<u64>()..]);
        let chained = self.chain.close(&state_message) == record.digest;
        // From a break on, the chain goes on from what is recorded: one break is told once.
        self.chain = Chain::from(record.digest);
        self.last = (tick, record.digest);
        Ok(Tick { events, inputs, record, state_message, chained })
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
    from_tick: u64,
    until_tick: u64,
}

/// One message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Channel.
    pub topic: String,
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
        Ok(Self { records: Records::open(path, None)?, from_tick: 0, until_tick: u64::MAX })
    }

    /// Opens a log, compacted or not.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open_any(path: &Path, open: Open) -> Result<Self, LogError> {
        Ok(Self { records: Records::open(path, Some(open))?, from_tick: 0, until_tick: u64::MAX })
    }

    /// Only the messages from one tick to another; those before are not read where the log's index
    /// says where they are.
    ///
    /// # Errors
    /// When the log cannot be read.
    pub fn limit(&mut self, from_tick: u64, until_tick: u64) -> Result<(), LogError> {
        (self.from_tick, self.until_tick) = (from_tick, until_tick);
        self.records.seek(from_tick)
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
            if let Item::Message(topic, time_ns, data) = self.records.next()? {
                let tick = time_ns / engine::STEP_NS;
                // What viewers draw is written after the states: an eye's blink later is surely past.
                if tick > self.until_tick.saturating_add(PAST_TICKS) {
                    self.records.until_now();
                    return None;
                }
                if (self.from_tick..=self.until_tick).contains(&tick) {
                    return Some(Message { topic, time_ns, data });
                }
            }
        }
    }
}

impl Message {
    /// The numbers of a recorded struct; `None` on channels for viewers.
    ///
    /// # Errors
    /// When the bytes are not what the channel holds.
    pub fn fields(&self) -> Option<Result<Vec<Field>, LogError>> {
        fn of<T: DeserializeOwned + Serialize>(data: &[u8]) -> Result<Vec<Field>, LogError> {
            Ok(fields(&cdr::decode::<T>(data)?)?)
        }
        let decode = match self.topic.as_str() {
            HARDWARE => of::<DeviceEvent>,
            INPUTS => of::<InputsRecord>,
            STATE => of::<StateRecord>,
            TIMING => of::<TimingRecord>,
            EVENTS => of::<EventRecord>,
            OUTPUTS => of::<Outputs>,
            _ => return None,
        };
        Some(decode(&self.data))
    }
}

fn no_flight(why: &str) -> LogError {
    LogError::NotAFlight(format!("an MCAP file, but not a tiltrotor flight: {why}"))
}

pub(crate) fn refuse_other_versions(identity: &Identity) -> Result<(), LogError> {
    let known = [
        (Identity::FORMAT, "log format", crate::records::FORMAT_VERSION),
        (Identity::MODEL, "flight model", engine::MODEL_VERSION),
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
    Message(String, u64, Vec<u8>),
}

/// Records of the file, up to its end or the first damage.
struct Records {
    path: PathBuf,
    file: BufReader<File>,
    reader: LinearReader,
    topics: BTreeMap<u16, String>,
    ending: Ending,
    started: bool,
    /// Makes the records of a compacted log.
    expander: Option<Box<Expander>>,
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
        let mut records = Self::new(path, file);
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
        if let Some(expander) = &mut self.expander {
            return expander.seek(tick);
        }
        let Some(index) = Index::read(&self.path) else { return Ok(()) };
        let Some(place) = index.chunk_of(tick).filter(|&place| place > 0) else { return Ok(()) };
        self.file.seek(SeekFrom::Start(index.chunks[place].offset))?;
        // Chunks keep their own checksums; that of the whole file cannot be looked at any more.
        let options = options().with_skip_start_magic(true).with_validate_data_section_crc(false);
        self.reader = LinearReader::new_with_options(options);
        Ok(())
    }

    /// Nobody wants to read any further.
    fn until_now(&mut self) {
        self.ending = Ending::Closed;
    }

    fn new(path: &Path, file: File) -> Self {
        Self {
            path: path.to_path_buf(),
            file: BufReader::with_capacity(256 * 1024, file),
            reader: LinearReader::new_with_options(options()),
            topics: BTreeMap::new(),
            ending: Ending::Closed,
            started: false,
            expander: None,
            refused: None,
        }
    }

    fn ending(&self) -> Ending {
        self.ending.clone()
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

    /// The next record of a compacted log.
    fn expanded(&mut self) -> Option<Item> {
        let expander = self.expander.as_mut()?;
        loop {
            match expander.next() {
                Ok(Some(Raw::Channel(channel))) => {
                    self.topics.insert(channel.id, channel.topic);
                }
                Ok(Some(Raw::Message(header, data))) => {
                    if let Some(topic) = self.topics.get(&header.channel_id) {
                        return Some(Item::Message(topic.clone(), header.log_time, data));
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
                    let read = self.file.read(room)?;
                    self.reader.notify_read(read);
                }
                LinearReadEvent::Record { data, opcode } => {
                    self.started = true;
                    match mcap::parse_record(opcode, data)? {
                        Record::Channel(channel) => {
                            self.topics.insert(channel.id, channel.topic);
                        }
                        Record::Message { header, data } => {
                            if let Some(topic) = self.topics.get(&header.channel_id) {
                                let (topic, data) = (topic.clone(), data.into_owned());
                                return Ok(Some(Item::Message(topic, header.log_time, data)));
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

fn options() -> LinearReaderOptions {
    LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(RECORD_BYTES_MAX)
}
