//! The kernel's names of axes and buttons, by which maps name them.
//!
//! # Source
//! `linux/input-event-codes.h`, as far as sticks, throttles, pedals, pads and keyboards have them.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use serde::de::{self, SeqAccess, Visitor};
use serde::ser::SerializeSeq;
use serde::{Deserializer, Serialize, Serializer};

/// An axis or a button (or key) of a device: the kernel's type and code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Code {
    /// `EV_ABS`.
    Axis(u64),
    /// `EV_KEY`.
    Key(u64),
}

use Code::{Axis, Key};

/// Names and codes; of several names of a code the first is the one that is shown.
const NAMES: &[(&str, Code)] = &[
    ("ABS_X", Axis(0x00)),
    ("ABS_Y", Axis(0x01)),
    ("ABS_Z", Axis(0x02)),
    ("ABS_RX", Axis(0x03)),
    ("ABS_RY", Axis(0x04)),
    ("ABS_RZ", Axis(0x05)),
    ("ABS_THROTTLE", Axis(0x06)),
    // HID's name: the kernel makes the first slider a throttle.
    ("ABS_SLIDER", Axis(0x06)),
    ("ABS_RUDDER", Axis(0x07)),
    ("ABS_WHEEL", Axis(0x08)),
    ("ABS_GAS", Axis(0x09)),
    ("ABS_BRAKE", Axis(0x0a)),
    ("ABS_HAT0X", Axis(0x10)),
    ("ABS_HAT0Y", Axis(0x11)),
    ("ABS_HAT1X", Axis(0x12)),
    ("ABS_HAT1Y", Axis(0x13)),
    ("ABS_HAT2X", Axis(0x14)),
    ("ABS_HAT2Y", Axis(0x15)),
    ("ABS_HAT3X", Axis(0x16)),
    ("ABS_HAT3Y", Axis(0x17)),
    ("ABS_PRESSURE", Axis(0x18)),
    ("ABS_DISTANCE", Axis(0x19)),
    ("ABS_TILT_X", Axis(0x1a)),
    ("ABS_TILT_Y", Axis(0x1b)),
    ("ABS_TOOL_WIDTH", Axis(0x1c)),
    ("ABS_VOLUME", Axis(0x20)),
    ("ABS_PROFILE", Axis(0x21)),
    ("ABS_MISC", Axis(0x28)),
    ("BTN_TRIGGER", Key(0x120)),
    ("BTN_JOYSTICK", Key(0x120)),
    ("BTN_THUMB", Key(0x121)),
    ("BTN_THUMB2", Key(0x122)),
    ("BTN_TOP", Key(0x123)),
    ("BTN_TOP2", Key(0x124)),
    ("BTN_PINKIE", Key(0x125)),
    ("BTN_BASE", Key(0x126)),
    ("BTN_BASE2", Key(0x127)),
    ("BTN_BASE3", Key(0x128)),
    ("BTN_BASE4", Key(0x129)),
    ("BTN_BASE5", Key(0x12a)),
    ("BTN_BASE6", Key(0x12b)),
    ("BTN_DEAD", Key(0x12f)),
    ("BTN_SOUTH", Key(0x130)),
    ("BTN_GAMEPAD", Key(0x130)),
    ("BTN_A", Key(0x130)),
    ("BTN_EAST", Key(0x131)),
    ("BTN_B", Key(0x131)),
    ("BTN_C", Key(0x132)),
    ("BTN_NORTH", Key(0x133)),
    ("BTN_X", Key(0x133)),
    ("BTN_WEST", Key(0x134)),
    ("BTN_Y", Key(0x134)),
    ("BTN_Z", Key(0x135)),
    ("BTN_TL", Key(0x136)),
    ("BTN_TR", Key(0x137)),
    ("BTN_TL2", Key(0x138)),
    ("BTN_TR2", Key(0x139)),
    ("BTN_SELECT", Key(0x13a)),
    ("BTN_START", Key(0x13b)),
    ("BTN_MODE", Key(0x13c)),
    ("BTN_THUMBL", Key(0x13d)),
    ("BTN_THUMBR", Key(0x13e)),
    ("BTN_DPAD_UP", Key(0x220)),
    ("BTN_DPAD_DOWN", Key(0x221)),
    ("BTN_DPAD_LEFT", Key(0x222)),
    ("BTN_DPAD_RIGHT", Key(0x223)),
    ("KEY_ESC", Key(1)),
    ("KEY_MINUS", Key(12)),
    ("KEY_EQUAL", Key(13)),
    ("KEY_BACKSPACE", Key(14)),
    ("KEY_TAB", Key(15)),
    ("KEY_LEFTBRACE", Key(26)),
    ("KEY_RIGHTBRACE", Key(27)),
    ("KEY_ENTER", Key(28)),
    ("KEY_LEFTCTRL", Key(29)),
    ("KEY_SEMICOLON", Key(39)),
    ("KEY_APOSTROPHE", Key(40)),
    ("KEY_GRAVE", Key(41)),
    ("KEY_LEFTSHIFT", Key(42)),
    ("KEY_BACKSLASH", Key(43)),
    ("KEY_COMMA", Key(51)),
    ("KEY_DOT", Key(52)),
    ("KEY_SLASH", Key(53)),
    ("KEY_RIGHTSHIFT", Key(54)),
    ("KEY_KPASTERISK", Key(55)),
    ("KEY_LEFTALT", Key(56)),
    ("KEY_SPACE", Key(57)),
    ("KEY_CAPSLOCK", Key(58)),
    ("KEY_KP7", Key(71)),
    ("KEY_KP8", Key(72)),
    ("KEY_KP9", Key(73)),
    ("KEY_KPMINUS", Key(74)),
    ("KEY_KP4", Key(75)),
    ("KEY_KP5", Key(76)),
    ("KEY_KP6", Key(77)),
    ("KEY_KPPLUS", Key(78)),
    ("KEY_KP1", Key(79)),
    ("KEY_KP2", Key(80)),
    ("KEY_KP3", Key(81)),
    ("KEY_KP0", Key(82)),
    ("KEY_KPDOT", Key(83)),
    ("KEY_F11", Key(87)),
    ("KEY_F12", Key(88)),
    ("KEY_KPENTER", Key(96)),
    ("KEY_RIGHTCTRL", Key(97)),
    ("KEY_KPSLASH", Key(98)),
    ("KEY_RIGHTALT", Key(100)),
    ("KEY_HOME", Key(102)),
    ("KEY_UP", Key(103)),
    ("KEY_PAGEUP", Key(104)),
    ("KEY_LEFT", Key(105)),
    ("KEY_RIGHT", Key(106)),
    ("KEY_END", Key(107)),
    ("KEY_DOWN", Key(108)),
    ("KEY_PAGEDOWN", Key(109)),
    ("KEY_INSERT", Key(110)),
    ("KEY_DELETE", Key(111)),
];

/// Names that differ by what they end with, in the order of their codes: `KEY_Q`, `KEY_W`…
const ROWS: &[(&str, &str, u64)] = &[
    ("KEY_", "1 2 3 4 5 6 7 8 9 0", 2),
    ("KEY_", "Q W E R T Y U I O P", 16),
    ("KEY_", "A S D F G H J K L", 30),
    ("KEY_", "Z X C V B N M", 44),
    ("KEY_", "F1 F2 F3 F4 F5 F6 F7 F8 F9 F10", 59),
    ("BTN_", "0 1 2 3 4 5 6 7 8 9", 0x100),
    (
        "BTN_TRIGGER_HAPPY",
        "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 \
         34 35 36 37 38 39 40",
        0x2c0,
    ),
];

/// A code of a number.
type OfNumber = fn(u64) -> Code;

/// What stands before the number of a code without a name.
const NUMBERED: [(&str, OfNumber); 3] = [("ABS_0x", Axis), ("BTN_0x", Key), ("KEY_0x", Key)];

impl Code {
    /// The one of this name, in any case: `ABS_X`, `btn_trigger`, or numbered, `BTN_0x12c`.
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.trim();
        if let Some((_, code)) = NAMES.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)) {
            return Some(*code);
        }
        for (start, ends, first) in ROWS {
            let Some(end) = without_start(name, start) else { continue };
            let at = ends.split(' ').position(|known| known.eq_ignore_ascii_case(end));
            if let Some(at) = at {
                return Some(Key(first + at as u64));
            }
        }
        let (number, make) =
            NUMBERED.iter().find_map(|(start, make)| Some((without_start(name, start)?, make)))?;
        u64::from_str_radix(number, 16).ok().filter(|&number| number <= 0xffff).map(make)
    }

    /// The kernel's name, or the number behind what would begin it.
    pub fn name(self) -> String {
        if let Some((name, _)) = NAMES.iter().find(|(_, code)| *code == self) {
            return (*name).into();
        }
        let number = match self {
            Axis(number) => return format!("ABS_{number:#04x}"),
            Key(number) => number,
        };
        for (start, ends, first) in ROWS {
            let at = number.checked_sub(*first).and_then(|at| usize::try_from(at).ok());
            if let Some(end) = at.and_then(|at| ends.split(' ').nth(at)) {
                return format!("{start}{end}");
            }
        }
        if number < 0x100 { format!("KEY_{number:#x}") } else { format!("BTN_{number:#x}") }
    }

    /// The kernel's number.
    pub fn number(self) -> u64 {
        match self {
            Axis(number) | Key(number) => number,
        }
    }
}

fn without_start<'a>(name: &'a str, start: &str) -> Option<&'a str> {
    let (head, rest) = name.split_at_checked(start.len())?;
    head.eq_ignore_ascii_case(start).then_some(rest)
}

/// The axis or button of a binding; several are alternatives, of which the first counts that the device
/// has. In a map as flown there is one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Codes(Vec<Code>);

impl Codes {
    /// One and no other.
    pub fn one(code: Code) -> Self {
        Self(alloc::vec![code])
    }

    /// All of them, the best first.
    pub fn all(&self) -> &[Code] {
        &self.0
    }

    /// Whether it is one of them.
    pub fn has(&self, code: Code) -> bool {
        self.0.contains(&code)
    }

    /// The kernel's number of the first; 0 where there is none.
    pub fn number(&self) -> u64 {
        self.0.first().map_or(0, |code| code.number())
    }
}

impl fmt::Display for Codes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, code) in self.0.iter().enumerate() {
            write!(f, "{}{}", if at == 0 { "" } else { " or " }, code.name())?;
        }
        Ok(())
    }
}

impl Serialize for Codes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.as_slice() {
            [one] => serializer.serialize_str(&one.name()),
            several => {
                let mut names = serializer.serialize_seq(Some(several.len()))?;
                for code in several {
                    names.serialize_element(&code.name())?;
                }
                names.end()
            }
        }
    }
}

/// What a bare number stands for.
pub(super) mod axis {
    use super::{Code, Codes, Deserializer, read};

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Codes, D::Error> {
        read(deserializer, Code::Axis)
    }
}

/// The same in a table of buttons.
pub(super) mod button {
    use super::{Code, Codes, Deserializer, read};

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Codes, D::Error> {
        read(deserializer, Code::Key)
    }
}

fn read<'de, D: Deserializer<'de>>(
    deserializer: D,
    number: fn(u64) -> Code,
) -> Result<Codes, D::Error> {
    deserializer.deserialize_any(CodesVisitor { number })
}

struct CodesVisitor {
    number: fn(u64) -> Code,
}

impl CodesVisitor {
    fn one<E: de::Error>(&self, number: Option<u64>) -> Result<Codes, E> {
        let code = number.filter(|&number| number <= 0xffff).map(self.number);
        code.map(Codes::one).ok_or_else(|| E::custom("an event code is from 0 to 0xffff"))
    }
}

impl<'de> Visitor<'de> for CodesVisitor {
    type Value = Codes;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an event code, by the kernel's name or its number, or an array of them")
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Codes, E> {
        self.one(u64::try_from(number).ok())
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<Codes, E> {
        self.one(Some(number))
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<Codes, E> {
        Code::from_name(name).map(Codes::one).ok_or_else(|| {
            E::custom(format!(
                "`{name}` is no axis and no button that is known: write it as `tiltrotor devices` \
                 shows it, ABS_X or BTN_TRIGGER, or numbered, ABS_0x2a or BTN_0x12c"
            ))
        })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut several: A) -> Result<Codes, A::Error> {
        struct One(fn(u64) -> Code);
        impl<'de> de::DeserializeSeed<'de> for One {
            type Value = Codes;

            fn deserialize<D: Deserializer<'de>>(self, one: D) -> Result<Codes, D::Error> {
                read(one, self.0)
            }
        }
        let mut codes = Vec::new();
        while let Some(one) = several.next_element_seed(One(self.number))? {
            codes.extend_from_slice(one.all());
        }
        if codes.is_empty() {
            return Err(de::Error::custom("an array of event codes names at least one"));
        }
        Ok(Codes(codes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_found_again_in_any_case() {
        for (name, code) in NAMES {
            assert_eq!(Code::from_name(name), Some(*code));
            assert_eq!(Code::from_name(&name.to_lowercase()), Some(*code));
            assert_eq!(Code::from_name(&code.name()), Some(*code), "{name}");
        }
    }

    #[test]
    fn every_code_has_a_name_of_its_own() {
        for number in 0..0x300 {
            for code in [Axis(number), Key(number)] {
                assert_eq!(Code::from_name(&code.name()), Some(code), "{code:?}");
            }
        }
        for (code, name) in [
            (Key(0x2c0), "BTN_TRIGGER_HAPPY1"),
            (Key(0x2e7), "BTN_TRIGGER_HAPPY40"),
            (Key(0x12c), "BTN_0x12c"),
            (Key(16), "KEY_Q"),
            (Key(68), "KEY_F10"),
            (Axis(0x29), "ABS_0x29"),
        ] {
            assert_eq!(code.name(), name);
        }
    }

    #[test]
    fn what_is_no_code_is_none() {
        for name in ["", "ABS_", "ABS_FOO", "BTN_0x10000", "BTN_0xz", "0x120", "ä"] {
            assert_eq!(Code::from_name(name), None, "{name}");
        }
    }
}
