//! Cockpit: raw device events to pilot controls.
//!
//! The map says which axis or button of which device moves what. Calibration, dead zone, curve and
//! the meaning of every button are here, inside the step, so that the log needs to hold nothing but
//! what the hardware said.
//!
//! # Equations
//! ```text
//! control = trim + deflection                     an axis that says where the control is
//! control' = control + rate·deflection·h          one that says how fast it moves
//! deflection = upper − lower                      of two axes that are joined
//! ```
//! A control that waits for pick-up keeps its position until `trim + deflection` crosses it.
//!
//! # Signs
//! Stick aft, stick right, right pedal, collective up, nacelles towards the helicopter are positive.
//!
//! # Assumptions
//! Trim switches move at 0.5 in/s of ±4.8 in unless the map says otherwise (`controls.md` of the data, an estimate).

mod codes;
mod lists;
mod map;

pub use self::codes::{Code, Codes};
pub use self::lists::{Acts, AxisControl, AxisFacts, ButtonControl, ButtonFacts, Travel};
pub use self::map::{AxisBinding, ButtonBinding, Device, Mode, Params, Side, WhenUnplugged};
pub use crate::controls::{FLAP_DETENT_LAST, PilotControls as State, RPM_SELECT_LAST};
use crate::inputs::{DeviceEvent, EventKind};
use crate::math::{clamp, sign};

/// A control that is no further from its hardware than this need not wait: an estimate of what is not felt,
/// a fifth of an inch of the power lever's ten.
const PICK_UP_WITHIN_NORM: f64 = 0.02;

/// Rate of a trim switch, of half the stick's travel.
const TRIM_NORM_PER_S: f64 = 0.5 / 4.8;

/// What an event of an axis tells.
#[derive(Clone, Copy, PartialEq)]
enum Told {
    /// It moved.
    Moved,
    /// Where it stands.
    Found,
}

/// Applies the events in their order, then moves what moves by itself for so long, which is nothing
/// during a pause. Events of unknown devices, codes or kinds change nothing.
pub fn update(map: &Params, state: &State, events: &[DeviceEvent], passed_s: f64) -> State {
    let mut controls = *state;
    for event in events {
        let Some(device) = map.device(event.device) else { continue };
        let was_released = controls.force_trim.is_released();
        apply(map, device, &mut controls, event, passed_s > 0.0);
        if was_released && !controls.force_trim.is_released() {
            trim_here(map, &mut controls);
        }
    }
    if passed_s > 0.0 && controls.force_trim.anything_moves() {
        move_on(map, &mut controls, passed_s);
    }
    controls
}

fn apply(map: &Params, device: &Device, controls: &mut State, event: &DeviceEvent, passes: bool) {
    let Some(kind) = EventKind::from_u64(event.kind) else { return };
    let picked_up = device.pick_up == Some(true);
    // During a pause the aircraft keeps its controls: what moves then is picked up after it.
    let told = if passes || !picked_up { Told::Moved } else { Told::Found };
    let pressed = event.value != 0;
    match kind {
        EventKind::Axis => axis(map, device, controls, event, told),
        EventKind::AxisPosition => axis(map, device, controls, event, Told::Found),
        EventKind::Button => {
            let code = Code::Key(event.code);
            for binding in device.axes_of(code) {
                let at_norm = if pressed { binding.reach_norm } else { 0.0 };
                turn(controls, binding, at_norm, picked_up, told);
            }
            for binding in device.buttons_of(code) {
                press(controls, binding, pressed);
            }
        }
        EventKind::Disconnected => unplug(map, device, controls),
        // Recorded for whoever reads the log; a switch acts when it is moved.
        EventKind::Connected | EventKind::Dropped | EventKind::ButtonPosition => {}
    }
}

fn axis(map: &Params, device: &Device, controls: &mut State, event: &DeviceEvent, told: Told) {
    let code = Code::Axis(event.code);
    for binding in device.axes_of(code) {
        let at_norm = position(binding, event) * binding.reach_norm;
        turn(controls, binding, at_norm, device.pick_up == Some(true), told);
    }
    for binding in device.buttons_of(code) {
        let ends = travelled(event, None, None);
        let (Some(beyond_norm), Some((raw, low, high))) = (binding.beyond_norm, ends) else {
            continue;
        };
        let at_norm = centred(raw, low, high);
        let pressed = if beyond_norm < 0.0 { at_norm < beyond_norm } else { at_norm > beyond_norm };
        let place = place_of(map, binding);
        if pressed != controls.force_trim.is_pressed(place) {
            controls.force_trim.put_pressed(place, pressed);
            if told == Told::Moved {
                press(controls, binding, pressed);
            }
        }
    }
}

/// The place of an axis that is used as a button among all of them.
fn place_of(map: &Params, binding: &ButtonBinding) -> u64 {
    let all = map.device.iter().flat_map(|device| &device.button);
    let axes = all.filter(|button| button.beyond_norm.is_some());
    axes.take_while(|axis| !core::ptr::eq(*axis, binding)).count() as u64
}

/// Nobody holds the switches of a device that is gone, and nothing waits for it.
fn unplug(map: &Params, device: &Device, controls: &mut State) {
    for binding in &device.axis {
        let (place, facts) = (binding.control as u64, binding.control.facts());
        if facts.springs_back || binding.when_unplugged == WhenUnplugged::Centre {
            let rest_norm =
                if facts.travel == Travel::Centred { trim(controls, facts) } else { 0.0 };
            (facts.set)(controls, rest_norm);
        }
        controls.pick_up.wait(place, false);
        controls.force_trim.put_above(place, false);
        controls.force_trim.put_moving(place, false);
        put_hardware(controls, facts, 0.0);
        if binding.side != Side::Both {
            controls.pick_up.put_lower(place, 0.0);
        }
    }
    for binding in &device.button {
        if binding.beyond_norm.is_some() {
            controls.force_trim.put_pressed(place_of(map, binding), false);
        }
        if binding.control.facts().acts == Acts::WhileHeld {
            (binding.control.facts().set)(controls, false);
        }
    }
}

/// A button's new position.
fn press(controls: &mut State, binding: &ButtonBinding, pressed: bool) {
    let ButtonFacts { acts, is_on, set, .. } = binding.control.facts();
    let pressed = pressed != binding.inverted;
    match (acts, binding.mode) {
        (Acts::Once, _) if !pressed => {}
        (Acts::WhileHeld | Acts::AsItStands, Some(Mode::Latch)) => {
            if pressed {
                set(controls, !is_on(controls));
            }
        }
        _ => set(controls, pressed),
    }
}

/// An axis' new position, −1 … 1, or 0 … 1 of those from an end.
fn turn(controls: &mut State, binding: &AxisBinding, at_norm: f64, picked_up: bool, told: Told) {
    let (control, facts) = (binding.control, binding.control.facts());
    let deflection_norm = joined(controls, binding, at_norm);
    if binding.is_remembered() {
        put_hardware(controls, facts, deflection_norm);
    }
    if binding.rate_norm_per_s != 0.0 {
        let moves = told == Told::Moved && deflection_norm != 0.0;
        controls.force_trim.put_moving(control as u64, moves);
    } else if picked_up && !facts.springs_back {
        take_over(controls, control, deflection_norm, binding.is_remembered(), told);
    } else if told == Told::Moved {
        (facts.set)(controls, asked_for(controls, facts, deflection_norm));
    }
}

/// Where a deflection puts a control.
fn asked_for(controls: &State, facts: &AxisFacts, deflection_norm: f64) -> f64 {
    clamp(trim(controls, facts) + deflection_norm, facts.travel.low_norm(), 1.0)
}

/// Puts a control where the hardware is, or lets it wait for it.
fn take_over(
    controls: &mut State,
    control: AxisControl,
    deflection_norm: f64,
    remembered: bool,
    told: Told,
) {
    let (place, facts) = (control as u64, control.facts());
    let to_norm = asked_for(controls, facts, deflection_norm);
    if told == Told::Moved && !controls.pick_up.waits(place) {
        (facts.set)(controls, to_norm);
        return;
    }
    // Where the control would come to: a flap lever's detent is not where its axis is.
    let mut there = *controls;
    (facts.set)(&mut there, to_norm);
    let gap_norm = (facts.get)(&there) - (facts.get)(controls);
    let is_above = gap_norm > 0.0;
    let crossed = told == Told::Moved && is_above != controls.force_trim.is_above(place);
    let is_there = crossed || gap_norm.abs() <= PICK_UP_WITHIN_NORM;
    controls.pick_up.wait(place, !is_there);
    controls.force_trim.put_above(place, !is_there && is_above);
    if !remembered {
        put_hardware(controls, facts, if is_there { 0.0 } else { deflection_norm });
    }
    if is_there && told == Told::Moved {
        (facts.set)(controls, to_norm);
    }
}

/// The deflection of an axis and the one that it is joined with.
fn joined(controls: &mut State, binding: &AxisBinding, at_norm: f64) -> f64 {
    let (place, facts) = (binding.control as u64, binding.control.facts());
    match binding.side {
        Side::Both => at_norm,
        Side::Upper => at_norm - controls.pick_up.lower_norm(place),
        Side::Lower => {
            let upper_norm = hardware(controls, facts) + controls.pick_up.lower_norm(place);
            controls.pick_up.put_lower(place, at_norm);
            upper_norm - controls.pick_up.lower_norm(place)
        }
    }
}

/// Moves what trim switches and axes with a rate move.
fn move_on(map: &Params, controls: &mut State, passed_s: f64) {
    for device in &map.device {
        for binding in &device.axis {
            let (place, facts) = (binding.control as u64, binding.control.facts());
            // Of a joined pair the lower one is the other half of the same deflection.
            let twin = binding.side == Side::Lower
                && device
                    .axis
                    .iter()
                    .any(|axis| axis.control == binding.control && axis.side == Side::Upper);
            if binding.rate_norm_per_s == 0.0 || twin || !controls.force_trim.moves(place) {
                continue;
            }
            let by_norm = hardware(controls, facts) * binding.rate_norm_per_s * passed_s;
            let to_norm = (facts.get)(controls) + by_norm;
            (facts.set)(controls, clamp(to_norm, facts.travel.low_norm(), 1.0));
        }
        for binding in &device.button {
            let Some((control, way)) = binding.control.trims() else { continue };
            let facts = control.facts();
            if !(binding.control.facts().is_on)(controls) {
                continue;
            }
            let rate_norm_per_s = binding.rate_norm_per_s.unwrap_or(TRIM_NORM_PER_S);
            let was_norm = trim(controls, facts);
            let now_norm = clamp(was_norm + way * rate_norm_per_s * passed_s, -1.0, 1.0);
            put_trim(controls, facts, now_norm);
            let to_norm = (facts.get)(controls) + (now_norm - was_norm);
            (facts.set)(controls, clamp(to_norm, -1.0, 1.0));
        }
    }
}

/// The release button is let go: where stick and pedals are they are at rest, and the hardware, which is
/// still held there, takes them over when it is back in its middle.
fn trim_here(map: &Params, controls: &mut State) {
    for &control in AxisControl::ALL {
        let (place, facts) = (control as u64, control.facts());
        if facts.trim.is_none() {
            continue;
        }
        let bound = |axis: &&AxisBinding| axis.control == control;
        let binding = map.device.iter().flat_map(|device| &device.axis).find(bound);
        let remembered = binding.is_some_and(AxisBinding::is_remembered);
        let at_norm = (facts.get)(controls);
        let deflection_norm = if remembered || controls.pick_up.waits(place) {
            hardware(controls, facts)
        } else {
            at_norm - trim(controls, facts)
        };
        put_trim(controls, facts, at_norm);
        let waits = deflection_norm.abs() > PICK_UP_WITHIN_NORM;
        controls.pick_up.wait(place, waits);
        controls.force_trim.put_above(place, waits && deflection_norm > 0.0);
        if !remembered {
            put_hardware(controls, facts, if waits { deflection_norm } else { 0.0 });
        }
    }
}

/// The controls `now`, as a reset, a loaded situation or a new start has them, with the hardware as it was
/// in `was`: what does not stand there waits for pick-up.
#[must_use]
pub fn await_pick_up(map: &Params, was: &State, now: &State) -> State {
    let mut controls = *now;
    controls.pick_up = was.pick_up;
    // Switches are held as they were, the trim is the new one.
    controls.force_trim.released = was.force_trim.released;
    for device in map.device.iter().filter(|device| device.pick_up == Some(true)) {
        for binding in &device.axis {
            let (place, facts) = (binding.control as u64, binding.control.facts());
            if facts.springs_back || binding.rate_norm_per_s != 0.0 {
                continue;
            }
            let deflection_norm = if binding.is_remembered() || was.pick_up.waits(place) {
                hardware(was, facts)
            } else {
                (facts.get)(was) - trim(was, facts)
            };
            let remembered = binding.is_remembered();
            take_over(&mut controls, binding.control, deflection_norm, remembered, Told::Found);
        }
    }
    controls
}

/// A control that waits for its hardware.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waiting {
    /// Which.
    pub control: AxisControl,
    /// Where it is, and stays until then.
    pub at_norm: f64,
    /// Where the hardware would put it; nothing of a flap lever, which has detents.
    pub hardware_norm: Option<f64>,
    /// Whether the hardware has to come up to it, or right or aft; else down, left or forward.
    pub up: bool,
}

/// The controls that wait for pick-up.
pub fn waiting(controls: &State) -> impl Iterator<Item = Waiting> {
    AxisControl::ALL.iter().filter(|control| controls.pick_up.waits(**control as u64)).map(
        |&control| Waiting {
            control,
            at_norm: (control.facts().get)(controls),
            hardware_norm: control
                .facts()
                .hardware
                .map(|_| asked_for(controls, control.facts(), hardware(controls, control.facts()))),
            up: !controls.force_trim.is_above(control as u64),
        },
    )
}

fn hardware(controls: &State, facts: &AxisFacts) -> f64 {
    let mut hardware = controls.pick_up.hardware;
    facts.hardware.map_or(0.0, |of| *of(&mut hardware))
}

fn put_hardware(controls: &mut State, facts: &AxisFacts, at_norm: f64) {
    if let Some(of) = facts.hardware {
        // No −0.0 in the state.
        *of(&mut controls.pick_up.hardware) = at_norm + 0.0;
    }
}

fn trim(controls: &State, facts: &AxisFacts) -> f64 {
    let mut trim = controls.force_trim;
    facts.trim.map_or(0.0, |of| *of(&mut trim))
}

fn put_trim(controls: &mut State, facts: &AxisFacts, at_norm: f64) {
    if let Some(of) = facts.trim {
        *of(&mut controls.force_trim) = at_norm + 0.0;
    }
}

/// The raw value as a control position: −1 … 1, or 0 … 1 for those that start at an end.
fn position(binding: &AxisBinding, event: &DeviceEvent) -> f64 {
    let Some((raw, low, high)) = travelled(event, binding.raw_min, binding.raw_max) else {
        return 0.0;
    };
    let from_end = binding.side != Side::Both
        || binding.control.facts().travel == Travel::FromEnd && binding.rate_norm_per_s == 0.0;
    if from_end {
        let travel = clamp((raw - low) / (high - low), 0.0, 1.0);
        return if binding.inverted { 1.0 - travel } else { travel };
    }
    let x = match binding.raw_centre.map(|centre| centre as f64) {
        Some(centre) if (centre - low) * (high - centre) > 0.0 => {
            let end =
                if (raw - centre) * (high - low) > 0.0 { high - centre } else { centre - low };
            clamp((raw - centre) / end, -1.0, 1.0)
        }
        _ => centred(raw, low, high),
    };
    let x = if binding.inverted { -x } else { x };
    let dead = clamp(binding.dead_norm, 0.0, 0.99);
    let beyond = (x.abs() - dead) / (1.0 - dead);
    if beyond <= 0.0 {
        return 0.0;
    }
    let expo = clamp(binding.expo_norm, 0.0, 1.0);
    sign(x) * ((1.0 - expo) * beyond + expo * beyond * beyond * beyond)
}

/// Raw value and both ends of travel, as floating-point numbers, because the difference of two of any size
/// may not be an i64. The ends are those of the map, then those that the device tells, then ±32767;
/// nothing when both are the same.
fn travelled(
    event: &DeviceEvent,
    raw_min: Option<i64>,
    raw_max: Option<i64>,
) -> Option<(f64, f64, f64)> {
    let told = event.raw_min < event.raw_max;
    let low = raw_min.unwrap_or(if told { event.raw_min } else { -32767 });
    let high = raw_max.unwrap_or(if told { event.raw_max } else { 32767 });
    (low != high).then_some((event.value as f64, low as f64, high as f64))
}

/// −1 … 1. Both distances before they are divided: then the mirrored raw value is the mirrored position.
fn centred(raw: f64, low: f64, high: f64) -> f64 {
    clamp(((raw - low) - (high - raw)) / (high - low), -1.0, 1.0)
}

#[cfg(test)]
mod tests;
