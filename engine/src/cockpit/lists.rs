//! What devices can move: the list of axes and the list of buttons.

use serde::{Deserialize, Serialize};

use crate::controls::{AxisPositions, FLAP_DETENT_LAST, ForceTrim, PilotControls, RPM_SELECT_LAST};
use crate::enumeration;
use crate::math::sign;
use crate::pair::Pair;

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
    /// Where it is.
    pub get: fn(&PilotControls) -> f64,
    /// Puts it at a position.
    pub set: fn(&mut PilotControls, f64),
    /// Where the hardware's position is remembered, of those that have such a place.
    pub hardware: Option<fn(&mut AxisPositions) -> &mut f64>,
    /// Where the position is remembered in which it is at rest, of those that can be trimmed.
    pub trim: Option<fn(&mut ForceTrim) -> &mut f64>,
}

enumeration! {
    /// What a device's axis can move.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum AxisControl tells AxisFacts {
        /// Longitudinal stick, aft positive.
        StickAft {
            key: "stick_aft", words: "stick aft", travel: Travel::Centred, springs_back: false,
            get: |controls| controls.stick_aft_norm,
            set: |controls, at_norm| controls.stick_aft_norm = at_norm,
            hardware: Some(|hardware| &mut hardware.stick_aft_norm),
            trim: Some(|trim| &mut trim.stick_aft_norm),
        }
        /// Lateral stick, right positive.
        StickRight {
            key: "stick_right", words: "stick right", travel: Travel::Centred, springs_back: false,
            get: |controls| controls.stick_right_norm,
            set: |controls, at_norm| controls.stick_right_norm = at_norm,
            hardware: Some(|hardware| &mut hardware.stick_right_norm),
            trim: Some(|trim| &mut trim.stick_right_norm),
        }
        /// Power lever, up positive.
        Collective {
            key: "collective", words: "collective", travel: Travel::FromEnd, springs_back: false,
            get: |controls| controls.collective_norm,
            set: |controls, at_norm| controls.collective_norm = at_norm,
            hardware: Some(|hardware| &mut hardware.collective_norm),
            trim: None,
        }
        /// Pedals, right positive.
        PedalRight {
            key: "pedal_right", words: "pedal right", travel: Travel::Centred, springs_back: false,
            get: |controls| controls.pedal_right_norm,
            set: |controls, at_norm| controls.pedal_right_norm = at_norm,
            hardware: Some(|hardware| &mut hardware.pedal_right_norm),
            trim: Some(|trim| &mut trim.pedal_right_norm),
        }
        /// Left toe brake.
        BrakeLeft {
            key: "brake_left", words: "brake left", travel: Travel::FromEnd, springs_back: false,
            get: |controls| controls.brake_norm.left,
            set: |controls, at_norm| controls.brake_norm.left = at_norm,
            hardware: Some(|hardware| &mut hardware.brake_norm.left),
            trim: None,
        }
        /// Right toe brake.
        BrakeRight {
            key: "brake_right", words: "brake right", travel: Travel::FromEnd, springs_back: false,
            get: |controls| controls.brake_norm.right,
            set: |controls, at_norm| controls.brake_norm.right = at_norm,
            hardware: Some(|hardware| &mut hardware.brake_norm.right),
            trim: None,
        }
        /// Nacelle switch as an axis (a hat): over a half is aft, below minus a half forward.
        NacelleAft {
            key: "nacelle_aft", words: "nacelle aft", travel: Travel::Centred, springs_back: true,
            get: |controls| controls.nacelle_aft_norm,
            set: |controls, at_norm| {
                controls.nacelle_aft_norm = if at_norm.abs() > 0.5 { sign(at_norm) } else { 0.0 };
            },
            hardware: None,
            trim: None,
        }
        /// Flap lever as an axis, at the nearest of its four detents: 0 up, 1 full flap.
        FlapLever {
            key: "flap_lever", words: "flap lever", travel: Travel::FromEnd, springs_back: false,
            get: |controls| controls.flap_detent as f64 / FLAP_DETENT_LAST as f64,
            set: |controls, at_norm| {
                controls.flap_detent = (at_norm * FLAP_DETENT_LAST as f64 + 0.5) as u64;
            },
            hardware: None,
            trim: None,
        }
    }
}

/// When a button acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// Once, when it is pressed.
    Once,
    /// While it is held; a device that is gone holds nothing.
    WhileHeld,
    /// As a switch that stays stands; it stays so when its device is gone.
    AsItStands,
}

/// What is told of a [`ButtonControl`].
#[derive(Clone, Copy, Debug)]
pub struct ButtonFacts {
    /// Its name in maps and scripts; never changed.
    pub key: &'static str,
    /// Its name in words.
    pub words: &'static str,
    /// What it does.
    pub description: &'static str,
    /// When.
    pub acts: Acts,
    /// Whether it is on, of those that do not act once.
    pub is_on: fn(&PilotControls) -> bool,
    /// Turns it on or off; what acts once is only turned on.
    pub set: fn(&mut PilotControls, bool),
}

/// Never on: it acts once.
const NEVER: fn(&PilotControls) -> bool = |_| false;

/// Holds a trim switch, or lets it go, by its place in what is remembered.
macro_rules! trims {
    ($bit:literal) => {
        |controls, on| controls.force_trim.hold($bit, on)
    };
}

enumeration! {
    /// What a device's button can do.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum ButtonControl tells ButtonFacts {
        /// Nacelles towards the aeroplane while held.
        NacelleForward {
            key: "nacelle_forward", words: "nacelle forward", acts: Acts::WhileHeld,
            is_on: |controls| controls.nacelle_aft_norm < 0.0,
            set: |controls, on| hold_nacelles(controls, -1.0, on),
        }
        /// Nacelles towards the helicopter while held.
        NacelleAft {
            key: "nacelle_aft", words: "nacelle aft", acts: Acts::WhileHeld,
            is_on: |controls| controls.nacelle_aft_norm > 0.0,
            set: |controls, on| hold_nacelles(controls, 1.0, on),
        }
        /// Flap lever one detent down.
        FlapDown {
            key: "flap_down", words: "flap down", acts: Acts::Once, is_on: NEVER,
            set: |controls, _| {
                controls.flap_detent = controls.flap_detent.wrapping_add(1).min(FLAP_DETENT_LAST);
            },
        }
        /// Flap lever one detent up.
        FlapUp {
            key: "flap_up", words: "flap up", acts: Acts::Once, is_on: NEVER,
            set: |controls, _| controls.flap_detent = controls.flap_detent.saturating_sub(1),
        }
        /// Gear handle to its other position.
        GearToggle {
            key: "gear_toggle", words: "gear toggle", acts: Acts::Once, is_on: NEVER,
            set: |controls, _| controls.gear_down ^= 1,
        }
        /// Parking brake to its other position.
        ParkingBrakeToggle {
            key: "parking_brake_toggle", words: "parking brake toggle", acts: Acts::Once,
            is_on: NEVER,
            set: |controls, _| controls.parking_brake ^= 1,
        }
        /// SCAS, all axes, on or off.
        ScasToggle {
            key: "scas_toggle", words: "scas toggle", acts: Acts::Once, is_on: NEVER,
            set: |controls, _| controls.scas_on ^= 1,
        }
        /// Next rotor speed: helicopter, aeroplane early flights, aeroplane design.
        RpmSelect {
            key: "rpm_select", words: "rpm select", acts: Acts::Once, is_on: NEVER,
            set: |controls, _| {
                controls.rpm_select = controls.rpm_select.wrapping_add(1) % (RPM_SELECT_LAST + 1);
            },
        }
        /// Marks the moment in the log.
        Marker {
            key: "marker", words: "marker", acts: Acts::Once, is_on: NEVER,
            set: |controls, _| controls.markers = controls.markers.wrapping_add(1),
        }
        /// Gear handle as the switch stands: down while it is on.
        GearDown {
            key: "gear_down", words: "gear down", acts: Acts::AsItStands,
            is_on: |controls| controls.gear_down != 0,
            set: |controls, on| controls.gear_down = u64::from(on),
        }
        /// Parking brake as the switch stands: set while it is on.
        ParkingBrake {
            key: "parking_brake", words: "parking brake", acts: Acts::AsItStands,
            is_on: |controls| controls.parking_brake != 0,
            set: |controls, on| controls.parking_brake = u64::from(on),
        }
        /// SCAS, all axes, as the switch stands.
        Scas {
            key: "scas", words: "scas", acts: Acts::AsItStands,
            is_on: |controls| controls.scas_on != 0,
            set: |controls, on| controls.scas_on = u64::from(on),
        }
        /// Both wheel brakes, fully, while held.
        WheelBrakes {
            key: "wheel_brakes", words: "wheel brakes", acts: Acts::WhileHeld,
            is_on: |controls| controls.brake_norm.left > 0.0 || controls.brake_norm.right > 0.0,
            set: |controls, on| controls.brake_norm = Pair::both(if on { 1.0 } else { 0.0 }),
        }
        /// Force trim released while held: where the stick and pedals are when it is let go, they stay, and
        /// the hardware takes them over again from its middle.
        ForceTrimRelease {
            key: "force_trim_release", words: "force trim release", acts: Acts::WhileHeld,
            is_on: |controls| controls.force_trim.is_released(),
            set: |controls, on| controls.force_trim.release(on),
        }
        /// Trims the stick aft while held.
        TrimAft {
            key: "trim_aft", words: "trim aft", acts: Acts::WhileHeld,
            is_on: |controls| controls.force_trim.holds(0), set: trims!(0),
        }
        /// Trims the stick forward while held.
        TrimForward {
            key: "trim_forward", words: "trim forward", acts: Acts::WhileHeld,
            is_on: |controls| controls.force_trim.holds(1), set: trims!(1),
        }
        /// Trims the stick right while held.
        TrimRight {
            key: "trim_right", words: "trim right", acts: Acts::WhileHeld,
            is_on: |controls| controls.force_trim.holds(2), set: trims!(2),
        }
        /// Trims the stick left while held.
        TrimLeft {
            key: "trim_left", words: "trim left", acts: Acts::WhileHeld,
            is_on: |controls| controls.force_trim.holds(3), set: trims!(3),
        }
        /// Trims the pedals right while held.
        TrimPedalRight {
            key: "trim_pedal_right", words: "trim pedal right", acts: Acts::WhileHeld,
            is_on: |controls| controls.force_trim.holds(4), set: trims!(4),
        }
        /// Trims the pedals left while held.
        TrimPedalLeft {
            key: "trim_pedal_left", words: "trim pedal left", acts: Acts::WhileHeld,
            is_on: |controls| controls.force_trim.holds(5), set: trims!(5),
        }
    }
}

impl ButtonControl {
    /// What a trim switch trims, and which way; nothing of other buttons.
    pub fn trims(self) -> Option<(AxisControl, f64)> {
        match self {
            Self::TrimAft => Some((AxisControl::StickAft, 1.0)),
            Self::TrimForward => Some((AxisControl::StickAft, -1.0)),
            Self::TrimRight => Some((AxisControl::StickRight, 1.0)),
            Self::TrimLeft => Some((AxisControl::StickRight, -1.0)),
            Self::TrimPedalRight => Some((AxisControl::PedalRight, 1.0)),
            Self::TrimPedalLeft => Some((AxisControl::PedalRight, -1.0)),
            _ => None,
        }
    }
}

/// A button that is released frees the switch only if it held it.
fn hold_nacelles(controls: &mut PilotControls, aft_norm: f64, pressed: bool) {
    if pressed {
        controls.nacelle_aft_norm = aft_norm;
    } else if controls.nacelle_aft_norm * aft_norm > 0.0 {
        controls.nacelle_aft_norm = 0.0;
    }
}
