//! Logs that were just made: read and reflown before they take their place.

use std::path::Path;

use crate::judgement::{Judgement, Outcome};
use crate::refly::ReplayError;
use crate::verify::{Options, verify_while};

/// What a log that was just written is, read again and reflown.
///
/// # Errors
/// When it cannot be reflown, or is none of `expected`: it is not what was meant to be written.
pub fn proven(written: &Path, expected: &[Outcome]) -> Result<Judgement, ReplayError> {
    proven_while(written, expected, |_| Ok(()))
}

/// The same, until `progress` refuses to go on.
///
/// # Errors
/// As for [`proven`], and what `progress` says.
pub fn proven_while(
    written: &Path,
    expected: &[Outcome],
    progress: impl FnMut(u64) -> Result<(), ReplayError>,
) -> Result<Judgement, ReplayError> {
    let judgement = verify_while(written, &Options::default(), progress)?.judgement;
    if expected.contains(&judgement.outcome) {
        return Ok(judgement);
    }
    let what = format!("not made: read again, it is not what was written: {judgement}");
    Err(ReplayError::Refused(what))
}
