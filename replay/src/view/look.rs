//! How a flight is told from another one in the same recording.

/// Colours of lines that no side has: fields of a view in their order, axes in the order in which they move.
pub const COLOURS: [u32; 8] = [
    0xF5_A0_3C_FF,
    0x5B_A8_F5_FF,
    0xB6_8C_F0_FF,
    0xE6_E6_E6_FF,
    0x3F_B9_5A_FF,
    0xF0_DC_50_FF,
    0x48_D0_D0_FF,
    0xE0_4A_3F_FF,
];

/// How a flight is told from another one in the same recording.
#[derive(Clone, Debug)]
pub struct Look {
    /// Before the names of its entities.
    pub root: String,
    /// Before the names of its lines and events.
    pub name: String,
    /// Whether the ground goes with it.
    pub ground: bool,
    /// RGBA over the aircraft's own colours.
    pub tint: u32,
    /// RGBA of its marks on the map and in the corridor, and of the line behind it where that is not by
    /// configuration.
    pub flown: u32,
    /// RGB of its whole path; the last byte is its own.
    pub path: u32,
    /// RGBA that is left of a line's colour.
    pub line_mask: u32,
    /// Added to the width of its lines.
    pub line_width: f32,
    /// Whether its trail is coloured by configuration.
    pub by_mode: bool,
}

impl Look {
    /// A flight by itself.
    pub fn alone() -> Self {
        Self {
            root: String::new(),
            name: String::new(),
            ground: true,
            tint: 0xFF_FF_FF_FF,
            flown: 0xFF_C2_3A_FF,
            path: 0x7F_D0_FF_00,
            line_mask: 0xFF_FF_FF_FF,
            line_width: 0.0,
            by_mode: true,
        }
    }

    /// The first of two: in its own colours, its path white; its lines are broad and pale. No line of a plot has the
    /// colours of the paths: there they tell quantities.
    pub fn first(name: &str) -> Self {
        Self {
            root: format!("{name}/"),
            name: format!("{name}: "),
            flown: 0xF0_F0_F0_FF,
            path: 0xF0_F0_F0_00,
            line_mask: 0xFF_FF_FF_70,
            line_width: 3.0,
            by_mode: false,
            ..Self::alone()
        }
    }

    /// The flight beside it: the aircraft and its path are magenta; its lines are thin, within the other's.
    pub fn second(name: &str) -> Self {
        Self {
            root: format!("{name}/"),
            name: format!("{name}: "),
            ground: false,
            tint: 0xF0_50_D0_FF,
            flown: 0xF0_50_D0_FF,
            path: 0xF0_50_D0_00,
            line_width: -0.3,
            by_mode: false,
            ..Self::alone()
        }
    }

    /// Its entity of that name.
    pub fn entity(&self, name: &str) -> String {
        format!("{}{name}", self.root)
    }

    /// RGBA of a piece of its trail that was flown in a configuration of that colour, RGB.
    pub fn trail(&self, configuration: u32, opacity: u32) -> u32 {
        (if self.by_mode { configuration } else { self.path }) | opacity
    }
}
