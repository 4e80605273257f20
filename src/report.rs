//! What a flight prints when it is over.

use engine::STEP_S;
use logs::LogError;
use logs::text::size;
use recorder::statistics::Durations;
use recorder::{End, Landing};
use replay::ReplayError;

use crate::link_args;

/// Why a log is not reflown, and what can be done about it.
pub fn refusal(error: &ReplayError) -> String {
    match error {
        ReplayError::Log(LogError::Version { what: "flight model", .. }) => {
            format!("{error}; --across-versions flies it for comparison")
        }
        _ => error.to_string(),
    }
}

/// Latency beyond which CS-FSTD(A) refuses a simulator.
pub const LATENCY_LIMIT_MS: f64 = 150.0;

/// Sums up a flight on standard output.
pub fn landing(landing: &Landing, real_time: bool, out: &str) {
    let flown = &landing.statistics;
    say!(
        "flown      {:.1} s, {} ticks of {:.0} ms, {} device events",
        flown.ticks as f64 * STEP_S,
        flown.ticks,
        STEP_S * 1e3,
        landing.events
    );
    if real_time {
        say!("overruns   {} ticks ended after the next one was due", flown.overruns);
        line("late by", &flown.late, "from when a tick was due until it ran");
    }
    if flown.slips > 0 {
        say!(
            "slips      the clock slipped {} times, {:.3} s at most, {:.3} s in all: the process stood \
             still, and so did the flight",
            flown.slips,
            flown.slip_ns_max as f64 * 1e-9,
            flown.slip_ns as f64 * 1e-9
        );
    }
    if flown.implausible_events > 0 {
        say!(
            "inputs     {} device events had a time that cannot be, and are not part of the latency",
            flown.implausible_events
        );
    }
    line("step", &flown.step, "the flight model");
    line("hand-over", &flown.record, "to the log's writer");
    // Without a packet there is no picture that could be late.
    let pictures = landing.pictures.iter().any(|way| way.sent > 0);
    if pictures {
        line("to picture", &flown.sent, "from when a tick was due to the packet for FlightGear");
    }
    if pictures && flown.latency.count() > 0 {
        line("latency", &flown.latency, "from the kernel's time of an input to the packet");
        say!(
            "           (limit of CS-FSTD(A): {LATENCY_LIMIT_MS} ms; the paper: 2.5 to 5 ms, peaks of \
             40 ms)"
        );
    }
    for words in link_args::in_words(&landing.pictures) {
        say!("FlightGear {words}");
    }
    match &landing.log {
        Ok(closed) => say!(
            "log        {out}, {} ({:.0} B a tick), digest {:016x}, nothing dropped",
            size(closed.bytes),
            closed.bytes as f64 / flown.ticks.max(1) as f64,
            closed.digest
        ),
        Err(error) => {
            say!("log        {out} ends before the flight did: {error}");
            say!(
                "           `tiltrotor log recover {out} --out FIXED` makes a whole log of what there is"
            );
        }
    }
    if let Some(older) = &landing.set_aside {
        say!("           the log that was there before is kept as {}", older.display());
    }
    beside_the_flight(landing);
    say!("debrief    {}", landing.debrief);
    if !matches!(landing.end, End::Done | End::TimeUp) {
        say!("end        {}", landing.end);
    }
    for refused in &landing.refused {
        say!("note       {refused}");
    }
}

/// What the threads beside the loop met: the log's writer, and the self-check.
fn beside_the_flight(landing: &Landing) {
    if landing.delay.times > 0 {
        say!(
            "writer     held up {} times, {:.1} s at most; at most {} entries waited, none was lost",
            landing.delay.times,
            landing.delay.longest.as_secs_f64(),
            landing.backlog_max
        );
    }
    if let Some(checked) = &landing.checked {
        say!(
            "self-check {} of {} ticks reflown in flight, {} mismatches, {} ticks dropped; {:.3} s of \
             a spare thread",
            checked.ticks,
            landing.statistics.ticks,
            checked.mismatches,
            checked.dropped,
            checked.busy.as_secs_f64()
        );
        line("", &checked.hand_over, "what it cost the loop");
    }
}

fn line(name: &str, durations: &Durations, what: &str) {
    say!(
        "{name:<10} p50 {:.3} ms, p99 {:.3}, p99.9 {:.3}, max {:.3} ms: {what}",
        durations.percentile_ms(50.0),
        durations.percentile_ms(99.0),
        durations.percentile_ms(99.9),
        durations.longest_ms()
    );
}
