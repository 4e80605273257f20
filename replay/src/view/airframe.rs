//! The aircraft as meshes, from the shape in its file.
//!
//! The airframe's axes are the body's (forward, right, down) with their origin at the datum of the
//! drawings: a station (aft, right, up) is drawn at (−aft, right, −up). A nacelle's axes are the
//! Mast's with their origin at the pivot. Shapes are for recognition; pivots, hubs, rotors, spans and
//! chords are those the aircraft is given.

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::display::{Fins, Fuselage, GearPods, Tailplane, Wheels, Wing};
use engine::frames::{Structural, Vec3};
use engine::math::{TAU, cos, sin, tan};
use engine::pair::Pair;
use engine::struts::Struts;
use engine::table::axis::RadialStation;
use rerun::Mesh3D;
use rerun::components::AlbedoFactor;

use super::sections::{BLUE, WHITE, WHOLE, section, station, wing_quarter_m};
use super::solid::{Point, Solid, refine, ring};
use super::surfaces;

const GLASS: u32 = 0x1C_2A_38_FF;
const DARK: u32 = 0x3A_3E_44_FF;
const BLADE: u32 = 0x2A_2C_30_FF;
const TIP: u32 = 0xF2_C0_30_FF;

/// Where the parts that move sit on the airframe.
#[derive(Clone, Copy)]
pub struct Mounts {
    /// Nacelle pivots in the airframe's axes.
    pub pivots: Pair<Point>,
    /// From pivot to hub.
    pub mast_m: f64,
    /// How far the gear moves up.
    pub gear_travel_m: f32,
    /// Surfaces: where they turn and about what.
    pub hinges: [Hinge; 7],
}

/// A surface without its shape.
#[derive(Clone, Copy)]
pub struct Hinge {
    /// Entity.
    pub entity: &'static str,
    /// A point of the hinge.
    pub at: Point,
    /// Along the hinge.
    pub axis: [f64; 3],
    /// How far it is turned.
    pub angle_rad: fn(&Outputs) -> f64,
}

impl Mounts {
    /// Those of an aircraft.
    pub fn of(aircraft: &Aircraft) -> Self {
        let Vec3 { x, y, z, .. } = aircraft.rotors.pivot_m;
        Self {
            pivots: Pair { left: -y, right: y }
                .map(|right| station(x as f32, right as f32, z as f32)),
            mast_m: aircraft.rotors.mast_length_m,
            gear_travel_m: aircraft.landing_gear.retraction_m as f32,
            hinges: hinges(aircraft),
        }
    }

    /// The hub in a nacelle's axes.
    pub fn hub(&self) -> Point {
        [0.0, 0.0, -self.mast_m as f32]
    }
}

/// Below the airframe, by the names of the surfaces.
const HINGED: [&str; 7] = [
    "world/aircraft/airframe/flap_left",
    "world/aircraft/airframe/flap_right",
    "world/aircraft/airframe/flaperon_left",
    "world/aircraft/airframe/flaperon_right",
    "world/aircraft/airframe/elevator",
    "world/aircraft/airframe/rudder_left",
    "world/aircraft/airframe/rudder_right",
];

fn hinges(aircraft: &Aircraft) -> [Hinge; 7] {
    let surfaces = surfaces::surfaces(aircraft);
    HINGED.map(|entity| {
        let surface = surfaces.iter().find(|surface| entity.ends_with(surface.name));
        let still = Hinge { entity, at: [0.0; 3], axis: [0.0, 1.0, 0.0], angle_rad: |_| 0.0 };
        surface.map_or(still, |surface| Hinge {
            entity,
            at: surface.hinge_m[0],
            axis: surface.axis(),
            angle_rad: surface.angle_rad,
        })
    })
}

/// Everything that neither tilts nor turns.
pub fn airframe(aircraft: &Aircraft) -> Solid {
    let mut solid = Solid::default();
    let shape = &aircraft.display;
    fuselage(&mut solid, &shape.fuselage);
    wing(&mut solid, &shape.wing);
    tailplane(&mut solid, &shape.horizontal_stabilizer);
    fins(&mut solid, &shape.vertical_stabilizers);
    pods(&mut solid, &shape.gear_pods);
    solid
}

/// The stripe along the side begins this far behind the nose, m.
const STRIPE_FROM_NOSE_M: f32 = 0.45;
/// The end of the fuselage is painted over this length, m.
const PAINTED_END_M: f32 = 1.14;
/// Half the width of the windscreen's post, m.
const POST_M: f32 = 0.05;
/// Stations of the post behind the windscreen's middle, from its front end, m.
const SIDE_POST_M: std::ops::Range<f32> = 0.70..0.83;

fn fuselage(solid: &mut Solid, shape: &Fuselage) {
    let rings: Vec<_> = shape
        .section_m
        .iter()
        .map(|section| {
            let [aft, half, bottom, top] = section.map(|x| x as f32);
            let (middle, tall) = (0.5 * (bottom + top), 0.5 * (top - bottom));
            ring(40, |s, c| {
                // Between an ellipse and a box.
                let round = |v: f32| v.signum() * v.abs().powf(0.72);
                station(aft, half * round(s), middle + tall * round(c))
            })
        })
        .collect();
    let [Some(nose), Some(end)] = [shape.section_m.first(), shape.section_m.last()] else { return };
    let stripe_from = nose[0] as f32 + STRIPE_FROM_NOSE_M;
    let painted_from = end[0] as f32 - PAINTED_END_M;
    let [windscreen, side_window] =
        [shape.windscreen_m, shape.side_window_m].map(|window| window.map(|x| x as f32));
    let densely = refine(&rings, 5);
    solid.skin(&densely, |point, at| {
        let [aft, right, up] = [-at[0], at[1].abs(), -at[2]];
        let behind = |[from, to, bottom, top]: [f32; 4]| {
            (from..to).contains(&aft) && up > bottom && up < top
        };
        let post = right < POST_M || SIDE_POST_M.contains(&(aft - windscreen[0]));
        let stripe = matches!(point, 11..=12 | 28..=29) && aft > stripe_from;
        match () {
            () if (behind(windscreen) || behind(side_window)) && !post => GLASS,
            () if stripe || aft > painted_from => BLUE,
            () => WHITE,
        }
    });
}

fn wing(solid: &mut Solid, wing: &Wing) {
    let half_span = 0.5 * wing.span_m;
    let mut span = |from: f64, to: f64, part: [f32; 2]| {
        let rings = [from, to].map(|right| {
            let quarter = wing_quarter_m(wing, right);
            section(quarter, wing.chord_m, wing.thickness_ratio, false, part)
        });
        solid.skin(&rings, |_, _| WHITE);
    };
    let ([inner, _], [_, outer]) = (surfaces::FLAP_M, surfaces::FLAPERON_M);
    let before = [0.0, surfaces::WING_HINGE_NORM as f32];
    for side in [-1.0, 1.0] {
        span(0.0, side * inner, WHOLE);
        span(side * inner, side * outer, before);
        span(side * outer, side * half_span, WHOLE);
    }
}

fn tailplane(solid: &mut Solid, plane: &Tailplane) {
    let rings = [-0.5, 0.5].map(|part| {
        let Vec3 { x, z, .. } = plane.quarter_chord_m;
        let quarter = Vec3::new(x, part * plane.span_m, z);
        let before = [0.0, surfaces::TAIL_HINGE_NORM as f32];
        section(quarter, plane.chord_m, plane.thickness_ratio, false, before)
    });
    solid.skin(&rings, |_, _| WHITE);
}

/// The fins' tips are painted over this height, m.
const PAINTED_TIP_M: f32 = 0.6;

fn fins(solid: &mut Solid, fins: &Fins) {
    let Some(&[tip_m, ..]) = fins.section_m.last() else { return };
    let painted_from = tip_m as f32 - PAINTED_TIP_M;
    for right in [-fins.buttline_m, fins.buttline_m] {
        let fin: Vec<_> = fins
            .section_m
            .iter()
            .map(|&[up, chord, aft]| {
                let before = [0.0, surfaces::TAIL_HINGE_NORM as f32];
                section(Vec3::new(aft, right, up), chord, fins.thickness_ratio, true, before)
            })
            .collect();
        let paint = |_, at: Point| if -at[2] > painted_from { BLUE } else { WHITE };
        solid.skin(&refine(&fin, 6), paint);
    }
}

/// The pods of the main gear.
fn pods(solid: &mut Solid, pods: &GearPods) {
    let (out, middle) = (pods.buttline_m as f32, pods.waterline_m as f32);
    for side in [-1.0, 1.0] {
        let rings: Vec<_> = pods
            .section_m
            .iter()
            .map(|section| {
                let [aft, radius] = section.map(|x| x as f32);
                ring(20, |s, c| station(aft, side * out + radius * s, middle + radius * c))
            })
            .collect();
        solid.skin(&rings, |_, _| WHITE);
    }
}

/// Wheels and leg of each strut, extended.
pub fn gear(aircraft: &Aircraft) -> Struts<Solid> {
    let (gear, shape) = (&aircraft.landing_gear, &aircraft.display);
    let axle_m = shape.main_wheels.axle_m(&gear.main);
    let one = |wheels: &Wheels, axle_m| {
        let mut solid = Solid::default();
        leg(&mut solid, wheels, axle_m);
        solid
    };
    Struts {
        nose: one(&shape.nose_wheels, shape.nose_wheels.axle_m(&gear.nose)),
        main: Pair {
            left: one(&shape.main_wheels, Vec3::new(axle_m.x, -axle_m.y, axle_m.z)),
            right: one(&shape.main_wheels, axle_m),
        },
    }
}

fn leg(solid: &mut Solid, wheels: &Wheels, axle_m: Vec3<Structural>) {
    let [aft, right, axle] = [axle_m.x, axle_m.y, axle_m.z].map(|x| x as f32);
    let [radius, thick, top] =
        [wheels.radius_m, wheels.leg_radius_m, wheels.leg_top_waterline_m].map(|x| x as f32);
    let [half_width, half_spacing] =
        [wheels.width_m, wheels.spacing_m].map(|whole| 0.5 * whole as f32);
    for offset in [-half_spacing, half_spacing] {
        let wheel = [-half_width, half_width].map(|half| {
            ring(20, |s, c| station(aft + radius * s, right + offset + half, axle + radius * c))
        });
        solid.skin(&wheel, |_, _| DARK);
    }
    let strut =
        [axle, top].map(|up| ring(10, |s, c| station(aft + thick * s, right + thick * c, up)));
    solid.skin(&strut, |_, _| WHITE);
}

/// A nacelle's exhaust is dark over this length, m.
const EXHAUST_M: f32 = 0.42;
/// A nacelle's painted band begins this far behind its front end, and is this wide, m.
const BAND_M: [f32; 2] = [0.25, 0.35];

/// A nacelle and its spinner, in the mast's axes.
pub fn nacelle(aircraft: &Aircraft) -> Solid {
    let shape = &aircraft.display.nacelles;
    let rings = |sections: &[[f64; 3]]| -> Vec<Vec<Point>> {
        let one = |section: &[f64; 3]| {
            let [down, deep, wide] = section.map(|x| x as f32);
            ring(28, |s, c| [deep * c, wide * s, down])
        };
        sections.iter().map(one).collect()
    };
    let mut solid = Solid::default();
    let [Some(back), Some(front)] = [shape.section_m.first(), shape.section_m.last()] else {
        return solid;
    };
    let exhaust_from = back[0] as f32 - EXHAUST_M;
    let band_from = front[0] as f32 + BAND_M[0];
    let band = band_from..band_from + BAND_M[1];
    solid.skin(&rings(&shape.section_m), |_, at| match at[2] {
        down if down > exhaust_from => DARK,
        down if band.contains(&down) => BLUE,
        _ => WHITE,
    });
    solid.skin(&rings(&shape.spinner_m), |_, _| BLUE);
    solid
}

/// Part of the radius from which a blade is seen, and from which its tip is painted.
const ROOT_NORM: f32 = 0.10;
const PAINTED_NORM: f32 = 0.903;

/// The blades, the first one aft.
pub fn blades(aircraft: &Aircraft) -> Solid {
    let rotors = &aircraft.rotors;
    let radius = rotors.radius_m as f32;
    let half = 0.5 * rotors.blade.blade_chord_m.at(RadialStation(1.0)) as f32;
    let mut solid = Solid::default();
    for blade in 0..rotors.blade.count as u8 {
        let azimuth_rad = TAU * f64::from(blade) / rotors.blade.count;
        let (s, c) = (sin(azimuth_rad) as f32, cos(azimuth_rad) as f32);
        let rings = [ROOT_NORM, 0.90, 0.905, 1.0].map(|part| {
            let out = part * radius;
            let down = -coning(aircraft) * out;
            [(half, -0.02), (half, 0.02), (-half, 0.02), (-half, -0.02)]
                .map(|(across, thick)| [-out * c - across * s, across * c - out * s, down + thick])
                .to_vec()
        });
        let tip = PAINTED_NORM * radius;
        solid.skin(&rings, |_, [x, y, _]| if x * x + y * y > tip * tip { TIP } else { BLADE });
    }
    solid
}

/// How far a blade rises on its way out.
fn coning(aircraft: &Aircraft) -> f32 {
    tan(aircraft.rotors.flapping.precone_rad) as f32
}

/// What a turning rotor looks like.
pub fn disc(aircraft: &Aircraft, colour: u32) -> Mesh3D {
    let mut solid = Solid::default();
    let radius = aircraft.rotors.radius_m as f32;
    let rim = ring(72, |s, c| [radius * c, radius * s, -coning(aircraft) * radius]);
    solid.fan(&rim, [0.0, 0.0, -1.0], colour);
    solid.mesh().with_albedo_factor(AlbedoFactor::from(rerun::Rgba32(0xFF_FF_FF_48)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn xv15() -> engine::Aircraft {
        aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn every_corner_exists_and_every_number_is_finite() {
        let xv15 = xv15();
        let Struts { nose, main } = gear(&xv15);
        let surfaces = surfaces::surfaces(&xv15).into_iter().map(|surface| surface.solid);
        let fixed = [airframe(&xv15), nose, main.left, main.right, nacelle(&xv15), blades(&xv15)];
        for solid in fixed.into_iter().chain(surfaces) {
            let count = u32::try_from(solid.positions.len()).unwrap();
            assert_eq!(solid.normals.len(), solid.positions.len());
            assert_eq!(solid.colours.len(), solid.positions.len());
            assert!(solid.triangles.iter().flatten().all(|&corner| corner < count));
            assert!(solid.positions.iter().chain(&solid.normals).flatten().all(|x| x.is_finite()));
        }
    }

    #[test]
    fn the_spans_are_those_of_the_sheet() {
        let solid = airframe(&xv15());
        let extent = |axis: usize| {
            let along = solid.positions.iter().map(|at| at[axis]);
            along.clone().fold(f32::MIN, f32::max) - along.fold(f32::MAX, f32::min)
        };
        // 9.8 m between nacelle centrelines; the nacelles hide the wing's ends.
        assert!((extent(1) - 9.5).abs() < 0.01, "{}", extent(1));
        assert!((12.4..14.1).contains(&extent(0)), "{}", extent(0));
    }
}
