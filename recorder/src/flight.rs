//! The loop.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc;

use engine::inputs::{DeviceEvent, World};
use engine::start::Start;
use engine::{Aircraft, Inputs, Outputs, STEP_NS, State, step};
use flightgear::Link;
use logs::records::{InputsRecord, TimingRecord};
use logs::{Closed, FlightWriter, Identity, LogError, Setup};

use crate::clock::{Pace, claim_real_time, now_ns, wall_ns};
use crate::hands::{Hands, Reach};
use crate::self_check::{Checked, SelfCheck};
use crate::statistics::Statistics;
use crate::writer::{Delay, Recording, ToRecord};

/// Device events handled in one tick without asking for memory.
const EVENTS_A_TICK: usize = 1024;

/// A flight to be flown.
pub struct Flight {
    /// The aircraft, its cockpit map included.
    pub aircraft: Aircraft,
    /// Where and how it begins.
    pub start: Start,
    /// The texts of both, for the log.
    pub setup: Setup,
    /// Who flies, for the log.
    pub identity: Identity,
    /// The aircraft's shape for viewers, URDF.
    pub robot_description: String,
    /// Whatever moves the controls, in the order in which it is asked.
    pub hands: Vec<Box<dyn Hands>>,
    /// Devices that deliver events of their own.
    #[cfg(feature = "sticks")]
    pub sticks: Option<crate::sticks::Sticks>,
    /// The log.
    pub out: PathBuf,
    /// Whether an existing log may be overwritten.
    pub force: bool,
    /// Real time; without it, as fast as it goes.
    pub real_time: bool,
    /// Ticks after which the flight ends by itself.
    pub ticks_max: Option<u64>,
    /// FlightGear.
    pub link: Option<Link>,
    /// Whether a spare thread reflies what is flown while it is flown.
    pub self_check: bool,
    /// Flips a bit of the state after this tick, as failing memory would: there is no such flight
    /// outside this crate's own tests.
    #[cfg(test)]
    pub upset_tick: Option<u64>,
}

/// Where the flight is, for whoever shows it, written by the loop without waiting.
#[derive(Debug, Default)]
pub struct Progress {
    tick: AtomicU64,
    height_m: AtomicU64,
    airspeed_mps: AtomicU64,
    heading_rad: AtomicU64,
    phase: AtomicU64,
    overruns: AtomicU64,
    log_failed: AtomicBool,
    mismatches: Arc<AtomicU64>,
    /// Set by whoever wants the flight to end.
    pub stop: Arc<AtomicBool>,
}

/// The same, read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// Ticks flown.
    pub tick: u64,
    /// Over the ground.
    pub height_m: f64,
    /// True.
    pub airspeed_mps: f64,
    /// Clockwise from north.
    pub heading_rad: f64,
    /// Number of the phase.
    pub phase: u64,
    /// Late ticks so far.
    pub overruns: u64,
    /// The log cannot be written any further.
    pub log_failed: bool,
    /// Seconds of flight that were not the same when reflown in flight.
    pub mismatches: u64,
}

impl Progress {
    /// Lets SIGINT and SIGTERM end the flight: the log is finished and the summary printed.
    ///
    /// # Errors
    /// When the system refuses the handlers.
    pub fn stop_on_signals(&self) -> std::io::Result<()> {
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            signal_hook::flag::register(signal, Arc::clone(&self.stop))?;
        }
        Ok(())
    }

    /// Where the flight is now.
    pub fn now(&self) -> Snapshot {
        let number = |bits: &AtomicU64| f64::from_bits(bits.load(Ordering::Relaxed));
        Snapshot {
            tick: self.tick.load(Ordering::Relaxed),
            height_m: number(&self.height_m),
            airspeed_mps: number(&self.airspeed_mps),
            heading_rad: number(&self.heading_rad),
            phase: self.phase.load(Ordering::Relaxed),
            overruns: self.overruns.load(Ordering::Relaxed),
            log_failed: self.log_failed.load(Ordering::Relaxed),
            mismatches: self.mismatches.load(Ordering::Relaxed),
        }
    }

    fn show(&self, outputs: &Outputs, phase: u64, overruns: u64, log_failed: bool) {
        let put = |bits: &AtomicU64, value: f64| bits.store(value.to_bits(), Ordering::Relaxed);
        self.tick.store(outputs.tick, Ordering::Relaxed);
        put(&self.height_m, outputs.height_above_ground_m);
        put(&self.airspeed_mps, outputs.airspeed_mps);
        put(&self.heading_rad, outputs.euler.heading_rad);
        self.phase.store(phase, Ordering::Relaxed);
        self.overruns.store(overruns, Ordering::Relaxed);
        self.log_failed.store(log_failed, Ordering::Relaxed);
    }
}

/// How a flight ended.
#[derive(Debug)]
pub struct Landing {
    /// How it kept time.
    pub statistics: Statistics,
    /// The log, or why it ends early.
    pub log: Result<Closed, LogError>,
    /// What the aircraft was like at the end.
    pub outputs: Outputs,
    /// Device events taken.
    pub events: u64,
    /// Pictures sent to FlightGear.
    pub sent: u64,
    /// Pictures that could not be sent.
    pub unsent: u64,
    /// Most items that ever waited for the writer.
    pub backlog_max: usize,
    /// How the writer was held up.
    pub delay: Delay,
    /// What the self-check found, if there was one.
    pub checked: Option<Checked>,
    /// What the system did not grant.
    pub refused: Vec<String>,
    /// Whether someone ended it.
    pub stopped: bool,
}

/// Why a flight did not begin.
#[derive(Debug, thiserror::Error)]
pub enum FlyError {
    /// The log cannot be begun.
    #[error(transparent)]
    Log(#[from] LogError),
    /// There is no steady flight to begin in.
    #[error("the flight cannot begin in the air")]
    Trim(#[from] analysis::trim::Failure),
}

/// Flies until the hands are done, the time is up, or `progress.stop` is set.
///
/// # Errors
/// When the log cannot be begun, or the flight. What goes wrong later is in the [`Landing`].
pub fn fly(mut flight: Flight, progress: &Progress) -> Result<Landing, FlyError> {
    let aircraft = flight.aircraft;
    let mut state = analysis::start::state_at(&flight.start, &aircraft)?;
    let world = flight.start.world.world();
    let identity = flight.identity.with(Identity::STARTED, wall_ns().to_string());
    let writer = FlightWriter::create(
        &flight.out,
        &flight.setup,
        &identity,
        &aircraft,
        &flight.robot_description,
        &state,
        flight.force,
    )?;
    let mut crew = Crew::new(flight.hands, world);
    let (tell, told) = mpsc::channel();
    let mut recording = Recording::start(writer, &state, told);
    let found = Arc::clone(&progress.mismatches);
    let mut self_check =
        flight.self_check.then(|| SelfCheck::start(&aircraft, &state, tell, found));
    let refused = if flight.real_time { claim_real_time() } else { Vec::new() };

    let mut outputs = crew.first_look(&aircraft, &state);
    recording.show(&outputs, state.plant.attitude);
    let mut statistics = Statistics::new();
    let mut events: Vec<DeviceEvent> = Vec::with_capacity(EVENTS_A_TICK);
    let mut events_taken = 0;
    let mut stopped = false;
    let pace = Pace::starting_now();
    while !crew.done && flight.ticks_max.is_none_or(|ticks| state.tick < ticks) {
        if progress.stop.load(Ordering::Relaxed) {
            stopped = true;
            break;
        }
        let tick = state.tick;
        let woke_ns = if flight.real_time {
            pace.wait(tick)
        } else {
            recording.wait_for_room();
            if let Some(check) = &self_check {
                check.wait_for_room();
            }
            now_ns()
        };
        let wall = wall_ns();

        events.clear();
        #[cfg(feature = "sticks")]
        if let Some(sticks) = &mut flight.sticks {
            sticks.take(tick, &mut events);
        }
        let phase = crew.act(tick, &outputs, &mut events);
        let oldest_ns = events.iter().map(|event| event.kernel_time_ns).filter(|&ns| ns > 0).min();

        // Recorded before the step that uses it.
        let recorded_ns = now_ns();
        for event in &events {
            recording.put(ToRecord::Event(*event));
        }
        let inputs = InputsRecord { tick, events: events.len() as u64, world: crew.world };
        recording.put(ToRecord::Inputs(inputs));
        if let Some((number, name)) = phase {
            recording.put(ToRecord::Phase(tick, number, name));
        }
        let stepping_ns = now_ns();
        (state, outputs) = step(&aircraft, &state, &Inputs { events: &events, world: crew.world });
        #[cfg(test)]
        if flight.upset_tick == Some(state.tick) {
            state.plant.fuel_kg = f64::from_bits(state.plant.fuel_kg.to_bits() ^ 1);
        }
        let stepped_ns = now_ns();
        if let Some(link) = &mut flight.link {
            link.send(&outputs);
        }
        let sent_ns = now_ns();
        recording.put(ToRecord::State(state));
        recording.show(&outputs, state.plant.attitude);
        if let Some(check) = &mut self_check {
            check.put(&events, crew.world, &state);
        }
        let handed_ns = now_ns();

        let timing = TimingRecord {
            tick,
            wall_ns: wall,
            late_ns: if flight.real_time { woke_ns.saturating_sub(pace.due_ns(tick)) } else { 0 },
            step_ns: stepped_ns - stepping_ns,
            sent_ns: sent_ns - woke_ns,
            latency_ns: oldest_ns
                .map_or(0, |oldest| (wall + (sent_ns - woke_ns)).saturating_sub(oldest)),
            record_ns: (stepping_ns - recorded_ns) + (handed_ns - sent_ns),
            overrun: u64::from(flight.real_time && handed_ns > pace.due_ns(tick) + STEP_NS),
        };
        recording.put(ToRecord::Timing(timing));
        statistics.add(&timing);
        events_taken += events.len() as u64;
        progress.show(&outputs, crew.phase.0, statistics.overruns, recording.has_failed());
    }
    recording.put(ToRecord::Landed(state.tick, if stopped { 2 } else { 0 }));
    let backlog_max = recording.backlog_max;
    // Before the log is closed: what it finds last is told there, too.
    let checked = self_check.map(SelfCheck::finish);
    let (sent, unsent) = flight.link.as_ref().map_or((0, 0), |link| (link.sent(), link.dropped()));
    let (log, delay) = recording.finish();
    Ok(Landing {
        statistics,
        log,
        outputs,
        events: events_taken,
        sent,
        unsent,
        backlog_max,
        delay,
        checked,
        refused,
        stopped,
    })
}

/// All hands, and what they hold on to between ticks.
pub(crate) struct Crew {
    hands: Vec<Box<dyn Hands>>,
    pub(crate) world: World,
    pub(crate) phase: (u64, &'static str),
    pub(crate) done: bool,
}

impl Crew {
    /// Hands that have touched nothing yet.
    pub(crate) fn new(hands: Vec<Box<dyn Hands>>, world: World) -> Self {
        Self { hands, world, phase: (0, ""), done: false }
    }

    /// What the hands see before the first tick: the aircraft as it is.
    pub(crate) fn first_look(&self, aircraft: &Aircraft, state: &State) -> Outputs {
        let inputs = Inputs { events: &[], world: World { paused: 1, ..self.world } };
        Outputs { tick: state.tick, ..step(aircraft, state, &inputs).1 }
    }

    /// Lets every hand act; returns the phase if it changed.
    pub(crate) fn act(
        &mut self,
        tick: u64,
        seen: &Outputs,
        events: &mut Vec<DeviceEvent>,
    ) -> Option<(u64, &'static str)> {
        let before = self.phase.0;
        for hand in &mut self.hands {
            hand.act(
                seen,
                &mut Reach {
                    tick,
                    events,
                    world: &mut self.world,
                    phase: &mut self.phase,
                    done: &mut self.done,
                },
            );
        }
        (self.phase.0 != before).then_some(self.phase)
    }
}

#[cfg(test)]
mod tests {
    use logs::OpenOptions;
    use logs::records::Happening;

    use super::*;

    /// Two seconds on the ground, with or without an upset; returns the log and what the crew saw.
    fn fly_two_seconds(name: &str, upset_tick: Option<u64>) -> (PathBuf, Landing, Snapshot) {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let out = std::env::temp_dir().join(format!("tiltrotor-{name}-{}", std::process::id()));
        let setup = Setup {
            aircraft_toml: aircraft::XV15.into(),
            cockpit_toml: String::new(),
            scenario_toml: aircraft::DEFAULT_SCENARIO.into(),
        };
        let flight = Flight {
            start: aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap(),
            aircraft,
            setup,
            identity: Identity::new(),
            robot_description: String::new(),
            hands: Vec::new(),
            #[cfg(feature = "sticks")]
            sticks: None,
            out: out.clone(),
            force: true,
            real_time: false,
            ticks_max: Some(500),
            link: None,
            self_check: true,
            upset_tick,
        };
        let progress = Progress::default();
        let landing = fly(flight, &progress).unwrap();
        (out, landing, progress.now())
    }

    fn self_checks(log: &std::path::Path) -> Vec<(u64, u64, String)> {
        let mut reader = logs::open(log, OpenOptions::default()).unwrap();
        while reader.next_tick().unwrap().is_some() {}
        let words = reader.remarks.iter().filter(|remark| remark.words.contains("self-check"));
        let mut words = words.map(|remark| remark.words.clone());
        let events = reader.happenings.iter();
        events
            .filter(|event| event.kind == Happening::SelfCheck as u64)
            .map(|event| (event.tick, event.value, words.next().unwrap_or_default()))
            .collect()
    }

    #[test]
    fn an_upset_in_flight_warns_the_crew_and_is_in_the_log_with_tick_and_name() {
        let (log, landing, seen) = fly_two_seconds("upset", Some(300));
        assert_eq!(seen.mismatches, 1);
        assert_eq!(landing.checked.unwrap().mismatches, 1);
        let told = self_checks(&log);
        std::fs::remove_file(&log).unwrap();
        assert_eq!(told.len(), 1, "{told:?}");
        assert_eq!((told[0].0, told[0].1), (300, 1));
        assert!(told[0].2.contains("plant.fuel_kg"), "{told:?}");
    }

    #[test]
    fn a_flight_without_an_upset_says_nothing_of_it() {
        let (log, landing, seen) = fly_two_seconds("quiet", None);
        let checked = landing.checked.unwrap();
        assert_eq!((checked.ticks, checked.mismatches, checked.dropped), (500, 0, 0));
        assert_eq!(seen.mismatches, 0);
        let told = self_checks(&log);
        std::fs::remove_file(&log).unwrap();
        assert!(told.is_empty(), "{told:?}");
    }
}
