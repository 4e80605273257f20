//! Recordings: of one flight, of two.

use std::path::Path;

use anyhow::{Context, Result};
use chrono::{DateTime, Utc};
use engine::STEP_NS;
use logs::Identity;
use logs::output::Output;
use logs::text::at;
use replay::judgement::disorder;
use replay::view::{
    About, Comparison, DrawError, FlightView, Layout, Mark, Moment, Other, Own, Stamp,
    draw_against, level,
};
use replay::{Facts, Reflight, ReflyOptions, Window, parent};

use crate::identity;
use crate::status::Status;

/// What is drawn, and how.
pub struct Drawing {
    /// By which the recording is known again.
    pub stamp: Stamp,
    /// How it is arranged.
    pub layout: Layout,
    /// Which part.
    pub window: Window,
    /// So many ticks later in the other log is what is laid beside the first.
    pub shift_ticks: i64,
}

/// The arrangement of that name, or in that file.
pub fn layout(wanted: Option<&str>, of_two: bool) -> Result<Layout> {
    let Some(wanted) = wanted else {
        return Ok(if of_two { Layout::Compare } else { Layout::Pilot });
    };
    match Layout::named(wanted) {
        Some(Layout::Compare) if !of_two => {
            anyhow::bail!("--layout compare: give the other log with --against OTHER")
        }
        Some(layout) => Ok(layout),
        None => {
            let text = std::fs::read_to_string(wanted).with_context(|| {
                let names = Layout::NAMED.map(|(name, _)| name).join(", ");
                format!("--layout {wanted}: neither one of {names}, nor a file that can be read")
            })?;
            Ok(Layout::Own(Own::parse(&text).with_context(|| format!("--layout {wanted}"))?))
        }
    }
}

/// By what a recording of these logs is known, drawn so and by this program.
pub fn stamp(logs: &[&Path], how: &str) -> Result<Stamp> {
    let by: Vec<String> =
        identity::identity().0.iter().map(|(key, value)| format!("{key}={value}")).collect();
    Stamp::of(logs, &format!("{how} {}", by.join(" "))).context("cannot read the log")
}

/// Draws a log as `view` does without options, where `demo` puts it; returns its size.
pub fn save_default(log: &Path, saved: &Output) -> Result<u64> {
    let (layout, window) = (Layout::Pilot, Window::default());
    let stamp = stamp(&[log], &format!("{layout:?} {window:?} 0"))?;
    Ok(one(log, saved, &Drawing { stamp, layout, window, shift_ticks: 0 })?.0)
}

/// When a log was flown, or of which other one it was made, in words; empty where it does not say.
fn flown(identity: &Identity) -> String {
    if let Some(by) = identity.0.get(parent::MADE_BY) {
        let changes = identity.0.get(parent::CHANGES);
        let changes = changes.map_or_else(String::new, |changes| format!(", {changes}"));
        return format!("made by {by} of {}{changes}; inputs", identity.get(parent::NAME));
    }
    let started = identity.get(Identity::STARTED).parse().ok();
    let started = started.map(DateTime::<Utc>::from_timestamp_nanos);
    started.map_or_else(String::new, |at| at.format("flown %Y-%m-%d %H:%M UTC").to_string())
}

fn title(log: &Path) -> String {
    log.file_stem().map_or_else(String::new, |stem| stem.display().to_string())
}

/// Reflies the log into a recording, whose first event says what the log is; returns its size, and what
/// came of it.
pub fn one(log: &Path, saved: &Output, drawing: &Drawing) -> Result<(u64, Mark)> {
    let options = ReflyOptions { window: drawing.window, across_versions: false };
    let mut flight = Reflight::open(log, &options).with_context(|| log.display().to_string())?;
    let about = About {
        title: title(log),
        recording_id: drawing.stamp.id().into(),
        flown: vec![flown(&flight.reader.identity)],
    };
    let mut view = FlightView::new(saved, &about, &drawing.layout, &flight.aircraft)?;
    let mut facts = Facts::of_reflight(&flight);
    let start_tick = flight.state.tick;
    let mut first_difference = None;
    let disorder = loop {
        match flight.next_tick() {
            Ok(Some(reflown)) => {
                let (recorded, outputs) = (reflown.recorded, reflown.outputs);
                let world = &recorded.inputs.world;
                if let Some(restart) = &recorded.restart {
                    view.restart(restart.state.tick);
                }
                view.push(Moment { outputs, world, events: &recorded.events });
                if !reflown.exact {
                    first_difference.get_or_insert(outputs.tick);
                }
                facts.add(recorded, Some(reflown.exact));
            }
            Ok(None) => break None,
            Err(error) => break Some(disorder(error)?),
        }
        flight.reader.timings.drain(..).for_each(|timing| view.time(&timing));
    };
    flight.reader.timings.drain(..).for_each(|timing| view.time(&timing));
    facts.end_of_reflight(&mut flight, disorder, &drawing.window);
    let judgement = facts.judge();
    view.judge(start_tick, &judgement);
    view.flown_by(&flight.reader.identity.who(&flight.reader.devices));
    say!("{}: {judgement}", log.display());
    for remark in &flight.reader.log_lines {
        view.event(remark.time_ns / STEP_NS, level(remark.level), &remark.words);
    }
    let mark = Mark { status: Status::from(&judgement).number(), first_difference };
    Ok((view.finish(mark)?, mark))
}

/// Draws two logs beside each other; returns the recording's size, and what came of it.
pub fn two(log: &Path, other: &Path, saved: &Output, drawing: &Drawing) -> Result<(u64, Mark)> {
    let how = Comparison {
        about: About {
            title: format!("{} against {}", title(log), title(other)),
            recording_id: drawing.stamp.id().into(),
            // What cannot be opened is told below.
            flown: [log, other]
                .map(|log| {
                    logs::open(log, replay::OPEN)
                        .map_or_else(|_| String::new(), |reader| flown(&reader.identity))
                })
                .into(),
        },
        layout: drawing.layout.clone(),
        names: names(log, other),
        shift_ticks: drawing.shift_ticks,
    };
    let status = |judgements: &[replay::Judgement]| {
        Status::gravest(judgements.iter().map(Status::from)).number()
    };
    let drawn =
        draw_against(log, Other::Log(other), saved, &how, status).map_err(|error| match error {
            // Which of the two logs it was is not known here.
            DrawError::Replay(error) => {
                anyhow::anyhow!("{} against {}: {error}", log.display(), other.display())
            }
            DrawError::View(error) => error.into(),
        })?;
    match drawn.first_difference {
        Some(tick) => say!("first difference at {}", at(tick)),
        None => say!("no difference"),
    }
    drawn.judgements.iter().for_each(|judgement| say!("{judgement}"));
    let first_difference = drawn.first_difference;
    let mark = Mark { status: status(&drawn.judgements), first_difference };
    Ok((drawn.bytes, mark))
}

/// What two logs are called: by their files, and where these are called alike, by their folders, too.
fn names(log: &Path, other: &Path) -> [String; 2] {
    let plain = |name: String| -> String {
        let fits = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        name.chars().map(|c| if fits(c) { c } else { '_' }).collect()
    };
    let [mut first, mut second] = [log, other].map(|log| plain(title(log)));
    if first == second {
        let folder = |log: &Path| {
            let folder = log.parent().and_then(Path::file_name).unwrap_or_default();
            plain(folder.display().to_string())
        };
        (first, second) =
            (format!("{}-{first}", folder(log)), format!("{}-{second}", folder(other)));
    }
    if first == second {
        second.push_str("-2");
    }
    // An entity of both is called so.
    [first, second].map(|name| match name.as_str() {
        "" | "delta" => format!("{name}-log"),
        _ => name,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_logs_have_two_names_that_entities_may_have() {
        let of = |a: &str, b: &str| names(Path::new(a), Path::new(b));
        assert_eq!(of("x/calm.mcap", "gusts.mcap"), ["calm", "gusts"]);
        assert_eq!(of("a/flight.mcap", "b/flight.mcap"), ["a-flight", "b-flight"]);
        assert_eq!(of("flight.mcap", "flight.mcap"), ["-flight", "-flight-2"]);
        assert_eq!(of("my flight/é.mcap", "delta.mcap"), ["_", "delta-log"]);
    }
}
