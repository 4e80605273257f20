//! What a pilot model does in each part of a flight.

use engine::cockpit::ButtonControl;
use engine::frames::{Ned, Vec3};
use engine::math::{FRAC_PI_2, atan2, clamp, cos, max, min, sin, sqrt, wrap_angle};
use engine::units::KNOT_MPS;
use engine::{Outputs, STEP_S};

use super::skill::{Aim, HAND_S, Observation, Positions};
use super::sweep::{self, Axis};
use super::{Pilot, bearing};
use crate::controller::TickContext;

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
    /// Accelerates as a helicopter, climbing to a height.
    Accelerate { knots: f64, height_m: f64 },
    /// Tilts the nacelles down through the corridor and reaches a speed.
    Convert { knots: f64 },
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
            Self::Stop { .. } | Self::Approach { .. } => 300.0,
            _ => 120.0,
        }
    }
}

/// Which way the nacelles are to go.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Nacelles {
    #[default]
    Stay,
    Forward,
    Aft,
    Autorotation,
}

/// What the phases have asked for so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Order {
    forward_mps: f64,
    over_ground: bool,
    forward_mps2: f64,
    forward_mps2_max: f64,
    height_m: f64,
    climb_mps_max: f64,
    sink_mps_max: f64,
    heading_rad: f64,
    bank_rad_max: f64,
    pub nacelles: Nacelles,
    pub gear_down: bool,
    /// It lands with speed, because one engine does not let it hover.
    pub run_on: bool,
    /// Where it hovers.
    spot_m: Option<Vec3<Ned>>,
    /// Forward and to the right, on the way to what a phase of sidling wants.
    sidle_mps: [f64; 2],
    start_m: Vec3<Ned>,
    start_heading_rad: f64,
    /// Calibrated airspeed as the pilot reads it, m/s.
    airspeed_mps: f64,
    pub turned_rad: f64,
}

impl Order {
    /// To any side, no faster than hands would ask for.
    fn sidle(&mut self, wanted_mps: [f64; 2]) {
        let step_mps = SIDLE_MPS2 * HAND_S;
        for (now, wanted) in self.sidle_mps.iter_mut().zip(wanted_mps) {
            *now += clamp(wanted - *now, -step_mps, step_mps);
        }
        self.forward_mps = 0.0;
        self.spot_m = None;
    }

    /// What the flight is when it begins.
    pub fn beginning(seen: &Outputs) -> Self {
        Self {
            forward_mps: if seen.airspeed_mps > 20.0 { seen.airspeed_mps } else { 0.0 },
            forward_mps2_max: 1.5,
            height_m: seen.height_above_ground_m,
            climb_mps_max: 2.5,
            sink_mps_max: 2.5,
            heading_rad: seen.euler.heading_rad,
            bank_rad_max: 0.5,
            gear_down: seen.cockpit.gear_down != 0,
            start_m: seen.position_m,
            start_heading_rad: seen.euler.heading_rad,
            airspeed_mps: seen.calibrated_airspeed_mps,
            ..Self::default()
        }
    }
}

/// Distance inside the corridor that the pilot keeps, m/s: 8 kt.
const CORRIDOR_MPS: f64 = 8.0 * KNOT_MPS;
/// The nacelles' way from the decision to the next one, rad: four degrees.
const AHEAD_RAD: f64 = 0.07;
/// Rotor speed of a conversion, rad/s: 589 rpm.
const ROTOR_RADPS: f64 = 61.68;
/// Part of it by which the rotors may be off while the nacelles move.
const ROTORS_OFF_MAX: f64 = 0.05;
/// Nearer to an end than this the nacelles are there, rad.
const END_RAD: f64 = 0.003;
/// Mast tilt of an autorotation: nacelles at 95° (TM-81244), rad.
const AUTOROTATION_RAD: f64 = -0.087;
/// Deceleration of an approach, m/s².
const APPROACH_MPS2: f64 = 1.4;
/// Over the ground where one engine does not let it hover, m/s: 35 kt.
const RUN_ON_MPS: f64 = 35.0 * KNOT_MPS;
/// Part of an engine's power that the other one is left with when it is out.
const OUT_NORM: f64 = 0.1;
/// How hard it brakes after a landing with speed.
const BRAKE_NORM: f64 = 0.4;
/// How fast it picks up speed to the side or back, m/s².
const SIDLE_MPS2: f64 = 1.0;
/// Slowest descent from high up, m/s.
const DESCENT_MPS: f64 = 28.0;
/// How fast the lever goes down after touchdown, 1/s.
const LOWER_PER_S: f64 = 0.3;
/// From touchdown to the end of the flight, s.
const SETTLE_S: f64 = 5.0;
/// A run-on landing that is faster than this is still one, m/s, and for this long, s.
const ROLLING_MPS: f64 = 0.3;
const ROLL_S: f64 = 60.0;
/// The gear goes through its cycle below this calibrated airspeed only, m/s: 160 kt, less 10.
const GEAR_MPS_MAX: f64 = 150.0 * KNOT_MPS;
/// As an aeroplane flaps 20 below the first calibrated airspeed, flaps up above the second, m/s.
const FLAP_MPS: [f64; 2] = [145.0 * KNOT_MPS, 160.0 * KNOT_MPS];
/// Between two movements of flap lever and gear handle, s.
const HANDLE_S: f64 = 1.0;

impl Pilot {
    /// The phase's orders for this moment, and whether it is over.
    pub(super) fn give_orders(
        &mut self,
        phase: Phase,
        seen: &Outputs,
        since_s: f64,
        context: &mut TickContext<'_>,
    ) -> bool {
        let order = &mut self.order;
        order.airspeed_mps += HAND_S / 0.5 * (seen.calibrated_airspeed_mps - order.airspeed_mps);
        let tilt_rad = seen.actuators.mast_tilt_rad.mean();
        let height_m = seen.height_above_ground_m;
        match phase {
            Phase::Wait { seconds } | Phase::Hold { seconds } | Phase::Steady { seconds } => {
                since_s >= seconds
            }
            Phase::Sweep { .. } => since_s >= sweep::length_s(),
            Phase::Sidle { forward_mps, right_mps, seconds } => {
                order.sidle([forward_mps, right_mps]);
                since_s >= seconds
            }
            Phase::Rise { height_m: to_m, climb_mps } => {
                order.climb_mps_max = climb_mps;
                order.height_m = to_m;
                (height_m - to_m).abs() < 1.0
            }
            Phase::Mark => {
                self.device.tap(context, ButtonControl::Marker);
                true
            }
            Phase::Accelerate { knots, height_m: to_m } => {
                order.forward_mps = knots * KNOT_MPS;
                order.forward_mps2_max = 1.6;
                order.climb_mps_max = 4.0;
                order.height_m = to_m;
                // Wheels up once it climbs away.
                order.gear_down &= height_m < 15.0 || order.airspeed_mps < 20.0;
                order.airspeed_mps > (knots - 4.0) * KNOT_MPS && height_m > to_m - 10.0
            }
            Phase::Convert { knots } => {
                order.nacelles = Nacelles::Forward;
                order.forward_mps = knots * KNOT_MPS;
                order.forward_mps2_max = 3.0;
                order.climb_mps_max = 3.0;
                order.gear_down = false;
                tilt_rad > FRAC_PI_2 - END_RAD && order.airspeed_mps > (knots - 8.0) * KNOT_MPS
            }
            Phase::Climb { height_m: to_m } => {
                order.height_m = to_m;
                order.climb_mps_max = 7.0;
                height_m > to_m - 15.0
            }
            Phase::Circle { bank_rad } => {
                order.bank_rad_max = bank_rad;
                order.heading_rad = wrap_angle(seen.euler.heading_rad - 1.0);
                false
            }
            Phase::Home { bank_rad } => {
                order.bank_rad_max = bank_rad;
                let (to_rad, distance_m) = bearing(seen, order.start_m);
                let turned_rad = -seen.euler_rate.heading_radps * HAND_S;
                order.turned_rad += turned_rad;
                let off_rad = wrap_angle(to_rad - track_rad(seen));
                // Rolling out takes a second or two; half a circle at least, or the spot is behind.
                let lead_rad = -seen.euler_rate.heading_radps * 2.2;
                order.heading_rad = wrap_angle(seen.euler.heading_rad - 1.0);
                order.turned_rad > 2.5 && off_rad.abs() < lead_rad.abs() + 0.03 && distance_m > 1.0
            }
            Phase::Approach { height_m: to_m } => self.approach(seen, to_m),
            Phase::Stop { height_m: to_m } => self.stop(seen, to_m),
            Phase::FaceStart => {
                order.heading_rad = order.start_heading_rad;
                let off_rad = wrap_angle(order.start_heading_rad - seen.euler.heading_rad);
                off_rad.abs() < 0.05 && seen.angular_rate_radps.z.abs() < 0.03
            }
            Phase::Land | Phase::Autorotate => self.touched_tick.is_some_and(|touched| {
                let down_s = (context.tick - touched) as f64 * STEP_S;
                down_s > SETTLE_S && (seen.velocity_mps.norm() < ROLLING_MPS || down_s > ROLL_S)
            }),
        }
    }

    /// To the spot where the flight began.
    fn approach(&mut self, seen: &Outputs, height_m: f64) -> bool {
        let order = &mut self.order;
        let (to_rad, distance_m) = bearing(seen, order.start_m);
        let off_rad = wrap_angle(to_rad - track_rad(seen));
        let ahead_m = distance_m * cos(wrap_angle(to_rad - seen.euler.heading_rad));
        if distance_m > 150.0 && off_rad.abs() < 1.0 {
            order.heading_rad = wrap_angle(seen.euler.heading_rad + off_rad);
        }
        order.bank_rad_max = 0.5;
        // A constant deceleration ends over the spot.
        let slow_mps = sqrt(2.0 * APPROACH_MPS2 * max(0.0, ahead_m - 15.0));
        self.slow_down(seen, slow_mps);
        let order = &mut self.order;
        order.height_m = min(order.height_m, max(height_m, height_m + 0.07 * (ahead_m - 150.0)));
        let slow = seen.velocity_mps.norm() < 3.0 && ahead_m < 30.0;
        if slow || order.spot_m.is_some() {
            order.spot_m = Some(order.start_m);
        }
        let (_, distance_m) = bearing(seen, order.start_m);
        order.spot_m.is_some()
            && distance_m < 3.0
            && seen.velocity_mps.norm() < 1.0
            && (seen.height_above_ground_m - height_m).abs() < 1.5
            && self.is_helicopter(seen)
    }

    /// Straight ahead: down to a low height first, with speed, then to a hover there.
    fn stop(&mut self, seen: &Outputs, height_m: Option<f64>) -> bool {
        let height_m = height_m.unwrap_or(self.order.height_m);
        let high_m = seen.height_above_ground_m - height_m;
        let run_on = self.lands && one_engine_is_out(seen);
        self.order.run_on = run_on;
        // Out of its own wake an aircraft that flies may sink twice as fast as one that hovers.
        let least_mps = if high_m > 40.0 {
            DESCENT_MPS
        } else if run_on {
            RUN_ON_MPS
        } else {
            0.0
        };
        let slow_mps = max(least_mps, self.order.forward_mps - APPROACH_MPS2 * HAND_S);
        self.slow_down(seen, slow_mps);
        if run_on && self.order.forward_mps < RUN_ON_MPS + 0.1 {
            // It slows down no further.
            self.order.forward_mps2 = 0.0;
        }
        if self.is_helicopter(seen) {
            if high_m > 40.0 && seen.airspeed_mps > 0.8 * DESCENT_MPS {
                self.order.sink_mps_max = 5.0;
            }
            self.order.height_m = min(self.order.height_m, height_m);
        }
        let slow_enough_mps = if run_on { RUN_ON_MPS + 3.0 } else { 1.0 };
        seen.velocity_mps.norm() < slow_enough_mps
            && (seen.height_above_ground_m - height_m).abs() < 1.5
            && self.is_helicopter(seen)
    }

    /// A speed over the ground, no slower than the nacelles allow, which come aft meanwhile.
    fn slow_down(&mut self, seen: &Outputs, slow_mps: f64) {
        let order = &mut self.order;
        if slow_mps < Observation::look(seen).forward_mps + 3.0 {
            order.nacelles = Nacelles::Aft;
        }
        order.over_ground = true;
        order.forward_mps2_max = 2.0;
        order.climb_mps_max = 2.5;
        order.sink_mps_max = clamp(0.12 * seen.airspeed_mps, 2.5, 6.0);
        order.gear_down |= order.airspeed_mps < GEAR_MPS_MAX;
        let tilt_rad = seen.actuators.mast_tilt_rad.mean();
        let slowest_mps = self.corridor.slowest_mps(tilt_rad);
        let along_mps = Observation::look(seen).forward_mps;
        let keep_mps = if slowest_mps > 0.0 {
            slowest_mps + CORRIDOR_MPS - (order.airspeed_mps - along_mps)
        } else {
            0.0
        };
        order.forward_mps2 =
            if slow_mps < order.forward_mps + 0.1 && slow_mps > keep_mps && slow_mps > 3.0 {
                -APPROACH_MPS2
            } else {
                0.0
            };
        order.forward_mps = max(min(order.forward_mps, slow_mps), keep_mps);
    }

    fn is_helicopter(&self, seen: &Outputs) -> bool {
        seen.actuators.mast_tilt_rad.mean() < END_RAD
    }

    /// Speeds that serve the orders, and hold the spot when there is one.
    fn aim(&mut self, phase: Phase, seen: &Outputs) -> Aim {
        let eyes = Observation::look(seen);
        let order = &mut self.order;
        let climb_mps = if phase == Phase::Land {
            -clamp(0.3 * (seen.height_above_ground_m - 2.3), 0.4, 1.6)
        } else {
            let gain_per_s = if seen.airspeed_mps > 40.0 { 0.2 } else { 0.4 };
            let off_m = order.height_m - seen.height_above_ground_m;
            clamp(gain_per_s * off_m, -order.sink_mps_max, order.climb_mps_max)
        };
        if matches!(phase, Phase::Sidle { .. }) {
            let [forward_mps, right_mps] = order.sidle_mps;
            return Aim {
                forward_mps,
                right_mps,
                any_way: true,
                over_ground: true,
                forward_mps2_max: order.forward_mps2_max,
                climb_mps,
                heading_rad: order.heading_rad,
                ..Aim::default()
            };
        }
        let slow = seen.velocity_mps.norm() < 4.0;
        let hovering = order.spot_m.is_some() || (order.forward_mps == 0.0 && slow);
        let (mut forward_mps, mut right_mps) = (order.forward_mps, 0.0);
        if hovering && (order.forward_mps == 0.0 || phase_ends_in_hover(phase)) {
            let spot_m = *order.spot_m.get_or_insert(seen.position_m);
            let off = spot_m - seen.position_m;
            let (s, c) = (sin(seen.euler.heading_rad), cos(seen.euler.heading_rad));
            forward_mps = clamp(0.12 * (off.x * c + off.y * s), -4.0, 4.0);
            right_mps = clamp(0.12 * (off.y * c - off.x * s), -3.0, 3.0);
            order.forward_mps = 0.0;
        } else if !phase_ends_in_hover(phase) || order.forward_mps > 0.0 {
            order.spot_m = None;
        }
        if matches!(phase, Phase::Approach { .. }) && order.spot_m.is_none() {
            // What is left to the side is flown off sideways when slow.
            let off = order.start_m - seen.position_m;
            let (s, c) = (sin(seen.euler.heading_rad), cos(seen.euler.heading_rad));
            right_mps = clamp(0.2 * (off.y * c - off.x * s), -3.0, 3.0);
        }
        let _ = eyes;
        Aim {
            forward_mps,
            over_ground: order.over_ground,
            right_mps,
            any_way: false,
            forward_mps2: if hovering { 0.0 } else { order.forward_mps2 },
            forward_mps2_max: order.forward_mps2_max,
            climb_mps,
            heading_rad: order.heading_rad,
            bank_rad_max: order.bank_rad_max,
        }
    }

    /// Stick, lever and pedals for this moment.
    pub(super) fn positions(&mut self, phase: Phase, seen: &Outputs, tick: u64) -> Positions {
        if phase.ends_on_wheels() && seen.landing_gear.main.map(|leg| leg.push_n).sum() > 0.0 {
            self.touched_tick.get_or_insert(tick);
        }
        if matches!(phase, Phase::Wait { .. }) {
            return Positions::default();
        }
        if self.touched_tick.is_some() {
            return self.skill.settle(LOWER_PER_S);
        }
        let aim = self.aim(phase, seen);
        if phase == Phase::Autorotate {
            let hands = self.autorotation.hands(seen);
            return self.skill.hold(seen, &aim, hands);
        }
        self.skill.fly(seen, &aim)
    }

    /// Toes on the brakes while it rolls out of a landing with speed.
    pub(super) fn brake(&self, seen: &Outputs) -> f64 {
        let rolls = self.touched_tick.is_some() && seen.velocity_mps.norm() > ROLLING_MPS;
        if rolls { BRAKE_NORM } else { 0.0 }
    }

    /// Thumb switches and handles: nacelles, rotor speed, flaps, gear.
    pub(super) fn switches(&mut self, seen: &Outputs, context: &mut TickContext<'_>) {
        let order = &self.order;
        let tilt_rad = seen.actuators.mast_tilt_rad.mean();
        // The governor is given time to follow: the rotors' own warnings come at 625 rpm and 90 %.
        let rotors_off = seen.rotor_speed_radps / ROTOR_RADPS - 1.0;
        let thumb = match order.nacelles {
            Nacelles::Stay => 0,
            // As autorotations were flown, whatever the rotors do meanwhile.
            Nacelles::Autorotation => i8::from(tilt_rad > AUTOROTATION_RAD),
            _ if rotors_off.abs() > ROTORS_OFF_MAX => 0,
            Nacelles::Forward if tilt_rad < FRAC_PI_2 - 1e-4 => {
                let ahead_rad = min(tilt_rad + AHEAD_RAD, FRAC_PI_2);
                let fast = order.airspeed_mps > self.corridor.slowest_mps(ahead_rad) + CORRIDOR_MPS;
                if fast && seen.alpha_rad < 0.21 { -1 } else { 0 }
            }
            Nacelles::Aft if tilt_rad > 1e-4 => {
                let ahead_rad = max(tilt_rad - AHEAD_RAD, 0.0);
                let slow = order.airspeed_mps < self.corridor.fastest_mps(ahead_rad) - CORRIDOR_MPS;
                if slow { 1 } else { 0 }
            }
            Nacelles::Forward | Nacelles::Aft => 0,
        };
        if thumb != self.thumb {
            for (way, button) in
                [(-1, ButtonControl::NacelleForward), (1, ButtonControl::NacelleAft)]
            {
                if self.thumb == way || thumb == way {
                    self.device.press(context, button, thumb == way);
                }
            }
            self.thumb = thumb;
        }

        let rested = (context.tick - self.handle_tick) as f64 * STEP_S > HANDLE_S;
        if !rested {
            return;
        }
        let to_move = match order.nacelles {
            Nacelles::Stay | Nacelles::Autorotation => false,
            Nacelles::Forward => tilt_rad < FRAC_PI_2 - 1e-4,
            Nacelles::Aft => tilt_rad > 1e-4,
        };
        let handle = if to_move && seen.cockpit.rpm_select != 0 {
            // The nacelles move at the helicopter's rotor speed only.
            Some(ButtonControl::RpmSelect)
        } else if order.gear_down != (seen.cockpit.gear_down != 0) {
            Some(ButtonControl::GearToggle)
        } else {
            let wanted = flap_detent(order, tilt_rad, seen.cockpit.flap_detent);
            match seen.cockpit.flap_detent.cmp(&wanted) {
                std::cmp::Ordering::Less => Some(ButtonControl::FlapDown),
                std::cmp::Ordering::Equal => None,
                std::cmp::Ordering::Greater => Some(ButtonControl::FlapUp),
            }
        };
        if let Some(button) = handle {
            self.device.tap(context, button);
            self.handle_tick = context.tick;
        }
    }
}

/// Whether the gauges show that one of the engines gives nothing while the other one does.
fn one_engine_is_out(seen: &Outputs) -> bool {
    let power_w = seen.engines.power_w;
    let more_w = max(power_w.left, power_w.right);
    min(power_w.left, power_w.right) < OUT_NORM * more_w && more_w > 0.2 * seen.engines.available_w
}

/// 40 as a helicopter, 20 in conversion and as a slow aeroplane, 0 as a fast one.
fn flap_detent(order: &Order, tilt_rad: f64, now: u64) -> u64 {
    let incidence_deg = 90.0 - tilt_rad.to_degrees();
    // Flaps 20 all the way down: our choice, the source does not tell them.
    if order.nacelles == Nacelles::Autorotation {
        return 1;
    }
    // Up late and down early, as the handbook has it.
    let helicopter_deg = if order.nacelles == Nacelles::Aft { 60.0 } else { 75.0 };
    if incidence_deg > helicopter_deg {
        2
    } else if incidence_deg > 5.0 || order.airspeed_mps < FLAP_MPS[0] {
        1
    } else if order.airspeed_mps > FLAP_MPS[1] {
        0
    } else {
        now
    }
}

fn phase_ends_in_hover(phase: Phase) -> bool {
    matches!(phase, Phase::Approach { .. } | Phase::Stop { .. })
}

/// Where the aircraft goes over the ground.
fn track_rad(seen: &Outputs) -> f64 {
    atan2(seen.velocity_mps.y, seen.velocity_mps.x)
}
