//! Arrows: what pushes and turns the aircraft, by component, and the wind.

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::frames::{Attitude, Body, Load, Ned, Structural, Vec3};
use engine::math::{cos, sin};
use engine::pair::Pair;
use engine::{GRAVITY_MPS2, struts::Struts};
use rerun::{Arrows3D, AsComponents};

use super::airframe::Mounts;
use super::basics::SIDES;
use super::columns::{Columns, point};
use super::sections::wing_quarter_m;

/// A force of 7 kN is a metre long: a rotor that hovers has an arrow of 4 m.
const M_PER_N: f64 = 1.0 / 7000.0;
/// A moment of 5 kN·m is a metre long.
const M_PER_N_M: f64 = 1.0 / 5000.0;
/// A wind of 2 m/s is a metre long.
const M_PER_MPS: f64 = 0.5;
/// The wind's arrow begins over the aircraft.
const WIND_UP_M: f64 = 5.0;

const BLUE: u32 = 0x5B_A8_F5_FF;
const ORANGE: u32 = 0xF5_A0_3C_FF;
const VIOLET: u32 = 0xB6_8C_F0_FF;
const YELLOW: u32 = 0xF0_DC_50_FF;
const CYAN: u32 = 0x48_D0_D0_FF;
const WHITE: u32 = 0xF4_F4_F4_FF;
const GREY: u32 = 0x90_90_90_FF;
const BLACK: u32 = 0x20_20_20_FF;

/// Where components are, as stations of the drawing.
pub struct Places {
    mounts: Mounts,
    wing_m: Vec3<Structural>,
    fuselage_m: Vec3<Structural>,
    tailplane_m: Vec3<Structural>,
    fin_m: Vec3<Structural>,
    tyres_m: Struts<Vec3<Structural>>,
}

impl Places {
    /// Those of an aircraft.
    pub fn of(aircraft: &Aircraft) -> Self {
        let shape = &aircraft.display;
        let middle = shape.fuselage.section_m.len() / 2;
        let [aft, _, bottom, top] =
            shape.fuselage.section_m.get(middle).copied().unwrap_or_default();
        let fins = &shape.vertical_stabilizers;
        let [up, _, fin_aft] =
            fins.section_m.get(fins.section_m.len() / 2).copied().unwrap_or_default();
        let gear = &aircraft.landing_gear;
        Self {
            mounts: Mounts::of(aircraft),
            wing_m: wing_quarter_m(&shape.wing, 0.25 * shape.wing.span_m),
            fuselage_m: Vec3::new(aft, 0.0, 0.5 * (bottom + top)),
            tailplane_m: shape.horizontal_stabilizer.quarter_chord_m,
            fin_m: Vec3::new(fin_aft, fins.buttline_m, up),
            tyres_m: Struts {
                nose: gear.nose.tyre_m,
                main: Pair { left: gear.main.tyre_m.mirrored(), right: gear.main.tyre_m },
            },
        }
    }

    /// The hubs, in body axes.
    fn hubs(&self, outputs: &Outputs) -> Pair<Vec3<Body>> {
        let datum = Vec3::<Structural>::zero().from_cg(outputs.balance.cg_m);
        self.mounts.pivots.zip(outputs.actuators.mast_tilt_rad).map(|([x, y, z], tilt_rad)| {
            let pivot = datum + Vec3::new(f64::from(x), f64::from(y), f64::from(z));
            pivot + Vec3::new(sin(tilt_rad), 0.0, -cos(tilt_rad)) * self.mounts.mast_m
        })
    }
}

/// An arrow: where it begins, and what it stands for.
type Arrow = (Vec3<Body>, Vec3<Body>);

/// Arrows that are shown together.
pub struct Arrows {
    /// Entity.
    pub entity: &'static str,
    /// Name and colour of each.
    pub each: &'static [(&'static str, u32)],
    m_per_unit: f64,
    /// Whether each has its name beside it: where they stand apart.
    named: bool,
    of: fn(&Places, &Outputs) -> Vec<Arrow>,
}

/// Loads of the components with their places.
fn components(places: &Places, outputs: &Outputs) -> [(Vec3<Body>, Load); 10] {
    let from_cg = |station: Vec3<Structural>| station.from_cg(outputs.balance.cg_m);
    let (loads, hubs) = (&outputs.loads, places.hubs(outputs));
    let datum = from_cg(Vec3::zero());
    let pivots = places.mounts.pivots.map(|at| datum + at_m(at));
    [
        (hubs.left, loads.rotors.left),
        (hubs.right, loads.rotors.right),
        (from_cg(places.wing_m.mirrored()), loads.wing_pylon.left),
        (from_cg(places.wing_m), loads.wing_pylon.right),
        (from_cg(places.fuselage_m), loads.fuselage),
        (from_cg(places.tailplane_m), loads.horizontal_stabilizer),
        (from_cg(places.fin_m.mirrored()), loads.vertical_stabilizers.left),
        (from_cg(places.fin_m), loads.vertical_stabilizers.right),
        (pivots.left, loads.jets.left),
        (pivots.right, loads.jets.right),
    ]
}

fn at_m([x, y, z]: [f32; 3]) -> Vec3<Body> {
    Vec3::new(f64::from(x), f64::from(y), f64::from(z))
}

/// Weight, in body axes.
fn weight_n(outputs: &Outputs) -> Vec3<Body> {
    let body_from_ned = Attitude::from_euler(outputs.euler).ned_from_body().inverse();
    body_from_ned * Vec3::new(0.0, 0.0, outputs.balance.mass_kg * GRAVITY_MPS2)
}

/// All of them.
pub const ARROWS: &[Arrows] = &[
    Arrows {
        entity: "world/aircraft/forces/rotors",
        each: &[("left rotor", SIDES.left), ("right rotor", SIDES.right)],
        m_per_unit: M_PER_N,
        named: true,
        of: |places, outputs| {
            components(places, outputs)[..2].iter().map(|(at, load)| (*at, load.force_n)).collect()
        },
    },
    Arrows {
        entity: "world/aircraft/forces/airframe",
        each: &[
            ("left wing", BLUE),
            ("right wing", BLUE),
            ("fuselage", ORANGE),
            ("tailplane", VIOLET),
            ("left fin", YELLOW),
            ("right fin", YELLOW),
            ("left jet", CYAN),
            ("right jet", CYAN),
        ],
        m_per_unit: M_PER_N,
        named: false,
        of: |places, outputs| {
            components(places, outputs)[2..].iter().map(|(at, load)| (*at, load.force_n)).collect()
        },
    },
    Arrows {
        entity: "world/aircraft/forces/gear",
        each: &[("nose gear", GREY), ("left gear", GREY), ("right gear", GREY)],
        m_per_unit: M_PER_N,
        named: false,
        of: |places, outputs| {
            let (tyres, legs) = (places.tyres_m, outputs.loads.landing_gear);
            [
                (tyres.nose, legs.nose),
                (tyres.main.left, legs.main.left),
                (tyres.main.right, legs.main.right),
            ]
            .map(|(at, load)| (at.from_cg(outputs.balance.cg_m), load.force_n))
            .to_vec()
        },
    },
    Arrows {
        entity: "world/aircraft/forces/sum",
        each: &[("total without weight", WHITE), ("weight", BLACK)],
        m_per_unit: M_PER_N,
        named: true,
        of: |_, outputs| {
            vec![(Vec3::zero(), outputs.total.force_n), (Vec3::zero(), weight_n(outputs))]
        },
    },
    Arrows {
        entity: "world/aircraft/moments",
        each: &[
            ("moment of the left rotor", SIDES.left),
            ("moment of the right rotor", SIDES.right),
            ("moment of the left wing", BLUE),
            ("moment of the right wing", BLUE),
            ("moment of the fuselage", ORANGE),
            ("moment of the tailplane", VIOLET),
            ("moment of the left fin", YELLOW),
            ("moment of the right fin", YELLOW),
            ("total moment", WHITE),
        ],
        m_per_unit: M_PER_N_M,
        named: false,
        of: |places, outputs| {
            let parts = components(places, outputs);
            let mut arrows: Vec<_> =
                parts[..8].iter().map(|(at, load)| (*at, load.moment_n_m)).collect();
            arrows.push((Vec3::zero(), outputs.total.moment_n_m));
            arrows
        },
    },
];

impl Arrows {
    /// What does not change: colours, names.
    pub fn still(&self) -> impl AsComponents + use<> {
        Arrows3D::update_fields()
            .with_radii([if self.entity.ends_with("moments") { 0.05 } else { 0.09 }])
            .with_colors(self.each.iter().map(|(_, colour)| *colour))
            .with_labels(self.each.iter().map(|(name, _)| *name))
            .with_show_labels(self.named)
    }

    /// What does.
    pub fn columns(&self, rows: &[Outputs], places: &Places) -> Columns {
        let arrows: Vec<Arrow> = rows.iter().flat_map(|row| (self.of)(places, row)).collect();
        Arrows3D::from_vectors(arrows.iter().map(|(_, of)| point(*of * self.m_per_unit)))
            .with_origins(arrows.iter().map(|(at, _)| point(*at)))
            .columns(std::iter::repeat_n(self.each.len(), rows.len()))
            .map(Vec::from_iter)
    }
}

/// Entity of the arrows of known length.
pub const SCALE: &str = "world/chase/scale";

/// What the others are measured by: beside the aircraft, and turning with its heading.
pub fn scale() -> impl AsComponents + use<> {
    const LENGTHS: [(&str, f64, u32); 2] = [
        ("10 kN of force", 10e3 * M_PER_N, WHITE),
        ("10 kN·m of moment", 10e3 * M_PER_N_M, ORANGE),
    ];
    let up = |(_, length_m, _): (&str, f64, u32)| [0.0, 0.0, -length_m as f32];
    Arrows3D::from_vectors(LENGTHS.map(up))
        .with_origins([[-5.5, 7.0, -0.5], [-5.5, 7.0, 2.2]])
        .with_radii([0.06])
        .with_colors(LENGTHS.map(|(_, _, colour)| colour))
        .with_labels(LENGTHS.map(|(words, ..)| words))
        .with_show_labels(true)
}

/// Entity of the wind's arrow.
pub const WIND: &str = "world/wind";

/// The wind's colour and name.
pub fn still_wind() -> impl AsComponents {
    Arrows3D::update_fields()
        .with_radii([0.08])
        .with_colors([0x30_E0_E0_FF])
        .with_labels(["wind, 1 m of arrow for 2 m/s"])
        .with_show_labels(false)
}

/// The wind over the aircraft.
pub fn wind_columns(rows: &[Outputs]) -> Columns {
    let over = |row: &Outputs| row.position_m + Vec3::<Ned>::new(0.0, 0.0, -WIND_UP_M);
    Arrows3D::from_vectors(rows.iter().map(|row| point(row.air.wind_mps * M_PER_MPS)))
        .with_origins(rows.iter().map(|row| point(over(row))))
        .columns_of_unit_batches()
        .map(Vec::from_iter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::frames::Euler;

    #[test]
    fn every_arrow_has_a_name_and_a_colour() {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15)
            .unwrap_or_else(|error| panic!("{error}"));
        let places = Places::of(&aircraft);
        for arrows in ARROWS {
            let of = (arrows.of)(&places, &Outputs::default());
            assert_eq!(of.len(), arrows.each.len(), "{}", arrows.entity);
        }
    }

    /// Rolled onto its left side, weight points to the left wing.
    #[test]
    fn weight_points_to_the_ground() {
        let mut outputs = Outputs::default();
        outputs.balance.mass_kg = 6000.0;
        outputs.euler = Euler { roll_rad: -engine::math::FRAC_PI_2, ..Euler::default() };
        let weight = weight_n(&outputs);
        assert!((weight.y + 6000.0 * GRAVITY_MPS2).abs() < 1e-6, "{weight:?}");
    }
}
