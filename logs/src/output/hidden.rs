//! Hidden files beside their place: each is locked by who writes it, so that what a program left that
//! was killed can be told from what is still being written, and goes away.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use super::same::is_same;

/// Whether a lock only says something to who asks for it. Where it keeps others from reading, as on Windows,
/// nothing hidden is locked, and nothing that was left is removed.
const LOCKS_ADVISE: bool = cfg!(unix);

const PREFIX: &str = ".tiltrotor-";
const SUFFIX: &str = ".unfinished";
/// In a hidden folder, the file that is locked; no table is called so.
const LOCK: &str = ".lock~";

/// A new file in the target's folder that no program looks at.
pub(super) fn file_beside(target: &Path) -> io::Result<(PathBuf, File)> {
    sweep_once(target.parent().unwrap_or(Path::new("")));
    loop {
        let hidden = target.with_file_name(new_name());
        let file = match File::options().read(true).write(true).create_new(true).open(&hidden) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            file => file?,
        };
        if is_mine(&hidden, &file) {
            return Ok((hidden, file));
        }
    }
}

/// A new folder in `folder` that no program looks at, with what keeps it from being taken for a leftover.
pub(crate) fn folder_in(folder: &Path) -> io::Result<(PathBuf, File)> {
    sweep_once(folder);
    loop {
        let hidden = folder.join(new_name());
        match fs::create_dir(&hidden) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            made => made?,
        }
        let lock = hidden.join(LOCK);
        let file = File::create(&lock)?;
        if is_mine(&lock, &file) {
            return Ok((hidden, file));
        }
    }
}

fn new_name() -> String {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    format!("{PREFIX}{}-{number}{SUFFIX}", std::process::id())
}

/// Locks a new file, and says whether it is still there: another program may have taken it for a
/// leftover before it was locked. Where files cannot be locked, nobody takes any away.
fn is_mine(path: &Path, file: &File) -> bool {
    !LOCKS_ADVISE
        || file.try_lock().is_err()
        || file.metadata().is_ok_and(|there| is_same(&there, path, path))
}

/// Removes what killed programs left in a folder, the first time that something is written there.
fn sweep_once(folder: &Path) {
    static SWEPT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    if !LOCKS_ADVISE {
        return;
    }
    let mut swept = SWEPT.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if !swept.iter().any(|known| known == folder) {
        swept.push(folder.into());
        sweep(folder);
    }
}

/// What cannot be looked at or removed stays: it is only one file too many.
pub(super) fn sweep(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let hidden = name.to_str().is_some_and(|n| n.starts_with(PREFIX) && n.ends_with(SUFFIX));
        let Ok(kind) = entry.file_type() else { continue };
        if !hidden || !(kind.is_file() || kind.is_dir()) {
            continue;
        }
        let path = entry.path();
        let lock = if kind.is_dir() { path.join(LOCK) } else { path.clone() };
        let Ok(file) = File::open(&lock) else { continue };
        // Held until it is gone: whoever has just made it sees that it is not there any more.
        if file.try_lock().is_err() {
            continue;
        }
        let _ = if kind.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
    }
}
