//! Tables that aircraft files of before they existed do not have.
//!
//! Every log carries the aircraft file that it was flown with, and is read as long as there are logs.
//! What `[envelope]`, `[pilot]` and `[display]` say now was part of the program then, the same for every
//! aircraft: the XV-15's. So a file without such a table gets the XV-15's whole, and a log of that
//! time is read, drawn and marked as it was. A new file has tables of its own: the XV-15's corridor
//! is no other aircraft's. A table that is there is complete or refused.

use std::sync::LazyLock;

use crate::builtin;
use crate::error::ConfigError;
use crate::tree::{self, Node, Numbers, Value};

/// The tables.
const TABLES: [&str; 3] = ["envelope", "pilot", "display"];

static XV15: LazyLock<Result<Vec<(String, Node)>, ConfigError>> = LazyLock::new(|| {
    let Value::Table(nodes) = tree::parse("xv15.toml", builtin::XV15, Numbers::Sourced)?.0.value
    else {
        return Ok(Vec::new());
    };
    Ok(nodes.into_iter().filter(|(name, _)| TABLES.contains(&name.as_str())).collect())
});

/// Adds the tables that are not there.
pub(crate) fn complete(tree: &mut Node) -> Result<(), ConfigError> {
    let Value::Table(nodes) = &mut tree.value else { return Ok(()) };
    let there = |nodes: &[(String, Node)], name| nodes.iter().any(|(other, _)| other == name);
    if TABLES.iter().all(|name| there(nodes, *name)) {
        return Ok(());
    }
    for (name, node) in XV15.as_ref().map_err(Clone::clone)? {
        if !there(nodes, name.as_str()) {
            nodes.push((name.clone(), node.clone()));
        }
    }
    Ok(())
}
