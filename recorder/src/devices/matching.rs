//! Which device of the map a device is.

use engine::cockpit::{Code, Device, Params};

use super::found::Found;

/// Whether two names are the same; case does not matter, and an empty one is no name.
fn is_same(wanted: &str, found: &str) -> bool {
    !wanted.is_empty() && wanted.trim().to_lowercase() == found.trim().to_lowercase()
}

fn is_part(wanted: &str, found: &str) -> bool {
    let wanted = wanted.trim().to_lowercase();
    !wanted.is_empty() && found.to_lowercase().contains(&wanted)
}

/// How well a device is the one that the map means; nothing when it is not. Everything that the map says
/// has to be so; a map that says nothing means none. A name may be a part of the device's, but keyboards,
/// receivers and touchpads are only taken by their whole name, or by a map that asks for their kind.
pub fn fits(wanted: &Device, found: &Found) -> Option<u32> {
    let mut fit = 0;
    let mut named = false;
    if !wanted.name.trim().is_empty() {
        if is_same(&wanted.name, &found.name) {
            (fit, named) = (fit + 16, true);
        } else if is_part(&wanted.name, &found.name) {
            fit += 4;
        } else {
            return None;
        }
    }
    if !wanted.id.is_empty() {
        if !wanted.id.iter().any(|id| is_same(id, &found.id())) {
            return None;
        }
        fit += 8;
    }
    if !wanted.port.trim().is_empty() {
        let places = [&found.port, &found.phys, &found.node];
        if !places.into_iter().any(|place| is_same(&wanted.port, place)) {
            return None;
        }
        fit += 32;
    }
    if !wanted.uniq.trim().is_empty() {
        if !is_same(&wanted.uniq, &found.uniq) {
            return None;
        }
        fit += 32;
    }
    if !wanted.kind.trim().is_empty() {
        if !is_same(&wanted.kind, found.kind.name()) {
            return None;
        }
        (fit, named) = (fit + 2, true);
    }
    (fit > 0 && (named || found.kind.flies())).then_some(fit)
}

/// How many of the axes and buttons that the map uses a device has.
pub fn codes_in(wanted: &Device, found: &Found) -> usize {
    let codes = wanted.axis.iter().map(|axis| &axis.code);
    let codes = codes.chain(wanted.button.iter().map(|button| &button.code));
    codes.filter(|codes| codes.all().iter().any(|&code| found.has(code))).count()
}

/// The number of the map's device that a device is and that is `free`: the one that it fits best, and
/// that has most of what it has; of equals the first. A device that has nothing of what the map's one uses is
/// another node of the same name.
pub fn number_of(map: &Params, found: &Found, free: impl Fn(usize) -> bool) -> Option<usize> {
    let mut best = None;
    for (number, wanted) in map.device.iter().enumerate() {
        let codes = codes_in(wanted, found);
        let is_another = codes == 0 && !(wanted.axis.is_empty() && wanted.button.is_empty());
        let Some(fit) = fits(wanted, found).filter(|_| free(number) && !is_another) else {
            continue;
        };
        let rank = (fit, has_all_axes(wanted, found), codes);
        if best.is_none_or(|(best, _)| rank > best) {
            best = Some((rank, number));
        }
    }
    best.map(|(_, number)| number)
}

/// Whether it has every axis that the map uses.
pub fn has_all_axes(wanted: &Device, found: &Found) -> bool {
    let has = |codes: &[Code]| codes.iter().any(|&code| found.has(code));
    wanted.axis.iter().all(|axis| has(axis.code.all()))
}

#[cfg(test)]
mod tests {
    use super::super::found::Kind;
    use super::*;

    fn pad() -> Found {
        Found {
            name: "Wireless Controller".into(),
            vendor: 0x54c,
            product: 0x9cc,
            port: "pci-0000:00:14.0-usb-0:3:1.3".into(),
            uniq: "a1:b2".into(),
            kind: Kind::Gamepad,
            ..Found::default()
        }
    }

    fn named(name: &str) -> Device {
        Device { name: name.into(), ..Device::default() }
    }

    #[test]
    fn a_name_fits_in_any_case_and_better_when_it_is_whole() {
        let fit = |name| fits(&named(name), &pad());
        assert!(fit("wireless controller") > fit("Wireless"));
        assert!(fit("Wireless").is_some());
        assert_eq!(fit("Wired"), None);
        assert_eq!((fit(""), fit("  ")), (None, None));
        assert_eq!(fits(&Device::default(), &pad()), None);
    }

    #[test]
    fn everything_that_the_map_says_has_to_be_so() {
        let id = Device { id: vec!["054C:09CC".into()], ..Device::default() };
        assert!(fits(&id, &pad()).is_some());
        let other_port = Device { port: "usb-1".into(), ..id.clone() };
        assert_eq!(fits(&other_port, &pad()), None);
        let at_port = Device { port: pad().port.to_uppercase(), ..id.clone() };
        assert!(fits(&at_port, &pad()) > fits(&id, &pad()));
        assert!(fits(&Device { uniq: "A1:B2".into(), ..id.clone() }, &pad()).is_some());
        assert_eq!(fits(&Device { kind: "stick".into(), ..id }, &pad()), None);
    }

    #[test]
    fn a_receiver_is_only_taken_by_its_whole_name_or_kind() {
        let receiver =
            Found { name: "Nano Transceiver v2.0".into(), kind: Kind::Keyboard, ..pad() };
        assert_eq!(fits(&named("Transceiver"), &receiver), None);
        let id = Device { id: vec!["054c:09cc".into()], ..Device::default() };
        assert_eq!(fits(&id, &receiver), None);
        assert!(fits(&named("nano transceiver V2.0"), &receiver).is_some());
        assert!(
            fits(&Device { kind: "keyboard".into(), ..Device::default() }, &receiver).is_some()
        );
    }

    fn map(text: &str) -> Params {
        aircraft::cockpit("map.toml", text).unwrap()
    }

    fn with(axes: &[u64], keys: &[u64]) -> Found {
        let axis =
            |&code| super::super::found::Axis { code, raw_min: 0, raw_max: 255, value: None };
        Found { axes: axes.iter().map(axis).collect(), keys: keys.to_vec(), ..pad() }
    }

    /// A gamepad's touchpad and motion sensor have its name, too.
    #[test]
    fn a_device_that_has_nothing_of_what_the_map_uses_is_not_the_one_of_its_name() {
        let uses = map("[[device]]\nname = \"Wireless Controller\"\n\
                       axis = [{ code = \"ABS_Y\", control = \"stick_aft\" }]\n\
                       button = [{ code = 304, control = \"marker\" }]");
        let number = |found: &Found| number_of(&uses, found, |_| true);
        assert_eq!(number(&pad()), None);
        assert_eq!(number(&with(&[0, 2], &[305])), None);
        assert_eq!(number(&with(&[1], &[])), Some(0));
        assert_eq!(number(&with(&[], &[304])), Some(0));
        // Nor does it hide one that fits less well, but is it.
        let two = map(
            "[[device]]\nname = \"Wireless Controller\"\naxis = [{ code = \"ABS_X\", control = \"stick_right\" }]\n\
             [[device]]\nname = \"Wireless\"\naxis = [{ code = \"ABS_Y\", control = \"stick_aft\" }]",
        );
        assert_eq!(number_of(&two, &with(&[1], &[]), |_| true), Some(1));
        // Where the map uses nothing of it, nothing can be missing.
        let bare = Params { device: vec![named("Wireless Controller")] };
        assert_eq!(number_of(&bare, &pad(), |_| true), Some(0));
    }

    #[test]
    fn of_devices_of_the_map_that_fit_alike_the_one_with_most_of_what_there_is_is_taken() {
        let y = "{ code = \"ABS_Y\", control = \"stick_aft\" }";
        let x = "{ code = \"ABS_X\", control = \"stick_right\" }";
        let device = |axes: &str| format!("[[device]]\nname = \"Wireless\"\naxis = [{axes}]\n");
        let three = [y.to_string(), format!("{y}, {x}"), format!("{x}, {y}")];
        let map = map(&three.map(|axes| device(&axes)).concat());
        let but = |found: &Found, taken: &[usize]| {
            number_of(&map, found, |number| !taken.contains(&number))
        };
        let both = with(&[0, 1], &[]);
        assert_eq!(but(&both, &[]), Some(1));
        assert_eq!(but(&both, &[1]), Some(2));
        assert_eq!(but(&both, &[1, 2]), Some(0));
        assert_eq!(but(&both, &[0, 1, 2]), None);
        // Of an axis by itself, the one that asks for no other.
        assert_eq!(but(&with(&[1], &[]), &[]), Some(0));
    }
}
