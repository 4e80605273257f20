//! Devices that come late, go, come back as another, or lose events; and controls that wait to be picked up.

use engine::cockpit::AxisControl;
use engine::inputs::{DeviceEvent, EventKind};

use super::fake::{Fake, PAUSE, known};
use super::stage::{Job, can_stage};
use super::{RIGHT, kinds};
use crate::common::{OK, text, tiltrotor};

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
