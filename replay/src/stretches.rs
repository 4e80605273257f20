//! A log in stretches: each is flown from the recorded state before it, on any processor.
//!
//! A stretch that leads from a recorded state to the next ones, to the bit, proves what one pass proves:
//! by induction every recorded state follows from the first one. One thread reads, from the beginning
//! to the end, so that every checksum and digest is looked at in its order; it flies, too, when the
//! others have enough to do. From the first difference on nothing of this is of use: then the log is
//! flown in one pass, whose report is the one there is.

use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, Sender, SyncSender, TrySendError, channel, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

use engine::{Aircraft, Inputs, Outputs, State, step, step_state};
use logs::{FlightReader, LogError, Tick, cdr};

use crate::judgement::{Facts, disorder};
use crate::outputs::{OutputsCheck, are_todays};
use crate::refly::{Reflight, ReplayError, Window};

/// Ticks in a stretch: few enough that what was read is still in the processor's cache when it is flown.
const TICKS: usize = 64;
/// Stretches that wait for each thread that flies.
const WAITING: usize = 2;
/// Stretches that may be done before the one whose turn it is.
const AHEAD: usize = 64;

/// What became of it.
pub(crate) enum Passed {
    /// Every tick that could be read is the recorded one.
    Same(Box<Facts>),
    /// So many ticks are; the next one is not.
    Differs(u64),
}

/// Some ticks of a flight.
#[derive(Default)]
struct Stretch {
    number: u64,
    /// The recorded state before them.
    from: State,
    /// As recorded; there is room for more.
    ticks: Vec<Tick>,
    length: usize,
    /// Recorded outputs, each with the place of the tick with which they were read.
    recorded: Vec<(usize, Outputs)>,
    /// Outputs that were computed where some may be recorded, each with the place of its tick.
    computed: Vec<(usize, Outputs)>,
    /// The place of the first tick that was not flown as recorded.
    differs: Option<usize>,
    /// The state as a message.
    message: Vec<u8>,
}

impl Stretch {
    /// Takes the tick that was read last, and leaves the room of an older one for the next.
    fn take(&mut self, reader: &mut FlightReader) {
        if self.ticks.len() == self.length {
            self.ticks.push(Tick::default());
        }
        std::mem::swap(&mut self.ticks[self.length], &mut reader.tick);
        let outputs = reader.outputs.drain(..);
        self.recorded.extend(outputs.map(|outputs| (self.length, outputs)));
        self.length += 1;
    }

    /// The recorded state after it; that before it where it has no ticks.
    fn to(&self) -> Result<State, LogError> {
        match self.ticks[..self.length].last() {
            Some(tick) => cdr::decode(&tick.state_message),
            None => Ok(self.from),
        }
    }

    /// Flies it up to the first tick that is not the recorded one.
    fn fly(&mut self, aircraft: &Aircraft, outputs_ticks: u64) -> Result<(), LogError> {
        let mut state = self.from;
        for (place, tick) in self.ticks[..self.length].iter().enumerate() {
            let inputs = Inputs { events: &tick.events, world: tick.inputs.world };
            let mut seen = None;
            if let Some(restart) = &tick.restart {
                state = restart.state;
            }
            if state.tick.wrapping_add(1).is_multiple_of(outputs_ticks) {
                let (next, outputs) = step(aircraft, &state, &inputs);
                (state, seen) = (next, Some((place, outputs)));
            } else {
                step_state(aircraft, &mut state, &inputs);
            }
            self.message.clear();
            cdr::append(&mut self.message, &state)?;
            if self.message != tick.state_message {
                self.differs = Some(place);
                break;
            }
            self.computed.extend(seen);
        }
        Ok(())
    }

    /// Its room, for another one.
    fn emptied(mut self: Box<Self>) -> Box<Self> {
        (self.length, self.differs) = (0, None);
        self.recorded.clear();
        self.computed.clear();
        self
    }
}

/// A stretch that was flown, or why it was not.
type Done = Result<Box<Stretch>, LogError>;

/// Reads a log from where it was opened, and flies every tick on so many threads. The check of the
/// flight's outputs knows afterwards what there was up to the end or the first difference.
///
/// # Errors
/// When the log cannot be read.
pub(crate) fn fly(
    flight: &mut Reflight,
    threads: usize,
    window: &Window,
    progress: &mut dyn FnMut(u64) -> Result<(), ReplayError>,
) -> Result<Passed, ReplayError> {
    let facts = Box::new(Facts::of_reflight(flight));
    let outputs_ticks = flight.outputs_check.every_ticks;
    let others = threads.saturating_sub(1);
    let (to_fly, waiting) = sync_channel(WAITING * others);
    let (back, done) = channel();
    let waiting = Mutex::new(waiting);
    let (from, Reflight { reader, aircraft, outputs_check, .. }) = (flight.state, &mut *flight);
    reader.states_as_bytes = true;
    let aircraft = &*aircraft;
    let reading = Reading {
        reader,
        aircraft,
        outputs_ticks,
        to_fly,
        done,
        early: BTreeMap::new(),
        free: Vec::new(),
        handed_out: 0,
        turn: 0,
        check: outputs_check,
        pending: Vec::new(),
        proven: 0,
        facts,
    };
    let (stopped, proven, mut facts) = thread::scope(|scope| {
        // What ends here, by a panic too, lets go of the channel: who waits for more goes home.
        let mut reading = reading;
        let mut controllers = 0;
        for _ in 0..others {
            let (waiting, back) = (&waiting, back.clone());
            let work = move || work(aircraft, outputs_ticks, waiting, &back);
            // A system that has no more threads: those that there are fly it.
            if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
            controllers += 1;
        }
        drop(back);
        if controllers == 0 {
            // Nobody takes anything from the channel: who reads flies.
            reading.to_fly = sync_channel(0).0;
        }
        let stopped = reading.run(from, progress)?;
        let Reading { proven, facts, .. } = reading;
        Ok::<_, ReplayError>((stopped, proven, facts))
    })?;
    let Some(stopped) = stopped else { return Ok(Passed::Differs(proven)) };
    facts.end_of_reflight(flight, stopped, window);
    Ok(Passed::Same(facts))
}

/// Flies what comes, until nothing comes any more.
fn work(
    aircraft: &Aircraft,
    outputs_ticks: u64,
    waiting: &Mutex<Receiver<Box<Stretch>>>,
    back: &Sender<Done>,
) {
    loop {
        let next = waiting.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(mut stretch) = next else { break };
        let flown = stretch.fly(aircraft, outputs_ticks).map(|()| stretch);
        if back.send(flown).is_err() {
            break;
        }
    }
}

/// What the thread knows that reads.
struct Reading<'a> {
    reader: &'a mut FlightReader,
    aircraft: &'a Aircraft,
    outputs_ticks: u64,
    to_fly: SyncSender<Box<Stretch>>,
    done: Receiver<Done>,
    /// Flown before their turn.
    early: BTreeMap<u64, Box<Stretch>>,
    #[expect(clippy::vec_box, reason = "they go from thread to thread as they are")]
    free: Vec<Box<Stretch>>,
    /// Stretches so far, and the one whose turn it is.
    handed_out: u64,
    turn: u64,
    check: &'a mut OutputsCheck,
    /// Recorded outputs whose tick has not come.
    pending: Vec<Outputs>,
    /// Ticks that are the recorded ones.
    proven: u64,
    facts: Box<Facts>,
}

impl Reading<'_> {
    /// Reads and flies to the end: what stopped the reading there, if anything did. `None` at the first
    /// difference.
    fn run(
        &mut self,
        mut from: State,
        progress: &mut dyn FnMut(u64) -> Result<(), ReplayError>,
    ) -> Result<Option<Option<String>>, ReplayError> {
        let mut stopped = None;
        while stopped.is_none() {
            let mut stretch = self.free.pop().unwrap_or_default();
            (stretch.number, stretch.from) = (self.handed_out, from);
            while stopped.is_none() && stretch.length < TICKS {
                stopped = self.read(&mut stretch)?;
            }
            from = stretch.to()?;
            self.handed_out += 1;
            self.hand_out(stretch)?;
            progress(self.facts.ticks)?;
            if !self.settle(self.handed_out.saturating_sub(AHEAD as u64))? {
                return Ok(None);
            }
        }
        if !self.settle(self.handed_out)? {
            return Ok(None);
        }
        self.pending.append(&mut self.reader.outputs);
        if are_todays(self.reader) {
            self.check.recorded(&self.pending)?;
        }
        Ok(stopped)
    }

    /// Reads a tick; at the end, what stopped the reading, if anything did.
    fn read(&mut self, stretch: &mut Stretch) -> Result<Option<Option<String>>, ReplayError> {
        match self.reader.next_tick() {
            Ok(Some(tick)) => {
                // To be taken back if it is not: then all of it is.
                self.facts.add(tick, Some(true));
                stretch.take(self.reader);
                self.reader.forget();
                Ok(None)
            }
            Ok(None) => Ok(Some(None)),
            Err(error) => disorder(error.into()).map(|what| Some(Some(what))),
        }
    }

    /// Gives a stretch to another thread; if they have enough to do, flies it.
    fn hand_out(&mut self, stretch: Box<Stretch>) -> Result<(), LogError> {
        if let Err(TrySendError::Full(mut stretch) | TrySendError::Disconnected(mut stretch)) =
            self.to_fly.try_send(stretch)
        {
            stretch.fly(self.aircraft, self.outputs_ticks)?;
            self.early.insert(stretch.number, stretch);
        }
        Ok(())
    }

    /// Takes the stretches whose turn it is, and waits for those before `until`. `false` when there is a
    /// difference.
    fn settle(&mut self, until: u64) -> Result<bool, LogError> {
        loop {
            while let Some(stretch) = self.early.remove(&self.turn) {
                self.turn += 1;
                if !self.take(&stretch)? {
                    return Ok(false);
                }
                self.free.push(stretch.emptied());
            }
            let next =
                if self.turn < until { self.done.recv().ok() } else { self.done.try_recv().ok() };
            let Some(done) = next else { return Ok(true) };
            let stretch = done?;
            self.early.insert(stretch.number, stretch);
        }
    }

    /// Takes what a stretch has shown, tick by tick, as one pass would have found it.
    fn take(&mut self, stretch: &Stretch) -> Result<bool, LogError> {
        let same = stretch.differs.unwrap_or(stretch.length);
        self.proven += same as u64;
        let (mut computed, mut recorded) = (stretch.computed.iter(), stretch.recorded.iter());
        let todays = are_todays(self.reader);
        let (mut computed_next, mut recorded_next) = (computed.next(), recorded.next());
        for (place, tick) in stretch.ticks[..same].iter().enumerate() {
            while let Some((_, outputs)) = recorded_next.filter(|(at, _)| *at == place) {
                self.pending.push(*outputs);
                recorded_next = recorded.next();
            }
            if let Some((_, outputs)) = computed_next.filter(|(at, _)| *at == place) {
                self.check.computed(outputs);
                computed_next = computed.next();
            }
            if self.pending.is_empty() {
                continue;
            }
            if todays {
                self.check.recorded(&self.pending)?;
            }
            self.pending.retain(|outputs| outputs.tick > tick.record.state.tick);
        }
        Ok(stretch.differs.is_none())
    }
}
