//! How the flight kept time, for the summary at landing.

use std::collections::BTreeMap;

use hdrhistogram::Histogram;
use logs::records::TimingRecord;

/// Longest duration that is told apart, ns: a minute.
const LONGEST_NS: u64 = 60_000_000_000;

/// Durations of one kind.
#[derive(Clone, Debug)]
pub struct Durations(Histogram<u64>);

impl Default for Durations {
    fn default() -> Self {
        Self::new()
    }
}

impl Durations {
    /// None yet.
    pub fn new() -> Self {
        // Three digits between 1 ns and a minute; the bounds are constants, so this cannot fail.
        Self(Histogram::new_with_bounds(1, LONGEST_NS, 3).unwrap_or_else(|_| {
            Histogram::new(3).unwrap_or_else(|_| unreachable!("3 digits are allowed"))
        }))
    }

    /// Adds one.
    pub fn add(&mut self, ns: u64) {
        self.0.saturating_record(ns.max(1));
    }

    /// The histogram as text: the greatest duration of each step in ns and how many there were, to two
    /// digits; the last one is the longest of all.
    pub fn text(&self) -> String {
        let mut steps: Vec<(u64, u64)> = Vec::new();
        for step in self.0.iter_recorded() {
            let digits = step.value_iterated_to().max(1).ilog10().saturating_sub(1);
            let width = 10_u64.pow(digits);
            let to_ns = step.value_iterated_to().div_ceil(width) * width;
            match steps.last_mut() {
                Some((last_ns, count)) if *last_ns == to_ns => {
                    *count += step.count_since_last_iteration();
                }
                _ => steps.push((to_ns, step.count_since_last_iteration())),
            }
        }
        let steps: Vec<String> = steps.iter().map(|(ns, count)| format!("{ns}:{count}")).collect();
        steps.join(" ")
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
    /// From when a tick was due until the picture was on its way: what a person meets, lateness included.
    pub sent: Durations,
    /// From the kernel's time of each device event until the picture was on its way.
    pub latency: Durations,
    /// Device events without a time of the kernel's: pilot models, scripts, keys.
    pub synthetic_events: u64,
    /// Device events whose time cannot be: in the future, or from before the flight.
    pub implausible_events: u64,
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
            synthetic_events: 0,
            implausible_events: 0,
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
        // A log may hold any number.
        self.sent.add(timing.late_ns.saturating_add(timing.sent_ns));
        self.record.add(timing.record_ns);
        self.implausible_events = self.implausible_events.saturating_add(timing.implausible_events);
    }

    /// Every kind of duration, with its name in the log.
    pub fn kinds(&self) -> [(&'static str, &Durations); 5] {
        [
            ("late_ns", &self.late),
            ("step_ns", &self.step),
            ("sent_ns", &self.sent),
            ("latency_ns", &self.latency),
            ("record_ns", &self.record),
        ]
    }

    /// As facts for the log: the histogram of each kind, and what was counted.
    pub fn facts(&self) -> BTreeMap<String, String> {
        let counts = [
            ("ticks", self.ticks),
            ("overruns", self.overruns),
            ("slips", self.slips),
            ("slip_ns", self.slip_ns),
            ("synthetic_events", self.synthetic_events),
            ("implausible_events", self.implausible_events),
        ];
        let counts = counts.map(|(name, count)| (name.to_string(), count.to_string()));
        let kinds = self.kinds().map(|(name, durations)| (name.to_string(), durations.text()));
        counts.into_iter().chain(kinds).collect()
    }
}

impl Default for Statistics {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    /// Four ticks whose times are known: each number of the summary is the one counted by hand.
    #[test]
    fn four_known_ticks_add_up() {
        let mut statistics = Statistics::new();
        for (late_ms, step_ms, sent_ms, record_ms, overrun, slip_ms, implausible_events) in [
            (0, 1, 2, 1, 0, 0, 0),
            (1, 1, 2, 1, 0, 7, 2),
            (2, 3, 4, 1, 1, 0, 0),
            (3, 8, 10, 5, 1, 5, 1),
        ] {
            statistics.add(&TimingRecord {
                late_ns: late_ms * MS,
                step_ns: step_ms * MS,
                sent_ns: sent_ms * MS,
                record_ns: record_ms * MS,
                slip_ns: slip_ms * MS,
                overrun,
                implausible_events,
                ..TimingRecord::default()
            });
        }
        assert_eq!((statistics.ticks, statistics.overruns), (4, 2));
        assert_eq!(
            (statistics.slips, statistics.slip_ns_max, statistics.slip_ns),
            (2, 7 * MS, 12 * MS)
        );
        assert_eq!(statistics.implausible_events, 3);
        assert_eq!(statistics.latency.count(), 0);
        // Three digits are kept.
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-3, "{a} ms is not {b}");
        for (durations, middle_ms, longest_ms) in [
            (&statistics.late, 1.0, 3.0),
            (&statistics.step, 1.0, 8.0),
            (&statistics.sent, 3.0, 13.0),
            (&statistics.record, 1.0, 5.0),
        ] {
            assert_eq!(durations.count(), 4);
            near(durations.percentile_ms(50.0), middle_ms);
            near(durations.longest_ms(), longest_ms);
        }
        // Each step of the histogram by its upper end, to two digits.
        assert_eq!(statistics.step.text(), "1100000:2 3100000:1 8100000:1");
        let facts = statistics.facts();
        assert_eq!(
            (facts["ticks"].as_str(), facts["overruns"].as_str(), facts["slip_ns"].as_str()),
            ("4", "2", "12000000")
        );
    }

    #[test]
    fn nothing_and_too_much_are_durations_too() {
        let mut durations = Durations::new();
        durations.add(0);
        durations.add(u64::MAX);
        assert_eq!(durations.count(), 2);
        assert!((durations.longest_ms() - 60_000.0).abs() < 60.0, "{}", durations.longest_ms());
    }
}
