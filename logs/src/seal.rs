//! Seals: checksums over what the digest chain leaves out.
//!
//! The chain guards what a flight is reflown from. Who flew, how the ticks kept time, what happened in
//! words and what viewers draw is not part of it; a tool that copies a log gives every changed byte of
//! those a right CRC again. A seal is written into the metadata and survives such a copy.

use std::collections::BTreeMap;

use xxhash_rust::xxh3::Xxh3Default;

/// Key of the seal among the facts of a metadata record.
const SEAL: &str = "seal";

/// Adds the seal over all other facts.
pub fn seal(facts: &mut BTreeMap<String, String>) {
    let seal = seal_of(facts);
    facts.insert(SEAL.into(), seal);
}

/// Whether the facts are those that were sealed.
pub fn is_whole(facts: &BTreeMap<String, String>) -> bool {
    facts.get(SEAL).is_some_and(|seal| *seal == seal_of(facts))
}

fn seal_of(facts: &BTreeMap<String, String>) -> String {
    let mut hash = Xxh3Default::new();
    for (key, value) in facts.iter().filter(|(key, _)| *key != SEAL) {
        for part in [key, value] {
            hash.update(&(part.len() as u64).to_le_bytes());
            hash.update(part.as_bytes());
        }
    }
    format!("{:016x}", hash.digest())
}

/// What a message carries beside its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    /// Number that the writer gave it.
    pub sequence: u32,
    /// Time since the start of the flight, ns.
    pub log_time_ns: u64,
    /// The same again.
    pub publish_time_ns: u64,
}

/// Every message of a log, in order, as one number.
#[derive(Clone, Default)]
pub struct RollCall {
    hash: Xxh3Default,
    met: Vec<String>,
}

impl RollCall {
    /// Adds the next message, and the definition of its channel with the first one.
    pub fn add(&mut self, topic: &str, definition: &[u8], stamp: Stamp, data: &[u8]) {
        let Self { hash, met } = self;
        if !met.iter().any(|known| known == topic) {
            met.push(topic.into());
            hash.update(&(definition.len() as u64).to_le_bytes());
            hash.update(definition);
        }
        hash.update(&(topic.len() as u64).to_le_bytes());
        hash.update(topic.as_bytes());
        hash.update(&stamp.sequence.to_le_bytes());
        hash.update(&stamp.log_time_ns.to_le_bytes());
        hash.update(&stamp.publish_time_ns.to_le_bytes());
        hash.update(&(data.len() as u64).to_le_bytes());
        hash.update(data);
    }

    /// All so far.
    pub fn digest(&self) -> u64 {
        self.hash.digest()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_added_or_missing_fact_breaks_the_seal() {
        let mut facts: BTreeMap<_, _> =
            [("commit", "a1"), ("dirty", "no")].map(|(k, v)| (k.into(), v.into())).into();
        assert!(!is_whole(&facts), "never sealed");
        seal(&mut facts);
        assert!(is_whole(&facts));
        let mut changed = facts.clone();
        changed.insert("commit".into(), "a2".into());
        assert!(!is_whole(&changed));
        let mut added = facts.clone();
        added.insert("pilot".into(), String::new());
        assert!(!is_whole(&added));
        facts.remove("dirty");
        assert!(!is_whole(&facts));
    }

    #[test]
    fn the_order_of_messages_counts() {
        let stamp = Stamp { sequence: 1, log_time_ns: 2, publish_time_ns: 2 };
        let (mut one, mut other) = (RollCall::default(), RollCall::default());
        one.add("/a", b"", stamp, b"b");
        one.add("/b", b"", stamp, b"a");
        other.add("/b", b"", stamp, b"a");
        other.add("/a", b"", stamp, b"b");
        assert_ne!(one.digest(), other.digest());
    }

    #[test]
    fn another_definition_is_another_roll_call() {
        let stamp = Stamp { sequence: 1, log_time_ns: 2, publish_time_ns: 2 };
        let (mut one, mut other) = (RollCall::default(), RollCall::default());
        one.add("/a", b"float64 x", stamp, b"b");
        other.add("/a", b"float64 y", stamp, b"b");
        assert_ne!(one.digest(), other.digest());
    }
}
