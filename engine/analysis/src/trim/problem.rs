//! What is unknown of a steady flight, and what must vanish in it.

use alloc::vec::Vec;
use core::ops::{Index, IndexMut};

use engine::controls::PilotControls;
use engine::frames::{Attitude, Body, Euler, Ned, Vec3};
use engine::inputs::Failures;
use engine::math::{FRAC_PI_2, PI, asin, atan2, clamp, cos, max, sin, sqrt, square};
use engine::pair::Pair;
use engine::{Aircraft, GRAVITY_MPS2, STEP_S, State, actuators, cockpit, engines, fcc, step};

use super::found::{Failure, Trim};
use super::residual::Equation;
use super::settle::settle;
use super::target::{Power, Target};
use crate::variable::{Inner, Side, accelerations};

/// What is unknown beside the inner states; the lateral ones only where flight is not symmetric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outer {
    /// θ.
    Pitch,
    /// Longitudinal stick.
    StickAft,
    /// θ at ¾ radius.
    Collective,
    /// Of each engine that runs, over its rated power.
    Power,
    /// With the lever given.
    Climb,
    /// φ.
    Roll,
    /// Lateral stick.
    StickRight,
    /// Pedals.
    Pedal,
}

impl Outer {
    const COUNT: usize = 8;

    /// No trial moves further at a time: rad, stick travel, rated power, m/s.
    pub(super) fn step_max(self) -> f64 {
        match self {
            Self::Pitch | Self::Collective => 0.1,
            Self::Roll => 0.15,
            Self::Power => 0.3,
            Self::StickAft | Self::StickRight | Self::Pedal => 0.4,
            Self::Climb => 5.0,
        }
    }
}

/// An unknown.
#[derive(Clone, Copy, Debug)]
pub(super) enum Unknown {
    Outer(Outer),
    /// The inner state at this place of [`Problem::inner`].
    Inner(usize),
}

/// Ticks for which the inner states settle before the first iteration.
const SETTLING_TICKS: usize = 150;

/// The engines give the torque that is needed: where that is too much is told afterwards.
pub(super) fn unlimited(aircraft: &Aircraft) -> Unlimited {
    let torque_n_m_max = aircraft.engines.torque_n_m_max;
    let aircraft = aircraft.clone().with(|params| params.engines.torque_n_m_max = 1e9);
    Unlimited { aircraft, torque_n_m_max }
}

/// An aircraft whose engines know no limit of torque, and that limit.
pub(super) struct Unlimited {
    aircraft: Aircraft,
    torque_n_m_max: f64,
}

pub(super) struct Problem<'a> {
    pub(super) aircraft: &'a Aircraft,
    pub(super) torque_n_m_max: f64,
    pub(super) target: &'a Target,
    symmetric: bool,
    pub(super) running: Pair<bool>,
    /// Which outer values are unknown, and which equations there are: as many.
    pub(super) outer: Vec<Outer>,
    pub(super) equations: Vec<Equation>,
    /// The inner states that are unknown. In symmetric flight the left rotor's are the right one's.
    pub(super) inner: Vec<Inner>,
}

/// A trial: a value for every outer quantity, unknown or not, and for every unknown inner state.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    outer: [f64; Outer::COUNT],
    inner: Vec<f64>,
}

impl Index<Outer> for Trial {
    type Output = f64;
    fn index(&self, outer: Outer) -> &f64 {
        &self.outer[outer as usize]
    }
}

impl IndexMut<Outer> for Trial {
    fn index_mut(&mut self, outer: Outer) -> &mut f64 {
        &mut self.outer[outer as usize]
    }
}

impl Index<Unknown> for Trial {
    type Output = f64;
    fn index(&self, unknown: Unknown) -> &f64 {
        match unknown {
            Unknown::Outer(outer) => &self[outer],
            Unknown::Inner(i) => &self.inner[i],
        }
    }
}

impl IndexMut<Unknown> for Trial {
    fn index_mut(&mut self, unknown: Unknown) -> &mut f64 {
        match unknown {
            Unknown::Outer(outer) => &mut self[outer],
            Unknown::Inner(i) => &mut self.inner[i],
        }
    }
}

impl Trial {
    /// All zeros, without inner states.
    fn zero() -> Self {
        Self { outer: [0.0; Outer::COUNT], inner: Vec::new() }
    }
}

impl<'a> Problem<'a> {
    pub(super) fn new(unlimited: &'a Unlimited, target: &'a Target) -> Result<Self, Failure> {
        let Unlimited { aircraft, torque_n_m_max } = unlimited;
        if !(target.airspeed_mps.is_finite() && target.airspeed_mps >= 0.0) {
            return Err(Failure::Senseless("an airspeed is zero or more"));
        }
        if let Power::Climb(climb_mps) = target.power
            && climb_mps.abs() > target.airspeed_mps
            && climb_mps != 0.0
        {
            return Err(Failure::Senseless("no climb or descent is faster than the airspeed"));
        }
        let symmetric = target.is_symmetric();
        let mirrored = |inner: &Inner| symmetric && matches!(inner, Inner::Rotor(Side::Left, _));
        let inner = Inner::of_plant().filter(|inner| !mirrored(inner)).collect();
        let mut outer = alloc::vec![Outer::Pitch, Outer::StickAft, Outer::Collective, Outer::Power];
        let mut equations =
            alloc::vec![Equation::Forward, Equation::Down, Equation::Pitch, Equation::RotorSpeed];
        if matches!(target.power, Power::Lever(_)) {
            outer.push(Outer::Climb);
            equations.push(Equation::Power);
        }
        if !symmetric {
            outer.extend([Outer::Roll, Outer::StickRight, Outer::Pedal]);
            equations.extend([Equation::Right, Equation::Roll, Equation::Yaw]);
        }
        let running = Pair {
            left: !target.world.failed(Failures::ENGINE_LEFT),
            right: !target.world.failed(Failures::ENGINE_RIGHT),
        };
        let torque_n_m_max = *torque_n_m_max;
        Ok(Self { aircraft, torque_n_m_max, target, symmetric, running, outer, equations, inner })
    }

    /// The rated power of one engine: the unit of power here.
    fn rated_w(&self) -> f64 {
        self.aircraft.engines.rated_power_w
    }

    fn rotor_speed_radps(&self) -> f64 {
        let governor = &self.aircraft.fcc.governor;
        governor.rotor_speed_radps[self.target.rpm_select.min(cockpit::RPM_SELECT_LAST) as usize]
    }

    /// A first trial: rotors at the inflow of a hover, blades at a working incidence.
    pub(super) fn guess(&self, pitch_rad: f64) -> Trial {
        let target = self.target;
        let rotors = &self.aircraft.rotors;
        let axial_mps = target.airspeed_mps * sin(target.mast_tilt_rad + pitch_rad);
        let disc_mps = 0.75 * self.rotor_speed_radps() * rotors.radius_m;
        let collective_rad = atan2(axial_mps + 17.0 * cos(target.mast_tilt_rad), disc_mps) + 0.07;
        let mut trial = Trial::zero();
        trial[Outer::Pitch] = pitch_rad;
        trial[Outer::Collective] = collective_rad;
        trial[Outer::Power] = if self.running.left || self.running.right { 0.6 } else { 0.0 };
        trial[Outer::Roll] = atan2(target.turn_radps * target.airspeed_mps, GRAVITY_MPS2);
        if let Power::Lever(lever) = target.power {
            let slow = -0.2 * target.airspeed_mps;
            trial[Outer::Climb] = if lever > 0.5 { 0.0 } else { slow };
        }
        self.settled(trial)
    }

    /// A first trial from a trim.
    pub(super) fn like(&self, near: &Trim) -> Trial {
        let plant = &near.state.plant;
        let mut trial = Trial::zero();
        trial[Outer::Pitch] = near.report.pitch_rad;
        trial[Outer::StickAft] = near.state.cockpit.stick_aft_norm;
        trial[Outer::Collective] = near.report.collective_rad;
        trial[Outer::Power] =
            max(plant.engines.left.power_w, plant.engines.right.power_w) / self.rated_w();
        trial[Outer::Climb] = near.report.climb_mps;
        if !self.symmetric {
            trial[Outer::Roll] = near.report.roll_rad;
            trial[Outer::StickRight] = near.state.cockpit.stick_right_norm;
            trial[Outer::Pedal] = near.state.cockpit.pedal_right_norm;
        }
        self.with_inner_of(trial, &near.state)
    }

    /// The trial after a while in which its inner states move and everything else is held. A trial that
    /// has none yet begins with those of a rotor at rest.
    pub(super) fn settled(&self, trial: Trial) -> Trial {
        let state = self.state(&trial);
        let mut state = settle(self.aircraft, &state, &self.target.world, SETTLING_TICKS);
        self.mirror(&mut state);
        self.with_inner_of(trial, &state)
    }

    fn with_inner_of(&self, mut trial: Trial, state: &State) -> Trial {
        trial.inner = self.inner.iter().map(|inner| inner.get(state)).collect();
        trial
    }

    /// In symmetric flight the left rotor, kept as its mirror image, does what the right one does.
    fn mirror(&self, state: &mut State) {
        if self.symmetric {
            state.plant.rotors.left = state.plant.rotors.right;
        }
    }

    /// The state of a trial's outer values, and of its inner ones where there are any.
    pub(super) fn state(&self, trial: &Trial) -> State {
        let target = self.target;
        let climb_mps = match target.power {
            Power::Climb(climb_mps) => climb_mps,
            Power::Lever(_) => {
                clamp(trial[Outer::Climb], -target.airspeed_mps, target.airspeed_mps)
            }
        };
        let (pitch_rad, roll_rad) = (trial[Outer::Pitch], trial[Outer::Roll]);
        let level_mps = sqrt(max(0.0, square(target.airspeed_mps) - square(climb_mps)));
        let off_track_rad = heading_off_track(
            pitch_rad,
            roll_rad,
            level_mps,
            -climb_mps,
            target.airspeed_mps * sin(target.sideslip_rad),
            target.sideslip_rad.abs() > FRAC_PI_2,
        );
        let track_rad = target.heading_rad - off_track_rad;
        let through_air =
            Vec3::<Ned>::new(level_mps * cos(track_rad), level_mps * sin(track_rad), -climb_mps);
        let power_w =
            self.running.map(|runs| if runs { trial[Outer::Power] * self.rated_w() } else { 0.0 });
        let mut state = State {
            cockpit: PilotControls {
                stick_aft_norm: trial[Outer::StickAft],
                stick_right_norm: trial[Outer::StickRight],
                pedal_right_norm: trial[Outer::Pedal],
                flap_detent: target.flap_detent.min(cockpit::FLAP_DETENT_LAST),
                gear_down: target.gear_down,
                scas_on: target.scas_on,
                rpm_select: target.rpm_select.min(cockpit::RPM_SELECT_LAST),
                ..PilotControls::default()
            },
            ..State::default()
        };
        let plant = &mut state.plant;
        plant.origin = target.origin;
        plant.position_m = Vec3::new(0.0, 0.0, target.origin.height_m - target.altitude_m);
        plant.velocity_mps = through_air + target.world.wind_mps;
        let heading_rad = target.heading_rad;
        plant.attitude = Attitude::from_euler(Euler { roll_rad, pitch_rad, heading_rad });
        plant.angular_rate_radps = turning(target.turn_radps, pitch_rad, roll_rad);
        plant.rotor_speed_radps = self.rotor_speed_radps();
        plant.engines = power_w.map(|power_w| engines::State { power_w });
        plant.fuel_kg = target.fuel_kg;
        state.actuators.mast_tilt_rad = Pair::both(target.mast_tilt_rad);
        self.set_controls(&mut state, trial[Outer::Collective]);
        for (inner, &value) in self.inner.iter().zip(&trial.inner) {
            inner.set(&mut state, value);
        }
        self.mirror(&mut state);
        state
    }

    /// Computer and actuators where they rest with the sticks of the state and this collective.
    pub(super) fn set_controls(&self, state: &mut State, collective_rad: f64) {
        let (aircraft, world) = (self.aircraft, &self.target.world);
        let sensed = step::sensed(state, world);
        let (fcc, commands) =
            fcc::settled(&aircraft.fcc, &state.cockpit, &sensed, world, collective_rad);
        state.fcc = fcc;
        state.actuators = actuators::settled(&aircraft.actuators, &state.actuators, &commands);
    }

    /// What must vanish: the outer equations, then the inner rates.
    pub(super) fn residual(&self, trial: &Trial) -> Vec<f64> {
        let state = self.state(trial);
        let mut lever = state;
        if let Power::Lever(lever_norm) = self.target.power {
            lever.actuators.lever_norm = lever_norm;
        }
        let next = step::derivatives(self.aircraft, &lever, &self.target.world).0;
        let [forward, right, down, roll, pitch, yaw] = accelerations(&state, &next);
        let power = next.rate.engines.power_w_per_s;
        let power_w_per_s = if self.running.right { power.right } else { power.left };
        let rate = |equation: &Equation| match equation {
            Equation::Forward => forward,
            Equation::Down => down,
            Equation::Pitch => pitch,
            Equation::RotorSpeed => next.rate.engines.rotor_speed_radps2,
            Equation::Power => power_w_per_s / self.rated_w(),
            Equation::Right => right,
            Equation::Roll => roll,
            Equation::Yaw => yaw,
        };
        self.equations
            .iter()
            .map(rate)
            .chain(self.inner.iter().map(|inner| (inner.get(&next) - inner.get(&state)) / STEP_S))
            .collect()
    }
}

/// ω of a steady turn.
fn turning(turn_radps: f64, pitch_rad: f64, roll_rad: f64) -> Vec3<Body> {
    Vec3::new(
        -turn_radps * sin(pitch_rad),
        turn_radps * sin(roll_rad) * cos(pitch_rad),
        turn_radps * cos(roll_rad) * cos(pitch_rad),
    )
}

/// ψ less the track's direction, so that the air comes from the right with `from_right_mps`, and from
/// ahead unless it comes from behind.
fn heading_off_track(
    pitch_rad: f64,
    roll_rad: f64,
    level_mps: f64,
    down_mps: f64,
    from_right_mps: f64,
    from_behind: bool,
) -> f64 {
    // v = a·cos ψ − b·sin ψ + c
    let a = level_mps * sin(roll_rad) * sin(pitch_rad);
    let b = level_mps * cos(roll_rad);
    let c = down_mps * sin(roll_rad) * cos(pitch_rad);
    let length = sqrt(square(a) + square(b));
    if length < 1e-9 {
        return 0.0;
    }
    let from_ahead_rad = asin((from_right_mps - c) / length);
    atan2(a, b) - if from_behind { PI - from_ahead_rad } else { from_ahead_rad }
}
