//! The quantities that tables are over, each a type of its own.

use core::fmt::Debug;

/// A quantity that a table is over, in SI: the table's type names it, the aircraft file has its key, and a
/// value of it is what the table is looked up with.
pub trait Axis: Copy + Debug + PartialEq {
    /// Its key in an aircraft file; other units of the same quantity are read, too.
    const KEY: &'static str;

    /// The quantity of a number in SI.
    fn new(si: f64) -> Self;

    /// The number in SI.
    fn si(self) -> f64;
}

/// One line for each axis: what it is, its type and its key.
macro_rules! axes {
    ($($(#[$doc:meta])+ $name:ident $key:literal;)+) => {$(
        $(#[$doc])+
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name(pub f64);

        impl Axis for $name {
            const KEY: &'static str = $key;

            fn new(si: f64) -> Self {
                Self(si)
            }

            fn si(self) -> f64 {
                self.0
            }
        }
    )+};
}

axes! {
    /// α: angle of attack, rad, from below positive.
    Alpha "alpha_rad";
    /// β: angle of sideslip, rad, from the right positive; tables printed for |β| are looked up with it.
    Beta "beta_rad";
    /// M: Mach number.
    Mach "mach";
    /// V: true airspeed, m/s.
    Airspeed "airspeed_mps";
    /// βm: tilt of the mast, rad, 0 as a helicopter.
    MastTilt "mast_tilt_rad";
    /// δF: flap, rad, trailing edge down positive.
    FlapAngle "flap_rad";
    /// δe: elevator, rad, trailing edge down positive.
    ElevatorAngle "elevator_rad";
    /// δr: rudder, rad, outboard positive.
    RudderAngle "rudder_rad";
    /// Angle, rad, between the flow and a pylon's plane of symmetry, 0 to 90°.
    CrossflowAngle "angle_rad";
    /// r/R: part of the rotor's radius.
    RadialStation "radius_norm";
    /// μ: speed in the disc's plane over the speed of the blades' tips.
    AdvanceRatio "advance_ratio";
    /// Ω: rotor speed, rad/s.
    RotorSpeed "rotor_speed_radps";
    /// Height of the hub over the ground in rotor diameters.
    HubHeight "height_over_diameter";
    /// Position of an engine's lever, 0 at its bottom to 1.
    EngineLever "lever_norm";
}
