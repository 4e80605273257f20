//! What an engineer reads of a flight: what happened, the greatest values and when, how it touched down,
//! where it ended.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use engine::math::{max, sqrt, square};
use engine::units::{
    DEG_PER_RAD as DEG, FPM_PER_MPS as FPM, KT_PER_MPS as KT, RPM_PER_RADPS, compass_deg,
};
use engine::{Outputs, STEP_S, State};
use logs::view::LogLine;

use crate::judgement::{Facts, Judgement, Outcome, disorder};
use crate::refly::{Reflight, ReflyOptions, ReplayError, Window};

/// Names of the extremes, their units, and how they are read off.
type Reading = (&'static str, &'static str, fn(&Outputs) -> f64);

const READINGS: [Reading; 11] = [
    ("height", "m", |o| o.height_above_ground_m),
    ("true airspeed", "kt", |o| o.airspeed_mps * KT),
    ("climb", "ft/min", |o| -o.velocity_mps.z * FPM),
    ("load factor", "g", |o| o.load_factor),
    ("roll", "deg", |o| o.euler.roll_rad * DEG),
    ("pitch", "deg", |o| o.euler.pitch_rad * DEG),
    ("yaw rate", "deg/s", |o| o.angular_rate_radps.z * DEG),
    ("nacelle", "deg", |o| 90.0 - o.actuators.mast_tilt_rad.mean() * DEG),
    ("rotor speed", "rpm", |o| o.rotor_speed_radps * RPM_PER_RADPS),
    ("power", "kW", |o| o.engines.power_w.sum() * 1e-3),
    ("flapping", "deg", |o| {
        let tilt = o.rotors.map(|r| sqrt(square(r.tilt_aft_rad) + square(r.tilt_outboard_rad)));
        max(tilt.left, tilt.right) * DEG
    }),
];

/// A value, and its tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    /// Tick.
    pub tick: u64,
    /// Value.
    pub value: f64,
}

/// The wheels took weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touchdown {
    /// Tick.
    pub tick: u64,
    /// Downwards, just before.
    pub sink_mps: f64,
    /// Over the ground.
    pub speed_mps: f64,
    /// From the origin.
    pub north_m: f64,
    /// From the origin.
    pub east_m: f64,
}

/// Gathers what is read of a flight, tick by tick.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    extremes: Vec<(At, At)>,
    /// Each time the wheels took weight.
    pub touchdowns: Vec<Touchdown>,
    before: Option<State>,
}

impl Gathered {
    /// Begins with a state.
    pub fn from(initial: &State) -> Self {
        Self { before: Some(*initial), ..Self::default() }
    }

    /// Goes on from another state: that it stands on the ground is no touchdown.
    pub fn restart(&mut self, state: &State) {
        self.before = Some(*state);
    }

    /// Least and greatest value of everything that is read: its name, its unit, both.
    pub fn extremes(&self) -> impl Iterator<Item = (&'static str, &'static str, At, At)> {
        let read = READINGS.iter().zip(&self.extremes);
        read.map(|((name, unit, _), (least, greatest))| (*name, *unit, *least, *greatest))
    }

    /// Adds a tick.
    pub fn add(&mut self, state: &State, outputs: &Outputs) {
        let first = self.extremes.is_empty();
        for (number, (_, _, read)) in READINGS.iter().enumerate() {
            let at = At { tick: outputs.tick, value: read(outputs) };
            if first {
                self.extremes.push((at, at));
                continue;
            }
            let (least, greatest) = &mut self.extremes[number];
            if at.value < least.value {
                *least = at;
            }
            if at.value > greatest.value {
                *greatest = at;
            }
        }
        if let Some(before) = self.before.replace(*state)
            && before.plant.weight_on_wheels == 0
            && state.plant.weight_on_wheels != 0
        {
            let (at, was) = (&state.plant, &before.plant);
            self.touchdowns.push(Touchdown {
                tick: state.tick,
                sink_mps: was.velocity_mps.z,
                speed_mps: sqrt(square(was.velocity_mps.x) + square(was.velocity_mps.y)),
                north_m: at.position_m.x,
                east_m: at.position_m.y,
            });
        }
    }
}

/// What is read of a flight.
#[derive(Clone, Debug)]
pub struct Summary {
    /// First tick.
    pub first_tick: u64,
    /// Last state.
    pub last: State,
    /// What happened, in words.
    pub log_lines: Vec<LogLine>,
    /// Greatest and least values, touchdowns.
    pub gathered: Gathered,
    /// Last digest.
    pub digest: u64,
    /// Other facts of the log: name, keys and values.
    pub facts: Vec<(String, BTreeMap<String, String>)>,
    /// What the log is.
    pub judgement: Judgement,
}

/// Reflies a log, or a part of it, and sums it up.
///
/// # Errors
/// When it cannot be reflown.
pub fn summary(log: &Path, window: &Window) -> Result<Summary, ReplayError> {
    let options = ReflyOptions { window: *window, across_versions: false };
    let mut flight = Reflight::open(log, &options)?;
    let mut gathered = Gathered::from(&flight.state);
    let mut facts = Facts::of_reflight(&flight);
    let first_tick = flight.state.tick;
    let disorder = loop {
        match flight.next_tick() {
            Ok(Some(reflown)) => {
                if let Some(restart) = &reflown.recorded.restart {
                    gathered.restart(&restart.state);
                }
                gathered.add(reflown.state, reflown.outputs);
                facts.add(reflown.recorded, Some(reflown.exact));
                flight.reader.timings.clear();
            }
            Ok(None) => break None,
            Err(error) => break Some(disorder(error)?),
        }
    };
    facts.end_of_reflight(&mut flight, disorder, window);
    let log_lines = std::mem::take(&mut flight.reader.log_lines);
    let digest = flight.reader.digest();
    Ok(Summary {
        first_tick,
        last: flight.state,
        log_lines,
        gathered,
        digest,
        facts: std::mem::take(&mut flight.reader.other_facts),
        judgement: facts.judge(),
    })
}

fn s(tick: u64) -> f64 {
    tick as f64 * STEP_S
}

/// To a thousandth, and never as −0.
fn shown(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ticks = self.last.tick - self.first_tick;
        let (from, to) = (s(self.first_tick), s(self.last.tick));
        writeln!(f, "{ticks} ticks, {from:.3} s to {to:.3} s")?;
        for line in &self.log_lines {
            writeln!(f, "{:>10.3} s  {}", line.time_ns as f64 * 1e-9, line.words)?;
        }
        for (name, unit, least, greatest) in self.gathered.extremes() {
            writeln!(
                f,
                "{name:<14} {:>10.3} {unit} at {:.3} s to {:.3} {unit} at {:.3} s",
                shown(least.value),
                s(least.tick),
                shown(greatest.value),
                s(greatest.tick)
            )?;
        }
        for touchdown in &self.gathered.touchdowns {
            writeln!(f, "touchdown      {touchdown}")?;
        }
        let at = &self.last.plant;
        let euler = at.attitude.euler();
        writeln!(
            f,
            "at the end     {:.3} m north, {:.3} m east, {:.3} m up; roll {:.3} deg, pitch {:.3} deg, \
             heading {:.3} deg; fuel {:.3} kg",
            shown(at.position_m.x),
            shown(at.position_m.y),
            shown(-at.position_m.z),
            shown(euler.roll_rad * DEG),
            shown(euler.pitch_rad * DEG),
            compass_deg(euler.heading_rad),
            at.fuel_kg
        )?;
        write!(f, "digest         {:016x}, ", self.digest)?;
        match self.judgement.outcome {
            Outcome::Exact => write!(f, "exact"),
            _ => write!(f, "{}; `tiltrotor verify` says more", self.judgement),
        }
    }
}

impl fmt::Display for Touchdown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "at {:.3} s, sinking {:.3} m/s, {:.3} m/s over the ground, {:.2} m north, {:.2} m east",
            s(self.tick),
            self.sink_mps,
            self.speed_mps,
            self.north_m,
            self.east_m
        )
    }
}

#[cfg(test)]
mod tests {
    use engine::frames::Vec3;

    use super::*;

    #[test]
    fn a_touchdown_is_the_first_weight_on_any_wheel_and_has_the_speed_of_the_tick_before() {
        let mut state = State::default();
        state.plant.weight_on_wheels = 0b111;
        let mut gathered = Gathered::from(&state);
        let mut fly = |tick: u64, wheels: u64, down_mps: f64| {
            state.tick = tick;
            state.plant.weight_on_wheels = wheels;
            state.plant.velocity_mps = Vec3::new(3.0, 4.0, down_mps);
            state.plant.position_m.x = tick as f64;
            gathered.add(&state, &Outputs { tick, load_factor: down_mps, ..Outputs::default() });
        };
        fly(1, 0b111, 0.0);
        fly(2, 0b001, -0.5);
        fly(3, 0, -1.0);
        fly(4, 0, 1.2);
        fly(5, 0b010, 0.4);
        fly(6, 0b110, 0.1);
        fly(7, 0, -0.2);
        fly(8, 0b111, 0.0);
        let touched: Vec<_> = gathered
            .touchdowns
            .iter()
            .map(|down| (down.tick, down.sink_mps, down.speed_mps, down.north_m))
            .collect();
        assert_eq!(touched, [(5, 1.2, 5.0, 5.0), (8, -0.2, 5.0, 8.0)]);
        let load = gathered.extremes().find(|(name, ..)| *name == "load factor").expect("a load");
        let (least, greatest) = (At { tick: 3, value: -1.0 }, At { tick: 4, value: 1.2 });
        assert_eq!(load, ("load factor", "g", least, greatest));
    }

    #[test]
    fn an_exact_flight_is_called_so_and_another_told_in_words() {
        let of = |outcome| {
            let words = "altered at tick 7".to_string();
            let judgement = Judgement { outcome, first_bad_tick: None, words };
            let (last, gathered) = (State::default(), Gathered::default());
            let (log_lines, facts) = (Vec::new(), Vec::new());
            let summary =
                Summary { first_tick: 0, last, log_lines, gathered, digest: 0xf, facts, judgement };
            summary.to_string()
        };
        assert!(of(Outcome::Exact).ends_with("digest         000000000000000f, exact"));
        assert!(
            of(Outcome::Altered).ends_with(", altered at tick 7; `tiltrotor verify` says more")
        );
    }

    #[test]
    fn whoever_goes_on_from_the_ground_has_not_touched_down() {
        let (flying, mut standing) = (State::default(), State::default());
        standing.plant.weight_on_wheels = 1;
        let mut gathered = Gathered::from(&flying);
        gathered.restart(&standing);
        gathered.add(&standing, &Outputs::default());
        assert_eq!(gathered.touchdowns.len(), 0);
    }
}
