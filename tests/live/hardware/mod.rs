//! Devices that people fly with, as the kernel would show them, that come and go as they please.
//!
//! `devices/stage.py` plugs them in and out through umockdev's library; every flight is reflown exactly.

mod choosing;
mod fake;
mod plugging;
mod shipped_maps;
mod stage;

use engine::inputs::EventKind;
use fake::{Fake, known};
use stage::{Flown, Job};

/// The devices sweep all their axes, with the shipped maps.
fn sweep(name: &str, labels: &[&str], seconds: u32) -> Flown {
    let devices: Vec<Fake> = labels.iter().map(|label| known(label)).collect();
    let plan: Vec<_> = labels.iter().map(|label| (0.3, "play", *label, "sweep")).collect();
    Job { name, devices: &devices, there: labels, plan: &plan, seconds, ..Job::default() }.fly()
}

fn kinds(flown: &Flown, kind: EventKind) -> usize {
    flown.events.iter().filter(|event| event.kind == kind as u64).count()
}

/// The stick is pushed to the right, half way between the middle and its end.
const RIGHT: &[(u16, u16, i32)] = &[(3, 0, 12288)];
