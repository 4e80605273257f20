//! What is told of a flight while it is flown without the panel.

use engine::STEP_S;
use engine::units::compass_deg;
use logs::records::FlightEvent;
use logs::view::Level;
use recorder::{Shown, Snapshot, Told};

use crate::report;

/// Where the flight is, in a line.
pub fn line(now: &Snapshot, phases: &[&str]) -> String {
    // Phases count from 1; 0 is before the first.
    let phase = usize::try_from(now.phase)
        .ok()
        .and_then(|number| phases.get(number.checked_sub(1)?).copied());
    format!(
        "{:6.1} s  height {:6.1} m  speed {:5.1} kt  heading {:03.0}°  {} late  {}",
        now.tick as f64 * STEP_S,
        now.height_m,
        engine::units::knots(now.airspeed_mps),
        compass_deg(now.heading_rad),
        now.overruns,
        phase.unwrap_or("")
    )
}

/// Whether an event is for the crew, and is told nowhere else.
pub fn is_new(event: &Told) -> bool {
    let elsewhere = [FlightEvent::Slip, FlightEvent::SelfCheck, FlightEvent::GaveUp];
    event.level != Level::Info && !elsewhere.contains(&event.what)
}

/// Ticks between two warnings of lateness: ten seconds.
const LATE_AGAIN_TICKS: u64 = 2500;

/// Lateness, told when it begins and not again for a while.
#[derive(Default)]
pub struct Punctual {
    told_tick: Option<u64>,
}

impl Punctual {
    /// What is to be told of the last second.
    pub fn look(&mut self, shown: &Shown) -> Option<String> {
        let tick = shown.outputs.tick;
        let ms = |ns: u64| ns as f64 * 1e-6;
        let (late_ms, latency_ms) = (ms(shown.late_ns), ms(shown.latency_ns));
        let limit_ms = report::LATENCY_LIMIT_MS;
        if self.told_tick.is_some_and(|told| tick < told + LATE_AGAIN_TICKS) {
            return None;
        }
        let warning = if latency_ms > limit_ms {
            format!(
                "an input needed {latency_ms:.0} ms to the picture; {limit_ms:.0} ms are the limit of a \
                 simulator"
            )
        } else if late_ms > STEP_S * 1e3 {
            format!(
                "ticks up to {late_ms:.1} ms late within a second; `tiltrotor doctor` says what to change"
            )
        } else {
            return None;
        };
        self.told_tick = Some(tick);
        Some(warning)
    }
}

/// What the crew is to know, and has not been told.
pub fn warnings(told: &Snapshot, now: &Snapshot) -> Vec<String> {
    let mut warnings = Vec::new();
    if now.slips > told.slips {
        let slip_s = now.slipped_s - told.slipped_s;
        warnings.push(format!(
            "the clock slipped by {slip_s:.1} s: the process stood still, and so did the flight"
        ));
    }
    if now.mismatches > 0 && told.mismatches == 0 {
        warnings.push(
            "the flight is not the same when reflown: do not trust this machine, or report this; the \
             log says where"
                .into(),
        );
    }
    if now.log_failed && !told.log_failed {
        warnings.push("the log cannot be written any further; flying on".into());
    }
    warnings
}
