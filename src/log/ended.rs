//! How a log ends that was read and not reflown.

use std::path::Path;

use logs::{Ending, Messages};

use crate::status::Status;

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
            complain!("tiltrotor: {name}: damaged: {why}");
            Status::Unusable
        }
    }
}
