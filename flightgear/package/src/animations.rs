//! How the parts move: the model's XML file.
//!
//! Properties have no leading slash: FlightGear looks them up below the aircraft whose model it is, so
//! that a second one shows its own values. What belongs to the viewer (which view, where the sun is) has
//! one.
//!
//! # Signs
//! Axes are FlightGear's: x aft, y right, z up, a turn anticlockwise seen against the axis. So about +y the
//! upper side goes aft and a trailing edge goes down. What is listed first is outside of what follows.

use std::fmt::Write as _;

use engine::aircraft::Params as Aircraft;
use engine::math::{TAU, cos, sin, sqrt};
use engine::units::DEG_PER_RAD;

use crate::ac3d::number;
use crate::mesh::{Point, dot, sub};
use crate::shape::{Likeness, SIDES, cockpit, gear, lights, nacelle, rotor, tail, wing};

/// Blades are seen below this rotor speed, the blur above the second.
const BLADES_RPM_MAX: f64 = 240.0;
const BLUR_RPM_MIN: f64 = 110.0;
/// Flaps, and how far the flaperons droop with them, deg. `TMX §3.3`
const FLAPERON_DROOP_DEG: [[f64; 2]; 4] = [[0.0, 0.0], [20.0, 12.5], [40.0, 25.0], [75.0, 47.0]];
/// How far inward a main leg of the XV-15 folds, m: the pods' axes are inside the wheels'.
const FOLDS_INWARD_M: f64 = 0.15;

struct Model {
    text: String,
    origin_m: Point,
}

/// The model's file.
pub fn xml(aircraft: &Aircraft) -> String {
    let cg = aircraft.weight_balance.cg_m;
    let text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
                <!-- Written by the example xv15_package of flightgear-package. -->\n\
                <PropertyList>\n <path>xv15.ac</path>\n";
    let mut model = Model { text: text.to_owned(), origin_m: [cg.x, cg.y, cg.z] };
    model.shown();
    model.nacelles(aircraft);
    model.rotors(aircraft);
    model.surfaces(aircraft);
    model.landing_gear(aircraft);
    model.lights(aircraft);
    model.cockpit(Likeness::of(aircraft));
    model.dust(aircraft);
    model.text + "</PropertyList>\n"
}

/// The file of a second aircraft beside the first: the same in amber, moved by what is sent for it.
///
/// FlightGear looks properties of such a model up at the root of its tree, so they are written in full.
pub fn ghost(aircraft: &Aircraft) -> String {
    let below = "<property>/ghost/tiltrotor/";
    let amber = " <animation>\n  <type>material</type>\n\
                 \x20 <diffuse><red>1</red><green>0.62</green><blue>0.12</blue></diffuse>\n\
                 \x20 <ambient><red>1</red><green>0.62</green><blue>0.12</blue></ambient>\n\
                 \x20</animation>\n</PropertyList>\n";
    xml(aircraft)
        .replace("<property>tiltrotor/", below)
        .replace("dust.left", "ghost.dust.left")
        .replace("dust.right", "ghost.dust.right")
        .replace("</PropertyList>\n", amber)
}

fn names<S: AsRef<str>>(objects: &[S]) -> String {
    objects.iter().map(|name| format!("  <object-name>{}</object-name>\n", name.as_ref())).collect()
}

fn vector(tag: &str, at: Point, unit: &str) -> String {
    let [x, y, z] = at.map(number);
    format!("  <{tag}><x{unit}>{x}</x{unit}><y{unit}>{y}</y{unit}><z{unit}>{z}</z{unit}></{tag}>\n")
}

/// How a property becomes an angle or a way.
enum Law<'a> {
    Times(f64),
    TimesPlus(f64, f64),
    Table(&'a [[f64; 2]]),
}

impl Law<'_> {
    fn xml(&self, unit: &str) -> String {
        match self {
            Self::Times(factor) => format!("  <factor>{}</factor>\n", number(*factor)),
            Self::TimesPlus(factor, offset) => format!(
                "  <factor>{}</factor>\n  <offset-{unit}>{}</offset-{unit}>\n",
                number(*factor),
                number(*offset)
            ),
            Self::Table(rows) => {
                let entries = rows.iter().map(|[at, value]| {
                    let (at, value) = (number(*at), number(*value));
                    format!("<entry><ind>{at}</ind><dep>{value}</dep></entry>")
                });
                format!("  <interpolation>{}</interpolation>\n", entries.collect::<String>())
            }
        }
    }
}

impl Model {
    fn animation(&mut self, kind: &str, objects: &[impl AsRef<str>], rest: &str) {
        let _ = write!(
            self.text,
            " <animation>\n  <type>{kind}</type>\n{}{rest} </animation>\n",
            names(objects)
        );
    }

    fn place(&self, station_m: Point) -> Point {
        sub(station_m, self.origin_m)
    }

    fn turn(
        &mut self,
        objects: &[impl AsRef<str>],
        property: &str,
        law: &Law,
        axis: Point,
        at: Point,
    ) {
        let rest = format!(
            "  <property>{property}</property>\n{}{}{}",
            law.xml("deg"),
            vector("axis", axis, ""),
            vector("center", self.place(at), "-m")
        );
        self.animation("rotate", objects, &rest);
    }

    /// A turn about the line from one point to another.
    fn hinge(&mut self, object: &str, property: &str, factor: f64, [from, to]: [Point; 2]) {
        self.turn(&[object], property, &Law::Times(factor), sub(to, from), from);
    }

    fn slide(&mut self, objects: &[impl AsRef<str>], property: &str, factor: f64, axis: Point) {
        let rest = format!(
            "  <property>{property}</property>\n{}{}",
            Law::Times(factor).xml("m"),
            vector("axis", axis, "")
        );
        self.animation("translate", objects, &rest);
    }

    fn show_if(&mut self, objects: &[impl AsRef<str>], condition: &str) {
        self.animation("select", objects, &format!("  <condition>{condition}</condition>\n"));
    }

    /// What is there or not, as a whole.
    fn shown(&mut self) {
        self.show_if(
            &["crew.left", "crew.right"],
            "<not><property>/sim/current-view/internal</property></not>",
        );
        // Glass is drawn after what is behind it, and does not throw a shadow.
        self.animation("noshadow", &["glass", "disc.left", "disc.right", "landing.beam"], "");
    }

    fn nacelles(&mut self, aircraft: &Aircraft) {
        for (i, name, side) in SIDES {
            let mut objects: Vec<String> =
                ["nacelle", "spinner", "glow", "disc", "nav", "halo.nav"]
                    .iter()
                    .map(|part| format!("{part}.{name}"))
                    .collect();
            objects.extend(self.blades(aircraft, name));
            // Built as a helicopter, 90 deg.
            self.turn(
                &objects,
                &format!("tiltrotor/nacelle-deg[{i}]"),
                &Law::TimesPlus(1.0, -90.0),
                [0.0, 1.0, 0.0],
                nacelle::pivot_m(aircraft, side),
            );
            self.show_if(
                &[format!("glow.{name}")],
                &format!("<property>tiltrotor/engine[{i}]/running</property>"),
            );
        }
    }

    fn blades(&self, aircraft: &Aircraft, name: &str) -> Vec<String> {
        (0..rotor::blades(aircraft)).map(|number| format!("blade.{name}.{number}")).collect()
    }

    fn rotors(&mut self, aircraft: &Aircraft) {
        let precone_deg = aircraft.rotors.flapping.precone_rad * DEG_PER_RAD;
        for (i, name, side) in SIDES {
            let property = |what: &str| format!("tiltrotor/rotor[{i}]/{what}");
            let hub = nacelle::hub_m(aircraft, side);
            let blades = self.blades(aircraft, name);
            let disc = format!("disc.{name}");
            let tilting: Vec<_> = blades.iter().chain([&disc]).cloned().collect();
            self.turn(&tilting, &property("flap-aft-deg"), &Law::Times(1.0), [0.0, 1.0, 0.0], hub);
            self.turn(
                &tilting,
                &property("flap-right-deg"),
                &Law::Times(1.0),
                [-1.0, 0.0, 0.0],
                hub,
            );
            let mut turning = tilting;
            turning.push(format!("spinner.{name}"));
            self.turn(&turning, &property("azimuth-deg"), &Law::Times(1.0), [0.0, 0.0, side], hub);
            for (number, blade) in (0..).zip(&blades) {
                let azimuth = rotor::azimuth_rad(aircraft, number);
                let (s, c) = (sin(azimuth), cos(azimuth));
                // Axial vectors of the left rotor are the images of the right one's.
                let cone = [side * s, -c, 0.0];
                let law = Law::TimesPlus(1.0, -precone_deg);
                self.turn(&[blade], &property("coning-deg"), &law, cone, hub);
                let span = [side * c, s, 0.0];
                self.turn(&[blade], &property("collective-deg"), &Law::Times(1.0), span, hub);
            }
            let rpm = |than: &str, value: f64| {
                format!(
                    "<{than}><property>{}</property><value>{value}</value></{than}>",
                    property("rpm")
                )
            };
            self.show_if(&blades, &rpm("less-than", BLADES_RPM_MAX));
            self.show_if(&[disc], &rpm("greater-than", BLUR_RPM_MIN));
        }
    }

    fn surfaces(&mut self, aircraft: &Aircraft) {
        let mirrored =
            |[from, to]: [Point; 2]| [to, from].map(|[aft, right, up]| [aft, -right, up]);
        let flap = wing::flap_hinge_m(aircraft);
        let flaperon = wing::flaperon_hinge_m(aircraft);
        let surface = |what: &str| format!("tiltrotor/surface/{what}");
        self.hinge("flap.left", &surface("flap-deg"), 1.0, mirrored(flap));
        self.hinge("flap.right", &surface("flap-deg"), 1.0, flap);
        for (i, name, line) in [(0, "left", mirrored(flaperon)), (1, "right", flaperon)] {
            let name = format!("flaperon.{name}");
            self.hinge(&name, &surface(&format!("flaperon-deg[{i}]")), 1.0, line);
            // What is sent is beyond the setting of the flaps, with which they droop.
            let droop = Law::Table(&FLAPERON_DROOP_DEG);
            self.turn(&[name], &surface("flap-deg"), &droop, sub(line[1], line[0]), line[0]);
        }
        self.hinge("elevator", &surface("elevator-deg"), 1.0, tail::elevator_hinge_m(aircraft));
        let rudder = tail::rudder_hinge_m(aircraft);
        let left = rudder.map(|[aft, right, up]| [aft, -right, up]);
        // About an axis upwards the trailing edge goes right; to the left is positive.
        self.hinge("rudder.left", &surface("rudder-deg[0]"), -1.0, left);
        self.hinge("rudder.right", &surface("rudder-deg[1]"), -1.0, rudder);
    }

    fn landing_gear(&mut self, aircraft: &Aircraft) {
        let folds_inward_m = Likeness::of(aircraft).length(FOLDS_INWARD_M);
        for leg in gear::legs(aircraft) {
            let part = |what: &str| format!("gear.{}.{what}", leg.name);
            let unit = |what: &str| format!("tiltrotor/gear/unit[{}]/{what}", leg.unit);
            let all = ["leg", "fork", "wheels"].map(part);
            let folded = -92.0 * leg.folds;
            self.turn(
                &all,
                &unit("position-norm"),
                &Law::Table(&[[0.0, folded], [0.15, folded], [1.0, 0.0]]),
                [0.0, 1.0, 0.0],
                leg.hinge_m,
            );
            let inward = leg.axle_m[1].signum() * -folds_inward_m;
            if leg.unit != 0 {
                let rest = format!(
                    "  <property>{}</property>\n{}{}",
                    unit("position-norm"),
                    Law::Table(&[[0.0, inward], [0.15, inward], [0.6, 0.0], [1.0, 0.0]]).xml("m"),
                    vector("axis", [0.0, 1.0, 0.0], "")
                );
                self.animation("translate", &all, &rest);
            }
            let low = ["fork", "wheels"].map(part);
            if leg.unit == 0 {
                self.turn(&low, &unit("steer-deg"), &Law::Times(-1.0), [0.0, 0.0, 1.0], leg.axle_m);
            }
            self.slide(&low, &unit("compression-m"), 1.0, [0.0, 0.0, 1.0]);
            let rest = format!(
                "  <property>{}</property>\n  <factor>{}</factor>\n{}{}",
                unit("wheel-speed-mps"),
                number(60.0 / (TAU * leg.radius_m)),
                vector("axis", [0.0, -1.0, 0.0], ""),
                vector("center", self.place(leg.axle_m), "-m")
            );
            self.animation("spin", &[part("wheels")], &rest);
        }
        // Down is away from the free edge.
        let doors = [
            ("nose.left", 0, -1.0),
            ("nose.right", 0, 1.0),
            ("left.inner", 1, 1.0),
            ("left.outer", 1, -1.0),
            ("right.inner", 2, -1.0),
            ("right.outer", 2, 1.0),
        ];
        for (door, unit, sense) in doors {
            self.turn(
                &[format!("door.{door}")],
                &format!("tiltrotor/gear/unit[{unit}]/position-norm"),
                &Law::Table(&[[0.0, 0.0], [0.15, 88.0 * sense], [1.0, 88.0 * sense]]),
                [1.0, 0.0, 0.0],
                gear::door_hinge_m(aircraft, door),
            );
        }
    }

    fn lights(&mut self, aircraft: &Aircraft) {
        let dark = "<greater-than><property>/sim/time/sun-angle-rad</property><value>1.4</value></greater-than>";
        for light in lights::lights(aircraft) {
            let halo = format!("halo.{}", light.name);
            if light.name.starts_with("nav") {
                self.show_if(&[&halo], dark);
            } else {
                // Branches: lit, dark, and for strobes a second flash.
                let times = if light.name == "beacon" { "0.15 0.95" } else { "0.06 1.14" };
                let mut parts = times.split(' ');
                let (lit, off) = (parts.next().unwrap_or(""), parts.next().unwrap_or(""));
                let rest = format!(
                    "  <use-personality type=\"bool\">false</use-personality>\n  \
                     <branch-duration-sec>{lit}</branch-duration-sec>\n  \
                     <branch-duration-sec>{off}</branch-duration-sec>\n"
                );
                self.animation("timed", &[&halo, &format!("off.{}", light.name)], &rest);
            }
            let at = self.place(light.at_m);
            let rest = format!(
                "  <offset-m>{}</offset-m>\n{}",
                number(sqrt(dot(at, at))),
                vector("axis", at, "")
            );
            self.animation("translate", &[&halo], &rest);
            self.animation("billboard", &[&halo], "  <spherical type=\"bool\">true</spherical>\n");
        }
        let down = "<greater-than><property>tiltrotor/gear/unit[0]/position-norm</property><value>0.9</value></greater-than>";
        self.show_if(&["landing.lamp"], down);
        self.show_if(&["landing.beam"], &format!("<and>{down}{dark}</and>"));
    }

    fn cockpit(&mut self, like: Likeness) {
        let control = |what: &str| format!("tiltrotor/control/{what}");
        for (_, name, side) in SIDES {
            let seat = side * cockpit::SEAT_M;
            let [aft, up] = cockpit::STICK_M;
            let stick = [format!("stick.{name}")];
            let at = like.at([aft, seat, up]);
            self.turn(&stick, &control("stick-aft-norm"), &Law::Times(13.0), [0.0, 1.0, 0.0], at);
            self.turn(
                &stick,
                &control("stick-right-norm"),
                &Law::Times(13.0),
                [-1.0, 0.0, 0.0],
                at,
            );
            let [aft, up, left] = cockpit::LEVER_M;
            self.turn(
                &[format!("lever.{name}")],
                &control("collective-norm"),
                &Law::Times(24.0),
                [0.0, 1.0, 0.0],
                like.at([aft, seat - left, up]),
            );
            for (foot, way) in [("left", 0.07), ("right", -0.07)] {
                let pedal = [format!("pedal.{name}.{foot}")];
                let way = like.length(way);
                self.slide(&pedal, &control("pedal-right-norm"), way, [1.0, 0.0, 0.0]);
            }
        }
        self.turn(
            &["gear.handle"],
            "tiltrotor/gear/handle-down",
            &Law::TimesPlus(50.0, -25.0),
            [0.0, 1.0, 0.0],
            like.at(cockpit::GEAR_HANDLE_M),
        );
        self.turn(
            &["flap.lever"],
            "tiltrotor/flap-detent",
            &Law::TimesPlus(20.0, -30.0),
            [0.0, 1.0, 0.0],
            like.at(cockpit::FLAP_LEVER_M),
        );
        self.show_if(&["warning.lamp"], "<property>tiltrotor/lamp/master-warning</property>");
    }

    /// Dust on the ground below each rotor, while it blows down near it.
    fn dust(&mut self, aircraft: &Aircraft) {
        let wheels_m = gear::legs(aircraft)[1].axle_m[2] - gear::legs(aircraft)[1].radius_m;
        for (i, name, side) in SIDES {
            let pivot = nacelle::pivot_m(aircraft, side);
            let at = self.place([pivot[0], pivot[1], wheels_m]);
            self.text += &dust(i, name, at);
            self.slide(
                &[format!("dust.{name}")],
                "tiltrotor/air/radar-altitude-ft",
                -engine::units::FOOT_M,
                [0.0, 0.0, 1.0],
            );
        }
    }
}

fn dust(rotor: usize, name: &str, at: Point) -> String {
    let [x, y, z] = at.map(number);
    format!(
        " <particlesystem>
  <name>dust.{name}</name>
  <type>normal</type>
  <texture>dust.png</texture>
  <emissive>false</emissive>
  <lighting>true</lighting>
  <align>billboard</align>
  <attach>world</attach>
  <offsets><x-m>{x}</x-m><y-m>{y}</y-m><z-m>{z}</z-m></offsets>
  <condition>
   <less-than><property>tiltrotor/air/radar-altitude-ft</property><value>45</value></less-than>
   <greater-than><property>tiltrotor/rotor[{rotor}]/rpm</property><value>300</value></greater-than>
   <greater-than><property>tiltrotor/nacelle-deg[{rotor}]</property><value>50</value></greater-than>
   <greater-than><property>tiltrotor/rotor[{rotor}]/thrust-lbf</property><value>2500</value></greater-than>
  </condition>
  <placer><type>point</type></placer>
  <shooter>
   <theta-min-deg>80</theta-min-deg><theta-max-deg>92</theta-max-deg>
   <phi-min-deg>0</phi-min-deg><phi-max-deg>360</phi-max-deg>
   <speed><value>11</value><spread>4</spread></speed>
  </shooter>
  <counter><particles-per-sec><value>24</value><spread>4</spread></particles-per-sec></counter>
  <particle>
   <start>
    <color><red><value>0.78</value></red><green><value>0.72</value></green><blue><value>0.62</value></blue><alpha><value>0.22</value></alpha></color>
    <size><value>1.8</value></size>
   </start>
   <end>
    <color><red><value>0.80</value></red><green><value>0.75</value></green><blue><value>0.66</value></blue><alpha><value>0.0</value></alpha></color>
    <size><value>6</value></size>
   </end>
   <life-sec><value>1.8</value></life-sec>
   <mass-kg>0.01</mass-kg>
   <radius-m>0.4</radius-m>
  </particle>
  <program><fluid>air</fluid><gravity type=\"bool\">false</gravity><wind type=\"bool\">true</wind></program>
 </particlesystem>
"
    )
}
