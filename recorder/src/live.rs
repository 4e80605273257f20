//! The loop: wait, sample, record, step, publish, account, once a tick.
//!
//! It runs on the thread that flies, asks for no memory once it has begun, and waits for nothing but
//! time; a flight that is not in real time waits for its writer instead.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc;

use engine::controls::PickUp;
use engine::inputs::{DeviceEvent, World};
use engine::{Aircraft, Inputs, Outputs, STEP_NS, State, observe, step};
use flightgear::{Hold, Lamps, Link, Picture, Recording as Lamp, Scene};
#[cfg(feature = "sticks")]
use logs::devices::DeviceIdentity;
use logs::output::Output;
use logs::records::{InputsRecord, RestartRecord, TimingRecord};
use logs::{FlightWriter, Identity, Observed};

use crate::clock::{Pace, RealTime, Woken, now_ns, wall_ns};
use crate::controllers::Controllers;
use crate::debrief::Debrief;
use crate::end::End;
use crate::flight::{Flight, FlyError};
use crate::landing::Landing;
use crate::platform::claim_real_time;
use crate::progress::{Progress, Shown, Told};
use crate::restart::{Restarts, Situation};
use crate::self_check::SelfCheck;
use crate::statistics::Statistics;
use crate::writer::{Saver, ToRecord, WriterHandle};

/// Device events taken in one tick; those beyond come in the next.
const EVENTS_A_TICK: usize = 1024;
/// Ticks between two looks at everything for whoever shows it: 25 a second.
const SHOWN_TICKS: u64 = 10;

/// Claims real time for this thread, if the flight wants it; returns what was not granted.
fn claim(real_time: Option<RealTime>) -> Vec<String> {
    real_time.map_or_else(Vec::new, |wanted| claim_real_time(wanted.cpu))
}

/// Number and name of a phase of the flight.
type Phase = (u64, &'static str);

/// Flies until pilot model or script has ended, the time is up, or `progress.stop` is set.
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
    controllers: Controllers,
    #[cfg(feature = "sticks")]
    sticks: Option<crate::devices::Devices>,
    restarts: Restarts,
    /// What the tick under way begins with in place of the state before it.
    restarted: Option<RestartRecord>,
    /// Of the tick under way.
    events: Vec<DeviceEvent>,
    events_taken: u64,
    recording: WriterHandle,
    /// Where the log goes.
    output: Output,
    self_check: Option<SelfCheck>,
    link: Option<Link>,
    /// Not before then is another picture sent when it flies as fast as it goes.
    next_picture_ns: u64,
    /// Real time; `None` flies as fast as it goes.
    pace: Option<Pace>,
    ticks_max: Option<u64>,
    progress: &'a Progress,
    statistics: Statistics,
    debrief: Debrief,
    shown: Shown,
    /// By the wall clock: device events from before it are not of this flight.
    begun_wall_ns: u64,
    /// What the system did not grant.
    refused: Vec<String>,
}

/// The state and the world of a flight that begins with a situation: at tick 0, with no marker pressed.
fn begun_with(situation: &Situation) -> (State, World) {
    let Situation { mut state, mut world } = *situation;
    match world.gust_start_tick.checked_sub(state.tick) {
        Some(start_tick) => world.gust_start_tick = start_tick,
        // It began before the flight does: what is left of one cannot be had.
        None => world.gust_s = 0.0,
    }
    state.tick = 0;
    state.cockpit.markers = 0;
    // Hardware tells where it stands, and that is not where it stood.
    state.cockpit.pick_up = PickUp::default();
    state.cockpit.force_trim.released = 0;
    (state, world)
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
        let world = flight.start.world.world();
        let (state, world_of_start) = match &flight.situation {
            Some(situation) => begun_with(situation),
            None => (analysis::start::state_at(&flight.start, &aircraft)?, world),
        };
        let identity = flight.identity.with(Identity::STARTED, wall_ns().to_string());
        let mut output = Output::flight(&flight.out, flight.force)?;
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
        let say = progress.listen();
        writer.tell(Box::new(move |tick, what, level, words| {
            say(&Told { tick, what, level, words: words.into() });
        }));
        let (tell, told) = mpsc::channel();
        #[cfg(feature = "sticks")]
        let later = flight.sticks.as_mut().and_then(|sticks| sticks.later.take());
        #[cfg(not(feature = "sticks"))]
        let later = None;
        let saver = Saver::beside(&flight.out, &aircraft.name);
        let mut recording = WriterHandle::start(writer, &aircraft, &state, told, saver, later);
        let found = Arc::clone(&progress.mismatches);
        let self_check =
            flight.self_check.then(|| SelfCheck::start(&aircraft, &state, tell, found));
        // After the other threads have begun: what is claimed is for the loop.
        let refused = claim(flight.real_time);
        #[cfg(feature = "sticks")]
        let refused =
            flight.sticks.iter().flat_map(|it| it.refused.clone()).chain(refused).collect();
        let outputs = observe(&aircraft, &state, &world);
        recording.show(&outputs, state.plant.attitude);
        let controllers = Controllers::new(flight.controllers, world_of_start);
        let pace = flight.real_time.as_ref().map(Pace::keeping);
        Ok(Self {
            step,
            aircraft,
            state,
            outputs,
            restarts: Restarts::new(Situation { state, world: world_of_start }),
            restarted: None,
            events: Vec::with_capacity(EVENTS_A_TICK + controllers.events_a_tick()),
            controllers,
            #[cfg(feature = "sticks")]
            sticks: flight.sticks,
            events_taken: 0,
            recording,
            output,
            self_check,
            link: flight.link,
            next_picture_ns: 0,
            ticks_max: flight.ticks_max,
            progress,
            statistics: Statistics::new(),
            debrief: Debrief::default(),
            shown: Shown::default(),
            begun_wall_ns: wall_ns(),
            refused,
            pace,
        })
    }

    /// Flies until pilot model or script has ended, the time is up, or someone wants it to end.
    pub(crate) fn fly(mut self) -> Landing {
        let end = loop {
            if let Some(gave_up) = self.controllers.gave_up {
                break End::GaveUp(gave_up);
            }
            if self.controllers.done {
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
            sticks.take(tick, &mut self.events, EVENTS_A_TICK);
            self.progress.devices(&self.events);
        }
        let phase = self.controllers.act(tick, &self.outputs, &mut self.events);
        self.events_taken += self.events.len() as u64;
        self.restarted = self.restart();
        phase
    }

    /// Goes on from another state if the crew wants it.
    fn restart(&mut self) -> Option<RestartRecord> {
        let restart = self.controllers.restart.take()?;
        let made = self.restarts.made(
            &restart,
            &self.aircraft.cockpit,
            &self.state,
            &self.controllers.world,
        );
        let (record, world) = made?;
        self.state = record.state;
        self.controllers.world = world;
        self.debrief.restart();
        Some(record)
    }

    /// Hands the inputs over to the writer, before the step that uses them.
    fn record(&mut self, tick: u64, phase: Option<Phase>, slip_ns: u64) {
        if let Some(restarted) = self.restarted {
            self.recording.put(ToRecord::Restart(restarted));
        }
        for event in &self.events {
            self.recording.put(ToRecord::Event(*event));
        }
        let events = self.events.len() as u64;
        let inputs = InputsRecord { tick, events, world: self.controllers.world };
        self.recording.put(ToRecord::Inputs(inputs));
        if std::mem::take(&mut self.controllers.save) {
            self.restarts.saved(Situation { state: self.state, world: self.controllers.world });
            self.recording.put(ToRecord::Save(self.state));
        }
        if let Some((number, name)) = phase {
            self.recording.put(ToRecord::Phase(tick, number, name));
        }
        if slip_ns > 0 {
            self.recording.put(ToRecord::Slip(tick, slip_ns));
            self.progress.slipped(slip_ns);
        }
    }

    fn advance(&mut self) {
        let inputs = Inputs { events: &self.events, world: self.controllers.world };
        let markers = self.state.cockpit.markers;
        (self.state, self.outputs) = (self.step)(&self.aircraft, &self.state, &inputs);
        self.restarts.look(markers, &self.state, &self.controllers.world);
        self.debrief.add(&self.aircraft.envelope, &self.outputs);
    }

    /// Sends the picture, then hands the state over to the other threads; returns when the picture was
    /// on its way.
    fn publish(&mut self) -> u64 {
        if self.pace.is_some() || now_ns() >= self.next_picture_ns {
            self.show();
        }
        let sent_ns = now_ns();
        self.recording.put(ToRecord::State(self.state, Observed::of(&self.outputs)));
        self.recording.show(&self.outputs, self.state.plant.attitude);
        if let Some(check) = &mut self.self_check {
            let restart = self.restarted.as_ref().map(|restarted| &restarted.state);
            check.put(restart, &self.events, self.controllers.world, &self.state);
        }
        sent_ns
    }

    /// Sends the picture. As fast as it goes there would be thousands a second, which nobody sees.
    fn show(&mut self) {
        self.next_picture_ns = now_ns() + STEP_NS;
        let picture = self.picture();
        if let (Some(link), Some(picture)) = (&mut self.link, picture) {
            link.send(&picture);
        }
    }

    /// What FlightGear is to show; `None` when there is none.
    fn picture(&self) -> Option<Picture> {
        self.link.as_ref()?;
        let recording = if self.recording.has_failed() { Lamp::Failed } else { Lamp::On };
        Some(Picture::of(&Scene {
            aircraft: &self.aircraft,
            outputs: &self.outputs,
            world: &self.controllers.world,
            lamps: Lamps { recording, ..Lamps::default() },
        }))
    }

    /// Notes how the tick kept time, in the log and for whoever looks on.
    fn account(&mut self, tick: u64, times: &Times) {
        let due_ns = self.pace.as_ref().map(|pace| pace.due_ns(tick));
        let sent_ns = times.sent_ns - times.woke_ns;
        let sent_wall_ns = times.wall_ns + sent_ns;
        let (stamped, implausible, oldest_ns) = self.latencies(sent_wall_ns);
        let timing = TimingRecord {
            tick,
            wall_ns: times.wall_ns,
            late_ns: due_ns.map_or(0, |due_ns| times.woke_ns.saturating_sub(due_ns)),
            step_ns: times.stepped_ns - times.recorded_ns,
            sent_ns,
            latency_ns: oldest_ns.map_or(0, |oldest_ns| sent_wall_ns - oldest_ns),
            record_ns: (times.recorded_ns - times.sampled_ns) + (times.handed_ns - times.sent_ns),
            slip_ns: times.slip_ns,
            overrun: u64::from(due_ns.is_some_and(|due_ns| times.handed_ns > due_ns + STEP_NS)),
            stamped_events: stamped,
            implausible_events: implausible,
        };
        self.recording.put(ToRecord::Timing(timing));
        self.statistics.add(&timing);
        let (overruns, failed) = (self.statistics.overruns, self.recording.has_failed());
        self.progress.show(&self.outputs, self.controllers.phase.0, overruns, failed);
        self.shown.add(&timing);
        if tick.is_multiple_of(SHOWN_TICKS) {
            self.shown.of(&self.outputs, &self.controllers.world, &self.debrief);
            self.progress.show_all(&self.shown);
        }
    }

    /// Adds the latency of every event of the tick that the kernel stamped: how many did, how many of
    /// these at a time that cannot be, and the oldest of the others.
    fn latencies(&mut self, sent_wall_ns: u64) -> (u64, u64, Option<u64>) {
        let (mut stamped, mut implausible, mut oldest_ns) = (0, 0, None);
        for event in &self.events {
            let kernel_ns = event.kernel_time_ns;
            match sent_wall_ns.checked_sub(kernel_ns) {
                _ if kernel_ns == 0 => {
                    self.statistics.synthetic_events += 1;
                    continue;
                }
                Some(latency_ns) if kernel_ns >= self.begun_wall_ns => {
                    self.statistics.latency.add(latency_ns);
                    oldest_ns = Some(oldest_ns.map_or(kernel_ns, |o: u64| o.min(kernel_ns)));
                }
                _ => implausible += 1,
            }
            stamped += 1;
        }
        (stamped, implausible, oldest_ns)
    }

    /// Ends the log and the threads beside the loop.
    fn land(mut self, end: End) -> Landing {
        self.recording.put(ToRecord::Landed(self.state.tick, end));
        // From here on, while the log is being closed, too.
        let last = self.picture();
        let pictures = self.link.as_ref().map(Link::sent).unwrap_or_default();
        let hold = self
            .link
            .filter(|link| !link.nobody_listens())
            .zip(last)
            .map(|(link, last)| Hold::start(link, last));
        let backlog_max = self.recording.backlog_max;
        // Before the log is closed: what it finds last is told there, too.
        let checked = self.self_check.map(SelfCheck::finish);
        let (log, delay) = self.recording.finish(self.statistics.facts());
        let set_aside = self.output.set_aside().map(Path::to_path_buf);
        let log = log.and_then(|closed| self.output.finish().map(|()| closed));
        let set_aside = set_aside.filter(|_| log.is_err());
        Landing {
            statistics: self.statistics,
            debrief: self.debrief,
            log,
            set_aside,
            outputs: self.outputs,
            events: self.events_taken,
            pictures,
            hold,
            backlog_max,
            delay,
            checked,
            refused: self.refused,
            end,
        }
    }
}

#[cfg(test)]
mod tests;
