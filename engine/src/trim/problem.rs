//! What is unknown of a steady flight, and what must vanish in it.

use alloc::string::String;
use alloc::vec::Vec;

use super::inner::{accelerations, inner_states, numbers, set_numbers, settle};
use super::{Failure, Power, Target, Trim, Unlimited};
use crate::fcc::{governor, mixer, scas};
use crate::frames::{Attitude, Body, Euler, Ned, Vec3};
use crate::inputs::failures;
use crate::math::{asin, atan2, clamp, cos, max, sin, sqrt, square};
use crate::pair::Pair;
use crate::state::State;
use crate::{Aircraft, STEP_S, actuators, cockpit, engines, fcc, step};

/// What the trial values are, in their order; lateral ones only where flight is not symmetric.
const PITCH: usize = 0;
const STICK_AFT: usize = 1;
pub(super) const COLLECTIVE: usize = 2;
const POWER: usize = 3;
const CLIMB: usize = 4;
const ROLL: usize = 5;
const STICK_RIGHT: usize = 6;
const PEDAL: usize = 7;
pub(super) const OUTER: usize = 8;

/// Ticks for which the inner states settle before the first iteration.
const SETTLING_TICKS: usize = 150;

pub(super) struct Problem<'a> {
    pub(super) aircraft: &'a Aircraft,
    pub(super) torque_n_m_max: f64,
    pub(super) target: &'a Target,
    symmetric: bool,
    pub(super) running: Pair<bool>,
    /// Which outer values and equations there are.
    pub(super) outer: Vec<usize>,
    pub(super) equations: Vec<usize>,
    /// Places of the inner states among the state's numbers.
    pub(super) inner: Vec<usize>,
    /// In symmetric flight the left inner states are those of the right: their places.
    twins: Vec<(usize, usize)>,
    pub(super) names: Vec<String>,
}

/// A trial: its values, inner states behind the outer ones.
pub(super) type Trial = Vec<f64>;

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
    pub(super) fn guess(&self, pitch_rad: f64) -> Trial {
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
    pub(super) fn like(&self, near: &Trim) -> Trial {
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
    pub(super) fn settled(&self, outer: &[f64; OUTER], state: State) -> Trial {
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
    pub(super) fn state(&self, trial: &[f64], inner: Option<&[f64]>) -> State {
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
    pub(super) fn set_controls(&self, state: &mut State, collective_rad: f64) {
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
        let feed_forward_rad =
            aircraft.fcc.governor.feed_forward_rad(sensed.mast_tilt_rad, from_lever_rad);
        let correction_rad = collective_rad - feed_forward_rad;
        let reference_radps = state.plant.rotor_speed_radps;
        let governor =
            governor::State { reference_radps, integral_rad: correction_rad, correction_rad };
        state.fcc = fcc::State { scas: centred, governor };
    }

    /// What must vanish: the outer equations, then the inner rates.
    pub(super) fn residual(&self, trial: &Trial) -> Vec<f64> {
        let state = self.state(trial, Some(&trial[OUTER..]));
        let mut lever = state;
        if let Power::Lever(lever_norm) = self.target.power {
            lever.actuators.lever_norm = lever_norm;
        }
        let next = step::derivatives(self.aircraft, &lever, &self.target.world).0;
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
