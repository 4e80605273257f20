use alloc::vec;
use alloc::vec::Vec;

use super::*;

fn axis(control: AxisControl) -> AxisBinding {
    AxisBinding {
        code: Codes::one(Code::Axis(1)),
        control,
        raw_min: Some(0),
        raw_max: Some(200),
        raw_centre: None,
        inverted: false,
        dead_norm: 0.1,
        expo_norm: 0.0,
        reach_norm: 1.0,
        side: Side::Both,
        rate_norm_per_s: 0.0,
        fallback: false,
        when_unplugged: WhenUnplugged::Centre,
    }
}

fn stick(button: ButtonControl) -> Params {
    Params {
        device: vec![Device {
            name: "stick".into(),
            axis: vec![axis(AxisControl::StickAft)],
            button: vec![pressing(button)],
            ..Device::default()
        }],
    }
}

fn pressing(control: ButtonControl) -> ButtonBinding {
    ButtonBinding {
        code: Codes::one(Code::Key(2)),
        control,
        mode: None,
        inverted: false,
        beyond_norm: None,
        rate_norm_per_s: None,
    }
}

fn update(map: &Params, state: &State, events: &[DeviceEvent]) -> State {
    super::update(map, state, events, crate::STEP_S)
}

fn at(binding: &AxisBinding, value: i64) -> f64 {
    position(binding, &DeviceEvent { value, ..DeviceEvent::default() })
}

fn event(kind: EventKind, code: u64, value: i64) -> DeviceEvent {
    DeviceEvent { kind: kind as u64, code, value, ..DeviceEvent::default() }
}

#[test]
fn an_axis_reaches_its_ends_and_rests_in_its_dead_zone() {
    let binding = axis(AxisControl::StickAft);
    for (raw, norm) in [(-5, -1.0), (0, -1.0), (95, 0.0), (100, 0.0), (109, 0.0), (200, 1.0)] {
        assert!((at(&binding, raw) - norm).abs() < 1e-15, "{raw}");
    }
    let left = at(&binding, 30);
    let right = at(&binding, 170);
    assert_eq!(left.to_bits(), (-right).to_bits());
}

#[test]
fn mirrored_raw_values_are_mirrored_positions_to_the_bit() {
    let binding = AxisBinding {
        raw_min: Some(-32767),
        raw_max: Some(32767),
        expo_norm: 0.3,
        ..axis(AxisControl::StickRight)
    };
    for raw in 0..=32767 {
        let (left, right) = (at(&binding, -raw), at(&binding, raw));
        assert_eq!((left + right).to_bits(), 0, "{raw}");
    }
}

#[test]
fn a_device_that_tells_its_range_has_its_full_travel_unless_the_map_says_otherwise() {
    let mapped = axis(AxisControl::StickAft);
    let plain = AxisBinding { raw_min: None, raw_max: None, dead_norm: 0.0, ..mapped.clone() };
    let told = |binding: &AxisBinding, value: i64| {
        position(binding, &DeviceEvent { value, raw_max: 1023, ..DeviceEvent::default() })
    };
    for (low, high) in [
        (told(&plain, 0), told(&plain, 1023)),
        (told(&mapped, 0), told(&mapped, 200)),
        (at(&plain, -32767), at(&plain, 32767)),
    ] {
        assert_eq!((low + 1.0).to_bits(), 0, "{low}");
        assert_eq!((high - 1.0).to_bits(), 0, "{high}");
    }
}

#[test]
fn what_is_only_found_out_moves_nothing() {
    let map = stick(ButtonControl::GearToggle);
    let found = [
        event(EventKind::AxisPosition, 1, 200),
        event(EventKind::ButtonPosition, 2, 1),
        event(EventKind::Dropped, 0, 3),
    ];
    assert_eq!(update(&map, &State::default(), &found), State::default());
}

#[test]
fn no_raw_value_is_too_large() {
    let mut binding = axis(AxisControl::StickAft);
    (binding.raw_min, binding.raw_max) = (Some(i64::MIN), Some(i64::MAX));
    assert_eq!(at(&binding, i64::MIN).to_bits(), f64::to_bits(-1.0));
    assert_eq!(at(&binding, i64::MAX).to_bits(), f64::to_bits(1.0));
}

#[test]
fn an_unplugged_hat_lets_go_of_the_nacelles_even_where_axes_hold() {
    let hat = AxisBinding { when_unplugged: WhenUnplugged::Hold, ..axis(AxisControl::NacelleAft) };
    let device = Device { axis: vec![hat], ..Device::default() };
    let map = Params { device: vec![device] };
    let held = update(&map, &State::default(), &[event(EventKind::Axis, 1, 200)]);
    assert_eq!(held.nacelle_aft_norm.to_bits(), f64::to_bits(1.0));
    let gone = update(&map, &held, &[event(EventKind::Disconnected, 0, 0)]);
    assert_eq!(gone.nacelle_aft_norm.to_bits(), 0);
}

#[test]
fn a_lever_starts_at_its_end() {
    assert!((at(&axis(AxisControl::Collective), 50) - 0.25).abs() < 1e-15);
}

#[test]
fn an_unplugged_stick_goes_where_the_map_says() {
    let map = stick(ButtonControl::NacelleForward);
    let held = update(
        &map,
        &State::default(),
        &[event(EventKind::Axis, 1, 200), event(EventKind::Button, 2, 1)],
    );
    assert_eq!((held.stick_aft_norm, held.nacelle_aft_norm), (1.0, -1.0));
    let gone = update(&map, &held, &[event(EventKind::Disconnected, 0, 0)]);
    assert_eq!((gone.stick_aft_norm, gone.nacelle_aft_norm), (0.0, 0.0));
}

#[test]
fn a_button_acts_when_pressed_not_when_released() {
    let map = stick(ButtonControl::Marker);
    let press = event(EventKind::Button, 2, 1);
    let release = event(EventKind::Button, 2, 0);
    let state = update(&map, &State::default(), &[press, release, press, release]);
    assert_eq!(state.markers, 2);
}

#[test]
fn nonsense_changes_nothing() {
    let map = stick(ButtonControl::Marker);
    let mut wrong = event(EventKind::Axis, 1, 3);
    wrong.device = u64::MAX;
    let mut kind = event(EventKind::Axis, 1, 3);
    kind.kind = 99;
    assert_eq!(update(&map, &State::default(), &[wrong, kind]), State::default());
}

/// The key is what maps are written with.
#[test]
fn a_key_of_the_list_is_the_name_in_a_map() {
    use serde::Deserialize;
    use serde::de::value::{Error, StrDeserializer};
    for &control in AxisControl::ALL {
        let name = StrDeserializer::<Error>::new(control.facts().key);
        assert_eq!(AxisControl::deserialize(name), Ok(control));
    }
    for &control in ButtonControl::ALL {
        let name = StrDeserializer::<Error>::new(control.facts().key);
        assert_eq!(ButtonControl::deserialize(name), Ok(control));
    }
}

#[test]
fn an_axis_goes_as_far_as_its_list_says() {
    for &control in AxisControl::ALL {
        let binding = AxisBinding { dead_norm: 0.0, ..axis(control) };
        let low_norm = control.facts().travel.low_norm();
        let ends = [(0, low_norm), (200, 1.0), (-50, low_norm), (999, 1.0)];
        for (raw, at_norm) in ends {
            assert!((at(&binding, raw) - at_norm).abs() < 1e-15, "{control:?} at {raw}");
        }
    }
}

#[test]
fn no_two_axes_move_the_same() {
    let moved: Vec<State> = AxisControl::ALL
        .iter()
        .map(|control| {
            let mut controls = State::default();
            (control.facts().set)(&mut controls, 1.0);
            controls
        })
        .collect();
    for (i, one) in moved.iter().enumerate() {
        assert_ne!(*one, State::default(), "{:?} moves nothing", AxisControl::ALL[i]);
        assert!(!moved[..i].contains(one), "{:?} moves what another does", AxisControl::ALL[i]);
    }
}

/// A device whose controls are picked up, and one event of axis 1 at a raw value, of 0 to 200.
fn picked_up(binding: AxisBinding) -> Params {
    let device = Device { axis: vec![binding], pick_up: Some(true), ..Device::default() };
    Params { device: vec![device] }
}

fn lever() -> Params {
    picked_up(axis(AxisControl::Collective))
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn a_lever_elsewhere_than_the_trim_waits_until_it_crosses() {
    let map = lever();
    let trimmed = State { collective_norm: 0.81, ..State::default() };
    let found = update(&map, &trimmed, &[event(EventKind::AxisPosition, 1, 122)]);
    assert!(near(found.collective_norm, 0.81));
    let told: Vec<_> = waiting(&found).collect();
    let expected = Waiting {
        control: AxisControl::Collective,
        at_norm: 0.81,
        hardware_norm: Some(0.61),
        up: true,
    };
    assert_eq!(told, [expected]);
    assert!(near(found.pick_up.hardware.collective_norm, 0.61));
    let moved = update(&map, &found, &[event(EventKind::Axis, 1, 100)]);
    assert!(near(moved.collective_norm, 0.81) && waiting(&moved).count() == 1);
    let crossed = update(&map, &moved, &[event(EventKind::Axis, 1, 180)]);
    assert!(near(crossed.collective_norm, 0.9));
    assert_eq!(crossed.pick_up, crate::controls::PickUp::default());
    assert_eq!(crossed.force_trim, crate::controls::ForceTrim::default());
    let followed = update(&map, &crossed, &[event(EventKind::Axis, 1, 20)]);
    assert!(near(followed.collective_norm, 0.1));
}

#[test]
fn a_lever_that_comes_close_is_there() {
    let map = lever();
    let trimmed = State { collective_norm: 0.5, ..State::default() };
    let near_by = update(&map, &trimmed, &[event(EventKind::AxisPosition, 1, 102)]);
    assert_eq!(waiting(&near_by).count(), 0);
    let below = update(&map, &trimmed, &[event(EventKind::AxisPosition, 1, 40)]);
    let close = update(&map, &below, &[event(EventKind::Axis, 1, 98)]);
    assert!(near(close.collective_norm, 0.49) && waiting(&close).count() == 0);
}

#[test]
fn a_log_of_before_pick_up_flies_as_it_was_flown() {
    let mut map = lever();
    map.device[0].pick_up = None;
    let trimmed = State { collective_norm: 0.81, ..State::default() };
    let found = update(&map, &trimmed, &[event(EventKind::AxisPosition, 1, 122)]);
    assert_eq!(found, trimmed);
    let moved = super::update(&map, &trimmed, &[event(EventKind::Axis, 1, 100)], 0.0);
    assert!(near(moved.collective_norm, 0.5));
}

#[test]
fn what_is_moved_during_a_pause_is_picked_up_after_it() {
    let map = lever();
    let flown = update(&map, &State::default(), &[event(EventKind::Axis, 1, 100)]);
    let paused = super::update(&map, &flown, &[event(EventKind::Axis, 1, 160)], 0.0);
    assert!(near(paused.collective_norm, 0.5));
    let after = update(&map, &paused, &[event(EventKind::Axis, 1, 150)]);
    assert!(near(after.collective_norm, 0.5) && waiting(&after).count() == 1);
    let back = update(&map, &after, &[event(EventKind::Axis, 1, 90)]);
    assert!(near(back.collective_norm, 0.45));
}

#[test]
fn after_a_reset_the_lever_waits_where_the_start_has_it() {
    let map = lever();
    let flown = update(&map, &State::default(), &[event(EventKind::Axis, 1, 160)]);
    let start = await_pick_up(&map, &flown, &State::default());
    assert_eq!(start.collective_norm.to_bits(), 0);
    assert!(waiting(&start).all(|waits| !waits.up) && waiting(&start).count() == 1);
    // Reset once more while it waits: the hardware is still where it was.
    let again = await_pick_up(&map, &start, &State { collective_norm: 0.9, ..start });
    assert!(waiting(&again).all(|waits| waits.up) && waiting(&again).count() == 1);
    let same = await_pick_up(&map, &flown, &flown);
    assert_eq!(same, flown);
}

#[test]
fn nothing_waits_for_a_device_that_is_gone_and_one_that_comes_back_is_picked_up() {
    let mut binding = axis(AxisControl::Collective);
    binding.when_unplugged = WhenUnplugged::Hold;
    let map = picked_up(binding);
    let waits = update(
        &map,
        &State { collective_norm: 0.3, ..State::default() },
        &[event(EventKind::AxisPosition, 1, 200)],
    );
    let gone = update(&map, &waits, &[event(EventKind::Disconnected, 0, 0)]);
    assert_eq!((waiting(&gone).count(), gone.collective_norm), (0, 0.3));
    let back = [event(EventKind::Connected, 0, 0), event(EventKind::AxisPosition, 1, 200)];
    assert_eq!(waiting(&update(&map, &gone, &back)).count(), 1);
}

#[test]
fn a_flap_lever_is_at_the_nearest_detent_and_waits_like_others() {
    let map = picked_up(axis(AxisControl::FlapLever));
    for (raw, detent) in [(0, 0), (30, 0), (40, 1), (100, 2), (130, 2), (170, 3), (200, 3)] {
        let state = update(&map, &State::default(), &[event(EventKind::Axis, 1, raw)]);
        assert_eq!(state.flap_detent, detent, "{raw}");
    }
    let up = State { flap_detent: 2, ..State::default() };
    let found = update(&map, &up, &[event(EventKind::AxisPosition, 1, 0)]);
    assert_eq!((found.flap_detent, waiting(&found).count()), (2, 1));
    let over = update(&map, &found, &[event(EventKind::Axis, 1, 200)]);
    assert_eq!((over.flap_detent, waiting(&over).count()), (3, 0));
}

fn triggers(rate_norm_per_s: f64) -> Params {
    let half = |code, side| AxisBinding {
        code: Codes::one(Code::Axis(code)),
        raw_max: Some(1023),
        dead_norm: 0.0,
        side,
        rate_norm_per_s,
        ..axis(AxisControl::PedalRight)
    };
    let device = Device {
        axis: vec![half(5, Side::Upper), half(2, Side::Lower)],
        pick_up: Some(true),
        ..Device::default()
    };
    Params { device: vec![device] }
}

#[test]
fn two_triggers_are_pedals_that_rest_in_the_middle() {
    let map = triggers(0.0);
    let mut state = State::default();
    let mut at = |code, raw| {
        state = update(&map, &state, &[event(EventKind::Axis, code, raw)]);
        state.pedal_right_norm
    };
    assert_eq!(at(5, 1023).to_bits(), f64::to_bits(1.0));
    assert_eq!(at(2, 1023).to_bits(), 0, "both pressed");
    assert_eq!(at(5, 0).to_bits(), f64::to_bits(-1.0));
    assert_eq!(at(2, 0).to_bits(), 0);
    assert!((at(2, 512) + 512.0 / 1023.0).abs() < 2e-4);
    assert!((at(5, 512)).abs() < 2e-4);
}

#[test]
fn joined_triggers_wait_for_the_trim_as_a_lever_does() {
    let map = triggers(0.0);
    let trimmed = State { pedal_right_norm: 0.3, ..State::default() };
    let at_rest = [event(EventKind::AxisPosition, 5, 0), event(EventKind::AxisPosition, 2, 0)];
    let state = update(&map, &trimmed, &at_rest);
    assert_eq!(waiting(&state).count(), 1);
    let pressed = update(&map, &state, &[event(EventKind::Axis, 2, 1023)]);
    assert_eq!((waiting(&pressed).count(), pressed.pedal_right_norm), (1, 0.3));
    let other = [event(EventKind::Axis, 2, 0), event(EventKind::Axis, 5, 512)];
    let crossed = update(&map, &pressed, &other);
    assert_eq!(waiting(&crossed).count(), 0);
    assert!((crossed.pedal_right_norm - 512.0 / 1023.0).abs() < 1e-9);
}

#[test]
fn a_stick_that_springs_back_moves_a_lever_at_a_rate_and_not_during_a_pause() {
    let mut binding = axis(AxisControl::Collective);
    binding.rate_norm_per_s = 0.5;
    let map = picked_up(binding);
    let mut state = update(&map, &State::default(), &[event(EventKind::Axis, 1, 200)]);
    for _ in 1..125 {
        state = update(&map, &state, &[]);
    }
    assert!((state.collective_norm - 0.25).abs() < 1e-12, "{}", state.collective_norm);
    let paused = super::update(&map, &state, &[], 0.0);
    assert_eq!(paused, state);
    let rest = update(&map, &state, &[event(EventKind::Axis, 1, 100)]);
    assert_eq!(update(&map, &rest, &[]), rest);
    let found = update(&map, &rest, &[event(EventKind::AxisPosition, 1, 200)]);
    assert_eq!(update(&map, &found, &[]).collective_norm.to_bits(), rest.collective_norm.to_bits());
    let both = update(&triggers(1.0), &State::default(), &[event(EventKind::Axis, 5, 1023)]);
    assert!(near(both.pedal_right_norm, crate::STEP_S), "once a tick: {}", both.pedal_right_norm);
}

#[test]
fn keys_deflect_a_stick_while_they_are_held() {
    let key = |code, side| AxisBinding {
        code: Codes::one(Code::Key(code)),
        side,
        reach_norm: 0.5,
        ..axis(AxisControl::StickAft)
    };
    let device =
        Device { axis: vec![key(108, Side::Upper), key(103, Side::Lower)], ..Device::default() };
    let map = Params { device: vec![device] };
    let down = update(&map, &State::default(), &[event(EventKind::Button, 108, 1)]);
    assert!(near(down.stick_aft_norm, 0.5));
    let up = [event(EventKind::Button, 103, 1), event(EventKind::Button, 108, 0)];
    let up = update(&map, &down, &up);
    assert!((up.stick_aft_norm + 0.5).abs() < 2e-4, "{}", up.stick_aft_norm);
    let none = update(&map, &up, &[event(EventKind::Button, 103, 0)]);
    assert_eq!(none.stick_aft_norm.to_bits(), 0);
}

#[test]
fn the_trim_is_where_the_stick_was_let_go_and_the_middle_takes_it_over() {
    let mut map = stick(ButtonControl::ForceTrimRelease);
    map.device[0].pick_up = Some(true);
    map.device[0].axis[0].dead_norm = 0.0;
    let held = [
        event(EventKind::Axis, 1, 150),
        event(EventKind::Button, 2, 1),
        event(EventKind::Axis, 1, 160),
        event(EventKind::Button, 2, 0),
    ];
    let let_go = update(&map, &State::default(), &held);
    assert!(near(let_go.stick_aft_norm, 0.6) && near(let_go.force_trim.stick_aft_norm, 0.6));
    // The hand still holds it aft of its middle: twice as far it would be, had it taken over.
    let first = waiting(&let_go).next().expect("the stick waits");
    assert!(near(first.at_norm, 0.6) && !first.up, "{first:?}");
    assert!(near(first.hardware_norm.unwrap(), 1.0), "{first:?}");
    let back = update(&map, &let_go, &[event(EventKind::Axis, 1, 130)]);
    assert!(near(back.stick_aft_norm, 0.6) && waiting(&back).count() == 1);
    let nearer = waiting(&back).next().expect("the stick waits");
    assert!(near(nearer.hardware_norm.unwrap(), 0.9), "{nearer:?}");
    let centre = update(&map, &back, &[event(EventKind::Axis, 1, 100)]);
    assert!(near(centre.stick_aft_norm, 0.6) && waiting(&centre).count() == 0);
    let pushed = update(&map, &centre, &[event(EventKind::Axis, 1, 70)]);
    assert!(near(pushed.stick_aft_norm, 0.3));
}

#[test]
fn a_trim_switch_moves_stick_and_trim_while_it_is_held() {
    let map = stick(ButtonControl::TrimForward);
    let mut state = update(&map, &State::default(), &[event(EventKind::Button, 2, 1)]);
    for _ in 1..250 {
        state = update(&map, &state, &[]);
    }
    assert!((state.force_trim.stick_aft_norm + TRIM_NORM_PER_S).abs() < 1e-12);
    assert!((state.stick_aft_norm + TRIM_NORM_PER_S).abs() < 1e-12);
    let held = update(&map, &state, &[event(EventKind::Button, 2, 0)]);
    assert_eq!(update(&map, &held, &[]), held);
}

#[test]
fn a_switch_that_stays_says_where_the_gear_is_and_keeps_it_when_it_is_gone() {
    let map = stick(ButtonControl::GearDown);
    let down = State { gear_down: 1, ..State::default() };
    let found = update(&map, &down, &[event(EventKind::ButtonPosition, 2, 0)]);
    assert_eq!(found.gear_down, 1);
    let up = update(&map, &down, &[event(EventKind::Button, 2, 0)]);
    assert_eq!(up.gear_down, 0);
    let down = update(&map, &up, &[event(EventKind::Button, 2, 1)]);
    let gone = update(&map, &down, &[event(EventKind::Disconnected, 0, 0)]);
    assert_eq!(gone.gear_down, 1);
}

#[test]
fn a_latch_turns_over_and_an_inverted_switch_is_on_when_it_is_not_pressed() {
    let mut map = stick(ButtonControl::NacelleForward);
    map.device[0].button[0].mode = Some(Mode::Latch);
    let tap = [event(EventKind::Button, 2, 1), event(EventKind::Button, 2, 0)];
    let on = update(&map, &State::default(), &tap);
    assert!(near(on.nacelle_aft_norm, -1.0));
    assert!(near(update(&map, &on, &tap).nacelle_aft_norm, 0.0));
    let mut map = stick(ButtonControl::GearDown);
    map.device[0].button[0].inverted = true;
    assert_eq!(update(&map, &State::default(), &tap).gear_down, 1);
}

#[test]
fn an_axis_beyond_its_mark_is_a_button_pressed_once() {
    let mut map = stick(ButtonControl::FlapDown);
    let hat = |beyond_norm, control| ButtonBinding {
        code: Codes::one(Code::Axis(17)),
        beyond_norm: Some(beyond_norm),
        ..pressing(control)
    };
    map.device[0].button =
        vec![hat(0.5, ButtonControl::FlapDown), hat(-0.5, ButtonControl::FlapUp)];
    let mut state = State::default();
    let mut at = |value| {
        let event = DeviceEvent { raw_min: -10, raw_max: 10, ..event(EventKind::Axis, 17, value) };
        state = update(&map, &state, &[event]);
        state.flap_detent
    };
    assert_eq!([8, 9, 10, 0, 10, -10, -9, 0].map(&mut at), [1, 1, 1, 1, 2, 1, 1, 1]);
}

#[test]
fn a_middle_of_its_own_has_full_travel_to_both_ends() {
    let binding =
        AxisBinding { raw_centre: Some(50), dead_norm: 0.0, ..axis(AxisControl::StickAft) };
    for (raw, norm) in [(0, -1.0), (25, -0.5), (50, 0.0), (125, 0.5), (200, 1.0), (300, 1.0)] {
        assert!(near(at(&binding, raw), norm), "{raw}");
    }
}
