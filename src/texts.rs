//! Texts that a command line names: files, or what is built in.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// The text of a file, or the built-in one of that name.
pub fn text_or(path: Option<&Path>, name: &str, built_in: &str) -> Result<(String, String)> {
    match path {
        Some(path) => Ok((name_of(path), read(path)?)),
        None => Ok((name.to_string(), built_in.to_string())),
    }
}

/// How a file is called in messages.
pub fn name_of(path: &Path) -> String {
    path.display().to_string()
}

/// The text of a file.
pub fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}
