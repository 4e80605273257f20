//! Whether two names are one file.

use std::fs::Metadata;
use std::path::{Path, PathBuf};

/// The file behind links; a link to nothing is itself.
pub(super) fn followed(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

/// Whether both are one file, under whatever names.
#[cfg(unix)]
pub(super) fn is_same(one: &Metadata, _: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |file: &Metadata| (file.dev(), file.ino());
    std::fs::metadata(other).is_ok_and(|other| id(&other) == id(one))
}

/// Whether both are one file, as far as names tell.
#[cfg(not(unix))]
pub(super) fn is_same(_: &Metadata, one: &Path, other: &Path) -> bool {
    followed(one) == followed(other)
}
