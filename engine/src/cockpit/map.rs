//! The cockpit map: which axis and button of which device moves what.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::codes::{self, Code, Codes};
use super::lists::{AxisControl, ButtonControl};

/// What an axis does when its device is unplugged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WhenUnplugged {
    /// Stays where it was.
    #[default]
    Hold,
    /// Goes to its neutral position.
    Centre,
}

/// How much of a control's travel an axis has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// All of it.
    #[default]
    Both,
    /// From the middle up; another axis has the rest: the right of two triggers that are pedals.
    Upper,
    /// From the middle down: the left one.
    Lower,
}

/// One axis of a device. A key may stand for one: it is at its end while it is held.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisBinding {
    /// Which: `"ABS_Y"`, or the kernel's number; of several the first that the device has.
    #[serde(deserialize_with = "codes::axis::deserialize")]
    pub code: Codes,
    /// What it moves.
    pub control: AxisControl,
    /// Raw value at one end of travel; with `raw_max`, from the device itself where it tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw_min: Option<i64>,
    /// Raw value at the other end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw_max: Option<i64>,
    /// Raw value in the middle, where that is not half way between the ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw_centre: Option<i64>,
    /// Whether the raw value falls as the control rises.
    #[serde(default)]
    pub inverted: bool,
    /// Dead zone either side of the middle, as a part of the half travel.
    #[serde(default)]
    pub dead_norm: f64,
    /// Softness around the middle: 0 straight, 1 cubic.
    #[serde(default)]
    pub expo_norm: f64,
    /// How far the control goes at the end of the axis, as a part of its travel.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub reach_norm: f64,
    /// How much of the control's travel it has.
    #[serde(default, skip_serializing_if = "is_default")]
    pub side: Side,
    /// When not 0: the axis does not say where the control is, but how fast it moves; this is the speed
    /// at its end, as a part of the control's range a second. For a stick that springs back to be a lever.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rate_norm_per_s: f64,
    /// Left out when another device moves the control: a twist grip beside pedals.
    #[serde(default, skip_serializing_if = "is_default")]
    pub fallback: bool,
    /// When the device is unplugged.
    #[serde(default)]
    pub when_unplugged: WhenUnplugged,
}

impl AxisBinding {
    /// Whether where the hardware stands is remembered all the time: its control is not there.
    pub(super) fn is_remembered(&self) -> bool {
        self.side != Side::Both || self.rate_norm_per_s != 0.0
    }
}

/// How a button works what does not act once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// On while the button is pressed.
    Hold,
    /// Each press turns it over.
    Latch,
}

/// One button of a device. An axis may stand for one: it is pressed beyond a position.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ButtonBinding {
    /// Which: `"BTN_TRIGGER"`, or the kernel's number; of several the first that the device has.
    #[serde(deserialize_with = "codes::button::deserialize")]
    pub code: Codes,
    /// What it does.
    pub control: ButtonControl,
    /// How.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<Mode>,
    /// Whether it is on while the button is not pressed.
    #[serde(default, skip_serializing_if = "is_default")]
    pub inverted: bool,
    /// Of an axis: where it begins to be pressed, −1 … 1; below it where this is negative, above it where
    /// it is positive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond_norm: Option<f64>,
    /// Of a trim switch: how fast it trims, as a part of the half travel a second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_norm_per_s: Option<f64>,
}

/// One device of the map; its place in the list is its number in the log.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// The device's own name, or a part of it.
    #[serde(default)]
    pub name: String,
    /// The USB numbers of vendor and product: `"044f:b10a"`; of several any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub id: Vec<String>,
    /// Where it is plugged in, to tell two of the same name apart.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub port: String,
    /// Its serial number.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub uniq: String,
    /// What kind of device it is, for maps of any of a kind: `"gamepad"`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub kind: String,
    /// Whether there is no flight without it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub required: bool,
    /// Whether its controls are picked up: they stay where the aircraft has them until the hardware comes
    /// there. Not of pilot models, scripts, and logs of before there was pick-up.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pick_up: Option<bool>,
    /// Its axes.
    #[serde(default)]
    pub axis: Vec<AxisBinding>,
    /// Its buttons.
    #[serde(default)]
    pub button: Vec<ButtonBinding>,
}

/// The cockpit map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Devices, in the order of their numbers.
    #[serde(default)]
    pub device: Vec<Device>,
}

impl Params {
    /// The device of that number in the log.
    pub fn device(&self, number: u64) -> Option<&Device> {
        usize::try_from(number).ok().and_then(|at| self.device.get(at))
    }
}

impl Device {
    /// The axes that move when this axis, or key, does.
    pub fn axes_of(&self, code: Code) -> impl Iterator<Item = &AxisBinding> {
        self.axis.iter().filter(move |axis| axis.code.has(code))
    }

    /// What this button, or axis, works as a button.
    pub fn buttons_of(&self, code: Code) -> impl Iterator<Item = &ButtonBinding> {
        self.button.iter().filter(move |button| button.code.has(code))
    }
}

fn one() -> f64 {
    1.0
}

fn is_one(number: &f64) -> bool {
    number.to_bits() == 1.0_f64.to_bits()
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
