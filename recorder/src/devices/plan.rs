//! The map and what is plugged in, brought together before take-off.

use std::fmt::Write as _;

use engine::cockpit::{AxisBinding, AxisControl, Codes, Device, Params};

use super::check::{called, check, clash};
use super::found::{Found, Survey, Why};
use super::matching;

/// How many devices a device that is not there may stand for, with the alternatives of its axes.
const VARIANTS_MAX: usize = 16;

/// What will be flown with.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The map as flown: every axis and button by one code, every device with its number.
    pub map: Params,
    /// The devices of the map that are there, with their numbers.
    pub taken: Vec<(usize, Found)>,
    /// Those that are there and not in the map.
    pub others: Vec<Found>,
    /// What the crew is to know.
    pub remarks: Vec<String>,
}

/// Why nothing can be flown with.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The map cannot be meant so.
    #[error("the cockpit map cannot be flown:\n{}", lines(.0))]
    Map(Vec<String>),
    /// A device is missing without which there is no flight.
    #[error("{0} is not plugged in, and the cockpit map requires it{1}")]
    Required(String, String),
    /// Nothing is plugged in that the map knows.
    #[error(
        "no stick found{0}\nplug one in, write a map for what is there (`tiltrotor devices --map-new \
         FILE`), or fly with `--keyboard` or `--pilot hover`"
    )]
    Nothing(String),
}

fn lines(wrong: &[String]) -> String {
    wrong.iter().map(|words| format!("  {words}")).collect::<Vec<_>>().join("\n")
}

/// What is plugged in, a line each, with why it is not used.
pub fn seen(survey: &Survey) -> String {
    let mut seen = String::new();
    for found in &survey.found {
        let _ = write!(seen, "\n  {}: {}", named(found), why_not(found));
    }
    for ignored in &survey.ignored {
        let why = match ignored.why {
            Why::Permission => "this user may not read it: see docs/cockpit.md for the udev rule",
            Why::Taken => "another program has taken it for itself: end that program",
            Why::Broken => "it cannot be read: unplug it and plug it in again",
        };
        let _ = write!(seen, "\n  {} ({}): {why}", ignored.name, ignored.node);
    }
    if seen.is_empty() {
        return ": no input device at all can be seen".into();
    }
    format!("; what is there:{seen}")
}

fn named(found: &Found) -> String {
    format!("{} ({}, {})", found.name, found.id(), found.node)
}

/// Why a device that can be read is not used.
pub fn why_not(found: &Found) -> &'static str {
    if found.kind.flies() {
        "the cockpit map does not know it"
    } else if found.axes.is_empty() && found.keys.is_empty() {
        "it has neither axis nor button"
    } else {
        match found.kind.name() {
            "keyboard" => "a keyboard or its receiver: only by its exact name in a map",
            "mouse" => "a mouse",
            "touchpad" => "a touchpad or tablet",
            "motion sensor" => "a motion sensor",
            _ => "it has no axes that one flies with",
        }
    }
}

/// Brings a map and what is plugged in together.
///
/// # Errors
/// When the map cannot be flown, or with nothing that is there.
pub fn plan(map: &Params, survey: &Survey) -> Result<Plan, PlanError> {
    let wrong = check(map);
    if !wrong.is_empty() {
        return Err(PlanError::Map(wrong));
    }
    let mut plan = Plan { map: map.clone(), ..Plan::default() };
    let of_entries = assigned(map, survey);
    for (number, of_entry) in of_entries.iter().enumerate() {
        if let Some(at) = of_entry {
            plan.taken.push((number, survey.found[*at].clone()));
        }
    }
    let is_taken = |at: &usize| of_entries.contains(&Some(*at));
    let others = survey.found.iter().enumerate().filter(|(at, _)| !is_taken(at));
    plan.others = others.map(|(_, found)| found.clone()).collect();
    for device in &mut plan.map.device {
        device.pick_up.get_or_insert(true);
    }
    for (number, device) in map.device.iter().enumerate() {
        if device.required && of_entries[number].is_none() {
            return Err(PlanError::Required(called(device), seen(survey)));
        }
    }
    if plan.taken.is_empty() {
        return Err(PlanError::Nothing(seen(survey)));
    }
    choose_axes(&mut plan);
    yield_to_others(&mut plan);
    let clashes = clashes(&plan);
    if !clashes.is_empty() {
        return Err(PlanError::Map(clashes));
    }
    tell(&mut plan, survey);
    Ok(plan)
}

/// Which device each entry of the map has: the best pairs first.
fn assigned(map: &Params, survey: &Survey) -> Vec<Option<usize>> {
    let mut pairs = Vec::new();
    for (number, wanted) in map.device.iter().enumerate() {
        for (at, found) in survey.found.iter().enumerate() {
            let Some(fit) = matching::fits(wanted, found) else { continue };
            let codes = matching::codes_in(wanted, found);
            if codes == 0 && !(wanted.axis.is_empty() && wanted.button.is_empty()) {
                continue;
            }
            let rank = (found.kind.flies(), fit, matching::has_all_axes(wanted, found), codes);
            pairs.push((rank, number, at));
        }
    }
    // A stable sort: of equals the first entry has the first device.
    pairs.sort_by_key(|pair| std::cmp::Reverse(pair.0));
    let mut of_entries = vec![None; map.device.len()];
    for (_, number, at) in pairs {
        if of_entries[number].is_none() && !of_entries.contains(&Some(at)) {
            of_entries[number] = Some(at);
        }
    }
    of_entries
}

/// Leaves one code of each axis and button: the first that the device has. A device that is not there
/// stands for as many as there are choices.
fn choose_axes(plan: &mut Plan) {
    let mut more = Vec::new();
    for (number, device) in plan.map.device.iter_mut().enumerate() {
        let found = plan.taken.iter().find(|(taken, _)| *taken == number).map(|(_, found)| found);
        match found {
            Some(found) => plan.remarks.extend(choose(device, found)),
            None => {
                let mut variants = variants(device);
                *device = variants.remove(0);
                more.extend(variants);
            }
        }
    }
    plan.map.device.extend(more);
}

/// What the device lacks, in words.
fn choose(device: &mut Device, found: &Found) -> Vec<String> {
    let mut lacks = Vec::new();
    let mut one = |codes: &mut Codes, control: &str| {
        let first = codes.all().iter().copied().find(|&code| found.has(code));
        if first.is_none() {
            lacks.push(format!("{} has no {codes}: nothing there moves {control}", found.name));
        }
        if let Some(code) = first.or_else(|| codes.all().first().copied()) {
            *codes = Codes::one(code);
        }
    };
    for axis in &mut device.axis {
        one(&mut axis.code, axis.control.facts().words);
    }
    for button in &mut device.button {
        one(&mut button.code, button.control.facts().words);
    }
    lacks
}

/// The devices that one that is not there may turn out to be, with one code each, the best first.
fn variants(device: &Device) -> Vec<Device> {
    let mut variants = vec![device.clone()];
    for at in 0..device.axis.len() {
        let codes = device.axis[at].code.all();
        let choices = if variants.len() * codes.len() > VARIANTS_MAX { &codes[..1] } else { codes };
        let with = |device: &Device, code| {
            let mut device = device.clone();
            device.axis[at].code = Codes::one(code);
            device
        };
        variants = choices
            .iter()
            .flat_map(|&code| variants.iter().map(move |device| with(device, code)))
            .collect();
    }
    for button in variants.iter_mut().flat_map(|device| &mut device.button) {
        if let Some(&code) = button.code.all().first() {
            button.code = Codes::one(code);
        }
    }
    variants
}

/// Leaves out the axes that give way to another device: a twist grip to pedals.
fn yield_to_others(plan: &mut Plan) {
    let map = plan.map.clone();
    for (number, found) in &plan.taken {
        let rival = |axis: &AxisBinding| {
            let others = plan.taken.iter().filter(|(other, _)| other != number);
            let rivals = others.filter(|(other, _)| {
                let of_other = map.device[*other].axis.iter();
                let mut same = of_other.filter(|other| other.control == axis.control);
                same.any(|of_other| !of_other.fallback || other < number)
            });
            rivals.map(|(_, rival)| rival.name.clone()).next()
        };
        let mut left = Vec::new();
        for axis in &map.device[*number].axis {
            match rival(axis).filter(|_| axis.fallback) {
                Some(rival) => plan.remarks.push(format!(
                    "{} of {} is not used: {rival} moves {}",
                    axis.code,
                    found.name,
                    axis.control.facts().words
                )),
                None => left.push(axis.clone()),
            }
        }
        plan.map.device[*number].axis = left;
    }
}

/// Two devices that are there and move the same.
fn clashes(plan: &Plan) -> Vec<String> {
    let mut clashes = Vec::new();
    for (at, (number, found)) in plan.taken.iter().enumerate() {
        for (other, of_other) in &plan.taken[..at] {
            for axis in &plan.map.device[*number].axis {
                let others = plan.map.device[*other].axis.iter();
                for rival in others.filter(|rival| clash(axis, rival)) {
                    clashes.push(format!(
                        "{} of {} and {} of {} both move {}: leave one out, or give it `fallback = true`",
                        rival.code,
                        of_other.name,
                        axis.code,
                        found.name,
                        axis.control.facts().words
                    ));
                }
            }
        }
    }
    clashes
}

/// What the crew is to know besides.
fn tell(plan: &mut Plan, survey: &Survey) {
    let mut told = Vec::new();
    for (number, found) in &plan.taken {
        let same = |other: &&Found| other.name == found.name && other.kind == found.kind;
        for other in plan.others.iter().filter(same) {
            told.push(format!(
                "two devices are called {}: device {number} is the one at {}; for the one at {} give \
                 the map `port = \"{}\"`",
                found.name, found.port, other.port, other.port
            ));
        }
    }
    for found in plan.others.iter().filter(|found| found.kind.flies()) {
        told.push(format!("{} is not used: {}", named(found), why_not(found)));
    }
    for ignored in &survey.ignored {
        let (name, node) = (&ignored.name, &ignored.node);
        match ignored.why {
            Why::Taken => told.push(format!(
                "{name} ({node}) will say nothing: another program has taken it for itself"
            )),
            Why::Permission if name != "unknown" => told.push(format!(
                "{name} ({node}) is not used: this user may not read it; `tiltrotor devices` says \
                 what allows it"
            )),
            Why::Permission | Why::Broken => {}
        }
    }
    plan.remarks.extend(told);
}

/// What does not move because its device is not there, in words; for maps that somebody wrote.
pub fn missing(plan: &Plan, map: &Params) -> Vec<String> {
    let is_there = |number: usize| plan.taken.iter().any(|(taken, _)| *taken == number);
    let moved = |control: AxisControl| {
        plan.taken.iter().any(|(number, _)| {
            plan.map.device[*number].axis.iter().any(|axis| axis.control == control)
        })
    };
    let mut missing = Vec::new();
    for (number, device) in map.device.iter().enumerate().filter(|(number, _)| !is_there(*number)) {
        let still: Vec<_> = device
            .axis
            .iter()
            .filter(|axis| !moved(axis.control))
            .map(|axis| axis.control.facts().words)
            .collect();
        let and = if still.is_empty() {
            String::new()
        } else {
            format!(": nothing moves {} until it is", still.join(", "))
        };
        missing.push(format!("device {number}, {}, is not plugged in{and}", called(device)));
    }
    missing
}

/// The shipped maps, as far as what is plugged in is in them. Devices that are not there stay in the map
/// when they would move something that nothing moves yet: they may be plugged in later.
///
/// # Errors
/// When nothing that is there is in any of them.
pub fn combined(shipped: &Params, survey: &Survey) -> Result<Plan, PlanError> {
    let of_entries = assigned(shipped, survey);
    let (mut there, mut not): (Vec<_>, Vec<_>) =
        shipped.device.iter().zip(&of_entries).partition(|(_, found)| found.is_some());
    // What gives way comes last: a pad beside a stick.
    let gives_way = |device: &Device| device.axis.iter().all(|axis| axis.fallback);
    there.sort_by_key(|(device, found)| (gives_way(device), *found));
    let mut kept: Vec<&Device> = Vec::new();
    let mut remarks = Vec::new();
    for (device, found) in there {
        let taken = |axis: &AxisBinding, by_any: bool| {
            let mut axes = kept.iter().flat_map(|device| &device.axis);
            axes.any(|other| (by_any || !other.fallback) && clash(axis, other))
        };
        let mut axes = device.axis.iter();
        let rivalled = if gives_way(device) {
            !device.axis.is_empty() && axes.all(|axis| taken(axis, true))
        } else {
            axes.any(|axis| !axis.fallback && taken(axis, false))
        };
        match found.filter(|_| rivalled) {
            Some(at) => remarks.push(format!(
                "{} is not used: another device moves the same; fly with both by a map of your own",
                named(&survey.found[at])
            )),
            None => kept.push(device),
        }
    }
    let firmly = |control: AxisControl| {
        kept.iter()
            .any(|device| device.axis.iter().any(|axis| axis.control == control && !axis.fallback))
    };
    not.retain(|(device, _)| {
        let mut firm = device.axis.iter().filter(|axis| !axis.fallback).peekable();
        firm.peek().is_some() && firm.all(|axis| !firmly(axis.control))
    });
    let devices = kept.into_iter().chain(not.into_iter().map(|(device, _)| device));
    let mut plan = plan(&Params { device: devices.cloned().collect() }, survey)?;
    plan.remarks.extend(remarks);
    Ok(plan)
}

#[cfg(test)]
mod tests;
