//! The envelope and the shape from the aircraft file: what reads them follows the file.

use aircraft::XV15;
use engine::display::Travels;
use engine::envelope::Corridor;
use engine::inputs::World;
use engine::math::{FRAC_PI_2, PI};
use engine::outputs::Validity;
use engine::table::axis::RotorSpeed;
use engine::units::{DEGREE_RAD as DEG, KNOT_MPS};
use engine::{Aircraft, Inputs, State};

fn read(text: &str) -> Aircraft {
    aircraft::aircraft("xv15.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn xv15() -> Aircraft {
    read(XV15)
}

fn corridor() -> Corridor {
    xv15().envelope.corridor.clone()
}

/// By nacelle incidence, as the figure has it.
fn tilt(incidence_deg: f64) -> f64 {
    FRAC_PI_2 - incidence_deg * DEG
}

#[test]
fn the_corridor_is_that_of_the_figure() {
    let corridor = corridor();
    for (incidence_deg, slowest_kt, fastest_kt) in [
        (0.0, 129.0, 234.0),
        (2.3, 128.1, 234.0),
        (16.0, 123.0, 169.0),
        (31.0, 113.6, 169.0),
        (47.0, 102.0, 155.2),
        (60.0, 90.4, 144.0),
        (69.5, 77.0, 128.0),
        (76.0, 64.0, 121.2),
        (80.0, 64.0, 117.0),
        (85.0, 64.0, 96.0),
        (90.0, 0.0, 96.0),
        (95.0, 0.0, 96.0),
    ] {
        let slowest = corridor.slowest_mps(tilt(incidence_deg)) / KNOT_MPS;
        let fastest = corridor.fastest_mps(tilt(incidence_deg)) / KNOT_MPS;
        assert!((slowest - slowest_kt).abs() < 0.1, "{incidence_deg} deg: {slowest} kt");
        assert!((fastest - fastest_kt).abs() < 0.1, "{incidence_deg} deg: {fastest} kt");
    }
}

#[test]
fn a_helicopter_in_hover_is_inside_and_an_aeroplane_in_hover_is_not() {
    let corridor = corridor();
    assert!(corridor.margin_mps(tilt(90.0), 0.0) > 0.0);
    assert!(corridor.margin_mps(tilt(0.0), 0.0) < 0.0);
    assert!(corridor.margin_mps(tilt(90.0), 60.0) < 0.0);
}

#[test]
fn limits_arrive_in_si() {
    let envelope = xv15().envelope.clone();
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} is not {b}");
    close(envelope.airspeed.flap_mps_max[2], 170.0 * KNOT_MPS);
    close(envelope.rotors.rated_radps, 601.0 * PI / 30.0);
    close(
        envelope.rotors.short_torque_n_m_max.at(RotorSpeed(565.0 * PI / 30.0)),
        163e3 / 12.0 * 1.355_817_948_331_400_4,
    );
    close(envelope.airframe.touchdown_sink_mps_max, 3.048);
}

/// The constants of the step before they came from the file, to the bit.
#[test]
fn the_models_limits_are_to_the_bit_those_that_logs_were_flown_with() {
    let model = xv15().envelope.model;
    let bits = [
        (model.airspeed_mps_max, 180.0),
        (model.height_m_max, 12e3),
        (model.rotor_speed_radps_min, 43.0),
        (model.rotor_speed_radps_max, 69.3),
        (model.angular_rate_radps_max, 3.0),
    ];
    for (read, was) in bits {
        assert_eq!(f64::to_bits(read), f64::to_bits(was), "{read}");
    }
}

/// What a step says of a helicopter that flies at 30 m/s in 300 m, turning a little.
fn validity_of(aircraft: &Aircraft) -> Validity {
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
    let mut state: State = start.on_wheels(aircraft);
    state.plant.position_m.z -= 300.0;
    state.plant.velocity_mps.x = 30.0;
    state.plant.angular_rate_radps.z = 0.5;
    let inputs = Inputs { events: &[], world: World::default() };
    engine::step(aircraft, &state, &inputs).1.validity
}

#[test]
fn where_the_model_ends_is_read_from_the_file() {
    assert_eq!(validity_of(&xv15()), Validity::empty());
    let changes = [
        (
            "airspeed_mps_max = { value = 180.0",
            "airspeed_mps_max = { value = 29.0",
            Validity::SPEED,
        ),
        ("height_m_max = { value = 12000.0", "height_m_max = { value = 299.0", Validity::HEIGHT),
        (
            "rotor_speed_radps_min = { value = 43.0",
            "rotor_speed_radps_min = { value = 63.0",
            Validity::ROTOR_SPEED,
        ),
        (
            "rotor_speed_radps_max = { value = 69.3",
            "rotor_speed_radps_max = { value = 60.0",
            Validity::ROTOR_SPEED,
        ),
        (
            "angular_rate_radps_max = { value = 3.0",
            "angular_rate_radps_max = { value = 0.4",
            Validity::TUMBLING,
        ),
    ];
    for (was, becomes, bit) in changes {
        assert_eq!(XV15.matches(was).count(), 1, "{was}");
        assert_eq!(validity_of(&read(&XV15.replace(was, becomes))), bit, "{becomes}");
    }
}

/// An aircraft file of before `[envelope]` and `[display]`, as old logs carry it.
fn old_file() -> &'static str {
    let ends = XV15.find("# --------------------------------------------------------------------------------- envelope");
    &XV15[..ends.unwrap()]
}

#[test]
fn a_file_of_before_these_tables_is_the_xv15_of_then() {
    assert!(!old_file().contains("[envelope") && !old_file().contains("[display"));
    assert_eq!(read(old_file()), xv15());
}

#[test]
fn a_file_with_one_of_these_tables_keeps_it() {
    let from = XV15.find("[envelope.").unwrap();
    let to = XV15.find("[display.").unwrap();
    let envelope = XV15[from..to]
        .replace("height_m_max = { value = 12000.0", "height_m_max = { value = 9000.0");
    let aircraft = read(&format!("{}{envelope}", old_file()));
    let kept_m = aircraft.envelope.model.height_m_max;
    assert!((kept_m - 9000.0).abs() < 1e-9, "{kept_m}");
    assert_eq!(aircraft.display, xv15().display);
}

#[test]
fn full_scales_are_the_actuators_travels() {
    let travels = Travels::of(&xv15().actuators);
    let scales = [
        (travels.elevator, 20.0),
        (travels.rudder, 20.0),
        (travels.flap, 75.0),
        (travels.flaperon, 23.8),
        (travels.nacelle_incidence, 95.0),
    ];
    for (travel, deg) in scales {
        assert!((travel.greatest_rad() - deg * DEG).abs() < 1e-12, "{travel:?} is not {deg}");
    }
    assert!(travels.nacelle_incidence.rad_min.abs() < 1e-12, "an aeroplane's nacelles");
}
