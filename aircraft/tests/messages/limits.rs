//! What the engine cannot work with: numbers out of their limits, or that do not go together.

use aircraft::XV15;

use crate::{SOURCED, changed, line_of, told, with_line};

#[test]
fn a_number_the_engine_would_divide_by() {
    changed(
        "rotors",
        "radius_ft",
        &format!("radius_ft = {{ value = 0.0, {SOURCED}"),
        "rotors.radius_ft: expected 3.281e-6 to 3.281e9, found 0",
    );
    changed(
        "engines",
        "lag_s",
        &format!("lag_s = {{ value = 0.001, {SOURCED}"),
        "engines.lag_s: expected 0.004 to 1e9, found 0.001",
    );
}

#[test]
fn a_number_that_would_overflow() {
    changed(
        "engines",
        "jet_thrust_lbf",
        &format!("jet_thrust_n = {{ value = 1e300, {SOURCED}"),
        "engines.jet_thrust_n: expected -1e9 to 1e9, found 1e300",
    );
}

#[test]
fn travel_the_wrong_way_round() {
    changed(
        "actuators.rudder",
        "deg_min",
        &format!("deg_min = {{ value = 30.0, {SOURCED}"),
        "actuators.rudder.deg_min: expected less than actuators.rudder.deg_max",
    );
}

#[test]
fn an_inertia_of_no_body() {
    let (text, _) = with_line(
        "weight_balance.inertia_change",
        "xx_slug_ft2",
        &format!("xx_slug_ft2 = {{ value = -6e4, {SOURCED}"),
    );
    let table = "weight_balance.inertia_change";
    let line = line_of(XV15, table, "[");
    told(
        &text,
        &format!(
            "xv15.toml:{line}: {table}: no body has this inertia; expected positive moments with \
             xx*zz above xz squared"
        ),
    );
}

#[test]
fn an_unknown_limit() {
    changed(
        "envelope.airspeed",
        "mach_max",
        &format!("mech_max = {{ value = 0.575, {SOURCED}"),
        "envelope.airspeed.mech_max: unknown key; expected one of cruise_mps_max, dive_mps_max, \
         mach_max, flap_mps_max, gear_cycle_mps_max (or the same in another unit)",
    );
}

#[test]
fn an_envelope_that_is_there_is_complete() {
    let (text, _) = with_line("envelope.model", "height_m_max", "");
    let table = line_of(XV15, "envelope.model", "[");
    told(
        &text,
        &format!(
            "xv15.toml:{table}: envelope.model: missing key height_m_max (or the same in another \
             unit)"
        ),
    );
}

#[test]
fn a_bound_in_a_list_is_told_in_the_lists_unit() {
    changed(
        "envelope.airspeed",
        "flap_kt_max",
        &format!("flap_kt_max = {{ value = [-1.0, 170.0, 150.0, 100.0], {SOURCED}"),
        "envelope.airspeed.flap_kt_max.value[0]: expected 1.944e-6 to 1.944e9, found -1",
    );
}

#[test]
fn a_limit_of_no_size() {
    changed(
        "envelope.airspeed",
        "gear_cycle_kt_max",
        &format!("gear_cycle_kt_max = {{ value = -160.0, {SOURCED}"),
        "envelope.airspeed.gear_cycle_kt_max: expected 1.944e-6 to 1.944e9, found -160",
    );
}

#[test]
fn a_limit_without_its_source() {
    changed(
        "envelope.model",
        "height_m_max",
        "height_m_max = 12000.0",
        "envelope.model.height_m_max: a number without its source; expected { value = 12000.0, \
         source = \"...\", trust = \"...\" }",
    );
}

#[test]
fn slower_than_the_slowest_is_faster_than_the_fastest() {
    changed(
        "envelope.model",
        "rotor_speed_radps_min",
        &format!("rotor_speed_radps_min = {{ value = 70.0, {SOURCED}"),
        "envelope.model.rotor_speed_radps_min: expected less than \
         envelope.model.rotor_speed_radps_max",
    );
}

#[test]
fn a_corridor_that_falls() {
    let table = "envelope.corridor.calibrated_airspeed_kt_max";
    let (text, line) = with_line(
        table,
        "value",
        "value = [96.0, 117.0, 128.0, 144.0, 143.0, 169.0, 234.0, 234.0]",
    );
    told(
        &text,
        &format!(
            "xv15.toml:{}: {table}: expected airspeeds from 0 that do not fall as the \
             mast tilts forward",
            line - 2
        ),
    );
}

#[test]
fn a_corridor_that_crosses() {
    let table = "envelope.corridor.calibrated_airspeed_kt_min";
    let (text, line) = with_line(
        table,
        "value",
        "value = [0.0, 0.0, 64.0, 64.0, 80.0, 90.0, 160.0, 165.0, 166.0, 167.0]",
    );
    told(
        &text,
        &format!(
            "xv15.toml:{}: {table}: expected less than the fastest airspeed at every \
             mast tilt",
            line - 2
        ),
    );
}

#[test]
fn a_shape_that_is_turned_inside_out() {
    let table = "display.fuselage.section_m";
    let (text, line) = with_line(table, "    [3.40", "    [2.90, 0.50, 0.66, 1.42],");
    told(
        &text,
        &format!(
            "xv15.toml:{}: {table}: expected two cross-sections at least, from front to \
             back, not turned inside out",
            line - 4
        ),
    );
}

#[test]
fn a_cross_section_with_a_number_missing() {
    let table = "display.gear_pods.section_m";
    let (text, line) = with_line(table, "    [6.6", "    [6.6],");
    told(
        &text,
        &format!("xv15.toml:{line}: {table}.value[1]: expected an array of 2, found one of 1"),
    );
}

/// What the program fixes, as docs/aircraft.md lists it.
#[test]
fn counts_that_are_fixed_are_told() {
    changed(
        "rotors.blade",
        "count",
        &format!("count = {{ value = 4.0, {SOURCED}"),
        "rotors.blade.count: expected 3 blades: the model is of a three-bladed gimballed hub; found 4",
    );
    changed(
        "fcc.mixer",
        "flap_deg",
        &format!("flap_deg = {{ value = [0.0, 20.0, 40.0], {SOURCED}"),
        "fcc.mixer.flap_deg: expected an array of 4, found one of 3",
    );
    changed(
        "fcc.governor",
        "rotor_speed_rpm",
        &format!("rotor_speed_rpm = {{ value = [589.0, 517.0], {SOURCED}"),
        "fcc.governor.rotor_speed_rpm: expected an array of 3, found one of 2",
    );
    let five = XV15.replace("[0.55, 0.80, 0.95, 1.0]", "[0.3, 0.55, 0.80, 0.95, 1.0]");
    let five = five
        .replace("    [-0.302,", "    [-0.302, -0.137, 0.039, 0.26, 0.483, 0.70, 0.935, 1.01, 1.105, 1.122],\n    [-0.302,")
        .replace("    [0.014,", "    [0.014, 0.014, 0.014, 0.014, 0.014, 0.026, 0.028],\n    [0.014,");
    let error = aircraft::aircraft("xv15.toml", &five).unwrap_err().to_string();
    assert!(error.contains("the same four regions in lift and drag"), "{error}");
    let (text, line) = with_line(
        "wing_pylon.lift.upright.flap_20",
        "[wing_pylon.lift.upright.flap_20]",
        "[wing_pylon.lift.upright.flap_15]",
    );
    let error = aircraft::aircraft("xv15.toml", &text).unwrap_err().to_string();
    let told = format!(
        "xv15.toml:{line}: wing_pylon.lift.upright.flap_15: unknown key; expected one of flap_0, flap_20, \
         flap_40, flap_75"
    );
    assert!(error.starts_with(&told), "{error}");
}

/// Three sections are four of which two are alike.
#[test]
fn a_blade_of_fewer_sections_is_divided() {
    let three = XV15
        .replace("radius_norm = [0.55, 0.80, 0.95, 1.0]", "radius_norm = [0.80, 0.95, 1.0]")
        .replace("    [-0.302, -0.137, 0.039, 0.26, 0.483, 0.70, 0.935, 1.01, 1.105, 1.122],\n", "")
        .replace("    [0.014, 0.014, 0.014, 0.014, 0.014, 0.026, 0.028],\n", "");
    let aircraft =
        aircraft::aircraft("three.toml", &three).unwrap_or_else(|error| panic!("{error}"));
    let section = &aircraft.rotors.blade.section;
    let middle = 0.5 * (0.0875 + 0.80);
    assert_eq!(section.lift_coefficient.x, [middle, 0.80, 0.95, 1.0]);
    assert_eq!(section.drag_coefficient.x, [middle, 0.80, 0.95, 1.0]);
    assert_eq!(section.lift_coefficient.z[0], section.lift_coefficient.z[1]);
    assert_ne!(section.lift_coefficient.z[1], section.lift_coefficient.z[2]);
}

#[test]
fn speeds_of_a_pilot_that_do_not_go_together_are_refused() {
    changed(
        "pilot",
        "flap_down_kt",
        &format!("flap_down_kt = {{ value = 200.0, {SOURCED}"),
        "pilot.flap_down_kt: expected slower than flap_up",
    );
}
