//! What a pilot model does in each part of a flight.

use engine::cockpit::ButtonControl;
use engine::frames::{Ned, Vec3};
use engine::math::{FRAC_PI_2, atan2, clamp, cos, max, min, sin, sqrt, wrap_angle};
use engine::{Outputs, STEP_S};

use super::Pilot;
use super::habits::*;
use super::handbook::detent;
use super::order::Nacelles;
use super::phase::Phase;
use super::skill::{Aim, HAND_S, Observation, Positions};
use super::sweep;
use crate::controller::TickContext;

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
        order.airspeed_mps +=
            HAND_S / READING_S * (seen.calibrated_airspeed_mps - order.airspeed_mps);
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
                (height_m - to_m).abs() < HOVER_NEAR_M
            }
            Phase::Mark => {
                self.device.tap(context, ButtonControl::Marker);
                true
            }
            Phase::Accelerate { height_m: to_m } => {
                order.forward_mps = self.handbook.pilot.helicopter_mps;
                order.forward_mps2_max = HELICOPTER_MPS2;
                order.climb_mps_max = HELICOPTER_CLIMB_MPS;
                order.height_m = to_m;
                // Wheels up once it climbs away.
                order.gear_down &= height_m < WHEELS_UP_M || order.airspeed_mps < WHEELS_UP_MPS;
                order.airspeed_mps > order.forward_mps - HELICOPTER_NEAR_MPS
                    && height_m > to_m - ACCELERATION_NEAR_M
            }
            Phase::Convert { to } => {
                order.nacelles = Nacelles::Forward;
                order.forward_mps = to.mps(&self.handbook);
                order.forward_mps2_max = CONVERSION_MPS2;
                order.climb_mps_max = CONVERSION_CLIMB_MPS;
                order.gear_down = false;
                tilt_rad > FRAC_PI_2 - END_RAD
                    && order.airspeed_mps > order.forward_mps - AEROPLANE_NEAR_MPS
            }
            Phase::Climb { height_m: to_m } => {
                order.height_m = to_m;
                order.climb_mps_max = AEROPLANE_CLIMB_MPS;
                height_m > to_m - CLIMB_NEAR_M
            }
            Phase::Circle { bank_rad } => {
                order.bank_rad_max = bank_rad;
                order.heading_rad = wrap_angle(seen.euler.heading_rad - TURN_AHEAD_RAD);
                false
            }
            Phase::Home { bank_rad } => self.home(seen, bank_rad),
            Phase::Approach { height_m: to_m } => self.approach(seen, to_m),
            Phase::Stop { height_m: to_m } => self.stop(seen, to_m),
            Phase::FaceStart => {
                order.heading_rad = order.start_heading_rad;
                let off_rad = wrap_angle(order.start_heading_rad - seen.euler.heading_rad);
                off_rad.abs() < FACED_RAD && seen.angular_rate_radps.z.abs() < FACED_RADPS
            }
            Phase::Land | Phase::Autorotate => self.touched_tick.is_some_and(|touched| {
                let down_s = (context.tick - touched) as f64 * STEP_S;
                down_s > SETTLE_S && (seen.velocity_mps.norm() < ROLLING_MPS || down_s > ROLL_S)
            }),
        }
    }

    /// Turns left until it goes towards the spot where the flight began.
    fn home(&mut self, seen: &Outputs, bank_rad: f64) -> bool {
        let order = &mut self.order;
        order.bank_rad_max = bank_rad;
        let (to_rad, distance_m) = bearing(seen, order.start_m);
        let turned_rad = -seen.euler_rate.heading_radps * HAND_S;
        order.turned_rad += turned_rad;
        let off_rad = wrap_angle(to_rad - track_rad(seen));
        let lead_rad = -seen.euler_rate.heading_radps * ROLL_OUT_S;
        order.heading_rad = wrap_angle(seen.euler.heading_rad - TURN_AHEAD_RAD);
        order.turned_rad > HALF_TURN_RAD
            && off_rad.abs() < lead_rad.abs() + ROLL_OUT_RAD
            && distance_m > HERE_M
    }

    /// To the spot where the flight began.
    fn approach(&mut self, seen: &Outputs, height_m: f64) -> bool {
        let order = &mut self.order;
        let (to_rad, distance_m) = bearing(seen, order.start_m);
        let off_rad = wrap_angle(to_rad - track_rad(seen));
        let ahead_m = distance_m * cos(wrap_angle(to_rad - seen.euler.heading_rad));
        if distance_m > STEER_M && off_rad.abs() < STEER_RAD {
            order.heading_rad = wrap_angle(seen.euler.heading_rad + off_rad);
        }
        order.bank_rad_max = BANK_RAD;
        // A constant deceleration ends over the spot.
        let slow_mps = sqrt(2.0 * APPROACH_MPS2 * max(0.0, ahead_m - STOP_SHORT_M));
        self.slow_down(seen, slow_mps);
        let order = &mut self.order;
        let slope_m = height_m + APPROACH_SLOPE * (ahead_m - LEVEL_OFF_M);
        order.height_m = min(order.height_m, max(height_m, slope_m));
        let slow = seen.velocity_mps.norm() < ARRIVING_MPS && ahead_m < ARRIVING_M;
        if slow || order.spot_m.is_some() {
            order.spot_m = Some(order.start_m);
        }
        let (_, distance_m) = bearing(seen, order.start_m);
        order.spot_m.is_some()
            && distance_m < ARRIVED_M
            && seen.velocity_mps.norm() < ARRIVED_MPS
            && (seen.height_above_ground_m - height_m).abs() < APPROACH_NEAR_M
            && self.is_helicopter(seen)
    }

    /// Straight ahead: down to a low height first, with speed, then to a hover there.
    fn stop(&mut self, seen: &Outputs, height_m: Option<f64>) -> bool {
        let height_m = height_m.unwrap_or(self.order.height_m);
        let high_m = seen.height_above_ground_m - height_m;
        let run_on = self.lands && one_engine_is_out(seen);
        let (descent_mps, run_on_mps) =
            (self.handbook.pilot.descent_mps, self.handbook.pilot.run_on_mps);
        self.order.run_on = run_on;
        // Out of its own wake an aircraft that flies may sink twice as fast as one that hovers.
        let least_mps = if high_m > HIGH_M {
            descent_mps
        } else if run_on {
            run_on_mps
        } else {
            0.0
        };
        let slow_mps = max(least_mps, self.order.forward_mps - APPROACH_MPS2 * HAND_S);
        self.slow_down(seen, slow_mps);
        if run_on && self.order.forward_mps < run_on_mps + SAME_MPS {
            // It slows down no further.
            self.order.forward_mps2 = 0.0;
        }
        if self.is_helicopter(seen) {
            if high_m > HIGH_M && seen.airspeed_mps > STEEP_NORM * descent_mps {
                self.order.sink_mps_max = STEEP_MPS;
            }
            self.order.height_m = min(self.order.height_m, height_m);
        }
        let slow_enough_mps = if run_on { run_on_mps + RUN_ON_NEAR_MPS } else { ARRIVED_MPS };
        seen.velocity_mps.norm() < slow_enough_mps
            && (seen.height_above_ground_m - height_m).abs() < APPROACH_NEAR_M
            && self.is_helicopter(seen)
    }

    /// A speed over the ground, no slower than the nacelles allow, which come aft meanwhile.
    fn slow_down(&mut self, seen: &Outputs, slow_mps: f64) {
        let order = &mut self.order;
        if slow_mps < Observation::look(seen).forward_mps + NACELLES_MPS {
            order.nacelles = Nacelles::Aft;
        }
        order.over_ground = true;
        order.forward_mps2_max = SLOWING_MPS2;
        order.climb_mps_max = GENTLE_MPS;
        order.sink_mps_max = clamp(SINK_BY_SPEED * seen.airspeed_mps, GENTLE_MPS, SINK_MPS_MAX);
        order.gear_down |= order.airspeed_mps < self.handbook.gear_mps_max;
        let tilt_rad = seen.actuators.mast_tilt_rad.mean();
        let slowest_mps = self.handbook.corridor.slowest_mps(tilt_rad);
        let along_mps = Observation::look(seen).forward_mps;
        let keep_mps = if slowest_mps > 0.0 {
            slowest_mps + CORRIDOR_MPS - (order.airspeed_mps - along_mps)
        } else {
            0.0
        };
        order.forward_mps2 = if slow_mps < order.forward_mps + SAME_MPS
            && slow_mps > keep_mps
            && slow_mps > ARRIVING_MPS
        {
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
        let order = &mut self.order;
        let climb_mps = if phase == Phase::Land {
            let [least_mps, most_mps] = LANDING_MPS;
            let touch_m = self.handbook.pilot.standing_m + TOUCH_M;
            -clamp(LANDING_PER_S * (seen.height_above_ground_m - touch_m), least_mps, most_mps)
        } else {
            let carried = seen.airspeed_mps > self.handbook.pilot.wing_borne_mps_min;
            let gain_per_s = HEIGHT_PER_S[usize::from(!carried)];
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
        let slow = seen.velocity_mps.norm() < HOVERING_MPS;
        let hovering = order.spot_m.is_some() || (order.forward_mps == 0.0 && slow);
        let (mut forward_mps, mut right_mps) = (order.forward_mps, 0.0);
        if hovering && (order.forward_mps == 0.0 || phase_ends_in_hover(phase)) {
            let spot_m = *order.spot_m.get_or_insert(seen.position_m);
            let off = spot_m - seen.position_m;
            let (s, c) = (sin(seen.euler.heading_rad), cos(seen.euler.heading_rad));
            let [ahead_mps, beside_mps] = SPOT_MPS_MAX;
            forward_mps = clamp(SPOT_PER_S * (off.x * c + off.y * s), -ahead_mps, ahead_mps);
            right_mps = clamp(SPOT_PER_S * (off.y * c - off.x * s), -beside_mps, beside_mps);
            order.forward_mps = 0.0;
        } else if !phase_ends_in_hover(phase) || order.forward_mps > 0.0 {
            order.spot_m = None;
        }
        if matches!(phase, Phase::Approach { .. }) && order.spot_m.is_none() {
            // What is left to the side is flown off sideways when slow.
            let off = order.start_m - seen.position_m;
            let (s, c) = (sin(seen.euler.heading_rad), cos(seen.euler.heading_rad));
            let [_, beside_mps] = SPOT_MPS_MAX;
            right_mps = clamp(BESIDE_PER_S * (off.y * c - off.x * s), -beside_mps, beside_mps);
        }
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
            let hands = self.autorotation.hands(seen, &self.handbook.pilot);
            return self.skill.hold(seen, &aim, hands, &self.handbook);
        }
        self.skill.fly(seen, &aim, &self.handbook)
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
        // The governor is given time to follow, long before the rotors' own warnings come.
        let rotors_off = seen.rotor_speed_radps / self.handbook.conversion_radps - 1.0;
        let thumb = match order.nacelles {
            Nacelles::Stay => 0,
            // As autorotations were flown, whatever the rotors do meanwhile.
            Nacelles::Autorotation => i8::from(tilt_rad > self.handbook.aft_rad + AFT_STOP_RAD),
            _ if rotors_off.abs() > ROTORS_OFF_MAX => 0,
            Nacelles::Forward if tilt_rad < FRAC_PI_2 - STOP_RAD => {
                let ahead_rad = min(tilt_rad + AHEAD_RAD, FRAC_PI_2);
                let fast = order.airspeed_mps
                    > self.handbook.corridor.slowest_mps(ahead_rad) + CORRIDOR_MPS;
                let alpha_rad_max = self.handbook.pilot.alpha_rad_max + FORWARD_ALPHA_RAD;
                if fast && seen.alpha_rad < alpha_rad_max { -1 } else { 0 }
            }
            Nacelles::Aft if tilt_rad > STOP_RAD => {
                let ahead_rad = max(tilt_rad - AHEAD_RAD, 0.0);
                let slow = order.airspeed_mps
                    < self.handbook.corridor.fastest_mps(ahead_rad) - CORRIDOR_MPS;
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
            Nacelles::Forward => tilt_rad < FRAC_PI_2 - STOP_RAD,
            Nacelles::Aft => tilt_rad > STOP_RAD,
        };
        let handle = if to_move && seen.cockpit.rpm_select != 0 {
            // The nacelles move at the helicopter's rotor speed only.
            Some(ButtonControl::RpmSelect)
        } else if order.gear_down != (seen.cockpit.gear_down != 0) {
            Some(ButtonControl::GearToggle)
        } else {
            let wanted = self.flap_detent(tilt_rad, seen.cockpit.flap_detent);
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

impl Pilot {
    /// A helicopter's; a conversion's, and a slow aeroplane's; a fast aeroplane's.
    fn flap_detent(&self, tilt_rad: f64, now: u64) -> u64 {
        let (order, pilot) = (&self.order, &self.handbook.pilot);
        let incidence_deg = 90.0 - tilt_rad.to_degrees();
        // A conversion's all the way down: our choice, the source does not tell them.
        if order.nacelles == Nacelles::Autorotation {
            return detent::CONVERSION;
        }
        let helicopter_deg = HELICOPTER_FLAPS_DEG[usize::from(order.nacelles != Nacelles::Aft)];
        if incidence_deg > helicopter_deg {
            detent::HELICOPTER
        } else if incidence_deg > AEROPLANE_FLAPS_DEG || order.airspeed_mps < pilot.flap_down_mps {
            detent::CONVERSION
        } else if order.airspeed_mps > pilot.flap_up_mps {
            detent::AEROPLANE
        } else {
            now
        }
    }
}

/// Whether the gauges show that one of the engines gives nothing while the other one does.
fn one_engine_is_out(seen: &Outputs) -> bool {
    let power_w = seen.engines.power_w;
    let more_w = max(power_w.left, power_w.right);
    min(power_w.left, power_w.right) < OUT_NORM * more_w
        && more_w > WORKING_NORM * seen.engines.available_w
}

fn phase_ends_in_hover(phase: Phase) -> bool {
    matches!(phase, Phase::Approach { .. } | Phase::Stop { .. })
}

/// Where the aircraft goes over the ground.
fn track_rad(seen: &Outputs) -> f64 {
    atan2(seen.velocity_mps.y, seen.velocity_mps.x)
}

/// Where a spot is from here: bearing and distance.
fn bearing(seen: &Outputs, spot_m: Vec3<Ned>) -> (f64, f64) {
    let off = spot_m - seen.position_m;
    (engine::math::atan2(off.y, off.x), engine::math::sqrt(off.x * off.x + off.y * off.y))
}

#[cfg(test)]
mod tests {
    use engine::inputs::World;

    use super::*;

    fn pilot(task: &str) -> Pilot {
        let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        Pilot::named(task, &map, &xv15).unwrap()
    }

    /// .12 m/s down for every m/s of airspeed, 2.5 to 6; 5 while it is more than 40 m too high and flies faster than
    /// .8 of the 28 m/s at which it leaves its own wake.
    #[test]
    fn who_stops_sinks_by_the_airspeed_and_steeply_from_high_above() {
        for (high_m, airspeed_mps, sink_mps) in [
            (100.0, 30.0, 5.0),
            (100.0, 22.0, 2.64),
            (30.0, 30.0, 3.6),
            (30.0, 10.0, 2.5),
            (30.0, 80.0, 6.0),
        ] {
            let mut pilot = pilot("hover");
            let seen = Outputs {
                height_above_ground_m: 20.0 + high_m,
                airspeed_mps,
                ..Outputs::default()
            };
            pilot.stop(&seen, Some(20.0));
            let found_mps = pilot.order.sink_mps_max;
            assert!(
                (found_mps - sink_mps).abs() < 1e-9,
                "{high_m} m, {airspeed_mps} m/s: {found_mps}"
            );
        }
    }

    /// From 15 m and 20 m/s on, both of them.
    #[test]
    fn the_wheels_come_up_when_it_climbs_away_and_not_before() {
        for (height_m, airspeed_mps, down) in
            [(14.0, 25.0, true), (16.0, 19.0, true), (16.0, 21.0, false), (14.0, 10.0, true)]
        {
            let mut pilot = pilot("hover");
            pilot.order.gear_down = true;
            pilot.order.airspeed_mps = airspeed_mps;
            let seen = Outputs {
                height_above_ground_m: height_m,
                calibrated_airspeed_mps: airspeed_mps,
                ..Outputs::default()
            };
            let mut context = TickContext {
                tick: 0,
                events: &mut Vec::new(),
                world: &mut World::default(),
                phase: &mut (0, ""),
                done: &mut false,
                restart: &mut None,
                save: &mut false,
                gave_up: &mut None,
            };
            pilot.give_orders(Phase::Accelerate { height_m: 30.0 }, &seen, 0.0, &mut context);
            assert_eq!(pilot.order.gear_down, down, "{height_m} m, {airspeed_mps} m/s");
        }
    }

    #[test]
    fn who_is_to_hover_keeps_to_the_spot_and_who_flies_on_lets_go_of_it() {
        let mut pilot = pilot("hover");
        // At the origin, heading east: what is north of it is on the left.
        let mut seen = Outputs::default();
        seen.euler.heading_rad = FRAC_PI_2;
        let mut aim = |phase, [north_m, east_m]: [f64; 2]| {
            pilot.order.spot_m = Some(Vec3::new(north_m, east_m, 0.0));
            pilot.order.forward_mps = 8.0;
            let aim = pilot.aim(phase, &seen);
            (
                [aim.forward_mps, aim.right_mps],
                pilot.order.forward_mps,
                pilot.order.spot_m.is_some(),
            )
        };
        let near = |[ahead, beside]: [f64; 2], [x, y]: [f64; 2]| {
            (ahead - x).abs() < 1e-9 && (beside - y).abs() < 1e-9
        };
        for phase in [Phase::Stop { height_m: None }, Phase::Approach { height_m: 9.0 }] {
            // .12 m/s for every metre, and 4 m/s ahead and 3 m/s to the side at most.
            let (mps, ordered_mps, keeps) = aim(phase, [5.0, 10.0]);
            assert!(near(mps, [1.2, -0.6]), "{phase:?}: {mps:?}");
            assert!(keeps && ordered_mps == 0.0, "{phase:?}");
            let (mps, ..) = aim(phase, [-500.0, -500.0]);
            assert!(near(mps, [-4.0, 3.0]), "{phase:?}: {mps:?}");
        }
        for phase in [Phase::Accelerate { height_m: 30.0 }, Phase::Hold { seconds: 1.0 }] {
            let (mps, ordered_mps, keeps) = aim(phase, [5.0, 10.0]);
            assert!(near(mps, [8.0, 0.0]), "{phase:?}: {mps:?}");
            assert!(!keeps && ordered_mps > 0.0, "{phase:?}");
        }
    }
}
