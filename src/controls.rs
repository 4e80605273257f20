//! What moves which control, in words: the cockpit map as a pilot reads it.

use engine::cockpit::{AxisBinding, AxisControl, ButtonBinding, Device, Params, Side, Travel};

/// The map, a line a control. `names` are the devices that are there, by number.
pub fn lines(map: &Params, name: impl Fn(usize) -> String) -> Vec<String> {
    let mut lines = Vec::new();
    for &control in AxisControl::ALL {
        for (number, device) in map.device.iter().enumerate() {
            for axis in device.axis.iter().filter(|axis| axis.control == control) {
                let (words, how) = (control.facts().words, how(axis));
                lines.push(format!("  {words:<22} {} of {}{how}", axis.code, name(number)));
            }
        }
    }
    for (number, device) in map.device.iter().enumerate() {
        for button in &device.button {
            let words = button.control.facts().words;
            let how = how_pressed(button);
            lines.push(format!("  {words:<22} {} of {}{how}", button.code, name(number)));
        }
    }
    lines
}

/// The controls of a device, in words.
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
