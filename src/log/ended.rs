//! How a log ends that was read and not reflown.

use std::path::Path;

use logs::{Ending, Messages};

use crate::status::Status;

/// What a file is that cannot be read to its end: nothing of a log, or a log with damage.
pub fn fault(messages: &Messages) -> &'static str {
    let is_nothing = messages.facts().is_empty() && messages.files().is_empty();
    if is_nothing { "not a flight log" } else { "damaged" }
}

/// How a log ends that was read to its end: said where it is not closed, and as a status.
pub fn ended(messages: &Messages, log: &Path) -> Status {
    let name = log.display();
    match messages.ending() {
        Ending::Closed => Status::Done,
        Ending::Truncated => {
            complain!("tiltrotor: {name}: it ends without having been closed");
            Status::NeverClosed
        }
        Ending::Damaged(why) => {
            complain!("tiltrotor: {name}: {}: {why}", fault(messages));
            Status::Unusable
        }
    }
}
