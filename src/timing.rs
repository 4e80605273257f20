//! How a flight kept time, as its log says.

use std::collections::BTreeMap;

use logs::records::TIMING_FACTS;

/// The kinds of durations: their key in a log, their name, and from when to when they are.
pub const KINDS: [(&str, &str, &str); 5] = [
    ("late_ns", "late", "from when a tick was due until it ran"),
    ("step_ns", "step", "the flight model"),
    ("sent_ns", "to picture", "from when a tick was due to the picture"),
    ("latency_ns", "input to picture", "from the kernel's time of an input to the picture"),
    ("record_ns", "hand-over", "to the log's writer"),
];

/// Whether these facts are how a flight kept time.
pub fn is_timing(name: &str) -> bool {
    name == TIMING_FACTS
}

/// Says how the flight kept time: counts, and percentiles of the histograms.
pub fn say(facts: &BTreeMap<String, String>) {
    for (key, name, what) in KINDS {
        let Some(steps) = facts.get(key).and_then(|text| steps(text)) else { continue };
        if let Some([p50, p99, p999, max]) = percentiles(&steps) {
            say!(
                "  {name:<16} p50 {p50:.3} ms, p99 {p99:.3}, p99.9 {p999:.3}, max {max:.3} ms: {what}"
            );
        }
    }
    let count = |key: &str| facts.get(key).map_or("0", String::as_str);
    // The first step of a histogram ends at 1 ns: as fast as it goes, no tick is ever late.
    let longest_late = facts.get("late_ns").and_then(|text| steps(text)?.last().map(|(ns, _)| *ns));
    let waited = longest_late.is_none_or(|ns| ns > 1);
    say!(
        "  {:<16} {} overruns, {} slips, {} events without a time of the kernel's, {} with one that cannot be",
        if waited { "in real time" } else { "not in real time" },
        count("overruns"),
        count("slips"),
        count("synthetic_events"),
        count("implausible_events")
    );
}

/// A histogram: the greatest duration of each step in ns, and how many there were.
pub fn steps(text: &str) -> Option<Vec<(u64, u64)>> {
    let step = |step: &str| {
        let (ns, count) = step.split_once(':')?;
        Some((ns.parse().ok()?, count.parse().ok()?))
    };
    text.split_whitespace().map(step).collect()
}

/// p50, p99, p99.9 and the longest, ms.
pub fn percentiles(steps: &[(u64, u64)]) -> Option<[f64; 4]> {
    let all: u64 = steps.iter().try_fold(0_u64, |sum, (_, count)| sum.checked_add(*count))?;
    let (longest_ns, _) = steps.last()?;
    let at = |part: f64| {
        let rank = (part * all as f64).ceil() as u64;
        let mut seen = 0;
        let found = steps.iter().find(|(_, count)| {
            seen += count;
            seen >= rank
        });
        found.map_or(*longest_ns, |(ns, _)| *ns) as f64 * 1e-6
    };
    Some([at(0.5), at(0.99), at(0.999), *longest_ns as f64 * 1e-6])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_come_out_of_the_text() {
        let steps = steps("1000000:500 2000000:490 3000000:9 40000000:1").unwrap();
        assert_eq!(percentiles(&steps), Some([1.0, 2.0, 3.0, 40.0]));
        assert_eq!(percentiles(&[]), None);
        assert!(super::steps("1:2 x").is_none());
    }
}
