//! Does a log refly to the same bits?

use std::num::NonZero;
use std::path::Path;
use std::thread;

use crate::diagnosis::Diagnosis;
use crate::divergence::Divergence;
use crate::growth::WINDOW_TICKS;
use crate::judgement::{Facts, Judgement, disorder};
use crate::refly::{Reflight, ReflyOptions, ReplayError, Window};
use crate::stretches::{self, Passed};
use crate::versions::Versions;

/// Threads at most, whatever is asked for: systems refuse some thousands, and no machine of today gains by more.
pub const THREADS_MAX: usize = 256;

/// How to verify.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Ticks that are still reflown after the first difference, to see how it grows.
    pub growth_ticks: u64,
    /// The part of the log that is reflown.
    pub window: Window,
    /// Fly logs of other versions of the flight model as well, as a comparison.
    pub across_versions: bool,
    /// Threads that fly, the one that reads included. What comes out is the same for any number; 0 flies
    /// in one pass, as after a difference. More than [`THREADS_MAX`] are that many.
    pub threads: usize,
}

impl Default for Options {
    fn default() -> Self {
        let threads = thread::available_parallelism().map_or(1, NonZero::get);
        let window = Window::default();
        Self { growth_ticks: WINDOW_TICKS, window, across_versions: false, threads }
    }
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// What the log is.
    pub judgement: Judgement,
    /// What was found.
    pub facts: Facts,
    /// The first difference.
    pub divergence: Option<Box<Divergence>>,
    /// What stands between the log's version and this one; `None` when nothing does.
    pub versions: Option<Box<Versions>>,
}

/// Reflies a log and compares every bit of every state.
///
/// After the first difference the reflight goes on for a while, by the recorded inputs, to see what
/// becomes of it; the rest of the log is only read.
///
/// # Errors
/// When it is not a flight log, or of another version, or its files cannot be read.
pub fn verify(
    path: &Path,
    options: &Options,
    mut progress: impl FnMut(u64),
) -> Result<Verdict, ReplayError> {
    verify_while(path, options, |ticks| {
        progress(ticks);
        Ok(())
    })
}

/// The same, until `progress` refuses to go on.
///
/// # Errors
/// As for [`verify`], and what `progress` says.
pub fn verify_while(
    path: &Path,
    options: &Options,
    mut progress: impl FnMut(u64) -> Result<(), ReplayError>,
) -> Result<Verdict, ReplayError> {
    let options = &Options { threads: options.threads.min(THREADS_MAX), ..*options };
    let open = || -> Result<Reflight, ReplayError> {
        let Options { window, across_versions, .. } = *options;
        let mut flight = Reflight::open(path, &ReflyOptions { window, across_versions })?;
        flight.outputs_taken = true;
        flight.outputs_ticks = flight.outputs_check.every_ticks;
        Ok(flight)
    };
    let mut flight = open()?;
    if options.threads > 0 && flight.can_begin_anywhere() {
        let passed = stretches::fly(&mut flight, options.threads, &options.window, &mut progress)?;
        match passed {
            Passed::Same(facts) => {
                let versions = flight.versions().map(Box::new);
                let (judgement, facts) = (facts.judge(), *facts);
                return Ok(Verdict { judgement, facts, divergence: None, versions });
            }
            Passed::Differs(proven) => {
                let mut again = open()?;
                again.outputs_check = flight.outputs_check;
                again.proven = proven;
                flight = again;
            }
        }
    }
    if options.threads > 0 && flight.reader.is_compacted() {
        flight.reader.fly_states_only(options.threads - 1);
        // What is compared is bytes; of a difference, too.
        flight.reader.states_as_bytes = true;
    }
    one_pass(flight, options, progress)
}

/// The same in one pass, tick by tick.
fn one_pass(
    mut flight: Reflight,
    options: &Options,
    mut progress: impl FnMut(u64) -> Result<(), ReplayError>,
) -> Result<Verdict, ReplayError> {
    let mut facts = Facts::of_reflight(&flight);
    let mut diagnosis = Diagnosis::of(&flight)?;
    let disorder = loop {
        let grown = |divergence: &Divergence| facts.last_tick().saturating_sub(divergence.tick);
        let watched = diagnosis
            .divergence
            .as_deref()
            .is_none_or(|divergence| grown(divergence) < options.growth_ticks);
        let same = match next_tick(&mut flight, watched) {
            Ok(Some(next)) => next,
            Ok(None) => break None,
            Err(error) => break Some(disorder(error)?),
        };
        facts.add(&flight.reader.tick, same);
        diagnosis.add(facts.last_tick(), &mut flight, same)?;
        flight.reader.forget();
        progress(facts.ticks)?;
    };
    diagnosis.blocks(&flight.reader.outputs)?;
    let divergence = diagnosis.divergence;
    let versions = flight.versions();
    facts.end_of_reflight(&mut flight, disorder, &options.window);
    facts.diverged_field = divergence
        .as_ref()
        .filter(|divergence| facts.diverged == Some(divergence.tick))
        .map(|divergence| divergence.path.clone());
    Ok(Verdict { judgement: facts.judge(), facts, divergence, versions: versions.map(Box::new) })
}

/// Reads the next tick, and says whether it reflew to the same bits, where it is to be reflown; `None` at
/// the end.
fn next_tick(flight: &mut Reflight, reflown: bool) -> Result<Option<Option<bool>>, ReplayError> {
    if reflown {
        Ok(flight.next_tick()?.map(|next| Some(next.exact)))
    } else {
        Ok(flight.reader.next_tick()?.map(|_| None))
    }
}
