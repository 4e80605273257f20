use super::*;
use crate::FlightWriter;
use crate::container::Compacted;
use crate::container::checksums::MessageDigests;
use crate::records::FlightEvent;

/// A compacted log that is read to its end: what was flown again of it.
struct Made {
    flown: Option<(State, Outputs)>,
    outputs_differ: Option<u64>,
}

impl RecordSource for Made {
    fn next(&mut self, _: &mut Record) -> Result<bool, LogError> {
        Ok(false)
    }

    fn seek(&mut self, _: u64) -> Result<(), LogError> {
        Ok(())
    }

    fn compacted(&self) -> Option<Compacted<'_>> {
        let flown = self.flown.as_ref().map(|(state, outputs)| (state, outputs));
        Some(Compacted { recorded: false, flown, outputs_differ: self.outputs_differ })
    }
}

/// A number of messages that is not that of no message, which is all that is read here.
const OTHERS: u64 = 7;

/// What is the same as no message.
fn none() -> Option<u64> {
    let counted = Some(crate::container::checksums::MessageDigest::default().digest());
    assert!(MessageDigests::default().are(counted) && counted != Some(OTHERS));
    counted
}

/// The end of a log that its writer closed after these messages.
fn closed(messages: Option<u64>) -> FlightReader {
    let closing = Some(FooterRecord { last: (0, 0), messages });
    FlightReader { closing, unbroken: true, ..FlightReader::default() }
}

fn compacted(outputs_differ: Option<u64>, messages: Option<u64>) -> FlightReader {
    let flown = Some((State::default(), Outputs::default()));
    let stream = Stream::over(Box::new(Made { flown, outputs_differ }));
    FlightReader { stream, same_model: true, ..closed(messages) }
}

fn remade(mut reader: FlightReader) -> Remade {
    assert!(reader.next_tick().expect("an end").is_none());
    reader.remade()
}

#[test]
fn what_is_made_again_differs_where_the_writer_had_counted_other_messages() {
    assert_eq!(remade(compacted(None, none())), Remade::AsRecorded);
    assert_eq!(remade(compacted(None, Some(OTHERS))), Remade::Differs);
    // Outputs have digests of their own, and tell the tick.
    for messages in [none(), Some(OTHERS), None] {
        let reader = compacted(Some(30), messages);
        assert_eq!(remade(reader), Remade::OutputsDiffer { tick: 30 });
    }
    // Of a log that is not compacted nothing is made.
    assert_eq!(remade(closed(Some(OTHERS))), Remade::AsRecorded);
}

#[test]
fn what_is_not_made_by_this_model_or_not_read_whole_says_nothing_of_what_was_recorded() {
    let weak: [fn(&mut FlightReader); 8] = [
        |reader| reader.same_model = false,
        |reader| {
            reader.stream.source = Box::new(Made { flown: None, outputs_differ: None });
        },
        |reader| reader.unbroken = false,
        |reader| reader.stream.sought = true,
        |reader| reader.stream.ending = Ending::Truncated,
        |reader| reader.stream.integrity_fault("a definition"),
        |reader| reader.closing = None,
        |reader| reader.closing = Some(FooterRecord { last: (0, 0), messages: None }),
    ];
    for (number, weaken) in weak.iter().enumerate() {
        let mut reader = compacted(None, Some(OTHERS));
        weaken(&mut reader);
        assert_eq!(remade(reader), Remade::AsRecorded, "weakness {number}");
    }
}

#[test]
fn a_log_is_closed_when_its_last_record_is_that_of_what_was_read() {
    let end = |messages, change: fn(&mut FlightReader)| {
        let mut reader = closed(messages);
        change(&mut reader);
        reader.end().expect("an end")
    };
    assert_eq!(end(none(), |_| ()), Ending::Closed);
    let cut: [fn(&mut FlightReader); 5] = [
        |reader| reader.closing = None,
        |reader| reader.last = (1, 0),
        |reader| reader.last = (0, 1),
        |reader| reader.stream.ending = Ending::Truncated,
        // A proper file, and not the whole flight.
        |reader| reader.identity = Identity::default().with(Identity::RECOVERED_FROM, "cut.mcap"),
    ];
    for (number, change) in cut.into_iter().enumerate() {
        assert_eq!(end(none(), change), Ending::Truncated, "case {number}");
    }
    // The first format counted no messages; later ones always do.
    let first_format = |reader: &mut FlightReader| {
        reader.identity = Identity::default().with(Identity::FORMAT, WITHOUT_CHECKSUMS);
    };
    assert_eq!(end(None, |_| ()), Ending::Truncated);
    assert_eq!(end(None, first_format), Ending::Closed);
    assert_eq!(end(Some(OTHERS), first_format), Ending::Closed);
}

#[test]
fn messages_that_were_not_counted_are_damage_where_all_were_read() {
    let end = |change: fn(&mut FlightReader)| {
        let mut reader = closed(Some(OTHERS));
        change(&mut reader);
        reader.end().expect("an end")
    };
    let beside = end(|_| ());
    let said = "a message beside the flight itself";
    assert!(matches!(&beside, Ending::Damaged(why) if why.starts_with(said)), "{beside:?}");
    assert_eq!(end(|reader| reader.unbroken = false), Ending::Closed);
    assert_eq!(end(|reader| reader.stream.sought = true), Ending::Closed);
    // What a compacted log makes again is judged apart.
    assert_eq!(compacted(None, Some(OTHERS)).end().expect("an end"), Ending::Closed);
    // What was found first is told.
    let damaged = |why: &str| Ending::Damaged(why.into());
    let found = end(|reader| reader.stream.integrity_fault("a definition"));
    assert_eq!(found, damaged("a definition"));
    let both = end(|reader| {
        reader.stream.integrity_fault("a definition");
        reader.stream.ending = Ending::Damaged("a checksum".into());
    });
    assert_eq!(both, damaged("a checksum"));
}

#[test]
fn a_tick_that_was_begun_and_has_no_state_is_an_error_of_a_closed_log_alone() {
    let begun: [fn(&mut FlightReader); 2] = [
        |reader| reader.has_inputs = true,
        |reader| reader.tick.events.push(DeviceEvent::default()),
    ];
    for begin in begun {
        let mut reader = closed(none());
        begin(&mut reader);
        let error = reader.end().expect_err("no state").to_string();
        assert!(error.ends_with("the last tick has no state"), "{error}");
        reader.stream.ending = Ending::Truncated;
        assert_eq!(reader.end().expect("cut there"), Ending::Truncated);
    }
}

#[test]
fn what_was_recorded_beside_the_flight_is_kept_until_it_is_let_go_of() {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    let file = tempfile::NamedTempFile::new().expect("a file");
    let new = file.reopen().expect("a file");
    let (setup, identity) = (Setup::default(), Identity::new().with("commit", "0123456789"));
    let mut writer =
        FlightWriter::create(new, &setup, &identity, &aircraft, "<robot/>", &State::default())
            .expect("a log");
    let stick = DeviceIdentity { vendor: 0x44f, name: "a stick".into(), ..Default::default() };
    writer.device(&stick).expect("written");
    writer.inputs(&InputsRecord::default()).expect("written");
    let state = State { tick: 1, ..State::default() };
    writer.state(&state).expect("written");
    let timing = TimingRecord { late_ns: 3, ..TimingRecord::default() };
    writer.timing(&timing).expect("written");
    writer.flight_event(1, FlightEvent::Marker, 4, [0.5, 2.0], "marker 4").expect("written");
    // Outputs are recorded every tenth tick.
    let outputs = Outputs { tick: 10, mach: 0.25, ..Outputs::default() };
    writer.view(&outputs, state.plant.attitude).expect("written");
    writer.finish().expect("closed");

    for keep_outputs in [true, false] {
        let mut reader = open(file.path(), OpenOptions::default()).expect("a log");
        reader.keep_outputs = keep_outputs;
        while reader.next_tick().expect("whole ticks").is_some() {}
        assert_eq!(reader.ending(), Some(&Ending::Closed));
        assert_eq!(reader.robot_description, "<robot/>");
        assert_eq!(reader.devices, std::slice::from_ref(&stick));
        assert_eq!(reader.timings, [timing]);
        let kind = FlightEvent::Marker as u64;
        let event = EventRecord { tick: 1, kind, value: 4, measured: [0.5, 2.0] };
        assert_eq!(reader.events, [event]);
        // Tick 1 is 4 ms.
        let lines = reader.log_lines.iter().map(|line| (line.time_ns, line.words.as_str()));
        assert_eq!(lines.collect::<Vec<_>>(), [(4_000_000, "marker 4")]);
        assert_eq!(reader.outputs, if keep_outputs { vec![outputs] } else { Vec::new() });
        reader.forget();
        assert!(
            reader.timings.is_empty() && reader.events.is_empty() && reader.log_lines.is_empty()
        );
        assert_eq!(reader.devices.len(), 1, "devices stay");
    }
}
