//! `ros2msg` schemas, generated from the recorded structs themselves.

use std::fmt::Write;
use std::sync::Arc;

use serde::Serialize;

use crate::LogError;
use crate::fields::{Node, tree};
use crate::layout::Layout;

/// Package of our message types.
pub const PACKAGE: &str = "tiltrotor";

/// What MCAP calls the language of the definitions.
pub(crate) const ENCODING: &str = "ros2msg";

/// Between the definitions of two types.
pub(crate) const RULE: &str =
    "================================================================================";

/// A channel's message type.
#[derive(Debug)]
pub struct MessageType {
    /// Its name, with its package.
    pub name: String,
    /// Its `ros2msg` definition.
    pub text: String,
    /// What its numbers are called; `None` when it is for viewers.
    pub layout: Option<Arc<Layout>>,
}

/// The message type of a struct of numbers.
pub(crate) fn numbers<T: Serialize + Default>(types: &mut Types) -> Result<MessageType, LogError> {
    types.describe::<T>()
}

/// The types that the messages of a file are made of: a name means one of them.
#[derive(Default)]
pub struct Types {
    /// Name and body of each so far.
    all: Vec<(String, String)>,
    /// Places of those that the message under way is made of.
    used: Vec<usize>,
}

impl Types {
    /// A message type, its definition with the types it is made of appended.
    ///
    /// # Errors
    /// When the struct is not recordable.
    pub fn describe<T: Serialize + Default>(&mut self) -> Result<MessageType, LogError> {
        let root = tree(&T::default())?;
        let Node::Struct(root_name, children) = &root else {
            return Err(LogError::Encode("a message is a struct".into()));
        };
        self.used.clear();
        let own = self.body(root_name, children, "")?;
        // The message keeps its own name.
        match self.all.iter().find(|(taken, body)| taken == root_name && *body != own) {
            Some(_) => return Err(LogError::Encode(format!("two types are called {root_name}"))),
            None => self.all.push(((*root_name).to_string(), own.clone())),
        }
        let mut text = own;
        for &place in &self.used {
            let (name, body) = &self.all[place];
            let _ = write!(text, "{RULE}\nMSG: {PACKAGE}/{name}\n{body}");
        }
        let layout = Some(Arc::new(Layout::of::<T>()?));
        Ok(MessageType { name: format!("{PACKAGE}/msg/{root_name}"), text, layout })
    }

    /// Defines the struct unless the same is there, and returns its name.
    ///
    /// Blocks call their structs alike (`State`): such a one takes the name of the field that holds
    /// it as well, and if that is taken, too, the name of the message.
    fn define(
        &mut self,
        root: &str,
        name: &str,
        children: &[(&'static str, Node)],
        field: &str,
    ) -> Result<String, LogError> {
        let body = self.body(root, children, field)?;
        let held = format!("{}{name}", camel_case(field));
        let of_root = format!("{root}{held}");
        let candidates = [name.to_string(), held, of_root.clone()]
            .into_iter()
            .chain((2..).map(|number| format!("{of_root}{number}")));
        for candidate in candidates.filter(|candidate| candidate != root) {
            let place = match self.all.iter().position(|(taken, _)| *taken == candidate) {
                Some(place) if self.all[place].1 == body => place,
                Some(_) => continue,
                None => {
                    self.all.push((candidate.clone(), body));
                    self.all.len() - 1
                }
            };
            if !self.used.contains(&place) {
                self.used.push(place);
            }
            return Ok(candidate);
        }
        unreachable!("the candidates never end")
    }

    /// The lines of a struct's fields, their types defined on the way.
    fn body(
        &mut self,
        root: &str,
        children: &[(&'static str, Node)],
        field: &str,
    ) -> Result<String, LogError> {
        let mut body = String::new();
        for (child_name, child) in children {
            // Left and right say nothing of what they are sides of.
            let hint = if matches!(*child_name, "left" | "right") { field } else { child_name };
            let kind = match child {
                Node::Leaf(value) => value.ros_type().to_string(),
                Node::Struct(name, below) => {
                    format!("{PACKAGE}/{}", self.define(root, name, below, hint)?)
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
        let text = Types::default().describe::<engine::State>().unwrap().text;
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
