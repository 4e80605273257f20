//! What an engineer reads, kept as snapshots: a change of layout, of motion or of wording shows up as a
//! difference to be looked at. `INSTA_UPDATE=always cargo test --test snapshots` takes the new ones.

mod common;

use common::{folder, text, tiltrotor};
use logs::channels::CHANNELS;
use logs::schema::MessageType;

#[test]
fn regress_the_layout_of_every_recorded_channel() {
    // Another layout is another format version: logs::records::FORMAT_VERSION.
    let texts: Vec<_> = CHANNELS
        .iter()
        .map(|channel| {
            let MessageType { name, text, .. } = channel.message_type().expect("recordable");
            format!("{}: {name}\n{text}", channel.topic)
        })
        .collect();
    insta::assert_snapshot!(texts.join("\n"));
}

#[test]
fn regress_the_events_of_the_demonstration_flight() {
    let log = folder("snapshots").join("flight.mcap");
    let common = ["--fast", "--no-flightgear", "--force", "--out", text(&log)];
    tiltrotor(&[&["demo"], &common[..]].concat()).ends(common::OK);
    let info = tiltrotor(&["log", "info", text(&log)]).ends(common::OK).out;
    // Everything from the first event on; what comes before names the build and the clock.
    let events: Vec<_> = info.lines().skip_while(|line| !line.contains(".000 s  ")).collect();
    insta::assert_snapshot!(events.join("\n"));
}
