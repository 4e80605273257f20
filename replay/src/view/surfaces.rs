//! Flaps, flaperons, elevator and rudders: where they turn, how far, and what they look like.
//!
//! The aircraft's file has wing, tailplane and fins, not what is cut out of them: spans and hinges here are
//! those of FlightGear's model of it, for recognition.

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::frames::Vec3;
use engine::units::{degrees, radians};

use super::sections::{BLUE, WHITE, section, station, wing_quarter_m};
use super::solid::{Point, Solid};

/// Flaps and flaperons begin here, in parts of the chord.
pub const WING_HINGE_NORM: f64 = 0.74;
/// The flap from buttline to buttline, m.
pub const FLAP_M: [f64; 2] = [0.95, 2.33];
/// The flaperon, m.
pub const FLAPERON_M: [f64; 2] = [2.33, 4.34];
/// Elevator and rudders begin here.
pub const TAIL_HINGE_NORM: f64 = 0.70;

/// Flaps, and how far the flaperons droop with them, deg. `TMX §3.3`
const DROOP_DEG: [[f64; 2]; 4] = [[0.0, 0.0], [20.0, 12.5], [40.0, 25.0], [75.0, 47.0]];

/// Something that turns about a hinge.
pub struct Surface {
    /// Below the airframe's entity.
    pub name: &'static str,
    /// Two points of its hinge in the airframe's axes; it turns about the line from the first to the second.
    pub hinge_m: [Point; 2],
    /// Its shape, from the first of these points.
    pub solid: Solid,
    /// How far it is turned.
    pub angle_rad: fn(&Outputs) -> f64,
}

impl Surface {
    /// The unit vector that it turns about.
    pub fn axis(&self) -> [f64; 3] {
        let [a, b] = self.hinge_m;
        let along = [0, 1, 2].map(|i| f64::from(b[i] - a[i]));
        let length = engine::math::sqrt(along.iter().map(|x| x * x).sum());
        along.map(|x| x / length)
    }
}

/// How far the flaperons droop with the flaps.
fn droop_rad(outputs: &Outputs) -> f64 {
    let flap_deg = degrees(outputs.actuators.flap_rad);
    let [last, beyond] = DROOP_DEG[DROOP_DEG.len() - 1];
    let within = DROOP_DEG.windows(2).find(|pair| flap_deg < pair[1][0]);
    radians(within.map_or(beyond * flap_deg / last, |pair| {
        let [[a, at_a], [b, at_b]] = [pair[0], pair[1]];
        at_a + (at_b - at_a) * (flap_deg - a) / (b - a)
    }))
}

/// Every surface of an aircraft. About a hinge that points to the right, a trailing edge goes down when it
/// turns by a positive angle; about one that points down, to the left.
pub fn surfaces(aircraft: &Aircraft) -> Vec<Surface> {
    let flap = |o: &Outputs| o.actuators.flap_rad;
    let [left_flaperon, right_flaperon]: [fn(&Outputs) -> f64; 2] = [
        |o| droop_rad(o) + o.actuators.flaperon_rad.left,
        |o| droop_rad(o) + o.actuators.flaperon_rad.right,
    ];
    vec![
        of_wing(aircraft, "flap_left", FLAP_M.map(|right| -right), flap),
        of_wing(aircraft, "flap_right", FLAP_M, flap),
        of_wing(aircraft, "flaperon_left", FLAPERON_M.map(|right| -right), left_flaperon),
        of_wing(aircraft, "flaperon_right", FLAPERON_M, right_flaperon),
        elevator(aircraft),
        rudder(aircraft, "rudder_left", -1.0),
        rudder(aircraft, "rudder_right", 1.0),
    ]
}

/// The surface itself and its hinge, from sections whose front ends are on the hinge.
fn surface(
    name: &'static str,
    hinge_m: [Point; 2],
    rings: &[Vec<Point>],
    colour: u32,
    angle_rad: fn(&Outputs) -> f64,
) -> Surface {
    let from = hinge_m[0];
    let rings: Vec<Vec<Point>> = rings
        .iter()
        .map(|ring| ring.iter().map(|at| [0, 1, 2].map(|i| at[i] - from[i])).collect())
        .collect();
    let mut solid = Solid::default();
    solid.skin(&rings, |_, _| colour);
    Surface { name, hinge_m, solid, angle_rad }
}

fn of_wing(
    aircraft: &Aircraft,
    name: &'static str,
    mut ends_m: [f64; 2],
    angle_rad: fn(&Outputs) -> f64,
) -> Surface {
    // From left to right.
    ends_m.sort_by(f64::total_cmp);
    let wing = &aircraft.display.wing;
    let hinge = ends_m.map(|right| {
        let quarter = wing_quarter_m(wing, right);
        let aft = quarter.x + (WING_HINGE_NORM - 0.25) * wing.chord_m;
        station(aft as f32, right as f32, quarter.z as f32)
    });
    let behind = [WING_HINGE_NORM as f32, 1.0];
    let rings = ends_m.map(|right| {
        section(wing_quarter_m(wing, right), wing.chord_m, wing.thickness_ratio, false, behind)
    });
    let colour = if name.starts_with("flaperon") { BLUE } else { 0x9C_B4_D8_FF };
    surface(name, hinge, &rings, colour, angle_rad)
}

fn elevator(aircraft: &Aircraft) -> Surface {
    let plane = &aircraft.display.horizontal_stabilizer;
    let at = plane.quarter_chord_m;
    let ends_m = [-0.5 * plane.span_m, 0.5 * plane.span_m];
    let behind = [TAIL_HINGE_NORM as f32, 1.0];
    let hinge = ends_m.map(|right| {
        let aft = at.x + (TAIL_HINGE_NORM - 0.25) * plane.chord_m;
        station(aft as f32, right as f32, at.z as f32)
    });
    let rings = ends_m.map(|right| {
        section(Vec3::new(at.x, right, at.z), plane.chord_m, plane.thickness_ratio, false, behind)
    });
    surface("elevator", hinge, &rings, WHITE, |o| o.actuators.elevator_rad)
}

fn rudder(aircraft: &Aircraft, name: &'static str, side: f64) -> Surface {
    let fins = &aircraft.display.vertical_stabilizers;
    let right = side * fins.buttline_m;
    let behind = [TAIL_HINGE_NORM as f32, 1.0];
    let hinge = |&[up, chord, aft]: &[f64; 3]| {
        station((aft + (TAIL_HINGE_NORM - 0.25) * chord) as f32, right as f32, up as f32)
    };
    let rings: Vec<_> = fins
        .section_m
        .iter()
        .map(|&[up, chord, aft]| {
            section(Vec3::new(aft, right, up), chord, fins.thickness_ratio, true, behind)
        })
        .collect();
    let (Some(lowest), Some(highest)) = (fins.section_m.first(), fins.section_m.last()) else {
        return surface(name, [[0.0; 3], [0.0, 0.0, 1.0]], &[], WHITE, |_| 0.0);
    };
    // From the top down; trailing edge right is the other way round.
    surface(name, [hinge(highest), hinge(lowest)], &rings, BLUE, |o| -o.actuators.rudder_right_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::math::{cos, sin};

    fn xv15() -> engine::Aircraft {
        aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
    }

    /// A point turned about an axis (Rodrigues).
    fn turned(axis: [f64; 3], angle_rad: f64, at: [f64; 3]) -> [f64; 3] {
        let dot: f64 = (0..3).map(|i| axis[i] * at[i]).sum();
        let cross = [
            axis[1] * at[2] - axis[2] * at[1],
            axis[2] * at[0] - axis[0] * at[2],
            axis[0] * at[1] - axis[1] * at[0],
        ];
        let (s, c) = (sin(angle_rad), cos(angle_rad));
        [0, 1, 2].map(|i| at[i] * c + cross[i] * s + axis[i] * dot * (1.0 - c))
    }

    #[test]
    fn trailing_edges_go_where_the_signs_say() {
        let mut outputs = Outputs::default();
        outputs.actuators.flap_rad = 0.3;
        outputs.actuators.flaperon_rad.left = 0.2;
        outputs.actuators.flaperon_rad.right = -0.4;
        outputs.actuators.elevator_rad = 0.1;
        outputs.actuators.rudder_right_rad = 0.2;
        // Down is +z, right is +y.
        let expected = [
            ("flap_left", 2, 1.0),
            ("flap_right", 2, 1.0),
            ("flaperon_left", 2, 1.0),
            ("flaperon_right", 2, -1.0),
            ("elevator", 2, 1.0),
            ("rudder_left", 1, 1.0),
            ("rudder_right", 1, 1.0),
        ];
        let found = surfaces(&xv15());
        assert_eq!(found.len(), expected.len());
        for (surface, (name, along, sign)) in found.iter().zip(expected) {
            assert_eq!(surface.name, name);
            let trailing_edge = [-1.0, 0.0, 0.0];
            let moved = turned(surface.axis(), (surface.angle_rad)(&outputs), trailing_edge);
            assert!(moved[along] * sign > 0.01, "{name}: {moved:?}");
        }
    }

    #[test]
    fn flaperons_droop_as_published() {
        for [flap_deg, droop_deg] in DROOP_DEG {
            let mut outputs = Outputs::default();
            outputs.actuators.flap_rad = radians(flap_deg);
            assert!((degrees(droop_rad(&outputs)) - droop_deg).abs() < 1e-9, "{flap_deg}");
        }
        let mut outputs = Outputs::default();
        outputs.actuators.flap_rad = radians(30.0);
        assert!((degrees(droop_rad(&outputs)) - 18.75).abs() < 1e-9);
    }
}
