//! A log that was made of another one: proven before it is said to be there.

use std::path::Path;

use anyhow::{Context, Result};
use logs::output::Output;
use replay::{Judgement, Outcome, Source, proven};

use crate::status::Status;

/// What the new log is, and what the one is that it was made of.
pub struct Made {
    source: Judgement,
    judgement: Judgement,
}

impl Made {
    /// Reflies a log that was just written, and puts it in its place when it is sound.
    pub fn of(source: &Source, output: Output) -> Result<Self> {
        // One that was made of a recovered log says so.
        let sound = [Outcome::Exact, Outcome::NeverClosed];
        let judgement = finished(output, &sound)?;
        Ok(Self { source: source.judgement.clone(), judgement })
    }

    /// Says what both are; a source that was never closed decides.
    pub fn say(&self, log: &Path) -> Status {
        say!("new log    {}", self.judgement);
        say!("source     {}: {}", log.display(), self.source);
        Status::gravest([Status::from(&self.source), Status::from(&self.judgement)])
    }
}

/// Reflies a log that was just written, and puts it in its place when it is what is expected.
pub fn finished(output: Output, expected: &[Outcome]) -> Result<Judgement> {
    let name = || output.path().display().to_string();
    let judgement = proven(output.unfinished(), expected).with_context(name)?;
    output.finish()?;
    Ok(judgement)
}
