//! Reading a compacted log as the log it was.

mod block_records;

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use engine::State;

use mcap::records::{MessageHeader, Metadata};
use xxhash_rust::xxh3::Xxh3Default;

use super::ahead::{BlockWorkers, Restarts};
use super::block::{Block, Op};
use super::definitions::Definitions;
use super::files::{broken, decode, form_of, refuse_other_form, refuse_other_layout, setup_of};
use super::regenerator::{FlightModelOf, FlownTick, Regenerator};
use super::{HEAD, ID, TAIL, TOPIC, VERSION};
use crate::channels::Compacted as How;
use crate::container::checksums::add_message;
use crate::container::{Compacted, LogFile, Record, RecordSource, Schema};
use crate::records::{RESTART, RestartRecord, StateRecord};
use crate::setup::{Identity, METADATA};
use crate::{LogError, cdr};

/// What is made of today's structs while a compacted log is read.
const MADE_AGAIN: [How; 3] = [How::Rows, How::Reflown, How::Remade];

/// A compacted log being read.
#[derive(Default)]
pub(crate) struct Expander {
    file: LogFile,
    /// The record of the file that was read last.
    record: Record,
    aircraft_of: Option<FlightModelOf>,
    /// Whether a log of another version of the flight model is to be read. Its states cannot be flown
    /// again: between keyframes, the last keyframe stands in for them, with the right tick and digest.
    across: bool,
    /// The log's flight model, or its aircraft file, is not for us: nothing is flown again.
    blind: bool,
    /// Who flew.
    identity: Identity,
    regenerator: Option<Regenerator>,
    /// The last recorded state's message, and the tick of the last state.
    keyframe: Vec<u8>,
    tick: u64,
    /// Records that come before anything else is read.
    ready: VecDeque<Record>,
    /// Channels and message types.
    definitions: Definitions,
    /// Messages of the chunk so far that stand as they were.
    plain: VecDeque<Message>,
    block: Option<Unpacked>,
    /// What was read of the file before its turn: blocks are flown meanwhile.
    ahead: VecDeque<Ahead>,
    workers: Option<BlockWorkers>,
    /// The state with which the next block begins, as far as it is known before its turn.
    next_from: Option<State>,
    /// Reading began in the middle: the next block is only read for its keyframe.
    skip_block: bool,
    sought: bool,
    /// The files have been read.
    begun: bool,
    hash: Xxh3Default,
    tail: Option<Tail>,
    states: u64,
    /// Whether the last state was flown again: it is not as it was recorded.
    reflown: bool,
    /// Whether blocks hold digests of the outputs.
    with_outputs: bool,
    /// The first tick whose outputs have not the digest that was kept.
    outputs_differ: Option<u64>,
}

type Message = (MessageHeader, Vec<u8>);

struct Tail {
    messages: String,
    /// Size and hash of the log that was compacted.
    original: Option<(u64, u128)>,
}

/// Something that was read of the file before its turn.
enum Ahead {
    Record(Record),
    Block(Box<Unpacked>),
    /// How the file ends: whole, or not.
    End(Result<(), LogError>),
}

/// A block, and how far it has been read.
struct Unpacked {
    block: Arc<Block>,
    /// Its messages that stand as they were.
    plain: VecDeque<Message>,
    /// It is flown by another thread: what is still to be taken of it.
    flown: Option<Receiver<Vec<FlownTick>>>,
    ticks: VecDeque<FlownTick>,
    next: usize,
    row: Vec<usize>,
    digest: usize,
    view: Vec<usize>,
    keyframe: Option<Message>,
}

impl Expander {
    /// Whether a file is a compacted log.
    ///
    /// # Errors
    /// When it cannot be read, or is one of another form.
    pub fn is_compacted(path: &Path) -> Result<bool, LogError> {
        let mut file = LogFile::open(path)?;
        let mut record = Record::default();
        // Our writers put the metadata first, and that which says so before all; of other programs'
        // files, all that comes before the first message is looked at.
        while let Ok(true) = file.next(&mut record) {
            match &record {
                Record::Metadata(head) if head.name == HEAD => {
                    return refuse_other_form(head).map(|()| true);
                }
                Record::Attachment(..) | Record::Message(..) => break,
                _ => {}
            }
        }
        Ok(false)
    }

    /// Reads a compacted log from its beginning.
    pub fn new(file: LogFile, aircraft_of: FlightModelOf, across: bool) -> Self {
        Self { file, aircraft_of: Some(aircraft_of), across, ..Self::default() }
    }

    /// States so far.
    pub fn states(&self) -> u64 {
        self.states
    }

    /// Size of the compacted log, once it is read.
    pub fn bytes(&self) -> u64 {
        self.file.fingerprint().map_or(0, |fingerprint| fingerprint.bytes)
    }

    /// Size and hash of the log that was compacted.
    pub fn original(&self) -> Option<(u64, u128)> {
        self.tail.as_ref()?.original
    }

    /// Takes a record of the file; `true` when the log that was compacted has it, too.
    fn take(&mut self, record: &mut Record) -> Result<bool, LogError> {
        match record {
            Record::ChunkEnd => {}
            Record::Schema(Schema { id: ID, .. }) => {}
            // The log's own definitions come with its files; some of other programs' later.
            Record::Schema(schema) => return Ok(self.begun && self.definitions.is_new_type(schema)),
            Record::Channel(channel) => {
                self.definitions.in_file(channel);
                let own = channel.topic != TOPIC;
                return Ok(self.begun && own && self.definitions.is_new(channel));
            }
            Record::Metadata(head) if head.name == HEAD => {
                self.with_outputs = form_of(head) == VERSION;
            }
            Record::Metadata(tail) if tail.name == TAIL => self.tail = Some(Tail::of(tail)),
            Record::Metadata(facts) if facts.name == METADATA && !self.begun => {
                let identity = Identity(facts.metadata.clone());
                self.blind = identity.get(Identity::MODEL) != engine::MODEL_VERSION;
                if !(self.blind && self.across) {
                    identity.refuse_other_versions()?;
                }
                self.identity = identity;
                return Ok(true);
            }
            Record::Message(header, data) => {
                let topic = self.definitions.topic(header.channel_id)?;
                add_message(&mut self.hash, topic, header, data);
                if topic == TOPIC {
                    self.unpack(data)?;
                } else {
                    let channel_id = self.definitions.id(topic)?;
                    let header = MessageHeader { channel_id, ..*header };
                    self.plain.push_back((header, std::mem::take(data)));
                }
            }
            _ => return Ok(true),
        }
        Ok(false)
    }

    /// Files, or a block.
    fn unpack(&mut self, data: &[u8]) -> Result<(), LogError> {
        let bytes = data.get(cdr::HEADER.len() + size_of::<u32>()..).unwrap_or_default();
        if !std::mem::replace(&mut self.begun, true) {
            return self.unpack_files(bytes);
        }
        let block = Arc::new(Block::decode(bytes, self.with_outputs)?);
        let keyframe = if block.ops.contains(&Op::Keyframe) { self.plain.pop_back() } else { None };
        if std::mem::take(&mut self.skip_block) {
            self.plain.clear();
            let (_, data) = keyframe.ok_or_else(|| broken("a block without a keyframe"))?;
            return self.stand_at(&data);
        }
        let plain = std::mem::take(&mut self.plain);
        let from = self.next_from.take();
        let restarts = self.restarts(&plain);
        let flown = self
            .workers
            .as_ref()
            .zip(from)
            .and_then(|(workers, from)| workers.fly(from, &block, restarts));
        if let (Some((_, data)), Some(_)) = (&keyframe, &self.workers) {
            self.next_from = Some(cdr::decode::<StateRecord>(data)?.state);
        }
        let (row, view) = (vec![0; block.rows.len()], vec![0; block.view_ticks.len()]);
        let ticks = VecDeque::new();
        let (next, digest) = (0, 0);
        let unpacked = Unpacked { block, plain, flown, ticks, next, row, digest, view, keyframe };
        self.ahead.push_back(Ahead::Block(Box::new(unpacked)));
        Ok(())
    }

    /// States among the messages of a block that take the place of flown ones; what cannot be read is found
    /// wrong when its turn comes.
    fn restarts(&self, plain: &VecDeque<Message>) -> Restarts {
        let of = |(number, (header, data)): (usize, &Message)| {
            let is_one = self.workers.is_some() && self.definitions.is(RESTART, header.channel_id);
            let restart = is_one.then(|| cdr::decode::<RestartRecord>(data).ok())??;
            Some((number, restart.state))
        };
        plain.iter().enumerate().filter_map(of).collect()
    }

    /// Reads on in the file, as far ahead as blocks can be flown meanwhile.
    fn read_ahead(&mut self) {
        let blocks = self.workers.as_ref().map_or(1, |workers| workers.blocks);
        let is_block = |ahead: &&Ahead| matches!(ahead, Ahead::Block(_));
        while !matches!(self.ahead.back(), Some(Ahead::End(_)))
            && (self.ahead.is_empty()
                || self.workers.is_some() && self.ahead.iter().filter(is_block).count() < blocks)
        {
            let mut of_file = std::mem::take(&mut self.record);
            let read = match self.file.next(&mut of_file) {
                Ok(true) => self.take(&mut of_file),
                Ok(false) => {
                    let end = self.close();
                    self.ahead.push_back(Ahead::End(end));
                    return;
                }
                Err(error) => Err(error),
            };
            match read {
                Ok(true) => self.ahead.push_back(Ahead::Record(of_file)),
                Ok(false) => self.record = of_file,
                Err(error) => self.ahead.push_back(Ahead::End(Err(error))),
            }
            // Files and definitions come before what they are the files of.
            if !self.ready.is_empty() {
                return;
            }
        }
    }

    /// The next tick of the block under way, flown.
    fn fly(&mut self) -> Result<(), LogError> {
        let (Some(regenerator), Some(at)) = (&mut self.regenerator, &mut self.block) else {
            return Ok(());
        };
        if let Some(flown) = at.flown.take() {
            at.ticks = flown.recv().unwrap_or_default().into();
        }
        match at.ticks.pop_front() {
            Some(tick) => regenerator.take(&tick),
            None => regenerator.fly(),
        }
        Ok(())
    }

    fn unpack_files(&mut self, bytes: &[u8]) -> Result<(), LogError> {
        let head = decode(bytes)?;
        let setup = setup_of(&head)?;
        if !self.blind {
            match refuse_other_layout(&head, &self.identity, &MADE_AGAIN) {
                Err(LogError::Layout { .. }) if self.across => self.blind = true,
                refused => refused?,
            }
        }
        if let Some(aircraft_of) = self.aircraft_of.filter(|_| !self.blind) {
            match aircraft_of(&setup) {
                Ok(flown) => self.regenerator = Some(Regenerator::new(flown)),
                // An aircraft file of another time: its keyframes can still be read.
                Err(_) if self.across => self.blind = true,
                Err(error) => return Err(error),
            }
        }
        for record in head {
            match &record {
                Record::Schema(schema) => self.definitions.has_type(schema),
                Record::Channel(channel) => self.definitions.has(channel),
                _ => {}
            }
            self.ready.push_back(record);
        }
        Ok(())
    }

    /// Goes on from a recorded state.
    fn stand_at(&mut self, data: &[u8]) -> Result<(), LogError> {
        self.tick = tick_of(data)?;
        if let Some(regenerator) = &mut self.regenerator {
            regenerator.begin(cdr::decode::<StateRecord>(data)?.state);
        }
        self.keyframe.clear();
        self.keyframe.extend_from_slice(data);
        Ok(())
    }

    /// What the writer of the compacted log said at its end.
    fn close(&self) -> Result<(), LogError> {
        let Some(tail) = &self.tail else { return Err(LogError::Truncated) };
        if !self.plain.is_empty() {
            return Err(broken("a block less"));
        }
        if !self.sought && tail.messages != format!("{:016x}", self.hash.digest()) {
            return Err(broken("its messages are not those that were written"));
        }
        Ok(())
    }
}

impl RecordSource for Expander {
    fn next(&mut self, record: &mut Record) -> Result<bool, LogError> {
        loop {
            if let Some(ready) = self.ready.pop_front() {
                *record = ready;
                return Ok(true);
            }
            if self.next_of_block(record)? {
                return Ok(true);
            }
            self.read_ahead();
            if !self.ready.is_empty() {
                continue;
            }
            match self.ahead.pop_front() {
                Some(Ahead::Record(read)) => {
                    *record = read;
                    return Ok(true);
                }
                Some(Ahead::Block(block)) => self.block = Some(*block),
                Some(Ahead::End(end)) => return end.map(|()| false),
                None => {}
            }
        }
    }

    fn fly_states_only(&mut self, threads: usize) {
        let Some(regenerator) = &mut self.regenerator else { return };
        regenerator.states_only = true;
        if threads > 0 {
            self.workers = Some(BlockWorkers::of(threads, &regenerator.of));
            let keyframe = self.block.as_ref().and_then(|block| block.keyframe.as_ref());
            let record = keyframe.and_then(|(_, data)| cdr::decode::<StateRecord>(data).ok());
            self.next_from = record.map(|record| record.state);
        }
    }

    fn seek(&mut self, tick: u64) -> Result<(), LogError> {
        // A block begins where the one before ends, with its keyframe.
        if self.file.jump_before(tick, 1)? {
            self.block = None;
            self.plain.clear();
            self.ready.clear();
            self.ahead.clear();
            self.next_from = None;
            (self.skip_block, self.sought) = (true, true);
        }
        Ok(())
    }

    fn compacted(&self) -> Option<Compacted<'_>> {
        let flown = self.regenerator.as_ref().and_then(|regenerator| regenerator.flown.as_ref());
        let flown = flown.map(|(state, outputs)| (state, outputs));
        let outputs_differ = self.outputs_differ;
        Some(Compacted { recorded: !self.reflown, flown, outputs_differ })
    }
}

impl Tail {
    fn of(record: &Metadata) -> Self {
        let get = |key: &str| record.metadata.get(key).map_or("", String::as_str);
        let bytes = get("original_bytes").parse();
        let xxh3 = u128::from_str_radix(get("original_xxh3"), 16);
        Self { messages: get("messages").into(), original: bytes.ok().zip(xxh3.ok()) }
    }
}

/// The tick of a `/state` message: it follows the digest, whatever else is in the state.
fn tick_of(message: &[u8]) -> Result<u64, LogError> {
    cdr::word(message, StateRecord::TICK).ok_or_else(|| broken("a state without a tick"))
}
