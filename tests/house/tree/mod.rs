//! The manifests in the tree: of every workspace, not of the root's alone.

pub mod source;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use toml::Table;

/// The tree's root.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The manifest of a folder.
pub fn manifest(folder: &Path) -> Table {
    let path = folder.join("Cargo.toml");
    let text = fs::read_to_string(&path).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    text.parse().unwrap_or_else(|why| panic!("{}: {why}", path.display()))
}

/// The packages in the tree by name, each with its folder and manifest.
pub fn packages() -> BTreeMap<String, (PathBuf, Table)> {
    let mut folders = Vec::new();
    with_manifest(&root(), &mut folders);
    let package = |folder: PathBuf| {
        let manifest = manifest(&folder);
        let name = manifest.get("package")?.get("name")?.as_str()?.to_string();
        Some((name, (folder, manifest)))
    };
    folders.into_iter().filter_map(package).collect()
}

fn with_manifest(folder: &Path, found: &mut Vec<PathBuf>) {
    if folder.join("Cargo.toml").is_file() {
        found.push(folder.to_path_buf());
    }
    let entries = fs::read_dir(folder).unwrap_or_else(|why| panic!("{}: {why}", folder.display()));
    for entry in entries {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        // What is built and what tools keep is not ours.
        if path.is_dir() && !path.is_symlink() && name != "target" && !name.starts_with('.') {
            with_manifest(&path, found);
        }
    }
}
