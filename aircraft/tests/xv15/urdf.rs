//! The aircraft's shape as URDF: every body where the aircraft file has it, and as large.

use std::ops::Range;

use aircraft::XV15;
use engine::Aircraft;
use engine::aircraft::Params;

fn read(text: &str) -> Aircraft {
    aircraft::aircraft("xv15.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn xv15() -> Aircraft {
    read(XV15)
}

/// A number of the text is to a tenth of a millimetre.
const WRITTEN_M: f64 = 1e-4;

/// Values of an attribute of the elements called `element`, in order.
fn attributes<'a>(urdf: &'a str, element: &str, attribute: &str) -> Vec<&'a str> {
    let (open, name) = (format!("<{element} "), format!("{attribute}=\""));
    let value = |tag: &'a str| {
        let tag = &tag[..tag.find('>').unwrap()];
        let from = tag.find(&name).unwrap() + name.len();
        &tag[from..from + tag[from..].find('"').unwrap()]
    };
    urdf.split(&open).skip(1).map(value).collect()
}

fn of(change: impl FnOnce(&mut Params)) -> String {
    aircraft::urdf(&xv15().with(change))
}

/// What is drawn of a link: where its middle is, m; its numbers (a box's size, or a cylinder's radius and length, m);
/// its material.
struct Body {
    at_m: [f64; 3],
    size_m: Vec<f64>,
    material: String,
}

fn bodies(urdf: &str, link: &str) -> Vec<Body> {
    let (_, rest) = urdf.split_once(&format!("<link name=\"{link}\">")).expect(link);
    let (link, _) = rest.split_once("</link>").expect(link);
    let numbers = |text: &str| -> Vec<f64> {
        text.split(' ').map(|number| number.parse().expect("a number")).collect()
    };
    let body = |visual: &str| {
        let only = |element, attribute| *attributes(visual, element, attribute).first().unwrap();
        let size_m = if visual.contains("<box ") {
            numbers(only("box", "size"))
        } else {
            ["radius", "length"].map(|name| numbers(only("cylinder", name))[0]).to_vec()
        };
        let at_m = numbers(only("origin", "xyz")).try_into().expect("three");
        Body { at_m, size_m, material: only("material", "name").into() }
    };
    link.split("<visual>").skip(1).map(body).collect()
}

fn near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1.5 * WRITTEN_M, "{found} m, not {wanted} m");
}

/// Slices along an axis of theirs, front or top first, of which each begins where the one before ends.
fn follow_one_another(slices: &[Body], axis: usize, ends_m: Range<f64>) {
    let mut from_m = ends_m.start;
    for slice in slices {
        near(slice.at_m[axis] + 0.5 * slice.size_m[1], from_m);
        from_m -= slice.size_m[1];
    }
    assert!((from_m - ends_m.end).abs() < slices.len() as f64 * WRITTEN_M, "{from_m} m");
}

#[test]
fn a_rotor_of_19_ft_is_drawn_with_19_ft() {
    let was = "radius_ft = { value = 12.5";
    assert_eq!(XV15.matches(was).count(), 1);
    let larger = aircraft::urdf(&read(&XV15.replace(was, "radius_ft = { value = 19.0")));
    let discs = |urdf: &str, radius: &str| {
        urdf.matches(&format!("<cylinder radius=\"{radius}\" length=\"0.04\"/>")).count()
    };
    assert_eq!((discs(&larger, "3.81"), discs(&larger, "5.7912")), (0, 2));
    let today = aircraft::urdf(&xv15());
    assert_eq!((discs(&today, "3.81"), discs(&today, "5.7912")), (2, 0));
    // Six blades grow with it, nothing else.
    let boxes = |urdf: &str| attributes(urdf, "box", "size").join(",");
    assert_eq!(boxes(&larger).matches("5.2845 0.3556 0.05").count(), 6);
    assert_eq!(boxes(&today), boxes(&larger).replace("5.2845 0.3556", "3.4766 0.3556"));
}

/// Blades lie where their azimuth says, the first one aft.
#[test]
fn blades_are_a_third_of_a_turn_apart() {
    let blades = bodies(&aircraft::urdf(&xv15()), "rotor_left").split_off(1);
    let middle_m = 0.5 * 3.4766 + (3.81 - 3.4766);
    for (blade, [along, across]) in blades.iter().zip([[-1.0, 0.0], [0.5, -0.866], [0.5, 0.866]]) {
        let [x, y, _] = blade.at_m;
        assert!((x - along * middle_m).abs() < 1e-3 && (y - across * middle_m).abs() < 1e-3);
    }
    assert_eq!(blades.len(), 3);
}

/// By hand: pivots at SL 300, BL 193, WL 100 in, the centre of gravity at SL 301.2, WL 81.65 in.
#[test]
fn joints_are_where_pivots_and_hubs_are() {
    let urdf = aircraft::urdf(&xv15());
    let joints = urdf.split("<joint ").skip(1).collect::<Vec<_>>().join("");
    let origins = attributes(&joints, "origin", "xyz");
    let hub = "0 0 1.4225";
    assert_eq!(origins, ["0.0305 4.9022 0.4661", "0.0305 -4.9022 0.4661", hub, hub]);
    assert_eq!(attributes(&joints, "limit", "lower"), ["-0.0873"; 2]);
    assert_eq!(attributes(&joints, "limit", "upper"), ["1.5708"; 2]);
    let shorter = of(|params| params.rotors.mast_length_m = 1.0);
    assert_eq!(shorter.matches("<origin xyz=\"0 0 1\"/>").count(), 2);
}

/// The bodies of the airframe, in order.
struct Airframe {
    aircraft: Aircraft,
    fuselage: Vec<Body>,
    wing: Vec<Body>,
    tailplane: Body,
    /// Left at +1, as URDF has it, and right: the side, the fin's panels, the pod's slices.
    sides: Vec<(f64, Vec<Body>, Vec<Body>)>,
}

fn airframe() -> Airframe {
    let aircraft = xv15();
    let shape = &aircraft.display;
    let mut rest = bodies(&aircraft::urdf(&aircraft), "base_link");
    let mut take = |count: usize| rest.drain(..count).collect::<Vec<_>>();
    let fuselage = take(shape.fuselage.section_m.len() - 1);
    let (wing, tailplane) = (take(2), take(1).remove(0));
    let sides = [1.0, -1.0].map(|side| {
        let fin = take(shape.vertical_stabilizers.section_m.len() - 1);
        (side, fin, take(shape.gear_pods.section_m.len() - 1))
    });
    assert!(rest.is_empty(), "{} bodies more", rest.len());
    Airframe { fuselage, wing, tailplane, sides: sides.into(), aircraft }
}

#[test]
fn the_fuselage_is_whole_from_nose_to_tail() {
    let Airframe { aircraft, fuselage, .. } = airframe();
    let (shape, cg_m) = (&aircraft.display.fuselage, aircraft.weight_balance.cg_m);
    follow_one_another(&fuselage, 0, cg_m.x - 2.85..cg_m.x - 15.34);
    for (slice, pair) in fuselage.iter().zip(shape.section_m.windows(2)) {
        let [from, to] = [pair[0], pair[1]];
        near(slice.at_m[2], (from[2] + from[3] + to[2] + to[3]) / 4.0 - cg_m.z);
        near(slice.at_m[1], 0.0);
        let is_nose = (from[0] + to[0]) / 2.0 < shape.windscreen_m[0];
        assert_eq!(slice.material, if is_nose { "blue" } else { "white" });
    }
    // Between SL 5.5 and 8.6 m it is .83 m wide to either side, and 1.87 to 1.88 m tall.
    let radius_m = |tall_m: f64| (0.83 * tall_m / 2.0).sqrt();
    near(fuselage[6].size_m[0], 0.5 * (radius_m(1.87) + radius_m(1.88)));
}

#[test]
fn wing_and_tailplane_are_where_their_quarter_chords_are() {
    let airframe = airframe();
    let cg_m = airframe.aircraft.weight_balance.cg_m;
    for (half, side) in airframe.wing.iter().zip([1.0, -1.0]) {
        near(half.at_m[1], side * 2.375);
        near(half.size_m[0], 5.25 * 0.3048);
        near(half.size_m[1], 4.75);
        near(half.size_m[2], 0.23 * 5.25 * 0.3048);
        // Quarter chord at BL 96.6, SL 291.7, WL 94.5 in, swept forward by 6.5°, tips up by 2°.
        let out_m = 2.375 - 96.6 * 0.0254;
        let aft_m = 291.7 * 0.0254 - 0.113_94 * out_m + 0.25 * 5.25 * 0.3048;
        near(half.at_m[0], cg_m.x - aft_m);
        near(half.at_m[2], 94.5 * 0.0254 + 0.034_92 * out_m - cg_m.z);
    }

    let tailplane = &airframe.tailplane;
    let chord_m = 3.92 * 0.3048;
    for (found, wanted) in tailplane.size_m.iter().zip([chord_m, 12.83 * 0.3048, 0.15 * chord_m]) {
        near(*found, wanted);
    }
    near(tailplane.at_m[0], cg_m.x - (560.0 * 0.0254 + 0.25 * chord_m));
    near(tailplane.at_m[2], 100.4 * 0.0254 - cg_m.z);
}

#[test]
fn fins_and_pods_are_on_their_sides() {
    let airframe = airframe();
    let (shape, cg_m) = (&airframe.aircraft.display, airframe.aircraft.weight_balance.cg_m);
    for (side, fin, pod) in &airframe.sides {
        let sections = &shape.vertical_stabilizers.section_m;
        for (panel, pair) in fin.iter().zip(sections.windows(2)) {
            let [up_m, chord_m, aft_m] = [0, 1, 2].map(|i| (pair[0][i] + pair[1][i]) / 2.0);
            near(panel.at_m[0], cg_m.x - (aft_m + 0.25 * chord_m));
            near(panel.at_m[1], side * 77.0 * 0.0254);
            near(panel.at_m[2], up_m - cg_m.z);
            for (found, wanted) in
                panel.size_m.iter().zip([chord_m, 0.09 * chord_m, pair[1][0] - pair[0][0]])
            {
                near(*found, wanted);
            }
        }
        follow_one_another(pod, 0, cg_m.x - 6.3..cg_m.x - 10.4);
        for (slice, pair) in pod.iter().zip(shape.gear_pods.section_m.windows(2)) {
            near(slice.at_m[1], side * 1.015);
            near(slice.at_m[2], 0.96 - cg_m.z);
            near(slice.size_m[0], (pair[0][1] + pair[1][1]) / 2.0);
        }
    }
}

/// A nacelle about its pivot, mast up, and its spinner, from below upwards.
#[test]
fn a_nacelle_is_whole_from_exhaust_to_spinner() {
    let shape = &xv15().display.nacelles;
    for link in ["nacelle_left", "nacelle_right"] {
        let mut nacelle = bodies(&aircraft::urdf(&xv15()), link);
        let mut spinner = nacelle.split_off(shape.section_m.len() - 1);
        assert_eq!(spinner.len(), shape.spinner_m.len() - 1);
        for (slices, ends_m) in [(&mut nacelle, 1.20..-1.72), (&mut spinner, 1.93..1.22)] {
            slices.reverse();
            follow_one_another(slices, 2, ends_m);
        }
        // Its widest slice, about the pivot: .58 by .49 m and .54 by .46 m.
        let radius_m = 0.5 * ((0.58_f64 * 0.49).sqrt() + (0.54_f64 * 0.46).sqrt());
        assert!(nacelle.iter().any(|slice| (slice.size_m[0] - radius_m).abs() < WRITTEN_M));
        assert!(nacelle.iter().all(|slice| slice.material == "grey"));
    }
}

#[test]
fn frames_are_those_that_a_log_moves_and_no_name_breaks_the_text() {
    let urdf = of(|params| params.name = "Tilt & \"Rotor\" <2>".into());
    let links = ["base_link", "nacelle_left", "nacelle_right", "rotor_left", "rotor_right"];
    assert_eq!(attributes(&urdf, "link", "name"), links);
    assert_eq!(attributes(&urdf, "child", "link"), links[1..]);
    assert_eq!(attributes(&urdf, "robot", "name"), ["tilt_rotor_2"]);
    assert!(!urdf.contains("NaN") && !urdf.contains("inf"), "{urdf}");
    let numbers = urdf.split(['"', ' ']);
    assert!(numbers.clone().any(|number| number == "0"), "{urdf}");
    assert!(numbers.into_iter().all(|number| number != "-0" && number != "-"), "{urdf}");
    for element in ["robot", "link", "joint", "visual", "geometry", "material"] {
        let open = format!("<{element}");
        let bodies = urdf.split(&open).skip(1);
        let opened = bodies.filter(|rest| !rest[..=rest.find('>').unwrap()].ends_with("/>"));
        assert_eq!(opened.count(), urdf.matches(&format!("</{element}>")).count());
    }
}
