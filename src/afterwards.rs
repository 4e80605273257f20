//! What is looked at when a flight is over: one reflight of its log, from which figures and the report are
//! made.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use engine::Outputs;
use engine::envelope::Params as Envelope;
use engine::math::{max, min};
use engine::table::axis::RotorSpeed;
use indicatif::{ProgressBar, ProgressStyle};
use logs::devices::DeviceIdentity;
use logs::{Identity, Setup};
use recorder::debrief::Debrief;
use replay::figures::{Flight, Gatherer};
use replay::judgement::disorder;
use replay::{Facts, Gathered, Judgement, Reflight, ReflyOptions, Window};

/// Ticks between two looks at the progress bar.
const TICKS_PER_LOOK: u64 = 2500;

/// A flight that is over.
pub struct Afterwards {
    /// What is drawn.
    pub flight: Flight,
    /// What the log is.
    pub judgement: Judgement,
    /// How it ended, in words.
    pub end: String,
    /// First and last tick.
    pub ticks: (u64, u64),
    /// Greatest values and touchdowns.
    pub gathered: Gathered,
    /// What a pilot hears after a flight.
    pub debrief: Debrief,
    /// What it came near to.
    pub margins: Margins,
    /// Who flew, with which program.
    pub identity: Identity,
    /// The files that it was flown with.
    pub setup: Setup,
    /// What the aircraft is called.
    pub aircraft: String,
    /// Devices that there were.
    pub devices: Vec<DeviceIdentity>,
    /// Other facts of the log: name, keys and values.
    pub facts: Vec<(String, BTreeMap<String, String>)>,
    /// The last digest.
    pub digest: u64,
    /// What could be observed last.
    pub last: Outputs,
}

/// The nearest that it came to limits, and what it needed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Margins {
    /// Inside the conversion corridor in flight, m/s, and at which tick; negative outside.
    pub corridor_mps_min: Option<(f64, u64)>,
    /// Torque of one mast as a part of what is allowed for a short time, and at which tick.
    pub torque_norm_max: Option<(f64, u64)>,
    /// Energy of both engines, J.
    pub energy_j: f64,
    /// Fuel at the beginning, kg.
    pub fuel_kg: Option<f64>,
    /// Path over the ground, m.
    pub distance_m: f64,
}

impl Margins {
    fn add(&mut self, envelope: &Envelope, outputs: &Outputs) {
        let tick = outputs.tick;
        self.fuel_kg.get_or_insert(outputs.fuel_kg);
        self.energy_j += outputs.engines.power_w.sum() * engine::STEP_S;
        let v = outputs.velocity_mps;
        self.distance_m += engine::math::sqrt(v.x * v.x + v.y * v.y) * engine::STEP_S;
        let allowed_n_m =
            envelope.rotors.short_torque_n_m_max.at(RotorSpeed(outputs.rotor_speed_radps));
        let torque = outputs.rotors.map(|rotor| rotor.torque_n_m);
        let torque_norm = max(torque.left, torque.right) / max(allowed_n_m, 1.0);
        if self.torque_norm_max.is_none_or(|(most, _)| torque_norm > most) {
            self.torque_norm_max = Some((torque_norm, tick));
        }
        let Some(margin_mps) = envelope.corridor.margin_in_flight_mps(outputs) else { return };
        if self.corridor_mps_min.is_none_or(|(least, _)| min(least, margin_mps) < least) {
            self.corridor_mps_min = Some((margin_mps, tick));
        }
    }
}

impl Afterwards {
    /// Reflies a log, or a part of it.
    ///
    /// # Errors
    /// When it is none that can be reflown.
    pub fn of(log: &Path, window: &Window) -> Result<Self> {
        let name = || log.display().to_string();
        let options = ReflyOptions { window: *window, across_versions: false };
        let mut flight = Reflight::open(log, &options).with_context(name)?;
        let mut gatherer = Gatherer::new(log, &flight.aircraft);
        let mut gathered = Gathered::from(&flight.state);
        let (mut debrief, mut margins) = (Debrief::default(), Margins::default());
        let mut facts = Facts::of_reflight(&flight);
        let envelope = flight.aircraft.envelope.clone();
        let first = flight.state.tick;
        let bar = progress();
        let disorder = loop {
            match flight.next_tick() {
                Ok(Some(reflown)) => {
                    if let Some(restart) = &reflown.recorded.restart {
                        gathered.restart(&restart.state);
                        debrief.restart();
                    }
                    gatherer.add(reflown.outputs);
                    gathered.add(reflown.state, reflown.outputs);
                    debrief.add(&envelope, reflown.outputs);
                    margins.add(&envelope, reflown.outputs);
                    facts.add(reflown.recorded, Some(reflown.exact));
                    let tick = reflown.state.tick;
                    if tick.is_multiple_of(TICKS_PER_LOOK) {
                        bar.set_message(format!(
                            "{}: {:.0} s reflown",
                            log.display(),
                            tick as f64 * engine::STEP_S
                        ));
                        bar.tick();
                    }
                }
                Ok(None) => break None,
                Err(error) => break Some(disorder(error).with_context(name)?),
            }
            flight.reader.timings.drain(..).for_each(|timing| gatherer.time(&timing));
        };
        flight.reader.timings.drain(..).for_each(|timing| gatherer.time(&timing));
        bar.finish_and_clear();
        facts.end_of_reflight(&mut flight, disorder, window);
        let judgement = facts.judge();
        Ok(Self {
            flight: gatherer.finish(&flight.reader, &judgement),
            judgement,
            end: facts.end.to_string(),
            ticks: (first, flight.state.tick),
            gathered,
            debrief,
            margins,
            aircraft: flight.aircraft.name.clone(),
            digest: flight.reader.digest(),
            last: flight.outputs,
            identity: std::mem::take(&mut flight.reader.identity),
            setup: std::mem::take(&mut flight.reader.setup),
            devices: std::mem::take(&mut flight.reader.devices),
            facts: std::mem::take(&mut flight.reader.other_facts),
        })
    }
}

/// Says on a terminal how far it is.
fn progress() -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
        bar.set_style(style);
    }
    bar
}
