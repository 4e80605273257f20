//! Writing a flight.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Seek};

use engine::frames::Attitude;
use engine::inputs::DeviceEvent;
use engine::{Aircraft, Outputs, State};
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, WriteOptions, Writer};
use serde::Serialize;

use crate::channels::{CHANNELS, Chain as InChain, Channel, ChannelId, Written};
use crate::container::checksums::{MessageDigest, add_checksum};
use crate::container::{RECORD_BYTES_MAX, stamped};
use crate::devices::DeviceIdentity;
use crate::reader::Message;
use crate::records::{
    Chain, EventRecord, FlightEvent, InputsRecord, RestartRecord, StateRecord, TimingRecord,
    first_digest,
};
use crate::schema::{self, MessageType};
use crate::setup::{
    CLOSING, CLOSING_DIGEST, CLOSING_MESSAGES, CLOSING_TICK, Identity, METADATA, Setup,
};
use crate::view::{self, Level};
use crate::{LogError, cdr};

/// Uncompressed size at which a chunk is closed; the caller's timer closes most of them earlier.
pub(crate) const CHUNK_BYTES: u64 = 128 * 1024;
/// The longest text that fits into a log, with room for its record's frame.
const TEXT_BYTES_MAX: usize = RECORD_BYTES_MAX - 1024;
/// A flight being written.
pub struct FlightWriter {
    /// Never seeks: a pipe will do.
    mcap: Writer<NoSeek<BufWriter<File>>>,
    /// Numbers of the channels in the file, and what their messages are, in the order of the table.
    channels: Vec<(u16, &'static MessageType)>,
    chain: Chain,
    message_digest: MessageDigest,
    /// Whether the state at the start is in it.
    begun: bool,
    last_tick: u64,
    message: Vec<u8>,
    shape: view::Shape,
    /// Hears what is told in words.
    listener: Option<Listener>,
}

/// Hears what is told in words: tick, what happened, how grave it is, words.
pub type Listener = Box<dyn FnMut(u64, FlightEvent, Level, &str) + Send>;

/// How a log ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Closed {
    /// Its size.
    pub bytes: u64,
    /// The digest of the whole flight.
    pub digest: u64,
}

impl FlightWriter {
    /// Starts a log in an empty file with all that is needed to refly it, handed to the system before
    /// this returns.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(
        file: File,
        setup: &Setup,
        identity: &Identity,
        aircraft: &Aircraft,
        robot_description: &str,
        initial: &State,
    ) -> Result<Self, LogError> {
        let mut writer = Self::begin(file, setup, identity)?;
        writer.shape = view::Shape::of(aircraft);
        let text = cdr::encode_view(&view::Text { data: robot_description })?;
        writer.put(ChannelId::RobotDescription, initial.tick, &text)?;
        let digest = first_digest(&setup.files(), &cdr::encode(initial)?);
        writer.chain = Chain::from(digest);
        writer.last_tick = initial.tick;
        writer.begun = true;
        let first = StateRecord { digest, state: *initial };
        writer.record(ChannelId::State, initial.tick, &first)?;
        writer.flush()?;
        Ok(writer)
    }

    /// Starts a log that holds no message yet.
    pub(crate) fn begin(file: File, setup: &Setup, identity: &Identity) -> Result<Self, LogError> {
        // What cannot be read back is not written.
        if let Some((name, text)) =
            setup.files().iter().find(|(_, text)| text.len() > TEXT_BYTES_MAX)
        {
            let (bytes, most) = (text.len(), TEXT_BYTES_MAX);
            return Err(LogError::Encode(format!("{name}: {bytes} bytes, at most {most} fit")));
        }
        let mut mcap = WriteOptions::new()
            .compression(Some(Compression::Lz4))
            .profile("ros2")
            .library(concat!("tiltrotor ", env!("CARGO_PKG_VERSION")))
            .chunk_size(Some(CHUNK_BYTES))
            .disable_seeking(true)
            .create(NoSeek::new(BufWriter::new(file)))?;
        let mut facts = identity.0.clone();
        add_checksum(&mut facts);
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
        let mut channels = Vec::with_capacity(CHANNELS.len());
        for channel in &CHANNELS {
            let kind = channel.message_type()?;
            let schema = mcap.add_schema(&kind.name, schema::ENCODING, kind.text.as_bytes())?;
            let id = mcap.add_channel(schema, channel.topic, cdr::ENCODING, &BTreeMap::new())?;
            channels.push((id, kind));
        }
        Ok(Self {
            mcap,
            channels,
            chain: Chain::default(),
            message_digest: MessageDigest::default(),
            begun: false,
            last_tick: 0,
            message: Vec::with_capacity(8192),
            shape: view::Shape::default(),
            listener: None,
        })
    }

    /// The state with which the tick under way begins in place of the last one; the tick's first message.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn restart(&mut self, restart: &RestartRecord) -> Result<(), LogError> {
        self.record(ChannelId::Restart, restart.state.tick, restart)
    }

    /// A device event of the tick under way.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn event(&mut self, event: &DeviceEvent) -> Result<(), LogError> {
        self.record(ChannelId::Hardware, event.tick, event)
    }

    /// The world of the tick under way, after its device events.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn inputs(&mut self, inputs: &InputsRecord) -> Result<(), LogError> {
        self.record(ChannelId::Inputs, inputs.tick, inputs)
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
        self.record(ChannelId::State, state.tick, &StateRecord { digest, state: *state })
    }

    /// How the tick kept time.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn timing(&mut self, timing: &TimingRecord) -> Result<(), LogError> {
        self.record(ChannelId::Timing, timing.tick, timing)
    }

    /// An input device that was found.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn device(&mut self, device: &DeviceIdentity) -> Result<(), LogError> {
        let message = device.encode()?;
        // One that was there before this log begins is told at its beginning: times never go back.
        self.put(ChannelId::Devices, device.tick.max(self.last_tick), &message)
    }

    /// Something that happened, as a record and in words.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn flight_event(
        &mut self,
        tick: u64,
        what: FlightEvent,
        value: u64,
        measured: [f64; 2],
        words: &str,
    ) -> Result<(), LogError> {
        let level = what.facts().levels.of(value);
        if let Some(listener) = &mut self.listener {
            listener(tick, what, level, words);
        }
        let record = EventRecord { tick, kind: what as u64, value, measured };
        // What is found out later is told later: log times never go back.
        let told_tick = tick.max(self.last_tick);
        self.record(ChannelId::Events, told_tick, &record)?;
        let message = cdr::encode_view(&view::log(tick, level, words))?;
        self.put(ChannelId::Log, told_tick, &message)
    }

    /// Lets somebody hear what is told in words from now on.
    pub fn tell(&mut self, listener: Listener) {
        self.listener = Some(listener);
    }

    /// Facts that no flight depends on, under a name of their own; for the end of the log.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn facts(&mut self, name: &str, facts: &BTreeMap<String, String>) -> Result<(), LogError> {
        let mut metadata = facts.clone();
        add_checksum(&mut metadata);
        let record = mcap::records::Metadata { name: name.into(), metadata };
        Ok(self.mcap.write_metadata(&record)?)
    }

    /// A message of another log as it stands there; `false` when no channel of ours is called so.
    ///
    /// The digest is formed anew from the copied bytes, and has to come out as recorded.
    ///
    /// # Errors
    /// When the file cannot be written, or the message does not follow from those before.
    pub(crate) fn copy(&mut self, message: &Message) -> Result<bool, LogError> {
        let Some(channel) = Channel::of(message.topic()) else { return Ok(false) };
        match channel.chain {
            InChain::Adds => self.chain.add(&message.data),
            InChain::Closes => {
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
            InChain::Outside => {}
        }
        self.stamped(channel.id, message.header, &message.data)?;
        Ok(true)
    }

    /// What viewers drew in another log, message for message; `false` of what they did not draw.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn picture(&mut self, message: &Message) -> Result<bool, LogError> {
        let drawn = |channel: &&Channel| matches!(channel.written, Written::FromOutputs { .. });
        match message.channel().filter(drawn).filter(|_| message.is_todays()) {
            Some(channel) => self.stamped(channel.id, message.header, &message.data).map(|()| true),
            None => Ok(false),
        }
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
        let mut message = std::mem::take(&mut self.message);
        for channel in &CHANNELS {
            if let Written::FromOutputs { ticks, message: make } = channel.written
                && tick.is_multiple_of(ticks)
            {
                message.clear();
                make(&mut message, outputs, attitude, &self.shape)?;
                self.put(channel.id, tick, &message)?;
            }
        }
        self.message = message;
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
        let footer_record = [
            (CLOSING_TICK, self.last_tick),
            (CLOSING_DIGEST, digest),
            (CLOSING_MESSAGES, self.message_digest.digest()),
        ];
        let mut facts = footer_record.map(|(key, number)| (key.into(), number.to_string())).into();
        add_checksum(&mut facts);
        self.mcap
            .write_metadata(&mcap::records::Metadata { name: CLOSING.into(), metadata: facts })?;
        self.mcap.finish()?;
        let mut whole = self.mcap.into_inner();
        let bytes = whole.stream_position()?;
        whole.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?;
        Ok(Closed { bytes, digest })
    }

    /// Writes a recorded struct.
    fn record<T: Serialize>(
        &mut self,
        channel: ChannelId,
        tick: u64,
        value: &T,
    ) -> Result<(), LogError> {
        let mut message = std::mem::take(&mut self.message);
        message.clear();
        cdr::append(&mut message, value)?;
        let written = self.put(channel, tick, &message);
        if CHANNELS[channel as usize].chain == InChain::Adds {
            self.chain.add(&message);
        }
        self.message = message;
        written
    }

    fn put(&mut self, channel: ChannelId, tick: u64, message: &[u8]) -> Result<(), LogError> {
        self.stamped(channel, stamped(0, tick), message)
    }

    /// Every message goes through here.
    fn stamped(
        &mut self,
        channel: ChannelId,
        header: MessageHeader,
        message: &[u8],
    ) -> Result<(), LogError> {
        let (channel_id, kind) = self.channels[channel as usize];
        let header = MessageHeader { channel_id, ..header };
        self.mcap.write_to_known_channel(&header, message)?;
        let topic = CHANNELS[channel as usize].topic;
        self.message_digest.add(topic, kind.text.as_bytes(), &header, message);
        Ok(())
    }
}
