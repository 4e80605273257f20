//! The loop: wait, sample, record, step, publish, account, once a tick.
//!
//! It runs on the thread that flies, asks for no memory once it has begun, and waits for nothing but
//! time; a flight that is not in real time waits for its writer instead.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc;

use engine::inputs::DeviceEvent;
use engine::{Aircraft, Inputs, Outputs, STEP_NS, State, observe, step};
use flightgear::Link;
#[cfg(feature = "sticks")]
use logs::devices::DeviceIdentity;
use logs::output::Output;
use logs::records::{InputsRecord, TimingRecord};
use logs::{FlightWriter, Identity, Observed};

use crate::clock::{Pace, Woken, claim_real_time, now_ns, wall_ns};
use crate::crew::Crew;
use crate::end::End;
use crate::flight::{Flight, FlyError};
use crate::landing::Landing;
use crate::progress::Progress;
use crate::self_check::SelfCheck;
use crate::statistics::Statistics;
use crate::writer::{Recording, ToRecord};

/// Device events handled in one tick without asking for memory.
const EVENTS_A_TICK: usize = 1024;

/// Number and name of a phase of the flight.
type Phase = (u64, &'static str);

/// Flies until the hands are done, the time is up, or `progress.stop` is set.
///
/// # Errors
/// When the log cannot be begun, or the flight. What goes wrong later is in the [`Landing`].
pub fn fly(flight: Flight, progress: &Progress) -> Result<Landing, FlyError> {
    Ok(Live::begin(flight, progress, step)?.fly())
}

/// A flight being flown by `S`, which is [`engine::step()`] but for tests of what happens when a step
/// goes wrong.
pub(crate) struct Live<'a, S> {
    step: S,
    aircraft: Aircraft,
    state: State,
    /// What the hands see: after the last tick, or before the first.
    outputs: Outputs,
    crew: Crew,
    #[cfg(feature = "sticks")]
    sticks: Option<crate::devices::Devices>,
    /// Of the tick under way.
    events: Vec<DeviceEvent>,
    events_taken: u64,
    recording: Recording,
    /// Where the log goes.
    output: Output,
    self_check: Option<SelfCheck>,
    link: Option<Link>,
    /// Real time; `None` flies as fast as it goes.
    pace: Option<Pace>,
    ticks_max: Option<u64>,
    progress: &'a Progress,
    statistics: Statistics,
    /// What the system did not grant.
    refused: Vec<String>,
}

/// When the parts of a tick were done.
struct Times {
    woke_ns: u64,
    /// By so much the clock was anchored anew.
    slip_ns: u64,
    /// At the same moment, by the wall clock.
    wall_ns: u64,
    sampled_ns: u64,
    recorded_ns: u64,
    stepped_ns: u64,
    sent_ns: u64,
    handed_ns: u64,
}

impl<'a, S> Live<'a, S>
where
    S: FnMut(&Aircraft, &State, &Inputs) -> (State, Outputs),
{
    /// Begins the log and the threads beside the loop.
    pub(crate) fn begin(
        #[cfg_attr(not(feature = "sticks"), expect(unused_mut, reason = "no device to take"))]
        mut flight: Flight,
        progress: &'a Progress,
        step: S,
    ) -> Result<Self, FlyError> {
        let aircraft = flight.aircraft;
        let state = analysis::start::state_at(&flight.start, &aircraft)?;
        let world = flight.start.world.world();
        let identity = flight.identity.with(Identity::STARTED, wall_ns().to_string());
        let mut output = Output::flight(&flight.out, flight.force)?;
        #[cfg_attr(not(feature = "sticks"), expect(unused_mut, reason = "no device to tell of"))]
        let mut writer = FlightWriter::create(
            output.file()?,
            &flight.setup,
            &identity,
            &aircraft,
            &flight.robot_description,
            &state,
        )?;
        #[cfg(feature = "sticks")]
        for device in flight.sticks.iter().flat_map(|sticks| &sticks.found) {
            writer.device(&DeviceIdentity { tick: state.tick, ..device.clone() })?;
        }
        output.begun()?;
        let (tell, told) = mpsc::channel();
        #[cfg(feature = "sticks")]
        let later = flight.sticks.as_mut().and_then(|sticks| sticks.later.take());
        #[cfg(not(feature = "sticks"))]
        let later = None;
        let mut recording = Recording::start(writer, &aircraft, &state, told, later);
        let found = Arc::clone(&progress.mismatches);
        let self_check =
            flight.self_check.then(|| SelfCheck::start(&aircraft, &state, tell, found));
        // After the other threads have begun: what is claimed is for the loop.
        let mut refused = if flight.real_time { claim_real_time() } else { Vec::new() };
        #[cfg(feature = "sticks")]
        refused.extend(flight.sticks.iter_mut().flat_map(|sticks| sticks.refused.drain(..)));
        let outputs = observe(&aircraft, &state, &world);
        recording.show(&outputs, state.plant.attitude);
        Ok(Self {
            step,
            aircraft,
            state,
            outputs,
            crew: Crew::new(flight.hands, world),
            #[cfg(feature = "sticks")]
            sticks: flight.sticks,
            events: Vec::with_capacity(EVENTS_A_TICK),
            events_taken: 0,
            recording,
            output,
            self_check,
            link: flight.link,
            ticks_max: flight.ticks_max,
            progress,
            statistics: Statistics::new(),
            refused,
            pace: flight.real_time.then(Pace::starting_now),
        })
    }

    /// Flies until the hands are done, the time is up, or someone wants it to end.
    pub(crate) fn fly(mut self) -> Landing {
        let end = loop {
            if let Some(gave_up) = self.crew.gave_up {
                break End::GaveUp(gave_up);
            }
            if self.crew.done {
                break End::Done;
            }
            if self.ticks_max.is_some_and(|ticks| self.state.tick >= ticks) {
                break End::TimeUp;
            }
            if self.progress.stop.load(Ordering::Relaxed) {
                break End::Stopped(self.progress.signal());
            }
            self.tick();
        };
        self.land(end)
    }

    fn tick(&mut self) {
        let tick = self.state.tick;
        let Woken { at_ns: woke_ns, slip_ns } = self.wait(tick);
        let wall_ns = wall_ns();
        self.recording.beat(woke_ns);
        let phase = self.sample(tick);
        let sampled_ns = now_ns();
        self.record(tick, phase, slip_ns);
        let recorded_ns = now_ns();
        self.advance();
        let stepped_ns = now_ns();
        let sent_ns = self.publish();
        let handed_ns = now_ns();
        let times = Times {
            woke_ns,
            slip_ns,
            wall_ns,
            sampled_ns,
            recorded_ns,
            stepped_ns,
            sent_ns,
            handed_ns,
        };
        self.account(tick, &times);
    }

    /// Waits until the tick is due, or until there is room for it.
    fn wait(&mut self, tick: u64) -> Woken {
        let Some(pace) = &mut self.pace else {
            self.recording.wait_for_room();
            if let Some(check) = &self.self_check {
                check.wait_for_room();
            }
            return Woken { at_ns: now_ns(), slip_ns: 0 };
        };
        pace.wait(tick)
    }

    /// Takes the device events that came in and lets the hands act; returns the phase if it changed.
    fn sample(&mut self, tick: u64) -> Option<Phase> {
        self.events.clear();
        #[cfg(feature = "sticks")]
        if let Some(sticks) = &mut self.sticks {
            sticks.take(tick, &mut self.events);
            self.progress.devices(&self.events);
        }
        let phase = self.crew.act(tick, &self.outputs, &mut self.events);
        self.events_taken += self.events.len() as u64;
        phase
    }

    /// Hands the inputs over to the writer, before the step that uses them.
    fn record(&mut self, tick: u64, phase: Option<Phase>, slip_ns: u64) {
        for event in &self.events {
            self.recording.put(ToRecord::Event(*event));
        }
        let events = self.events.len() as u64;
        let inputs = InputsRecord { tick, events, world: self.crew.world };
        self.recording.put(ToRecord::Inputs(inputs));
        if let Some((number, name)) = phase {
            self.recording.put(ToRecord::Phase(tick, number, name));
        }
        if slip_ns > 0 {
            self.recording.put(ToRecord::Slip(tick, slip_ns));
            self.progress.slipped(slip_ns);
        }
    }

    fn advance(&mut self) {
        let inputs = Inputs { events: &self.events, world: self.crew.world };
        (self.state, self.outputs) = (self.step)(&self.aircraft, &self.state, &inputs);
    }

    /// Sends the picture, then hands the state over to the other threads; returns when the picture was
    /// on its way.
    fn publish(&mut self) -> u64 {
        if let Some(link) = &mut self.link {
            link.send(&self.outputs);
        }
        let sent_ns = now_ns();
        self.recording.put(ToRecord::State(self.state, Observed::of(&self.outputs)));
        self.recording.show(&self.outputs, self.state.plant.attitude);
        if let Some(check) = &mut self.self_check {
            check.put(&self.events, self.crew.world, &self.state);
        }
        sent_ns
    }

    /// Notes how the tick kept time, in the log and for whoever looks on.
    fn account(&mut self, tick: u64, times: &Times) {
        let due_ns = self.pace.as_ref().map(|pace| pace.due_ns(tick));
        let sent_ns = times.sent_ns - times.woke_ns;
        // Synthetic events have no time of the kernel's.
        let kernel_ns = self.events.iter().map(|event| event.kernel_time_ns).filter(|&ns| ns > 0);
        let stamped_events = kernel_ns.clone().count() as u64;
        let timing = TimingRecord {
            tick,
            wall_ns: times.wall_ns,
            late_ns: due_ns.map_or(0, |due_ns| times.woke_ns.saturating_sub(due_ns)),
            step_ns: times.stepped_ns - times.recorded_ns,
            sent_ns,
            latency_ns: kernel_ns
                .min()
                .map_or(0, |oldest_ns| (times.wall_ns + sent_ns).saturating_sub(oldest_ns)),
            record_ns: (times.recorded_ns - times.sampled_ns) + (times.handed_ns - times.sent_ns),
            slip_ns: times.slip_ns,
            overrun: u64::from(due_ns.is_some_and(|due_ns| times.handed_ns > due_ns + STEP_NS)),
            stamped_events,
            implausible_events: 0,
        };
        self.recording.put(ToRecord::Timing(timing));
        self.statistics.add(&timing);
        let (overruns, failed) = (self.statistics.overruns, self.recording.has_failed());
        self.progress.show(&self.outputs, self.crew.phase.0, overruns, failed);
    }

    /// Ends the log and the threads beside the loop.
    fn land(mut self, end: End) -> Landing {
        self.recording.put(ToRecord::Landed(self.state.tick, end));
        let backlog_max = self.recording.backlog_max;
        // Before the log is closed: what it finds last is told there, too.
        let checked = self.self_check.map(SelfCheck::finish);
        let (sent, unsent) =
            self.link.as_ref().map_or((0, 0), |link| (link.sent(), link.dropped()));
        let (log, delay) = self.recording.finish();
        let set_aside = self.output.set_aside().map(Path::to_path_buf);
        let log = log.and_then(|closed| self.output.finish().map(|()| closed));
        let set_aside = set_aside.filter(|_| log.is_err());
        Landing {
            statistics: self.statistics,
            log,
            set_aside,
            outputs: self.outputs,
            events: self.events_taken,
            sent,
            unsent,
            backlog_max,
            delay,
            checked,
            refused: self.refused,
            end,
        }
    }
}
