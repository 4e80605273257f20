//! The writer thread: takes what the loop hands over, and writes it.
//!
//! The loop never waits for it. What does not fit into the ring any more, after some twenty seconds
//! of stalled disk, goes to a list that grows: slower, but nothing is dropped.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use engine::frames::Attitude;
use engine::inputs::{DeviceEvent, World};
use engine::{Aircraft, Outputs, State};
use logs::devices::DeviceIdentity;
use logs::records::{FlightEvent, InputsRecord, RestartRecord, TIMING_FACTS, TimingRecord};
use logs::{Closed, EventDetector, FlightWriter, LogError, Observed};
use rtrb::{Consumer, Producer, PushError, RingBuffer};

use crate::clock::{Awake, now_ns};
use crate::end::End;
use crate::restart::Situation;
use crate::self_check::Mismatch;
use crate::situation;

/// Entries the ring holds: three a tick, twenty seconds and some.
const RING_ENTRIES: usize = 16_384;
/// Outputs the ring for viewers holds.
const VIEW_OUTPUTS: usize = 256;
/// Ticks between two outputs handed over for viewers.
const VIEW_TICKS: u64 = 5;
/// At most this much of a flight is lost when the program is killed, with room for a slow disk.
const FLUSH: Duration = Duration::from_millis(100);
/// How often the thread looks for work.
const NAP: Duration = Duration::from_millis(4);

/// A writer that needs longer than this for one thing was held up: a disk, a pipe, a busy machine. Time
/// in which the whole process stood still does not count.
const HELD_UP: Duration = Duration::from_millis(500);

/// How the writer was held up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Delay {
    /// How often.
    pub times: u64,
    /// The longest.
    pub longest: Duration,
}

/// An entry of the log, as the loop hands it over, in order.
#[derive(Clone, Copy)]
// The state is by far the largest and by far the most frequent.
#[allow(clippy::large_enum_variant)]
pub enum ToRecord {
    /// A device event.
    Event(DeviceEvent),
    /// The world, before the step.
    Inputs(InputsRecord),
    /// The state after the step, and what was seen of it.
    State(State, Observed),
    /// How the tick kept time.
    Timing(TimingRecord),
    /// The phase of the flight changed.
    Phase(u64, u64, &'static str),
    /// Another state takes the place of the last one; the tick's first entry.
    Restart(RestartRecord),
    /// The state before the tick is to be saved with the world of the tick, as a situation.
    Save(State),
    /// The clock was anchored anew before this tick, by so many ns.
    Slip(u64, u64),
    /// The flight ends: tick and reason.
    Landed(u64, End),
}

/// The loop's end of the hand-over.
pub struct WriterHandle {
    ring: Producer<ToRecord>,
    overflow: VecDeque<ToRecord>,
    view: Producer<(Outputs, Attitude)>,
    thread: Option<JoinHandle<(Result<Closed, LogError>, Delay)>>,
    failed: Arc<AtomicBool>,
    done: Arc<AtomicBool>,
    awake: Arc<Awake>,
    /// How the flight kept time, for the end of the log.
    facts: Arc<Mutex<BTreeMap<String, String>>>,
    /// Most entries that ever waited.
    pub backlog_max: usize,
}

impl WriterHandle {
    /// Starts the thread; `mismatches` is what a self-check finds, `devices` are those that come later.
    pub fn start(
        writer: FlightWriter,
        aircraft: &Aircraft,
        initial: &State,
        mismatches: Receiver<Mismatch>,
        saver: Saver,
        devices: Option<Receiver<DeviceIdentity>>,
    ) -> Self {
        let filling = ToRecord::State(*initial, Observed::default());
        let (ring, entries) = touched_ring(RING_ENTRIES, filling);
        let (view, views) = touched_ring(VIEW_OUTPUTS, (Outputs::default(), Attitude::default()));
        let failed = Arc::new(AtomicBool::new(false));
        let done = Arc::new(AtomicBool::new(false));
        let awake = Arc::new(Awake::default());
        awake.beat(now_ns());
        let facts = Arc::default();
        let writer_thread = WriterThread {
            writer: Some(writer),
            entries,
            views,
            detector: EventDetector::new(initial, &aircraft.envelope.airframe),
            mismatches,
            devices,
            saver,
            world: World::default(),
            facts: Arc::clone(&facts),
            held: None,
            tick: initial.tick,
            delay: Delay::default(),
            awake: Arc::clone(&awake),
            seen_ns: awake.ns(),
            failed: Arc::clone(&failed),
            done: Arc::clone(&done),
            error: None,
        };
        let thread = thread::spawn(move || writer_thread.run());
        Self {
            facts,
            ring,
            overflow: VecDeque::new(),
            view,
            thread: Some(thread),
            failed,
            done,
            awake,
            backlog_max: 0,
        }
    }

    /// The loop is awake, and its clock shows this.
    pub fn beat(&self, now_ns: u64) {
        self.awake.beat(now_ns);
    }

    /// Hands an entry over. Never waits, never drops.
    pub fn put(&mut self, entry: ToRecord) {
        while let Some(waiting) = self.overflow.pop_front() {
            if let Err(PushError::Full(waiting)) = self.ring.push(waiting) {
                self.overflow.push_front(waiting);
                break;
            }
        }
        if self.overflow.is_empty() {
            if let Err(PushError::Full(entry)) = self.ring.push(entry) {
                self.overflow.push_back(entry);
            }
        } else {
            self.overflow.push_back(entry);
        }
        let waiting = RING_ENTRIES - self.ring.slots() + self.overflow.len();
        self.backlog_max = self.backlog_max.max(waiting);
    }

    /// Hands outputs over for viewers; these may be dropped.
    pub fn show(&mut self, outputs: &Outputs, attitude: Attitude) {
        if outputs.tick.is_multiple_of(VIEW_TICKS) {
            let _ = self.view.push((*outputs, attitude));
        }
    }

    /// Waits until the writer has caught up to half a ring; for flights that outrun time.
    pub fn wait_for_room(&self) {
        while self.ring.slots() < RING_ENTRIES / 2 || self.view.slots() == 0 {
            if self.has_failed() {
                return;
            }
            self.beat(now_ns());
            thread::sleep(Duration::from_micros(100));
        }
    }

    /// Whether the log could not be written any further.
    pub fn has_failed(&self) -> bool {
        self.failed.load(Ordering::Relaxed)
    }

    /// Ends the log, with how the flight kept time: what became of it or what stopped the writer, and how
    /// it was held up.
    pub fn finish(mut self, timing: BTreeMap<String, String>) -> (Result<Closed, LogError>, Delay) {
        while let Some(waiting) = self.overflow.pop_front() {
            let mut entry = waiting;
            while let Err(PushError::Full(back)) = self.ring.push(entry) {
                entry = back;
                self.beat(now_ns());
                thread::sleep(NAP);
            }
        }
        *self.facts.lock().unwrap_or_else(PoisonError::into_inner) = timing;
        self.done.store(true, Ordering::Release);
        while self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) {
            self.beat(now_ns());
            thread::sleep(NAP);
        }
        let ended = self.thread.take().and_then(|thread| thread.join().ok());
        ended.unwrap_or_else(|| (Err(writer_died()), Delay::default()))
    }
}

/// A ring whose every slot has been written once: the loop meets no page that is not there yet.
fn touched_ring<T: Copy>(capacity: usize, entry: T) -> (Producer<T>, Consumer<T>) {
    let (mut producer, mut consumer) = RingBuffer::new(capacity);
    while producer.push(entry).is_ok() {}
    while consumer.pop().is_ok() {}
    (producer, consumer)
}

/// Saves situations beside the log.
#[derive(Debug)]
pub struct Saver {
    /// The log's path without its ending.
    stem: PathBuf,
    /// Whose situations they are.
    aircraft: String,
    /// How many were saved.
    saved: u64,
}

impl Saver {
    /// Beside that log.
    pub fn beside(log: &Path, aircraft: &str) -> Self {
        Self { stem: log.with_extension(""), aircraft: aircraft.into(), saved: 0 }
    }

    /// Saves a situation in a file that was not there: its number in the flight, and what is told of it.
    fn save(&mut self, situation: &Situation) -> (u64, String) {
        let name = |number: u64| {
            let mut name = self.stem.clone().into_os_string();
            name.push(format!("-situation-{number}.toml"));
            PathBuf::from(name)
        };
        let free = (1..).map(name).find(|path| !path.exists()).unwrap_or_default();
        match situation::save(&free, situation, &self.aircraft) {
            Ok(()) => {
                self.saved += 1;
                let name = free.file_name().unwrap_or(free.as_os_str()).display();
                (self.saved, format!("situation saved as {name}"))
            }
            Err(error) => (0, format!("the situation could not be saved: {error}")),
        }
    }
}

/// What is told when the clock was anchored anew.
pub fn slipped(slip_ns: u64) -> String {
    let slip_s = slip_ns as f64 * 1e-9;
    format!("the clock slipped by {slip_s:.3} s: the process stood still, and so did the flight")
}

fn writer_died() -> LogError {
    LogError::Io(std::io::Error::other("the writer thread died"))
}

/// The thread's end.
struct WriterThread {
    writer: Option<FlightWriter>,
    entries: Consumer<ToRecord>,
    views: Consumer<(Outputs, Attitude)>,
    detector: EventDetector,
    mismatches: Receiver<Mismatch>,
    devices: Option<Receiver<DeviceIdentity>>,
    saver: Saver,
    /// The world of the tick under way.
    world: World,
    /// How the flight kept time, once it is over.
    facts: Arc<Mutex<BTreeMap<String, String>>>,
    /// A state that waits for the timing of its tick, which is of an earlier moment.
    held: Option<(State, Observed)>,
    /// Tick of the last state written.
    tick: u64,
    delay: Delay,
    awake: Arc<Awake>,
    /// When this thread last got somewhere, by the time awake.
    seen_ns: u64,
    failed: Arc<AtomicBool>,
    done: Arc<AtomicBool>,
    error: Option<LogError>,
}

impl WriterThread {
    fn run(mut self) -> (Result<Closed, LogError>, Delay) {
        let mut flushed = Instant::now();
        loop {
            // Looked at before draining: nothing is put after it is set.
            let last_round = self.done.load(Ordering::Acquire);
            self.drain();
            if flushed.elapsed() >= FLUSH {
                let written = self.writer.as_mut().map_or(Ok(()), FlightWriter::flush);
                self.keep(written);
                self.look_at_the_clock();
                flushed = Instant::now();
            }
            if last_round {
                break;
            }
            thread::sleep(NAP);
        }
        let released = self.release();
        self.keep(released);
        let log = match (self.writer, self.error) {
            (Some(mut writer), None) => {
                let facts = self.facts.lock().unwrap_or_else(PoisonError::into_inner);
                writer.facts(TIMING_FACTS, &facts).and_then(|()| writer.finish())
            }
            (_, Some(error)) => Err(error),
            (None, None) => Err(writer_died()),
        };
        (log, self.delay)
    }

    fn drain(&mut self) {
        while let Ok(entry) = self.entries.pop() {
            let written = self.write(&entry);
            self.keep(written);
            self.look_at_the_clock();
        }
        while let Some(Ok(device)) = self.devices.as_ref().map(Receiver::try_recv) {
            let device = DeviceIdentity { tick: self.tick, ..device };
            let written = self.writer.as_mut().map_or(Ok(()), |writer| writer.device(&device));
            self.keep(written);
        }
        while let Ok(mismatch) = self.mismatches.try_recv() {
            let written = self.mismatch(&mismatch);
            self.keep(written);
        }
    }

    /// Notes in the log, and for the landing, when the last thing took too long. Nothing is lost by
    /// it, but whoever wonders about the log finds it there.
    fn look_at_the_clock(&mut self) {
        let now_ns = self.awake.ns();
        let took = Duration::from_nanos(now_ns.saturating_sub(self.seen_ns));
        self.seen_ns = now_ns;
        if took < HELD_UP {
            return;
        }
        self.delay.times += 1;
        self.delay.longest = self.delay.longest.max(took);
        let waiting = self.entries.slots();
        let Some(writer) = self.writer.as_mut() else { return };
        let words = format!(
            "the log's writer was held up for {:.1} s; {waiting} entries waited, none was lost",
            took.as_secs_f64()
        );
        let (what, ms) = (FlightEvent::WriterHeldUp, took.as_millis() as u64);
        let written = writer.flight_event(self.tick, what, ms, [0.0; 2], &words);
        self.keep(written);
    }

    fn mismatch(&mut self, mismatch: &Mismatch) -> Result<(), LogError> {
        let Some(writer) = self.writer.as_mut() else { return Ok(()) };
        let Mismatch { tick, fields, path } = mismatch;
        let words = format!(
            "self-check: tick {tick}, reflown in flight, was not the same: {fields} numbers of the \
             state, first {path}"
        );
        writer.flight_event(*tick, FlightEvent::SelfCheck, *fields, [0.0; 2], &words)
    }

    /// Writes an entry; log times never go back, so the state of a tick waits for the tick's timing.
    fn write(&mut self, entry: &ToRecord) -> Result<(), LogError> {
        if !matches!(entry, ToRecord::Timing(_)) {
            self.release()?;
        }
        let Some(writer) = self.writer.as_mut() else { return Ok(()) };
        match entry {
            ToRecord::Event(event) => {
                writer.event(event)?;
                self.detector.event(writer, event)
            }
            ToRecord::Restart(restart) => {
                writer.restart(restart)?;
                self.detector.restart(writer, restart)
            }
            ToRecord::Save(state) => {
                let situation = Situation { state: *state, world: self.world };
                let (number, words) = self.saver.save(&situation);
                let what = FlightEvent::SituationSaved;
                writer.flight_event(state.tick, what, number, [0.0; 2], &words)
            }
            ToRecord::Inputs(inputs) => {
                self.world = inputs.world;
                writer.inputs(inputs)?;
                self.detector.inputs(writer, inputs)
            }
            ToRecord::State(state, seen) => {
                self.held = Some((*state, *seen));
                Ok(())
            }
            ToRecord::Timing(timing) => {
                writer.timing(timing)?;
                self.release()
            }
            ToRecord::Phase(tick, number, name) => {
                writer.flight_event(*tick, FlightEvent::Phase, *number, [0.0; 2], name)
            }
            ToRecord::Slip(tick, slip_ns) => {
                let words = slipped(*slip_ns);
                let ms = slip_ns / 1_000_000;
                writer.flight_event(*tick, FlightEvent::Slip, ms, [0.0; 2], &words)
            }
            ToRecord::Landed(tick, end) => {
                if let End::GaveUp(gave_up) = end {
                    let (number, words) = (gave_up.number, gave_up.to_string());
                    writer.flight_event(*tick, FlightEvent::GaveUp, number, [0.0; 2], &words)?;
                }
                let words = end.to_string();
                writer.flight_event(*tick, FlightEvent::Landed, end.number(), [0.0; 2], &words)
            }
        }
    }

    /// Writes the state that waits, what can be told of it, and what viewers draw up to it.
    fn release(&mut self) -> Result<(), LogError> {
        let Some(writer) = self.writer.as_mut() else { return Ok(()) };
        if let Some((state, seen)) = self.held.take() {
            self.tick = state.tick;
            writer.state(&state)?;
            self.detector.state(writer, &state, &seen)?;
        }
        while self.views.peek().is_ok_and(|(outputs, _)| outputs.tick <= self.tick) {
            if let Ok((outputs, attitude)) = self.views.pop() {
                writer.view(&outputs, attitude)?;
            }
        }
        Ok(())
    }

    /// After an error the flight goes on; what comes is taken and let go.
    fn keep(&mut self, written: Result<(), LogError>) {
        if let Err(error) = written {
            self.failed.store(true, Ordering::Relaxed);
            self.error.get_or_insert(error);
            // Dropped without an index: what was flushed stays readable.
            self.writer = None;
        }
    }
}
