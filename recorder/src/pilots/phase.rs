//! The parts of a pilot model's flight.

use super::habits::{APPROACH_S_MAX, PHASE_S_MAX};
use super::handbook::Handbook;
use super::sweep::Axis;

/// A speed of an aeroplane that the aircraft's handbook tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// Of a circuit.
    Circuit,
    /// Of a cruise.
    Cruise,
}

impl Speed {
    /// The speed, m/s.
    pub fn mps(self, handbook: &Handbook) -> f64 {
        match self {
            Self::Circuit => handbook.pilot.circuit_mps,
            Self::Cruise => handbook.pilot.cruise_mps,
        }
    }
}

/// One part of a pilot's flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// Stands, brakes set.
    Wait { seconds: f64 },
    /// Straight up from the ground to a height over it.
    Rise { height_m: f64, climb_mps: f64 },
    /// Keeps what it has.
    Hold { seconds: f64 },
    /// Presses the marker.
    Mark,
    /// Accelerates as a helicopter to the speed of a conversion, climbing to a height.
    Accelerate { height_m: f64 },
    /// Tilts the nacelles down through the corridor and reaches a speed.
    Convert { to: Speed },
    /// Climbs as an aeroplane.
    Climb { height_m: f64 },
    /// Turns left for ever.
    Circle { bank_rad: f64 },
    /// Turns left until it goes towards the spot where it began.
    Home { bank_rad: f64 },
    /// Flies to that spot, reconverts and slows down on the way, hovers over it.
    Approach { height_m: f64 },
    /// Reconverts and slows down straight ahead, hovers at a height over the ground, or at the one it has.
    Stop { height_m: Option<f64> },
    /// Turns over a spot to the heading of the start.
    FaceStart,
    /// Flies to any side with the nose where it points, as a helicopter.
    Sidle { forward_mps: f64, right_mps: f64, seconds: f64 },
    /// Descends onto the wheels and lowers the lever.
    Land,
    /// Comes down without engines.
    Autorotate,
    /// Keeps the flight that it finds, the hands at the controls' positions.
    Steady { seconds: f64 },
    /// Sweeps a control about that flight.
    Sweep { axis: Axis },
}

impl Phase {
    /// Whether it is over when the wheels are on the ground.
    pub fn ends_on_wheels(self) -> bool {
        matches!(self, Self::Land | Self::Autorotate)
    }

    /// When a pilot no longer waits for what does not come, and gives up, s. What has no end of its own
    /// is never given up for its length.
    pub fn patience_s(self) -> f64 {
        match self {
            Self::Wait { .. }
            | Self::Hold { .. }
            | Self::Circle { .. }
            | Self::Sidle { .. }
            | Self::Steady { .. }
            | Self::Sweep { .. } => f64::INFINITY,
            Self::Stop { .. } | Self::Approach { .. } => APPROACH_S_MAX,
            _ => PHASE_S_MAX,
        }
    }
}
