use engine::inputs::{DeviceEvent, EventKind};

use super::*;

/// Acts for so many ticks on controls that follow the events.
struct Cockpit {
    map: cockpit::Params,
    keyboard: Keyboard,
    orders: Orders,
    seen: Outputs,
    world: World,
    restart: Option<Restart>,
    events: Vec<DeviceEvent>,
}

impl Cockpit {
    fn new() -> Self {
        let map = aircraft::cockpit("keyboard.toml", aircraft::KEYBOARD_MAP).unwrap();
        let (keyboard, orders) = Keyboard::of(&map).unwrap();
        let mut seen = Outputs::default();
        seen.cockpit.collective_norm = 0.5;
        let world = World::default();
        Self { map, keyboard, orders, seen, world, restart: None, events: Vec::new() }
    }

    fn fly(&mut self, ticks: u64) {
        for _ in 0..ticks {
            let mut events = Vec::new();
            self.keyboard.act(
                &self.seen,
                &mut TickContext {
                    tick: self.seen.tick,
                    events: &mut events,
                    world: &mut self.world,
                    phase: &mut (0, ""),
                    done: &mut false,
                    gave_up: &mut None,
                    restart: &mut self.restart,
                    save: &mut false,
                },
            );
            self.seen.cockpit =
                cockpit::update(&self.map, &self.seen.cockpit, &events, engine::STEP_S);
            self.seen.tick += 1;
            self.events.extend(events);
        }
    }

    fn press(&mut self, action: KeyAction) {
        assert!(self.orders.give(Order::Press(action)));
    }
}

#[test]
fn nothing_moves_before_a_key_is_pressed() {
    let mut cockpit = Cockpit::new();
    cockpit.fly(100);
    assert!(cockpit.events.is_empty());
    assert_eq!(cockpit.seen.cockpit.collective_norm, 0.5);
}

#[test]
fn a_tap_deflects_the_stick_and_it_comes_back() {
    let mut cockpit = Cockpit::new();
    cockpit.press(KeyAction::StickAft);
    cockpit.fly(50);
    assert!((cockpit.seen.cockpit.stick_aft_norm - TAP_NORM).abs() < 1e-3);
    cockpit.fly(100);
    assert!(cockpit.seen.cockpit.stick_aft_norm.abs() < 1e-4);
    // Only what moved sent events.
    let axes: Vec<u64> = cockpit.events.iter().map(|event| event.code).collect();
    assert!(axes.iter().all(|&code| code == 1), "{axes:?}");
}

#[test]
fn a_step_of_the_lever_stays_and_begins_where_the_aircraft_has_it() {
    let mut cockpit = Cockpit::new();
    cockpit.press(KeyAction::LeverUp);
    cockpit.press(KeyAction::LeverDownFine);
    cockpit.fly(200);
    let at_norm = cockpit.seen.cockpit.collective_norm;
    assert!((at_norm - 0.515).abs() < 1e-4, "{at_norm}");
}

#[test]
fn the_nacelle_switch_is_released_when_the_key_no_longer_repeats() {
    let mut cockpit = Cockpit::new();
    cockpit.press(KeyAction::NacelleForward);
    cockpit.fly(100);
    cockpit.press(KeyAction::NacelleForward);
    cockpit.fly(100);
    assert_eq!(cockpit.seen.cockpit.nacelle_aft_norm, -1.0);
    cockpit.fly(100);
    assert_eq!(cockpit.seen.cockpit.nacelle_aft_norm, 0.0);
    let buttons = cockpit.events.iter().filter(|e| e.kind == EventKind::Button as u64);
    assert_eq!(buttons.count(), 2);
}

#[test]
fn wind_by_key_comes_from_ahead_and_turns() {
    let mut cockpit = Cockpit::new();
    cockpit.seen.euler.heading_rad = -std::f64::consts::FRAC_PI_2;
    for _ in 0..3 {
        cockpit.press(KeyAction::WindStronger);
    }
    cockpit.fly(1);
    let v = cockpit.world.wind_mps;
    assert!((v.y - mps_of_knots(15.0)).abs() < 1e-9 && v.x.abs() < 1e-9, "{v:?}");
    for _ in 0..4 {
        cockpit.press(KeyAction::WindWeaker);
    }
    cockpit.fly(1);
    assert_eq!(cockpit.world.wind_mps.norm(), 0.0);
}

#[test]
fn failures_freeze_and_resets_are_handed_on() {
    let mut cockpit = Cockpit::new();
    assert!(cockpit.orders.give(Order::Fail(Failures::GOVERNOR)));
    cockpit.press(KeyAction::Freeze);
    cockpit.press(KeyAction::ResetToMarker);
    cockpit.fly(1);
    assert_eq!((cockpit.world.failures, cockpit.world.paused), (Failures::GOVERNOR, 1));
    assert_eq!(cockpit.restart, Some(Restart::Marker));
    cockpit.restart = None;
    // The aircraft has the lever elsewhere now: a step goes on from there.
    cockpit.seen.cockpit.collective_norm = 0.2;
    cockpit.press(KeyAction::LeverUp);
    cockpit.press(KeyAction::MendAll);
    cockpit.fly(100);
    assert!((cockpit.seen.cockpit.collective_norm - 0.22).abs() < 1e-4);
    assert!(cockpit.world.failures.is_empty());
}

#[test]
fn every_key_has_its_own_action() {
    let keys: Vec<&str> = KeyAction::ALL.iter().map(|action| action.facts().on).collect();
    for (i, key) in keys.iter().enumerate() {
        assert!(!keys[..i].contains(key), "{key} stands twice");
    }
}
