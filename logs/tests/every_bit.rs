//! Every bit of a small log, flipped one at a time, and the log cut at every byte: found, each of them,
//! by the reader alone, before anything is reflown.
//!
//! `TILTROTOR_EVERY_BIT_STRIDE=7` looks at every seventh bit only, and `TILTROTOR_EVERY_BIT_LOG=FILE`
//! flips the bits of another log, a real one (`tests/integrity.sh`).

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;

use engine::inputs::{DeviceEvent, EventKind};
use engine::{Inputs, Outputs, State, step};
use logs::devices::DeviceIdentity;
use logs::records::{FlightEvent, InputsRecord, TimingRecord};
use logs::{Ending, FlightReader, FlightWriter, Identity, LogError, Setup};

/// Resident memory that reading may take beyond what the process had before.
const MEMORY_KIB_MAX: usize = 64 * 1024;
/// Memory is the process's: one of these at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// Ticks in the log.
const TICKS: u64 = 3;

/// What a reader made of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Seen {
    /// Refused at the door, and why.
    Refused(String),
    /// The files or the first state are not what the flight was flown with.
    NotIntact,
    /// Messages that do not make a flight.
    Disorder(String),
    /// The digest breaks.
    Altered,
    /// All that can be read is as recorded: so many ticks, and how the file ends.
    Exact(u64, Ending),
}

fn read(bytes: Vec<u8>) -> Seen {
    read_all(bytes).0
}

/// The verdict, and everything that was read as one text.
fn read_all(bytes: Vec<u8>) -> (Seen, String) {
    let mut contents = String::new();
    (judged(bytes, &mut contents), contents)
}

fn judged(bytes: Vec<u8>, contents: &mut String) -> Seen {
    let mut reader = match FlightReader::read(Cursor::new(bytes)) {
        Ok(reader) => reader,
        Err(error) => return Seen::Refused(error.to_string()),
    };
    if !reader.intact {
        return Seen::NotIntact;
    }
    let mut ticks = 0;
    loop {
        match reader.next_tick() {
            // The digest stands for all of the tick.
            Ok(Some(tick)) if tick.chained => {
                ticks += 1;
                contents.push_str(&tick.record.digest.to_string());
            }
            Ok(Some(_)) => return Seen::Altered,
            Ok(None) => break,
            Err(error @ (LogError::Order(_) | LogError::Decode(_))) => {
                return Seen::Disorder(error.to_string());
            }
            Err(error) => return Seen::Refused(error.to_string()),
        }
    }
    let ending = reader.ending().cloned().expect("an end");
    if ticks == TICKS && ending == Ending::Truncated {
        *contents += &format!(
            "{:?} {:?} {:?} {:?} {:?} {:?}",
            reader.setup,
            reader.identity,
            reader.timings,
            reader.events,
            reader.log_lines,
            reader.devices
        );
    }
    Seen::Exact(ticks, ending)
}

fn file(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("every-bit");
    fs::create_dir_all(&folder).expect("a folder");
    folder.join(name)
}

/// A few ticks with something on every channel; returns the bytes, and how many of them were there
/// before the log was closed.
fn small_log(name: &str) -> (Vec<u8>, usize) {
    let path = file(name);
    let _ = fs::remove_file(&path);
    let setup = Setup {
        aircraft_toml: "name = \"small\"\n".into(),
        cockpit_toml: "[[device]]\n".into(),
        scenario_toml: "heading_deg = 90.0\n".into(),
    };
    let identity = Identity::new().with("commit", "0123456789").with("dirty", "no");
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    let mut state = State::default();
    let new = fs::File::create_new(&path).expect("a file");
    let mut writer =
        FlightWriter::create(new, &setup, &identity, &aircraft, "<robot/>", &state).expect("a log");
    let stick = DeviceIdentity { vendor: 0x44f, name: "a stick".into(), ..Default::default() };
    writer.device(&stick).expect("written");
    for tick in 0..TICKS {
        let event = DeviceEvent {
            tick,
            kernel_time_ns: 12_345,
            device: 0,
            kind: EventKind::Axis as u64,
            code: 1,
            value: 77,
            raw_min: -100,
            raw_max: 100,
        };
        writer.event(&event).expect("written");
        writer.inputs(&InputsRecord { tick, events: 1, ..Default::default() }).expect("written");
        let inputs = Inputs { events: &[event], world: Default::default() };
        state = State { tick: tick + 1, ..step(&aircraft, &state, &inputs).0 };
        writer.state(&state).expect("written");
        writer
            .timing(&TimingRecord { tick, step_ns: 9_000, ..Default::default() })
            .expect("written");
        writer.flight_event(tick, FlightEvent::Marker, 1, [0.0; 2], "marker 1").expect("written");
        let outputs = Outputs { tick: 50 * tick, ..Default::default() };
        writer.view(&outputs, state.plant.attitude).expect("written");
        writer.flush().expect("written");
    }
    let before_closing = fs::metadata(&path).expect("a file").len() as usize;
    writer.finish().expect("an end");
    let bytes = fs::read(&path).expect("a log");
    assert_eq!(read(bytes.clone()), Seen::Exact(TICKS, Ending::Closed));
    (bytes, before_closing)
}

/// Peak of the process's resident memory, KiB.
fn peak_kib() -> usize {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches("kB").trim().parse().ok()).unwrap_or(0)
}

fn stride() -> usize {
    let stride = std::env::var("TILTROTOR_EVERY_BIT_STRIDE").ok();
    stride.and_then(|stride| stride.parse().ok()).unwrap_or(1).max(1)
}

/// Hands the log over with each of its bits flipped, and fails with all that `judge` finds wrong.
fn every_bit(log: &[u8], judge: impl Fn(usize, Vec<u8>) -> Option<String> + Sync) {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let before_kib = peak_kib();
    let next = AtomicUsize::new(0);
    let wrong = Mutex::new(Vec::new());
    let log: Arc<[u8]> = log.into();
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                let mut flipped = log.to_vec();
                loop {
                    let bit = stride() * next.fetch_add(1, Ordering::Relaxed);
                    if bit >= 8 * log.len() {
                        return;
                    }
                    flipped[bit / 8] ^= 1 << (bit % 8);
                    let wrong_now = judge(bit / 8, flipped.clone());
                    flipped[bit / 8] ^= 1 << (bit % 8);
                    if let Some(what) = wrong_now {
                        let what = format!("bit {} of byte {}: {what}", bit % 8, bit / 8);
                        wrong.lock().expect("the list").push(what);
                    }
                    if bit.is_multiple_of(1024) {
                        let more_kib = peak_kib().saturating_sub(before_kib);
                        assert!(more_kib < MEMORY_KIB_MAX, "{more_kib} KiB, near bit {bit}");
                    }
                }
            });
        }
    });
    println!("{} bits, at most {} KiB more", 8 * log.len(), peak_kib().saturating_sub(before_kib));
    let wrong = wrong.into_inner().expect("the list");
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

/// Whether the verdict is not "this log is whole", and says something.
fn found(seen: &Seen) -> bool {
    match seen {
        Seen::Refused(why) | Seen::Disorder(why) => !why.is_empty(),
        Seen::NotIntact | Seen::Altered => true,
        Seen::Exact(_, Ending::Damaged(why)) => !why.is_empty(),
        Seen::Exact(..) => false,
    }
}

#[test]
fn every_flipped_bit_of_a_closed_log_is_found() {
    let log = match std::env::var_os("TILTROTOR_EVERY_BIT_LOG") {
        Some(log) => fs::read(log).expect("a log"),
        None => small_log("closed.mcap").0,
    };
    let verdicts = Mutex::new(BTreeMap::<String, usize>::new());
    every_bit(&log, |_, bytes| {
        let seen = read(bytes);
        // Without the numbers at its end: a verdict a bit would take more memory than all the logs.
        let what: String = format!("{seen:?}").chars().take(90).collect();
        *verdicts.lock().expect("the list").entry(what).or_default() += 1;
        (!found(&seen)).then(|| format!("{seen:?}"))
    });
    let verdicts = verdicts.into_inner().expect("the list");
    let mut common: Vec<_> = verdicts.into_iter().collect();
    common.sort_by_key(|(_, bits)| std::cmp::Reverse(*bits));
    for (verdict, bits) in common.iter().take(12) {
        println!("{bits:>7} bits: {verdict}");
    }
}

#[test]
fn of_a_log_that_was_never_closed_every_flipped_bit_of_the_flight_is_found() {
    let (log, before_closing) = small_log("killed.mcap");
    let log = &log[..before_closing];
    let (seen, whole) = read_all(log.to_vec());
    assert_eq!(seen, Seen::Exact(TICKS, Ending::Truncated));
    let unnoticed = AtomicUsize::new(0);
    every_bit(log, |_, bytes| {
        let (seen, contents) = read_all(bytes);
        let honest = match &seen {
            // Fewer ticks are fewer ticks: what is said to be exact is exact.
            Seen::Exact(ticks, Ending::Truncated) if *ticks < TICKS => true,
            // In the header, the frame of a chunk, its index, or another way to compress the same bytes:
            // nothing that is read is different.
            Seen::Exact(_, Ending::Truncated) => {
                unnoticed.fetch_add(1, Ordering::Relaxed);
                contents == whole
            }
            seen => found(seen),
        };
        (!honest).then(|| format!("{seen:?}"))
    });
    println!("{} bits change nothing that is read", unnoticed.into_inner());
}

#[test]
fn a_log_cut_at_any_byte_is_exact_up_to_there_or_refused() {
    let (log, before_closing) = small_log("cut.mcap");
    let mut ticks_before = 0;
    for cut in (0..log.len()).step_by(stride()) {
        match read(log[..cut].to_vec()) {
            Seen::Exact(ticks, Ending::Truncated) => {
                assert!(
                    ticks >= ticks_before,
                    "cut at {cut}: {ticks} ticks, {ticks_before} before"
                );
                ticks_before = ticks;
            }
            Seen::Refused(why) => assert!(ticks_before == 0 && !why.is_empty(), "cut at {cut}"),
            seen => panic!("cut at byte {cut} of {}: {seen:?}", log.len()),
        }
        assert!(cut < before_closing || ticks_before == TICKS, "cut at {cut}");
    }
}

#[test]
fn bytes_doubled_dropped_or_swapped_anywhere_are_found() {
    let (log, _) = small_log("spliced.mcap");
    let mut numbers = Numbers(7);
    for round in 0..4000 {
        let mut bytes = log.clone();
        let (a, b) = (numbers.below(log.len()), numbers.below(log.len()));
        let (from, to) = (a.min(b), a.max(b).min(a.min(b) + 1 + numbers.below(4096)));
        let piece = log[from..to].to_vec();
        match round % 4 {
            0 => drop(bytes.drain(from..to)),
            1 => drop(bytes.splice(to..to, piece)),
            2 => bytes[from..to].reverse(),
            _ => bytes[from..to].fill(numbers.below(256) as u8),
        }
        if bytes == log {
            continue;
        }
        let seen = read(bytes);
        // Without its end it may look as if it was cut: that is true enough.
        let honest = found(&seen) || matches!(seen, Seen::Exact(_, Ending::Truncated));
        assert!(honest, "round {round}, bytes {from} to {to}: {seen:?}");
    }
}

/// splitmix64.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }
}
