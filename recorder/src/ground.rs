//! Ground from FlightGear's scenery: heights under the wheels, as a recorded input.
//!
//! # Equations
//! ```text
//! ground' = ground + clamp(sample − ground, ±rate·h)
//! rate = 0.2 m/s + 0.1·speed over the ground     a wheel within 2 m of the ground
//!        50 m/s                                  otherwise
//! ```
//! # Assumptions
//! A sample is a drawn frame old: the aircraft has moved on by a few metres at most. What comes from
//! outside is taken only where it can be the ground here: finite, near the aircraft, and not a cliff
//! that only one sample knows. When samples stop, the ground stays while a wheel is near it, and goes
//! back to the flat default in the air.

use std::sync::Arc;

use engine::Outputs;
use engine::math::{clamp, max, sqrt, square};
use engine::state::Geodetic;
use engine::struts::Struts;
use engine::units::radians;
use engine::{Aircraft, STEP_S};
use flightgear::{GroundSample, Receiver, Report};

use crate::controller::{Controller, TickContext};

/// A sample of farther away is none of here, m.
const NEAR_M: f64 = 150.0;
/// Heights on this planet, m.
const HEIGHT_M: std::ops::RangeInclusive<f64> = -600.0..=9_000.0;
/// A change from one sample to the next that has to be found more than once, m.
const CLIFF_M: f64 = 20.0;
/// So often.
const TIMES: u32 = 3;
/// Without a sample for so long, there is none any more: two seconds.
const SILENT_TICKS: u64 = 500;
/// A wheel nearer to the ground than this may touch it soon, m.
const CLEAR_M: f64 = 2.0;
/// Metres of a radian of latitude, near enough for what is near.
const EARTH_M: f64 = 6_371_000.0;

/// The ground under the wheels, tick by tick.
pub struct Ground {
    receiver: Arc<Receiver>,
    filter: Filter,
}

impl Ground {
    /// Takes the ground from what a FlightGear tells; heights count from the origin's.
    pub fn new(receiver: Arc<Receiver>, origin: Geodetic, aircraft: &Aircraft) -> Self {
        Self { receiver, filter: Filter::new(origin, aircraft) }
    }
}

impl Controller for Ground {
    fn act(&mut self, seen: &Outputs, context: &mut TickContext<'_>) {
        let sample = self.receiver.newest_ground();
        if let Some(ground_height_m) = self.filter.update(sample.as_ref(), seen) {
            context.world.ground_height_m = ground_height_m;
        }
    }
}

/// From samples to heights that wheels can stand on.
#[derive(Clone, Debug)]
struct Filter {
    origin: Geodetic,
    /// Centre of gravity over an extended main wheel, as a helicopter, m.
    wheels_m: f64,
    /// Last one taken.
    number: i64,
    wanted_m: Struts<f64>,
    ground_m: Struts<f64>,
    /// A cliff that was found once, and how often since.
    doubtful: Option<(Struts<f64>, u32)>,
    silent_ticks: u64,
    /// Where it was in the tick before.
    place: Option<Geodetic>,
    /// Whether there has been any.
    begun: bool,
}

impl Filter {
    fn new(origin: Geodetic, aircraft: &Aircraft) -> Self {
        Self {
            origin,
            wheels_m: aircraft.weight_balance.cg_m.z - aircraft.landing_gear.main.tyre_m.z,
            number: 0,
            wanted_m: Struts::default(),
            ground_m: Struts::default(),
            doubtful: None,
            silent_ticks: 0,
            place: None,
            begun: false,
        }
    }

    /// One tick: the ground under the wheels above the origin's; `None` before there was a sample.
    fn update(&mut self, sample: Option<&GroundSample>, seen: &Outputs) -> Option<Struts<f64>> {
        self.silent_ticks += 1;
        if let Some(sample) = sample.filter(|sample| sample.number != self.number) {
            self.number = sample.number;
            if is_plausible(sample, &seen.place) {
                self.silent_ticks = 0;
                self.take(above(&self.origin, sample));
            }
        }
        if self.has_jumped(&seen.place) {
            // The flight was begun anew elsewhere: what is known is of another place.
            (self.ground_m, self.wanted_m, self.doubtful) = Default::default();
        }
        let clearance_m = seen.height_above_ground_m - self.wheels_m;
        let near = clearance_m < CLEAR_M;
        if self.silent_ticks > SILENT_TICKS {
            // Nobody pulls the ground away from under a wheel.
            self.wanted_m = if near { self.ground_m } else { Struts::default() };
        }
        let speed_mps = sqrt(square(seen.velocity_mps.x) + square(seen.velocity_mps.y));
        let step_m = STEP_S * if near { 0.2 + 0.1 * speed_mps } else { 50.0 };
        let wanted_m = self.wanted_m;
        let toward = |at: f64, to: f64| {
            // Never into a wheel that is clear of it.
            let step_m =
                if near { step_m } else { clamp(clearance_m - CLEAR_M / 2.0, 0.0, step_m) };
            at + clamp(to - at, -step_m, step_m)
        };
        self.ground_m.nose = toward(self.ground_m.nose, wanted_m.nose);
        self.ground_m.main = self.ground_m.main.zip(wanted_m.main).map(|(at, to)| toward(at, to));
        self.begun.then_some(self.ground_m)
    }

    /// Whether the aircraft is elsewhere than flying could have brought it in a tick.
    fn has_jumped(&mut self, place: &Geodetic) -> bool {
        let before = self.place.replace(*place);
        before.is_some_and(|before| {
            let north_m = (place.latitude_rad - before.latitude_rad) * EARTH_M;
            let east_m = (place.longitude_rad - before.longitude_rad) * EARTH_M;
            square(north_m) + square(east_m) > square(NEAR_M)
        })
    }

    fn take(&mut self, height_m: Struts<f64>) {
        let is_new = !std::mem::replace(&mut self.begun, true);
        if is_new || apart_m(&height_m, &self.wanted_m) < CLIFF_M {
            (self.wanted_m, self.doubtful) = (height_m, None);
            return;
        }
        let times = match self.doubtful {
            Some((before_m, times)) if apart_m(&height_m, &before_m) < CLIFF_M => times + 1,
            _ => 1,
        };
        self.doubtful = Some((height_m, times));
        if times >= TIMES {
            (self.wanted_m, self.doubtful) = (height_m, None);
        }
    }
}

/// Heights of a sample above the origin's ground.
fn above(origin: &Geodetic, sample: &GroundSample) -> Struts<f64> {
    let [nose_m, left_m, right_m] = sample.height_m.map(|height_m| height_m - origin.height_m);
    Struts { nose: nose_m, main: engine::pair::Pair { left: left_m, right: right_m } }
}

/// The greatest difference of two grounds, m.
fn apart_m(a: &Struts<f64>, b: &Struts<f64>) -> f64 {
    let main = a.main.zip(b.main).map(|(a, b)| (a - b).abs());
    max((a.nose - b.nose).abs(), max(main.left, main.right))
}

/// Whether a sample can be the ground at a place.
pub fn is_plausible(sample: &GroundSample, place: &Geodetic) -> bool {
    let north_m = (radians(sample.latitude_deg) - place.latitude_rad) * EARTH_M;
    let east_m = engine::math::wrap_angle(radians(sample.longitude_deg) - place.longitude_rad)
        * EARTH_M
        * engine::math::cos(place.latitude_rad);
    square(north_m) + square(east_m) < square(NEAR_M)
        && sample.height_m.iter().all(|height_m| HEIGHT_M.contains(height_m))
}

/// Ground under the main wheels where FlightGear shows a place, m above its sea level; `None` while it
/// shows another one, or has no scenery there.
pub fn at_place(report: &Report, place: &Geodetic) -> Option<f64> {
    /// FlightGear has the place to a centimetre.
    const HERE_M: f64 = 0.5;
    let sample = report.ground.filter(|sample| is_plausible(sample, place))?;
    let north_m = (radians(sample.latitude_deg) - place.latitude_rad) * EARTH_M;
    let east_m = engine::math::wrap_angle(radians(sample.longitude_deg) - place.longitude_rad)
        * EARTH_M
        * engine::math::cos(place.latitude_rad);
    let here = square(north_m) + square(east_m) < square(HERE_M);
    here.then_some((sample.height_m[1] + sample.height_m[2]) / 2.0)
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use engine::frames::Vec3;

    use super::*;

    fn filter() -> Filter {
        static XV15: OnceLock<Aircraft> = OnceLock::new();
        let xv15 = || aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
        let origin = Geodetic { height_m: 10.0, ..Geodetic::default() };
        Filter::new(origin, XV15.get_or_init(xv15))
    }

    fn sample(number: i64, height_m: f64) -> GroundSample {
        GroundSample { number, latitude_deg: 0.0, longitude_deg: 0.0, height_m: [height_m; 3] }
    }

    /// Wheels that high over the ground that the flight knows, at a speed northwards.
    fn flying(clearance_m: f64, speed_mps: f64) -> Outputs {
        Outputs {
            height_above_ground_m: filter().wheels_m + clearance_m,
            velocity_mps: Vec3::new(speed_mps, 0.0, 0.0),
            ..Outputs::default()
        }
    }

    #[test]
    fn nothing_is_touched_before_there_is_a_sample() {
        assert_eq!(filter().update(None, &flying(0.0, 0.0)), None);
    }

    #[test]
    fn under_wheels_that_stand_the_ground_moves_slowly() {
        let mut filter = filter();
        let seen = flying(-0.1, 0.0);
        let mut before_m = 0.0;
        for number in 1..=250 {
            let ground_m = filter.update(Some(&sample(number, 12.0)), &seen).expect("begun").nose;
            assert!((0.0..=0.2 * STEP_S + 1e-12).contains(&(ground_m - before_m)));
            before_m = ground_m;
        }
        assert!((before_m - 0.2).abs() < 1e-9, "a second at 0.2 m/s: {before_m}");
    }

    #[test]
    fn in_the_air_it_follows_at_once_and_never_into_a_wheel() {
        let mut filter = filter();
        for number in 1..=100 {
            filter.update(Some(&sample(number, 29.0)), &flying(100.0, 70.0));
        }
        assert!((filter.ground_m.nose - 19.0).abs() < 1e-9);
        let mut filter = self::filter();
        let ground_m = filter.update(Some(&sample(1, 29.0)), &flying(3.0, 70.0)).expect("begun");
        assert!(ground_m.nose <= 2.0);
    }

    #[test]
    fn a_cliff_that_one_sample_knows_is_none() {
        let mut filter = filter();
        let seen = flying(200.0, 0.0);
        for number in 1..=10 {
            filter.update(Some(&sample(number, 11.0)), &seen);
        }
        filter.update(Some(&sample(11, 111.0)), &seen);
        filter.update(Some(&sample(12, 11.0)), &seen);
        for _ in 0..250 {
            filter.update(Some(&sample(12, 11.0)), &seen);
        }
        assert!((filter.ground_m.nose - 1.0).abs() < 1e-9);
        for number in 13..400 {
            filter.update(Some(&sample(number, 111.0)), &seen);
        }
        assert!(filter.ground_m.nose > 50.0, "a real one: {}", filter.ground_m.nose);
    }

    #[test]
    fn when_samples_stop_it_is_flat_again_in_the_air_and_stays_under_wheels() {
        for (clearance_m, expected_m) in [(100.0, 0.0), (0.0, 1.0)] {
            let mut filter = filter();
            for number in 1..=1500 {
                filter.update(Some(&sample(number, 11.0)), &flying(clearance_m, 0.0));
            }
            for _ in 0..1500 {
                filter.update(Some(&sample(1500, 11.0)), &flying(clearance_m, 0.0));
            }
            assert!((filter.ground_m.nose - expected_m).abs() < 1e-9, "{}", filter.ground_m.nose);
        }
    }

    #[test]
    fn what_cannot_be_the_ground_here_is_not_taken() {
        let here = Geodetic::default();
        assert!(is_plausible(&sample(1, 12.0), &here));
        for height_m in [1e4, -1e3, f64::NAN] {
            assert!(!is_plausible(&sample(1, height_m), &here));
        }
        let far = GroundSample { latitude_deg: 0.1, ..sample(1, 12.0) };
        assert!(!is_plausible(&far, &here));
        let nowhere = GroundSample { longitude_deg: f64::NAN, ..sample(1, 12.0) };
        assert!(!is_plausible(&nowhere, &here));
    }
}
