//! What a tick costs: flying it, handing it to the log's writer, reflying it from a log.
//!
//! `cargo bench --no-default-features`. The yardsticks are there so that figures from different
//! machines, or from a busy one, can be read against each other.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use divan::Bencher;
use divan::counter::ItemsCount;
use engine::inputs::World;
use engine::start::Start;
use engine::{Aircraft, Inputs, State, step};
use flightgear::{Picture, Scene};
use logs::compact::Copied;
use logs::output::Output;
use logs::records::{InputsRecord, TimingRecord};
use logs::{FlightWriter, Identity, Observed, Setup};
use recorder::pilots::Pilot;
use recorder::writer::{Saver, ToRecord, WriterHandle};
use recorder::{Flight, Progress, fly};
use replay::{Options, ReflyOptions, Window};

fn main() {
    divan::main();
}

/// Ticks of the flight that is reflown: a minute.
const TICKS: u64 = 15_000;
/// And of a long one: ten minutes.
const LONG_TICKS: u64 = 150_000;

fn ready() -> (Aircraft, Start) {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).expect("our own file");
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
    let aircraft = aircraft.with_cockpit(map);
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).expect("our own file");
    (aircraft, start)
}

fn scratch(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("tiltrotor-bench-{}-{name}.mcap", std::process::id()))
}

fn setup() -> Setup {
    Setup {
        aircraft_toml: aircraft::XV15.into(),
        cockpit_toml: aircraft::PILOT_MAP.into(),
        scenario_toml: aircraft::DEFAULT_SCENARIO.into(),
    }
}

/// A flight by the hover pilot, as fast as it goes.
fn flown(name: &str, ticks: u64) -> (PathBuf, State) {
    let (aircraft, start) = ready();
    let pilot = Pilot::named("hover", &aircraft.cockpit, &aircraft).expect("it exists");
    let initial = start.on_wheels(&aircraft);
    let out = scratch(name);
    let flight = Flight {
        aircraft,
        start,
        setup: setup(),
        identity: Identity::new(),
        robot_description: String::new(),
        controllers: vec![Box::new(pilot)],
        #[cfg(feature = "sticks")]
        sticks: None,
        out: out.clone(),
        force: true,
        real_time: None,
        situation: None,
        ticks_max: Some(ticks),
        link: None,
        self_check: false,
    };
    fly(flight, &Progress::default()).expect("a flight").log.expect("a whole log");
    (out, initial)
}

/// One tick of the flight model, hovering.
#[divan::bench]
fn one_tick(bencher: Bencher) {
    let (aircraft, start) = ready();
    let mut state = start.on_wheels(&aircraft);
    state.cockpit.collective_norm = 0.75;
    let inputs = Inputs { events: &[], world: World::default() };
    for _ in 0..2_000 {
        state = step(&aircraft, &state, &inputs).0;
    }
    bencher.bench_local(|| step(&aircraft, divan::black_box(&state), &inputs));
}

/// The same in the picture that FlightGear is sent: a hovering XV-15.
fn scene() -> (Aircraft, engine::Outputs) {
    let (aircraft, start) = ready();
    let state = start.on_wheels(&aircraft);
    let outputs = engine::observe(&aircraft, &state, &World::default());
    (aircraft, outputs)
}

/// Both packets of a picture, made.
#[divan::bench]
fn picture_of_a_tick(bencher: Bencher) {
    let (aircraft, outputs) = scene();
    let (world, lamps) = (World::default(), flightgear::Lamps::default());
    bencher.bench_local(|| {
        let outputs = divan::black_box(&outputs);
        Picture::of(&Scene { aircraft: &aircraft, outputs, world: &world, lamps })
    });
}

/// The same made and sent to a FlightGear that listens, all that it costs the loop's thread.
#[divan::bench]
fn picture_sent(bencher: Bencher) {
    let (aircraft, outputs) = scene();
    let (world, lamps) = (World::default(), flightgear::Lamps::default());
    let sockets = (0..100).find_map(|_| {
        let fdm = UdpSocket::bind("127.0.0.1:0").ok()?;
        let next = fdm.local_addr().ok()?.port().checked_add(1)?;
        Some((UdpSocket::bind(("127.0.0.1", next)).ok()?, fdm))
    });
    let (_channel, fdm) = sockets.expect("two ports in a row");
    let place = fdm.local_addr().expect("bound").to_string();
    let mut link = flightgear::Link::new(&[place]).expect("a link");
    bencher.bench_local(|| {
        let outputs = divan::black_box(&outputs);
        link.send(&Picture::of(&Scene { aircraft: &aircraft, outputs, world: &world, lamps }));
    });
}

/// What the loop's thread pays for recording a tick: inputs, state and timing into the ring, while
/// the writer thread empties it. Paced, as in flight: ten ticks, then the writer gets its turn.
#[divan::bench(sample_size = 10)]
fn hand_over_of_a_tick(bencher: Bencher) {
    let (aircraft, start) = ready();
    let state = start.on_wheels(&aircraft);
    let out = scratch("hand-over");
    let identity = Identity::new();
    let file = fs::File::create(&out).expect("a file");
    let writer =
        FlightWriter::create(file, &setup(), &identity, &aircraft, "", &state).expect("a log");
    let told = std::sync::mpsc::channel().1;
    let saver = Saver::beside(&out, &aircraft.name);
    let mut recording = WriterHandle::start(writer, &aircraft, &state, told, saver, None);
    let tick = Cell::new(0);
    bencher.with_inputs(|| recording_has_room(tick.get())).bench_local_values(|()| {
        let tick = tick.replace(tick.get() + 1);
        recording.put(ToRecord::Inputs(InputsRecord { tick, ..InputsRecord::default() }));
        recording.put(ToRecord::State(State { tick: tick + 1, ..state }, Observed::default()));
        recording.put(ToRecord::Timing(TimingRecord { tick, ..TimingRecord::default() }));
    });
    recording.finish(BTreeMap::new()).0.expect("a whole log");
    let _ = fs::remove_file(out);
}

/// Every few hundred ticks the writer needs a moment: it shares two cores with the bench.
fn recording_has_room(tick: u64) {
    if tick.is_multiple_of(500) {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

/// A minute of flight reflown from its log, reading included. Items are ticks: 250 a second is real
/// time.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn verify_a_minute(bencher: Bencher) {
    let (log, _) = flown("verify", TICKS);
    bencher.counter(ItemsCount::new(TICKS)).bench_local(|| {
        replay::verify(&log, &Options::default(), |_| ()).expect("a log").facts.same
    });
    let _ = fs::remove_file(log);
}

/// Compacts a log, with a state every two seconds.
fn compacted(log: &Path, out: &Path) -> Copied {
    let output = Output::beside(out, true, &[log]).expect("a place");
    let made = logs::compact::compact(log, &output, 500, replay::flown, |_| ());
    output.finish().expect("in its place");
    made.expect("a compacted log")
}

/// Ten minutes of flight, and the same compacted: flown once for all that is done with them.
fn ten_minutes() -> &'static (PathBuf, PathBuf) {
    static LOGS: OnceLock<(PathBuf, PathBuf)> = OnceLock::new();
    LOGS.get_or_init(|| {
        let log = flown("long", LONG_TICKS).0;
        let compact = scratch("long-compact");
        let bytes = compacted(&log, &compact).bytes as f64;
        eprintln!("compacted: {:.1} B a tick", bytes / LONG_TICKS as f64);
        (log, compact)
    })
}

/// Ten minutes verified. Items are ticks.
#[divan::bench(sample_count = 2, sample_size = 1, args = ["whole", "compacted"])]
fn verify_ten_minutes(bencher: Bencher, form: &str) {
    let (whole, compact) = ten_minutes();
    let log = if form == "whole" { whole } else { compact };
    bencher.counter(ItemsCount::new(LONG_TICKS)).bench_local(|| {
        replay::verify(log, &Options::default(), |_| ()).expect("a log").facts.same
    });
}

/// Ten minutes compacted.
#[divan::bench(sample_count = 2, sample_size = 1)]
fn compact_ten_minutes(bencher: Bencher) {
    let (whole, _) = ten_minutes();
    let out = scratch("compacted");
    bencher.counter(ItemsCount::new(LONG_TICKS)).bench_local(|| compacted(whole, &out));
    let _ = fs::remove_file(out);
}

/// Ten minutes expanded, and the file compared with the one that was compacted.
#[divan::bench(sample_count = 2, sample_size = 1)]
fn expand_ten_minutes(bencher: Bencher) {
    let (_, compact) = ten_minutes();
    let out = scratch("expanded");
    bencher.counter(ItemsCount::new(LONG_TICKS)).bench_local(|| {
        let output = Output::beside(&out, true, &[]).expect("a file");
        let copied = logs::compact::expand(compact, &output, replay::flown, |_| ());
        assert_eq!(copied.expect("a log").same_file, Some(true));
    });
    let _ = fs::remove_file(out);
}

/// From nothing open to the first tick reflown, nine minutes into a flight of ten.
#[divan::bench(sample_count = 50, sample_size = 1, args = ["whole", "compacted"])]
fn start_in_the_ninth_minute(bencher: Bencher, form: &str) {
    let (whole, compact) = ten_minutes();
    let log = if form == "whole" { whole } else { compact };
    let window = Window { from_tick: Some(135_123), until_tick: None, clamped: false };
    let options = ReflyOptions { window, across_versions: false };
    bencher.bench_local(|| {
        let mut flight = replay::Reflight::open(log, &options).expect("a log");
        assert!(flight.next_tick().expect("a tick").expect("a tick").exact);
    });
}

/// The same by way of a marker that is not there: every event of ten minutes is looked at.
#[divan::bench(sample_count = 20, sample_size = 1)]
fn look_for_a_marker_in_ten_minutes(bencher: Bencher) {
    let (whole, _) = ten_minutes();
    bencher.bench_local(|| logs::marker(whole, 7).is_err());
}

/// Yardstick: copying a megabyte.
#[divan::bench]
fn yardstick_copy_of_a_megabyte(bencher: Bencher) {
    let from = vec![1_u8; 1 << 20];
    let mut to = vec![0_u8; 1 << 20];
    bencher.bench_local(|| divan::black_box(&mut to).copy_from_slice(divan::black_box(&from)));
}

/// Yardstick: a thousand sines.
#[divan::bench]
fn yardstick_thousand_sines(bencher: Bencher) {
    bencher.bench_local(|| {
        (0..1000).map(|i| engine::math::sin(f64::from(divan::black_box(i)) * 0.01)).sum::<f64>()
    });
}
