//! What the end-to-end tests share: the command, flights to look at, and logs with one thing changed.
//!
//! A log is changed through the `mcap` crate: every record is copied, so that all checksums of the
//! copy are right again and only the flight itself can betray it.

// Each test program uses its part.
#![allow(dead_code)]

pub mod flightgear;

use std::collections::VecDeque;
use std::fmt::Write as _;
use std::fs;
use std::io::{Cursor, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use logs::cdr;
use logs::fields::fields;
use logs::records::{Chain, HARDWARE, INPUTS, RESTART, STATE, StateRecord, first_digest};
use mcap::records::{Metadata, Record};
use mcap::{Attachment, Message, MessageStream, WriteOptions};
use serde::Serialize;

/// Exact, or done.
pub const OK: i32 = 0;
/// The log is not what was flown.
pub const DIVERGED: i32 = 1;
/// Not a usable log, or not a usable command.
pub const UNUSABLE: i32 = 2;
/// Exact, but never closed.
pub const INCOMPLETE: i32 = 3;
/// The flight went on, its log did not.
pub const LOG_CUT_SHORT: i32 = 4;

/// What the command said, and how it ended.
#[derive(Debug)]
pub struct Said {
    /// As typed.
    pub command: String,
    /// `None` when a signal ended it.
    pub status: Option<i32>,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

/// Runs the command to its end.
#[track_caller]
pub fn tiltrotor(arguments: &[&str]) -> Said {
    said(&mut command(arguments))
}

/// The command, to be run by the caller.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tiltrotor"));
    command.args(arguments);
    command
}

/// Runs a command to its end. Whatever else it does, it never panics.
#[track_caller]
pub fn said(command: &mut Command) -> Said {
    let output = command.output().expect("the command runs");
    understood(&format!("{command:?}"), &output)
}

/// What a command that ended had said.
#[track_caller]
pub fn understood(command: &str, output: &Output) -> Said {
    let said = Said {
        command: command.into(),
        status: output.status.code(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    };
    assert!(!said.err.contains("panicked"), "{said}");
    assert!(said.status.is_some(), "ended by a signal: {said}");
    said
}

impl Said {
    /// It ended with this status.
    #[track_caller]
    pub fn ends(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "{self}");
        self
    }

    /// It said these words, anywhere.
    #[track_caller]
    pub fn says(self, words: &str) -> Self {
        assert!(self.out.contains(words) || self.err.contains(words), "no `{words}` in\n{self}");
        self
    }

    /// It did not say these words.
    #[track_caller]
    pub fn never_says(self, words: &str) -> Self {
        assert!(!self.out.contains(words) && !self.err.contains(words), "`{words}` in\n{self}");
        self
    }

    /// It was refused: one line for people on standard error, and nothing done.
    #[track_caller]
    pub fn refused(self) -> Self {
        let said = self.ends(UNUSABLE);
        assert_eq!(said.err.lines().count(), 1, "one line: {said}");
        assert!(said.err.starts_with("tiltrotor: "), "{said}");
        assert_eq!(said.out, "", "{said}");
        // How Rust prints what was not meant for people.
        for debris in ["Error {", "Os {", "Error(", "Some(", "Custom {", "kind:"] {
            assert!(!said.err.contains(debris), "`{debris}`: {said}");
        }
        said
    }

    /// What follows `name` on its line of standard output.
    #[track_caller]
    pub fn after(&self, name: &str) -> &str {
        let line = self.out.lines().find_map(|line| line.trim_start().strip_prefix(name));
        line.unwrap_or_else(|| panic!("no `{name}` in {self}")).trim()
    }
}

impl std::fmt::Display for Said {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { command, status, out, err } = self;
        write!(f, "{command}\nstatus {status:?}\n--- out\n{out}\n--- err\n{err}")
    }
}

/// An empty folder of that name.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A path as an argument.
pub fn text(path: &Path) -> &str {
    path.to_str().expect("a path of letters")
}

/// A flight by the pilot model, as fast as it goes, into a log of that name.
#[track_caller]
pub fn hover(log: &Path, seconds: &str) {
    tiltrotor(&[
        "fly",
        "--pilot",
        "hover",
        "--fast",
        "--duration",
        seconds,
        "--no-flightgear",
        "--out",
        text(log),
    ])
    .ends(OK);
}

/// Verifies a log.
#[track_caller]
pub fn verify(log: &Path) -> Said {
    tiltrotor(&["verify", text(log)])
}

/// Makes a script that can be run at once. What this process writes itself may stay open for a moment in a
/// child that another test starts meanwhile, and what is open for writing cannot be run.
pub fn program_of(program: &Path, script: &str) {
    let mut writer = Command::new("sh")
        .args(["-c", "cat >\"$0\" && chmod 755 \"$0\"", text(program)])
        .stdin(Stdio::piped())
        .spawn()
        .expect("a shell");
    let mut to = writer.stdin.take().expect("its input");
    to.write_all(script.as_bytes()).expect("it takes the script");
    drop(to);
    assert!(writer.wait().expect("it ends").success(), "{}", program.display());
}

/// A log taken apart, to be put together again with something changed.
pub struct Forgery {
    /// Metadata records.
    pub metadata: Vec<Metadata>,
    /// Attachments.
    pub attachments: Vec<Attachment<'static>>,
    /// Messages with their channels and schemas, in the file's order.
    pub messages: Vec<Message<'static>>,
}

impl Clone for Forgery {
    fn clone(&self) -> Self {
        let attachment = |file: &Attachment<'static>| Attachment {
            name: file.name.clone(),
            media_type: file.media_type.clone(),
            data: file.data.clone(),
            ..*file
        };
        Self {
            metadata: self.metadata.clone(),
            attachments: self.attachments.iter().map(attachment).collect(),
            messages: self.messages.clone(),
        }
    }
}

impl Forgery {
    /// Takes a log apart.
    #[track_caller]
    pub fn of(log: &Path) -> Self {
        // The pieces point into it.
        let bytes: &'static [u8] = fs::read(log).expect("a log").leak();
        let (mut metadata, mut attachments) = (Vec::new(), Vec::new());
        for record in mcap::read::LinearReader::new(bytes).expect("an MCAP file") {
            match record.expect("a record") {
                Record::Metadata(record) => metadata.push(record),
                Record::Attachment { header, data, .. } => attachments.push(Attachment {
                    log_time: header.log_time,
                    create_time: header.create_time,
                    name: header.name,
                    media_type: header.media_type,
                    data,
                }),
                _ => {}
            }
        }
        let messages = MessageStream::new(bytes).expect("an MCAP file");
        Self { metadata, attachments, messages: messages.map(|m| m.expect("a message")).collect() }
    }

    /// Where in the list the messages of a channel are.
    pub fn places(&self, topic: &str) -> Vec<usize> {
        let of_topic = |&i: &usize| self.messages[i].channel.topic == topic;
        (0..self.messages.len()).filter(of_topic).collect()
    }

    /// The bytes of a channel's message.
    #[track_caller]
    pub fn bytes(&mut self, topic: &str, number: usize) -> &mut [u8] {
        let place = self.places(topic)[number];
        self.messages[place].data.to_mut()
    }

    /// The text of an attachment, changed.
    #[track_caller]
    pub fn rewrite(&mut self, name: &str, from: &str, to: &str) {
        let file = self.attachments.iter_mut().find(|file| file.name == name).expect(name);
        let text = String::from_utf8(file.data.to_vec()).expect("text");
        assert_eq!(text.matches(from).count(), 1, "`{from}` once in {name}");
        file.data = text.replacen(from, to, 1).into_bytes().into();
    }

    /// Puts it together again, all checksums right.
    #[track_caller]
    pub fn write(&self, log: &Path) {
        let mut bytes = Vec::new();
        let mut writer = WriteOptions::new()
            .compression(Some(mcap::Compression::Lz4))
            .profile("ros2")
            .create(Cursor::new(&mut bytes))
            .expect("a writer");
        for metadata in &self.metadata {
            writer.write_metadata(metadata).expect("metadata");
        }
        for attachment in &self.attachments {
            writer.attach(attachment).expect("an attachment");
        }
        for message in &self.messages {
            writer.write(message).expect("a message");
        }
        writer.finish().expect("an end");
        drop(writer);
        fs::write(log, bytes).expect("a file");
    }
}

/// Where in a message a field of the recorded struct begins.
#[track_caller]
pub fn place_of<T: Serialize + Default>(path: &str) -> usize {
    let fields = fields(&T::default()).expect("recordable");
    let number = fields.iter().position(|field| field.path == path).expect(path);
    cdr::HEADER.len() + 8 * number
}

/// Flips the lowest bit of a field of the state after `tick`.
#[track_caller]
pub fn flip_state_bit(forgery: &mut Forgery, tick: usize, path: &str) {
    let place = place_of::<StateRecord>(&format!("state.{path}"));
    // The first message is the state at the start.
    forgery.bytes(STATE, tick)[place] ^= 1;
}

/// Forms the digests anew, up to the writer's footer record.
pub fn chain_anew(log: &mut Forgery) {
    let mut chain = None;
    let files: Vec<_> = log
        .attachments
        .iter()
        .map(|file| (file.name.clone(), String::from_utf8(file.data.to_vec()).expect("text")))
        .collect();
    let files: Vec<_> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    for message in &mut log.messages {
        match (message.channel.topic.as_str(), &mut chain) {
            (STATE, chain) => {
                let state = [&cdr::HEADER[..], &message.data[cdr::HEADER.len() + 8..]].concat();
                let digest = match chain {
                    None => {
                        let digest = first_digest(&files, &state);
                        *chain = Some(Chain::from(digest));
                        digest
                    }
                    Some(chain) => chain.close(&state),
                };
                message.data.to_mut()[cdr::HEADER.len()..][..8]
                    .copy_from_slice(&digest.to_le_bytes());
            }
            (HARDWARE | INPUTS | RESTART, Some(chain)) => chain.add(&message.data),
            _ => {}
        }
    }
    let digest = chain.expect("a state").digest().to_string();
    let closing = log.metadata.iter_mut().find(|record| record.name == "tiltrotor_closing");
    closing.expect("a footer record").metadata.insert("digest".into(), digest);
}

/// Random enough to choose moments and bits: splitmix64.
pub struct Dice(pub u64);

impl Dice {
    /// The next number below `end`.
    pub fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % end
    }
}

/// Does all of it on as many threads as there are processors, and hands over what came out wrong.
pub fn all<T: Send>(work: impl IntoIterator<Item = T>, check: impl Fn(T) -> Option<String> + Sync) {
    let work = std::sync::Mutex::new(work.into_iter().collect::<VecDeque<_>>());
    let wrong = std::sync::Mutex::new(String::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let Some(next) = work.lock().expect("the list").pop_front() else { break };
                    if let Some(what) = check(next) {
                        let _ = writeln!(wrong.lock().expect("the list"), "{what}");
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().expect("the list");
    assert!(wrong.is_empty(), "{wrong}");
}
