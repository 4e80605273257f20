//! `ros2msg` schemas, generated from the recorded structs themselves.

use std::fmt::Write;
use std::sync::{Arc, OnceLock};

use engine::Outputs;
use engine::inputs::DeviceEvent;
use serde::Serialize;

use crate::fields::{Node, tree};
use crate::layout::Layout;
use crate::records::{
    EVENTS, EventRecord, HARDWARE, INPUTS, InputsRecord, OUTPUTS, STATE, StateRecord, TIMING,
    TimingRecord,
};
use crate::{LogError, view};

/// Package of our message types.
pub const PACKAGE: &str = "tiltrotor";

/// What MCAP calls the language of the definitions.
pub(crate) const ENCODING: &str = "ros2msg";

/// What a channel holds.
pub(crate) struct Kind {
    /// The channel.
    pub topic: &'static str,
    /// The message type's name, with its package.
    pub name: String,
    /// Its definition.
    pub text: String,
    /// What its numbers are called; `None` when it is for viewers.
    pub layout: Option<Arc<Layout>>,
}

/// Every channel of a flight log, made once.
///
/// # Errors
/// When a struct is not recordable.
pub(crate) fn kinds() -> Result<&'static [Kind], LogError> {
    static KINDS: OnceLock<Vec<Kind>> = OnceLock::new();
    if let Some(kinds) = KINDS.get() {
        return Ok(kinds);
    }
    fn recorded<T: Serialize + Default>(topic: &'static str, name: &str) -> Result<Kind, LogError> {
        let layout = Some(Arc::new(Layout::of::<T>()?));
        Ok(Kind { topic, name: format!("{PACKAGE}/msg/{name}"), text: ros2msg::<T>()?, layout })
    }
    let viewed = |topic, schema: view::Schema| Kind {
        topic,
        name: schema.name.to_string(),
        text: schema.text,
        layout: None,
    };
    let kinds = vec![
        recorded::<DeviceEvent>(HARDWARE, "DeviceEvent")?,
        recorded::<InputsRecord>(INPUTS, "InputsRecord")?,
        recorded::<StateRecord>(STATE, "StateRecord")?,
        recorded::<TimingRecord>(TIMING, "TimingRecord")?,
        recorded::<EventRecord>(EVENTS, "EventRecord")?,
        recorded::<Outputs>(OUTPUTS, "Outputs")?,
        viewed(view::TF, view::tf_schema()),
        viewed(view::JOY, view::joy_schema()),
        viewed(view::FIX, view::fix_schema()),
        viewed(view::JOINT_STATES, view::joint_schema()),
        viewed(view::LOG, view::log_schema()),
        viewed(view::ROBOT_DESCRIPTION, view::string_schema()),
    ];
    Ok(KINDS.get_or_init(|| kinds))
}

const RULE: &str =
    "================================================================================";

/// A message type's definition, the types it is made of appended.
///
/// # Errors
/// When the struct is not recordable.
pub fn ros2msg<T: Serialize + Default>() -> Result<String, LogError> {
    let root = tree(&T::default())?;
    let Node::Struct(root_name, children) = &root else {
        return Err(LogError::Encode("a message is a struct".into()));
    };
    // The root keeps its own name, and comes first, without a heading.
    let mut types = Types(vec![((*root_name).to_string(), String::new())]);
    let mut text = types.body(children, "")?;
    for (name, body) in &types.0[1..] {
        let _ = write!(text, "{RULE}\nMSG: {PACKAGE}/{name}\n{body}");
    }
    Ok(text)
}

/// Types defined so far: name and body.
struct Types(Vec<(String, String)>);

impl Types {
    /// Defines the struct unless the same is there, and returns its name.
    ///
    /// Blocks call their structs alike (`State`): such a one takes the name of the field that holds
    /// it as well.
    fn define(
        &mut self,
        name: &str,
        children: &[(&'static str, Node)],
        field: &str,
    ) -> Result<String, LogError> {
        let body = self.body(children, field)?;
        let held = format!("{}{name}", camel_case(field));
        let candidates = [name.to_string(), held.clone()]
            .into_iter()
            .chain((2..).map(|number| format!("{held}{number}")));
        for candidate in candidates {
            match self.0.iter().find(|(taken, _)| *taken == candidate) {
                Some((_, same)) if *same == body => return Ok(candidate),
                Some(_) => {}
                None => {
                    self.0.push((candidate.clone(), body));
                    return Ok(candidate);
                }
            }
        }
        unreachable!("the candidates never end")
    }

    /// The lines of a struct's fields, their types defined on the way.
    fn body(&mut self, children: &[(&'static str, Node)], field: &str) -> Result<String, LogError> {
        let mut body = String::new();
        for (child_name, child) in children {
            // Left and right say nothing of what they are sides of.
            let hint = if matches!(*child_name, "left" | "right") { field } else { child_name };
            let kind = match child {
                Node::Leaf(value) => value.ros_type().to_string(),
                Node::Struct(name, below) => {
                    format!("{PACKAGE}/{}", self.define(name, below, hint)?)
                }
                Node::Array(items) => match items.first() {
                    Some(Node::Leaf(value)) => format!("{}[{}]", value.ros_type(), items.len()),
                    _ => return Err(LogError::Encode("arrays hold numbers".into())),
                },
            };
            let _ = writeln!(body, "{kind} {child_name}");
        }
        Ok(body)
    }
}

fn camel_case(snake: &str) -> String {
    snake
        .split('_')
        .filter_map(|word| {
            let mut letters = word.chars();
            letters.next().map(|first| first.to_uppercase().chain(letters).collect::<String>())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_schema_names_every_type_once() {
        let text = ros2msg::<engine::State>().unwrap();
        assert!(text.starts_with("uint64 tick\n"), "{text}");
        assert!(text.contains("tiltrotor/FccState fcc\n"), "{text}");
        assert!(text.contains("MSG: tiltrotor/Vec3\nfloat64 x\nfloat64 y\nfloat64 z\n"));
        let mut names: Vec<_> = text.lines().filter(|line| line.starts_with("MSG: ")).collect();
        let all = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all);
    }
}
