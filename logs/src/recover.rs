//! A proper file from a broken one: every tick up to the first bad one, and nothing after it.
//!
//! A tick is kept when its bytes passed their checksums *and* its digest follows from the first state
//! on. Messages are copied as they stand; nothing is repaired, so nothing bad can come out good.

use std::path::Path;

use crate::LogError;
use crate::channels::{Chain, Channel};
use crate::open::OpenOptions;
use crate::output::Output;
use crate::reader::{Ending, FlightReader, Messages, open};
use crate::records::{STATE, time_ns};
use crate::setup::Identity;
use crate::writer::FlightWriter;

/// What was recovered, and what was not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recovery {
    /// Last tick that was kept.
    pub tick: u64,
    /// What is wrong right after it.
    pub reason: String,
    /// Ticks that can still be read after that, but not trusted.
    pub ticks_distrusted: u64,
    /// Messages on channels that this program does not write: not copied.
    pub messages_foreign: u64,
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

/// Writes what can be trusted of a broken log to `out`.
///
/// # Errors
/// When not even the first state can be trusted, when the log is whole, or when `out` exists and
/// `force` is not set, or cannot be written.
pub fn recover(broken: &Path, out: &Path, force: bool) -> Result<Recovery, LogError> {
    let output = Output::beside(out, force, &[broken])?;
    let mut recovery = survey(broken)?;
    let mut reader = open(broken, OpenOptions::default())?;
    let parent = name_of(broken, &reader);
    let mut identity = std::mem::take(&mut reader.identity);
    if let Some(oddity) = reader.oddity() {
        identity = identity.with(Recovery::IDENTITY, oddity);
    }
    let identity = identity
        .with(Recovery::PARENT, parent)
        .with(Recovery::TICK, recovery.tick.to_string())
        .with(Recovery::REASON, &*recovery.reason);
    let mut writer = FlightWriter::begin(output.file()?, &reader.setup, &identity)?;
    copy(broken, &mut writer, &mut recovery)?;
    recovery.bytes_written = writer.finish()?.bytes;
    output.finish()?;
    Ok(recovery)
}

/// Finds the last tick that can be trusted.
fn survey(broken: &Path) -> Result<Recovery, LogError> {
    let mut reader = open(broken, OpenOptions::default())?;
    if !reader.intact {
        return Err(LogError::NotRecoverable(
            "its aircraft, cockpit map, scenario or first state is not what it was flown with: no \
             tick can be trusted"
                .into(),
        ));
    }
    if !reader.differences().is_empty() {
        return Err(LogError::NotRecoverable("its fields are not those of this version".into()));
    }
    let mut recovery = Recovery {
        tick: reader.initial.tick,
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
            return Ok(recovery);
        }
    }
}

/// Copies the messages up to the state of the last good tick, and what belongs to those ticks.
fn copy(broken: &Path, writer: &mut FlightWriter, recovery: &mut Recovery) -> Result<(), LogError> {
    let mut copied = None;
    let mut messages = Messages::open(broken, OpenOptions::default())?;
    while let Some(message) = messages.next_message() {
        let flown = Channel::of(message.topic()).is_some_and(|c| c.chain != Chain::Outside);
        if flown && copied == Some(recovery.tick) {
            break;
        }
        if !flown && message.time_ns > time_ns(recovery.tick) {
            // Viewers' channels may be a few ticks ahead.
            continue;
        }
        if !writer.copy(message)? {
            recovery.messages_foreign += 1;
        }
        if message.topic() == STATE {
            copied = Some(writer.last_tick());
        }
    }
    let changed = || LogError::Order("the file changed while it was being read".into());
    (copied == Some(recovery.tick)).then_some(()).ok_or_else(changed)
}

/// The name of the file; for one that was recovered before, the names of all of them.
fn name_of(path: &Path, reader: &FlightReader) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    reader.recovered_from().map_or(name.clone(), |earlier| format!("{name}, from {earlier}"))
}
