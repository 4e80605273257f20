//! What an engineer reads, kept as snapshots: a change of layout, of motion or of wording shows up as a
//! difference to be looked at. `INSTA_UPDATE=always cargo test --test snapshots` takes the new ones.

mod common;

use common::{folder, text, tiltrotor};
use logs::records::{EventRecord, InputsRecord, StateRecord, TimingRecord};
use logs::schema::ros2msg;

#[test]
fn regress_the_layout_of_every_recorded_channel() {
    // Another layout is another format version: logs::records::FORMAT_VERSION.
    let schemas = [
        ("/hardware", ros2msg::<engine::inputs::DeviceEvent>()),
        ("/inputs", ros2msg::<InputsRecord>()),
        ("/state", ros2msg::<StateRecord>()),
        ("/timing", ros2msg::<TimingRecord>()),
        ("/events", ros2msg::<EventRecord>()),
    ];
    let texts: Vec<_> = schemas
        .into_iter()
        .map(|(topic, schema)| format!("{topic}\n{}", schema.expect("a schema")))
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
