//! The XV-15's file as the engine sees it.

use engine::aero::{Motion, wing_pylon};
use engine::frames::Vec3;
use engine::inputs::World;
use engine::math::{PI, sqrt, square};
use engine::{Aircraft, Inputs, State, rotors};

const DEG: f64 = PI / 180.0;
const LBF: f64 = 4.448_221_615_260_5;
const DENSITY: f64 = engine::environment::DENSITY_SL_KG_PER_M3;

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
    close(xv15.rotors.flapping_rad_max, PI / 15.0);
    close(xv15.fcc.governor.rotor_speed_radps[0], 589.0 * PI / 30.0);
    close(xv15.fcc.mixer.flap_rad[2], 40.0 * DEG);
    close(xv15.engines.rated_power_w, 1375.0 * 745.699_871_582_270_2);
    close(xv15.weight_balance.zero_fuel_mass_kg, 11_525.0 * 0.453_592_37);
    close(xv15.landing_gear.nose.tyre_m.x, 137.0 * 0.0254);
}

#[test]
fn tables_arrive_in_si() {
    let mixer = xv15().fcc.mixer;
    close(mixer.collective_per_lever_rad_per_m.at(0.0), 1.6 * DEG / 0.0254);
    close(mixer.collective_per_lever_rad_per_m.at(45.0 * DEG), 0.5 * (0.92 + 0.71) * DEG / 0.0254);
    close(
        mixer.cyclic_per_pedal_rad_per_m.at(60.0 * DEG, 80.0 * 1852.0 / 3600.0),
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
    close(start.fuel_kg, 1475.0 * 0.453_592_37);
    close(start.origin.latitude_rad, 19.7203 * DEG);
}

// ------------------------------------------------------------------------------------ rotor

fn hovering(collective_rad: f64) -> rotors::Inputs {
    rotors::Inputs {
        motion: Motion {
            cg_m: Vec3::new(7.65, 0.0, 2.074),
            airspeed_mps: Vec3::zero(),
            angular_rate_radps: Vec3::zero(),
            density_kg_per_m3: DENSITY,
        },
        mast_tilt_rad: 0.0,
        mast_tilt_rate_radps: 0.0,
        rotor_speed_radps: 589.0 * PI / 30.0,
        collective_rad,
        cyclic_forward_rad: 0.0,
        hub_height_m: 1e9,
    }
}

/// A rotor far from the ground, its inflow settled.
struct Hover {
    collective_rad: f64,
    thrust_n: f64,
    induced_mps: f64,
    c_t: f64,
    c_p: f64,
}

fn hover(params: &rotors::Params, collective_rad: f64) -> Hover {
    let inputs = hovering(collective_rad);
    let mut state = rotors::State { induced_mps: 10.0, ..rotors::State::default() };
    for _ in 0..2_000 {
        let (rate, _) = rotors::rotor(params, &state, &inputs);
        state.induced_mps += engine::STEP_S * rate.induced_mps2;
    }
    let (_, out) = rotors::rotor(params, &state, &inputs);
    let tip_mps = inputs.rotor_speed_radps * params.radius_m;
    let c_t = out.thrust_n / (DENSITY * params.disc_area_m2() * square(tip_mps));
    let c_p = out.power_w / (DENSITY * params.disc_area_m2() * square(tip_mps) * tip_mps);
    Hover { collective_rad, thrust_n: out.thrust_n, induced_mps: out.induced_mps, c_t, c_p }
}

/// The hover with this thrust coefficient.
fn hover_at(params: &rotors::Params, c_t: f64) -> Hover {
    let (mut low, mut high) = (-5.0 * DEG, 20.0 * DEG);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if hover(params, middle).c_t < c_t {
            low = middle;
        } else {
            high = middle;
        }
    }
    hover(params, low)
}

/// CR-2017-219486 Table A-2 (OARF run 15): CT, figure of merit, for .06 < CT/sigma < .15.
const OARF: [(f64, f64); 4] =
    [(0.007_391, 0.7641), (0.010_104, 0.7866), (0.011_063, 0.7881), (0.013_089, 0.7797)];

/// The test facilities disagree by .04; the validation plan takes half of it.
const FIGURE_OF_MERIT_TOLERANCE: f64 = 0.02;

#[test]
fn val_figure_of_merit_is_that_of_the_oarf_hover_test() {
    let rotors = xv15().rotors;
    for (c_t, measured) in OARF {
        let at = hover_at(&rotors, c_t);
        let merit = at.c_t * sqrt(at.c_t / 2.0) / at.c_p;
        println!(
            "CT {c_t}: {merit:.4}, measured {measured}, collective {:.2} deg",
            at.collective_rad / DEG
        );
        assert!((merit - measured).abs() < FIGURE_OF_MERIT_TOLERANCE, "CT {c_t}: {merit}");
    }
}

/// The collective's zero is another one in every source; its slope, .00093 per degree, is not.
#[test]
fn val_thrust_grows_with_collective_as_in_the_oarf_hover_test() {
    let rotors = xv15().rotors;
    let (low, high) = (hover_at(&rotors, 0.0091), hover_at(&rotors, 0.0111));
    let slope_per_deg = (high.c_t - low.c_t) / (high.collective_rad - low.collective_rad) * DEG;
    assert!((slope_per_deg / 0.000_93 - 1.0).abs() < 0.07, "{slope_per_deg}");
}

// ----------------------------------------------------------------------------- whole aircraft

/// Download over thrust with the flaps at a detent.
fn download(xv15: &Aircraft, detent: usize) -> f64 {
    let at = hover_at(&xv15.rotors, 0.0105);
    let (motion, thrust_axis) = (hovering(0.0).motion, xv15.rotors.thrust_axis(0.0));
    let load = wing_pylon::half_wing(
        &xv15.wing_pylon,
        &wing_pylon::Inputs {
            motion,
            mach: 0.0,
            alpha_rad: 0.0,
            wake_mps: thrust_axis * (xv15.rotor_wake.wing_factor * at.induced_mps),
            mast_tilt_rad: 0.0,
            thrust_axis,
            induced_mps: at.induced_mps,
            pivot_m: xv15.rotors.pivot_m,
            hub_from_cg_m: xv15.rotors.hub_from_cg(motion.cg_m, 0.0),
            flap_rad: xv15.fcc.mixer.flap_rad[detent],
            flaperon_rad: 0.0,
        },
    );
    load.total().force_n.z / at.thrust_n
}

/// CR176970, flown with full-span flaps: download over thrust, flaps 0, 20, 40.
const DOWNLOAD_FLOWN: [f64; 3] = [0.132, 0.119, 0.103];
/// CR176970: the nominal setting 40/25 lies between 10.4 and 11.5 %; the plan's band.
const DOWNLOAD_AT_40: std::ops::Range<f64> = 0.10..0.12;
/// Flap 20 droops its flaperon to 12.5° only, where the flight had 20° all along the span.
const DOWNLOAD_AT_20: std::ops::Range<f64> = 0.115..0.132;

/// Flaps up misses, by 5 % of thrust: the source's drag coefficient there is .96, the tunnel's 1.69.
#[test]
fn val_download_in_hover_is_that_of_the_flight_test() {
    let xv15 = xv15();
    let downloads = [0, 1, 2, 3].map(|detent| download(&xv15, detent));
    println!("download {downloads:.4?}, flown {DOWNLOAD_FLOWN:?}");
    assert!(DOWNLOAD_AT_40.contains(&downloads[2]));
    assert!(DOWNLOAD_AT_20.contains(&downloads[1]));
    assert!(downloads[1..].is_sorted_by(|more, less| more > less));
    assert!(downloads[0] < 0.09, "flaps up no longer misses");
}

/// GTRS needs 1430 kW (CR537), the flight test scaled to this weight 1465 to 1500 (CR176970).
const HOVER_POWER_W: std::ops::Range<f64> = 1.42e6..1.51e6;

/// The thrust whose part above the wing's download carries 13,000 lb, less what the jets carry.
#[test]
fn val_hover_at_design_weight_takes_the_published_power() {
    let xv15 = xv15();
    let jets_n = 2.0 * 83.0 * LBF;
    let thrust_n = (13_000.0 * LBF - jets_n) / (1.0 - download(&xv15, 2));
    let tip_mps = 589.0 * PI / 30.0 * xv15.rotors.radius_m;
    let disc_n = DENSITY * xv15.rotors.disc_area_m2() * square(tip_mps);
    let at = hover_at(&xv15.rotors, 0.5 * thrust_n / disc_n);
    let power_w = 2.0 * at.c_p * disc_n * tip_mps;
    println!("{power_w:.0} W, collective {:.2} deg", at.collective_rad / DEG);
    assert!(HOVER_POWER_W.contains(&power_w), "{power_w} W");
}

fn started(xv15: &Aircraft) -> State {
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
    start.state(xv15).unwrap()
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
