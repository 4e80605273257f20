//! Cockpit maps by their files or by the names under which they are shipped.

use std::path::Path;

use anyhow::{Context, Result};
use engine::cockpit::Params;
use recorder::devices::SHIPPED;

/// A map: a file, or the name of a shipped one.
pub fn cockpit_map(path: &Path) -> Result<Params> {
    let name = path.display().to_string();
    let shipped = SHIPPED.iter().find(|map| {
        !path.exists() && (map.name == name || map.name.strip_suffix(".toml") == Some(&name))
    });
    let text = match shipped {
        Some(map) => map.text.to_string(),
        None => std::fs::read_to_string(path).with_context(|| {
            let names: Vec<_> = SHIPPED.iter().map(|map| map.name).collect();
            format!("cannot read {name}; shipped maps are {}", names.join(", "))
        })?,
    };
    Ok(aircraft::cockpit(&name, &text)?)
}
