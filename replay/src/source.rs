//! A log from which another one is to be made.

use std::path::Path;

use logs::devices::DeviceIdentity;
use logs::{Identity, OpenOptions};

use crate::judgement::{Facts, Judgement, Outcome};
use crate::refly::{OPEN, ReplayError, Window};
use crate::rewrite::parent;

/// A log that was read from its beginning to its end before another one is made of it.
#[derive(Clone, Debug)]
pub struct Source {
    /// What it is: never exact, for nothing was reflown.
    pub judgement: Judgement,
    /// The last tick that can be read.
    last_tick: u64,
    /// What a log that it was made from was, and its first bad tick.
    inherited: [Option<String>; 2],
    /// The input devices that were found.
    pub devices: Vec<DeviceIdentity>,
}

/// Keys that say where a log that is not to be trusted comes from.
const KEYS: [&str; 2] = [parent::JUDGEMENT, parent::FIRST_BAD_TICK];

impl Source {
    /// Proves a log: its digests, its messages, its ending.
    ///
    /// # Errors
    /// When it is not a flight log, or of another version.
    pub fn of(log: &Path) -> Result<Self, ReplayError> {
        Self::opened(log, OPEN)
    }

    /// The same of a log that is opened in another way.
    pub(crate) fn opened(log: &Path, options: OpenOptions) -> Result<Self, ReplayError> {
        let mut reader = logs::open(log, options)?;
        let inherited = KEYS.map(|key| reader.identity.0.get(key).cloned());
        let facts = Facts::read(&mut reader, &Window::default())?;
        let devices = std::mem::take(&mut reader.devices);
        Ok(Self { judgement: facts.judge(), last_tick: facts.last_tick(), inherited, devices })
    }

    /// The same, but refuses what no log can be made of: what is proven of it would be lost in the new one.
    ///
    /// # Errors
    /// And when it is altered, damaged, or does not refly to its digests.
    pub fn proven(log: &Path, not_made: &str) -> Result<Self, ReplayError> {
        let source = Self::of(log)?;
        match source.judgement.outcome {
            Outcome::NotReflown | Outcome::NeverClosed => Ok(source),
            _ => Err(ReplayError::Refused(format!("{not_made}: {}", source.judgement))),
        }
    }

    /// Whether nothing is wrong with it.
    pub fn is_sound(&self) -> bool {
        self.judgement.outcome == Outcome::NotReflown
    }

    /// The facts of a new log, with what this one is where it is not sound, or what one was that it comes
    /// from.
    #[must_use]
    pub fn marks(&self, identity: Identity) -> Identity {
        let bad = self.judgement.first_bad_tick.unwrap_or(self.last_tick.saturating_add(1));
        let own = [self.judgement.words.clone(), bad.to_string()].map(Some);
        let marks = if self.is_sound() { &self.inherited } else { &own };
        KEYS.iter().zip(marks).fold(identity, |identity, (key, value)| match value {
            Some(value) => identity.with(key, value),
            None => identity,
        })
    }
}
