//! The numbers that trim solves for and that a linear system has as states, by name.
//!
//! A variable is a place in the engine's [`State`]: a field that is renamed there does not compile here
//! until it is renamed, and a field that is added to the plant does not compile until it is sorted.

use core::fmt;

use engine::aero::horizontal_stabilizer;
use engine::frames::{Body, Vec3};
use engine::state::Plant;
use engine::{State, actuators, engines, fcc, rotors};

/// An enum of fields of one struct: their places and their names.
macro_rules! fields {
    ($(#[$doc:meta])* $name:ident of $owner:ty {
        $($(#[$about:meta])* $variant:ident: $($field:ident).+,)+
    }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($(#[$about])* $variant,)+
        }

        impl $name {
            /// All of them, in the order of the state.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            fn get(self, owner: &$owner) -> f64 {
                match self {
                    $(Self::$variant => owner.$($field).+,)+
                }
            }

            fn place(self, owner: &mut $owner) -> &mut f64 {
                match self {
                    $(Self::$variant => &mut owner.$($field).+,)+
                }
            }

            /// The field as the state names it.
            pub fn field(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($($field).+),)+
                }
            }
        }
    };
}

fields! {
    /// What a rotor remembers.
    RotorState of rotors::State {
        /// v0.
        MeanInflow: inflow.mean_mps,
        /// vc.
        AftInflow: inflow.aft_mps,
        /// vs.
        RightInflow: inflow.right_mps,
        /// β0.
        Coning: flapping.coning_rad,
        /// Rate of β0.
        ConingRate: flapping.coning_radps,
        /// a1.
        AftFlapping: flapping.aft_rad,
        /// Rate of a1.
        AftFlappingRate: flapping.aft_radps,
        /// b1.
        RightFlapping: flapping.right_rad,
        /// Rate of b1.
        RightFlappingRate: flapping.right_radps,
        /// Of a1, what the blades bend.
        AftBending: flapping.elastic_aft_rad,
        /// Its rate.
        AftBendingRate: flapping.elastic_aft_radps,
        /// Of b1, what the blades bend.
        RightBending: flapping.elastic_right_rad,
        /// Its rate.
        RightBendingRate: flapping.elastic_right_radps,
    }
}

fields! {
    /// Mean stick positions of the SCAS's washout.
    ScasMean of fcc::scas::State {
        /// Longitudinal stick.
        Aft: mean_aft_m,
        /// Lateral stick.
        Right: mean_right_m,
        /// Pedals.
        PedalRight: mean_pedal_right_m,
    }
}

fields! {
    /// Positions of the actuators that move with sticks, pedals and governor.
    Surface of actuators::State {
        /// θ, left.
        CollectiveLeft: collective_rad.left,
        /// θ, right.
        CollectiveRight: collective_rad.right,
        /// B1, left.
        CyclicForwardLeft: cyclic_forward_rad.left,
        /// B1, right.
        CyclicForwardRight: cyclic_forward_rad.right,
        /// A1, left.
        CyclicOutboardLeft: cyclic_outboard_rad.left,
        /// A1, right.
        CyclicOutboardRight: cyclic_outboard_rad.right,
        /// δe.
        Elevator: elevator_rad,
        /// δa, left.
        FlaperonLeft: flaperon_rad.left,
        /// δa, right.
        FlaperonRight: flaperon_rad.right,
        /// δr.
        Rudder: rudder_right_rad,
    }
}

/// A side of the aircraft.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The pilot's left.
    Left,
    /// The pilot's right.
    Right,
}

impl Side {
    fn field(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// Where every field of the plant belongs: a field that is added does not compile until it is an
/// [`Inner`] state, or one that trim sets and a linear system holds.
const _: fn(&Plant) = |plant| {
    let Plant {
        origin: _,
        position_m: _,
        velocity_mps: _,
        attitude: _,
        angular_rate_radps: _,
        rotors,
        horizontal_stabilizer,
        rotor_speed_radps: _,
        rotor_azimuth_rad: _,
        engines,
        fuel_kg: _,
        tyre_deflections: _,
        weight_on_wheels: _,
    } = plant;
    let rotors::State { inflow, flapping } = &rotors.right;
    let rotors::inflow::State { mean_mps: _, aft_mps: _, right_mps: _ } = inflow;
    let rotors::flapping::State {
        coning_rad: _,
        coning_radps: _,
        aft_rad: _,
        aft_radps: _,
        right_rad: _,
        right_radps: _,
        elastic_aft_rad: _,
        elastic_aft_radps: _,
        elastic_right_rad: _,
        elastic_right_radps: _,
    } = flapping;
    let horizontal_stabilizer::State { downwash_rad: _ } = horizontal_stabilizer;
    let engines::State { power_w: _ } = &engines.right;
};

/// A number that a block remembers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inner {
    /// A mean of the SCAS.
    Scas(ScasMean),
    /// K_I·∫e of the governor.
    GovernorIntegral,
    /// An actuator's position.
    Surface(Surface),
    /// Inflow or flapping of a rotor.
    Rotor(Side, RotorState),
    /// Downwash at the tail.
    Downwash,
    /// Ω.
    RotorSpeed,
    /// Power of an engine.
    EnginePower(Side),
}

impl Inner {
    /// The plant's inner states: what trim solves for beside attitude, controls and power.
    pub fn of_plant() -> impl Iterator<Item = Self> {
        let rotor = |side| RotorState::ALL.iter().map(move |&state| Self::Rotor(side, state));
        rotor(Side::Left).chain(rotor(Side::Right)).chain([Self::Downwash])
    }

    /// The states of a linear system beside the rigid body's: those that move in a second or so.
    pub fn that_move(scas_on: bool) -> impl Iterator<Item = Self> {
        let scas = if scas_on { ScasMean::ALL } else { &[] };
        scas.iter()
            .map(|&mean| Self::Scas(mean))
            .chain([Self::GovernorIntegral])
            .chain(Surface::ALL.iter().map(|&surface| Self::Surface(surface)))
            .chain(Self::of_plant())
            .chain([
                Self::RotorSpeed,
                Self::EnginePower(Side::Left),
                Self::EnginePower(Side::Right),
            ])
    }

    /// Its value in a state.
    pub fn get(self, state: &State) -> f64 {
        let plant = &state.plant;
        match self {
            Self::Scas(mean) => mean.get(&state.fcc.scas),
            Self::GovernorIntegral => state.fcc.governor.integral_rad,
            Self::Surface(surface) => surface.get(&state.actuators),
            Self::Rotor(Side::Left, rotor) => rotor.get(&plant.rotors.left),
            Self::Rotor(Side::Right, rotor) => rotor.get(&plant.rotors.right),
            Self::Downwash => plant.horizontal_stabilizer.downwash_rad,
            Self::RotorSpeed => plant.rotor_speed_radps,
            Self::EnginePower(Side::Left) => plant.engines.left.power_w,
            Self::EnginePower(Side::Right) => plant.engines.right.power_w,
        }
    }

    /// Sets it in a state; a value that is not finite leaves it as it was.
    pub fn set(self, state: &mut State, value: f64) {
        if !value.is_finite() {
            return;
        }
        let plant = &mut state.plant;
        *match self {
            Self::Scas(mean) => mean.place(&mut state.fcc.scas),
            Self::GovernorIntegral => &mut state.fcc.governor.integral_rad,
            Self::Surface(surface) => surface.place(&mut state.actuators),
            Self::Rotor(Side::Left, rotor) => rotor.place(&mut plant.rotors.left),
            Self::Rotor(Side::Right, rotor) => rotor.place(&mut plant.rotors.right),
            Self::Downwash => &mut plant.horizontal_stabilizer.downwash_rad,
            Self::RotorSpeed => &mut plant.rotor_speed_radps,
            Self::EnginePower(Side::Left) => &mut plant.engines.left.power_w,
            Self::EnginePower(Side::Right) => &mut plant.engines.right.power_w,
        } = value;
    }
}

/// As the state names it: `plant.engines.left.power_w`.
impl fmt::Display for Inner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scas(mean) => write!(f, "fcc.scas.{}", mean.field()),
            Self::GovernorIntegral => f.write_str("fcc.governor.integral_rad"),
            Self::Surface(surface) => write!(f, "actuators.{}", surface.field()),
            Self::Rotor(side, rotor) => {
                write!(f, "plant.rotors.{}.{}", side.field(), rotor.field())
            }
            Self::Downwash => f.write_str("plant.horizontal_stabilizer.downwash_rad"),
            Self::RotorSpeed => f.write_str("plant.rotor_speed_radps"),
            Self::EnginePower(side) => write!(f, "plant.engines.{}.power_w", side.field()),
        }
    }
}

/// A state of the rigid body, in body axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rigid {
    /// u, over the ground.
    Forward,
    /// v.
    Right,
    /// w.
    Down,
    /// p.
    RollRate,
    /// q.
    PitchRate,
    /// r.
    YawRate,
    /// φ.
    Roll,
    /// θ.
    Pitch,
}

impl Rigid {
    /// All of them: the first states of every linear system, in this order.
    pub const ALL: [Self; 8] = [
        Self::Forward,
        Self::Right,
        Self::Down,
        Self::RollRate,
        Self::PitchRate,
        Self::YawRate,
        Self::Roll,
        Self::Pitch,
    ];

    /// Its name, with the unit.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward_mps",
            Self::Right => "right_mps",
            Self::Down => "down_mps",
            Self::RollRate => "roll_rate_radps",
            Self::PitchRate => "pitch_rate_radps",
            Self::YawRate => "yaw_rate_radps",
            Self::Roll => "roll_rad",
            Self::Pitch => "pitch_rad",
        }
    }
}

/// A state of a linear system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Of the rigid body.
    Rigid(Rigid),
    /// Of a block.
    Inner(Inner),
}

/// What a state belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// u, w, q, θ.
    Longitudinal,
    /// v, p, r, φ.
    Lateral,
    /// Rotor speed, engines, governor.
    Drive,
    /// The SCAS's washout.
    Scas,
    /// Inflow and flapping.
    Rotors,
    /// Downwash on its way to the tail.
    Downwash,
    /// Positions of the actuators.
    Actuators,
}

impl Part {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Longitudinal,
        Self::Lateral,
        Self::Drive,
        Self::Scas,
        Self::Rotors,
        Self::Downwash,
        Self::Actuators,
    ];
}

impl Variable {
    /// What it belongs to.
    pub fn part(self) -> Part {
        match self {
            Self::Rigid(Rigid::Forward | Rigid::Down | Rigid::PitchRate | Rigid::Pitch) => {
                Part::Longitudinal
            }
            Self::Rigid(Rigid::Right | Rigid::RollRate | Rigid::YawRate | Rigid::Roll) => {
                Part::Lateral
            }
            Self::Inner(Inner::Scas(_)) => Part::Scas,
            Self::Inner(Inner::Surface(_)) => Part::Actuators,
            Self::Inner(Inner::Rotor(..)) => Part::Rotors,
            Self::Inner(Inner::Downwash) => Part::Downwash,
            Self::Inner(Inner::GovernorIntegral | Inner::RotorSpeed | Inner::EnginePower(_)) => {
                Part::Drive
            }
        }
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rigid(rigid) => f.write_str(rigid.name()),
            Self::Inner(inner) => inner.fmt(f),
        }
    }
}

/// u̇ and ω̇ in body axes, m/s² and rad/s², of a state whose rates are in `next`.
pub(crate) fn accelerations(state: &State, next: &State) -> [f64; 6] {
    let body_from_ned = state.plant.attitude.ned_from_body().inverse();
    let rate = &next.rate.motion;
    let omega = state.plant.angular_rate_radps;
    let along: Vec3<Body> = body_from_ned * rate.acceleration_mps2
        - omega.cross(body_from_ned * state.plant.velocity_mps);
    let turn = rate.angular_acceleration_radps2;
    [along.x, along.y, along.z, turn.x, turn.y, turn.z]
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;
    use alloc::vec::Vec;

    use super::*;

    /// The name leads to the very number, and their order is the state's.
    #[test]
    fn every_inner_state_is_the_number_that_it_is_called_after() {
        let names = State::default().number_names();
        let mut last = None;
        for inner in Inner::that_move(true) {
            let mut state = State::default();
            inner.set(&mut state, 7.0);
            assert!((inner.get(&state) - 7.0).abs() <= 0.0, "{inner}");
            let (mut place, mut number) = (Vec::new(), 0);
            state.each_number(|value| {
                if *value > 6.0 {
                    place.push(number);
                }
                number += 1;
            });
            let [place] = place[..] else { panic!("{inner}: {place:?}") };
            assert_eq!(names[place], inner.to_string());
            assert!(last < Some(place), "{inner}: not in the order of the state");
            last = Some(place);
        }
    }

    #[test]
    fn what_is_not_finite_is_not_set() {
        let mut state = State::default();
        Inner::Downwash.set(&mut state, 0.1);
        Inner::Downwash.set(&mut state, f64::NAN);
        assert!((state.plant.horizontal_stabilizer.downwash_rad - 0.1).abs() <= 0.0);
    }
}
