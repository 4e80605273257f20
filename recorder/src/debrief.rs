//! What a pilot hears after a flight: how it touched down, how often it left the corridor, and which
//! limits it exceeded.

use std::fmt;

use engine::envelope::{Params as Envelope, is_clear_of_ground};
use engine::frames::Euler;
use engine::math::{sqrt, square};
use engine::outputs::Validity;
use engine::units::{FPM_PER_MPS, degrees, knots};
use engine::{Outputs, STEP_S};

/// A touchdown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touchdown {
    /// When.
    pub tick: u64,
    /// Downwards, just before.
    pub sink_mps: f64,
    /// Over the ground.
    pub speed_mps: f64,
    /// Roll, pitch, heading.
    pub euler: Euler,
    /// From the origin, m.
    pub north_m: f64,
    /// From the origin, m.
    pub east_m: f64,
    /// Whether the gear is designed for less.
    pub hard: bool,
}

/// What was outside, for how long and how far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Excursions {
    /// How often.
    pub times: u64,
    /// Ticks in all.
    pub ticks: u64,
    /// How far at most, m/s.
    pub by_mps_max: f64,
    outside: bool,
}

impl Excursions {
    fn add(&mut self, outside_by_mps: f64) {
        let outside = outside_by_mps > 0.0;
        self.times += u64::from(outside && !self.outside);
        self.ticks += u64::from(outside);
        self.by_mps_max = engine::math::max(self.by_mps_max, outside_by_mps);
        self.outside = outside;
    }
}

/// Gathered tick by tick, without asking for memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct Debrief {
    /// How often the wheels took weight.
    pub touchdowns: u64,
    /// The last landing; of its bounces, the hardest.
    pub touchdown: Option<Touchdown>,
    /// Times outside the conversion corridor.
    pub corridor: Excursions,
    /// Times beyond the greatest speed for the flaps.
    pub flap_speed: Excursions,
    /// Where the model's answer was not to be trusted.
    pub validity: Validity,
    /// It has flown since the last touchdown: what comes is no bounce.
    flown: bool,
    before: Option<Seen>,
}

/// What was seen in the tick before.
#[derive(Clone, Copy, Debug)]
struct Seen {
    on_wheels: bool,
    sink_mps: f64,
    speed_mps: f64,
}

impl Debrief {
    /// Adds a tick.
    pub fn add(&mut self, envelope: &Envelope, outputs: &Outputs) {
        let main = &outputs.landing_gear.main;
        let v = outputs.velocity_mps;
        let now = Seen {
            on_wheels: main.map(|leg| leg.push_n).sum() > 0.0,
            sink_mps: v.z,
            speed_mps: sqrt(square(v.x) + square(v.y)),
        };
        if let Some(before) = self.before.replace(now)
            && now.on_wheels
            && !before.on_wheels
        {
            self.touchdowns += 1;
            let touchdown = Touchdown {
                tick: outputs.tick,
                sink_mps: before.sink_mps,
                speed_mps: before.speed_mps,
                euler: outputs.euler,
                north_m: outputs.position_m.x,
                east_m: outputs.position_m.y,
                hard: before.sink_mps > envelope.airframe.touchdown_sink_mps_max,
            };
            let bounce =
                self.touchdown.filter(|last| !self.flown && last.sink_mps > before.sink_mps);
            self.touchdown = bounce.or(Some(touchdown));
            self.flown = false;
        }
        self.validity |= outputs.validity;
        let flying = is_clear_of_ground(outputs);
        let (tilt_rad, cas_mps) =
            (outputs.actuators.mast_tilt_rad.mean(), outputs.calibrated_airspeed_mps);
        let outside_mps = -envelope.corridor.margin_mps(tilt_rad, cas_mps);
        self.flown |= flying;
        self.corridor.add(if flying { outside_mps } else { 0.0 });
        let detent =
            (outputs.cockpit.flap_detent as usize).min(envelope.airspeed.flap_mps_max.len() - 1);
        let flaps_mps = cas_mps - envelope.airspeed.flap_mps_max[detent];
        self.flap_speed.add(if flying { flaps_mps } else { 0.0 });
    }

    /// Another state took the place of the one flown: that it stands on the ground is no touchdown.
    pub fn restart(&mut self) {
        self.before = None;
    }
}

impl fmt::Display for Touchdown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:.0} ft/min ({:.1} m/s), {:.1} kt over the ground, bank {:.1} deg {}, pitch {:.1} deg, \
             {:.0} m north and {:.0} m east of the start",
            self.sink_mps * FPM_PER_MPS,
            self.sink_mps,
            knots(self.speed_mps),
            degrees(self.euler.roll_rad).abs(),
            if self.euler.roll_rad < 0.0 { "left" } else { "right" },
            degrees(self.euler.pitch_rad) + 0.0,
            self.north_m.round() + 0.0,
            self.east_m.round() + 0.0,
        )?;
        f.write_str(if self.hard { "; HARD: beyond the gear's design" } else { "" })
    }
}

/// One line.
impl fmt::Display for Debrief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.touchdown {
            Some(touchdown) => write!(f, "touchdown {touchdown}")?,
            None => f.write_str("no touchdown")?,
        }
        for (what, outside) in
            [("the corridor", &self.corridor), ("the flap speed", &self.flap_speed)]
        {
            if outside.times == 0 {
                continue;
            }
            let (times, s) = (outside.times, outside.ticks as f64 * STEP_S);
            let kt = knots(outside.by_mps_max);
            write!(f, "; outside {what} {times} times, {s:.1} s, by {kt:.0} kt at most")?;
        }
        if !self.validity.is_empty() {
            write!(f, "; exceeded: {}", self.validity)?;
        }
        Ok(())
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "what is passed on stays the same to the bit")]
mod tests {
    use super::*;

    #[test]
    fn a_hard_landing_is_told_with_its_rate_bank_and_place() {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut debrief = Debrief::default();
        let mut outputs = Outputs { height_above_ground_m: 20.0, ..Outputs::default() };
        outputs.velocity_mps.z = 5.0;
        outputs.position_m.x = 12.0;
        outputs.euler.roll_rad = -0.1;
        debrief.add(&xv15.envelope, &outputs);
        assert_eq!(debrief.to_string(), "no touchdown");
        outputs.height_above_ground_m = 2.0;
        outputs.landing_gear.main.left.push_n = 1000.0;
        outputs.validity = Validity::GEAR_BOTTOMED;
        debrief.add(&xv15.envelope, &outputs);
        let line = debrief.to_string();
        for words in
            ["984 ft/min", "bank 5.7 deg left", "12 m north", "HARD", "exceeded: gear bottomed"]
        {
            assert!(line.contains(words), "{line}");
        }
    }

    #[test]
    fn of_a_landing_with_bounces_the_hardest_is_told() {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut debrief = Debrief::default();
        let mut outputs = Outputs::default();
        let mut land = |height_m: f64, sink_mps: f64| {
            outputs.height_above_ground_m = height_m;
            outputs.velocity_mps.z = sink_mps;
            outputs.landing_gear.main.left.push_n = 0.0;
            debrief.add(&xv15.envelope, &outputs);
            outputs.landing_gear.main.left.push_n = 1000.0;
            debrief.add(&xv15.envelope, &outputs);
            debrief.touchdown.unwrap().sink_mps
        };
        assert_eq!(land(20.0, 5.0), 5.0);
        assert_eq!(land(2.0, 1.0), 5.0, "a bounce");
        assert_eq!(land(20.0, 1.5), 1.5, "another landing");
    }

    #[test]
    fn a_reset_to_the_ground_is_no_touchdown() {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut debrief = Debrief::default();
        let mut outputs = Outputs::default();
        debrief.add(&xv15.envelope, &outputs);
        debrief.restart();
        outputs.landing_gear.main.left.push_n = 1000.0;
        debrief.add(&xv15.envelope, &outputs);
        assert_eq!(debrief.touchdowns, 0);
    }
}
