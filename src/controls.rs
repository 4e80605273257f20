//! What moves the aircraft: the active cockpit map and the keys, for `fly --controls` and the panel.

use engine::cockpit::Params;
use engine::inputs::Failures;
use recorder::keyboard::{self, KeyAction};

/// The keys that are not in the list of actions, and what they do.
const OTHERS: [(&str, &str); 3] = [
    ("F5 to F8", "goes on from a start position"),
    ("? or Tab", "next page: flight, controls"),
    ("Q, Ctrl-C", "ends the flight"),
];

/// The controls of a map line by line; those of the keyboard by their keys.
pub fn lines(map: &Params) -> Vec<String> {
    let mut lines = Vec::new();
    for device in &map.device {
        if device.name == keyboard::DEVICE {
            lines.extend(keyboard());
            continue;
        }
        lines.push(format!("{}:", device.name));
        for axis in &device.axis {
            let facts = axis.control.facts();
            lines.push(format!("  axis {:<#6x} {}", axis.code, facts.words));
        }
        for button in &device.button {
            let facts = button.control.facts();
            lines.push(format!("  button {:<#5x} {}", button.code, facts.words));
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
