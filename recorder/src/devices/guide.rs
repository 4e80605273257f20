//! A new map, by asking for one movement after the other and looking at what moves.

use engine::cockpit::{
    AxisBinding, AxisControl, ButtonBinding, ButtonControl, Code, Codes, Device, Params, Side,
    Travel, WhenUnplugged,
};
use engine::inputs::{DeviceEvent, EventKind};

use super::found::Found;

/// An axis has been moved when it has come so far, as a part of its range.
const MOVED_NORM: f64 = 0.35;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// An axis, towards its positive end.
    Axis(AxisControl),
    /// A button.
    Button(ButtonControl),
    /// The nacelle switch towards the helicopter: a hat, or a button.
    Nacelle,
}

/// What is asked for, in words and in order.
pub const STEPS: &[(&str, Wanted)] = &[
    ("push the stick fully to the right and let it go", Wanted::Axis(AxisControl::StickRight)),
    ("pull the stick fully back and let it go", Wanted::Axis(AxisControl::StickAft)),
    (
        "pull the collective fully up (throttle: push it fully)",
        Wanted::Axis(AxisControl::Collective),
    ),
    (
        "press the right pedal fully (or twist right) and let it go",
        Wanted::Axis(AxisControl::PedalRight),
    ),
    ("press the left toe brake and let it go", Wanted::Axis(AxisControl::BrakeLeft)),
    ("press the right toe brake and let it go", Wanted::Axis(AxisControl::BrakeRight)),
    ("nacelle switch (a hat or a button): towards the helicopter, and let it go", Wanted::Nacelle),
    (
        "nacelle button towards the aeroplane (skip it after a hat)",
        Wanted::Button(ButtonControl::NacelleForward),
    ),
    ("button for flaps down", Wanted::Button(ButtonControl::FlapDown)),
    ("button for flaps up", Wanted::Button(ButtonControl::FlapUp)),
    ("button for the gear", Wanted::Button(ButtonControl::GearToggle)),
    ("button for the parking brake", Wanted::Button(ButtonControl::ParkingBrakeToggle)),
    ("button for force trim release", Wanted::Button(ButtonControl::ForceTrimRelease)),
    ("button for the SCAS", Wanted::Button(ButtonControl::ScasToggle)),
    ("button for the rotor speed", Wanted::Button(ButtonControl::RpmSelect)),
    ("button for the marker", Wanted::Button(ButtonControl::Marker)),
];

/// Where an axis is, and where it was when the step began.
#[derive(Clone, Copy, Debug)]
struct Place {
    device: usize,
    code: u64,
    range: i64,
    from: i64,
    at: i64,
}

/// A map being made.
#[derive(Clone, Debug)]
pub struct Guide {
    map: Params,
    places: Vec<Place>,
    step: usize,
}

impl Guide {
    /// Nothing is mapped yet; the devices have the numbers of their places.
    pub fn new(found: &[Found]) -> Self {
        let twice = |one: &Found| found.iter().filter(|other| other.name == one.name).count() > 1;
        let device = |one: &Found| Device {
            name: one.name.clone(),
            id: vec![one.id()],
            port: if twice(one) { one.port.clone() } else { String::new() },
            ..Device::default()
        };
        let places = found.iter().enumerate().flat_map(|(device, found)| {
            found.axes.iter().map(move |axis| {
                let at = axis.value.unwrap_or((axis.raw_min + axis.raw_max) / 2);
                Place { device, code: axis.code, range: axis.raw_max - axis.raw_min, from: at, at }
            })
        });
        let map = Params { device: found.iter().map(device).collect() };
        Self { map, places: places.collect(), step: 0 }
    }

    /// What is asked for now; nothing when all has been.
    pub fn asks(&self) -> Option<&'static str> {
        STEPS.get(self.step).map(|(words, _)| *words)
    }

    /// Goes on without it.
    pub fn skip(&mut self) {
        self.step += 1;
        for place in &mut self.places {
            place.from = place.at;
        }
    }

    /// Looks at an event; says what was found when it is what was asked for.
    pub fn take(&mut self, event: &DeviceEvent) -> Option<String> {
        let device = usize::try_from(event.device).ok().filter(|at| *at < self.map.device.len())?;
        let wanted = STEPS.get(self.step)?.1;
        let found = match EventKind::from_u64(event.kind)? {
            EventKind::Axis => self.axis(device, event, wanted)?,
            EventKind::Button if event.value != 0 => self.button(device, event.code, wanted)?,
            _ => return None,
        };
        let words = format!("{found} of {}", self.map.device[device].name);
        self.skip();
        Some(words)
    }

    fn axis(&mut self, device: usize, event: &DeviceEvent, wanted: Wanted) -> Option<String> {
        let code = Code::Axis(event.code);
        let place = self
            .places
            .iter_mut()
            .find(|place| (place.device, place.code) == (device, event.code))?;
        place.at = event.value;
        let moved_norm = (place.at - place.from) as f64 / place.range.max(1) as f64;
        let is_hat = place.range <= 2;
        let bound = self.map.device[device].axes_of(code).next().is_some();
        if moved_norm.abs() < MOVED_NORM || bound {
            return None;
        }
        let control = match wanted {
            Wanted::Axis(control) if !is_hat => control,
            Wanted::Nacelle if is_hat => AxisControl::NacelleAft,
            _ => return None,
        };
        let is_centred = control.facts().travel == Travel::Centred && !is_hat;
        self.map.device[device].axis.push(AxisBinding {
            code: Codes::one(code),
            control,
            raw_min: None,
            raw_max: None,
            raw_centre: None,
            inverted: moved_norm < 0.0,
            dead_norm: if is_centred { 0.02 } else { 0.0 },
            expo_norm: if is_centred { 0.2 } else { 0.0 },
            reach_norm: 1.0,
            side: Side::Both,
            rate_norm_per_s: 0.0,
            fallback: false,
            when_unplugged: if control == AxisControl::Collective {
                WhenUnplugged::Hold
            } else {
                WhenUnplugged::Centre
            },
        });
        Some(code.name())
    }

    fn button(&mut self, device: usize, code: u64, wanted: Wanted) -> Option<String> {
        let code = Code::Key(code);
        let control = match wanted {
            Wanted::Button(control) => control,
            Wanted::Nacelle => ButtonControl::NacelleAft,
            Wanted::Axis(_) => return None,
        };
        if self.map.device[device].buttons_of(code).next().is_some() {
            return None;
        }
        self.map.device[device].button.push(ButtonBinding {
            code: Codes::one(code),
            control,
            mode: None,
            inverted: false,
            beyond_norm: None,
            rate_norm_per_s: None,
        });
        Some(code.name())
    }

    /// The map: the devices that something was found on.
    pub fn map(self) -> Params {
        let used = |device: &Device| !device.axis.is_empty() || !device.button.is_empty();
        Params { device: self.map.device.into_iter().filter(used).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::found::Axis;
    use super::*;

    #[test]
    fn what_moves_is_what_was_asked_for() {
        let axis = |code, raw_max, value| Axis { code, raw_min: 0, raw_max, value: Some(value) };
        let stick = Found {
            name: "Stick".into(),
            vendor: 0x44f,
            product: 0xb10a,
            axes: vec![axis(0, 1023, 512), axis(1, 1023, 512), axis(6, 255, 255), axis(16, 2, 1)],
            keys: vec![0x120],
            ..Found::default()
        };
        let mut guide = Guide::new(&[stick]);
        let moves = |code, value| DeviceEvent {
            kind: EventKind::Axis as u64,
            code,
            value,
            ..DeviceEvent::default()
        };
        assert!(guide.asks().is_some_and(|words| words.contains("right")));
        assert_eq!(guide.take(&moves(0, 600)), None, "too little");
        assert_eq!(guide.take(&moves(0, 1000)).as_deref(), Some("ABS_X of Stick"));
        assert_eq!(guide.take(&moves(0, 10)), None, "it springs back");
        assert_eq!(guide.take(&moves(1, 1023)).as_deref(), Some("ABS_Y of Stick"));
        assert_eq!(guide.take(&moves(6, 0)).as_deref(), Some("ABS_THROTTLE of Stick"));
        (0..3).for_each(|_| guide.skip());
        assert_eq!(guide.take(&moves(16, 2)).as_deref(), Some("ABS_HAT0X of Stick"));
        guide.skip();
        let press = DeviceEvent { kind: EventKind::Button as u64, value: 1, ..moves(0x120, 1) };
        assert_eq!(guide.take(&press).as_deref(), Some("BTN_TRIGGER of Stick"));
        let map = guide.map();
        let inverted: Vec<bool> = map.device[0].axis.iter().map(|axis| axis.inverted).collect();
        assert_eq!(inverted, [false, false, true, false]);
        assert_eq!(map.device[0].id, ["044f:b10a"]);
        assert!(super::super::check::check(&map).is_empty());
    }
}
