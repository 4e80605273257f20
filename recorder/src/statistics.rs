//! How the flight kept time, for the summary at landing.

use hdrhistogram::Histogram;
use logs::records::TimingRecord;

/// Longest duration that is told apart, ns: a minute.
const LONGEST_NS: u64 = 60_000_000_000;

/// Durations of one kind.
#[derive(Clone, Debug)]
pub struct Durations(Histogram<u64>);

impl Durations {
    pub(crate) fn new() -> Self {
        // Three digits between 1 ns and a minute; the bounds are constants, so this cannot fail.
        Self(Histogram::new_with_bounds(1, LONGEST_NS, 3).unwrap_or_else(|_| {
            Histogram::new(3).unwrap_or_else(|_| unreachable!("3 digits are allowed"))
        }))
    }

    pub(crate) fn add(&mut self, ns: u64) {
        self.0.saturating_record(ns.max(1));
    }

    /// How many.
    pub fn count(&self) -> u64 {
        self.0.len()
    }

    /// Shorter than this are `percent` of them, ms.
    pub fn percentile_ms(&self, percent: f64) -> f64 {
        self.0.value_at_percentile(percent) as f64 * 1e-6
    }

    /// The longest, ms.
    pub fn longest_ms(&self) -> f64 {
        self.0.max() as f64 * 1e-6
    }
}

/// All durations of a flight.
#[derive(Clone, Debug)]
pub struct Statistics {
    /// Ticks flown.
    pub ticks: u64,
    /// Ticks that ended after the next one was due.
    pub overruns: u64,
    /// How often the clock was anchored anew, because the process had stood still.
    pub slips: u64,
    /// By how much at most.
    pub slip_ns_max: u64,
    /// And in all.
    pub slip_ns: u64,
    /// From when a tick was due until it ran, slips apart.
    pub late: Durations,
    /// The step alone.
    pub step: Durations,
    /// From waking up, when inputs are sampled, until the picture was on its way.
    pub sent: Durations,
    /// From the kernel's time of a device event until the picture was on its way.
    pub latency: Durations,
    /// Handing the tick over to the writer.
    pub record: Durations,
}

impl Statistics {
    /// Nothing yet.
    pub fn new() -> Self {
        Self {
            ticks: 0,
            overruns: 0,
            slips: 0,
            slip_ns_max: 0,
            slip_ns: 0,
            late: Durations::new(),
            step: Durations::new(),
            sent: Durations::new(),
            latency: Durations::new(),
            record: Durations::new(),
        }
    }

    /// Adds a tick.
    pub fn add(&mut self, timing: &TimingRecord) {
        self.ticks += 1;
        self.overruns += timing.overrun;
        self.slips += u64::from(timing.slip_ns > 0);
        self.slip_ns += timing.slip_ns;
        self.slip_ns_max = self.slip_ns_max.max(timing.slip_ns);
        self.late.add(timing.late_ns);
        self.step.add(timing.step_ns);
        self.sent.add(timing.sent_ns);
        self.record.add(timing.record_ns);
        if timing.latency_ns > 0 {
            self.latency.add(timing.latency_ns);
        }
    }
}

impl Default for Statistics {
    fn default() -> Self {
        Self::new()
    }
}
