//! What displays and viewers show of the aircraft: its outer shape, and how far its surfaces move.
//!
//! No block of the physics reads it. What another table has is not here a second time: viewers take
//! pivots, mast and rotors from `rotors`, wheels' places from `landing_gear`, travels from
//! `actuators` ([`Travels`]).
//!
//! # Signs
//! Points are stations of the drawing (aft, right, up). Of what is on both sides the right one is
//! given.
//! # Assumptions
//! Symmetric; bodies are rows of cross-sections, surfaces have symmetric sections. For recognition,
//! not for measuring.

use alloc::vec::Vec;

use serde::Deserialize;

use crate::actuators::{self, Actuator};
use crate::frames::{Structural, Vec3};
use crate::landing_gear::Strut;
use crate::math::{FRAC_PI_2, max};
use crate::table::Invalid;

/// The outer shape.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Fuselage.
    pub fuselage: Fuselage,
    /// Wing.
    pub wing: Wing,
    /// Horizontal stabiliser.
    pub horizontal_stabilizer: Tailplane,
    /// Fins.
    pub vertical_stabilizers: Fins,
    /// Pods that the main gear folds into.
    pub gear_pods: GearPods,
    /// Nose wheels and leg.
    pub nose_wheels: Wheels,
    /// Main wheels and legs.
    pub main_wheels: Wheels,
    /// Nacelles and spinners.
    pub nacelles: Nacelles,
}

/// The fuselage.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fuselage {
    /// Cross-sections from nose to tail: station, half width, waterlines of bottom and top.
    pub section_m: Vec<[f64; 4]>,
    /// From the side: stations of its ends, waterlines of its edges.
    pub windscreen_m: [f64; 4],
    /// The same of the windows behind it.
    pub side_window_m: [f64; 4],
}

/// The wing: both sides straight and of one chord.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wing {
    /// A point of the right side's quarter-chord line.
    pub quarter_chord_m: Vec3<Structural>,
    /// Chord.
    pub chord_m: f64,
    /// Tip to tip as far as it is seen.
    pub span_m: f64,
    /// Of the quarter-chord line, aft.
    pub sweep_rad: f64,
    /// Tips up.
    pub dihedral_rad: f64,
    /// Thickness over chord.
    pub thickness_ratio: f64,
}

/// The horizontal stabiliser: rectangular.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tailplane {
    /// Quarter chord in the plane of symmetry.
    pub quarter_chord_m: Vec3<Structural>,
    /// Chord.
    pub chord_m: f64,
    /// Tip to tip.
    pub span_m: f64,
    /// Thickness over chord.
    pub thickness_ratio: f64,
}

/// The fins, upright.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fins {
    /// Buttline of the right one.
    pub buttline_m: f64,
    /// From the lower tip to the upper one: waterline, chord, station of the quarter chord.
    pub section_m: Vec<[f64; 3]>,
    /// Thickness over chord.
    pub thickness_ratio: f64,
}

/// The pods of the main gear: round.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GearPods {
    /// Buttline of the right one's axis.
    pub buttline_m: f64,
    /// Waterline of its axis.
    pub waterline_m: f64,
    /// From front to back: station, radius.
    pub section_m: Vec<[f64; 2]>,
}

/// The two wheels of a strut, standing on the ground, and its leg.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wheels {
    /// Waterline of the axle.
    pub axle_waterline_m: f64,
    /// Of a tyre.
    pub radius_m: f64,
    /// Of a tyre.
    pub width_m: f64,
    /// Between the wheels' middles.
    pub spacing_m: f64,
    /// Of the leg.
    pub leg_radius_m: f64,
    /// Waterline at which the leg ends in the airframe.
    pub leg_top_waterline_m: f64,
}

impl Wheels {
    /// The axle of a strut of the landing gear.
    pub fn axle_m(&self, strut: &Strut) -> Vec3<Structural> {
        Vec3::new(strut.tyre_m.x, strut.tyre_m.y, self.axle_waterline_m)
    }
}

/// Nacelles and spinners, in the mast's axes about the pivot.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nacelles {
    /// From the exhaust up: distance down the mast from the pivot, half depth fore and aft, half width.
    pub section_m: Vec<[f64; 3]>,
    /// From the nacelle to the tip: the same.
    pub spinner_m: Vec<[f64; 3]>,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        const ASCENDING: &str =
            "two cross-sections at least, from front to back, not turned inside out";
        const RISING: &str =
            "two cross-sections at least, from the bottom up, not turned inside out";
        let fuselage = &self.fuselage.section_m;
        let flat = |section: &[f64; 4]| section[1] < 0.0 || section[2] >= section[3];
        let fins = &self.vertical_stabilizers.section_m;
        let pods = &self.gear_pods.section_m;
        // The mast counts downwards: from the bottom up it descends.
        let up = |rows: &[[f64; 3]]| {
            let halves = rows.iter().any(|row| row[1] <= 0.0 || row[2] <= 0.0);
            halves || !in_order(rows.iter().map(|row| -row[0]))
        };
        let faults = [
            (
                "display.fuselage.section",
                ASCENDING,
                fuselage.iter().any(flat) || !in_order(fuselage.iter().map(|row| row[0])),
            ),
            (
                "display.vertical_stabilizers.section",
                RISING,
                fins.iter().any(|row| row[1] <= 0.0) || !in_order(fins.iter().map(|row| row[0])),
            ),
            (
                "display.gear_pods.section",
                ASCENDING,
                pods.iter().any(|row| row[1] <= 0.0) || !in_order(pods.iter().map(|row| row[0])),
            ),
            ("display.nacelles.section", RISING, up(&self.nacelles.section_m)),
            ("display.nacelles.spinner", RISING, up(&self.nacelles.spinner_m)),
        ];
        faults.into_iter().try_for_each(|(key, expected, wrong)| {
            (!wrong).then_some(()).ok_or(Invalid { key, expected })
        })
    }
}

/// Whether there are two places at least, each beyond the one before.
fn in_order(mut places: impl Iterator<Item = f64>) -> bool {
    let Some(mut last) = places.next() else { return false };
    let mut more = false;
    for place in places {
        if place <= last {
            return false;
        }
        (last, more) = (place, true);
    }
    more
}

/// How far something moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// One way.
    pub rad_min: f64,
    /// The other way.
    pub rad_max: f64,
}

impl Travel {
    /// The greater of its two ways: what a display's full scale stands for.
    pub fn greatest_rad(&self) -> f64 {
        max(self.rad_min.abs(), self.rad_max.abs())
    }
}

/// Scales of displays: how far surfaces and nacelles move, from the actuators.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travels {
    /// Elevator.
    pub elevator: Travel,
    /// Rudders.
    pub rudder: Travel,
    /// Flaps.
    pub flap: Travel,
    /// Flaperons, beyond the flaps' setting, as the outputs have it.
    pub flaperon: Travel,
    /// Nacelles as cockpits count them: π/2 as a helicopter, 0 as an aeroplane.
    pub nacelle_incidence: Travel,
}

impl Travels {
    /// Those of an aircraft's actuators.
    pub fn of(actuators: &actuators::Params) -> Self {
        let travel =
            |actuator: &Actuator| Travel { rad_min: actuator.rad_min, rad_max: actuator.rad_max };
        Self {
            elevator: travel(&actuators.elevator),
            rudder: travel(&actuators.rudder),
            flap: travel(&actuators.flap),
            flaperon: travel(&actuators.flaperon),
            nacelle_incidence: Travel {
                rad_min: FRAC_PI_2 - actuators.mast_tilt_rad_max,
                rad_max: FRAC_PI_2 - actuators.mast_tilt_rad_min,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_in_order_or_not() {
        assert!(in_order([0.0, 1.0, 2.0].into_iter()));
        for places in [&[][..], &[1.0], &[0.0, 0.0], &[0.0, 2.0, 1.0]] {
            assert!(!in_order(places.iter().copied()), "{places:?}");
        }
    }

    #[test]
    fn a_full_scale_is_the_greater_way() {
        assert!((Travel { rad_min: -0.4, rad_max: 0.2 }.greatest_rad() - 0.4).abs() < 1e-15);
    }
}
