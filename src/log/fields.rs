//! `tiltrotor log fields`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use engine::Outputs;
use engine::inputs::DeviceEvent;
use logs::channels::{Channel, ChannelId};
use logs::fields::{Node, tree};
use logs::layout::Layout;
use logs::records::{EventRecord, InputsRecord, RestartRecord, StateRecord, TimingRecord};
use logs::units::unit_of;
use logs::{Ending, Messages};
use serde_json::json;
use wildmatch::WildMatch;

use super::ended::{ended, fault};
use crate::status::Status;

/// What is said of the fields of every public struct: its name, and each field with its doc comment, in order.
/// Made of the sources by `provenance`, so that a field and what is said of it stand in one place.
type Described = (&'static str, &'static [(&'static str, &'static str)]);
static DESCRIBED: &[Described] = include!(concat!(env!("OUT_DIR"), "/descriptions.rs"));

/// Parts that mean little without what they are parts of.
const PARTS: [&str; 8] = ["x", "y", "z", "w", "left", "right", "nose", "main"];

/// What to list.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Only channels of this name, * and ? allowed
    #[arg(long, value_name = "GLOB")]
    channel: Vec<String>,
    /// Only fields of this name, * and ? allowed
    #[arg(long, value_name = "GLOB")]
    field: Vec<String>,
    /// How to list
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// Form of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// For people
    Text,
    /// For programs: an array of objects
    Json,
}

/// A channel of the log.
struct Found {
    messages: u64,
    layout: Option<Layout>,
}

/// Lists the fields of every channel that the log has messages of.
pub fn run(args: &Args) -> Result<Status> {
    let name = args.log.display();
    let mut messages = Messages::open(&args.log, replay::OPEN).with_context(|| name.to_string())?;
    let mut channels: BTreeMap<String, Found> = BTreeMap::new();
    while let Some(message) = messages.next_message() {
        let topic = message.topic();
        if let Some(found) = channels.get_mut(topic) {
            found.messages += 1;
        } else {
            let layout = message.layout().cloned();
            channels.insert(topic.into(), Found { messages: 1, layout });
        }
    }
    let globs = |globs: &[String]| globs.iter().map(|g| WildMatch::new(g)).collect::<Vec<_>>();
    let (wanted_channels, wanted_fields) = (globs(&args.channel), globs(&args.field));
    let wanted = |globs: &[WildMatch], name: &str| {
        globs.is_empty() || globs.iter().any(|glob| glob.matches(name))
    };
    let mut listed = 0;
    let mut objects = Vec::new();
    for (topic, found) in &channels {
        let bare = topic.trim_start_matches('/');
        if !wanted(&wanted_channels, topic) && !wanted(&wanted_channels, bare) {
            continue;
        }
        let descriptions = Channel::of(topic).map_or_else(BTreeMap::new, descriptions);
        let Some(layout) = &found.layout else {
            if args.field.is_empty() {
                listed += 1;
                if args.format == Format::Text {
                    say!("{topic}: {} messages of text or for viewers", found.messages);
                }
            }
            continue;
        };
        let fields: Vec<_> =
            layout.numbers().iter().filter(|number| wanted(&wanted_fields, &number.path)).collect();
        listed += fields.len();
        if args.format == Format::Text && !fields.is_empty() {
            let numbers = layout.numbers().len();
            say!("{topic}: {} messages of {numbers} numbers", found.messages);
        }
        for field in fields {
            let unit = unit_of(&field.path);
            let about = descriptions.get(&field.path).map_or("", String::as_str);
            match args.format {
                Format::Text => {
                    let unit = if unit.is_empty() { "–" } else { &unit };
                    say!("  {:<48} {unit:<8} {about}", field.path);
                }
                Format::Json => objects.push(json!({
                    "channel": topic, "field": field.path, "unit": unit, "description": about,
                })),
            }
        }
    }
    if let Ending::Damaged(why) = messages.ending()
        && channels.is_empty()
    {
        bail!("{name}: {}: {why}", fault(&messages));
    }
    if listed == 0 {
        let there: Vec<_> = channels.keys().map(String::as_str).collect();
        bail!("{name}: no such channel or field in it; its channels are {}", there.join(", "));
    }
    if args.format == Format::Json {
        say!("{:#}", serde_json::Value::from(objects));
    }
    Ok(ended(&messages, &args.log))
}

/// What today's structs say of the numbers of a channel, by their paths.
fn descriptions(channel: &Channel) -> BTreeMap<String, String> {
    let node = match channel.id {
        ChannelId::Hardware => tree(&DeviceEvent::default()),
        ChannelId::Inputs => tree(&InputsRecord::default()),
        ChannelId::State => tree(&StateRecord::default()),
        ChannelId::Timing => tree(&TimingRecord::default()),
        ChannelId::Events => tree(&EventRecord::default()),
        ChannelId::Outputs => tree(&Outputs::default()),
        ChannelId::Restart => tree(&RestartRecord::default()),
        ChannelId::Tf
        | ChannelId::Joy
        | ChannelId::JointStates
        | ChannelId::Fix
        | ChannelId::Log
        | ChannelId::RobotDescription
        | ChannelId::Devices => return BTreeMap::new(),
    };
    let mut found = BTreeMap::new();
    if let Ok(node) = node {
        walk(&node, "", "", &mut found);
    }
    found
}

/// Puts down what is said of every number below a node; `above` is what is said of the node itself.
fn walk(node: &Node, path: &str, above: &str, found: &mut BTreeMap<String, String>) {
    match node {
        Node::Leaf(_) => {
            found.insert(path.into(), above.into());
        }
        Node::Array(items) => {
            for (place, item) in items.iter().enumerate() {
                walk(item, &format!("{path}[{place}]"), above, found);
            }
        }
        Node::Struct(name, fields) => {
            let names: Vec<&str> = fields.iter().map(|(field, _)| *field).collect();
            let said = said_of(name, &names);
            for (place, (field, child)) in fields.iter().enumerate() {
                let own = said.map_or("", |fields| fields[place].1);
                let words = match (PARTS.contains(field), above, own) {
                    (true, above, own) if !above.is_empty() => format!("{above} {own}"),
                    (_, above, "") => above.into(),
                    _ => own.into(),
                };
                let path =
                    if path.is_empty() { (*field).into() } else { format!("{path}.{field}") };
                walk(child, &path, words.trim(), found);
            }
        }
    }
}

/// What is said of the fields of a struct: several have the same name, and are told apart by their fields.
fn said_of(name: &str, names: &[&str]) -> Option<&'static [(&'static str, &'static str)]> {
    let same = |fields: &[(&str, &str)]| {
        fields.len() == names.len()
            && fields.iter().zip(names).all(|(field, name)| field.0 == *name)
    };
    DESCRIBED.iter().find(|(known, fields)| *known == name && same(fields)).map(|known| known.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field that nobody describes would be a name without a meaning in the list.
    #[test]
    fn every_number_of_the_log_is_described() {
        let mut wanting = Vec::new();
        for channel in &logs::channels::CHANNELS {
            for (path, words) in descriptions(channel) {
                if words.is_empty() {
                    wanting.push(format!("{} {path}", channel.topic));
                }
            }
        }
        assert!(wanting.is_empty(), "{wanting:#?}");
    }

    #[test]
    fn structs_of_one_name_are_told_apart() {
        let of = descriptions(ChannelId::Outputs.into());
        assert_eq!(of["rotors.left.thrust_n"], "T, along the mast.");
        assert_eq!(of["load_factor"], "Load factor, 1 in level flight.");
    }
}
