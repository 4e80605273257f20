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
