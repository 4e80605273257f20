//! The flight checks itself: a spare thread reflies each second from the state at its beginning and
//! compares every bit.
//!
//! What it finds is not a matter of the model but of the machine or of this program: memory that does
//! not hold, a step that does not give the same twice. The loop hands over a tick if there is room for
//! all of it, and goes on; what there was no room for is counted and not checked.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::Sender;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use engine::inputs::{DeviceEvent, World};
use engine::{Aircraft, Inputs, State, step};
use logs::cdr;
use logs::fields::fields;
use rtrb::{Consumer, Producer, RingBuffer};

use crate::statistics::Durations;

/// Ticks reflown at a time: a second.
const TICKS: usize = 250;
/// Events and ticks the ring holds: five seconds and some, with three events a tick.
const RING_SIZE: usize = 4096;
/// How often the thread looks for work.
const NAP: Duration = Duration::from_millis(20);
/// Mismatches told one by one; a broken machine need not fill the log.
const TOLD_MAX: u64 = 100;

/// What the loop hands over.
#[derive(Clone, Copy)]
// A tick is by far the most frequent.
#[allow(clippy::large_enum_variant)]
enum ToRefly {
    /// What the tick begins with in place of the state before it.
    Restart(State),
    Event(DeviceEvent),
    Tick(World, State),
}

/// The reflown state was not the flown one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The first tick at which it was not.
    pub tick: u64,
    /// Fields of the state that differ there.
    pub fields: u64,
    /// The first of them, in the order of the state.
    pub path: String,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Ticks reflown and compared.
    pub ticks: u64,
    /// Seconds of flight in which something differed.
    pub mismatches: u64,
    /// Ticks that were not handed over, for want of room.
    pub dropped: u64,
    /// Time the spare thread was busy.
    pub busy: Duration,
    /// What handing over cost the loop.
    pub hand_over: Durations,
}

/// The loop's end.
pub struct SelfCheck {
    ring: Producer<ToRefly>,
    dropped: u64,
    hand_over: Durations,
    thread: JoinHandle<Checker>,
    found: Arc<AtomicU64>,
    done: Arc<AtomicBool>,
}

impl SelfCheck {
    /// Starts the thread. Mismatches go to `tell`; `found` counts them.
    pub fn start(
        aircraft: &Aircraft,
        initial: &State,
        tell: Sender<Mismatch>,
        found: Arc<AtomicU64>,
    ) -> Self {
        let (mut ring, mut taken) = RingBuffer::new(RING_SIZE);
        // Every page is there before the loop meets it.
        while ring.push(ToRefly::Tick(World::default(), *initial)).is_ok() {}
        while taken.pop().is_ok() {}
        let done = Arc::new(AtomicBool::new(false));
        let checker = Checker {
            aircraft: Box::new(aircraft.clone()),
            ring: taken,
            second: Second::from(initial),
            tell,
            found: Arc::clone(&found),
            ticks: 0,
            busy: Duration::ZERO,
        };
        let last = Arc::clone(&done);
        let thread = thread::spawn(move || checker.run(&last));
        Self { ring, dropped: 0, hand_over: Durations::new(), thread, found, done }
    }

    /// Hands a tick over, all of it or nothing. Never waits.
    pub fn put(
        &mut self,
        restart: Option<&State>,
        events: &[DeviceEvent],
        world: World,
        state: &State,
    ) {
        let started = Instant::now();
        if self.ring.slots() > events.len() + 1 {
            if let Some(restart) = restart {
                let _ = self.ring.push(ToRefly::Restart(*restart));
            }
            for event in events {
                let _ = self.ring.push(ToRefly::Event(*event));
            }
            let _ = self.ring.push(ToRefly::Tick(world, *state));
        } else {
            self.dropped += 1;
        }
        self.hand_over.add(started.elapsed().as_nanos() as u64);
    }

    /// Waits until half the ring is free; for flights that outrun time.
    pub fn wait_for_room(&self) {
        while self.ring.slots() < RING_SIZE / 2 && !self.thread.is_finished() {
            thread::sleep(Duration::from_micros(100));
        }
    }

    /// Checks what is left. When the thread has died, nothing counts as checked.
    pub fn finish(self) -> Checked {
        self.done.store(true, Ordering::Release);
        let (ticks, busy) = match self.thread.join() {
            Ok(checker) => (checker.ticks, checker.busy),
            Err(_) => (0, Duration::ZERO),
        };
        Checked {
            ticks,
            mismatches: self.found.load(Ordering::Relaxed),
            dropped: self.dropped,
            busy,
            hand_over: self.hand_over,
        }
    }
}

/// A second of flight, or the part of it that has come in.
struct Second {
    /// The state at its beginning.
    keyframe: State,
    /// Events of all its ticks.
    events: Vec<DeviceEvent>,
    /// How many of them belong to the ticks up to this one, its world, and the state after it.
    ticks: Vec<(usize, World, State)>,
}

impl Second {
    fn from(keyframe: &State) -> Self {
        Self { keyframe: *keyframe, events: Vec::new(), ticks: Vec::with_capacity(TICKS) }
    }

    /// The state after the last tick that came in.
    fn last(&self) -> &State {
        self.ticks.last().map_or(&self.keyframe, |(_, _, state)| state)
    }

    /// Begins again, from a state as it was flown.
    fn restart(&mut self, keyframe: State) {
        self.keyframe = keyframe;
        self.events.clear();
        self.ticks.clear();
    }

    /// Reflies it.
    fn mismatch(&self, aircraft: &Aircraft) -> Option<Mismatch> {
        let mut state = self.keyframe;
        let mut from = 0;
        for (to, world, flown) in &self.ticks {
            let inputs = Inputs { events: &self.events[from..*to], world: *world };
            state = step(aircraft, &state, &inputs).0;
            from = *to;
            // Bits, not numbers.
            if cdr::encode(&state).ok() != cdr::encode(flown).ok() {
                return Some(difference(&state, flown));
            }
        }
        None
    }
}

fn difference(reflown: &State, flown: &State) -> Mismatch {
    let tick = flown.tick;
    let (Ok(reflown), Ok(flown)) = (fields(reflown), fields(flown)) else {
        return Mismatch { tick, fields: 0, path: "not told".into() };
    };
    let pairs = reflown.iter().zip(&flown);
    let mut differing = pairs.filter(|(a, b)| a.value.bits() != b.value.bits());
    let path = differing.next().map_or_else(String::new, |(_, field)| field.path.clone());
    Mismatch { tick, fields: 1 + differing.count() as u64, path }
}

/// The thread's end.
struct Checker {
    aircraft: Box<Aircraft>,
    ring: Consumer<ToRefly>,
    second: Second,
    tell: Sender<Mismatch>,
    found: Arc<AtomicU64>,
    ticks: u64,
    busy: Duration,
}

impl Checker {
    fn run(mut self, done: &AtomicBool) -> Self {
        loop {
            // Looked at before draining: nothing is put after it is set.
            let last_round = done.load(Ordering::Acquire);
            while let Ok(handed) = self.ring.pop() {
                self.take(handed);
            }
            if last_round {
                self.check();
                return self;
            }
            thread::sleep(NAP);
        }
    }

    fn take(&mut self, handed: ToRefly) {
        match handed {
            // What is there so far is checked, and the next second begins with it.
            ToRefly::Restart(state) => {
                self.check();
                self.second.restart(state);
            }
            ToRefly::Event(event) => self.second.events.push(event),
            // A tick was dropped before this one: what is there so far is checked, and the next
            // second begins after the gap.
            ToRefly::Tick(_, state) if state.tick != self.second.last().tick.wrapping_add(1) => {
                let before = self.second.ticks.last().map_or(0, |(to, ..)| *to);
                self.second.events.truncate(before);
                self.check();
                self.second.restart(state);
            }
            ToRefly::Tick(world, state) => {
                self.second.ticks.push((self.second.events.len(), world, state));
                if self.second.ticks.len() == TICKS {
                    self.check();
                }
            }
        }
    }

    fn check(&mut self) {
        let started = Instant::now();
        if let Some(mismatch) = self.second.mismatch(&self.aircraft)
            && self.found.fetch_add(1, Ordering::Relaxed) < TOLD_MAX
        {
            // Without a writer nobody listens: the crew is told all the same.
            let _ = self.tell.send(mismatch);
        }
        self.ticks += self.second.ticks.len() as u64;
        // Goes on from what was flown: one fault is told once.
        let last = *self.second.last();
        self.second.restart(last);
        self.busy += started.elapsed();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    /// Flies `ticks` ticks on the ground, hands over those that `keep` says, as `change` made them.
    fn checked(
        ticks: u64,
        keep: impl Fn(u64) -> bool,
        change: impl Fn(&mut State),
    ) -> (Checked, Vec<Mismatch>) {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
        let mut state = start.on_wheels(&aircraft);
        let (tell, told) = mpsc::channel();
        let mut check = SelfCheck::start(&aircraft, &state, tell, Arc::default());
        for tick in 0..ticks {
            let inputs = Inputs { events: &[], world: start.world.world() };
            state = step(&aircraft, &state, &inputs).0;
            change(&mut state);
            check.wait_for_room();
            if keep(tick) {
                check.put(None, inputs.events, inputs.world, &state);
            }
        }
        (check.finish(), told.try_iter().collect())
    }

    #[test]
    fn a_flight_that_is_the_same_twice_is_not_mentioned() {
        let (checked, told) = checked(600, |_| true, |_| {});
        assert_eq!((checked.ticks, checked.mismatches, checked.dropped), (600, 0, 0));
        assert!(told.is_empty(), "{told:?}");
    }

    #[test]
    fn one_bit_of_the_state_that_falls_over_in_flight_is_told_once_with_its_tick_and_name() {
        let flip = |state: &mut State| {
            if state.tick == 400 {
                state.plant.fuel_kg = f64::from_bits(state.plant.fuel_kg.to_bits() ^ 1);
            }
        };
        let (checked, told) = checked(600, |_| true, flip);
        assert_eq!((checked.ticks, checked.mismatches), (600, 1));
        let expected = Mismatch { tick: 400, fields: 1, path: "plant.fuel_kg".into() };
        assert_eq!(told, [expected]);
    }

    #[test]
    fn a_tick_that_was_not_handed_over_is_a_gap_and_no_mismatch() {
        let (checked, told) = checked(600, |tick| tick != 300, |_| {});
        // The one that is missing, and the one after it, which nothing leads up to.
        assert_eq!((checked.ticks, checked.mismatches), (598, 0));
        assert!(told.is_empty(), "{told:?}");
    }
}
