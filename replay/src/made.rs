//! Logs that were just made: read and reflown before they take their place.

use std::path::Path;

use crate::judgement::{Judgement, Outcome};
use crate::refly::ReplayError;
use crate::verify::{Options, verify};

/// What a log that was just written is, read again and reflown.
///
/// # Errors
/// When it cannot be reflown, or is none of `expected`: it is not what was meant to be written.
pub fn proven(written: &Path, expected: &[Outcome]) -> Result<Judgement, ReplayError> {
    let judgement = verify(written, &Options::default(), |_| ())?.judgement;
    if expected.contains(&judgement.outcome) {
        return Ok(judgement);
    }
    let what = format!("not made: read again, it is not what was written: {judgement}");
    Err(ReplayError::Refused(what))
}
