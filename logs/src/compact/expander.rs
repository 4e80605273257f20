//! Reading a compacted log as the log it was.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

use engine::{Outputs, State};
use mcap::McapError;
use mcap::records::{AttachmentHeader, Channel, MessageHeader, Metadata};
use xxhash_rust::xxh3::Xxh3Default;

use super::block::{Block, Op, ROWS};
use super::columns::Taker;
use super::flier::{Flier, Flown, VIEWED};
use super::{HEAD, ID, TAIL, TOPIC, VERSION};
use crate::index::Index;
use crate::raw::{Fingerprint, Raw, RawReader};
use crate::reader::refuse_other_versions;
use crate::records::{HARDWARE, INPUTS, STATE, StateRecord, time_ns};
use crate::setup::{Identity, METADATA, Setup};
use crate::{LogError, cdr};

/// Makes an aircraft, and the world in which its flight begins, of the files in the log. This crate
/// does not read them itself.
pub type Open = fn(&Setup) -> Result<Flown, LogError>;

/// A compacted log being read.
pub(crate) struct Expander {
    path: PathBuf,
    raw: RawReader,
    open: Open,
    /// Whether a log of another version of the flight model is to be read.
    pub across: bool,
    /// The log's flight model, or its aircraft file, is not for us: nothing is flown again.
    blind: bool,
    flier: Option<Flier>,
    /// The last recorded state's message, and the tick of the last state.
    keyframe: Vec<u8>,
    tick: u64,
    /// Records that come before anything else is read.
    ready: VecDeque<Raw>,
    /// Channels of the log that was compacted, and of this file.
    ids: BTreeMap<String, u16>,
    topics: BTreeMap<u16, String>,
    /// Message types of the log.
    schemas: BTreeSet<String>,
    /// Messages of the chunk so far that stand as they were.
    plain: VecDeque<Message>,
    block: Option<Unpacked>,
    /// Reading began in the middle: the next block is only read for its keyframe.
    skip_block: bool,
    sought: bool,
    /// The files have been read.
    begun: bool,
    hash: Xxh3Default,
    tail: Option<Tail>,
    states: u64,
    /// Whether the last state is as it was recorded, not flown again.
    pub recorded: bool,
}

type Message = (MessageHeader, Vec<u8>);

struct Tail {
    messages: String,
    original: Option<Fingerprint>,
}

/// A block, and how far it has been read.
struct Unpacked {
    block: Block,
    next: usize,
    row: [usize; ROWS.len()],
    digest: usize,
    view: [usize; VIEWED.len()],
    keyframe: Option<Message>,
}

impl Expander {
    /// Opens a compacted log; `None` when it is a log, or another file, that is not compacted.
    ///
    /// With `across`, one of another version of the flight model is opened, too. Its states cannot be
    /// flown again: between keyframes, the last keyframe stands in for them, with the right tick and
    /// digest, and [`Expander::recorded`] is false.
    pub fn open(path: &Path, open: Open, across: bool) -> Result<Option<Self>, LogError> {
        let mut raw = RawReader::open(path)?;
        let header = match raw.next() {
            Ok(Some(header @ Raw::Header { .. })) => header,
            _ => return Ok(None),
        };
        match raw.next() {
            Ok(Some(Raw::Metadata(head))) if head.name == HEAD => refuse_other_form(&head)?,
            _ => return Ok(None),
        }
        Ok(Some(Self {
            path: path.to_path_buf(),
            raw,
            open,
            across,
            blind: false,
            flier: None,
            keyframe: Vec::new(),
            tick: 0,
            ready: [header].into(),
            ids: BTreeMap::new(),
            topics: BTreeMap::new(),
            schemas: BTreeSet::new(),
            plain: VecDeque::new(),
            block: None,
            skip_block: false,
            sought: false,
            begun: false,
            hash: Xxh3Default::new(),
            tail: None,
            states: 0,
            recorded: true,
        }))
    }

    /// States so far.
    pub fn states(&self) -> u64 {
        self.states
    }

    /// Size of the compacted log, and its hash, once it is read.
    pub fn fingerprint(&self) -> Fingerprint {
        self.raw.fingerprint()
    }

    /// Size and hash of the log that was compacted.
    pub fn original(&self) -> Option<Fingerprint> {
        self.tail.as_ref()?.original
    }

    /// The last tick as it was flown again.
    pub fn flown(&self) -> Option<(&State, &Outputs)> {
        self.flier.as_ref()?.flown.as_ref().map(|(state, outputs)| (state, outputs))
    }

    /// Goes where the state of the tick is not far ahead.
    pub fn seek(&mut self, tick: u64) -> Result<(), LogError> {
        let Some(index) = Index::read(&self.path) else { return Ok(()) };
        // A block begins where the one before ends, with its keyframe.
        let Some(place) = index.chunk_of(tick).and_then(|number| number.checked_sub(1)) else {
            return Ok(());
        };
        if place == 0 {
            return Ok(());
        }
        self.raw.jump(index.chunks[place].offset)?;
        self.block = None;
        self.plain.clear();
        self.ready.clear();
        (self.skip_block, self.sought) = (true, true);
        Ok(())
    }

    /// The next record of the log that was compacted.
    pub fn next(&mut self) -> Result<Option<Raw>, LogError> {
        loop {
            if let Some(raw) = self.ready.pop_front() {
                return Ok(Some(raw));
            }
            if let Some(raw) = self.unpack()? {
                return Ok(Some(raw));
            }
            match self.raw.next()? {
                None => {
                    self.close()?;
                    return Ok(None);
                }
                Some(Raw::Header { .. } | Raw::ChunkEnd) => {}
                Some(Raw::Schema { id: ID, .. }) => {}
                Some(raw @ (Raw::Schema { .. } | Raw::Channel(_))) => {
                    if let Raw::Channel(channel) = &raw {
                        self.topics.insert(channel.id, channel.topic.clone());
                        if channel.topic == TOPIC {
                            continue;
                        }
                    }
                    // The log's own definitions came with its files.
                    if self.begun && self.is_new(&raw) {
                        return Ok(Some(raw));
                    }
                }
                Some(Raw::Metadata(tail)) if tail.name == TAIL => self.tail = Some(Tail::of(&tail)),
                Some(Raw::Metadata(record)) if record.name == METADATA => {
                    self.refuse_other_versions(&record)?;
                    return Ok(Some(Raw::Metadata(record)));
                }
                Some(Raw::Message(header, data)) => {
                    let topic = self.topics.get(&header.channel_id);
                    let topic = topic.ok_or_else(|| broken("a channel is not there"))?.clone();
                    add_to(&mut self.hash, &topic, &header, &data);
                    if topic == TOPIC {
                        self.bytes(&data)?;
                    } else {
                        let channel_id = self.id(&topic)?;
                        self.plain.push_back((MessageHeader { channel_id, ..header }, data));
                    }
                }
                Some(raw) => return Ok(Some(raw)),
            }
        }
    }

    fn refuse_other_versions(&mut self, record: &Metadata) -> Result<(), LogError> {
        let identity = Identity(record.metadata.clone());
        self.blind = identity.get(Identity::MODEL) != engine::MODEL_VERSION;
        if self.blind && self.across { Ok(()) } else { refuse_other_versions(&identity) }
    }

    /// Whether a definition is not known yet; from now on it is.
    fn is_new(&mut self, definition: &Raw) -> bool {
        match definition {
            Raw::Schema { name, .. } => self.schemas.insert(name.clone()),
            Raw::Channel(channel) => {
                let new = !self.ids.contains_key(&channel.topic);
                self.ids.entry(channel.topic.clone()).or_insert(channel.id);
                new
            }
            _ => false,
        }
    }

    /// Files, or a block.
    fn bytes(&mut self, data: &[u8]) -> Result<(), LogError> {
        let bytes = data.get(cdr::HEADER.len() + size_of::<u32>()..).unwrap_or_default();
        if !std::mem::replace(&mut self.begun, true) {
            let (attachments, definitions) = head(bytes)?;
            let setup = setup_of(&attachments)?;
            if !self.blind {
                match (self.open)(&setup) {
                    Ok(flown) => self.flier = Some(Flier::new(flown)),
                    // An aircraft file of another time: its keyframes can still be read.
                    Err(_) if self.across => self.blind = true,
                    Err(error) => return Err(error),
                }
            }
            self.ready.extend(attachments.into_iter().map(|(h, data)| Raw::Attachment(h, data)));
            for definition in definitions {
                if self.is_new(&definition) {
                    self.ready.push_back(definition);
                }
            }
            return Ok(());
        }
        let block = Block::decode(bytes)?;
        let keyframe = if block.ops.contains(&Op::Keyframe) { self.plain.pop_back() } else { None };
        if std::mem::take(&mut self.skip_block) {
            self.plain.clear();
            let (_, data) = keyframe.ok_or_else(|| broken("a block without a keyframe"))?;
            return self.stand_at(data);
        }
        self.block = Some(Unpacked {
            block,
            next: 0,
            row: [0; ROWS.len()],
            digest: 0,
            view: [0; VIEWED.len()],
            keyframe,
        });
        Ok(())
    }

    /// Goes on from a recorded state.
    fn stand_at(&mut self, data: Vec<u8>) -> Result<(), LogError> {
        self.tick = tick_of(&data)?;
        if let Some(flier) = &mut self.flier {
            flier.begin(cdr::decode::<StateRecord>(&data)?.state);
        }
        self.keyframe = data;
        Ok(())
    }

    /// The next record of the block, if there is one.
    fn unpack(&mut self) -> Result<Option<Raw>, LogError> {
        loop {
            let Some(at) = &mut self.block else { return Ok(None) };
            let Some(op) = at.block.ops.get(at.next).copied() else {
                self.block = None;
                return Ok(None);
            };
            at.next += 1;
            if op == Op::ChunkEnd {
                return Ok(Some(Raw::ChunkEnd));
            }
            let message = match op {
                Op::ChunkEnd => None,
                Op::Plain => Some(self.plain()?),
                Op::Row(number) => Some(self.row(number)?),
                Op::State => Some(self.state()?),
                Op::Keyframe => Some(self.end_of_block()?),
                Op::View(number) => self.view(number)?,
            };
            if let Some((header, data)) = message {
                return Ok(Some(Raw::Message(header, data)));
            }
        }
    }

    fn plain(&mut self) -> Result<Message, LogError> {
        let message = self.plain.pop_front().ok_or_else(|| broken("a message less"))?;
        if Some(&message.0.channel_id) == self.ids.get(STATE) {
            self.stand_at(message.1.clone())?;
            self.states += 1;
            self.recorded = true;
        }
        Ok(message)
    }

    fn row(&mut self, number: u8) -> Result<Message, LogError> {
        let kind = usize::from(number);
        let at = self.block.as_mut().ok_or_else(|| broken("no block"))?;
        let row = at.block.rows[kind].row(at.row[kind]).ok_or_else(|| broken("a row less"))?;
        at.row[kind] += 1;
        let mut data = cdr::HEADER.to_vec();
        data.extend(row.iter().flat_map(|word| word.to_le_bytes()));
        let tick = row[0];
        match (ROWS[kind], &mut self.flier) {
            (HARDWARE, Some(flier)) => flier.event(&data)?,
            (INPUTS, Some(flier)) => flier.inputs(&data)?,
            _ => {}
        }
        Ok((stamped(self.id(ROWS[kind])?, tick), data))
    }

    fn state(&mut self) -> Result<Message, LogError> {
        let at = self.block.as_mut().ok_or_else(|| broken("no block"))?;
        let digest = at.block.digests.get(at.digest).ok_or_else(|| broken("a digest less"))?;
        let digest = *digest;
        at.digest += 1;
        self.states += 1;
        self.tick = self.tick.wrapping_add(1);
        self.recorded = false;
        let data = if let Some(flier) = &mut self.flier {
            flier.fly();
            self.tick = flier.state.tick;
            flier.state_message(digest)?
        } else {
            let mut data = self.keyframe.clone();
            for (place, number) in [(0, digest), (1, self.tick)] {
                let at = cdr::HEADER.len() + 8 * place;
                let word = data.get_mut(at..at + 8).ok_or_else(|| broken("no keyframe"))?;
                word.copy_from_slice(&number.to_le_bytes());
            }
            data
        };
        Ok((stamped(self.id(STATE)?, self.tick), data))
    }

    fn end_of_block(&mut self) -> Result<Message, LogError> {
        let keyframe = self.block.as_mut().and_then(|at| at.keyframe.take());
        let (header, data) = keyframe.ok_or_else(|| broken("a keyframe less"))?;
        if let Some(flier) = &mut self.flier {
            flier.fly();
            // The same, or the log does not refly: then what was recorded counts.
            flier.state = cdr::decode::<StateRecord>(&data)?.state;
        }
        self.states += 1;
        self.tick = tick_of(&data)?;
        self.recorded = true;
        self.keyframe.clone_from(&data);
        Ok((header, data))
    }

    /// `None` when nothing is flown again, or reading began after that tick.
    fn view(&mut self, number: u8) -> Result<Option<Message>, LogError> {
        let kind = usize::from(number);
        let at = self.block.as_mut().ok_or_else(|| broken("no block"))?;
        let tick = at.block.view_ticks[kind].get(at.view[kind]).copied();
        let tick = tick.ok_or_else(|| broken("a tick less"))?;
        at.view[kind] += 1;
        let Some(flier) = &self.flier else { return Ok(None) };
        if let Some(data) = flier.view(number, tick)? {
            return Ok(Some((stamped(self.id(VIEWED[kind])?, tick), data)));
        }
        if self.sought && tick <= flier.begun_tick {
            return Ok(None);
        }
        Err(broken("viewers' messages of a tick that is long past"))
    }

    fn id(&self, topic: &str) -> Result<u16, LogError> {
        self.ids.get(topic).copied().ok_or_else(|| broken("a channel is not there"))
    }

    /// What the writer of the compacted log said at its end.
    fn close(&mut self) -> Result<(), LogError> {
        let Some(tail) = &self.tail else {
            return Err(LogError::Mcap(McapError::UnexpectedEof));
        };
        if !self.plain.is_empty() {
            return Err(broken("a block less"));
        }
        if !self.sought && tail.messages != format!("{:016x}", self.hash.digest()) {
            return Err(broken("its messages are not those that were written"));
        }
        Ok(())
    }
}

impl Tail {
    fn of(record: &Metadata) -> Self {
        let get = |key: &str| record.metadata.get(key).map_or("", String::as_str);
        let bytes = get("original_bytes").parse();
        let xxh3 = u128::from_str_radix(get("original_xxh3"), 16);
        let original = bytes.ok().zip(xxh3.ok());
        Self {
            messages: get("messages").into(),
            original: original.map(|(bytes, xxh3)| Fingerprint { bytes, xxh3 }),
        }
    }
}

/// The tick of a `/state` message: it follows the digest, whatever else is in the state.
fn tick_of(message: &[u8]) -> Result<u64, LogError> {
    cdr::word(message, 1).ok_or_else(|| broken("a state without a tick"))
}

/// The header that our writer gives a message of a tick.
fn stamped(channel_id: u16, tick: u64) -> MessageHeader {
    let log_time = time_ns(tick);
    MessageHeader { channel_id, sequence: tick as u32, log_time, publish_time: log_time }
}

/// Adds a message to the hash over all of them.
pub(super) fn add_to(hash: &mut Xxh3Default, topic: &str, header: &MessageHeader, data: &[u8]) {
    hash.update(&(topic.len() as u64).to_le_bytes());
    hash.update(topic.as_bytes());
    hash.update(&header.sequence.to_le_bytes());
    hash.update(&header.log_time.to_le_bytes());
    hash.update(&header.publish_time.to_le_bytes());
    hash.update(&(data.len() as u64).to_le_bytes());
    hash.update(data);
}

type Files = Vec<(AttachmentHeader, Vec<u8>)>;

/// The files that were attachments, and the definitions before the first message.
fn head(bytes: &[u8]) -> Result<(Files, Vec<Raw>), LogError> {
    let mut from = Taker(bytes);
    let mut files = Vec::new();
    for _ in 0..from.count(5)? {
        let (log_time, create_time) = (from.number()?, from.number()?);
        let (name, media_type) = (text(&mut from)?, text(&mut from)?);
        let header = AttachmentHeader { log_time, create_time, name, media_type };
        files.push((header, from.sized()?.to_vec()));
    }
    let mut definitions = Vec::new();
    for _ in 0..from.count(1)? {
        definitions.push(match from.number()? {
            0 => {
                let (id, name, encoding) = (id(&mut from)?, text(&mut from)?, text(&mut from)?);
                Raw::Schema { id, name, encoding, data: from.sized()?.to_vec() }
            }
            1 => {
                let (id, schema_id) = (id(&mut from)?, id(&mut from)?);
                let (topic, message_encoding) = (text(&mut from)?, text(&mut from)?);
                let mut metadata = BTreeMap::new();
                for _ in 0..from.count(2)? {
                    metadata.insert(text(&mut from)?, text(&mut from)?);
                }
                Raw::Channel(Channel { id, schema_id, topic, message_encoding, metadata })
            }
            _ => return Err(broken("a definition of an unknown kind")),
        });
    }
    Ok((files, definitions))
}

fn text(from: &mut Taker<'_>) -> Result<String, LogError> {
    String::from_utf8(from.sized()?.to_vec()).map_err(|_| broken("a name is no text"))
}

fn id(from: &mut Taker<'_>) -> Result<u16, LogError> {
    u16::try_from(from.number()?).map_err(|_| broken("a channel's number is too large"))
}

/// Those of them that a flight is reflown from.
pub(super) fn setup_of(files: &[(AttachmentHeader, Vec<u8>)]) -> Result<Setup, LogError> {
    let mut setup = Setup::default();
    for name in Setup::NAMES {
        let missing = || LogError::NotAFlight(format!("{name} is not in it"));
        let (_, data) = files.iter().find(|(h, _)| h.name == name).ok_or_else(missing)?;
        let text = String::from_utf8(data.clone())
            .map_err(|_| LogError::NotAFlight(format!("{name} is not text")))?;
        if let Some(file) = setup.file_mut(name) {
            *file = text;
        }
    }
    Ok(setup)
}

fn refuse_other_form(head: &Metadata) -> Result<(), LogError> {
    let theirs = head.metadata.get("version").map_or("unknown", String::as_str);
    if theirs == VERSION {
        return Ok(());
    }
    let (what, theirs) = ("compacted form", theirs.to_string());
    Err(LogError::Version { what, theirs, ours: VERSION })
}

fn broken(what: &str) -> LogError {
    LogError::Decode(format!("a compacted log that does not hold together: {what}"))
}
