//! `tiltrotor diff`.

use std::path::PathBuf;

use anyhow::{Result, anyhow};
use engine::STEP_S;
use engine::inputs::{DeviceEvent, EventKind};
use indicatif::{ProgressBar, ProgressStyle};
use logs::text::at;
use logs::units::with_unit;
use replay::{Diff, Extent, FileDifference, KeyDifference, Side, Stage, Which, diff, differing};
use serde_json::{Value, json};

use crate::json;
use crate::status::Status;

/// Two logs.
#[derive(clap::Args)]
pub struct Args {
    /// The first log
    a: PathBuf,
    /// The second log
    b: PathBuf,
    /// How to report
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Every field and key that differs, not only the first ones
    #[arg(long)]
    all: bool,
}

/// Form of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// For people
    Text,
    /// For programs: docs/reports.md
    Json,
}

/// Lines of a list, unless all are asked for.
const LINES: usize = 12;

/// Compares them as they were recorded.
pub fn run(args: &Args) -> Result<Status> {
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
        bar.set_style(style);
    }
    let found = diff(&args.a, &args.b, |ticks| {
        if ticks.is_multiple_of(2500) {
            bar.set_message(format!("{:.0} s compared", ticks as f64 * STEP_S));
            bar.tick();
        }
    });
    bar.finish_and_clear();
    let diff = found.map_err(|(which, error)| {
        let log = if which == Which::A { &args.a } else { &args.b };
        anyhow!("{}: {error}", log.display())
    })?;
    match args.format {
        Format::Text => tell(args, &diff),
        Format::Json => say!("{:#}", in_json(args, &diff)),
    }
    Ok(status(&diff))
}

fn status(diff: &Diff) -> Status {
    let compared = match (diff.usable(), diff.same()) {
        (false, _) => Status::Unusable,
        (true, true) => Status::Done,
        (true, false) => Status::Differs,
    };
    let sides = [&diff.a, &diff.b].map(|side| Status::from(&side.judgement));
    Status::gravest([compared].into_iter().chain(sides))
}

fn tell(args: &Args, diff: &Diff) {
    let most = if args.all { usize::MAX } else { LINES };
    for (name, path, side) in [("A", &args.a, &diff.a), ("B", &args.b, &diff.b)] {
        say!("{name}  {}: {}", path.display(), told(side));
    }
    for KeyDifference { key, a, b } in &diff.identity {
        say!("   {key}: {} in A, {} in B", or_none(a.as_deref()), or_none(b.as_deref()));
    }
    for FileDifference { name, keys } in &diff.files {
        match keys.len() {
            0 => say!("{name}: not the same text, but the same values"),
            count => say!("{name}: {}", differing(count, "value")),
        }
        some(keys, most, |KeyDifference { key, a, b }| {
            say!("  {key}: {} in A, {} in B", or_none(a.as_deref()), or_none(b.as_deref()));
        });
    }
    match diff.compared {
        None => say!("they have no tick in common"),
        Some((from, to)) => {
            say!("compared: {} ticks, from {} to {}", diff.ticks, at(from), at(to));
        }
    }
    tell_irregular(diff);
    tell_inputs(diff, most);
    tell_states(diff, most);
    if diff.usable() {
        say!("{}", in_a_word(diff));
    } else {
        say!(
            "not usable to its end: {}",
            if diff.same() { "the same up to there" } else { "they differ" }
        );
    }
}

/// What came of it. That one flight only goes on for longer is no difference of what was flown.
fn in_a_word(diff: &Diff) -> &'static str {
    let same_inputs = diff.events.ticks == 0 && diff.world.is_empty();
    let regular = diff.a.irregular.is_none() && diff.b.irregular.is_none();
    if diff.same() {
        "the same flight"
    } else if same_inputs && diff.state.is_empty() && diff.files.is_empty() && regular {
        match diff.compared {
            Some(_) => "they differ only in where they begin or end",
            None => "they differ: no moment is in both",
        }
    } else {
        "they differ"
    }
}

/// What the same states of two logs that are not regular are worth.
fn tell_irregular(diff: &Diff) {
    for (name, side) in [("A", &diff.a), ("B", &diff.b)] {
        if let Some(irregular) = side.irregular {
            say!(
                "{name} is not regular: {irregular}; {} ticks are missing, {} are there once more",
                side.missing,
                side.doubled
            );
        }
    }
}

fn told(side: &Side) -> String {
    let (from, to) = (at(side.start_tick), at(side.last_tick));
    format!("from {from} to {to}, digest {:016x}\n   {}", side.digest, side.judgement)
}

fn or_none(value: Option<&str>) -> &str {
    value.unwrap_or("nothing")
}

/// The first lines of a list, and how many more there are.
fn some<T>(list: &[T], most: usize, tell: impl Fn(&T)) {
    list.iter().take(most).for_each(tell);
    if list.len() > most {
        say!("  and {} more (--all)", list.len() - most);
    }
}

fn tell_inputs(diff: &Diff, most: usize) {
    if let Some(first) = &diff.events.first {
        say!(
            "device events: not the same in {} ticks, first for {}",
            diff.events.ticks,
            at(first.tick)
        );
        say!("  A         {}", event(first.a.as_ref()));
        say!("  B         {}", event(first.b.as_ref()));
    }
    if !diff.world.is_empty() {
        say!("world: {}", differing(diff.world.len(), "field"));
        some(&diff.world, most, tell_extent);
    }
    if diff.events.ticks == 0 && diff.world.is_empty() {
        say!("inputs: the same");
    }
}

fn event(event: Option<&DeviceEvent>) -> String {
    let Some(DeviceEvent { kernel_time_ns, device, kind, code, value, .. }) = event else {
        return "nothing".into();
    };
    let kind = EventKind::from_u64(*kind).map_or("event", |kind| kind.facts().key);
    format!("device {device} {kind} 0x{code:x} = {value}, at the kernel's time {kernel_time_ns} ns")
}

fn tell_states(diff: &Diff, most: usize) {
    let Some(first) = &diff.first else {
        say!("states: the same to the bit");
        return;
    };
    say!("states: {}, first at {}", differing(diff.state.len(), "field"), at(first.tick));
    if diff.parts_at_start() {
        say!("  stage     none: they begin with it");
    } else {
        let stage = first.stage.map_or("(not known here)", Stage::name);
        let before = first.stage.and_then(Stage::or_before);
        say!(
            "  stage     {stage}{}",
            before.map_or(String::new(), |it| format!(", or before it {it}"))
        );
    }
    say!("  field     {}", first.path);
    for (name, value) in [("A", first.recorded), ("B", first.reflown)] {
        say!("  {name:<9} {}  (0x{:016x})", with_unit(value, &first.unit), value.bits());
    }
    let ulps = first.recorded.ulps_to(first.reflown);
    say!("  apart     {} ULP", ulps.map_or("?".into(), |ulps| ulps.to_string()));
    say!("  others    {} at this tick", differing(first.others, "more field"));
    if let Some(input) = &first.last_input {
        say!("  last input of A: {input}");
    }
    say!("  largest differences, by the tick of the first");
    let mut fields: Vec<&Extent> = diff.state.iter().collect();
    let stage = |extent: &Extent| Stage::of_state(&extent.path).unwrap_or(Stage::Step);
    fields.sort_by_key(|extent| (extent.first_tick, stage(extent)));
    some(&fields, most, |extent| tell_extent(extent));
    say!("{}", first.growth);
    if let Some(noticed) = diff.noticed() {
        say!("{noticed}");
    }
}

fn tell_extent(extent: &Extent) {
    let Extent { path, unit, first_tick, ticks, largest, largest_tick, ulps, .. } = extent;
    say!(
        "    {path}: {} at {}, {ulps} ULP at most; {ticks} ticks, from {} on",
        with_unit(format!("{largest:.3e}"), unit),
        at(*largest_tick),
        at(*first_tick)
    );
}

/// As `docs/reports.md` has it.
fn in_json(args: &Args, diff: &Diff) -> Value {
    let side = |path: &PathBuf, side: &Side| {
        json!({
            "log": path.display().to_string(),
            "start_tick": side.start_tick,
            "last_tick": side.last_tick,
            "digest": format!("{:016x}", side.digest),
            "judgement": json::judgement(&side.judgement),
            "ticks_missing": side.missing,
            "ticks_doubled": side.doubled,
            "end": json::end(&side.end),
        })
    };
    let keys = |keys: &[KeyDifference]| -> Value {
        keys.iter().map(|key| json!({ "key": key.key, "a": key.a, "b": key.b })).collect()
    };
    let file = |file: &FileDifference| json!({ "file": file.name, "keys": keys(&file.keys) });
    json!({
        "report": "tiltrotor diff",
        "version": 2,
        "status": status(diff).number(),
        "same": diff.same(),
        "a": side(&args.a, &diff.a),
        "b": side(&args.b, &diff.b),
        "identity": keys(&diff.identity),
        "files": diff.files.iter().map(file).collect::<Vec<_>>(),
        "compared": diff.compared.map(|(from, to)| json!({
            "ticks": diff.ticks, "first_tick": from, "last_tick": to,
        })),
        "device_events": {
            "ticks": diff.events.ticks,
            "first": diff.events.first.map(|first| json!({
                "tick": first.tick,
                "a": first.a.as_ref().map(event_json),
                "b": first.b.as_ref().map(event_json),
            })),
        },
        "world": diff.world.iter().map(extent).collect::<Vec<_>>(),
        "first": diff.first.as_ref().map(|first| json!({
            "tick": first.tick,
            "time_s": first.tick as f64 * STEP_S,
            "at_start": diff.parts_at_start(),
            "stage": first.stage.map(Stage::name),
            "field": first.path,
            "unit": first.unit,
            "a": json::number(first.recorded),
            "b": json::number(first.reflown),
            "ulps": first.recorded.ulps_to(first.reflown),
            "other_fields": first.others,
        })),
        "state": diff.state.iter().map(extent).collect::<Vec<_>>(),
        "growth": diff.first.as_ref().map(|first| json::growth(&first.growth)),
    })
}

fn event_json(event: &DeviceEvent) -> Value {
    json!({
        "device": event.device,
        "kind": event.kind,
        "code": event.code,
        "value": event.value,
        "kernel_time_ns": event.kernel_time_ns,
    })
}

fn extent(extent: &Extent) -> Value {
    json!({
        "field": extent.path,
        "unit": extent.unit,
        "first_tick": extent.first_tick,
        "ticks": extent.ticks,
        "largest": extent.largest,
        "largest_tick": extent.largest_tick,
        "a": json::number(extent.a),
        "b": json::number(extent.b),
        "ulps": extent.ulps,
        "ulps_tick": extent.ulps_tick,
    })
}
