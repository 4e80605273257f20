//! Checksums over what the digest chain and mcap's own leave out.
//!
//! The chain guards what a flight is reflown from. Who flew, how the ticks kept time, what happened in
//! words and what viewers draw is not part of it; a tool that copies a log gives every changed byte of
//! those a right CRC again. A checksum of the metadata is written into them and survives such a copy.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use mcap::records::MessageHeader;
use xxhash_rust::xxh3::Xxh3Default;

use crate::LogError;

/// Key of the checksum among the facts of a metadata record.
const CHECKSUM: &str = "seal";

/// Adds the checksum over all other facts.
pub fn add_checksum(facts: &mut BTreeMap<String, String>) {
    let checksum = metadata_checksum(facts);
    facts.insert(CHECKSUM.into(), checksum);
}

/// Whether they have a checksum.
pub fn has_checksum(facts: &BTreeMap<String, String>) -> bool {
    facts.contains_key(CHECKSUM)
}

/// Whether the facts are those that the checksum was made of.
pub fn is_whole(facts: &BTreeMap<String, String>) -> bool {
    facts.get(CHECKSUM).is_some_and(|written| *written == metadata_checksum(facts))
}

fn metadata_checksum(facts: &BTreeMap<String, String>) -> String {
    let mut hash = Xxh3Default::new();
    for (key, value) in facts.iter().filter(|(key, _)| *key != CHECKSUM) {
        for part in [key, value] {
            hash.update(&(part.len() as u64).to_le_bytes());
            hash.update(part.as_bytes());
        }
    }
    format!("{:016x}", hash.digest())
}

/// Every message of a log, in order, as one number.
#[derive(Clone, Default)]
pub struct MessageDigest {
    hash: Xxh3Default,
    /// Topics of the channels so far, and their numbers.
    met: Vec<String>,
    ids: Vec<u16>,
    head: Vec<u8>,
}

impl MessageDigest {
    /// Adds the next message, and the definition of its channel with the first one.
    pub fn add(&mut self, topic: &str, definition: &[u8], header: &MessageHeader, data: &[u8]) {
        let Self { hash, met, ids, head } = self;
        if !ids.contains(&header.channel_id) {
            ids.push(header.channel_id);
            if !met.iter().any(|known| known == topic) {
                met.push(topic.into());
                hash.update(&(definition.len() as u64).to_le_bytes());
                hash.update(definition);
            }
        }
        message_head(head, topic, header, data);
        hash.update(head);
        hash.update(data);
    }

    /// All so far.
    pub fn digest(&self) -> u64 {
        self.hash.digest()
    }
}

/// The message digest of a log being read: a message on a channel of somebody else's is none of the
/// flight's, and takes nothing from it.
#[derive(Default)]
pub struct MessageDigests {
    all: MessageDigest,
    /// Without the channels of others, once there is a message of theirs.
    ours: Option<MessageDigest>,
}

impl MessageDigests {
    /// Adds the next message.
    pub fn add(
        &mut self,
        topic: &str,
        ours: bool,
        definition: &[u8],
        header: &MessageHeader,
        data: &[u8],
    ) {
        match &mut self.ours {
            None if !ours => self.ours = Some(self.all.clone()),
            Some(of_ours) if ours => of_ours.add(topic, definition, header, data),
            _ => {}
        }
        self.all.add(topic, definition, header, data);
    }

    /// Whether this is what the writer counted: every message, or every one of ours.
    pub fn are(&self, counted: Option<u64>) -> bool {
        let ours = self.ours.as_ref().map(MessageDigest::digest);
        counted.is_some() && (counted == Some(self.all.digest()) || counted == ours)
    }
}

/// Adds a message to a hash over all of them.
pub fn add_message(hash: &mut Xxh3Default, topic: &str, header: &MessageHeader, data: &[u8]) {
    let mut head = Vec::new();
    message_head(&mut head, topic, header, data);
    hash.update(&head);
    hash.update(data);
}

/// What a message carries beside its bytes.
fn message_head(head: &mut Vec<u8>, topic: &str, header: &MessageHeader, data: &[u8]) {
    head.clear();
    head.extend_from_slice(&(topic.len() as u64).to_le_bytes());
    head.extend_from_slice(topic.as_bytes());
    head.extend_from_slice(&header.sequence.to_le_bytes());
    head.extend_from_slice(&header.log_time.to_le_bytes());
    head.extend_from_slice(&header.publish_time.to_le_bytes());
    head.extend_from_slice(&(data.len() as u64).to_le_bytes());
}

/// A file's size and hash.
#[derive(Clone, Default)]
pub struct Fingerprint {
    pub bytes: u64,
    hash: Xxh3Default,
}

impl Fingerprint {
    /// Of a file.
    pub fn of(path: &Path) -> Result<Self, LogError> {
        let mut file = File::open(path).map_err(LogError::Open)?;
        let mut all = Self::default();
        let mut room = vec![0; 256 * 1024];
        loop {
            let read = file.read(&mut room)?;
            if read == 0 {
                return Ok(all);
            }
            all.add(&room[..read]);
        }
    }

    /// Adds the bytes that follow.
    pub fn add(&mut self, bytes: &[u8]) {
        self.hash.update(bytes);
        self.bytes += bytes.len() as u64;
    }

    /// The hash so far.
    pub fn xxh3(&self) -> u128 {
        self.hash.digest128()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// XXH3-128 without a seed, as xxHash's own tools print it.
    #[test]
    fn a_fingerprint_is_the_published_hash_of_all_bytes_whatever_parts_they_come_in() {
        let of = |parts: &[&[u8]]| {
            let mut all = Fingerprint::default();
            parts.iter().for_each(|part| all.add(part));
            (all.bytes, all.xxh3())
        };
        assert_eq!(of(&[]), (0, 0x99aa_06d3_0147_98d8_6001_c324_468d_497f));
        let abc = (3, 0x06b0_5ab6_733a_6185_78af_5f94_892f_3950);
        assert_eq!(of(&[b"abc"]), abc);
        assert_eq!(of(&[b"a", b"", b"bc"]), abc);
        assert_ne!(of(&[b"acb"]), abc);
    }

    fn header(channel_id: u16) -> MessageHeader {
        MessageHeader { channel_id, sequence: 1, log_time: 2, publish_time: 2 }
    }

    #[test]
    fn a_changed_added_or_missing_fact_breaks_the_checksum() {
        let mut facts: BTreeMap<_, _> =
            [("commit", "a1"), ("dirty", "no")].map(|(k, v)| (k.into(), v.into())).into();
        assert!(!is_whole(&facts), "no checksum yet");
        add_checksum(&mut facts);
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
        let (a, b) = (header(1), header(2));
        let (mut one, mut other) = (MessageDigest::default(), MessageDigest::default());
        one.add("/a", b"", &a, b"b");
        one.add("/b", b"", &b, b"a");
        other.add("/b", b"", &b, b"a");
        other.add("/a", b"", &a, b"b");
        assert_ne!(one.digest(), other.digest());
    }

    #[test]
    fn another_definition_is_another_roll_call() {
        let (mut one, mut other) = (MessageDigest::default(), MessageDigest::default());
        one.add("/a", b"float64 x", &header(1), b"b");
        other.add("/a", b"float64 y", &header(1), b"b");
        assert_ne!(one.digest(), other.digest());
    }

    #[test]
    fn a_message_of_somebody_else_s_takes_nothing_from_the_flight() {
        let (mut written, mut read) = (MessageDigest::default(), MessageDigests::default());
        for topic in ["/a", "/b"] {
            written.add(topic, b"float64 x", &header(1), b"a");
            read.add(topic, true, b"float64 x", &header(1), b"a");
            read.add("/theirs", false, b"string data", &header(7), topic.as_bytes());
        }
        assert!(read.are(Some(written.digest())) && !read.are(None));
        read.add("/a", true, b"float64 x", &header(1), b"one more");
        assert!(!read.are(Some(written.digest())));
    }
}
