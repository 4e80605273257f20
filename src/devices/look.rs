//! What is plugged in, looked at.

use std::io::{self, BufRead, IsTerminal};
use std::path::Path;
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use engine::cockpit::{Code, Device, Params};
use engine::inputs::{DeviceEvent, EventKind};
use logs::output;
use recorder::devices::{self, Devices, Found, Guide, Plan, Why};

use crate::controls;
use crate::maps::cockpit_map;
use crate::status::Status;

/// How often bars are drawn.
const REDRAW: Duration = Duration::from_millis(100);

/// What is there, what of it would be flown with, and what not, and why.
pub fn list(map: Option<&Path>) -> Result<Status> {
    let mut survey = devices::survey();
    survey.ignored.extend(devices::taken(&survey));
    let survey = &survey;
    let plan = match map {
        Some(path) => devices::plan(&cockpit_map(path)?, survey),
        None => devices::combined(&devices::shipped()?, survey),
    };
    let plan = plan.map_err(|error| error.to_string());
    for found in &survey.found {
        describe(found, plan.as_ref().ok());
    }
    for ignored in &survey.ignored {
        say!("{}  {}", ignored.node, ignored.name);
        let why = match ignored.why {
            Why::Permission => {
                "not flown: this user may not read it; what allows it:\n    tiltrotor devices \
                 --udev-rule | sudo tee /etc/udev/rules.d/70-tiltrotor.rules\n    sudo udevadm \
                 control --reload && sudo udevadm trigger --subsystem-match=input"
            }
            Why::Taken => {
                "another program has taken it for itself and hears it alone: end that program"
            }
            Why::Broken => "not flown: it cannot be read; unplug it and plug it in again",
        };
        say!("    {why}");
    }
    match plan {
        Ok(plan) => {
            plan.remarks.iter().for_each(|remark| say!("remark: {remark}"));
            say!("fly with it: tiltrotor fly --stick{}", map_argument(map));
            say!("what moves what: tiltrotor fly --controls --stick{}", map_argument(map));
        }
        Err(error) if survey.found.is_empty() && survey.ignored.is_empty() => {
            drop(error);
            say!(
                "no input device at all can be seen: nothing is plugged in, or this is a container"
            );
            say!("fly without one: tiltrotor fly --keyboard, or tiltrotor fly --pilot hover");
        }
        Err(error) => {
            let first = error.lines().next().unwrap_or_default();
            say!("nothing to fly with: {}", first.trim_end_matches("; what is there:"));
            say!("map one of these: tiltrotor devices --map-new FILE");
            say!("fly without one: tiltrotor fly --keyboard, or tiltrotor fly --pilot hover");
        }
    }
    Ok(Status::Done)
}

fn map_argument(map: Option<&Path>) -> String {
    map.map(|path| format!(" --map {}", path.display())).unwrap_or_default()
}

fn describe(found: &Found, plan: Option<&Plan>) {
    let Found { node, name, kind, axes, keys, port, .. } = found;
    let (axes, keys) =
        (counted(axes.len(), "axis", "axes"), counted(keys.len(), "button", "buttons"));
    say!("{node}  {name}  {}  {}: {axes}, {keys}; port {port}", found.id(), kind.name());
    let taken = plan.and_then(|plan| {
        let of = plan.taken.iter().find(|(_, taken)| taken.node == *node);
        of.map(|(number, _)| (number, &plan.map.device[*number]))
    });
    match taken {
        Some((number, device)) => say!("    device {number}: {}", controls::moved(device)),
        None => say!("    not flown: {}", devices::why_not(found)),
    }
    if found.kind.flies() {
        let names: Vec<String> = found
            .axes
            .iter()
            .map(|axis| {
                let name = Code::Axis(axis.code).name();
                format!("{name} {}..{}", axis.raw_min, axis.raw_max)
            })
            .collect();
        say!("    axes: {}", names.join(", "));
    }
}

fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// Reads all that can be flown with; the devices have the numbers of their places.
fn all() -> Result<(Vec<Found>, Devices)> {
    let survey = devices::survey();
    let found: Vec<Found> =
        survey.found.iter().filter(|found| found.kind.flies()).cloned().collect();
    if found.is_empty() {
        bail!(
            "nothing to look at: no stick, pedals or gamepad is there; `tiltrotor devices` says what is"
        );
    }
    let device = |found: &Found| Device { name: found.name.clone(), ..Device::default() };
    let map = Params { device: found.iter().map(device).collect() };
    let taken = found.iter().cloned().enumerate().collect();
    let devices = Devices::start(&Plan { map, taken, ..Plan::default() });
    Ok((found, devices))
}

/// Where everything is: bars on a terminal, lines of what moved in a pipe.
pub fn watch(seconds: Option<f64>) -> Result<Status> {
    let (mut found, mut devices) = all()?;
    let until = seconds.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
    let bars = io::stdout().is_terminal();
    let (mut events, mut drawn) = (Vec::new(), 0);
    while until.is_none_or(|until| Instant::now() < until) {
        devices.take(0, &mut events, usize::MAX);
        for event in events.drain(..) {
            let moved = note(&mut found, &event);
            if let Some(line) = moved.filter(|_| !bars) {
                say!("{line}");
            }
        }
        if bars {
            if drawn > 0 {
                say!("\x1b[{}A", drawn + 1);
            }
            let lines: Vec<String> = found.iter().flat_map(drawing).collect();
            lines.iter().for_each(|line| say!("\x1b[2K{line}"));
            drawn = lines.len();
        }
        if crate::console::has_failed() {
            break;
        }
        thread::sleep(REDRAW);
    }
    Ok(Status::Done)
}

/// Notes an event; what it says in a line, if anything moved.
fn note(found: &mut [Found], event: &DeviceEvent) -> Option<String> {
    let device = found.get_mut(usize::try_from(event.device).ok()?)?;
    let name = device.name.clone();
    match EventKind::from_u64(event.kind)? {
        kind @ (EventKind::Axis | EventKind::AxisPosition) => {
            let axis = device.axes.iter_mut().find(|axis| axis.code == event.code)?;
            axis.value = Some(event.value);
            let code = Code::Axis(event.code).name();
            let stands = if kind == EventKind::Axis { "" } else { "stands at " };
            Some(format!("{name}: {code} {stands}{}", event.value))
        }
        EventKind::Button | EventKind::ButtonPosition => {
            device.pressed.retain(|&pressed| pressed != event.code);
            if event.value != 0 {
                device.pressed.push(event.code);
            }
            let did = if event.value != 0 { "pressed" } else { "released" };
            Some(format!("{name}: {} {did}", Code::Key(event.code).name()))
        }
        EventKind::Disconnected => Some(format!("{name}: unplugged")),
        EventKind::Dropped => Some(format!("{name}: the kernel lost events")),
        EventKind::Connected => None,
    }
}

/// A device as bars.
fn drawing(found: &Found) -> Vec<String> {
    const WIDTH: usize = 40;
    let mut lines = vec![found.name.clone()];
    for axis in &found.axes {
        let range = (axis.raw_max - axis.raw_min).max(1) as f64;
        let value = axis.value.unwrap_or(axis.raw_min);
        let norm = ((value - axis.raw_min) as f64 / range).clamp(0.0, 1.0);
        let filled = (norm * WIDTH as f64).round() as usize;
        let (full, empty) = ("#".repeat(filled), "-".repeat(WIDTH - filled));
        lines.push(format!("  {:<14} {full}{empty} {value}", Code::Axis(axis.code).name()));
    }
    let pressed: Vec<String> = found.pressed.iter().map(|&code| Code::Key(code).name()).collect();
    let pressed = if pressed.is_empty() { "none".into() } else { pressed.join(" ") };
    lines.push(format!("  pressed        {pressed}"));
    lines
}

/// Asks for one movement after the other, and writes the map.
pub fn map_new(path: &Path, force: bool, seconds: Option<f64>) -> Result<Status> {
    output::refuse(path, force, &[])?;
    let (found, mut devices) = all()?;
    let mut guide = Guide::new(&found);
    let skipped = lines_typed();
    say!("Move nothing until you are asked. Enter skips what you do not have.");
    let mut events = Vec::new();
    while let Some(asked) = guide.asks() {
        say!("{asked}");
        let begun = Instant::now();
        let answer = loop {
            devices.take(0, &mut events, usize::MAX);
            let taken = events
                .drain(..)
                .fold(None, |found: Option<String>, event| found.or_else(|| guide.take(&event)));
            if taken.is_some() {
                break taken;
            }
            let late = seconds.is_some_and(|s| begun.elapsed().as_secs_f64() > s);
            if late || skipped.try_recv().is_ok() {
                guide.skip();
                break None;
            }
            thread::sleep(Duration::from_millis(20));
        };
        say!("  {}", answer.unwrap_or_else(|| "skipped".into()));
    }
    let map = guide.map();
    if map.device.is_empty() {
        bail!("nothing was moved: no map is written");
    }
    let text = format!(
        "# Cockpit map, made by `tiltrotor devices --map-new`; docs/cockpit.md says what else there is.\n\n{}",
        toml::to_string(&map)?
    );
    output::write(path, &text, &[])?;
    say!("written: {0}; fly with it: tiltrotor fly --stick --map {0}", path.display());
    Ok(Status::Done)
}

/// A message for every line that is typed; none once nothing more can be.
fn lines_typed() -> Receiver<()> {
    let (tell, told) = mpsc::channel();
    thread::spawn(move || {
        for line in io::stdin().lock().lines() {
            if line.is_err() || tell.send(()).is_err() {
                return;
            }
        }
        // Keeps the channel open: the end of the input skips nothing.
        thread::park();
    });
    told
}

#[cfg(test)]
mod tests {
    use recorder::devices::Axis;

    use super::*;

    #[test]
    fn a_bar_is_filled_as_far_as_the_axis_has_come_through_its_range() {
        // Forty characters.
        for (raw_min, raw_max, value, filled) in [
            (0, 200, Some(0), 0),
            (0, 200, Some(50), 10),
            (0, 200, Some(200), 40),
            (-100, 100, Some(0), 20),
            (-100, 100, Some(-50), 10),
            (100, 300, Some(150), 10),
            // Nobody has said where it stands: at its lower end.
            (-100, 100, None, 0),
            // Devices tell of values beyond the range that they tell.
            (0, 200, Some(900), 40),
            (0, 200, Some(-900), 0),
            (5, 5, Some(5), 0),
        ] {
            let axes = vec![Axis { code: 1, raw_min, raw_max, value }];
            let drawn = drawing(&Found { name: "T".into(), axes, ..Found::default() });
            let (full, empty) = ("#".repeat(filled), "-".repeat(40 - filled));
            let bar = format!("  ABS_Y          {full}{empty} {}", value.unwrap_or(raw_min));
            assert_eq!(drawn, ["T".into(), bar, "  pressed        none".into()]);
        }
        let pressed = drawing(&Found { pressed: vec![288, 289], ..Found::default() });
        assert_eq!(pressed[1], "  pressed        BTN_TRIGGER BTN_THUMB");
    }

    #[test]
    fn what_moved_is_noted_and_told() {
        let axes = vec![Axis { code: 1, raw_min: 0, raw_max: 200, value: None }];
        let mut found = [Found { name: "T".into(), axes, ..Found::default() }];
        let mut told = |kind: EventKind, device, code, value| {
            let kind = kind as u64;
            let words = note(
                &mut found,
                &DeviceEvent { kind, device, code, value, ..DeviceEvent::default() },
            );
            (words.unwrap_or_default(), found[0].axes[0].value, found[0].pressed.clone())
        };
        let is = |words: &str, value, pressed: &[u64]| (words.into(), value, pressed.to_vec());
        assert_eq!(
            told(EventKind::AxisPosition, 0, 1, 30),
            is("T: ABS_Y stands at 30", Some(30), &[])
        );
        assert_eq!(told(EventKind::Axis, 0, 1, 40), is("T: ABS_Y 40", Some(40), &[]));
        assert_eq!(told(EventKind::Axis, 0, 2, 50), is("", Some(40), &[]), "it has no such axis");
        assert_eq!(told(EventKind::Axis, 1, 1, 50), is("", Some(40), &[]), "no such device");
        let pressed = is("T: BTN_TRIGGER pressed", Some(40), &[288]);
        assert_eq!(told(EventKind::Button, 0, 288, 1), pressed);
        assert_eq!(told(EventKind::ButtonPosition, 0, 288, 1), pressed, "once");
        let released = is("T: BTN_TRIGGER released", Some(40), &[]);
        assert_eq!(told(EventKind::Button, 0, 288, 0), released);
        assert_eq!(told(EventKind::Disconnected, 0, 0, 0).0, "T: unplugged");
        assert_eq!(told(EventKind::Dropped, 0, 0, 0).0, "T: the kernel lost events");
        assert_eq!(told(EventKind::Connected, 0, 0, 0).0, "");
    }
}
