//! Logs that other people's MCAP tools wrote anew: the same flight, or refused for a true reason.
//!
//! Such tools put attachments and metadata last, choose chunks and compression of their own, and may add
//! channels. Here the `mcap` crate's own writer does it.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use mcap::{Compression, WriteOptions};

use crate::common::{
    DIVERGED, Forgery, OK, UNUSABLE, flip_state_bit, folder, hover, text, tiltrotor, verify,
};

/// Two seconds by the pilot model.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("foreign").join("flight.mcap");
        hover(&log, "2");
        log
    })
}

/// How a tool writes a log.
struct Tool {
    name: &'static str,
    options: fn() -> WriteOptions,
}

const TOOLS: [Tool; 6] = [
    Tool { name: "zstd", options: || with(Some(Compression::Zstd), Some(1 << 20)) },
    Tool { name: "small-chunks", options: || with(Some(Compression::Lz4), Some(5_000)) },
    Tool { name: "one-chunk", options: || with(None, None) },
    Tool { name: "no-chunks", options: || with(None, None).use_chunks(false) },
    Tool {
        name: "half-an-index",
        options: || with(Some(Compression::Zstd), Some(1 << 17)).emit_attachment_indexes(false),
    },
    Tool {
        name: "no-index",
        options: || {
            let options = with(Some(Compression::Lz4), Some(1 << 16));
            options.emit_summary_records(false).emit_summary_offsets(false)
        },
    },
];

fn with(compression: Option<Compression>, chunk_bytes: Option<u64>) -> WriteOptions {
    WriteOptions::new().compression(compression).chunk_size(chunk_bytes).profile("ros2")
}

/// Writes a log as the tool does: messages first, then attachments and metadata.
fn write(log: &Forgery, tool: &Tool, theirs: Option<&str>, to: &Path) {
    let mut bytes = Vec::new();
    let mut writer = (tool.options)().create(Cursor::new(&mut bytes)).expect("a writer");
    let theirs = theirs.map(|topic| {
        let (id, text) = (900, b"string data\n");
        writer.add_schema_with_id(id, "std_msgs/msg/String", "ros2msg", text).expect("a schema");
        writer.add_channel_with_id(id, id, topic, "cdr", &BTreeMap::new()).expect("a channel");
        id
    });
    for (number, message) in log.messages.iter().enumerate() {
        writer.write(message).expect("a message");
        if let Some(channel_id) = theirs.filter(|_| number % 7 == 0) {
            let (sequence, log_time) = (number as u32, message.log_time);
            let header = mcap::records::MessageHeader {
                channel_id,
                sequence,
                log_time,
                publish_time: log_time,
            };
            writer.write_to_known_channel(&header, b"\0\x01\0\0\x01\0\0\0\0").expect("a message");
        }
    }
    for attachment in &log.attachments {
        writer.attach(attachment).expect("an attachment");
    }
    for metadata in &log.metadata {
        writer.write_metadata(metadata).expect("metadata");
    }
    writer.finish().expect("an end");
    drop(writer);
    fs::write(to, bytes).expect("a file");
}

#[test]
fn a_log_with_its_files_last_is_the_same_flight() {
    let place = folder("foreign-last");
    let flown = Forgery::of(flight());
    let of_flight = |log: &Path| {
        let info = tiltrotor(&["log", "info", text(log)]).ends(OK);
        info.out.lines().skip(1).map(String::from).collect::<Vec<_>>()
    };
    let cat = |log: &Path| tiltrotor(&["log", "cat", text(log)]).ends(OK).out;
    for tool in &TOOLS {
        let log = place.join(format!("{}.mcap", tool.name));
        write(&flown, tool, None, &log);
        verify(&log).ends(OK).says("exact: all 500 ticks");
        assert_eq!(of_flight(&log), of_flight(flight()), "{}", tool.name);
        assert!(cat(&log) == cat(flight()), "{}", tool.name);
        tiltrotor(&["verify", text(&log), "--from", "1", "--until", "1.5"])
            .ends(OK)
            .says("exact: all 125 ticks");
        let tables = place.join(format!("{}-tables", tool.name));
        tiltrotor(&["log", "export", "--csv", text(&tables), text(&log)]).ends(OK);
    }
}

#[test]
fn a_log_with_its_files_last_is_compacted_and_comes_back() {
    let place = folder("foreign-compact");
    for tool in &TOOLS {
        let (log, compact) = (place.join("log.mcap"), place.join("compact.mcap"));
        write(&Forgery::of(flight()), tool, None, &log);
        let out = ["--force", "--out", text(&compact)];
        tiltrotor(&[&["log", "compact", text(&log)], &out[..]].concat()).ends(OK);
        verify(&compact).ends(OK).says("exact: all 500 ticks");
        // The compacted log goes through the same tool.
        write(&Forgery::of(&compact), tool, None, &log);
        if tool.name == "no-index" {
            // Channels that have no message in a compacted log are lost with such a tool.
            verify(&log).ends(UNUSABLE).says("a channel is not there");
            continue;
        }
        verify(&log).ends(OK).says("exact: all 500 ticks");
        let expanded = place.join("expanded.mcap");
        let out = ["--force", "--out", text(&expanded)];
        tiltrotor(&[&["log", "expand", text(&log)], &out[..]].concat()).ends(OK);
        verify(&expanded).ends(OK).says("exact: all 500 ticks");
    }
}

#[test]
fn a_channel_of_somebody_else_s_takes_nothing_from_the_flight() {
    let place = folder("foreign-channel");
    for tool in &TOOLS {
        let log = place.join(format!("{}.mcap", tool.name));
        write(&Forgery::of(flight()), tool, Some("/theirs"), &log);
        verify(&log).ends(OK).says("exact: all 500 ticks");
    }
}

#[test]
fn what_was_changed_on_the_way_is_still_found() {
    let place = folder("foreign-changed");
    for tool in &TOOLS {
        let mut log = Forgery::of(flight());
        flip_state_bit(&mut log, 300, "plant.velocity_mps.x");
        let changed = place.join(format!("{}.mcap", tool.name));
        write(&log, tool, Some("/theirs"), &changed);
        verify(&changed).ends(DIVERGED).says("tick 300");
        let mut log = Forgery::of(flight());
        let (from, to) = ("mast_length_ft = { value = 4.667", "mast_length_ft = { value = 4.668");
        log.rewrite("aircraft.toml", from, to);
        write(&log, tool, None, &changed);
        verify(&changed).ends(DIVERGED).says("the log was changed after the flight");
        // A message on a channel of ours is none of somebody else's.
        write(&Forgery::of(flight()), tool, Some("/log"), &changed);
        assert_ne!(verify(&changed).status, Some(OK), "{}", tool.name);
        let mut log = Forgery::of(flight());
        log.attachments.retain(|file| file.name != "aircraft.toml");
        write(&log, tool, None, &changed);
        verify(&changed).ends(UNUSABLE).says("aircraft.toml is not in it");
    }
}

/// Every 7th message has one of theirs behind it.
fn theirs_among(log: &Forgery) -> usize {
    log.messages.len().div_ceil(7)
}

#[test]
fn what_is_foreign_and_what_is_out_of_place_is_counted_by_every_verb() {
    let place = folder("foreign-counted");
    let notes = mcap::records::Metadata {
        name: "somebody.notes".into(),
        metadata: BTreeMap::from([("weather".into(), "fine".into())]),
    };
    let mut log = Forgery::of(flight());
    log.metadata.insert(0, notes);
    let whole = place.join("whole.mcap");
    write(&log, &TOOLS[0], Some("/theirs"), &whole);

    // Whole: theirs is named, and takes nothing from the flight.
    tiltrotor(&["log", "info", text(&whole)]).ends(OK).says("somebody.notes").says("fine");
    verify(&whole).ends(OK).says("exact: all 500 ticks");
    let lines = |log: &Path, status: i32| {
        tiltrotor(&["log", "cat", text(log), "--channel", "state"]).ends(status).out.lines().count()
    };
    assert_eq!(lines(&whole, OK), 501, "the first state, and one a tick");
    tiltrotor(&["log", "recover", text(&whole), "--out", text(&place.join("no.mcap"))]).refused();

    // The timing of tick 100 stands behind everything: one record out of place.
    let at = log.places("/timing")[99];
    let late = log.messages.remove(at);
    log.messages.push(late);
    let broken = place.join("misplaced.mcap");
    write(&log, &TOOLS[0], Some("/theirs"), &broken);
    let info = tiltrotor(&["log", "info", text(&broken)]);
    assert_ne!(info.status, Some(OK), "{info}");
    info.says("somebody.notes");
    let said = verify(&broken);
    assert_ne!(said.status, Some(OK), "{said}");
    said.says("500");
    let fixed = place.join("fixed.mcap");
    let said = tiltrotor(&["log", "recover", text(&broken), "--out", text(&fixed)]);
    said.says(&format!("{} messages on channels of others", theirs_among(&log)));
    verify(&fixed).says("500");
}
