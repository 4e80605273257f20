//! What figures are drawn from: rows of numbers, times of ticks, and what happened.

use std::path::Path;

use engine::aircraft::Params as Aircraft;
use engine::envelope::{Corridor, is_clear_of_ground};
use engine::frames::{Ned, Vec3};
use engine::math::{TAU, max, wrap_angle};
use engine::pair::Pair;
use engine::units::degrees;
use engine::{Outputs, STEP_NS, STEP_S};
use logs::FlightReader;
use logs::records::{FlightEvent, TimingRecord};
use logs::view::Level;

use crate::judgement::{Judgement, Outcome};

/// Of this many ticks one is a row: 50 Hz.
const TICKS_PER_ROW: u64 = 5;
const ROW_S: f64 = TICKS_PER_ROW as f64 * STEP_S;
/// So many moments are numbered in a figure.
const MOMENTS_MAX: usize = 16;

/// How the nacelles stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Configuration {
    /// Up.
    Helicopter,
    /// Between.
    Converting,
    /// On the down stop.
    Aeroplane,
}

impl Configuration {
    /// That of a nacelle incidence, deg: 90 as a helicopter.
    fn of(incidence_deg: f64) -> Self {
        match incidence_deg {
            incidence_deg if incidence_deg > 85.0 => Self::Helicopter,
            incidence_deg if incidence_deg > 1.0 => Self::Converting,
            _ => Self::Aeroplane,
        }
    }

    /// In a word.
    pub fn words(self) -> &'static str {
        match self {
            Self::Helicopter => "helicopter",
            Self::Converting => "conversion",
            Self::Aeroplane => "aeroplane",
        }
    }
}

/// What is drawn of a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Since the beginning of the flight.
    pub time_s: f64,
    /// From the origin.
    pub position_m: Vec3<Ned>,
    /// Centre of gravity over the ground.
    pub height_m: f64,
    /// Over the ground.
    pub velocity_mps: Vec3<Ned>,
    /// φ, θ.
    pub roll_rad: f64,
    /// θ.
    pub pitch_rad: f64,
    /// ψ without jumps: beyond a whole turn it goes on.
    pub heading_rad: f64,
    /// True airspeed.
    pub airspeed_mps: f64,
    /// Calibrated airspeed.
    pub calibrated_airspeed_mps: f64,
    /// n.
    pub load_factor: f64,
    /// 90 as a helicopter.
    pub incidence_deg: f64,
    /// Aft.
    pub stick_aft_norm: f64,
    /// Right.
    pub stick_right_norm: f64,
    /// Right.
    pub pedal_right_norm: f64,
    /// Power lever.
    pub lever_norm: f64,
    /// δe, trailing edge down.
    pub elevator_rad: f64,
    /// δf, down.
    pub flap_rad: f64,
    /// θ¾.
    pub collective_rad: Pair<f64>,
    /// T.
    pub thrust_n: Pair<f64>,
    /// Q.
    pub torque_n_m: Pair<f64>,
    /// a1.
    pub flapping_aft_rad: Pair<f64>,
    /// Ω.
    pub rotor_speed_radps: f64,
    /// Of each engine.
    pub power_w: Pair<f64>,
    /// Whether the corridor is asked for.
    pub flying: bool,
}

impl Row {
    fn of(outputs: &Outputs, heading_rad: f64) -> Self {
        let (o, cockpit, actuators) = (outputs, &outputs.cockpit, &outputs.actuators);
        Self {
            time_s: o.tick as f64 * STEP_S,
            position_m: o.position_m,
            height_m: o.height_above_ground_m,
            velocity_mps: o.velocity_mps,
            roll_rad: o.euler.roll_rad,
            pitch_rad: o.euler.pitch_rad,
            heading_rad,
            airspeed_mps: o.airspeed_mps,
            calibrated_airspeed_mps: o.calibrated_airspeed_mps,
            load_factor: o.load_factor,
            incidence_deg: 90.0 - degrees(actuators.mast_tilt_rad.mean()),
            stick_aft_norm: cockpit.stick_aft_norm,
            stick_right_norm: cockpit.stick_right_norm,
            pedal_right_norm: cockpit.pedal_right_norm,
            lever_norm: cockpit.collective_norm,
            elevator_rad: actuators.elevator_rad,
            flap_rad: actuators.flap_rad,
            collective_rad: actuators.collective_rad,
            thrust_n: o.rotors.map(|rotor| rotor.thrust_n),
            torque_n_m: o.rotors.map(|rotor| rotor.torque_n_m),
            flapping_aft_rad: o.rotors.map(|rotor| rotor.tilt_aft_rad),
            rotor_speed_radps: o.rotor_speed_radps,
            power_w: o.engines.power_w,
            flying: is_clear_of_ground(o),
        }
    }

    /// How the nacelles stand.
    pub fn configuration(&self) -> Configuration {
        Configuration::of(self.incidence_deg)
    }
}

/// How a tick kept time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepTime {
    /// Which.
    pub tick: u64,
    /// From when it was due until its picture was on its way: lateness included.
    pub sent_ns: u64,
    /// The step alone.
    pub step_ns: u64,
    /// From the kernel's time of its oldest device event until the picture was on its way; 0 without one.
    pub latency_ns: u64,
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Happened {
    /// When.
    pub tick: u64,
    /// What, where it is known.
    pub what: Option<FlightEvent>,
    /// How grave.
    pub level: Level,
    /// In words.
    pub words: String,
}

impl Happened {
    /// The part of the words that a figure has room for.
    pub fn short(&self) -> &str {
        self.words.split([',', ';', '(']).next().unwrap_or_default().trim_end()
    }

    /// How little it matters where there is no room for all; phases of a pilot model tell what is meant to
    /// be done, not what happened.
    fn rank(&self) -> u8 {
        match (self.level, self.what) {
            (Level::Error, _) => 0,
            (_, Some(FlightEvent::Impact | FlightEvent::Failures | FlightEvent::GaveUp)) => 1,
            (_, Some(FlightEvent::WeightOnWheels | FlightEvent::Marker)) => 2,
            (Level::Warn, _) => 3,
            (_, Some(FlightEvent::Phase)) => 5,
            _ => 4,
        }
    }
}

/// A flight, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// What its log is called.
    pub name: String,
    /// What the log is, where it is not exact: no figure is shown without it.
    pub caveat: Option<String>,
    /// Rows, 50 a second.
    pub rows: Vec<Row>,
    /// Times of every tick that the log has them of.
    pub times: Vec<StepTime>,
    /// Whether anything waited for the clock.
    pub in_real_time: bool,
    /// What happened, in order.
    pub happened: Vec<Happened>,
    /// The aircraft's conversion corridor.
    pub corridor: Corridor,
    /// Mast tilts at the stops.
    pub mast_tilt_rad: (f64, f64),
}

impl Flight {
    /// The flight events that are numbered, in order, and how many are not.
    pub fn moments(&self) -> (Vec<&Happened>, usize) {
        let mut order: Vec<usize> = (0..self.happened.len()).collect();
        // Stable: of those that matter alike, the earlier ones.
        order.sort_by_key(|&place| self.happened[place].rank());
        order.truncate(MOMENTS_MAX);
        order.sort_unstable();
        let chosen: Vec<_> = order.into_iter().map(|place| &self.happened[place]).collect();
        let left = self.happened.len() - chosen.len();
        (chosen, left)
    }

    /// When it ended in an impact that nothing is meant to stand, s.
    pub fn crash_s(&self) -> Option<f64> {
        let impact = |happened: &&Happened| {
            happened.what == Some(FlightEvent::Impact) && happened.level == Level::Error
        };
        self.happened.iter().find(impact).map(|happened| happened.tick as f64 * STEP_S)
    }

    /// The row at a tick, or the first one after it.
    pub fn row_at(&self, tick: u64) -> Option<&Row> {
        let time_s = tick as f64 * STEP_S - 0.5 * STEP_S;
        let place = self.rows.partition_point(|row| row.time_s < time_s);
        self.rows.get(place).or(self.rows.last())
    }

    /// From when to when, s.
    pub fn range_s(&self) -> (f64, f64) {
        match (self.rows.first(), self.rows.last()) {
            // Before the first row a flight begins.
            (Some(first), Some(last)) => (max(first.time_s - ROW_S, 0.0), last.time_s),
            _ => (0.0, 0.0),
        }
    }

    /// Stretches of the same configuration: which, and from which row to which.
    pub fn stretches(&self) -> Vec<(Configuration, usize, usize)> {
        let mut stretches: Vec<(Configuration, usize, usize)> = Vec::new();
        for (place, row) in self.rows.iter().enumerate() {
            match stretches.last_mut() {
                Some((known, _, last)) if *known == row.configuration() => *last = place,
                Some((_, _, last)) => {
                    // Up to where the next one begins.
                    *last = place;
                    stretches.push((row.configuration(), place, place));
                }
                None => stretches.push((row.configuration(), place, place)),
            }
        }
        stretches
    }
}

/// Gathers a flight while it is reflown.
pub struct Gatherer {
    pub(super) flight: Flight,
    heading_rad: Option<f64>,
}

impl Gatherer {
    /// Of a log and its aircraft, nothing yet.
    pub fn new(log: &Path, aircraft: &Aircraft) -> Self {
        let name = log.file_name().map_or_else(String::new, |name| name.display().to_string());
        let tilt = &aircraft.actuators;
        let flight = Flight {
            name,
            caveat: None,
            rows: Vec::new(),
            times: Vec::new(),
            in_real_time: false,
            happened: Vec::new(),
            corridor: aircraft.envelope.corridor.clone(),
            mast_tilt_rad: (tilt.mast_tilt_rad_min, tilt.mast_tilt_rad_max),
        };
        Self { flight, heading_rad: None }
    }

    /// Adds what could be observed after a tick.
    pub fn add(&mut self, outputs: &Outputs) {
        let heading_rad = outputs.euler.heading_rad;
        let continued = match self.heading_rad {
            Some(before) => before + wrap_angle(heading_rad - before),
            None => heading_rad.rem_euclid(TAU),
        };
        self.heading_rad = Some(continued);
        if outputs.tick.is_multiple_of(TICKS_PER_ROW) {
            self.flight.rows.push(Row::of(outputs, continued));
        }
    }

    /// Adds how a tick kept time.
    pub fn time(&mut self, timing: &TimingRecord) {
        self.flight.in_real_time |= timing.late_ns > 0;
        self.flight.times.push(StepTime {
            tick: timing.tick,
            // A log may hold any number.
            sent_ns: timing.late_ns.saturating_add(timing.sent_ns),
            step_ns: timing.step_ns,
            latency_ns: timing.latency_ns,
        });
    }

    /// Adds what the log tells in words and what it is, and ends.
    pub fn finish(mut self, reader: &FlightReader, judgement: &Judgement) -> Flight {
        let exact = judgement.outcome == Outcome::Exact;
        self.flight.caveat = (!exact).then(|| judgement.words.clone());
        let told = reader.events.len() == reader.log_lines.len();
        self.flight.happened = reader
            .log_lines
            .iter()
            .enumerate()
            .map(|(place, line)| Happened {
                tick: line.time_ns / STEP_NS,
                // Each event is written with its words behind it.
                what: reader
                    .events
                    .get(place)
                    .filter(|_| told)
                    .and_then(|event| FlightEvent::from_u64(event.kind)),
                level: line.level,
                words: line.words.clone(),
            })
            .collect();
        self.flight
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn happened(tick: u64, what: FlightEvent, level: Level) -> Happened {
        Happened { tick, what: Some(what), level, words: format!("event at {tick}") }
    }

    fn flight() -> Flight {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        Gatherer::new(Path::new("/a/flight.mcap"), &xv15).flight
    }

    #[test]
    fn what_is_grave_is_numbered_however_much_happens() {
        let mut flight = flight();
        flight.happened =
            (0..40).map(|tick| happened(tick, FlightEvent::Phase, Level::Info)).collect();
        flight.happened.push(happened(50, FlightEvent::Impact, Level::Error));
        flight.happened.push(happened(60, FlightEvent::Wind, Level::Info));
        let (moments, left) = flight.moments();
        assert_eq!((moments.len(), left), (MOMENTS_MAX, 42 - MOMENTS_MAX));
        assert!(moments.iter().any(|moment| moment.tick == 50));
        assert!(moments.iter().any(|moment| moment.tick == 60));
        assert!(moments.is_sorted_by_key(|moment| moment.tick));
    }

    #[test]
    fn a_heading_goes_on_beyond_a_whole_turn() {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut gatherer = Gatherer::new(Path::new("flight.mcap"), &xv15);
        for step in 0..100_u32 {
            let mut outputs = Outputs { tick: 5 * u64::from(step), ..Outputs::default() };
            outputs.euler.heading_rad = wrap_angle(0.1 * f64::from(step));
            gatherer.add(&outputs);
        }
        let headings: Vec<_> = gatherer.flight.rows.iter().map(|row| row.heading_rad).collect();
        assert!(headings.is_sorted(), "{headings:?}");
        assert!((headings[99] - 9.9).abs() < 1e-9);
    }

    #[test]
    fn a_figure_has_room_for_the_first_words() {
        let mut told = happened(1, FlightEvent::WeightOnWheels, Level::Info);
        told.words = "lift-off, climbing 0.03 m/s at 0.01 m/s over the ground".into();
        assert_eq!(told.short(), "lift-off");
    }

    /// Rows at these ticks, with the nacelles at an incidence in deg.
    fn rows(ticks: &[(u64, f64)]) -> Vec<Row> {
        let row = |&(tick, incidence_deg): &(u64, f64)| {
            let mut outputs = Outputs { tick, ..Outputs::default() };
            let tilt_rad = engine::units::radians(90.0 - incidence_deg);
            outputs.actuators.mast_tilt_rad = Pair { left: tilt_rad, right: tilt_rad };
            Row::of(&outputs, 0.0)
        };
        ticks.iter().map(row).collect()
    }

    /// A tick takes 4 ms, and a row is one of five: 20 ms.
    #[test]
    fn a_flight_begins_a_row_before_its_first_row_and_ends_with_its_last() {
        let range_s = |ticks: &[(u64, f64)]| Flight { rows: rows(ticks), ..flight() }.range_s();
        let near = |(a, b): (f64, f64), from_s: f64, to_s: f64| {
            assert!((a - from_s).abs() < 1e-9 && (b - to_s).abs() < 1e-9, "{a} to {b} s");
        };
        near(range_s(&[(5, 90.0), (10, 90.0), (15, 90.0)]), 0.0, 0.06);
        near(range_s(&[(250, 90.0), (500, 90.0)]), 0.98, 2.0);
        // None begins before time does.
        near(range_s(&[(0, 90.0)]), 0.0, 0.0);
        near(range_s(&[]), 0.0, 0.0);
    }

    #[test]
    fn the_row_of_a_tick_is_its_own_or_the_next_one() {
        let rows = rows(&[(5, 90.0), (10, 90.0), (15, 90.0)]);
        let flight = Flight { rows, ..flight() };
        let tick_at = |tick| (flight.row_at(tick).expect("a row").time_s / STEP_S).round() as u64;
        assert_eq!([0, 5, 6, 10, 11, 15, 99].map(tick_at), [5, 5, 10, 10, 15, 15, 15]);
        assert!(self::flight().row_at(5).is_none(), "without rows there is none");
    }

    #[test]
    fn a_stretch_of_a_configuration_goes_up_to_where_the_next_begins() {
        use Configuration::{Aeroplane, Converting, Helicopter};
        // A helicopter above 85 deg, an aeroplane on the down stop.
        let ticks = [(5, 90.0), (10, 85.5), (15, 84.5), (20, 1.5), (25, 0.5), (30, 0.0)];
        let flight = Flight { rows: rows(&ticks), ..flight() };
        let expected = [(Helicopter, 0, 2), (Converting, 2, 4), (Aeroplane, 4, 5)];
        assert_eq!(flight.stretches(), expected);
        assert!(self::flight().stretches().is_empty());
    }

    #[test]
    fn a_flight_is_in_real_time_when_anything_waited_for_the_clock() {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut gatherer = Gatherer::new(Path::new("flight.mcap"), &xv15);
        let timing = |tick, late_ns| TimingRecord {
            tick,
            late_ns,
            sent_ns: 300,
            step_ns: 20,
            latency_ns: 7,
            ..TimingRecord::default()
        };
        gatherer.time(&timing(0, 0));
        assert!(!gatherer.flight.in_real_time, "flown as fast as it goes");
        gatherer.time(&timing(1, 1));
        gatherer.time(&timing(2, 0));
        assert!(gatherer.flight.in_real_time, "one tick was waited for");
        gatherer.time(&timing(3, u64::MAX));
        // From when it was due: lateness counts.
        let time = |tick, sent_ns| StepTime { tick, sent_ns, step_ns: 20, latency_ns: 7 };
        let expected = [time(0, 300), time(1, 301), time(2, 300), time(3, u64::MAX)];
        assert_eq!(gatherer.flight.times, expected);
    }

    #[test]
    fn a_crash_is_an_impact_that_nothing_is_meant_to_stand() {
        let crash_s = |happened: Vec<Happened>| Flight { happened, ..flight() }.crash_s();
        let hard = || happened(100, FlightEvent::Impact, Level::Warn);
        assert_eq!(crash_s(vec![hard(), happened(150, FlightEvent::Fuel, Level::Error)]), None);
        let crashed = happened(250, FlightEvent::Impact, Level::Error);
        let again = happened(300, FlightEvent::Impact, Level::Error);
        let at_s = crash_s(vec![hard(), crashed, again]).expect("a crash");
        assert!((at_s - 1.0).abs() < 1e-9, "{at_s} s");
    }
}
