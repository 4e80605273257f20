//! Cockpit maps and scenarios.

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
    assert!(error.contains(": origin.latitude_deg: expected -88.81 to 88.81, found"), "{error}");
}
