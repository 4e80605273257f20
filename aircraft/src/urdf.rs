//! The aircraft's shape as URDF, for viewers that draw robots.
//!
//! Boxes and cylinders from `[display]`, `[rotors]` and `[actuators]`. In metres; x forward, y left,
//! z up, as ROS has it. The airframe's link is at the centre of gravity of the upright nacelles, a
//! nacelle's at its pivot with the mast up, a rotor's at its hub. Links and joints are called as in
//! the frames that a log's `/tf` moves. The landing gear has no frame there and is not drawn.

use engine::aircraft::Params as Aircraft;
use engine::display::{Nacelles, Wing};
use engine::frames::{Structural, Vec3};
use engine::math::{FRAC_PI_2, PI, TAU, cos, max, sin, sqrt, tan};
use engine::table::axis::RadialStation;

/// Of a rotor's disc, m.
const DISC_M: f64 = 0.04;
/// Of a blade, m.
const BLADE_M: f64 = 0.05;
/// A blade lies this far above its disc, m.
const BLADE_UP_M: f64 = 0.03;
/// A body of revolution along x.
const ALONG_X: [f64; 3] = [0.0, FRAC_PI_2, 0.0];
const UPRIGHT: [f64; 3] = [0.0; 3];

const MATERIALS: [(&str, &str); 4] = [
    ("white", "0.92 0.92 0.90 1"),
    ("blue", "0.20 0.35 0.60 1"),
    ("grey", "0.45 0.45 0.48 1"),
    ("disc", "0.30 0.60 0.90 0.35"),
];

/// The sides: name, and where they are along the buttline.
const SIDES: [(&str, f64); 2] = [("left", -1.0), ("right", 1.0)];

/// The aircraft's shape as URDF.
pub fn urdf(aircraft: &Aircraft) -> String {
    let mut links = link("base_link", &airframe(aircraft));
    let (mut rotors, mut joints) = (String::new(), String::new());
    for (side, sign) in SIDES {
        links += &link(&format!("nacelle_{side}"), &nacelle(&aircraft.display.nacelles));
        rotors += &link(&format!("rotor_{side}"), &rotor(aircraft));
        joints += &nacelle_joint(aircraft, side, sign);
    }
    for (side, _) in SIDES {
        joints += &rotor_joint(aircraft, side);
    }
    let materials = MATERIALS.map(|(name, rgba)| {
        format!("  <material name=\"{name}\"><color rgba=\"{rgba}\"/></material>\n")
    });
    format!(
        "<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n{}{links}{rotors}{joints}</robot>\n",
        plain(&aircraft.name),
        materials.concat(),
    )
}

/// What of a name needs no quoting: small letters, digits, and `_` for what is between.
fn plain(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_ascii_lowercase).collect::<Vec<_>>().join("_")
}

/// A number to a tenth of a millimetre, as short as it can be said.
fn number(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn numbers(values: [f64; 3]) -> String {
    values.map(number).join(" ")
}

fn visual(at_m: [f64; 3], turn_rad: [f64; 3], geometry: &str, material: &str) -> String {
    format!(
        "    <visual>\n      <origin xyz=\"{}\" rpy=\"{}\"/>\n      <geometry>{geometry}</geometry>\n      \
         <material name=\"{material}\"/>\n    </visual>\n",
        numbers(at_m),
        numbers(turn_rad),
    )
}

fn cylinder(radius_m: f64, length_m: f64) -> String {
    format!("<cylinder radius=\"{}\" length=\"{}\"/>", number(radius_m), number(length_m))
}

fn a_box(size_m: [f64; 3]) -> String {
    format!("<box size=\"{}\"/>", numbers(size_m))
}

fn link(name: &str, visuals: &str) -> String {
    format!("  <link name=\"{name}\">\n{visuals}  </link>\n")
}

fn joint(name: &str, kind: &str, parent: &str, at_m: [f64; 3], rest: &str) -> String {
    format!(
        "  <joint name=\"{name}_joint\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\
         <child link=\"{name}\"/>\n    <origin xyz=\"{}\"/>{rest}\n  </joint>\n",
        numbers(at_m),
    )
}

/// A station of the drawing in the airframe's link.
fn from_station(aircraft: &Aircraft, aft_m: f64, right_m: f64, up_m: f64) -> [f64; 3] {
    let cg_m = aircraft.weight_balance.cg_m;
    [cg_m.x - aft_m, cg_m.y - right_m, up_m - cg_m.z]
}

fn airframe(aircraft: &Aircraft) -> String {
    let mut visuals = fuselage(aircraft);
    for (_, side) in SIDES {
        visuals += &half_wing(aircraft, &aircraft.display.wing, side);
    }
    visuals += &tailplane(aircraft);
    for (_, side) in SIDES {
        visuals += &fin(aircraft, side);
        visuals += &gear_pod(aircraft, side);
    }
    visuals
}

/// Cylinders between the cross-sections, the nose before the windscreen in blue.
fn fuselage(aircraft: &Aircraft) -> String {
    let fuselage = &aircraft.display.fuselage;
    let slice = |pair: &[[f64; 4]]| {
        let [front, back] = [pair[0], pair[1]];
        let radius_m = |[_, half, bottom, top]: [f64; 4]| sqrt(half * 0.5 * (top - bottom));
        let middle_m = 0.5 * (front[0] + back[0]);
        let up_m = 0.25 * (front[2] + front[3] + back[2] + back[3]);
        visual(
            from_station(aircraft, middle_m, 0.0, up_m),
            ALONG_X,
            &cylinder(0.5 * (radius_m(front) + radius_m(back)), back[0] - front[0]),
            if middle_m < fuselage.windscreen_m[0] { "blue" } else { "white" },
        )
    };
    fuselage.section_m.windows(2).map(slice).collect()
}

fn half_wing(aircraft: &Aircraft, wing: &Wing, side: f64) -> String {
    let half_m = 0.5 * wing.span_m;
    let out_m = 0.5 * half_m - wing.quarter_chord_m.y;
    visual(
        from_station(
            aircraft,
            wing.quarter_chord_m.x + tan(wing.sweep_rad) * out_m + 0.25 * wing.chord_m,
            side * 0.5 * half_m,
            wing.quarter_chord_m.z + tan(wing.dihedral_rad) * out_m,
        ),
        // Roll to the right and turn to the left are positive.
        [-side * wing.dihedral_rad, 0.0, -side * wing.sweep_rad],
        &a_box([wing.chord_m, half_m, wing.thickness_ratio * wing.chord_m]),
        "white",
    )
}

fn tailplane(aircraft: &Aircraft) -> String {
    let plane = &aircraft.display.horizontal_stabilizer;
    let Vec3 { x, z, .. } = plane.quarter_chord_m;
    visual(
        from_station(aircraft, x + 0.25 * plane.chord_m, 0.0, z),
        UPRIGHT,
        &a_box([plane.chord_m, plane.span_m, plane.thickness_ratio * plane.chord_m]),
        "white",
    )
}

fn fin(aircraft: &Aircraft, side: f64) -> String {
    let fins = &aircraft.display.vertical_stabilizers;
    let panel = |pair: &[[f64; 3]]| {
        let mean = |i: usize| 0.5 * (pair[0][i] + pair[1][i]);
        let (up_m, chord_m, quarter_chord_m) = (mean(0), mean(1), mean(2));
        visual(
            from_station(aircraft, quarter_chord_m + 0.25 * chord_m, side * fins.buttline_m, up_m),
            UPRIGHT,
            &a_box([chord_m, fins.thickness_ratio * chord_m, pair[1][0] - pair[0][0]]),
            "blue",
        )
    };
    fins.section_m.windows(2).map(panel).collect()
}

fn gear_pod(aircraft: &Aircraft, side: f64) -> String {
    let pods = &aircraft.display.gear_pods;
    let slice = |pair: &[[f64; 2]]| {
        let ([front_m, before_m], [back_m, after_m]) = (pair[0], pair[1]);
        let middle_m = 0.5 * (front_m + back_m);
        visual(
            from_station(aircraft, middle_m, side * pods.buttline_m, pods.waterline_m),
            ALONG_X,
            &cylinder(0.5 * (before_m + after_m), back_m - front_m),
            "white",
        )
    };
    pods.section_m.windows(2).map(slice).collect()
}

/// A nacelle with its spinner, which shows no turning.
fn nacelle(nacelles: &Nacelles) -> String {
    let slice = |pair: &[[f64; 3]], material: &str| {
        let radius_m = |[_, deep, wide]: [f64; 3]| sqrt(deep * wide);
        visual(
            [0.0, 0.0, -0.5 * (pair[0][0] + pair[1][0])],
            UPRIGHT,
            &cylinder(0.5 * (radius_m(pair[0]) + radius_m(pair[1])), pair[0][0] - pair[1][0]),
            material,
        )
    };
    let pod = nacelles.section_m.windows(2).map(|pair| slice(pair, "grey"));
    pod.chain(nacelles.spinner_m.windows(2).map(|pair| slice(pair, "blue"))).collect()
}

/// A disc and the blades on it, the first one aft.
fn rotor(aircraft: &Aircraft) -> String {
    let rotors = &aircraft.rotors;
    let (radius_m, blade) = (rotors.radius_m, &rotors.blade);
    let mut visuals = visual([0.0; 3], UPRIGHT, &cylinder(radius_m, DISC_M), "disc");
    let middle_m = 0.5 * (1.0 + blade.root_norm) * radius_m;
    let length_m = (1.0 - blade.root_norm) * radius_m;
    let size_m = [length_m, blade.blade_chord_m.at(RadialStation(1.0)), BLADE_M];
    for number in 0..blade.count as u32 {
        let azimuth_rad = PI + TAU * f64::from(number) / blade.count;
        visuals += &visual(
            [middle_m * cos(azimuth_rad), middle_m * sin(azimuth_rad), BLADE_UP_M],
            [0.0, 0.0, azimuth_rad],
            &a_box(size_m),
            "grey",
        );
    }
    visuals
}

fn nacelle_joint(aircraft: &Aircraft, side: &str, sign: f64) -> String {
    let Vec3 { x, y, z, .. }: Vec3<Structural> = aircraft.rotors.pivot_m;
    let actuators = &aircraft.actuators;
    let rate_radps = actuators.nacelle_radps.y.iter().fold(0.0, |rate, &at| max(rate, at));
    let rest = format!(
        "<axis xyz=\"0 1 0\"/>\n    <limit lower=\"{}\" upper=\"{}\" effort=\"0\" velocity=\"{}\"/>",
        number(actuators.mast_tilt_rad_min),
        number(actuators.mast_tilt_rad_max),
        number(rate_radps),
    );
    let at_m = from_station(aircraft, x, sign * y, z);
    joint(&format!("nacelle_{side}"), "revolute", "base_link", at_m, &rest)
}

fn rotor_joint(aircraft: &Aircraft, side: &str) -> String {
    let at_m = [0.0, 0.0, aircraft.rotors.mast_length_m];
    let parent = format!("nacelle_{side}");
    joint(&format!("rotor_{side}"), "continuous", &parent, at_m, "<axis xyz=\"0 0 1\"/>")
}
