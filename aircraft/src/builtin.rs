//! The files that the program carries with it.

/// The XV-15, to be read by [`aircraft`](crate::aircraft()).
pub const XV15: &str = include_str!("../xv15.toml");

/// Cockpit map of the built-in pilots and scripts, to be read by [`cockpit`](crate::cockpit()).
pub const PILOT_MAP: &str = include_str!("../cockpit/pilot.toml");

/// Cockpit map of the keyboard, to be read by [`cockpit`](crate::cockpit()).
pub const KEYBOARD_MAP: &str = include_str!("../cockpit/keyboard.toml");

/// Cockpit map of a common USB stick, to be read by [`cockpit`](crate::cockpit()).
pub const STICK_MAP: &str = include_str!("../cockpit/stick.toml");

/// Cockpit map of FlightGear's own stick, keyboard and mouse, to be read by [`cockpit`](crate::cockpit()).
pub const FLIGHTGEAR_MAP: &str = include_str!("../cockpit/flightgear.toml");

/// Where a flight begins unless told otherwise, to be read by [`start`](crate::start()).
pub const DEFAULT_SCENARIO: &str = include_str!("../scenario/default.toml");

/// Start positions by name, each with what it is and its scenario, to be read by [`start`](crate::start()).
pub const STARTS: [(&str, &str, &str); 4] = [
    ("runway", "on the threshold of runway 26 at Hilo", DEFAULT_SCENARIO),
    ("hover-50ft", "in a hover 50 ft above it", include_str!("../scenario/hover-50ft.toml")),
    (
        "approach-60",
        "three miles out, nacelles at 60 deg, 100 kt, sinking at 500 ft/min",
        include_str!("../scenario/approach-60.toml"),
    ),
    (
        "downwind",
        "as an aeroplane on the downwind leg, 170 kt at 1,050 ft",
        include_str!("../scenario/downwind.toml"),
    ),
];
