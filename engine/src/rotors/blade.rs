//! The blade: where its elements are, how wide and how twisted.
//!
//! # Equations
//! Gauss–Legendre within each of the four section regions, so that no section is smeared over a
//! boundary:
//! ```text
//! ∫ f dr = Σ f(r_i)·w_i        3, 2, 2 and 1 stations from the root cut-out to the tip
//! ```
//! # Assumptions
//! The blade is straight until it bends; its twist is the geometric one.

use serde::Deserialize;

use super::bending::{self, Inertias};
use super::section::{self, REGIONS, Region};
use crate::lanes::{self, LANES, Lanes};
use crate::math::{sin_cos, tan};
use crate::table::Table1;
use crate::table::axis::RadialStation;

/// Elements along a blade.
pub const STATIONS: usize = 8;

/// Region, and place and weight within it on −1..1: Gauss–Legendre of 3, 2, 2 and 1 points.
const NODES: [(usize, f64, f64); STATIONS] = [
    (0, -0.774_596_669_241_483_4, 5.0 / 9.0),
    (0, 0.0, 8.0 / 9.0),
    (0, 0.774_596_669_241_483_4, 5.0 / 9.0),
    (1, -0.577_350_269_189_625_8, 1.0),
    (1, 0.577_350_269_189_625_8, 1.0),
    (2, -0.577_350_269_189_625_8, 1.0),
    (2, 0.577_350_269_189_625_8, 1.0),
    (3, 0.0, 2.0),
];

/// What a blade is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// b, blades of a rotor.
    pub count: f64,
    /// Where the blade begins, of the radius.
    pub root_norm: f64,
    /// c over the part of the radius.
    pub blade_chord_m: Table1<RadialStation>,
    /// Built-in twist over the part of the radius, relative to ¾ of it.
    pub twist_rad: Table1<RadialStation>,
    /// Sections.
    pub section: section::Params,
}

impl Params {
    /// # Errors
    /// What is expected, if it is not so.
    pub fn validate(&self) -> Result<(), &'static str> {
        self.section
            .validate()
            .and_then(|()| self.blade_chord_m.validate())
            .and_then(|()| self.twist_rad.validate())
            .and_then(|()| {
                let ends = &self.section.lift_coefficient.x;
                (self.root_norm < ends[0])
                    .then_some(())
                    .ok_or("the root within the innermost region")
            })
    }
}

/// An element of the blade.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// Its section.
    pub region: usize,
    /// r.
    pub radius_m: f64,
    /// c·w: the area it stands for.
    pub area_m2: f64,
    /// c.
    pub chord_m: f64,
    /// K − 1: how far rotation holds off the stall.
    pub delay: f64,
    /// M_cr without lift: where the drag begins to rise.
    pub rise_mach: f64,
    /// Where its region begins, of the radius.
    pub inner_norm: f64,
    /// How wide that is.
    pub width_norm: f64,
    /// Part of the disc's area it stands for, 2r·w/R².
    pub disc_norm: f64,
    /// Sine of the twist.
    pub sin_twist: f64,
    /// Cosine of the twist.
    pub cos_twist: f64,
    /// R·φ: how far it moves up when the tip bends up by one radius.
    pub displacement_m: f64,
    /// Slope that it has then.
    pub slope_norm: f64,
}

/// Neighbouring elements, each in its lane: what the inflow needs of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    /// r.
    pub radius_m: Lanes,
    /// c.
    pub chord_m: Lanes,
    /// Where the regions begin, of the radius.
    pub inner_norm: Lanes,
    /// How wide those are.
    pub width_norm: Lanes,
    /// Sines of the twist.
    pub sin_twist: Lanes,
    /// Cosines of the twist.
    pub cos_twist: Lanes,
    /// α0.
    pub zero_lift_rad: Lanes,
}

impl Group {
    fn new(stations: &[Station], regions: &[Region]) -> Self {
        let of = |f: fn(&Station) -> f64| Lanes::from_fn(|lane| f(&stations[lane]));
        Self {
            radius_m: of(|station| station.radius_m),
            chord_m: of(|station| station.chord_m),
            inner_norm: of(|station| station.inner_norm),
            width_norm: of(|station| station.width_norm),
            sin_twist: of(|station| station.sin_twist),
            cos_twist: of(|station| station.cos_twist),
            zero_lift_rad: Lanes::from_fn(|lane| regions[stations[lane].region].zero_lift_rad),
        }
    }

    /// Parts of their areas that lift when lift ends at this part of the radius.
    pub fn lifting(&self, tip_norm: f64) -> Lanes {
        lanes::clamp((tip_norm - self.inner_norm) / self.width_norm, 0.0, 1.0)
    }
}

/// A blade, ready to be moved through the air.
#[derive(Clone, Copy, Debug)]
pub struct Blade {
    /// Elements, from the root.
    pub stations: [Station; STATIONS],
    /// Sections, from the root.
    pub regions: [Region; REGIONS],
    /// tan δ3.
    pub tan_delta3: f64,
    /// How heavy it is as it flaps.
    pub inertias: Inertias,
    /// The elements in lanes, from the root.
    pub(crate) groups: [Group; STATIONS / LANES],
}

/// The blade of a rotor of that radius, hinged under that angle, bending so, with those inertias.
pub fn blade(
    params: &Params,
    radius_m: f64,
    delta3_rad: f64,
    bending: &bending::Params,
    inertias: Inertias,
) -> Blade {
    let ends = &params.section.lift_coefficient.x;
    let stations = NODES.map(|(region, at, weight)| {
        let inner = if region > 0 { ends[region - 1] } else { params.root_norm };
        let width = ends[region] - inner;
        let x = inner + 0.5 * width * (1.0 + at);
        let weight_norm = 0.5 * width * weight;
        let chord_m = params.blade_chord_m.at(RadialStation(x));
        let (sin_twist, cos_twist) = sin_cos(params.twist_rad.at(RadialStation(x)));
        Station {
            region,
            radius_m: x * radius_m,
            area_m2: chord_m * weight_norm * radius_m,
            chord_m,
            delay: params.section.delay(chord_m / (x * radius_m)),
            rise_mach: params.section.rise_mach(x),
            inner_norm: inner,
            width_norm: width,
            disc_norm: 2.0 * x * weight_norm,
            sin_twist,
            cos_twist,
            displacement_m: bending.displacement(x) * radius_m,
            slope_norm: bending.slope(x),
        }
    });
    let regions = params.section.regions(params.root_norm);
    let groups = core::array::from_fn(|group| Group::new(&stations[group * LANES..], &regions));
    Blade { stations, regions, tan_delta3: tan(delta3_rad), inertias, groups }
}
