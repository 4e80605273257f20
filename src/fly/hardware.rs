//! The flight's sticks, throttles and pedals, and what the crew is told of them.

use std::path::Path;

use anyhow::Result;
use engine::cockpit::{AxisControl, Params};
use recorder::{Flight, Snapshot};

use crate::status::Status;

#[cfg(not(feature = "sticks"))]
const MISSING: &str = "this program was built without `sticks`: build it with the default features";

/// What the crew calls its devices, by their numbers.
#[derive(Default)]
pub struct Named(Vec<String>);

impl Named {
    /// By their numbers.
    pub fn names(&self) -> &[String] {
        &self.0
    }

    /// Devices that came or went and controls that wait for pick-up, since the crew was told.
    pub fn lines(&self, told: &Snapshot, now: &Snapshot) -> Vec<String> {
        let mut lines = Vec::new();
        for (number, name) in self.0.iter().enumerate().take(64) {
            let [was, is] = [told, now].map(|seen| seen.plugged >> number & 1 != 0);
            if was && !is {
                lines.push(format!("WARNING: device {number}, {name}, is unplugged"));
            } else if is && !was && told.tick > 0 {
                lines.push(format!("device {number}, {name}, is plugged in"));
            }
        }
        for &control in AxisControl::ALL {
            let waits = |bits: u64| bits >> control as u64 & 1 != 0;
            let way = |seen: &Snapshot| match (waits(seen.waiting_up), waits(seen.waiting_down)) {
                (true, _) => Some(ways(control).0),
                (_, true) => Some(ways(control).1),
                _ => None,
            };
            let words = control.facts().words;
            match (way(told), way(now)) {
                (None, Some(way)) => lines
                    .push(format!("{words} waits for pick-up: move it {way} until it takes over")),
                (Some(_), None) => lines.push(format!("{words} is picked up")),
                _ => {}
            }
        }
        lines
    }
}

/// Towards positive and negative.
fn ways(control: AxisControl) -> (&'static str, &'static str) {
    match control {
        AxisControl::StickAft => ("aft", "forward"),
        AxisControl::StickRight | AxisControl::PedalRight => ("right", "left"),
        AxisControl::FlapLever => ("to more flap", "to less flap"),
        _ => ("up", "down"),
    }
}

#[cfg(feature = "sticks")]
fn planned(path: Option<&Path>) -> Result<recorder::devices::Plan> {
    use recorder::devices;

    let mut survey = devices::survey();
    survey.ignored.extend(devices::taken(&survey));
    let Some(path) = path else { return Ok(devices::combined(&devices::shipped()?, &survey)?) };
    let map = crate::maps::cockpit_map(path)?;
    let mut plan = devices::plan(&map, &survey)?;
    let missing = devices::missing(&plan, &map);
    plan.remarks.extend(missing);
    Ok(plan)
}

/// Takes up what is plugged in, by a map or the shipped ones; says what is flown with.
#[cfg(feature = "sticks")]
pub fn plug_in(flight: &mut Flight, map: &mut Params, path: Option<&Path>) -> Result<Named> {
    use recorder::devices::{Devices, called};

    let plan = planned(path)?;
    for (number, found) in &plan.taken {
        complain!("device {number}: {} ({}, {})", found.name, found.id(), found.port);
    }
    for remark in &plan.remarks {
        complain!("WARNING: {remark}");
    }
    flight.sticks = Some(Devices::start(&plan));
    let mut names: Vec<String> = plan.map.device.iter().map(called).collect();
    for (number, found) in &plan.taken {
        names[*number].clone_from(&found.name);
    }
    *map = plan.map;
    Ok(Named(names))
}

#[cfg(not(feature = "sticks"))]
pub fn plug_in(_: &mut Flight, _: &mut Params, _: Option<&Path>) -> Result<Named> {
    anyhow::bail!(MISSING)
}

/// Prints what moves which control; of a map that nothing is plugged in for, what it says.
#[cfg(feature = "sticks")]
pub fn say_controls(path: Option<&Path>) -> Result<Status> {
    use recorder::devices::called;

    let (plan, nothing) = match (planned(path), path) {
        (Ok(plan), _) => (plan, None),
        (Err(error), Some(path)) => {
            let map = crate::maps::cockpit_map(path)?;
            (recorder::devices::Plan { map, ..Default::default() }, Some(error))
        }
        (Err(error), None) => return Err(error),
    };
    let name = |number: usize| match plan.taken.iter().find(|(taken, _)| *taken == number) {
        Some((_, found)) => found.name.clone(),
        None => format!("{} (not plugged in)", called(&plan.map.device[number])),
    };
    let names: Vec<String> = (0..plan.map.device.len()).map(name).collect();
    crate::controls::lines(&plan.map, &names).iter().for_each(|line| say!("{line}"));
    plan.remarks.iter().for_each(|remark| say!("remark: {remark}"));
    if let Some(error) = nothing {
        say!("remark: {error}");
    }
    Ok(Status::Done)
}

#[cfg(not(feature = "sticks"))]
pub fn say_controls(_: Option<&Path>) -> Result<Status> {
    anyhow::bail!(MISSING)
}
