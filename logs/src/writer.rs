//! Writing a flight.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Seek};
use std::path::Path;

use engine::frames::Attitude;
use engine::inputs::DeviceEvent;
use engine::{Aircraft, Outputs, State};
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, WriteOptions, Writer};
use serde::Serialize;

use crate::reader::{Message, RECORD_BYTES_MAX};
use crate::records::{
    Chain, EVENTS, EventRecord, HARDWARE, Happening, INPUTS, InputsRecord, OUTPUTS, STATE,
    StateRecord, TIMING, TimingRecord, first_digest, time_ns,
};
use crate::schema::{self, Kind};
use crate::seal::{RollCall, Stamp, seal};
use crate::setup::{
    CLOSING, CLOSING_DIGEST, CLOSING_MESSAGES, CLOSING_TICK, Identity, METADATA, Setup,
};
use crate::view;
use crate::{LogError, cdr};

/// Uncompressed size at which a chunk is closed; the caller's timer closes most of them earlier.
pub(crate) const CHUNK_BYTES: u64 = 128 * 1024;
/// The longest text that fits into a log, with room for its record's frame.
const TEXT_BYTES_MAX: usize = RECORD_BYTES_MAX - 1024;
/// Ticks between frames, stick positions and joints for viewers: 50 Hz.
const VIEW_TICKS: u64 = 5;
/// Ticks between outputs: 25 Hz.
const OUTPUT_TICKS: u64 = 10;
/// Ticks between places on earth: 5 Hz.
const FIX_TICKS: u64 = 50;

/// Ids of the channels.
struct Channels {
    hardware: u16,
    inputs: u16,
    state: u16,
    timing: u16,
    events: u16,
    outputs: u16,
    tf: u16,
    joy: u16,
    fix: u16,
    joints: u16,
    log: u16,
    description: u16,
}

/// A flight being written.
pub struct FlightWriter {
    /// Never seeks: a pipe will do.
    mcap: Writer<NoSeek<BufWriter<File>>>,
    channels: Channels,
    kinds: BTreeMap<u16, &'static Kind>,
    chain: Chain,
    roll_call: RollCall,
    /// Whether the state at the start is in it.
    begun: bool,
    last_tick: u64,
    message: Vec<u8>,
    shape: view::Shape,
}

/// How a log ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Closed {
    /// Its size.
    pub bytes: u64,
    /// The digest of the whole flight.
    pub digest: u64,
}

impl FlightWriter {
    /// Starts a log at `path` with all that is needed to refly it, on disk before this returns.
    ///
    /// # Errors
    /// When the file exists and `force` is not set, or cannot be written.
    pub fn create(
        path: &Path,
        setup: &Setup,
        identity: &Identity,
        aircraft: &Aircraft,
        robot_description: &str,
        initial: &State,
        force: bool,
    ) -> Result<Self, LogError> {
        let mut writer = Self::begin(path, setup, identity, force)?;
        writer.shape = view::Shape::of(aircraft);
        let text = cdr::encode_view(&view::Text { data: robot_description })?;
        writer.put(writer.channels.description, initial.tick, &text)?;
        let digest = first_digest(&setup.files(), &cdr::encode(initial)?);
        writer.chain = Chain::from(digest);
        writer.last_tick = initial.tick;
        writer.begun = true;
        let first = StateRecord { digest, state: *initial };
        writer.record(writer.channels.state, initial.tick, &first)?;
        writer.flush()?;
        Ok(writer)
    }

    /// Starts a log that holds no message yet.
    pub(crate) fn begin(
        path: &Path,
        setup: &Setup,
        identity: &Identity,
        force: bool,
    ) -> Result<Self, LogError> {
        // What cannot be read back is not written.
        if let Some((name, text)) =
            setup.files().iter().find(|(_, text)| text.len() > TEXT_BYTES_MAX)
        {
            let (bytes, most) = (text.len(), TEXT_BYTES_MAX);
            return Err(LogError::Encode(format!("{name}: {bytes} bytes, at most {most} fit")));
        }
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(force)
            .create_new(!force)
            .open(path)
            .map_err(|error| LogError::create(path, error))?;
        let mut mcap = WriteOptions::new()
            .compression(Some(Compression::Lz4))
            .profile("ros2")
            .library(concat!("tiltrotor ", env!("CARGO_PKG_VERSION")))
            .chunk_size(Some(CHUNK_BYTES))
            .disable_seeking(true)
            .create(NoSeek::new(BufWriter::new(file)))?;
        let mut facts = identity.0.clone();
        seal(&mut facts);
        mcap.write_metadata(&mcap::records::Metadata { name: METADATA.into(), metadata: facts })?;
        for (name, text) in setup.files() {
            mcap.attach(&Attachment {
                log_time: 0,
                create_time: 0,
                name: name.into(),
                media_type: "application/toml".into(),
                data: text.as_bytes().into(),
            })?;
        }
        let mut kinds = BTreeMap::new();
        let mut add = |kind: &'static Kind| -> Result<u16, LogError> {
            let schema = mcap.add_schema(&kind.name, schema::ENCODING, kind.text.as_bytes())?;
            let id = mcap.add_channel(schema, kind.topic, cdr::ENCODING, &BTreeMap::new())?;
            kinds.insert(id, kind);
            Ok(id)
        };
        let mut channel = |topic: &str| -> Result<u16, LogError> {
            let kind = schema::kinds()?.iter().find(|kind| kind.topic == topic);
            add(kind.ok_or_else(|| LogError::Encode(format!("no channel {topic}")))?)
        };
        let channels = Channels {
            hardware: channel(HARDWARE)?,
            inputs: channel(INPUTS)?,
            state: channel(STATE)?,
            timing: channel(TIMING)?,
            events: channel(EVENTS)?,
            outputs: channel(OUTPUTS)?,
            tf: channel(view::TF)?,
            joy: channel(view::JOY)?,
            fix: channel(view::FIX)?,
            joints: channel(view::JOINT_STATES)?,
            log: channel(view::LOG)?,
            description: channel(view::ROBOT_DESCRIPTION)?,
        };
        Ok(Self {
            mcap,
            channels,
            kinds,
            chain: Chain::default(),
            roll_call: RollCall::default(),
            begun: false,
            last_tick: 0,
            message: Vec::with_capacity(8192),
            shape: view::Shape::default(),
        })
    }

    /// A device event of the tick under way.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn event(&mut self, event: &DeviceEvent) -> Result<(), LogError> {
        self.record(self.channels.hardware, event.tick, event)?;
        self.chain.add(&self.message);
        Ok(())
    }

    /// The world of the tick under way, after its device events.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn inputs(&mut self, inputs: &InputsRecord) -> Result<(), LogError> {
        self.record(self.channels.inputs, inputs.tick, inputs)?;
        self.chain.add(&self.message);
        Ok(())
    }

    /// The state after the tick.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn state(&mut self, state: &State) -> Result<(), LogError> {
        self.message.clear();
        cdr::append(&mut self.message, state)?;
        let digest = self.chain.close(&self.message);
        self.last_tick = state.tick;
        self.record(self.channels.state, state.tick, &StateRecord { digest, state: *state })
    }

    /// How the tick kept time.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn timing(&mut self, timing: &TimingRecord) -> Result<(), LogError> {
        self.record(self.channels.timing, timing.tick, timing)
    }

    /// Something that happened, as a record and in words.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn happened(
        &mut self,
        tick: u64,
        what: Happening,
        value: u64,
        words: &str,
    ) -> Result<(), LogError> {
        let level = what.facts().levels.of(value);
        let record = EventRecord { tick, kind: what as u64, value };
        self.record(self.channels.events, tick, &record)?;
        let message = cdr::encode_view(&view::log(tick, level, words))?;
        self.put(self.channels.log, tick, &message)
    }

    /// A message of another log as it stands there; `false` when no channel of ours is called so.
    ///
    /// The digest is formed anew from the copied bytes, and has to come out as recorded.
    ///
    /// # Errors
    /// When the file cannot be written, or the message does not follow from those before.
    pub(crate) fn copy(&mut self, message: &Message) -> Result<bool, LogError> {
        let known = self.kinds.iter().find(|(_, kind)| kind.topic == message.topic());
        let Some((&channel, _)) = known else { return Ok(false) };
        match message.topic() {
            HARDWARE | INPUTS => self.chain.add(&message.data),
            STATE => {
                let record: StateRecord = cdr::decode(&message.data)?;
                let state = cdr::encode(&record.state)?;
                // The first digest is not formed from messages alone: the reader has looked at it.
                if self.begun && self.chain.close(&state) != record.digest {
                    return Err(LogError::Order(format!("tick {}", record.state.tick)));
                }
                if !self.begun {
                    self.chain = Chain::from(record.digest);
                }
                self.begun = true;
                self.last_tick = record.state.tick;
            }
            _ => {}
        }
        self.stamped(channel, message.stamp, &message.data)?;
        Ok(true)
    }

    /// Tick of the last state.
    pub(crate) fn last_tick(&self) -> u64 {
        self.last_tick
    }

    /// What viewers draw; call it with every tick's outputs, it takes what it needs.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn view(&mut self, outputs: &Outputs, attitude: Attitude) -> Result<(), LogError> {
        let tick = outputs.tick;
        let channels = &self.channels;
        let due = [
            (channels.outputs, OUTPUTS, OUTPUT_TICKS),
            (channels.tf, view::TF, VIEW_TICKS),
            (channels.joy, view::JOY, VIEW_TICKS),
            (channels.joints, view::JOINT_STATES, VIEW_TICKS),
            (channels.fix, view::FIX, FIX_TICKS),
        ];
        for (channel, topic, ticks) in due {
            if tick.is_multiple_of(ticks)
                && let Some(message) = view::message(topic, outputs, attitude, &self.shape)?
            {
                self.put(channel, tick, &message)?;
            }
        }
        Ok(())
    }

    /// Closes the chunk and hands everything to the system: a kill from here on loses nothing older.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn flush(&mut self) -> Result<(), LogError> {
        Ok(self.mcap.flush()?)
    }

    /// Ends the log with the last tick and digest, and its index.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(mut self) -> Result<Closed, LogError> {
        let digest = self.chain.digest();
        let last_word = [
            (CLOSING_TICK, self.last_tick),
            (CLOSING_DIGEST, digest),
            (CLOSING_MESSAGES, self.roll_call.digest()),
        ];
        let mut facts = last_word.map(|(key, number)| (key.into(), number.to_string())).into();
        seal(&mut facts);
        self.mcap
            .write_metadata(&mcap::records::Metadata { name: CLOSING.into(), metadata: facts })?;
        self.mcap.finish()?;
        let mut whole = self.mcap.into_inner();
        let bytes = whole.stream_position()?;
        whole.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?;
        Ok(Closed { bytes, digest })
    }

    /// Writes a recorded struct; its bytes stay in `self.message`.
    fn record<T: Serialize>(&mut self, channel: u16, tick: u64, value: &T) -> Result<(), LogError> {
        let mut message = std::mem::take(&mut self.message);
        message.clear();
        cdr::append(&mut message, value)?;
        let written = self.put(channel, tick, &message);
        self.message = message;
        written
    }

    fn put(&mut self, channel: u16, tick: u64, message: &[u8]) -> Result<(), LogError> {
        let log_time_ns = time_ns(tick);
        // The sequence wraps after half a year of flight.
        let sequence = tick as u32;
        self.stamped(
            channel,
            Stamp { sequence, log_time_ns, publish_time_ns: log_time_ns },
            message,
        )
    }

    /// Every message goes through here.
    fn stamped(&mut self, channel_id: u16, stamp: Stamp, message: &[u8]) -> Result<(), LogError> {
        let header = MessageHeader {
            channel_id,
            sequence: stamp.sequence,
            log_time: stamp.log_time_ns,
            publish_time: stamp.publish_time_ns,
        };
        self.mcap.write_to_known_channel(&header, message)?;
        if let Some(kind) = self.kinds.get(&channel_id) {
            self.roll_call.add(kind.topic, kind.text.as_bytes(), stamp, message);
        }
        Ok(())
    }
}
