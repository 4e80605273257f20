//! The envelope: what the aircraft may do, and how far the model's data reach.
//!
//! No block of the physics reads the aircraft's own limits: flown beyond them it flies on. Displays,
//! pilot models and the detection of events read them. The step reads the [`Model`]'s limits, for
//! [`Validity`](crate::outputs::Validity).
//!
//! # Signs
//! Mast tilt as everywhere: 0 as a helicopter, π/2 as an aeroplane. What is faster, higher or turns
//! more than a greatest value is outside.
//! # Assumptions
//! Airspeed limits are calibrated ones. What the source gives as an equivalent airspeed is taken as
//! calibrated too: at 260 kt and 10,000 ft they are 2 kt apart.

use serde::Deserialize;

use crate::controls::FLAP_DETENT_LAST;
use crate::math::min;
use crate::outputs::Outputs;
use crate::table::axis::{MastTilt, RotorSpeed};
use crate::table::{Invalid, Table1, all_valid};

/// Not higher than this above the ground the corridor is not asked for, m: what the wing does there is the
/// ground's affair.
pub const CORRIDOR_HEIGHT_M: f64 = 5.0;

/// Whether it flies so high that the corridor is asked for: off its main wheels, above [`CORRIDOR_HEIGHT_M`].
pub fn is_clear_of_ground(outputs: &Outputs) -> bool {
    let on_wheels = outputs.landing_gear.main.map(|leg| leg.push_n).sum() > 0.0;
    !on_wheels && outputs.height_above_ground_m > CORRIDOR_HEIGHT_M
}

/// Where the aircraft is flown, and where the model holds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Airspeeds at which a mast tilt is flown.
    pub corridor: Corridor,
    /// Greatest calibrated airspeeds by configuration.
    pub airspeed: Airspeed,
    /// Speed and torque of the rotors.
    pub rotors: Rotors,
    /// Weight, and what a landing may be.
    pub airframe: Airframe,
    /// Where the model's data end.
    pub model: Model,
}

/// The conversion corridor: between which calibrated airspeeds a mast tilt is flown.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Corridor {
    /// Slowest, over mast tilt: below it the wing is near its stall. 0 where there is no slowest.
    pub calibrated_airspeed_mps_min: Table1<MastTilt>,
    /// Fastest, over mast tilt: above it rotors and masts bend too much.
    pub calibrated_airspeed_mps_max: Table1<MastTilt>,
}

impl Corridor {
    /// The slowest calibrated airspeed at a mast tilt, m/s; 0 where there is none.
    pub fn slowest_mps(&self, mast_tilt_rad: f64) -> f64 {
        self.calibrated_airspeed_mps_min.at(MastTilt(mast_tilt_rad))
    }

    /// The fastest calibrated airspeed at a mast tilt, m/s.
    pub fn fastest_mps(&self, mast_tilt_rad: f64) -> f64 {
        self.calibrated_airspeed_mps_max.at(MastTilt(mast_tilt_rad))
    }

    /// How far inside the corridor a calibrated airspeed is, m/s; negative outside.
    pub fn margin_mps(&self, mast_tilt_rad: f64, calibrated_airspeed_mps: f64) -> f64 {
        let below = self.fastest_mps(mast_tilt_rad) - calibrated_airspeed_mps;
        let slowest_mps = self.slowest_mps(mast_tilt_rad);
        // As a helicopter there is no slowest speed: flying backwards is no way out.
        let above = if slowest_mps > 0.0 { calibrated_airspeed_mps - slowest_mps } else { below };
        min(below, above)
    }

    /// The same of what is seen at a tick, m/s; `None` on the wheels or not higher than [`CORRIDOR_HEIGHT_M`].
    pub fn margin_in_flight_mps(&self, outputs: &Outputs) -> Option<f64> {
        let tilt_rad = outputs.actuators.mast_tilt_rad.mean();
        is_clear_of_ground(outputs)
            .then(|| self.margin_mps(tilt_rad, outputs.calibrated_airspeed_mps))
    }

    /// Mast tilts at which one of the limits has a corner, ascending: what lies between is straight.
    pub fn corners_rad(&self) -> impl Iterator<Item = f64> {
        let (slow, fast) =
            (&self.calibrated_airspeed_mps_min.x, &self.calibrated_airspeed_mps_max.x);
        let (mut i, mut j) = (0, 0);
        core::iter::from_fn(move || {
            let next = match (slow.get(i), fast.get(j)) {
                (Some(&a), Some(&b)) => min(a, b),
                (a, b) => *a.or(b)?,
            };
            i += usize::from(slow.get(i).is_some_and(|&x| x <= next));
            j += usize::from(fast.get(j).is_some_and(|&x| x <= next));
            Some(next)
        })
    }

    fn validate(&self) -> Result<(), Invalid> {
        const SLOWEST: &str = "envelope.corridor.calibrated_airspeed_min";
        const FASTEST: &str = "envelope.corridor.calibrated_airspeed_max";
        let limits = [
            (SLOWEST, &self.calibrated_airspeed_mps_min),
            (FASTEST, &self.calibrated_airspeed_mps_max),
        ];
        for (key, limit) in limits {
            all_valid([(key, limit.validate())])?;
            if limit.y.windows(2).any(|pair| pair[0] > pair[1]) || limit.y.iter().any(|&y| y < 0.0)
            {
                let expected = "airspeeds from 0 that do not fall as the mast tilts forward";
                return Err(Invalid { key, expected });
            }
        }
        let crossed = |tilt_rad| self.slowest_mps(tilt_rad) >= self.fastest_mps(tilt_rad);
        let expected = "less than the fastest airspeed at every mast tilt";
        let is_crossed = self.corners_rad().any(crossed);
        (!is_crossed).then_some(()).ok_or(Invalid { key: SLOWEST, expected })
    }
}

/// Greatest calibrated airspeeds by configuration.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Airspeed {
    /// V_C: of an aeroplane in normal flight.
    pub cruise_mps_max: f64,
    /// V_D: of an aeroplane that dives.
    pub dive_mps_max: f64,
    /// M_C: Mach number of an aeroplane.
    pub mach_max: f64,
    /// With the flaps at each detent.
    pub flap_mps_max: [f64; FLAP_DETENT_LAST as usize + 1],
    /// While the landing gear moves.
    pub gear_cycle_mps_max: f64,
}

/// Speed and torque of the rotors.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotors {
    /// Ω that the dial calls 100 %.
    pub rated_radps: f64,
    /// Ω above which the crew is warned.
    pub overspeed_radps: f64,
    /// Ω that is never exceeded.
    pub speed_radps_max: f64,
    /// Below this part of the selected Ω the crew is warned.
    pub underspeed_norm: f64,
    /// Torque of one mast for a short time, over Ω. The continuous limit is that of the engines.
    pub short_torque_n_m_max: Table1<RotorSpeed>,
}

/// Weight, and what a landing may be.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Airframe {
    /// Greatest gross mass.
    pub gross_kg_max: f64,
    /// Sink at touchdown that the gear is designed for.
    pub touchdown_sink_mps_max: f64,
    /// Sink at touchdown that it takes with its reserve.
    pub reserve_sink_mps_max: f64,
}

/// Where the model's data end: beyond them its answer is not to be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// True airspeed.
    pub airspeed_mps_max: f64,
    /// Above mean sea level.
    pub height_m_max: f64,
    /// Slowest Ω.
    pub rotor_speed_radps_min: f64,
    /// Fastest Ω.
    pub rotor_speed_radps_max: f64,
    /// Angular rate of the body; turning faster is no flight.
    pub angular_rate_radps_max: f64,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        self.corridor.validate()?;
        let short_torque = self.rotors.short_torque_n_m_max.validate();
        all_valid([("envelope.rotors.short_torque_max", short_torque)])
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;

    use super::*;

    /// Straight lines: slowest 0 to 40 m/s and fastest 30 to 60 m/s over 0 to 1 rad.
    fn corridor() -> Corridor {
        Corridor {
            calibrated_airspeed_mps_min: Table1::new(vec![0.0, 0.5, 1.0], vec![0.0, 20.0, 40.0]),
            calibrated_airspeed_mps_max: Table1::new(vec![0.0, 0.8], vec![30.0, 60.0]),
        }
    }

    #[test]
    fn inside_and_outside_are_told_apart_by_sign() {
        let corridor = corridor();
        for (tilt_rad, airspeed_mps, margin_mps) in
            [(0.0, 0.0, 30.0), (0.0, 31.0, -1.0), (0.5, 25.0, 5.0), (0.5, 19.0, -1.0)]
        {
            let found_mps = corridor.margin_mps(tilt_rad, airspeed_mps);
            assert!((found_mps - margin_mps).abs() < 1e-12, "{tilt_rad}, {airspeed_mps}");
        }
    }

    #[test]
    fn corners_of_both_limits_come_once_and_in_order() {
        let corners: Vec<_> = corridor().corners_rad().collect();
        assert_eq!(corners, [0.0, 0.5, 0.8, 1.0]);
    }

    #[test]
    fn limits_that_fall_or_cross_are_refused() {
        assert_eq!(corridor().validate(), Ok(()));
        let mut falling = corridor();
        falling.calibrated_airspeed_mps_max.y[1] = 29.0;
        assert_eq!(
            falling.validate().err().map(|at| at.key),
            Some("envelope.corridor.calibrated_airspeed_max")
        );
        // Not at the corners of its own limit: at one of the other's.
        let mut crossed = corridor();
        crossed.calibrated_airspeed_mps_max = Table1::new(vec![0.0, 1.0], vec![19.0, 61.0]);
        assert_eq!(crossed.validate(), Ok(()));
        crossed.calibrated_airspeed_mps_min =
            Table1::new(vec![0.0, 0.4, 1.0], vec![0.0, 40.0, 41.0]);
        assert_eq!(
            crossed.validate().err().map(|at| at.key),
            Some("envelope.corridor.calibrated_airspeed_min")
        );
    }
}
