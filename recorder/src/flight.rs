//! A flight to be flown.

use std::path::PathBuf;

use engine::Aircraft;
use engine::start::Start;
use flightgear::Link;
use logs::{Identity, LogError, Setup};

use crate::clock::RealTime;
use crate::controller::Controller;
use crate::restart::Situation;

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
    pub controllers: Vec<Box<dyn Controller>>,
    /// Devices that deliver events of their own.
    #[cfg(feature = "sticks")]
    pub sticks: Option<crate::devices::Devices>,
    /// The log.
    pub out: PathBuf,
    /// Whether an existing log may be overwritten.
    pub force: bool,
    /// How it keeps real time; without it, as fast as it goes.
    pub real_time: Option<RealTime>,
    /// What it begins with in place of its start.
    pub situation: Option<Situation>,
    /// Ticks after which the flight ends by itself.
    pub ticks_max: Option<u64>,
    /// FlightGear.
    pub link: Option<Link>,
    /// Whether a spare thread reflies what is flown while it is flown.
    pub self_check: bool,
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

#[cfg(test)]
mod tests {
    use engine::{Inputs, Outputs, State, step};
    use logs::OpenOptions;
    use logs::records::FlightEvent;

    use super::*;
    use crate::landing::Landing;
    use crate::live::Live;
    use crate::progress::{Progress, Snapshot};

    /// Two seconds on the ground by a loop whose step flips a bit of the state after `upset_tick`, as
    /// failing memory would; returns the log and what the crew saw.
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
            controllers: Vec::new(),
            #[cfg(feature = "sticks")]
            sticks: None,
            out: out.clone(),
            force: true,
            real_time: None,
            situation: None,
            ticks_max: Some(500),
            link: None,
            self_check: true,
        };
        let progress = Progress::default();
        let upset = |aircraft: &Aircraft, state: &State, inputs: &Inputs| -> (State, Outputs) {
            let (mut state, outputs) = step(aircraft, state, inputs);
            if upset_tick == Some(state.tick) {
                state.plant.fuel_kg = f64::from_bits(state.plant.fuel_kg.to_bits() ^ 1);
            }
            (state, outputs)
        };
        let landing = Live::begin(flight, &progress, upset).unwrap().fly();
        (out, landing, progress.now())
    }

    fn self_checks(log: &std::path::Path) -> Vec<(u64, u64, String)> {
        let mut reader = logs::open(log, OpenOptions::default()).unwrap();
        while reader.next_tick().unwrap().is_some() {}
        let words = reader.log_lines.iter().filter(|line| line.words.contains("self-check"));
        let mut words = words.map(|line| line.words.clone());
        let events = reader.events.iter();
        events
            .filter(|event| event.kind == FlightEvent::SelfCheck as u64)
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
