//! Which figures there are.

/// What is told of a [`Figure`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FigureFacts {
    /// Its name on the command line and in files; never changed.
    pub key: &'static str,
    /// Its title.
    pub words: &'static str,
    /// What it shows.
    pub description: &'static str,
}

engine::enumeration! {
    /// A figure.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u64)]
    pub enum Figure tells FigureFacts {
        /// The path in space, in a box with its shadow on the ground.
        Trajectory = 1 { key: "trajectory", words: "Trajectory" }
        /// The path seen from above.
        Plan = 2 { key: "plan", words: "Ground track" }
        /// Height, airspeed, climb, nacelles and load factor over time.
        Profile = 3 { key: "profile", words: "Flight profile" }
        /// Roll, pitch and heading over time.
        Euler = 4 { key: "euler", words: "Euler angles" }
        /// Stick, pedals and lever, and the surfaces that follow, over time.
        Controls = 5 { key: "controls", words: "Controls" }
        /// Thrust, torque, collective pitch, flapping and speed of the rotors over time.
        Rotors = 6 { key: "rotors", words: "Rotors" }
        /// Nacelle angle over airspeed, within the conversion corridor.
        Corridor = 7 { key: "corridor", words: "Conversion corridor" }
        /// How late each tick's picture was, and how long its step took.
        Latency = 8 { key: "latency", words: "Latency of each step" }
    }
}

/// Why a figure cannot be drawn of a flight.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it cannot be drawn: {0}")]
pub struct Undrawn(pub &'static str);
