//! A number: its value, its unit, its source and its trust.

use aircraft::XV15;

use crate::{SOURCED, changed, line_of};

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
