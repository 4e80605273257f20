//! Sticks, pedals, pads and keys with the maps that are shipped: every control from end to end.

use super::fake::{Fake, PAUSE, known};
use super::stage::{Job, can_stage};
use super::sweep;
use crate::common::{OK, text, tiltrotor};

#[test]
fn a_t16000m_and_pedals_without_buttons_have_full_travel() {
    if !can_stage() {
        return;
    }
    let flown = sweep("t16000m", &["t16000m", "trudder"], 5);
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
    flown.full("pedals", |c| c.pedal_right_norm, -1.0);
    flown.full("left brake", |c| c.brake_norm.left, 0.0);
    flown.full("right brake", |c| c.brake_norm.right, 0.0);
    flown.full("nacelles", |c| c.nacelle_aft_norm, -1.0);
    // The lever rests at its greatest raw value, which is down.
    assert!(flown.cockpits[50].collective_norm.abs() < 1e-12);
    flown.says("ABS_RZ of Thrustmaster T.16000M is not used");
    let info = tiltrotor(&["log", "info", text(&flown.log)]).ends(OK);
    info.says("Thrustmaster T.16000M, 0003:044f:b10a:0111").says("T-Rudder, 0003:044f:b679:0110");
}

#[test]
fn saitek_pedals_brake_each_wheel_in_proportion() {
    if !can_stage() {
        return;
    }
    let devices = ["extreme3d", "saitekpedals"].map(known);
    let half: &[(u16, u16, i32)] = &[(3, 0, 32), (3, 1, 96), (3, 5, 511), (3, 5, 0), (3, 0, 0)];
    let flown = Job {
        name: "saitek",
        devices: &devices,
        there: &["extreme3d", "saitekpedals"],
        scripts: &[("saitekpedals", "half", half)],
        plan: &[(0.3, "play", "extreme3d", "sweep"), (0.3, "play", "saitekpedals", "half")],
        seconds: 4,
        ..Job::default()
    }
    .fly();
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
    flown.full("pedals", |c| c.pedal_right_norm, -1.0);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    assert!(near(flown.reached(|c| c.brake_norm.left).1, 32.0 / 127.0));
    assert!(near(flown.reached(|c| c.brake_norm.right).1, 96.0 / 127.0));
}

#[test]
fn other_sticks_fly_by_what_they_have() {
    if !can_stage() {
        return;
    }
    // The throttle of the one is on ABS_Z, which the other does not have.
    let flown = sweep("st290", &["st290", "homemade"], 4);
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
    flown.full("pedals", |c| c.pedal_right_norm, -1.0);
    flown.full("left brake", |c| c.brake_norm.left, 0.0);
    let flown = sweep("x52", &["x52pro"], 6);
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
    flown.full("pedals", |c| c.pedal_right_norm, -1.0);
}

#[test]
fn a_gamepad_rests_in_the_middle_and_moves_the_lever_at_a_rate() {
    if !can_stage() {
        return;
    }
    let devices = [known("xpad")];
    let mut moves = vec![(3, 1, -32768), (PAUSE, 0, 4), (3, 1, -208), (PAUSE, 0, 5)];
    moves.extend(devices[0].sweep());
    let flown = Job {
        name: "gamepad",
        devices: &devices,
        there: &["xpad"],
        scripts: &[("xpad", "moves", &moves)],
        plan: &[(0.3, "play", "xpad", "moves")],
        seconds: 6,
        ..Job::default()
    }
    .fly();
    assert!(flown.cockpits[50].pedal_right_norm.abs() < 1e-12);
    assert!(flown.cockpits[50].stick_aft_norm.abs() < 1e-12);
    flown.full("pedals", |c| c.pedal_right_norm, -1.0);
    flown.stick_is_full();
    // 0.4 a second for half a second, as punctual as the stage is.
    let sweep = flown.events.iter().find(|event| (event.code, event.value) == (0, 32767));
    let lever = flown.cockpits[sweep.expect("the sweep").tick as usize].collective_norm;
    assert!((0.1..0.4).contains(&lever), "{lever}");
}

#[test]
fn a_radio_flies_with_switches_that_stay() {
    if !can_stage() {
        return;
    }
    let flown = sweep("radio", &["radio"], 5);
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
    flown.full("pedals", |c| c.pedal_right_norm, -1.0);
    let detents = flown.cockpits.iter().map(|c| c.flap_detent).max();
    assert_eq!(detents, Some(3));
    assert!(flown.cockpits.iter().any(|c| c.gear_down == 0));
}

#[test]
fn the_keyboard_flies_by_evdev_when_it_is_asked_for() {
    if !can_stage() {
        return;
    }
    let keyboard = Fake {
        label: "keyboard",
        name: "AT Translated Set 2 keyboard",
        number: 18,
        axes: Vec::new(),
        buttons: (1..128).collect(),
        ..Fake::default()
    };
    let keys: &[(u16, u16, i32)] =
        &[(1, 108, 1), (1, 104, 1), (1, 104, 2), (1, 104, 0), (1, 108, 0), (1, 50, 1), (1, 50, 0)];
    let devices = [keyboard];
    let job = Job {
        name: "keyboard",
        devices: &devices,
        there: &["keyboard"],
        scripts: &[("keyboard", "keys", keys)],
        plan: &[(0.3, "play", "keyboard", "keys")],
        more: &["--map", "evdev-keyboard"],
        seconds: 3,
        ..Job::default()
    };
    let flown = job.fly();
    assert!((flown.reached(|c| c.stick_aft_norm).1 - 0.4).abs() < 1e-9);
    let last = flown.cockpits.last().expect("a tick");
    assert!(last.collective_norm > 0.01 && last.collective_norm < 0.3, "{}", last.collective_norm);
    assert_eq!((last.stick_aft_norm, last.markers), (0.0, 1));
    // Nobody flies with it by itself.
    let (status, said) = Job { more: &[], plan: &[], ..job }.command(&["fly", "--stick"]);
    assert_eq!(status, 2);
    assert!(said.contains("no stick found") && said.contains("only by its exact name"), "{said}");
}
