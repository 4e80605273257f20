//! No verb takes a log for better than it is, and no chain of verbs makes it better.
//!
//! The logs are changed by a writer that is not ours: it copies every record, and all its checksums are
//! right.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use common::{
    DIVERGED, Forgery, INCOMPLETE, OK, Said, UNUSABLE, all, flip_state_bit, folder, hover,
    place_of, text, tiltrotor, verify,
};
use logs::records::{HARDWARE, INPUTS, InputsRecord, OUTPUTS, STATE, TIMING, TimingRecord};
use mcap::Message;

/// Six tenths of a second by the pilot model: every verb reflies it, and in debug too.
const TICKS: usize = 150;

fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("trust").join("flight.mcap");
        hover(&log, "0.6");
        log
    })
}

/// What a log is, and so what every verb says of it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Is {
    Altered,
    OutputsDiffer,
    Damaged,
    NeverClosed,
}

impl Is {
    /// With what verbs end that read it.
    fn status(self) -> i32 {
        match self {
            Self::Altered | Self::OutputsDiffer => DIVERGED,
            Self::Damaged => UNUSABLE,
            Self::NeverClosed => INCOMPLETE,
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Altered => "altered at ",
            Self::OutputsDiffer => "outputs differ at ",
            Self::Damaged => "damaged after ",
            Self::NeverClosed => "never closed: ",
        }
    }

    /// What verbs know that do not refly: a changed message beside the flight.
    fn as_read(self) -> Self {
        if self == Self::OutputsDiffer { Self::Damaged } else { self }
    }
}

/// A kind of alteration: its name, what becomes of the log, what `verify` says more.
type Kind = (&'static str, Is, &'static str, fn(&mut Forgery));

const KINDS: [Kind; 16] = [
    ("state", Is::Altered, "altered at tick 80 (0.320 s)", |log| {
        flip_state_bit(log, 80, "plant.velocity_mps.x");
    }),
    ("kernel-time", Is::Altered, "the digest does not follow", |log| {
        let place = place_of::<engine::inputs::DeviceEvent>("kernel_time_ns");
        log.bytes(HARDWARE, 2)[place] ^= 1;
    }),
    ("events-swapped", Is::Altered, "the digest does not follow", swap_events),
    ("world", Is::Altered, "altered at tick 41", |log| {
        let place = place_of::<InputsRecord>("world.wind_mps.x");
        log.bytes(INPUTS, 40)[place + 6] ^= 0x10;
    }),
    ("aircraft", Is::Altered, "is not what it was flown with", |log| {
        let (from, to) = ("mast_length_ft = { value = 4.667", "mast_length_ft = { value = 4.668");
        log.rewrite("aircraft.toml", from, to);
    }),
    (
        "ticks-missing",
        Is::Altered,
        "20 ticks are missing, from tick 41 (0.164 s) to tick 60 (0.240 s)",
        |log| {
            let (from, to) = (log.places(STATE)[40] + 1, log.places(STATE)[60] + 1);
            let of_flight = |message: &Message| [HARDWARE, INPUTS, STATE].contains(&topic(message));
            let mut place = 0;
            log.messages.retain(|message| {
                place += 1;
                !((from..to).contains(&(place - 1)) && of_flight(message))
            });
        },
    ),
    ("tick-doubled", Is::Altered, "tick 70 (0.280 s) is there once more", |log| {
        let (from, to) = (log.places(STATE)[69] + 1, log.places(STATE)[70] + 1);
        let again: Vec<_> = log.messages[from..to].to_vec();
        log.messages.splice(to..to, again);
    }),
    ("timing", Is::Damaged, "is not as written", |log| {
        let place = place_of::<TimingRecord>("step_ns");
        log.bytes(TIMING, 50)[place] ^= 1;
    }),
    ("timing-log-time", Is::Damaged, "is not as written", |log| {
        let place = log.places(TIMING)[50];
        log.messages[place].log_time += 1;
    }),
    ("tf-renamed", Is::Damaged, "is not as written", |log| {
        for place in log.places("/tf") {
            let mut channel = (*log.messages[place].channel).clone();
            channel.topic = "/tf_of_old".into();
            log.messages[place].channel = Arc::new(channel);
        }
    }),
    ("outputs-doubled", Is::Damaged, "is not as written", |log| {
        let place = log.places(OUTPUTS)[5];
        let again = log.messages[place].clone();
        log.messages.insert(place, again);
    }),
    ("outputs", Is::OutputsDiffer, "body_velocity_mps", |log| {
        let place = place_of::<engine::Outputs>("body_velocity_mps.x");
        log.bytes(OUTPUTS, 5)[place] ^= 1;
    }),
    ("schema", Is::Damaged, "", |log| {
        for place in log.places(TIMING) {
            let mut channel = (*log.messages[place].channel).clone();
            let mut schema = (**channel.schema.as_ref().expect("a schema")).clone();
            let changed = String::from_utf8(schema.data.to_vec()).expect("text");
            schema.data = changed.replacen("late_ns", "early_ns", 1).into_bytes().into();
            channel.schema = Some(Arc::new(schema));
            log.messages[place].channel = Arc::new(channel);
        }
    }),
    ("sorted", Is::Damaged, "", |log| {
        // By time alone nothing would move: log times never go back.
        let beside = |message: &Message| match topic(message) {
            HARDWARE | INPUTS | STATE => String::new(),
            topic => topic.to_owned(),
        };
        log.messages.sort_by_key(|message| (message.log_time, beside(message)));
    }),
    ("who-flew", Is::Damaged, "the metadata that says who flew is not as written", |log| {
        let facts = log.metadata.iter_mut().find(|record| record.name == "tiltrotor");
        facts.expect("metadata").metadata.insert("commit".into(), "another".into());
    }),
    ("last-word", Is::NeverClosed, "", |log| {
        log.metadata.retain(|record| record.name != "tiltrotor_closing");
    }),
];

fn topic<'a>(message: &'a Message) -> &'a str {
    &message.channel.topic
}

/// The first two events of one tick that are not the same change places.
fn swap_events(log: &mut Forgery) {
    let places = log.places(HARDWARE);
    let swapped = places.windows(2).find(|pair| {
        let [a, b] = [0, 1].map(|at| &log.messages[pair[at]]);
        a.log_time == b.log_time && a.data != b.data
    });
    let [a, b] = swapped.expect("two events of one tick") else { unreachable!("a window of two") };
    log.messages.swap(*a, *b);
}

/// The log of that kind, in a folder of its own.
fn altered(kind: &Kind, name: &str) -> PathBuf {
    let mut log = Forgery::of(flight());
    (kind.3)(&mut log);
    let path = folder(&format!("trust-{name}-{}", kind.0)).join("log.mcap");
    log.write(&path);
    path
}

/// Every verb that reads a log, with what it needs.
fn reading(log: &Path) -> Vec<(&'static str, Said, bool)> {
    let log = text(log);
    let tables = format!("{log}-tables");
    let replay = ["replay", log, "--speed", "1000", "--flightgear", "127.0.0.1:9"];
    vec![
        ("verify", tiltrotor(&["verify", log]), true),
        ("summary", tiltrotor(&["log", "summary", log]), true),
        ("replay", tiltrotor(&replay), true),
        ("plot", tiltrotor(&["plot", log, "--figure", "plan", "--force"]), true),
        ("report", tiltrotor(&["report", log, "--compact", "--force"]), true),
        ("info", tiltrotor(&["log", "info", log]), false),
        ("cat", tiltrotor(&["log", "cat", log, "--channel", "timing"]), false),
        ("export", tiltrotor(&["log", "export", log, "--csv", &tables]), false),
    ]
}

/// The verbs that make a log of a log; the new one is at `out`.
const MAKING: [&str; 6] = ["compact", "expand", "clip", "whatif", "bless", "recover"];

fn make(verb: &str, log: &Path, out: &Path) -> Said {
    let (from, to) = (text(log), text(out));
    match verb {
        "clip" => tiltrotor(&["log", "clip", from, "--from", "0.2", "--until", "0.4", "--out", to]),
        "whatif" => {
            let set = ["--set", "fcc.travel.pedal_in=2", "--until", "0.4"];
            tiltrotor(&[&["whatif", from, "--out", to], &set[..]].concat())
        }
        // In its place.
        "bless" => {
            fs::copy(log, out).expect("a copy");
            tiltrotor(&["verify", "--bless", to])
        }
        verb => tiltrotor(&["log", verb, from, "--out", to]),
    }
}

#[test]
fn every_verb_that_reads_says_what_a_log_is() {
    flight();
    all(&KINDS, |kind| {
        let (name, is, more, _) = kind;
        let log = altered(kind, "read");
        for (verb, said, reflies) in reading(&log) {
            let is = if reflies { *is } else { is.as_read() };
            // What is sorted by time may make no flight any more, and is then no less damaged.
            let ends = said.status == Some(is.status());
            let told = said.out.contains(is.word()) || said.err.contains(is.word());
            if !ends || !told {
                return Some(format!("{name}, {verb}: {said}"));
            }
            if verb == "verify" && !said.out.contains(more) {
                return Some(format!("{name}: no `{more}`: {said}"));
            }
            if [&said.out, &said.err].iter().any(|said| said.contains(": exact: all")) {
                return Some(format!("{name}, {verb} says exact: {said}"));
            }
        }
        let said = tiltrotor(&["diff", text(&log), text(flight())]);
        if said.status == Some(OK) || !said.out.contains(is.as_read().word()) {
            return Some(format!("{name}, diff: {said}"));
        }
        let table = fs::read_dir(format!("{}-tables/flights", text(&log))).expect("a table");
        let row = table.last().expect("a flight").expect("an entry").path().join("data.csv");
        let row = fs::read_to_string(row).expect("a table");
        let told = row.contains("judgement") && row.contains(is.as_read().word());
        (!told).then(|| format!("{name}: the table says {row}"))
    });
}

#[test]
fn no_verb_and_no_chain_of_verbs_makes_a_log_better_than_it_is() {
    flight();
    all(&KINDS, |kind| {
        let (name, is, ..) = kind;
        let log = altered(kind, "chain");
        let mut wrong = String::new();
        for first in MAKING {
            let made = log.with_file_name(format!("{first}.mcap"));
            let said = make(first, &log, &made);
            let expected = match (first, is) {
                ("recover", _) => said.status == Some(INCOMPLETE) || said.status == Some(UNUSABLE),
                ("compact" | "clip" | "whatif", Is::NeverClosed) => said.status == Some(INCOMPLETE),
                _ => said.status == Some(UNUSABLE),
            };
            if !expected {
                wrong += &format!("{name}, {first}: {said}\n");
            }
            wrong +=
                &clean(&made).map_or_else(String::new, |why| format!("{name}, {first}: {why}\n"));
            if first != "bless" {
                wrong += &follow(name, &made, chain_length() - 1);
            }
        }
        (!wrong.is_empty()).then_some(wrong)
    });
}

/// Verbs in a chain: two, and three in `tests/full.sh`.
fn chain_length() -> usize {
    let length = std::env::var("TILTROTOR_CHAINS").ok().and_then(|length| length.parse().ok());
    length.unwrap_or(2)
}

/// Goes on from a log by every verb, so many times; what came out clean.
fn follow(kind: &str, log: &Path, verbs: usize) -> String {
    let mut wrong = String::new();
    if verbs == 0 || !log.exists() {
        return wrong;
    }
    let so_far = log.file_stem().expect("a name").display().to_string();
    for verb in MAKING {
        let made = log.with_file_name(format!("{so_far}-{verb}.mcap"));
        let said = make(verb, log, &made);
        if let Some(why) = clean(&made) {
            wrong += &format!("{kind}, {so_far}-{verb}: {why}\n");
        }
        // What was not blessed is the log that it was.
        if verb != "bless" || said.status == Some(OK) {
            wrong += &follow(kind, &made, verbs - 1);
        }
        let _ = fs::remove_file(made);
    }
    wrong
}

/// Why a log that came of one that is not to be trusted looks as if it were.
fn clean(log: &Path) -> Option<String> {
    if !log.exists() {
        return None;
    }
    let said = verify(log);
    let marked = said.out.contains("first bad tick") && said.out.contains("it was made from");
    (said.status == Some(OK) && !marked).then(|| format!("clean: {said}"))
}

#[test]
fn what_is_made_of_a_flight_that_was_cut_says_so_wherever_it_goes() {
    let place = folder("trust-cut");
    let path = |name: &str| place.join(name);
    let bytes = fs::read(flight()).expect("a log");
    fs::write(path("cut.mcap"), &bytes[..bytes.len() * 4 / 5]).expect("a file");
    make("clip", &path("cut.mcap"), &path("clip.mcap")).ends(INCOMPLETE).says("never closed: ");
    let marked = |name: &str| {
        verify(&path(name)).ends(OK).says("it was made from ").says("first bad tick is ");
        tiltrotor(&["log", "info", text(&path(name))]).ends(OK).says("never closed: ");
    };
    marked("clip.mcap");
    make("compact", &path("clip.mcap"), &path("compact.mcap")).ends(OK);
    marked("compact.mcap");
    make("expand", &path("compact.mcap"), &path("expand.mcap")).ends(OK);
    marked("expand.mcap");
    make("whatif", &path("expand.mcap"), &path("whatif.mcap")).ends(OK);
    marked("whatif.mcap");
    make("bless", &path("whatif.mcap"), &path("bless.mcap")).ends(OK).says("nothing moved");
    marked("bless.mcap");
}

#[test]
fn a_clean_flight_stays_clean() {
    let place = folder("trust-clean");
    for verb in ["compact", "clip", "whatif", "bless"] {
        let made = place.join(format!("{verb}.mcap"));
        make(verb, flight(), &made).ends(OK);
        verify(&made).ends(OK).says("exact: all ").never_says("first bad tick");
    }
    let said = tiltrotor(&["diff", text(flight()), text(flight())]).ends(OK);
    said.says("not reflown: ").says("the same flight").never_says("regular");
}

#[test]
fn a_part_carries_the_viewers_messages_of_the_whole() {
    let part = folder("trust-part").join("part.mcap");
    make("clip", flight(), &part).ends(OK);
    let of = |log: &Path, topic: &str| {
        let log = Forgery::of(log);
        let of_tick = |message: &Message| message.log_time == 200_000_000;
        let places = log.places(topic).into_iter().map(|place| log.messages[place].clone());
        places.filter(of_tick).map(|message| message.data.into_owned()).collect::<Vec<_>>()
    };
    for topic in ["/tf", "/joy", "/joint_states", "/fix", OUTPUTS] {
        assert_eq!(of(&part, topic), of(flight(), topic), "{topic}");
        assert_eq!(of(&part, topic).len(), 1, "{topic}");
    }
    let shape = |log: &Path| Forgery::of(log).bytes("/robot_description", 0).to_vec();
    assert_eq!(shape(&part), shape(flight()));
}

#[test]
fn a_channel_of_somebody_else_s_is_compacted_and_comes_back() {
    let place = folder("trust-foreign");
    let (log, compact, back) =
        (place.join("log.mcap"), place.join("compact.mcap"), place.join("back.mcap"));
    let mut flown = Forgery::of(flight());
    // A type of the name that the shape of the aircraft has, too, but of another text.
    let mut foreign = flown.messages[flown.places("/robot_description")[0]].clone();
    let mut channel = (*foreign.channel).clone();
    let mut schema = (**channel.schema.as_ref().expect("a schema")).clone();
    (schema.id, schema.data) = (1000, b"string data # theirs\n".as_slice().into());
    (channel.id, channel.topic) = (1000, "/theirs".into());
    channel.schema = Some(Arc::new(schema));
    foreign.channel = Arc::new(channel);
    for place in (50..flown.messages.len()).step_by(50) {
        let mut message = foreign.clone();
        message.log_time = flown.messages[place].log_time;
        message.publish_time = message.log_time;
        flown.messages.insert(place, message);
    }
    flown.write(&log);
    make("compact", &log, &compact).ends(OK).says("message for message");
    verify(&compact).ends(OK).says(&format!("exact: all {TICKS} ticks"));
    make("expand", &compact, &back).ends(OK);
    let messages = |log: &Path| {
        let of = |m: Message<'static>| (m.channel.topic.clone(), m.log_time, m.sequence, m.data);
        Forgery::of(log).messages.into_iter().map(of).collect::<Vec<_>>()
    };
    assert!(messages(&back) == messages(&log));
}

#[test]
fn the_tables_of_a_compacted_log_are_those_of_the_log_that_it_was() {
    let place = folder("trust-tables");
    let compact = place.join("compact.mcap");
    make("compact", flight(), &compact).ends(OK);
    let tables = |log: &Path, name: &str| {
        let tables = place.join(name);
        tiltrotor(&["log", "export", text(log), "--csv", text(&tables)]).ends(OK);
        ["state", "outputs", "hardware", "inputs", "timing", "events", "log"].map(|table| {
            let part = fs::read_dir(tables.join(table)).expect("a table").next();
            let file = part.expect("a flight").expect("an entry").path().join("data.csv");
            fs::read_to_string(file).expect("a table")
        })
    };
    assert!(tables(&compact, "compact") == tables(flight(), "whole"));
}

#[test]
fn a_difference_in_a_compacted_log_lies_between_two_states_that_were_kept() {
    let place = folder("trust-between");
    let compact = place.join("compact.mcap");
    let keyframes = ["--keyframes", "0.2", "--out", text(&compact)];
    tiltrotor(&[&["log", "compact", text(flight())], &keyframes[..]].concat()).ends(OK);
    let mut log = Forgery::of(&compact);
    // The first message is the state at the start, the next ones are the keyframes.
    flip_state_bit(&mut log, 2, "plant.fuel_kg");
    log.write(&compact);
    let said = verify(&compact).ends(DIVERGED).never_says("block  ");
    said.says("first difference: between tick 99 (0.396 s) and tick 100 (0.400 s)")
        .says("plant.fuel_kg")
        .says("keyframes ");
}
