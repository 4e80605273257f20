//! Cockpit: raw device events to pilot controls.
//!
//! The map says which axis or button of which device moves what. Calibration, dead zone, curve and
//! the meaning of every button are here, inside the step, so that the log needs to hold nothing but
//! what the hardware said.
//!
//! # Signs
//! Stick aft, stick right, right pedal, collective up, nacelles towards the helicopter are positive.

use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

pub use crate::controls::{FLAP_DETENT_LAST, PilotControls as State, RPM_SELECT_LAST};
use crate::enumeration;
use crate::inputs::{DeviceEvent, EventKind};
use crate::math::{clamp, sign};

/// How far a control goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Travel {
    /// Either way from its middle, −1..1.
    Centred,
    /// From one end to the other, 0..1.
    FromEnd,
}

impl Travel {
    /// The position at the lower end; the other is always at 1.
    pub const fn low_norm(self) -> f64 {
        match self {
            Self::Centred => -1.0,
            Self::FromEnd => 0.0,
        }
    }
}

/// What is told of an [`AxisControl`].
#[derive(Clone, Copy, Debug)]
pub struct AxisFacts {
    /// Its name in maps and scripts; never changed.
    pub key: &'static str,
    /// Its name in words.
    pub words: &'static str,
    /// What it is, and which way is positive.
    pub description: &'static str,
    /// How far it goes.
    pub travel: Travel,
    /// Whether it is a switch that springs back when nobody holds it, be it a hat or buttons.
    pub springs_back: bool,
    /// Puts it at a position.
    pub set: fn(&mut State, f64),
}

enumeration! {
    /// What a device's axis can move.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum AxisControl tells AxisFacts {
        /// Longitudinal stick, aft positive.
        StickAft {
            key: "stick_aft", words: "stick aft", travel: Travel::Centred, springs_back: false,
            set: |controls, at_norm| controls.stick_aft_norm = at_norm,
        }
        /// Lateral stick, right positive.
        StickRight {
            key: "stick_right", words: "stick right", travel: Travel::Centred, springs_back: false,
            set: |controls, at_norm| controls.stick_right_norm = at_norm,
        }
        /// Power lever, up positive.
        Collective {
            key: "collective", words: "collective", travel: Travel::FromEnd, springs_back: false,
            set: |controls, at_norm| controls.collective_norm = at_norm,
        }
        /// Pedals, right positive.
        PedalRight {
            key: "pedal_right", words: "pedal right", travel: Travel::Centred, springs_back: false,
            set: |controls, at_norm| controls.pedal_right_norm = at_norm,
        }
        /// Left toe brake.
        BrakeLeft {
            key: "brake_left", words: "brake left", travel: Travel::FromEnd, springs_back: false,
            set: |controls, at_norm| controls.brake_norm.left = at_norm,
        }
        /// Right toe brake.
        BrakeRight {
            key: "brake_right", words: "brake right", travel: Travel::FromEnd, springs_back: false,
            set: |controls, at_norm| controls.brake_norm.right = at_norm,
        }
        /// Nacelle switch as an axis (a hat): over a half is aft, below minus a half forward.
        NacelleAft {
            key: "nacelle_aft", words: "nacelle aft", travel: Travel::Centred, springs_back: true,
            set: |controls, at_norm| {
                controls.nacelle_aft_norm = if at_norm.abs() > 0.5 { sign(at_norm) } else { 0.0 };
            },
        }
    }
}

/// What is told of a [`ButtonControl`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ButtonFacts {
    /// Its name in maps and scripts; never changed.
    pub key: &'static str,
    /// Its name in words.
    pub words: &'static str,
    /// What it does.
    pub description: &'static str,
}

enumeration! {
    /// What a device's button can do.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum ButtonControl tells ButtonFacts {
        /// Nacelles towards the aeroplane while held.
        NacelleForward { key: "nacelle_forward", words: "nacelle forward" }
        /// Nacelles towards the helicopter while held.
        NacelleAft { key: "nacelle_aft", words: "nacelle aft" }
        /// Flap lever one detent down.
        FlapDown { key: "flap_down", words: "flap down" }
        /// Flap lever one detent up.
        FlapUp { key: "flap_up", words: "flap up" }
        /// Gear handle to its other position.
        GearToggle { key: "gear_toggle", words: "gear toggle" }
        /// Parking brake to its other position.
        ParkingBrakeToggle { key: "parking_brake_toggle", words: "parking brake toggle" }
        /// SCAS, all axes, on or off.
        ScasToggle { key: "scas_toggle", words: "scas toggle" }
        /// Next rotor speed: helicopter, aeroplane early flights, aeroplane design.
        RpmSelect { key: "rpm_select", words: "rpm select" }
        /// Marks the moment in the log.
        Marker { key: "marker", words: "marker" }
    }
}

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

/// One axis of a device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisBinding {
    /// The kernel's event code.
    pub code: u64,
    /// What it moves.
    pub control: AxisControl,
    /// Raw value at one end of travel; with `raw_max`, from the device itself where it tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw_min: Option<i64>,
    /// Raw value at the other end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw_max: Option<i64>,
    /// Whether the raw value falls as the control rises.
    #[serde(default)]
    pub inverted: bool,
    /// Dead zone either side of the middle, as a part of the half travel.
    #[serde(default)]
    pub dead_norm: f64,
    /// Softness around the middle: 0 straight, 1 cubic.
    #[serde(default)]
    pub expo_norm: f64,
    /// When the device is unplugged.
    #[serde(default)]
    pub when_unplugged: WhenUnplugged,
}

/// One button of a device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ButtonBinding {
    /// The kernel's event code.
    pub code: u64,
    /// What it does.
    pub control: ButtonControl,
}

/// One device of the map; its place in the list is its number in the log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// The device's own name, or a part of it.
    pub name: String,
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

/// Applies the events in their order. Events of unknown devices, codes or kinds change nothing.
pub fn update(map: &Params, state: &State, events: &[DeviceEvent]) -> State {
    let mut controls = *state;
    for event in events {
        let Some(device) = usize::try_from(event.device).ok().and_then(|i| map.device.get(i))
        else {
            continue;
        };
        match EventKind::from_u64(event.kind) {
            Some(EventKind::Axis) => {
                for binding in device.axis.iter().filter(|axis| axis.code == event.code) {
                    (binding.control.facts().set)(&mut controls, position(binding, event));
                }
            }
            Some(EventKind::Button) => {
                for binding in device.button.iter().filter(|button| button.code == event.code) {
                    set_button(&mut controls, binding.control, event.value != 0);
                }
            }
            Some(EventKind::Disconnected) => {
                // Nobody holds the switches of a device that is gone.
                for binding in &device.axis {
                    let AxisFacts { springs_back, set, .. } = binding.control.facts();
                    if *springs_back || binding.when_unplugged == WhenUnplugged::Centre {
                        set(&mut controls, 0.0);
                    }
                }
                for binding in &device.button {
                    set_button(&mut controls, binding.control, false);
                }
            }
            // Recorded for whoever reads the log.
            Some(
                EventKind::Connected
                | EventKind::Dropped
                | EventKind::AxisPosition
                | EventKind::ButtonPosition,
            )
            | None => {}
        }
    }
    controls
}

/// The raw value as a control position: −1..1, or 0..1 for those that start at an end.
///
/// The ends of travel are those of the map, then those that the device tells, then ±32767.
fn position(binding: &AxisBinding, event: &DeviceEvent) -> f64 {
    let (raw, told) = (event.value, event.raw_min < event.raw_max);
    let low = binding.raw_min.unwrap_or(if told { event.raw_min } else { -32767 });
    let high = binding.raw_max.unwrap_or(if told { event.raw_max } else { 32767 });
    if low == high {
        return 0.0;
    }
    // As floating-point numbers, because the difference of two of any size may not be an i64.
    let (raw, low, high) = (raw as f64, low as f64, high as f64);
    if binding.control.facts().travel == Travel::FromEnd {
        let travel = clamp((raw - low) / (high - low), 0.0, 1.0);
        return if binding.inverted { 1.0 - travel } else { travel };
    }
    // Both distances before they are divided: then the mirrored raw value is the mirrored position.
    let x = clamp(((raw - low) - (high - raw)) / (high - low), -1.0, 1.0);
    let x = if binding.inverted { -x } else { x };
    let dead = clamp(binding.dead_norm, 0.0, 0.99);
    let beyond = (x.abs() - dead) / (1.0 - dead);
    if beyond <= 0.0 {
        return 0.0;
    }
    let expo = clamp(binding.expo_norm, 0.0, 1.0);
    sign(x) * ((1.0 - expo) * beyond + expo * beyond * beyond * beyond)
}

fn set_button(controls: &mut State, control: ButtonControl, pressed: bool) {
    match control {
        ButtonControl::NacelleForward => hold_nacelles(controls, -1.0, pressed),
        ButtonControl::NacelleAft => hold_nacelles(controls, 1.0, pressed),
        _ if !pressed => {}
        ButtonControl::FlapDown => {
            controls.flap_detent = controls.flap_detent.wrapping_add(1).min(FLAP_DETENT_LAST);
        }
        ButtonControl::FlapUp => controls.flap_detent = controls.flap_detent.saturating_sub(1),
        ButtonControl::GearToggle => controls.gear_down ^= 1,
        ButtonControl::ParkingBrakeToggle => controls.parking_brake ^= 1,
        ButtonControl::ScasToggle => controls.scas_on ^= 1,
        ButtonControl::RpmSelect => {
            controls.rpm_select = controls.rpm_select.wrapping_add(1) % (RPM_SELECT_LAST + 1);
        }
        ButtonControl::Marker => controls.markers = controls.markers.wrapping_add(1),
    }
}

/// A button that is released frees the switch only if it held it.
fn hold_nacelles(controls: &mut State, aft_norm: f64, pressed: bool) {
    if pressed {
        controls.nacelle_aft_norm = aft_norm;
    } else if controls.nacelle_aft_norm * aft_norm > 0.0 {
        controls.nacelle_aft_norm = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    fn axis(control: AxisControl) -> AxisBinding {
        AxisBinding {
            code: 1,
            control,
            raw_min: Some(0),
            raw_max: Some(200),
            inverted: false,
            dead_norm: 0.1,
            expo_norm: 0.0,
            when_unplugged: WhenUnplugged::Centre,
        }
    }

    fn stick(button: ButtonControl) -> Params {
        Params {
            device: vec![Device {
                name: "stick".into(),
                axis: vec![axis(AxisControl::StickAft)],
                button: vec![ButtonBinding { code: 2, control: button }],
            }],
        }
    }

    fn at(binding: &AxisBinding, value: i64) -> f64 {
        position(binding, &DeviceEvent { value, ..DeviceEvent::default() })
    }

    fn event(kind: EventKind, code: u64, value: i64) -> DeviceEvent {
        DeviceEvent { kind: kind as u64, code, value, ..DeviceEvent::default() }
    }

    #[test]
    fn an_axis_reaches_its_ends_and_rests_in_its_dead_zone() {
        let binding = axis(AxisControl::StickAft);
        for (raw, norm) in [(-5, -1.0), (0, -1.0), (95, 0.0), (100, 0.0), (109, 0.0), (200, 1.0)] {
            assert!((at(&binding, raw) - norm).abs() < 1e-15, "{raw}");
        }
        let left = at(&binding, 30);
        let right = at(&binding, 170);
        assert_eq!(left.to_bits(), (-right).to_bits());
    }

    #[test]
    fn mirrored_raw_values_are_mirrored_positions_to_the_bit() {
        let binding = AxisBinding {
            raw_min: Some(-32767),
            raw_max: Some(32767),
            expo_norm: 0.3,
            ..axis(AxisControl::StickRight)
        };
        for raw in 0..=32767 {
            let (left, right) = (at(&binding, -raw), at(&binding, raw));
            assert_eq!((left + right).to_bits(), 0, "{raw}");
        }
    }

    #[test]
    fn a_device_that_tells_its_range_has_its_full_travel_unless_the_map_says_otherwise() {
        let mapped = axis(AxisControl::StickAft);
        let plain = AxisBinding { raw_min: None, raw_max: None, dead_norm: 0.0, ..mapped.clone() };
        let told = |binding: &AxisBinding, value: i64| {
            position(binding, &DeviceEvent { value, raw_max: 1023, ..DeviceEvent::default() })
        };
        for (low, high) in [
            (told(&plain, 0), told(&plain, 1023)),
            (told(&mapped, 0), told(&mapped, 200)),
            (at(&plain, -32767), at(&plain, 32767)),
        ] {
            assert_eq!((low + 1.0).to_bits(), 0, "{low}");
            assert_eq!((high - 1.0).to_bits(), 0, "{high}");
        }
    }

    #[test]
    fn what_is_only_found_out_moves_nothing() {
        let map = stick(ButtonControl::GearToggle);
        let found = [
            event(EventKind::AxisPosition, 1, 200),
            event(EventKind::ButtonPosition, 2, 1),
            event(EventKind::Dropped, 0, 3),
        ];
        assert_eq!(update(&map, &State::default(), &found), State::default());
    }

    #[test]
    fn no_raw_value_is_too_large() {
        let mut binding = axis(AxisControl::StickAft);
        (binding.raw_min, binding.raw_max) = (Some(i64::MIN), Some(i64::MAX));
        assert_eq!(at(&binding, i64::MIN).to_bits(), f64::to_bits(-1.0));
        assert_eq!(at(&binding, i64::MAX).to_bits(), f64::to_bits(1.0));
    }

    #[test]
    fn an_unplugged_hat_lets_go_of_the_nacelles_even_where_axes_hold() {
        let hat =
            AxisBinding { when_unplugged: WhenUnplugged::Hold, ..axis(AxisControl::NacelleAft) };
        let device = Device { name: "hat".into(), axis: vec![hat], button: vec![] };
        let map = Params { device: vec![device] };
        let held = update(&map, &State::default(), &[event(EventKind::Axis, 1, 200)]);
        assert_eq!(held.nacelle_aft_norm.to_bits(), f64::to_bits(1.0));
        let gone = update(&map, &held, &[event(EventKind::Disconnected, 0, 0)]);
        assert_eq!(gone.nacelle_aft_norm.to_bits(), 0);
    }

    #[test]
    fn a_lever_starts_at_its_end() {
        assert!((at(&axis(AxisControl::Collective), 50) - 0.25).abs() < 1e-15);
    }

    #[test]
    fn an_unplugged_stick_goes_where_the_map_says() {
        let map = stick(ButtonControl::NacelleForward);
        let held = update(
            &map,
            &State::default(),
            &[event(EventKind::Axis, 1, 200), event(EventKind::Button, 2, 1)],
        );
        assert_eq!((held.stick_aft_norm, held.nacelle_aft_norm), (1.0, -1.0));
        let gone = update(&map, &held, &[event(EventKind::Disconnected, 0, 0)]);
        assert_eq!((gone.stick_aft_norm, gone.nacelle_aft_norm), (0.0, 0.0));
    }

    #[test]
    fn a_button_acts_when_pressed_not_when_released() {
        let map = stick(ButtonControl::Marker);
        let press = event(EventKind::Button, 2, 1);
        let release = event(EventKind::Button, 2, 0);
        let state = update(&map, &State::default(), &[press, release, press, release]);
        assert_eq!(state.markers, 2);
    }

    #[test]
    fn nonsense_changes_nothing() {
        let map = stick(ButtonControl::Marker);
        let mut wrong = event(EventKind::Axis, 1, 3);
        wrong.device = u64::MAX;
        let mut kind = event(EventKind::Axis, 1, 3);
        kind.kind = 99;
        assert_eq!(update(&map, &State::default(), &[wrong, kind]), State::default());
    }

    /// The key is what maps are written with.
    #[test]
    fn a_key_of_the_list_is_the_name_in_a_map() {
        use serde::de::value::{Error, StrDeserializer};
        for &control in AxisControl::ALL {
            let name = StrDeserializer::<Error>::new(control.facts().key);
            assert_eq!(AxisControl::deserialize(name), Ok(control));
        }
        for &control in ButtonControl::ALL {
            let name = StrDeserializer::<Error>::new(control.facts().key);
            assert_eq!(ButtonControl::deserialize(name), Ok(control));
        }
    }

    #[test]
    fn an_axis_goes_as_far_as_its_list_says() {
        for &control in AxisControl::ALL {
            let binding = AxisBinding { dead_norm: 0.0, ..axis(control) };
            let low_norm = control.facts().travel.low_norm();
            let ends = [(0, low_norm), (200, 1.0), (-50, low_norm), (999, 1.0)];
            for (raw, at_norm) in ends {
                assert!((at(&binding, raw) - at_norm).abs() < 1e-15, "{control:?} at {raw}");
            }
        }
    }

    #[test]
    fn no_two_axes_move_the_same() {
        let moved: Vec<State> = AxisControl::ALL
            .iter()
            .map(|control| {
                let mut controls = State::default();
                (control.facts().set)(&mut controls, 1.0);
                controls
            })
            .collect();
        for (i, one) in moved.iter().enumerate() {
            assert_ne!(*one, State::default(), "{:?} moves nothing", AxisControl::ALL[i]);
            assert!(!moved[..i].contains(one), "{:?} moves what another does", AxisControl::ALL[i]);
        }
    }
}
