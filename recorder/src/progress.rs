//! Where a flight is while it is flown, for whoever shows it, and the word that it should end.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};

use engine::Outputs;
use engine::cockpit::{self, Waiting};
use engine::inputs::{DeviceEvent, EventKind, World};
use logs::records::{FlightEvent, TimingRecord};
use logs::view::Level;

use crate::debrief::Debrief;
use crate::platform::{ENDING, is_ignored};

/// Something that was told in the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// When.
    pub tick: u64,
    /// What happened.
    pub what: FlightEvent,
    /// How grave it is.
    pub level: Level,
    /// In words.
    pub words: String,
}

/// Everything that a panel shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shown {
    /// What can be observed.
    pub outputs: Outputs,
    /// Weather and failures.
    pub world: World,
    /// Touchdown, corridor, limits so far.
    pub debrief: Debrief,
    /// Ticks so far that ended after the next one was due.
    pub overruns: u64,
    /// The greatest lateness within the last second, ns.
    pub late_ns: u64,
    /// The same in the whole flight, slips apart.
    pub late_ns_max: u64,
    /// From an input's time in the kernel to the picture: the greatest within the last second, ns; 0
    /// without one.
    pub latency_ns: u64,
    /// How the latest of the ticks since the last look kept time; one with an input of hardware, a slip or an
    /// overrun goes before others.
    pub timing: TimingRecord,
    /// It has been shown: the next tick begins anew.
    timing_shown: bool,
    /// Of the second under way: lateness, latency, ticks.
    gathering: (u64, u64, u64),
}

/// Ticks a second.
const SECOND_TICKS: u64 = 1_000_000_000 / engine::STEP_NS;

impl Shown {
    /// Adds how a tick kept time.
    pub(crate) fn add(&mut self, timing: &TimingRecord) {
        self.overruns += timing.overrun;
        self.late_ns_max = self.late_ns_max.max(timing.late_ns);
        let rank = |timing: &TimingRecord| {
            let grave = timing.latency_ns > 0 || timing.slip_ns > 0 || timing.overrun > 0;
            (grave, timing.late_ns)
        };
        if self.timing_shown || rank(timing) >= rank(&self.timing) {
            self.timing = *timing;
            self.timing_shown = false;
        }
        let (late_ns, latency_ns, ticks) = &mut self.gathering;
        *late_ns = (*late_ns).max(timing.late_ns);
        *latency_ns = (*latency_ns).max(timing.latency_ns);
        *ticks += 1;
        if *ticks == SECOND_TICKS {
            (self.late_ns, self.latency_ns) = (*late_ns, *latency_ns);
            self.gathering = (0, 0, 0);
        }
    }

    /// Takes what there is to be seen.
    pub(crate) fn of(&mut self, outputs: &Outputs, world: &World, debrief: &Debrief) {
        (self.outputs, self.world, self.debrief) = (*outputs, *world, *debrief);
        self.timing_shown = true;
    }
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
    slips: AtomicU64,
    slipped_ns: AtomicU64,
    /// Devices that are plugged in, a bit each by their numbers.
    plugged: AtomicU64,
    /// Controls that wait for pick-up and are to go up to it, and down, a bit each by their places.
    waiting_up: AtomicU64,
    waiting_down: AtomicU64,
    /// Neither side waits for the other.
    shown: Mutex<Shown>,
    told: Mutex<Option<Receiver<Told>>>,
    /// Who listens beside whoever calls `told`.
    beside: Mutex<Option<Sender<Told>>>,
    /// The last signal that came, by its place in [`ENDING`], from 1.
    signal: Arc<AtomicUsize>,
    pub(crate) mismatches: Arc<AtomicU64>,
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
    /// How often the clock was anchored anew, because the process had stood still.
    pub slips: u64,
    /// For how long it had in all, s.
    pub slipped_s: f64,
    /// Seconds of flight that were not the same when reflown in flight.
    pub mismatches: u64,
    /// Devices of the map that are plugged in, a bit each by their numbers.
    pub plugged: u64,
    /// Controls that wait for pick-up, a bit each by their places: the hardware has to come up to them.
    pub waiting_up: u64,
    /// The same, down.
    pub waiting_down: u64,
}

impl Progress {
    /// Lets SIGINT, SIGTERM, SIGHUP and SIGXFSZ end the flight: the log is finished and the summary
    /// printed. Who has the last two ignored, as `nohup` does, wants the flight to go on.
    ///
    /// # Errors
    /// When the system refuses the handlers.
    pub fn stop_on_signals(&self) -> std::io::Result<()> {
        for (number, &(signal, _)) in (1..).zip(ENDING) {
            if is_ignored(signal) {
                continue;
            }
            // The name first: whoever sees that it should end can say why.
            signal_hook::flag::register_usize(signal, Arc::clone(&self.signal), number)?;
            signal_hook::flag::register(signal, Arc::clone(&self.stop))?;
        }
        Ok(())
    }

    /// What the signal that ended the flight is called.
    pub(crate) fn signal(&self) -> Option<&'static str> {
        let number = self.signal.load(Ordering::Relaxed);
        ENDING.get(number.checked_sub(1)?).map(|(_, name)| *name)
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
            slips: self.slips.load(Ordering::Relaxed),
            slipped_s: self.slipped_ns.load(Ordering::Relaxed) as f64 * 1e-9,
            mismatches: self.mismatches.load(Ordering::Relaxed),
            plugged: self.plugged.load(Ordering::Relaxed),
            waiting_up: self.waiting_up.load(Ordering::Relaxed),
            waiting_down: self.waiting_down.load(Ordering::Relaxed),
        }
    }

    /// Everything that there is to be seen, as new as it can be had without waiting.
    pub fn shown(&self) -> Option<Shown> {
        self.shown.try_lock().ok().map(|shown| *shown)
    }

    /// What was told in the log since the last call.
    pub fn told(&self) -> Vec<Told> {
        let told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        told.iter().flat_map(Receiver::try_iter).collect()
    }

    /// The same for another listener, who takes everything himself; to be called before the flight begins.
    pub fn listen_beside(&self) -> Receiver<Told> {
        let (say, said) = mpsc::channel();
        *self.beside.lock().unwrap_or_else(PoisonError::into_inner) = Some(say);
        said
    }

    /// Where to say what is told in the log. Nobody may listen.
    pub(crate) fn listen(&self) -> impl Fn(&Told) + Send + use<> {
        let (say, said) = mpsc::channel();
        *self.told.lock().unwrap_or_else(PoisonError::into_inner) = Some(said);
        let beside = self.beside.lock().unwrap_or_else(PoisonError::into_inner).take();
        move |told| {
            for say in [Some(&say), beside.as_ref()].into_iter().flatten() {
                let _ = say.send(told.clone());
            }
        }
    }

    /// Written by the loop, if nobody is reading at this moment.
    pub(crate) fn show_all(&self, shown: &Shown) {
        if let Ok(mut place) = self.shown.try_lock() {
            *place = *shown;
        }
    }

    /// The clock was anchored anew.
    pub(crate) fn slipped(&self, slip_ns: u64) {
        self.slipped_ns.fetch_add(slip_ns, Ordering::Relaxed);
        self.slips.fetch_add(1, Ordering::Relaxed);
    }

    /// Devices that came or went.
    #[cfg_attr(not(feature = "sticks"), expect(dead_code, reason = "none is read"))]
    pub(crate) fn devices(&self, events: &[DeviceEvent]) {
        for event in events.iter().filter(|event| event.device < 64) {
            let bit = 1 << event.device;
            match EventKind::from_u64(event.kind) {
                Some(EventKind::Connected) => self.plugged.fetch_or(bit, Ordering::Relaxed),
                Some(EventKind::Disconnected) => self.plugged.fetch_and(!bit, Ordering::Relaxed),
                _ => continue,
            };
        }
    }

    /// Written by the loop, without waiting.
    pub(crate) fn show(&self, outputs: &Outputs, phase: u64, overruns: u64, log_failed: bool) {
        let put = |bits: &AtomicU64, value: f64| bits.store(value.to_bits(), Ordering::Relaxed);
        self.tick.store(outputs.tick, Ordering::Relaxed);
        put(&self.height_m, outputs.height_above_ground_m);
        put(&self.airspeed_mps, outputs.airspeed_mps);
        put(&self.heading_rad, outputs.euler.heading_rad);
        self.phase.store(phase, Ordering::Relaxed);
        self.overruns.store(overruns, Ordering::Relaxed);
        self.log_failed.store(log_failed, Ordering::Relaxed);
        let (mut up, mut down) = (0, 0);
        for Waiting { control, up: is_up, .. } in cockpit::waiting(&outputs.cockpit) {
            *(if is_up { &mut up } else { &mut down }) |= 1 << control as u64;
        }
        self.waiting_up.store(up, Ordering::Relaxed);
        self.waiting_down.store(down, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_every_second_the_greatest_lateness_and_latency_are_shown_when_it_is_over() {
        let mut shown = Shown::default();
        let mut a_second = |late_ns: u64, latency_ns: u64| {
            let before = (shown.late_ns, shown.latency_ns);
            for tick in 0..250 {
                assert_eq!((shown.late_ns, shown.latency_ns), before, "tick {tick} of the second");
                shown.add(&TimingRecord {
                    late_ns: if tick == 100 { late_ns } else { 10 },
                    latency_ns: if tick == 20 { latency_ns } else { 0 },
                    overrun: u64::from(tick == 7),
                    ..TimingRecord::default()
                });
            }
            (shown.late_ns, shown.latency_ns, shown.late_ns_max, shown.overruns)
        };
        assert_eq!(a_second(7000, 900), (7000, 900, 7000, 1));
        // The next one begins anew, but for what is of the whole flight.
        assert_eq!(a_second(3000, 0), (3000, 0, 7000, 2));
        assert_eq!(a_second(9000, 1), (9000, 1, 9000, 3));
    }

    #[test]
    fn what_happened_to_a_tick_is_shown_before_lateness_and_until_it_was_looked_at() {
        let mut shown = Shown::default();
        let late = |tick, late_ns| TimingRecord { tick, late_ns, ..TimingRecord::default() };
        let mut add = |timing: TimingRecord| {
            shown.add(&timing);
            shown.timing.tick
        };
        assert_eq!(add(late(1, 500)), 1);
        assert_eq!(add(late(2, 400)), 1, "less late");
        assert_eq!(add(late(3, 500)), 3, "as late, and newer");
        assert_eq!(add(TimingRecord { latency_ns: 1, ..late(4, 0) }), 4, "hardware moved");
        assert_eq!(add(late(5, 900)), 4, "nothing happened to it");
        assert_eq!(add(TimingRecord { slip_ns: 1, ..late(6, 10) }), 6, "a slip");
        assert_eq!(add(TimingRecord { overrun: 1, ..late(7, 20) }), 7, "an overrun");
        shown.of(&Outputs::default(), &World::default(), &Debrief::default());
        shown.add(&late(8, 0));
        assert_eq!(shown.timing.tick, 8, "after a look any tick is news");
    }
}
