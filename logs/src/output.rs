//! Files that are written whole or not at all.
//!
//! An [`Output`] is written beside its place, under a hidden name, and renamed over it once it is
//! whole and on disk. Until then whatever stood there stands there; when anything fails, the hidden
//! file goes away, and what a killed program left is removed by the next one that writes there. A
//! flight is different: its log has to be readable under its own name while it grows, so it takes its
//! name with its first state, locked, and an older log of that name is set aside until the new one is
//! closed. What is locked by a flight is never replaced.
//!
//! Pipes, terminals and devices have no place to be renamed to: they are written as they are.

pub(crate) mod hidden;
mod same;

use std::fs::{self, File, Metadata, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use crate::LogError;
use same::{followed, is_same};

/// Attempts to take a name or a lock that others take and leave at the same time.
const ATTEMPTS: u32 = 20;
/// Time between two of them: others hold a lock as long as a renaming takes, a flight as long as it
/// flies.
const PAUSE: Duration = Duration::from_millis(5);

/// A file to be written.
#[derive(Debug)]
pub struct Output {
    file: File,
    /// As it was named, for messages.
    named: PathBuf,
    /// The same with links followed.
    target: PathBuf,
    stage: Stage,
}

/// Where the bytes are.
#[derive(Debug)]
enum Stage {
    /// In a pipe or a device.
    Stream,
    /// Beside the target.
    Beside { hidden: PathBuf, force: bool },
    /// Beside the target until the flight begins; the older log is held, so that nobody else takes it.
    Claimed { hidden: PathBuf, old: Option<File> },
    /// Under its own name, with the older log set aside.
    Flown { set_aside: Option<PathBuf>, _old: Option<File> },
    /// Whole, under its own name.
    Done,
}

impl Output {
    /// Begins a file that is made from `inputs`, to take its place with [`Output::finish`].
    ///
    /// # Errors
    /// When it is one of its inputs, exists and `force` is not set, is being flown, or cannot be made.
    pub fn beside(path: &Path, force: bool, inputs: &[&Path]) -> Result<Self, LogError> {
        refuse(path, force, inputs)?;
        Self::begin(path, |hidden| Stage::Beside { hidden, force })
    }

    /// Begins the log of a flight, to take its name with [`Output::begun`].
    ///
    /// # Errors
    /// When it exists and `force` is not set, is being flown, or cannot be made.
    pub fn flight(path: &Path, force: bool) -> Result<Self, LogError> {
        refuse(path, force, &[])?;
        let old = hold(path, &followed(path))?;
        let output = Self::begin(path, |hidden| Stage::Claimed { hidden, old })?;
        // Where files cannot be locked, a flight flies all the same.
        let _ = output.file.try_lock();
        Ok(output)
    }

    fn begin(path: &Path, stage: impl FnOnce(PathBuf) -> Stage) -> Result<Self, LogError> {
        let failed = |error| LogError::create(path, error);
        let target = followed(path);
        let named = path.to_path_buf();
        if fs::metadata(&target).is_ok_and(|there| !there.is_file()) {
            let file = File::options().write(true).open(&target).map_err(failed)?;
            return Ok(Self { file, named, target, stage: Stage::Stream });
        }
        let (hidden, file) = hidden::file_beside(&target).map_err(failed)?;
        Ok(Self { file, named, target, stage: stage(hidden) })
    }

    /// The file to be written; all of them are the same file at the same place.
    ///
    /// # Errors
    /// When the system has no more of them.
    pub fn file(&self) -> Result<File, LogError> {
        self.file.try_clone().map_err(|error| LogError::create(&self.named, error))
    }

    /// How it was named.
    pub fn path(&self) -> &Path {
        &self.named
    }

    /// Where what was written can be read before it is finished.
    pub fn unfinished(&self) -> &Path {
        match &self.stage {
            Stage::Beside { hidden, .. } | Stage::Claimed { hidden, .. } => hidden,
            _ => &self.target,
        }
    }

    /// Where the older log is while the flight is under way.
    pub fn set_aside(&self) -> Option<&Path> {
        match &self.stage {
            Stage::Flown { set_aside, .. } => set_aside.as_deref(),
            _ => None,
        }
    }

    /// The log of the flight takes its name: from here on it is there, whatever happens.
    ///
    /// # Errors
    /// When someone else has taken the name, or the system refuses.
    pub fn begun(&mut self) -> Result<(), LogError> {
        let Stage::Claimed { hidden, old } = &mut self.stage else { return Ok(()) };
        let failed = |error| LogError::create(&self.named, error);
        let set_aside = match old {
            None => {
                link(hidden, &self.target).map_err(|error| {
                    match hold(&self.named, &self.target) {
                        Err(in_use) => in_use,
                        Ok(_) => failed(error),
                    }
                })?;
                None
            }
            Some(old) if old.metadata().map_err(failed)?.len() == 0 => {
                fs::rename(&*hidden, &self.target).map_err(failed)?;
                None
            }
            Some(_) => Some(replace(hidden, &self.target).map_err(failed)?),
        };
        self.stage = Stage::Flown { set_aside, _old: old.take() };
        Ok(())
    }

    /// It is whole: on disk, and in its place. Until this has returned, what stood there is not lost.
    ///
    /// # Errors
    /// When it cannot be brought to disk, or its place was taken meanwhile.
    pub fn finish(mut self) -> Result<(), LogError> {
        self.begun()?;
        if matches!(self.stage, Stage::Stream) {
            return Ok(());
        }
        self.file.sync_all()?;
        match &self.stage {
            Stage::Beside { hidden, force } => place(hidden, &self.target, &self.named, *force)?,
            // One that cannot be removed is one too many, not one too few.
            Stage::Flown { set_aside: Some(old), .. } => drop(fs::remove_file(old)),
            _ => {}
        }
        self.stage = Stage::Done;
        Ok(())
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        if let Stage::Beside { hidden, .. } | Stage::Claimed { hidden, .. } = &self.stage {
            let _ = fs::remove_file(hidden);
        }
    }
}

/// Writes a text file that is made from `inputs`, in place of what was there.
///
/// # Errors
/// When it is one of its inputs, or cannot be written.
pub fn write(path: &Path, text: &str, inputs: &[&Path]) -> Result<(), LogError> {
    let output = Output::beside(path, true, inputs)?;
    output.file()?.write_all(text.as_bytes())?;
    output.finish()
}

/// Says before any work what [`Output::beside`] would refuse.
///
/// # Errors
/// When the file is one of `inputs`, exists and `force` is not set, or is being flown; when it is called `-`, which means
/// standard output elsewhere: nothing here is written there.
pub fn refuse(path: &Path, force: bool, inputs: &[&Path]) -> Result<(), LogError> {
    if path.as_os_str() == "-" {
        let why = "standard output is for words; give a file, or ./- for one of that name";
        return Err(LogError::create(path, io::Error::new(io::ErrorKind::InvalidInput, why)));
    }
    let target = followed(path);
    let Ok(there) = fs::symlink_metadata(&target) else { return Ok(()) };
    if there.is_dir() {
        return Err(LogError::create(path, io::ErrorKind::IsADirectory.into()));
    }
    if let Some(input) = inputs.iter().find(|input| is_same(&there, &target, input)) {
        return Err(LogError::Input {
            path: path.display().to_string(),
            input: input.display().to_string(),
        });
    }
    hold(path, &target)?;
    if force || is_left_over(&there) {
        return Ok(());
    }
    Err(LogError::create(path, io::ErrorKind::AlreadyExists.into()))
}

/// Puts a whole file in its place: over what is there with `force` only, and never over a flight.
pub(crate) fn place(
    hidden: &Path,
    target: &Path,
    named: &Path,
    force: bool,
) -> Result<(), LogError> {
    let failed = |error| LogError::create(named, error);
    for _ in 0..ATTEMPTS {
        let Ok(there) = fs::symlink_metadata(target) else {
            match link(hidden, target) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                linked => return linked.map_err(failed),
            }
        };
        // Held until it is replaced: no flight begins over it in between.
        let _held = hold(named, target)?;
        if !force && !is_left_over(&there) {
            break;
        }
        return fs::rename(hidden, target).map_err(failed);
    }
    Err(failed(io::ErrorKind::AlreadyExists.into()))
}

/// A file of no bytes: a program that was killed, or a full disk, left it. Nothing is lost with it.
fn is_left_over(there: &Metadata) -> bool {
    there.is_file() && there.len() == 0
}

/// Locks the file that is there, if one is and files can be locked.
fn hold(named: &Path, target: &Path) -> Result<Option<File>, LogError> {
    if !fs::metadata(target).is_ok_and(|there| there.is_file()) {
        return Ok(None);
    }
    let Ok(file) = File::open(target) else { return Ok(None) };
    let in_use = || LogError::InUse { path: named.display().to_string() };
    let mut attempts = 1;
    while let Err(TryLockError::WouldBlock) = file.try_lock() {
        if attempts == ATTEMPTS {
            return Err(in_use());
        }
        attempts += 1;
        thread::sleep(PAUSE);
    }
    // Whoever replaced it before it was locked has the name now.
    let held = file.metadata().is_ok_and(|there| is_same(&there, target, target));
    if held { Ok(Some(file)) } else { Err(in_use()) }
}

/// Gives a file the name `target`, which nobody has.
fn link(hidden: &Path, target: &Path) -> io::Result<()> {
    match fs::hard_link(hidden, target) {
        Ok(()) => {
            let _ = fs::remove_file(hidden);
            Ok(())
        }
        Err(error) if has_no_links(&error) && fs::symlink_metadata(target).is_err() => {
            fs::rename(hidden, target)
        }
        Err(error) => Err(error),
    }
}

/// Gives a file the name of an older one, which is set aside; returns where to. The name is never
/// without a file.
fn replace(hidden: &Path, target: &Path) -> io::Result<PathBuf> {
    let name = target.file_name().unwrap_or_default().display();
    for number in 1.. {
        let nth = if number == 1 { String::new() } else { format!("-{number}") };
        let aside = target.with_file_name(format!("{name}.old{nth}"));
        let set = match fs::hard_link(target, &aside) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            Err(error) if has_no_links(&error) => match fs::symlink_metadata(&aside) {
                Ok(_) => continue,
                Err(_) => fs::rename(target, &aside),
            },
            set => set,
        };
        set?;
        return match fs::rename(hidden, target) {
            Ok(()) => Ok(aside),
            Err(error) => {
                // Back under its name, or one name less for the same file.
                let _ = fs::rename(&aside, target);
                let _ = fs::remove_file(&aside);
                Err(error)
            }
        };
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Whether the file system has no hard links, as those of memory cards.
fn has_no_links(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::PermissionDenied | io::ErrorKind::Unsupported | io::ErrorKind::TooManyLinks
    )
}

#[cfg(all(test, target_os = "linux"))]
mod tests;
