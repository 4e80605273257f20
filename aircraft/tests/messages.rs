//! What a file with one thing wrong in it is told. Each test changes one line of a good file.

use aircraft::XV15;

/// The line, from 1, that begins with `start` behind the header `table`.
fn line_of(text: &str, table: &str, start: &str) -> usize {
    let lines: Vec<_> = text.lines().collect();
    let header = lines.iter().position(|line| *line == format!("[{table}]")).unwrap();
    header + 1 + lines[header..].iter().position(|line| line.starts_with(start)).unwrap()
}

/// The XV-15 with the line that begins with `start` behind `[table]` replaced, and that line.
fn with_line(table: &str, start: &str, new: &str) -> (String, usize) {
    let line = line_of(XV15, table, start);
    let mut lines: Vec<_> = XV15.lines().collect();
    lines[line - 1] = new;
    (lines.join("\n"), line)
}

#[track_caller]
fn told(text: &str, message: &str) {
    let error = aircraft::aircraft("xv15.toml", text).unwrap_err();
    assert_eq!(error.to_string(), message);
}

/// Replaces a line, and expects to be told `message` about that line.
#[track_caller]
fn changed(table: &str, start: &str, new: &str, message: &str) {
    let (text, line) = with_line(table, start, new);
    told(&text, &format!("xv15.toml:{line}: {message}"));
}

const SOURCED: &str = "source = \"TMX\", trust = \"V\" }";

#[test]
fn a_syntax_error() {
    let (text, line) = with_line("rotors", "radius_ft", "radius_ft = = 1");
    let error = aircraft::aircraft("xv15.toml", &text).unwrap_err().to_string();
    assert!(error.starts_with(&format!("xv15.toml:{line}: not valid TOML: ")), "{error}");
}

#[test]
fn an_unknown_key() {
    changed(
        "rotors",
        "radius_ft",
        &format!("chrod_in = {{ value = 14.0, {SOURCED}"),
        "rotors.chrod_in: unknown key; expected one of radius_m, solidity, polar_inertia_kg_m2, \
         pivot_m, mast_length_m, mast_cant_rad, blade, inflow, flapping, bending, \
         other_rotor \
         (or the same in another unit)",
    );
}

#[test]
fn a_missing_key_is_told_with_its_tables_line() {
    let (text, _) = with_line("rotors", "radius_ft", "");
    let table = line_of(XV15, "rotors", "[rotors]");
    told(
        &text,
        &format!("xv15.toml:{table}: rotors: missing key radius_m (or the same in another unit)"),
    );
}

#[test]
fn a_missing_table() {
    told("name = \"nothing\"", "xv15.toml:1: missing key fcc");
}

#[test]
fn a_string_for_a_number() {
    changed(
        "rotors",
        "solidity",
        &format!("solidity = {{ value = \"thick\", {SOURCED}"),
        "rotors.solidity: expected a number, found a string",
    );
}

#[test]
fn a_number_for_a_vector() {
    changed(
        "rotors",
        "pivot_in",
        &format!("pivot_in = {{ value = 300.0, {SOURCED}"),
        "rotors.pivot_in: expected an array of 3, found a number",
    );
}

#[test]
fn a_vector_of_two() {
    changed(
        "rotors",
        "pivot_in",
        &format!("pivot_in = {{ value = [300.0, 193.0], {SOURCED}"),
        "rotors.pivot_in: expected an array of 3, found one of 2",
    );
}

#[test]
fn a_string_in_a_vector() {
    changed(
        "rotors",
        "pivot_in",
        &format!("pivot_in = {{ value = [300.0, \"far\", 100.0], {SOURCED}"),
        "rotors.pivot_in.value[1]: expected a number, found a string",
    );
}

#[test]
fn a_table_where_a_number_belongs() {
    changed(
        "rotors",
        "solidity",
        &format!("solidity = {{ value = {{ x = 1 }}, {SOURCED}"),
        "rotors.solidity.value: expected a number, found a table",
    );
}

#[test]
fn a_number_without_its_source() {
    changed(
        "rotors",
        "radius_ft",
        "radius_ft = 12.5",
        "rotors.radius_ft: a number without its source; expected { value = 12.5, source = \"...\", \
         trust = \"...\" }",
    );
}

#[test]
fn a_source_a_trust_or_a_value_forgotten() {
    let expected = "expected { value = ..., source = \"...\", trust = \"...\" }";
    for (new, what) in [
        ("radius_ft = { value = 12.5, trust = \"V\" }", "source"),
        ("radius_ft = { value = 12.5, source = \" \", trust = \"V\" }", "source"),
        ("radius_ft = { value = 12.5, source = \"TMX\" }", "trust"),
        ("radius_ft = { source = \"TMX\", trust = \"V\" }", "value"),
    ] {
        changed("rotors", "radius_ft", new, &format!("rotors.radius_ft: no {what}; {expected}"));
    }
}

#[test]
fn an_unknown_trust_label() {
    changed(
        "rotors",
        "radius_ft",
        "radius_ft = { value = 12.5, source = \"TMX\", trust = \"W\" }",
        "rotors.radius_ft: unknown trust label `W`; expected one of V, V-fig, V-sec, R+, R?, E",
    );
}

#[test]
fn a_stray_key_beside_a_value() {
    changed(
        "rotors",
        "radius_ft",
        &format!("radius_ft = {{ value = 12.5, sauce = \"TMX\", {SOURCED}"),
        "rotors.radius_ft.sauce: unknown key; expected one of value, source, trust, note",
    );
}

#[test]
fn the_same_quantity_in_two_units() {
    let line = line_of(XV15, "rotors", "radius_ft");
    changed(
        "rotors",
        "solidity",
        &format!("radius_m = {{ value = 3.81, {SOURCED}"),
        &format!(
            "rotors.radius_m: given twice: rotors.radius_ft on line {line} is the same in another \
             unit"
        ),
    );
}

#[test]
fn numbers_that_are_none() {
    for (number, shown) in [("nan", "nan"), ("-inf", "-inf"), ("1e999", "1e999")] {
        changed(
            "rotors",
            "radius_ft",
            &format!("radius_ft = {{ value = {number}, {SOURCED}"),
            &format!("rotors.radius_ft.value: expected a finite number, found {shown}"),
        );
    }
}

#[test]
fn a_number_the_engine_would_divide_by() {
    changed(
        "rotors",
        "radius_ft",
        &format!("radius_ft = {{ value = 0.0, {SOURCED}"),
        "rotors.radius_ft: expected 1e-6 to 1000000000.0 in SI units, found 0.0",
    );
    changed(
        "engines",
        "lag_s",
        &format!("lag_s = {{ value = 0.001, {SOURCED}"),
        "engines.lag_s: expected 0.004 to 1000000000.0 in SI units, found 0.001",
    );
}

#[test]
fn a_number_that_would_overflow() {
    changed(
        "engines",
        "jet_thrust_lbf",
        &format!("jet_thrust_n = {{ value = 1e300, {SOURCED}"),
        "engines.jet_thrust_n: expected -1000000000.0 to 1000000000.0 in SI units, found 1e300",
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
fn a_table_that_does_not_ascend() {
    let table = "actuators.nacelle_degps";
    let (text, line) =
        with_line(table, "mast_tilt_deg", "mast_tilt_deg = [-5.0, 2.0, 1.0, 87.0, 87.5, 90.0]");
    told(&text, &format!("xv15.toml:{}: {table}: expected ascending arguments", line - 1));
}

#[test]
fn a_table_with_a_value_missing_is_found_by_its_engine_name() {
    let table = "fcc.governor.lever_bottom_deg";
    let (text, line) = with_line(table, "value", "value = [1.0, 2.0]");
    told(&text, &format!("xv15.toml:{}: {table}: expected as many values as arguments", line - 2));
}

#[test]
fn a_table_over_the_wrong_arguments() {
    let table = "fcc.mixer.cyclic_per_pedal_deg_per_in";
    let (text, line) = with_line(table, "airspeed_kt", "");
    told(
        &text,
        &format!(
            "xv15.toml:{}: {table}: expected a table over mast_tilt_rad, airspeed_mps (or \
             the same in another unit), found one over mast_tilt_deg; give its values over \
             mast_tilt_rad, airspeed_mps, in this order",
            line - 2
        ),
    );
}

#[test]
fn a_number_where_a_table_belongs() {
    let table = "actuators.nacelle_degps";
    let (text, line) = with_line(table, "mast_tilt_deg", "");
    told(
        &text,
        &format!(
            "xv15.toml:{}: {table}: expected a table over mast_tilt_rad (or the same in \
             another unit), found no arguments; give its values over mast_tilt_rad",
            line - 1
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
fn a_limit_of_no_size() {
    changed(
        "envelope.airspeed",
        "gear_cycle_kt_max",
        &format!("gear_cycle_kt_max = {{ value = -160.0, {SOURCED}"),
        "envelope.airspeed.gear_cycle_kt_max: expected 1e-6 to 1000000000.0 in SI units, found \
         -82.31111111111112",
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

#[test]
fn a_control_that_no_cockpit_has() {
    let map = "[[device]]\nname = \"stick\"\nbutton = [\n    { code = 1, control = \"eject\" },\n]";
    let error = aircraft::cockpit("stick.toml", map).unwrap_err();
    assert_eq!(
        error.to_string(),
        "stick.toml:4: device[0].button[0].control: unknown name `eject`; expected one of \
         nacelle_forward, nacelle_aft, flap_down, flap_up, gear_toggle, parking_brake_toggle, \
         scas_toggle, rpm_select, marker, gear_down, parking_brake, scas, wheel_brakes, \
         force_trim_release, trim_aft, trim_forward, trim_right, trim_left, trim_pedal_right, \
         trim_pedal_left"
    );
}

#[test]
fn a_code_that_is_none() {
    let code = "an event code, by the kernel's name or its number, or an array of them";
    let beyond = "an event code is from 0 to 0xffff".to_string();
    for (written, told) in [
        ("-1", format!(".code: {beyond}")),
        ("65536", format!(".code: {beyond}")),
        ("1.5", format!(".code: expected {code}, found floating point `1.5`")),
        ("true", format!(": expected {code}, found boolean `true`")),
        (
            "\"BTN_EJECT\"",
            ": `BTN_EJECT` is no axis and no button that is known: write it as `tiltrotor devices` shows \
             it, ABS_X or BTN_TRIGGER, or numbered, ABS_0x2a or BTN_0x12c"
                .into(),
        ),
    ] {
        let map = format!(
            "[[device]]\nname = \"s\"\nbutton = [{{ code = {written}, control = \"marker\" }}]"
        );
        let error = aircraft::cockpit("stick.toml", &map).unwrap_err();
        assert_eq!(error.to_string(), format!("stick.toml:3: device[0].button[0]{told}"));
    }
}

#[test]
fn a_start_beyond_the_pole() {
    let text = aircraft::DEFAULT_SCENARIO.replace("19.721359", "100.0");
    let error = aircraft::start("default.toml", &text).unwrap_err().to_string();
    assert!(error.contains(": origin.latitude_deg: expected -1.55 to 1.55 in SI units"), "{error}");
}

/// Whatever a line is replaced by, the answer is a message about the file, never a panic.
#[test]
fn any_line_may_be_missing_or_nonsense() {
    let lines: Vec<_> = XV15.lines().collect();
    let at = |header: &str| lines.iter().position(|line| *line == header).unwrap();
    // The lines of the airframe's tables are all alike: one in ten stands for the rest.
    let tables = at("[rotor_wake]")..at("[engines]");
    let told_apart = |i: &usize| !tables.contains(i) || i.is_multiple_of(10);
    for i in (0..lines.len()).filter(told_apart) {
        let mut changed = lines.clone();
        changed[i] = ["", "x = 1", "]"][i % 3];
        if let Err(error) = aircraft::aircraft("xv15.toml", &changed.join("\n")) {
            assert!(error.to_string().starts_with("xv15.toml:"), "{error}");
        }
    }
}

/// Two blocks have a table `drag`, each over an angle of its own.
#[test]
fn a_table_over_another_block_s_axis_is_refused_with_the_right_one() {
    for (table, given, other) in [
        ("horizontal_stabilizer.drag", "alpha_deg", "beta_deg"),
        ("vertical_stabilizers.drag", "beta_deg", "alpha_deg"),
        ("vertical_stabilizers.drag_by_mach.mach_0_5", "beta_deg", "alpha_deg"),
        ("horizontal_stabilizer.drag_by_mach.mach_0_5", "alpha_deg", "beta_deg"),
        ("vertical_stabilizers.side_force_by_mach.mach_0_4", "beta_deg", "alpha_deg"),
        ("wing_pylon.lift.upright.flap_20", "alpha_deg", "beta_deg"),
    ] {
        let line = line_of(XV15, table, given);
        let mut lines: Vec<_> = XV15.lines().map(str::to_owned).collect();
        lines[line - 1] = lines[line - 1].replacen(given, other, 1);
        let right = given.replace("_deg", "_rad");
        let table_line = line_of(XV15, table, "[");
        told(
            &lines.join("\n"),
            &format!(
                "xv15.toml:{table_line}: {table}: expected a table over {right} (or the same in another \
                 unit), found one over {other}; give its values over {right}"
            ),
        );
    }
}

/// Rows and columns would be taken for each other.
#[test]
fn a_table_over_its_axes_in_another_order_is_refused() {
    let table = "vertical_stabilizers.rotor_sidewash";
    let (first, second) = (line_of(XV15, table, "airspeed_kt"), line_of(XV15, table, "beta_deg"));
    let mut lines: Vec<_> = XV15.lines().collect();
    lines.swap(first - 1, second - 1);
    let line = line_of(XV15, table, "[");
    told(
        &lines.join("\n"),
        &format!(
            "xv15.toml:{line}: {table}: expected a table over airspeed_mps, beta_rad (or the same in \
             another unit), found one over beta_deg, airspeed_kt; give its values over airspeed_mps, \
             beta_rad, in this order"
        ),
    );
}

#[test]
fn a_table_where_one_number_belongs() {
    let (text, line) = with_line(
        "rotors",
        "solidity",
        &format!("solidity = {{ mast_tilt_deg = [0, 90], value = [0.089, 0.09], {SOURCED}"),
    );
    told(
        &text,
        &format!(
            "xv15.toml:{line}: rotors.solidity: expected a number, found values over mast_tilt_deg"
        ),
    );
}

/// What the program fixes, as docs/aircraft.md lists it.
#[test]
fn counts_that_are_fixed_are_told() {
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
