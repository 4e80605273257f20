//! A flight, tick by tick.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use engine::inputs::DeviceEvent;
use engine::{Outputs, State};

use super::ending::{Ending, FooterRecord, Remade, WITHOUT_CHECKSUMS, footer_record};
use super::stream::Stream;
use crate::channels::{Chain as InChain, Channel, ChannelId};
use crate::container::checksums::{has_checksum, is_whole};
use crate::container::{LogFile, Record, RecordSource};
use crate::devices::DeviceIdentity;
use crate::evolution::{Difference, Mappings};
use crate::open::{OpenOptions, source};
use crate::records::{
    Chain, EventRecord, InputsRecord, RESTART, RestartRecord, STATE, StateRecord, TimingRecord,
    first_digest,
};
use crate::setup::{CLOSING, Identity, METADATA, Setup};
use crate::view::{self, LogLine};
use crate::{LogError, cdr};

/// One tick as recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tick {
    /// What took the place of the state before it, if anything did.
    pub restart: Option<Box<RestartRecord>>,
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

impl Tick {
    /// The state with which its step begins: the one after the tick before, or what took its place.
    pub fn begins_with(&self, before: &State) -> State {
        self.restart.as_ref().map_or(*before, |restart| restart.state)
    }
}

/// A flight being read.
#[derive(Default)]
pub struct FlightReader {
    stream: Stream,
    /// The tick that was read last; its room is used again.
    pub tick: Tick,
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
    /// The inputs of the tick under way were read.
    has_inputs: bool,
    /// Tick and digest of the last state read.
    last: (u64, u64),
    /// Whether every digest so far follows from the one before.
    unbroken: bool,
    /// The footer record, with which the writer closed the log.
    closing: Option<FooterRecord>,
    /// Events in the order they were recorded.
    pub events: Vec<EventRecord>,
    /// The same in words.
    pub log_lines: Vec<LogLine>,
    /// Input devices that were found, in the order they were recorded.
    pub devices: Vec<DeviceIdentity>,
    /// How the ticks kept time; cleared by whoever takes them.
    pub timings: Vec<TimingRecord>,
    /// What could be observed, if it is to be kept; cleared by whoever takes it.
    pub outputs: Vec<Outputs>,
    /// Whether `outputs` is to be kept: no flight depends on it.
    pub keep_outputs: bool,
    /// Of a recorded state only the digest, the tick and the bytes are wanted; the rest of
    /// [`Tick::record`] is then of no tick.
    pub states_as_bytes: bool,
    ending: Option<Ending>,
    remade: Remade,
}

/// Opens a log and reads up to the state at the start.
///
/// # Errors
/// When the file cannot be read, is not MCAP, is not a flight of ours, or is none that the options
/// let in.
pub fn open(path: &Path, options: OpenOptions) -> Result<FlightReader, LogError> {
    let reader = FlightReader::over(source(path, options)?)?;
    if !options.across_versions {
        reader.identity.refuse_other_versions()?;
    }
    Ok(reader)
}

impl FlightReader {
    /// Reads a log from anywhere, of whatever version it is, up to the state at the start.
    ///
    /// # Errors
    /// When it is not MCAP, or not a flight of ours.
    pub fn read(source: impl Read + Send + 'static) -> Result<Self, LogError> {
        Self::over(Box::new(LogFile::over(source)))
    }

    /// Reads up to the state at the start.
    pub(crate) fn over(source: Box<dyn RecordSource>) -> Result<Self, LogError> {
        let mut reader = Self { stream: Stream::over(source), ..Self::default() };
        let mut found: Vec<&str> = Vec::new();
        while reader.stream.advance() {
            if let Record::Attachment(header, data) = &mut reader.stream.record {
                let Some(name) = Setup::NAMES.iter().find(|name| **name == header.name) else {
                    continue;
                };
                reader.setup.put(name, std::mem::take(data))?;
                found.push(name);
            } else if !reader.take_metadata(true) && reader.take_first(&found)? {
                reader.unbroken = reader.intact;
                return Ok(reader);
            }
        }
        let Stream { refused, ending, .. } = reader.stream;
        Err(match (refused, ending) {
            (Some(error), _) => error,
            (None, Ending::Damaged(why)) => LogError::NotAFlight(why),
            _ if !reader.identity.0.is_empty() => no_flight("it ends before the first state"),
            _ => no_flight("no `tiltrotor` metadata"),
        })
    }

    /// Takes metadata, if that is what was read.
    fn take_metadata(&mut self, first: bool) -> bool {
        let Record::Metadata(record) = &mut self.stream.record else { return false };
        let (name, facts) =
            (std::mem::take(&mut record.name), std::mem::take(&mut record.metadata));
        match name.as_str() {
            METADATA if first => {
                // A flipped bit may make of the format another one, without checksums.
                let checked =
                    facts.get(Identity::FORMAT).is_none_or(|format| format != WITHOUT_CHECKSUMS);
                if (checked || has_checksum(&facts)) && !is_whole(&facts) {
                    self.stream
                        .integrity_fault("the metadata that says who flew is not as written");
                }
                self.identity = Identity(facts);
            }
            // A tool that copied the log may have put it first.
            CLOSING => self.closing = footer_record(&facts),
            _ => self.other_facts.push((name, facts)),
        }
        true
    }

    /// Takes a message before the first tick; `true` when it was the state at the start.
    fn take_first(&mut self, found: &[&str]) -> Result<bool, LogError> {
        let channel = &self.stream.channel;
        let Record::Message(_, data) = &self.stream.record else { return Ok(false) };
        let Some(ours) = channel.id.map(<&Channel>::from) else { return Ok(false) };
        if ours.id == ChannelId::RobotDescription {
            self.robot_description = view::text(data)?;
        }
        // Nothing would look at it again.
        if ours.chain == InChain::Adds {
            return Err(LogError::Order(format!("{} before the first {STATE}", ours.topic)));
        }
        if ours.chain != InChain::Closes {
            return Ok(false);
        }
        if self.identity.0.is_empty() {
            return Err(no_flight("no `tiltrotor` metadata"));
        }
        if let Some(missing) = Setup::NAMES.iter().find(|name| !found.contains(name)) {
            return Err(no_flight(&format!("{missing} is not in it")));
        }
        self.identity.refuse_other_formats()?;
        self.same_model = self.identity.get(Identity::MODEL) == engine::MODEL_VERSION;
        let first: StateRecord = self.mappings.decode(ours, channel.foreign_layout(), data)?;
        without_digest(data, &mut self.tick.state_message);
        self.intact = first_digest(&self.setup.files(), &self.tick.state_message) == first.digest;
        self.first.clone_from(data);
        self.stand_at(&first);
        Ok(true)
    }

    /// Goes on from a recorded state.
    fn stand_at(&mut self, record: &StateRecord) {
        self.initial = record.state;
        self.chain = Chain::from(record.digest);
        self.last = (record.state.tick, record.digest);
    }

    /// The next whole tick; `None` at the end of what can be read. It stays in [`FlightReader::tick`].
    ///
    /// # Errors
    /// When the messages do not make a flight: out of order, missing, or of another layout.
    pub fn next_tick(&mut self) -> Result<Option<&Tick>, LogError> {
        if self.until_tick.is_some_and(|until| self.last.0 >= until) {
            // As far as it was wanted, it is whole.
            self.ending = Some(Ending::Closed);
            return Ok(None);
        }
        self.tick.events.clear();
        self.tick.restart = None;
        self.has_inputs = false;
        while self.stream.advance() {
            if !self.take_metadata(false) && self.take_message()? {
                return Ok(Some(&self.tick));
            }
        }
        self.ending = Some(self.end()?);
        self.remade = self.judge_remade();
        Ok(None)
    }

    /// Takes what was read into the tick under way; `true` when it was the state that ends it.
    fn take_message(&mut self) -> Result<bool, LogError> {
        let Record::Message(_, data) = &self.stream.record else { return Ok(false) };
        let channel = &self.stream.channel;
        let Some(ours) = channel.id.map(<&Channel>::from) else { return Ok(false) };
        if ours.chain == InChain::Adds {
            self.chain.add(data);
        }
        let (mappings, layout) = (&mut self.mappings, channel.foreign_layout());
        match ours.id {
            ChannelId::Hardware => self.tick.events.push(mappings.decode(ours, layout, data)?),
            ChannelId::Restart => {
                let restart: RestartRecord = mappings.decode(ours, layout, data)?;
                let tick = restart.state.tick;
                if tick != self.last.0 || self.tick.restart.is_some() {
                    let what = format!("a message of {RESTART} for tick {tick}, out of its place");
                    return Err(LogError::Order(what));
                }
                self.tick.restart = Some(Box::new(restart));
            }
            ChannelId::Inputs => {
                self.tick.inputs = mappings.decode(ours, layout, data)?;
                if std::mem::replace(&mut self.has_inputs, true) {
                    let tick = self.tick.inputs.tick.saturating_add(1);
                    let what = format!("two inputs before the state of tick {tick}");
                    return Err(LogError::Order(what));
                }
            }
            ChannelId::State => {
                let whole = layout.is_none() && data.len() == self.first.len();
                if self.states_as_bytes && whole && data.starts_with(&cdr::HEADER) {
                    let word = |place| cdr::word(data, place).unwrap_or_default();
                    self.tick.record.digest = word(0);
                    self.tick.record.state.tick = word(StateRecord::TICK);
                } else {
                    self.tick.record = mappings.decode(ours, layout, data)?;
                }
                return self.close_tick().map(|()| true);
            }
            ChannelId::Timing => self.timings.push(mappings.decode(ours, layout, data)?),
            ChannelId::Events => self.events.push(mappings.decode(ours, layout, data)?),
            ChannelId::Log => self.log_lines.push(view::log_line(data)?),
            ChannelId::Devices => self.devices.push(DeviceIdentity::decode(data)?),
            // No flight depends on it: one of another form is none.
            ChannelId::Outputs if self.keep_outputs => {
                let outputs: Option<Outputs> = mappings.decode(ours, layout, data).ok();
                self.outputs.extend(outputs);
            }
            // What viewers draw.
            _ => {}
        }
        Ok(false)
    }

    /// How the file ends, now that nothing more can be read.
    fn end(&self) -> Result<Ending, LogError> {
        let ending = self.stream.ending.clone();
        let begun = self.has_inputs || !self.tick.events.is_empty();
        if ending == Ending::Closed && begun {
            return Err(LogError::Order("the last tick has no state".into()));
        }
        if matches!(ending, Ending::Damaged(_)) {
            return Ok(ending);
        }
        if let Some(integrity_fault) = &self.stream.integrity_fault {
            return Ok(Ending::Damaged(integrity_fault.clone()));
        }
        // An end without the writer's footer record was put there by someone else.
        let Some(closing) = self.closing.filter(|_| ending == Ending::Closed) else {
            return Ok(Ending::Truncated);
        };
        let checked = self.identity.get(Identity::FORMAT) != WITHOUT_CHECKSUMS;
        if closing.last != self.last || checked && closing.messages.is_none() {
            return Ok(Ending::Truncated);
        }
        // When the chain says that the flight is what was flown, it is something beside it. What a
        // compacted log says is guarded by a hash of its own, and what it does not say is made again.
        let all_read = self.unbroken && !self.stream.sought && !self.is_compacted();
        if checked && all_read && !self.stream.message_digests.are(closing.messages) {
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

    /// Whether what was made again is what the writer of the log had counted. It says nothing where the
    /// states are others, too.
    fn judge_remade(&self) -> Remade {
        let Some(compacted) = self.stream.source.compacted() else { return Remade::AsRecorded };
        if let Some(tick) = compacted.outputs_differ {
            return Remade::OutputsDiffer { tick };
        }
        let made = self.same_model && compacted.flown.is_some();
        let all_read = self.unbroken && !self.stream.sought;
        let ended = self.stream.ending == Ending::Closed && self.stream.integrity_fault.is_none();
        let counted = self.closing.and_then(|closing| closing.messages);
        if made
            && all_read
            && ended
            && counted.is_some()
            && !self.stream.message_digests.are(counted)
        {
            return Remade::Differs;
        }
        Remade::AsRecorded
    }

    fn close_tick(&mut self) -> Result<(), LogError> {
        let Record::Message(_, data) = &self.stream.record else { return Ok(()) };
        let Tick { events, inputs, record, state_message, chained, foreign, .. } = &mut self.tick;
        let tick = record.state.tick;
        if !self.has_inputs {
            return Err(LogError::Order(format!("tick {tick} has no inputs")));
        }
        if events.len() as u64 != inputs.events {
            return Err(LogError::Order(format!(
                "tick {tick}: expected {} device events, got {}",
                inputs.events,
                events.len()
            )));
        }
        without_digest(data, state_message);
        *chained = self.chain.close(state_message) == record.digest;
        self.unbroken &= *chained;
        // From a break on, the chain goes on from what is recorded: one break is told once.
        self.chain.set(record.digest);
        self.last = (tick, record.digest);
        if !self.mappings.same_state() {
            *foreign = Some(data.clone());
            state_message.clear();
            cdr::append(state_message, &record.state)?;
        }
        Ok(())
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

    /// Takes what the last state lacks, if it is of another layout, from `otherwise`, so that it differs from that state
    /// only where both know the field.
    ///
    /// # Errors
    /// When the message is not of the log's layout.
    pub fn fill(&mut self, otherwise: &State) -> Result<(), LogError> {
        let tick = &mut self.tick;
        if let Some(message) = &tick.foreign {
            tick.record.state = self.mappings.state_over(message, otherwise)?;
            tick.state_message = cdr::encode(&tick.record.state)?;
        }
        Ok(())
    }

    /// Where the log's layout is not today's, channel by channel.
    pub fn differences(&self) -> Vec<(&'static str, Difference)> {
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
        self.stream.seek(tick)?;
        while self.stream.advance() {
            if self.take_metadata(false) || self.stream.channel.id != Some(ChannelId::State) {
                continue;
            }
            let Record::Message(_, data) = &self.stream.record else { continue };
            // Of all the states that are passed by, only the tick is looked at.
            let found = self.mappings.tick_of(data).unwrap_or(0);
            if found > tick {
                return Err(LogError::Order(format!("tick {tick} is not there")));
            }
            self.last.0 = found;
            if found == tick {
                let layout = self.stream.channel.foreign_layout();
                let record = self.mappings.decode(ChannelId::State.into(), layout, data)?;
                self.first.clone_from(data);
                self.stand_at(&record);
                return Ok(());
            }
        }
        Err(match &self.stream.ending {
            Ending::Damaged(why) => LogError::Order(format!("damaged: {why}")),
            _ => LogError::Outside { tick, first, last: self.last_tick() },
        })
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
        self.stream.source.compacted().is_none_or(|compacted| compacted.recorded)
    }

    /// In a compacted log, the last tick as it was flown again while reading.
    pub fn flown(&self) -> Option<(&State, &Outputs)> {
        self.stream.source.compacted()?.flown
    }

    /// For whoever does not look at the outputs that a compacted log's ticks give but every tenth tick: its
    /// states are flown on so many threads beside this one.
    pub fn fly_states_only(&mut self, threads: usize) {
        self.stream.source.fly_states_only(threads);
    }

    /// What is made again of a compacted log beside what was recorded, once the last tick has been read.
    pub fn remade(&self) -> Remade {
        self.remade
    }

    /// Whether the log is compacted.
    pub fn is_compacted(&self) -> bool {
        self.stream.source.compacted().is_some()
    }

    /// What no checksum found and is not as written, so far.
    pub fn integrity_fault(&self) -> Option<&str> {
        self.stream.integrity_fault.as_deref()
    }

    /// The file that this log was recovered from, if it was.
    pub fn recovered_from(&self) -> Option<&str> {
        self.identity.0.get(Identity::RECOVERED_FROM).map(String::as_str)
    }

    /// Lets go of what was read beside the ticks: for whoever reads on and on and does not ask for it.
    pub fn forget(&mut self) {
        self.timings.clear();
        self.events.clear();
        self.log_lines.clear();
    }

    /// How the file ends, once the last tick has been read.
    pub fn ending(&self) -> Option<&Ending> {
        self.ending.as_ref()
    }
}

/// A `/state` message without its digest, which comes first.
fn without_digest(data: &[u8], state: &mut Vec<u8>) {
    state.clear();
    state.extend_from_slice(&cdr::HEADER);
    state.extend_from_slice(data.get(cdr::HEADER.len() + size_of::<u64>()..).unwrap_or_default());
}

fn no_flight(why: &str) -> LogError {
    LogError::NotAFlight(format!("an MCAP file, but not a tiltrotor flight: {why}"))
}

#[cfg(test)]
mod tests;
