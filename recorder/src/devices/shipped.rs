//! The maps that are shipped, and which of them are for anybody.

use engine::cockpit::Params;

/// A map that is shipped.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// Its file's name.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
    /// What it is for.
    pub what: &'static str,
    /// Whether it is flown without being asked for.
    pub by_itself: bool,
}

macro_rules! shipped {
    ($($name:literal, $by_itself:literal, $what:literal;)+) => {
        &[$(Shipped {
            name: $name,
            text: include_str!(concat!("../../../aircraft/cockpit/", $name)),
            what: $what,
            by_itself: $by_itself,
        }),+]
    };
}

/// All of them; of devices that are in several the first counts.
pub const SHIPPED: &[Shipped] = shipped! {
    "stick.toml", true, "a stick with a collective lever that is pulled up, twist grip and hat";
    "t16000m.toml", true, "Thrustmaster T.16000M: stick, twist grip, slider";
    "x52.toml", true, "Saitek and Logitech X52, X52 Pro: stick and throttle in one";
    "x56.toml", true, "Saitek and Logitech X56, X55: stick and throttle";
    "pedals.toml", true, "pedals without buttons, with toe brakes: Thrustmaster, Saitek and Logitech, any other";
    "joystick.toml", true, "any other stick with a throttle slider: ST290, Extreme 3D and their like";
    "radio.toml", true, "an RC transmitter with OpenTX or EdgeTX as a joystick";
    "gamepad.toml", true, "any gamepad: triggers are pedals, the left stick's height is the lever's speed";
    "evdev-keyboard.toml", false, "a keyboard, where this user may read it";
};

/// The map of all that are flown by themselves.
///
/// # Errors
/// When one of them is none, in words: a fault of ours that a test finds.
pub fn shipped() -> Result<Params, aircraft::ConfigError> {
    let mut all = Params::default();
    for map in SHIPPED.iter().filter(|map| map.by_itself) {
        all.device.extend(aircraft::cockpit(map.name, map.text)?.device);
    }
    Ok(all)
}
