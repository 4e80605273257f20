//! The aircraft's entry file, and the numbers that its display draws.

use std::fmt::Write as _;

use engine::aircraft::Params as Aircraft;
use engine::units::{DEG_PER_RAD, KNOT_MPS, POUND_KG, RPM_PER_RADPS};

use crate::ac3d::number;
use crate::mesh::{Point, sub};
use crate::shape::{Likeness, cockpit};

/// The entry file, with places for numbers.
const SET: &str = include_str!("xv15-set.xml");

/// JP-4, pounds a US gallon.
const FUEL_LB_PER_GAL: f64 = 6.5;

/// A station as FlightGear's views have it: right, up, aft of the model's origin.
fn view(aircraft: &Aircraft, station_m: Point) -> String {
    let cg = aircraft.weight_balance.cg_m;
    let [aft, right, up] = sub(station_m, [cg.x, cg.y, cg.z]).map(number);
    format!(
        "<x-offset-m type=\"double\">{right}</x-offset-m><y-offset-m type=\"double\">{up}</y-offset-m><z-offset-m type=\"double\">{aft}</z-offset-m>"
    )
}

/// The entry file.
pub fn set(aircraft: &Aircraft) -> String {
    let [aft, up] = cockpit::EYE_M;
    let like = Likeness::of(aircraft);
    let view = |drawn_m: Point| view(aircraft, like.at(drawn_m));
    let fuel_gal = aircraft.weight_balance.fuel_kg_max / (POUND_KG * FUEL_LB_PER_GAL);
    SET.replace("@PILOT@", &view([aft, cockpit::SEAT_M, up]))
        .replace("@COPILOT@", &view([aft, -cockpit::SEAT_M, up]))
        .replace("@CREW@", &view([5.75, 0.0, up + 0.05]))
        .replace("@HOVER@", &view([2.70, 0.0, 1.1]))
        .replace("@NAME@", &escaped(&aircraft.name))
        .replace("@FUEL_LB_PER_GAL@", &number(FUEL_LB_PER_GAL))
        .replace("@FUEL_GAL@", &number(fuel_gal))
}

/// A name as text of XML.
fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Numbers for the display: the conversion corridor's outline and the limits of its scales.
pub fn numbers(aircraft: &Aircraft) -> String {
    let envelope = &aircraft.envelope;
    let mut text = String::from(
        "# Written by the example xv15_package of flightgear-package from the aircraft file.\n\n\
         # The conversion corridor: [nacelle, deg; calibrated airspeed, kt].\n",
    );
    let corridor = &envelope.corridor;
    let limits = [
        ("corridor_slow", &corridor.calibrated_airspeed_mps_min),
        ("corridor_fast", &corridor.calibrated_airspeed_mps_max),
    ];
    for (name, table) in limits {
        let points = table.x.iter().zip(&table.y).map(|(tilt_rad, mps)| {
            let nacelle_deg = 90.0 - tilt_rad * DEG_PER_RAD;
            format!("[{}, {}]", number(nacelle_deg), number(mps / KNOT_MPS))
        });
        let _ = writeln!(text, "var {name} = [{}];", points.collect::<Vec<_>>().join(", "));
    }
    let rotors = &envelope.rotors;
    let rows = [
        ("rated_rpm", rotors.rated_radps * RPM_PER_RADPS),
        ("overspeed_rpm", rotors.overspeed_radps * RPM_PER_RADPS),
        ("greatest_rpm", rotors.speed_radps_max * RPM_PER_RADPS),
        ("cruise_kt", envelope.airspeed.cruise_mps_max / KNOT_MPS),
        ("dive_kt", envelope.airspeed.dive_mps_max / KNOT_MPS),
        ("gear_cycle_kt", envelope.airspeed.gear_cycle_mps_max / KNOT_MPS),
    ];
    text.push_str("\n# Limits of the scales.\n");
    for (name, value) in rows {
        let _ = writeln!(text, "var {name} = {};", number(value));
    }
    let list = |values: &mut dyn Iterator<Item = f64>| {
        values.map(|value| number((value * 10.0).round() / 10.0)).collect::<Vec<_>>().join(", ")
    };
    let _ = writeln!(
        text,
        "var flap_kt = [{}];",
        list(&mut envelope.airspeed.flap_mps_max.iter().map(|mps| mps / KNOT_MPS))
    );
    let _ = writeln!(
        text,
        "var flap_deg = [{}];",
        list(&mut aircraft.fcc.mixer.flap_rad.iter().map(|rad| rad * DEG_PER_RAD))
    );
    let _ = writeln!(
        text,
        "var governed_rpm = [{}];",
        list(
            &mut aircraft.fcc.governor.rotor_speed_radps.iter().map(|radps| radps * RPM_PER_RADPS)
        )
    );
    text
}
