use engine::cockpit::Code;

use super::super::found::{Axis, Ignored, Kind, kind};
use super::super::shipped::{SHIPPED, shipped};
use super::*;

fn device(name: &str, (vendor, product): (u64, u64), axes: &[u64], keys: &[u64]) -> Found {
    let axis = |&code| Axis { code, raw_min: 0, raw_max: 255, value: Some(0) };
    let axes: Vec<Axis> = axes.iter().map(axis).collect();
    Found {
        node: format!("/dev/input/event-{name}"),
        name: name.into(),
        vendor,
        product,
        port: format!("port of {name}"),
        kind: kind(&axes, keys, false, false, false),
        axes,
        keys: keys.to_vec(),
        ..Found::default()
    }
}

fn t16000m() -> Found {
    let buttons: Vec<u64> = (0x120..0x130).collect();
    device("Thrustmaster T.16000M", (0x44f, 0xb10a), &[0, 1, 5, 6, 16, 17], &buttons)
}

fn pedals() -> Found {
    device("Saitek Pro Flight Rudder Pedals", (0x6a3, 0x763), &[0, 1, 5], &[])
}

fn gamepad() -> Found {
    device("Pad", (0x45e, 0x2ea), &[0, 1, 2, 3, 4, 5, 16, 17], &[304, 305, 307, 308, 310, 311])
}

fn there(found: &[Found]) -> Survey {
    Survey { found: found.to_vec(), ignored: Vec::new() }
}

fn map(text: &str) -> Params {
    aircraft::cockpit("map.toml", text).expect("a map")
}

fn combine(found: &[Found]) -> Plan {
    combined(&shipped().expect("the shipped maps"), &there(found)).expect("a plan")
}

/// What moves a control: code and device.
fn moves(plan: &Plan, control: AxisControl) -> Vec<(String, String)> {
    let of = |(number, found): &(usize, Found)| {
        let name = found.name.clone();
        let axes = plan.map.device[*number].axis.iter();
        let axes = axes.filter(|axis| axis.control == control).map(|axis| axis.code.to_string());
        axes.map(|code| (code, name.clone())).collect::<Vec<_>>()
    };
    plan.taken.iter().flat_map(of).collect()
}

#[test]
fn every_shipped_map_can_be_flown() {
    for map in SHIPPED {
        let read = aircraft::cockpit(map.name, map.text).unwrap_or_else(|e| panic!("{e}"));
        assert!(check(&read).is_empty(), "{}: {:?}", map.name, check(&read));
        assert!(!read.device.is_empty() && !map.what.is_empty(), "{}", map.name);
    }
}

#[test]
fn shipped_maps_are_combined_by_what_is_plugged_in() {
    let plan = combine(&[t16000m(), pedals()]);
    assert_eq!(moves(&plan, AxisControl::StickAft), [("ABS_Y".into(), t16000m().name)]);
    assert_eq!(moves(&plan, AxisControl::Collective), [("ABS_THROTTLE".into(), t16000m().name)]);
    assert_eq!(moves(&plan, AxisControl::PedalRight), [("ABS_RZ".into(), pedals().name)]);
    assert!(plan.remarks.iter().any(|r| r.contains("ABS_RZ of Thrustmaster T.16000M is not used")));
    // Without pedals the twist grip has them, and pedals that come later have their place.
    let alone = combine(&[t16000m()]);
    assert_eq!(moves(&alone, AxisControl::PedalRight), [("ABS_RZ".into(), t16000m().name)]);
    let late = pedals();
    let number = matching::number_of(&alone.map, &late, |number| number != 0).expect("a place");
    assert!(alone.map.device[number].id.contains(&"06a3:0763".to_string()));
}

#[test]
fn a_gamepad_gives_way_to_everything_else() {
    let alone = combine(&[gamepad()]);
    assert_eq!(moves(&alone, AxisControl::PedalRight).len(), 2, "two triggers");
    let beside = combine(&[gamepad(), pedals()]);
    assert_eq!(moves(&beside, AxisControl::PedalRight), [("ABS_RZ".into(), pedals().name)]);
    assert_eq!(moves(&beside, AxisControl::StickAft).len(), 1);
    let stick = combine(&[gamepad(), t16000m()]);
    assert_eq!(moves(&stick, AxisControl::StickAft), [("ABS_Y".into(), t16000m().name)]);
}

#[test]
fn a_second_stick_is_told_of_and_not_flown() {
    let mut second = t16000m();
    (second.node, second.port) = ("/dev/input/event9".into(), "another port".into());
    let plan = combine(&[t16000m(), second.clone()]);
    assert_eq!(plan.taken.len(), 1);
    let told = plan.remarks.iter().any(|remark| remark.contains("`port = \"another port\"`"));
    assert!(told, "{:?}", plan.remarks);
    // By its port it can be chosen.
    let chosen = map("[[device]]\nid = [\"044f:b10a\"]\nport = \"another port\"\naxis = [\
         { code = \"ABS_X\", control = \"stick_right\" }]");
    let plan = super::plan(&chosen, &there(&[t16000m(), second.clone()])).expect("a plan");
    assert_eq!(plan.taken, [(0, second)]);
}

#[test]
fn alternatives_are_the_first_that_the_device_has() {
    let text = "[[device]]\nname = \"ST290\"\naxis = [{ code = [\"ABS_THROTTLE\", \"ABS_Z\", \
                \"ABS_SLIDER\"], control = \"collective\" }]";
    let st290 = device("Saitek ST290 Pro", (0x6a3, 0x460), &[0, 1, 2, 5], &[0x120]);
    let plan = super::plan(&map(text), &there(&[st290])).expect("a plan");
    assert_eq!(plan.map.device[0].axis[0].code, Codes::one(Code::Axis(2)));
    // Of one that is not there every choice has its own number.
    let other = "[[device]]\nname = \"Pad\"\naxis = [{ code = 0, control = \"stick_right\" }]\n";
    let plan = super::plan(&map(&format!("{other}{text}")), &there(&[gamepad()])).expect("a plan");
    let codes: Vec<_> = plan.map.device.iter().map(|d| d.axis[0].code.to_string()).collect();
    assert_eq!(codes, ["ABS_X", "ABS_THROTTLE", "ABS_Z", "ABS_THROTTLE"]);
    let late = device("Saitek ST290 Pro", (0x6a3, 0x460), &[0, 1, 2, 5], &[0x120]);
    assert_eq!(matching::number_of(&plan.map, &late, |number| number != 0), Some(2));
}

#[test]
fn what_the_device_lacks_is_told_by_name() {
    let text = "[[device]]\nname = \"T.16000M\"\naxis = [{ code = \"ABS_RUDDER\", control = \
                \"pedal_right\" }, { code = 0, control = \"stick_right\" }]\n\
                button = [{ code = \"BTN_SOUTH\", control = \"marker\" }]";
    let plan = super::plan(&map(text), &there(&[t16000m()])).expect("a plan");
    let told = plan.remarks.join("; ");
    assert!(told.contains("has no ABS_RUDDER: nothing there moves pedal right"), "{told}");
    assert!(told.contains("has no BTN_SOUTH: nothing there moves marker"), "{told}");
}

#[test]
fn two_devices_that_move_the_same_are_refused_by_name() {
    let text = "[[device]]\nname = \"T.16000M\"\naxis = [{ code = 5, control = \"pedal_right\" }]\n\
                [[device]]\nname = \"Pedals\"\naxis = [{ code = 5, control = \"pedal_right\" }]";
    let error = super::plan(&map(text), &there(&[t16000m(), pedals()])).expect_err("a clash");
    let words = error.to_string();
    for name in ["Thrustmaster T.16000M", "Rudder Pedals", "ABS_RZ", "pedal right"] {
        assert!(words.contains(name), "{name}: {words}");
    }
}

#[test]
fn a_missing_device_is_told_of_and_a_required_one_refused() {
    let text = |required| {
        format!(
            "[[device]]\nname = \"T.16000M\"\naxis = [{{ code = 0, control = \"stick_right\" }}]\n\
             [[device]]\nname = \"Pedals\"\nrequired = {required}\n\
             axis = [{{ code = 5, control = \"pedal_right\" }}]"
        )
    };
    let optional = map(&text(false));
    let plan = super::plan(&optional, &there(&[t16000m()])).expect("a plan");
    let told = missing(&plan, &optional);
    assert_eq!(
        told,
        ["device 1, Pedals, is not plugged in: nothing moves pedal right until it is"]
    );
    let error = super::plan(&map(&text(true)), &there(&[t16000m()])).expect_err("it is required");
    assert!(error.to_string().contains("Pedals is not plugged in"), "{error}");
}

#[test]
fn nothing_found_says_what_was_seen_and_why_it_is_not_used() {
    let keys: Vec<u64> = (1..120).collect();
    let receiver = device("Nano Transceiver", (0x45e, 0x745), &[0, 1, 32], &keys);
    let mut survey = there(&[receiver, pedals()]);
    survey.ignored.push(Ignored {
        node: "/dev/input/event3".into(),
        name: "Secret Stick".into(),
        why: Why::Permission,
    });
    let nobody =
        map("[[device]]\nname = \"Nobody's\"\naxis = [{ code = 0, control = \"stick_right\" }]");
    let error = super::plan(&nobody, &survey).expect_err("nothing").to_string();
    for words in [
        "Nano Transceiver",
        "by its exact name",
        "Pedals",
        "does not know",
        "Secret Stick",
        "udev rule",
        "--map-new",
    ] {
        assert!(error.contains(words), "{words}: {error}");
    }
    let error = super::plan(&nobody, &Survey::default()).expect_err("nothing").to_string();
    assert!(error.contains("no input device at all"), "{error}");
}

#[test]
fn a_touchpad_of_the_same_name_is_not_taken_for_the_pad() {
    let mut touchpad = device("Wireless Controller", (0x54c, 0x9cc), &[0, 1], &[0x14a, 0x145]);
    touchpad.node = "/dev/input/event1".into();
    assert_eq!(touchpad.kind, Kind::Touchpad);
    let pad = Found { name: "Wireless Controller".into(), ..gamepad() };
    let text = "[[device]]\nname = \"Wireless Controller\"\naxis = [\
                { code = 0, control = \"stick_right\" }, { code = 1, control = \"stick_aft\" }]";
    let plan = super::plan(&map(text), &there(&[touchpad, pad.clone()])).expect("a plan");
    assert_eq!(plan.taken, [(0, pad)]);
}
