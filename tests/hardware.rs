//! Devices that people fly with, as the kernel would show them, that come and go as they please.
//!
//! `devices/stage.py` plugs them in and out through umockdev's library; every flight is reflown exactly.

#![cfg(all(target_os = "linux", feature = "sticks"))]

mod common;
#[path = "hardware/fake.rs"]
mod fake;
#[path = "hardware/stage.rs"]
mod stage;

use common::{OK, text, tiltrotor};
use engine::cockpit::AxisControl;
use engine::inputs::{DeviceEvent, EventKind};
use fake::{Fake, PAUSE, known};
use stage::{Flown, Job, can_stage};

/// The devices sweep all their axes, with the shipped maps.
fn sweep(name: &str, labels: &[&str], seconds: u32) -> Flown {
    let devices: Vec<Fake> = labels.iter().map(|label| known(label)).collect();
    let plan: Vec<_> = labels.iter().map(|label| (0.3, "play", *label, "sweep")).collect();
    Job { name, devices: &devices, there: labels, plan: &plan, seconds, ..Job::default() }.fly()
}

fn kinds(flown: &Flown, kind: EventKind) -> usize {
    flown.events.iter().filter(|event| event.kind == kind as u64).count()
}

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
fn a_throttle_that_is_plugged_in_late_has_full_travel() {
    if !can_stage() {
        return;
    }
    let devices = ["x56stick", "x56throttle"].map(known);
    let flown = Job {
        name: "late",
        devices: &devices,
        there: &["x56stick"],
        plan: &[
            (0.2, "play", "x56stick", "sweep"),
            (1.0, "plug", "x56throttle", ""),
            (1.6, "play", "x56throttle", "sweep"),
        ],
        seconds: 5,
        ..Job::default()
    }
    .fly();
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
    assert_eq!(kinds(&flown, EventKind::Connected), 2);
    assert!(
        flown.reader.devices.iter().any(|device| device.product == 0xa221 && device.mapped == 1)
    );
    flown.says("is plugged in");
}

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

/// The stick is pushed to the right, half way between the middle and its end.
const RIGHT: &[(u16, u16, i32)] = &[(3, 0, 12288)];

#[test]
fn unplugging_is_told_and_plugging_in_again_is_picked_up() {
    if !can_stage() {
        return;
    }
    // What is plugged in again gets another node; what udev alone has lost keeps it.
    let again = Fake { label: "again", number: 34, ..known("t16000m") };
    let devices = [known("t16000m"), again];
    let mut later = RIGHT.to_vec();
    later.push((PAUSE, 0, 26));
    later.extend(devices[0].sweep());
    let map = "[[device]]\nname = \"T.16000M\"\naxis = [\
               { code = \"ABS_X\", control = \"stick_right\" },\
               { code = \"ABS_THROTTLE\", control = \"collective\", inverted = true }]";
    for (name, plan) in [
        (
            "replug",
            &[
                (0.2, "play", "t16000m", "right"),
                (1.0, "unplug", "t16000m", ""),
                (2.0, "plug", "again", ""),
                (2.6, "play", "again", "sweep"),
            ][..],
        ),
        (
            "udev",
            &[
                (0.2, "play", "t16000m", "later"),
                (1.0, "vanish", "t16000m", ""),
                (2.0, "appear", "t16000m", ""),
            ],
        ),
    ] {
        let flown = Job {
            name,
            devices: &devices,
            there: &["t16000m"],
            scripts: &[("t16000m", "right", RIGHT), ("t16000m", "later", &later)],
            plan,
            map: Some(map),
            seconds: 6,
            ..Job::default()
        }
        .fly();
        flown.says("WARNING: device 0, Thrustmaster T.16000M, is unplugged");
        flown.says("device 0, Thrustmaster T.16000M, is plugged in");
        // Back in its middle it waits, because the aircraft has the stick to the right.
        flown.says("stick right waits for pick-up: move it right until it takes over");
        flown.says("stick right is picked up");
        let unplugged = flown.events.iter().position(|e| e.kind == EventKind::Disconnected as u64);
        let tick = flown.events[unplugged.expect("unplugged")].tick;
        let held = flown.cockpits[tick as usize + 200].stick_right_norm;
        assert!((held - 0.5).abs() < 1e-3, "{held}");
        flown.full("stick right", |c| c.stick_right_norm, -1.0);
        let info = tiltrotor(&["log", "info", text(&flown.log)]).ends(OK);
        info.says("device 0 disconnected").says("device 0 connected");
    }
}

#[test]
fn a_hang_up_without_udev_is_noticed_and_not_spun_on() {
    if !can_stage() {
        return;
    }
    let devices = ["t16000m", "trudder"].map(known);
    let flown = Job {
        name: "hang-up",
        devices: &devices,
        there: &["t16000m", "trudder"],
        scripts: &[("t16000m", "right", RIGHT)],
        plan: &[(0.2, "play", "t16000m", "right"), (1.0, "hang_up", "t16000m", "")],
        seconds: 6,
        ..Job::default()
    }
    .fly();
    flown.says("WARNING: device 0, Thrustmaster T.16000M, is unplugged");
    assert_eq!(kinds(&flown, EventKind::Disconnected), 1);
    assert!(flown.cpu_s < 4.5, "{} s of the processor in a flight of 6 s", flown.cpu_s);
}

#[test]
fn a_stick_is_replaced_by_another_of_its_kind() {
    if !can_stage() {
        return;
    }
    let other = Fake {
        label: "other",
        id: [0x44f, 0xb10a, 0x500],
        number: 31,
        axes: vec![(0, 512, 0, 1023), (1, 512, 0, 1023), (6, 1023, 0, 1023)],
        ..known("t16000m")
    };
    let devices = [known("t16000m"), other];
    let flown = Job {
        name: "replaced",
        devices: &devices,
        there: &["t16000m"],
        plan: &[
            (0.5, "unplug", "t16000m", ""),
            (1.0, "plug", "other", ""),
            (1.6, "play", "other", "sweep"),
        ],
        seconds: 4,
        ..Job::default()
    }
    .fly();
    flown.stick_is_full();
    flown.full("collective", |c| c.collective_norm, 0.0);
    let versions: Vec<u64> = flown.reader.devices.iter().map(|device| device.version).collect();
    assert_eq!(versions, [0x111, 0x500]);
    assert!(flown.reader.devices.iter().all(|device| (device.device, device.mapped) == (0, 1)));
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
fn lost_events_are_recorded_with_what_is_asked_for_anew() {
    if !can_stage() {
        return;
    }
    let devices = [known("t16000m")];
    let lost: &[(u16, u16, i32)] = &[(3, 0, 16383), (3, 1, 0), (0, 3, 0), (3, 0, 0), (3, 1, 16383)];
    let flown = Job {
        name: "lost",
        devices: &devices,
        there: &["t16000m"],
        scripts: &[("t16000m", "lost", lost)],
        plan: &[(0.3, "play", "t16000m", "lost")],
        seconds: 3,
        ..Job::default()
    }
    .fly();
    assert_eq!(kinds(&flown, EventKind::Dropped), 1);
    let at = flown.events.iter().position(|event| event.kind == EventKind::Dropped as u64);
    let after = &flown.events[at.expect("lost") + 1..];
    let asked = |code: u64| {
        let of_code = |event: &&DeviceEvent| event.code == code;
        after.iter().find(of_code).map(|event| (event.kind, event.value, event.raw_max))
    };
    // The device says that both are in their middle; that is where they are then, and the hat still is.
    assert_eq!(asked(0), Some((EventKind::Axis as u64, 8192, 16383)));
    assert_eq!(asked(1), Some((EventKind::Axis as u64, 8192, 16383)));
    assert_eq!(asked(17), Some((EventKind::AxisPosition as u64, 0, 1)));
    tiltrotor(&["log", "info", text(&flown.log)]).ends(OK).says("the kernel lost events");
}

#[test]
fn a_lever_that_stands_elsewhere_than_the_trim_does_not_jump() {
    if !can_stage() {
        return;
    }
    let mut stick = known("t16000m");
    stick.axes[3].1 = 230;
    let devices = [stick];
    let moves: &[(u16, u16, i32)] = &[(3, 6, 229), (3, 6, 200), (3, 6, 20), (3, 6, 0)];
    let flown = Job {
        name: "pick-up",
        devices: &devices,
        there: &["t16000m"],
        scripts: &[("t16000m", "moves", moves)],
        plan: &[(0.3, "play", "t16000m", "moves")],
        more: &["--from-trim", "--altitude-ft", "3000"],
        seconds: 3,
        ..Job::default()
    }
    .fly();
    let trimmed = flown.cockpits[0].collective_norm;
    assert!((0.2..0.9).contains(&trimmed), "{trimmed}");
    flown.says("collective waits for pick-up: move it up until it takes over");
    flown.says("collective is picked up");
    let counted = |value| flown.events.iter().find(|e| (e.code, e.value) == (6, value));
    let at = |value| flown.cockpits[counted(value).expect("a count").tick as usize].collective_norm;
    assert_eq!((at(229).to_bits(), at(200).to_bits()), (trimmed.to_bits(), trimmed.to_bits()));
    assert!((at(20) - 235.0 / 255.0).abs() < 1e-9);
    let waits = &flown.cockpits[counted(229).expect("a count").tick as usize];
    let waiting: Vec<_> = engine::cockpit::waiting(waits).map(|waits| waits.control).collect();
    assert!(waiting.contains(&AxisControl::Collective), "{waiting:?}");
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
