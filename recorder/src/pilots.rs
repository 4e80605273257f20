//! Pilot models: they look at the aircraft, and move a virtual stick, lever and pedals.
//!
//! What they send are raw device events of the device that the cockpit map calls `pilot`: the path
//! that hardware takes. They move their hands fifty times a second.

use engine::cockpit::{self, AxisControl, ButtonControl};
use engine::frames::{Ned, Vec3};
use engine::inputs::EventKind;
use engine::math::{clamp, cos, sin, wrap_angle};
use engine::{Outputs, STEP_S};

use crate::hands::{Hands, Reach};

/// Name of the device in the cockpit map that pilot models and scripts use.
pub const DEVICE: &str = "pilot";

/// Ticks between two movements.
const HAND_TICKS: u64 = 5;
/// Time between two movements, s.
const HAND_S: f64 = HAND_TICKS as f64 * STEP_S;

/// A device that exists in the map only: moves controls by sending what a real one would send.
pub struct VirtualDevice {
    number: u64,
    device: cockpit::Device,
    sent: Vec<(u64, i64)>,
}

impl VirtualDevice {
    /// The device called [`DEVICE`], if the map has it.
    pub fn of(map: &cockpit::Params) -> Option<Self> {
        let number = map.device.iter().position(|device| device.name == DEVICE)?;
        Some(Self { number: number as u64, device: map.device[number].clone(), sent: Vec::new() })
    }

    /// Moves an axis to a position (−1..1, or 0..1 for lever and brakes), if it is not there yet.
    pub fn set(&mut self, reach: &mut Reach<'_>, control: AxisControl, position_norm: f64) {
        let Some(axis) = self.device.axis.iter().find(|axis| axis.control == control) else {
            return;
        };
        let (low, high) = (axis.raw_min.unwrap_or(-32767), axis.raw_max.unwrap_or(32767));
        let from_end = matches!(
            control,
            AxisControl::Collective | AxisControl::BrakeLeft | AxisControl::BrakeRight
        );
        let travel = if from_end { position_norm } else { 0.5 * (position_norm + 1.0) };
        let travel = clamp(if axis.inverted { 1.0 - travel } else { travel }, 0.0, 1.0);
        let raw = low + (travel * (high - low) as f64).round() as i64;
        match self.sent.iter_mut().find(|(code, _)| *code == axis.code) {
            Some((_, sent)) if *sent == raw => return,
            Some((_, sent)) => *sent = raw,
            None => self.sent.push((axis.code, raw)),
        }
        reach.send(self.number, EventKind::Axis, axis.code, raw);
    }

    /// Presses or releases a button.
    pub fn press(&self, reach: &mut Reach<'_>, control: ButtonControl, pressed: bool) {
        if let Some(button) = self.device.button.iter().find(|button| button.control == control) {
            reach.send(self.number, EventKind::Button, button.code, i64::from(pressed));
        }
    }
}

/// Lever position the pilot has in mind to lift off.
const LIFT_LEVER_NORM: f64 = 0.3;
/// How fast the lever goes down after touchdown, 1/s.
const LOWER_PER_S: f64 = 0.3;
/// From touchdown to the end of the flight, s.
const SETTLE_S: f64 = 4.0;

/// What the pilot wants to hold.
#[derive(Clone, Copy, Debug)]
struct Aim {
    forward_mps: f64,
    right_mps: f64,
    climb_mps: f64,
    heading_rad: f64,
}

/// Hand–eye coordination of a helicopter pilot: speeds by attitude, height by lever, heading by
/// pedals.
#[derive(Clone, Copy, Debug, Default)]
struct Skill {
    pitch_trim_norm: f64,
    roll_trim_norm: f64,
    pedal_trim_norm: f64,
    lever_norm: f64,
    pitch_level_rad: f64,
    roll_level_rad: f64,
}

/// Stick, lever and pedals.
#[derive(Clone, Copy, Debug, Default)]
struct Positions {
    stick_aft_norm: f64,
    stick_right_norm: f64,
    pedal_right_norm: f64,
    lever_norm: f64,
}

impl Skill {
    fn fly(&mut self, seen: &Outputs, aim: &Aim) -> Positions {
        let heading = seen.euler.heading_rad;
        let v = seen.velocity_mps;
        let forward_off = aim.forward_mps - (v.x * cos(heading) + v.y * sin(heading));
        let right_off = aim.right_mps - (v.y * cos(heading) - v.x * sin(heading));
        let rate = seen.angular_rate_radps;

        // Nose down to go faster; what is always needed becomes the level attitude.
        self.pitch_level_rad =
            clamp(self.pitch_level_rad - 0.004 * forward_off * HAND_S, -0.25, 0.25);
        let pitch_rad = clamp(self.pitch_level_rad - 0.04 * forward_off, -0.25, 0.25);
        self.roll_level_rad = clamp(self.roll_level_rad + 0.004 * right_off * HAND_S, -0.2, 0.2);
        let roll_rad = clamp(self.roll_level_rad + 0.04 * right_off, -0.25, 0.25);

        let pitch_off = pitch_rad - seen.euler.pitch_rad;
        self.pitch_trim_norm = clamp(self.pitch_trim_norm + 0.6 * pitch_off * HAND_S, -0.8, 0.8);
        let roll_off = roll_rad - seen.euler.roll_rad;
        self.roll_trim_norm = clamp(self.roll_trim_norm + 0.4 * roll_off * HAND_S, -0.5, 0.5);
        let heading_off = wrap_angle(aim.heading_rad - heading);
        self.pedal_trim_norm = clamp(self.pedal_trim_norm + 0.3 * heading_off * HAND_S, -0.6, 0.6);

        let climb_off = aim.climb_mps + v.z;
        self.lever_norm = clamp(self.lever_norm + 0.04 * climb_off * HAND_S, 0.0, 1.0);
        Positions {
            stick_aft_norm: self.pitch_trim_norm + 1.6 * pitch_off - 1.0 * rate.y,
            stick_right_norm: self.roll_trim_norm + 0.9 * roll_off - 0.5 * rate.x,
            pedal_right_norm: self.pedal_trim_norm + 1.5 * heading_off - 0.8 * rate.z,
            lever_norm: clamp(self.lever_norm + 0.08 * climb_off, 0.0, 1.0),
        }
    }
}

/// One part of a pilot's flight.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Stands, brakes set.
    Wait { seconds: f64 },
    /// Straight up from the ground to a height over it.
    Climb { height_m: f64, climb_mps: f64 },
    /// Turns over a spot, right positive.
    Turn { by_rad: f64, rate_radps: f64 },
    /// Accelerates or decelerates along the heading.
    Speed { forward_mps: f64, at_mps2: f64 },
    /// Keeps what it has.
    Hold { seconds: f64 },
    /// Descends onto the wheels and lowers the lever.
    Land,
    /// Presses the marker.
    Mark,
}

/// A pilot model: a list of phases, flown one after the other.
pub struct Pilot {
    device: VirtualDevice,
    phases: Vec<(&'static str, Phase)>,
    at: usize,
    since_tick: u64,
    /// What the phases have asked for so far.
    forward_mps: f64,
    heading_rad: f64,
    turned_rad: f64,
    height_m: f64,
    /// Where it hovers.
    spot_m: Option<Vec3<Ned>>,
    skill: Skill,
    touched_tick: Option<u64>,
    started: bool,
}

/// Names of the pilot models, each with what it flies.
pub const PILOTS: [(&str, &str); 2] = [
    ("hover", "lifts off, hovers at 10 m and keeps hovering"),
    ("demo", "vertical take-off, climb, hover turn, dash to 60 kt, landing"),
];

/// One knot, m/s.
const KNOT_MPS: f64 = 1852.0 / 3600.0;

impl Pilot {
    /// The pilot model of that name, its hands on the map's virtual device.
    pub fn named(name: &str, map: &cockpit::Params) -> Option<Self> {
        let quarter = engine::math::FRAC_PI_2;
        let phases = match name {
            "hover" => vec![
                ("on the ground", Phase::Wait { seconds: 1.0 }),
                ("take-off", Phase::Climb { height_m: 10.0, climb_mps: 1.5 }),
                ("hover", Phase::Hold { seconds: f64::INFINITY }),
            ],
            "demo" => vec![
                ("on the ground", Phase::Wait { seconds: 2.0 }),
                ("take-off", Phase::Climb { height_m: 8.0, climb_mps: 1.5 }),
                ("climb", Phase::Climb { height_m: 30.0, climb_mps: 3.0 }),
                ("hover turn", Phase::Turn { by_rad: -2.0 * quarter, rate_radps: 0.25 }),
                ("hover", Phase::Hold { seconds: 3.0 }),
                ("marker", Phase::Mark),
                ("dash to 60 kt", Phase::Speed { forward_mps: 60.0 * KNOT_MPS, at_mps2: 2.0 }),
                ("60 kt", Phase::Hold { seconds: 4.0 }),
                ("deceleration", Phase::Speed { forward_mps: 0.0, at_mps2: 1.5 }),
                ("hover", Phase::Hold { seconds: 2.0 }),
                ("landing", Phase::Land),
            ],
            _ => return None,
        };
        Some(Self {
            device: VirtualDevice::of(map)?,
            phases,
            at: 0,
            since_tick: 0,
            forward_mps: 0.0,
            heading_rad: 0.0,
            turned_rad: 0.0,
            height_m: 0.0,
            spot_m: None,
            skill: Skill::default(),
            touched_tick: None,
            started: false,
        })
    }

    /// Names of its phases, in order.
    pub fn phases(&self) -> Vec<&'static str> {
        self.phases.iter().map(|(name, _)| *name).collect()
    }

    /// The phase's orders for this moment, and whether it is over.
    fn order(&mut self, phase: Phase, seen: &Outputs, reach: &mut Reach<'_>) -> bool {
        let since_s = (reach.tick - self.since_tick) as f64 * STEP_S;
        match phase {
            Phase::Wait { seconds } | Phase::Hold { seconds } => since_s >= seconds,
            Phase::Climb { height_m, climb_mps } => {
                let step_m = climb_mps * HAND_S;
                self.height_m += clamp(height_m - self.height_m, -step_m, step_m);
                (seen.height_above_ground_m - height_m).abs() < 1.0
            }
            Phase::Turn { by_rad, rate_radps } => {
                let left_rad = by_rad - self.turned_rad;
                let step_rad = clamp(left_rad, -rate_radps * HAND_S, rate_radps * HAND_S);
                self.turned_rad += step_rad;
                self.heading_rad = wrap_angle(self.heading_rad + step_rad);
                let off_rad = wrap_angle(self.heading_rad - seen.euler.heading_rad);
                left_rad.abs() < 1e-9 && off_rad.abs() < 0.05
            }
            Phase::Speed { forward_mps, at_mps2 } => {
                let off_mps = forward_mps - self.forward_mps;
                let step_mps = at_mps2 * HAND_S;
                self.forward_mps += clamp(off_mps, -step_mps, step_mps);
                off_mps.abs() < 1e-9 && (seen.body_velocity_mps.x - forward_mps).abs() < 1.0
            }
            Phase::Land => self
                .touched_tick
                .is_some_and(|touched| (reach.tick - touched) as f64 * STEP_S > SETTLE_S),
            Phase::Mark => {
                self.device.press(reach, ButtonControl::Marker, true);
                self.device.press(reach, ButtonControl::Marker, false);
                true
            }
        }
    }

    /// Speeds that serve the orders, and hold the spot when there is one.
    fn aim(&mut self, phase: Phase, seen: &Outputs) -> Aim {
        let climb_mps = if phase == Phase::Land {
            -clamp(0.3 * (seen.height_above_ground_m - 2.0), 0.4, 1.5)
        } else {
            clamp(0.8 * (self.height_m - seen.height_above_ground_m), -2.5, 2.5)
        };
        let hovering = self.forward_mps == 0.0 && seen.velocity_mps.norm() < 4.0;
        let (mut forward_mps, mut right_mps) = (self.forward_mps, 0.0);
        if hovering {
            let spot_m = *self.spot_m.get_or_insert(seen.position_m);
            let off = spot_m - seen.position_m;
            let (s, c) = (sin(seen.euler.heading_rad), cos(seen.euler.heading_rad));
            forward_mps = clamp(0.25 * (off.x * c + off.y * s), -1.5, 1.5);
            right_mps = clamp(0.25 * (off.y * c - off.x * s), -1.5, 1.5);
        } else {
            self.spot_m = None;
        }
        Aim { forward_mps, right_mps, climb_mps, heading_rad: self.heading_rad }
    }

    /// Stick, lever and pedals for this moment.
    fn positions(&mut self, phase: Phase, seen: &Outputs, tick: u64) -> Positions {
        let on_ground = matches!(phase, Phase::Wait { .. });
        if phase == Phase::Land && seen.landing_gear.main.map(|leg| leg.push_n).sum() > 0.0 {
            self.touched_tick.get_or_insert(tick);
        }
        if on_ground {
            return Positions::default();
        }
        if self.touched_tick.is_some() {
            // Down: lets the stick go and lowers the lever.
            let lever_norm = self.skill.lever_norm - LOWER_PER_S * HAND_S;
            self.skill.lever_norm = clamp(lever_norm, 0.0, 1.0);
            return Positions { lever_norm: self.skill.lever_norm, ..Positions::default() };
        }
        let aim = self.aim(phase, seen);
        self.skill.fly(seen, &aim)
    }
}

impl Hands for Pilot {
    fn act(&mut self, seen: &Outputs, reach: &mut Reach<'_>) {
        if !reach.tick.is_multiple_of(HAND_TICKS) {
            return;
        }
        if !self.started {
            self.started = true;
            self.heading_rad = seen.euler.heading_rad;
            self.height_m = seen.height_above_ground_m;
            self.skill.pitch_level_rad = seen.euler.pitch_rad;
            self.skill.lever_norm = LIFT_LEVER_NORM;
        }
        let Some(&(name, phase)) = self.phases.get(self.at) else {
            *reach.done = true;
            return;
        };
        *reach.phase = (self.at as u64 + 1, name);
        let over = self.order(phase, seen, reach);
        let to = self.positions(phase, seen, reach.tick);
        self.device.set(reach, AxisControl::StickAft, to.stick_aft_norm);
        self.device.set(reach, AxisControl::StickRight, to.stick_right_norm);
        self.device.set(reach, AxisControl::PedalRight, to.pedal_right_norm);
        self.device.set(reach, AxisControl::Collective, to.lever_norm);
        if over {
            self.at += 1;
            self.since_tick = reach.tick;
            self.turned_rad = 0.0;
        }
    }
}
