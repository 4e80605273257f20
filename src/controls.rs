//! What moves the aircraft: the active cockpit map and the keys, for `fly --controls` and the panel.

use engine::cockpit::{AxisBinding, ButtonBinding, Device, Params, Side, Travel};
use engine::inputs::Failures;
use recorder::keyboard::{self, KeyAction};

/// The keys that are not in the list of actions, and what they do.
const OTHERS: [(&str, &str); 3] = [
    ("F5 to F8", "goes on from a start position"),
    ("? or Tab", "next page: flight, controls"),
    ("Q, Ctrl-C", "ends the flight"),
];

/// The controls of a map line by line; those of the keyboard by their keys. `names` are what the crew calls
/// its devices, by their numbers, as far as they are known.
pub fn lines(map: &Params, names: &[String]) -> Vec<String> {
    let mut lines = Vec::new();
    for (number, device) in map.device.iter().enumerate() {
        if device.name == keyboard::DEVICE {
            lines.extend(keyboard());
            continue;
        }
        let name = names.get(number).unwrap_or(&device.name);
        lines.push(format!("device {number}, {name}:"));
        for axis in &device.axis {
            let (code, words) = (axis.code.to_string(), axis.control.facts().words);
            lines.push(format!("  {code:<14} {words}{}", how(axis)));
        }
        for button in &device.button {
            let (code, words) = (button.code.to_string(), button.control.facts().words);
            lines.push(format!("  {code:<14} {words}{}", how_pressed(button)));
        }
    }
    lines
}

/// The keys.
pub fn keyboard() -> Vec<String> {
    let own = KeyAction::ALL.iter().map(|action| {
        let facts = action.facts();
        (facts.on.to_string(), facts.description.trim_end_matches('.').to_string())
    });
    let others = OTHERS.iter().map(|(on, what)| (on.to_string(), what.to_string()));
    let failures = (1..)
        .zip(Failures::FACTS)
        .map(|(number, facts)| (format!("{number}"), format!("fails or mends: {}", facts.words)));
    let keys = own.chain(failures).chain(others);
    std::iter::once("keyboard:".to_string())
        .chain(keys.map(|(on, what)| format!("  {on:<12} {what}")))
        .collect()
}

/// The controls of a device, in words.
#[cfg_attr(not(feature = "sticks"), expect(dead_code, reason = "no device is read"))]
pub fn moved(device: &Device) -> String {
    let axes = device.axis.iter().map(|axis| axis.control.facts().words);
    let buttons = device.button.iter().map(|button| button.control.facts().words);
    let mut words: Vec<&str> = axes.collect();
    for button in buttons.filter(|button| !button.is_empty()) {
        if !words.contains(&button) {
            words.push(button);
        }
    }
    words.join(", ")
}

fn how(axis: &AxisBinding) -> String {
    let mut how = String::new();
    let percent = |norm: f64| format!("{:.0} %", norm * 100.0);
    match axis.side {
        Side::Both => {}
        Side::Upper => how.push_str(", upper half"),
        Side::Lower => how.push_str(", lower half"),
    }
    if axis.inverted {
        how.push_str(", inverted");
    }
    if axis.rate_norm_per_s != 0.0 {
        how.push_str(&format!(", at {} a second", percent(axis.rate_norm_per_s)));
    }
    let centred = axis.control.facts().travel == Travel::Centred || axis.rate_norm_per_s != 0.0;
    if axis.dead_norm > 0.0 && centred {
        how.push_str(&format!(", dead zone {}", percent(axis.dead_norm)));
    }
    if let (Some(low), Some(high)) = (axis.raw_min, axis.raw_max) {
        how.push_str(&format!(", {low} to {high} counts"));
    }
    how
}

fn how_pressed(button: &ButtonBinding) -> String {
    let beyond = button.beyond_norm.map(|norm| {
        let side = if norm < 0.0 { "below" } else { "above" };
        format!(", {side} {:.0} % of its half travel", norm * 100.0)
    });
    let inverted = if button.inverted { ", when it is not pressed" } else { "" };
    format!("{}{inverted}", beyond.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_listed_with_what_it_does() {
        let lines = keyboard();
        assert_eq!(lines[0], "keyboard:");
        // A line each: the actions, the failures by their digits, and what is no action.
        assert_eq!(lines.len(), 1 + KeyAction::ALL.len() + Failures::FACTS.len() + 3);
        for line in [
            "  PageUp       Power lever up",
            "  Left         Stick left while held",
            "  1            fails or mends: left engine",
            "  Q, Ctrl-C    ends the flight",
        ] {
            assert!(lines.iter().any(|known| known == line), "{line} in {lines:#?}");
        }
        let map = aircraft::cockpit("keyboard.toml", aircraft::KEYBOARD_MAP).unwrap();
        assert_eq!(super::lines(&map, &[]), lines);
    }

    #[test]
    fn an_axis_and_a_button_are_listed_with_how_they_move_their_control() {
        let map = "[[device]]\nname = \"T\"\n\
                   axis = [{ code = \"ABS_Y\", control = \"stick_aft\", inverted = true, dead_norm = 0.05 },\
                   { code = \"ABS_Z\", control = \"collective\", dead_norm = 0.05, raw_min = 3, raw_max = 250 },\
                   { code = \"ABS_RZ\", control = \"pedal_right\", side = \"upper\" },\
                   { code = \"ABS_RX\", control = \"pedal_right\", side = \"lower\" },\
                   { code = \"ABS_RY\", control = \"collective\", rate_norm_per_s = 0.3, dead_norm = 0.1 }]\n\
                   button = [{ code = 288, control = \"marker\" },\
                   { code = \"ABS_HAT0Y\", control = \"trim_aft\", beyond_norm = 0.5 },\
                   { code = \"ABS_HAT0X\", control = \"trim_left\", beyond_norm = -0.5, inverted = true }]";
        let map = aircraft::cockpit("map.toml", map).unwrap();
        let listed = |names: &[String]| lines(&map, names);
        assert_eq!(listed(&["Stick".into()])[0], "device 0, Stick:");
        assert_eq!(
            listed(&[]),
            [
                "device 0, T:",
                "  ABS_Y          stick aft, inverted, dead zone 5 %",
                // At the end of a lever's travel there is no middle to be dead.
                "  ABS_Z          collective, 3 to 250 counts",
                "  ABS_RZ         pedal right, upper half",
                "  ABS_RX         pedal right, lower half",
                "  ABS_RY         collective, at 30 % a second, dead zone 10 %",
                "  BTN_TRIGGER    marker",
                "  ABS_HAT0Y      trim aft, above 50 % of its half travel",
                "  ABS_HAT0X      trim left, below -50 % of its half travel, when it is not pressed",
            ]
        );
        #[cfg(feature = "sticks")]
        assert_eq!(
            moved(&map.device[0]),
            "stick aft, collective, pedal right, pedal right, collective, marker, trim aft, trim left"
        );
    }
}
