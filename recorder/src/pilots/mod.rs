//! Pilot models: they look at the aircraft, and move a virtual stick, lever, pedals and thumb switches.
//!
//! What they send are raw device events of the device that the cockpit map calls `pilot`: the path
//! that hardware takes. They move their hands fifty times a second, and know nothing of the aircraft
//! but what windows, dials and seat tell, and the numbers of its handbook.

mod autorotation;
mod device;
mod flying;
mod habits;
mod handbook;
mod order;
mod phase;
mod plan;
mod skill;
mod sweep;

use engine::cockpit::{self, AxisControl};
use engine::outputs::Validity;
use engine::{Aircraft, Outputs, STEP_S};

use autorotation::{Autorotation, engines_are_out};
pub use device::{DEVICE, VirtualDevice};
use handbook::Handbook;
use order::{Nacelles, Order};
use phase::Phase;
use plan::plan;
pub use plan::{PILOTS, lands};
use skill::{HAND_TICKS, Observation, Positions, Skill};
use sweep::Steady;

use crate::controller::{Controller, GaveUp, TickContext};

/// Higher than this it has flown, m.
const FLOWN_M: f64 = 5.0;
/// Masts that are tilted less are those of a helicopter, rad.
const UPRIGHT_RAD: f64 = 0.1;
/// Part of the weight on the wheels with which it stands, and with which it has come down unasked.
const STANDS_NORM: f64 = 0.5;
const DOWN_NORM: f64 = 0.7;
/// A pilot model: a list of phases, flown one after the other.
pub struct Pilot {
    device: VirtualDevice,
    handbook: Handbook,
    name: &'static str,
    phases: Vec<(&'static str, Phase)>,
    at: usize,
    since_tick: u64,
    order: Order,
    skill: Skill,
    started: bool,
    touched_tick: Option<u64>,
    /// It has been in the air.
    flown: bool,
    /// Its plan ends on the ground.
    lands: bool,
    /// Why its task cannot be flown to the end.
    failed: Option<GaveUp>,
    /// The thumb on the nacelle switch: −1 forward, 0 off it, 1 aft.
    thumb: i8,
    /// When the other hand last moved a handle.
    handle_tick: u64,
    /// The flight about which it sweeps.
    steady: Option<Steady>,
    /// The way down without engines.
    autorotation: Autorotation,
}

impl Pilot {
    /// The pilot model of that name for an aircraft, its hands on the map's virtual device.
    pub fn named(name: &str, map: &cockpit::Params, aircraft: &Aircraft) -> Option<Self> {
        let (name, _) = PILOTS.into_iter().find(|(known, _)| *known == name)?;
        Some(Self {
            device: VirtualDevice::of(map)?,
            handbook: Handbook::of(aircraft),
            name,
            phases: plan(name, true)?,
            at: 0,
            since_tick: 0,
            order: Order::default(),
            skill: Skill::default(),
            started: false,
            touched_tick: None,
            flown: false,
            lands: lands(name),
            failed: None,
            thumb: 0,
            handle_tick: 0,
            steady: None,
            autorotation: Autorotation::default(),
        })
    }

    /// Names of its phases, in order, for a flight that begins on the wheels.
    pub fn phases(&self) -> Vec<&'static str> {
        self.phases.iter().map(|(name, _)| *name).collect()
    }

    /// Who stands on the ground after a flight, wanted or not, has landed: a stopped engine may not let
    /// an aircraft hover. Its task is given up with it.
    fn give_up_flying(&mut self, seen: &Outputs, tick: u64) {
        let eyes = Observation::look(seen);
        self.flown |= seen.height_above_ground_m > FLOWN_M;
        let landing = |phase: &(&str, Phase)| phase.1.ends_on_wheels();
        let down = eyes.on_wheels_norm > DOWN_NORM || seen.validity.contains(Validity::HULL);
        if !(self.flown && down) || self.phases.get(self.at).is_none_or(landing) {
            return;
        }
        self.give_up("the aircraft is on the ground");
        self.phases.truncate(self.at + 1);
        self.phases.push(("on the ground", Phase::Land));
        self.at += 1;
        self.since_tick = tick;
        self.touched_tick = Some(tick);
    }

    /// Who only wants to land does so without engines, too, once the masts are upright.
    fn autorotate(&mut self, seen: &Outputs, tick: u64) {
        let upright = seen.actuators.mast_tilt_rad.mean() < UPRIGHT_RAD;
        let flies = seen.height_above_ground_m > FLOWN_M;
        let phase = self.phases.get(self.at).map(|(_, phase)| *phase);
        if self.name != "land"
            || !(flies && upright && engines_are_out(seen))
            || phase.is_none_or(|phase| phase == Phase::Autorotate)
        {
            return;
        }
        self.phases.truncate(self.at + 1);
        self.phases.push(("autorotation", Phase::Autorotate));
        self.at += 1;
        self.since_tick = tick;
        self.order.gear_down = true;
        self.order.nacelles = Nacelles::Autorotation;
        self.order.run_on = true;
    }

    /// The phase under way cannot be flown to its end; the first reason is the one that is told.
    fn give_up(&mut self, why: &'static str) {
        let phase = self.phases.get(self.at).map_or("", |(name, _)| name);
        let number = self.at as u64 + 1;
        self.failed.get_or_insert(GaveUp { number, phase, why });
    }

    /// Keeps the flight in which the sweeps began, and sweeps; no other hand moves.
    fn sweep(&mut self, phase: Phase, seen: &Outputs, since_s: f64) -> Positions {
        let steady = *self.steady.get_or_insert_with(|| Steady::of(seen));
        let sweep = match phase {
            Phase::Sweep { axis } => Some((axis, since_s)),
            _ => None,
        };
        steady.positions(seen, sweep, &self.handbook.pilot)
    }

    fn begin(&mut self, seen: &Outputs) {
        self.started = true;
        let on_wheels = Observation::look(seen).on_wheels_norm > STANDS_NORM;
        self.phases = plan(self.name, on_wheels).unwrap_or_default();
        self.skill = Skill::taking_over(seen);
        self.order = Order::beginning(seen);
    }
}

impl Controller for Pilot {
    fn act(&mut self, seen: &Outputs, context: &mut TickContext<'_>) {
        if !context.tick.is_multiple_of(HAND_TICKS) {
            return;
        }
        if !self.started {
            self.begin(seen);
        }
        self.give_up_flying(seen, context.tick);
        self.autorotate(seen, context.tick);
        if seen.validity.intersects(Validity::HULL | Validity::FROZEN) {
            self.give_up("the aircraft is a wreck");
        }
        let Some(&(name, phase)) = self.phases.get(self.at) else {
            *context.gave_up = self.failed;
            *context.done = true;
            return;
        };
        *context.phase = (self.at as u64 + 1, name);
        let since_s = (context.tick - self.since_tick) as f64 * STEP_S;
        let over = self.give_orders(phase, seen, since_s, context);
        let to = match phase {
            Phase::Steady { .. } | Phase::Sweep { .. } => self.sweep(phase, seen, since_s),
            _ => self.positions(phase, seen, context.tick),
        };
        self.device.set(context, AxisControl::StickAft, to.stick_aft_norm);
        self.device.set(context, AxisControl::StickRight, to.stick_right_norm);
        self.device.set(context, AxisControl::PedalRight, to.pedal_right_norm);
        self.device.set(context, AxisControl::Collective, to.lever_norm);
        if self.order.run_on {
            let brake_norm = self.brake(seen);
            self.device.set(context, AxisControl::BrakeLeft, brake_norm);
            self.device.set(context, AxisControl::BrakeRight, brake_norm);
        }
        if self.steady.is_none() {
            self.switches(seen, context);
        }
        if over {
            self.at += 1;
            self.since_tick = context.tick;
            self.order.turned_rad = 0.0;
        } else if since_s > phase.patience_s() {
            self.give_up("it takes too long");
            *context.gave_up = self.failed;
            *context.done = true;
        }
    }
}
