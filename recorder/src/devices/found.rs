//! An input device as it was found: what it calls itself, what it has, where everything stands.

use engine::cockpit::Code;
use logs::devices::DeviceIdentity;

/// An absolute axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// The kernel's event code.
    pub code: u64,
    /// Raw value at the lower end.
    pub raw_min: i64,
    /// Raw value at the upper end.
    pub raw_max: i64,
    /// Where it stands, of systems that tell.
    pub value: Option<i64>,
}

/// What a device is, told by what it has and not by what others say of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// A stick, throttle, or panel: it has buttons of a joystick.
    Stick,
    /// It has the buttons of a gamepad.
    Gamepad,
    /// Axes and no button.
    Pedals,
    /// Many keys that are letters; or a receiver that says so.
    Keyboard,
    /// A mouse.
    Mouse,
    /// A touchpad or tablet.
    Touchpad,
    /// A gamepad's own motion sensor.
    Motion,
    /// None of these.
    #[default]
    Other,
}

impl Kind {
    /// Its name in maps.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Gamepad => "gamepad",
            Self::Pedals => "pedals",
            Self::Keyboard => "keyboard",
            Self::Mouse => "mouse",
            Self::Touchpad => "touchpad",
            Self::Motion => "motion sensor",
            Self::Other => "other device",
        }
    }

    /// Whether people fly with it.
    pub fn flies(self) -> bool {
        matches!(self, Self::Stick | Self::Gamepad | Self::Pedals)
    }
}

/// A device that was found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// `/dev/input/event20`, or a number where there are no nodes.
    pub node: String,
    /// What it calls itself.
    pub name: String,
    /// The kernel's bus type.
    pub bus: u64,
    /// The maker's USB number.
    pub vendor: u64,
    /// The product's USB number.
    pub product: u64,
    /// The device's version.
    pub version: u64,
    /// Where it is plugged in, as the kernel names it.
    pub phys: String,
    /// Its serial number.
    pub uniq: String,
    /// Where it is plugged in, as udev names it; the kernel's name without udev.
    pub port: String,
    /// What it is.
    pub kind: Kind,
    /// Its axes, by their codes.
    pub axes: Vec<Axis>,
    /// Its buttons and keys, by their codes.
    pub keys: Vec<u64>,
    /// Those of them that are pressed.
    pub pressed: Vec<u64>,
}

impl Found {
    /// Whether it has this axis or button.
    pub fn has(&self, code: Code) -> bool {
        match code {
            Code::Axis(code) => self.axes.iter().any(|axis| axis.code == code),
            Code::Key(code) => self.keys.contains(&code),
        }
    }

    /// `044f:b10a`.
    pub fn id(&self) -> String {
        format!("{:04x}:{:04x}", self.vendor, self.product)
    }

    /// For a log: its number in `/hardware`, or its place among those that are not mapped.
    pub fn identity(&self, number: u64, mapped: bool) -> DeviceIdentity {
        DeviceIdentity {
            tick: 0,
            device: number,
            mapped: u64::from(mapped),
            bus: self.bus,
            vendor: self.vendor,
            product: self.product,
            version: self.version,
            name: self.name.clone(),
            phys: self.phys.clone(),
            uniq: self.uniq.clone(),
            port: self.port.clone(),
        }
    }
}

/// Buttons of joysticks: `BTN_JOYSTICK` up to `BTN_DEAD`, and those beyond the ones with names.
fn is_joystick_button(code: u64) -> bool {
    (0x120..0x130).contains(&code) || (0x2c0..0x2e8).contains(&code)
}

/// What a device with these axes and keys is. `has_pointer` is what the kernel says of touchpads,
/// `is_motion` of motion sensors, `has_relative` of mice.
pub fn kind(
    axes: &[Axis],
    keys: &[u64],
    has_pointer: bool,
    is_motion: bool,
    has_relative: bool,
) -> Kind {
    let has = |code| keys.contains(&code);
    let letters = keys.iter().filter(|&&code| (16..=50).contains(&code)).count();
    let axis = |codes: std::ops::RangeInclusive<u64>| axes.iter().any(|a| codes.contains(&a.code));
    // BTN_TOOL_PEN, BTN_TOOL_FINGER, BTN_TOUCH.
    let is_touched = [0x140, 0x145, 0x14a].into_iter().any(has);
    if is_motion {
        Kind::Motion
    } else if letters >= 20 {
        Kind::Keyboard
    } else if has(0x130) && axis(0..=1) {
        Kind::Gamepad
    } else if keys.iter().any(|&code| is_joystick_button(code)) && axis(0..=0x28) {
        Kind::Stick
    } else if has_pointer || is_touched {
        Kind::Touchpad
    } else if has_relative {
        Kind::Mouse
    } else if keys.is_empty() && axis(0..=0x0a) {
        Kind::Pedals
    } else {
        Kind::Other
    }
}

/// A device that is not used, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ignored {
    /// Its node.
    pub node: String,
    /// What it calls itself, as far as that is known.
    pub name: String,
    /// Why.
    pub why: Why,
}

/// Why a device cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// This user may not read it.
    Permission,
    /// Another program has taken it for itself.
    Taken,
    /// It cannot be read.
    Broken,
}

/// All that is there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Survey {
    /// What can be read, whatever it is.
    pub found: Vec<Found>,
    /// What cannot.
    pub ignored: Vec<Ignored>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(codes: &[u64]) -> Vec<Axis> {
        let axis = |&code| Axis { code, raw_min: 0, raw_max: 255, value: None };
        codes.iter().map(axis).collect()
    }

    #[test]
    fn a_device_is_what_it_has() {
        let keyboard: Vec<u64> = (1..120).collect();
        for (codes, keys, expected) in [
            (&[0, 1, 5, 6][..], &[0x120, 0x121][..], Kind::Stick),
            (&[0, 1, 2], &[], Kind::Pedals),
            (&[0, 1, 5], &[], Kind::Pedals),
            (&[0, 1, 2, 3, 4, 5], &[304, 305], Kind::Gamepad),
            (&[0, 1, 0x20], &keyboard, Kind::Keyboard),
            (&[0x20], &[113, 114, 115], Kind::Other),
            (&[0x20], &[], Kind::Other),
            (&[0, 1], &[0x14a, 0x145, 0x110], Kind::Touchpad),
        ] {
            let kind = kind(&axes(codes), keys, false, false, false);
            assert_eq!(kind, expected, "{codes:?} {keys:?}");
        }
        assert_eq!(kind(&axes(&[0, 1, 2]), &[], false, true, false), Kind::Motion);
        assert_eq!(kind(&[], &[0x110], true, false, true), Kind::Touchpad);
        assert_eq!(kind(&[], &[0x110], false, false, true), Kind::Mouse);
    }
}
