//! What reports for programs have in common; docs/reports.md says what is what.

use engine::STEP_S;
use logs::fields::Value as Number;
use replay::growth::{Checkpoint, Growth};
use replay::{Divergence, End, InputChange, Judgement, OneStepCheck, Stage};
use serde_json::{Value, json};

use crate::status::Status;

/// A recorded number: its value (`null` where it is none) and its bits.
pub fn number(number: Number) -> Value {
    let value = match number {
        Number::F64(value) => json!(value),
        Number::U64(value) => json!(value),
        Number::I64(value) => json!(value),
    };
    json!({ "value": value, "hex": format!("0x{:016x}", number.bits()) })
}

/// What a log is.
pub fn judgement(judgement: &Judgement) -> Value {
    json!({
        "outcome": judgement.outcome.name(),
        "status": Status::from(judgement).number(),
        "first_bad_tick": judgement.first_bad_tick,
        "words": judgement.words,
    })
}

/// How its reading ended.
pub fn end(end: &End) -> Value {
    json!({ "reason": end.name(), "words": end.to_string() })
}

/// The first difference.
pub fn divergence(divergence: &Divergence) -> Value {
    json!({
        "tick": divergence.tick,
        "after_tick": divergence.after_tick,
        "time_s": divergence.tick as f64 * STEP_S,
        "stage": divergence.stage.map(Stage::name),
        "or_before": divergence.stage.and_then(Stage::or_before),
        "field": divergence.path,
        "unit": divergence.unit,
        "recorded": number(divergence.recorded),
        "reflown": number(divergence.reflown),
        "ulps": divergence.recorded.ulps_to(divergence.reflown),
        "other_fields": divergence.others,
        "stages": stages(&divergence.stages, "fields"),
        "last_input": divergence.last_input.as_ref().map(input),
        "single_steps": single(&divergence.single),
        "growth": growth(&divergence.growth),
    })
}

fn stages(counts: &[(Stage, u64)], of: &str) -> Value {
    counts.iter().map(|(stage, count)| json!({ "stage": stage.name(), of: count })).collect()
}

fn input(input: &InputChange) -> Value {
    let tick = input.led_to_tick();
    let time_s = tick as f64 * STEP_S;
    match input {
        InputChange::Device { event, moves } => json!({
            "tick": tick,
            "time_s": time_s,
            "from": "device",
            "device": event.device,
            "kind": event.kind,
            "code": event.code,
            "value": event.value,
            "moves": moves,
        }),
        InputChange::World { path, unit, from, to, .. } => json!({
            "tick": tick,
            "time_s": time_s,
            "from": "world",
            "field": path,
            "unit": unit,
            "before": number(*from),
            "after": number(*to),
        }),
    }
}

fn single(single: &OneStepCheck) -> Value {
    json!({
        "ticks": single.ticks,
        "differing": single.differing,
        "first_stages": stages(&single.first_stages, "ticks"),
        "blocks_compared_ticks": single.outputs,
        "between_keyframes": single.between_keyframes,
        "block": single.block.as_ref().map(|block| json!({
            "tick": block.tick,
            "stage": block.stage.name(),
            "field": block.path,
            "unit": block.unit,
            "recorded": number(block.recorded),
            "reflown": number(block.reflown),
            "ulps": block.recorded.ulps_to(block.reflown),
        })),
    })
}

/// How a difference grows.
pub fn growth(growth: &Growth) -> Value {
    json!({
        "first_tick": growth.first_tick,
        "last_tick": growth.last_tick,
        "differing_ticks": growth.differing_ticks,
        "same_from_tick": growth.same_from,
        "doubling_s": growth.doubling_s(),
        "checkpoints": growth.checkpoints.iter().map(checkpoint).collect::<Vec<_>>(),
    })
}

fn checkpoint(checkpoint: &Checkpoint) -> Value {
    let groups = checkpoint.groups.iter().map(|group| {
        json!({
            "group": group.group,
            "unit": group.unit,
            "absolute": group.absolute,
            "ulps": group.ulps,
        })
    });
    json!({
        "after_s": checkpoint.after_s,
        "tick": checkpoint.tick,
        "fields": checkpoint.fields,
        "groups": groups.collect::<Vec<_>>(),
    })
}
