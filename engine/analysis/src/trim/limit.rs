//! What the aircraft cannot do of a steady flight.

use alloc::format;
use alloc::string::String;

/// What the aircraft cannot do of a steady flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// The engines give no more.
    EnginePower,
    /// The engines give no less.
    IdlePower,
    /// The engines' governor lets no more torque on a mast.
    MastTorque,
    /// The stick's stops, fore and aft.
    LongitudinalStick,
    /// The stick's stops at the sides.
    LateralStick,
    /// The pedals' stops.
    Pedals,
    /// The governor's lower stop at these nacelles.
    CollectiveLow,
    /// The governor's upper stop.
    CollectiveHigh,
    /// The ground is where the wheels are.
    Ground,
}

impl Limit {
    /// What is wanted, against the limit, and what to ask for instead.
    pub(super) fn words(self, wanted_norm: f64) -> (String, &'static str) {
        let percent = 100.0 * wanted_norm;
        let less = "less weight, speed, climb or turn, or another flap or rotor speed";
        let at_its_limit = |what: &str| (format!("{what} at {percent:.0} % of its limit"), less);
        match self {
            Self::EnginePower => at_its_limit("engine power"),
            Self::IdlePower if wanted_norm > 0.0 => (
                format!("it takes {percent:.0} % of the power at which the engines idle"),
                "less descent, or more flap",
            ),
            Self::IdlePower => {
                ("the rotors would drive the engines".into(), "less descent, or more flap")
            }
            Self::MastTorque => (
                format!("mast torque at {percent:.0} % of its limit"),
                "less lever, weight, speed, climb or turn, or a faster rotor",
            ),
            Self::LongitudinalStick => at_its_limit("longitudinal stick"),
            Self::LateralStick => at_its_limit("lateral stick"),
            Self::Pedals => at_its_limit("pedals"),
            Self::CollectiveLow => {
                ("collective below its lower stop".into(), "less descent, or more weight")
            }
            Self::CollectiveHigh => ("collective above its upper stop".into(), less),
            Self::Ground => ("the wheels touch the ground".into(), "more height"),
        }
    }
}
