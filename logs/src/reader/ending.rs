//! How a log ends.

use std::collections::BTreeMap;

use crate::container::checksums::is_whole;
use crate::setup::{CLOSING_DIGEST, CLOSING_MESSAGES, CLOSING_TICK};

/// How the file ends.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Ending {
    /// As the writer ended it.
    #[default]
    Closed,
    /// Short of its end: the program was killed, or the file was cut.
    Truncated,
    /// Bytes that do not belong there, from which on nothing is read.
    Damaged(String),
}

/// What a compacted log does not hold and what is made again while it is read, beside what was recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Remade {
    /// The same, as far as can be told.
    #[default]
    AsRecorded,
    /// Other outputs.
    OutputsDiffer {
        /// The first such tick.
        tick: u64,
    },
    /// Something that is shown, sent or exported is not the same.
    Differs,
}

/// With what the writer closed the log.
#[derive(Clone, Copy, Debug)]
pub(super) struct FooterRecord {
    /// Tick and digest of the last state.
    pub last: (u64, u64),
    /// Message digest of all messages; `None` without a checksum of the footer record.
    pub messages: Option<u64>,
}

/// The log format without checksums of metadata and messages.
pub(super) const WITHOUT_CHECKSUMS: &str = "1";

pub(super) fn footer_record(facts: &BTreeMap<String, String>) -> Option<FooterRecord> {
    let number = |key| facts.get(key).and_then(|text| text.parse().ok());
    let last = number(CLOSING_TICK).zip(number(CLOSING_DIGEST))?;
    Some(FooterRecord { last, messages: number(CLOSING_MESSAGES).filter(|_| is_whole(facts)) })
}
