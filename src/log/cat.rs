//! `tiltrotor log cat`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use engine::STEP_NS;
use logs::channels::Written;
use logs::fields::Value;
use logs::layout::Layout;
use logs::{Ending, Messages};
use replay::{Outcome, Window};
use wildmatch::WildMatch;

use super::ended::ended;
use crate::console::Stdout;
use crate::numbers::whole;
use crate::status::Status;
use crate::window::WindowArgs;

/// What to print.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Only channels of this name, * and ? allowed: state, inputs, hardware, timing, events, outputs
    #[arg(long, value_name = "GLOB", alias = "topic")]
    channel: Vec<String>,
    /// Only fields of this name, * and ? allowed: '*.velocity_mps.*', load_factor
    #[arg(long, value_name = "GLOB")]
    field: Vec<String>,
    /// Only every Nth tick; device events and flight events are printed all the same
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = whole(1, 1_000_000_000, "one tick in so many"), allow_negative_numbers = true)]
    every: u64,
    #[command(flatten)]
    window: WindowArgs,
}

/// What is printed of a channel: the places of its fields in the message, each behind its name. `None`
/// of a channel that is not wanted.
type Choice = Option<Vec<(usize, String)>>;

/// Prints every number that is wanted, a line of JSON a message.
pub fn run(args: &Args) -> Result<Status> {
    let globs = |globs: &[String]| globs.iter().map(|g| WildMatch::new(g)).collect::<Vec<_>>();
    let (channels, fields) = (globs(&args.channel), globs(&args.field));
    let mut choices: BTreeMap<String, Choice> = BTreeMap::new();
    let mut out = BufWriter::new(Stdout);
    let name = args.log.display();
    let window = args.window.of(&args.log)?;
    // What cannot be flown any more is still read by its own schema.
    let mut messages = Messages::open(&args.log, replay::OPEN).with_context(|| name.to_string())?;
    if window != Window::default() {
        let (from, until) = (window.from_tick.unwrap_or(0), window.until_tick.unwrap_or(u64::MAX));
        messages.limit(from, until).with_context(|| name.to_string())?;
    }
    let mut line = String::new();
    while let Some(message) = messages.next_message() {
        let (topic, Some(layout)) = (message.topic(), message.layout()) else { continue };
        if !choices.contains_key(topic) {
            let choice = choose(topic, layout, &channels, &fields);
            choices.insert(topic.to_string(), choice);
        }
        let Some(Some(choice)) = choices.get(topic) else { continue };
        let now_and_then =
            message.channel().is_some_and(|channel| matches!(channel.written, Written::OnEvent));
        if !now_and_then && !(message.time_ns / STEP_NS).is_multiple_of(args.every) {
            continue;
        }
        line.clear();
        let _ = write!(line, "{{\"topic\":\"{topic}\",\"time_ns\":{}", message.time_ns);
        let bits: Vec<u64> =
            layout.bits(&message.data).with_context(|| name.to_string())?.collect();
        for (place, name) in choice {
            let (Some(number), Some(bits)) = (layout.numbers().get(*place), bits.get(*place))
            else {
                bail!("{}: {topic} changes its layout on the way", args.log.display());
            };
            let _ = match number.kind.value(*bits) {
                // JSON has no such numbers.
                Value::F64(value) if !value.is_finite() => write!(line, "{name}\"{value}\""),
                value => write!(line, "{name}{value}"),
            };
        }
        line.push_str("}\n");
        if out.write_all(line.as_bytes()).is_err() {
            // Whoever closed the pipe has seen enough; another error is told at the end.
            return Ok(Status::Done);
        }
    }
    if out.flush().is_err() {
        return Ok(Status::Done);
    }
    if matches!(messages.ending(), Ending::Damaged(_)) {
        return Ok(ended(&messages, &args.log));
    }
    if choices.is_empty() {
        bail!("{name}: no recorded channel in it");
    }
    if !choices.values().any(Option::is_some) {
        let there: Vec<_> = choices.keys().map(String::as_str).collect();
        let fields = format!("`tiltrotor log fields {name}` lists their fields");
        let there = there.join(", ");
        bail!("{name}: no such channel or field in it; its channels are {there}; {fields}");
    }
    let ended = match messages.ending() {
        Ending::Closed => Status::Done,
        _ => Status::NeverClosed,
    };
    let judgement = replay::judge(&args.log, &window);
    complain!("tiltrotor: {name}: {judgement}");
    // What cannot be judged can still be read.
    Ok(match judgement.outcome {
        Outcome::Unusable => ended,
        _ => Status::from(&judgement),
    })
}

fn choose(topic: &str, layout: &Layout, channels: &[WildMatch], fields: &[WildMatch]) -> Choice {
    let bare = topic.trim_start_matches('/');
    let wanted = |globs: &[WildMatch], names: [&str; 2]| {
        globs.is_empty() || globs.iter().any(|glob| names.iter().any(|name| glob.matches(name)))
    };
    if !wanted(channels, [topic, bare]) {
        return None;
    }
    // The name of the state's fields elsewhere, as in what `verify` says, is without `state.`.
    let prefix = format!("{bare}.");
    let chosen: Vec<_> = layout
        .numbers()
        .iter()
        .enumerate()
        .filter(|(_, number)| {
            let path = number.path.as_str();
            wanted(fields, [path, path.strip_prefix(&prefix).unwrap_or(path)])
        })
        .map(|(place, number)| (place, format!(",\"{}\":", number.path)))
        .collect();
    (!chosen.is_empty()).then_some(chosen)
}
