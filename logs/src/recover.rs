//! A proper file from a broken one: every tick up to the first bad one, and nothing after it.
//!
//! A tick is kept when its bytes passed their checksums *and* its digest follows from the first state
//! on. Messages are copied as they stand; nothing is repaired, so nothing bad can come out good. What
//! is drawn and exported of a tick is guarded by no digest: it is kept where the tick, flown again,
//! gives the same bytes.

use std::collections::BTreeMap;
use std::path::Path;

use crate::channels::{Chain, Channel, ChannelId, Compacted};
use crate::compact::{FlightModelOf, Regenerator};
use crate::open::OpenOptions;
use crate::output::Output;
use crate::reader::{Ending, FlightReader, Message, Messages, open};
use crate::records::{STATE, time_ns};
use crate::setup::{CLOSING, Identity, Setup, opens_a_flight};
use crate::writer::FlightWriter;
use crate::{LogError, cdr};

/// What was recovered, and what was not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recovery {
    /// First tick of the log.
    pub first_tick: u64,
    /// Last tick that was kept.
    pub tick: u64,
    /// What is wrong right after it.
    pub reason: String,
    /// Ticks that can still be read after that, but not trusted.
    pub ticks_distrusted: u64,
    /// Messages on channels that this program does not write, or of another definition: not copied.
    pub messages_foreign: u64,
    /// Files and metadata of other programs: not copied.
    pub files_foreign: u64,
    /// Messages for viewers and tables that the kept ticks do not prove: not copied.
    pub messages_unproven: u64,
    /// Size of the broken file.
    pub bytes_read: u64,
    /// Size of the new one.
    pub bytes_written: u64,
}

impl Recovery {
    /// Key of the name of the file that a log was recovered from.
    pub const PARENT: &'static str = Identity::RECOVERED_FROM;
    /// Key of the last tick that the recovery kept.
    pub const TICK: &'static str = "recovered_tick";
    /// Key of what was wrong right after it.
    pub const REASON: &'static str = "recovered_reason";
    /// Key of what was wrong with the facts themselves.
    pub const IDENTITY: &'static str = "recovered_identity";
}

/// Writes what can be trusted of a broken log, compacted or not; whoever asked for it proves and
/// finishes the output. Of a compacted log it is a log with all its states.
///
/// # Errors
/// When not even the first state can be trusted, when the log is whole, or when the new one cannot be
/// written.
pub fn recover(
    broken: &Path,
    output: &Output,
    aircraft_of: FlightModelOf,
) -> Result<Recovery, LogError> {
    let options = OpenOptions { aircraft_of: Some(aircraft_of), across_versions: false };
    let mut recovery = survey(broken, options)?;
    let mut reader = open(broken, options)?;
    let parent = name_of(broken, &reader);
    let mut identity = std::mem::take(&mut reader.identity);
    if let Some(integrity_fault) = reader.integrity_fault() {
        identity = identity.with(Recovery::IDENTITY, integrity_fault);
    }
    let identity = identity
        .with(Recovery::PARENT, parent)
        .with(Recovery::TICK, recovery.tick.to_string())
        .with(Recovery::REASON, &*recovery.reason);
    let mut writer = FlightWriter::begin(output.file()?, &reader.setup, &identity)?;
    let witness = Witness::of(&reader.setup, aircraft_of)?;
    copy(Messages::open(broken, options)?, &mut writer, witness, &mut recovery)?;
    recovery.bytes_written = writer.finish()?.bytes;
    Ok(recovery)
}

/// Finds the last tick that can be trusted.
fn survey(broken: &Path, options: OpenOptions) -> Result<Recovery, LogError> {
    let mut reader = open(broken, options)?;
    if !reader.intact {
        return Err(LogError::NotRecoverable(
            "its aircraft, cockpit map, scenario or first state is not what it was flown with: no \
             tick can be trusted"
                .into(),
        ));
    }
    let first_tick = reader.initial.tick;
    let mut recovery = Recovery {
        first_tick,
        tick: first_tick,
        bytes_read: std::fs::metadata(broken).map_err(LogError::Open)?.len(),
        ..Recovery::default()
    };
    loop {
        let (bad, more) = match reader.next_tick() {
            Ok(Some(tick)) => {
                let (tick, chained) = (tick.record.state.tick, tick.chained);
                reader.forget();
                if recovery.reason.is_empty() && chained {
                    recovery.tick = tick;
                    continue;
                }
                recovery.ticks_distrusted += 1;
                (format!("the digest breaks at tick {tick}"), true)
            }
            Ok(None) => match reader.ending() {
                Some(Ending::Closed) if recovery.reason.is_empty() => {
                    return Err(LogError::NotRecoverable("it is whole".into()));
                }
                Some(Ending::Damaged(why)) => (why.clone(), false),
                _ => ("it ends without having been closed".into(), false),
            },
            Err(error @ (LogError::Order(_) | LogError::Decode(_))) => (error.to_string(), false),
            Err(error) => return Err(error),
        };
        if recovery.reason.is_empty() {
            recovery.reason = bad;
        }
        if !more {
            break;
        }
    }
    let of_flight = |topic: &str| Channel::of(topic).is_some_and(|c| c.chain != Chain::Outside);
    if reader.differences().iter().any(|(topic, _)| of_flight(topic)) {
        return Err(LogError::NotRecoverable("its fields are not those of this version".into()));
    }
    Ok(recovery)
}

/// Copies the messages up to the state of the last good tick, and what belongs to those ticks.
fn copy(
    mut messages: Messages,
    writer: &mut FlightWriter,
    mut witness: Witness,
    recovery: &mut Recovery,
) -> Result<(), LogError> {
    let mut copied = None;
    while let Some(message) = messages.next_message() {
        let flown = Channel::of(message.topic()).is_some_and(|c| c.chain != Chain::Outside);
        if flown && copied == Some(recovery.tick) {
            break;
        }
        if !flown && message.time_ns > time_ns(recovery.tick) {
            // Viewers' channels may be a few ticks ahead.
            continue;
        }
        if !flown && !message.is_todays() {
            recovery.messages_foreign += 1;
            continue;
        }
        if !witness.confirms(message)? {
            recovery.messages_unproven += 1;
            continue;
        }
        if !writer.copy(message)? {
            recovery.messages_foreign += 1;
        }
        if message.topic() == STATE {
            copied = Some(writer.last_tick());
        }
    }
    // What stands after it is looked at for what is left behind.
    while messages.next_message().is_some() {}
    let files = messages.files().iter().filter(|(name, _)| !Setup::NAMES.contains(&&**name));
    let known = |name: &str| opens_a_flight(name) || name == CLOSING;
    let facts = messages.facts().iter().filter(|(name, _)| !known(name));
    recovery.files_foreign = (files.count() + facts.count()) as u64;
    let changed = || LogError::Order("the file changed while it was being read".into());
    (copied == Some(recovery.tick)).then_some(()).ok_or_else(changed)
}

/// Flies the kept ticks again, beside the messages that are made of them.
struct Witness {
    regenerator: Regenerator,
    /// The first state has come.
    begun: bool,
    /// Every tick so far was the recorded one.
    together: bool,
    /// A message as it was made again.
    again: Vec<u8>,
    /// Ticks of the last messages that were made of them, by channel: none comes twice.
    last: BTreeMap<ChannelId, u64>,
}

impl Witness {
    fn of(setup: &Setup, aircraft_of: FlightModelOf) -> Result<Self, LogError> {
        let regenerator = Regenerator::new(aircraft_of(setup)?);
        Ok(Self {
            regenerator,
            begun: false,
            together: true,
            again: Vec::new(),
            last: BTreeMap::new(),
        })
    }

    /// Whether nothing speaks against a message. Where this program does not fly the recorded flight,
    /// it cannot speak.
    fn confirms(&mut self, message: &Message) -> Result<bool, LogError> {
        let Some(channel) = message.channel().filter(|_| self.together) else { return Ok(true) };
        match channel.compacted {
            Compacted::Rows | Compacted::Kept => {
                self.regenerator.takes(channel.id, &message.data)?;
            }
            Compacted::Reflown => self.state(message)?,
            Compacted::Remade => {
                self.again.clear();
                let tick = message.time_ns / engine::STEP_NS;
                let next = self.last.get(&channel.id).is_none_or(|&last| last < tick);
                let made = self.regenerator.view(&mut self.again, channel, tick)?;
                let same = made && self.again == message.data && message.is_stamped(tick);
                if next && same {
                    self.last.insert(channel.id, tick);
                }
                return Ok(next && same);
            }
        }
        Ok(true)
    }

    fn state(&mut self, message: &Message) -> Result<(), LogError> {
        let record: crate::records::StateRecord = cdr::decode(&message.data)?;
        if !std::mem::replace(&mut self.begun, true) {
            self.regenerator.begin(record.state);
            return Ok(());
        }
        self.regenerator.fly();
        self.again.clear();
        self.regenerator.state_message(&mut self.again, record.digest)?;
        self.together = self.again == message.data;
        Ok(())
    }
}

/// The name of the file; for one that was recovered before, the names of all of them.
fn name_of(path: &Path, reader: &FlightReader) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    reader.recovered_from().map_or(name.clone(), |earlier| format!("{name}, from {earlier}"))
}

#[cfg(test)]
mod tests {
    use engine::inputs::World;
    use engine::{Inputs, State, step};

    use super::*;
    use crate::compact::FlightModel;
    use crate::records::{FlightEvent, InputsRecord};

    fn flown_by(_: &Setup) -> Result<FlightModel, LogError> {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
        Ok(FlightModel { aircraft, world: World::default() })
    }

    /// Ten ticks; each says in words when it begins, as other programs' messages may be ahead, and when it
    /// has ended. Nobody closed it.
    fn never_closed(log: &Path) -> Setup {
        let (setup, identity) = (Setup::default(), Identity::new().with("commit", "0123456789"));
        let aircraft = flown_by(&setup).expect("an aircraft").aircraft;
        let new = std::fs::File::create_new(log).expect("a file");
        let mut state = State::default();
        let mut writer =
            FlightWriter::create(new, &setup, &identity, &aircraft, "", &state).expect("a log");
        for tick in 0..10 {
            let said = format!("tick {} begins", tick + 1);
            writer.flight_event(tick + 1, FlightEvent::Phase, 0, [0.0; 2], &said).expect("written");
            writer.inputs(&InputsRecord { tick, ..InputsRecord::default() }).expect("written");
            let (flown, outputs) =
                step(&aircraft, &state, &Inputs { events: &[], world: World::default() });
            state = flown;
            writer.state(&state).expect("written");
            writer.view(&outputs, state.plant.attitude).expect("written");
            let said = format!("tick {} has ended", tick + 1);
            writer.flight_event(tick + 1, FlightEvent::Phase, 1, [0.0; 2], &said).expect("written");
        }
        writer.flush().expect("written");
        setup
    }

    #[test]
    fn what_belongs_to_the_last_tick_that_is_kept_is_kept_and_what_is_of_later_ones_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let (broken, fixed) = (folder.path().join("cut.mcap"), folder.path().join("fixed.mcap"));
        let setup = never_closed(&broken);
        let file = std::fs::File::create_new(&fixed).expect("a file");
        let mut writer = FlightWriter::begin(file, &setup, &Identity::new()).expect("a log");
        let witness = Witness::of(&setup, flown_by).expect("an aircraft");
        // As if tick 6 were the first bad one.
        let mut recovery = Recovery { tick: 5, ..Recovery::default() };
        let messages = Messages::open(&broken, OpenOptions::default()).expect("a log");
        copy(messages, &mut writer, witness, &mut recovery).expect("copied");
        writer.finish().expect("closed");

        let mut reader = open(&fixed, OpenOptions::default()).expect("a log");
        while reader.next_tick().expect("whole ticks").is_some() {}
        assert_eq!((reader.last_tick(), reader.ending()), (5, Some(&Ending::Closed)));
        let told: Vec<_> = reader.log_lines.iter().map(|line| line.words.clone()).collect();
        let of = |tick| [format!("tick {tick} begins"), format!("tick {tick} has ended")];
        assert_eq!(told, (1..=5).flat_map(of).collect::<Vec<_>>());
        // Frames are drawn every fifth tick.
        let mut drawn = Vec::new();
        let mut messages = Messages::open(&fixed, OpenOptions::default()).expect("a log");
        while let Some(message) = messages.next_message() {
            if message.topic() == crate::view::TF {
                drawn.push(message.time_ns / engine::STEP_NS);
            }
        }
        assert_eq!(drawn, [5]);
        let Recovery { messages_foreign, messages_unproven, files_foreign, .. } = recovery;
        assert_eq!((messages_foreign, messages_unproven, files_foreign), (0, 0, 0));
    }
}
