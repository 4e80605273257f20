//! A prepared flight being flown, with the panel or with a line of progress.

use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use anyhow::Result;
use engine::{Aircraft, STEP_S};
use indicatif::{ProgressBar, ProgressStyle};
use recorder::{Landing, Progress, Restart, Snapshot, check_clock, fly};

use super::live::beside;
use super::plan::Plan;
use super::progress::{Punctual, is_new, line, warnings};
use crate::controls;
use crate::panel::{Cockpit, Panel};

/// How long the clock is tried before a flight with the panel.
const CLOCK_CHECK: Duration = Duration::from_millis(500);

impl Plan {
    /// Flies with the panel, or with a line of progress on a terminal.
    pub fn fly(self) -> Result<Landing> {
        if self.panel {
            return self.fly_with_panel();
        }
        let progress = Progress::default();
        progress.stop_on_signals()?;
        let bar = ProgressBar::new_spinner();
        bar.set_style(ProgressStyle::with_template("{spinner} {msg}")?);
        let Self { flight, pipe: _pipe, phases, names, live, .. } = self;
        let real_time = flight.real_time.is_some();
        let live = live.map(|live| live.ready(&flight, &progress));
        let flown = || {
            thread::scope(|scope| {
                let flying = scope.spawn(|| fly(flight, &progress));
                let mut told = Snapshot::default();
                let mut punctual = Punctual::default();
                while !flying.is_finished() {
                    thread::sleep(Duration::from_millis(100));
                    let now = progress.now();
                    if let Some(warning) = progress.shown().and_then(|shown| punctual.look(&shown))
                    {
                        bar.suspend(|| complain!("WARNING: {warning}"));
                    }
                    bar.set_message(line(&now, &phases));
                    bar.tick();
                    // As fast as it goes, nobody could act on it.
                    for event in progress.told().iter().filter(|event| real_time && is_new(event)) {
                        let at_s = event.tick as f64 * STEP_S;
                        bar.suspend(|| complain!("{at_s:.1} s: {}", event.words));
                    }
                    for warning in warnings(&told, &now) {
                        bar.suspend(|| complain!("WARNING: {warning}"));
                    }
                    for line in names.lines(&told, &now) {
                        bar.suspend(|| complain!("{line}"));
                    }
                    told = now;
                }
                flying.join()
            })
        };
        let landing = beside(live, &progress, flown);
        bar.finish_and_clear();
        let landing = landing.map_err(|_| anyhow::anyhow!("the flight died of a fault of ours"))?;
        Ok(landing?)
    }

    /// Flies with the panel.
    fn fly_with_panel(self) -> Result<Landing> {
        let progress = Progress::default();
        progress.stop_on_signals()?;
        let Self { flight, pipe: _pipe, phases, orders, names, live, .. } = self;
        let live = live.map(|live| live.ready(&flight, &progress));
        let verdict = flight
            .real_time
            .map_or_else(String::new, |wanted| check_clock(wanted, CLOCK_CHECK).verdict());
        complain!("{verdict}");
        let aircraft = flight.aircraft.clone();
        let cockpit = Cockpit {
            log: flight.out.display().to_string(),
            aircraft: aircraft.name.clone(),
            envelope: aircraft.envelope.clone(),
            phases,
            verdict,
            controls: controls::lines(&aircraft.cockpit, names.names()),
            keys_fly: orders.is_some(),
        };
        let panel = Panel {
            cockpit,
            orders,
            situation: flight.situation,
            start: Box::new(move |place| {
                let (name, _, text) = aircraft::STARTS.get(place)?;
                Some(reposition(name, text, &aircraft))
            }),
        };
        let flown = || {
            thread::scope(|scope| {
                let flying = scope.spawn(|| fly(flight, &progress));
                let told = panel.show(&progress, || !flying.is_finished());
                if told.is_err() {
                    // Without its panel a flight by hand cannot go on.
                    progress.stop.store(true, Ordering::Relaxed);
                }
                (flying.join(), told)
            })
        };
        let (landing, told) = beside(live, &progress, flown);
        for told in told? {
            complain!("{:.1} s: {}", told.tick as f64 * STEP_S, told.words);
        }
        let landing = landing.map_err(|_| anyhow::anyhow!("the flight died of a fault of ours"))?;
        Ok(landing?)
    }
}

/// The state of a start position, to go on from.
fn reposition(name: &str, text: &str, aircraft: &Aircraft) -> Result<Restart> {
    let start = aircraft::start(name, text)?;
    Ok(Restart::Reposition(analysis::start::state_at(&start, aircraft)?))
}
