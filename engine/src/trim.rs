//! Trim: the steady flight that was asked for, and the state that flies it.
//!
//! # Equations
//! ```text
//! u̇ = 0, ω̇ = 0 in body axes,  Ω̇ = 0,  ṡ = 0                       s: inner states of the plant
//! u̇ = Rᵀ·V̇ − ω×u               ω = ψ̇·(−sin θ, sin φ·cos θ, cos φ·cos θ)       steady turn  [STEVENS]
//! v = V·sin β  by the heading ψ off the track                             from θ, φ and the climb
//! ```
//! Unknown are pitch, stick, collective and engine power (or, with the lever given, the climb); in flight
//! that is not symmetric roll, lateral stick and pedals too; and every inner state of the plant,
//! whatever the blocks remember. Newton's method with central differences and a line search finds
//! them together; [`step::heading`] says where a trial is heading.
//!
//! Lever, governor and SCAS follow from what was found: the lever that keeps the engines' power, the
//! governor's correction that makes up the collective.
//!
//! # Signs
//! Those of the blocks. Climb positive upwards, turn positive to the right, sideslip from the right
//! positive.
//! # Assumptions
//! The wind is part of the world and counts as moving air; fuel burns, and density changes in a
//! climb: both are so slow that the flight counts as steady. With the wings level, no turn and both engines
//! alike only the symmetric motion is solved, which makes the lateral quantities exactly zero.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;

use crate::dense::Matrix;
use crate::fcc::{governor, mixer, scas};
use crate::frames::{Attitude, Body, Euler, Ned, Vec3};
use crate::inputs::{World, failures};
use crate::math::{PI, asin, atan2, clamp, cos, max, sin, sqrt, square};
use crate::pair::Pair;
use crate::state::{Geodetic, State};
use crate::{Aircraft, Outputs, STEP_S, actuators, cockpit, engines, fcc, step};

/// A steady flight to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// βm.
    pub mast_tilt_rad: f64,
    /// True airspeed.
    pub airspeed_mps: f64,
    /// What the engines are to do.
    pub power: Power,
    /// ψ̇, to the right positive.
    pub turn_radps: f64,
    /// β.
    pub sideslip_rad: f64,
    /// Where the nose points.
    pub heading_rad: f64,
    /// Above mean sea level.
    pub altitude_m: f64,
    /// The origin of NED, and the ground there.
    pub origin: Geodetic,
    /// Fuel aboard.
    pub fuel_kg: f64,
    /// Flap lever's detent, 0..3.
    pub flap_detent: u64,
    /// Rotor speed selected: 0 helicopter, 1 and 2 aeroplane.
    pub rpm_select: u64,
    /// 1 with the gear down.
    pub gear_down: u64,
    /// 1 with the SCAS on; it is centred.
    pub scas_on: u64,
    /// The world. Its ground is what the rotors feel under them.
    pub world: World,
}

/// What the engines are to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Power {
    /// Whatever this climb takes, m/s upwards.
    Climb(f64),
    /// What the lever gives at this position, 0..1; the climb follows.
    Lever(f64),
}

/// Ground that no rotor feels, m.
pub const GROUND_FAR_BELOW_M: f64 = -1e5;

impl Default for Target {
    /// Hover as a helicopter at sea level, far from the ground, flaps 40/25, gear up.
    fn default() -> Self {
        Self {
            mast_tilt_rad: 0.0,
            airspeed_mps: 0.0,
            power: Power::Climb(0.0),
            turn_radps: 0.0,
            sideslip_rad: 0.0,
            heading_rad: 0.0,
            altitude_m: 0.0,
            origin: Geodetic::default(),
            fuel_kg: 669.0,
            flap_detent: 2,
            rpm_select: 0,
            gear_down: 0,
            scas_on: 0,
            world: World { ground_height_m: GROUND_FAR_BELOW_M, ..World::default() },
        }
    }
}

impl Target {
    fn is_symmetric(&self) -> bool {
        let engines = failures::ENGINE_LEFT | failures::ENGINE_RIGHT;
        let failed = self.world.failures & engines;
        self.turn_radps == 0.0
            && self.sideslip_rad == 0.0
            && (failed == 0 || failed == engines)
            && self.world.wind_mps == Vec3::zero()
    }
}

/// A steady flight that was found.
#[derive(Clone, Debug)]
pub struct Trim {
    /// Everything the aircraft remembers in it.
    pub state: State,
    /// What can be observed in it.
    pub outputs: Outputs,
    /// In words that a pilot knows.
    pub report: Report,
}

/// A trim by its numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// θ.
    pub pitch_rad: f64,
    /// φ.
    pub roll_rad: f64,
    /// α.
    pub alpha_rad: f64,
    /// β.
    pub beta_rad: f64,
    /// Upwards.
    pub climb_mps: f64,
    /// Longitudinal stick from the aft stop.
    pub stick_from_aft_m: f64,
    /// The same over the whole travel, 0 aft … 1 forward.
    pub stick_forward_norm: f64,
    /// Lateral stick from neutral, right positive.
    pub stick_right_m: f64,
    /// Pedals from neutral, right positive.
    pub pedal_right_m: f64,
    /// Power lever, 0..1.
    pub lever_norm: f64,
    /// θ at ¾ radius, mean of both rotors.
    pub collective_rad: f64,
    /// B1, mean of both rotors, stick forward positive.
    pub cyclic_forward_rad: f64,
    /// δe, trailing edge down.
    pub elevator_rad: f64,
    /// Of each rotor.
    pub thrust_n: Pair<f64>,
    /// Taken by both rotors.
    pub power_w: f64,
    /// That both engines could give at the rotor shafts.
    pub available_w: f64,
    /// Torque of the busier mast.
    pub torque_n_m: f64,
    /// Of both engines.
    pub fuel_flow_kg_per_s: f64,
    /// Wings and pylons push down by, in body axes.
    pub download_n: f64,
    /// Largest acceleration left: m/s², rad/s².
    pub residual: f64,
}

/// Why there is no trim.
#[derive(Clone, Debug)]
pub enum Failure {
    /// No steady flight was found.
    Unsteady {
        /// Largest acceleration in the best trial: m/s², rad/s².
        residual: f64,
        /// Of what.
        of: String,
    },
    /// There is a steady flight, but the aircraft cannot fly it.
    Beyond {
        /// What is asked for too much of.
        what: &'static str,
        /// How much, 1 being all there is.
        wanted_norm: f64,
        /// The flight, with that control at its stop.
        trim: Box<Trim>,
    },
    /// What was asked for makes no sense.
    Senseless(&'static str),
}

impl core::fmt::Display for Failure {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unsteady { residual, of } => {
                let unit = match of.as_str() {
                    "acceleration forward" | "acceleration down" | "acceleration to the right" => {
                        " m/s²"
                    }
                    "pitch acceleration" | "rotor acceleration" | "roll acceleration"
                    | "yaw acceleration" => " rad/s²",
                    // Inner states have their unit in the name, power is relative.
                    _ => "",
                };
                write!(f, "no steady flight found: {of} is left with {residual:.2e}{unit}")
            }
            Self::Beyond { what, wanted_norm, .. } => {
                write!(
                    f,
                    "beyond the aircraft: {what} at {:.0} % of its limit",
                    100.0 * wanted_norm
                )
            }
            Self::Senseless(what) => f.write_str(what),
        }
    }
}

impl core::error::Error for Failure {}

/// Finds the steady flight.
///
/// # Errors
/// When there is none, or the aircraft cannot fly it.
pub fn trim(aircraft: &Aircraft, target: &Target) -> Result<Trim, Failure> {
    let aircraft = &unlimited(aircraft);
    let mut best = None;
    for pitch_rad in [guess_pitch(target), 0.0, 0.14, -0.14] {
        let problem = Problem::new(aircraft, target)?;
        let guess = problem.guess(pitch_rad);
        match problem.solve(guess) {
            Err(Failure::Unsteady { residual, of }) => {
                if best.as_ref().is_none_or(|(least, _)| residual < *least) {
                    best = Some((residual, of));
                }
            }
            done => return done,
        }
    }
    let (residual, of) = best.unwrap_or_default();
    Err(Failure::Unsteady { residual, of })
}

/// Finds the steady flight from one that is near it, and without one otherwise.
///
/// # Errors
/// When there is none, or the aircraft cannot fly it.
pub fn trim_near(aircraft: &Aircraft, target: &Target, near: &Trim) -> Result<Trim, Failure> {
    let unlimited = unlimited(aircraft);
    let problem = Problem::new(&unlimited, target)?;
    let guess = problem.like(near);
    match problem.solve(guess) {
        Err(Failure::Unsteady { .. }) => trim(aircraft, target),
        done => done,
    }
}

/// The engines give the torque that is needed: where that is too much is told afterwards.
fn unlimited(aircraft: &Aircraft) -> Unlimited {
    let torque_n_m_max = aircraft.engines.torque_n_m_max;
    let mut aircraft = aircraft.clone();
    aircraft.engines.torque_n_m_max = 1e9;
    Unlimited { aircraft, torque_n_m_max }
}

/// An aircraft whose engines know no limit of torque, and that limit.
struct Unlimited {
    aircraft: Aircraft,
    torque_n_m_max: f64,
}

/// Slow flight takes about level attitudes, an aeroplane some incidence at low speed.
fn guess_pitch(target: &Target) -> f64 {
    let speed = max(target.airspeed_mps, 1.0);
    let aeroplane = sin(target.mast_tilt_rad) * clamp(400.0 / square(speed), 0.0, 0.15);
    let helicopter = -cos(target.mast_tilt_rad) * clamp(0.002 * speed, 0.0, 0.15);
    aeroplane + helicopter
}

/// What the trial values are, in their order; lateral ones only where flight is not symmetric.
const PITCH: usize = 0;
const STICK_AFT: usize = 1;
const COLLECTIVE: usize = 2;
const POWER: usize = 3;
const CLIMB: usize = 4;
const ROLL: usize = 5;
const STICK_RIGHT: usize = 6;
const PEDAL: usize = 7;
const OUTER: usize = 8;

/// No trial moves further at a time: rad, stick travel, rad, rated power, m/s.
const STEP_MAX: [f64; OUTER] = [0.1, 0.4, 0.1, 0.3, 5.0, 0.15, 0.4, 0.4];

/// What must vanish, beside the inner states' rates.
const EQUATIONS: [&str; OUTER] = [
    "acceleration forward",
    "acceleration down",
    "pitch acceleration",
    "rotor acceleration",
    "engine power",
    "acceleration to the right",
    "roll acceleration",
    "yaw acceleration",
];

/// Weighed against each other, for the line search: an m/s² counts like this many of the others.
const WEIGHTS: [f64; OUTER] = [1.0, 1.0, 3.0, 1.0, 1.0, 1.0, 3.0, 3.0];

/// Inner states are fast: their rates are large where their effect is small.
const INNER_WEIGHT: f64 = 0.02;

/// Below this an acceleration is rounding.
const STEADY: f64 = 1e-8;

/// A trial is this good at the latest after so many iterations, or never.
const ITERATIONS: usize = 60;

/// Ticks for which the inner states settle before the first iteration.
const SETTLING_TICKS: usize = 150;

struct Problem<'a> {
    aircraft: &'a Aircraft,
    torque_n_m_max: f64,
    target: &'a Target,
    symmetric: bool,
    running: Pair<bool>,
    /// Which outer values and equations there are.
    outer: Vec<usize>,
    equations: Vec<usize>,
    /// Places of the inner states among the state's numbers.
    inner: Vec<usize>,
    /// In symmetric flight the left inner states are those of the right: their places.
    twins: Vec<(usize, usize)>,
    names: Vec<String>,
}

/// A trial: its values, inner states behind the outer ones.
type Trial = Vec<f64>;

/// The places of the plant's inner states among the numbers of a state, with their names: whatever
/// the plant remembers beside the rigid body, the drive, the fuel and the tyres.
pub(crate) fn inner_states(names: &[String]) -> Vec<usize> {
    const OTHERS: [&str; 9] = [
        "plant.origin",
        "plant.position_m",
        "plant.velocity_mps",
        "plant.attitude",
        "plant.angular_rate_radps",
        "plant.rotor_speed_radps",
        "plant.rotor_azimuth_rad",
        "plant.fuel_kg",
        "plant.treads",
    ];
    (0..names.len())
        .filter(|&i| {
            names[i].starts_with("plant.")
                && !names[i].starts_with("plant.engines")
                && !OTHERS.iter().any(|other| names[i].starts_with(other))
        })
        .collect()
}

/// The state's numbers.
pub(crate) fn numbers(state: &State) -> Vec<f64> {
    let mut numbers = Vec::new();
    let mut copy = *state;
    copy.each_number(|number| numbers.push(*number));
    numbers
}

/// The state after some ticks in which only the plant's inner states move, as on a test stand:
/// the body, the drive and all controls are held.
pub fn settle(aircraft: &Aircraft, state: &State, world: &World, ticks: usize) -> State {
    let inner = inner_states(&state.number_names());
    let mut state = *state;
    for _ in 0..ticks {
        let next = numbers(&step::heading(aircraft, &state, world).0);
        set_numbers(&mut state, &inner, |i| next[inner[i]]);
    }
    state
}

/// Sets the numbers at these places, which ascend; what is not finite stays as it was.
pub(crate) fn set_numbers(state: &mut State, places: &[usize], value: impl Fn(usize) -> f64) {
    let (mut number, mut i) = (0, 0);
    state.each_number(|place| {
        if places.get(i) == Some(&number) {
            let value = value(i);
            if value.is_finite() {
                *place = value;
            }
            i += 1;
        }
        number += 1;
    });
}

impl<'a> Problem<'a> {
    fn new(unlimited: &'a Unlimited, target: &'a Target) -> Result<Self, Failure> {
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
        let names = State::default().number_names();
        let symmetric = target.is_symmetric();
        let all = inner_states(&names);
        let mut twins = Vec::new();
        if symmetric {
            for &i in all.iter().filter(|&&i| names[i].contains(".left.")) {
                let right = names[i].replace(".left.", ".right.");
                twins.extend(all.iter().find(|&&j| names[j] == right).map(|&j| (i, j)));
            }
        }
        let inner = all.into_iter().filter(|i| twins.iter().all(|(left, _)| left != i)).collect();
        let mut outer = alloc::vec![PITCH, STICK_AFT, COLLECTIVE, POWER];
        let mut equations = alloc::vec![0, 1, 2, 3];
        if matches!(target.power, Power::Lever(_)) {
            outer.push(CLIMB);
            equations.push(4);
        }
        if !symmetric {
            outer.extend([ROLL, STICK_RIGHT, PEDAL]);
            equations.extend([5, 6, 7]);
        }
        let running = Pair {
            left: !target.world.failed(failures::ENGINE_LEFT),
            right: !target.world.failed(failures::ENGINE_RIGHT),
        };
        let torque_n_m_max = *torque_n_m_max;
        Ok(Self {
            aircraft,
            torque_n_m_max,
            target,
            symmetric,
            running,
            outer,
            equations,
            inner,
            twins,
            names,
        })
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
    fn guess(&self, pitch_rad: f64) -> Trial {
        let target = self.target;
        let rotors = &self.aircraft.rotors;
        let axial_mps = target.airspeed_mps * sin(target.mast_tilt_rad + pitch_rad);
        let disc_mps = 0.75 * self.rotor_speed_radps() * rotors.radius_m;
        let collective_rad = atan2(axial_mps + 17.0 * cos(target.mast_tilt_rad), disc_mps) + 0.07;
        let mut outer = [0.0; OUTER];
        outer[PITCH] = pitch_rad;
        outer[COLLECTIVE] = collective_rad;
        outer[POWER] = if self.running.left || self.running.right { 0.6 } else { 0.0 };
        outer[ROLL] = atan2(target.turn_radps * target.airspeed_mps, crate::GRAVITY_MPS2);
        if let Power::Lever(lever) = target.power {
            let slow = -0.2 * target.airspeed_mps;
            outer[CLIMB] = if lever > 0.5 { 0.0 } else { slow };
        }
        let state = self.state(&outer, None);
        self.settled(&outer, state)
    }

    /// A first trial from a trim.
    fn like(&self, near: &Trim) -> Trial {
        let plant = &near.state.plant;
        let mut outer = [0.0; OUTER];
        outer[PITCH] = near.report.pitch_rad;
        outer[STICK_AFT] = near.state.cockpit.stick_aft_norm;
        outer[COLLECTIVE] = near.report.collective_rad;
        outer[POWER] =
            max(plant.engines.left.power_w, plant.engines.right.power_w) / self.rated_w();
        outer[CLIMB] = near.report.climb_mps;
        if !self.symmetric {
            outer[ROLL] = near.report.roll_rad;
            outer[STICK_RIGHT] = near.state.cockpit.stick_right_norm;
            outer[PEDAL] = near.state.cockpit.pedal_right_norm;
        }
        let inner = numbers(&near.state);
        let mut trial = outer.to_vec();
        trial.extend(self.inner.iter().map(|&i| inner[i]));
        trial
    }

    /// The inner states after a while with everything else held.
    fn settled(&self, outer: &[f64; OUTER], state: State) -> Trial {
        let mut state = settle(self.aircraft, &state, &self.target.world, SETTLING_TICKS);
        self.mirror(&mut state);
        let inner = numbers(&state);
        let mut trial = outer.to_vec();
        trial.extend(self.inner.iter().map(|&i| inner[i]));
        trial
    }

    fn mirror(&self, state: &mut State) {
        if !self.twins.is_empty() {
            let all = numbers(state);
            let left: Vec<usize> = self.twins.iter().map(|(left, _)| *left).collect();
            set_numbers(state, &left, |i| all[self.twins[i].1]);
        }
    }

    /// The state of a trial's outer values, and of its inner ones where there are any.
    fn state(&self, trial: &[f64], inner: Option<&[f64]>) -> State {
        let target = self.target;
        let climb_mps = match target.power {
            Power::Climb(climb_mps) => climb_mps,
            Power::Lever(_) => clamp(trial[CLIMB], -target.airspeed_mps, target.airspeed_mps),
        };
        let (pitch_rad, roll_rad) = (trial[PITCH], trial[ROLL]);
        let level_mps = sqrt(max(0.0, square(target.airspeed_mps) - square(climb_mps)));
        let off_track_rad = heading_off_track(
            pitch_rad,
            roll_rad,
            level_mps,
            -climb_mps,
            target.airspeed_mps * sin(target.sideslip_rad),
        );
        let track_rad = target.heading_rad - off_track_rad;
        let through_air =
            Vec3::<Ned>::new(level_mps * cos(track_rad), level_mps * sin(track_rad), -climb_mps);
        let power_w =
            self.running.map(|runs| if runs { trial[POWER] * self.rated_w() } else { 0.0 });
        let mut state = State {
            cockpit: cockpit::State {
                stick_aft_norm: trial[STICK_AFT],
                stick_right_norm: trial[STICK_RIGHT],
                pedal_right_norm: trial[PEDAL],
                flap_detent: target.flap_detent.min(cockpit::FLAP_DETENT_LAST),
                gear_down: target.gear_down,
                scas_on: target.scas_on,
                rpm_select: target.rpm_select.min(cockpit::RPM_SELECT_LAST),
                ..cockpit::State::default()
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
        self.set_controls(&mut state, trial[COLLECTIVE]);
        if let Some(inner) = inner {
            set_numbers(&mut state, &self.inner, |i| inner[i]);
            self.mirror(&mut state);
        }
        state
    }

    /// Computer and actuators where they rest with the sticks of the state and this collective.
    fn set_controls(&self, state: &mut State, collective_rad: f64) {
        let (aircraft, pilot) = (self.aircraft, state.cockpit);
        let travel = &aircraft.fcc.travel;
        let sensed = step::sensed(state, &self.target.world);
        let sticks = scas::Sticks {
            aft_m: pilot.stick_aft_norm * travel.longitudinal_stick_m,
            right_m: pilot.stick_right_norm * travel.lateral_stick_m,
            pedal_right_m: pilot.pedal_right_norm * travel.pedal_m,
        };
        let centred = scas::State {
            mean_aft_m: sticks.aft_m,
            mean_right_m: sticks.right_m,
            mean_pedal_right_m: sticks.pedal_right_m,
            held_pitch_rad: sensed.euler.pitch_rad,
            held_roll_rad: sensed.euler.roll_rad,
        };
        let world = &self.target.world;
        let on = scas::Axes {
            pitch: pilot.scas_on != 0 && !world.failed(failures::SCAS_PITCH),
            roll: pilot.scas_on != 0 && !world.failed(failures::SCAS_ROLL),
            yaw: pilot.scas_on != 0 && !world.failed(failures::SCAS_YAW),
        };
        let (_, augmented) = scas::update(&aircraft.fcc.scas, &centred, &sticks, on, &sensed);
        let commands = mixer::mix(&aircraft.fcc.mixer, &augmented, collective_rad, &pilot, &sensed);
        state.actuators = actuators::settled(&aircraft.actuators, &state.actuators, &commands);
        let lever_m = pilot.collective_norm * travel.collective_m;
        let from_lever_rad =
            mixer::lever_collective(&aircraft.fcc.mixer, sensed.mast_tilt_rad, lever_m);
        let correction_rad = collective_rad - from_lever_rad;
        let reference_radps = state.plant.rotor_speed_radps;
        let governor =
            governor::State { reference_radps, integral_rad: correction_rad, correction_rad };
        state.fcc = fcc::State { scas: centred, governor };
    }

    /// What must vanish: the outer equations, then the inner rates.
    fn residual(&self, trial: &Trial) -> Vec<f64> {
        let state = self.state(trial, Some(&trial[OUTER..]));
        let mut lever = state;
        if let Power::Lever(lever_norm) = self.target.power {
            lever.actuators.lever_norm = lever_norm;
        }
        let next = step::heading(self.aircraft, &lever, &self.target.world).0;
        let accelerations = accelerations(&state, &next);
        let power = next.rate.engines.power_w_per_s;
        let power_w_per_s = if self.running.right { power.right } else { power.left };
        let all = [
            accelerations[0],
            accelerations[2],
            accelerations[4],
            next.rate.engines.rotor_speed_radps2,
            power_w_per_s / self.rated_w(),
            accelerations[1],
            accelerations[3],
            accelerations[5],
        ];
        let (before, after) = (numbers(&state), numbers(&next));
        self.equations
            .iter()
            .map(|&i| all[i])
            .chain(self.inner.iter().map(|&i| (after[i] - before[i]) / STEP_S))
            .collect()
    }

    fn merit(&self, residual: &[f64]) -> f64 {
        let outer = self.equations.iter().zip(residual).map(|(&i, r)| WEIGHTS[i] * r);
        let inner = residual[self.equations.len()..].iter().map(|r| INNER_WEIGHT * r);
        let merit = sqrt(outer.chain(inner).map(square).sum());
        if merit.is_finite() { merit } else { f64::MAX }
    }

    /// The largest of them, and its equation. Inner rates count by their weight.
    fn worst(&self, residual: &[f64]) -> (f64, String) {
        let mut worst = (0.0, String::new());
        for (i, r) in residual.iter().enumerate() {
            let (size, name) = match self.equations.get(i) {
                Some(&equation) => (r.abs(), EQUATIONS[equation]),
                None => {
                    let inner = self.inner[i - self.equations.len()];
                    (INNER_WEIGHT * r.abs(), self.names[inner].as_str())
                }
            };
            // What is not a number is worse than any.
            if size > worst.0 || size.is_nan() {
                worst = (size, name.into());
            }
        }
        worst
    }

    /// Places of the unknown among the values of a trial.
    fn unknown(&self) -> Vec<usize> {
        self.outer.iter().copied().chain(OUTER..OUTER + self.inner.len()).collect()
    }

    fn jacobian(&self, trial: &Trial, unknown: &[usize]) -> Matrix {
        let mut jacobian = Matrix::zeros(unknown.len(), unknown.len());
        for (column, &i) in unknown.iter().enumerate() {
            let step = 1e-6 * max(1.0, if i >= OUTER { trial[i].abs() } else { 1.0 });
            let mut moved = trial.clone();
            moved[i] = trial[i] + step;
            let above = self.residual(&moved);
            moved[i] = trial[i] - step;
            let below = self.residual(&moved);
            for row in 0..unknown.len() {
                jacobian[(row, column)] = (above[row] - below[row]) / (2.0 * step);
            }
        }
        jacobian
    }

    fn solve(&self, mut trial: Trial) -> Result<Trim, Failure> {
        let unknown = self.unknown();
        let mut residual = self.residual(&trial);
        let mut stuck = 0;
        for _ in 0..ITERATIONS {
            if self.worst(&residual).0 < 1e-3 * STEADY {
                break;
            }
            let wanted: Vec<f64> = residual.iter().map(|r| -r).collect();
            let mut change = self.jacobian(&trial, &unknown).solve(&wanted);
            let over = unknown.iter().zip(&change).fold(1.0, |over, (&i, change)| {
                let most = if i < OUTER { STEP_MAX[i] } else { max(0.3 * trial[i].abs(), 5.0) };
                max(over, change.abs() / most)
            });
            change.iter_mut().for_each(|change| *change /= over);
            let merit = self.merit(&residual);
            let mut part = 1.0;
            let better = loop {
                let mut moved = trial.clone();
                for (&i, change) in unknown.iter().zip(&change) {
                    moved[i] += part * change;
                }
                let left = self.residual(&moved);
                if self.merit(&left) < merit * (1.0 - 1e-3 * part) {
                    break Some((moved, left));
                }
                part *= 0.5;
                if part < 1e-3 {
                    break None;
                }
            };
            if let Some((moved, left)) = better {
                (trial, residual) = (moved, left);
            } else if self.worst(&residual).0 < STEADY || stuck == 3 {
                break;
            } else {
                // A fold or a kink: let the inner states find their way and try again from there.
                stuck += 1;
                let mut outer = [0.0; OUTER];
                outer.copy_from_slice(&trial[..OUTER]);
                for (&i, change) in self.outer.iter().zip(&change) {
                    outer[i] += 0.3 * change;
                }
                trial = self.settled(&outer, self.state(&outer, Some(&trial[OUTER..])));
                residual = self.residual(&trial);
            }
        }
        let (left, of) = self.worst(&residual);
        if left >= STEADY || left.is_nan() {
            return Err(Failure::Unsteady { residual: left, of });
        }
        self.finish(&trial, left)
    }

    /// The state of a trial that is steady, with lever and governor where they belong.
    fn finish(&self, trial: &Trial, residual: f64) -> Result<Trim, Failure> {
        let (aircraft, world) = (self.aircraft, &self.target.world);
        let mut state = self.state(trial, Some(&trial[OUTER..]));
        let lever_norm = match self.target.power {
            Power::Lever(lever_norm) => lever_norm,
            Power::Climb(_) => self.lever(&state),
        };
        state.cockpit.collective_norm = lever_norm;
        self.set_controls(&mut state, trial[COLLECTIVE]);
        let (next, outputs) = step::heading(aircraft, &state, world);
        state.rate = next.rate;
        state.rate.motion.acceleration_mps2 =
            a_tick_before(next.rate.motion.acceleration_mps2, self.target.turn_radps);
        let state = state.without_negative_zeros();
        let report = Report::new(aircraft, &state, &outputs, residual);
        let trim = Trim { state, outputs, report };
        let power_w_per_s = next.rate.engines.power_w_per_s;
        match beyond(aircraft, self.torque_n_m_max, &trim, power_w_per_s) {
            Some((what, wanted_norm)) => {
                Err(Failure::Beyond { what, wanted_norm, trim: Box::new(trim) })
            }
            None => Ok(trim),
        }
    }

    /// The lever that keeps the engines' power, or the stop that is nearest to it.
    fn lever(&self, state: &State) -> f64 {
        let gains = |lever_norm: f64| {
            let mut at = *state;
            at.actuators.lever_norm = lever_norm;
            let rate = step::heading(self.aircraft, &at, &self.target.world).0.rate.engines;
            if self.running.right { rate.power_w_per_s.right } else { rate.power_w_per_s.left }
        };
        if !self.running.left && !self.running.right {
            return 0.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        if gains(high) < 0.0 {
            return high;
        }
        if gains(low) > 0.0 {
            return low;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if gains(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// What the aircraft cannot do of a steady flight, and how much is asked of it.
fn beyond(
    aircraft: &Aircraft,
    torque_n_m_max: f64,
    trim: &Trim,
    power_w_per_s: Pair<f64>,
) -> Option<(&'static str, f64)> {
    let (state, report) = (&trim.state, &trim.report);
    let pilot = &state.cockpit;
    let engine_w = max(state.plant.engines.left.power_w, state.plant.engines.right.power_w);
    let lag_w = max(-power_w_per_s.left, -power_w_per_s.right) * aircraft.engines.lag_s;
    if lag_w > 1e-3 * aircraft.engines.rated_power_w {
        return Some(("engine power", engine_w / max(engine_w - lag_w, 1.0)));
    }
    if -lag_w > 1e-3 * aircraft.engines.rated_power_w {
        return Some(("idle power", engine_w / (engine_w - lag_w)));
    }
    // The engines give up to this in a hurry; what a mast may bear for long is for the pilot to mind.
    let torque_norm = engine_w / max(state.plant.rotor_speed_radps, 1.0) / torque_n_m_max;
    if torque_norm > engines::TORQUE_NORM_MAX {
        return Some(("mast torque", torque_norm));
    }
    for (what, norm) in [
        ("longitudinal stick", pilot.stick_aft_norm),
        ("lateral stick", pilot.stick_right_norm),
        ("pedals", pilot.pedal_right_norm),
    ] {
        if norm.abs() > 1.0 {
            return Some((what, norm.abs()));
        }
    }
    let governor = &aircraft.fcc.governor;
    let lowest_rad = governor.collective_rad_min.at(state.actuators.mast_tilt_rad.mean());
    let (low, high) = (lowest_rad, governor.collective_rad_max);
    if report.collective_rad < low - 1e-9 || report.collective_rad > high + 1e-9 {
        return Some((
            "collective",
            report.collective_rad / if report.collective_rad < low { low } else { high },
        ));
    }
    (trim.outputs.landing_gear.main.right.push_n > 0.0).then_some(("height over the ground", 1.0))
}

/// u̇ and ω̇ in body axes of a state whose rates are in `next`.
pub(crate) fn accelerations(state: &State, next: &State) -> [f64; 6] {
    let body_from_ned = state.plant.attitude.ned_from_body().inverse();
    let rate = &next.rate.motion;
    let omega = state.plant.angular_rate_radps;
    let along: Vec3<Body> = body_from_ned * rate.acceleration_mps2
        - omega.cross(body_from_ned * state.plant.velocity_mps);
    let turn = rate.angular_acceleration_radps2;
    [along.x, along.y, along.z, turn.x, turn.y, turn.z]
}

/// An acceleration that turns with the aircraft, a tick before: what the integration remembers.
fn a_tick_before(acceleration_mps2: Vec3<Ned>, turn_radps: f64) -> Vec3<Ned> {
    let (s, c) = (sin(turn_radps * STEP_S), cos(turn_radps * STEP_S));
    let Vec3 { x, y, z, .. } = acceleration_mps2;
    Vec3::new(c * x + s * y, c * y - s * x, z)
}

/// ω of a steady turn.
fn turning(turn_radps: f64, pitch_rad: f64, roll_rad: f64) -> Vec3<Body> {
    Vec3::new(
        -turn_radps * sin(pitch_rad),
        turn_radps * sin(roll_rad) * cos(pitch_rad),
        turn_radps * cos(roll_rad) * cos(pitch_rad),
    )
}

/// ψ less the track's direction, so that the air comes from the right with `from_right_mps`.
fn heading_off_track(
    pitch_rad: f64,
    roll_rad: f64,
    level_mps: f64,
    down_mps: f64,
    from_right_mps: f64,
) -> f64 {
    // v = a·cos ψ − b·sin ψ + c
    let a = level_mps * sin(roll_rad) * sin(pitch_rad);
    let b = level_mps * cos(roll_rad);
    let c = down_mps * sin(roll_rad) * cos(pitch_rad);
    let length = sqrt(square(a) + square(b));
    if length < 1e-9 {
        return 0.0;
    }
    atan2(a, b) - asin((from_right_mps - c) / length)
}

impl Report {
    fn new(aircraft: &Aircraft, state: &State, outputs: &Outputs, residual: f64) -> Self {
        let travel = &aircraft.fcc.travel;
        let (pilot, surfaces) = (&state.cockpit, &state.actuators);
        let airspeed_mps = outputs.airspeed_mps;
        // A standing aircraft meets the air from nowhere.
        let moving = |angle_rad: f64| if airspeed_mps < 0.01 { 0.0 } else { angle_rad };
        Self {
            pitch_rad: outputs.euler.pitch_rad,
            roll_rad: outputs.euler.roll_rad,
            alpha_rad: moving(outputs.alpha_rad),
            beta_rad: moving(outputs.beta_rad),
            climb_mps: -state.plant.velocity_mps.z,
            stick_from_aft_m: travel.longitudinal_stick_m * (1.0 - pilot.stick_aft_norm),
            stick_forward_norm: 0.5 * (1.0 - pilot.stick_aft_norm),
            stick_right_m: travel.lateral_stick_m * pilot.stick_right_norm,
            pedal_right_m: travel.pedal_m * pilot.pedal_right_norm,
            lever_norm: pilot.collective_norm,
            collective_rad: surfaces.collective_rad.mean(),
            cyclic_forward_rad: surfaces.cyclic_forward_rad.mean(),
            elevator_rad: surfaces.elevator_rad,
            thrust_n: outputs.rotors.map(|rotor| rotor.thrust_n),
            power_w: outputs.rotors.map(|rotor| rotor.power_w).sum(),
            available_w: 2.0 * outputs.engines.available_w,
            torque_n_m: max(outputs.rotors.left.torque_n_m, outputs.rotors.right.torque_n_m),
            fuel_flow_kg_per_s: outputs.engines.fuel_flow_kg_per_s,
            download_n: outputs.loads.wing_pylon.sum().force_n.z,
            residual,
        }
    }
}

/// The reference model counts collective at the root of its linearly twisted blade:
/// θ_root = θ¾ + 30.75°, rad.
pub const ROOT_FROM_THREE_QUARTERS_RAD: f64 = 30.75 * PI / 180.0;
