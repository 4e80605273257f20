//! Which device a map means, and what is said where it means none; maps that are made by moving things.

use super::RIGHT;
use super::fake::{Fake, known};
use super::stage::{Job, can_stage};
use crate::common::{self, text};

#[test]
fn a_receiver_of_a_keyboard_is_only_taken_by_its_exact_name() {
    if !can_stage() {
        return;
    }
    let devices = ["nano", "extreme3d"].map(known);
    let map = |name: &str| {
        let stick = "[[device]]\nname = \"Extreme 3D\"\naxis = [{ code = \"ABS_X\", control = \
                     \"stick_right\" }]\n";
        format!(
            "{stick}[[device]]\nname = \"{name}\"\naxis = [{{ code = 0x20, control = \"collective\" }}]"
        )
    };
    let fly = |name, map: &str| {
        Job {
            name,
            devices: &devices,
            there: &["nano", "extreme3d"],
            plan: &[(0.2, "play", "nano", "sweep"), (0.2, "play", "extreme3d", "sweep")],
            map: Some(map),
            seconds: 3,
            ..Job::default()
        }
        .fly()
    };
    let part = fly("nano-part", &map("Transceiver"));
    assert!(part.reader.devices.iter().any(|device| device.vendor == 0x45e && device.mapped == 0));
    assert_eq!(part.reached(|c| c.collective_norm), (0.0, 0.0));
    part.says("Transceiver, is not plugged in: nothing moves collective until it is");
    let exact = fly("nano-exact", &map("microsoft nano transceiver V2.0"));
    exact.full("collective", |c| c.collective_norm, 0.0);
}

#[test]
fn two_of_the_same_name_are_told_apart_by_their_ports() {
    if !can_stage() {
        return;
    }
    let second = Fake { label: "second", number: 32, ..known("t16000m") };
    let port = second.port();
    let devices = [known("t16000m"), second];
    let plan = [(0.2, "play", "t16000m", "sweep"), (0.2, "play", "second", "right")];
    let job = |name, map| Job {
        name,
        devices: &devices,
        there: &["t16000m", "second"],
        scripts: &[("second", "right", RIGHT)],
        plan: &plan,
        map,
        seconds: 3,
        ..Job::default()
    };
    job("two", None).fly().says(&format!("`port = \"{port}\"`"));
    let map = format!(
        "[[device]]\nid = [\"044f:b10a\"]\nport = \"{port}\"\naxis = [{{ code = 0, control = \
         \"stick_right\" }}]"
    );
    let flown = job("chosen", Some(&map)).fly();
    let (least, most) = flown.reached(|c| c.stick_right_norm);
    assert!(least >= 0.0 && (most - 0.5).abs() < 1e-3, "{least} to {most}");
}

#[test]
fn a_touchpad_of_the_same_name_is_no_pad() {
    if !can_stage() {
        return;
    }
    let pad = Fake { name: "Wireless Controller", id: [0x54c, 0x9cc, 1], ..known("xpad") };
    let touchpad = Fake {
        label: "touchpad",
        number: 19,
        axes: vec![(0, 0, 0, 1919), (1, 0, 0, 941)],
        buttons: vec![0x110, 0x145, 0x14a],
        ..pad.clone()
    };
    let map = "[[device]]\nname = \"wireless controller\"\naxis = [\
               { code = 0, control = \"stick_right\" }, { code = 1, control = \"stick_aft\" }]";
    let devices = [touchpad, pad];
    let flown = Job {
        name: "touchpad",
        devices: &devices,
        there: &["touchpad", "xpad"],
        plan: &[(0.2, "play", "touchpad", "sweep"), (1.0, "play", "xpad", "sweep")],
        map: Some(map),
        seconds: 4,
        ..Job::default()
    }
    .fly();
    flown.stick_is_full();
    assert!(flown.events.iter().all(|event| event.raw_max != 1919));
}

#[test]
fn what_the_map_cannot_have_is_said_before_take_off() {
    if !can_stage() {
        return;
    }
    let devices = [known("t16000m")];
    let map = "[[device]]\nname = \"T.16000M\"\naxis = [\
               { code = \"ABS_RUDDER\", control = \"pedal_right\" },\
               { code = \"ABS_X\", control = \"stick_right\" }]\n\
               [[device]]\nname = \"T-Rudder\"\naxis = [{ code = 2, control = \"brake_left\" }]";
    let job =
        Job { name: "lacks", devices: &devices, there: &["t16000m"], seconds: 1, ..Job::default() };
    let flown = Job { map: Some(map), ..job }.fly();
    flown.says("Thrustmaster T.16000M has no ABS_RUDDER: nothing there moves pedal right");
    flown.says("device 1, T-Rudder, is not plugged in: nothing moves brake left until it is");
}

#[test]
fn devices_lists_what_is_there_and_a_map_is_made_by_moving_things() {
    if !can_stage() {
        return;
    }
    let devices = ["t16000m", "nano"].map(known);
    let there = ["t16000m", "nano"];
    let job = Job { name: "list", devices: &devices, there: &there, seconds: 5, ..Job::default() };
    let (status, said) = job.command(&["devices"]);
    assert_eq!(status, 0, "{said}");
    for words in [
        "/dev/input/event20  Thrustmaster T.16000M  044f:b10a  stick: 6 axes, 16 buttons",
        "device 0: stick right, stick aft, pedal right, collective",
        "not flown: a keyboard or its receiver",
        "ABS_THROTTLE 0..255",
        "fly with it: tiltrotor fly --stick",
    ] {
        assert!(said.contains(words), "{words}\n{said}");
    }
    let (status, said) = job.command(&["fly", "--stick", "--controls"]);
    assert_eq!(status, 0, "{said}");
    assert!(said.contains("ABS_THROTTLE   collective, inverted"), "{said}");

    let folder = common::folder("hardware-map-new");
    let map = folder.join("mine.toml");
    let moves: &[(u16, u16, i32)] = &[
        (3, 0, 16383),
        (3, 0, 8192),
        (3, 1, 16383),
        (3, 1, 8192),
        (3, 6, 0),
        (3, 5, 255),
        (3, 5, 128),
    ];
    let job = Job {
        name: "map-new",
        devices: &devices,
        there: &there,
        scripts: &[("t16000m", "moves", moves)],
        plan: &[(0.2, "play", "t16000m", "moves")],
        seconds: 20,
        ..Job::default()
    };
    let (status, said) =
        job.command(&["devices", "--map-new", text(&map), "--force", "--seconds", "1"]);
    assert_eq!(status, 0, "{said}");
    let made = std::fs::read_to_string(&map).expect("a map");
    for words in ["id = [\"044f:b10a\"]", "code = \"ABS_THROTTLE\"", "control = \"pedal_right\""] {
        assert!(made.contains(words), "{words}\n{made}\n{said}");
    }
    let flown = Job {
        name: "map-flown",
        map: Some(&made),
        scripts: &[],
        plan: &[(0.2, "play", "t16000m", "sweep")],
        seconds: 4,
        ..job
    }
    .fly();
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
}
