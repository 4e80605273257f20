//! A table: its axes and what it holds over them.

use aircraft::XV15;

use crate::{SOURCED, line_of, told, with_line};

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
