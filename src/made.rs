//! A log that was made of another one: proven before it is said to be there.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use replay::{Judgement, Options, Outcome, Source, verify};

use crate::status::Status;

/// What the new log is, and what the one is that it was made of.
pub struct Made {
    source: Judgement,
    judgement: Judgement,
}

impl Made {
    /// Reflies a log that was just made; what is not sound is removed again.
    pub fn of(source: &Source, out: &Path) -> Result<Self> {
        let verdict = verify(out, &Options::default(), |_| ());
        let remove = || {
            let _ = fs::remove_file(out);
        };
        let verdict =
            verdict.inspect_err(|_| remove()).with_context(|| out.display().to_string())?;
        let judgement = verdict.judgement;
        // One that was made of a recovered log says so.
        if !matches!(judgement.outcome, Outcome::Exact | Outcome::NeverClosed) {
            remove();
            bail!(
                "{}: not made: read again, it is not what was written: {judgement}",
                out.display()
            );
        }
        Ok(Self { source: source.judgement.clone(), judgement })
    }

    /// Says what both are; a source that was never closed decides.
    pub fn say(&self, log: &Path) -> Status {
        say!("new log    {}", self.judgement);
        say!("source     {}: {}", log.display(), self.source);
        Status::gravest([Status::from(&self.source), Status::from(&self.judgement)])
    }
}
