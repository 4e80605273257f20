//! The ground under the wheels: flat, or FlightGear's.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use engine::start::Start;
use engine::{Aircraft, observe};
use flightgear::{Hold, Lamps, Link, Picture, Receiver, Scene};
use recorder::{Progress, ground};

/// Whose ground the wheels stand on.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Whose {
    /// FlightGear's, when it tells of it within two seconds before a flight in real time; else flat
    #[default]
    Auto,
    /// FlightGear's: the flight waits for it
    Flightgear,
    /// Flat, as the scenario has it
    Flat,
}

/// For how long a FlightGear that nobody insists on may be silent.
const SILENT: Duration = Duration::from_secs(2);
/// For how long scenery may take to be loaded.
const LOADING: Duration = Duration::from_secs(120);
/// So many samples have to agree.
const SAMPLES: u32 = 5;
/// So well, m.
const AGREED_M: f64 = 0.02;

/// Shows FlightGear where the flight begins until it tells the ground there: that under the main wheels, m
/// above its sea level; `None` where it does not and need not.
///
/// # Errors
/// When it has to and does not.
pub fn found(
    whose: Whose,
    aircraft: &Aircraft,
    start: &Start,
    link: Link,
    receiver: &Receiver,
) -> Result<(Link, Option<f64>)> {
    let world = start.world.world();
    let state = analysis::start::state_at(start, aircraft)?;
    let outputs = observe(aircraft, &state, &world);
    let lamps = Lamps::default();
    let picture = Picture::of(&Scene { aircraft, outputs: &outputs, world: &world, lamps });
    let mut link = link;
    for _ in 0..2 {
        link.send(&picture);
    }
    if link.nobody_listens() && whose == Whose::Auto {
        link.count_anew();
        return Ok((link, None));
    }
    let stop = Progress::default();
    stop.stop_on_signals()?;
    let hold = Hold::start(link, picture);
    let began = Instant::now();
    let (mut last, mut agreed, mut told) = ((0, f64::NAN), 0, false);
    let ground_m = loop {
        let newest = receiver.newest().filter(|(_, age)| *age < SILENT).map(|(report, _)| report);
        if let Some(report) = &newest
            && let Some(height_m) = ground::at_place(report, &outputs.place)
            && let Some(sample) = report.ground.filter(|sample| sample.number != last.0)
        {
            agreed = if (height_m - last.1).abs() < AGREED_M { agreed + 1 } else { 0 };
            last = (sample.number, height_m);
            if agreed >= SAMPLES {
                break Some(height_m);
            }
        }
        let patience = if whose == Whose::Auto && newest.is_none() { SILENT } else { LOADING };
        if stop.stop.load(Ordering::Relaxed) {
            bail!("ended before the flight began");
        }
        if began.elapsed() > patience {
            break None;
        }
        if newest.is_some() && began.elapsed() > SILENT && !std::mem::replace(&mut told, true) {
            complain!("FlightGear is there: waiting for its scenery where the flight begins");
        }
        thread::sleep(Duration::from_millis(10));
    };
    let Some(mut link) = hold.stop() else { bail!("the thread to FlightGear died") };
    link.count_anew();
    if ground_m.is_none() && whose == Whose::Flightgear {
        let (reports, refused) = receiver.counts();
        bail!(
            "--ground flightgear: FlightGear does not tell the ground where the flight begins ({reports} \
             reports and {refused} other packets came to port {}): is it started as `tiltrotor flightgear \
             --print` says, and is there scenery?",
            receiver.port()
        );
    }
    Ok((link, ground_m))
}

/// The hand that keeps the ground under the wheels.
pub fn hand(receiver: &Arc<Receiver>, start: &Start, aircraft: &Aircraft) -> ground::Ground {
    ground::Ground::new(Arc::clone(receiver), start.origin, aircraft)
}

/// A scenario whose origin lies at that height; comments do not survive.
///
/// # Errors
/// When it is no scenario.
pub fn scenario_at(scenario_toml: &str, height_m: f64) -> Result<String> {
    let mut scenario: toml::Table = scenario_toml.parse()?;
    let origin = scenario.get_mut("origin").and_then(toml::Value::as_table_mut);
    let Some(origin) = origin else { bail!("the scenario has no [origin]") };
    origin.retain(|key, _| !key.starts_with("height"));
    origin.insert("height_m".into(), height_m.into());
    Ok(toml::to_string(&scenario)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scenario_is_lifted_and_nothing_else_of_it_changes() {
        let before = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).expect("ours");
        let lifted = scenario_at(aircraft::DEFAULT_SCENARIO, 17.25).expect("a scenario");
        let after = aircraft::start("lifted.toml", &lifted).expect("still one");
        assert!((after.origin.height_m - 17.25).abs() < 1e-12);
        let mut same = after.clone();
        same.origin.height_m = before.origin.height_m;
        assert_eq!(same, before);
    }
}
