//! The XV-15's file as the engine sees it.

use engine::aero::{local_flow, wing_pylon};
use engine::frames::Vec3;
use engine::inputs::World;
use engine::math::{PI, square};
use engine::symmetry::Mirror;
use engine::table::axis::{Airspeed, MastTilt};
use engine::units::DEGREE_RAD as DEG;
use engine::{Aircraft, Inputs, State};

use crate::rotor_stand::{self, hover_at, hovering};

const LBF: f64 = 4.448_221_615_260_5;

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-9, "{a} is not {b}");
}

#[test]
fn numbers_arrive_in_si() {
    let xv15 = xv15();
    close(xv15.rotors.radius_m, 3.81);
    close(xv15.rotors.pivot_m.y, 4.9022);
    close(xv15.rotors.flapping.flapping_rad_max, PI / 15.0);
    close(xv15.fcc.governor.rotor_speed_radps[0], 589.0 * PI / 30.0);
    close(xv15.fcc.mixer.flap_rad[2], 40.0 * DEG);
    close(xv15.engines.rated_power_w, 1375.0 * 745.699_871_582_270_2);
    close(xv15.weight_balance.zero_fuel_mass_kg, 11_525.0 * 0.453_592_37);
    close(xv15.landing_gear.nose.tyre_m.x, 137.0 * 0.0254);
}

#[test]
fn tables_arrive_in_si() {
    let mixer = xv15().fcc.mixer.clone();
    close(mixer.collective_per_lever_rad_per_m.at(MastTilt(0.0)), 1.6 * DEG / 0.0254);
    close(
        mixer.collective_per_lever_rad_per_m.at(MastTilt(45.0 * DEG)),
        0.5 * (0.92 + 0.71) * DEG / 0.0254,
    );
    close(
        mixer
            .cyclic_per_pedal_rad_per_m
            .at(MastTilt(60.0 * DEG), Airspeed(80.0 * engine::units::KNOT_MPS)),
        0.52 * DEG / 0.0254,
    );
}

#[test]
fn every_number_names_its_source() {
    let numbers = aircraft::provenance("xv15.toml", aircraft::XV15).unwrap();
    assert!(numbers.len() > 150, "{} numbers", numbers.len());
    assert!(numbers.iter().all(|number| !number.source.is_empty()));
    let radius = numbers.iter().find(|number| number.key == "rotors.radius_ft").unwrap();
    assert_eq!((radius.source.as_str(), radius.trust.label()), ("TMX §3.7", "V"));
}

/// An estimate nobody can follow is not one: it says how, or that it is a bare one.
#[test]
fn every_estimate_from_a_document_says_how() {
    for number in aircraft::provenance("xv15.toml", aircraft::XV15).unwrap() {
        let bare = number.source == "estimate" || number.key.ends_with("tyre_in");
        assert!(
            number.trust != aircraft::Trust::Estimate || bare || number.note.is_some(),
            "{} has no note",
            number.key
        );
    }
}

#[test]
fn cockpit_maps_and_scenario_load() {
    for (name, map) in [("pilot.toml", aircraft::PILOT_MAP), ("stick.toml", aircraft::STICK_MAP)] {
        let map = aircraft::cockpit(name, map).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(map.device.len(), 1);
    }
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
    close(start.fuel_aboard_kg(&xv15()), 1475.0 * 0.453_592_37);
    close(start.origin.latitude_rad, 19.721_359 * DEG);
}

// ----------------------------------------------------------------------------- whole aircraft

/// Download over thrust with the flaps at a detent.
fn download(xv15: &Aircraft, detent: usize) -> f64 {
    let at = hover_at(&xv15.rotors, 589.0, 0.0105);
    let (motion, mast) = (hovering(589.0, 0.0).motion, xv15.rotors.mast(0.0));
    let load = wing_pylon::evaluate(
        &xv15.wing_pylon,
        &wing_pylon::Inputs {
            motion,
            flow: local_flow(motion.airspeed_mps, motion.density_kg_per_m3),
            mach: 0.0,
            alpha_rad: 0.0,
            wake_mps: mast.thrust_axis * (xv15.rotor_wake.wing_factor * at.out.induced_mps),
            mast,
            induced_mps: at.out.induced_mps,
            rotor_radius_m: xv15.rotors.radius_m,
            pivot_m: xv15.rotors.pivot_m,
            hub_from_cg_m: xv15.rotors.hub_from_cg(motion.cg_m, &mast),
            flap_rad: xv15.fcc.mixer.flap_rad[detent],
            flaperon_rad: 0.0,
        },
    );
    load.total().force_n.z / at.out.thrust_n
}

/// CR176970, flown with full-span flaps: download over thrust, flaps 0, 20, 40.
const DOWNLOAD_FLOWN: [f64; 3] = [0.132, 0.119, 0.103];
/// CR176970: the nominal setting 40/25 lies between 10.4 and 11.5 %; the plan's band.
const DOWNLOAD_AT_40: std::ops::Range<f64> = 0.10..0.12;
/// Flap 20 droops its flaperon to 12.5° only, where the flight had 20° all along the span.
const DOWNLOAD_AT_20: std::ops::Range<f64> = 0.115..0.132;

/// Flaps up, the same wing in both: the spread of the report's own ways to it.
const DOWNLOAD_AT_0: std::ops::Range<f64> = 0.127..0.137;
/// Flap 75 droops its flaperon to 47°, 57° in the mean: flown are 9.4 % at 50 and 8.5 % at 60°, with the
/// same spread.
const DOWNLOAD_AT_75: std::ops::Range<f64> = 0.080..0.099;

#[test]
fn val_download_in_hover_is_that_of_the_flight_test() {
    let xv15 = xv15();
    let downloads = [0, 1, 2, 3].map(|detent| download(&xv15, detent));
    println!("download {downloads:.4?}, flown {DOWNLOAD_FLOWN:?}");
    assert!(DOWNLOAD_AT_40.contains(&downloads[2]));
    assert!(DOWNLOAD_AT_20.contains(&downloads[1]));
    assert!(DOWNLOAD_AT_0.contains(&downloads[0]));
    assert!(DOWNLOAD_AT_75.contains(&downloads[3]));
    assert!(downloads.is_sorted_by(|more, less| more > less));
}

/// GTRS needs 1430 kW (CR537), the flight test scaled to this weight 1465 to 1500 (CR176970).
const HOVER_POWER_W: std::ops::Range<f64> = 1.42e6..1.51e6;

/// The thrust whose part above the wing's download carries 13,000 lb, less what the jets carry.
///
/// The isolated rotor of the OARF test has a figure of merit of .79; in flight, beside the wing and the
/// other rotor, it reached .74 (CR176970). That loss is the inflow's recirculation.
#[test]
fn val_hover_power_at_design_weight_is_that_of_the_flight_test() {
    let xv15 = xv15();
    let jets_n = 2.0 * 83.0 * LBF;
    let thrust_n = (13_000.0 * LBF - jets_n) / (1.0 - download(&xv15, 2));
    let tip_mps = 589.0 * PI / 30.0 * xv15.rotors.radius_m;
    let disc_n = rotor_stand::DENSITY * xv15.rotors.disc_area_m2() * square(tip_mps);
    let at = hover_at(&xv15.rotors, 589.0, 0.5 * thrust_n / disc_n);
    let power_w = 2.0 * at.out.power_w;
    println!(
        "hover at 13,000 lb: {power_w:.0} W, published {HOVER_POWER_W:?}; collective {:.2} deg",
        at.inputs.collective_rad / DEG
    );
    assert!(HOVER_POWER_W.contains(&power_w), "{power_w} W");
}

fn started(xv15: &Aircraft) -> State {
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
    start.on_wheels(xv15)
}

/// Rotors at flat pitch on idle power carry a little of the weight, either way.
const ON_THE_WHEELS: std::ops::Range<f64> = 0.75..1.15;

#[test]
fn the_aircraft_starts_at_rest_on_its_wheels() {
    let xv15 = xv15();
    let state = started(&xv15);
    let inputs = Inputs { events: &[], world: World::default() };
    let (next, out) = engine::step(&xv15, &state, &inputs);
    assert!(next.is_finite() && next.frozen == 0);
    assert!(out.euler.pitch_rad.abs() < 3.0 * DEG, "{}", out.euler.pitch_rad / DEG);
    assert!(out.euler.roll_rad.abs() < 0.1 * DEG, "{}", out.euler.roll_rad / DEG);
    assert!(state.plant.velocity_mps.norm() < 0.02, "{:?}", state.plant.velocity_mps);
    assert_eq!(state.plant.weight_on_wheels, 1);
    let legs = out.landing_gear;
    let on_wheels = (legs.nose.push_n + legs.main.map(|leg| leg.push_n).sum()) / (13_000.0 * LBF);
    assert!(legs.nose.push_n > 0.0 && ON_THE_WHEELS.contains(&on_wheels), "{on_wheels}");
}

/// Half a minute of waiting: the governor holds the rotors' speed, the brakes the aircraft.
#[test]
fn an_idling_aircraft_stays_where_it_is() {
    let xv15 = xv15();
    let mut state = started(&xv15);
    let inputs = Inputs { events: &[], world: World::default() };
    for _ in 0..7_500 {
        (state, _) = engine::step(&xv15, &state, &inputs);
    }
    let rpm = state.plant.rotor_speed_radps * 30.0 / PI;
    assert!((rpm - 589.0).abs() < 1.0, "{rpm}");
    assert!(state.plant.velocity_mps.norm() < 1e-3, "{:?}", state.plant.velocity_mps);
    let moved_m = Vec3::new(0.0, 0.0, state.plant.position_m.z) - state.plant.position_m;
    assert!(moved_m.norm() < 0.02, "{moved_m:?}");
}

/// The left rotor is computed as the image of a right one: a mirrored flight is the mirrored state.
#[test]
fn a_mirrored_flight_is_the_mirrored_state() {
    let xv15 = xv15();
    let mut state = started(&xv15);
    state.plant.position_m.z -= 300.0;
    state.plant.velocity_mps = Vec3::new(25.0, 6.0, 1.0);
    state.plant.angular_rate_radps = Vec3::new(0.2, -0.1, 0.3);
    state.cockpit.collective_norm = 0.6;
    state.cockpit.stick_right_norm = 0.2;
    state.cockpit.pedal_right_norm = -0.1;
    state.cockpit.nacelle_aft_norm = -1.0;
    let wind = World { wind_mps: Vec3::new(-3.0, 4.0, 0.5), ..World::default() };
    let mut image = state.mirrored();
    for tick in 0..750 {
        state = engine::step(&xv15, &state, &Inputs { events: &[], world: wind }).0;
        image = engine::step(&xv15, &image, &Inputs { events: &[], world: wind.mirrored() }).0;
        assert_eq!(image, state.mirrored(), "tick {tick}");
    }
    assert!(state.frozen == 0 && state.actuators.mast_tilt_rad.left > 0.1);
}
