//! Flying by keyboard: keys move the controls of a device that exists in the cockpit map only.
//!
//! Most terminals tell that a key was pressed, and not that it was released. So a key either moves a
//! control by a step and leaves it there, or holds it for as long as the key repeats and a little longer.
//! What is recorded is what a stick would have sent: axis and button events.

use engine::cockpit::{self, AxisControl, ButtonControl};
use engine::controls::PilotControls;
use engine::frames::Vec3;
use engine::inputs::{Failures, World};
use engine::math::{atan2, clamp, cos, sin, sqrt};
use engine::units::{knots, mps_of_knots};
use engine::{Outputs, STEP_NS, STEP_S};
use rtrb::{Consumer, Producer, RingBuffer};

use crate::controller::{Controller, TickContext};
use crate::pilots::VirtualDevice;
use crate::restart::Restart;

/// Name of the device in the cockpit map.
pub const DEVICE: &str = "keyboard";

/// Orders that wait for a tick, at most.
const ORDERS: usize = 256;
/// A key holds its control for so long after it was last told to be pressed: a keyboard needs up to
/// 0.66 s before it repeats.
const HELD_TICKS: u64 = 700_000_000 / STEP_NS;
/// The same for stick and pedals, where a tap is to be a tap.
const TAPPED_TICKS: u64 = 250_000_000 / STEP_NS;
/// How fast a control follows its key, of its travel from the middle a second.
const RATE_NORM_PER_S: f64 = 1.0;
/// How far the first press of a key deflects stick and pedals.
const TAP_NORM: f64 = 0.10;
/// By how much each repetition deflects them further, and how far at most.
const REPEAT_NORM: f64 = 0.03;
const PUSH_NORM_MAX: f64 = 0.4;
/// A step of stick and pedals that stays.
const STEP_NORM: f64 = 0.01;
/// Steps of the power lever.
const LEVER_NORM: f64 = 0.02;
const LEVER_FINE_NORM: f64 = 0.005;
/// Steps of the wind.
const WIND_KT: f64 = 5.0;
const WIND_KT_MAX: f64 = 60.0;
const WIND_DEG: f64 = 10.0;
/// Steps of the turbulence, which begins at 0 again after the last.
const TURBULENCE_MPS: f64 = 0.5;
const TURBULENCE_MPS_MAX: f64 = 2.0;
/// The gust by key: upwards, 1 − cosine.
const GUST_UP_MPS: f64 = 5.0;
const GUST_S: f64 = 2.0;

/// What is told of a [`KeyAction`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyFacts {
    /// Its name; never changed.
    pub key: &'static str,
    /// The key on the keyboard.
    pub on: &'static str,
    /// What it does.
    pub description: &'static str,
}

engine::enumeration! {
    /// What a key does in flight.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum KeyAction tells KeyFacts {
        /// Stick forward while held.
        StickForward { key: "stick_forward", on: "Up" }
        /// Stick aft while held.
        StickAft { key: "stick_aft", on: "Down" }
        /// Stick left while held.
        StickLeft { key: "stick_left", on: "Left" }
        /// Stick right while held.
        StickRight { key: "stick_right", on: "Right" }
        /// Left pedal while held.
        PedalLeft { key: "pedal_left", on: "z" }
        /// Right pedal while held.
        PedalRight { key: "pedal_right", on: "x" }
        /// Stick a step forward, to stay.
        StepForward { key: "step_forward", on: "w" }
        /// Stick a step aft, to stay.
        StepAft { key: "step_aft", on: "s" }
        /// Stick a step left, to stay.
        StepLeft { key: "step_left", on: "a" }
        /// Stick a step right, to stay.
        StepRight { key: "step_right", on: "d" }
        /// Left pedal a step, to stay.
        StepPedalLeft { key: "step_pedal_left", on: "," }
        /// Right pedal a step, to stay.
        StepPedalRight { key: "step_pedal_right", on: "." }
        /// Stick and pedals to their middle.
        Centre { key: "centre", on: "c" }
        /// Stick and pedals stay where they are now.
        Stay { key: "stay", on: "h" }
        /// Power lever up.
        LeverUp { key: "lever_up", on: "PageUp" }
        /// Power lever down.
        LeverDown { key: "lever_down", on: "PageDown" }
        /// Power lever up, a small step.
        LeverUpFine { key: "lever_up_fine", on: "+" }
        /// Power lever down, a small step.
        LeverDownFine { key: "lever_down_fine", on: "-" }
        /// Nacelles towards the aeroplane while held.
        NacelleForward { key: "nacelle_forward", on: "n" }
        /// Nacelles towards the helicopter while held.
        NacelleAft { key: "nacelle_aft", on: "b" }
        /// Flap lever one detent down.
        FlapDown { key: "flap_down", on: "]" }
        /// Flap lever one detent up.
        FlapUp { key: "flap_up", on: "[" }
        /// Gear handle to its other position.
        Gear { key: "gear", on: "g" }
        /// Both toe brakes while held.
        Brakes { key: "brakes", on: "v" }
        /// Parking brake to its other position.
        ParkingBrake { key: "parking_brake", on: "k" }
        /// SCAS on or off.
        Scas { key: "scas", on: "y" }
        /// Next rotor speed.
        RpmSelect { key: "rpm_select", on: "r" }
        /// Marks the moment in the log.
        Marker { key: "marker", on: "m" }
        /// Freezes the aircraft, or lets it go on.
        Freeze { key: "freeze", on: "p" }
        /// Back to the start of the flight.
        ResetToStart { key: "reset_to_start", on: "R" }
        /// Back to the last marker.
        ResetToMarker { key: "reset_to_marker", on: "M" }
        /// Saves the situation in a file beside the log.
        SaveSituation { key: "save_situation", on: "S" }
        /// Loads the situation saved last.
        LoadSituation { key: "load_situation", on: "L" }
        /// Mends all failures.
        MendAll { key: "mend_all", on: "0" }
        /// Wind from ten degrees further left.
        WindLeft { key: "wind_left", on: "(" }
        /// Wind from ten degrees further right.
        WindRight { key: "wind_right", on: ")" }
        /// Wind weaker by 5 kt.
        WindWeaker { key: "wind_weaker", on: "{" }
        /// Wind stronger by 5 kt, up to 60; out of calm air it comes from ahead.
        WindStronger { key: "wind_stronger", on: "}" }
        /// Turbulence stronger by 0.5 m/s; after 2 m/s none.
        Turbulence { key: "turbulence", on: "t" }
        /// A gust upwards of 5 m/s within 2 s.
        Gust { key: "gust", on: "u" }
    }
}

/// What the crew wants, by whatever means it says so.
#[derive(Clone, Copy, Debug, PartialEq)]
// A situation is handed over once in a while.
#[allow(clippy::large_enum_variant)]
pub enum Order {
    /// A key was pressed, or repeated itself.
    Press(KeyAction),
    /// A key was released, where the terminal tells that.
    Release(KeyAction),
    /// Fails what works, mends what failed.
    Fail(Failures),
    /// Goes on from somewhere else.
    Restart(Restart),
}

/// The end at which orders are given.
pub struct Orders(Producer<Order>);

impl Orders {
    /// Gives an order; `false` when too many wait already.
    pub fn give(&mut self, order: Order) -> bool {
        self.0.push(order).is_ok()
    }
}

/// The keyboard as hands.
pub struct Keyboard {
    device: VirtualDevice,
    orders: Consumer<Order>,
    axes: [Axis; 4],
    /// What is held until a tick: nacelles and brakes.
    held: [Held; 3],
    /// The controls are to be taken over from where the aircraft has them.
    fresh: bool,
}

/// A control that is moved.
#[derive(Clone, Copy)]
struct Axis {
    control: AxisControl,
    /// Where it is.
    at_norm: f64,
    /// Where it stays when no key is held.
    rest_norm: f64,
    /// How far from there a key holds it, until when.
    push_norm: f64,
    until_tick: u64,
    /// Whether a key has moved it since it was taken over.
    moved: bool,
}

/// A switch or brake that is held.
#[derive(Clone, Copy)]
struct Held {
    what: KeyAction,
    until_tick: Option<u64>,
}

/// Places of the controls in [`Keyboard::axes`].
const AFT: usize = 0;
const RIGHT: usize = 1;
const PEDAL: usize = 2;
const LEVER: usize = 3;

impl Keyboard {
    /// Of a map that has the device; with it the end at which orders are given.
    pub fn of(map: &cockpit::Params) -> Option<(Self, Orders)> {
        let (give, orders) = RingBuffer::new(ORDERS);
        let axis = |control| Axis {
            control,
            at_norm: 0.0,
            rest_norm: 0.0,
            push_norm: 0.0,
            until_tick: 0,
            moved: false,
        };
        let controls = [
            AxisControl::StickAft,
            AxisControl::StickRight,
            AxisControl::PedalRight,
            AxisControl::Collective,
        ];
        let keyboard = Self {
            device: VirtualDevice::named(map, DEVICE)?,
            orders,
            axes: controls.map(axis),
            held: [KeyAction::NacelleForward, KeyAction::NacelleAft, KeyAction::Brakes]
                .map(|what| Held { what, until_tick: None }),
            fresh: true,
        };
        Some((keyboard, Orders(give)))
    }

    /// Takes the controls over from where the aircraft has them.
    fn take_over(&mut self, controls: &PilotControls) {
        let at = [
            controls.stick_aft_norm,
            controls.stick_right_norm,
            controls.pedal_right_norm,
            controls.collective_norm,
        ];
        for (axis, at_norm) in self.axes.iter_mut().zip(at) {
            *axis = Axis {
                at_norm,
                rest_norm: at_norm,
                push_norm: 0.0,
                until_tick: 0,
                moved: false,
                ..*axis
            };
        }
        self.device.forget();
    }

    fn obey(&mut self, order: Order, seen: &Outputs, context: &mut TickContext<'_>) {
        match order {
            Order::Press(action) => self.press(action, seen, context),
            Order::Release(action) => self.release(action, context.tick),
            Order::Fail(failure) => context.world.failures.toggle(failure),
            Order::Restart(restart) => *context.restart = Some(restart),
        }
    }

    fn press(&mut self, action: KeyAction, seen: &Outputs, context: &mut TickContext<'_>) {
        use KeyAction as K;
        let tick = context.tick;
        match action {
            K::StickForward => self.push(AFT, -1.0, tick),
            K::StickAft => self.push(AFT, 1.0, tick),
            K::StickLeft => self.push(RIGHT, -1.0, tick),
            K::StickRight => self.push(RIGHT, 1.0, tick),
            K::PedalLeft => self.push(PEDAL, -1.0, tick),
            K::PedalRight => self.push(PEDAL, 1.0, tick),
            K::StepForward => self.step(AFT, -STEP_NORM),
            K::StepAft => self.step(AFT, STEP_NORM),
            K::StepLeft => self.step(RIGHT, -STEP_NORM),
            K::StepRight => self.step(RIGHT, STEP_NORM),
            K::StepPedalLeft => self.step(PEDAL, -STEP_NORM),
            K::StepPedalRight => self.step(PEDAL, STEP_NORM),
            K::Centre => self.rest(|_| 0.0),
            K::Stay => self.rest(|axis| axis.at_norm),
            K::LeverUp => self.step(LEVER, LEVER_NORM),
            K::LeverDown => self.step(LEVER, -LEVER_NORM),
            K::LeverUpFine => self.step(LEVER, LEVER_FINE_NORM),
            K::LeverDownFine => self.step(LEVER, -LEVER_FINE_NORM),
            K::NacelleForward | K::NacelleAft | K::Brakes => self.hold(action, context),
            K::FlapDown => self.device.tap(context, ButtonControl::FlapDown),
            K::FlapUp => self.device.tap(context, ButtonControl::FlapUp),
            K::Gear => self.device.tap(context, ButtonControl::GearToggle),
            K::ParkingBrake => self.device.tap(context, ButtonControl::ParkingBrakeToggle),
            K::Scas => self.device.tap(context, ButtonControl::ScasToggle),
            K::RpmSelect => self.device.tap(context, ButtonControl::RpmSelect),
            K::Marker => self.device.tap(context, ButtonControl::Marker),
            K::Freeze => context.world.paused ^= 1,
            K::ResetToStart => *context.restart = Some(Restart::Start),
            K::ResetToMarker => *context.restart = Some(Restart::Marker),
            K::SaveSituation => *context.save = true,
            K::LoadSituation => *context.restart = Some(Restart::Saved),
            K::MendAll => context.world.failures = Failures::empty(),
            K::WindLeft => wind(context.world, -WIND_DEG, 0.0, seen),
            K::WindRight => wind(context.world, WIND_DEG, 0.0, seen),
            K::WindWeaker => wind(context.world, 0.0, -WIND_KT, seen),
            K::WindStronger => wind(context.world, 0.0, WIND_KT, seen),
            K::Turbulence => {
                let next_mps = context.world.turbulence_mps + TURBULENCE_MPS;
                let over = next_mps > TURBULENCE_MPS_MAX;
                context.world.turbulence_mps = if over { 0.0 } else { next_mps };
            }
            K::Gust => {
                context.world.gust_mps = Vec3::new(0.0, 0.0, -GUST_UP_MPS);
                context.world.gust_s = GUST_S;
                context.world.gust_start_tick = tick;
            }
        }
    }

    /// A key deflects a control: further with each repetition.
    fn push(&mut self, axis: usize, way: f64, tick: u64) {
        let axis = &mut self.axes[axis];
        let same_way = tick < axis.until_tick && axis.push_norm * way > 0.0;
        let push_norm = if same_way { axis.push_norm.abs() + REPEAT_NORM } else { TAP_NORM };
        axis.push_norm = way * clamp(push_norm, 0.0, PUSH_NORM_MAX);
        axis.until_tick = tick + TAPPED_TICKS;
        axis.moved = true;
    }

    /// A key moves a control by a step.
    fn step(&mut self, axis: usize, by_norm: f64) {
        let axis = &mut self.axes[axis];
        let low_norm = axis.control.facts().travel.low_norm();
        axis.rest_norm = clamp(axis.rest_norm + by_norm, low_norm, 1.0);
        axis.moved = true;
    }

    /// Stick and pedals get another place to rest.
    fn rest(&mut self, at_norm: impl Fn(&Axis) -> f64) {
        for axis in &mut self.axes[..LEVER] {
            axis.rest_norm = at_norm(axis);
            axis.until_tick = 0;
            axis.moved = true;
        }
    }

    /// A switch or brake that a key holds.
    fn hold(&mut self, action: KeyAction, context: &mut TickContext<'_>) {
        let until_tick = context.tick + HELD_TICKS;
        let Some(held) = self.held.iter_mut().find(|held| held.what == action) else { return };
        if held.until_tick.replace(until_tick).is_none() {
            set(&mut self.device, context, action, true);
        }
    }

    /// A terminal that tells when a key is released ends what it held.
    fn release(&mut self, action: KeyAction, tick: u64) {
        use KeyAction as K;
        for held in self.held.iter_mut().filter(|held| held.what == action) {
            held.until_tick = held.until_tick.map(|_| tick);
        }
        let axis = match action {
            K::StickForward | K::StickAft => AFT,
            K::StickLeft | K::StickRight => RIGHT,
            K::PedalLeft | K::PedalRight => PEDAL,
            _ => return,
        };
        self.axes[axis].until_tick = tick;
    }

    /// Moves the controls towards where they are to be.
    fn move_on(&mut self, context: &mut TickContext<'_>) {
        let most_norm = RATE_NORM_PER_S * STEP_S;
        for axis in self.axes.iter_mut().filter(|axis| axis.moved) {
            let push_norm = if context.tick < axis.until_tick { axis.push_norm } else { 0.0 };
            let low_norm = axis.control.facts().travel.low_norm();
            let to_norm = clamp(axis.rest_norm + push_norm, low_norm, 1.0);
            axis.at_norm += clamp(to_norm - axis.at_norm, -most_norm, most_norm);
            self.device.set(context, axis.control, axis.at_norm);
        }
        for held in &mut self.held {
            if held.until_tick.is_some_and(|until_tick| context.tick >= until_tick) {
                held.until_tick = None;
                set(&mut self.device, context, held.what, false);
            }
        }
    }
}

impl Controller for Keyboard {
    fn act(&mut self, seen: &Outputs, context: &mut TickContext<'_>) {
        if std::mem::take(&mut self.fresh) {
            self.take_over(&seen.cockpit);
        }
        while let Ok(order) = self.orders.pop() {
            self.obey(order, seen, context);
        }
        self.move_on(context);
        // What it sees in the next tick is where the controls are then.
        self.fresh = context.restart.is_some();
    }
}

fn set(device: &mut VirtualDevice, context: &mut TickContext<'_>, what: KeyAction, on: bool) {
    match what {
        KeyAction::NacelleForward => device.press(context, ButtonControl::NacelleForward, on),
        KeyAction::NacelleAft => device.press(context, ButtonControl::NacelleAft, on),
        _ => {
            for brake in [AxisControl::BrakeLeft, AxisControl::BrakeRight] {
                device.set(context, brake, f64::from(u8::from(on)));
            }
        }
    }
}

/// Turns and strengthens the wind.
fn wind(world: &mut World, by_deg: f64, by_kt: f64, seen: &Outputs) {
    let v = world.wind_mps;
    let kt = knots(sqrt(v.x * v.x + v.y * v.y));
    let from_rad = if kt > 0.0 { atan2(-v.y, -v.x) } else { seen.euler.heading_rad };
    let from_rad = from_rad + by_deg / engine::units::DEG_PER_RAD;
    // To whole knots: what was typed five times is what it says.
    let mps = mps_of_knots(clamp((kt + by_kt).round(), 0.0, WIND_KT_MAX));
    world.wind_mps = Vec3::new(0.0 - mps * cos(from_rad), 0.0 - mps * sin(from_rad), v.z);
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "what is passed on stays the same to the bit")]
mod tests;
