//! Writing a flight.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter};
use std::path::Path;

use engine::frames::Attitude;
use engine::inputs::DeviceEvent;
use engine::{Aircraft, Outputs, State};
use mcap::records::MessageHeader;
use mcap::{Attachment, Compression, WriteOptions, Writer};
use serde::Serialize;

use crate::records::{
    Chain, EVENTS, EventRecord, HARDWARE, Happening, INPUTS, InputsRecord, OUTPUTS, STATE,
    StateRecord, TIMING, TimingRecord, first_digest, time_ns,
};
use crate::setup::{CLOSING, CLOSING_DIGEST, CLOSING_TICK, Identity, METADATA, Setup};
use crate::view::{self, Level};
use crate::{LogError, cdr, schema};

/// Uncompressed size at which a chunk is closed; the caller's timer closes most of them earlier.
pub(crate) const CHUNK_BYTES: u64 = 128 * 1024;
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
}

/// A flight being written.
pub struct FlightWriter {
    mcap: Writer<BufWriter<File>>,
    channels: Channels,
    chain: Chain,
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
            .create(BufWriter::new(file))?;
        mcap.write_metadata(&mcap::records::Metadata {
            name: METADATA.into(),
            metadata: identity.0.clone(),
        })?;
        for (name, text) in setup.files() {
            mcap.attach(&Attachment {
                log_time: 0,
                create_time: 0,
                name: name.into(),
                media_type: "application/toml".into(),
                data: text.as_bytes().into(),
            })?;
        }
        let channels = Channels {
            hardware: recorded::<DeviceEvent>(&mut mcap, HARDWARE, "DeviceEvent")?,
            inputs: recorded::<InputsRecord>(&mut mcap, INPUTS, "InputsRecord")?,
            state: recorded::<StateRecord>(&mut mcap, STATE, "StateRecord")?,
            timing: recorded::<TimingRecord>(&mut mcap, TIMING, "TimingRecord")?,
            events: recorded::<EventRecord>(&mut mcap, EVENTS, "EventRecord")?,
            outputs: recorded::<Outputs>(&mut mcap, OUTPUTS, "Outputs")?,
            tf: viewed(&mut mcap, view::TF, &view::tf_schema())?,
            joy: viewed(&mut mcap, view::JOY, &view::joy_schema())?,
            fix: viewed(&mut mcap, view::FIX, &view::fix_schema())?,
            joints: viewed(&mut mcap, view::JOINT_STATES, &view::joint_schema())?,
            log: viewed(&mut mcap, view::LOG, &view::log_schema())?,
        };
        let description = viewed(&mut mcap, view::ROBOT_DESCRIPTION, &view::string_schema())?;
        let state_message = cdr::encode(initial)?;
        let digest = first_digest(&setup.files(), &state_message);
        let mut writer = Self {
            mcap,
            channels,
            chain: Chain::from(digest),
            last_tick: initial.tick,
            message: Vec::with_capacity(8192),
            shape: view::Shape::of(aircraft),
        };
        let text = cdr::encode_view(&view::Text { data: robot_description })?;
        writer.put(description, initial.tick, &text)?;
        let first = StateRecord { digest, state: *initial };
        writer.record(writer.channels.state, initial.tick, &first)?;
        writer.flush()?;
        Ok(writer)
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
        level: Level,
        words: &str,
    ) -> Result<(), LogError> {
        let record = EventRecord { tick, kind: what as u64, value };
        self.record(self.channels.events, tick, &record)?;
        let message = cdr::encode_view(&view::log(tick, level, words))?;
        self.put(self.channels.log, tick, &message)
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
        let last_word = [(CLOSING_TICK, self.last_tick), (CLOSING_DIGEST, digest)];
        self.mcap.write_metadata(&mcap::records::Metadata {
            name: CLOSING.into(),
            metadata: last_word.map(|(key, number)| (key.into(), number.to_string())).into(),
        })?;
        self.mcap.finish()?;
        let file = self.mcap.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?;
        Ok(Closed { bytes: file.metadata()?.len(), digest })
    }

    /// Writes a recorded struct; its bytes stay in `self.message`.
    fn record<T: Serialize>(&mut self, channel: u16, tick: u64, value: &T) -> Result<(), LogError> {
        self.message.clear();
        cdr::append(&mut self.message, value)?;
        let header = header(channel, tick);
        Ok(self.mcap.write_to_known_channel(&header, &self.message)?)
    }

    fn put(&mut self, channel: u16, tick: u64, message: &[u8]) -> Result<(), LogError> {
        Ok(self.mcap.write_to_known_channel(&header(channel, tick), message)?)
    }
}

fn header(channel_id: u16, tick: u64) -> MessageHeader {
    let log_time = time_ns(tick);
    // The sequence wraps after half a year of flight.
    MessageHeader { channel_id, sequence: tick as u32, log_time, publish_time: log_time }
}

fn recorded<T: Serialize + Default>(
    mcap: &mut Writer<BufWriter<File>>,
    topic: &str,
    name: &str,
) -> Result<u16, LogError> {
    let text = schema::ros2msg::<T>()?;
    channel(mcap, topic, &format!("{}/msg/{name}", schema::PACKAGE), &text)
}

fn viewed(
    mcap: &mut Writer<BufWriter<File>>,
    topic: &str,
    schema: &view::Schema,
) -> Result<u16, LogError> {
    channel(mcap, topic, schema.name, &schema.text)
}

fn channel(
    mcap: &mut Writer<BufWriter<File>>,
    topic: &str,
    schema_name: &str,
    schema_text: &str,
) -> Result<u16, LogError> {
    let schema = mcap.add_schema(schema_name, "ros2msg", schema_text.as_bytes())?;
    Ok(mcap.add_channel(schema, topic, "cdr", &BTreeMap::new())?)
}
