//! What was found, as text for people.

use std::fmt;

use engine::STEP_S;
use engine::inputs::{DeviceEvent, EventKind};
use logs::evolution::Difference;
use logs::fields::Value;
use logs::text::at;
use logs::units::{unit_of, with_unit};

use crate::divergence::{Divergence, InputChange, OneStepCheck};
use crate::growth::{Checkpoint, Growth, WINDOW_TICKS};
use crate::judgement::{End, Outcome};
use crate::stage::Stage;
use crate::verify::Verdict;
use crate::versions::Versions;

/// The judgement, how far it goes, and what there is to say of it.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { judgement, facts, divergence, versions } = self;
        write!(f, "{judgement}")?;
        if let Some(versions) = versions {
            write!(f, "\n{versions}")?;
        }
        let (exact, last) = (facts.exact_tick(), facts.last_tick());
        let same = match judgement.outcome {
            Outcome::Compared => "the same in every field that both know",
            Outcome::OutputsDiffer => "the outputs are those recorded, and the states exact,",
            _ => "exact",
        };
        let more = if matches!(facts.end, End::Closed | End::Window) { "" } else { " or more" };
        let exact_s = exact as f64 * STEP_S;
        write!(f, "\n{same} up to tick {exact} of {last}{more} ({exact_s:.3} s)")?;
        let whole = exact == last && facts.altered.is_none();
        if whole {
            write!(f, ": {}", facts.end)?;
        }
        if exact < facts.same_tick() {
            write!(f, "; the states refly to the same bits up to {}", at(facts.same_tick()))?;
        }
        if let Some(origin) = &facts.origin {
            write!(f, "\n{origin}")?;
        }
        if let Some(recovered) = &facts.recovered
            && !matches!(facts.end, End::Recovered(_))
        {
            write!(f, "\n{recovered}")?;
        }
        if let Some(divergence) = divergence {
            write!(f, "\n{divergence}")?;
        }
        if !whole && !matches!(facts.end, End::Closed | End::Window) {
            write!(f, "\nafter {}: {}", at(last), facts.end)?;
        }
        Ok(())
    }
}

fn apart(recorded: Value, reflown: Value) -> String {
    recorded.ulps_to(reflown).map_or("?".into(), |ulps| ulps.to_string())
}

/// How many differ: `1 field differs`, `2 fields differ`.
pub fn differing(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what} differs"),
        _ => format!("{count} {what}s differ"),
    }
}

fn counted(stages: &[(Stage, u64)]) -> String {
    let each: Vec<_> =
        stages.iter().map(|(stage, number)| format!("{} {number}", stage.name())).collect();
    each.join(", ")
}

impl fmt::Display for Divergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.after_tick {
            None => writeln!(f, "first difference: {}", at(self.tick))?,
            Some(after) => writeln!(
                f,
                "first difference: between {} and {}, the next state that was kept",
                at(after),
                at(self.tick)
            )?,
        }
        let stage = self.stage.map_or("(not known here)", Stage::name);
        write!(f, "  stage     {stage}")?;
        match self.stage.and_then(Stage::or_before) {
            Some(before) => writeln!(f, ", or before it {before}")?,
            None => writeln!(f)?,
        }
        if let Some(block) = &self.single.block {
            writeln!(
                f,
                "  block     {}: {} at {}, recorded {}, reflown {}, {} ULP apart",
                block.stage.name(),
                block.path,
                at(block.tick),
                with_unit(block.recorded, &block.unit),
                with_unit(block.reflown, &block.unit),
                apart(block.recorded, block.reflown)
            )?;
        } else if self.single.outputs > 0 {
            writeln!(
                f,
                "  block     none: at {} ticks every block gives what was recorded",
                self.single.outputs
            )?;
        }
        writeln!(f, "  field     {}", self.path)?;
        for (name, value) in [("recorded", self.recorded), ("reflown", self.reflown)] {
            let told = with_unit(value, &self.unit);
            writeln!(f, "  {name:<9} {told}  (0x{:016x})", value.bits())?;
        }
        writeln!(f, "  apart     {} ULP", apart(self.recorded, self.reflown))?;
        writeln!(
            f,
            "  others    {} at this tick; by stage: {}",
            differing(self.others, "more field"),
            counted(&self.stages)
        )?;
        match &self.last_input {
            None => writeln!(f, "  last input: none before it")?,
            Some(input) => writeln!(f, "  last input: {input}")?,
        }
        write_single(f, &self.single)?;
        write!(f, "{}", self.growth)
    }
}

fn write_single(f: &mut fmt::Formatter<'_>, single: &OneStepCheck) -> fmt::Result {
    let OneStepCheck { ticks, differing, first_stages, .. } = single;
    if single.between_keyframes {
        return writeln!(
            f,
            "  keyframes {differing} of {ticks} are not what the flight from the keyframe before leads to"
        );
    }
    writeln!(
        f,
        "  one step  from each recorded state: {differing} of {ticks} do not lead to the next one{}{}",
        if first_stages.is_empty() { "" } else { "; first to differ: " },
        counted(first_stages)
    )
}

impl fmt::Display for InputChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Device { event, moves } => {
                let kind = EventKind::from_u64(event.kind).map_or("event", |kind| kind.facts().key);
                let DeviceEvent { device, code, value, .. } = event;
                write!(f, "device {device} {kind} 0x{code:x} = {value}")?;
                if !moves.is_empty() {
                    write!(f, " ({moves})")?;
                }
            }
            Self::World { path, unit, from, to, .. } => {
                write!(f, "{path} from {} to {}", with_unit(*from, unit), with_unit(*to, unit))?;
            }
        }
        write!(f, ", for {}", at(self.led_to_tick()))
    }
}

/// What is shown of the motion; the rest is in the JSON form.
const SHOWN: [&str; 5] = [
    "plant.position_m",
    "plant.velocity_mps",
    "plant.attitude",
    "plant.angular_rate_radps",
    "plant.rotor_speed_radps",
];

/// As a table: a line a quantity, a column a checkpoint.
impl fmt::Display for Growth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = |f: &mut fmt::Formatter<'_>, name: &str, of: &dyn Fn(&Checkpoint) -> String| {
            write!(f, "\n    {name:<33}")?;
            self.checkpoints.iter().try_for_each(|checkpoint| write!(f, " {:>11}", of(checkpoint)))
        };
        write!(f, "  growth")?;
        line(f, "after", &|checkpoint| format!("{} s", checkpoint.after_s))?;
        line(f, "fields that differ", &|checkpoint| checkpoint.fields.to_string())?;
        line(f, &format!("{}, ULP", self.first_group), &|checkpoint| {
            let ulps = checkpoint.group(&self.first_group).map_or(0, |group| group.ulps);
            if ulps < 1_000_000 { ulps.to_string() } else { format!("{:.1e}", ulps as f64) }
        })?;
        let first = Some(self.first_group.as_str()).filter(|first| !SHOWN.contains(first));
        for group in first.into_iter().chain(SHOWN) {
            let unit = unit_of(group);
            let name = if unit.is_empty() { group.to_string() } else { format!("{group}, {unit}") };
            line(f, &name, &|checkpoint| {
                let found = checkpoint.group(group);
                found.map_or("0".into(), |found| format!("{:.2e}", found.absolute))
            })?;
        }
        match (self.same_from, self.doubling_s()) {
            (Some(tick), _) => write!(f, "\n    the same again from {} on", at(tick)),
            (None, Some(doubling_s)) => write!(
                f,
                "\n    the velocities' difference doubles every {doubling_s:.3} s (fitted over {:.1} s)",
                self.last_tick.saturating_sub(self.first_tick).min(WINDOW_TICKS) as f64 * STEP_S
            ),
            (None, None) => {
                write!(f, "\n    no doubling time: it does not grow, or there is too little of it")
            }
        }
    }
}

impl fmt::Display for Versions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { recorded_model, model, differences, notes } = self;
        if recorded_model == model {
            write!(f, "read by the names of its fields: flight model {model}, in another layout")?;
        } else {
            write!(
                f,
                "a comparison, and never exact: recorded by flight model {recorded_model}, flown by {model}"
            )?;
        }
        for (topic, Difference { missing, ignored }) in differences {
            if !missing.is_empty() {
                write!(f, "\n  {topic} of the log lacks {}", listed(missing))?;
            }
            if !ignored.is_empty() {
                write!(
                    f,
                    "\n  {topic} of the log has, and nobody knows today, {}",
                    listed(ignored)
                )?;
            }
        }
        notes.iter().try_for_each(|note| write!(f, "\n  {note}"))
    }
}

/// So many names are told; the rest are counted.
const NAMES_TOLD: usize = 8;

fn listed(names: &[String]) -> String {
    let told = names.iter().take(NAMES_TOLD).map(String::as_str).collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(NAMES_TOLD) {
        0 => told,
        more => format!("{told} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_is_told_with_the_tick_that_it_led_to() {
        let told = |kind, moves: &str| {
            let (device, code, value) = (2, 0x10, -5);
            let event =
                DeviceEvent { tick: 249, kind, device, code, value, ..DeviceEvent::default() };
            InputChange::Device { event, moves: moves.into() }.to_string()
        };
        let axis = EventKind::Axis as u64;
        assert_eq!(told(axis, ""), "device 2 axis 0x10 = -5, for tick 250 (1.000 s)");
        let aft = "device 2 axis 0x10 = -5 (stick aft), for tick 250 (1.000 s)";
        assert_eq!(told(axis, "stick aft"), aft);
        // Of a kind that nobody knows.
        assert_eq!(told(u64::MAX, ""), "device 2 event 0x10 = -5, for tick 250 (1.000 s)");
        let world = InputChange::World {
            tick: 3000,
            path: "world.wind_mps.x".into(),
            unit: "m/s".into(),
            from: Value::F64(0.5),
            to: Value::F64(-5.25),
        };
        let blown = "world.wind_mps.x from 0.5 m/s to -5.25 m/s, for tick 3001 (12.004 s)";
        assert_eq!(world.to_string(), blown);
    }

    #[test]
    fn one_differs_and_several_differ() {
        assert_eq!(differing(0, "field"), "0 fields differ");
        assert_eq!(differing(1, "field"), "1 field differs");
        assert_eq!(differing(2, "more field"), "2 more fields differ");
    }

    #[test]
    fn eight_names_are_told_and_the_rest_counted() {
        let names: Vec<String> = ('a'..='j').map(String::from).collect();
        assert_eq!(listed(&names[..2]), "a, b");
        assert_eq!(listed(&names[..8]), "a, b, c, d, e, f, g, h");
        assert_eq!(listed(&names), "a, b, c, d, e, f, g, h and 2 more");
    }
}
