//! A log that was made of another one: proven before it is said to be there.

use std::path::Path;

use anyhow::{Context, Result, bail};
use logs::output::Output;
use replay::{Judgement, Options, Outcome, Source, verify};

use crate::status::Status;

/// What the new log is, and what the one is that it was made of.
pub struct Made {
    source: Judgement,
    judgement: Judgement,
}

impl Made {
    /// Reflies a log that was just written, and puts it in its place when it is sound.
    pub fn of(source: &Source, output: Output) -> Result<Self> {
        let made = Self::judged(source, output.unfinished(), output.path())?;
        output.finish()?;
        Ok(made)
    }

    /// Reflies a log that is in its place already.
    pub fn finished(source: &Source, out: &Path) -> Result<Self> {
        Self::judged(source, out, out)
    }

    fn judged(source: &Source, written: &Path, named: &Path) -> Result<Self> {
        let verdict = verify(written, &Options::default(), |_| ());
        let judgement = verdict.with_context(|| named.display().to_string())?.judgement;
        // One that was made of a recovered log says so.
        if !matches!(judgement.outcome, Outcome::Exact | Outcome::NeverClosed) {
            bail!(
                "{}: not made: read again, it is not what was written: {judgement}",
                named.display()
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
