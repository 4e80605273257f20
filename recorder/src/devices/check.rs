//! What a map cannot mean, refused before take-off with the names of device, axis and control.

use engine::cockpit::{
    Acts, AxisBinding, AxisControl, ButtonBinding, Code, Device, Mode, Params, Side,
};

use super::found::Kind;

/// Kinds of which a map may ask for any.
const KINDS: [Kind; 4] = [Kind::Stick, Kind::Gamepad, Kind::Pedals, Kind::Keyboard];

/// What a device of a map is called in messages.
pub fn called(device: &Device) -> String {
    let said = [&device.name, &device.port, &device.uniq].into_iter().chain(&device.id);
    match said.into_iter().find(|said| !said.trim().is_empty()) {
        Some(said) => said.clone(),
        None if device.kind.is_empty() => "a device without a name".into(),
        None => format!("any {}", device.kind),
    }
}

/// What is wrong with a map by itself, whatever is plugged in; a sentence each.
pub fn check(map: &Params) -> Vec<String> {
    let mut wrong = Vec::new();
    for (number, device) in map.device.iter().enumerate() {
        let name = called(device);
        identity(number, device, &mut wrong);
        for axis in &device.axis {
            if let Some(words) = axis_wrong(axis) {
                wrong.push(format!("{name}: {}: {words}", axis.code));
            }
        }
        for (at, axis) in device.axis.iter().enumerate() {
            for other in device.axis[..at].iter().filter(|other| clash(axis, other)) {
                wrong.push(format!(
                    "{name}: {} and {} both move {}: leave one of them out",
                    other.code,
                    axis.code,
                    axis.control.facts().words
                ));
            }
        }
        for (at, button) in device.button.iter().enumerate() {
            if let Some(words) = button_wrong(button) {
                wrong.push(format!("{name}: {}: {words}", button.code));
            }
            let twice = device.button[..at].iter().any(|other| {
                (&other.code, other.control, other.beyond_norm)
                    == (&button.code, button.control, button.beyond_norm)
            });
            if twice {
                let control = button.control.facts().words;
                wrong.push(format!("{name}: {} is bound to {control} twice", button.code));
            }
        }
    }
    wrong
}

fn identity(number: usize, device: &Device, wrong: &mut Vec<String>) {
    let said = [&device.name, &device.port, &device.uniq, &device.kind];
    if device.id.is_empty() && said.into_iter().all(|said| said.trim().is_empty()) {
        wrong.push(format!(
            "device {number} of the map says neither name, id, port, uniq nor kind: it would be any \
             device, or none"
        ));
    }
    for id in &device.id {
        let parts: Vec<&str> = id.split(':').collect();
        let is_number = |part: &&str| part.len() == 4 && u16::from_str_radix(part, 16).is_ok();
        if parts.len() != 2 || !parts.iter().all(is_number) {
            wrong.push(format!(
                "`{id}` is no id: write vendor and product as `tiltrotor devices` shows them, 044f:b10a"
            ));
        }
    }
    if !device.kind.is_empty() && !KINDS.iter().any(|kind| kind.name() == device.kind) {
        let names: Vec<_> = KINDS.iter().map(|kind| kind.name()).collect();
        wrong.push(format!("no kind is called `{}`; there are {}", device.kind, names.join(", ")));
    }
}

/// Whether two axes of a device, or of two devices, move the same, and are no joined pair.
pub fn clash(one: &AxisBinding, other: &AxisBinding) -> bool {
    one.control == other.control
        && (one.side == other.side || one.side == Side::Both || other.side == Side::Both)
}

fn axis_wrong(axis: &AxisBinding) -> Option<String> {
    let control = axis.control.facts().words;
    let within = |number: f64| (0.0..=1.0).contains(&number);
    let is_joined = axis.side != Side::Both;
    let joins = [
        AxisControl::StickAft,
        AxisControl::StickRight,
        AxisControl::Collective,
        AxisControl::PedalRight,
    ];
    if !within(axis.dead_norm) || !within(axis.expo_norm) || !within(axis.reach_norm) {
        Some("dead_norm, expo_norm and reach_norm are from 0 to 1".into())
    } else if !(0.0..=100.0).contains(&axis.rate_norm_per_s) {
        Some("rate_norm_per_s is from 0 to 100; turn it round with inverted = true".into())
    } else if is_joined && !joins.contains(&axis.control) {
        Some(format!("{control} cannot be moved by two axes: leave out `side`"))
    } else if axis.rate_norm_per_s != 0.0 && axis.control.facts().hardware.is_none() {
        Some(format!("{control} cannot be moved at a rate: leave out `rate_norm_per_s`"))
    } else {
        None
    }
}

fn button_wrong(button: &ButtonBinding) -> Option<String> {
    let facts = button.control.facts();
    let is_axis = button.code.all().iter().any(|code| matches!(code, Code::Axis(_)));
    match (is_axis, button.beyond_norm) {
        (true, None) => {
            Some("an axis as a button: say from where on it is pressed, `beyond_norm = 0.5`".into())
        }
        (false, Some(_)) => Some("`beyond_norm` is for axes; this is a button".into()),
        (true, Some(beyond)) if !(-1.0..=1.0).contains(&beyond) => {
            Some("`beyond_norm` is from -1 to 1".into())
        }
        _ if facts.acts == Acts::Once && matches!(button.mode, Some(Mode::Hold | Mode::Latch)) => {
            Some(format!("{} acts once, when it is pressed: leave out `mode`", facts.words))
        }
        _ if button.rate_norm_per_s.is_some() && button.control.trims().is_none() => {
            Some(format!("{} has no rate: leave out `rate_norm_per_s`", facts.words))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrong(text: &str) -> Vec<String> {
        check(&aircraft::cockpit("map.toml", text).expect("a map"))
    }

    #[test]
    fn what_a_map_cannot_mean_is_told_by_name() {
        for (text, expected) in [
            ("[[device]]\nname = \" \"", "neither name, id, port, uniq nor kind"),
            ("[[device]]\nid = [\"44f:b10a\"]", "`44f:b10a` is no id"),
            ("[[device]]\nkind = \"yoke\"", "no kind is called `yoke`"),
            (
                "[[device]]\nname = \"T\"\naxis = [{ code = \"ABS_Z\", control = \"collective\" }, \
                 { code = 6, control = \"collective\" }]",
                "T: ABS_Z and ABS_THROTTLE both move collective",
            ),
            (
                "[[device]]\nname = \"T\"\nbutton = [{ code = \"ABS_HAT0Y\", control = \"marker\" }]",
                "T: ABS_HAT0Y: an axis as a button",
            ),
            (
                "[[device]]\nname = \"T\"\nbutton = [{ code = 288, control = \"marker\", mode = \"hold\" }]",
                "T: BTN_TRIGGER: marker acts once",
            ),
            (
                "[[device]]\nname = \"T\"\naxis = [{ code = 1, control = \"brake_left\", side = \"upper\" }]",
                "brake left cannot be moved by two axes",
            ),
        ] {
            let told = wrong(text);
            assert!(told.iter().any(|words| words.contains(expected)), "{expected}: {told:?}");
        }
    }

    #[test]
    fn two_triggers_may_share_the_pedals() {
        let text = "[[device]]\nkind = \"gamepad\"\naxis = [\
            { code = \"ABS_RZ\", control = \"pedal_right\", side = \"upper\" },\
            { code = \"ABS_Z\", control = \"pedal_right\", side = \"lower\" }]";
        assert!(wrong(text).is_empty(), "{:?}", wrong(text));
    }

    #[test]
    fn what_a_button_cannot_mean_is_told_and_what_it_can_mean_is_not() {
        let told = |words: &str| {
            let map = wrong(&format!("[[device]]\nname = \"T\"\nbutton = [{{ {words} }}]"));
            map.join("; ")
        };
        for (words, expected) in [
            ("code = 288, control = \"marker\"", ""),
            ("code = 288, control = \"trim_aft\", rate_norm_per_s = 0.1", ""),
            ("code = 288, control = \"marker\", rate_norm_per_s = 0.1", "marker has no rate"),
            ("code = 288, control = \"nacelle_aft\", mode = \"hold\"", ""),
            ("code = 288, control = \"marker\", mode = \"latch\"", "marker acts once"),
            ("code = 288, control = \"marker\", beyond_norm = 0.5", "`beyond_norm` is for axes"),
            ("code = \"ABS_HAT0Y\", control = \"marker\"", "say from where on it is pressed"),
            ("code = \"ABS_HAT0Y\", control = \"marker\", beyond_norm = -1.0", ""),
            ("code = \"ABS_HAT0Y\", control = \"marker\", beyond_norm = 1.0", ""),
            ("code = \"ABS_HAT0Y\", control = \"marker\", beyond_norm = 1.1", "from -1 to 1"),
            ("code = \"ABS_HAT0Y\", control = \"marker\", beyond_norm = -1.1", "from -1 to 1"),
        ] {
            let told = told(words);
            let right = if expected.is_empty() { told.is_empty() } else { told.contains(expected) };
            assert!(right, "{words}: `{told}`, and not `{expected}`");
        }
    }
}
