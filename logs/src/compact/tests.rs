use std::fs::{self, File};
use std::path::Path;

use engine::inputs::{DeviceEvent, EventKind, World};
use engine::{Inputs, State, step};

use super::*;
use crate::output::Output;
use crate::records::{FlightEvent, InputsRecord, TIMING, TimingRecord};
use crate::view::TF;
use crate::{
    Ending, FlightReader, FlightWriter, Identity, LogError, Messages, OpenOptions, Remade, Setup,
};

/// Ticks of the log: three blocks of keyframes, and a part of one.
const TICKS: u64 = 22;
const KEYFRAME_TICKS: u64 = 6;

fn setup() -> Setup {
    Setup { aircraft_toml: "name = \"X\"\n".into(), ..Setup::default() }
}

fn flown_by(_: &Setup) -> Result<FlightModel, LogError> {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    Ok(FlightModel { aircraft, world: World::default() })
}

/// A log with something on every channel.
fn flown(log: &Path) {
    let aircraft = flown_by(&setup()).expect("an aircraft").aircraft;
    let mut state = State::default();
    let file = File::create_new(log).expect("a file");
    let identity = Identity::new().with("commit", "0123456789");
    let mut writer = FlightWriter::create(file, &setup(), &identity, &aircraft, "<robot/>", &state)
        .expect("a log");
    for tick in 0..TICKS {
        let kind = EventKind::Axis as u64;
        let event = DeviceEvent { tick, kind, value: -7, ..DeviceEvent::default() };
        writer.event(&event).expect("written");
        writer.inputs(&InputsRecord { tick, events: 1, ..Default::default() }).expect("written");
        let inputs = Inputs { events: &[event], world: World::default() };
        let (flown, outputs) = step(&aircraft, &state, &inputs);
        state = flown;
        writer.state(&state).expect("written");
        let timing = TimingRecord { tick, step_ns: 9_000 + tick, ..TimingRecord::default() };
        writer.timing(&timing).expect("written");
        writer.view(&outputs, state.plant.attitude).expect("written");
        if tick.is_multiple_of(7) {
            writer
                .flight_event(tick, FlightEvent::Marker, tick, [0.0; 2], "marker")
                .expect("written");
            writer.flush().expect("written");
        }
    }
    writer.finish().expect("closed");
}

/// The same with messages that nobody can make again: a time that is not its tick's, another picture.
fn with_odd_messages(log: &Path, from: &Path) {
    let identity = open(from).identity;
    let file = File::create_new(log).expect("a file");
    let mut writer = FlightWriter::begin(file, &setup(), &identity).expect("a log");
    let mut messages = Messages::open(from, OpenOptions::default()).expect("a log");
    let mut odd = 0;
    while let Some(message) = messages.next_message() {
        let mut message = message.clone();
        let tick = message.time_ns / engine::STEP_NS;
        let before = message.clone();
        match (message.topic(), tick) {
            (TIMING, 9) => message.header.publish_time += 1,
            (TF, 10) => *message.data.last_mut().expect("a byte") ^= 1,
            (TF, 15) => message.header.sequence += 1,
            _ => {}
        }
        odd += u32::from(message != before);
        assert!(writer.copy(&message).expect("written"));
    }
    assert_eq!(odd, 3);
    writer.finish().expect("closed");
}

fn open(log: &Path) -> FlightReader {
    let options = OpenOptions { aircraft_of: Some(flown_by), across_versions: false };
    crate::open(log, options).expect("a log")
}

/// Its messages, and how it ends.
fn all_of(log: &Path) -> (Vec<(String, u64, Vec<u8>)>, Ending) {
    let options = OpenOptions { aircraft_of: Some(flown_by), across_versions: false };
    let mut messages = Messages::open(log, options).expect("a log");
    let mut all = Vec::new();
    while let Some(message) = messages.next_message() {
        all.push((message.topic().to_string(), message.time_ns, message.data.clone()));
    }
    (all, messages.ending())
}

#[test]
fn a_log_is_compacted_and_comes_back_message_by_message_and_byte_by_byte() {
    let folder = tempfile::tempdir().expect("a folder");
    let [plain, odd] = ["plain.mcap", "odd.mcap"].map(|name| folder.path().join(name));
    flown(&plain);
    with_odd_messages(&odd, &plain);
    let mut sizes = Vec::new();
    for log in [&plain, &odd] {
        let [compact, again] = ["compact", "again"].map(|name| log.with_extension(name));
        let output = Output::beside(&compact, false, &[]).expect("a place");
        let copied = super::compact(log, &output, KEYFRAME_TICKS, flown_by, |_| ());
        output.finish().expect("finished");
        assert_eq!(copied.expect("compacted").states, TICKS + 1);
        assert!(
            fs::metadata(&compact).expect("a file").len()
                < fs::metadata(log).expect("a file").len()
        );
        sizes.push(fs::metadata(&compact).expect("a file").len());

        // It is read as the log it was.
        assert_eq!(all_of(&compact), all_of(log));
        let mut reader = open(&compact);
        let mut recorded = Vec::new();
        while let Some(tick) = reader.next_tick().expect("whole ticks") {
            assert!(tick.chained);
            let tick = tick.record.state.tick;
            if reader.is_recorded() {
                recorded.push(tick);
            }
        }
        assert_eq!((reader.ending(), reader.remade()), (Some(&Ending::Closed), Remade::AsRecorded));
        assert_eq!(recorded, [6, 12, 18, 22], "the last state of each block is kept");

        let output = Output::beside(&again, false, &[]).expect("a place");
        let expanded = expand(&compact, &output, flown_by, |_| ()).expect("expanded");
        output.finish().expect("finished");
        assert_eq!(expanded.same_file, Some(true));
        assert!(fs::read(&again).expect("a log") == fs::read(log).expect("a log"));
    }
    assert!(sizes[0] < sizes[1], "what is not made again is kept: {sizes:?}");
}
