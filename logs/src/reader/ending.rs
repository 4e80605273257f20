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

/// With what the writer closed the log.
#[derive(Clone, Copy, Debug)]
pub(super) struct LastWord {
    /// Tick and digest of the last state.
    pub last: (u64, u64),
    /// Roll call of all messages; `None` without a seal.
    pub messages: Option<u64>,
}

/// The log format that knew no seals.
pub(super) const UNSEALED: &str = "1";

pub(super) fn last_word(facts: &BTreeMap<String, String>) -> Option<LastWord> {
    let number = |key| facts.get(key).and_then(|text| text.parse().ok());
    let last = number(CLOSING_TICK).zip(number(CLOSING_DIGEST))?;
    Some(LastWord { last, messages: number(CLOSING_MESSAGES).filter(|_| is_whole(facts)) })
}
